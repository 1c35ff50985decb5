"""Terrain and surface as rasters."""

from typing import Optional

import numpy as np

from ..cloud.asprs import NOISE, PointClass
from ..criteria import CELL_SPACINGS
from ..geometry.grid import EIGHT, refuse_sparse
from ..geometry.sparse_voxels import voxel_index
from ..geometry.tiled_tin import TiledTin
from ..packages import ndimage
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..stage import Monitor, Raster, RasterSurface, stage, tunable

# Least side of a cell (m) that is set automatically.
_LEAST_CELL = 0.05

# Largest side of a cell (m): rasters begin at whole kilometers, so that larger cells would differ between clouds.
_MOST_CELL = 1000.0

# Gaps are filled up to this distance (cells) from the nearest cell with points.
_GAP_CELLS = 5.0


@stage(
    "Terrain",
    tags="DTM,DSM,nDSM,DEM,CHM,elevation model,raster,GeoTIFF,interpolate,TIN,hillshade,canopy,las2dem,blast2dem,grid",
    rasters=(
        Raster("dtm", "Terrain model", "terrain", "m"),
        Raster("dsm", "Surface model", "terrain", "m"),
        Raster("ndsm", "Heights above the terrain", "heights", "m"),
    ),
    cost=5.0,
)
def rasterize_terrain(
    xyz,
    classification,
    *,
    cell_size: Optional[float] = tunable(
        None,
        within=f"[0.01, {_MOST_CELL}] m",
        automatic=(
            f"{CELL_SPACINGS:g} times the point spacing, rounded to 1, 2 or 5 times a power of ten; at "
            f"least {_LEAST_CELL:g} m."
        ),
    ),
    gap_distance: Optional[float] = tunable(None, within="[0, 10_000] m", automatic=f"{_GAP_CELLS:g} cells."),
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Make rasters of the terrain, of the surface with all objects on it, and of the difference.

    The terrain model (DTM) is the triangulated surface (TIN) of the ground points (class 2), at the middle of each
    cell. The surface model (DSM) holds the highest point of each cell. The heights (nDSM) are surface minus terrain.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; ground is 2, noise (7, 18) is left out.

    Returns
    -------
    dtm, dsm, ndsm : RasterSurface
        Elevations and heights, m, on the same cells; NaN where there is nothing.

    Other Parameters
    ----------------
    cell_size
        Side of a cell of the rasters.
    gap_distance
        Cells of the surface model without points are interpolated up to this far from cells with points.

    Raises
    ------
    ValueError
        If no point is ground, or the points are spread so thinly that the rasters are nearly empty.

    Notes
    -----
    Cells lie at multiples of their size from a corner at whole kilometers of the map. Neighboring clouds have the same
    cells if these divide 1000 m, as 1, 2 and 5 times a power of ten do.

    There is no terrain outside the hull of the ground points. Small gaps of the surface (shadows, dark roofs, water)
    are interpolated linearly between the cells around them; larger ones stay empty.

    References
    ----------
    Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection, section 2.2.
    [hrutka2022]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 1, 2)
    >>> terrain, surface, heights = rasterize_terrain(xyz, classes, cell_size=1.0)
    >>> float(np.nanmax(heights.values))
    5.0
    """
    is_ground = classification == PointClass.GROUND
    if not is_ground.any():
        raise ValueError("The cloud has no ground points (class 2); run 'Classify ground points (TIN)' first.")
    used = xyz[~np.isin(classification, NOISE)]
    if cell_size is None:
        cell_size = round_cell_size(CELL_SPACINGS * sampling.spacing)
    gap_distance = _GAP_CELLS * cell_size if gap_distance is None else gap_distance
    monitor.resolved(cell_size=cell_size, gap_distance=gap_distance)
    refuse_sparse(used, cell_size)

    # Cells lie at multiples of their size, so that rasters of neighboring clouds have no seams.
    cell = voxel_index(used[:, :2] / cell_size, cell_size)
    first = cell.min(axis=0)
    cell = (cell - first).astype(np.int64)
    columns, rows = (cell.max(axis=0) + 1).tolist()
    # Measured from the south-western corner, rounding is the same wherever on Earth that is.
    corner = np.append(first * cell_size, 0.0)
    middle = _middles(cell_size, rows, columns)
    ground = TiledTin(xyz[is_ground] - corner)
    dtm = ground.elevation(middle.reshape(-1, 3), monitor.part(0, 0.6)).reshape(rows, columns)
    if np.isnan(dtm).all():
        monitor.warn("The ground points span no area: the terrain model is empty.")
    dsm = _highest(used[:, 2], cell, rows, columns)
    _fill_gaps(dsm, middle, gap_distance / cell_size, monitor.part(0.6, 1))
    west, north = float(corner[0]), float(corner[1]) + rows * cell_size
    return tuple(RasterSurface(values.astype(np.float32), west, north, cell_size) for values in (dtm, dsm, dsm - dtm))


def round_cell_size(size: float) -> float:
    """Return the round number nearest in proportion to a size, both in m, from 0.05 to 1000."""
    power = np.floor(np.log10(size))
    numbers = np.array([1.0, 2.0, 5.0, 10.0])
    number = numbers[np.argmin(np.abs(np.log(numbers * 10**power / size)))]
    return float(np.clip(float(f"{number * 10**power:.0e}"), _LEAST_CELL, _MOST_CELL))


def _middles(size: float, rows: int, columns: int) -> np.ndarray:
    """Return the middle of each cell (rows, columns, 3) from the south-western corner, at elevation 0."""
    middle = np.zeros((rows, columns, 3))
    middle[..., 0] = (np.arange(columns) + 0.5) * size
    middle[..., 1] = ((rows - np.arange(rows) - 0.5) * size)[:, None]
    return middle


def _highest(elevation: np.ndarray, cell: np.ndarray, rows: int, columns: int) -> np.ndarray:
    """Return the elevation of the highest point of each cell (rows, columns), NaN without points.

    ``cell`` (n, 2) are the column of each point and its row, counted from the south.
    """
    column, from_south = cell.T
    highest = np.full((rows, columns), np.nan)
    np.fmax.at(highest, (rows - 1 - from_south, column), elevation)
    return highest


def _fill_gaps(surface: np.ndarray, middle: np.ndarray, reach: float, monitor: Monitor) -> None:
    """Interpolate, in place, empty cells at most ``reach`` cells from a filled one, between the filled ones around."""
    empty = np.isnan(surface)
    gap = empty & (ndimage.distance_transform_edt(empty) <= reach) if empty.any() else empty
    monitor.progress(0.2)
    if not gap.any():
        return
    # Cells inside the surface don't influence its gaps.
    rim = ~empty & ndimage.binary_dilation(empty, EIGHT)
    nodes = middle[rim]
    nodes[:, 2] = surface[rim]
    surface[gap] = TiledTin(nodes).elevation(middle[gap], monitor.part(0.2, 1))
