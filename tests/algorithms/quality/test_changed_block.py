"""Buildings of a map drawn again: walls that a map has twice, and what overlaps what stays."""

import numpy as np
import pytest

from lidar_buildings.algorithms.footprints.soft_shares import Lattice
from lidar_buildings.algorithms.geometry.polygon_overlap import are_within
from lidar_buildings.algorithms.geometry.rings import polygon_area, sides_of_rings
from lidar_buildings.algorithms.quality.changed_block import _is_sound, draw_labels


def box(west, east):
    """Return the rings of a house 8 m deep."""
    return [np.array([[west, 0], [east, 0], [east, 8], [west, 8], [west, 0]], float)]


def drawn(one, other, is_fixed):
    """Return the areas (m²) of two houses by label, where both are drawn as they were or the other one stays."""
    lattice = Lattice.around(np.concatenate([one[0], other[0]]), 0.5)
    wanted = np.zeros(len(lattice.positions), int)
    for label, rings in ((1, one), (-1 if is_fixed else 2, other)):
        wanted[are_within(lattice.positions, sides_of_rings(rings))] = label
    old, fixed = ([one], [other]) if is_fixed else ([one, other], [])
    made = draw_labels(lattice, wanted.reshape(lattice.shape), old, fixed, [], 1.0)
    return {label: sum(map(polygon_area, polygons)) for label, polygons in made.items()}


@pytest.mark.parametrize(("gap", "between"), [(0.04, 0.0), (0.08, 0.64)])
def test_a_wall_that_the_map_has_twice_is_one_and_a_wider_gap_stays(gap, between):
    """Nodes of the lattice, at whole quarters of a meter, lie in the gap."""
    areas = drawn(box(0, 9.98), box(9.98 + gap, 20), is_fixed=False)
    assert 8 * 20 - sum(areas.values()) == pytest.approx(between, abs=0.01)


@pytest.mark.parametrize("overlap", [0.0009, 0.0015, 0.003])
def test_a_house_is_drawn_where_the_map_has_it_some_millimeters_within_what_stays(overlap):
    assert list(drawn(box(0, 10.1 + overlap), box(10.1, 20), is_fixed=True)) == [1]


@pytest.mark.parametrize(("overlap", "is_sound"), [(0.004, True), (0.006, False)])
def test_a_polygon_overlaps_what_stays_by_a_millimeter_of_its_outline_at_most(overlap, is_sound):
    """The outline is 36 m long, the overlap 8 m."""
    house, stays = box(0, 10), box(10 - overlap, 20)
    lattice = Lattice.around(house[0], 0.5)
    count = are_within(lattice.positions, sides_of_rings(house)).sum()
    assert _is_sound([house], count, lattice, [stays], 1.0) == is_sound
