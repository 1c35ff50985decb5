"""Facades of segments: least-squares plane, side that was seen, and boundary of each."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..geometry.groups import members
from ..planes.least_squares_planes import Planes, planes_of
from ..stage import LayerFeatures, Monitor
from .facade_frame import Frame, frame_of
from .facade_outline import Drawing, outline_of, ring_area
from .facade_sides import facing_outside

# Points nearer to a facade's plane than this (m) may be frames and reliefs of it: they don't show which side was seen.
_THICKNESS = 0.05


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
    # Or three standard deviations, within which nearly all points of the facade itself lie.
    thickness = np.array([max(_THICKNESS, 3 * planes[n][1]) for n in steep])
    rows = [groups[n] for n in steep]
    frames = facing_outside([planes[n][0] for n in steep], xyz, rows, thickness, monitor.part(0, 0.3))
    facades = []
    for done, (number, frame) in enumerate(zip(steep, frames), start=1):
        positions = frame.local(xyz[groups[number]])[:, :2]
        outline = outline_of(positions, drawing)
        if outline is not None:
            found = outline.ring, groups[number], planes[number][1], outline.spacing
            facades.append(Facade(number, frame, *found, outline.hull_area, outline.seen_area))
        monitor.progress(0.3 + 0.7 * done / len(steep))
    return facades


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
