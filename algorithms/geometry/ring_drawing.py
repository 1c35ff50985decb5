"""Draw a ring with straight edges: the cheapest division into runs of samples with a direction each.

Every run has one of a few oriented directions. A run costs the squared distances of its samples from its line, a corner
by its angle. One dynamic program decides on all corners and directions at once, so that there is no order of choices in
which a small change of the samples could change all that follow.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..criteria import PARALLEL
from .principal_axes import principal_axes

# Shortest run, in samples: shorter edges are drawn as steps between two runs.
_SHORTEST = 3

# Ends of runs whose costs are computed in one batch, a multiple of the shortest run: fewer calls of numpy.
_AT_ONCE = 8 * _SHORTEST

# Angle (°) between directions besides the main ones: any wall is within half of it, and the line is fitted.
_FAN = 15.0

# A run must advance by at least this share of its length; less is a bulge, no edge.
_ADVANCE = 0.5

# Greatest distance (steps) of a corner from where the runs part: the corner of a sharp angle lies that far off.
_FARTHEST = 6.0


@dataclass(frozen=True)
class Prices:
    """Costs of corners and directions; all but ``corner`` are multiples of it."""

    corner: float  #: Price of a right-angled corner, m³: as of leaving out a bay of two spacings by four
    flat: float = 1.5  #: Corner that turns by less than 20°, which noise makes more easily than a sharper one
    #: Corner that turns by 20° to 70°. With 1.0, a corner of a house that is cut off over 7 m is drawn as a notch at
    #: 2 points per m² in 36 of 40 draws, with 0.8 in 11.
    obtuse: float = 0.8
    step: float = 2.0  #: Step or turn by 180°, both of which are drawn with two corners
    #: Corner that turns by 170° or more. Corners from 110° on have a price between a right angle's and this.
    #: One of 116° costs as much as the two obtuse ones that would cut it off; with 4.0 these are drawn.
    sharp: float = 2.8
    #: Edge along the second main direction. With 1.0, the short side of a house whose front is oblique was drawn
    #: parallel to the front's direction.
    second: float = 0.5
    other: float = 1.75  #: Edge along neither main direction
    #: curved, other_curved: A ring with curved walls pays ``curved`` once and ``other_curved`` for each edge along
    #: neither main direction, if this sum is less than with ``other``
    curved: float = 15.0
    other_curved: float = 0.5
    round: float = 0.2  #: Corner of a ring without main directions, which is drawn in chords


@dataclass(frozen=True)
class Edge:
    """A straight edge of a ring: from ``start`` to ``end`` (2,), m; ``is_main`` if along a main direction."""

    start: np.ndarray
    end: np.ndarray
    is_main: bool


def draw_ring(samples: np.ndarray, directions: np.ndarray, prices: Prices) -> list[Edge]:
    """Return the edges of the ring that costs least.

    Parameters
    ----------
    samples : ndarray of shape (n, 2)
        Positions at equal steps along the ring (m), the first not repeated, the inside to the left.
    directions : ndarray of shape (k,)
        Main directions of the building, °, at most two, the heavier first; without any all are equally good.
    prices : Prices
        What corners and directions cost.

    Returns
    -------
    list of Edge
        In the order of the samples, each beginning where the one before ends. They may cross each other.

    References
    ----------
    Perez, J. C., Vidal, E., 1994. Optimum polygonal approximation of digitized curves. Pattern Recognition Letters 15
    (8), 743-750. [perez1994]
    Killick, R., Fearnhead, P., Eckley, I. A., 2012. Optimal detection of changepoints with a linear computational cost.
    Journal of the American Statistical Association 107 (500), 1590-1598 (which starts of runs can be left out).
    [killick2012]
    """
    if not len(directions):
        return _drawn(samples, _Ways.of(directions, replace(prices, corner=prices.round * prices.corner), 0.0))[1]
    cost, edges = _drawn(samples, _Ways.of(directions, prices, prices.other))
    # A ring with curved walls saves the difference of the prices for each edge along neither main direction. To cost
    # less it needs more of them than this, and each has a corner.
    n_edges = prices.curved / (prices.other - prices.other_curved)
    if cost > (prices.curved + n_edges * (prices.obtuse + prices.other_curved)) * prices.corner:
        curved_cost, curved = _drawn(samples, _Ways.of(directions, prices, prices.other_curved))
        if curved_cost + prices.curved * prices.corner < cost:
            return curved
    return edges


def _drawn(samples: np.ndarray, ways: _Ways) -> tuple[float, list[Edge]]:
    """Return the cost of the cheapest ring along some ways, m³, and its edges."""
    corner, after = _Chain(samples, ways).sure_corner()
    chain = _Chain(np.roll(samples, -corner, axis=0), ways)
    cost, runs = chain.closed_runs(after)
    lines = [chain.line(*run) for run in runs]
    return cost, _joined(lines, [chain.vertices[run[0]] for run in runs], chain.step)


@dataclass(frozen=True)
class _Ways:
    """Oriented directions of runs, the main ones first.

    The line of a run along another direction is fitted to its samples, up to half of the angle between two directions
    off.
    """

    angle: np.ndarray  #: (k,): directions, °
    unit: np.ndarray  #: (k, 2): unit vectors along these
    is_main: np.ndarray  #: (k,), bool: which of these are main directions
    price: np.ndarray  #: (k,): what a run costs, m³
    turn: np.ndarray  #: (k, k): what a turn from one to another and the run after it cost, m³

    @property
    def n_fixed(self) -> int:
        """Number of ways along main directions, which come first."""
        return int(self.is_main.sum())

    @classmethod
    def of(cls, directions: np.ndarray, prices: Prices, other: float) -> _Ways:
        main = [angle + np.arange(0.0, 360.0, 90.0) for angle in directions]
        fan = np.arange(0.0, 360.0, _FAN) + (directions[0] if main else 0.0)
        angle = np.concatenate([*main, fan])
        sizes = [*(len(one) for one in main), len(fan)]
        costs = [0.0, prices.second][: len(main)] + [other]
        price = prices.corner * np.repeat(costs, sizes)
        turned = (angle - angle[:, None] + 180.0) % 360.0 - 180.0
        turn = prices.corner * _turn_prices(turned, prices) + price
        unit = np.column_stack([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
        return cls(angle, unit, np.arange(len(angle)) < len(angle) - len(fan), price, turn)


def _turn_prices(turned: np.ndarray, prices: Prices) -> np.ndarray:
    """Return the costs of turns by angles (°, -180 to 180), in multiples of a right-angled corner."""
    size = np.abs(turned)
    # In proportion, from the price at 90° to that at 170°.
    sharp = 1 + (prices.sharp - 1) * np.clip((size - 90) / 80, 0.0, 1.0)
    cost = np.select([size < 20, size <= 70, size > 110], [prices.flat, prices.obtuse, sharp], 1.0)
    # Two directions are the same or opposite within half a degree of rounding.
    return np.where((size < 0.5) | (size > 179.5), prices.step, cost)


class _Chain:
    """Samples of a ring from the first one on, once around, and sums over the pieces between them."""

    def __init__(self, samples: np.ndarray, ways: _Ways) -> None:
        self.ways = ways
        self.vertices = np.concatenate([samples, samples[:1]])
        self.middles = (self.vertices[1:] + self.vertices[:-1]) / 2
        origin = samples.mean(axis=0)
        self.step = float(np.hypot(*np.diff(self.vertices, axis=0).T).mean())
        fixed = ways.unit[: ways.n_fixed]
        across = (self.middles - origin) @ np.column_stack([-fixed[:, 1], fixed[:, 0]]).T
        none = np.zeros((1, len(fixed)))
        self.sums = np.concatenate([none, np.cumsum(across, axis=0)])
        self.squares = np.concatenate([none, np.cumsum(across**2, axis=0)])
        x, y = (self.middles - origin).T
        # Store sums of one kind contiguously: numpy is slow on rows of a few numbers.
        self.moments = np.zeros((5, len(x) + 1))
        np.cumsum([x, y, x * x, y * y, x * y], axis=1, out=self.moments[:, 1:])
        self.columns = np.ascontiguousarray(self.vertices.T)
        self.along = (self.vertices - origin) @ fixed.T

    def sure_corner(self) -> tuple[int, int]:
        """Return the sample at which a run begins, and its way; the run before it and itself are long."""
        n = len(self.middles)
        # The first corner is searched in a stretch of 64 samples, which is doubled until it holds one.
        length = min(n, 64)
        while True:
            _, runs = self._runs(self.ways.price, np.zeros_like(self.ways.price), length)
            if len(runs) > 1 or length == n:
                break
            length = min(n, 2 * length)
        size = [stop - start for start, stop, _ in runs]
        if len(runs) == 1:
            return 0, runs[0][2]
        best = max(range(1, len(runs)), key=lambda i: min(size[i - 1], size[i]))
        return runs[best][0], runs[best][2]

    def closed_runs(self, after: int) -> tuple[float, list[tuple[int, int, int]]]:
        """Return the cost of the cheapest runs once around from the first sample on, and these.

        ``after`` is the way of the first run.
        """
        start = np.full(len(self.ways.price), np.inf)
        start[after] = 0.0
        return self._runs(start, self.ways.turn[:, after], len(self.middles))

    def _runs(self, start: np.ndarray, end: np.ndarray, length: int) -> tuple[float, list[tuple[int, int, int]]]:
        """Return the cost of the cheapest runs from the first sample over a length, and these: first, last sample, way.

        ``start`` and ``end`` (k,) are the costs to begin and to end by each way.
        """
        cost = np.full((length + 1, len(start)), np.inf)
        came, turned = np.zeros((2, length + 1, len(start)), np.int64)
        every, turn_to = np.arange(len(start)), np.ascontiguousarray(self.ways.turn.T)
        # Samples that runs may begin at, ascending, and the costs to begin there by each way (k, a).
        firsts, begun = np.zeros(1, np.int64), start[:, None]
        for first in range(_SHORTEST, length + 1, _AT_ONCE):
            batch = np.arange(first, min(first + _AT_ONCE, length + 1))
            n_before, firsts = len(firsts), np.concatenate([firsts, batch])
            begun = np.concatenate([begun, np.empty((len(start), len(batch)))], axis=1)
            allowed, least = self._run_costs(firsts, batch)
            for at in range(0, len(batch), _SHORTEST):
                own, ends, n_starts = slice(at, at + _SHORTEST), batch[at : at + _SHORTEST], n_before + at
                total = allowed[own, :, :n_starts] + begun[:, :n_starts]
                best = total.argmin(axis=2)
                row = np.arange(len(ends))[:, None]
                cost[ends] = reached = total[row, every, best]
                came[ends] = firsts[best]
                turns = reached[:, None, :] + turn_to
                turned[ends] = way = turns.argmin(axis=2)
                begun[:, n_starts : n_starts + len(ends)] = turns[row, every, way].T
            # Runs have a least length: to the ends after this batch they lead from all but the last of its samples.
            if len(batch) > _SHORTEST:
                stays = self._stays(len(firsts) - 1 - _SHORTEST, begun, [costs[-1 - _SHORTEST] for costs in least])
                firsts, begun = firsts[stays], begun[:, stays]
        whole = cost[length] + end
        return float(whole.min()), self._traced(whole, came, turned)

    def _stays(self, end: int, begun: np.ndarray, least: list[np.ndarray]) -> np.ndarray:
        """Return the mask of starts of runs (a,) that reach an end at less cost than a run that begins there.

        Others need not be tried for later ends. ``end`` is its row among the starts, ``begun`` (k, a) the cost to begin
        there, ``least`` the cost of runs to the end by each main way (m, a) and by the others (a,).
        """
        (fixed, free), n_fixed, begins = least, self.ways.n_fixed, begun[:, end, None]
        stays = (begun[:n_fixed] + fixed < begins[:n_fixed]).any(axis=0)
        stays |= (begun[n_fixed:] + free < begins[n_fixed:]).any(axis=0)
        stays[max(end - _SHORTEST + 1, 0) :] = True
        return stays

    def _run_costs(self, firsts: np.ndarray, ends: np.ndarray) -> tuple[np.ndarray, tuple[np.ndarray, np.ndarray]]:
        """Return the costs of runs from samples (a,) to samples (b,) by each way (b, k, a), infinite where forbidden.

        Of all other ways only the one nearest to the best line is allowed. Also returned are the costs without this
        check, for each main way (b, m, a) and for the others (b, a).
        """
        fixed, is_run = self._fixed_costs(firsts, ends)
        free, way, is_free_run = self._free_costs(firsts, ends)
        allowed = np.full((len(ends), len(self.ways.price), len(firsts)), np.inf)
        np.copyto(allowed[:, : self.ways.n_fixed], fixed, where=is_run)
        row, column = np.nonzero(is_free_run)
        allowed[row, way[row, column], column] = free[row, column]
        return allowed, (fixed, free)

    def _fixed_costs(self, firsts: np.ndarray, ends: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the costs (b, m, a) of runs from samples (a,) to samples (b,) by each main way, and which can be."""
        count = (ends[:, None] - firsts)[:, None]
        sums, squares, along = (of[ends, :, None] - of[firsts].T for of in (self.sums, self.squares, self.along))
        is_run = (along >= _ADVANCE * self.step * count) & (count >= _SHORTEST)
        return self.step * (squares - sums**2 / np.maximum(count, 1)), is_run

    def _free_costs(self, firsts: np.ndarray, ends: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the costs (b, a) of runs along the best lines, by which of the other ways, and which can be."""
        count = np.maximum(ends[:, None] - firsts, 1)
        x, y, xx, yy, xy = self.moments[:, ends, None] - self.moments[:, None, firsts]
        xx, yy, xy = xx - x * x / count, yy - y * y / count, xy - x * y / count
        least = np.maximum((xx + yy) / 2 - np.hypot((xx - yy) / 2, xy), 0.0)
        angle = np.degrees(np.arctan2(2 * xy, xx - yy)) / 2
        east, north = self.columns[:, ends, None] - self.columns[:, None, firsts]
        along = east * np.cos(np.radians(angle)) + north * np.sin(np.radians(angle))
        is_run = (np.abs(along) >= _ADVANCE * self.step * count) & (ends[:, None] - firsts >= _SHORTEST)
        n_free = round(360 / _FAN)
        way = np.rint((angle + 180 * (along < 0) - self.ways.angle[self.ways.n_fixed]) / _FAN).astype(np.int64) % n_free
        return self.step * least, self.ways.n_fixed + way, is_run

    def _traced(self, cost: np.ndarray, came: np.ndarray, turned: np.ndarray) -> list[tuple[int, int, int]]:
        """Return the runs that lead to the end, from the tables of where each comes from."""
        runs, end, way = [], len(came) - 1, int(np.argmin(cost))
        while end > 0:
            first = int(came[end, way])
            runs.append((first, end, way))
            end, way = first, int(turned[first, way])
        return runs[::-1]

    def line(self, first: int, last: int, way: int) -> tuple[np.ndarray, np.ndarray, bool]:
        """Return a position on the line of a run, its direction (2,), and whether that is a main one."""
        # Corners are rounded: up to two pieces at each end are left out of the fit, never more than two thirds of all.
        left_out = min(2, (last - first - 1) // 3)
        inner = slice(first + left_out, last - left_out)
        samples, unit, is_main = self.middles[inner], self.ways.unit[way], bool(self.ways.is_main[way])
        mean, _, axes = principal_axes(samples)
        if not is_main and len(samples) > _SHORTEST:
            fitted = axes[:, 1] * np.sign(axes[:, 1] @ unit)
            unit = fitted if fitted @ unit > np.cos(np.radians(_FAN / 2)) else unit
        return mean, unit, is_main


def _joined(lines: list, breaks: list[np.ndarray], step: float) -> list[Edge]:
    """Return the edges along lines, each of which begins near a break and ends near the next one.

    Lines are positions (2,), directions (2,) and whether these are main ones. Corners lie up to ``_FARTHEST`` times
    ``step`` (m) from their breaks.
    """
    corners = [_corner(lines[i - 1], lines[i], breaks[i], step) for i in range(len(lines))]
    edges = []
    for (ends, start), line, (end, _) in zip(corners, lines, [*corners[1:], corners[0]]):
        if (ends != start).any():
            edges.append(Edge(ends, start, line[2]))
        edges.append(Edge(start, end, line[2]))
    return [edge for edge in edges if (edge.start != edge.end).any()]


def _corner(before: tuple, after: tuple, at: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the corner between two lines: their crossing, or a position next to the break between their runs."""
    (p, u, _), (q, v, _) = before, after
    sine = float(u[0] * v[1] - u[1] * v[0])
    offset = q - p
    if abs(sine) > PARALLEL:
        position = p + u * float(offset[0] * v[1] - offset[1] * v[0]) / sine
        if np.hypot(*(position - at)) <= _FARTHEST * step:
            return position, position
    return p + u * float((at - p) @ u), q + v * float((at - q) @ v)


def aligned(rings: list[list[Edge]], within: float) -> list[list[Edge]]:
    """Return rings with edges moved onto the lines of longer edges of other rings that they nearly lie on.

    Parameters
    ----------
    rings : list of list of Edge
        Edges of each, in order.
    within : float
        Greatest distance of both ends of an edge from that line, and greatest gap along it between the two edges, m.
    """
    edges = [edge for ring in rings for edge in ring]
    if not edges:
        return rings
    ring_of = np.repeat(np.arange(len(rings)), [len(ring) for ring in rings])
    start, end = (np.array([getattr(edge, name) for edge in edges]) for name in ("start", "end"))
    length = np.hypot(*(end - start).T)
    unit = (end - start) / length[:, None]
    is_free, line = np.ones(len(edges), bool), np.arange(len(edges))
    for number in np.argsort(-length, kind="stable").tolist():
        if not is_free[number]:
            continue
        is_free[number] = False
        normal = np.array([-unit[number, 1], unit[number, 0]])
        off = np.maximum(np.abs((start - start[number]) @ normal), np.abs((end - start[number]) @ normal))
        along = np.sort([(start - start[number]) @ unit[number], (end - start[number]) @ unit[number]], axis=0)
        is_beside = (along[0] <= length[number] + within) & (along[1] >= -within)
        # An edge no longer than the distance may cross the line.
        # Within 10°.
        is_parallel = np.abs(unit @ unit[number]) >= 0.985
        own = is_free & is_beside & is_parallel & (off <= within) & (ring_of != ring_of[number])
        line[own], is_free[own] = number, False
    parts = np.split(line, np.cumsum([len(ring) for ring in rings])[:-1])
    return [_on_lines(ring, [edges[i] for i in own], within) for ring, own in zip(rings, parts)]


def _on_lines(ring: list[Edge], lines: list[Edge], within: float) -> list[Edge]:
    """Return a ring with each edge moved onto the line of the given one; the ring itself if these are its own edges."""
    if all(edge is line for edge, line in zip(ring, lines)):
        return ring
    on_lines = []
    for edge, line in zip(ring, lines):
        unit = (line.end - line.start) / np.hypot(*(line.end - line.start))
        unit = unit * np.sign(unit @ (edge.end - edge.start))
        middle = (edge.start + edge.end) / 2
        on_lines.append((line.start + unit * float((middle - line.start) @ unit), unit, line.is_main and edge.is_main))
    return _joined(on_lines, [edge.start for edge in ring], within)
