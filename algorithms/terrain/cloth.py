"""A cloth that falls onto the terrain turned upside down."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ..stage import Monitor

# Particles that start over the highest point by this much (m) touch nothing yet.
_ABOVE = 0.05

# Of the authors' program: gravity, the part of its speed that a particle keeps, and the motion (m) that ends the fall.
_GRAVITY, _KEPT_SPEED, _AT_REST = 0.2, 0.99, 0.005

# A particle moves this share of its height difference to a neighbor in each of the passes that rigidness counts.
_SHARE = 0.3

# Order in which a particle meets its neighbors (row, column), first those beside it, then those two steps away. Each
# moves both, so that the order matters: with another, one point in twenty of a steep scene takes another class.
_ORDER = ((-1, -1), (0, -1), (1, -1), (-1, 0), (-1, 1), (0, 1), (1, 0), (1, 1))

# Particles this many columns apart in consecutive rows have no neighbor in common and can be moved together.
_APART = 5

# Rows of a band; bands move together, so that a motion crosses from one to the next only in the step after.
_BAND = 32


class Cloth:
    """Particles on a grid, linked to the neighbors one and two steps away, that fall until they lie on something.

    Parameters
    ----------
    floor : ndarray of shape (rows, columns), float64
        Height below which no particle falls, m.
    rigidness : int
        How often a particle is drawn to each of its neighbors in a step.
    time_step : float
        Time step of the simulation.

    Attributes
    ----------
    height : ndarray of shape (rows, columns), float64
        Height of each particle, m.
    """

    def __init__(self, floor: np.ndarray, rigidness: int, time_step: float) -> None:
        self.floor = floor
        self.fall = _GRAVITY * time_step**4
        # Of two movable particles both move, of a movable and a fixed one only that.
        self.both, self.one = (1 - (1 - 2 * _SHARE) ** rigidness) / 2, 1 - (1 - _SHARE) ** rigidness
        rows, columns = floor.shape
        self.bands = -(-rows // _BAND)
        # Two particles more on all sides, which aren't there: they neither move nor draw.
        shape = (self.bands * _BAND + 4, columns + 4)
        inside = (slice(2, 2 + rows), slice(2, 2 + columns))
        self._height, self._movable, self._draw = np.zeros(shape), np.zeros(shape), np.zeros(shape)
        self.height, self.movable, self.draw = self._height[inside], self._movable[inside], self._draw[inside]
        self.height[:] = floor.max() + _ABOVE
        self.movable[:] = 1.0
        self.before = self.height.copy()

    @property
    def is_movable(self) -> np.ndarray:
        """Return which particles hang freely (rows, columns)."""
        return self.movable > 0

    def settle(self, steps: int, monitor: Monitor) -> int:
        """Let the cloth fall until it hardly moves, at most ``steps`` times; return how often."""
        fronts = self._fronts()
        for step in range(1, steps + 1):
            monitor.progress((step - 1) / steps)
            moved = (self.height - self.before) * _KEPT_SPEED - self.fall
            self.before[:] = self.height
            self.height += moved * self.movable
            np.multiply(self.movable, self.both - self.one, out=self.draw)
            self.draw += self.one
            if np.ptp(self.height) > 0:
                for front in fronts:
                    _draw_together(*front)
            motion = float((np.abs(self.height - self.before) * self.movable).max())
            is_below = self.height < self.floor
            self.height[is_below] = np.where(self.movable > 0, self.floor, self.height)[is_below]
            self.movable[is_below] = 0.0
            if motion < _AT_REST:
                break
        return step

    def _fronts(self) -> list[tuple]:
        """Return what can be moved together, in order: windows on particles and neighbors, and room to work in.

        Particles are met row by row, each row from its first column on. A front holds all that can be met at the
        same time as if they were: in each band, one particle of each row, ``_APART`` columns behind that of the row
        before.
        """
        columns, stride = self.floor.shape[1], self._height.shape[1]
        room = lru_cache(maxsize=None)(self._room)
        fronts = []
        for time in range(columns + _APART * (_BAND - 1)):
            first, last = max(0, -(-(time - columns + 1) // _APART)), min(_BAND - 1, time // _APART)
            start = (2 + first) * stride + 2 + time - _APART * first
            windows = []
            for array in (self._height, self._movable, self._draw):
                windows += [self._window(array, start, last - first + 1, reach) for reach in (0, 1, 2)]
            fronts.append((*windows, *room(last - first + 1)))
        return fronts

    def _window(self, array: np.ndarray, start: int, rows: int, reach: int) -> np.ndarray:
        """Return a view of a front's particles (bands, rows), or, with a reach, of them and those around (3, 3, …)."""
        stride, size = array.shape[1], array.itemsize
        shape: tuple[int, ...] = (self.bands, rows)
        strides: tuple[int, ...] = (_BAND * stride * size, (stride - _APART) * size)
        if reach:
            shape, strides = (3, 3, *shape), (reach * stride * size, reach * size, *strides)
        return np.ndarray(shape, array.dtype, array, (start - reach * stride - reach) * size, strides)

    def _room(self, rows: int) -> tuple:
        """Return the arrays that a front of so many rows works in: heights, shares, differences, one and all pairs."""
        near, far, share_near, share_far, off_near, off_far = (np.zeros((3, 3, self.bands, rows)) for _ in range(6))
        own, part = np.zeros((self.bands, rows)), np.zeros((self.bands, rows))
        pairs = []
        for heights, shares, offs in ((near, share_near, off_near), (far, share_far, off_far)):
            pairs += [(heights[r + 1, c + 1], shares[r + 1, c + 1], offs[r + 1, c + 1]) for r, c in _ORDER]
        return near, far, share_near, share_far, off_near, off_far, own, part, pairs


def _draw_together(
    height,
    height_near,
    height_far,
    movable,
    movable_near,
    movable_far,
    draw,
    draw_near,
    draw_far,
    near,
    far,
    share_near,
    share_far,
    off_near,
    off_far,
    own,
    part,
    pairs,
) -> None:
    """Draw the particles of a front and their neighbors together, neighbor after neighbor."""
    own[:] = height
    near[:] = height_near
    far[:] = height_far
    np.multiply(draw_near, movable, share_near)
    np.multiply(draw_far, movable, share_far)
    for other, share, off in pairs:
        np.subtract(other, own, off)
        np.multiply(off, share, part)
        np.add(own, part, own)
    _give_back(height_near, near, off_near, movable_near, draw, own)
    _give_back(height_far, far, off_far, movable_far, draw, own)


def _give_back(
    target: np.ndarray, heights: np.ndarray, off: np.ndarray, movable: np.ndarray, draw: np.ndarray, own: np.ndarray
) -> None:
    """Move the neighbors of a front's particles by their share of the differences, and store all heights."""
    off *= movable
    off *= draw
    heights -= off
    heights[1, 1] = own
    target[:] = heights
