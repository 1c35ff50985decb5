"""Triangulations made in tiles and mended, against those made at once, and against the definition of Delaunay."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import Delaunay

from lidar_buildings.algorithms.geometry import delaunay as module
from lidar_buildings.algorithms.geometry.delaunay import circles, triangulate
from lidar_buildings.tests.monitors import Listening

CORNERS = 300.0 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])


@pytest.fixture(autouse=True)
def small_tiles(monkeypatch):
    monkeypatch.setattr(module, "TILE_POSITIONS", 40)


@pytest.fixture
def plan(rng):
    """Places in 100 m by 60 m, with a lake and with one that lies far off."""
    places = rng.uniform([0, 0], [100, 60], (1500, 2)) - [50, 30]
    places = places[np.linalg.norm(places - [10, 5], axis=1) > 12]
    return np.concatenate([CORNERS, places, [[-200.0, 190.0]]])


def lattice(columns, rows):
    x, y = np.meshgrid(np.arange(float(columns)), np.arange(float(rows)))
    return np.concatenate([CORNERS, np.column_stack([x.ravel(), y.ravel()])])


def ordered(facets):
    """Return facets as sets of corners, in one order."""
    return np.unique(np.sort(facets, axis=1), axis=0)


def cross(u, v):
    """Return the areas that vectors in plan span; numpy 2 has no product of two dimensions without a warning."""
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]


def under(mesh, places):
    """Return a facet that holds each place, by its sides."""
    a, b, c = np.swapaxes(mesh.plan[mesh.facets], 0, 1)[:, None]
    sides = [cross(end - start, places[:, None] - start) for start, end in ((a, b), (b, c), (c, a))]
    return np.argmax(np.min(sides, axis=0) >= 0, axis=1)


def is_delaunay(mesh):
    """Whether facets cover the square between the corners once and have empty circles and the right neighbors."""
    a, b, c = np.swapaxes(mesh.plan[mesh.facets], 0, 1)
    area = cross(b - a, c - a) / 2
    center, radius = circles(mesh.plan, mesh.facets)
    distance = np.linalg.norm(mesh.plan[None] - center[:, None], axis=2)
    facet, corner = np.nonzero(mesh.neighbors >= 0)
    beside = mesh.facets[mesh.neighbors[facet, corner]]
    ends = [mesh.facets[facet, (corner + step) % 3][:, None] for step in (1, 2)]
    assert area.min() > 0
    assert area.sum() == pytest.approx(600.0**2)
    assert (distance > radius[:, None] * (1 - 1e-9)).all()
    assert all((beside == end).any(axis=1).all() for end in ends)
    assert (mesh.neighbors < 0).sum() == 4
    return True


def test_tiles_make_the_triangulation_of_the_whole(plan):
    mesh = triangulate(plan)
    np.testing.assert_array_equal(ordered(mesh.facets), ordered(Delaunay(plan).simplices))
    assert is_delaunay(mesh)


@pytest.mark.parametrize("shape", ["round", "square"])
def test_tiles_need_no_corners_far_around(shape, rng, monkeypatch):
    """The sides of the hull, which have nothing beyond, were taken for holes: all was triangulated once more."""
    places = rng.uniform(-50, 50, (1500, 2))
    if shape == "round":
        places = places[np.linalg.norm(places, axis=1) < 45]
    at_once, largest = Delaunay(places), []
    made = module._by_qhull
    monkeypatch.setattr(module, "_by_qhull", lambda plan: largest.append(len(plan)) or made(plan))
    mesh = triangulate(places)
    assert max(largest) < len(places) / 2
    assert (mesh.neighbors < 0).sum() == len(at_once.convex_hull)
    assert len(mesh.facets) == len(at_once.simplices)
    np.testing.assert_array_equal(ordered(mesh.facets), ordered(at_once.simplices))


def test_the_hull_may_have_many_corners(plan):
    np.testing.assert_array_equal(ordered(triangulate(plan[4:]).facets), ordered(Delaunay(plan[4:]).simplices))


@pytest.mark.parametrize("margin", [3.0, 0.3])
def test_tiles_are_used(margin, plan, monkeypatch):
    """Also where so little is seen around them that many triangles aren't known to be right, and are left out."""
    sizes = []
    by_qhull = module._by_qhull
    monkeypatch.setattr(module, "_by_qhull", lambda places: sizes.append(len(places)) or by_qhull(places))
    monkeypatch.setattr(module, "_MARGIN", margin)
    assert is_delaunay(triangulate(plan))
    assert len(sizes) > 30
    assert max(sizes) < 0.7 * len(plan)


def test_grids_whose_cells_have_two_diagonals_are_seamless():
    assert is_delaunay(triangulate(lattice(30, 20)))
    # A tile of one column has no triangles of its own.
    assert is_delaunay(triangulate(lattice(1, 200)))


def test_where_seams_stay_open_the_whole_is_triangulated_at_once(plan, monkeypatch):
    monkeypatch.setattr(module, "_is_whole", lambda mesh: False)
    some = triangulate(plan[:-300])
    np.testing.assert_array_equal(some.facets, Delaunay(plan[:-300]).simplices)
    more, became = some.with_positions(plan[-300:], under(some, plan[-300:]))
    np.testing.assert_array_equal(ordered(more.facets), ordered(Delaunay(plan).simplices))
    assert (became == -1).all()


def test_places_come_in_as_if_they_had_been_there(plan):
    """One in each facet at most, as the ground grows, and many in one."""
    some = triangulate(plan[:-300])
    more, became = some.with_positions(plan[-300:], under(some, plan[-300:]))
    np.testing.assert_array_equal(ordered(more.facets), ordered(Delaunay(plan).simplices))
    assert is_delaunay(more)
    kept = became >= 0
    assert 0.1 < kept.mean() < 0.9
    np.testing.assert_array_equal(more.facets[became[kept]], some.facets[kept])


def test_nothing_comes_in(plan):
    mesh = triangulate(plan)
    same, became = mesh.with_positions(np.empty((0, 2)), np.empty(0, np.int32))
    assert is_delaunay(same)
    np.testing.assert_array_equal(ordered(same.facets), ordered(mesh.facets))


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 14), st.integers(0, 9)), min_size=1, max_size=250), st.integers(0, 250))
def test_places_of_a_grid_some_twice_and_some_later(places, later):
    """Where four and more places lie on a circle, and where one comes to lie on another."""
    places = np.concatenate([CORNERS, np.array(places, float)])
    first = places[: max(5, len(places) - later)]
    mesh = triangulate(first)
    new = places[len(first) :]
    mesh, _ = mesh.with_positions(new, under(mesh, new))
    assert is_delaunay(mesh)


def test_progress_is_reported(plan):
    monitor = Listening()
    triangulate(plan, monitor)
    assert monitor.heard[-1] == 1.0
    assert len(monitor.heard) > 5


def test_order_does_not_matter(plan, rng):
    order = np.append(np.arange(4), 4 + rng.permutation(len(plan) - 4))
    here, there = triangulate(plan), triangulate(plan[order])
    np.testing.assert_array_equal(ordered(here.facets), ordered(order[there.facets]))
