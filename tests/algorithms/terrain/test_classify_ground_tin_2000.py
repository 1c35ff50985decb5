"""The densification as published, on scenes whose ground is known by formula."""

import numpy as np
import pytest

from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.algorithms.terrain.classify_ground_tin_2000 import classify_ground_tin_2000
from lidar_buildings.algorithms.terrain.tin_densification import JoinRules, Surface, grow
from lidar_buildings.tests.algorithms.terrain.terrains import HOUSES, TERRAINS, errors, scan, unclassified
from lidar_buildings.tests.builders import FAR
from lidar_buildings.tests.monitors import Listening


@pytest.mark.parametrize("name", ["level", "bumpy"])
def test_houses_on_terrain(name, rng):
    """On slopes the surface starts from too few points: the lowest of a cell of 60 m lies far below the others."""
    xyz, is_house = scan(rng, TERRAINS[name], HOUSES)
    missed, wrong = errors(classify_ground_tin_2000(xyz, unclassified(xyz)), is_house)
    assert wrong == 0
    assert missed < 0.03


def test_without_a_sweep_only_nodes_are_ground(rng):
    """Points within the noise of the finished surface do not refine it, and stay unclassified."""
    xyz, is_house = scan(rng, TERRAINS["level"], HOUSES)
    nodes = classify_ground_tin_2000(xyz, unclassified(xyz), sweep_distance=0.0) == 2
    swept = classify_ground_tin_2000(xyz, unclassified(xyz)) == 2
    assert 0 < nodes.sum() < swept.sum()
    assert swept[nodes].all()
    assert not nodes[is_house].any()


def test_lowest_seeds_keep_off_houses_smaller_than_their_cells(rng):
    xyz, is_house = scan(rng, TERRAINS["level"], HOUSES)
    missed, wrong = errors(classify_ground_tin_2000(xyz, unclassified(xyz), max_building_size=40), is_house)
    assert wrong == 0
    assert missed < 0.01


def test_position_and_order_change_nothing(rng):
    xyz, _ = scan(rng, TERRAINS["hill"], HOUSES, density=1)
    xyz = np.round(xyz * 1024) / 1024
    expected = classify_ground_tin_2000(xyz, unclassified(xyz))
    order = rng.permutation(len(xyz))
    np.testing.assert_array_equal(classify_ground_tin_2000(xyz[order], unclassified(xyz)), expected[order])
    np.testing.assert_array_equal(classify_ground_tin_2000(xyz + FAR, unclassified(xyz)), expected)


def test_noise_is_not_used_and_keeps_its_class(rng):
    """A point 20 m below the ground would be the lowest of its cell."""
    xyz, is_house = scan(rng, TERRAINS["level"], HOUSES)
    classes, low = unclassified(xyz), np.flatnonzero(~is_house)[0]
    xyz[low, 2], classes[low] = -20.0, 7
    found = classify_ground_tin_2000(xyz, classes)
    assert found[low] == 7
    is_known = np.arange(len(xyz)) != low
    missed, wrong = errors(found[is_known], is_house[is_known])
    assert missed < 0.03
    assert wrong == 0


def test_progress_only_grows_and_a_cancel_gets_through(rng):
    xyz, _ = scan(rng, TERRAINS["slope"], HOUSES, density=1)
    monitor = Listening()
    classify_ground_tin_2000(xyz, unclassified(xyz), monitor=monitor)
    assert monitor.heard == sorted(monitor.heard)
    assert monitor.heard[-1] <= 1
    with pytest.raises(Cancelled):
        classify_ground_tin_2000(xyz, unclassified(xyz), monitor=Listening(stop_at=0.5))


def test_rounds_go_on_until_no_point_qualifies(rng):
    """After the last round no point outside the surface is under the thresholds of that round."""
    xyz, _ = scan(rng, TERRAINS["hill"], density=1)
    rules = JoinRules(20.0, None, 0.3, 2.0, estimates_angle=True, is_exhaustive=True)
    start = np.sort(rng.choice(len(xyz), 12, replace=False))
    surface, distance, angle = grow(xyz, start, np.ones(len(xyz), bool), rules, Monitor())
    limits = rules.limits(surface.nodes)
    assert limits == pytest.approx((distance, angle))
    again = Surface(xyz, np.flatnonzero(surface.is_node), Monitor())
    tin, facet = again.tin, again.facet
    nearest = np.linalg.norm(tin.nodes[tin.facets[facet]] - (xyz - tin.shift)[:, None], axis=2).min(axis=1)
    offset = np.abs(again.above())
    fits = (offset <= distance) & (np.degrees(np.arcsin(np.clip(offset / nearest.clip(1e-9), 0, 1))) <= angle)
    is_open = (tin.longest_edge()[facet] > 2.0) & (nearest > 0.5) & ~surface.is_node
    assert not (fits & is_open).any()


def test_a_hill_far_above_the_first_surface_is_reached(rng):
    """The first surface lies under the hill by many of its distances: a point there was once dropped for good."""
    xyz, _ = scan(rng, lambda x, y: 12 * np.exp(-((x - 40) ** 2 + (y - 40) ** 2) / 300), density=2)
    found = classify_ground_tin_2000(xyz, unclassified(xyz), max_building_size=40.0, iteration_angle=40.0)
    assert (found == 2).mean() > 0.95


@pytest.mark.parametrize(("noise", "spread"), [(0.02, 2.0), (0.2, 2.0), (0.02, 0.5)])
def test_the_angle_is_estimated_from_the_nodes(noise, spread, rng):
    """Nodes on a grid of the given spacing (m): eight deviations of the angles under which their residuals appear."""
    x, y = np.meshgrid(np.arange(60.0), np.arange(60.0))
    nodes = np.column_stack([spread * x.ravel(), spread * y.ravel(), rng.normal(0, noise, x.size)])
    estimated = JoinRules(90.0, None, 0.0, 1.0, estimates_angle=True).angle(nodes)
    # A residual is of the node and of the plane of its eight neighbors.
    deviation = np.degrees(np.arctan(noise * np.sqrt(1 + 1 / 8) / spread))
    assert estimated == pytest.approx(min(8 * deviation, 90.0), rel=0.08)
    assert JoinRules(5.0, None, 0.0, 1.0, estimates_angle=True).angle(nodes) == min(5.0, estimated)


def test_nothing_steeper_than_the_terrain_angle_joins(rng):
    """A slope of 35° is ground up to a terrain angle that has room for it and for noise."""
    xyz, _ = scan(rng, lambda x, y: np.tan(np.radians(35)) * x, noise=0.0)
    shares = [
        (classify_ground_tin_2000(xyz, unclassified(xyz), terrain_angle=steepest, sweep_distance=0.0) == 2).mean()
        for steepest in (25.0, 40.0)
    ]
    assert shares[0] < 0.5 * shares[1]


def test_last_values_are_reported(rng):
    xyz, _ = scan(rng, TERRAINS["level"], density=1)
    monitor = Monitor()
    classify_ground_tin_2000(xyz, unclassified(xyz), max_building_size=20.0, monitor=monitor)
    assert monitor.values["edge_length"] == 2.0
    assert 0 < monitor.values["last_angle"] <= 20.0
    assert 0 < monitor.values["sweep_distance"] < monitor.values["iteration_distance"]
