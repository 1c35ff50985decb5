"""Street scans that are off by a known vector, which is found with the number of its observations."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.facades.plan_segments import PlanSegments, facade_segments, outline_segments
from lidar_buildings.algorithms.facades.register_street import register, register_street
from lidar_buildings.algorithms.stage import LayerFeatures, Monitor
from lidar_buildings.tests.blocks import outlines, seen_from


@pytest.fixture(scope="module")
def scans():
    air, layers = seen_from("airplane")
    return air["xyz"], air["classification"], seen_from("vehicle")[0]["xyz"], layers


def walls_of(layers):
    """Return the true facades along the street as they are seen: without the ends that meet a neighbor's."""
    return facade_segments(layers["facades"])


@pytest.mark.parametrize("off", [(0.0, 0.0, 0.0), (1.4, -0.9, 0.6), (-2.2, 2.6, -1.1)])
def test_the_shift_of_true_walls_is_found_also_under_eaves(scans, off):
    """Within 4 cm of plan, although all outlines are 0.4 m before the walls, and 2 cm of height."""
    xyz, classes, street, layers = scans
    walls = walls_of(layers).moved(-np.array(off[:2]))
    ground = xyz[classes == PointClass.GROUND]
    for overhang in (0.0, 0.4):
        found = register(walls, outline_segments(outlines(overhang)), street - off, ground, 3.0)
        np.testing.assert_allclose(found.shift[:2], off[:2], atol=0.04)
        assert found.shift[2] == pytest.approx(off[2], abs=0.02)
        assert found.walls >= 4
        assert found.residual < 0.15


def test_eaves_as_wide_as_a_meter_are_no_shift(scans):
    """Taken for narrower ones, they move the scan by 0.6 m toward one side of the street."""
    xyz, classes, street, layers = scans
    off = (1.4, -0.9, 0.6)
    ground = xyz[classes == PointClass.GROUND]
    walls = walls_of(layers).moved(-np.array(off[:2]))
    found = register(walls, outline_segments(outlines(1.0)), street - off, ground, 3.0)
    np.testing.assert_allclose(found.shift[:2], off[:2], atol=0.04)
    assert found.overhang == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize(("side", "shift"), [(1.99, 0.0), (2.49, 0.25)])
def test_a_few_cells_of_ground_do_not_give_a_height(side, shift):
    """16 and 25 cells of 0.5 m: a car hides as much of the ground, and its roof is the lowest that is seen."""
    wall = PlanSegments(np.array([[10.0, 0.3]]), np.array([[20.0, 0.3]]), np.array([0]))
    outline = PlanSegments(np.array([[0.0, 0.0]]), np.array([[40.0, 0.0]]), np.array([0]))
    plan = np.stack(np.meshgrid(*2 * [np.arange(0.01, side, 0.1)]), axis=-1).reshape(-1, 2)
    level = np.column_stack([plan + [12.0, -4.0], np.zeros(len(plan))])
    found = register(wall, outline, level, level + [0, 0, 0.25], 3.0)
    assert found.shift[2] == pytest.approx(shift)


def test_facades_and_openings_of_a_scan_are_moved_onto_the_block(scans):
    xyz, classes, street, layers = scans
    off = np.array([1.2, -0.7, 0.5])
    monitor = Monitor()
    facades, openings, report = register_street(
        xyz, classes, street - off, np.zeros(len(street), np.uint8), outlines(0.2), monitor=monitor
    )
    found = np.array([report.values[name] for name in ("shift_x", "shift_y", "shift_z")])
    # Along the street only the ends of the rows determine the shift.
    np.testing.assert_allclose(found, off, atol=0.15)
    assert report.values["residual"] < 0.15
    assert report.values["walls"] >= 3
    assert report.values["ground"] > 100
    assert not monitor.warnings
    corners = np.array(layers["corners"].geometries)
    made = np.concatenate([rings[0][:-1] for rings in facades.geometries])
    assert np.median(np.linalg.norm(corners[:, None] - made, axis=2).min(axis=1)) < 0.15
    true = np.array([ring.mean(axis=0) for (ring,) in layers["openings"].geometries])
    middle = np.array([ring.mean(axis=0) for (ring,) in openings.geometries])
    assert np.median(np.linalg.norm(true[:, None] - middle, axis=2).min(axis=1)) < 0.15
    assert min(facades.columns["base"]) == pytest.approx(min(ring[0][:, 2].min() for ring in facades.geometries))


def test_walls_of_one_side_leave_the_shift_along_them_undetermined():
    """One wall before a longer outline: the shift across is found, that along stays 0."""
    wall = PlanSegments(np.array([[10.0, 0.3]]), np.array([[20.0, 0.3]]), np.array([0]))
    outline = PlanSegments(np.array([[0.0, 0.0]]), np.array([[40.0, 0.0]]), np.array([0]))
    level = np.random.default_rng(1).uniform((0, -5, 0), (40, 5, 0), (4000, 3))
    found = register(wall, outline, level, level + [0, 0, 0.25], 3.0)
    assert found.shift[0] == pytest.approx(0.0, abs=1e-6)
    # The overhang of the eaves takes its part.
    assert found.shift[1] - found.overhang == pytest.approx(-0.3, abs=0.02)
    assert found.shift[2] == pytest.approx(0.25)
    assert (found.walls, found.ends) == (1, 0)


def test_sides_of_a_bay_that_the_air_shows_displaced_hardly_move_the_scan():
    """A row of 30 by 10 m whose bay, 3 m wide and 1 m deep, the outline has 0.2 m too far east."""
    bay = np.array([[10.0, 0.0], [10.0, -1.0], [13.0, -1.0], [13.0, 0.0]])
    back = np.array([[30.0, 0.0], [30.0, 10.0], [0.0, 10.0], [0.0, 0.0]])
    ring = np.concatenate([back[-1:], bay + [0.2, 0.0], back])
    front = np.concatenate([back[-1:], bay, back[:1]])
    rows = np.array([0, 2, 4])
    walls = PlanSegments(front[rows], front[rows + 1], np.arange(3))
    level = np.random.default_rng(1).uniform((0, -5, 0), (30, 0, 0), (2000, 3))
    found = register(walls, outline_segments(LayerFeatures([[ring]], {})), level, level, 3.0)
    # Ends of the same weight would move it by 0.15 m.
    assert abs(found.shift[0]) < 0.04


def test_objects_before_the_foot_of_a_wall_do_not_make_it_longer():
    """A wall of 10 by 6 m with a car next to its foot and a tree at its top: 1.5 and 1 m high, 2 m long."""
    ring = np.array([[0, 0], [12, 0], [12, 1.5], [10, 1.5], [10, 6], [-2, 6], [-2, 5], [0, 5], [0, 0]], float)
    wall = facade_segments(LayerFeatures([[np.column_stack([ring[:, 0], np.full(len(ring), 3.0), ring[:, 1]])]], {}))
    np.testing.assert_allclose(wall.start, [[0.0, 3.0]], atol=1e-9)
    np.testing.assert_allclose(wall.end, [[10.0, 3.0]], atol=1e-9)


def test_a_scan_of_another_street_is_not_moved_and_clouds_without_ground_are_refused(scans):
    xyz, classes, street, _ = scans
    far = LayerFeatures([[ring + 500.0 for ring in rings] for rings in outlines().geometries], {})
    monitor = Monitor()
    few = street[::10]
    unknown = np.zeros(len(few), np.uint8)
    facades, _, report = register_street(xyz, classes, few, unknown, far, monitor=monitor)
    assert report.values["shift_x"] == 0.0
    assert np.isnan(report.values["residual"])
    assert "No facade lies on a footprint" in monitor.warnings[-1]
    with pytest.raises(ValueError, match="No point of the airborne cloud is called ground"):
        register_street(xyz, np.ones_like(classes), few, unknown, far)
