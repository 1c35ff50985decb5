"""Pipes, tanks, spheres and planes in tiles: each once and whole, also where no block sees all of it."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.algorithms.stage import LayerFeatures, Monitor
from lidar_buildings.algorithms.tiling.blocks import Block
from lidar_buildings.algorithms.tiling.joining import References, join_features
from lidar_buildings.algorithms.tiling.run_in_tiles import run_in_tiles
from lidar_buildings.algorithms.tiling.tiled_run import TilesOptions
from lidar_buildings.algorithms.tiling.workers import Workers
from lidar_buildings.tests.industry import pipe

INDUSTRY = PIPELINES["model_industry"]
SIDE = 16.0
CORNER = np.array([600_000.0, 5_000_000.0, 0.0])
# Two pipes that run through three blocks, the tank and the sphere on an edge between two, the plate in three.
LENGTH, PIPES = 40.0, ((0.25, 4.0, 2.0), (0.4, 6.0, 2.5))
TANK, SPHERE = (1.0, (15.2, 10.0)), (0.8, np.array([31.9, 9.0, 1.5]))
OPTIONS = {"max_radius": 1.5}


def plant():
    """Return points 9 cm apart with noise of 2 mm."""
    rng = np.random.default_rng(4)
    parts = [pipe(rng, radius, LENGTH, 0.09, 0.002, (1, 0, 0)) + [22, y, z] for radius, y, z in PIPES]
    parts.append(pipe(rng, TANK[0], 3.0, 0.09, 0.002, (0, 0, 1), seen=0.9) + [*TANK[1], 1.6])
    away = rng.normal(size=(1000, 3))
    away /= np.linalg.norm(away, axis=1)[:, None]
    parts.append(SPHERE[1] + away * (SPHERE[0] + rng.normal(0, 0.002, (1000, 1))))
    plate = rng.uniform((2, 0.5), (42, 2.5), (10_000, 2))
    parts.append(np.column_stack([plate, rng.normal(0, 0.002, len(plate))]))
    return np.round(np.concatenate(parts) + CORNER, 4)


def as_cloud(xyz, part=slice(None)):
    return create_cloud({"xyz": xyz[part], "gps_time": np.arange(len(xyz))[part] * 1e-5}, "EPSG:25832")


@pytest.fixture(scope="module")
def points():
    return plant()


def in_tiles(xyz, folder, parts):
    for number, part in enumerate(parts):
        write_cloud(as_cloud(xyz, part), folder / f"tile{number}.las")
    options = TilesOptions(Workers(processes=1), SIDE, compressed=False)
    return run_in_tiles(INDUSTRY, sorted(folder.glob("*.las")), folder / "result", options=options, **OPTIONS)


@pytest.fixture(scope="module")
def whole(points):
    cloud = as_cloud(points)
    return run_pipeline(INDUSTRY, cloud, **OPTIONS).layers, cloud.origin


@pytest.fixture(scope="module")
def tiled(points, tmp_path_factory):
    return in_tiles(points, tmp_path_factory.mktemp("one"), [slice(None)])


def extents(layer, origin):
    """Return least and greatest coordinates (n, 6) of features, m, in a fixed order."""
    vertices = [np.concatenate(one) if isinstance(one, list) else np.atleast_2d(one) for one in layer.geometries]
    boxes = np.array([np.concatenate([one.min(axis=0), one.max(axis=0)]) for one in vertices])
    boxes += np.tile(origin - CORNER, 2)
    return boxes[np.lexsort(np.round(boxes.T, 1))]


@pytest.mark.parametrize(("name", "count", "off"), [("axes", 3, 0.01), ("centers", 1, 0.01), ("planes", 1, 0.15)])
def test_shapes_are_those_of_the_whole_cloud_each_once(whole, tiled, name, count, off):
    """Axes and centers agree within 1 cm, outlines of planes within a cell of 0.1 m and the inset of outlines.

    No block sees a whole pipe or the whole plate.
    """
    layers, origin = whole
    found, expected = extents(tiled.layers[name], tiled.survey.origin), extents(layers[name], origin)
    assert (tiled.blocks, tiled.failures) == (3, [])
    assert tiled.tries[:, 0].max() < 15
    assert len(found) == len(expected) == count
    np.testing.assert_allclose(found, expected, atol=off)


def test_pipes_are_as_long_and_wide_as_they_are(tiled):
    columns = tiled.layers["axes"].columns
    order = np.argsort(columns["radius"])
    np.testing.assert_allclose(np.array(columns["radius"])[order], [0.25, 0.4, 1.0], atol=0.002)
    np.testing.assert_allclose(np.array(columns["length"])[order], [LENGTH, LENGTH, 3.0], atol=0.05)
    assert tiled.layers["planes"].columns["area"] == pytest.approx([80.0], rel=0.05)


def test_points_refer_to_their_shapes(tiled):
    """By numbers that no two shapes share, and as many as the shapes say."""
    (path,) = tiled.tiles
    cloud = read_cloud(path)
    numbers, kinds = cloud.get("segment_id"), cloud.get("shape")
    said = {}
    for kind, name in ((1, "planes"), (2, "axes"), (3, "centers")):
        columns = tiled.layers[name].columns
        said.update(zip(columns["id"], zip([kind] * len(columns["id"]), columns["points"])))
    assert sorted(said) == [1, 2, 3, 4, 5]
    assert set(np.unique(numbers[kinds > 0]).tolist()) == set(said)
    for number, (kind, count) in said.items():
        assert set(kinds[numbers == number].tolist()) == {kind}
        assert (numbers == number).sum() == pytest.approx(count, rel=0.001)
    assert (kinds > 0).mean() > 0.98


def cuts(xyz):
    x, y = (xyz - CORNER)[:, :2].T
    yield [(x < 20) & (y < 5), (x < 20) & (y >= 5), (x >= 20) & (y < 5), (x >= 20) & (y >= 5)]
    yield [x < 18, (x > 12) & (x < 33), (x > 29) & (y < 7), x > 31]


@pytest.mark.parametrize("number", [0, pytest.param(1, marks=pytest.mark.slow)])
def test_how_the_plant_is_cut_changes_nothing(points, tiled, tmp_path, number):
    """As 4 tiles, and as 4 that overlap: but for micrometers, as sums follow the order of the points.

    Micrometers decide which corner of a cell an outline turns at.
    """
    outcome = in_tiles(points, tmp_path, list(cuts(points))[number])
    for name in tiled.layers:
        again, first = (extents(one.layers[name], one.survey.origin) for one in (outcome, tiled))
        np.testing.assert_allclose(again, first, atol=0.1 if name == "planes" else 2e-5)
    for name in ("length", "radius", "points"):
        assert outcome.layers["axes"].columns[name] == pytest.approx(tiled.layers["axes"].columns[name])


AXES = {layer.name: layer for step in INDUSTRY.steps for layer in step.stage.layers}


def joined(layer, *layers):
    """Join what blocks of 10 m next to each other found: (geometry, radius) each, cut off where windows end, at 3 m."""
    made, counts, pieces = [], [], []
    for at, one in enumerate(layers):
        number = list(range(1, len(one) + 1))
        columns = {"id": number, "radius": [radius for _, radius in one], "points": [100] * len(one)}
        columns.update(length=[np.ptp(g[:, 0]) if g.ndim > 1 else 0.0 for g, _ in one])
        columns.update(rms=[0.002] * len(one), seen=[0.5] * len(one))
        made.append(LayerFeatures([geometry for geometry, _ in one], columns))
        counts.append(dict.fromkeys(number, 60))
        ends = [(np.atleast_2d(g)[:, 0].min(), np.atleast_2d(g)[:, 0].max()) for g, _ in one]
        pieces.append(np.array([(low <= 10 * at - 3) | (high >= 10 * at + 13) for low, high in ends]))
    blocks = [Block(column, 0, 10.0) for column in range(len(layers))]
    none = [np.zeros(0, np.int32)] * len(layers)
    references = References(counts)
    kind = AXES[layer]
    found, _ = join_features(
        blocks, made, none, np.zeros(3), Monitor(), kind, references, pieces if kind.whole else None
    )
    return found, references.known


def axis(west, east, y, z=2.0):
    return np.array([[west, y, z], [east, y, z]], float)


def test_pieces_of_a_pipe_become_one_and_pipes_beside_each_other_do_not():
    """Three pieces of a pipe, one next to it, one inside it, as in insulation, and one behind a gap in its line."""
    one = [(axis(0, 13, 5.0), 0.1), (axis(0, 13, 5.3), 0.1), (axis(0, 13, 5.0), 0.15)]
    two = [(axis(7, 23, 5.005), 0.1)]
    three = [(axis(17, 28, 5.0), 0.1), (axis(28.4, 29, 5.0), 0.1)]
    axes, known = joined("axes", one, two, three)
    assert len(axes) == 4
    long = int(np.argmax(axes.columns["length"]))
    assert axes.columns["length"][long] == pytest.approx(28)
    assert axes.columns["points"][long] == 180
    np.testing.assert_allclose(axes.geometries[long], axis(0, 28, 5.0))
    assert known[0, 1] == known[1, 1] == known[2, 1]
    assert len(set(known.values())) == 4


def test_pieces_that_share_more_than_half_are_still_pieces_of_one_pipe():
    """The middle one shares more than half of its length with the first, the last one of its own with that."""
    axes, known = joined("axes", [(axis(0, 13, 5.0), 0.1)], [(axis(7, 18, 5.0), 0.1)], [(axis(16.9, 18.7, 5.0), 0.1)])
    assert axes.columns["length"] == pytest.approx([18.7])
    assert set(known.values()) == {1}


def test_pipes_that_were_seen_whole_stay_as_they_are():
    """Two in line with a gap of 0.2 m, which another block has not seen; a piece of one is replaced by the whole."""
    one = [(axis(2, 6, 5.0), 0.1), (axis(6.2, 9, 5.0), 0.1), (axis(7.5, 13, 2.0), 0.1)]
    two = [(axis(2.5, 8.5, 5.0), 0.1), (axis(7.5, 14, 2.001), 0.1)]
    axes, known = joined("axes", one, two)
    assert sorted(axes.columns["length"]) == pytest.approx([2.8, 4, 6.5])
    assert known[0, 3] == known[1, 2]
    assert known[1, 1] == known[0, 1] != known[0, 2]


def test_a_sphere_that_two_blocks_found_comes_once():
    centers, known = joined("centers", [(np.array([9.0, 5, 1]), 2.0)], [(np.array([9.01, 5, 1]), 2.01)])
    assert len(centers) == 1
    assert centers.geometries[0].tolist() == [9, 5, 1]
    assert known == {(0, 1): 1, (1, 1): 1}
    # A smaller one within it is another one.
    assert len(joined("centers", [(np.array([9.0, 5, 1]), 2.0)], [(np.array([9.0, 5, 1]), 1.0)])[0]) == 2
