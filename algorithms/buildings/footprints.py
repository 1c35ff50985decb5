"""Footprints: the outlines of building clusters as polygons."""

from __future__ import annotations

from typing import Annotated, Optional

import numpy as np

from ..cloud.asprs import PointClass
from ..cloud.cells import find_cells, grid_over
from ..cloud.density import point_spacing
from ..packages import spatial
from ..params import MinBuildingArea
from ..stage import Features, Field, Layer, Param, stage
from .outlines import perimeter, signed_area, trace_outlines
from .regularize import regularize_outline

_FIELDS = (
    Field("id", int, "number of the footprint, from 1"),
    Field("cluster_id", int, "cluster that it outlines"),
    Field("area", float, "area without holes", "m²"),
    Field("perimeter", float, "length of the exterior and the holes", "m"),
    Field("height", float, "median height of the roof's points above ground", "m"),
    Field("max_height", float, "greatest height above ground", "m"),
    Field("ground_elevation", float, "median elevation of the ground under the roof's points", "m"),
    Field("entropy", float, "mean entropy of the cluster"),
    Field("points", int, "points of the building, walls among them"),
    Field("confidence", float, "0 unsure to 1 sure of being a building"),
    Field("regularized", int, "1 straightened, 0 outline as traced"),
)


@stage(
    "Extract footprints",
    group="Buildings",
    tags="polygons,outlines,alpha shape,concave hull,vectorize,regularize,right angles",
    layers=(Layer("footprints", "Footprints", "Polygon", _FIELDS, style="footprints"),),
)
def extract_footprints(
    xyz,
    classification,
    cluster_id=None,
    height_above_ground=None,
    cluster_entropy=None,
    confidence=None,
    *,
    min_area: MinBuildingArea = 4.0,
    min_hole_area: Annotated[
        float,
        Param(
            "Minimum hole area", "Smaller holes are filled, larger ones are courtyards.", unit="m²", low=0, high=10_000
        ),
    ] = 5.0,
    max_edge: Annotated[
        Optional[float],
        Param(
            "Longest edge",
            "Points farther apart are not joined. Longer edges close gaps and round off corners that point inward.",
            unit="m",
            low=0.01,
            high=100,
            automatic="adapted to the spacing of the points of each cluster, from 4 to 8 times the mean spacing.",
            advanced=True,
        ),
    ] = None,
    regularize: Annotated[
        bool,
        Param(
            "Regularize outlines", "Make walls straight and, where they nearly are, parallel or square to each other."
        ),
    ] = True,
    tolerance: Annotated[
        Optional[float],
        Param(
            "Tolerance",
            "Wiggles of the traced outline that are taken for straight; an outline that would have to move by more "
            "than twice that stays as traced.",
            unit="m",
            low=0.01,
            high=100,
            automatic="twice the mean spacing of the building points, at least 0.3 m.",
            advanced=True,
        ),
    ] = None,
    monitor=None,
):
    """Outline each building as a polygon with its area, heights, entropy and confidence.

    Each cluster of building points is outlined by an alpha shape that adapts to the spacing of its points, with
    courtyards as holes; walls are then made straight along the main directions of the building where that stays
    close to the points.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m).
    classification : ndarray of shape (n,)
        Classes; points of class 6 are outlined.
    cluster_id : ndarray of shape (n,), optional
        Building of each point, from 1; points of 0 are left out. Without it, points that lie together are a building.
    height_above_ground : ndarray of shape (n,), optional
        Heights (m), for the attributes only.
    cluster_entropy : ndarray of shape (n,), optional
        Mean entropy of the cluster, for the attributes only.
    confidence : ndarray of shape (n,), optional
        Sureness of being a building, 0 to 1, for the attributes only.

    Returns
    -------
    Features
        One valid polygon per building part that is not connected with others, largest cluster number last; attributes
        without the dimension they come from are NaN. None at all where there is no building.

    Notes
    -----
    Points with another one more than a meter (or three spacings) higher beside them are walls: they count as points
    of the building but don't widen its outline. The outline runs through the outermost points, which lie inside the
    eaves; where it is regularized its walls are moved outward by half a point spacing to make up for that. Clusters
    whose points lie on one line have no area and give no polygon.

    References
    ----------
    Santos et al. (2019), Extraction of building roof boundaries from LiDAR data using an adaptive alpha shape.
    Santos et al. (2019), Building detection from LiDAR data using entropy and the k-means concept.
    """
    building = np.flatnonzero((classification == PointClass.BUILDING) & (cluster_id is None or cluster_id > 0))
    found = Features([], {field.name: [] for field in _FIELDS})
    if not len(building) or not np.ptp(xyz[building, :2], axis=0).any():
        return found
    spacing = point_spacing(xyz[building])
    if tolerance is None:
        tolerance = max(0.3, 2 * spacing)
        monitor.resolved(tolerance=tolerance)

    is_roof = _is_roof(xyz[building], spacing)
    measured = {"height": height_above_ground, "entropy": cluster_entropy, "confidence": confidence}
    edges = []
    clusters = _clusters(building, cluster_id)
    for done, (number, rows) in enumerate(clusters, start=1):
        members, roof = building[rows], is_roof[rows]
        outlines = trace_outlines(xyz[members[roof], :2], spacing, max_edge)
        edges += [outlines.max_edge] * bool(outlines.parts)
        part_of_member = _part_of_members(xyz[members, :2], roof, outlines.part_of_point)
        for part, rings in enumerate(outlines.parts):
            traced = [rings[0], *(hole for hole in rings[1:] if -signed_area(hole) >= min_hole_area)]
            if sum(map(signed_area, traced)) < min_area:
                continue
            straight = regularize_outline(traced, tolerance, spacing / 2) if regularize else None
            own = part_of_member == part
            described = _attributes(xyz, members[own], members[own & roof], measured)
            described.update(cluster_id=number, regularized=int(straight is not None))
            _add(found, straight or traced, described)
        monitor.progress(done / len(clusters))
    if max_edge is None and edges:
        monitor.resolved(max_edge=float(np.median(edges)))
    return found


def _clusters(building: np.ndarray, cluster_id: Optional[np.ndarray]) -> list:
    """Return the number of each cluster and the positions of its points in ``building``."""
    if cluster_id is None:
        return [(0, np.arange(len(building)))]
    numbers = cluster_id[building]
    order = np.argsort(numbers, kind="stable")
    starts = np.flatnonzero(np.diff(numbers[order], prepend=0))
    return [(int(numbers[rows[0]]), rows) for rows in np.split(order, starts[1:])]


def _is_roof(xyz: np.ndarray, spacing: float) -> np.ndarray:
    """Return which points have none far above them in their cell of one spacing and the eight around it."""
    grid = grid_over(xyz, spacing)
    cell = grid.number(xyz)
    order = np.lexsort((xyz[:, 2], cell))
    last = np.flatnonzero(np.diff(cell[order], append=-1))
    cells, top = cell[order][last], xyz[order[last], 2]
    highest = top.copy()
    for step in grid.around:
        position, found = find_cells(cells, cells + step)
        highest[found] = np.maximum(highest[found], top[position[found]])
    return xyz[:, 2] >= highest[np.searchsorted(cells, cell)] - max(1.0, 3 * spacing)


def _part_of_members(xy: np.ndarray, roof: np.ndarray, part_of_roof: np.ndarray) -> np.ndarray:
    """Return the part of each point of a cluster: that of the nearest outlined point, -1 where there is none."""
    part = np.full(len(xy), -1)
    part[np.flatnonzero(roof)] = part_of_roof
    if part_of_roof.max(initial=-1) <= 0:
        part[:] = part_of_roof.max(initial=-1)
        return part
    has, left = np.flatnonzero(part >= 0), np.flatnonzero(part < 0)
    if len(left):
        part[left] = part[has[spatial.cKDTree(xy[has]).query(xy[left])[1]]]
    return part


def _attributes(xyz: np.ndarray, members: np.ndarray, roof: np.ndarray, measured: dict) -> dict:
    """Return what the points of one footprint say of it."""
    height, entropy, confidence = (measured[name] for name in ("height", "entropy", "confidence"))
    undefined = float("nan")
    return {
        "height": undefined if height is None else float(np.median(height[roof])),
        "max_height": undefined if height is None else float(np.max(height[roof])),
        "ground_elevation": undefined if height is None else float(np.median(xyz[roof, 2] - height[roof])),
        "entropy": undefined if entropy is None else _mean(entropy[members]),
        "confidence": undefined if confidence is None else _mean(confidence[members]),
        "points": len(members),
    }


def _mean(values: np.ndarray) -> float:
    """Return the mean of the values that are defined: points that were added to a building later have none."""
    defined = values[np.isfinite(values)]
    return float(np.mean(defined, dtype=np.float64)) if len(defined) else float("nan")


def _add(found: Features, rings: list, described: dict) -> None:
    """Append a footprint to those found, with what its shape says of it."""
    found.geometries.append(rings)
    shape = {"area": sum(map(signed_area, rings)), "perimeter": sum(map(perimeter, rings))}
    for name, value in {"id": len(found), **described, **shape}.items():
        found.columns[name].append(value)
