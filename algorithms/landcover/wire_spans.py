"""Spans of wires: parabolas in upright planes, fitted by RANSAC."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np
from numpy.random import Generator

from ..geometry.groups import members
from ..geometry.principal_axes import principal_axes
from ..packages import spatial
from ..rules import rules


@rules
class RULES:
    """Criteria for the span of a wire, and its search."""

    #: tries, trials: Points from which a span is looked for along their direction, and parabolas through three points
    #: that are tried from each. If half of the points belong to one span, an eighth of the trials is right. After
    #: more than ``tries`` wrong spans in a row, as in crowns, the search in a strand ends. A span is extended ``tries``
    #: times at most.
    tries: int = 10
    trials: int = 40
    longest: float = 60.0  #: Distance (m) along the wire within which these points are
    #: Points within this distance (m) of the plane of the wire are on it: the radius of the beam's footprint and the
    #: swing of the wire. Points of a trial are at least as far apart along it.
    aside: float = 0.3
    #: Points on the wire are within this height (m) from its parabola, or within ``DEVIATIONS`` times the noise
    least_off: float = 0.1
    #: Curvature (1/m), half of the second derivative, of the deepest parabola: a sag of a tenth over a span of 20 m
    most_bent: float = 0.02
    #: A fitted curvature exceeds zero by this many standard errors: beams, rails and edges are straight, wires sag
    certain: float = 2.0
    #: least_points, least_length: Least number of points of a span, thinned as well as all, and its least length (m)
    least_points: int = 5
    least_length: float = 10.0
    beyond: float = 5.0  #: A span goes on where its parabola meets points within this distance (m) of its ends
    below: float = 2.0  #: Height (m) under the wire in which crowns and roofs have points
    #: Largest share of the length of a span, counted in parts of 1 m, that has points that far below or buildings
    #: next to it: masts and plants have points there
    most_below: float = 0.25
    #: Distance (m) in plan and in height from eaves and ridges within which lines are edges of buildings
    beside: float = 1.0
    line: float = 8.0  #: Distance (m) aside and in height of wires on the same masts: arms of towers are 4 to 10 m long


@dataclass(frozen=True)
class Span:
    """A parabola in an upright plane."""

    #: middle, direction, (2,): a point of the wire in plan (m), and the unit vector along it
    middle: np.ndarray
    direction: np.ndarray
    #: (3,): elevation (m) by the distance from the middle (m): coefficients of its square, of it, and the constant
    curve: np.ndarray
    #: start, end: Distances (m) from the middle between which the span was seen
    start: float
    end: float

    def local(self, xyz: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return how far along, aside of, and above the wire points (n, 3) are, m."""
        offset = xyz[:, :2] - self.middle
        along = offset @ self.direction
        aside = offset[:, 0] * self.direction[1] - offset[:, 1] * self.direction[0]
        return along, aside, xyz[:, 2] - np.polyval(self.curve, along)

    def holds(self, xyz: np.ndarray, off: float, beyond: float = 0.0) -> np.ndarray:
        """Return the mask of points (n, 3) within ``off`` (m) in height of the span, or ``beyond`` (m) its ends."""
        along, aside, above = self.local(xyz)
        inside = (along >= self.start - beyond) & (along <= self.end + beyond)
        return inside & (np.abs(aside) <= RULES.aside) & (np.abs(above) <= off)

    def at(self, along: float) -> np.ndarray:
        """Return the point (3,) of the wire at a distance (m) from its middle."""
        return np.append(self.middle + along * self.direction, np.polyval(self.curve, along))


class SpanSurroundings:
    """All points that are high enough to be of a wire, and points of buildings, to examine the surroundings of a span.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Points (m) of no class.
    solid : ndarray of shape (m, 3)
        Points (m) of buildings.
    off : float
        Largest distance (m) in height of points from their wire.
    """

    def __init__(self, xyz: np.ndarray, solid: np.ndarray, off: float) -> None:
        self.xyz, self.solid, self.off = xyz, solid, off
        self._order = [np.argsort(points[:, 0], kind="stable") for points in (xyz, solid)]
        self._eastward = [points.take(order, axis=0) for points, order in zip((xyz, solid), self._order)]

    def on_wire(self, span: Span, beyond: float = 0.0) -> np.ndarray:
        """Return the rows (k,) of the points on a span, and on it up to ``beyond`` (m) its ends."""
        rows = self._near(0, span, beyond + 1.0)
        return rows[span.holds(self.xyz[rows], self.off, beyond)]

    def extended(self, span: Span) -> Span:
        """Return the span fitted anew to all points on it, and beyond its ends as far as they go on."""
        for _ in range(RULES.tries):
            longer = fitted(self.xyz[self.on_wire(span, RULES.beyond)])
            if longer is None or longer.end - longer.start <= span.end - span.start:
                return span
            span = longer
        return span

    def is_free(self, span: Span) -> bool:
        """Return whether a span has enough points, none below it, and no building next to it."""
        rows = self._near(0, span, 1.0)
        along, aside, above = span.local(self.xyz[rows])
        is_left, aside, inside = aside > 0, np.abs(aside), (along >= span.start) & (along <= span.end)
        is_level = inside & (np.abs(above) <= self.off)
        on_wire = is_level & (aside <= RULES.aside)
        # A wire is a line: next to a line drawn on a surface, a strip half as wide has half as many points.
        beside = is_level & (aside > 1.5 * RULES.aside) & (aside <= 2.5 * RULES.aside)
        sheet = max((beside & is_left).sum(), (beside & ~is_left).sum())
        # Points nearer than twice the tolerance may be of the wire itself.
        below = inside & (aside <= 2 * RULES.aside) & (above < -2 * self.off) & (above > -RULES.below)
        below = np.flatnonzero(below)[~self._on_parallels(above[below])]
        length = span.end - span.start
        occupied = len(np.unique(np.floor(along[below]))) + self._beside_buildings(span)
        is_line = on_wire.sum() >= RULES.least_points and sheet <= on_wire.sum() / 4
        return bool(is_line and occupied <= RULES.most_below * length)

    def parallels(self, span: Span, is_taken: np.ndarray) -> Iterator[Span]:
        """Yield the wires next to a span, on the same masts: of its direction and curve, up to ``RULES.line`` m away.

        Points (n,) that ``is_taken`` are of other wires.
        """
        rows = self._near(0, span, RULES.line)
        along, aside, above = span.local(self.xyz[rows])
        inside = (along >= span.start) & (along <= span.end) & (np.maximum(np.abs(aside), np.abs(above)) <= RULES.line)
        rows, place = rows[inside], np.column_stack([aside, above])[inside] / [RULES.aside, self.off]
        tree, failures = spatial.cKDTree(place), 0
        count = tree.query_ball_point(place, 1.0, return_length=True)
        for row in np.argsort(-count, kind="stable").tolist():
            if count[row] < RULES.least_points or failures > RULES.tries:
                break
            if is_taken[rows[row]]:
                continue
            near = rows[tree.query_ball_point(place[row], 2.0)]
            other = fitted(self.xyz[near])
            other = other and self.extended(other)
            is_taken[near] = True
            if other is None or not self._is_like(other, span) or not self.is_free(other):
                failures += 1
                continue
            is_taken[self.on_wire(other)] = True
            yield other

    def _is_like(self, other: Span, span: Span) -> bool:
        """Return whether another wire is about as long as a span, and has about as many points."""
        is_as_long = 2 * (other.end - other.start) >= span.end - span.start
        return is_as_long and 4 * len(self.on_wire(other)) >= len(self.on_wire(span))

    def _on_parallels(self, above: np.ndarray) -> np.ndarray:
        """Return the mask of points (n,), that high above a wire (m), on others at a constant height below it.

        Of points that are spread evenly over the height below a wire, as leaves are, no layer as thick as a wire has
        twice its share.
        """
        thick, on_one = 2 * self.off, np.zeros(len(above), bool)
        least = max(RULES.least_points, 2 * thick / RULES.below * len(above))
        order = np.argsort(above, kind="stable")
        while len(order) >= least:
            height = above[order]
            count = np.searchsorted(height, height + thick, side="right") - np.arange(len(order))
            first = int(count.argmax())
            if count[first] < least:
                break
            on_one[order[first : first + count[first]]] = True
            order = np.delete(order, np.s_[first : first + count[first]])
        return on_one

    def _beside_buildings(self, span: Span) -> int:
        """Return along how much of a span (m) buildings are next to it."""
        along, aside, above = span.local(self.solid[self._near(1, span, RULES.beside)])
        inside = (along >= span.start) & (along <= span.end)
        return len(np.unique(np.floor(along[inside & (np.maximum(np.abs(aside), np.abs(above)) <= RULES.beside)])))

    def _near(self, which: int, span: Span, margin: float) -> np.ndarray:
        """Return the rows of points that may be near a span."""
        points, order = self._eastward[which], self._order[which]
        ends = np.array([span.at(span.start), span.at(span.end)])
        low, high = ends[:, :2].min(axis=0) - margin, ends[:, :2].max(axis=0) + margin
        first, last = np.searchsorted(points[:, 0], [low[0], high[0]])
        north = points[first:last, 1]
        return order[first:last][(north >= low[1]) & (north <= high[1])]


def spans_of(
    xyz: np.ndarray, strand: np.ndarray, direction: np.ndarray, around: SpanSurroundings, reach: float, rng: Generator
) -> Iterator[Span]:
    """Yield the spans among points (n, 3), m.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Thinned points.
    strand : ndarray of shape (n,), int
        The line that each is on, -1 for none.
    direction : ndarray of shape (n, 3)
        Direction of the line at each point, 1 m long in plan.
    around : SpanSurroundings
        All points.
    reach : float
        Largest gap in a span, m.
    rng : numpy.random.Generator
        Draws the points.
    """
    for rows in members(np.where(np.bincount(1 + strand)[1 + strand] >= RULES.least_points, 1 + strand, 0)).values():
        remaining, failures = rows, 0
        while len(remaining) >= RULES.least_points and failures <= RULES.tries:
            chosen = _most_points(xyz[remaining], direction[remaining], around.off, reach, rng)
            if not len(chosen):
                break
            span = fitted(xyz[remaining[chosen]])
            span = span and around.extended(span)
            failures = 0 if span is not None and around.is_free(span) else failures + 1
            if span is not None and not failures:
                yield span
                chosen = np.union1d(chosen, np.flatnonzero(span.holds(xyz[remaining], around.off)))
            remaining = np.delete(remaining, chosen)


def parallels_of(spans: list[Span], around: SpanSurroundings) -> list[Span]:
    """Return the wires next to spans, without these."""
    is_taken = np.zeros(len(around.xyz), bool)
    for span in spans:
        is_taken[around.on_wire(span, beyond=1.0)] = True
    return [other for span in spans for other in around.parallels(span, is_taken)]


def _most_points(xyz: np.ndarray, direction: np.ndarray, off: float, reach: float, rng: Generator) -> np.ndarray:
    """Return the rows (k,) of the span with the most points that a few starts find; empty for none."""
    best = np.zeros(0, np.int64)
    for start in rng.choice(len(xyz), min(RULES.tries, len(xyz)), replace=False):
        offset = xyz[:, :2] - xyz[start, :2]
        aside = np.abs(offset[:, 0] * direction[start, 1] - offset[:, 1] * direction[start, 0])
        near = np.flatnonzero((aside <= 2 * RULES.aside) & (np.abs(offset).max(axis=1) <= RULES.longest))
        found = _best_parabola(xyz[near], off, reach, rng) if len(near) >= RULES.least_points else None
        if found is not None and len(found) > len(best):
            best = near[found]
    return best


def _best_parabola(xyz: np.ndarray, off: float, reach: float, rng: Generator) -> Optional[np.ndarray]:
    """Return the rows (k,) on the parabola through three points that has the most without a large gap, or None."""
    drawn = np.argsort(rng.random((RULES.trials, len(xyz))), axis=1)[:, :3]
    first, middle, last = (xyz[drawn[:, i]] for i in range(3))
    direction = last[:, :2] - first[:, :2]
    length = np.hypot(*direction.T)
    direction = direction / np.maximum(length, 1e-9)[:, None]
    offset = xyz[None, :, :2] - first[:, None, :2]
    along = np.einsum("ijk,ik->ij", offset, direction)
    aside = np.abs(offset[..., 0] * direction[:, None, 1] - offset[..., 1] * direction[:, None, 0])
    to_middle = np.einsum("ij,ij->i", middle[:, :2] - first[:, :2], direction)
    usable = (to_middle >= RULES.aside) & (length - to_middle >= RULES.aside)
    # The parabola through (0, 0), (to_middle, rise) and (length, end), by divided differences.
    safe = np.where(usable, to_middle, 1.0)
    total = np.where(usable, length, 3.0)
    slope = (middle[:, 2] - first[:, 2]) / safe
    bend = ((last[:, 2] - middle[:, 2]) / (total - safe) - slope) / total
    height = first[:, 2, None] + slope[:, None] * along + bend[:, None] * along * (along - safe[:, None])
    usable &= (bend >= 0) & (bend <= RULES.most_bent)
    on_curve = usable[:, None] & (aside <= RULES.aside) & (np.abs(xyz[:, 2] - height) <= off)
    best: Any = int(on_curve.sum(axis=1).argmax())
    rows = np.flatnonzero(on_curve[best])
    if len(rows) < RULES.least_points:
        return None
    rows = rows[np.argsort(along[best, rows])]
    return np.sort(max(np.split(rows, np.flatnonzero(np.diff(along[best, rows]) > reach) + 1), key=len))


def fitted(xyz: np.ndarray) -> Optional[Span]:
    """Return the span through points (n, 3), m, by least squares; None if too few, too short or not bent as a wire."""
    if len(xyz) < RULES.least_points:
        return None
    middle, _, axes = principal_axes(xyz[:, :2])
    direction = axes[:, 1]
    along = (xyz[:, :2] - middle) @ direction
    if np.ptp(along) < RULES.least_length:
        return None
    curve, covariance = np.polyfit(along, xyz[:, 2], 2, cov=True)
    if not RULES.certain * np.sqrt(covariance[0, 0]) < curve[0] <= RULES.most_bent:
        return None
    return Span(middle, direction, curve, float(along.min()), float(along.max()))
