"""Surveys whose tiles differ, overlap, leave gaps or are damaged: worked on where that is sound, else one sentence."""

import json
import struct
from dataclasses import replace

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud import laz
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.geometry.grid import SparsePointsError
from lidar_buildings.algorithms.pipeline import Pipeline, Step
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.algorithms.stage import Monitor, stage
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.algorithms.tiling import run_in_tiles as module
from lidar_buildings.algorithms.tiling import survey_sampling
from lidar_buildings.algorithms.tiling.cutting import cut_into_tiles
from lidar_buildings.algorithms.tiling.run_in_tiles import run_in_tiles
from lidar_buildings.algorithms.tiling.survey import crs_of_survey, open_survey
from lidar_buildings.algorithms.tiling.tiled_run import TilesOptions
from lidar_buildings.algorithms.tiling.workers import Workers
from lidar_buildings.tests.las_files import made_las, random_records, vlr

QUICK = Pipeline("quick", "Quick", "Tests", "", "", "", "", (Step("clusters", "segment_clusters", {"radius": 1.0}),))
RD = 'PROJCS["RD",UNIT["metre",1],AUTHORITY["EPSG","28992"]]'
BOUNDS_AT = 179
FEET = 'PROJCS["Oregon",UNIT["foot",0.3048],AUTHORITY["EPSG","2992"]]'
OF_BLOCKS = TilesOptions(Workers(processes=1), 50.0, compressed=False)


@pytest.fixture(autouse=True)
def _quick(monkeypatch):
    monkeypatch.setitem(PIPELINES, QUICK.name, QUICK)


@pytest.fixture
def make_las(tmp_path):
    """Write a LAS file with known bytes and return its path."""

    def make(name, **contents):
        path = tmp_path / name
        raw = bytearray(made_las(**contents))
        struct.pack_into("<6d", raw, BOUNDS_AT, 600_200, 600_000, 5_000_200, 5_000_000, 200, 0)
        path.write_bytes(raw)
        return path

    return make


def run(paths, folder):
    return run_in_tiles(QUICK, paths, folder, options=OF_BLOCKS)


def tile(path, low, high, n=500, seed=0):
    """Write points on a square and return their file."""
    xyz = np.random.default_rng(seed).uniform([*low, 0], [*high, 1], (n, 3)) + [600_000, 5_000_000, 0]
    write_cloud(create_cloud({"xyz": xyz, "gps_time": np.arange(n) + 1000.0 * seed}, "EPSG:28992"), path)
    return path


def in_map(cloud):
    """Return the points of a cloud from the zero of the map."""
    return cloud.get("xyz") + cloud.origin


def crs(wkt):
    return vlr("LASF_Projection", 2112, wkt.encode() + b"\0")


def test_a_tile_that_names_no_system_is_in_that_of_the_others(make_las, tmp_path):
    files = [make_las(f"{i}.las", point_format=6, vlrs=(crs(RD),) if i else ()) for i in range(2)]
    monitor = Monitor()
    assert open_survey(files, monitor=monitor).crs.identity == "EPSG:28992"
    warned = "0.las names no coordinate reference system; it is taken to be in the system of 1.las."
    assert [one for one in monitor.warnings if "taken to be in" in one] == [warned]


def test_other_coordinate_systems_and_units_are_refused_by_name(make_las, tmp_path):
    one = make_las("one.las", point_format=6, vlrs=(crs(RD),))
    two = make_las("two.las", point_format=6, vlrs=(crs(FEET),))
    with pytest.raises(ValueError, match=r"one.las and two.las have different coordinate reference systems"):
        run([one, two], tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_tiles_of_other_scales_and_point_formats_keep_theirs(make_las, tmp_path):
    one = make_las("one.las", point_format=1, minor=2, vlrs=(crs(RD),), n=50)
    records = random_records(7, 36, 70, seed=2)
    two = make_las(
        "two.las", point_format=7, vlrs=(crs(RD),), records=records,
        scale=(0.001, 0.01, 0.01), offset=(600_100.0, 5_000_000.5, 10.0),
    )  # fmt: skip
    outcome = run([one, two], tmp_path / "out")
    assert not outcome.failures
    for source, made in zip((one, two), outcome.tiles):
        before, after = read_cloud(source), read_cloud(made)
        assert after.header.layout.point_format == before.header.layout.point_format
        np.testing.assert_array_equal(after.header.scale, before.header.scale)
        for axis in "XYZ":
            np.testing.assert_array_equal(after.points[axis], before.points[axis])
        assert after.has("cluster_id")


def test_a_gap_between_tiles_is_no_failure(tmp_path):
    paths = [tile(tmp_path / "a.las", (0, 0), (20, 20)), tile(tmp_path / "b.las", (400, 300), (420, 320), seed=1)]
    outcome = run(paths, tmp_path / "out")
    assert not outcome.failures
    assert [len(read_cloud(one)) for one in outcome.tiles] == [500, 500]


def test_what_two_tiles_have_alike_is_worked_on_once_and_written_twice(tmp_path):
    one = tile(tmp_path / "a.las", (0, 0), (20, 20))
    again = tmp_path / "b.las"
    again.write_bytes(one.read_bytes())
    outcome = run([one, again], tmp_path / "out")
    first, second = (read_cloud(path) for path in outcome.tiles)
    np.testing.assert_array_equal(first.get("cluster_id"), second.get("cluster_id"))
    np.testing.assert_array_equal(first.points["X"], second.points["X"])


@pytest.mark.parametrize(
    ("damage", "sentence"),
    [
        (lambda raw: b"", "b.las"),
        (lambda raw: raw[:100], "b.las"),
        (lambda raw: raw[:-1000], "b.las is truncated or damaged"),
    ],
    ids=["nothing", "head", "points"],
)
def test_a_tile_that_is_damaged_is_named_before_the_work(tmp_path, damage, sentence):
    good, bad = (tile(tmp_path / name, (0, 0), (20, 20)) for name in ("a.las", "b.las"))
    bad.write_bytes(damage(bad.read_bytes()))
    with pytest.raises(ValueError, match=sentence):
        run([good, bad], tmp_path / "out")
    assert not (tmp_path / "out").exists()


def without_points(laspy, path):
    """Write a tile of no points, as surveys have them where nothing was measured."""
    header = laspy.LasHeader(version="1.4", point_format=6)
    header.offsets, header.scales = [0.0] * 3, [0.01] * 3
    laspy.LasData(header).write(path)
    return path


@pytest.mark.parametrize("first", [True, False])
def test_a_tile_without_points_is_left_out_with_a_warning(laspy, tmp_path, first):
    """A tile of no points refused whole surveys; agencies deliver one for each cell of their lattice."""
    good = [tile(tmp_path / f"{name}.laz", (i * 20, 0), (i * 20 + 20, 20), seed=i) for i, name in enumerate("bc")]
    empty = without_points(laspy, tmp_path / ("a.laz" if first else "d.laz"))
    monitor = Monitor()
    outcome = run_in_tiles(QUICK, [tmp_path], tmp_path / "out", monitor, OF_BLOCKS)
    assert not outcome.failures
    assert [one.name for one in outcome.tiles] == ["b.las", "c.las"]
    assert outcome.points == 1000
    assert f"1 of 3 tiles have no points and are left out: {empty.name}." in monitor.warnings
    assert crs_of_survey([tmp_path]).identity == "EPSG:28992"
    expected = run(good, tmp_path / "expected")
    for one, other in zip(outcome.tiles, expected.tiles):
        assert one.read_bytes() == other.read_bytes()


def test_tiles_without_any_points_are_refused(laspy, tmp_path):
    paths = [without_points(laspy, tmp_path / name) for name in ("a.laz", "b.laz")]
    with pytest.raises(ValueError, match=r"None of the 2 tiles, a.laz and others, has points; choose others"):
        run(paths, tmp_path / "out")
    with pytest.raises(ValueError, match="None of the 2 tiles, a.laz and others, has points"):
        crs_of_survey(paths)
    with pytest.raises(ValueError, match=r"a.laz has no points; choose another file"):
        run(paths[:1], tmp_path / "out")


def damage_points(path):
    raw = bytearray(path.read_bytes())
    middle = len(raw) // 2
    raw[middle : middle + 4000] = b"\xff" * 4000
    path.write_bytes(raw)


def test_a_tile_whose_points_are_damaged_fails_by_name_and_the_rest_is_there(tmp_path):
    paths = [
        tile(tmp_path / f"{name}.laz", (i * 200, 0), (i * 200 + 20, 20), n=60_000, seed=i)
        for i, name in enumerate("ab")
    ]
    damage_points(paths[1])
    outcome = run(paths, tmp_path / "out")
    assert [one.name for one in outcome.tiles] == ["a.las"]
    assert any("b.laz is truncated or damaged" in failure for failure in outcome.failures)


def test_a_damaged_tile_of_a_corridor_does_not_stop_the_rest(tmp_path, monkeypatch):
    """Windows spread over the extent of the survey hold no points, so that places are taken from the files."""
    monkeypatch.setattr(survey_sampling, "_SAMPLED_WHOLE", 1000)
    corners = {"a": (0, 0), "b": (2000, 0), "c": (0, 2000)}
    paths = [
        tile(tmp_path / f"{name}.laz", low, (low[0] + 20, low[1] + 20), n=60_000, seed=i)
        for i, (name, low) in enumerate(corners.items())
    ]
    damage_points(paths[1])
    outcome = run(paths, tmp_path / "out")
    assert [one.name for one in outcome.tiles] == ["a.las", "c.las"]
    assert any("b.laz is truncated or damaged" in failure for failure in outcome.failures)


def test_a_tile_that_vanishes_during_the_run_fails_by_name(tmp_path, monkeypatch):
    paths = [tile(tmp_path / f"{name}.las", (i * 200, 0), (i * 200 + 20, 20), seed=i) for i, name in enumerate("ab")]
    run_all = module.run_all

    def removing(*given):
        paths[1].unlink(missing_ok=True)
        return run_all(*given)

    monkeypatch.setattr(module, "run_all", removing)
    outcome = run(paths, tmp_path / "out")
    assert [one.name for one in outcome.tiles] == ["a.las"]
    assert any("b.las can't be read" in failure for failure in outcome.failures)


def test_a_point_far_from_all_others_is_worked_on_with_them(tmp_path, monkeypatch):
    """A bird over the sea, alone in its block and around it: no surface can be laid through it."""
    ground = Pipeline("ground", "Ground", "Tests", "", "", "", "", (Step("ground", "classify_ground_tin"),))
    monkeypatch.setitem(PIPELINES, ground.name, ground)
    paths = [
        tile(tmp_path / "land.laz", (0, 0), (50, 50), n=2000),
        tile(tmp_path / "bird.laz", (250, 20), (251, 21), n=1),
    ]
    done = run_in_tiles(ground, paths, tmp_path / "out", options=replace(OF_BLOCKS, compressed=True))
    assert not done.failures
    assert len(read_cloud(tmp_path / "out" / "bird.laz")) == 1
    assert (read_cloud(tmp_path / "out" / "land.laz").get("classification") == 2).mean() > 0.9


def test_islands_too_far_apart_for_one_surface_are_worked_on_one_by_one(tmp_path, monkeypatch):
    ground = Pipeline("ground", "Ground", "Tests", "", "", "", "", (Step("ground", "classify_ground_tin"),))
    monkeypatch.setitem(PIPELINES, ground.name, ground)
    paths = [
        tile(tmp_path / f"{name}.laz", (west, west), (west + 40, west + 40), n=2000)
        for name, west in (("near", 0), ("far", 40_000))
    ]
    with pytest.raises(SparsePointsError):
        run_pipeline(ground, create_cloud({"xyz": np.concatenate([in_map(read_cloud(path)) for path in paths])}))
    done = run_in_tiles(ground, paths, tmp_path / "out", options=replace(OF_BLOCKS, compressed=True))
    assert not done.failures
    for path in done.tiles:
        assert (read_cloud(path).get("classification") == 2).mean() > 0.9


def house_and_meadow(folder):
    """Write two tiles 400 m apart, all points of the first called building, and return their paths."""
    paths = []
    for name, west, number in (("house", 10, 6), ("meadow", 410, 2)):
        xyz = np.random.default_rng(5).uniform([west, 10, 5], [west + 20, 30, 5.1], (2000, 3)) + [600_000, 5_000_000, 0]
        classes = np.full(2000, number, np.uint8)
        arrays = {"xyz": xyz, "classification": classes, "height_above_ground": np.full(2000, 5, np.float32)}
        paths.append(folder / f"{name}.las")
        write_cloud(create_cloud(arrays, RD), paths[-1])
    return paths


def test_that_some_blocks_have_no_building_is_no_warning(tmp_path, monkeypatch):
    """It says nothing of the survey, unless no block has any."""
    outlines = Pipeline("outlines", "Outlines", "Tests", "", "", "", "", (Step("roofs", "extract_footprints"),))
    monkeypatch.setitem(PIPELINES, outlines.name, outlines)
    paths, monitor = house_and_meadow(tmp_path), Monitor()
    outcome = run_in_tiles(outlines, paths, tmp_path / "out", monitor, OF_BLOCKS)
    assert len(next(iter(outcome.layers.values()))) == 1
    assert not [sentence for sentence in monitor.warnings if "No point is called" in sentence]
    run_in_tiles(outlines, paths[1:], tmp_path / "meadow", monitor, OF_BLOCKS)
    assert "No point is called building (class 6), so there are no footprints." in monitor.warnings


@stage("Toys", title="Toy", writes=("classification",), reach=1.0)
def classify_warned(classification, *, monitor=None):
    """Warn of buildings."""
    if (classification == 6).any():
        monitor.warn("There are buildings.")
    return classification


def test_a_warning_of_some_blocks_has_their_number(tmp_path, monkeypatch):
    warned = Pipeline("warned", "Warned", "Tests", "", "", "", "", (Step("warned", "classify_warned"),))
    monkeypatch.setitem(STAGES, "classify_warned", classify_warned.stage)
    monkeypatch.setitem(PIPELINES, warned.name, warned)
    paths, monitor = house_and_meadow(tmp_path), Monitor()
    run_in_tiles(warned, paths, tmp_path / "out", monitor, OF_BLOCKS)
    run_in_tiles(warned, paths[:1], tmp_path / "house", monitor, OF_BLOCKS)
    said = [sentence for sentence in monitor.warnings if "buildings" in sentence]
    assert said == ["In 1 of 2 blocks: There are buildings.", "There are buildings."]


def test_a_missing_tile_of_a_virtual_point_cloud_is_named(tmp_path):
    tile(tmp_path / "a.las", (0, 0), (20, 20))
    features = [{"type": "Feature", "assets": {"data": {"href": one, "roles": ["data"]}}} for one in ("a.las", "b.las")]
    vpc = tmp_path / "all.vpc"
    vpc.write_text(json.dumps({"type": "FeatureCollection", "features": features}), encoding="utf-8")
    with pytest.raises(ValueError, match=r"names the tile b.las"):
        run([vpc], tmp_path / "out")


def test_tiles_without_returns_are_worked_on(make_las, tmp_path):
    path = make_las("one.las", point_format=0, minor=2, vlrs=(crs(RD),), n=60)
    size = read_cloud(path).header.layout.dtype.itemsize
    raw = bytearray(path.read_bytes())
    # The byte of return number, number of returns and flags.
    raw[len(raw) - 60 * size + 14 :: size] = bytes(60)
    path.write_bytes(raw)
    assert not read_cloud(path).get("number_of_returns").any()
    outcome = run([path], tmp_path / "out")
    assert not outcome.failures
    assert len(read_cloud(outcome.tiles[0])) == 60


def test_bounds_that_can_not_be_are_measured(tmp_path):
    """The survey had no points in the tile, or lost those outside."""
    paths = [tile(tmp_path / "a.las", (0, 0), (20, 20)), tile(tmp_path / "b.las", (60, 0), (140, 20), seed=1)]
    raw = bytearray(paths[1].read_bytes())
    # The greatest easting.
    struct.pack_into("<d", raw, BOUNDS_AT, 600_070.0)
    paths[1].write_bytes(raw)
    outcome = run(paths, tmp_path / "out")
    assert not outcome.failures
    assert [len(read_cloud(one)) for one in outcome.tiles] == [len(read_cloud(one)) for one in paths]


def test_tiles_that_no_package_compresses_are_refused_before_the_work(make_las, tmp_path, monkeypatch):
    """Waveforms need laszip: the run failed tile by tile at its end."""
    has_backend = laz.has_backend
    monkeypatch.setattr(laz, "has_backend", lambda name: name != "Laszip" and has_backend(name))
    path = make_las("one.las", point_format=9, vlrs=(crs(RD),))
    with pytest.raises(ValueError, match="LAZ with waveforms"):
        run_in_tiles(QUICK, [path], tmp_path / "out", options=replace(OF_BLOCKS, compressed=True))
    with pytest.raises(ValueError, match="LAZ with waveforms"):
        cut_into_tiles(open_survey([path]), 50.0, tmp_path / "cut", "a", True, Monitor())
    assert not (tmp_path / "out").exists()
    assert not (tmp_path / "cut").exists()


def test_points_outside_the_bounds_of_their_header_are_not_lost_in_silence(tmp_path):
    paths = [tile(tmp_path / "a.las", (0, 0), (20, 20)), tile(tmp_path / "b.las", (60, 0), (140, 20), seed=1)]
    raw, header = bytearray(paths[1].read_bytes()), read_cloud(paths[1]).header
    # A single point in another block, which is none of those that are looked at.
    far = round((600_400.0 - header.offset[0]) / header.scale[0])
    struct.pack_into("<i", raw, header.points_at + header.layout.dtype.itemsize, far)
    paths[1].write_bytes(raw)
    outcome = run(paths, tmp_path / "out")
    assert [one.name for one in outcome.tiles] == ["a.las"]
    (failure,) = outcome.failures
    assert "points outside the bounds in its header; repair its header first" in failure
