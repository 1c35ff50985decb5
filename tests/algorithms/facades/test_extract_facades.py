"""Facades of walls whose corners are known."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.facades.extract_facades import extract_facades, merged_planes, split_at_gaps
from lidar_buildings.algorithms.facades.facade_outline import Drawing, key_points, outline_of, pushed_out, ring_area
from lidar_buildings.algorithms.simulation.simulate_street import simulate_street
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.tests.builders import FAR, turned
from lidar_buildings.tests.facades import corner_errors, street_floor, wall, without
from lidar_buildings.tests.real.fronts import frame_on

# A house at a street corner, 8 m by 6 m, 5 m high; the street is south and east of it.
CORNERS = np.array([[x, y, z] for x, y in ((0, 0), (8, 0), (8, 6)) for z in (0.0, 5.0)])


def classes_of(*parts):
    """Return classes for parts of a cloud, the last one being ground."""
    sizes = [len(part) for part in parts]
    return np.repeat([*[PointClass.UNCLASSIFIED] * (len(parts) - 1), PointClass.GROUND], sizes).astype(np.uint8)


@pytest.fixture
def corner(rng):
    """Two walls at a right angle, the street before them, and its classes."""
    parts = [wall(rng, (0, 0), (8, 0)), wall(rng, (8, 0), (8, 6)), street_floor(rng, -1, -4, 12, 6)]
    parts[-1] = parts[-1][(parts[-1][:, 1] < 0) | (parts[-1][:, 0] > 8)]
    return np.concatenate(parts), classes_of(*parts)


def test_corners_lie_where_they_are(corner):
    segment_id, facades = extract_facades(*corner)
    missed, invented = corner_errors(facades.geometries, CORNERS)
    assert len(facades) == 2
    assert missed.mean() < 0.03
    assert invented.max() < 0.08
    assert facades.columns["neighbors"] == [1, 1]
    assert sorted(facades.columns["area"]) == pytest.approx([30, 40], rel=0.01)
    np.testing.assert_array_equal(np.bincount(segment_id)[1:], facades.columns["points"])
    assert np.mean(segment_id[corner[1] != PointClass.GROUND] > 0) > 0.98
    assert not segment_id[corner[1] == PointClass.GROUND].any()


def test_facades_face_the_street(corner):
    """The street lies south of one facade and east of the other: azimuths of 180° and 90°."""
    columns = extract_facades(*corner)[1].columns
    assert sorted(columns["azimuth"]) == pytest.approx([90, 180], abs=0.3)
    assert columns["tilt"] == pytest.approx([0, 0], abs=0.3)


def test_rings_turn_counterclockwise_seen_from_outside(corner):
    facades = extract_facades(*corner)[1]
    for i, (ring,) in enumerate(facades.geometries):
        normal = np.cross(ring[:-1] - ring[0], ring[1:] - ring[0]).sum(axis=0)
        outward = [facades.columns[f"normal_{axis}"][i] for axis in "xyz"]
        np.testing.assert_allclose(normal / np.linalg.norm(normal), outward, atol=1e-6)


def test_neighbors_share_the_intersection_line_of_their_planes(corner):
    """Both polygons have two corners on the line, which is not changed by how far the points end before it."""
    xyz, classes = corner
    seen = ~((xyz[:, 0] > 7.8) & (xyz[:, 1] > -0.1) & (xyz[:, 1] < 0.2) & (classes != PointClass.GROUND))
    facades = extract_facades(xyz[seen], classes[seen])[1]
    one, other = (polygon[0] for polygon in facades.geometries)
    near = [ring[:-1][np.hypot(ring[:-1, 0] - 8, ring[:-1, 1]) < 0.02] for ring in (one, other)]
    assert [len(corners) for corners in near] == [2, 2]
    apart = extract_facades(xyz[seen], classes[seen], corner_distance=0.0)[1]
    gaps = [np.hypot(polygon[0][:, 0] - 8, polygon[0][:, 1]).min() for polygon in apart.geometries]
    assert min(gaps) > 0.1


def test_planes_are_those_of_a_singular_value_decomposition(corner):
    xyz, classes = corner
    segment_id, facades = extract_facades(xyz, classes)
    for i, number in enumerate(facades.columns["id"]):
        points = xyz[segment_id == number]
        off = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
        normal = [facades.columns[f"normal_{axis}"][i] for axis in "xyz"]
        assert abs(off[2][2] @ normal) == pytest.approx(1, abs=1e-9)
        assert facades.columns["rms"][i] == pytest.approx(off[1][2] / np.sqrt(len(points)), rel=1e-6)


def test_position_turn_and_order_change_nothing(corner, rng):
    xyz, classes = corner
    expected = extract_facades(xyz, classes)[1]
    order = rng.permutation(len(xyz))
    for moved, plan in ((xyz[order] + FAR, CORNERS + FAR), (turned(xyz[order], 33.0), turned(CORNERS, 33.0))):
        found = extract_facades(moved, classes[order])[1]
        missed, invented = corner_errors(found.geometries, plan)
        assert len(found) == len(expected)
        assert max(missed.max(), invented.max()) < 0.08


@pytest.mark.parametrize("boundary", ["straight edges", "key points"])
def test_boundaries_hold_their_points(corner, boundary):
    """Pushed out, no point of the facade lies more than its noise outside; the published boundary has more corners."""
    xyz, classes = corner
    segment_id, facades = extract_facades(xyz, classes, boundary=boundary, corner_distance=0.0)
    for number, (ring,) in zip(facades.columns["id"], facades.geometries):
        points = xyz[segment_id == number]
        low, high = ring.min(axis=0) - 0.05, ring.max(axis=0) + 0.05
        assert ((points >= low) & (points <= high)).all()
    corners = sum(len(polygon[0]) - 1 for polygon in facades.geometries)
    assert corners == 8 if boundary == "straight edges" else corners > 8


def test_gable_walls_keep_their_slopes(rng):
    points = wall(rng, (0, 0), (8, 0), high=8)
    points = points[points[:, 2] < 8 - np.abs(points[:, 0] - 4)]
    facades = extract_facades(points, np.zeros(len(points), np.uint8))[1]
    missed, invented = corner_errors(facades.geometries, [[0, 0, 0], [8, 0, 0], [8, 0, 4], [4, 0, 8], [0, 0, 4]])
    assert missed.mean() < 0.06
    assert invented.max() < 0.2
    # Area of the pentagon, 48 m²: the rectangle below the eaves and the triangle above them.
    assert facades.columns["area"] == pytest.approx([48.0], rel=0.01)


def test_a_curved_front_is_a_strip_of_planes_with_common_borders(rng):
    angle = np.linspace(0, np.pi / 2, 200)
    arc = np.column_stack([5 * np.sin(angle), 5 - 5 * np.cos(angle)])
    points = np.concatenate([wall(rng, a, b, density=120) for a, b in zip(arc[::4], arc[4::4])])
    facades = extract_facades(points, np.zeros(len(points), np.uint8))[1]
    assert 3 <= len(facades) <= 12
    assert min(facades.columns["neighbors"]) >= 1
    plan = np.concatenate([polygon[0][:, :2] for polygon in facades.geometries])
    assert np.abs(np.hypot(plan[:, 0], plan[:, 1] - 5) - 5).max() < 0.15


def test_recesses_and_bays_are_planes_of_their_own(rng):
    """A front of 12 m steps back by 1 m between 4 and 8 m."""
    line = [(0, 0), (4, 0), (4, 1), (8, 1), (8, 0), (12, 0)]
    points = np.concatenate([wall(rng, a, b) for a, b in zip(line, line[1:])])
    facades = extract_facades(points, np.zeros(len(points), np.uint8))[1]
    corners = [[x, y, z] for x, y in line for z in (0, 5)]
    missed, invented = corner_errors(facades.geometries, corners)
    assert len(facades) == 5
    assert missed.mean() < 0.03
    assert invented.max() < 0.1


def test_what_cars_and_trees_hide_of_foot_and_sides_is_completed(rng):
    """A car hides a corner of the foot, another a piece of it, a tree a piece of a side; a step at the top stays."""
    points = wall(rng, (0, 0), (14, 0), density=80)
    for low, high in (((-1, -1, -1), (3, 1, 1.5)), ((6, -1, -1), (9, 1, 1.4)), ((12, -1, 2), (15, 1, 3.5))):
        points = without(points, low, high)
    points = without(points, (-1, -1, 4), (5, 1, 6))
    classes = np.zeros(len(points), np.uint8)
    whole, bare = (extract_facades(points, classes, complete=complete)[1] for complete in (True, False))
    missed, invented = corner_errors(
        whole.geometries, [[0, 0, 0], [14, 0, 0], [14, 0, 5], [5, 0, 5], [5, 0, 4], [0, 0, 4]]
    )
    assert missed.max() < 0.08
    assert invented.max() < 0.08
    assert whole.columns["area"] == pytest.approx([65], rel=0.01)
    assert bare.columns["area"] == pytest.approx([65 - 4.5 - 4.2 - 3.0], rel=0.03)
    assert whole.columns["seen_share"] == pytest.approx([1 - 11.7 / 65], abs=0.02)


def test_what_a_slanting_shadow_cuts_off_is_drawn_where_its_points_are_of_the_facade(rng):
    """Cells of half a gap hang together across 1.1 m of shadow; the smaller part was not drawn."""
    points = wall(rng, (0, 0), (10, 0), high=10)
    across = (points[:, 0] - points[:, 2] + 3.0) / np.sqrt(2)
    points = points[np.abs(across) > 0.55]
    segment_id, facades = extract_facades(points, np.zeros(len(points), np.uint8), max_gap=1.0)
    assert np.unique(segment_id[segment_id > 0]).tolist() == [1]
    assert facades.columns["area"] == pytest.approx([100], rel=0.05)


def test_shadows_are_bridged_up_to_the_widest_gap(rng):
    points = wall(rng, (0, 0), (12, 0))
    points = points[np.abs(points[:, 0] - 6) > 0.4]
    classes = np.zeros(len(points), np.uint8)
    assert len(extract_facades(points, classes)[1]) == 1
    assert len(extract_facades(points, classes, max_gap=0.5)[1]) == 2


def test_what_is_low_small_or_leaning_is_no_facade(rng):
    low, leaning = wall(rng, (0, 0), (8, 0), high=1.6), wall(rng, (0, 20), (8, 20))
    leaning[:, 1] += 0.5 * leaning[:, 2]
    points = np.concatenate([low, leaning, wall(rng, (20, 0), (20.3, 0))])
    monitor = Monitor()
    segment_id, facades = extract_facades(points, np.zeros(len(points), np.uint8), monitor=monitor)
    assert not len(facades)
    assert not segment_id.any()
    assert monitor.warnings == [
        "No vertical plane of 2 m² and 2.5 m height was found, so there are no facades; lower these values, raise the "
        "maximum tilt, or use a cloud that was taken from the street or obliquely."
    ]
    assert len(extract_facades(points, np.zeros(len(points), np.uint8), max_tilt=45.0, min_height=1.0)[1]) == 2


@pytest.mark.parametrize("count", [1, 3, 5])
def test_a_few_points_or_points_on_a_line_have_no_facade(count):
    points = np.column_stack([np.zeros((count, 2)), np.arange(count)]).astype(float)
    assert not len(extract_facades(points, np.zeros(count, np.uint8))[1])


def test_one_wall_found_as_two_crossing_planes_is_joined(rng):
    points = wall(rng, (0, 0), (10, 0))
    found = np.where(points[:, 0] < 5, 1, 2)
    assert merged_planes(points, found, 0.05, Monitor()).max() == 1
    points[points[:, 0] >= 5, 1] += 0.3
    assert merged_planes(points, found, 0.05, Monitor()).max() == 2


def test_pieces_far_apart_get_numbers_of_their_own(rng):
    points = np.concatenate([wall(rng, (0, 0), (3, 0)), wall(rng, (9, 0), (12, 0))])
    pieces = split_at_gaps(points, np.ones(len(points), np.int64), 1.0)
    np.testing.assert_array_equal(np.unique(pieces), [1, 2])
    np.testing.assert_array_equal(pieces == pieces[0], points[:, 0] < 6)


def test_key_points_are_where_a_boundary_turns():
    """A square with a vertex every meter, and a kink of 20° that 30 rounds remove."""
    side = np.arange(0.0, 10.0)
    ring = np.array(
        [*[(x, 0) for x in side], *[(10, y) for y in side], *[(10 - x, 10) for x in side], *[(0, 10 - y) for y in side]]
    )
    ring[5, 1] = -np.tan(np.radians(10))
    ring = np.concatenate([ring, ring[:1]]).astype(float)
    np.testing.assert_allclose(key_points(ring), [[0, 0], [10, 0], [10, 10], [0, 10], [0, 0]])


def test_a_boundary_is_pushed_out_until_it_holds_all_positions():
    square = np.array([[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]], float)
    made = pushed_out(square, np.array([[2, -0.3], [4.2, 2], [4.2, -0.3]]), np.inf)
    np.testing.assert_allclose(made, [[0, -0.3], [4.2, -0.3], [4.2, 4], [0, 4], [0, -0.3]], atol=1e-9)
    np.testing.assert_allclose(pushed_out(square, np.array([[2, -3.0]]), 1.0), square)


def test_planes_of_one_wall_are_joined_the_largest_first():
    """Forty planes of two walls, the second 0.3 m behind the first: brute force joins the same ones."""
    rng = np.random.default_rng(3)
    number = np.repeat(np.arange(1, 41), rng.permutation(np.arange(20, 60)))
    points = np.column_stack(
        [rng.uniform(0, 2, len(number)) + number, rng.normal(0, 0.01, len(number)), np.zeros(len(number))]
    )
    points[:, 1] += np.where(number % 2 == 1, 0.3, 0.0)
    points[:, 2] = rng.uniform(0, 5, len(number))
    wall = merged_planes(points, number, 0.05, Monitor())
    largest = np.argmax(np.bincount(number))
    assert [set(number[wall == k] % 2) for k in (1, 2)] == [{largest % 2}, {1 - largest % 2}]
    assert wall.max() == 2


def test_the_search_for_one_wall_can_be_cancelled():
    class Stopped(Monitor):
        def progress(self, fraction):
            raise Cancelled

    with pytest.raises(Cancelled):
        merged_planes(np.random.default_rng(0).random((20, 3)), np.repeat([1, 2], 10), 0.1, Stopped())


def test_a_facade_narrower_than_its_tolerance_keeps_the_boundary_of_its_points(rng):
    """Sparse points of a strip 0.6 m wide: straight edges within two spacings would leave a line of it."""
    positions = np.column_stack([rng.uniform(0, 0.6, 60), np.sort(rng.uniform(0, 4.5, 60))])
    positions[::7, 1] += 0.4
    outline = outline_of(positions, Drawing(10.0, 1.0, "straight edges", True))
    assert len(outline.ring) > 3
    assert outline.seen_area <= ring_area(outline.ring) <= 1.1 * np.prod(np.ptp(positions, axis=0))


def test_walls_are_found_among_the_facade_lines_of_a_vehicle_and_a_fence_before_them_is_not():
    """A fence 3 m high is 4 m before the fronts of a simulated street; it is nearer to the scanner on its side."""
    made = simulate_street.stage.unpack(
        simulate_street(length=20.0, line_rate=30.0, angular_step=0.5, clutter=False, seed=2)
    )
    points = made.dimensions
    xyz, true = points["xyz"], points["segment_id"] > 0
    rings = [ring for (ring,) in made.layers["facades"].geometries]
    ring = max(rings, key=lambda ring: float(np.hypot(*(ring[1] - ring[0])[:2])))
    frame = frame_on(ring)
    along, up, out = frame.local(xyz).T
    # Points low on the front become points of the fence, which hides the front there.
    is_fence = true & (up < ring[0, 2] + 3.0 - frame.origin[2]) & (along > 2.0) & (along < 5.0) & (np.abs(out) < 0.1)
    outward = frame.normal
    fenced = xyz + 4.0 * is_fence[:, None] * outward
    unclassified = np.zeros(len(xyz), np.uint8)
    times = points["gps_time"], points["point_source_id"]
    everywhere, _ = extract_facades(fenced, unclassified, *times)
    in_lines, _ = extract_facades(fenced, unclassified, *times, search_in="facade lines")
    assert np.mean(everywhere[is_fence] > 0) > 0.5
    assert np.mean(in_lines[is_fence] > 0) < 0.5
    assert np.mean(in_lines[true & ~is_fence] > 0) > 0.85


def test_facade_lines_need_times(rng):
    points = wall(rng, (0, 0), (5, 0))
    with pytest.raises(ValueError, match="the cloud has no GPS time; search in all points"):
        extract_facades(points, np.zeros(len(points), np.uint8), search_in="facade lines")
