"""Windows and doors of walls that were built with them."""

import numpy as np
import pytest

from lidar_buildings.algorithms.facades.extract_openings import extract_openings
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.builders import FAR, turned
from lidar_buildings.tests.facades import street_floor, wall

# Two rows of three windows and a door, on a front of 12 m by 7 m: west, low, east, high (m).
WINDOWS = [(x, z, x + 1.2, z + 1.5) for z in (0.9, 4.2) for x in (1.4, 5.4, 9.4)]
DOOR = (3.4, 0.0, 4.4, 2.2)


def pierced(rng, boxes, width=12.0, height=7.0, density=250, depth=0.15, kept=0.3, frame=0.08):
    """Return points of a wall along y = 0, seen from the south, with a pane and its frame behind each box."""
    points = wall(rng, (0, 0), (width, 0), high=height, density=density)
    pane = wall(rng, (0, depth), (width, depth), high=height, density=density)
    is_wall, is_pane = np.ones(len(points), bool), np.zeros(len(pane), bool)
    for west, low, east, high in boxes:
        is_wall &= ~((points[:, [0, 2]] > (west, low)) & (points[:, [0, 2]] < (east, high))).all(axis=1)
        x, z = pane[:, 0], pane[:, 2]
        inside = (x > west) & (x < east) & (z > low) & (z < high)
        edge = np.minimum(np.minimum(x - west, east - x), np.minimum(z - low, high - z)) < frame
        is_pane |= inside & (edge | (rng.random(len(pane)) < kept))
    return points[is_wall], pane[is_pane]


def as_cloud(rng, wall_points, pane, with_street=True):
    """Return coordinates and segments of a wall, what is behind it, and the street before it."""
    street = street_floor(rng, 0, -4, 12, -0.05) if with_street else np.zeros((0, 3))
    xyz = np.concatenate([wall_points, pane, street])
    return xyz, np.repeat([1, 0, 0], [len(wall_points), len(pane), len(street)]).astype(np.int32)


def boxes_of(openings):
    """Return west, low, east and high (m, 4) of openings along y = 0."""
    return np.array(
        [[*ring[:, [0, 2]].min(axis=0), *ring[:, [0, 2]].max(axis=0)] for (ring,) in openings.geometries]
    ).reshape(-1, 4)


@pytest.fixture
def front(rng):
    return as_cloud(rng, *pierced(rng, [*WINDOWS, DOOR]))


def test_windows_and_doors_are_found_where_they_are(front):
    """All seven, none else, edges within 5 cm at 250 points per m²."""
    _, openings = extract_openings(*front)
    found = boxes_of(openings)
    true = np.array([*WINDOWS, DOOR])
    distance = np.abs(found[:, None] - true).max(axis=2)
    assert len(found) == 7
    assert distance.min(axis=0).max() < 0.05
    kinds = np.array(openings.columns["kind"])[distance.argmin(axis=0)]
    assert list(kinds) == ["window"] * 6 + ["door"]
    assert openings.columns["depth"] == pytest.approx([0.15] * 7, abs=0.02)


def test_rows_and_places_are_those_of_the_front(front):
    """Seen from the street, which is south, places count from the west."""
    columns = extract_openings(*front)[1].columns
    windows = [(r, p) for r, p, kind in zip(columns["row"], columns["place"], columns["kind"]) if kind == "window"]
    assert {row for row, _ in windows} == {1, 2}
    assert [p for r, p in windows if r == 2] == [1, 2, 3]
    assert max(columns["sill"]) == pytest.approx(4.2, abs=0.05)
    assert min(columns["from_left"]) == pytest.approx(1.4, abs=0.05)


def test_openings_are_holes_of_the_facade(front):
    """Area of the front, 84 m², less six windows of 1.8 m² and a door of 2.2 m²."""
    facades, openings = extract_openings(*front)
    assert len(facades.geometries[0]) == 8
    assert facades.columns["area"] == pytest.approx([84 - 10.8 - 2.2], rel=0.01)
    assert sum(openings.columns["area"]) == pytest.approx(13.0, rel=0.05)
    exterior, *holes = (np.cross(r[:-1] - r[0], r[1:] - r[0]).sum(axis=0) for r in facades.geometries[0])
    assert all(exterior @ hole < 0 for hole in holes)


def test_holes_with_nothing_behind_are_no_openings(rng):
    """A sign that was cut out of the cloud, and the shadow of a pole."""
    points, pane = pierced(rng, WINDOWS[:3])
    x, z = points[:, 0], points[:, 2]
    points = points[~((x > 2) & (x < 9) & (z > 4) & (z < 4.8)) & (np.abs(x - 8.2) > 0.15)]
    openings = extract_openings(*as_cloud(rng, points, pane))[1]
    assert len(openings) == 3


def test_recesses_are_no_openings(rng):
    """Half a meter deep from the ground to the top, and what continues behind the end of the wall."""
    points, pane = pierced(rng, [(4, -1, 7, 8)], depth=0.5, kept=1.0)
    behind = wall(rng, (12.3, 0.3), (15, 0.3), high=7)
    assert not len(extract_openings(*as_cloud(rng, points, np.concatenate([pane, behind])))[1])


def test_a_triangular_window_is_a_triangle(rng):
    """Its legs are 3 m and 2 m long."""
    _, pane = pierced(rng, [(3, 3, 6, 5)], kept=1.0)
    points = wall(rng, (0, 0), (12, 0), high=7, density=250)

    def below(xyz):
        return xyz[:, 2] - 3 <= (6 - xyz[:, 0]) * 2 / 3

    points = points[~(below(points) & (points[:, 0] > 3) & (points[:, 2] > 3))]
    openings = extract_openings(*as_cloud(rng, points, pane[below(pane)]))[1]
    assert 4 <= len(openings.geometries[0][0]) <= 8
    assert openings.columns["area"] == pytest.approx([3.0], rel=0.07)


def test_panes_beside_a_mullion_are_one_window(rng):
    points, pane = pierced(rng, [(3.0, 1.0, 3.7, 2.5), (3.8, 1.0, 4.5, 2.5), (6.0, 1.0, 6.7, 2.5)], kept=1.0)
    found = boxes_of(extract_openings(*as_cloud(rng, points, pane))[1])
    np.testing.assert_allclose(found, [[3, 1, 4.5, 2.5], [6, 1, 6.7, 2.5]], atol=0.06)


def test_a_shop_front_that_is_a_plane_of_its_own_fills_an_opening(rng):
    points, pane = pierced(rng, [(4, 0, 8, 3)], kept=1.0)
    xyz, segment_id = as_cloud(rng, points, pane)
    segment_id[len(points) : len(points) + len(pane)] = 2
    facades, openings = extract_openings(xyz, segment_id)
    assert facades.columns["id"] == [1]
    assert openings.columns["kind"] == ["door"]


def stairs(rng, west, east, height, depth=1.2, steps=4):
    """Return points of a landing before the wall and of the risers and treads that lead up to it from the south."""
    parts = []
    for step in range(steps):
        front, top = -(depth + 0.28 * step), height * (1 - step / steps)
        riser = wall(rng, (west, front), (east, front), low=top - height / steps, high=top, density=250)
        tread = rng.uniform((west, front, top), (east, front + (depth if step == 0 else 0.28), top), (200, 3))
        parts += [riser, tread]
    return np.concatenate(parts)


def test_a_door_up_two_meters_of_stairs_is_one_and_what_is_beside_it_is_not(rng):
    """A cellar window in the yard, and a tall window whose sill is as high as the door's."""
    door, cellar, tall = (3.4, 2.0, 4.4, 4.2), (6.0, 0.2, 7.2, 0.9), (9.0, 2.0, 10.2, 4.4)
    points, pane = pierced(rng, [door, cellar, tall])
    hidden = (points[:, 0] > 3.1) & (points[:, 0] < 4.7) & (points[:, 2] < 2.0)
    xyz, segment_id = as_cloud(rng, points[~hidden], np.concatenate([pane, stairs(rng, 3.1, 4.7, 2.0)]))
    openings = extract_openings(xyz, segment_id)[1]
    assert openings.columns["kind"] == ["door", "window", "window"]


def test_a_stair_seen_from_below_leads_up_by_its_risers(rng):
    points, pane = pierced(rng, [(3.4, 2.0, 4.4, 4.2)])
    hidden = (points[:, 0] > 3.1) & (points[:, 0] < 4.7) & (points[:, 2] < 2.0)
    riser = wall(rng, (3.1, -1.2), (4.7, -1.2), low=1.0, high=2.0, density=250)
    openings = extract_openings(*as_cloud(rng, points[~hidden], np.concatenate([pane, riser])))[1]
    assert openings.columns["kind"] == ["door"]
    assert boxes_of(openings)[0] == pytest.approx((3.4, 2.0, 4.4, 4.2), abs=0.05)


def test_a_door_whose_top_a_tree_hides_is_one_with_a_landing_before_it(rng):
    """Of 2.2 m the lower 1.7 m are seen."""
    points, pane = pierced(rng, [(3.4, 2.0, 4.4, 4.2)])
    hidden = (points[:, 0] > 3.1) & (points[:, 0] < 4.7) & (points[:, 2] < 2.0)
    before = np.concatenate([pane, stairs(rng, 3.1, 4.7, 2.0)])
    xyz, segment_id = as_cloud(rng, points[~hidden], before, with_street=False)
    kept = (np.abs(xyz[:, 0] - 3.9) > 0.9) | (xyz[:, 2] < 3.7) | (xyz[:, 2] > 5.0)
    openings = extract_openings(xyz[kept], segment_id[kept])[1]
    assert openings.columns["kind"] == ["door"]


def test_a_quarter_of_a_landing_shows_a_door(rng):
    """The rest lies in the shadow of a car, which hides the foot of the wall, too."""
    points, pane = pierced(rng, [(3.4, 1.0, 4.4, 3.2)])
    landing = rng.uniform((3.4, -1.2, 1.0), (3.66, -0.2, 1.0), (100, 3))
    xyz, segment_id = as_cloud(rng, points[points[:, 2] > 0.2], np.concatenate([pane, landing]), with_street=False)
    kept = (xyz[:, 0] < 3.1) | (xyz[:, 0] > 4.7) | (xyz[:, 2] > 0.99)
    assert extract_openings(xyz[kept], segment_id[kept])[1].columns["kind"] == ["door"]


def test_leaves_beside_scattered_points_of_a_wall_are_no_window(rng):
    """Above and on the left a few points of the wall are near, and it has no edge."""
    points, pane = pierced(rng, [(4.0, 2.0, 5.2, 3.5), (8.0, 2.0, 9.2, 3.5)])
    near = (points[:, 0] > 3.0) & (points[:, 0] < 6.2) & (points[:, 2] > 1.0) & (points[:, 2] < 4.5)
    beside = np.arange(0.0, 1.6, 0.2)
    left = np.column_stack([np.full(8, 3.9), np.zeros(8), 2.0 + beside])
    above = np.column_stack([3.9 + beside, np.zeros(8), np.full(8, 3.6)])
    xyz, segment_id = as_cloud(rng, np.concatenate([points[~near], left, above]), pane)
    np.testing.assert_allclose(boxes_of(extract_openings(xyz, segment_id)[1]), [(8.0, 2.0, 9.2, 3.5)], atol=0.06)


def test_openings_of_two_walls_in_nearly_one_plane_are_drawn_once(rng):
    """A front that bends by 0.8° in its middle; within 4 m of the bend its points are of either plane."""
    points, pane = pierced(rng, WINDOWS)
    xyz, segment_id = as_cloud(rng, points, pane)
    xyz[:, 1] += np.where(segment_id, np.tan(np.radians(0.8)) * np.maximum(xyz[:, 0] - 6.0, 0), 0)
    segment_id[: len(points)] = 1 + (xyz[: len(points), 0] + rng.uniform(-4, 4, len(points)) > 6.0)
    facades, openings = extract_openings(xyz, segment_id)
    assert len(facades) == 2
    assert len(openings) == 6
    assert np.abs(boxes_of(openings)[:, None] - WINDOWS).max(axis=2).min(axis=0).max() < 0.1


def test_openings_behind_a_wall_are_not_drawn(rng):
    """A second wall 0.4 m behind the first, pierced where the first is closed, and where it is pierced too."""
    points, pane = pierced(rng, [WINDOWS[0]], depth=0.7)
    inner, inner_pane = pierced(rng, WINDOWS[:3])
    inner_all = np.concatenate([inner, inner_pane]) + [0, 0.4, 0]
    xyz, segment_id = as_cloud(rng, points, np.concatenate([pane, inner_all]))
    segment_id[len(points) + len(pane) :][: len(inner)] = 2
    openings = extract_openings(xyz, segment_id)[1]
    np.testing.assert_allclose(boxes_of(openings), [WINDOWS[0]], atol=0.06)


def test_position_turn_and_order_change_nothing(front, rng):
    xyz, segment_id = front
    expected = extract_openings(xyz, segment_id)[1]
    order = rng.permutation(len(xyz))
    for moved in (xyz[order] + FAR, turned(xyz[order], 125.0)):
        columns = extract_openings(moved, segment_id[order])[1].columns
        for name in ("row", "place", "kind"):
            assert columns[name] == expected.columns[name]
        assert columns["width"] == pytest.approx(expected.columns["width"], abs=0.04)


def test_least_size_and_greatest_depth_decide(front):
    assert not len(extract_openings(*front, min_size=3.0)[1])
    assert not len(extract_openings(*front, max_depth=0.05)[1])


def test_clouds_without_facades_or_openings_are_reported(rng):
    level = street_floor(rng, 0, 0, 5, 5)
    points = wall(rng, (0, 0), (5, 0))
    for xyz, reported in (
        (level, "No segment is a vertical plane, so there are no facades; run 'Extract facades' first."),
        (
            points,
            "No opening was found in any facade: nothing lies behind the walls and is enclosed by them; openings need "
            "about 50 points per m² and frames or panes that are set back.",
        ),
    ):
        monitor = Monitor()
        assert not len(extract_openings(xyz, np.ones(len(xyz), np.int32), monitor=monitor)[1])
        assert monitor.warnings == [reported]


def test_points_that_a_cloud_holds_twice_change_no_window(rng):
    """The hull of a triangular window of few points has no vertex twice."""
    wall_points, pane = pierced(rng, [(4, 2, 8, 5)], density=60, kept=1.0)
    x, z = pane[:, 0], pane[:, 2]
    is_glass = z < 5 - 1.5 * np.abs(x - 6)
    filled = pane[~is_glass] - [0, 0.15, 0]
    xyz, segment = as_cloud(rng, np.concatenate([wall_points, filled]), pane[is_glass])
    once, twice = (extract_openings(np.repeat(xyz, n, axis=0), np.repeat(segment, n))[1] for n in (1, 2))
    assert len(once) == len(twice) == 1
    assert np.isfinite(twice.geometries[0][0]).all()
    np.testing.assert_allclose(boxes_of(twice), boxes_of(once), atol=0.15)
