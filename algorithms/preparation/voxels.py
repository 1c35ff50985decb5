"""Points evened out: one for every voxel that has any."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Optional

import numpy as np

from ..stage import Param, stage
from ..threads import in_chunks

# Points worked on at once: what is gathered for them stays in the processor's cache.
_CHUNK = 50_000

# A coordinate this little (m) under the side of a voxel is on it: more than float64 rounds off, less than files tell.
_TOUCH = 1e-7

# Places inside a voxel are whole numbers of this fraction of its side, so that sums don't depend on the order.
_STEPS = 2.0**32

# With more voxels along an axis, float64 could not tell places inside a voxel.
_MOST_ALONG_AXIS = 2.0**46
_LARGEST_KEY = 2**63 - 1


@dataclass(frozen=True)
class _Sorted:
    """The points in the order of their voxels.

    Attributes
    ----------
    order : int64 array, (n,)
        Positions of the points, by voxel, then as in the file.
    starts : int64 array, (m + 1,)
        Where each voxel's points begin in ``order``, and the end of the last.
    """

    order: np.ndarray
    starts: np.ndarray

    def chunks(self) -> np.ndarray:
        """Return the first voxel of each chunk, and the number of voxels: chunks have whole voxels."""
        firsts = np.searchsorted(self.starts, np.arange(0, len(self.order), _CHUNK))
        return np.append(np.unique(firsts), len(self.starts) - 1)


@stage(
    "Downsample to voxels",
    group="Preparation",
    tags="thin,decimate,subsample,reduce,voxel grid,center of gravity,centroid,even density",
    writes=("xyz", "classification", "voxel_count"),
    selects=True,
)
def downsample_voxels(
    xyz,
    classification=None,
    gps_time=None,
    return_number=None,
    *,
    voxel_size: Annotated[
        float,
        Param(
            "Voxel size",
            "Side of the cubes that are left with one point each. Take more than the noise of the scanner and less "
            "than the smallest thing that is to be seen.",
            unit="m",
            low=0.001,
            high=1000,
        ),
    ] = 0.1,
    monitor=None,
):
    """Leave one point in every voxel that has any: the center of gravity of the points in it.

    Evens out the density of scans, where near and twice seen surfaces have many times the points of others, and makes
    clouds smaller. Everything but place, class and count comes from the point nearest to the center.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m).
    classification : ndarray of shape (n,), optional
        Classes. Noise counts like any other class; alone as it mostly is, it keeps voxels of its own.
    gps_time, return_number : ndarray of shape (n,), optional
        They choose between points at the same place, and for nothing else.

    Returns
    -------
    selected : ndarray of shape (m,), int64
        For each voxel, from west to east, then south to north, then upward, the point nearest to its center of
        gravity. Of points equally near (to 0.1 µm), the one farthest west, then south, then down is taken; of points
        at one place the earliest by time, then by number of return, then in the cloud.
    xyz : ndarray of shape (m, 3), float64
        Centers of gravity (m). A point that is alone in its voxel stays where it is.
    classification : ndarray of shape (m,), uint8
        The most frequent class of each voxel, the lowest of those that are equally frequent. None without classes.
    voxel_count : ndarray of shape (m,), uint32
        Points in each voxel.

    Raises
    ------
    ValueError
        If the voxels are finer than float64 can tell coordinates apart.

    Notes
    -----
    Voxels start at the origin of the coordinates, not at the first point, so that clouds of the same site get the same
    voxels. A point on the side between two voxels belongs to the eastern, northern or upper one; one that is less
    than 0.1 µm off counts as on the side, since decimals like 0.3 have no exact binary number. The result depends on
    neither the order of the points nor, but for this rounding, on where the cloud lies.

    References
    ----------
    Weinmann et al. (2017), Point cloud analysis for UAV-borne laser scanning with horizontally and vertically oriented
    line scanners, section 4.1. Hrutka et al. (2022), Voxel-based point cloud segmentation and building detection,
    section 2.2.

    Examples
    --------
    >>> import numpy as np
    >>> from lidar_buildings.algorithms.preparation.voxels import downsample_voxels
    >>> xyz = np.array([[0.01, 0.0, 0.0], [0.03, 0.0, 0.0], [0.08, 0.0, 0.0], [0.1, 0.0, 0.0]])
    >>> selected, center, _, count = downsample_voxels(xyz, voxel_size=0.1)
    >>> selected.tolist(), center[:, 0].round(6).tolist(), count.tolist()
    ([1, 3], [0.04, 0.1], [3, 1])
    """
    voxels = _by_voxel(xyz, voxel_size)
    monitor.progress(0.4)
    count = np.diff(voxels.starts)
    selected, center = np.empty(len(count), np.int64), np.empty((len(count), 3))
    majority = None if classification is None else np.empty(len(count), np.uint8)
    bounds, touch = voxels.chunks(), _TOUCH / voxel_size * _STEPS

    def work(chunk: np.ndarray) -> None:
        these = slice(bounds[chunk[0]], bounds[chunk[0] + 1])
        rows = voxels.order[voxels.starts[these.start] : voxels.starts[these.stop]]
        # The places inside each voxel, their mean, and the point nearest to it.
        place = _places(xyz.take(rows, axis=0), voxel_size)
        total = np.add.reduceat(place, voxels.starts[these] - voxels.starts[these.start], axis=0)
        which = np.repeat(np.arange(len(total)), count[these])
        nearest = _nearest(place, total, which, count[these], touch, (gps_time, return_number), rows)
        selected[these] = rows[nearest]
        shift = total / count[these, None] - place[nearest]
        center[these] = xyz[selected[these]] + shift * (voxel_size / _STEPS)
        if majority is not None:
            majority[these] = _majority(classification[rows], which, len(total))

    in_chunks(work, np.arange(len(bounds) - 1), 1, monitor.part(0.4, 1.0))
    monitor.resolved(share_left=len(count) / len(xyz))
    return selected, center, majority, count.astype(np.uint32)


def _by_voxel(xyz: np.ndarray, size: float) -> _Sorted:
    key = _keys(xyz, size)
    order = np.argsort(key, kind="stable")
    key = key[order]
    is_first = np.empty(len(key), bool)
    is_first[0] = True
    np.not_equal(key[1:], key[:-1], out=is_first[1:])
    return _Sorted(order, np.append(np.flatnonzero(is_first), len(key)))


def _keys(xyz: np.ndarray, size: float) -> np.ndarray:
    """Return a number for each point's voxel (n,), int64, that grows with x, then y, then z."""
    farthest = max(float(xyz.max()), -float(xyz.min()))
    if farthest / size > _MOST_ALONG_AXIS:
        raise ValueError(
            f"Voxels of {size:g} m are too fine for coordinates up to {farthest:g} m; "
            "take larger voxels or check the coordinates."
        )
    key, n_keys = np.zeros(len(xyz), np.int64), 1
    for axis in range(3):
        index = _index(xyz[:, axis] / size, size)
        index = (index - index.min()).astype(np.int64)
        n_index = int(index.max()) + 1
        # In wide clouds the voxels that no point is in can't all be numbered: only those with points then are.
        if n_keys * n_index > _LARGEST_KEY:
            key, n_keys = _renumbered(key)
        if n_keys * n_index > _LARGEST_KEY:
            index, n_index = _renumbered(index)
        key *= n_index
        key += index
        n_keys *= n_index
    return key


def _index(scaled: np.ndarray, size: float) -> np.ndarray:
    """Return the number of the voxel along an axis, a whole float64, of coordinates in voxels."""
    return np.floor(scaled + _TOUCH / size)


def _renumbered(key: np.ndarray) -> tuple[np.ndarray, int]:
    """Return numbers in the same order without gaps, and how many there are."""
    used, key = np.unique(key, return_inverse=True)
    return key, len(used)


def _places(points: np.ndarray, size: float) -> np.ndarray:
    """Return where points lie in their voxels, int64 (m, 3), in steps."""
    scaled = points / size
    scaled -= _index(scaled, size)
    scaled *= _STEPS
    return np.rint(scaled).astype(np.int64)


def _nearest(
    place: np.ndarray,
    total: np.ndarray,
    which: np.ndarray,
    count: np.ndarray,
    touch: float,
    times: tuple[Optional[np.ndarray], ...],
    rows: np.ndarray,
) -> np.ndarray:
    """Return, for each voxel, the position of the point nearest to the center.

    Parameters
    ----------
    place : ndarray of shape (m, 3), int64
        Of the points, by voxel.
    total : ndarray of shape (k, 3), int64
        Sum of the places of each voxel.
    which, count : ndarray of shape (m,) and (k,)
        Voxel of each point, points of each voxel.
    touch : float
        Points that are so much (steps) farther away than the nearest are as near: only rounding tells them apart.
    times : tuple
        Further dimensions (n,) of the cloud, or None, by which points at one place are told apart.
    rows : ndarray of shape (m,)
        Where in the cloud the points are.
    """
    away = (place * count[which, None] - total[which]).astype(float)
    distance = np.sqrt(np.einsum("ij,ij->i", away, away)) / count[which]
    least = np.minimum.reduceat(distance, _firsts(which))
    left = np.flatnonzero(distance <= (least + touch)[which])
    for values in _criteria(place, times, rows):
        if len(left) == len(total):
            break
        least = np.minimum.reduceat(values[left], _firsts(which[left]))
        left = left[values[left] == least[which[left]]]
    return left[_firsts(which[left])]


def _criteria(place: np.ndarray, times: tuple, rows: np.ndarray) -> Iterator[np.ndarray]:
    """Yield the numbers (m,) that decide between points equally near, the next ones only if some are still alike."""
    yield from place.T
    for dimension in times:
        if dimension is not None:
            yield np.nan_to_num(dimension[rows])


def _firsts(which: np.ndarray) -> np.ndarray:
    """Return where in ``which`` (m,), which is sorted, each number comes first."""
    return np.flatnonzero(np.diff(which, prepend=-1))


def _majority(classes: np.ndarray, which: np.ndarray, n_voxels: int) -> np.ndarray:
    """Return the most frequent class of each voxel, the lowest of those equally frequent."""
    firsts = _firsts(which)
    made = np.minimum.reduceat(classes, firsts).astype(np.uint8)
    is_mixed = made != np.maximum.reduceat(classes, firsts)
    among = is_mixed[which]
    pair, count = np.unique(which[among] * 256 + classes[among], return_counts=True)
    voxel, kind = np.divmod(pair, 256)
    order = np.lexsort((kind, -count, voxel))
    first = order[_firsts(voxel[order])]
    made[voxel[first]] = kind[first]
    return made
