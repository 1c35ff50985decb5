"""Noise far above or below everything else, from height histograms of cells."""

from typing import Optional

import numpy as np

from ..geometry.grid import Grid
from ..geometry.groups import mask_of, placed
from ..packages import spatial
from ..params import MIN_FREQUENCY
from ..rules import rule, rules
from ..sampling.cloud_sampling import MEASURED, CloudSampling, with_noise
from ..sampling.density import DENSITY
from ..sampling.kinds import SCENE
from ..stage import Monitor, stage, tunable
from . import height_histograms
from .height_histograms import AUTOMATIC_BIN, HISTOGRAM_POINTS, Histogram, Ranges
from .points_under_ground import UNDER_GROUND, under_ground


@rules
class HISTOGRAM:
    """Limits of gaps in a histogram that separate noise from the scene."""

    gap: int = rule(2, "bins", "physics: empty ones; chimneys, treetops and rock faces leave no such gap")


@stage(
    "Preparation",
    title="Classify noise by height histogram",
    tags="noise,outliers,birds,low points,high points,multipath,histogram,clean,denoise,lasnoise",
    writes=("classification",),
    # About the width of an automatic cell: histograms count a cell and the cells around it.
    reach=SCENE.ground_within,
    cost=1.5,
)
def classify_noise_histogram(
    xyz,
    classification,
    *,
    min_frequency: int = MIN_FREQUENCY,
    cell_size: Optional[float] = tunable(
        None,
        within="[0.1, 10_000] m",
        automatic=f"cells that have {HISTOGRAM_POINTS:,} points with those around them, on average.",
        advanced=True,
    ),
    bin_height: Optional[float] = tunable(None, within="[0.01, 1000] m", automatic=AUTOMATIC_BIN, advanced=True),
    max_clearance: float = tunable(200.0, within="[1, 100_000] m", advanced=True),
    isolated: bool = tunable(True, label="Isolated points under the ground"),
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Find points far above or below the scene, such as birds, clouds and multipath returns.

    The heights of each cell and its neighbors make a histogram. From both ends inward, bins that hold few points and
    are separated from the scene by a gap are noise: low noise (class 7) below it and high noise (class 18) above it.
    Then come isolated points under the ground. 'Classify noise in the air' finds birds and dust between these heights.

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
        Side of the cells whose heights are counted, each together with the eight cells around it.
    bin_height
        Height of the bins; at least two empty ones separate noise from the scene.
    max_clearance
        Height over the scene, or depth under it, beyond which everything is noise, however many points it has: clouds,
        aircraft, flocks. Cables over a deep valley may need more.
    isolated
        Also find single points and a few together under the ground (multipath), within the heights of the scene.

    Notes
    -----
    Bins are examined from both ends of a histogram only, so that sparse points of a facade, between ground and roof,
    stay. Parts adjoining the scene stay too (chimneys, masts, treetops, slopes), and so do three high points close
    together (a lamp, a wire). A cell whose surroundings have no full bin gets the range of the nearest one that has.

    Isolated points under the ground are found without histograms: single points or a few, ``UNDER_GROUND.depth`` m or
    more below the surface on all sides. They are not near others of the same height, as ground seen between leaves is.
    More than three that share a level over meters, to the noise of surfaces, and are most of those around, are a floor,
    seen through glass or in a shaft. Among crowns and in narrow yards points just below the ground are left alone.

    The filter of the paper (T_f) has no gap, no groups, no pooled cells and no isolated points; see 'Classify noise by
    height histogram (as published 2019)'.

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
    >>> int(classify_noise_histogram(bird, np.zeros(len(bird)))[-1])
    18
    """
    made = classification.astype(np.uint8)
    points, used = sampling.without_noise(xyz, made, monitor)
    if not len(used):
        return made
    spacing = sampling.spacing
    cell_size = float(np.sqrt(HISTOGRAM_POINTS / 9)) * spacing if cell_size is None else cell_size
    bin_height = height_histograms.automatic_bin_height(spacing) if bin_height is None else bin_height
    monitor.resolved(cell_size=cell_size, bin_height=bin_height)
    monitor.progress(0.2)
    beyond = _beyond_scene(points, cell_size, bin_height, min_frequency, max_clearance, monitor.part(0.2, 0.7))
    if beyond is None:
        monitor.warn(f"No noise was found: no bin of the histograms has {min_frequency} points.")
        return made
    is_low, is_high, is_near = beyond
    hanging = np.flatnonzero(is_high & is_near)
    is_high[hanging[_in_group(points[hanging], max(1.0, DENSITY.link * spacing))]] = False
    if isolated:
        rest = np.flatnonzero(~(is_low | is_high))
        is_low[rest[under_ground(points.take(rest, axis=0), spacing, sampling.noise, monitor.part(0.7, 1.0))]] = True
    return with_noise(made, used[is_low], used[is_high], monitor)


def _beyond_scene(
    points: np.ndarray, cell_size: float, bin_height: float, min_frequency: int, max_clearance: float, monitor: Monitor
) -> Optional[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Return masks of points (n,): below the scene, above it, and not too far above to belong to it.

    None where no bin has enough points to be the scene.
    """
    grid, cell, level = height_histograms.cells_and_levels(points, cell_size, bin_height)
    histogram = height_histograms.pooled_histogram(grid, cell, level)
    monitor.progress(0.6)
    clearance = max_clearance / bin_height
    cells, low, high = _scene_range(grid, histogram, min_frequency, clearance)
    if not len(cells):
        return None
    at = np.searchsorted(cells, cell)
    return level < low[at], level > high[at], level <= high[at] + clearance


def _scene_range(grid: Grid, histogram: Histogram, min_frequency: int, max_clearance: float) -> Ranges:
    """Return all occupied cells, ascending, and the lowest and highest level of the scene in each.

    ``max_clearance`` is in levels.
    """
    cells, start = np.unique(histogram.cell, return_index=True)
    # Runs of bins without a gap: one full bin makes all bins of its run part of the scene.
    is_break = np.diff(histogram.level, prepend=0) > HISTOGRAM.gap
    is_break[start] = True
    run = np.cumsum(is_break) - 1
    first = np.flatnonzero(is_break)
    is_full = mask_of(len(first), run[histogram.count >= min_frequency])
    run_cell = np.searchsorted(cells, histogram.cell[first])[is_full]
    run_low = histogram.level[first][is_full]
    run_high = histogram.level[np.append(first[1:], len(run)) - 1][is_full]

    # All other runs must be near the one with most points.
    order = np.lexsort((np.bincount(run, histogram.count)[is_full], run_cell))
    main = placed(order, run_cell[order], len(cells))
    clearance = np.maximum(run_low - run_high[main[run_cell]], run_low[main[run_cell]] - run_high)
    near = clearance <= max_clearance
    low, high = np.full(len(cells), np.iinfo(np.int64).max), np.full(len(cells), -1)
    np.minimum.at(low, run_cell[near], run_low[near])
    np.maximum.at(high, run_cell[near], run_high[near])
    return height_histograms.with_borrowed_ranges(grid, cells, low, high, HISTOGRAM.gap)


def _in_group(points: np.ndarray, radius: float) -> np.ndarray:
    """Return the mask of points that have at least three points, themselves among them, within ``radius`` (m)."""
    if len(points) < UNDER_GROUND.few:
        return np.zeros(len(points), bool)
    return spatial.cKDTree(points).query(points, UNDER_GROUND.few)[0][:, -1] <= radius
