"""Thinning of points: one for every occupied voxel."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..cloud.asprs import CODES
from ..geometry.groups import items, run_starts
from ..geometry.sparse_voxels import MOST_KEYS, TOUCH, refuse_fine, voxel_index
from ..stage import Monitor, stage, tunable
from ..threads import ROWS_AT_ONCE, in_chunks

# Steps on the side of a voxel: positions in it are whole numbers of steps, so that sums don't depend on the order.
_STEPS = 2.0**32


@dataclass(frozen=True)
class _Sorted:
    """The points in the order of their voxels."""

    order: np.ndarray  #: Positions of the points, by voxel, then as in the file
    starts: np.ndarray  #: Where each voxel's points begin in ``order``
    count: np.ndarray  #: Points of each voxel

    def rows(self, voxels: np.ndarray) -> np.ndarray:
        """Return the positions of the points of some voxels, voxel after voxel."""
        voxel, item = items(self.count[voxels])
        return self.order[self.starts[voxels][voxel] + item]

    def chunks(self, voxels: np.ndarray) -> list[np.ndarray]:
        """Cut a list of voxels into some that have about as many points as are worked on at once."""
        cuts = np.searchsorted(np.cumsum(self.count[voxels]), np.arange(0, len(self.order), ROWS_AT_ONCE))
        return [chunk for chunk in np.split(voxels, np.unique(cuts)) if len(chunk)]


@stage(
    "Preparation",
    title="Downsample to voxels",
    tags="las,laz,copc,pdal,thin,decimate,subsample,reduce,voxel grid,center of gravity,centroid,even density,lasthin",
    writes=("xyz", "classification", "voxel_count"),
    selects=True,
    reach=lambda tunables: tunables["voxel_size"],
    cost=0.3,
)
def downsample_voxels(
    xyz,
    classification=None,
    gps_time=None,
    return_number=None,
    *,
    voxel_size: float = tunable(0.1, within="[0.001, 1000] m"),
    monitor=None,
):
    """Leave one point in every occupied voxel: the center of gravity of its points.

    Evens out the density of scans, where surfaces that are near or scanned twice have many times the points of others,
    and makes clouds smaller. The class is the most frequent one in the voxel, VoxelCount their number. Everything else
    but the position comes from the point nearest to the center.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m).
    classification : ndarray of shape (n,), optional
        Classes. Noise counts like any other class; alone as it mostly is, it keeps voxels of its own.
    gps_time, return_number : ndarray of shape (n,), optional
        They choose between points at the same position, and for nothing else.

    Returns
    -------
    selected : ndarray of shape (m,), int64
        For each voxel, from west to east, then south to north, then upward, the point nearest to its center of
        gravity. Of points equally near (to 0.1 µm), the one farthest west, then south, then down is taken; of points
        at one position the earliest by time, then by number of return, then in the cloud.
    xyz : ndarray of shape (m, 3), float64
        Centers of gravity (m). A point that is alone in its voxel stays where it is.
    classification : ndarray of shape (m,), uint8
        The most frequent class of each voxel, the lowest of those that are equally frequent. None without classes.
    voxel_count : ndarray of shape (m,), uint32
        Points in each voxel.

    Other Parameters
    ----------------
    voxel_size
        Side of the cubes that are left with one point each. Take more than the noise of the scanner and less than the
        smallest object of interest.

    Raises
    ------
    ValueError
        If the voxels are finer than the resolution of float64 coordinates.

    Notes
    -----
    Voxels start at the origin of the coordinates, not at the first point, so that clouds of the same site get the same
    voxels. A point on the side between two voxels belongs to the eastern, northern or upper one. One that is less
    than 0.1 µm off counts as on the side, since decimals like 0.3 have no exact binary number. The result depends on
    neither the order of the points nor, but for this rounding, on where the cloud lies.

    References
    ----------
    Weinmann et al. (2017), Point cloud analysis for UAV-borne laser scanning with horizontally and vertically oriented
    line scanners, section 4.1. [weinmann2017]
    Hrutka et al. (2022), Voxel-based point cloud segmentation and building detection, section 2.2. [hrutka2022]

    Examples
    --------
    >>> import numpy as np
    >>> from lidar_buildings.algorithms.preparation.downsample_voxels import downsample_voxels
    >>> xyz = np.array([[0.01, 0.0, 0.0], [0.03, 0.0, 0.0], [0.08, 0.0, 0.0], [0.1, 0.0, 0.0]])
    >>> selected, center, _, count = downsample_voxels(xyz, voxel_size=0.1)
    >>> selected.tolist(), center[:, 0].round(6).tolist(), count.tolist()
    ([1, 3], [0.04, 0.1], [3, 1])
    """
    voxels = _by_voxel(xyz, voxel_size, monitor.part(0.0, 0.3))
    # Points alone in their voxel stay as they are.
    selected = voxels.order[voxels.starts]
    center = xyz.take(selected, axis=0)
    majority = None if classification is None else classification.take(selected).astype(np.uint8)
    chunks = voxels.chunks(np.flatnonzero(voxels.count > 1))

    def work(chunk: np.ndarray) -> None:
        these = chunks[chunk[0]]
        rows, count = voxels.rows(these), voxels.count[these]
        which = np.repeat(np.arange(len(these)), count)
        # The positions inside each voxel, their sum, and the point nearest to their mean.
        position = _positions(xyz.take(rows, axis=0), voxel_size)
        total = np.add.reduceat(position, run_starts(which), axis=0)
        nearest = _nearest(position, total, which, TOUCH / voxel_size * _STEPS, (gps_time, return_number), rows)
        selected[these] = rows[nearest]
        shift = total / count[:, None] - position[nearest]
        center[these] = xyz.take(rows[nearest], axis=0) + shift * (voxel_size / _STEPS)
        if majority is not None:
            majority[these] = _majority(classification.take(rows), which)

    in_chunks(work, np.arange(len(chunks)), 1, monitor.part(0.3, 1.0))
    monitor.resolved(share_left=len(selected) / len(xyz))
    return selected, center, majority, voxels.count.astype(np.uint32)


def _by_voxel(xyz: np.ndarray, size: float, monitor: Monitor) -> _Sorted:
    """Return the points in the order of their voxels: by x, then y, then z, and within one as in the cloud."""
    key = _keys(xyz, size, monitor)
    order = np.argsort(key, kind="stable")
    starts = run_starts(key[order])
    return _Sorted(order, starts, np.diff(starts, append=len(order)))


def _keys(xyz: np.ndarray, size: float, monitor: Monitor) -> np.ndarray:
    """Return a number for each point's voxel (n,), int64, from 0, that grows with x, then y, then z."""
    ends = np.array([(column.min(), column.max()) for column in xyz.T], float)
    refuse_fine(float(np.abs(ends).max()), size)
    low, high = voxel_index(ends / size, size).T.astype(np.int64)
    _, n_y, n_z = shape = [int(count) for count in high - low + 1]
    if math.prod(shape) > MOST_KEYS:
        return _keys_of_wide(xyz, size)
    key = np.empty(len(xyz), np.int64)

    def work(start: np.ndarray) -> None:
        rows = slice(start[0], start[0] + ROWS_AT_ONCE)
        x, y, z = (voxel_index(xyz[rows] / size, size).astype(np.int64) - low).T
        key[rows] = (x * n_y + y) * n_z + z

    in_chunks(work, np.arange(0, len(xyz), ROWS_AT_ONCE), 1, monitor)
    return key


def _keys_of_wide(xyz: np.ndarray, size: float) -> np.ndarray:
    """Return keys as :func:`_keys`, but number only voxels with points: all are more than int64 holds."""
    key, n_keys = np.zeros(len(xyz), np.int64), 1
    for column in xyz.T:
        index, n_index = _renumbered(voxel_index(column / size, size))
        if n_keys * n_index > MOST_KEYS:
            key, n_keys = _renumbered(key)
        key = key * n_index + index
        n_keys *= n_index
    return key


def _renumbered(key: np.ndarray) -> tuple[np.ndarray, int]:
    """Return numbers in the same order without gaps, and how many there are."""
    used, key = np.unique(key, return_inverse=True)
    return key, len(used)


def _positions(points: np.ndarray, size: float) -> np.ndarray:
    """Return the positions of points in their voxels, int64 (m, 3), in steps."""
    scaled = points / size
    scaled -= voxel_index(scaled, size)
    scaled *= _STEPS
    return np.rint(scaled).astype(np.int64)


def _nearest(
    position: np.ndarray,
    total: np.ndarray,
    which: np.ndarray,
    touch: float,
    times: tuple[Optional[np.ndarray], ...],
    rows: np.ndarray,
) -> np.ndarray:
    """Return, for each of k voxels, the position of the point nearest to the center.

    The points come voxel by voxel, with their ``position`` (m, 3), int64, their voxel ``which`` (m,) and their
    ``rows`` (m,) in the cloud; ``total`` (k, 3) is the sum of the positions of each voxel. Distances that
    differ by less than ``touch`` (steps) are equal but for rounding. ``times`` are dimensions (n,) of the cloud, or
    None, that order points at one position.
    """
    count = np.bincount(which)[which]
    # Use whole numbers, so that two equally near points are equal to the last bit.
    away = (position * count[:, None] - total[which]).astype(float)
    distance = np.sqrt(np.einsum("ij,ij->i", away, away)) / count
    least = np.minimum.reduceat(distance, run_starts(which))
    remaining = np.flatnonzero(distance <= (least + touch)[which])
    for values in _criteria(position, times, rows):
        if len(remaining) == len(total):
            break
        least = np.minimum.reduceat(values[remaining], run_starts(which[remaining]))
        remaining = remaining[values[remaining] == least[which[remaining]]]
    return remaining[run_starts(which[remaining])]


def _criteria(position: np.ndarray, times: tuple, rows: np.ndarray) -> Iterator[np.ndarray]:
    """Yield the numbers (m,) that decide between points equally near, the next ones only if some are still alike."""
    yield from position.T
    for dimension in times:
        if dimension is not None:
            yield np.nan_to_num(dimension[rows])


def _majority(classes: np.ndarray, which: np.ndarray) -> np.ndarray:
    """Return the most frequent class of each voxel, the lowest of those equally frequent."""
    firsts = run_starts(which)
    made = np.minimum.reduceat(classes, firsts).astype(np.uint8)
    among = (made != np.maximum.reduceat(classes, firsts))[which]
    pair, count = np.unique(which[among] * CODES + classes[among], return_counts=True)
    voxel, kind = np.divmod(pair, CODES)
    order = np.lexsort((kind, -count, voxel))
    first = order[run_starts(voxel[order])]
    made[voxel[first]] = kind[first]
    return made
