"""Gaps of a raster filled with values from around them."""

import numpy as np

from ..packages import ndimage


def nearest_known(surface: np.ndarray, unknown: np.ndarray) -> np.ndarray:
    """Fill unknown cells with the value of the nearest known one."""
    if not unknown.any():
        return surface
    row, column = ndimage.distance_transform_edt(unknown, return_distances=False, return_indices=True)
    return surface[row, column]


def filled_by_means(surface: np.ndarray, unknown: np.ndarray, is_nearly_empty: bool = False) -> np.ndarray:
    """Fill unknown cells with Gaussian means of the known ones around, over ever larger surroundings.

    Parameters
    ----------
    surface : ndarray of shape (rows, columns)
        Values of the cells.
    unknown : ndarray of shape (rows, columns), bool
        Cells whose values do not count.
    is_nearly_empty : bool
        Whether most of the raster are gaps: wide means are then taken of larger blocks.

    Returns
    -------
    ndarray of shape (rows, columns)
        The surface without gaps; as it is where no cell is known.
    """
    # Widest standard deviation (cells) of a mean that is taken of all cells, which gaps of buildings need; wider ones
    # are means of blocks, half of it in blocks.
    widest_exact = 4 if is_nearly_empty else 16
    filled = np.where(unknown, np.nan, surface)
    weight = (~unknown).astype(float)
    weighted = np.where(unknown, 0.0, surface)
    # Standard deviation in cells, doubled until every unknown cell is reached or rounding is all that is left.
    scale, widest = 1.0, 4.0 * max(surface.shape)
    row, column = np.nonzero(unknown)
    while len(row) and scale < widest:
        share, mean = (_smoothed(raster, scale, widest_exact, row, column) for raster in (weight, weighted))
        # Far from known cells the share is rounding error only.
        is_reached = share > 1e-3
        filled[row[is_reached], column[is_reached]] = mean[is_reached] / share[is_reached]
        row, column = row[~is_reached], column[~is_reached]
        scale *= 2
    return nearest_known(filled, np.isnan(filled)) if np.isfinite(filled).any() else surface


def _smoothed(raster: np.ndarray, scale: float, widest_exact: int, row: np.ndarray, column: np.ndarray) -> np.ndarray:
    """Return the Gaussian means (m,) of a raster at some cells; of a wider standard deviation, by means of blocks.

    The time of a filter grows with its width: over gaps of hundreds of meters it would dominate.
    """
    if scale <= widest_exact:
        return ndimage.gaussian_filter(raster, scale, mode="nearest")[row, column]
    side = round(2 * scale / widest_exact)
    padded = np.pad(raster, [(0, -length % side) for length in raster.shape], mode="edge")
    blocks = padded.reshape(padded.shape[0] // side, side, -1, side).mean(axis=(1, 3))
    smooth = ndimage.gaussian_filter(blocks, scale / side, mode="nearest")
    at = [(cell + 0.5) / side - 0.5 for cell in (row, column)]
    return ndimage.map_coordinates(smooth, at, order=1, mode="nearest")
