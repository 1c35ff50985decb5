"""Sites with bridges and similar objects, one per lot: terrain, decks, parapets, piers, quays, cars and trees."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..cloud.asprs import PointClass
from .bodies import Body, Rect, flat, inclined
from .relief import Relief
from .scene import Scene
from .town_layout import CAR

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

    @property
    def obstacle(self) -> Kind:
        """Kind of the crossing."""
        return KINDS[self.kind]

    def height(self, x, y) -> np.ndarray:
        """Return the elevation (m) of the terrain; under water, of the bottom."""
        u, v = self.frame.local(x, y)
        obstacle, end = self.obstacle, LOT / 2 - _MARGIN - np.abs(v)
        if self.kind == "fly-over":
            return self._embankment(u, v)
        if self.kind == "ramp":
            # A road climbs along the lot and ends at a wall, like a loading ramp.
            climb = np.clip((v + 35) * _RAMP, 0, -obstacle.depth) * (v < 5)
            side = (obstacle.half_width + 2 - np.abs(u)) * _WALL
            return np.clip(np.minimum(np.minimum(climb, side), np.maximum(5 - v, 0) * _WALL), 0, None)
        depth = np.clip((obstacle.half_width + obstacle.behind - np.abs(u)) * obstacle.bank, 0, obstacle.depth)
        if self.kind == "tunnel":
            # The road descends to both portals between walls; the land continues over the tunnel of 60 m between them.
            # The road has a slope of 16 %, so that it begins within the lot.
            down = np.clip(end * 0.16, 0, obstacle.depth)
            return -np.minimum(np.minimum(depth, down), np.clip((np.abs(v) - 30.0) * _WALL, 0, None))
        return -depth * np.clip(end / _FADE, 0, 1)

    def _embankment(self, u, v) -> np.ndarray:
        """Return the elevation (m) of the embankments of a fly-over, in line with its deck."""
        cos, sin = np.cos(self.skew), np.sin(self.skew)
        along, across = u * cos + v * sin, v * cos - u * sin
        past = np.abs(along) - self.span / 2
        top = _FLY_OVER - np.clip(past - 2, 0, None) * _RAMP
        bank = (self.obstacle.decks[0] / 2 + 8 - np.abs(across)) * _BANK
        # Abutments are parallel to the road below; the deck begins where they reach its height.
        wall = np.minimum(past, np.abs(u) - self.obstacle.half_width) * _WALL + _FLY_OVER
        return np.clip(np.minimum(top, np.minimum(bank, wall)), 0, None)

    @property
    def span(self) -> float:
        """Length (m) of the deck from edge to edge of the obstacle."""
        return 2 * self.obstacle.half_width / np.cos(self.skew) + self.obstacle.width * np.tan(abs(self.skew))

    @property
    def water_level(self) -> float:
        """Elevation (m) of the water, which is 1 m deep; -inf without water."""
        return 1.0 - self.obstacle.depth if self.obstacle.is_water else -np.inf


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
        return self._by_lot(x, y, 0.0, lambda lot, x, y: lot.height(x, y))

    def surface(self, x, y) -> np.ndarray:
        """Return the elevation (m) of terrain or water, whichever is higher."""
        return np.maximum(self.ground(x, y), self._level(x, y))

    def is_water(self, x, y) -> np.ndarray:
        """Return the mask of positions with water."""
        return self._level(x, y) > self.ground(x, y)

    def _level(self, x, y) -> np.ndarray:
        return self._by_lot(x, y, -np.inf, lambda lot, x, y: lot.water_level)

    def _by_lot(self, x, y, outside: float, value: Callable[[Lot, np.ndarray, np.ndarray], Any]) -> np.ndarray:
        x, y = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float))
        values = np.full(x.shape, outside)
        for lot in self.lots:
            inside = lot.contains(x, y)
            values[inside] = value(lot, x[inside], y[inside])
        return values


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
        if lot.obstacle.behind:
            on_quay = lot.contains(x, y) & (np.abs(lot.frame.local(x, y)[0]) >= lot.obstacle.half_width)
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
        if lot.obstacle.behind:
            _quays(scene, lot)
        if trees:
            _trees(scene, lot, rng)
    return scene, decks


def _bridge(scene: Scene, lot: Lot, cars: bool) -> list[Deck]:
    """Add the decks of a lot with parapets, cars, and piers under long decks."""
    obstacle = lot.obstacle
    top = _FLY_OVER if lot.kind == "fly-over" else 0.05
    decks, at = [], -obstacle.width / 2
    for width in obstacle.decks:
        # A deck rests on the land with half a meter at each end.
        rect = lot.frame.part(0.0, 0.0, 1.0, 1.0, lot.skew).part(0.0, at + width / 2, lot.span + 1.0, width)
        at += width + 1.5
        number = scene.new_id()
        deck_top = _deck_top(rect, top, obstacle.arch)
        scene.solids.append(Body(rect, deck_top, top - _THICKNESS, PointClass.BRIDGE_DECK, number))
        for side in (-1, 1):
            # Parapets are 1 m high, as building codes require.
            rail = rect.part(0.0, side * (width - 0.25) / 2, rect.length, 0.25)
            tops = _deck_top(rail, top + 1.0, obstacle.arch)
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
    """Add cars on both lanes of a deck, one per 15 m, as in slow traffic."""
    for side in (-1, 1):
        for along in np.arange(-deck.length / 2 + 5 + 3 * side, deck.length / 2 - 4, 15.0):
            car = deck.part(float(along), side * deck.width / 4, *CAR)
            scene.add_box(car, top, top + 1.45, PointClass.UNCLASSIFIED)


def _quays(scene: Scene, lot: Lot) -> None:
    """Add vertical quays along a canal, and a jetty if no deck crosses it; both are terrain."""
    half = lot.obstacle.half_width
    parts = [lot.frame.part(side * (half + 1.5), 0.0, 3.0, LOT - 2 * (_MARGIN + _FADE)) for side in (-1, 1)]
    parts += [] if lot.obstacle.decks else [lot.frame.part(-half / 2, 0.0, half + 2, 6.0)]
    for part in parts:
        scene.add_box(part, -lot.obstacle.depth - 1, 0.0, PointClass.GROUND, 0)


def _trees(scene: Scene, lot: Lot, rng: np.random.Generator) -> None:
    """Add trees on the land away from decks."""
    obstacle = lot.obstacle
    for u, v in rng.uniform(-LOT / 2 + 8, LOT / 2 - 8, (24, 2)):
        x, y = lot.frame.at(u, v)
        across = abs(v * np.cos(lot.skew) - u * np.sin(lot.skew))
        is_free = abs(u) > obstacle.half_width + 4 and across > sum(obstacle.decks) / 2 + 12
        if is_free and max(abs(x - lot.x), abs(y - lot.y)) < LOT / 2 - 6:
            radius = float(rng.uniform(2, 4))
            z = float(scene.relief.ground(x, y))
            scene.crowns.append((float(x), float(y), z + 2 + radius, radius, radius, 1.2, scene.new_id()))
