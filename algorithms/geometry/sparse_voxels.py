"""Voxels that are occupied, as a list: neighbors, components, morphology and distances without the grid around them.

A set of voxels is an array of cells: int64 (m, 3), columns, rows and layers, each voxel once, sorted by column, then
row, then layer. Memory follows the voxels, not the box around them. All other space is background, without an end.
"""

import itertools
import math

import numpy as np

from ..packages import spatial
from ..threads import n_threads
from .grid import find_cells
from .groups import components, placed, run_starts

# A coordinate within this distance (m) below the side of a voxel lies on it: above rounding, below the resolution of
# files.
TOUCH = 1e-7

# Keys of voxels are int64.
MOST_KEYS = np.iinfo(np.int64).max

# Neighbors that differ in at most this many of the three indices.
_AXES = {6: 1, 18: 2, 26: 3}


def voxel_index(scaled: np.ndarray, size: float) -> np.ndarray:
    """Return the index of the voxel along an axis, a whole float64, of coordinates divided by the voxel's ``size``."""
    return np.floor(scaled + TOUCH / size)


def refuse_fine(farthest: float, size: float) -> None:
    """Refuse voxels of a ``size`` (m) that float64 can't separate at the ``farthest`` coordinate (m).

    Raises
    ------
    ValueError
        If there are more than 2^46 along an axis.
    """
    if farthest / size > 2.0**46:
        raise ValueError(
            f"Voxels of {size:g} m are too fine for coordinates up to {farthest:g} m; "
            "take larger voxels or check the coordinates."
        )


def voxelize(xyz: np.ndarray, size: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Find the voxels that have points.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m). Voxels start at the origin of these coordinates.
    size : float
        Side of a voxel, m.

    Returns
    -------
    cells : ndarray of shape (m, 3), int64
        The occupied voxels, sorted.
    voxel : ndarray of shape (n,), int64
        The voxel of each point.
    count : ndarray of shape (m,), int64
        Points of each voxel.

    Raises
    ------
    ValueError
        If the voxels are too fine for the coordinates or for the extent.
    """
    refuse_fine(float(np.abs(xyz).max(initial=0.0)), size)
    index = np.column_stack([voxel_index(column / size, size).astype(np.int64) for column in xyz.T])
    key = Keys(index).of(index)
    order = np.argsort(key, kind="stable")
    starts = run_starts(key[order])
    count = np.diff(starts, append=len(order))
    return index[order[starts]], placed(np.repeat(np.arange(len(starts)), count), order, len(xyz)), count


def one_per_voxel(xyz: np.ndarray, size: float) -> np.ndarray:
    """Return the rows (m,), ascending, of the lowest point of each voxel of a ``size`` (m), in any order of points."""
    _, voxel, _ = voxelize(xyz, size)
    order = np.lexsort((xyz[:, 0], xyz[:, 1], xyz[:, 2], voxel))
    return np.sort(order[run_starts(voxel[order])])


def neighbor_offsets(connectivity: int) -> np.ndarray:
    """Return the steps to the neighbors, sorted int64 (6, 18 or 26, 3); step i is opposite to step -1 - i."""
    steps = np.array(list(itertools.product((-1, 0, 1), repeat=3)))
    n_axes = np.abs(steps).sum(axis=1)
    return steps[(n_axes > 0) & (n_axes <= _AXES[connectivity])]


class Keys:
    """One number for each cell of the box around some voxels, growing with column, row and layer.

    Parameters
    ----------
    cells : ndarray of shape (m, 3), int64
        Voxels.
    margin : int
        Cells around the box that have numbers too, so that steps of this length never wrap around.

    Raises
    ------
    ValueError
        If the box has more cells than there are numbers.
    """

    def __init__(self, cells: np.ndarray, margin: int = 1) -> None:
        low, high = (cells.min(axis=0), cells.max(axis=0)) if len(cells) else (np.zeros(3, np.int64),) * 2
        self.low = low - margin
        self.shape = high - low + 1 + 2 * margin
        if math.prod(self.shape.tolist()) > MOST_KEYS:
            spread = " by ".join(f"{extent:,}" for extent in (high - low + 1).tolist())
            raise ValueError(
                f"The points are spread over {spread} voxels, more than can be numbered; remove points that lie far "
                "off, or take larger voxels."
            )

    def of(self, cells: np.ndarray) -> np.ndarray:
        """Return the keys (m,), int64, of cells (m, 3) inside the box and its margin."""
        return self.step(cells - self.low)

    def step(self, offsets: np.ndarray) -> np.ndarray:
        """Return the change of the key for steps (k, 3)."""
        return (offsets[..., 0] * self.shape[1] + offsets[..., 1]) * self.shape[2] + offsets[..., 2]

    def cells(self, keys: np.ndarray) -> np.ndarray:
        """Return the cells (m, 3) of keys (m,)."""
        rest, layer = np.divmod(keys, self.shape[2])
        column, row = np.divmod(rest, self.shape[1])
        return np.column_stack([column, row, layer]) + self.low


def find_keys(keys: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Return the position of each ``wanted`` key (k,) among ascending ``keys`` (m,), int64; -1 if absent."""
    position, found = find_cells(keys, wanted)
    return np.where(found, position, -1)


def locate_voxels(cells: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Return the position of each ``wanted`` voxel (k, 3) among sorted ``cells`` (m, 3), int64 (k,); -1 if absent."""
    box = Keys(np.concatenate([cells, wanted]))
    return find_keys(box.of(cells), box.of(wanted))


def neighbor_pairs(cells: np.ndarray, connectivity: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return each pair of neighboring voxels once.

    Parameters
    ----------
    cells : ndarray of shape (m, 3), int64
        Voxels, sorted.
    connectivity : int
        Neighbors of a voxel: 6 share a face, 18 a face or an edge, 26 a face, an edge or a corner.

    Returns
    -------
    one, other : ndarray of shape (k,), int64
        The two voxels of each pair; ``one`` comes after ``other``.
    axes : ndarray of shape (k,), int8
        1, 2 or 3: they share a face, an edge or a corner, and are as many voxel sizes apart as its square root.
    """
    box = Keys(cells)
    keys = box.of(cells)
    pairs = []
    for offset in neighbor_offsets(connectivity)[: connectivity // 2]:
        other = find_keys(keys, keys + box.step(offset))
        one = np.flatnonzero(other >= 0)
        pairs.append((one, other[one], np.full(len(one), np.abs(offset).sum(), np.int8)))
    one, other, axes = (np.concatenate(column) for column in zip(*pairs))
    return one, other, axes


def label_components(cells: np.ndarray, connectivity: int) -> np.ndarray:
    """Return the connected component of each voxel (m,), int32, from 0 in the order of their first voxels."""
    one, other, _ = neighbor_pairs(cells, connectivity)
    return components(one, other, len(cells))[1]


def dilate(cells: np.ndarray, connectivity: int, steps: int = 1) -> np.ndarray:
    """Return the voxels (k, 3), sorted, and all that at most ``steps`` steps to neighbors lead to."""
    if not len(cells) or not steps:
        return cells
    box = Keys(cells, margin=steps)
    keys = box.of(cells)
    for _ in range(steps):
        for part in _structuring_parts(connectivity):
            keys = np.unique(np.concatenate([keys, *(keys + box.step(offset) for offset in part)]))
    return box.cells(keys)


def erode(cells: np.ndarray, connectivity: int, steps: int = 1) -> np.ndarray:
    """Return the voxels (k, 3), sorted, from which no background is within ``steps`` steps to neighbors."""
    box = Keys(cells)
    keys = box.of(cells)
    for _ in range(steps):
        for part in _structuring_parts(connectivity):
            inside = np.ones(len(keys), bool)
            for offset in part:
                inside &= find_keys(keys, keys + box.step(offset)) >= 0
            keys = keys[inside]
    return box.cells(keys)


def open_voxels(cells: np.ndarray, connectivity: int, steps: int = 1) -> np.ndarray:
    """Return the voxels (k, 3), sorted, after erosion and dilation: thin and small parts are removed."""
    return dilate(erode(cells, connectivity, steps), connectivity, steps)


def close_voxels(cells: np.ndarray, connectivity: int, steps: int = 1) -> np.ndarray:
    """Return the voxels (k, 3), sorted, after dilation and erosion: narrow gaps and holes are filled."""
    return erode(dilate(cells, connectivity, steps), connectivity, steps)


def distance_to_background(cells: np.ndarray) -> np.ndarray:
    """Return the distance (m,), float64, in voxels, from each voxel to the nearest one of the background.

    Parameters
    ----------
    cells : ndarray of shape (m, 3), int64
        Voxels, sorted.

    Notes
    -----
    Exact: from a background voxel that shares no face with an object voxel, a step toward any object voxel leads to
    background that is no farther from it. So only background that shares a face with an object voxel is searched.
    """
    if not len(cells):
        return np.zeros(0)
    box = Keys(cells)
    keys = box.of(cells)
    around = np.unique(np.concatenate([keys + box.step(offset) for offset in neighbor_offsets(6)]))
    shell = box.cells(around[find_keys(keys, around) < 0])
    return spatial.cKDTree(shell).query(cells, workers=n_threads())[0]


def _structuring_parts(connectivity: int) -> list[np.ndarray]:
    """Return steps whose dilations, one after the other, are that by all neighbors: the cube is one line per axis."""
    if connectivity != 26:
        return [neighbor_offsets(connectivity)]
    return [np.array([-axis, axis]) for axis in np.eye(3, dtype=np.int64)]
