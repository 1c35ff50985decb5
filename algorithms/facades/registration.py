"""The shift between a street scan and an airborne one: by walls, their ends, and the ground that both see."""

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..geometry.grid import distinct, grid_over
from ..packages import spatial
from ..rules import rules
from .facade_surfaces import CELL
from .plan_segments import PlanSegments


@rules
class _RULES:
    """Features common to both scans, and their largest displacement."""

    # Walls and outlines run the same way within this angle (°): regularized outlines turn by a few degrees.
    angle: float = 10.0
    # Step of the search (m): half of it is within the first distance of the rounds.
    step: float = 0.25
    # Distance (m) within which the search counts a wall or an end as common: more than a step.
    near: float = 0.4
    # Overhangs of eaves (m) that are tried: few are wider.
    overhangs: tuple[float, ...] = (0.0, 0.4, 0.8)
    # Distances (m) within which walls and ends are common in the rounds that follow: down to twice the accuracy
    # of an outline (0.1 m).
    rounds: tuple[float, ...] = (0.6, 0.6, 0.4, 0.4, 0.3, 0.3, 0.2, 0.2)
    # Standard deviation (m) of an outline's edge from the air.
    edge: float = 0.1
    # Standard deviation (m) of the overhang of eaves and gables.
    overhang: float = 0.3
    # Standard deviation (m) of a shift that nothing determines, as that along a street without ends of walls.
    unseen: float = 1.0
    # Least squares with weights of the residuals before: a tenth round moves the shift by less than a millimeter.
    reweighted: int = 9
    # Walls shorter than this (m) are sides of recesses, which outlines from the air don't show.
    shortest: float = 2.0
    # Least number of these cells: fewer may all be below cars.
    least_cells: int = 20
    # Half of the range of height differences (m) that count as common ground: the range that holds most of them.
    ground: float = 0.2


@dataclass(frozen=True)
class Registration:
    """How a street scan is moved onto an airborne one."""

    shift: np.ndarray  #: (3,): vector (m) by which the street scan is moved
    residual: float  #: Root mean square distance (m) of common walls and ends after that, by weight; NaN without any
    overhang: float  #: How far outlines from the air lie before the walls (m), in the mean
    #: walls, ends, ground: Common walls, ends of walls, and cells of ground
    walls: int
    ends: int
    ground: int


@dataclass(frozen=True)
class _Common:
    """Linear equations of the shift in plan and the overhangs of eaves and gables: (m, 4), values and weights (m,)."""

    coefficients: np.ndarray
    values: np.ndarray
    weights: np.ndarray
    n_walls: int


def register(
    walls: PlanSegments, outlines: PlanSegments, street: np.ndarray, ground: np.ndarray, max_shift: float
) -> Optional[Registration]:
    """Return the shift of a street scan, None where it has no wall in common with the outlines.

    Parameters
    ----------
    walls, outlines : PlanSegments
        Facades of the street scan, and edges of footprints from the air.
    street : ndarray of shape (n, 3)
        Points of the street scan, m.
    ground : ndarray of shape (m, 3)
        Ground points of the airborne scan, m.
    max_shift : float
        Greatest shift along either axis (m).

    Notes
    -----
    A wall and an outline that run the same way give the shift across them, but for the overhang of the eaves. That is
    one unknown for all: walls of both sides of a street separate it from the shift. Ends of walls and corners of
    outlines give the shift along, but for the overhang of gables, another unknown. The weight of an end is the length
    of the outline's edge across it, a wall by the square root of its own length. A search on a grid finds which
    are common, least squares in narrowing rounds their shift. The ground then gives the shift in height.
    """
    long = walls.length >= _RULES.shortest
    walls = PlanSegments(walls.start[long], walls.end[long], walls.owner[long])
    if not len(walls) or not len(outlines):
        return None
    plan, common = _shift_in_plan(walls, outlines, max_shift)
    if common is None:
        return None
    height, cells = _shift_in_height(street, ground, plan[:2])
    off = common.coefficients @ plan - common.values
    residual = float(np.sqrt(np.average(off**2, weights=common.weights)))
    n_ends = len(common.values) - common.n_walls
    return Registration(np.array([*plan[:2], height]), residual, float(plan[2]), common.n_walls, n_ends, cells)


def _shift_in_plan(
    walls: PlanSegments, outlines: PlanSegments, max_shift: float
) -> tuple[np.ndarray, Optional[_Common]]:
    """Return shift and overhangs (4,), m, and the equations that they solve; None without any."""
    beside = _beside(walls, outlines, max_shift)
    plan = _searched(walls, beside, max_shift)
    common = None
    for near in _RULES.rounds:
        common = _common(walls, beside, plan, near)
        if not common.n_walls:
            return plan, None
        plan = _solved(common)
    return plan, common


@dataclass(frozen=True)
class _Beside:
    """Edges of outlines near each wall that run the same way.

    Both ends (walls, m, 2), m, how long (m) the edges across are that they meet there (walls, m), and which are edges.
    """

    start: np.ndarray
    end: np.ndarray
    before: np.ndarray
    after: np.ndarray
    is_edge: np.ndarray


def _beside(walls: PlanSegments, outlines: PlanSegments, max_shift: float) -> _Beside:
    """Return the edges that a shift can bring to each wall."""
    reach = max_shift + max(_RULES.overhangs) + max(_RULES.rounds)
    low, high = np.minimum(outlines.start, outlines.end) - reach, np.maximum(outlines.start, outlines.end) + reach
    way, found = outlines.way, []
    for start, end, own in zip(walls.start, walls.end, walls.way):
        is_near = ((np.maximum(start, end) >= low) & (np.minimum(start, end) <= high)).all(axis=1)
        found.append(np.flatnonzero(is_near & (way @ own >= np.cos(np.radians(_RULES.angle)))))
    count = np.array([len(edges) for edges in found])
    is_edge = np.arange(max(1, int(count.max()))) < count[:, None]
    edge = np.zeros(is_edge.shape, int)
    edge[is_edge] = np.concatenate(found)
    before, after = (outlines.across(step) for step in (-1, 1))
    return _Beside(outlines.start[edge], outlines.end[edge], before[edge], after[edge], is_edge)


def _searched(walls: PlanSegments, beside: _Beside, max_shift: float) -> np.ndarray:
    """Return shift and overhangs (4,), m, at which most of the walls lie on outlines, by length; ends count a meter."""
    steps = np.arange(-np.floor(max_shift / _RULES.step), np.floor(max_shift / _RULES.step) + 1) * _RULES.step
    shifts = np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
    # Of shifts that are equally good the smallest comes first.
    shifts = shifts[np.argsort(np.hypot(*shifts.T), kind="stable")]
    score = np.array([_scores(walls.moved(shift), beside) for shift in shifts])
    overhang, best = np.unravel_index(np.argmax(score.T), score.T.shape)
    return np.array([*shifts[best], _RULES.overhangs[overhang], 0.0])


def _scores(walls: PlanSegments, beside: _Beside) -> list[float]:
    """Return the length (m) of walls on outlines, and a meter for each of their ends at a corner, by overhang."""
    across, shared, left, right = _offsets(walls, beside)
    scores = []
    for overhang in _RULES.overhangs:
        is_near = np.abs(across - overhang) <= _RULES.near
        on_outline = (is_near & (shared > 0)).any(axis=1)
        ends = [(is_near & (np.abs(along) <= _RULES.near)).any(axis=1).sum() for along in (left, right)]
        scores.append(float(walls.length[on_outline].sum() + sum(ends)))
    return scores


def _offsets(walls: PlanSegments, beside: _Beside) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return how far the edges near each wall are off; NaN (or 0 shared) where there is no edge.

    Distance across the wall (m), shared length (m), and distances along it of the left and right ends, each (walls, m).
    """
    way, normal, is_edge = walls.way[:, None], walls.normal[:, None], beside.is_edge
    middle = (walls.start + walls.end)[:, None] / 2
    first, last = (ends - middle for ends in (beside.start, beside.end))
    along = [np.einsum("ijk,ijk->ij", ends, np.broadcast_to(way, ends.shape)) for ends in (first, last)]
    off = [np.einsum("ijk,ijk->ij", ends, np.broadcast_to(normal, ends.shape)) for ends in (first, last)]
    half = walls.length[:, None] / 2
    shared = np.where(is_edge, np.minimum(along[1], half) - np.maximum(along[0], -half), 0.0)
    # Where the wall's middle is next to the outline, or at the nearer end of the outline.
    position = np.clip(-along[0] / np.maximum(along[1] - along[0], 1e-9), 0, 1)
    across = np.where(is_edge, off[0] + position * (off[1] - off[0]), np.nan)
    left, right = np.where(is_edge, along[0] + half, np.nan), np.where(is_edge, along[1] - half, np.nan)
    return across, shared, left, right


def _common(walls: PlanSegments, beside: _Beside, plan: np.ndarray, near: float) -> _Common:
    """Return the equations of walls and ends that are within a distance (m) of outlines and corners at a shift."""
    across, shared, left, right = _offsets(walls.moved(plan[:2]), beside)
    off = np.where(shared > 0, np.abs(across - plan[2]), np.inf)
    best = off.argmin(axis=1)
    rows = np.flatnonzero(off[np.arange(len(walls)), best] <= near)
    equations = [(*walls.normal[k], 1.0, 0.0, across[k, best[k]], np.sqrt(walls.length[k])) for k in rows]
    for k in rows:
        # Under gables that overhang, an outline goes on beyond both ends of a wall.
        for along, outward, depth in ((left[k], -1.0, beside.before[k]), (right[k], 1.0, beside.after[k])):
            off_end = np.where(np.abs(across[k] - plan[2]) <= near, np.abs(along - outward * plan[3]), np.inf)
            end = off_end.argmin()
            if off_end[end] <= near:
                # The longer the edge that the outline has there, the better its position: sides of bays are poor.
                equations.append((*walls.way[k], 0.0, outward, along[end], depth[end]))
    table = np.array(equations).reshape(-1, 6)
    coefficients, values = table[:, :4], table[:, 4] + table[:, :2] @ plan[:2]
    return _Common(coefficients, values, table[:, 5], len(rows))


def _solved(common: _Common) -> np.ndarray:
    """Return shift and overhangs (4,), m, by least squares with Huber's weights; unknowns without evidence stay near 0.

    By these, a wall that goes on beyond its corner has less influence than by the square of its distance.
    """
    assumed = np.diag([1 / _RULES.unseen, 1 / _RULES.unseen, 1 / _RULES.overhang, 1 / _RULES.overhang])
    weights = common.weights
    for _ in range(_RULES.reweighted):
        precision = np.sqrt(weights) / _RULES.edge
        left = np.concatenate([common.coefficients * precision[:, None], assumed])
        right = np.concatenate([common.values * precision, np.zeros(4)])
        plan = np.linalg.lstsq(left, right, rcond=None)[0]
        off = np.abs(common.coefficients @ plan - common.values)
        weights = common.weights * _RULES.edge / np.maximum(off, _RULES.edge)
    return plan


def _shift_in_height(street: np.ndarray, ground: np.ndarray, shift: np.ndarray) -> tuple[float, int]:
    """Return the shift in height (m) of a street scan that is moved in plan, and on how many cells it was measured."""
    cells, cell = distinct(grid_over(street, CELL).number(street))
    order = np.lexsort((street[:, 2], cell))
    lowest = street[order[np.searchsorted(cell[order], np.arange(len(cells)))]]
    distance, nearest = spatial.cKDTree(ground[:, :2]).query(lowest[:, :2] + shift, k=min(3, len(ground)))
    distance, nearest = distance.reshape(len(lowest), -1), nearest.reshape(len(lowest), -1)
    beside = distance[:, -1] <= 2 * CELL + _RULES.near
    difference = ground[nearest[beside], 2].mean(axis=1) - lowest[beside, 2]
    if len(difference) < _RULES.least_cells:
        return 0.0, 0
    # Take the range with most cells, as under cars and walls the lowest point is no ground.
    ascending = np.sort(difference)
    until = np.searchsorted(ascending, ascending + 2 * _RULES.ground, side="right")
    first = int(np.argmax(until - np.arange(len(ascending))))
    window = ascending[first : until[first]]
    return float(np.median(window)), len(window)
