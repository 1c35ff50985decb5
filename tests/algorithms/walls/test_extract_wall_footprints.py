"""Footprints of walls that were made point by point, so that every corner is known."""

import re
import tracemalloc

import numpy as np
import pytest

from lidar_buildings.algorithms.geometry.rings import signed_area
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.algorithms.walls.extract_wall_footprints import extract_wall_footprints
from lidar_buildings.algorithms.walls.wall_lines import Scale, WallLine
from lidar_buildings.algorithms.walls.wall_outline import _through_few
from lidar_buildings.tests.builders import is_inside
from lidar_buildings.tests.monitors import Listening
from lidar_buildings.tests.polygon_validity import assert_valid
from lidar_buildings.tests.villages import corner_distances, mapped, village

OVERHANG = 0.5

SHAPES = {
    "rectangle": [(0, 0), (10, 0), (10, 7), (0, 7)],
    "shed": [(0, 0), (4, 0), (4, 3), (0, 3)],
    "L": [(0, 0), (12, 0), (12, 10), (7, 10), (7, 6), (0, 6)],
    "bend": [(0, 0), (8, 0), (14, 3), (11.5, 8), (6.5, 5.5), (0, 5.5)],
    "skew": [(0, 0), (10, 0), (12, 6), (0, 6)],
    "T": [(0, 0), (14, 0), (14, 5), (10, 5), (10, 9), (5, 9), (5, 5), (0, 5)],
}


def grown(ring, by):
    """Return the corners of a polygon (counterclockwise) with every side moved outward."""
    steps = np.roll(ring, -1, 0) - ring
    ways = steps / np.hypot(*steps.T)[:, None]
    outward = np.column_stack([ways[:, 1], -ways[:, 0]])
    corners = []
    for i in range(len(ring)):
        a, b = ring[i] + by * outward[i - 1], ring[i] + by * outward[i]
        u, v = ways[i - 1], ways[i]
        share = ((b - a)[0] * v[1] - (b - a)[1] * v[0]) / (u[0] * v[1] - u[1] * v[0])
        corners.append(a + share * u)
    return np.array(corners)


def building(rng, shape, *, per_meter=10, noise=0.03, missing=(), turn=0.0, density=50):
    """Return points, roof and wall ids (1) and the true corners; walls in ``missing`` have no points."""
    ring = np.array(SHAPES.get(shape, shape), float)
    eaves = grown(ring, OVERHANG)
    low, high = eaves.min(axis=0), eaves.max(axis=0)
    roof = rng.uniform(low, high, (round(np.prod(high - low) * density), 2))
    roof = roof[is_inside(roof, [eaves])]
    walls = []
    for i, (a, b) in enumerate(zip(ring, np.roll(ring, -1, 0))):
        if i not in missing:
            share = rng.random((round(np.hypot(*(b - a)) * per_meter), 1))
            walls.append(a + share * (b - a))
    walls = np.concatenate([np.zeros((0, 2)), *walls])
    xyz = np.column_stack(
        [np.concatenate([roof, walls]), np.append(np.full(len(roof), 4.0), rng.uniform(0.4, 2.4, len(walls)))]
    )
    xyz += rng.normal(0, noise, xyz.shape)
    cos, sin = np.cos(turn), np.sin(turn)
    rotation = np.array([(cos, sin), (-sin, cos)])
    xyz[:, :2] = xyz[:, :2] @ rotation
    is_wall = np.arange(len(xyz)) >= len(roof)
    return {"xyz": xyz, "cluster_id": (~is_wall).astype(int), "wall_of": is_wall.astype(int)}, ring @ rotation


def errors(found, true):
    """Return the distance of each true corner to the nearest found one."""
    ring = found.geometries[0][0][:-1]
    return np.hypot(*(true[:, None] - ring).transpose(2, 0, 1)).min(axis=1)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(("per_meter", "noise"), [(6, 0.02), (8, 0.05), (40, 0.05)])
@pytest.mark.parametrize("turn", [0.0, 0.6])
def test_corners_are_where_walls_meet(rng, shape, per_meter, noise, turn):
    arrays, true = building(rng, shape, per_meter=per_meter, noise=noise, turn=turn)
    footprints, edges = extract_wall_footprints(**arrays)[:2]
    assert len(footprints) == 1
    assert_valid(footprints.geometries[0])
    assert len(footprints.geometries[0][0]) - 1 == len(true)
    assert errors(footprints, true).mean() < 0.05
    assert errors(footprints, true).max() < 0.2
    table = {name: column[0] for name, column in footprints.columns.items()}
    assert table["source"] == "wall"
    assert table["edges"] == table["edges_seen"] == len(true) == len(edges)
    assert table["quality"] > 0.8
    assert table["worst_quality"] >= 0.5
    assert table["deviation"] == pytest.approx(noise, rel=0.3)
    assert table["overhang"] == pytest.approx(OVERHANG, abs=0.1)
    assert table["area"] == pytest.approx(abs(signed_area(np.concatenate([true, true[:1]]))), rel=0.03)


def holed_bend(seed):
    """Return a bent house with six holes of 2 m at the eaves, and half of the points of the walls at its inner bend."""
    rng = np.random.default_rng(seed)
    arrays, true = building(rng, "bend", per_meter=5, noise=0.05)
    xy, is_wall = arrays["xyz"][:, :2], arrays["wall_of"] > 0
    eaves, side, share = grown(true, OVERHANG), rng.integers(0, 6, 6), rng.random((6, 1))
    holes = eaves[side] * (1 - share) + eaves[(side + 1) % 6] * share
    is_seen = np.hypot(*(xy[:, None] - holes).transpose(2, 0, 1)).min(axis=1) > 1.0
    direction = (true[4] - true[3]) / np.hypot(*(true[4] - true[3]))
    beside = np.abs((xy - true[4]) @ [-direction[1], direction[0]]) < 0.3
    at_bend = is_wall & (beside | (np.abs(xy[:, 1] - true[4, 1]) < 0.3))
    kept = (is_wall | is_seen) & (~at_bend | (rng.random(len(xy)) < 0.5))
    return {name: values[kept] for name, values in arrays.items()}, true


def test_a_bend_is_seldom_cut_off_where_the_roof_has_holes_and_the_walls_few_points():
    """A chord over the bend is off by 2 m and more."""
    cut = []
    for seed in range(16, 28):
        arrays, true = holed_bend(seed)
        cut.append(errors(extract_wall_footprints(**arrays)[0], true).max() > 0.5)
    assert sum(cut) <= 1


def test_a_row_of_bays_keeps_all_its_corners(rng):
    """It has dozens of lines."""
    bays = [(start + x, y) for start in range(36, -1, -6) for x, y in ((3, 7), (3, 9.5), (0, 9.5), (0, 7))]
    ring = ((0, 0), (39, 0), *bays[1:-1])
    arrays, true = building(rng, ring, per_meter=8, noise=0.04, missing=(3, 9, 17))
    footprints = extract_wall_footprints(**arrays)[0]
    assert len(footprints.geometries[0][0]) - 1 == len(true) == 28


def test_an_expected_wall_moves_to_most_of_the_points_beside_it_in_little_memory(rng):
    """A hedge before a wall that nobody saw has thousands of points: pairs of them all took gigabytes."""
    hedge = np.column_stack([rng.uniform(-5, 5, 4000), rng.uniform(-0.3, 0.3, 4000)])
    face = np.column_stack([rng.uniform(-5, 5, 3000), rng.normal(0.17, 0.01, 3000)])
    expected = WallLine(np.zeros(2), np.array([1.0, 0.0]), np.zeros(0, np.int64), np.zeros(0), np.nan, True)
    walls = np.concatenate([hedge, face])
    tracemalloc.start()
    line = _through_few(expected, 5.0, walls, Scale(0.1, 0.5))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert line.point[1] == pytest.approx(0.17, abs=0.02)
    assert peak < 200 * len(walls)


def test_points_in_one_position_show_no_wall(rng):
    """A bush in front of a wall that nobody saw: its points say nothing about the rest of the wall."""
    expected = WallLine(np.zeros(2), np.array([1.0, 0.0]), np.zeros(0, np.int64), np.zeros(0), np.nan, True)
    bush = np.column_stack([rng.uniform(2.0, 3.0, 200), rng.normal(0.2, 0.01, 200)])
    assert _through_few(expected, 5.0, bush, Scale(0.1, 0.5)) is expected
    few = np.column_stack([np.linspace(-4, 4, 5), np.full(5, 0.2)])
    assert _through_few(expected, 5.0, few, Scale(0.1, 0.5)).point[1] == pytest.approx(0.2)


def test_corners_that_are_not_square_are_made_for_a_reason():
    """Where walls are thin, an oblique line through noise would save a corner or two, and cost a house its shape."""
    arrays, true, old_map = village(density=25.0, noise=0.04, seed=102, size=90.0)
    cloud = mapped(arrays, old_map).cloud
    names = ("xyz", "cluster_id", "wall_of", "classification")
    made = extract_wall_footprints(**{name: cloud.get(name) for name in names})[0]
    distances, _ = corner_distances(made, true)
    assert len(distances) == len(true)
    assert np.concatenate(distances).mean() < 0.09


def test_right_angles_are_right_and_others_are_kept(rng):
    arrays, _ = building(rng, "L", turn=0.3)
    assert extract_wall_footprints(**arrays)[1].columns["angle"] == pytest.approx([90] * 6, abs=1e-6) or sorted(
        np.round(extract_wall_footprints(**arrays)[1].columns["angle"], 6)
    ) == [90] * 5 + [270]
    arrays, true = building(rng, "skew", per_meter=30, noise=0.02)
    angles = sorted(extract_wall_footprints(**arrays)[1].columns["angle"])
    skew = np.degrees(np.arctan2(6, 2))
    assert angles == pytest.approx([skew, 90, 90, 180 - skew], abs=0.5)
    assert angles[1:3] == pytest.approx([90, 90], abs=1e-6)


def test_an_unseen_wall_is_distinguished_from_the_roof_and_says_so(rng):
    arrays, true = building(rng, "rectangle", missing=(2,))
    footprints, edges = extract_wall_footprints(**arrays)[:2]
    assert errors(footprints, true).max() < 0.2
    assert footprints.columns["edges_seen"] == [3]
    assert footprints.columns["worst_quality"] == [0.0]
    assert sorted(edges.columns["source"]) == ["roof", "wall", "wall", "wall"]
    unseen = edges.columns["source"].index("roof")
    assert edges.columns["points"][unseen] == 0
    assert np.isnan(edges.columns["precision"][unseen])
    # It is the north wall: both ends lie 7 m north of the south wall.
    assert edges.geometries[unseen][:, 1] == pytest.approx([7, 7], abs=0.15)


def test_a_footprint_that_rests_on_one_wall_is_reported(rng):
    monitor = Monitor()
    arrays, _ = building(rng, "rectangle", missing=(1, 2, 3))
    footprints, _ = extract_wall_footprints(**arrays, min_seen=0.1, monitor=monitor)[:2]
    assert footprints.columns["source"] == ["wall"]
    assert monitor.warnings == [
        "Of 1 of 1 footprints less than half of the walls was seen; where the others are (edges of quality 0) is "
        "guessed from the edge of the roof."
    ]
    monitor = Monitor()
    extract_wall_footprints(**building(rng, "rectangle", missing=(2,))[0], monitor=monitor)
    assert not monitor.warnings


def test_edges_show_how_precise_they_are(rng):
    """The precision of an edge is its points' over the root of their number, as repeated scans confirm."""
    offsets, reported = [], []
    for _ in range(30):
        arrays, _ = building(rng, "rectangle", per_meter=8, noise=0.05)
        _, edges = extract_wall_footprints(**arrays)[:2]
        south = int(np.argmin([line[:, 1].mean() for line in edges.geometries]))
        offsets.append(edges.geometries[south][:, 1].mean())
        reported.append(edges.columns["precision"][south])
    assert np.std(offsets) == pytest.approx(np.mean(reported), rel=0.5)
    assert abs(np.mean(offsets)) < 3 * np.std(offsets) / np.sqrt(30)


@pytest.mark.parametrize("missing", [(0, 1, 2, 3), (1, 2, 3)])
def test_without_walls_or_with_one_the_outline_is_the_roofs(rng, missing):
    arrays, true = building(rng, "rectangle", missing=missing)
    monitor = Monitor()
    footprints, edges = extract_wall_footprints(**arrays, min_seen=0.3, monitor=monitor)[:2]
    assert_valid(footprints.geometries[0])
    assert footprints.columns["source"] == ["roof"]
    assert footprints.columns["edges_seen"] == [0]
    assert set(edges.columns["source"]) == {"roof"}
    assert np.isnan(footprints.columns["overhang"][0])
    assert footprints.columns["area"] == pytest.approx([11 * 8], rel=0.05)
    assert monitor.warnings == ["1 of 1 footprints are outlines of roofs, as too few of their walls were seen."]


def test_without_the_dimension_footprints_are_roofs(rng):
    arrays, _ = building(rng, "L")
    del arrays["wall_of"]
    footprints, _ = extract_wall_footprints(**arrays)[:2]
    assert footprints.columns["source"] == ["roof"]


def test_bushes_and_a_car_before_walls_change_nothing(rng):
    arrays, true = building(rng, "rectangle", per_meter=12)
    bush = np.array([3.0, -0.4, 1.0]) + rng.normal(0, 0.3, (60, 3))
    car = np.column_stack([np.full(80, 10.4), rng.uniform(2, 5, 80), rng.uniform(0.3, 1.2, 80)])
    more = np.concatenate([bush, car])
    arrays = {
        "xyz": np.concatenate([arrays["xyz"], more]),
        "cluster_id": np.append(arrays["cluster_id"], np.zeros(len(more), int)),
        "wall_of": np.append(arrays["wall_of"], np.ones(len(more), int)),
    }
    footprints, _ = extract_wall_footprints(**arrays)[:2]
    assert len(footprints.geometries[0][0]) == 5
    assert errors(footprints, true).max() < 0.1


def test_the_order_of_points_and_the_place_change_nothing(rng):
    arrays, _ = building(rng, "bend")
    expected, lines = extract_wall_footprints(**arrays)[:2]
    order = rng.permutation(len(arrays["xyz"]))
    for changed in (
        {name: values[order] for name, values in arrays.items()},
        {**arrays, "xyz": arrays["xyz"] + [2.0**19, 2.0**22, 64.0]},
    ):
        shift = changed["xyz"].min(axis=0)[:2] - arrays["xyz"].min(axis=0)[:2]
        made, edges = extract_wall_footprints(**changed)[:2]
        np.testing.assert_allclose(made.geometries[0][0] - shift, expected.geometries[0][0], atol=1e-6)
        np.testing.assert_allclose(edges.columns["quality"], lines.columns["quality"])


def test_the_seed_decides_and_nothing_else(rng):
    arrays, true = building(rng, "T", noise=0.05)
    once, again = (extract_wall_footprints(**arrays, seed=4)[0].geometries[0][0] for _ in range(2))
    np.testing.assert_array_equal(once, again)
    for seed in range(4):
        assert errors(extract_wall_footprints(**arrays, seed=seed)[0], true).max() < 0.2


def test_buildings_keep_their_numbers_and_small_ones_are_left_out(rng):
    big, true = building(rng, "rectangle")
    small, _ = building(rng, "shed")
    arrays = {
        "xyz": np.concatenate([small["xyz"] + [30, 0, 0], big["xyz"]]),
        "cluster_id": np.concatenate([7 * small["cluster_id"], 3 * big["cluster_id"]]),
        "wall_of": np.concatenate([7 * small["wall_of"], 3 * big["wall_of"]]),
    }
    footprints, edges = extract_wall_footprints(**arrays)[:2]
    assert footprints.columns["cluster_id"] == [3, 7]
    assert footprints.columns["id"] == [1, 2]
    assert edges.columns["footprint"] == [1] * 4 + [2] * 4
    assert edges.columns["edge"] == [1, 2, 3, 4] * 2
    assert extract_wall_footprints(**arrays, min_area=20.0)[0].columns["cluster_id"] == [3]


def test_tunables_have_the_described_effect(rng):
    arrays, true = building(rng, "L", missing=(1,))
    assert extract_wall_footprints(**arrays, min_seen=0.95)[0].columns["source"] == ["roof"]
    wide = extract_wall_footprints(**arrays, tolerance=0.5)[0].columns["deviation"][0]
    assert wide > extract_wall_footprints(**arrays, tolerance=0.03)[0].columns["deviation"][0]
    assert extract_wall_footprints(**arrays, max_overhang=0.3)[0].columns["overhang"] == [0.3]
    assert extract_wall_footprints(**arrays, min_length=20.0)[0].columns["source"] == ["roof"]


def test_a_recess_under_the_roof_is_inside(rng):
    """Loggias and porches deeper under a roof than its overhang elsewhere are inside, whatever walls they have."""
    shape = ((0, 0), (3, 0), (3, 2), (8, 2), (8, 0), (10, 0), (10, 7), (0, 7))
    recess, _ = building(rng, shape, per_meter=20)
    covered, true = building(rng, "rectangle")
    roof, is_wall = covered["cluster_id"] > 0, recess["wall_of"] > 0
    xyz = np.concatenate([covered["xyz"][roof], recess["xyz"][is_wall]])
    of_roof = np.repeat([1, 0], [roof.sum(), is_wall.sum()])
    found = extract_wall_footprints(xyz, of_roof, 1 - of_roof)[0]
    assert len(found.geometries[0][0]) - 1 == 4
    assert errors(found, true).max() < 0.1


@pytest.mark.parametrize(
    "roof", [np.zeros((5, 3)), np.column_stack([np.arange(9.0), np.zeros(9), np.full(9, 4.0)]), [[0.0, 0, 4]]]
)
def test_roofs_without_area_give_no_footprint(roof):
    roof = np.asarray(roof)
    footprints, edges = extract_wall_footprints(roof, np.ones(len(roof), int), np.zeros(len(roof), int))[:2]
    assert len(footprints) == len(edges) == 0


def test_a_building_that_spans_a_country_has_no_footprint_and_the_others_have(rng):
    """One point with a wrong ClusterID asked for terabytes, then ended the work on all buildings."""
    arrays, _ = building(rng, "rectangle")
    other = {name: values.copy() for name, values in arrays.items()}
    other["xyz"][:, 0] += 100
    for name in ("cluster_id", "wall_of"):
        other[name] *= 2
    stray = {name: values[:1].copy() for name, values in arrays.items()}
    stray["xyz"][:], stray["cluster_id"][:], stray["wall_of"][:] = (900_000.0, 500_000.0, 5.0), 1, 0
    together = {name: np.concatenate([part[name] for part in (arrays, other, stray)]) for name in arrays}
    monitor = Listening()
    footprints = extract_wall_footprints(**together, monitor=monitor)[0]
    assert footprints.columns["cluster_id"] == [2]
    (warning,) = monitor.warnings
    assert re.match(r"Building 1 has no footprint\. The \d+ points are spread over 900,\d+ m by 500,\d+ m", warning)


@pytest.mark.slow
def test_a_long_row_across_the_grid_is_no_mistake(rng):
    """Its box is nearly empty, and was refused as if a point lay far off."""
    row = ((0, 0), (1150, 0), (1150, 10), (0, 10))
    arrays, corners = building(rng, row, per_meter=1, turn=np.pi / 4, density=2)
    footprints, _ = extract_wall_footprints(**arrays)[:2]
    assert footprints.columns["source"] == ["wall"]
    ring = footprints.geometries[0][0][:-1]
    assert np.hypot(*(corners[:, None] - ring).transpose(2, 0, 1)).min(axis=1).max() < 0.5


def test_the_outline_of_one_building_reports_its_progress_and_can_be_stopped(rng):
    """One with sixty walls took two minutes in which nobody could stop it."""
    teeth = [(x + dx, 8 + dy) for x in (24, 12, 0) for dx, dy in ((12, 6), (6, 6), (6, 0), (0, 0))]
    arrays, _ = building(rng, ((0, 0), (36, 0), *teeth), per_meter=8, density=10)
    monitor = Listening()
    footprints, _ = extract_wall_footprints(**arrays, monitor=monitor)[:2]
    assert footprints.columns["edges"] == [14]
    assert monitor.heard == sorted(monitor.heard)
    assert 0 < monitor.heard[0] < 0.1
    assert monitor.heard[-1] == 1
    # Once for each wall found and each outline tried.
    assert len(monitor.heard) > 25
    for stop_at in (0.01, 0.35, 0.6):
        with pytest.raises(Cancelled):
            extract_wall_footprints(**arrays, monitor=Listening(stop_at))


def test_walls_without_roofs_give_no_footprint(rng):
    arrays, _ = building(rng, "rectangle")
    footprints, edges = extract_wall_footprints(arrays["xyz"], np.zeros(len(arrays["xyz"]), int), arrays["wall_of"])[:2]
    assert len(footprints) == len(edges) == 0
    assert set(footprints.columns) == {field.name for field in extract_wall_footprints.stage.layers[0].fields}


def two_houses(rng, apart, **options):
    """Return two houses of 8 m by 6 m, their walls ``apart`` (m) in one cluster, and the true corners of both."""
    (west, ring), (east, _) = (building(rng, ((0, 0), (8, 0), (8, 6), (0, 6)), **options) for _ in range(2))
    shift = np.array([8 + apart, 0.0, 0.0])
    arrays = {name: np.concatenate([west[name], east[name] + (shift if name == "xyz" else 0)]) for name in west}
    return arrays, [ring, ring + shift[:2]]


@pytest.mark.parametrize("noise", [0.02, 0.05])
def test_two_houses_with_a_lane_between_stay_two(rng, noise):
    """Eaves of 0.5 m left 0.3 m between the roofs: they were one footprint of 103.8 m², with the lane filled."""
    arrays, true = two_houses(rng, 1.3, noise=noise)
    footprints, edges, corners, report = extract_wall_footprints(**arrays)
    assert len(footprints) == 2
    assert footprints.columns["area"] == pytest.approx([48, 48], rel=0.03)
    for ring in true:
        distance = [
            np.hypot(*(ring[:, None] - rings[0][:-1]).transpose(2, 0, 1)).min(axis=1).max()
            for rings in footprints.geometries
        ]
        assert min(distance) < 0.1
    assert footprints.columns["cluster_id"] == [1, 1]
    assert edges.columns["edge"] == [1, 2, 3, 4] * 2
    assert report.values["kept_corners"] == corners.columns["outcome"].count("corner") == 8


@pytest.mark.parametrize("missing", [(1,), (1, 3)])
def test_without_both_walls_of_the_lane_nothing_is_parted(rng, missing):
    arrays, _ = two_houses(rng, 1.3, missing=missing)
    assert len(extract_wall_footprints(**arrays)[0]) == 1


def test_an_arcade_is_no_lane(rng):
    """A colonnade along the front has no house behind it, whatever wall is seen in it."""
    arrays, _ = building(rng, "rectangle", per_meter=12)
    inner = np.column_stack([rng.uniform(0, 10, 120), rng.normal(1.5, 0.02, 120), rng.uniform(0.4, 2.4, 120)])
    arrays["xyz"] = np.concatenate([arrays["xyz"], inner])
    arrays["cluster_id"] = np.append(arrays["cluster_id"], np.zeros(120, int))
    arrays["wall_of"] = np.append(arrays["wall_of"], np.ones(120, int))
    assert len(extract_wall_footprints(**arrays)[0]) == 1


def test_candidate_corners_are_the_intersections_of_all_lines(rng):
    """An L has six walls in two directions: three by three lines meet, six of them in its corners."""
    arrays, true = building(rng, "L", per_meter=20)
    _, _, corners, report = extract_wall_footprints(**arrays)
    outcome = np.array(corners.columns["outcome"])
    place = np.array(corners.geometries)
    kept = place[outcome == "corner"]
    assert len(kept) == 6
    assert np.hypot(*(true[:, None] - kept).transpose(2, 0, 1)).min(axis=1).max() < 0.1
    # Where the sides of the notch go on through the building they meet the other walls on edges.
    for meeting, is_called in (((7, 0), "on an edge"), ((12, 6), "on an edge"), ((0, 10), "off the outline")):
        nearest = np.argmin(np.hypot(*(place - meeting).T))
        assert np.hypot(*(place[nearest] - meeting)) < 0.1
        assert outcome[nearest] == is_called
    seen = np.array(corners.columns["walls_seen"]) == 2
    assert np.array(corners.columns["angle"])[seen] == pytest.approx(90, abs=0.1)
    at_corners = outcome == "corner"
    assert (np.array(corners.columns["gap"])[at_corners] < 0.5).all()
    assert np.array(corners.columns["gap"])[np.argmin(np.hypot(*(place - (0, 10)).T))] == pytest.approx(7, abs=0.5)
    assert report.values["candidates"] == len(corners)


def test_candidate_corners_give_the_reason_why_a_footprint_has_none(rng):
    arrays, _ = building(rng, "L", missing=(1,))
    assert set(extract_wall_footprints(**arrays, min_seen=0.95)[2].columns["outcome"]) == {"outline of the roof"}
    assert set(extract_wall_footprints(**arrays, min_area=500.0)[2].columns["outcome"]) == {"too small"}


def test_the_report_counts_points_at_each_step(rng):
    arrays, _ = building(rng, "rectangle")
    n, n_walls = len(arrays["xyz"]), int(arrays["wall_of"].sum())
    classes = np.full(n, 6, np.uint8)
    classes[:7], classes[7:10] = 2, 18
    report = extract_wall_footprints(**arrays, classification=classes, voxel_count=np.full(n, 3, np.uint32))[3]
    counts = [3 * n, n, n - 10, n - n_walls, n_walls]
    names = ("original_points", "points", "points_above_ground", "roof_points", "wall_points")
    assert [report.values[name] for name in names] == counts
    assert all(f"{count:,}" in report.html for count in counts)
    assert (report.values["all_outlines"], report.values["wall_outlines"]) == (1, 1)
    unknown = extract_wall_footprints(**arrays)[3]
    assert np.isnan([unknown.values["original_points"], unknown.values["points_above_ground"]]).all()
    assert "unknown" in unknown.html
