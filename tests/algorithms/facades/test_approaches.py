"""What leads up to an opening 1 m wide whose sill is 2 m above the street, each rule with a case that it decides."""

import numpy as np
import pytest

from lidar_buildings.algorithms.facades.approaches import Approach

SPACING = 0.05
LEFT, RIGHT, SILL = 1.0, 2.0, 2.0

LANDING = (LEFT, SILL - 0.1, RIGHT, SILL - 0.1)
STREET = (LEFT, 0.0, RIGHT, 0.0)
WALL_BELOW = (LEFT, 0.0, RIGHT, SILL)


def filled(west, low, east, high):
    """Return positions (n, 2), m, evenly spaced in a rectangle or along a line."""
    along, up = np.meshgrid(np.arange(west, east + 1e-9, SPACING), np.arange(low, high + 1e-9, SPACING))
    return np.column_stack([along.ravel(), up.ravel()])


def is_door(before, *, below=(), height=2.2, has_lintel=True, foot=0.0):
    """Return whether a person can go through, with wall on both sides of the opening from its foot to 6 m."""
    sides = (LEFT - 1, foot, LEFT - SPACING, 6.0), (RIGHT + SPACING, foot, RIGHT + 1, 6.0)
    wall = np.concatenate([filled(*part) for part in (*sides, *below)])
    seen = np.concatenate([np.zeros((0, 2)), *(filled(*part) for part in before)])
    return Approach(wall, seen).leads_to(np.array([[LEFT, SILL], [RIGHT, SILL + height]]), has_lintel)


def test_a_landing_leads_to_a_door():
    assert is_door([LANDING])


def test_the_street_two_meters_below_does_not():
    """Nothing is seen of the wall below the sill: the height of the street decides."""
    assert not is_door([STREET])


def test_a_ledge_with_wall_below_it_does_not():
    assert not is_door([LANDING], below=[WALL_BELOW])


@pytest.mark.parametrize(
    ("height", "has_lintel", "expected"),
    [(1.75, True, False), (1.85, True, True), (1.75, False, True), (1.45, False, False)],
)
def test_only_an_opening_whose_top_is_hidden_may_be_lower(height, has_lintel, expected):
    """A door is 1.8 m high; without a lintel, where a shadow may hide its top, 1.5 m."""
    assert is_door([LANDING], height=height, has_lintel=has_lintel) is expected


@pytest.mark.parametrize(("seen", "expected"), [(0.1, False), (0.3, True)])
def test_less_than_a_quarter_of_the_width_is_no_landing(seen, expected):
    """A hand or a sign covers a tenth of it; then the foot of the wall decides, two meters below."""
    assert is_door([(LEFT, SILL - 0.1, LEFT + seen, SILL - 0.1)]) is expected


@pytest.mark.parametrize(
    ("foot", "height", "has_lintel", "expected"),
    [(1.8, 2.2, True, True), (1.4, 2.2, True, False), (1.8, 1.7, False, False)],
)
def test_where_nothing_is_seen_the_foot_of_the_wall_decides(foot, height, has_lintel, expected):
    """The sill is at most 0.4 m above it, and the opening has the full height: nothing shows what a shadow hides."""
    assert is_door([], foot=foot, height=height, has_lintel=has_lintel) is expected
