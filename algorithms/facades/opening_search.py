"""Openings in the plane of a facade: areas enclosed by the wall with points behind it."""

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..criteria import MAJORITY
from ..geometry.groups import components, least_of, mask_of, members
from ..geometry.polylines import simplify_ring
from ..packages import ndimage, spatial
from .approaches import BEFORE, FROM_WALL, Approach
from .facade_outline import edge_tolerance, grown
from .facade_surfaces import Facade, wall_thickness

# Side of a cell, in point spacings of the wall: few cells of a wall are empty.
_CELL_SPACINGS = 1.2

# Least side of a cell (m).
_LEAST_CELL = 0.02

# Gap (m) between points behind the wall that are of one opening: bars, curtains and panes leave gaps.
_LINK = 0.3

# Least value of half the gap ``_LINK``, in cells.
_LINK_CELLS = 1.5

# Distance (m) from the points behind the wall within which the edge of the wall is a side of their opening.
_REACH = 0.3

# Mean share of the four sides of an opening along which the wall has an edge. A surplus makes up for a lack of wall
# next to its outline, and the reverse: leaves and people past the end of a wall have little of both.
_EDGED = 0.33

# Share of the cells of an opening in which points behind the wall must be seen.
_SEEN = 0.1

# An opening higher than this (m) must have wall above it: the recessed part of a front has none.
_TALL = 4.0

# Panes side by side with no more than this between them (m), which end at one height within it, are one window: a pier
# of wall is wider than a mullion.
_MULLION = 0.15

# Pieces whose boxes overlap by this share of the smaller one are one opening, as a shop front has many pieces.
_SHARED = 0.3

# Area of the convex hull of an opening, as a share of its rectangle, from which it is that rectangle.
_RECTANGULAR = 0.75


@dataclass(frozen=True)
class Opening:
    """One window or door."""

    ring: np.ndarray  #: (m, 2): closed, counterclockwise, along and up the facade (m)
    kind: str  #: "window" or "door"
    depth: float  #: Median distance of its points behind the wall, m
    enclosed: float  #: Share of its outline that has wall next to it, 0 to 1
    seen: float  #: Share of its area with points, 0 to 1
    points: np.ndarray  #: (k,), int: indices of its points in the cloud

    @property
    def box(self) -> np.ndarray:
        """Least and greatest position (2, 2) along and up the facade (m)."""
        return np.array([self.ring.min(axis=0), self.ring.max(axis=0)])

    @property
    def size(self) -> np.ndarray:
        """Width and height (2,), m."""
        return self.box[1] - self.box[0]


class WallRaster:
    """Cells of a ``size`` (m) on a facade, and which hold positions (n, 2), m, of points of the wall and behind it."""

    def __init__(self, wall: np.ndarray, behind: np.ndarray, size: float) -> None:
        self.size, self.margin = size, int(np.ceil(_REACH / size)) + 2
        both = np.concatenate([wall, behind])
        self.low = both.min(axis=0) - self.margin * size
        self.shape = tuple(np.floor((both.max(axis=0) - self.low) / size).astype(np.int64) + self.margin + 1)
        self.behind = self.mask(behind)
        self.wall = self.mask(wall)
        self.behind &= ~self.wall
        # Fill cells of the wall that are empty by chance, but none with points behind the wall.
        self.wall |= ndimage.binary_closing(self.wall, np.ones((3, 3), bool)) & ~self.behind

    def cell(self, positions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the cells of positions (n, 2), along and up."""
        along, up = np.floor((positions - self.low) / self.size).astype(np.int64).T
        return along, up

    def mask(self, positions: np.ndarray) -> np.ndarray:
        """Return the mask of cells that hold positions (n, 2)."""
        return mask_of(self.shape, self.cell(positions))

    def groups(self) -> tuple[np.ndarray, int]:
        """Return the group from 1 of each cell with points behind the wall, 0 for others, and the number of groups.

        Cells are of one group if they are near each other with no wall between them.
        """
        reach = max(_LINK / 2, _LINK_CELLS * self.size)
        near = ndimage.distance_transform_edt(~self.behind) * self.size <= reach
        label, count = ndimage.label(near & ~self.wall, np.ones((3, 3), bool))
        return np.where(self.behind, label, 0), count


def find_openings(facade: Facade, xyz: np.ndarray, rows: np.ndarray, max_depth: float, min_size: float) -> list:
    """Return the openings of a facade, from its left to its right.

    Parameters
    ----------
    facade : Facade
        The wall.
    xyz : ndarray of shape (n, 3)
        The whole cloud (m).
    rows : ndarray of shape (k,)
        The points near the facade.
    max_depth : float
        How far behind the wall (m) points may be of its openings.
    min_size : float
        Least width and height (m).
    """
    local = facade.frame.local(xyz[rows])
    off_wall = wall_thickness(facade.rms)
    # Outward from the wall is positive.
    distance = local[:, 2]
    is_wall = np.abs(distance) <= off_wall
    is_behind = (distance < -off_wall) & (distance >= -max_depth)
    if not is_wall.any() or not is_behind.any():
        return []
    wall, behind, own = local[is_wall, :2], local[is_behind], rows[is_behind]
    raster = WallRaster(wall, behind[:, :2], max(_CELL_SPACINGS * facade.spacing, _LEAST_CELL))
    label, count = raster.groups()
    group = _joined(behind[:, :2], label[raster.cell(behind[:, :2])], count)
    approach = Approach(wall, local[(distance > max(FROM_WALL, off_wall)) & (distance <= BEFORE), :2])
    made = (_opening(facade, raster, behind[k], own[k], approach, min_size) for k in members(group).values())
    return sorted((one for one in made if one is not None), key=lambda opening: tuple(opening.box[0]))


def _joined(positions: np.ndarray, group: np.ndarray, count: int) -> np.ndarray:
    """Return groups (n,) from 1 of positions (n, 2), those joined that are parts of one opening; 0 stays 0."""
    boxes = np.full((count + 1, 2, 2), np.nan)
    for number, rows in members(group).items():
        boxes[number] = positions[rows].min(axis=0), positions[rows].max(axis=0)
    low, high = boxes[:, 0], boxes[:, 1]
    shared = np.minimum(high[:, None], high) - np.maximum(low[:, None], low)
    area = np.prod(high - low, axis=1)
    overlap = np.prod(np.maximum(shared, 0), axis=2) >= _SHARED * np.fmin(area[:, None], area)
    overlap &= (shared > 0).all(axis=2)
    level = (np.abs(low[:, None, 1] - low[:, 1]) <= _MULLION) & (np.abs(high[:, None, 1] - high[:, 1]) <= _MULLION)
    beside = level & (shared[..., 0] > -_MULLION) & (shared[..., 1] > 0)
    one, other = np.nonzero(overlap | beside)
    return np.where(group > 0, 1 + components(one, other, count + 1)[1][group], 0)


def _opening(
    facade: Facade, raster: WallRaster, behind: np.ndarray, points: np.ndarray, approach: Approach, min_size: float
) -> Optional[Opening]:
    """Return the opening that points behind a wall show, None if they show none."""
    # There are too few points, or they are too close together, even with the sides moved out to the edges of the wall.
    if len(behind) < 4 or (np.ptp(behind[:, :2], axis=0) < min_size / 2).any():
        return None
    spacing, box = facade.spacing, np.array([behind[:, :2].min(axis=0), behind[:, :2].max(axis=0)])
    box, beside = _bounded(box, approach.wall, raster.size, spacing)
    if (box[1] - box[0] < min_size).any():
        return None
    is_door = approach.leads_to(box, bool(beside[3] >= MAJORITY))
    ring, share = _shape(box, behind[:, :2], spacing)
    enclosed = _enclosure(raster, ring, box[0, 1] if is_door else None)
    cells = len(np.unique(np.column_stack(raster.cell(behind[:, :2])), axis=0)) * raster.size**2
    seen = min(1.0, cells / (share * float(np.prod(box[1] - box[0]))))
    is_tall = box[1, 1] - box[0, 1] > _TALL and beside[3] < MAJORITY
    # An opening has wall next to at least half of its outline, without the sill of a door.
    is_open = enclosed < MAJORITY or enclosed + beside.mean() < MAJORITY + _EDGED
    if is_open or seen < _SEEN or is_tall:
        return None
    depth = -float(np.median(behind[:, 2]))
    return Opening(ring, "door" if is_door else "window", depth, enclosed, seen, points)


def _bounded(box: np.ndarray, wall: np.ndarray, cell: float, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """Return a box with its sides moved to the edges of the wall, and the share (4,) of each side with wall next to it.

    The shares are of the left, right, lower and upper side. A side without a straight edge stays where it is.
    """
    bounded, shares = box.copy(), np.zeros(4)
    for axis, end in ((0, 0), (0, 1), (1, 0), (1, 1)):
        sign, other = (-1, 1)[end], 1 - axis
        # Positions outward of the side: the wall next to the opening is the first beyond its middle.
        outward = sign * (wall[:, axis] - box[end, axis])
        near = (outward > -np.ptp(box[:, axis]) / 2) & (outward <= _REACH)
        near &= (wall[:, other] >= box[0, other]) & (wall[:, other] <= box[1, other])
        lines = max(1, int(np.ceil((box[1, other] - box[0, other]) / cell)))
        line = np.minimum(((wall[near, other] - box[0, other]) / cell).astype(np.int64), lines - 1)
        nearest = least_of(outward[near], line, lines)
        has_wall = np.abs(nearest) <= _REACH
        shares[2 * axis + end] = has_wall.mean()
        if has_wall.any():
            edge = float(np.median(nearest[has_wall]))
            is_straight = np.abs(nearest - edge) <= edge_tolerance(spacing)
            # A slanting edge bounds the opening by its shape, not by its box.
            if is_straight.mean() >= MAJORITY:
                bounded[end, axis] = box[end, axis] + sign * (edge - spacing / 2)
    return bounded, shares


def _shape(box: np.ndarray, positions: np.ndarray, spacing: float) -> tuple[np.ndarray, float]:
    """Return the ring of an opening, its rectangle or its convex hull, and its share of the rectangle."""
    (west, low), (east, high) = box
    rectangle = np.array([[west, low], [east, low], [east, high], [west, high], [west, low]])
    inside = np.clip(positions, box[0], box[1])
    if (np.ptp(inside, axis=0) < 1e-6).any():
        return rectangle, 1.0
    hull = spatial.ConvexHull(inside, qhull_options="QJ")
    share = float(hull.volume) / float(np.prod(box[1] - box[0]))
    if share >= _RECTANGULAR:
        return rectangle, 1.0
    corners = inside[hull.vertices]
    # Points that a cloud holds twice may both be vertices, as the hull is of slightly moved points.
    corners = corners[(corners != np.roll(corners, 1, axis=0)).any(axis=1)]
    if len(corners) < 3:
        return rectangle, 1.0
    # The edge lies halfway between the outermost points behind and the wall.
    ring = grown(np.concatenate([corners, corners[:1]]), spacing / 2)
    ring = simplify_ring(ring, edge_tolerance(spacing / 2))
    return (ring, share) if len(ring) > 3 else (rectangle, 1.0)


def _enclosure(raster: WallRaster, ring: np.ndarray, sill: Optional[float]) -> float:
    """Return the share of a ring with wall within half the reach and a cell; a door's ``sill`` (m) does not count."""
    steps = np.diff(ring, axis=0)
    length = np.linalg.norm(steps, axis=1)
    counted = np.ones(len(steps), bool)
    if sill is not None:
        counted = np.maximum(ring[:-1, 1], ring[1:, 1]) > sill + raster.size
    pieces = np.maximum(np.ceil(length / raster.size), 1).astype(int)
    sides = zip(ring[:-1][counted], steps[counted], pieces[counted])
    positions = [start + (np.arange(n)[:, None] + 0.5) / n * step for start, step, n in sides]
    if not positions:
        return 0.0
    distance = ndimage.distance_transform_edt(~raster.wall) * raster.size
    along, up = (np.clip(cell, 0, size - 1) for cell, size in zip(raster.cell(np.concatenate(positions)), raster.shape))
    return float(np.mean(distance[along, up] <= _REACH / 2 + raster.size))
