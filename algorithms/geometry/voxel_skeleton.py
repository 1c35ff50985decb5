"""Skeletons of sparse voxels: thinning to lines one voxel wide that keeps components, tunnels and cavities."""

import numpy as np

from ..stage import Monitor
from ..threads import ROWS_AT_ONCE
from .sparse_voxels import Keys, find_keys, neighbor_offsets

# The 26 neighbors of a voxel are the bits of a number, in the order of these steps.
_STEPS = neighbor_offsets(26)
_BIT = np.uint32(1) << np.arange(26, dtype=np.uint32)
_ALL = np.uint32(2**26 - 1)

# Bits of the neighbors that share a face with the voxel, and of those that share a face or an edge.
_N_AXES = np.abs(_STEPS).sum(axis=1)
_FACE_BITS = np.bitwise_or.reduce(_BIT[_N_AXES == 1])
_EDGE_BITS = np.bitwise_or.reduce(_BIT[_N_AXES <= 2])

# Sides from which voxels are removed in turn: top, bottom, north, south, east, west. Opposite sides follow each other,
# so that the skeleton stays in the middle.
_POSITIVE_SIDES = [int(np.flatnonzero((side == _STEPS).all(axis=1))[0]) for side in np.eye(3, dtype=int)[::-1]]
_SIDES = [bit for side in _POSITIVE_SIDES for bit in (side, 25 - side)]


def _adjacency(connectivity: int, among: np.ndarray) -> list[np.uint32]:
    """Return for each of the 26 neighbors which of the others ``among`` (bits) are its own neighbors."""
    steps = {tuple(step) for step in neighbor_offsets(connectivity).tolist()}
    rows = [[tuple(a - b) in steps for b in _STEPS] for a in _STEPS]
    return [np.bitwise_or.reduce(_BIT[row], initial=np.uint32(0)) & among for row in np.array(rows)]


# Neighbors of the neighbors of a voxel: of the object, and of the background.
_TOUCHING = _adjacency(26, _ALL)
_SHARING_FACES = _adjacency(6, _EDGE_BITS)


def skeleton(cells: np.ndarray, monitor: Monitor) -> np.ndarray:
    """Thin voxels to their curve skeleton.

    Parameters
    ----------
    cells : ndarray of shape (m, 3), int64
        Voxels, sorted (see :mod:`.sparse_voxels`).
    monitor : Monitor
        Receives progress.

    Returns
    -------
    ndarray of shape (m,), bool
        Which voxels are the skeleton.

    Notes
    -----
    Directional thinning removes voxels that face the background on one side, from the six sides in turn until nothing
    changes. They must be simple (their removal changes no component, tunnel or cavity: Malandain & Bertrand 1992) and
    no end of a line (exactly one neighbor). Within a side, the voxels of each of the eight parities of column, row and
    layer are removed together. No two of these are neighbors: the result is as if they were removed one by one, and the
    topology is kept exactly. Objects have 26, the background 6 neighbors.

    Palágyi & Kuba remove voxels by templates in eight sub-iterations; the result there is as thin, but other
    voxels of the same middle may be kept.

    References
    ----------
    Palágyi, K., Kuba, A., 1999. Directional 3D thinning using 8 subiterations. LNCS 1568, 325-336. [palagyi1999]
    Malandain, G., Bertrand, G., 1992. Fast characterization of 3D simple points. ICPR, 232-235. [malandain1992]
    """
    return _Thinning(cells).run(monitor)


class _Thinning:
    """The state of a thinning: which voxels are kept, and which neighbors of each are.

    Attributes
    ----------
    keys : ndarray of shape (m,), int64
        Numbers of the voxels, ascending.
    parity : ndarray of shape (m,), int64
        Which of column, row and layer are odd, as bits.
    kept : ndarray of shape (m,), bool
        Voxels that were not removed.
    around : ndarray of shape (m,), uint32
        Bits of the neighbors that are kept.
    changed : ndarray of shape (m,), int32
        Step of work at which ``around`` last changed. A voxel that could not be removed from a side is examined again
        only after a change.
    """

    def __init__(self, cells: np.ndarray) -> None:
        self.box = Keys(cells)
        self.keys = self.box.of(cells)
        self.parity = (cells & 1) @ np.array([1, 2, 4])
        self.kept = np.ones(len(cells), bool)
        self.around = np.zeros(len(cells), np.uint32)
        for bit, step in enumerate(_STEPS[:13]):
            other = find_keys(self.keys, self.keys + self.box.step(step))
            one = np.flatnonzero(other >= 0)
            self.around[one] |= _BIT[bit]
            self.around[other[one]] |= _BIT[25 - bit]
        self.changed = np.zeros(len(cells), np.int32)

    def run(self, monitor: Monitor) -> np.ndarray:
        """Remove voxels until nothing changes; return the mask (m,) of kept ones."""
        step, n_removed = 0, 1
        while n_removed:
            n_removed = 0
            for side in _SIDES:
                n_removed += self._peel(side, step)
                step += 1
            # How many rounds there will be is known at the end only: the first ones remove most.
            monitor.progress(1 - 0.8 ** (step / len(_SIDES)))
        monitor.progress(1.0)
        return self.kept

    def _peel(self, side: int, step: int) -> int:
        """Remove what can be removed from one side, and return how many voxels that are."""
        is_open = self.kept & (self.around & _BIT[side] == 0) & (self.changed >= step - len(_SIDES))
        rows = np.flatnonzero(is_open)
        # Decide on all voxels of the side before any is removed; newly exposed ones wait for the next round.
        rows = rows[_removable(self.around[rows])]
        removed = 0
        for parity in range(8):
            these = rows[self.parity[rows] == parity]
            these = these[_removable(self.around[these])]
            self._remove(these, step)
            removed += len(these)
        return removed

    def _remove(self, rows: np.ndarray, step: int) -> None:
        self.kept[rows] = False
        for bit, offset in enumerate(_STEPS):
            has = rows[self.around[rows] & _BIT[bit] != 0]
            other = find_keys(self.keys, self.keys[has] + self.box.step(offset))
            self.around[other] &= ~_BIT[25 - bit]
            self.changed[other] = step


def _removable(around: np.ndarray) -> np.ndarray:
    """Return the mask of voxels (m,) with these neighbors (bits) that are simple and no ends of lines."""
    removable = np.zeros(len(around), bool)
    for start in range(0, len(around), ROWS_AT_ONCE):
        part = slice(start, start + ROWS_AT_ONCE)
        is_end = around[part] & (around[part] - np.uint32(1)) == 0
        rows = np.flatnonzero(~is_end)
        removable[start + rows] = is_simple(around[part][rows])
    return removable


def is_simple(around: np.ndarray) -> np.ndarray:
    """Return the mask of voxels (m,) that can be removed without a change of topology.

    Parameters
    ----------
    around : ndarray of shape (m,), uint32
        Which of the 26 neighbors belong to the object: bit i is of step i of ``neighbor_offsets(26)``.

    Notes
    -----
    A voxel is simple if its neighbors of the object are one component (26). Also, its neighbors of the background that
    share a face or an edge with it hold exactly one component (6) that shares a face with it.
    """
    background = ~around & _EDGE_BITS
    faces = background & _FACE_BITS
    is_one = (around != 0) & (faces != 0)
    simple = np.zeros(len(around), bool)
    rows = np.flatnonzero(is_one)
    rows = rows[_flood(faces[rows], background[rows], _SHARING_FACES) & faces[rows] == faces[rows]]
    simple[rows] = _flood(around[rows], around[rows], _TOUCHING) == around[rows]
    return simple


def _flood(start: np.ndarray, among: np.ndarray, adjacency: list) -> np.ndarray:
    """Return the component (bits) of the lowest bit of ``start`` among the bits of ``among``."""
    component = start & (~start + np.uint32(1))
    growing = np.arange(len(start))
    while len(growing):
        before = component[growing]
        reached = before.copy()
        for bit, adjacent in enumerate(adjacency):
            if adjacent:
                reached |= np.where(reached & _BIT[bit] != 0, adjacent, np.uint32(0)) & among[growing]
        component[growing] = reached
        growing = growing[reached != before]
    return component
