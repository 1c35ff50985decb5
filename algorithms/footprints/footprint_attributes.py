"""Attributes of footprints: sizes, heights of the roof above the ground, and measures of the building."""

from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from ..cloud.reasons import ADDED, Reason, evidence_text
from ..criteria import PLANE_NEIGHBORS
from ..geometry.grid import find_cells
from ..geometry.groups import split_groups
from ..geometry.rings import along_sides, perimeter, sides_of_rings, signed_area
from ..packages import spatial
from ..stage import Field
from ..threads import searchers
from .drawn_blocks import Outlined
from .soft_shares import APART, NODES

FIELDS = (
    Field("id", int, "number of the footprint, from 1"),
    Field("cluster_id", int, "cluster that it outlines"),
    Field("area", float, "area without holes", "m²"),
    Field("perimeter", float, "length of the exterior and the holes", "m"),
    Field("ground_elevation", float, "median elevation of the ground under the roof's points", "m"),
    Field(
        "eave_height", float, "lower quartile of the heights above ground at which the roof ends along the outline", "m"
    ),
    Field("ridge_height", float, "98th percentile of the roof's heights above ground", "m"),
    Field("height", float, "median of the roof's heights above ground", "m"),
    Field("max_height", float, "greatest height above ground", "m"),
    Field("volume", float, "space between roof and ground: mean height of the roof's surface times area", "m³"),
    Field("points", int, "points of the building, walls among them"),
    Field("entropy", float, "mean entropy of the clusters that its points are of"),
    Field("confidence", float, "0 unsure to 1 sure of being a building"),
    Field("reason", str, "why most of its roofs are called building"),
    Field("evidence", str, "measure nearest to its limit for most of these roofs, and the limit"),
    Field("regularized", int, "1 straightened along main directions, 0 outline as traced or in chords of it"),
)

# The eave height is this percentile of the roof's heights along the outline, as gables rise above the eaves. Footprints
# and models share it.
EAVE = 25

# The ridge height is this percentile of the heights of a roof's points, as chimneys rise above the ridge.
RIDGE = 98

# Points closer than this (spacings) to the outline may lie on the wall; roof planes are fitted without them.
_INNER = 2.0

# A roof plane fits its points within this root mean square distance (m).
_FLAT = 0.15

# Largest slope (tangent) of such a plane: 68°.
_STEEPEST = 2.5


@dataclass(frozen=True)
class PointMeasures:
    """Measures of the points of a cloud; None if not measured."""

    xyz: np.ndarray  #: (n, 3), float64: coordinates, m
    corner: np.ndarray  #: (2,), float64: easting and northing from which outlines are measured, m
    height: Optional[np.ndarray] = None  #: (n,): height above ground, m
    entropy: Optional[np.ndarray] = None  #: (n,): mean entropy of the cluster, NaN where it is not defined
    confidence: Optional[np.ndarray] = None  #: (n,): confidence of being a building, 0 to 1; NaN where not defined
    reason: Optional[np.ndarray] = None  #: (n,): codes of :class:`~..cloud.reasons.Reason`
    weakest: Optional[np.ndarray] = None  #: (n,): packed evidence that is nearest to its limit

    def plan(self, points: np.ndarray) -> np.ndarray:
        """Return easting and northing (p, 2) of points from the corner (m)."""
        return self.xyz[points, :2] - self.corner

    def local(self, points: np.ndarray) -> np.ndarray:
        """Return coordinates (p, 3) of points, in plan from the corner (m)."""
        return self.xyz[points] - np.append(self.corner, 0.0)

    def over_ground(self, points: np.ndarray) -> np.ndarray:
        """Return the heights (p,) of points above ground (m), NaN where they were not measured."""
        return np.full(len(points), np.nan) if self.height is None else self.height[points].astype(np.float64)

    def over_lowest(self, points: np.ndarray, others: np.ndarray) -> np.ndarray:
        """Return the heights (p,) of points above ground (m); without these, above the lowest point of all."""
        if self.height is not None:
            return self.height[points].astype(np.float64)
        return self.xyz[points, 2] - min(self.xyz[others, 2].min(), self.xyz[points, 2].min())


def footprint_attributes(
    outlines: list[Outlined], points: np.ndarray, members: np.ndarray, measures: PointMeasures, spacing: float
) -> list[dict[str, Any]]:
    """Return the attributes of outlines that lie close together.

    Parameters
    ----------
    outlines : list of Outlined
        Outlines of buildings, m from ``measures.corner``.
    points : ndarray of shape (p,), int64
        Points of their roofs in the cloud.
    members : ndarray of shape (m,), int64
        All points of these buildings in the cloud, walls included.
    measures : PointMeasures
        What was measured of the points of the cloud.
    spacing : float
        Mean distance of neighboring points (m).

    Returns
    -------
    list of dict
        For each outline the values of ``FIELDS`` by name, but for the number.
    """
    if not outlines:
        return []
    plan_of_all = measures.plan(members)
    owners = _Owners(outlines, spacing)
    plan, over_ground = measures.plan(points), measures.over_ground(points)
    own = split_groups(owners.at(plan), len(outlines))
    all_own = split_groups(owners.at(plan_of_all), len(outlines))
    attributes = []
    for face, (outlined, roof, rows) in enumerate(zip(outlines, own, all_own)):
        area = sum(map(signed_area, outlined.rings))
        along, is_outer = owners.border(face, outlined.rings)
        inner = _own_roof(roof, plan, along[~is_outer], spacing)
        surface = surface_heights(outlined.nodes, plan[inner], over_ground[inner], spacing)
        facts = {
            "cluster_id": outlined.building,
            "area": area,
            "perimeter": sum(map(perimeter, outlined.rings)),
            "volume": area * float(np.mean(surface)),
            "regularized": int(outlined.is_straight),
            "ground_elevation": _percentile(measures.xyz[points[inner], 2] - over_ground[inner], 50),
            **roof_heights(along, is_outer, plan[inner], over_ground[inner], spacing),
            "max_height": _percentile(over_ground[inner], 100),
            "points": len(rows),
            "entropy": _mean(measures.entropy, members[rows]),
            "confidence": _mean(measures.confidence, members[rows]),
            **_why(measures, members[rows]),
        }
        attributes.append(facts)
    return attributes


def roof_heights(
    along: np.ndarray, is_outer: np.ndarray, plan: np.ndarray, height: np.ndarray, spacing: float
) -> dict[str, float]:
    """Return the heights of a roof at the eaves and the ridge, and their median, m, by field.

    Parameters
    ----------
    along : ndarray of shape (a, 2)
        Positions along its outline, m.
    is_outer : ndarray of shape (a,), bool
        Beyond which of these no other roof is.
    plan : ndarray of shape (n, 2)
        Its points in plan, m.
    height : ndarray of shape (n,)
        Their heights, m, NaN where unknown.
    spacing : float
        Mean distance of neighboring points, m.

    Returns
    -------
    dict of str to float
        Values of the fields ``eave_height``, ``ridge_height`` and ``height``.
    """
    eaves = _eave_heights(along, is_outer, plan, height, spacing)
    percentiles = {"ridge_height": _percentile(height, RIDGE), "height": _percentile(height, 50)}
    return {"eave_height": _percentile(eaves, EAVE), **percentiles}


class _Owners:
    """Assigns each position to the outline of the nearest lattice node with one."""

    def __init__(self, outlines: list[Outlined], spacing: float) -> None:
        self.spacing, self.step = spacing, spacing / NODES
        nodes = np.concatenate([outlined.nodes for outlined in outlines])
        face = np.repeat(np.arange(len(outlines)), [len(outlined.nodes) for outlined in outlines])
        column, row = np.rint(nodes / self.step).astype(np.int64).T
        self.first, self.columns = (column.min() - 1, row.min() - 1), int(np.ptp(column)) + 3
        number = self._number(column, row)
        order = np.argsort(number)
        self.occupied, self.face = number[order], np.append(face[order], -1)
        # The nearest node of a position without a node of its own has a neighbor without an outline.
        beside = (-self.columns, -1, 1, self.columns)
        is_inner = np.logical_and.reduce([find_cells(self.occupied, number + by)[1] for by in beside])
        self.rim_face = np.append(face[~is_inner], -1)
        self.rim = spatial.cKDTree(nodes[~is_inner], balanced_tree=False)

    def _number(self, column: np.ndarray, row: np.ndarray) -> np.ndarray:
        return (row - self.first[1]) * self.columns + column - self.first[0]

    def at(self, plan: np.ndarray, within: float = APART) -> np.ndarray:
        """Return the outline (n,) nearest to positions (n, 2), -1 farther than ``within`` spacings from all."""
        column, row = np.rint(plan / self.step).astype(np.int64).T
        is_near = (column > self.first[0]) & (column < self.first[0] + self.columns - 1)
        found, there = find_cells(self.occupied, np.where(is_near, self._number(column, row), -1))
        face = np.where(there, self.face[np.minimum(found, len(self.face) - 1)], -1)
        outside, reach = np.flatnonzero(~there), within * self.spacing
        nearest = self.rim.query(plan[outside], distance_upper_bound=reach, workers=searchers(len(outside)))[1]
        face[outside] = self.rim_face[nearest]
        return face

    def border(self, face: int, rings: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        """Return positions (b, 2) along an outline, and the mask (b,) of the outer ones; all if none is outer."""
        along, _, outward = along_sides(sides_of_rings(rings), self.spacing)
        beyond = self.at(along + self.spacing * outward, 1 / NODES)
        is_outer = (beyond < 0) | (beyond == face)
        return along, is_outer if is_outer.any() else np.ones(len(along), bool)


def _own_roof(roof: np.ndarray, plan: np.ndarray, shared: np.ndarray, spacing: float) -> np.ndarray:
    """Return the points (r,) of a roof without those at a border (b, 2) with another one, unless it has no others.

    Borders are accurate to one spacing: points of the other roof on this side would be extremes of height.
    """
    if not len(shared) or not len(roof):
        return roof
    inner = roof[spatial.cKDTree(shared).query(plan[roof], workers=searchers(len(roof)))[0] > spacing]
    return inner if len(inner) else roof


def _eave_heights(
    along: np.ndarray, is_outer: np.ndarray, plan: np.ndarray, height: np.ndarray, spacing: float
) -> np.ndarray:
    """Return the height (b,) of the roof at the outer positions of its outline (a, 2), continued from the roof there.

    Many points at an outline belong to the wall below the roof.
    """
    border, defined = along[is_outer], np.isfinite(height)
    plan, height = plan[defined], height[defined]
    if not len(plan):
        return np.full(len(border), np.nan)
    workers = searchers(len(border))
    at_border = height[spatial.cKDTree(plan, balanced_tree=False).query(border, workers=workers)[1]]
    # Beyond this distance nothing is searched, and it is infinite.
    least, searching = _INNER * spacing, searchers(len(plan))
    inner = spatial.cKDTree(along).query(plan, distance_upper_bound=least, workers=searching)[0] >= least
    plan, height = plan[inner], height[inner]
    if not len(plan):
        return at_border
    tree = spatial.cKDTree(plan, balanced_tree=False)
    distance, beside = tree.query(border, min(PLANE_NEIGHBORS, len(plan)), workers=workers)
    distance, beside = distance.reshape(len(border), -1), beside.reshape(len(border), -1)
    weight = (distance <= APART * spacing).astype(float)
    factors = np.concatenate([np.ones((*weight.shape, 1)), plan[beside] - border[:, None]], axis=2)
    # A small weight on level planes decides the slope only where the points lie on one line.
    matrix = np.einsum("ni,nij,nik->njk", weight, factors, factors) + np.diag([1e-6, *[spacing**2 / 10] * 2])
    planes = np.linalg.solve(matrix, np.einsum("ni,nij,ni->nj", weight, factors, height[beside])[..., None])
    off = ((factors @ planes)[..., 0] - height[beside]) ** 2
    is_roof = (weight.sum(axis=1) >= PLANE_NEIGHBORS / 2) & (np.hypot(*planes[:, 1:, 0].T) <= _STEEPEST)
    is_plane = is_roof & ((weight * off).sum(axis=1) <= _FLAT**2 * weight.sum(axis=1))
    return np.where(is_plane, planes[:, 0, 0], at_border)


def surface_heights(nodes: np.ndarray, plan: np.ndarray, height: np.ndarray, spacing: float) -> np.ndarray:
    """Return the heights of a roof's surface: at each position the nearest point's.

    Parameters
    ----------
    nodes : ndarray of shape (m, 2)
        Nodes of a lattice in it, m. Positions are a spacing apart: those with even numbers, or all where none has.
    plan : ndarray of shape (n, 2)
        Its points in plan, m.
    height : ndarray of shape (n,)
        Their heights, m, NaN where unknown.
    spacing : float
        Mean distance of neighboring points, m.

    Returns
    -------
    ndarray of shape (k,)
        Heights at these positions, m; one NaN if no height is known.
    """
    defined = np.isfinite(height)
    if not defined.any():
        return np.full(1, np.nan)
    is_even = (np.rint(nodes * (NODES / spacing)).astype(np.int64) % NODES == 0).all(axis=1)
    places = nodes[is_even] if is_even.any() else nodes
    tree = spatial.cKDTree(plan[defined], balanced_tree=False)
    return height[defined][tree.query(places, workers=searchers(len(places)))[1]]


def _percentile(values: np.ndarray, percent: float) -> float:
    """Return a percentile of the values that are defined, NaN without any."""
    defined = values[np.isfinite(values)]
    return float(np.percentile(defined, percent)) if len(defined) else float("nan")


def _mean(values: Optional[np.ndarray], rows: np.ndarray) -> float:
    """Return the mean of the values that are defined: points that were added to a building later have none."""
    if values is None:
        return float("nan")
    defined = values[rows][np.isfinite(values[rows])]
    return float(np.mean(defined, dtype=np.float64)) if len(defined) else float("nan")


def _why(measures: PointMeasures, rows: np.ndarray) -> dict[str, str]:
    """Return reason and evidence of most roof points, "" where unknown; points added to a building have neither."""
    given = np.zeros(len(rows), np.int64) if measures.reason is None else measures.reason[rows].astype(np.int64)
    counts = np.bincount(given, minlength=max(Reason) + 1)
    roofs = [reason for reason in Reason if reason.is_building and reason not in ADDED and counts[reason]]
    if not roofs:
        return {"reason": "", "evidence": ""}
    main = max(roofs, key=lambda reason: counts[reason])
    weakest = np.zeros(0, np.uint32) if measures.weakest is None else measures.weakest[rows[given == main]]
    packed, many = np.unique(weakest[weakest > 0], return_counts=True)
    return {"reason": main.label, "evidence": evidence_text(int(packed[many.argmax()])) if len(packed) else ""}
