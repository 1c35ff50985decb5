"""Noise above or below everything else by height histograms of cells, as published."""

from typing import Optional

import numpy as np

from ..geometry.grid import Grid
from ..params import MIN_FREQUENCY
from ..sampling.cloud_sampling import MEASURED, CloudSampling, with_noise
from ..stage import stage, tunable
from . import height_histograms
from .height_histograms import AUTOMATIC_BIN, HISTOGRAM_POINTS, Histogram, Ranges


@stage(
    "Preparation",
    title="Classify noise by height histogram (as published 2019)",
    tags="noise,outliers,birds,low points,high points,multipath,histogram,clean,CH filter,Carrilho",
    writes=("classification",),
    # The width of a cell at 1 point/m²; it is narrower in denser clouds. A cell without a full bin borrows from cells
    # around it, which may lie beyond that where a survey is run in tiles.
    reach=lambda tunables: tunables["cell_size"] or HISTOGRAM_POINTS**0.5,
    cost=0.3,
)
def classify_noise_histogram_2019(
    xyz,
    classification,
    *,
    min_frequency: int = MIN_FREQUENCY,
    cell_size: Optional[float] = tunable(
        None, within="[0.1, 10_000] m", automatic=f"cells of {HISTOGRAM_POINTS:,} points on average.", advanced=True
    ),
    bin_height: Optional[float] = tunable(None, within="[0.01, 1000] m", automatic=AUTOMATIC_BIN, advanced=True),
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Find points far above or below the scene by the cell histogram filter.

    The heights of each cell make a histogram. From both ends inward, bins with fewer points than the minimum frequency
    are noise, up to the first bin that has at least as many: low noise (class 7) below, high noise (class 18) above it.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m).
    classification : ndarray of shape (n,)
        Classes; points that are noise already stay so and are not counted.

    Returns
    -------
    ndarray of shape (n,), uint8
        The classes, 7 and 18 for the noise that was found, all others as they were.

    Other Parameters
    ----------------
    cell_size
        Side of the cells whose heights are counted.
    bin_height
        Height of the bins.

    Notes
    -----
    The paper names the filter and its threshold T_f, which is 5 in both of its scenes; cells and bins are not given,
    and follow the density of the cloud. A cell in which no bin has enough points borrows the histogram of itself and
    its eight neighbors, and where these have none either, the range of the nearest cell that has one.

    Tips of trees, chimneys, masts and wires that have few points in a bin are noise by this rule.
    'Classify noise by height histogram' asks for a gap and keeps them, and finds single points between the heights of
    the scene.

    References
    ----------
    Carrilho et al. (2018), Statistical outlier detection method for airborne LiDAR data. [carrilho2018]
    Santos et al. (2019), Building detection from LiDAR data using entropy and the k-means concept, section 2.1.
    [santos2019]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> bird = np.vstack([xyz, [20, 20, 60]])
    >>> int(classify_noise_histogram_2019(bird, np.zeros(len(bird)))[-1])
    18
    """
    classes = classification.astype(np.uint8)
    points, used = sampling.without_noise(xyz, classes, monitor)
    if not len(used):
        return classes
    spacing = sampling.spacing
    cell_size = float(np.sqrt(HISTOGRAM_POINTS)) * spacing if cell_size is None else cell_size
    bin_height = height_histograms.automatic_bin_height(spacing) if bin_height is None else bin_height
    monitor.resolved(cell_size=cell_size, bin_height=bin_height)

    grid, cell, level = height_histograms.cells_and_levels(points, cell_size, bin_height)
    monitor.progress(0.3)
    cells, low, high = _bodies(grid, cell, level, min_frequency)
    if not len(cells):
        monitor.warn(f"No noise was found: no bin of the histograms has {min_frequency} points.")
        return classes
    at = np.searchsorted(cells, cell)
    is_low, is_high = level < low[at], level > high[at]
    return with_noise(classes, used[is_low], used[is_high], monitor)


def _bodies(grid: Grid, cell: np.ndarray, level: np.ndarray, min_frequency: int) -> Ranges:
    """Return all occupied cells, ascending, and the lowest and highest level of the main body in each.

    Without any full bin no cells are returned.
    """
    cells, low, high = _full_range(height_histograms.own_histogram(cell, level), min_frequency)
    is_poor = high < 0
    if is_poor.any():
        _, pooled_low, pooled_high = _full_range(height_histograms.pooled_histogram(grid, cell, level), min_frequency)
        low, high = np.where(is_poor, pooled_low, low), np.where(is_poor, pooled_high, high)
    return height_histograms.with_borrowed_ranges(grid, cells, low, high)


def _full_range(histogram: Histogram, min_frequency: int) -> Ranges:
    """Return the cells, ascending, and their lowest and highest level with ``min_frequency`` points.

    The highest one is -1 in cells without such a level.
    """
    cells, which = np.unique(histogram.cell, return_inverse=True)
    is_full = histogram.count >= min_frequency
    low, high = np.full(len(cells), np.iinfo(np.int64).max), np.full(len(cells), -1)
    np.minimum.at(low, which[is_full], histogram.level[is_full])
    np.maximum.at(high, which[is_full], histogram.level[is_full])
    return cells, low, high
