"""Intersections of beams with ground, solids, leaves and wires, exact or to 0.01 mm."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from ..cloud.asprs import PointClass
from .bodies import SolidArrays, dot, stack
from .pairs import rank
from .relief import Relief
from .scene import Scene

# Beams per block of a scan, which bounds memory.
BLOCK = 50_000

# Radius of an airborne beam at the ground (m): 0.35 mrad from 600 m.
BEAM_RADIUS = 0.1

# Precision of ranges (m).
_PRECISION = 1e-5


@dataclass(frozen=True)
class Beams:
    """Beams of a scanner."""

    pulse: np.ndarray  #: (n,): number of the pulse
    #: origin, direction, (n, 3): start (m) and unit vector
    origin: np.ndarray
    direction: np.ndarray
    #: (n, 2): coordinates in which candidates are searched: from the air, position on the plane of the ground (m); from
    #: a drone or vehicle, azimuth and elevation (rad)
    aim: np.ndarray

    def __len__(self) -> int:
        return len(self.aim)

    def take(self, which: np.ndarray) -> Beams:
        """Return the beams of a mask or at indices."""
        return Beams(self.pulse[which], self.origin[which], self.direction[which], self.aim[which])

    def at(self, which, ranges: np.ndarray) -> np.ndarray:
        """Return the points (n, 3) at ranges (m) along beams."""
        return self.origin[which] + ranges[:, None] * self.direction[which]

    def echoes(self, which, ranges: np.ndarray, classification: np.ndarray, object_id: np.ndarray) -> Echoes:
        """Return the echoes of beams at ranges (m)."""
        numbers = object_id.astype(np.int32)
        return Echoes(self.pulse[which], ranges, self.direction[which], classification.astype(np.uint8), numbers)


@dataclass(frozen=True)
class Echoes:
    """Echoes of pulses: number of the pulse, range (m), direction (n, 3), class and object id."""

    pulse: np.ndarray
    range: np.ndarray
    direction: np.ndarray
    classification: np.ndarray
    object_id: np.ndarray

    def __len__(self) -> int:
        return len(self.pulse)

    def take(self, which: np.ndarray) -> Echoes:
        """Return the echoes of a mask or at indices."""
        return Echoes(*(getattr(self, field.name)[which] for field in fields(self)))

    def in_order(self) -> Echoes:
        """Return the echoes sorted by pulse, then by range."""
        return self.take(np.lexsort((self.range, self.pulse)))

    def first(self) -> Echoes:
        """Return the nearest echo of each pulse."""
        echoes = self.in_order()
        return echoes.take(rank(echoes.pulse) == 0)


def join(parts: Sequence[Echoes]) -> Echoes:
    """Concatenate echoes."""
    return Echoes(*(np.concatenate([getattr(part, field.name) for part in parts]) for field in fields(Echoes)))


class World:
    """A scene as arrays for ray casting. Columns of ``crowns`` and ``wires`` are as in :class:`.scene.Scene`."""

    def __init__(self, scene: Scene) -> None:
        self.relief: Relief = scene.relief
        self.solids: SolidArrays = stack(scene.solids)
        self.crowns: np.ndarray = np.array(scene.crowns, float).reshape(-1, 7)
        self.wires: np.ndarray = np.array(scene.wires, float).reshape(-1, 7)

    def boxes(self, kind: str) -> tuple[np.ndarray, np.ndarray]:
        """Return the lower and upper corners (m, 3) of the bounding boxes of "solids", "crowns" or "wires"."""
        if kind == "solids":
            return self.solids.low, self.solids.high
        if kind == "crowns":
            reach = self.crowns[:, [3, 3, 4]]
            return self.crowns[:, :3] - reach, self.crowns[:, :3] + reach
        ends = self.wires[:, :6].reshape(-1, 2, 3)
        return ends.min(axis=1) - BEAM_RADIUS, ends.max(axis=1) + BEAM_RADIUS

    def surfaces(self, beams: Beams, beam: np.ndarray, solid: np.ndarray) -> Echoes:
        """Return the last echo of each beam, in order: ground, water or a solid (candidates: pairs beam, solid)."""
        ranges = self.ground(beams)
        x, y, _ = beams.at(slice(None), ranges).T
        classes = np.where(self.relief.is_water(x, y), PointClass.WATER, PointClass.GROUND)
        objects = np.zeros(len(beams), np.int32)
        entered = self.solids.enter(solid, beams.origin[beam], beams.direction[beam])
        # The nearest solid of each beam counts if it is nearer than the ground.
        order = np.lexsort((entered, beam))
        order = order[rank(beam[order]) == 0]
        order = order[entered[order] < ranges[beam[order]]]
        beam, solid = beam[order], solid[order]
        ranges[beam] = entered[order]
        classes[beam], objects[beam] = self.solids.classification[solid], self.solids.object_id[solid]
        return beams.echoes(slice(None), ranges, classes, objects)

    def ground(self, beams: Beams) -> np.ndarray:
        """Return the ranges (n,) (m) at which beams meet ground or water.

        The clearance of a beam over the ground decreases along the beam, so it has a single zero. Regula falsi shrinks
        a bracket around it; the Illinois rule (halve the value at the end that stays) keeps the convergence fast.
        """
        middle = np.linalg.norm(beams.aim - beams.origin[:, :2], axis=1)
        middle = np.hypot(middle, beams.origin[:, 2] - self.relief.plane(*beams.aim.T))
        # Beams are at most 30° off the vertical, the ground is within ``spread`` of its plane: a bracket of the zero.
        margin = 3.0 * (self.relief.spread + 1.0)
        found, active = np.zeros(len(beams)), np.arange(len(beams))
        near, far = middle - margin, middle + margin
        # Contiguous columns are faster.
        start, way = np.ascontiguousarray(beams.origin.T), np.ascontiguousarray(beams.direction.T)
        above, below = self._clearance(start, way, near), self._clearance(start, way, far)
        while len(active):
            t = (near * below - far * above) / (below - above)
            value = self._clearance(start, way, t)
            is_above = value > 0
            above = np.where(is_above, value, above / 2)
            below = np.where(is_above, below / 2, value)
            near, far = np.where(is_above, t, near), np.where(is_above, far, t)
            found[active] = t
            go_on = (np.abs(value) > _PRECISION) & (far - near > _PRECISION)
            active, near, far = active[go_on], near[go_on], far[go_on]
            above, below = above[go_on], below[go_on]
            start, way = start.compress(go_on, axis=1), way.compress(go_on, axis=1)
        return found

    def _clearance(self, start: np.ndarray, way: np.ndarray, ranges: np.ndarray) -> np.ndarray:
        x, y, z = start + ranges * way
        return z - self.relief.surface(x, y)

    def leaves(self, beams: Beams, beam: np.ndarray, crown: np.ndarray, rng: np.random.Generator) -> Echoes:
        """Return echoes of leaves along beams through ellipsoids (pairs beam, crown), drawn by a Poisson process."""
        center, radius = self.crowns[crown, :3], self.crowns[crown][:, [3, 3, 4]]
        start, way = (beams.origin[beam] - center) / radius, beams.direction[beam] / radius
        # |start + t way| = 1, a quadratic equation.
        a, b = dot(way, way), dot(start, way)
        inside = b * b - a * (dot(start, start) - 1.0)
        met = inside > 0
        half = np.sqrt(inside[met]) / a[met]
        enter, leave = -b[met] / a[met] - half, -b[met] / a[met] + half
        beam, crown = beam[met], crown[met]
        # Eight leaves per ellipsoid are enough: the echoes of more would come too late to be recorded.
        steps = rng.standard_exponential((len(beam), 8)) * self.crowns[crown, 5, None]
        depth = enter[:, None] + np.cumsum(steps, axis=1)
        which, leaf = np.nonzero(depth < leave[:, None])
        beam, ranges, crown = beam[which], depth[which, leaf], crown[which]
        x, y, z = beams.at(beam, ranges).T
        height = z - self.relief.ground(x, y)
        return beams.echoes(beam, ranges, vegetation_class(height), self.crowns[crown, 6])

    def strands(self, beams: Beams, beam: np.ndarray, wire: np.ndarray, rng: np.random.Generator) -> Echoes:
        """Return the echoes of wires within beams (candidates: pairs beam, wire)."""
        start, along = self.wires[wire, :3], self.wires[wire, 3:6] - self.wires[wire, :3]
        origin, direction = beams.origin[beam], beams.direction[beam]
        # Both ends of the common perpendicular of two lines.
        apart = start - origin
        length2, lean = dot(along, along), dot(along, direction)
        on_beam, on_wire = dot(apart, direction), dot(apart, along)
        share = np.clip((lean * on_beam - on_wire) / (length2 - lean * lean), 0.0, 1.0)
        ranges = on_beam + share * lean
        gap = np.linalg.norm(apart + share[:, None] * along - ranges[:, None] * direction, axis=1)
        # Of the wires in a beam 70 % return an echo: a wire covers a small part of the beam.
        met = (gap < BEAM_RADIUS) & (rng.random(len(beam)) < 0.7)
        classes = np.full(met.sum(), PointClass.WIRE_CONDUCTOR)
        return beams.echoes(beam[met], ranges[met], classes, self.wires[wire[met], 6])


def is_vegetation(classification: np.ndarray) -> np.ndarray:
    """Return the mask of low, medium and high vegetation."""
    return (classification >= PointClass.LOW_VEGETATION) & (classification <= PointClass.HIGH_VEGETATION)


def vegetation_class(height: np.ndarray) -> np.ndarray:
    """Return the vegetation class by height above ground (m): low under 0.5 m, medium under 2 m, otherwise high."""
    steps = np.array([PointClass.LOW_VEGETATION, PointClass.MEDIUM_VEGETATION, PointClass.HIGH_VEGETATION], np.uint8)
    return steps[np.searchsorted([0.5, 2.0], height, side="right")]
