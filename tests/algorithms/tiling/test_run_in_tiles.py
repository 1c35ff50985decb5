"""A survey in tiles gives the same result as in one file: however it is cut, stopped or damaged."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.cloud.vpc import write_vpc
from lidar_buildings.algorithms.pipeline import Pipeline, Step
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.algorithms.stage import Cancelled, Layer, LayerFeatures, Monitor, stage
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.algorithms.tiling import run_in_tiles as module
from lidar_buildings.algorithms.tiling import survey_sampling, tile_writing
from lidar_buildings.algorithms.tiling.block_plan import larger_blocks, side_of_blocks
from lidar_buildings.algorithms.tiling.run_in_tiles import run_in_tiles
from lidar_buildings.algorithms.tiling.survey import Survey
from lidar_buildings.algorithms.tiling.tile_writing import rows_of
from lidar_buildings.algorithms.tiling.tiled_run import TilesOptions
from lidar_buildings.algorithms.tiling.tiled_steps import why_whole
from lidar_buildings.algorithms.tiling.workers import Workers
from lidar_buildings.tests.builders import crown, roof
from lidar_buildings.tests.monitors import Listening

DETECT = PIPELINES["detect_buildings"]
HERE = Workers(processes=1)
# Blocks of this side (m) have edges through the houses below.
SIDE = 40.0
# Southwest corner of the survey: houses lie on edges of blocks and of tiles.
CORNER = np.array([600_010.0, 5_000_010.0, 0.0])
SIZE = 66
HOUSES = ((24, 8), (10, 24), (48, 44))
# Tests of runs, not of results, take a chain of one quick step.
QUICK = Pipeline("quick", "Quick", "Tests", "", "", "", "", (Step("clusters", "segment_clusters", {"radius": 1.0}),))


def survey():
    """Return points, GPS times and which points are roofs: three flat houses and two crowns on 66 m by 66 m."""
    rng = np.random.default_rng(3)
    plan = rng.uniform(0, SIZE, (SIZE * SIZE * 3, 2))
    under = np.zeros(len(plan), bool)
    for x, y in HOUSES:
        under |= ((plan > [x, y]) & (plan < [x + 12, y + 10])).all(axis=1)
    ground = np.column_stack([plan, rng.normal(0, 0.02, len(plan))])[~under]
    roofs = np.concatenate([roof(rng, x, y, 12, 10, 5.0, density=3.0) for x, y in HOUSES])
    crowns = np.concatenate([crown(rng, x, y) for x, y in ((50, 20), (15, 55))])
    xyz = np.concatenate([ground, roofs, crowns]) + CORNER
    is_roof = np.repeat([False, True, False], [len(ground), len(roofs), len(crowns)])
    order = rng.permutation(len(xyz))
    return np.round(xyz[order], 3), np.arange(len(xyz)) * 1e-5, is_roof[order]


@pytest.fixture(scope="module")
def points():
    return survey()


def tiles_of(folder, xyz, times, *parts):
    """Write tiles, each of the points of a mask; return their paths."""
    paths = []
    for number, part in enumerate(parts):
        paths.append(folder / f"tile{number}.las")
        write_cloud(create_cloud({"xyz": xyz[part], "gps_time": times[part]}, "EPSG:28992"), paths[-1])
    return paths


def run(paths, folder, monitor=None, pipeline=DETECT, tunables=None, **options):
    chosen = TilesOptions(**{"workers": HERE, "block_side": SIDE, "compressed": False, **options})
    return run_in_tiles(pipeline, paths, folder, monitor, chosen, **(tunables or {}))


@pytest.fixture(autouse=True)
def _quick(monkeypatch):
    """Let workers, which are in this process, know the quick chain."""
    monkeypatch.setitem(PIPELINES, QUICK.name, QUICK)


def classes_by_time(outcome):
    """Return the times of all points, ascending, with their classes and clusters."""
    clouds = [read_cloud(path) for path in outcome.tiles]
    time, classes, cluster = (
        np.concatenate([cloud.get(name) for cloud in clouds]) for name in ("gps_time", "classification", "cluster_id")
    )
    order = np.argsort(time, kind="stable")
    return time[order], classes[order], cluster[order]


@pytest.fixture(scope="module")
def whole(points, tmp_path_factory):
    """The survey from one file."""
    xyz, times, _ = points
    folder = tmp_path_factory.mktemp("whole")
    return run(tiles_of(folder, xyz, times, np.ones(len(xyz), bool)), folder / "result")


def test_roofs_are_found_and_houses_come_once(points, whole):
    _, classes, cluster = classes_by_time(whole)
    is_roof = points[2]
    assert whole.blocks == 4
    assert (classes[is_roof] == 6).mean() > 0.98
    assert (classes[~is_roof] != 6).mean() > 0.98
    assert len(whole.layers["footprints"]) == len(HOUSES)
    # A house is one cluster, though edges of blocks go through each of them.
    assert sorted(np.unique(cluster[(classes == 6) & is_roof])) == sorted(
        whole.layers["footprints"].columns["cluster_id"]
    )
    areas = whole.layers["footprints"].columns["area"]
    np.testing.assert_allclose(areas, 120, rtol=0.1)
    assert whole.layers["footprints"].columns["id"] == [1, 2, 3]


def test_blocks_report_the_same_as_the_whole_cloud(points, whole):
    xyz, times, _ = points
    cloud = create_cloud({"xyz": xyz, "gps_time": times}, "EPSG:28992")
    run_pipeline(DETECT, cloud)
    assert (classes_by_time(whole)[1] == cloud.get("classification")).mean() > 0.99


def test_a_window_grows_on_the_side_that_cuts_off_a_house_alone(tmp_path, monkeypatch):
    rng = np.random.default_rng(5)
    plan = rng.uniform(0, SIZE, (SIZE * SIZE * 4, 2))
    # From 2 m west of an edge between blocks to 32 m east of it.
    under = ((plan > [28, 12]) & (plan < [62, 22])).all(axis=1)
    ground = np.column_stack([plan, rng.normal(0, 0.02, len(plan))])[~under]
    xyz = np.round(np.concatenate([ground, roof(rng, 28, 12, 34, 10, 5.0, density=4.0)]) + CORNER, 3)
    asked = []
    window = Survey.window

    def listened(self, box, monitor=None):
        asked.append(box)
        return window(self, box, monitor)

    monkeypatch.setattr(Survey, "window", listened)
    monkeypatch.setattr(Pipeline, "reach", lambda self, tunables: 8.0)
    outcome = run(tiles_of(tmp_path, xyz, np.arange(len(xyz)) * 1e-5, np.ones(len(xyz), bool)), tmp_path / "result")
    assert len(outcome.layers["footprints"]) == 1
    west = np.array([[600_000.0, 5_000_000.0], [600_040.0, 5_000_040.0]])
    margins = [np.abs(box - west) for box in asked if (box[0] <= west[0]).all() and (box[0] >= west[0] - 8).all()]
    assert [margin[1, 0] for margin in margins if margin[1, 1] < 9] == [8, 16, 32, 64]
    assert all((margin.ravel()[[0, 1, 3]] == 8).all() for margin in margins if margin[1, 0] < 65)


def cuts(xyz):
    """Return ways to cut the survey into tiles: 9, and irregular ones that overlap by 15 m."""
    x, y = (xyz - CORNER)[:, :2].T
    yield [(x // 23 == i) & (y // 24 == j) for i in range(3) for j in range(3)]
    yield [x < 40, (x > 25) & (y < 50), (x > 25) & (y > 35)]


@pytest.mark.parametrize("number", [0, pytest.param(1, marks=pytest.mark.slow)])
def test_how_the_survey_is_cut_changes_nothing(points, whole, tmp_path, number):
    xyz, times, _ = points
    parts = list(cuts(xyz))[number]
    outcome = run(tiles_of(tmp_path, xyz, times, *parts), tmp_path / "result")
    time, classes, cluster = classes_by_time(outcome)
    one, *of_one = classes_by_time(whole)
    at = np.searchsorted(one, time)
    assert len(time) == sum(part.sum() for part in parts)
    np.testing.assert_array_equal(classes, of_one[0][at])
    np.testing.assert_array_equal(cluster, of_one[1][at])
    found, expected = outcome.layers["footprints"], whole.layers["footprints"]
    for rings, wanted in zip(found.geometries, expected.geometries):
        np.testing.assert_allclose(rings[0] + outcome.survey.origin[:2], wanted[0] + whole.survey.origin[:2], atol=1e-3)
    assert len(found) == len(expected)


def test_a_file_too_large_to_be_read_at_once_is_cut_first(points, tmp_path):
    xyz, times, _ = points
    path = tiles_of(tmp_path, xyz, times, np.ones(len(xyz), bool))
    outcome = run(path, tmp_path / "result", pipeline=QUICK, largest_file=len(xyz) - 1)
    expected = run(path, tmp_path / "expected", pipeline=QUICK)
    assert (len(outcome.tiles), len(expected.tiles)) == (4, 1)
    for found, wanted in zip(classes_by_time(outcome), classes_by_time(expected)):
        np.testing.assert_array_equal(found, wanted)
    assert sorted(p.name for p in (tmp_path / "result").iterdir()) == sorted(p.name for p in outcome.tiles)


@pytest.mark.parametrize("extent", [None, np.array([[4.0, 20.0], [30.0, 60.0]]) + CORNER[:2]])
def test_a_large_copc_file_is_cut_by_its_index(points, tmp_path, monkeypatch, extent):
    """Nothing of it is written before the tiles are; these come of a file that is cut into pieces."""
    xyz, times, _ = points
    (path,) = tiles_of(tmp_path, xyz, times, np.ones(len(xyz), bool))
    copc = tmp_path / "town.copc.laz"
    write_cloud(read_cloud(path), copc)
    expected = run([path], tmp_path / "expected", pipeline=QUICK, extent=extent, largest_file=1000)
    monkeypatch.setattr(module, "cut_into_tiles", None)
    outcome = run([copc], tmp_path / "result", pipeline=QUICK, extent=extent, largest_file=1000)
    assert not outcome.failures
    assert outcome.points == expected.points
    names = [tile.name.replace("town", "tile0") for tile in outcome.tiles]
    assert sorted(names) == sorted(tile.name for tile in expected.tiles)
    for found, wanted in zip(classes_by_time(outcome), classes_by_time(expected)):
        np.testing.assert_array_equal(found, wanted)
    assert sorted(p.name for p in (tmp_path / "result").iterdir()) == sorted(p.name for p in outcome.tiles)


def test_points_of_a_large_copc_file_that_no_block_has_are_reported(points, tmp_path, monkeypatch):
    xyz, times, _ = points
    copc = tmp_path / "town.copc.laz"
    write_cloud(create_cloud({"xyz": xyz, "gps_time": times}, "EPSG:28992"), copc)
    monkeypatch.setattr(tile_writing, "rows_of", lambda result, number: rows_of(result, number)[3:])
    outcome = run([copc], tmp_path / "result", pipeline=QUICK, largest_file=1000)
    assert outcome.failures == [
        "town.copc.laz has 12 points outside the bounds in its header; repair its header first."
    ]


def test_large_files_of_similar_names_keep_all_their_points(points, tmp_path):
    """The pieces of area.2019.las were overwritten by pieces of area.2020.las: half of the points were lost."""
    xyz, times, _ = points
    paths = []
    for number, name in enumerate(("area.2019.las", "area.2020.las")):
        paths.append(tmp_path / name)
        part = slice(number, None, 2)
        write_cloud(create_cloud({"xyz": xyz[part], "gps_time": times[part]}, "EPSG:28992"), paths[-1])
    outcome = run(paths, tmp_path / "result", pipeline=QUICK, largest_file=1000)
    assert outcome.failures == []
    written = np.concatenate([read_cloud(path).get("gps_time") for path in outcome.tiles])
    np.testing.assert_allclose(np.sort(written), np.sort(times), atol=1e-9)


def test_a_corridor_is_sampled_where_it_has_points(tmp_path, monkeypatch):
    """None of the windows that were spread over its extent had points, so that all points were read at once."""
    rng = np.random.default_rng(1)
    along = np.concatenate([rng.uniform((0, 0), (4000, 90), (9000, 2)), rng.uniform((0, 0), (90, 4000), (9000, 2))])
    xyz = np.column_stack([along, rng.normal(0, 0.02, len(along))]) + CORNER
    path = tmp_path / "corridor.las"
    write_cloud(create_cloud({"xyz": xyz, "gps_time": np.arange(len(xyz)) * 1e-3}, "EPSG:28992"), path)
    read = []
    window = Survey.window

    def listened(self, box, monitor=None):
        found = window(self, box, monitor)
        read.append((box[1, 0] - box[0, 0], 0 if found is None else len(found.cloud)))
        return found

    monkeypatch.setattr(survey_sampling, "_SAMPLED_WHOLE", 1000)
    monkeypatch.setattr(Survey, "window", listened)
    outcome = run([path], tmp_path / "result", pipeline=QUICK, block_side=4400.0)
    # Windows of 100 m are read, and blocks with the points around them.
    sampled = [count for side, count in read if side < 4400]
    assert {side for side, _ in read if side < 4400} == {100}
    assert 0 < max(sampled) < len(xyz) / 10
    assert outcome.sampling.density == pytest.approx(9000 / (4000 * 90), rel=0.3)


def test_a_point_far_off_is_named_before_a_million_blocks_are(points, tmp_path):
    xyz, times, _ = points
    far = np.append(xyz[:1000], [CORNER + (200_000.0, 200_000.0, 0.0)], axis=0)
    (path,) = tiles_of(tmp_path, far, times, np.arange(1001))
    with pytest.raises(ValueError, match=r"The 1,001 points are spread over 25,\d{3},\d{3} blocks of 40 m.*tile0\.las"):
        run([path], tmp_path / "result", pipeline=QUICK)


def test_a_tile_keeps_its_points_and_their_order(points, tmp_path):
    xyz, times, _ = points
    paths = tiles_of(tmp_path, xyz, times, xyz[:, 0] < CORNER[0] + 50, xyz[:, 0] >= CORNER[0] + 50)
    before = [path.read_bytes() for path in paths]
    outcome = run(paths, tmp_path / "result", pipeline=QUICK)
    for path, tile in zip(paths, outcome.tiles):
        np.testing.assert_array_equal(read_cloud(path).get("xyz"), read_cloud(tile).get("xyz"))
        assert tile == tmp_path / "result" / path.name
    assert [path.read_bytes() for path in paths] == before


def test_what_an_earlier_run_said_of_numbers_is_cleared_as_on_one_cloud(points, tmp_path):
    """Tiles kept the confidence and the reason of clusters that had been numbered anew."""
    xyz, times, _ = points
    cloud = create_cloud({"xyz": xyz, "gps_time": times}, "EPSG:28992")
    for name, value in {"cluster_id": 7, "confidence": 0.75, "reason": 3, "entropy": 0.5}.items():
        cloud.set(name, np.full(len(xyz), value))
    write_cloud(cloud, tmp_path / "earlier.las")
    (tile,) = run([tmp_path / "earlier.las"], tmp_path / "result", pipeline=QUICK).tiles
    whole, in_tiles = read_cloud(tmp_path / "earlier.las"), read_cloud(tile)
    run_pipeline(QUICK, whole)
    for name in ("confidence", "reason", "entropy"):
        np.testing.assert_array_equal(in_tiles.get(name), whole.get(name))
    assert np.isnan(in_tiles.get("confidence")).all()
    assert not in_tiles.get("reason").any()
    assert (in_tiles.get("entropy") == 0.5).all()


def test_several_processes_give_what_one_gives(points, whole, tmp_path, monkeypatch):
    # New processes import the package by its name, whatever the folder of the checkout is called.
    (tmp_path / "packages").mkdir()
    (tmp_path / "packages" / "lidar_buildings").symlink_to(Path(module.__file__).resolve().parents[2])
    monkeypatch.syspath_prepend(tmp_path / "packages")
    xyz, times, _ = points
    paths = tiles_of(tmp_path, xyz, times, *next(cuts(xyz)))
    outcome = run(paths, tmp_path / "result", workers=Workers(processes=2))
    for found, expected in zip(classes_by_time(outcome), classes_by_time(whole)):
        np.testing.assert_array_equal(found, expected)


def counted(monkeypatch):
    """Count the blocks that are finished: after a cancellation more of them may begin, and stop at once."""
    done = []
    work = module.work_on_block

    def count(task):
        made = work(task)
        done.append(task.block.name)
        return made

    monkeypatch.setattr(module, "work_on_block", count)
    return done


def stopped(paths, folder, done, **tunables):
    """Stop a run in the middle; return the blocks that were finished."""
    before = len(done)
    with pytest.raises(Cancelled):
        run(paths, folder, Listening(stop_at=0.5), pipeline=QUICK, block_side=10.0, tunables=tunables)
    return set(done[before:])


def test_a_stopped_run_goes_on_where_it_was(points, tmp_path, monkeypatch):
    xyz, times, _ = points
    paths = tiles_of(tmp_path, xyz, times, np.ones(len(xyz), bool))
    done = counted(monkeypatch)
    assert stopped(paths, tmp_path / "result", done)
    assert not list((tmp_path / "result").glob("*.las"))
    first, monitor = len(done), Monitor()
    outcome = run(paths, tmp_path / "result", monitor, pipeline=QUICK, block_side=10.0)
    assert first < outcome.blocks
    # Finished blocks are not worked on again.
    assert len(done) == outcome.blocks
    assert any("were worked on before" in sentence for sentence in monitor.infos)
    expected = run(paths, tmp_path / "expected", pipeline=QUICK, block_side=10.0)
    np.testing.assert_array_equal(classes_by_time(outcome)[2], classes_by_time(expected)[2])


def test_other_tunables_or_changed_files_begin_anew(points, tmp_path, monkeypatch):
    xyz, times, _ = points
    paths = tiles_of(tmp_path, xyz, times, np.ones(len(xyz), bool))
    done = counted(monkeypatch)
    first = stopped(paths, tmp_path / "result", done)
    assert stopped(paths, tmp_path / "result", done, clusters_min_points=2) & first
    tiles_of(tmp_path, xyz, times + 1, np.ones(len(xyz), bool))
    assert stopped(paths, tmp_path / "result", done) & first


def test_two_runs_into_one_folder_are_refused(points, tmp_path):
    xyz, times, _ = points
    paths = tiles_of(tmp_path, xyz, times, np.ones(len(xyz), bool))

    class Second(Monitor):
        tried = ""

        def progress(self, fraction):
            if not self.tried and fraction > 0.1:
                self.tried = "yes"
                with pytest.raises(ValueError, match="Another run is writing to"):
                    run(paths, tmp_path / "result", pipeline=QUICK)

    monitor = Second()
    run(paths, tmp_path / "result", monitor, pipeline=QUICK)
    assert monitor.tried


def test_a_block_that_fails_is_named_and_the_rest_is_there(points, tmp_path, monkeypatch):
    xyz, times, _ = points
    x = xyz[:, 0] - CORNER[0]
    paths = tiles_of(tmp_path, xyz, times, x < 40, x >= 40)
    work = module.work_on_block

    def fail(task):
        if task.block.box[0, 0] == CORNER[0] + 50:
            raise ValueError("This block is damaged.")
        return work(task)

    monkeypatch.setattr(module, "work_on_block", fail)
    outcome = run(paths, tmp_path / "result", pipeline=QUICK, block_side=10.0)
    assert [tile.name for tile in outcome.tiles] == ["tile0.las"]
    assert any("This block is damaged." in sentence for sentence in outcome.failures)
    assert any("tile1.las is not written" in sentence for sentence in outcome.failures)
    # Finished blocks stay for the next try.
    monkeypatch.setattr(module, "work_on_block", work)
    done = counted(monkeypatch)
    again = run(paths, tmp_path / "result", pipeline=QUICK, block_side=10.0)
    assert not again.failures
    assert len(done) < again.blocks


def test_folders_and_virtual_point_clouds_are_surveys_too(points, tmp_path):
    xyz, times, _ = points
    paths = tiles_of(tmp_path, xyz, times, *next(cuts(xyz)))
    write_vpc(paths, tmp_path / "all.vpc")
    of_tiles, of_folder, of_vpc = (
        classes_by_time(run(given, tmp_path / name, pipeline=QUICK))
        for given, name in ((paths, "one"), ([tmp_path], "two"), ([tmp_path / "all.vpc"], "three"))
    )
    for tiles, folder, vpc in zip(of_tiles, of_folder, of_vpc):
        np.testing.assert_array_equal(tiles, folder)
        np.testing.assert_array_equal(tiles, vpc)


def test_tiles_and_their_folder_are_checked_before_anything_runs(points, tmp_path):
    xyz, times, _ = points
    paths = tiles_of(tmp_path, xyz[:500], times[:500], np.ones(500, bool))
    with pytest.raises(ValueError, match="is in the folder"):
        run(paths, tmp_path)
    with pytest.raises(ValueError, match="is a file; choose a folder"):
        run(paths, paths[0])
    (tmp_path / "empty").mkdir()
    with pytest.raises(ValueError, match="There are no point clouds in the folder"):
        run([tmp_path / "empty"], tmp_path / "result")
    with pytest.raises(ValueError, match="has no tunable 'nonsense'"):
        run(paths, tmp_path / "result", tunables={"nonsense": 1})
    assert not why_whole(DETECT)
    assert not (tmp_path / "result").exists()


def test_progress_only_grows(points, tmp_path):
    xyz, times, _ = points
    monitor = Listening()
    run(tiles_of(tmp_path, xyz, times, np.ones(len(xyz), bool)), tmp_path / "result", monitor, pipeline=QUICK)
    assert monitor.heard == sorted(monitor.heard)
    assert monitor.heard[-1] == 1.0


@pytest.mark.parametrize("largest", [10**9, 1000])
def test_an_extent_takes_a_part_of_the_survey(tmp_path, points, largest):
    xyz, times, _ = points
    west = xyz[:, 0] < CORNER[0] + 33
    tiles = tiles_of(tmp_path, xyz, times, west, ~west)
    # Nothing of the eastern tile; the house at (10, 24) to (22, 34) and no other.
    extent = np.array([[4.0, 20.0], [30.0, 60.0]]) + CORNER[:2]
    outcome = run(tiles, tmp_path / "out", extent=extent, largest_file=largest)
    assert not outcome.failures
    inside = ((xyz[:, :2] >= extent[0]) & (xyz[:, :2] <= extent[1])).all(axis=1)
    assert outcome.points == inside.sum()
    written = np.concatenate([read_cloud(tile).get("gps_time") for tile in outcome.tiles])
    np.testing.assert_allclose(np.sort(written), times[inside])
    (house,) = outcome.layers["footprints"].geometries
    np.testing.assert_allclose(house[0].mean(axis=0) + outcome.survey.origin[:2] - CORNER[:2], [16, 29], atol=3)
    time, classes, _ = classes_by_time(outcome)
    at = np.searchsorted(time, times[inside])
    assert ((classes[at] == 6) == points[2][inside]).mean() > 0.98


def test_reviewed_buildings_stay_in_tiles_each_once(points, tmp_path):
    """The first house, over an edge of blocks, was redrawn as a part of it, and the second was deleted."""
    xyz, times, _ = points
    rings = [np.array([[x, y], [x + 8, y], [x + 8, y + 9], [x, y + 9], [x, y]], float) for x, y in HOUSES[:2]]
    decided = {"id": np.array([7, 8]), "review": ["changed", "deleted"], "note": ["mine", None]}

    def find_layers(survey):
        return {"reviewed": LayerFeatures([[ring + CORNER[:2] - survey.origin[:2]] for ring in rings], decided)}

    tiles, results = tiles_of(tmp_path, xyz, times, np.ones(len(xyz), bool)), tmp_path / "out"
    outcome = run(tiles, results, find_layers=find_layers, wanted=("footprints",))
    found = outcome.layers["footprints"]
    assert sorted(map(str, found.columns["review"])) == ["None", "changed"]
    row = found.columns["review"].index("changed")
    np.testing.assert_allclose(found.geometries[row][0] + outcome.survey.origin[:2] - CORNER[:2], rings[0], atol=1e-6)
    assert found.columns["note"][row] == "mine"
    time, classes, _ = classes_by_time(outcome)
    inside = ((xyz[:, :2] - CORNER[:2] > HOUSES[1]) & (xyz[:, :2] - CORNER[:2] < np.add(HOUSES[1], (12, 10)))).all(
        axis=1
    )
    assert not (classes[np.searchsorted(time, times[inside])] == 6).any()


@pytest.mark.parametrize(
    ("density", "halo", "side"),
    [(7.7, 80, 660), (20, 160.5, 190), (100, 80, 100), (0.01, 80, 1600), (400, 26, 60), (20_000, 26, 40), (1e6, 0, 10)],
)
def test_blocks_have_room_for_their_points(density, halo, side):
    """In a dense plant, where little is looked at around a block, it is smaller than 100 m."""
    assert side_of_blocks(density, halo) == side


def test_larger_blocks_are_advised_where_there_is_memory_for_them():
    """At 20 points per m² (190 m + 320 m)² is 7.2 times the block, (600 m + 320 m)² 2.4 times and 17 million points."""
    advice = larger_blocks(20.0, 190.0, 160.0, 340 * 20 * 925.0**2, 10_000.0)
    assert advice == (
        "Each point is worked on 7.2 times. With 600 m as 'Side of a block' it would be 2.4 times, and each process "
        "would need 5.8 GB of memory."
    )
    # Memory for no more points, and a survey so small that processes would wait for the last block.
    assert larger_blocks(20.0, 190.0, 160.0, 2e9, 10_000.0) is None
    assert larger_blocks(20.0, 190.0, 160.0, 340 * 20 * 925.0**2, 570.0) is None


@pytest.mark.parametrize(("side", "advised"), [(None, True), (100.0, False)])
def test_the_advice_reaches_the_log_unless_a_side_is_chosen(points, tmp_path, monkeypatch, side, advised):
    monkeypatch.setattr(module, "larger_blocks", lambda *_: "Larger ones.")
    xyz, times, _ = points
    paths, monitor, asked = tiles_of(tmp_path, xyz, times, np.ones(len(xyz), bool)), Monitor(), []
    monkeypatch.setattr(Workers, "count", lambda self, memory: asked.append(memory) or 1)
    run(paths, tmp_path / "result", monitor, pipeline=QUICK, block_side=side)
    assert ("Larger ones." in monitor.infos) == advised
    # Each process holds all points, as the survey is smaller than a window.
    assert set(asked) == {340 * len(xyz)}


def test_an_extent_without_points_is_refused(tmp_path, points):
    xyz, times, _ = points
    tiles = tiles_of(tmp_path, xyz, times, np.ones(len(xyz), bool))
    with pytest.raises(ValueError, match="no points within the extent"):
        run(tiles, tmp_path / "out", extent=np.array([[0.0, 0.0], [10.0, 10.0]]))


@pytest.mark.parametrize(
    ("steps", "why"),
    [
        ((Step("town", "simulate_town"),), "it reads no cloud"),
        ((*DETECT.steps[:2], Step("again", "classify_ground_tin", cloud="noise")), "works on another cloud"),
    ],
)
def test_steps_that_can_not_be_tiled_are_refused_with_the_reason(tmp_path, steps, why):
    with pytest.raises(ValueError, match=f"can't be run in tiles: .*{why}"):
        run([], tmp_path / "out", pipeline=replace(QUICK, steps=steps))


@pytest.mark.parametrize(("around", "grows"), [(1.0, False), (8.0, True)])
def test_a_window_grows_where_a_feature_ends_nearer_to_its_edge_than_points_decide_on_it(
    points, tmp_path, monkeypatch, around, grows
):
    """A box from 20 to 29 m east of the survey's corner, in a block whose window ends 6 m behind it."""

    @stage("Toys", title="Boxes", layers=(Layer("boxes", "Boxes", "Polygon", (), around=around),), reach=5.0)
    def outline_box(xyz, *, sampling=None, monitor=None):
        """Outline the part of the box that is seen."""
        ring = np.array([[20.0, 4], [29, 4], [29, 14], [20, 14], [20, 4]]) + sampling.corner
        ring = np.clip(ring, xyz[:, :2].min(axis=0), xyz[:, :2].max(axis=0))
        return LayerFeatures([[ring]] if np.ptp(ring, axis=0).all() else [], {})

    boxes = Pipeline("boxes", "Boxes", "Tests", "", "", "", "", (Step("boxes", "outline_box"),))
    monkeypatch.setitem(STAGES, "outline_box", outline_box.stage)
    monkeypatch.setitem(PIPELINES, "boxes", boxes)
    made = run(tiles_of(tmp_path, *points[:2], slice(None)), tmp_path / "out", pipeline=boxes)
    assert len(next(iter(made.layers.values()))) == 1
    assert made.tries[:, 0].max() == (10.0 if grows else 5.0)


def test_only_steps_that_the_wanted_outputs_need_are_run_in_tiles(tmp_path):
    """Tiles without footprints had them drawn in every block, and measured on the whole survey before."""
    rng = np.random.default_rng(3)
    x, y = rng.uniform(0, 60, (2, 12_000))
    z = np.where((abs(x - 30) < 5) & (abs(y - 30) < 4), 6.0, 0.0) + rng.normal(0, 0.02, len(x))
    write_cloud(create_cloud({"xyz": np.column_stack([x, y, z])}), tmp_path / "a.las")
    pipeline, made = PIPELINES["detect_buildings"], {}
    for name, wanted in (("all", None), ("cloud", ()), ("footprints", ("footprints",))):
        options = TilesOptions(workers=Workers(1), block_side=60.0, wanted=wanted)
        made[name] = run_in_tiles(pipeline, [tmp_path / "a.las"], tmp_path / name, options=options)
    classes = [read_cloud(tmp_path / name / "a.laz").get("classification") for name in made]
    assert (classes[0] == classes[1]).all()
    assert (classes[0] == classes[2]).all()
    assert not made["cloud"].layers
    assert "footprints" not in made["cloud"].seconds
    assert not made["cloud"].reports
    assert len(made["footprints"].layers["footprints"]) == len(made["all"].layers["footprints"]) == 1
    # Its numbers are given with the footprints.
    assert made["footprints"].reports["report"].values["buildings"] == 1
