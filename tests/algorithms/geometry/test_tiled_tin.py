"""The surface made tile by tile against one triangulation of all nodes, above all where the ground has gaps."""

import numpy as np
import pytest
from scipy.interpolate import LinearNDInterpolator
from scipy.spatial import ConvexHull

from lidar_buildings.algorithms.geometry import tiled_tin as module
from lidar_buildings.algorithms.geometry.tiled_tin import TiledTin
from lidar_buildings.algorithms.geometry.tin import Tin
from lidar_buildings.algorithms.stage import Cancelled
from lidar_buildings.tests.builders import FAR
from lidar_buildings.tests.monitors import Listening

SIDE = 80.0


@pytest.fixture(autouse=True)
def small_tiles(monkeypatch):
    """Tiles so small that the few points of a test make many."""
    monkeypatch.setattr(module, "TILE_POSITIONS", 400)
    monkeypatch.setattr(module, "ROWS_AT_ONCE", 600)


def ground(rng, where, count=6000):
    """Return nodes of a bumpy, noisy surface where ``where`` says so of their plan."""
    plan = rng.uniform(0, SIDE, (count, 2))
    plan = plan[where(plan)]
    return np.column_stack([plan, 5 * np.sin(plan[:, 0] / 9) + 0.1 * plan[:, 1] + rng.normal(0, 0.2, len(plan))])


def by_one_triangulation(nodes, places):
    """Independent opinion: Qhull's triangulation of all nodes."""
    lowest = np.lexsort((nodes[:, 2], nodes[:, 1], nodes[:, 0]))
    plan, first = np.unique(nodes[lowest, :2], axis=0, return_index=True)
    return LinearNDInterpolator(plan, nodes[lowest, 2][first])(places[:, :2])


def from_middle(plan):
    return np.hypot(*(plan - SIDE / 2).T)


@pytest.mark.parametrize(
    "where",
    [
        lambda plan: plan[:, 0] > -1,
        lambda plan: from_middle(plan) > 30,
        lambda plan: np.abs(from_middle(plan) - 30) < 3,
        lambda plan: np.abs(plan[:, 0] - plan[:, 1]) < 2,
        lambda plan: (np.floor(plan / 20) % 2).sum(axis=1) == 1,
        lambda plan: np.random.default_rng(2).random(len(plan)) < np.exp(-from_middle(plan) / 6),
    ],
    ids=["everywhere", "lake", "ring", "diagonal strip", "chessboard", "denser in the middle"],
)
def test_elevations_are_those_of_one_triangulation(rng, where):
    nodes = ground(rng, where)
    places = rng.uniform(-10, SIDE + 10, (4000, 2))
    found = TiledTin(nodes).elevation(places)
    np.testing.assert_allclose(found, by_one_triangulation(nodes, places), atol=1e-9)


@pytest.mark.parametrize("corner", [np.zeros(3), FAR], ids=["near", "map"])
@pytest.mark.parametrize("count", [3, 4, 30, 1100])
def test_the_whole_hull_is_inside(rng, corner, count):
    """Triangles along the hull are flat, and were lost to far corners: up to 2.6 m of height on steep ground.

    Of 20,000 places on and around the sparsest ground some 150 inside the hull had no elevation.
    """
    nodes = ground(rng, lambda plan: plan[:, 0] > -1, count) * [1, 1, 5]
    places = rng.uniform(-1, SIDE + 1, (20_000, 2))
    expected = by_one_triangulation(nodes, places)
    found = TiledTin(nodes + corner).elevation(places + corner[:2])
    np.testing.assert_array_equal(np.isnan(found), np.isnan(expected))
    np.testing.assert_allclose(found, expected, atol=1e-5)


def test_the_middle_of_every_edge_of_the_hull_is_inside(rng):
    """The flattest pockets: a millimeter inside the hull, with nodes rounded to centimeters."""
    nodes = np.round(ground(rng, lambda plan: from_middle(plan) < 39), 2)
    hull = ConvexHull(nodes[:, :2])
    ends = nodes[hull.vertices, :2]
    places = (ends + np.roll(ends, -1, axis=0)) / 2
    places += 0.001 * (SIDE / 2 - places) / from_middle(places)[:, None]
    found = TiledTin(nodes).elevation(places)
    np.testing.assert_allclose(found, by_one_triangulation(nodes, places), rtol=0, atol=1e-6)
    assert np.isfinite(found).all()


def test_nodes_on_a_line_have_no_inside(rng):
    line = np.arange(50.0)[:, None] * [0.6, 0.8, 0.1]
    for corner in (np.zeros(3), FAR):
        assert np.isnan(TiledTin(line + corner).elevation(line[:, :2] + [0.1, 0] + corner[:2])).all()


def test_places_in_one_gap_only(rng):
    """A tile without nodes: those around the gap are found from the places."""
    nodes = ground(rng, lambda plan: from_middle(plan) > 25)
    places = SIDE / 2 + rng.uniform(-3, 3, (50, 2))
    np.testing.assert_allclose(TiledTin(nodes).elevation(places), by_one_triangulation(nodes, places), atol=1e-9)


def test_a_regular_grid_of_nodes_is_its_own_surface(rng):
    """Four nodes lie on every circle, and each diagonal is right: on a plane that makes no difference."""
    x, y = np.meshgrid(np.arange(60.0), np.arange(50.0))
    nodes = np.column_stack([x.ravel(), y.ravel(), (0.3 * x - 0.2 * y).ravel()])
    places = rng.uniform(0, 49, (3000, 2))
    np.testing.assert_allclose(TiledTin(nodes).elevation(places), places @ [0.3, -0.2], atol=1e-9)


def test_of_nodes_at_one_position_the_lowest_counts(rng):
    nodes = ground(rng, lambda plan: plan[:, 0] > -1, 2000)
    places = rng.uniform(0, SIDE, (1000, 2))
    expected = by_one_triangulation(nodes, places)
    above = nodes[::2] + np.column_stack([np.zeros((1000, 2)), rng.uniform(0.1, 9, 1000)])
    for both in (np.concatenate([nodes, above]), np.concatenate([above, nodes])):
        np.testing.assert_allclose(TiledTin(both).elevation(places), expected, atol=1e-9)


def test_order_and_position_change_nothing(rng):
    nodes = ground(rng, lambda plan: from_middle(plan) > 20)
    nodes[:, :2] = np.round(nodes[:, :2], 1)  # with twins, and many on one circle
    places = rng.uniform(0, SIDE, (2000, 2))
    found = TiledTin(nodes).elevation(places)
    order = rng.permutation(2000)
    np.testing.assert_array_equal(TiledTin(rng.permutation(nodes)).elevation(places[order]), found[order])
    nodes = ground(rng, lambda plan: from_middle(plan) > 20)
    found = TiledTin(nodes).elevation(places)
    np.testing.assert_allclose(TiledTin(nodes + FAR).elevation(places + FAR[:2]), found, atol=1e-5)


def test_size_of_tiles_changes_nothing(rng, monkeypatch):
    nodes, places = ground(rng, lambda plan: from_middle(plan) > 20), rng.uniform(0, SIDE, (3000, 2))
    found = TiledTin(nodes).elevation(places)
    monkeypatch.setattr(module, "TILE_POSITIONS", 100_000)
    monkeypatch.setattr(module, "ROWS_AT_ONCE", 100_000)
    np.testing.assert_allclose(TiledTin(nodes).elevation(places), found, atol=1e-9)


@pytest.mark.parametrize("nodes", [[[3, 4, 5]], [[3, 4, 5]] * 1000], ids=["one", "all at one place"])
def test_nodes_without_area_have_no_inside(nodes, rng):
    surface = TiledTin(np.array(nodes, float))
    places = rng.uniform(0, 9, (2000, 2))
    assert np.isnan(surface.elevation(places)).all()
    np.testing.assert_array_equal(surface.nearest_elevation(places), 5)


def test_nearest_elevation(rng):
    nodes, places = ground(rng, lambda plan: plan[:, 0] > -1, 300), rng.uniform(-50, 130, (200, 2))
    nearest = np.linalg.norm(places[:, None] - nodes[None, :, :2], axis=2).argmin(axis=1)
    np.testing.assert_array_equal(TiledTin(nodes).nearest_elevation(places), nodes[nearest, 2])


def test_no_places():
    assert TiledTin(np.zeros((1, 3))).elevation(np.zeros((0, 2))).shape == (0,)


def test_progress_is_reported_and_a_cancellation_ends_it(rng):
    monitor = Listening(stop_at=0.3)
    surface = TiledTin(ground(rng, lambda plan: plan[:, 0] > -1))
    with pytest.raises(Cancelled):
        surface.elevation(rng.uniform(0, SIDE, (4000, 2)), monitor)
    assert len(monitor.heard) > 2
    assert monitor.heard == sorted(monitor.heard)


@pytest.mark.parametrize("place", [np.zeros(3), FAR], ids=["near", "map"])
def test_no_circle_is_doubted_where_all_nodes_are_known(rng, place):
    """In map coordinates the rounding of circles once sent many of them to a second search."""
    nodes = ground(rng, lambda plan: plan[:, 0] > -1, 500) * [0.05, 0.05, 1]  # 0.2 m apart, as drones give them
    surface = TiledTin(nodes + place)
    asked = []

    class Watched:
        def query(self, center, *count):
            asked.append((len(count), len(center)))
            return surface_tree.query(center, *count)

    surface_tree, surface._tree = surface._tree, Watched()
    tin = Tin(surface.nodes, surface._box)
    intruders, is_wrong = surface._intruders(*tin.circles(np.arange(len(tin.facets))), np.arange(len(surface.nodes)))
    assert not len(intruders)
    assert not is_wrong.any()
    assert asked == [(0, len(tin.facets)), (1, 0)]


@pytest.mark.parametrize("rounding", [1e-9, -1e-9])
def test_a_node_on_a_circle_makes_no_circle_wrong_that_has_all_nodes_known(rng, monkeypatch, rounding):
    """Else the search for nodes that are missing would never end."""
    monkeypatch.setattr(module, "ROUNDING", rounding)
    surface = TiledTin(ground(rng, lambda plan: plan[:, 0] > -1, 300))
    tin = Tin(surface.nodes, surface._box)
    intruders, is_wrong = surface._intruders(*tin.circles(np.arange(len(tin.facets))), np.arange(len(surface.nodes)))
    assert not len(intruders)
    assert not is_wrong.any()


def test_a_facet_of_nodes_on_a_line_is_taken_as_it_is(rng):
    surface = TiledTin(ground(rng, lambda plan: plan[:, 0] > -1, 300))
    tin = Tin(surface.nodes, surface._box)
    tin.nodes[tin.facets[5], 1] = 0.0
    intruders, is_wrong = surface._intruders(*tin.circles(np.array([5])), np.arange(len(surface.nodes)))
    assert not len(intruders)
    assert is_wrong.tolist() == [False]


@pytest.mark.parametrize("other", [3.0, np.nextafter(3.0, 4.0)])
def test_places_that_no_line_parts_stay_in_one_tile(other, monkeypatch):
    monkeypatch.setattr(module, "ROWS_AT_ONCE", 1)
    places = np.array([[3.0, 7.0], [other, 7.0]])
    ((rows, own),) = module._tiles(np.zeros((1, 3)), places)
    assert (rows.tolist(), own.tolist()) == ([0], [0, 1])


def test_only_few_nodes_are_triangulated_at_once(rng, monkeypatch):
    """What the tiles are for: memory that doesn't grow with the cloud."""
    sizes = []

    class Watched(Tin):
        def __init__(self, nodes, box):
            sizes.append(len(nodes))
            super().__init__(nodes, box)

    monkeypatch.setattr(module, "Tin", Watched)
    nodes = ground(rng, lambda plan: from_middle(plan) > 10, 20_000)
    TiledTin(nodes).elevation(rng.uniform(0, SIDE, (3000, 2)))
    assert max(sizes) < 1000
