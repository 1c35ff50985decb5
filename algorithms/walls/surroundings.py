"""The surroundings of a roof and of its holes: other roofs, and visible ground."""

from functools import cached_property

import numpy as np

from ..criteria import MAJORITY
from ..footprints.footprint_attributes import EAVE
from ..geometry.grid import Grid, distinct, find_cells, grid_over, refuse_sparse
from ..geometry.groups import mask_of, run_starts
from ..geometry.polygon_overlap import are_within
from ..geometry.rings import along_sides, sides_of_rings, signed_area
from ..packages import ndimage
from ..sampling.cloud_sampling import CloudSampling

# Least side (m) of the cells in which roofs and their surroundings are looked up.
CELL = 0.25

# Largest distance (m) in plan of a wall from its roof, if part of the roof was not seen; other walls lie under it.
NEAR = 2.0

# Least side of these cells in point spacings: then less than one cell of a surface in two hundred is empty by chance.
_CELL_SPACINGS = 2.5

# Widest notch (m) at the edge of a roof that is filled if it has no points: image matching fails on some roofs, and
# then finds nothing below either. Gaps inside a roof are filled at any width.
_BITE = 4.0

# Empty cells count as a notch only if at least this share of the neighboring cells has points; otherwise nothing there
# was scanned.
_SEEN_BESIDE = 0.8

# A gap is a courtyard if at least this share of its cells has points below the eaves.
_SEEN = 0.3

# Least distance (m) below the eaves of points that show a courtyard.
_BELOW = 1.0

# Largest distance between points put into gaps (spacings of the roof's points).
_FILLED = 2.0

# Distance (m) outward from a side within which the other roof is searched for: gaps between party walls are narrower.
_OUTWARD = 1.0


class Surroundings:
    """Roofs and lowest points of a cloud (n, 3), m, in small cells; ``cluster_id`` (n,) numbers roofs from 1."""

    def __init__(self, xyz: np.ndarray, cluster_id: np.ndarray, sampling: CloudSampling) -> None:
        self.xyz, self._cluster_id, self._sampling = xyz, cluster_id, sampling

    @cached_property
    def grid(self) -> Grid:
        """The cells."""
        return grid_over(self.xyz, max(CELL, _CELL_SPACINGS * self._sampling.spacing))

    @cached_property
    def _table(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Numbers of the cells with points, ascending, the lowest elevation in each (m), and a roof in it, or 0."""
        cells, which = distinct(self.grid.number(self.xyz))
        order = np.argsort(which, kind="stable")
        starts = run_starts(which[order])
        # Of two roofs in a cell either one is next to a third.
        roof = np.maximum(np.maximum.reduceat(self._cluster_id[order], starts), 0)
        return cells, np.minimum.reduceat(self.xyz[order, 2], starts), roof.astype(np.int64)

    def _at(self, xy: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the lowest elevation (n,), m, in the cells of positions (n, 2), NaN where empty, and a roof, or 0."""
        (west, south), size = self.grid.origin, self.grid.size
        east, north = west + self.grid.columns * size, south + self.grid.rows * size
        inside = (xy >= (west, south)).all(axis=1) & (xy < (east, north)).all(axis=1)
        cells, lowest, roof = self._table
        position, found = find_cells(cells, self.grid.number(xy))
        found &= inside
        return np.where(found, lowest[position], np.nan), np.where(found, roof[position], 0)

    def gaps(self, roof: np.ndarray, spacing: float) -> np.ndarray:
        """Return positions (k, 2), m, that fill the gaps and bites of a roof (n, 3) of a point spacing (m)."""
        if self.grid.size > _BITE / 2:
            return np.zeros((0, 2))
        refuse_sparse(roof, self.grid.size)
        room = int(np.ceil(_BITE / self.grid.size)) + 1
        cell = np.floor((roof[:, :2] - self.grid.origin) / self.grid.size).astype(np.int64)
        low = cell.min(axis=0) - room
        column, row = (cell - low).T
        is_roof = mask_of((row.max() + room + 1, column.max() + room + 1), (row, column))
        rows, columns = np.indices(is_roof.shape).reshape(2, -1)
        centers = (np.column_stack([columns, rows]) + low + 0.5) * self.grid.size + self.grid.origin
        lowest = self._at(centers)[0].reshape(is_roof.shape)
        is_seen, is_low = np.isfinite(lowest), lowest < np.percentile(roof[:, 2], EAVE) - _BELOW
        filled, radius = ndimage.binary_fill_holes(is_roof), _BITE / 2 / self.grid.size
        beside = ndimage.distance_transform_edt(~filled)
        if is_seen[(beside > radius) & (beside <= 2 * radius)].mean() < _SEEN_BESIDE:
            return np.zeros((0, 2))
        is_gap = _closed(is_roof, radius) & ~is_seen
        holes, count = ndimage.label(ndimage.binary_fill_holes(is_roof | is_gap) & ~is_roof)
        share = ndimage.mean(is_low, holes, np.arange(1, count + 1)) if count else np.zeros(0)
        is_gap |= np.append(False, np.asarray(share) < _SEEN)[holes]
        return _spread(centers[is_gap.ravel()], self.grid.size, _FILLED * spacing)

    def is_party(self, sides: np.ndarray, number: int) -> np.ndarray:
        """Return the mask of the sides (k, 2, 2) of roof ``number``, to their left, next to which other roofs begin."""
        along, side, outward = along_sides(sides, CELL)
        is_beside = np.zeros(len(side), bool)
        for distance in np.arange(CELL, _OUTWARD + CELL, CELL):
            roof = self._at(along + distance * outward)[1]
            is_beside |= (roof > 0) & (roof != number)
        count = np.bincount(side, minlength=len(sides))
        # A side is a party wall if another roof begins next to at least half of it.
        return np.bincount(side, is_beside, len(sides)) >= MAJORITY * np.maximum(count, 1)


def _closed(mask: np.ndarray, radius: float) -> np.ndarray:
    """Close a mask of cells by a disk of a radius (cells)."""
    near = ndimage.distance_transform_edt(~mask) <= radius
    return ndimage.distance_transform_edt(np.pad(near, 1))[1:-1, 1:-1] > radius


def _spread(centers: np.ndarray, size: float, step: float) -> np.ndarray:
    """Return positions (k, 2) (m) in cells around ``centers``, at most ``step`` (m) apart."""
    count = int(np.ceil(size / step))
    inner = (np.arange(count) + 0.5) / count * size - size / 2
    offsets = np.stack(np.meshgrid(inner, inner), axis=-1).reshape(-1, 2)
    return (centers[:, None] + offsets).reshape(-1, 2)


def without_nested(parts: list) -> list:
    """Return the parts of a roof, each a list of rings, without those that lie in larger ones next to their holes."""
    kept: list = []
    for rings in sorted(parts, key=lambda rings: -signed_area(rings[0])):
        if not any(are_within(rings[0][:1], sides_of_rings(other))[0] for other in kept):
            kept.append(rings)
    return kept
