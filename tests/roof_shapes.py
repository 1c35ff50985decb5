"""Roofs whose ridges, eaves and corners are known, as points of a scanner."""

from dataclasses import dataclass
from typing import Callable

import numpy as np

from lidar_buildings.tests.builders import is_inside, rectangle


@dataclass(frozen=True)
class RoofShape:
    """A roof: its outline (m, 2), its height over x and y, the true corners of its roof (k, 3), and its type."""

    outline: np.ndarray
    top: Callable
    corners: np.ndarray
    kind: str

    @property
    def ring(self) -> np.ndarray:
        return np.concatenate([self.outline, self.outline[:1]])

    @property
    def eave(self) -> float:
        return float(self.corners[:, 2].min())

    @property
    def ridge(self) -> float:
        return float(self.corners[:, 2].max())

    def scanned(self, density=12.0, noise=0.03, seed=0, turn=0.0, origin=(0.0, 0.0)):
        """Return points (n, 3) at random, turned about z (°) and moved to an origin, and the ring likewise."""
        rng = np.random.default_rng(seed)
        low, high = self.outline.min(axis=0), self.outline.max(axis=0)
        xy = rng.uniform(low, high, (round(np.prod(high - low) * density), 2))
        xy = xy[is_inside(xy, [self.ring])]
        z = self.top(*xy.T) + rng.normal(0, noise, len(xy))
        return np.column_stack([moved(xy, turn, origin), z]), moved(self.ring, turn, origin)


def moved(xy, turn, origin):
    """Return places turned about the zero (°) and then moved."""
    c, s = np.cos(np.deg2rad(turn)), np.sin(np.deg2rad(turn))
    return np.asarray(xy)[:, :2] @ np.array([[c, s], [-s, c]]) + origin


def _box(w, d):
    return rectangle(0.0, 0.0, w, d)[:4]


def _over(outline, top, more, kind):
    """Return a shape whose corners are the outline's and ``more`` places (x, y) or (x, y, z)."""
    corners = [(x, y, float(top(np.array(x), np.array(y)))) for x, y in outline]
    corners += [place if len(place) == 3 else (*place, float(top(*map(np.array, place)))) for place in more]
    return RoofShape(outline, top, np.array(corners, float), kind)


def _dormer(x, y):
    main = 4 + 0.8 * np.minimum(y, 8 - y)
    is_dormer = (np.abs(x - 6) < 1) & (y > 0.6) & (y < 2.875)
    return np.where(is_dormer, np.maximum(main, 6.3), main)


def _lowest(*planes):
    return lambda x, y: np.min([plane(x, y) for plane in planes], axis=0)


def _in_l(x, y):
    """Return an L of two gables of one ridge height that cross: a wing of 6 m across the end of a house of 6 m."""
    house = 4 + 0.7 * np.minimum(y, 6 - y)
    wing = np.where((x <= 6) | (y > 6), 4 + 0.7 * np.minimum(x, 6 - x), -9.0)
    return np.where(y > 6, wing, np.maximum(house, wing))


def _in_t(x, y):
    """Return a T: a lower wing of 5 m on the middle of a house."""
    house = np.where(y <= 7, 4 + 0.8 * np.minimum(y, 7 - y), -9.0)
    return np.maximum(house, np.where((x >= 4) & (x <= 9), 4 + 0.8 * np.minimum(x - 4, 9 - x), -9.0))


_L = np.array([[0, 0], [14, 0], [14, 6], [6, 6], [6, 13], [0, 13]], float)
_T = np.array([[0, 0], [13, 0], [13, 7], [9, 7], [9, 12], [4, 12], [4, 7], [0, 7]], float)

SHAPES = {
    "flat": _over(_box(12, 8), lambda x, y: 6 + 0 * x, [], "flat"),
    "shed": _over(_box(10, 6), lambda x, y: 3 + 0.3 * y, [], "shed"),
    "gable": _over(
        _box(12, 8), _lowest(lambda x, y: 4 + 0.8 * y, lambda x, y: 4 + 0.8 * (8 - y)), [(0, 4), (12, 4)], "gable"
    ),
    "steep gable": _over(
        _box(9, 6), _lowest(lambda x, y: 3 + 1.5 * y, lambda x, y: 3 + 1.5 * (6 - y)), [(0, 3), (9, 3)], "gable"
    ),
    "hip": _over(_box(12, 8), lambda x, y: 4 + 0.7 * np.min([x, 12 - x, y, 8 - y], axis=0), [(4, 4), (8, 4)], "hip"),
    "tent": _over(_box(8, 8), lambda x, y: 4 + 0.9 * np.min([x, 8 - x, y, 8 - y], axis=0), [(4, 4)], "hip"),
    "half-hip": _over(
        _box(12, 8),
        lambda x, y: 4 + np.minimum(0.8 * np.minimum(y, 8 - y), 1.6 + 0.8 * np.minimum(x, 12 - x)),
        [(0, 2), (0, 6), (12, 2), (12, 6), (2, 4), (10, 4)],
        "hip",
    ),
    "mansard": _over(
        _box(12, 8),
        lambda x, y: 4 + np.min([2 * y, 2 * (8 - y), 2.4 + 0.4 * y, 2.4 + 0.4 * (8 - y)], axis=0),
        [(0, 1.5), (0, 6.5), (12, 1.5), (12, 6.5), (0, 4), (12, 4)],
        "mansard",
    ),
    "L": _over(_L, _in_l, [(14, 3), (3, 3), (3, 13), (0, 3), (3, 0)], "other"),
    "T": _over(_T, _in_t, [(0, 3.5), (13, 3.5), (6.5, 12), (6.5, 4.5)], "other"),
    "dormer": _over(
        _box(12, 8),
        _dormer,
        [
            *((0, 4), (12, 4)),
            *((x, y, z) for x in (5, 7) for y, z in ((0.6, 4.48), (0.6, 6.3), (2.875, 6.3))),
        ],
        "gable",
    ),
    "steps": _over(
        _box(15, 8),
        lambda x, y: np.where(x < 5, 3.5, np.where(x < 10, 6.5, 9.5)),
        [(5, 0, 6.5), (5, 8, 6.5), (10, 0, 9.5), (10, 8, 9.5), (5, 0, 3.5), (5, 8, 3.5), (10, 0, 6.5), (10, 8, 6.5)],
        "stepped flat",
    ),
}
