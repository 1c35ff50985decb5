"""Whole buildings from their roofs: gaps, edges, what stands on the roof, and the walls below."""

from __future__ import annotations

from typing import Annotated, Optional

import numpy as np

from ..cloud.asprs import NOISE, PointClass
from ..cloud.density import point_density
from ..packages import ndimage
from ..params import MinBuildingArea, PointDensity
from ..stage import Monitor, Param, stage

# Cells hold at least a point where the roof was seen: this many point spacings, and no less than half a metre.
_CELL_SPACINGS, _LEAST_CELL = 1.2, 0.5

# Points lower than this stand on the ground (kerbs, plants, steps) and are no wall, m.
_WALL_FOOT = 0.5

_EIGHT = np.ones((3, 3), bool)


@stage(
    "Complete buildings",
    group="Buildings",
    tags="building,roof,facade,chimney,dormer,attach",
    writes=("classification", "cluster_id"),
)
def complete_buildings(
    xyz,
    classification,
    height_above_ground,
    *,
    gap: Annotated[
        float,
        Param(
            "Gap to close",
            "Gaps in a roof up to this wide are filled where no ground is seen in them (gutters, skylights, ridges).",
            unit="m",
            low=0,
            high=20,
        ),
    ] = 1.5,
    roof_clearance: Annotated[
        float,
        Param(
            "Clearance above the roof",
            "Points up to this far above the roof belong to it (chimneys, dormers, railings); higher ones are trees.",
            unit="m",
            low=0,
            high=20,
        ),
    ] = 1.0,
    min_area: MinBuildingArea = 4.0,
    density: PointDensity = None,
    monitor=None,
):
    """Add to each building what belongs to it beside its roof surfaces, and number the buildings.

    Buildings are decided in columns: where a roof was found, everything from the foot of the walls to just above
    the roof is building. Small gaps between roof surfaces are closed where the ground does not show in them.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; points of class 6 are the roofs to start from.
    height_above_ground : ndarray of shape (n,), float32
        Heights, m.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        Buildings 6; roofs of less than the minimum building area become 1.
    cluster_id : ndarray of shape (n,), int32
        Buildings from 1, from the south-west northward; 0 is none.

    Notes
    -----
    This stage is no part of the published method, whose clusters are roofs and lose what is not planar or not
    connected with them.

    References
    ----------
    Santos, R. C. dos, Pessoa, G. G., Carrilho, A. C., Galo, M., 2019. Building detection from LiDAR data using
    entropy and the k-means concept, section 4 (critical regions).
    """
    density = point_density(xyz) if density is None else density
    monitor.resolved(density=density)
    result = np.where(classification == PointClass.BUILDING, np.uint8(PointClass.UNCLASSIFIED), classification)
    cluster_id = np.zeros(len(xyz), np.int32)
    is_roof = classification == PointClass.BUILDING
    if not is_roof.any():
        return result.astype(np.uint8), cluster_id

    cell_size = max(_LEAST_CELL, _CELL_SPACINGS / np.sqrt(density))
    cell = _cells(xyz, cell_size, margin=gap)
    raised = (height_above_ground >= _WALL_FOOT) & ~np.isin(classification, NOISE)
    covered = _covered(cell, is_roof, raised, gap, cell_size)
    building = _numbered(covered, min_area / cell_size**2)
    top = _roof_top(cell, xyz[:, 2], is_roof, covered)
    number = building[cell]
    inside = raised & (number > 0) & (xyz[:, 2] <= top[cell] + roof_clearance)
    result[inside] = PointClass.BUILDING
    cluster_id[inside] = number[inside]
    return result.astype(np.uint8), cluster_id


def _cells(xyz: np.ndarray, cell_size: float, margin: float) -> tuple[np.ndarray, np.ndarray]:
    """Return row and column (n,) of each point's cell, with room for ``margin`` (m) around."""
    low = xyz[:, :2].min(axis=0) - margin - 2 * cell_size
    column, row = np.floor((xyz[:, :2] - low) / cell_size).astype(np.int64).T
    return row, column


def _covered(
    cell: tuple[np.ndarray, np.ndarray], is_roof: np.ndarray, raised: np.ndarray, gap: float, cell_size: float
) -> np.ndarray:
    """Return the cells (rows, columns) that roofs cover, gaps closed where the ground doesn't show."""
    row, column = cell
    margin = int(np.ceil(gap / cell_size)) + 2
    shape = (row.max() + margin, column.max() + margin)
    roof = np.zeros(shape, bool)
    roof[row[is_roof], column[is_roof]] = True
    open_ground = np.zeros(shape, bool)
    open_ground[row[~raised], column[~raised]] = True
    closed = roof
    reach = round(gap / 2 / cell_size)
    if reach:
        closed = roof | ndimage.binary_closing(roof, _disk(reach))
    holes = ndimage.binary_fill_holes(closed) & ~closed
    # A hole as narrow as the gap may be closed too; a courtyard may not.
    small = _small(holes, max(1.0, (gap / cell_size) ** 2))
    return roof | ((closed | small) & ~open_ground)


def _small(mask: np.ndarray, most: float) -> np.ndarray:
    """Return the part of ``mask`` that lies in regions of at most ``most`` cells."""
    region, count = ndimage.label(mask)
    size = np.bincount(region.ravel(), minlength=count + 1)
    size[0] = 0
    return mask & (size <= most)[region]


def _numbered(covered: np.ndarray, least: float) -> np.ndarray:
    """Number the regions of at least ``least`` cells from 1, from the south-west; 0 elsewhere."""
    region, count = ndimage.label(covered, _EIGHT)
    large = np.bincount(region.ravel(), minlength=count + 1) >= least
    large[0] = False
    return np.where(large, np.cumsum(large), 0).astype(np.int32)[region]


def _roof_top(
    cell: tuple[np.ndarray, np.ndarray], elevation: np.ndarray, is_roof: np.ndarray, covered: np.ndarray
) -> np.ndarray:
    """Return the elevation (rows, columns) of the highest roof point of each cell, that of the nearest where it has none."""
    row, column = cell
    top = np.full(covered.shape, -np.inf)
    np.maximum.at(top, (row[is_roof], column[is_roof]), elevation[is_roof])
    nearest = ndimage.distance_transform_edt(~np.isfinite(top), return_distances=False, return_indices=True)
    return top[tuple(nearest)]


def _disk(radius: int) -> np.ndarray:
    row, column = np.mgrid[-radius : radius + 1, -radius : radius + 1]
    return row**2 + column**2 <= radius**2 + 0.5 * radius
