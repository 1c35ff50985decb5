"""Facades of segments: least-squares plane, side that was seen, and boundary of each."""

from dataclasses import dataclass, field

import numpy as np

from ..criteria import DEVIATIONS
from ..geometry.grid import shared_cells
from ..geometry.groups import members
from ..geometry.sparse_voxels import voxelize
from ..packages import spatial
from ..planes.least_squares_planes import Planes, planes_of
from ..stage import LayerFeatures, Monitor
from .facade_frame import Frame, frame_of, intersection_line
from .facade_outline import Drawing, outline_of, ring_area

# Points nearer to a facade's plane than this (m) are of the wall and its relief.
_LEAST_THICKNESS = 0.03

# Side (m) of the cells in which street scans are examined, in plan and on facades: some spacings of a sparse scan. Two
# facades meet where they share a cell.
CELL = 0.5

# Side (m) of the voxels whose points count as one around a facade: a cell holds a few of them.
_THINNED = 0.1

# Points farther from the plane than this (m) say nothing about the side from which a facade was seen.
FARTHEST = 10.0

# Panes, frames, curtains and reveals lie within this distance (m) behind a wall; cars and trees are farther before it.
_DEPTH = 0.5

# The ends of a facade wider than this (cells) are left out of the comparison.
_LEAST_COLUMNS = 3

# Which side of a corner a facade lies on follows from its points within this distance (m) of the corner.
_AT_CORNER = 1.5

# Facades that enclose less than this angle (rad) are strips of one front, and face the same side; others meet at a
# corner.
ONE_FRONT = np.radians(40.0)


@dataclass(frozen=True)
class Facade:
    """A facade: a plane with a boundary."""

    number: int  #: Segment that it was made of
    frame: Frame  #: Its plane
    ring: np.ndarray  #: (m, 2): boundary along and up the plane, closed and counterclockwise seen from outside (m)
    points: np.ndarray  #: (k,): its points in the cloud
    rms: float  #: Root mean square distance of these from the plane, m
    spacing: float  #: Distance between these where they are farthest apart, m
    hull_area: float  #: Area of their convex hull, m²
    seen_area: float  #: Area of the triangles between them, m²
    neighbors: int = 0  #: Facades with which it shares a border
    holes: list = field(default_factory=list)  #: list of (m, 2): openings, clockwise

    @property
    def area(self) -> float:
        """Area within the boundary, openings left out, m²."""
        return ring_area(self.ring) - sum(ring_area(hole) for hole in self.holes)

    @property
    def height(self) -> float:
        """Height of the boundary, m."""
        return float(np.ptp(self.frame.space(self.ring)[:, 2]))

    @property
    def rings(self) -> list[np.ndarray]:
        """Rings (m, 3) of the polygon: boundary, then openings."""
        return [self.frame.space(ring) for ring in (self.ring, *self.holes)]


def surfaces_of(xyz: np.ndarray, segment_id: np.ndarray, drawing: Drawing, monitor: Monitor) -> list[Facade]:
    """Return the facades of segments whose planes are steep and have an area, in the order of their numbers.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates of the whole cloud (m).
    segment_id : ndarray of shape (n,)
        Planes from 1; 0 if unassigned.
    drawing : Drawing
        How they are drawn.
    monitor : Monitor
        Receives progress.
    """
    groups = members(segment_id)
    monitor.progress(0.0)
    if not groups:
        return []
    planes = {number: plane_of(xyz[points]) for number, points in groups.items()}
    steep = [n for n, (frame, _) in planes.items() if len(groups[n]) >= 4 and abs(frame.tilt) <= drawing.max_tilt]
    thickness = np.array([wall_thickness(planes[n][1]) for n in steep])
    rows = [groups[n] for n in steep]
    frames = facing_outside([planes[n][0] for n in steep], xyz, rows, thickness, monitor.part(0, 0.3))
    facades = []
    for done, (number, frame) in enumerate(zip(steep, frames), start=1):
        outline = outline_of(frame.local(xyz[groups[number]])[:, :2], drawing)
        if outline is not None:
            found = outline.ring, groups[number], planes[number][1], outline.spacing
            facades.append(Facade(number, frame, *found, outline.hull_area, outline.seen_area))
        monitor.progress(0.3 + 0.7 * done / len(steep))
    return facades


def wall_thickness(rms: float) -> float:
    """Return the distance (m) from a facade's plane within which points are its own, by their deviation (m)."""
    return max(DEVIATIONS * rms, _LEAST_THICKNESS)


def plane_of(xyz: np.ndarray) -> tuple[Frame, float]:
    """Return the plane of least squares through points (n, 3), and their root mean square distance from it (m).

    A plane that is level gets a normal that is slightly inclined, so that it has a direction along it.
    """
    start = xyz[0]
    planes: Planes = planes_of(xyz - start, np.zeros(len(xyz), np.int64), 1)
    normal = planes.normal[0]
    if not np.isfinite(normal).all() or np.hypot(normal[0], normal[1]) < 1e-9:
        normal = np.array([1e-9, 0.0, 1.0])
    return frame_of(planes.center[0] + start, normal), float(np.sqrt(max(planes.eigenvalues[0, 2], 0.0)))


def facade_features(facades: list[Facade]) -> LayerFeatures:
    """Return facades as features of the layer that :data:`.extract_facades.FACADES` describes."""
    columns: dict[str, list] = {
        "id": [facade.number for facade in facades],
        "area": [facade.area for facade in facades],
        "height": [facade.height for facade in facades],
        "base": [float(facade.rings[0][:, 2].min()) for facade in facades],
        "azimuth": [facade.frame.azimuth for facade in facades],
        "tilt": [facade.frame.tilt for facade in facades],
        "normal_x": [float(facade.frame.normal[0]) for facade in facades],
        "normal_y": [float(facade.frame.normal[1]) for facade in facades],
        "normal_z": [float(facade.frame.normal[2]) for facade in facades],
        "rms": [facade.rms for facade in facades],
        "points": [len(facade.points) for facade in facades],
        "density": [len(facade.points) / facade.area for facade in facades],
        "hull_share": [ring_area(facade.ring) / max(facade.hull_area, 1e-9) for facade in facades],
        "seen_share": [min(facade.seen_area / ring_area(facade.ring), 1.0) for facade in facades],
        "neighbors": [facade.neighbors for facade in facades],
    }
    return LayerFeatures([facade.rings for facade in facades], columns)


def facing_outside(
    frames: list[Frame], xyz: np.ndarray, rows: list[np.ndarray], thickness: np.ndarray, monitor: Monitor
) -> list[Frame]:
    """Return frames turned so that their normals point to the side that the facades were seen from.

    Parameters
    ----------
    frames : sequence of Frame
        Of the facades, normals to either side.
    xyz : ndarray of shape (n, 3)
        The whole cloud (m).
    rows : sequence of ndarray
        The points of each facade.
    thickness : ndarray of shape (m,)
        Points nearer to the plane of a facade than this (m) belong to it.
    monitor : Monitor
        Receives the progress.

    Notes
    -----
    An opaque wall hides everything behind it: points off a cell of wall are before it (streets, cars, trees). Close
    behind the wall there are only points seen through openings. Points farther off next to a gap say nothing: a gap is
    an opening with a room behind it, or the shadow of a tree before it.

    A narrow wall hides little, and the side of a bay has the street on both sides. Two facades that meet at a corner
    both have the other before them, or both behind them: a reentrant corner or a salient one. Facades are decided from
    the one with most evidence to that with least, each with those next to it that were decided before.
    """
    start = xyz.min(axis=0)
    _, voxel, count = voxelize(xyz - start, _THINNED)
    around = start + np.column_stack([np.bincount(voxel, column) / count for column in (xyz - start).T])
    tree = spatial.cKDTree(around)
    evidence = []
    for done, (frame, own, thick) in enumerate(zip(frames, rows, thickness), start=1):
        points = xyz[own]
        middle, reach = points.mean(axis=0), np.linalg.norm(np.ptp(points, axis=0)) / 2 + FARTHEST
        evidence.append(_evidence(frame, points, around[np.sort(tree.query_ball_point(middle, reach))], thick))
        monitor.progress(done / len(frames))
    side = _decided(np.array(evidence).reshape(-1, 2), *_corners(frames, xyz, rows))
    return [frame_of(frame.origin, sign * frame.normal) for frame, sign in zip(frames, side)]


def _evidence(frame: Frame, own: np.ndarray, near: np.ndarray, thickness: float) -> tuple[float, float]:
    """Return the evidence for the outside of a facade, from its points (n, 3) and the points around (m, 3).

    It is -1 to 1, for the side to which the normal points, and comes with the area (m²) of the wall.
    """
    own, positions = frame.local(own), frame.local(near)
    low = own[:, :2].min(axis=0)
    cell, own_cell = (np.floor((some[:, :2] - low) / CELL).astype(np.int64) for some in (positions, own))
    count = own_cell.max(axis=0) + 1
    # Ground lies at the foot of the facade or a little below.
    cell[:, 1] += cell[:, 1] == -1
    inside = ((cell >= 0) & (cell < count)).all(axis=1)
    if count[0] > _LEAST_COLUMNS:
        # Walls at a right angle lie behind the ends of the facade.
        inside &= (positions[:, 0] > own[:, 0].min() + CELL) & (positions[:, 0] < own[:, 0].max() - CELL)
    off = np.abs(positions[:, 2])
    inside &= (off > thickness) & (off <= FARTHEST)
    points = np.bincount(own_cell @ [count[1], 1], minlength=int(count.prod()))
    # A cell at the rim of an opening has fewer points than half of the usual.
    is_wall = points >= 0.5 * np.median(points[points > 0])
    cell, off, side = cell[inside], off[inside], np.sign(positions[inside, 2])
    votes = np.where(off <= _DEPTH, -side, np.where(is_wall[cell @ [count[1], 1]], side, 0.0))
    total = float(np.abs(votes).sum())
    return float(votes.sum()) / total if total else 0.0, float(is_wall.sum()) * CELL**2


def _corners(frames: list[Frame], xyz: np.ndarray, rows: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return pairs of facades that meet (k,), (k,), and whether their normals agree: 1 if they do, -1 if not."""
    if len(frames) < 2:
        return np.zeros(0, int), np.zeros(0, int), np.zeros(0)
    number = np.repeat(np.arange(len(rows)), [len(own) for own in rows])
    one, other, _ = shared_cells(xyz[np.concatenate(rows)], number, len(rows), CELL)
    agree = [_agreement(frames[a], xyz[rows[a]], frames[b], xyz[rows[b]]) for a, b in zip(one, other)]
    return one, other, np.array(agree)


def _agreement(one: Frame, of_one: np.ndarray, other: Frame, of_other: np.ndarray) -> float:
    """Return whether two normals point to the same side of a corner, -1 to 1; 0 where undecided."""
    line = intersection_line(one, other)
    cosine = float(one.normal @ other.normal)
    if line is None or abs(cosine) >= np.cos(ONE_FRONT):
        return float(np.sign(cosine))
    sides = []
    for frame, points in ((one, of_other), (other, of_one)):
        offset = points - line[0]
        away = offset - np.outer(offset @ line[1], line[1])
        at_corner = points[(away**2).sum(axis=1) <= _AT_CORNER**2]
        sides.append(float(np.sign(frame.local(at_corner)[:, 2]).mean()) if len(at_corner) else 0.0)
    return sides[0] * sides[1]


def _decided(evidence: np.ndarray, one: np.ndarray, other: np.ndarray, agree: np.ndarray) -> np.ndarray:
    """Return 1 for each normal (m,) that points outside, and -1 for the others.

    A corner weighs as much as the smaller of its two facades.
    """
    area = evidence[:, 1]
    support = area * evidence[:, 0]
    side, is_open = np.ones(len(support)), np.ones(len(support), bool)
    beside: list[list[tuple[int, float]]] = [[] for _ in support]
    for a, b, sign in zip(one, other, agree * np.minimum(area[one], area[other])):
        beside[a].append((int(b), float(sign)))
        beside[b].append((int(a), float(sign)))
    for _ in range(len(support)):
        clearest = int(np.argmax(np.where(is_open, np.abs(support), -1.0)))
        side[clearest], is_open[clearest] = (1.0 if support[clearest] >= 0 else -1.0), False
        for neighbor, weight in beside[clearest]:
            support[neighbor] += weight * side[clearest]
    return side
