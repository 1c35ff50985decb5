"""Facades and openings of a street scan, moved onto an airborne cloud by the walls and the ground that both show."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..cloud.asprs import PointClass
from ..geometry.grid import distinct, grid_over
from ..packages import spatial
from ..report.page import Row, build_page
from ..rules import rules
from ..stage import InputLayer, LayerFeatures, Measure, Report, stage, tunable
from .extract_facades import extract_facades
from .extract_openings import PIERCED, extract_openings
from .facade_surfaces import CELL
from .plan_segments import PlanSegments, facade_segments, outline_segments

_MEASURES = (
    Measure("shift_x", "Shift eastward", "m"),
    Measure("shift_y", "Shift northward", "m"),
    Measure("shift_z", "Shift upward", "m"),
    Measure("residual", "Residual of common walls and ends", "m"),
    Measure("overhang", "Overhang of the eaves", "m"),
    Measure("walls", "Common walls"),
    Measure("ends", "Common ends of walls"),
    Measure("ground", "Common cells of ground"),
)

# Sentences of the report on each measure.
_MEANINGS = {
    "shift_x": "Added to the eastings of the street scan.",
    "shift_y": "Added to its northings.",
    "shift_z": "Added to its elevations, from the ground that both scans show.",
    "residual": "Root mean square distance of common walls and ends from the outlines after the shift.",
    "overhang": "Mean distance of airborne outlines outside the walls: eaves, and the spacing of the points at edges.",
    "walls": "Facades that lie on an edge of a footprint.",
    "ends": "Ends of facades that lie at a corner of a footprint; they give the shift along the street.",
    "ground": "Cells of 0.5 m in which the lowest point of the street is ground from the air, too.",
}


@stage(
    "Facades",
    title="Register street scan",
    tags="registration,alignment,shift,coregistration,mobile mapping,terrestrial,airborne,facade,street,Peng",
    input_layers=(InputLayer("footprints", buildings=True),),
    layers=PIERCED,
    measures=_MEASURES,
    input_title="Airborne point cloud",
    reference_title="Street scan",
    reference="The scan of the street, from a vehicle or a tripod.",
    cost=20.0,
)
def register_street(
    xyz,
    classification,
    reference_xyz,
    reference_classification,
    footprints,
    *,
    max_shift: float = tunable(3.0, within="[0, 20] m"),
    min_size: float = tunable(0.4, within="[0.05, 10] m"),
    monitor=None,
):
    """Find facades, windows and doors in a street scan and move them onto the airborne cloud.

    The shift makes facades lie on the outlines of buildings, their ends at corners of these, and the street on the
    ground. It is reported with its residual. The airborne cloud stays where it is.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates of the airborne cloud, m.
    classification : ndarray of shape (n,), uint8
        Its classes: ground (2) gives the shift in height.
    reference_xyz : ndarray of shape (m, 3), float64
        Coordinates of the street scan, from a vehicle or a tripod, m.
    reference_classification : ndarray of shape (m,), uint8
        Its classes; ground, water and noise are no facades. All points may be unclassified.
    footprints : LayerFeatures
        Outlines of the buildings, from the airborne cloud.

    Returns
    -------
    facades, openings : LayerFeatures
        As of "Extract openings", in the frame of the airborne cloud.
    report : Report
        The shift, its residual and what it rests on.

    Other Parameters
    ----------------
    max_shift
        How far the street scan may be off the airborne cloud, along either axis.
    min_size
        Least width and height of a window or door.

    Raises
    ------
    ValueError
        If the airborne cloud has no ground points.

    Notes
    -----
    The paper scans streets without satellite positions and leaves open how its scans come together. A vehicle's
    position between high houses is off by decimeters to meters, its direction hardly at all; so the transformation is a
    shift. A search on a grid of 0.25 m finds the shift at which most of the walls lie on outlines. Least squares in
    narrowing rounds then solve for shift and overhang of the eaves together, which walls on both sides of a street
    separate. Where a street shows no end of a wall at a corner, the shift along it stays near 0.

    References
    ----------
    Peng, C., Yu, Z., 2018. Research on 3D building information extraction and image post-processing based on vehicle
    LIDAR. EURASIP Journal on Image and Video Processing 2018:121, sections 3 and 4. [peng2018]

    Examples
    --------
    >>> from lidar_buildings.algorithms.stage import LayerFeatures
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 6, 2)
    >>> ring = np.array([[15, 16], [25, 16], [25, 24], [15, 24], [15, 16.0]])
    >>> facades, openings, report = register_street(xyz, classes, xyz, classes, LayerFeatures([[ring]], {}))
    >>> sorted(report.values)
    ['ends', 'ground', 'overhang', 'residual', 'shift_x', 'shift_y', 'shift_z', 'walls']
    """
    is_ground = classification == PointClass.GROUND
    if not is_ground.any():
        raise ValueError(
            "No point of the airborne cloud is called ground (class 2); run 'Classify ground points (TIN)' first."
        )
    segment_id, _ = extract_facades(reference_xyz, reference_classification, monitor=monitor.part(0, 0.5))
    facades, openings = extract_openings(reference_xyz, segment_id, min_size=min_size, monitor=monitor.part(0.5, 0.9))
    result = register(facade_segments(facades), outline_segments(footprints), reference_xyz, xyz[is_ground], max_shift)
    if result is None:
        monitor.warn(
            "No facade lies on a footprint, so the street scan is not moved; raise the maximum shift, or check that "
            "both clouds show the same buildings."
        )
        result = Registration(np.zeros(3), float("nan"), float("nan"), 0, 0, 0)
    else:
        monitor.inform(_sentence(result))
    return _moved(facades, result.shift), _moved(openings, result.shift), _report(result)


def _sentence(result: Registration) -> str:
    """Return the shift and its residual in a sentence."""
    x, y, z = result.shift
    return (
        f"The street scan is moved by {x:.2f} m eastward, {y:.2f} m northward and {z:.2f} m upward; "
        f"{result.walls} walls and {result.ends} ends are then off the outlines by {result.residual:.2f} m (rms)."
    )


def _moved(features: LayerFeatures, shift: np.ndarray) -> LayerFeatures:
    """Return features moved by a vector (3,), m."""
    columns = dict(features.columns)
    if "base" in columns:
        columns["base"] = [base + float(shift[2]) for base in columns["base"]]
    return LayerFeatures([[ring + shift for ring in rings] for rings in features.geometries], columns)


def _report(result: Registration) -> Report:
    """Return the measures and their page."""
    lengths = (*result.shift.tolist(), result.residual, result.overhang)
    counts = (result.walls, result.ends, result.ground)
    values = dict(zip((measure.name for measure in _MEASURES), (*lengths, *counts)))
    shown = [*("undefined" if np.isnan(value) else f"{value:.3f} m" for value in lengths), *map(str, counts)]
    rows = [Row(measure.title, text, _MEANINGS[measure.name]) for measure, text in zip(_MEASURES, shown)]
    lead = _sentence(result) if result.walls else "No facade lies on a footprint; the street scan is not moved."
    return Report(values, build_page("Registration of a street scan", lead, {"Shift": rows}, ""))


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
    # Least number of cells with ground of both scans: fewer may all be below cars.
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
    plan, common = _in_plan(walls, outlines, max_shift)
    if common is None:
        return None
    height, cells = _shift_in_height(street, ground, plan[:2])
    off = common.coefficients @ plan - common.values
    residual = float(np.sqrt(np.average(off**2, weights=common.weights)))
    n_ends = len(common.values) - common.n_walls
    return Registration(np.array([*plan[:2], height]), residual, float(plan[2]), common.n_walls, n_ends, cells)


def _in_plan(walls: PlanSegments, outlines: PlanSegments, max_shift: float) -> tuple[np.ndarray, Optional[_Common]]:
    """Return shift and overhangs (4,), m, and the equations that they solve; None without any."""
    beside = _beside(walls, outlines, max_shift)
    plan = _searched(walls, beside, max_shift)
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
    """Return the distances of the edges near each wall; NaN (or 0 shared) without an edge.

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
