"""Sites with bridges and similar objects, one per lot: terrain, decks, parapets, piers, quays, cars and trees."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..cloud.asprs import PointClass
from .bodies import Body, Rect, flat, inclined
from .relief import Relief
from .scene import Scene

# Side of a lot (m): the ramps of a fly-over are 46 m long on both sides of its span.
LOT = 140.0

# Distance (m) of obstacles from the border of their lot, so that neighbors do not touch.
_MARGIN = 4.0

# Length (m) over which the bottom of an obstacle rises to the land at its ends.
_FADE = 12.0

# Slope of terrain walls, a tangent (60°): beams up to 30° off the vertical meet such ground once.
_WALL = 1.7

# Thickness of a deck (m), usual for short concrete bridges.
_THICKNESS = 0.9

# Height of parapets (m), as building codes require.
_PARAPET = 1.0

# Width of parapets (m).
_PARAPET_WIDTH = 0.25

# Length (m) of a deck that rests on the land at each end.
_SEAT = 0.5

# Length, width and height of a mid-size car (m).
_CAR = (4.3, 1.8, 1.45)

# Distance between cars (m), as in slow traffic.
_CARS = 15.0

# Slope of the ramps of a fly-over, a tangent: steeper than real roads, to keep lots small.
_RAMP = 0.12

# Height of a fly-over (m): trucks pass below.
_FLY_OVER = 5.5

# Slope of embankments and cuttings, a tangent: the usual 2 : 3.
_BANK = 0.67


@dataclass(frozen=True)
class Kind:
    """Kind of crossing: an obstacle and the decks over it."""

    half_width: float  #: Half the width of the obstacle between its edges, m
    depth: float  #: Depth of the obstacle below the land, m; negative if it rises above the land
    bank: float  #: Slope of its banks, a tangent; they lie within ``half_width``
    is_water: bool = False  #: Whether the obstacle holds water
    decks: tuple[float, ...] = (9.0,)  #: Widths of the decks side by side, m; empty without a bridge
    arch: float = 0.0  #: Rise of the middle of a deck over its ends, m

    @property
    def width(self) -> float:
        """Total width (m) of the decks with gaps of 1.5 m between them."""
        return sum(self.decks) + 1.5 * (len(self.decks) - 1)

    @property
    def behind(self) -> float:
        """Distance (m) of the slope to the bottom behind the edges, which vertical quays hide."""
        return self.depth / _WALL if self.is_water and self.bank == _WALL else 0.0


# Kinds of crossings by name.
KINDS = {
    "canal": Kind(9.0, 3.0, _WALL, True, (8.0,)),
    "arch": Kind(9.0, 3.0, _WALL, True, (6.0,), 0.9),
    "footbridge": Kind(6.0, 2.2, 0.8, True, (2.5,)),
    "cutting": Kind(20.0, 6.0, _BANK, False, (10.0,)),
    "two decks": Kind(20.0, 6.0, _BANK, False, (10.0, 10.0)),
    "valley": Kind(32.0, 14.0, 0.6, True, (9.0,)),
    "fly-over": Kind(12.0, 0.0, _WALL, False, (9.0,)),
    "tunnel": Kind(9.0, 6.0, _WALL, False, ()),
    "jetty": Kind(15.0, 3.0, _WALL, True, ()),
    "ramp": Kind(5.0, -4.0, _WALL, False, ()),
}

# Depth of the water (m).
_WATER = 1.0

# Half the length of the tunnel (m).
_TUNNEL = 30.0

# Slope of the road down to the tunnel, a tangent: steep, so that it begins within the lot.
_ROAD = 0.16


@dataclass(frozen=True)
class Lot:
    """A lot: kind of crossing, center (m), direction across the obstacle (rad), angle of the decks to it (rad)."""

    kind: str
    x: float
    y: float
    turn: float
    skew: float

    def contains(self, x, y) -> np.ndarray:
        """Return the mask of positions (m) that lie on the lot."""
        return (np.abs(x - self.x) < LOT / 2) & (np.abs(y - self.y) < LOT / 2)

    @property
    def frame(self) -> Rect:
        """Frame of the lot: length across the obstacle, width along it."""
        return Rect(self.x, self.y, 1.0, 1.0, self.turn)

    def height(self, x, y) -> np.ndarray:
        """Return the elevation (m) of the terrain; under water, of the bottom."""
        u, v = self.frame.local(x, y)
        obstacle = KINDS[self.kind]
        if self.kind == "fly-over":
            return self._embankment(u, v)
        fade = np.clip((LOT / 2 - _MARGIN - np.abs(v)) / _FADE, 0, 1)
        if self.kind == "ramp":
            # A road climbs along the lot and ends at a wall, like a loading ramp.
            climb = np.clip((v + 35) * _RAMP, 0, -obstacle.depth) * (v < 5)
            side = (obstacle.half_width + 2 - np.abs(u)) * _WALL
            return np.clip(np.minimum(np.minimum(climb, side), np.maximum(5 - v, 0) * _WALL), 0, None)
        depth = np.clip((obstacle.half_width + obstacle.behind - np.abs(u)) * obstacle.bank, 0, obstacle.depth)
        if self.kind == "tunnel":
            # The road descends to both portals between walls; the land continues over the tunnel between them.
            down = np.clip((LOT / 2 - _MARGIN - np.abs(v)) * _ROAD, 0, obstacle.depth)
            return -np.minimum(np.minimum(depth, down), np.clip((np.abs(v) - _TUNNEL) * _WALL, 0, None))
        return -depth * fade

    def _embankment(self, u, v) -> np.ndarray:
        """Return the elevation (m) of the embankments of a fly-over, in line with its deck."""
        cos, sin = np.cos(self.skew), np.sin(self.skew)
        along, across = u * cos + v * sin, v * cos - u * sin
        past = np.abs(along) - self.span / 2
        top = _FLY_OVER - np.clip(past - 2, 0, None) * _RAMP
        bank = (KINDS[self.kind].decks[0] / 2 + 8 - np.abs(across)) * _BANK
        # Abutments are parallel to the road below; the deck begins where they reach its height.
        wall = np.minimum(past, np.abs(u) - KINDS[self.kind].half_width) * _WALL + _FLY_OVER
        foot = np.minimum(bank, wall)
        return np.clip(np.minimum(top, foot), 0, None)

    @property
    def span(self) -> float:
        """Length (m) of the deck from edge to edge of the obstacle."""
        obstacle = KINDS[self.kind]
        return 2 * obstacle.half_width / np.cos(self.skew) + obstacle.width * np.tan(abs(self.skew))

    @property
    def water_level(self) -> float:
        """Elevation (m) of the water, -inf without water."""
        obstacle = KINDS[self.kind]
        return _WATER - obstacle.depth if obstacle.is_water else -np.inf


@dataclass(frozen=True)
class BridgeRelief(Relief):
    """Level land with an obstacle per lot."""

    lots: tuple[Lot, ...] = field(default=())  #: Each fills a square of :data:`LOT` around its middle

    @property
    def spread(self) -> float:
        """Upper bound (m) of the vertical distance from the ground to the plane."""
        return max(max(kind.depth, _FLY_OVER) for kind in KINDS.values())

    def ground(self, x, y) -> np.ndarray:
        """Return the elevation (m) of the terrain; under water, of the bottom."""
        x, y = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float))
        z = np.zeros(x.shape)
        for lot in self.lots:
            inside = lot.contains(x, y)
            z[inside] = lot.height(x[inside], y[inside])
        return z

    def surface(self, x, y) -> np.ndarray:
        """Return the elevation (m) of terrain or water, whichever is higher."""
        return np.maximum(self.ground(x, y), self._level(x, y))

    def is_water(self, x, y) -> np.ndarray:
        """Return the mask of positions with water."""
        return self._level(x, y) > self.ground(x, y)

    def _level(self, x, y) -> np.ndarray:
        x, y = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float))
        level = np.full(x.shape, -np.inf)
        for lot in self.lots:
            level[lot.contains(x, y)] = lot.water_level
        return level


@dataclass(frozen=True)
class Deck:
    """A deck: object id, kind of crossing, angle (°) and footprint."""

    object_id: int
    kind: str
    angle: float
    rect: Rect


def land(scene: Scene, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return the elevation (m) of terrain and quays at positions (n,); under water, of the bottom."""
    z = np.array(scene.relief.ground(x, y))
    for lot in scene.relief.lots if isinstance(scene.relief, BridgeRelief) else ():
        kind = KINDS[lot.kind]
        if kind.behind:
            on_quay = lot.contains(x, y) & (np.abs(lot.frame.local(x, y)[0]) >= kind.half_width)
            z[on_quay] = np.maximum(z[on_quay], 0.0)
    return z


def build_site(kinds: tuple[str, ...], angle: float, cars: bool, trees: bool, seed: int) -> tuple[Scene, list[Deck]]:
    """Return a site with a lot for each of ``kinds``, and its true decks.

    Parameters
    ----------
    kinds : tuple of str
        Kinds of crossings, one per lot.
    angle : float
        Angle of the decks to the perpendicular of the obstacle, °.
    cars, trees : bool
        Whether to add cars on the decks, and trees.
    seed : int
        The same seed gives the same site.
    """
    rng = np.random.default_rng([seed, 7])
    columns = int(np.ceil(np.sqrt(len(kinds))))
    lots = []
    for number, kind in enumerate(kinds):
        row, column = divmod(number, columns)
        turn = float(rng.uniform(0, 2 * np.pi)) if KINDS[kind].decks else float(rng.integers(4) * np.pi / 2)
        x, y = (column + 0.5) * LOT, (row + 0.5) * LOT
        lots.append(Lot(kind, x, y, turn, float(np.radians(angle))))
    scene = Scene(BridgeRelief(columns * LOT, lots=tuple(lots)))
    decks = []
    for lot in lots:
        decks += _bridge(scene, lot, cars)
        if KINDS[lot.kind].is_water and KINDS[lot.kind].bank == _WALL:
            _quays(scene, lot)
        if trees:
            _trees(scene, lot, rng)
    return scene, decks


def _bridge(scene: Scene, lot: Lot, cars: bool) -> list[Deck]:
    """Add the decks of a lot with parapets, cars, and piers under long decks."""
    obstacle = KINDS[lot.kind]
    top = _FLY_OVER if lot.kind == "fly-over" else 0.05
    decks, at = [], -obstacle.width / 2
    for width in obstacle.decks:
        frame = lot.frame.part(0.0, 0.0, 1.0, 1.0, lot.skew)
        rect = frame.part(0.0, at + width / 2, lot.span + 2 * _SEAT, width)
        at += width + 1.5
        number = scene.new_id()
        deck_top = _deck_top(rect, top, obstacle.arch)
        scene.solids.append(Body(rect, deck_top, top - _THICKNESS, PointClass.BRIDGE_DECK, number))
        for side in (-1, 1):
            rail = rect.part(0.0, side * (width - _PARAPET_WIDTH) / 2, rect.length, _PARAPET_WIDTH)
            tops = _deck_top(rail, top + _PARAPET, obstacle.arch)
            scene.solids.append(Body(rail, tops, top - _THICKNESS, PointClass.UNCLASSIFIED, number))
        if rect.length > 40:
            for share in (-0.2, 0.2):
                pier = rect.part(share * rect.length, 0.0, 1.2, width - 2.0)
                scene.add_box(pier, -20.0, top - _THICKNESS, PointClass.UNCLASSIFIED, number)
        if cars and width > 4 and not obstacle.arch:
            _cars(scene, rect, top)
        decks.append(Deck(number, lot.kind, float(np.degrees(lot.skew)), rect))
    return decks


def _deck_top(rect: Rect, top: float, arch: float) -> np.ndarray:
    """Return the top planes of a deck with ends at elevation ``top`` (m) and a rise ``arch`` (m) in the middle."""
    if not arch:
        return flat(rect, top)
    half = rect.length / 2
    # Two planes on each side: steeper toward the ends.
    planes = [
        inclined(rect, side * half * share, 0.0, top + arch * rise, -side * arch / half * slope, 0.0)
        for side in (-1, 1)
        for share, rise, slope in ((1.0, 0.0, 1.4), (0.0, 1.0, 0.5))
    ]
    return np.array(planes)


def _cars(scene: Scene, deck: Rect, top: float) -> None:
    """Add cars on both lanes of a deck."""
    length, width, height = _CAR
    for side in (-1, 1):
        for along in np.arange(-deck.length / 2 + 5 + 3 * side, deck.length / 2 - 4, _CARS):
            car = deck.part(float(along), side * deck.width / 4, length, width)
            scene.add_box(car, top, top + height, PointClass.UNCLASSIFIED)


def _quays(scene: Scene, lot: Lot) -> None:
    """Add vertical quays along a canal, and a jetty if no deck crosses it; both are terrain."""
    obstacle = KINDS[lot.kind]
    long = LOT - 2 * (_MARGIN + _FADE)
    for side in (-1, 1):
        quay = lot.frame.part(side * (obstacle.half_width + 1.5), 0.0, 3.0, long)
        scene.add_box(quay, -obstacle.depth - 1, 0.0, PointClass.GROUND, 0)
    if not obstacle.decks:
        jetty = lot.frame.part(-obstacle.half_width / 2, 0.0, obstacle.half_width + 2, 6.0)
        scene.add_box(jetty, -obstacle.depth - 1, 0.0, PointClass.GROUND, 0)


def _trees(scene: Scene, lot: Lot, rng: np.random.Generator) -> None:
    """Add trees on the land away from decks."""
    obstacle = KINDS[lot.kind]
    for u, v in rng.uniform(-LOT / 2 + 8, LOT / 2 - 8, (24, 2)):
        x, y = lot.frame.at(u, v)
        across = abs(v * np.cos(lot.skew) - u * np.sin(lot.skew))
        is_free = abs(u) > obstacle.half_width + 4 and across > sum(obstacle.decks) / 2 + 12
        if is_free and max(abs(x - lot.x), abs(y - lot.y)) < LOT / 2 - 6:
            radius = float(rng.uniform(2, 4))
            z = float(scene.relief.ground(x, y))
            scene.crowns.append((float(x), float(y), z + 2 + radius, radius, radius, 1.2, scene.new_id()))
