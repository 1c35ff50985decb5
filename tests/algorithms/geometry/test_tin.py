"""The triangulated surface against scipy's own interpolation and search, and where those end."""

import numpy as np
import pytest
from scipy.interpolate import LinearNDInterpolator
from scipy.spatial import Delaunay

from lidar_buildings.algorithms.geometry import tin as module
from lidar_buildings.algorithms.geometry.tin import Tin, node_fits, robust_deviation
from lidar_buildings.tests.builders import FAR
from lidar_buildings.tests.monitors import Listening


@pytest.fixture
def nodes(rng):
    """Nodes of a bumpy surface in 100 m by 60 m."""
    plan = rng.uniform([0, 0], [100, 60], (400, 2))
    return np.column_stack([plan, 5 * np.sin(plan[:, 0] / 9) + 0.1 * plan[:, 1]])


@pytest.fixture
def positions(rng):
    """Points all over and around the nodes; their own elevation means nothing."""
    return np.column_stack([rng.uniform([-20, -20], [120, 80], (3000, 2)), np.zeros(3000)])


def test_elevation_inside_the_hull_is_that_of_scipy(nodes, positions):
    tin = Tin(nodes)
    facet = tin.locate(positions)
    theirs = LinearNDInterpolator(nodes[:, :2], nodes[:, 2])(positions[:, :2])
    inside = np.isfinite(theirs)
    own = ~tin.is_extrapolated()[facet]
    # The corners may take a sliver off the hull, and never add to it.
    assert not (own & ~inside).any()
    assert (inside & ~own).sum() < 0.02 * inside.sum()
    np.testing.assert_allclose(tin.elevation(positions, facet)[own], theirs[own], atol=1e-9)


def test_facets_are_those_that_qhull_finds(nodes, positions):
    tin = Tin(nodes)
    whole = Delaunay(tin.nodes[:, :2])
    found = whole.simplices[whole.find_simplex(positions[:, :2] - tin.shift[:2])]
    np.testing.assert_array_equal(np.sort(tin.facets[tin.locate(positions)], axis=1), np.sort(found, axis=1))


def test_nodes_that_join_change_the_surface_as_if_they_had_been_there(nodes, positions):
    box = np.array([[0.0, 0], [100, 60]])
    points = np.concatenate([nodes[300:], positions])
    tin, whole = Tin(nodes[:300], box), Tin(nodes, box)
    before = tin.locate(points)
    facet = tin.add(points, before, np.arange(100))
    expected = whole.locate(points)
    corners = [np.sort(at.nodes[at.facets[of], 0]) for at, of in ((tin, facet), (whole, expected))]
    # Nodes that join lie in several facets.
    np.testing.assert_array_equal(corners[0][100:], corners[1][100:])
    np.testing.assert_allclose(tin.elevation(points, facet)[:100], nodes[300:, 2], atol=1e-9)
    own = ~whole.is_extrapolated()[expected]
    np.testing.assert_allclose(tin.elevation(points, facet)[own], whole.elevation(points, expected)[own], atol=1e-9)
    np.testing.assert_array_equal(tin.locate_near(points, np.full(len(points), 7))[100:], facet[100:])


def test_chunks_change_nothing(nodes, positions, monkeypatch):
    whole = Tin(nodes).locate(positions)
    monkeypatch.setattr(module, "ROWS_AT_ONCE", 700)
    np.testing.assert_array_equal(Tin(nodes).locate(positions), whole)


def test_a_walk_that_does_not_end_is_finished_by_search(nodes, positions, monkeypatch):
    tin = Tin(nodes)
    whole = tin.locate(positions)
    monkeypatch.setattr(module, "_MAX_STEPS", 1)
    np.testing.assert_array_equal(tin.locate(positions), whole)


def test_large_coordinates_keep_their_digits(nodes, positions):
    at_origin, far_away = Tin(nodes), Tin(nodes + FAR)
    near = at_origin.elevation(positions, at_origin.locate(positions))
    np.testing.assert_allclose(far_away.elevation(positions + FAR, far_away.locate(positions + FAR)), near, atol=1e-5)


def test_nodes_lie_on_their_surface_also_on_a_regular_grid():
    x, y = np.meshgrid(np.arange(12.0), np.arange(9.0))
    nodes = np.column_stack([x.ravel(), y.ravel(), (3 * x + y * y).ravel()])
    tin = Tin(nodes)
    np.testing.assert_allclose(tin.elevation(nodes, tin.locate(nodes)), nodes[:, 2], atol=1e-9)


def test_duplicate_nodes_count_once(nodes, positions):
    once, twice = Tin(nodes), Tin(np.concatenate([nodes, nodes[::3]]))
    expected = once.elevation(positions, once.locate(positions))
    np.testing.assert_allclose(twice.elevation(positions, twice.locate(positions)), expected, atol=1e-9)
    tall = Tin(np.array([[0.0, 0, 0], [0, 0, 7], [4, 0, 0], [0, 4, 0], [4, 4, 0]]))
    at = np.zeros((1, 3))
    assert tall.elevation(at, tall.locate(at))[0] in (pytest.approx(0), pytest.approx(7))


def test_outside_the_hull_the_surface_goes_on_at_the_height_of_the_nearest_nodes():
    x, y = np.meshgrid(np.arange(11.0), np.arange(11.0))
    tin = Tin(np.column_stack([x.ravel(), y.ravel(), np.full(121, 8.0)]))
    around = np.array([[-15.0, 5, 0], [5, 25, 0], [-30, -30, 0], [12, 5, 0]])
    facet = tin.locate(around)
    assert tin.is_extrapolated()[facet].all()
    np.testing.assert_allclose(tin.elevation(around, facet), 8.0)


def test_points_farther_than_the_corners_are_outside_too(rng):
    """Ground known in one small part of a large cloud once gave heights of some unrelated facet."""
    nodes = rng.uniform(0, 2, (6, 3))
    far = rng.uniform(-5000, 5000, (200, 3))
    tin = Tin(nodes)
    facet = tin.locate(far)
    assert (facet >= 0).all()
    assert tin.is_extrapolated()[facet].all()


@pytest.mark.parametrize("nodes", [[[3, 4, 5]], [[3, 4, 5], [3, 4, 5]]])
def test_one_node_is_a_level_surface(nodes, positions):
    tin = Tin(np.array(nodes, float))
    np.testing.assert_allclose(tin.elevation(positions[:50], tin.locate(positions[:50])), 5)


def test_nodes_on_a_line_interpolate_along_it():
    tin = Tin(np.array([[0.0, 0, 0], [10, 10, 5], [20, 20, 0]]))
    on_line = np.array([[5.0, 5, 0], [15, 15, 0], [10, 10, 0]])
    np.testing.assert_allclose(tin.elevation(on_line, tin.locate(on_line)), [2.5, 2.5, 5], atol=1e-9)


def test_slope_cosine_and_longest_edge_of_a_roof():
    # Two facets of slope 1 that meet in a ridge along y, 6 m long, their longest edge.
    tin = Tin(np.array([[0.0, 0, 0], [5, 3, 5], [10, 0, 0], [5, -3, 5]]))
    facet = tin.locate(np.array([[2.0, 0.1, 0], [8.0, 0.1, 0]]))
    np.testing.assert_allclose(tin.slope_cosine()[facet], np.sqrt(0.5))
    np.testing.assert_allclose(tin.longest_edge()[facet], 6)


def test_circles_go_through_their_nodes_and_hold_no_other(nodes):
    """To all digits in map coordinates too: else circles without a node inside would seem to have one."""
    for shift in (0, FAR):
        tin = Tin(nodes + shift)
        center, radius = tin.circles(np.arange(len(tin.facets)))
        distance = np.linalg.norm(tin.nodes[None, :, :2] - center[:, None], axis=2)
        own = np.take_along_axis(distance, tin.facets, axis=1)
        np.testing.assert_allclose(own, np.repeat(radius[:, None], 3, axis=1), rtol=1e-11)
        assert (distance >= radius[:, None] * (1 - 1e-11)).all()


def test_nodes_on_a_line_have_no_circle():
    tin = Tin(np.array([[0.0, 0, 0], [10, 0, 0], [20, 0, 0]]))
    tin.nodes[tin.facets[0], 1] = 0.0
    center, radius = tin.circles(np.array([0]))
    assert not np.isfinite(center).all()
    assert not np.isfinite(radius).any()


def test_a_search_reports_its_progress(nodes, monkeypatch):
    monkeypatch.setattr(module, "ROWS_AT_ONCE", 10)
    monitor = Listening()
    Tin(nodes).locate(nodes[:40], monitor)
    assert monitor.heard == [0.25, 0.5, 0.75, 1.0]


def test_empty_search(nodes):
    assert len(Tin(nodes).locate(np.empty((0, 3)))) == 0


def test_residuals_of_a_plane_are_nothing_and_of_one_lifted_node_its_lift(rng):
    plan = rng.uniform(0, 50, (300, 2))
    plane = np.column_stack([plan, 0.3 * plan[:, 0] - 0.2 * plan[:, 1]]) + FAR
    np.testing.assert_allclose(node_fits(plane)[0], 0, atol=1e-6)
    plane[7, 2] += 1.5
    assert node_fits(plane)[0][7] == pytest.approx(1.5, abs=1e-6)


def test_a_sample_of_residuals_depends_neither_on_order_nor_on_one_node(rng):
    """The ground of a survey in tiles, whose points are sorted, was swept by 3 % less than the file's."""
    nodes = rng.uniform(0, [60, 60, 1], (3000, 3))
    sample = np.sort(node_fits(nodes, most=700)[0])
    assert 550 < len(sample) < 950
    order = rng.permutation(len(nodes))
    np.testing.assert_allclose(np.sort(node_fits(nodes[order], most=700)[0]), sample, atol=1e-9)
    # The residuals of nodes next to the missing one change.
    without = np.sort(node_fits(nodes[1:], most=700)[0])
    assert len(np.intersect1d(np.round(without, 9), np.round(sample, 9))) > 0.97 * len(sample)


def test_residuals_are_those_of_least_squares(nodes):
    """Independent: numpy's least squares over the eight other nodes nearest in plan."""
    expected = []
    for node in nodes[:40]:
        near = np.argsort(np.linalg.norm(nodes[:, :2] - node[:2], axis=1))[1:9]
        design = np.column_stack([nodes[near, :2] - node[:2], np.ones(8)])
        expected.append(node[2] - np.linalg.lstsq(design, nodes[near, 2], rcond=None)[0][2])
    np.testing.assert_allclose(node_fits(nodes)[0][:40], expected, atol=1e-4)


def test_robust_deviation():
    assert robust_deviation(np.array([-2.0, 1, 0.5, 1e6, -0.5])) == pytest.approx(1.4826)
    assert robust_deviation(np.zeros(5)) == 0.01


def test_robust_deviation_of_normal_noise(rng):
    assert robust_deviation(rng.normal(0, 0.3, 20_000)) == pytest.approx(0.3, rel=0.03)


def test_truth_of_the_comparison(nodes):
    """The hull that the comparison uses leaves positions outside, so that both sides are tested."""
    outside = Delaunay(nodes[:, :2]).find_simplex([[-15.0, 5], [50, 30]]) < 0
    assert outside.tolist() == [True, False]
