"""Attributes of footprints: sizes, heights of the roof above the ground, and what was measured of the building."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from ..cloud.reasons import ADDED, Reason
from ..geometry.groups import split_groups
from ..geometry.rings import perimeter, signed_area
from ..packages import spatial
from ..stage import Field
from ..threads import n_threads
from .alpha_shape import Tracing
from .block_drawing import Drawing

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
    Field("volume", float, "space between roof and ground: mean height of the roof's surface by area", "m³"),
    Field("points", int, "points of the building, walls among them"),
    Field("entropy", float, "mean entropy of the building's points' clusters"),
    Field("confidence", float, "0 unsure to 1 sure of being a building"),
    Field("reason", str, "why most of its roofs are called building"),
    Field("regularized", int, "1 straightened along main directions, 0 outline as traced or in chords of it"),
)

# Percentile of the roof's heights along the outline that is the eaves': gables rise from eaves.
_EAVE = 25

# Percentile of the roof's heights that is the ridge's: chimneys rise above it.
_RIDGE = 98

# Points of the roof to which a plane is fitted beside each point of the outline.
_PLANE = 12

# Distance (spacings) of these from the outline, at least: beyond points on the wall.
_INNER = 2.0

# Distance (spacings) from the point of the outline, at most: points farther away are never joined to it.
_BESIDE = 8.0

# Root mean square (m) of their distances to the plane, at most: more is no roof plane.
_FLAT = 0.15

# Slope (tangent) of the plane, at most: 68°.
_STEEPEST = 2.5


@dataclass(frozen=True)
class PointMeasures:
    """What was measured of the points of a cloud; None where it was not.

    Attributes
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates (m).
    height : ndarray of shape (n,), optional
        Height above ground (m).
    entropy, confidence : ndarray of shape (n,), optional
        Mean entropy of the cluster, and confidence (0 to 1) of being a building; NaN where they are not defined.
    reason : ndarray of shape (n,), optional
        Codes of :class:`~..cloud.reasons.Reason`.
    """

    xyz: np.ndarray
    height: Optional[np.ndarray] = None
    entropy: Optional[np.ndarray] = None
    confidence: Optional[np.ndarray] = None
    reason: Optional[np.ndarray] = None

    def over_ground(self, points: np.ndarray) -> np.ndarray:
        """Return the heights (p,) of points above ground (m), NaN where they were not measured."""
        return np.full(len(points), np.nan) if self.height is None else self.height[points].astype(np.float64)

    def over_lowest(self, points: np.ndarray, others: np.ndarray) -> np.ndarray:
        """Return the heights (p,) of points above ground (m), or else above the lowest of them and of others."""
        if self.height is not None:
            return self.height[points].astype(np.float64)
        return self.xyz[points, 2] - min(self.xyz[others, 2].min(), self.xyz[points, 2].min())


def footprint_attributes(
    traced: Tracing,
    drawing: Drawing,
    points: np.ndarray,
    members: np.ndarray,
    measures: PointMeasures,
    spacing: float,
) -> list[dict[str, Any]]:
    """Return the attributes of the faces of a tracing.

    Parameters
    ----------
    traced : Tracing
        Faces of buildings over the points of roofs and those beside them.
    drawing : Drawing
        Their polygons.
    points : ndarray of shape (p,), int64
        Its points in the cloud.
    members : ndarray of shape (m,), int64
        All points of these buildings in the cloud, walls included.
    measures : PointMeasures
        What was measured of the points of the cloud.
    spacing : float
        Mean distance of neighboring points (m).

    Returns
    -------
    list of dict
        For each face the values of ``FIELDS`` by name, but for the number.
    """
    count = len(traced.labels)
    face_of_point = _face_of_points(traced)
    face_of_member = _face_of_members(traced, face_of_point, measures.xyz[members])
    outline_face, outline_point = _outer_points(traced)
    over_ground = measures.over_ground(points)
    eaves = _eave_heights(traced, (outline_face, outline_point), face_of_point, over_ground, spacing)
    mean_height = _mean_heights(traced, over_ground)
    rows = zip(*(split_groups(face, count) for face in (face_of_point, face_of_member, outline_face)))
    attributes = []
    for face, (roof, own, outline) in enumerate(rows):
        area = sum(map(signed_area, drawing.rings[face]))
        attributes.append(
            {
                "cluster_id": int(traced.labels[face]),
                "area": area,
                "perimeter": sum(map(perimeter, drawing.rings[face])),
                "volume": area * mean_height[face],
                "regularized": int(face in drawing.straight),
                **_roof_heights(measures.xyz[points[roof], 2], over_ground[roof], eaves[outline]),
                **_evidence(measures, members[own]),
            }
        )
    return attributes


def _roof_heights(elevation: np.ndarray, over_ground: np.ndarray, eaves: np.ndarray) -> dict[str, float]:
    """Return the attributes that come from the elevations and heights (r,) of a roof and those along its outline."""
    return {
        "ground_elevation": _percentile(elevation - over_ground, 50),
        "eave_height": _percentile(eaves, _EAVE),
        "ridge_height": _percentile(over_ground, _RIDGE),
        "height": _percentile(over_ground, 50),
        "max_height": _percentile(over_ground, 100),
    }


def _evidence(measures: PointMeasures, members: np.ndarray) -> dict[str, Any]:
    """Return the attributes that say why the points of a building are one."""
    return {
        "points": len(members),
        "entropy": _mean(measures.entropy, members),
        "confidence": _mean(measures.confidence, members),
        "reason": _main_reason(measures.reason, members),
    }


def _face_of_points(traced: Tracing) -> np.ndarray:
    """Return the face (n,) that has the most of the triangles around a point of it; -1 of those in none or bare."""
    face, count = np.full(len(traced.xy), -1), len(traced.labels)
    inside = traced.face >= 0
    corner, of = traced.triangles[inside].ravel(), np.repeat(traced.face[inside], 3)
    is_own = traced.label[corner] == traced.labels[of]
    pairs, inverse = np.unique(corner[is_own] * count + of[is_own], return_inverse=True)
    # The largest comes last for each point, and stays.
    pairs = pairs[np.argsort(np.bincount(inverse, np.repeat(traced.areas[inside], 3)[is_own]), kind="stable")]
    face[pairs // count] = pairs % count
    return face


def _face_of_members(traced: Tracing, face_of_point: np.ndarray, xyz: np.ndarray) -> np.ndarray:
    """Return the face (m,) of points of buildings: that of the nearest roof point, -1 beyond the longest edge of it."""
    roof = np.flatnonzero(face_of_point >= 0)
    distance, nearest = spatial.cKDTree(traced.xy[roof]).query(xyz[:, :2], workers=n_threads())
    return np.where(distance <= traced.max_edge, face_of_point[roof[nearest]], -1)


def _outer_points(traced: Tracing) -> tuple[np.ndarray, np.ndarray]:
    """Return faces and points along the outlines; those along borders between buildings only where it has no others."""
    face, across = np.repeat(traced.face, 3), traced.beyond(traced.face)
    is_border = (face >= 0) & (face != across)
    has_outer = np.bincount(face[is_border & (across < 0)], minlength=len(traced.labels)) > 0
    used = np.flatnonzero(is_border & ((across < 0) | ~has_outer[face]))
    return face[used], traced.starts[used]


def _eave_heights(
    traced: Tracing, border: tuple, roof_face: np.ndarray, height: np.ndarray, spacing: float
) -> np.ndarray:
    """Return the height (b,) of the roof above each point of the outlines, continued from the roof beside it.

    Many points of an outline are those of the wall below, down to where they are no longer taken for a roof's.
    """
    face, point = border
    distance, _ = spatial.cKDTree(traced.xy[np.unique(point)]).query(traced.xy, workers=n_threads())
    inner = np.flatnonzero((roof_face >= 0) & (distance >= _INNER * spacing) & np.isfinite(height))
    if not len(inner):
        return height[point]
    distance, nearest = spatial.cKDTree(traced.xy[inner]).query(
        traced.xy[point], min(_PLANE, len(inner)), workers=n_threads()
    )
    beside = inner[nearest.reshape(len(point), -1)]
    is_near = distance.reshape(beside.shape) <= _BESIDE * spacing
    weight = (is_near & (roof_face[beside] == face[:, None])).astype(float)
    step = traced.xy[beside] - traced.xy[point][:, None]
    factors = np.concatenate([np.ones((*weight.shape, 1)), step], axis=2)
    # A pull to the level, which only points in one line feel.
    matrix = np.einsum("ni,nij,nik->njk", weight, factors, factors) + np.diag([1e-6, *[spacing**2 / 10] * 2])
    right = np.einsum("ni,nij,ni->nj", weight, factors, height[beside])
    planes = np.linalg.solve(matrix, right[..., None])
    off = ((factors @ planes)[..., 0] - height[beside]) ** 2
    is_roof = (weight.sum(axis=1) >= _PLANE / 2) & (np.hypot(*planes[:, 1:, 0].T) <= _STEEPEST)
    is_plane = is_roof & ((weight * off).sum(axis=1) <= _FLAT**2 * weight.sum(axis=1))
    return np.where(is_plane, planes[:, 0, 0], height[point])


def _mean_heights(traced: Tracing, height: np.ndarray) -> np.ndarray:
    """Return the mean height (f,) of the roof's surface in each face."""
    is_roof = (traced.face >= 0) & (traced.label[traced.triangles] > 0).all(axis=1)
    is_roof &= np.isfinite(height[traced.triangles]).all(axis=1)
    face, triangles = traced.face[is_roof], traced.triangles[is_roof]
    a, b = (traced.xy[triangles[:, k]] - traced.xy[triangles[:, 0]] for k in (1, 2))
    area = np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    count = len(traced.labels)
    volume, total = np.bincount(face, area * height[triangles].mean(axis=1), count), np.bincount(face, area, count)
    return np.divide(volume, total, out=np.full(count, np.nan), where=total > 0)


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


def _main_reason(values: Optional[np.ndarray], rows: np.ndarray) -> str:
    """Return the sentence of the reason that most points have, "" without any; what was added later has none itself."""
    given = [] if values is None else values[rows].astype(np.int64)
    counts = np.bincount(given, minlength=max(Reason) + 1)
    roofs = [reason for reason in Reason if reason.is_building and reason not in ADDED and counts[reason]]
    return max(roofs, key=lambda reason: counts[reason]).text if roofs else ""
