"""Solids with plane faces, and their intersection with beams.

Houses, dormers, chimneys, cars, walls and bridge decks all have one shape: a rectangle in plan with vertical sides. The
underside is a plane, level except for roof slabs; the top is the lowest of up to four planes. Such a solid is convex. A
beam enters it at the last of its crossings from outside a face to inside.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Optional

import numpy as np

# Most planes of the top of a solid: a hip roof has four.
_MAX_TOPS = 4


@dataclass(frozen=True)
class Rect:
    """A rectangle in plan: center (m), length and width (m), direction of the length (radians from east)."""

    x: float
    y: float
    length: float
    width: float
    angle: float

    def at(self, along, across) -> tuple:
        """Return the point at distances (m) from the center along the length and to the left of it."""
        cos, sin = np.cos(self.angle), np.sin(self.angle)
        return self.x + along * cos - across * sin, self.y + along * sin + across * cos

    def local(self, x, y) -> tuple:
        """Return the coordinates (m) of points along and across the rectangle, from its center."""
        dx, dy = x - self.x, y - self.y
        cos, sin = np.cos(self.angle), np.sin(self.angle)
        return dx * cos + dy * sin, dy * cos - dx * sin

    def part(self, along: float, across: float, length: float, width: float, turn: float = 0.0) -> Rect:
        """Return a rectangle from its center (m), sides (m) and turn (radians) in the frame of this one."""
        x, y = self.at(along, across)
        return Rect(float(x), float(y), length, width, self.angle + turn)

    def corners(self, margin: float = 0.0) -> np.ndarray:
        """Return the corners (4, 2), counterclockwise, of the rectangle grown by a margin (m)."""
        a, c = self.length / 2 + margin, self.width / 2 + margin
        return np.stack(self.at(np.array([-a, a, a, -a]), np.array([-c, -c, c, c])), axis=1)

    def contains(self, x, y, margin: float = 0.0) -> np.ndarray:
        """Return the mask of points (m) in the rectangle grown by a margin (m)."""
        along, across = self.local(x, y)
        return (np.abs(along) <= self.length / 2 + margin) & (np.abs(across) <= self.width / 2 + margin)


@dataclass(frozen=True)
class Body:
    """A solid over a rectangle, between its underside and the lowest of its top planes."""

    rect: Rect  #: The footprint
    tops: np.ndarray  #: (k, 3), k from 1 to 4: planes z = a x + b y + c
    bottom: float  #: Lowest elevation of the underside (m)
    #: classification, object_id: Class code and object id of the points on it
    classification: int
    object_id: int
    #: (3,): plane z = a x + b y + c of the underside; level at ``bottom`` by default
    under: Optional[np.ndarray] = None

    def top(self, x, y) -> np.ndarray:
        """Return the elevation of the top (m), also outside the rectangle."""
        return np.min([a * x + b * y + c for a, b, c in self.tops], axis=0)


def inclined(rect: Rect, along: float, across: float, z: float, rise_along: float, rise_across: float) -> np.ndarray:
    """Return the plane (a, b, c) through a point with given slopes along and across a rectangle.

    Parameters
    ----------
    rect : Rect
        The rectangle.
    along, across : float
        Position of the point along and across it, m from its center.
    z : float
        Elevation of the point, m.
    rise_along, rise_across : float
        Slopes along and across it, tangents.
    """
    cos, sin = np.cos(rect.angle), np.sin(rect.angle)
    a, b = rise_along * cos - rise_across * sin, rise_along * sin + rise_across * cos
    x, y = rect.at(along, across)
    return np.array([a, b, z - a * x - b * y])


def flat(rect: Rect, z: float) -> np.ndarray:
    """Return the top of a flat roof."""
    return inclined(rect, 0.0, 0.0, z, 0.0, 0.0)[None]


def lean_to(rect: Rect, low: float, pitch: float) -> np.ndarray:
    """Return the top of a shed roof: elevation ``low`` (m) on the right side, ``pitch`` as a tangent."""
    return inclined(rect, 0.0, -rect.width / 2, low, 0.0, pitch)[None]


def gable(rect: Rect, eave: float, pitch: float) -> np.ndarray:
    """Return the planes of a gable roof with the ridge along the length, ``pitch`` as a tangent."""
    return np.array([inclined(rect, 0.0, side * rect.width / 2, eave, 0.0, -side * pitch) for side in (-1, 1)])


def hip(rect: Rect, eave: float, pitch: float) -> np.ndarray:
    """Return the planes of a hip roof with the same pitch (a tangent) on all sides."""
    ends = [inclined(rect, side * rect.length / 2, 0.0, eave, -side * pitch, 0.0) for side in (-1, 1)]
    return np.concatenate([gable(rect, eave, pitch), ends])


@dataclass(frozen=True)
class SolidArrays:
    """Many solids as arrays."""

    faces: np.ndarray  #: (m, 9, 4): normal n and offset d of each face, with n·p <= d inside
    #: low, high, (m, 3): corners of the bounding boxes, m
    low: np.ndarray
    high: np.ndarray
    classification: np.ndarray  #: (m,), uint8: class code
    object_id: np.ndarray  #: (m,), int32: id of the object

    def enter(self, which: np.ndarray, origin: np.ndarray, direction: np.ndarray) -> np.ndarray:
        """Return the ranges (n,) (m) at which beams enter the solids ``which``, inf for misses and solids behind."""
        near = np.full(len(which), -np.inf)
        far = np.full(len(which), np.inf)
        # Contiguous columns are faster.
        start, way = np.ascontiguousarray(origin.T), np.ascontiguousarray(direction.T)
        for face in self.faces.transpose(1, 2, 0):
            a, b, c, offset = (values.take(which) for values in face)
            speed = a * way[0] + b * way[1] + c * way[2]
            remaining = offset - (a * start[0] + b * start[1] + c * start[2])
            with np.errstate(divide="ignore", invalid="ignore"):
                crossing = remaining / speed
            near = np.where(speed < 0, np.maximum(near, crossing), near)
            far = np.where(speed > 0, np.minimum(far, crossing), far)
            # A beam parallel to a face and outside of it misses the solid.
            far = np.where((speed == 0) & (remaining < 0), -np.inf, far)
        return np.where((near < far) & (near > 0), near, np.inf)


def dot(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return the scalar products (n,) of vectors (n, 3), summed in the same order for every memory layout."""
    return one[:, 0] * other[:, 0] + one[:, 1] * other[:, 1] + one[:, 2] * other[:, 2]


def rectangles(solids: Sequence[Body]) -> Rect:
    """Return the footprints of solids as one :class:`Rect` whose fields are arrays (m,)."""
    rows = [(s.rect.x, s.rect.y, s.rect.length, s.rect.width, s.rect.angle) for s in solids]
    return Rect(*np.array(rows, float).reshape(-1, 5).T)


def stack(solids: Sequence[Body]) -> SolidArrays:
    """Convert solids to arrays."""
    rects, bottom = rectangles(solids), np.array([solid.bottom for solid in solids], float)
    # Four sides, the underside and the planes of the top; missing ones are (0, 0, 0, 1): every point is inside of them.
    faces = np.zeros((len(solids), 5 + _MAX_TOPS, 4))
    faces[:, :, 3] = 1.0
    # One by one: the last bit of numpy's cosine of an array depends on the memory layout.
    cos, sin = (np.array([call(angle) for angle in np.asarray(rects.angle).tolist()]) for call in (math.cos, math.sin))
    for i, (side, reach) in enumerate([(1, rects.length), (-1, rects.length), (1, rects.width), (-1, rects.width)]):
        x, y = (side * cos, side * sin) if i < 2 else (-side * sin, side * cos)
        faces[:, i] = np.column_stack([x, y, np.zeros(len(solids)), x * rects.x + y * rects.y + reach / 2])
    under = [(0.0, 0.0, solid.bottom) if solid.under is None else solid.under for solid in solids]
    a, b, c = np.array(under, float).reshape(-1, 3).T
    faces[:, 4] = np.column_stack([a, b, -np.ones(len(solids)), -c])
    corners = np.stack([solid.rect.corners() for solid in solids], axis=2) if len(solids) else rects.corners()
    top = np.full(len(solids), np.inf)
    for k in range(_MAX_TOPS):
        has = np.array([len(solid.tops) > k for solid in solids], bool)
        a, b, c = np.array([solid.tops[k] for solid in solids if len(solid.tops) > k], float).reshape(-1, 3).T
        faces[has, 5 + k] = np.column_stack([-a, -b, np.ones(len(a)), c])
        # A plane is highest at a corner; the lowest of these maxima bounds the top.
        top[has] = np.minimum(top[has], (a * corners[:, 0, has] + b * corners[:, 1, has] + c).max(axis=0))
    return SolidArrays(
        faces,
        np.column_stack([*corners.min(axis=0), bottom]),
        np.column_stack([*corners.max(axis=0), top]),
        np.array([solid.classification for solid in solids], np.uint8),
        np.array([solid.object_id for solid in solids], np.int32),
    )
