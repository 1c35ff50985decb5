"""Match two classifications of the same points."""

import numpy as np

from ..criteria import MILLIMETER
from ..geometry.groups import mask_of, placed
from ..packages import spatial


def counted_points(
    xyz: np.ndarray, classification: np.ndarray, true: np.ndarray, ignored: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return coordinates, classes and true classes of the points whose ``true`` class (n,) is not ``ignored``.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Points, m.
    classification : ndarray of shape (n,)
        Their classes.
    true : ndarray of shape (n,)
        Their true classes.
    ignored : ndarray of shape (k,)
        True classes of points that are not counted.

    Raises
    ------
    ValueError
        If none is left to compare.
    """
    used = ~np.isin(true, ignored)
    if not used.any():
        classes = ", ".join(str(number) for number in np.unique(true))
        raise ValueError(
            f"All {len(xyz)} points have an ignored class in the reference ({classes}); ignore fewer classes."
        )
    return xyz[used], classification[used], true[used]


def match_points(xyz: np.ndarray, reference_xyz: np.ndarray) -> np.ndarray:
    """Return the row of each point in the reference, which may hold the points in another order.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m).
    reference_xyz : ndarray of shape (m, 3)
        Coordinates (m) of the reference; points that are nowhere in ``xyz`` are allowed.

    Returns
    -------
    ndarray of shape (n,), int64
        ``reference_xyz[result]`` is ``xyz`` within 2 mm; no row is used twice. Of several points
        at one position the first goes with the first, the second with the second.

    Raises
    ------
    ValueError
        If a point is not in the reference.
    """
    if xyz.shape == reference_xyz.shape and (np.abs(xyz - reference_xyz) <= MILLIMETER).all():
        return np.arange(len(xyz))
    found = _match_rounded(xyz, reference_xyz)
    _match_nearest(xyz, reference_xyz, found)
    missing = np.flatnonzero(found < 0)
    if len(missing):
        x, y, z = xyz[missing[0]]
        raise ValueError(
            f"{len(missing)} of {len(xyz)} points are not in the reference, the first at {x:.3f}, {y:.3f}, {z:.3f}; "
            "compare two classifications of the same points, in whatever order."
        )
    return found


def _match_rounded(xyz: np.ndarray, reference_xyz: np.ndarray) -> np.ndarray:
    """Return the reference row whose rounded coordinates are a point's, -1 if unassigned."""
    n = len(xyz)
    both = np.concatenate([xyz, reference_xyz])
    keys = np.rint((both - both.min(axis=0)) / MILLIMETER).astype(np.int64)
    # Stable: within a position the points of the input come first, each cloud in its own order.
    order = np.lexsort(keys.T)
    starts = np.flatnonzero((np.diff(keys[order], axis=0, prepend=-1) != 0).any(axis=1))
    group = np.repeat(np.arange(len(starts)), np.diff(starts, append=len(both)))
    of_input = order < n
    mine, group_of_mine = order[of_input], group[of_input]
    theirs, group_of_theirs = order[~of_input] - n, group[~of_input]
    # The k-th point at a position goes with the k-th reference point there, if there is one.
    rank = np.arange(n) - np.searchsorted(group_of_mine, group_of_mine)
    position = np.searchsorted(group_of_theirs, group_of_mine) + rank
    there = position < np.searchsorted(group_of_theirs, group_of_mine, side="right")
    return placed(theirs[position[there]], mine[there], n, -1)


def _match_nearest(xyz: np.ndarray, reference_xyz: np.ndarray, found: np.ndarray) -> None:
    """Match in place the points that rounding has put on either side of a border."""
    left = np.flatnonzero(found < 0)
    free = np.flatnonzero(~mask_of(len(reference_xyz), found[found >= 0]))
    if not len(left) or not len(free):
        return
    distance, nearest = spatial.cKDTree(reference_xyz[free]).query(xyz[left], distance_upper_bound=2 * MILLIMETER)
    near = np.flatnonzero(np.isfinite(distance))
    _, first = np.unique(nearest[near], return_index=True)
    found[left[near[first]]] = free[nearest[near[first]]]
