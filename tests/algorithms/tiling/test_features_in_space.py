"""Facades in tiles: each once, as of the whole cloud, with the points and the windows that are theirs."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.algorithms.stage import Field, Layer, LayerFeatures, Monitor
from lidar_buildings.algorithms.tiling.blocks import Block
from lidar_buildings.algorithms.tiling.joining import References, join_features, refer_to_features
from lidar_buildings.algorithms.tiling.run_in_tiles import run_in_tiles
from lidar_buildings.algorithms.tiling.tiled_run import TilesOptions
from lidar_buildings.algorithms.tiling.workers import Workers
from lidar_buildings.tests.facades import street_floor, wall

FACADES = PIPELINES["model_facades"]
# Edges of blocks run through the fronts below, and along one of them.
SIDE = 20.0
CORNER = np.array([600_000.0, 5_000_000.0, 0.0])
# Fronts on both sides of a street of 12 m: west, east and position across it (m). The first is longer than a
# block with the points around it.
FRONTS = ((3, 50, 12), (4, 22, 24), (24, 33, 26.3))
WINDOWS = ((10, 12), (19, 21), (39, 41), (45, 47))


def street():
    """Return points of three fronts, of which the first has four windows, a house's side, and the floor between."""
    rng = np.random.default_rng(2)
    parts = [wall(rng, (west, y), (east, y), density=20) for west, east, y in FRONTS]
    parts.append(wall(rng, (50, 12), (50, 5), density=20))
    pane = wall(rng, (3, 11.8), (50, 11.8), density=20)

    def in_window(xyz):
        inside = np.any([(xyz[:, 0] > west) & (xyz[:, 0] < east) for west, east in WINDOWS], axis=0)
        return inside & (xyz[:, 2] > 1.5) & (xyz[:, 2] < 3.2)

    parts[0] = parts[0][~in_window(parts[0])]
    xyz = np.concatenate([*parts, pane[in_window(pane)], street_floor(rng, 0, 12.3, 52, 23.7, density=4)])
    classes = np.full(len(xyz), 1, np.uint8)
    classes[xyz[:, 2] < 0.2] = 2
    return np.round(xyz + CORNER, 3), classes


def as_cloud(xyz, classes, part=slice(None)):
    times = np.arange(len(xyz)) * 1e-5
    return create_cloud({"xyz": xyz[part], "classification": classes[part], "gps_time": times[part]}, "EPSG:25832")


@pytest.fixture(scope="module")
def points():
    return street()


@pytest.fixture(scope="module")
def whole(points):
    cloud = as_cloud(*points)
    return run_pipeline(FACADES, cloud), cloud.origin


def in_tiles(points, folder, parts):
    for number, part in enumerate(parts):
        write_cloud(as_cloud(*points, part), folder / f"tile{number}.las")
    options = TilesOptions(Workers(processes=1), SIDE, compressed=False)
    return run_in_tiles(FACADES, sorted(folder.glob("*.las")), folder / "result", options=options)


@pytest.fixture(scope="module")
def tiled(points, tmp_path_factory):
    return in_tiles(points, tmp_path_factory.mktemp("one"), [slice(None)])


def extents(layer, origin):
    """Return least and greatest coordinates (n, 6) of features, m, in a fixed order."""
    boxes = [np.concatenate([ring.min(axis=0), ring.max(axis=0)]) for ring, *_ in layer.geometries]
    boxes = np.array(boxes) + np.tile(origin - CORNER, 2)
    return boxes[np.lexsort(np.round(boxes.T, 1))]


@pytest.mark.parametrize("name", ["planes_facades", "openings_facades", "openings"])
def test_facades_and_openings_are_those_of_the_whole_cloud_each_once(whole, tiled, name):
    """Within 1 cm: planes are fitted to the same points, but those at corners, that random planes divide otherwise."""
    (made, origin), count = whole, {"openings": len(WINDOWS)}.get(name, len(FRONTS) + 1)
    found, expected = extents(tiled.layers[name], tiled.survey.origin), extents(made.layers[name], origin)
    assert tiled.blocks == 6
    assert len(found) == len(expected) == count
    np.testing.assert_allclose(found, expected, atol=0.01)


def test_points_refer_to_facades_and_openings_belong_to_them(tiled):
    facades, openings = tiled.layers["openings_facades"], tiled.layers["openings"]
    (path,) = tiled.tiles
    cloud = read_cloud(path)
    numbers = cloud.get("segment_id")
    assert tiled.layers["planes_facades"].columns["id"] == facades.columns["id"] == [1, 2, 3, 4]
    assert np.unique(numbers).tolist() == [0, 1, 2, 3, 4]
    xyz = cloud.get("xyz") + cloud.origin - tiled.survey.origin
    for number, (ring, *_), count in zip(facades.columns["id"], facades.geometries, facades.columns["points"]):
        own = xyz[numbers == number]
        assert (np.abs(own - np.clip(own, ring.min(axis=0), ring.max(axis=0))) < 0.1).all()
        assert len(own) == pytest.approx(count, rel=0.01)
    longest = facades.columns["id"][int(np.argmax(facades.columns["area"]))]
    assert openings.columns["facade"] == [longest] * len(WINDOWS)
    assert sorted(openings.columns["place"]) == [1, 2, 3, 4]


def cuts(xyz):
    x, y = (xyz - CORNER)[:, :2].T
    yield [(x < 28) & (y < 18), (x < 28) & (y >= 18), (x >= 28) & (y < 18), (x >= 28) & (y >= 18)]
    yield [x < 31, (x > 20) & (x < 46), x > 40]


@pytest.mark.parametrize("number", [0, pytest.param(1, marks=pytest.mark.slow)])
def test_how_the_street_is_cut_changes_nothing(points, tiled, tmp_path, number):
    """As 4 tiles, and as 3 that overlap."""
    outcome = in_tiles(points, tmp_path, list(cuts(points[0]))[number])
    for name, layer in tiled.layers.items():
        again = extents(outcome.layers[name], outcome.survey.origin)
        np.testing.assert_allclose(again, extents(layer, tiled.survey.origin), atol=1e-6)
    clouds = [[read_cloud(path) for path in one.tiles] for one in (outcome, tiled)]
    times, ids = (np.concatenate([cloud.get(name) for cloud in clouds[0]]) for name in ("gps_time", "segment_id"))
    at = np.searchsorted(clouds[1][0].get("gps_time"), times - 5e-6)
    np.testing.assert_array_equal(ids, clouds[1][0].get("segment_id")[at])


PLANES = Layer(
    "planes", "P", "Polygon", (Field("id", int, "", numbers="segment_id"), Field("rms", float, "")), deviation="rms"
)


def upright(west, east, y, low=0.0, high=4.0):
    return [np.array([[west, y, low], [east, y, low], [east, y, high], [west, y, high], [west, y, low]], float)]


def joined(*layers, declared=PLANES, known=None):
    """Join what two blocks of 10 m next to each other found, (number, geometry) each."""
    made = [
        LayerFeatures([geometry for _, geometry in one], {"id": [n for n, _ in one], "rms": [0.01] * len(one)})
        for one in layers
    ]
    blocks = [Block(column, 0, 10.0) for column in range(len(layers))]
    none = [np.zeros(0, np.int32)] * len(layers)
    references = References([{}] * len(layers), {} if known is None else known)
    return join_features(blocks, made, none, np.zeros(3), Monitor(), declared, references)


def test_walls_that_two_blocks_found_are_reported_in_space():
    """In plan they have no area. A pane 15 cm behind a wall and a storey above another are features of their own."""
    known = {}
    one = [(4, upright(6, 13, 5.0)), (7, upright(8, 9, 5.15)), (9, upright(6, 13, 5.0, 4.1, 8))]
    # Of the block in the east, whose plane is 1 cm off; it has not found the upper storey.
    other = [(1, upright(6.1, 13, 5.01)), (2, upright(8, 9, 5.15))]
    features, kept = joined(one, other, known=known)
    assert features.columns["id"] == [1, 2, 3]
    assert sorted(kept[:, :2].tolist()) == [[0, 4], [0, 7], [0, 9]]
    assert known[1, 1] == known[0, 4]
    assert known[1, 2] == known[0, 7]
    numbers = [{"segment_id": np.arange(12, dtype=np.int32)}, {"segment_id": np.array([0, 0, 0, 1], np.int32)}]
    refer_to_features(numbers, "segment_id", known)
    assert numbers[1]["segment_id"].tolist() == [0, known[0, 4], known[0, 7], 4]


def test_another_layer_of_the_same_features_calls_them_the_same():
    known = {}
    joined([(4, upright(6, 13, 5.0))], [(1, upright(6, 13, 5.0)), (2, upright(15, 19, 5.0))], known=known)
    again, _ = joined([(4, upright(6, 13, 5.0))], [(2, upright(15, 19, 5.0)), (3, upright(15, 19, 8.0))], known=known)
    assert again.columns["id"] == [known[0, 4], known[1, 2], 3]


def test_level_plates_above_one_another_are_two():
    ring = np.array([[8, 2, 0], [12, 2, 0], [12, 6, 0], [8, 6, 0], [8, 2, 0]], float)
    features, _ = joined([(1, [ring]), (2, [ring + [0, 0, 3]])], [(1, [ring + [0, 0, 3]]), (2, [ring])])
    assert sorted(rings[0][0, 2] for rings in features.geometries) == [0, 3]
