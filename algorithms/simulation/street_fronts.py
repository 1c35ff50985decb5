"""Fronts of houses along a street: plain or curved walls with openings, recesses, bays and balconies."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..cloud.asprs import PointClass
from .bodies import Body, Rect, gable
from .scene import Scene

# Kinds of fronts.
KINDS = ("plain", "recess", "bay", "curved", "balconies")

# Thickness of walls (m).
_WALL = 0.3

# Depth of walls below the ground (m).
_BELOW = 1.0

# Height of a storey (m).
_STOREY = 3.0

# Height of sills over the floor (m).
_SILL = 0.9

# Width and height of windows (m).
_WINDOW = (1.2, 1.5)

# Distance of panes behind the front (m).
_PANE = 0.16

# Distance between the axes of neighboring windows (m).
_AXIS = 2.4

# Depth of recesses and bays (m).
_RECESS = 1.2

# Thickness of panes, doors and parapets (m).
_THIN = 0.05

# Depth of houses behind their fronts (m).
_DEPTH = 10.0

# First and last of positions or elevations (m).
_Span = tuple[float, float]


@dataclass
class Truth:
    """True facades, openings and houses, with the object ids of their solids.

    Adjoining walls in one plane are one facade, also of several houses. Facades and openings are numbered from 1.
    """

    #: Walls of each facade: feet at both ends, (3,) each, and elevation of the top (m)
    walls: list[list[tuple[np.ndarray, np.ndarray, float]]] = field(default_factory=list)
    kinds: list[str] = field(default_factory=list)  #: Kind of each facade, one of :data:`KINDS`
    #: Closed ring (5, 3) of each opening, m, and its attributes
    openings: list[tuple[list[np.ndarray], dict[str, Any]]] = field(default_factory=list)
    facade_of: dict[int, int] = field(default_factory=dict)  #: Number of the facade by object id of its walls
    opening_of: dict[int, int] = field(default_factory=dict)  #: Number of the opening by object id of pane and frame
    glass: set[int] = field(default_factory=set)  #: Object ids of window panes
    #: Closed ring (k, 3) of each house on the ground, m, and its attributes
    houses: list[tuple[list[np.ndarray], dict[str, Any]]] = field(default_factory=list)

    @property
    def facades(self) -> list[np.ndarray]:
        """Closed rings (m, 3) of the facades, m, counterclockwise seen from the street."""
        return [_ring(walls) for walls in self.walls]

    def add_wall(self, start: np.ndarray, end: np.ndarray, top: float, kind: str) -> int:
        """Add a wall between two feet (3,), m, to the facade that it continues, or a new one; return its number."""
        if self.walls and np.allclose(self.walls[-1][-1][1], start):
            before, step = self.walls[-1][-1][1] - self.walls[-1][-1][0], end - start
            if abs(before[0] * step[1] - before[1] * step[0]) < 1e-6 and before[:2] @ step[:2] > 0:
                self.walls[-1].append((start, end, top))
                return len(self.walls)
        self.walls.append([(start, end, top)])
        self.kinds.append(kind)
        return len(self.walls)


def _ring(walls: list[tuple[np.ndarray, np.ndarray, float]]) -> np.ndarray:
    """Return the outline of adjoining walls, with steps between different heights."""
    ring = [walls[0][0], walls[-1][1]]
    for start, end, top in reversed(walls):
        for x, y, _ in (end, start):
            corner = np.array([x, y, top])
            # Walls of equal height have no corner between them.
            if len(ring) > 3 and np.allclose(ring[-1], corner):
                ring.pop()
            else:
                ring.append(corner)
    return np.array([*ring, ring[0]])


@dataclass(frozen=True)
class Line:
    """The foot of a wall: start (2,), m, direction (2,) and length, with the street on its right."""

    start: np.ndarray
    way: np.ndarray
    length: float

    def at(self, along: float, inward: float = 0.0) -> np.ndarray:
        """Return the point (2,) at a distance along the wall and behind its front (m)."""
        return self.start + along * self.way + inward * np.array([-self.way[1], self.way[0]])

    def rect(self, along: _Span, inward: _Span) -> Rect:
        """Return the rectangle between two positions along the wall and two behind its front (m)."""
        x, y = self.at(sum(along) / 2, sum(inward) / 2)
        angle = float(np.arctan2(self.way[1], self.way[0]))
        return Rect(float(x), float(y), along[1] - along[0], inward[1] - inward[0], angle)


@dataclass(frozen=True)
class Front:
    """The front of a house."""

    line: Line  #: Foot of the front
    height: float  #: Height above the ground floor at the start of the line, m
    kind: str  #: One of :data:`KINDS`
    raised: float = 0.0  #: Height of the ground floor above the street, m

    def build(self, scene: Scene, truth: Truth) -> None:
        """Add the front."""
        line, kind = self.line, self.kind
        top = float(scene.relief.plane(*line.start)) + self.height + self.raised
        for part, is_front in _parts(line, kind):
            _Wall(scene, truth, part).build(top, kind, self.raised, is_front)
        if kind == "balconies":
            _Wall(scene, truth, line).hang_balconies(top, self.height)

    def build_house(self, scene: Scene, truth: Truth, pitch: float) -> None:
        """Add a house behind a straight front: its other walls and a gable roof with a ``pitch`` (°).

        The roof is flush with the walls and covers a recess; its ridge is parallel to the street.
        """
        line, kind, walls = self.line, self.kind, _Wall(scene, truth, self.line)
        ground = float(scene.relief.plane(*line.start))
        top, across, number = ground + (self.height + self.raised), (0.0, line.length), scene.new_id()
        inner = _RECESS + _WALL if kind == "recess" else _WALL
        sides = [((end, end + _WALL), (_WALL, inner)) for end in (0.0, line.length - _WALL)]
        for along, inward in [(across, (inner, _DEPTH)), *sides]:
            walls.put(along, inward, ground - 2 * _BELOW, top, number)
        rect = line.rect(across, (0.0, _DEPTH))
        tops = gable(rect, top, float(np.tan(np.deg2rad(pitch))))
        scene.solids.append(Body(rect, tops, top, PointClass.BUILDING, number))
        if kind == "bay":
            # The roof of the bay, 0.2 m thick, is between its walls, so that no faces coincide.
            third = line.length / 3
            walls.put((third + _WALL, 2 * third - _WALL), (_WALL - _RECESS, 0.0), top - 0.2, top, number)
        corners = [*_corners(line, kind), (line.length, _DEPTH), (0.0, _DEPTH), (0.0, 0.0)]
        ring = np.array([(*line.at(*corner), ground) for corner in corners])
        truth.houses.append(([ring], {"eave": top, "ridge": float(np.min(tops @ [rect.x, rect.y, 1.0]))}))


def _parts(line: Line, kind: str) -> list[tuple[Line, bool]]:
    """Return the walls of a front in order, and whether each has openings."""
    if kind in ("recess", "bay"):
        points = [line.at(*corner) for corner in _corners(line, kind)]
        return [(between(a, b), k % 2 == 0) for k, (a, b) in enumerate(zip(points, points[1:]))]
    if kind == "curved":
        half = np.deg2rad(30.0)
        radius = line.length / (2 * np.sin(half))
        angle = np.linspace(-half, half, 7)
        # The arc of 60° is convex toward the street; six plane strips approximate it.
        out = radius * (np.cos(angle) - np.cos(half))
        points = [line.at(line.length / 2 + radius * np.sin(a), -o) for a, o in zip(angle, out)]
        return [(between(a, b), False) for a, b in zip(points, points[1:])]
    return [(line, True)]


def _corners(line: Line, kind: str) -> list[tuple[float, float]]:
    """Return the corners of a front that is not curved, as distances along its line and behind it (m)."""
    third, inward = line.length / 3, {"recess": _RECESS, "bay": -_RECESS}.get(kind)
    steps = [(third, 0.0), (third, inward), (2 * third, inward), (2 * third, 0.0)] if inward else []
    return [(0.0, 0.0), *steps, (line.length, 0.0)]


def between(a: np.ndarray, b: np.ndarray) -> Line:
    """Return the foot of a wall between two points (2,), m."""
    length = float(np.hypot(*(b - a)))
    return Line(a, (b - a) / length, length)


@dataclass(frozen=True)
class _Wall:
    """A plane wall to be added to a scene and its truth."""

    scene: Scene
    truth: Truth
    line: Line

    def put(self, along: _Span, inward: _Span, bottom: float, top: float, number: int) -> None:
        """Add a box by its ranges along the wall, behind its front and in elevation (m)."""
        if along[1] - along[0] > 1e-6 and top - bottom > 1e-6:
            self.scene.add_box(self.line.rect(along, inward), bottom, top, PointClass.BUILDING, number)

    def build(self, top: float, kind: str, raised: float, has_openings: bool) -> None:
        """Add the wall with its openings."""
        line = self.line
        ends = [line.at(0.0), line.at(line.length)]
        feet = [float(self.scene.relief.plane(*end)) for end in ends]
        first, last = (np.array([*end, foot]) for end, foot in zip(ends, feet))
        facade = self.truth.add_wall(first, last, top, kind)
        own = self.scene.new_id()
        self.truth.facade_of[own] = facade
        bottom, levels = min(feet) - _BELOW, (max(feet), max(feet) + raised)
        axes = _axes(line.length) if has_openings else []
        sides = [0.0, *(side for axis in axes for side in axis), line.length]
        for along in zip(sides[::2], sides[1::2]):
            self.put(along, (0.0, _WALL), bottom, top, own)
        for k, along in enumerate(axes):
            self._build_axis(along, levels, (bottom, top), own, facade, k == len(axes) // 2)

    def _build_axis(self, along: _Span, levels: _Span, heights: _Span, own: int, facade: int, has_door: bool) -> None:
        """Add the openings of one axis and the wall between them; ``levels`` are ground and ground floor (m)."""
        (bottom, top), (ground, floor) = heights, levels
        openings, level = [], floor
        # Cellar windows of 0.8 m are 0.25 m above the ground.
        if not has_door and floor - ground >= 1.4:
            openings.append((ground + 0.25, ground + (0.25 + 0.8), "window"))
        # The wall above a window is at least 0.3 m high.
        while level + _SILL + _WINDOW[1] + 0.3 < top:
            openings.append((level + _SILL, level + _SILL + _WINDOW[1], "window"))
            level += _STOREY
        if has_door and openings:
            # The door is 2.2 m high.
            openings[0] = (floor if floor > ground else bottom, floor + 2.2, "door")
            self._put_stairs(along, bottom, levels)
        below = bottom
        for low, high, kind in openings:
            self.put(along, (0.0, _WALL), below, low, own)
            self._build_opening(along, (low, high), kind, facade)
            below = high
        self.put(along, (0.0, _WALL), below, top, own)

    def _put_stairs(self, along: _Span, bottom: float, levels: _Span) -> None:
        """Add a landing and steps from the ground to the floor of a door; their boxes start at ``bottom`` (m)."""
        ground, floor = levels
        # Depth of the landing, run and greatest rise of a step (m).
        landing, run, rise = 1.2, 0.28, 0.18
        steps = int(np.ceil((floor - ground) / rise))
        wide = (along[0] - 0.25, along[1] + 0.25)
        number = self.scene.new_id() if steps else 0
        for step in range(steps):
            start = 0.0 if step == 0 else landing + (step - 1) * run
            self.put(wide, (-(landing + step * run), -start), bottom, floor - step / steps * (floor - ground), number)

    def _build_opening(self, along: _Span, heights: _Span, kind: str, facade: int) -> None:
        """Add the pane and frame of an opening; a door is opaque."""
        truth, (start, end), (low, high) = self.truth, along, heights
        number = len(truth.openings) + 1
        pane, frame = self.scene.new_id(), self.scene.new_id()
        truth.opening_of |= {pane: number, frame: number}
        if kind == "window":
            truth.glass.add(pane)
        self.put(along, (_PANE, _PANE + _THIN), low, high, pane)
        # Frames are 0.07 m wide and 0.1 m behind the front.
        for side in ((start, start + 0.07), (end - 0.07, end)):
            self.put(side, (0.1, _PANE), low, high, frame)
        for bar in ((low, low + 0.07), (high - 0.07, high)):
            self.put(along, (0.1, _PANE), *bar, frame)
        ground = max(low, min(float(self.scene.relief.plane(*self.line.at(position))) for position in along))
        corners = [(start, ground), (end, ground), (end, high), (start, high), (start, ground)]
        ring = np.array([(*self.line.at(a), z) for a, z in corners])
        facts = {"width": float(np.hypot(*(ring[1] - ring[0])[:2])), "height": float(ring[2, 2] - ring[1, 2])}
        truth.openings.append(([ring], {"facade": facade, "kind": kind, **facts}))

    def hang_balconies(self, top: float, height: float) -> None:
        """Add a balcony in front of the middle axis of each upper storey."""
        middle, floor = self.line.length / 2, top - height
        # The uppermost storey may be up to half a meter lower than the others.
        for level in np.arange(floor + _STOREY, top - _STOREY + 0.5, _STOREY):
            # A slab of 2.8 m by 1.1 m and 0.15 m, with a parapet of 1 m.
            number, along = self.scene.new_id(), (middle - 1.4, middle + 1.4)
            self.put(along, (-1.1, 0.0), level - 0.15, level, number)
            self.put(along, (-1.1, -1.1 + _THIN), level, level + 1.0, number)


def _axes(length: float) -> list[_Span]:
    """Return the start and end (m) of each axis of openings along a wall, at least 0.5 m from its ends."""
    count = max(int((length - 1.0 + (_AXIS - _WINDOW[0])) // _AXIS), 0)
    middles = [length / 2 + (k - (count - 1) / 2) * _AXIS for k in range(count)]
    return [(middle - _WINDOW[0] / 2, middle + _WINDOW[0] / 2) for middle in middles]
