"""The outside of facades, where trees, cars and narrow walls leave few signs of it."""

import numpy as np
import pytest

from lidar_buildings.algorithms.facades.facade_surfaces import facing_outside, plane_of
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.builders import FAR
from lidar_buildings.tests.facades import street_floor, wall, without


def normals(walls, others, shift=(0.0, 0.0, 0.0)):
    """Return the outward normals (m, 2) in plan of walls, which are parts of a cloud with other points."""
    sizes = np.cumsum([0, *map(len, walls)])
    xyz = np.concatenate([*walls, *others]) + shift
    rows = [np.arange(a, b) for a, b in zip(sizes[:-1], sizes[1:])]
    frames = [plane_of(xyz[own])[0] for own in rows]
    found = facing_outside(frames, xyz, rows, np.full(len(rows), 0.05), Monitor())
    return np.array([frame.normal[:2] for frame in found])


@pytest.mark.parametrize("shift", [(0.0, 0.0, 0.0), FAR])
def test_a_wall_in_the_shadow_of_a_tree_and_cars_faces_them(rng, shift):
    """Crown and cars take the place of the wall behind them, as rooms would behind windows; the street is south."""
    front = without(wall(rng, (0, 0), (10, 0)), (2.5, -1, 2), (7.5, 1, 5))
    front = without(front, (0.5, -1, 0), (9.5, 1, 1.6))
    crown = rng.uniform((2.5, -4, 2), (7.5, -1.5, 5), (20_000, 3))
    cars = rng.uniform((0.5, -4, 0), (9.5, -2, 1.6), (10_000, 3))
    floor = street_floor(rng, -1, -4, 12, 2)
    (normal,) = normals([front], [crown, cars, floor], shift)
    assert normal == pytest.approx([0, -1], abs=0.01)


def test_a_wall_with_nothing_before_it_shows_what_is_behind_its_windows(rng):
    front = without(wall(rng, (0, 0), (10, 0)), (2, -1, 1), (4, 1, 3))
    panes = rng.uniform((2, 0.12, 1), (4, 0.2, 3), (500, 3))
    (normal,) = normals([front], [panes])
    assert normal == pytest.approx([0, -1], abs=0.01)


def test_the_narrow_sides_of_a_bay_face_away_from_it(rng):
    """Street and cars lie on both sides of each; the bay, 0.8 m before the wall, shows which side is the front."""
    walls = [
        wall(rng, (0, 0), (4, 0)),
        wall(rng, (4, 0), (4, -0.8)),
        wall(rng, (4, -0.8), (7, -0.8)),
        wall(rng, (7, -0.8), (7, 0)),
        wall(rng, (7, 0), (11, 0)),
    ]
    street = [street_floor(rng, -1, -8, 13, 7.2), rng.uniform((0, -4, 0), (11, -2, 1.5), (3000, 3))]
    # From the left of the street more lies beyond the left side of the bay than beyond its right one.
    street.append(rng.uniform((7.5, -6, 0), (11, -1, 4), (6000, 3)))
    expected = [(0, -1), (-1, 0), (0, -1), (1, 0), (0, -1)]
    assert normals(walls, street) == pytest.approx(np.array(expected, float), abs=0.02)


def test_without_facades_there_is_nothing_to_turn(rng):
    assert facing_outside([], rng.random((5, 3)), [], np.zeros(0), Monitor()) == []
