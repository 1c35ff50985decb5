"""Files that are tiles of one cloud: none gets points of another, and all have the units of the survey."""

import errno
import os
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.crs import Crs
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.pipeline import Pipeline, Step
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.algorithms.tiling import cutting, survey_sampling, tile_writing
from lidar_buildings.algorithms.tiling import run_in_tiles as run_in_tiles_module
from lidar_buildings.algorithms.tiling.cutting import cut_into_tiles
from lidar_buildings.algorithms.tiling.run_in_tiles import run_in_tiles
from lidar_buildings.algorithms.tiling.survey import open_survey
from lidar_buildings.algorithms.tiling.tiled_run import TilesOptions
from lidar_buildings.algorithms.tiling.workers import Workers
from lidar_buildings.tests.las_files import descriptor, made_las, vlr
from lidar_buildings.tests.monitors import Listening

CLUSTERS = Pipeline("quick", "Quick", "Tests", "", "", "", "", (Step("clusters", "segment_clusters", {"radius": 1.0}),))
HEIGHTS = Pipeline("heights", "Heights", "Tests", "", "", "", "", (Step("height", "compute_height_above_ground"),))
BOUNDS_AT = 179


@pytest.fixture(autouse=True)
def _known(monkeypatch):
    for pipeline in (CLUSTERS, HEIGHTS):
        monkeypatch.setitem(PIPELINES, pipeline.name, pipeline)


def run(paths, folder, pipeline=CLUSTERS, monitor=None, **options):
    chosen = TilesOptions(**{"workers": Workers(processes=1), "block_side": 50.0, "compressed": False, **options})
    return run_in_tiles(pipeline, paths, folder, monitor, chosen)


def tile(path, low, side=20.0, n=500, seed=0, epsg=28992, **dimensions):
    """Write points on a square and return their file."""
    xyz = np.random.default_rng(seed).uniform([*low, 0], [low[0] + side, low[1] + side, 1], (n, 3))
    arrays = {"xyz": xyz + [600_000, 5_000_000, 0], "gps_time": np.arange(n) + 1000.0 * seed, **dimensions}
    write_cloud(create_cloud(arrays, f"EPSG:{epsg}"), path)
    return path


def test_a_file_taken_away_before_a_run_goes_on_gives_no_other_file_its_points(tmp_path, monkeypatch):
    paths = [
        tile(tmp_path / f"{name}.las", (x, 0), seed=seed) for seed, (name, x) in enumerate(zip("abc", (0, 900, 1800)))
    ]
    # A survey too large to be measured whole has the same sampling without the file.
    monkeypatch.setattr(survey_sampling, "_SAMPLED_WHOLE", 0)
    same = open_survey(paths[1:]).box
    monkeypatch.setattr(survey_sampling, "_sample_boxes", lambda survey: [same])
    with pytest.raises(Cancelled):
        run(paths, tmp_path / "out", monitor=Listening(stop_at=0.87))
    outcome = run(paths[1:], tmp_path / "out")
    assert not outcome.failures
    expected = run(paths[1:], tmp_path / "expected")
    for found, made in zip(outcome.tiles, expected.tiles):
        np.testing.assert_array_equal(read_cloud(found).get("cluster_id"), read_cloud(made).get("cluster_id"))


def test_cells_of_a_survey_begin_at_its_least_coordinates_to_the_last_bit(tmp_path):
    """A picometer off, the points at the edge had cells of their own, and what is learned from a sample changed."""
    for seed in range(5):
        cloud = read_cloud(tile(tmp_path / f"{seed}.las", (17.3 * seed, 11.7 * seed), seed=seed))
        low = cloud.get("xyz")[:, :2].min(axis=0)
        survey = open_survey([tmp_path / f"{seed}.las"])
        np.testing.assert_array_equal(survey.corner + survey.origin[:2], low + cloud.origin[:2])
        window = survey.window(survey.box).cloud.get("xyz")
        assert (window[:, :2].min(axis=0) == survey.corner).all()


def test_heights_are_stored_in_the_unit_that_only_the_code_of_the_system_shows(tmp_path):
    # GeoKeys of EPSG:2263 (US survey feet) name no unit.
    ground = np.full(500, 2, np.uint8)
    ground[::5] = 1
    path = tile(tmp_path / "feet.las", (0, 0), epsg=2263, classification=ground)
    foot = 1200 / 3937

    in_feet = Crs(identity="EPSG:2263", horizontal=foot, vertical=foot)
    outcome = run([path], tmp_path / "out", HEIGHTS, read=lambda header: in_feet)
    assert not outcome.failures
    stored = read_cloud(outcome.tiles[0], read=lambda header: Crs())
    # Read without the database its numbers are those in the file, feet.
    z = stored.get("xyz")[:, 2]
    assert np.abs(stored.get("height_above_ground")).max() > 0.5 * np.ptp(z)


def test_matched_images_are_known_as_such(tmp_path):
    one = {"return_number": np.ones(500, np.uint8), "number_of_returns": np.ones(500, np.uint8)}
    two = {"return_number": np.ones(500, np.uint8), "number_of_returns": np.full(500, 2, np.uint8)}
    images = [tile(tmp_path / f"{x}.las", (x, 0), seed=x, **one) for x in (0, 20)]
    scan = tile(tmp_path / "scan.las", (40, 0), seed=3, **two)
    assert run(images, tmp_path / "images").sampling.single_returns
    assert not run([*images, scan], tmp_path / "both").sampling.single_returns


def test_the_sampling_of_a_dense_survey_takes_no_more_points_than_that_of_a_small_one(tmp_path, monkeypatch):
    path = tile(tmp_path / "dense.las", (0, 0), side=60.0, n=40_000)
    monkeypatch.setattr(survey_sampling, "_SAMPLED_WHOLE", 4000)
    survey = open_survey([path])
    boxes = survey_sampling._sample_boxes(survey)
    assert len(boxes) > 8
    counts = [len(window.cloud) for window in map(survey.window, boxes) if window is not None]
    assert 1000 < sum(counts) < 6000


def test_writing_a_tile_stops_when_the_run_does(tmp_path, monkeypatch):
    path = tile(tmp_path / "a.las", (0, 0))
    write = tile_writing.write_tile

    def cancelled(task):
        task.stop.touch()
        return write(task)

    monkeypatch.setattr(tile_writing, "write_tile", cancelled)
    with pytest.raises(Cancelled):
        run([path], tmp_path / "out")
    assert not (tmp_path / "out" / "a.las").exists()


def test_names_that_some_systems_take_for_one_are_separated(tmp_path):
    folders = [tmp_path / one for one in ("one", "two")]
    for folder in folders:
        folder.mkdir()
    paths = [tile(folders[0] / "Tile.las", (0, 0)), tile(folders[1] / "tile.las", (30, 0), seed=1)]
    assert [made.name for made in run(paths, tmp_path / "out").tiles] == ["Tile.las", "tile_2.las"]


def test_no_piece_of_a_large_file_has_the_name_of_another_file(tmp_path):
    """The second one written won, and thousands of points were lost without a word."""
    cloud = read_cloud(tile(tmp_path / "a.las", (0, 0), side=40.0))
    write_cloud(cloud, tmp_path / "a.copc.laz")
    (tmp_path / "a.las").unlink()
    paths = [tmp_path / "a.copc.laz", tile(tmp_path / "A_600000_5000000.las", (100, 0), n=300, seed=1)]
    outcome = run(paths, tmp_path / "out", largest_file=400, block_side=20.0)
    assert not outcome.failures
    assert len({path.name.lower() for path in outcome.tiles}) == 5
    assert sum(len(read_cloud(path)) for path in outcome.tiles) == outcome.points == 800


def test_tiles_of_one_name_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(tile_writing, "unique_stems", lambda sources, _: ["Tile", "tile"][: len(list(sources))])
    paths = [tile(tmp_path / "a.las", (0, 0)), tile(tmp_path / "b.las", (30, 0), seed=1)]
    with pytest.raises(ValueError, match=r"2 tiles would be written to .*tile\.las; give the files"):
        run(paths, tmp_path / "out")
    assert not list((tmp_path / "out").glob("*.las"))


def test_points_that_are_in_no_tile_are_a_failure(tmp_path, monkeypatch):
    write = tile_writing.write_tile

    def overwritten(task):
        made = write(task)
        if task.source.path.name == "b.las":
            made.path.write_bytes((tmp_path / "out" / "a.las").read_bytes())
        return made

    monkeypatch.setattr(tile_writing, "write_tile", overwritten)
    paths = [tile(tmp_path / "a.las", (0, 0)), tile(tmp_path / "b.las", (30, 0), n=400, seed=1)]
    assert run(paths, tmp_path / "out").failures == ["b.las has 500 points of the 400 written to it."]


def test_a_cut_that_leaves_points_out_is_refused(tmp_path, monkeypatch):
    path = tile(tmp_path / "a.las", (0, 0))
    half = [(0, np.array(next(iter(cutting.chunks_near(path, *chunk)))[1][:250])) for chunk in [_chunk(path)]]
    monkeypatch.setattr(cutting, "chunks_near", lambda *_: iter(half))
    with pytest.raises(ValueError, match="would have 250 of the 500 points; nothing was written"):
        cut_into_tiles(open_survey([path]), 10.0, tmp_path / "cut", "tile", False, Monitor())
    assert not (tmp_path / "cut").exists()


def _chunk(path):
    survey = open_survey([path])
    return survey.sources[0].header, survey.box, Monitor()


@pytest.mark.parametrize("when", ["blocks", "tiles"])
def test_a_file_that_changes_during_a_run_fails_by_name(tmp_path, monkeypatch, when):
    """With its points in another order half of the classes were wrong, and nothing was said."""
    paths = [tile(tmp_path / "a.las", (0, 0)), tile(tmp_path / "b.las", (200, 0), seed=1)]
    module = run_in_tiles_module if when == "blocks" else tile_writing
    run_all = module.run_all

    def changing(*given):
        cloud = read_cloud(paths[1])
        write_cloud(cloud.take(np.arange(len(cloud))[::-1]), tmp_path / "c.las")
        (tmp_path / "c.las").replace(paths[1])
        return run_all(*given)

    with monkeypatch.context() as patch:
        patch.setattr(module, "run_all", changing)
        outcome = run(paths, tmp_path / "out")
    assert [one.name for one in outcome.tiles] == ["a.las"]
    assert any("b.las has changed since the run began; run it again" in failure for failure in outcome.failures)
    again = run(paths, tmp_path / "out")
    expected = run(paths, tmp_path / "expected")
    assert not again.failures
    assert [one.read_bytes() for one in again.tiles] == [one.read_bytes() for one in expected.tiles]


def test_a_file_that_changes_while_it_is_cut_is_refused(tmp_path, monkeypatch):
    path, chunks_near = tile(tmp_path / "a.las", (0, 0)), cutting.chunks_near

    def changing(*given):
        yield from chunks_near(*given)
        os.utime(path, ns=(0, 0))

    monkeypatch.setattr(cutting, "chunks_near", changing)
    with pytest.raises(ValueError, match="a.las has changed since the run began"):
        cut_into_tiles(open_survey([path]), 10.0, tmp_path / "cut", "tile", False, Monitor())


def test_a_link_among_the_tiles_is_replaced(tmp_path):
    """Its target, somebody's text, became a point cloud."""
    path, diary, out = tile(tmp_path / "a.las", (0, 0)), tmp_path / "diary.txt", tmp_path / "out"
    diary.write_text("mine")
    out.mkdir()
    (out / "a.las").symlink_to(diary)
    assert not run([path], out).failures
    assert diary.read_text() == "mine"
    assert len(read_cloud(out / "a.las")) == 500
    assert not (out / "a.las").is_symlink()


def test_the_folder_of_what_is_shown_is_no_link_and_has_no_input(tmp_path):
    """The COPC files for QGIS went through the link, and in the place of an input of their name."""
    path, out, elsewhere = tile(tmp_path / "a.las", (0, 0)), tmp_path / "out", tmp_path / "elsewhere"
    for folder in (out, elsewhere):
        folder.mkdir()
    (out / "shown").symlink_to(elsewhere)
    with pytest.raises(ValueError, match="shown is a link, which no run makes"):
        run([path], out, shown=True)
    (out / "shown").unlink()
    (out / "shown").mkdir()
    write_cloud(read_cloud(tile(tmp_path / "b.las", (30, 0), seed=1)), out / "shown" / "a.copc.laz")
    before = (out / "shown" / "a.copc.laz").read_bytes()
    with pytest.raises(ValueError, match=r"a\.copc\.laz is in the folder .*shown, where the tiles go, and is an input"):
        run([path, out / "shown" / "a.copc.laz"], out, shown=True)
    assert (out / "shown" / "a.copc.laz").read_bytes() == before


def test_cutting_keeps_fields_of_one_name_apart(tmp_path):
    twice = descriptor("Twice", 3) * 2 + descriptor("", 0, options=1) * 2
    raw = bytearray(made_las(6, extra=6, n=50, vlrs=(vlr("LASF_Spec", 4, twice),)))
    struct.pack_into("<6d", raw, BOUNDS_AT, 600_200, 600_000, 5_000_200, 5_000_000, 200, 0)
    path = tmp_path / "made.las"
    path.write_bytes(raw)
    (cut,) = cut_into_tiles(open_survey([path]), 1e7, tmp_path / "cut", "tile", False, Monitor())
    np.testing.assert_array_equal(read_cloud(cut).points, read_cloud(path).points)


def test_a_folder_that_links_to_its_files_lead_to_is_refused(tmp_path):
    raw, links = tmp_path / "raw", tmp_path / "links"
    raw.mkdir()
    links.mkdir()
    path = tile(raw / "a.las", (0, 0))
    (links / "a.las").symlink_to(path)
    before = path.read_bytes()
    with pytest.raises(ValueError, match="a.las is in the folder"):
        cut_into_tiles(open_survey([links]), 10.0, raw, "tile", False, Monitor())
    with pytest.raises(ValueError, match="a.las is in the folder"):
        run([links], raw)
    assert [(one.name, one.read_bytes()) for one in raw.iterdir()] == [("a.las", before)]


def test_a_full_disk_is_reported_of_the_folder_that_was_chosen(tmp_path, monkeypatch):
    """The message named a hidden folder in it, which is gone after the run."""
    open_file = Path.open

    def opened(path, mode="r", *args, **kwargs):
        if mode == "ab" and path.parent.parent == tmp_path / "cut":
            raise OSError(errno.ENOSPC, "No space left on device")
        return open_file(path, mode, *args, **kwargs)

    path = tile(tmp_path / "a.las", (0, 0))
    monkeypatch.setattr(Path, "open", opened)
    with pytest.raises(ValueError, match="The disk is full") as raised:
        cut_into_tiles(open_survey([path]), 10.0, tmp_path / "cut", "tile", False, Monitor())
    sentence = f"The disk is full: {tmp_path / 'cut'} was not written; free some space or choose another folder."
    assert str(raised.value) == sentence
    assert not (tmp_path / "cut").exists(), "an empty folder was left"


@pytest.mark.parametrize("fitting", [0, 2])
def test_a_survey_stops_where_the_disk_is_full(tmp_path, fitting):
    """It worked on all other blocks, whose results could not be written either, and named its last file's reason."""
    (tmp_path / "disk").mkdir()
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=200k", "tmpfs", str(tmp_path / "disk")], capture_output=True, check=False
    )
    if mounted.returncode:
        pytest.skip("this user can't mount a disk")
    path = tile(tmp_path / "a.las", (0, 0))
    try:
        (tmp_path / "disk" / "full").write_bytes(bytes(1024 * (196 - 40 * fitting)))
        with pytest.raises(ValueError, match="^The disk is full; free some space and start the same run again, which"):
            run([path], tmp_path / "disk" / "out", block_side=8.0)
        work = tmp_path / "disk" / "out" / ".lidar-buildings"
        kept = len(list(work.glob("block-*.npz")))
        assert bool(kept) == bool(fitting) == (tmp_path / "disk" / "out").exists()
        assert kept < 16
    finally:
        subprocess.run(["umount", str(tmp_path / "disk")], check=True)


def test_folders_that_are_left_empty_are_removed_and_no_others(tmp_path):
    path = tile(tmp_path / "a.las", (0, 0))
    (tmp_path / "there").mkdir()

    class Stopped(Monitor):
        def progress(self, fraction):
            raise Cancelled

    for folder in (tmp_path / "new" / "cut", tmp_path / "there", tmp_path / "there" / "cut"):
        with pytest.raises(Cancelled):
            cut_into_tiles(open_survey([path]), 10.0, folder, "tile", False, Stopped())
    assert sorted(one.name for one in tmp_path.iterdir()) == ["a.las", "there"]
    assert not list((tmp_path / "there").iterdir())


KILLED = """
import os, sys
sys.path.insert(0, sys.argv[1])
import conftest
from pathlib import Path
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.algorithms.tiling.cutting import cut_into_tiles
from lidar_buildings.algorithms.tiling.survey import open_survey

class Killed(Monitor):
    def progress(self, fraction):
        if fraction >= 0.5:
            os._exit(9)

cut_into_tiles(open_survey([Path(sys.argv[2])]), 10.0, Path(sys.argv[3]), "tile", False, Killed())
"""


def test_what_a_killed_cut_left_is_removed_by_the_next_one(tmp_path, monkeypatch):
    from lidar_buildings.algorithms.cloud import outputs

    path, folder = tile(tmp_path / "a.las", (0, 0)), tmp_path / "cut"
    killed = subprocess.run(
        [sys.executable, "-c", KILLED, str(Path(__file__).parents[3]), str(path), str(folder)], check=False
    )
    assert killed.returncode == 9
    assert [one for one in folder.iterdir() if one.is_dir()]
    monkeypatch.setattr(outputs, "_UNLOCKED", 0.0)
    tiles = cut_into_tiles(open_survey([path]), 10.0, folder, "tile", False, Monitor())
    assert sorted(folder.iterdir()) == sorted(tiles)


@pytest.mark.parametrize("kind", [".las", ".copc.laz"])
def test_a_spacing_gives_the_points_of_one_run_whatever_the_blocks(tmp_path, kind):
    """Cubes that lie on the edges of blocks have one point as well, and tiles have no others."""
    path, spacing = tile(tmp_path / f"a{kind}", (0, 0), side=100.0, n=80_000), np.array([1.3, 1.3, 1.3])
    wanted = read_cloud(path, spacing=spacing)
    outcome = run([path], tmp_path / "out", spacing=spacing, block_side=37.0)
    assert not outcome.failures
    assert outcome.points == len(wanted) < 10_000
    found = [read_cloud(one) for one in outcome.tiles]
    times = np.concatenate([one.get("gps_time") for one in found])
    np.testing.assert_array_equal(np.sort(times), np.sort(wanted.get("gps_time")))
    whole, extent = found[0], np.array([[20.0, 30.0], [60.0, 80.0]]) + [600_000, 5_000_000]
    outcome = run([path], tmp_path / "part", spacing=spacing, extent=extent, largest_file=10_000)
    times = np.concatenate([read_cloud(one).get("gps_time") for one in outcome.tiles])
    wanted = read_cloud(path, box=extent, spacing=spacing)
    np.testing.assert_array_equal(np.sort(times), np.sort(wanted.get("gps_time")))
    assert len(outcome.tiles) > 1
    assert len(whole) > len(wanted)
