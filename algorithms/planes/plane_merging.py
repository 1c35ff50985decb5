"""Join pieces of one plane in neighboring voxels."""

import itertools

import numpy as np

from ..criteria import MAJORITY
from ..geometry.boxes import Boxes, around
from ..geometry.groups import items
from ..geometry.tin import PLANE_POINTS
from ..stage import Monitor
from ..threads import ROWS_AT_ONCE, in_chunks
from .best_pairs import merge_best_pairs
from .least_squares_planes import Planes, planes_of

# Root mean square of a uniform distribution within a tolerance, as a share of it.
_EVEN = 1 / np.sqrt(3)

# A voxel joins its neighbors' planes if they explain this share of its points. In foliage, one plane of automatic
# tolerance explains a fifth by chance.
_HELD = 2 / 3


def joined_planes(
    boxes: Boxes, label: np.ndarray, tolerance: float, min_area: float, monitor: Monitor
) -> tuple[Planes, np.ndarray]:
    """Join the pieces of planes that were found voxel by voxel.

    Parameters
    ----------
    boxes : Boxes
        The voxels and their points.
    label : ndarray of shape (n,), int
        Plane of each point in the order of the boxes: from 1 in each voxel; 0 if unassigned.
    tolerance : float
        Distance within which a point lies on a plane, m.
    min_area : float
        Area of the smallest plane, m².
    monitor : Monitor
        Receives progress.

    Returns
    -------
    planes : Planes
        The planes that are large enough.
    plane : ndarray of shape (n,), int64
        The nearest of them to each point in the order of the boxes, from 0; -1 if none is within the tolerance.
    """
    on_plane = np.flatnonzero(label)
    box = boxes.box()
    key, piece = np.unique(box[on_plane] * (int(label.max()) + 1) + label[on_plane], return_inverse=True)
    voxel = key // (int(label.max()) + 1)
    pieces = planes_of(boxes.xyz[on_plane], piece, len(key))
    # Points of a scan line or an edge lie on many planes.
    wide = np.flatnonzero(pieces.eigenvalues[:, 1] > tolerance**2)
    pieces, voxel = pieces.chosen(wide), voxel[wide]
    group = join_pieces(pieces, voxel, boxes, tolerance, monitor.part(0, 0.6))
    planes = pieces.merged(group, int(group.max(initial=-1)) + 1)
    nearest = NearestPlanes(boxes, planes, tolerance)
    nearest.look(voxel, group, monitor.part(0.6, 0.8))
    # A plane across a ridge loses most of its points to the roofs on both sides.
    kept = np.bincount(nearest.plane[nearest.plane >= 0], minlength=len(planes)) / planes.count
    area = np.bincount(group, pieces.area, len(planes)) * np.minimum(kept, 1)
    # A plane across others keeps less when each point goes to its nearest plane.
    large = (area >= min_area) & (kept >= MAJORITY)
    is_large = large[group]
    group = (np.cumsum(large) - 1)[group[is_large]]
    planes = planes.chosen(large)
    nearest = NearestPlanes(boxes, planes, tolerance)
    return planes, grown_planes(nearest, voxel[is_large], group, monitor.part(0.8, 1))


def join_pieces(pieces: Planes, voxel: np.ndarray, boxes: Boxes, tolerance: float, monitor: Monitor) -> np.ndarray:
    """Group pieces of planes that continue each other.

    Parameters
    ----------
    pieces : Planes
        Planes (m,) of the points of a voxel.
    voxel : ndarray of shape (m,), int64
        Box of each piece, ascending.
    boxes : Boxes
        The voxels.
    tolerance : float
        Distance within which a point lies on a plane, m.
    monitor : Monitor
        Receives progress.

    Returns
    -------
    ndarray of shape (m,), int64
        Number of each piece's plane, from 0.

    Notes
    -----
    Of two neighbors the one with fewer points belongs to the other's plane if its points lie no farther off it, as
    root mean square, than points would that are spread evenly within the tolerance. Pairs that are the best of both
    are joined in rounds, and planes are fitted again: what does not fit at first may fit a better plane later.
    """

    def cost(planes: Planes, one: np.ndarray, other: np.ndarray) -> np.ndarray:
        is_larger = planes.count[one] > planes.count[other]
        off = planes.deviation(np.where(is_larger, other, one), np.where(is_larger, one, other))
        return np.where(off <= tolerance * _EVEN, off, np.inf)

    return merge_best_pairs(pieces, *_neighbors(voxel, boxes), cost, monitor)[1]


def _neighbors(voxel: np.ndarray, boxes: Boxes) -> tuple[np.ndarray, np.ndarray]:
    """Return all pairs of pieces in one voxel or in two that touch."""
    count = np.bincount(voxel, minlength=len(boxes))
    start = np.cumsum(count) - count
    every = np.arange(len(boxes))
    pairs = [_pairs(every, every, start, count)]
    pairs += [_pairs(*boxes.beside(boxes, offset), start, count) for offset in around(1) if offset > (0, 0, 0)]
    a, b = (np.concatenate(side) for side in zip(*pairs))
    return a[a != b], b[a != b]


def _pairs(here: np.ndarray, there: np.ndarray, start: np.ndarray, count: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return every piece of the voxels ``here`` with every piece of those ``there``."""
    which, position = items(count[here] * count[there])
    first, second = np.divmod(position, count[there][which])
    return start[here[which]] + first, start[there[which]] + second


class NearestPlanes:
    """The nearest plane to each point of boxes, of the planes that were looked for around it.

    Parameters
    ----------
    boxes : Boxes
        The voxels and their points.
    planes : Planes
        The planes.
    tolerance : float
        Distance within which a point lies on a plane, m.

    Attributes
    ----------
    box : ndarray of shape (n,), int64
        Box of each point, in the order of the boxes.
    plane : ndarray of shape (n,), int64
        Number of its plane; -1 if none is within the tolerance.
    """

    def __init__(self, boxes: Boxes, planes: Planes, tolerance: float) -> None:
        self.boxes, self.planes, self.box = boxes, planes, boxes.box()
        self.plane, self._distance = np.full(len(self.box), -1), np.full(len(self.box), tolerance)
        # Each box with itself and with every box that touches it, by the step between them.
        every = np.arange(len(boxes))
        self._around_each = [(every, every), *(boxes.beside(boxes, offset) for offset in around(1))]

    def look(self, voxel: np.ndarray, group: np.ndarray, monitor: Monitor) -> None:
        """Compare the points in the voxels (m,) of pieces, and around these, with their planes ``group`` (m,).

        Of planes as near it is the one with the largest number.
        """
        seen_from, plane = self._planes_around(voxel, group)
        count = np.bincount(seen_from, minlength=len(self.boxes))
        start = np.cumsum(count) - count
        box, nearest, distance = self.box, self.plane, self._distance

        def work(rows: np.ndarray) -> None:
            for rank in range(int(count[box[rows]].max())):
                some = rows[count[box[rows]] > rank]
                candidate = plane[start[box[some]] + rank]
                off = self.planes.distance(self.boxes.xyz[some], candidate)
                is_nearer = (off < distance[some]) | ((off == distance[some]) & (candidate > nearest[some]))
                distance[some[is_nearer]], nearest[some[is_nearer]] = off[is_nearer], candidate[is_nearer]

        in_chunks(work, np.flatnonzero(count[box]), ROWS_AT_ONCE, monitor)

    def _planes_around(self, voxel: np.ndarray, group: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return pairs of a box and a plane that has a piece in it or next to it, by box."""
        count, n_planes = np.bincount(voxel, minlength=len(self.boxes)), max(len(self.planes), 1)
        start = np.cumsum(count) - count
        keys = []
        for here, there in self._around_each:
            which, position = items(count[there])
            keys.append(here[which] * n_planes + group[start[there[which]] + position])
        return np.divmod(np.unique(np.concatenate(keys)), n_planes)


def grown_planes(nearest: NearestPlanes, voxel: np.ndarray, group: np.ndarray, monitor: Monitor) -> np.ndarray:
    """Return the plane (n,) nearest to each point, of planes that also grow into voxels where none was found.

    The tip of a hip and the strip along an eave have too few points in a voxel to show a plane of their own.

    Parameters
    ----------
    nearest : NearestPlanes
        The planes, which were looked for nowhere.
    voxel : ndarray of shape (m,), int64
        Box of each piece of a plane.
    group : ndarray of shape (m,), int64
        Its plane.
    monitor : Monitor
        Receives the progress.
    """
    boxes, box, n_planes = nearest.boxes, nearest.box, max(len(nearest.planes), 1)
    pieces = new = np.unique(voxel * n_planes + group)
    for step in itertools.count():
        part = monitor.part(1 - 0.8**step, 1 - 0.8 ** (step + 1))
        at, plane = np.divmod(new, n_planes)
        nearest.look(at, plane, part)
        on_plane = nearest.plane >= 0
        held = np.bincount(box[on_plane], minlength=len(boxes)) >= _HELD * boxes.size
        inside = on_plane & held[box]
        found, count = np.unique(box[inside] * n_planes + nearest.plane[inside], return_counts=True)
        # Any three points lie on a plane.
        grown = np.union1d(pieces, found[count > PLANE_POINTS])
        new = np.setdiff1d(grown, pieces, assume_unique=True)
        if not len(new):
            break
        pieces = grown
    return nearest.plane
