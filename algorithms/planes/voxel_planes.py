"""Planes in voxels by sequential RANSAC, all voxels of a chunk at once."""

import numpy as np

from ..geometry.boxes import Boxes
from ..neighborhoods.covariance import smallest_eigenvectors, symmetric_eigenvalues
from ..neighborhoods.nearest_blocks import PAIRS
from ..stage import Monitor
from ..threads import PAIRS_AT_ONCE, in_chunks

# Fits to the points of a trial plane, each to those that lie on the fit before. With a third one, a facade of railings
# was invented on one of eleven simulated streets.
_REFINEMENTS = 2

# Of this many voxels with scattered points, one may have a plane by chance.
_VOXELS_PER_CHANCE = 1000


class VoxelPlanes:
    """Sequential RANSAC in the boxes of a cloud.

    Parameters
    ----------
    boxes : Boxes
        The voxels.
    side : float
        Side of a voxel, m.
    tolerance : float
        Distance within which a point lies on a plane, m.
    max_planes, trials : int
        Planes that are looked for in a voxel, and planes that are tried for each.
    seed : int
        Start of the random numbers.
    """

    def __init__(self, boxes: Boxes, side: float, tolerance: float, max_planes: int, trials: int, seed: int) -> None:
        self.boxes, self.tolerance = boxes, tolerance
        # Below 1, also where a tolerance is as wide as a voxel: see :func:`more_than_chance`.
        self.by_chance = min(0.99, 2 * tolerance / side)
        # The same shares for all voxels: the planes drawn in one depend on its own points only.
        self.shares = np.random.default_rng(seed).random((max_planes, trials, 3))

    def find(self, monitor: Monitor) -> np.ndarray:
        """Return the plane (n,), int16, of each point in the order of the boxes: from 1 in each voxel, or 0."""
        plane = np.zeros(len(self.boxes.order), np.int16)
        voxels = np.flatnonzero(self.boxes.size > 3)
        # Voxels with about as many points go together, so that hardly any position is left empty.
        voxels = voxels[np.argsort(self.boxes.size[voxels], kind="stable")]
        most = np.maximum(1, PAIRS_AT_ONCE // (self.boxes.size[voxels] * self.shares.shape[1]))
        chunks = _chunks(most)

        def work(numbers: np.ndarray) -> None:
            for number in numbers:
                self._search(voxels[chunks[number] : chunks[number + 1]], plane)

        in_chunks(work, np.arange(len(chunks) - 1), 1, monitor)
        return plane

    def _search(self, voxels: np.ndarray, plane: np.ndarray) -> None:
        """Find the planes of ``voxels`` one after the other and note them in ``plane``."""
        points, index, is_left = self._padded(voxels)
        open_ = np.arange(len(voxels))
        for number, shares in enumerate(self.shares, start=1):
            open_ = open_[is_left[open_].sum(axis=1) > 3]
            if not len(open_):
                return
            on_plane = self._refined(points[open_], is_left[open_], self._best(points[open_], is_left[open_], shares))
            is_plane = more_than_chance(on_plane.sum(axis=1), is_left[open_].sum(axis=1), self.by_chance, len(shares))
            open_, on_plane = open_[is_plane], on_plane[is_plane]
            plane[index[open_][on_plane]] = number
            is_left[open_] &= ~on_plane

    def _padded(self, voxels: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the points (v, k, 3) around each voxel's middle, their index, and which are no padding (v, k)."""
        boxes, size = self.boxes, self.boxes.size[voxels, None]
        position = np.arange(int(size.max()))
        is_point = position < size
        index = boxes.start[voxels, None] + np.minimum(position, size - 1)
        xyz = boxes.xyz[index]
        # Sort them by themselves, as the order of the cloud must not matter.
        order = np.lexsort([np.where(is_point, xyz[..., axis], np.inf) for axis in (2, 1, 0)], axis=-1)
        index, xyz = np.take_along_axis(index, order, axis=1), np.take_along_axis(xyz, order[..., None], axis=1)
        middle = (xyz.min(axis=1) + xyz.max(axis=1)) / 2
        return (xyz - middle[:, None]).astype(np.float32), index, is_point

    def _best(self, points: np.ndarray, is_left: np.ndarray, shares: np.ndarray) -> np.ndarray:
        """Return the mask of points (v, k) on the plane that holds most, of those through three of the points left."""
        left_first = np.argsort(~is_left, axis=1, kind="stable")
        rank = (shares * is_left.sum(axis=1)[:, None, None]).astype(np.int64)
        chosen = np.take_along_axis(left_first, rank.reshape(len(rank), -1), axis=1)
        a, b, c = np.moveaxis(np.take_along_axis(points, chosen[..., None], axis=1).reshape(*rank.shape, 3), 2, 0)
        normal = np.cross(b - a, c - a)
        length = np.linalg.norm(normal, axis=2, keepdims=True)
        # Three points in line make no plane: at an infinite distance it holds none.
        normal = np.divide(normal, length, out=np.zeros_like(normal), where=length > 0)
        level = np.where(length[..., 0] > 0, np.einsum("vti,vti->vt", a, normal), np.float32(np.inf))
        on_plane = np.abs(points @ normal.transpose(0, 2, 1) - level[:, None]) <= self.tolerance
        on_plane &= is_left[..., None]
        best = np.argmax(on_plane.sum(axis=1, dtype=np.int32), axis=1)
        return np.take_along_axis(on_plane, best[:, None, None], axis=2)[..., 0]

    def _refined(self, points: np.ndarray, is_left: np.ndarray, on_plane: np.ndarray) -> np.ndarray:
        """Return the points on the plane fitted to those ``on_plane`` (v, k), where they are no fewer."""
        for _ in range(_REFINEMENTS):
            weight = on_plane / np.maximum(on_plane.sum(axis=1, keepdims=True), 1)
            center = np.einsum("vk,vki->vi", weight, points)
            offset = points - center[:, None].astype(np.float32)
            covariance = np.stack([(weight * offset[..., a] * offset[..., b]).sum(axis=1) for a, b in PAIRS], axis=1)
            normal = smallest_eigenvectors(covariance, symmetric_eigenvalues(covariance))
            again = is_left & (np.abs(np.einsum("vki,vi->vk", offset, normal)) <= self.tolerance)
            better = again.sum(axis=1) >= on_plane.sum(axis=1)
            on_plane = np.where(better[:, None], again, on_plane)
        return on_plane


def more_than_chance(found, left, by_chance: float, trials: int) -> np.ndarray:
    """Return whether more points lie on the best of many planes than scattered points would have on one.

    Parameters
    ----------
    found, left : int or ndarray of shape (v,), int
        Points on the plane, and points that it was looked for among.
    by_chance : float
        Share of scattered points that lies within the tolerance of a plane, below 1.
    trials : int
        Planes that were tried.

    Notes
    -----
    The probability that this many come to lie within the tolerance is at most exp(-n KL(share, share by chance))
    (Hoeffding's bound). Three points of each plane always do, and many planes are tried. One of a
    thousand voxels may have such a plane by chance.
    """
    others = np.maximum(np.asarray(left) - 3, 1)
    share = (np.asarray(found) - 3) / others
    on, off = np.maximum(share, 1e-12), np.maximum(1 - share, 1e-12)
    divergence = share * np.log(on / by_chance) + (1 - share) * np.log(off / (1 - by_chance))
    return (share > by_chance) & (others * divergence >= np.log(trials * _VOXELS_PER_CHANCE))


def _chunks(most: np.ndarray) -> np.ndarray:
    """Return the starts of chunks and the end of the last, each as long as its last element of ``most`` (m,) allows."""
    starts = [0]
    while starts[-1] < len(most):
        start = starts[-1]
        end = min(start + int(most[start]), len(most))
        # Later voxels are larger.
        starts.append(start + max(1, min(end - start, int(most[end - 1]))))
    return np.array(starts)
