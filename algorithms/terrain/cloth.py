"""A cloth that falls onto the terrain turned upside down.

Particles draw their neighbors one after the other, row by row, as in the program that the authors of the method
published: in another order, part of a steep scene takes another class. Particles without a neighbor in common can be
moved together all the same. They are a wavefront: all with one value of ``column + 5 row + 30 step``. Of two particles
that have a neighbor in common, the one that comes first in the loop over steps, rows and columns has the smaller value.
So the next steps start in the first rows long before a step has come to the last ones.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..rules import rule, rules
from ..stage import Monitor


@rules
class _PROGRAM:
    """Constants of the program that the authors of the method published; the paper leaves them open."""

    share: float = rule(0.3, "share of its height difference", "to a neighbor that a particle moves in one pass")
    gravity: float = rule(0.2, "m", "fall in a step of a particle at rest, with a time step of 1")
    kept_speed: float = rule(0.99, "share of its speed", "that a particle keeps from step to step")
    at_rest: float = rule(0.005, "m", "greatest motion in the step that ends the fall")


# Neighbors (row, column) in the order in which a particle draws them: first those next to it, then those two away.
_BESIDE = ((-1, -1), (0, -1), (1, -1), (-1, 0), (-1, 1), (0, 1), (1, 0), (1, 1))
NEIGHBORS = tuple((reach * row, reach * column) for reach in (1, 2) for row, column in _BESIDE)

# Lag (columns) of a row behind the row before it: neighborhoods of particles are as many columns wide.
_APART = len({column for _, column in NEIGHBORS})

# Lag (wavefronts of _APART phases each) of the landing of a particle behind its own motion: after the last time that
# others draw it, whose values are up to 12 more than its own.
_LANDING_LAG = -(-max(column + _APART * row for row, column in NEIGHBORS) // _APART)

# Wavefronts by which a step is behind the one before: neighbors that are drawn late have landed before, too.
_STEP_LAG = 2 * _LANDING_LAG

# Number of steps made together: with more a wavefront is fuller, but more steps are repeated when the cloth comes to
# rest.
_STEPS_AT_ONCE = 32

# Positions and diagonals around the stored particles: neighbors of those at the rim.
_MARGIN = max(abs(row + column // _APART) for row, column in NEIGHBORS)

_EVERYTHING = slice(None)


class _Front(NamedTuple):
    """Particles that are moved together: one phase on every ``_STEP_LAG``-th diagonal, each of them in another step."""

    phase: int
    first_diagonal: int
    last_step: int
    diagonals: int


@dataclass(frozen=True)
class _Order:
    """How particles are stored: by phase (column modulo 5), diagonal (column // 5 + row) and position on that.

    The position is the row or the column // 5, whichever has the smaller range.
    """

    rows: int
    columns: int

    @cached_property
    def blocks(self) -> int:
        """Blocks of five columns."""
        return -(-self.columns // _APART)

    @cached_property
    def is_by_row(self) -> bool:
        """Whether rows are the positions on a diagonal."""
        return self.rows < self.blocks

    @cached_property
    def diagonals(self) -> int:
        """Number of diagonals."""
        return self.rows + self.blocks

    @cached_property
    def breadth(self) -> int:
        """Positions on a diagonal, with a margin on either side."""
        return min(self.rows, self.blocks) + 2 * _MARGIN

    @cached_property
    def turns(self) -> int:
        """Diagonals that are ``_STEP_LAG`` apart, with a margin."""
        return -(-(self.diagonals + 2 * _MARGIN) // _STEP_LAG)

    @cached_property
    def size(self) -> int:
        """Length of the arrays that hold the particles and a margin around: what a front moves lies side by side."""
        return _APART * _STEP_LAG * self.turns * self.breadth + 2 * _MARGIN

    def start(self, phase: int, diagonal: int, position: int) -> int:
        """Return the offset of a diagonal in memory; the diagonal ``_STEP_LAG`` later follows it."""
        turn, rest = divmod(diagonal + _MARGIN, _STEP_LAG)
        return ((phase * _STEP_LAG + rest) * self.turns + turn) * self.breadth + _MARGIN + position

    def positions(self) -> np.ndarray:
        """Return the offsets (rows, columns) of the particles in memory."""
        row, column = np.mgrid[: self.rows, : self.columns]
        block, phase = np.divmod(column, _APART)
        turn, rest = np.divmod(block + row + _MARGIN, _STEP_LAG)
        position = (row if self.is_by_row else block) + _MARGIN
        return ((phase * _STEP_LAG + rest) * self.turns + turn) * self.breadth + _MARGIN + position

    def own(self, front: _Front) -> slice:
        """Return the slice of memory that holds the particles of a front, and the margins between their diagonals."""
        start = self.start(front.phase, front.first_diagonal, 0)
        return slice(start, start + front.diagonals * self.breadth)

    def neighbors(self, phase: int, diagonal: int) -> list[int]:
        """Return the offsets of the neighbors of particles in memory, in the order in which they are drawn.

        It depends on the diagonal by its remainder to ``_STEP_LAG`` only.
        """
        start, shifts = self.start(phase, diagonal, 0), []
        for row, column in NEIGHBORS:
            block, other = divmod(phase + column, _APART)
            shifts.append(self.start(other, diagonal + block + row, row if self.is_by_row else block) - start)
        return shifts

    def front(self, time: int, phase: int, steps: int) -> _Front:
        """Return the particles moved at a time, counted in wavefronts, of the first ``steps`` steps."""
        first_step = max(0, -(-(time - self.diagonals + 1) // _STEP_LAG))
        last_step = min(steps - 1, time // _STEP_LAG)
        return _Front(phase, time - _STEP_LAG * last_step, last_step, max(0, last_step - first_step + 1))


@dataclass
class _State:
    """State of the particles, as they are stored; in the margin nothing moves or draws."""

    #: height, before: Height (m), and height at the step before
    height: np.ndarray
    before: np.ndarray
    floor: np.ndarray  #: Height (m) at which the particle lands; -inf in the margin
    movable: np.ndarray  #: 1 until it has landed, then 0
    #: Share of a height difference by which it draws a movable neighbor: that one moves all of the way or, if both are
    #: movable, half of it
    draw: np.ndarray

    def copy(self) -> _State:
        """Return a copy, but for the floor, which doesn't change."""
        return replace(self, **{name: getattr(self, name).copy() for name in ("height", "before", "movable", "draw")})


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
    top : float, optional
        Height of the highest point, m, over which the particles start; the highest floor's if None. The highest
        point is on no floor where another point is nearer to its particle.
    """

    def __init__(self, floor: np.ndarray, rigidness: int, time_step: float, top: float | None = None) -> None:
        self.floor = floor
        # Shares of a difference that both of two particles move, or the only movable one.
        both, self._one = (1 - (1 - 2 * _PROGRAM.share) ** rigidness) / 2, 1 - (1 - _PROGRAM.share) ** rigidness
        # The fall (m) per step and step.
        self._gravity = _PROGRAM.gravity * time_step**4
        self._order = _Order(*floor.shape)
        self._positions = self._order.positions()
        zero = np.zeros(self._order.size)
        self._state = _State(zero, zero.copy(), np.full(self._order.size, -np.inf), zero.copy(), zero.copy())
        # So high (m) they touch nothing yet.
        start = (floor.max() if top is None else top) + 0.05
        values = {"height": start, "before": start, "floor": floor, "movable": 1.0, "draw": both}
        for name, value in values.items():
            getattr(self._state, name)[self._positions] = value
        room = _STEPS_AT_ONCE * self._order.breadth
        self._own, self._off, self._part = np.zeros(room), np.zeros(room), np.zeros(room)
        self._shifts = [[self._order.neighbors(phase, lag) for lag in range(_STEP_LAG)] for phase in range(_APART)]

    @property
    def height(self) -> np.ndarray:
        """Height (rows, columns) of each particle, m."""
        return self._state.height[self._positions]

    @property
    def is_movable(self) -> np.ndarray:
        """Which particles (rows, columns) hang freely."""
        return self._state.movable[self._positions] > 0

    def settle(self, steps: int, monitor: Monitor) -> int:
        """Let the cloth fall until it hardly moves, in at most ``steps`` steps; return their number."""
        done, is_level = 0, True
        while done < steps:
            count = 1 if is_level else min(_STEPS_AT_ONCE, steps - done)
            before = self._state.copy() if count > 1 else None
            part = monitor.part(done / steps, (done + count) / steps)
            motion = self._fall_level() if is_level else self._make(count, part)
            resting = np.flatnonzero(motion < _PROGRAM.at_rest)
            if len(resting):
                count = int(resting[0]) + 1
                if before is not None and count < len(motion):
                    self._state = before
                    # The same steps again, which the progress has counted.
                    self._make(count, part.part(1.0, 1.0))
                return done + count
            done += count
            # Until the first particle lands, all are at one height and none draws another.
            is_level = is_level and bool(self.is_movable.all())
        return done

    def _fall_level(self) -> np.ndarray:
        """Make one step in which no particle draws another; return the greatest motion (1,) in it (m)."""
        self._fall(_EVERYTHING)
        return np.atleast_1d(self._land(_EVERYTHING).max())

    def _make(self, steps: int, monitor: Monitor) -> np.ndarray:
        """Make some steps; return the greatest motion (steps,) in each (m)."""
        motion = np.zeros(steps)
        self._fall(_EVERYTHING)
        times = self._order.diagonals + _STEP_LAG * (steps - 1) + _LANDING_LAG
        for time in range(times):
            for phase in range(_APART):
                drawing = self._order.front(time, phase, steps)
                if drawing.diagonals:
                    self._draw(drawing)
                landing = self._order.front(time - _LANDING_LAG, phase, steps)
                if landing.diagonals:
                    self._land_and_fall(landing, motion)
            monitor.progress((time + 1) / times)
        return motion

    def _draw(self, front: _Front) -> None:
        """Draw the particles of a front and their neighbors together, neighbor after neighbor."""
        state, where = self._state, self._order.own(front)
        own, off, part = (array[: where.stop - where.start] for array in (self._own, self._off, self._part))
        movable, draw = state.movable[where], state.draw[where]
        own[:] = state.height[where]
        for shift in self._shifts[front.phase][front.first_diagonal % _STEP_LAG]:
            beside = slice(where.start + shift, where.stop + shift)
            other = state.height[beside]
            np.subtract(other, own, off)
            np.multiply(state.draw[beside], movable, part)
            np.multiply(off, part, part)
            np.add(own, part, own)
            np.multiply(off, state.movable[beside], off)
            np.multiply(off, draw, off)
            np.subtract(other, off, other)
        state.height[where] = own

    def _land_and_fall(self, front: _Front, motion: np.ndarray) -> None:
        """Let particles land, record the lengths of their steps, and let those that have steps left fall on."""
        # The first diagonal is the last step's.
        moved = self._land(self._order.own(front)).reshape(front.diagonals, -1).max(axis=1)[::-1]
        steps = slice(front.last_step - front.diagonals + 1, front.last_step + 1)
        motion[steps] = np.maximum(motion[steps], moved)
        if front.last_step == len(motion) - 1:
            front = _Front(front.phase, front.first_diagonal + _STEP_LAG, front.last_step - 1, front.diagonals - 1)
        if front.diagonals:
            self._fall(self._order.own(front))

    def _fall(self, where: slice) -> None:
        """Begin the step of the particles stored there: those that are movable fall."""
        height, before = self._state.height[where], self._state.before[where]
        moved = (height - before) * _PROGRAM.kept_speed - self._gravity
        before[:] = height
        height += moved * self._state.movable[where]

    def _land(self, where: slice) -> np.ndarray:
        """End the step of the particles stored there: those below the floor land on it; return the motion of each."""
        state = self._state
        height, floor, movable = state.height[where], state.floor[where], state.movable[where]
        moved = np.abs(height - state.before[where]) * movable
        is_below = height < floor
        np.copyto(height, floor, where=is_below)
        np.copyto(movable, 0.0, where=is_below)
        np.copyto(state.draw[where], self._one, where=is_below)
        return moved
