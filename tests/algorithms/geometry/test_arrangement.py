"""Cells of lines: how many there are, that they tile the rectangle, and that the cheapest choice is the cheapest."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidar_buildings.algorithms.geometry.arrangement import Arrangement, sides_of
from lidar_buildings.algorithms.geometry.rings import signed_area

LOW, HIGH = np.array([-10.0, -8.0]), np.array([10.0, 8.0])


def lines(seed, count):
    rng = np.random.default_rng(seed)
    angle = rng.uniform(0, np.pi, count)
    return rng.uniform(-6, 6, (count, 2)), np.column_stack([np.cos(angle), np.sin(angle)])


def ring_of(cells, names):
    ring = np.array([cells.corner(name) for name in names])
    return np.concatenate([ring, ring[:1]])


def cell_areas(cells):
    found = []
    for ring in cells.rings:
        names = [tuple(sorted(pair)) for pair in zip([ring[-1], *ring], ring)]
        found.append(signed_area(ring_of(cells, names)))
    return np.array(found)


def outline_area(cells, inside):
    return sum(signed_area(ring_of(cells, [name for _, name in ring])) for ring in cells.outline(inside))


def test_two_by_two_lines_make_nine_cells():
    points = np.array([(-2.0, 0), (3, 0), (0, -1), (0, 4)])
    directions = np.array([(0.0, 1), (0, 1), (1, 0), (1, 0)])
    cells = Arrangement(points, directions, LOW, HIGH)
    assert sorted(cell_areas(cells)) == pytest.approx(sorted(a * b for a in (8, 5, 7) for b in (7, 5, 4)))
    middle = cells.cells_at(sides_of(np.array([[0.0, 0.0], [2.9, 3.9]]), points, directions))
    assert middle[0] == middle[1]
    inside = np.arange(9) == middle[0]
    (ring,) = cells.outline(inside)
    assert {line for line, _ in ring} == {0, 1, 2, 3}
    assert outline_area(cells, inside) == pytest.approx(25)
    # Everything but the middle has a hole.
    assert sorted(
        signed_area(ring_of(cells, [n for _, n in ring])) for ring in cells.outline(~inside)
    ) == pytest.approx([-25, 320])


@settings(max_examples=40)
@given(seed=st.integers(0, 10_000), count=st.integers(0, 7))
def test_cells_tile_the_rectangle_and_are_as_many_as_lines_make(seed, count):
    points, directions = lines(seed, count)
    cells = Arrangement(points, directions, LOW, HIGH)
    assert cell_areas(cells).min() > 0
    assert cell_areas(cells).sum() == pytest.approx(320)
    crossings = 0
    for a, b in itertools.combinations(range(count), 2):
        place = cells.corner((a, b))
        crossings += ((place > LOW) & (place < HIGH)).all()
    assert len(cells.rings) == 1 + count + crossings
    # Every line through the rectangle adds a cell for itself and for each crossing on it.
    rng = np.random.default_rng(seed)
    inside = rng.random(len(cells.rings)) < 0.5
    assert outline_area(cells, inside) == pytest.approx(cell_areas(cells)[inside].sum())
    places = rng.uniform(LOW, HIGH, (300, 2))
    cell = cells.cells_at(sides_of(places, points, directions))
    assert (cell >= 0).all()
    share = np.bincount(cell, minlength=len(cells.rings)) / 300
    np.testing.assert_allclose(share, cell_areas(cells) / 320, atol=0.12)


@settings(max_examples=25)
@given(seed=st.integers(0, 10_000))
def test_no_other_choice_of_cells_is_cheaper(seed):
    points, directions = lines(seed, 3)
    cells = Arrangement(points, directions, LOW, HIGH)
    rng = np.random.default_rng(seed)
    n = len(cells.rings)
    cost, if_inside, if_outside = rng.uniform(0, 3, len(cells.edges)), rng.uniform(0, 4, n), rng.uniform(0, 4, n)

    def total(inside):
        extended = np.append(inside, False)
        cut = np.array([extended[edge.left] != extended[edge.right] for edge in cells.edges])
        return cost[cut].sum() + if_inside[inside].sum() + if_outside[~inside].sum()

    found = total(cells.cheapest(cost, if_inside, if_outside))
    least = min(total(np.array(choice, bool)) for choice in itertools.product((False, True), repeat=n))
    # Costs are rounded to a thousandth each.
    assert found == pytest.approx(least, abs=0.001 * (len(cost) + 2 * n))


@pytest.mark.parametrize("forbidden", [1e3, 3e6, 1e12])
def test_costs_beyond_32_bits_forbid_as_smaller_ones_do(forbidden):
    """Square meters beside large roofs cost more than fits, and such cells were taken for free."""
    cells = Arrangement(np.zeros((1, 2)), np.array([(0.0, 1.0)]), LOW, HIGH)
    cost = np.ones(len(cells.edges))
    kept_out = cells.cheapest(cost, np.array([0.0, forbidden]), np.array([50.0, 0.0]))
    kept_in = cells.cheapest(cost, np.array([50.0, 0.0]), np.array([0.0, forbidden]))
    assert kept_out.tolist() == [True, False]
    assert kept_in.tolist() == [False, True]
