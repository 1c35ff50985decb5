"""Cells of lines: how many there are, that they tile the rectangle, and that the cheapest choice is the cheapest."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidar_buildings.algorithms.geometry.arrangement import Arrangement, sides_of
from lidar_buildings.algorithms.geometry.cheapest_labels import cheapest_cut
from lidar_buildings.algorithms.geometry.rings import signed_area

LOW, HIGH = np.array([-10.0, -8.0]), np.array([10.0, 8.0])


def lines(seed, count):
    rng = np.random.default_rng(seed)
    angle = rng.uniform(0, np.pi, count)
    return rng.uniform(-6, 6, (count, 2)), np.column_stack([np.cos(angle), np.sin(angle)])


def rings_of(cells, inside):
    rings = [cells.positions[[place for _, place in ring]] for ring in cells.outline(inside)]
    return [np.concatenate([ring, ring[:1]]) for ring in rings]


def outline_area(cells, inside):
    return sum(map(signed_area, rings_of(cells, inside)))


def inner_areas(cells):
    """Return the area of each cell that doesn't touch the rectangle's sides."""
    return {
        cell: outline_area(cells, np.arange(cells.count) == cell) for cell in np.flatnonzero(~cells.is_border).tolist()
    }


def test_two_by_two_lines_make_nine_cells():
    points = np.array([(-2.0, 0), (3, 0), (0, -1), (0, 4)])
    directions = np.array([(0.0, 1), (0, 1), (1, 0), (1, 0)])
    cells = Arrangement(points, directions, LOW, HIGH)
    assert cells.count == 9
    assert len(cells.crossing) == 4
    middle = cells.cells_at(sides_of(np.array([[0.0, 0.0], [2.9, 3.9]]), points, directions))
    assert middle[0] == middle[1]
    assert np.flatnonzero(~cells.is_border).tolist() == [middle[0]]
    inside = np.arange(9) == middle[0]
    (ring,) = cells.outline(inside)
    assert {line for line, _ in ring} == {0, 1, 2, 3}
    assert outline_area(cells, inside) == pytest.approx(25)


def test_a_ring_of_cells_has_a_hole():
    across, upright = np.array([-6.0, -2, 3, 7]), np.array([-7.0, -1, 4, 7])
    points = np.concatenate([np.column_stack([across, 0 * across]), np.column_stack([0 * upright, upright])])
    directions = np.repeat([(0.0, 1.0), (1.0, 0.0)], 4, axis=0)
    cells = Arrangement(points, directions, LOW, HIGH)
    middle = cells.cells_at(sides_of(np.zeros((1, 2)), points, directions))
    inside = ~cells.is_border & (np.arange(cells.count) != middle[0])
    assert sorted(map(signed_area, rings_of(cells, inside))) == pytest.approx([-25, 13 * 14])


@settings(max_examples=40)
@given(seed=st.integers(0, 10_000), count=st.integers(0, 9))
def test_cells_tile_the_rectangle_and_are_as_many_as_lines_make(seed, count):
    points, directions = lines(seed, count)
    cells = Arrangement(points, directions, LOW, HIGH)
    crossings = 0
    for a, b in itertools.combinations(range(count), 2):
        place = np.linalg.solve(np.column_stack([directions[a], -directions[b]]), points[b] - points[a])[0]
        place = points[a] + place * directions[a]
        crossings += ((place > LOW) & (place < HIGH)).all()
    # Every line through the rectangle adds a cell for itself and for each crossing on it.
    assert (cells.count, len(cells.crossing)) == (1 + count + crossings, crossings)
    rng = np.random.default_rng(seed)
    places = rng.uniform(LOW, HIGH, (3000, 2))
    cell = cells.cells_at(sides_of(places, points, directions))
    assert (cell >= 0).all()
    share = np.bincount(cell, minlength=cells.count) / 3000
    areas = inner_areas(cells)
    np.testing.assert_allclose(share[list(areas)], np.array(list(areas.values())) / 320, atol=0.04)
    assert all(area > 0 for area in areas.values())
    inside = (rng.random(cells.count) < 0.5) & ~cells.is_border
    assert outline_area(cells, inside) == pytest.approx(sum(areas[i] for i in np.flatnonzero(inside)))


@settings(max_examples=40)
@given(seed=st.integers(0, 10_000), count=st.integers(2, 9))
def test_edges_lie_between_their_cells_and_crossings(seed, count):
    points, directions = lines(seed, count)
    cells = Arrangement(points, directions, LOW, HIGH)
    edges = cells.edges
    normals = np.column_stack([-directions[:, 1], directions[:, 0]])[edges.line]
    middle = points[edges.line] + ((edges.low + edges.high) / 2)[:, None] * directions[edges.line]
    for cell, sign in ((edges.left, 1e-7), (edges.right, -1e-7)):
        beside = sides_of(middle + sign * normals, points, directions)
        assert (cells.cells_at(beside) == cell).mean() > 0.99
    for place, way in ((edges.start, edges.low), (edges.end, edges.high)):
        np.testing.assert_allclose(
            cells.positions[place], points[edges.line] + way[:, None] * directions[edges.line], atol=1e-6
        )
    # Each of the four cells around a crossing lies next to the edge of the first line before or after it.
    for column, beside in enumerate((edges.left, edges.right, edges.left, edges.right)):
        at = edges.end if column < 2 else edges.start
        found = {(place, line): cell for place, line, cell in zip(at, edges.line, beside)}
        firsts = enumerate(cells.crossing[:, 0])
        assert cells.around[:, column].tolist() == [found[place, line] for place, line in firsts]


def test_three_lines_through_one_point_are_parted():
    angle = np.linspace(0, np.pi, 7)[:-1]
    cells = Arrangement(np.zeros((6, 2)), np.column_stack([np.cos(angle), np.sin(angle)]), LOW, HIGH)
    assert cells.count == 1 + 6 + 15


@settings(max_examples=25)
@given(seed=st.integers(0, 10_000))
def test_no_other_choice_of_cells_is_cheaper(seed):
    points, directions = lines(seed, 3)
    cells = Arrangement(points, directions, LOW, HIGH)
    rng = np.random.default_rng(seed)
    n, edges = cells.count, cells.edges
    cost, if_inside, if_outside = rng.uniform(0, 3, len(edges.line)), rng.uniform(0, 4, n), rng.uniform(0, 4, n)

    def total(inside):
        cut = inside[edges.left] != inside[edges.right]
        return cost[cut].sum() + if_inside[inside].sum() + if_outside[~inside].sum()

    found = total(cheapest_cut(edges.left, edges.right, cost, if_inside, if_outside))
    least = min(total(np.array(choice, bool)) for choice in itertools.product((False, True), repeat=n))
    # Costs are rounded to a thousandth each.
    assert found == pytest.approx(least, abs=0.001 * (len(cost) + 2 * n))


@pytest.mark.parametrize("forbidden", [1e3, 3e6, 1e12])
def test_costs_beyond_32_bits_forbid_as_smaller_ones_do(forbidden):
    """Square meters next to large roofs cost more than fits, and such cells were taken for free."""
    cells = Arrangement(np.zeros((1, 2)), np.array([(0.0, 1.0)]), LOW, HIGH)
    cost = np.ones(1)
    sides, place = (cells.edges.left, cells.edges.right), np.eye(2)
    left, right = int(sides[0][0]), int(sides[1][0])
    kept_out = cheapest_cut(*sides, cost, forbidden * place[right], 50 * place[left])
    kept_in = cheapest_cut(*sides, cost, 50 * place[left], forbidden * place[right])
    assert kept_out[[left, right]].tolist() == [True, False]
    assert kept_in[[left, right]].tolist() == [False, True]
