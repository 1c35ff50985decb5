"""Distinguish doors from windows by the approach: ground, a landing or steps before the opening."""

import numpy as np

from ..criteria import MAJORITY
from ..geometry.groups import least_of
from ..rules import rules

# Distance (m) before a wall from which points are of ground, landings and stairs: sills and cornices jut out less.
FROM_WALL = 0.2

# Distance (m) before a wall up to which ground, landings and stairs lead to a door: a landing is rarely deeper.
BEFORE = 1.5


@rules
class _RULES:
    """What makes an opening a door."""

    # Least height (m): a person walks through. Building codes ask for 2.0 m; a rim may not be seen.
    least_height: float = 1.8
    # Least height (m) of a door whose top a shadow hides: windows with a landing or ground before them are lower.
    cut_height: float = 1.5
    # Largest height (m) of the sill of a door above its approach: two steps of 0.18 m and the noise of the edge.
    step: float = 0.4
    # The wall below a sill is looked for down to this depth (m) below the step: one row of stones.
    below: float = 0.4
    # The approach counts as seen if this share of the columns has points before the wall; stairs and cars cast shadows
    # on the rest.
    least_seen: float = 0.25
    # Width of a column (m): a step that is 0.3 m deep has two points in it from 50 points per m² on.
    column: float = 0.15
    # Without points before a wall, its foot is this quantile of the heights of its points.
    foot: float = 0.01


class Approach:
    """The surroundings of a wall: positions (n, 2), m, along and up, of its points and of those before it.

    Those before it are up to :data:`BEFORE` (m) before it, and at least :data:`FROM_WALL` (m): more where the points of
    the wall itself scatter farther.
    """

    def __init__(self, wall: np.ndarray, before: np.ndarray) -> None:
        self.wall, self.before = (some[np.argsort(some[:, 0], kind="stable")] for some in (wall, before))

    def leads_to(self, box: np.ndarray, has_lintel: bool) -> bool:
        """Return whether a person can walk up to an opening with a box (2, 2), m, and through it.

        The highest surface up to a step above the sill is at most a step below it, in most columns in which one is
        seen. In most columns no wall is seen further down. Where something is seen before less than a quarter of the
        columns, the foot of the wall is taken instead. A shadow hides the top of an opening without a lintel, which may
        therefore be lower.
        """
        low, high = box[:, 1]
        is_high = high - low >= _RULES.least_height
        if not is_high and (has_lintel or high - low < _RULES.cut_height):
            return False
        top = _highest(_between(self.before, box), box, low + _RULES.step)
        is_seen = np.isfinite(top)
        if is_seen.mean() < _RULES.least_seen:
            # Without points before the opening, take the foot of the wall for the ground.
            return bool(is_high and low - np.quantile(self.wall[:, 1], _RULES.foot) <= _RULES.step)
        seen_wall = _highest(_between(self.wall, box), box, low - _RULES.step) > low - _RULES.step - _RULES.below
        is_reached = top[is_seen] >= low - _RULES.step
        return bool(is_reached.mean() >= MAJORITY > seen_wall.mean())


def _between(positions: np.ndarray, box: np.ndarray) -> np.ndarray:
    """Return the positions (k, 2) between the sides of a box; ``positions`` are sorted along the wall."""
    first, last = np.searchsorted(positions[:, 0], box[:, 0])
    return positions[first:last]


def _highest(positions: np.ndarray, box: np.ndarray, limit: float) -> np.ndarray:
    """Return the greatest height (m) up to a limit in each column of a box, -inf where there are no points."""
    left, right = box[:, 0]
    count = max(1, int((right - left) / _RULES.column))
    low = positions[positions[:, 1] <= limit]
    column = np.minimum(((low[:, 0] - left) / (right - left) * count).astype(np.int64), count - 1)
    return -least_of(-low[:, 1], column, count)
