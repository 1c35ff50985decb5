"""Parts of an industrial plant: surfaces with a kind, which can be sampled."""

from dataclasses import dataclass
from typing import Callable, Optional

import numpy as np

from ..geometry.polygons import axes_across
from ..shapes.searched_points import Shape

# Draws positions (k, 3) and outward normals (k, 3) of k random points on a surface.
Sampler = Callable[[np.random.Generator, int], tuple[np.ndarray, np.ndarray]]

# Distance between the bars of a grating (m).
_MESH = 0.04

# Height and thickness of the bars of a grating (m).
_BAR = (0.03, 0.004)


@dataclass(frozen=True)
class PlantPart:
    """One surface of a plant."""

    kind: str  #: "pipe", "tank", "sphere", "elbow", "flange", "beam", "grating", "roof", "floor" or "clutter"
    shape: int  #: Value of the dimension ``shape``
    area: float  #: Area, m²
    middle: np.ndarray  #: (3,): center (m)
    sample: Sampler  #: Draws points on the surface
    #: (2, 3): ends of the axis of a pipe or tank, or the center of a sphere in both rows (m)
    axis: Optional[np.ndarray] = None
    radius: float = 0.0  #: Radius of a pipe, tank or sphere (m), otherwise 0


def cylinder(kind: str, start: np.ndarray, end: np.ndarray, radius: float) -> PlantPart:
    """Return the lateral surface of a cylinder.

    Parameters
    ----------
    kind : str
        Kind of the part.
    start, end : ndarray of shape (3,)
        Centers of both ends, m.
    radius : float
        Radius, m.
    """
    length = float(np.linalg.norm(end - start))
    axis = (end - start) / length
    first, second = axes_across(axis)

    def sample(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
        angle = rng.uniform(0, 2 * np.pi, count)[:, None]
        away = np.cos(angle) * first + np.sin(angle) * second
        return start + rng.uniform(0, length, count)[:, None] * axis + radius * away, away

    shape = Shape.NONE if kind == "flange" else Shape.CYLINDER
    ends = np.array([start, end])
    return PlantPart(kind, shape, 2 * np.pi * radius * length, ends.mean(axis=0), sample, ends, radius)


def disk(kind: str, center: np.ndarray, normal: np.ndarray, inner: float, outer: float) -> PlantPart:
    """Return a disk or an annulus.

    Parameters
    ----------
    kind : str
        Kind of the part.
    center : ndarray of shape (3,)
        Center, m.
    normal : ndarray of shape (3,)
        Unit normal.
    inner, outer : float
        Radii, m.
    """
    first, second = axes_across(normal)

    def sample(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
        angle = rng.uniform(0, 2 * np.pi, count)[:, None]
        reach = np.sqrt(rng.uniform(inner**2, outer**2, count))[:, None]
        positions = center + reach * (np.cos(angle) * first + np.sin(angle) * second)
        return positions, np.broadcast_to(normal, positions.shape)

    shape = Shape.PLANE if kind == "roof" else Shape.NONE
    return PlantPart(kind, shape, float(np.pi * (outer**2 - inner**2)), center, sample)


def sphere(center: np.ndarray, radius: float) -> PlantPart:
    """Return a sphere with a center (3,) and radius, m."""

    def sample(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
        away = rng.normal(size=(count, 3))
        away /= np.linalg.norm(away, axis=1)[:, None]
        return center + radius * away, away

    return PlantPart("sphere", Shape.SPHERE, 4 * np.pi * radius**2, center, sample, np.array([center, center]), radius)


def elbow(start: np.ndarray, along: np.ndarray, toward: np.ndarray, bend: float, radius: float) -> PlantPart:
    """Return a quarter of a torus that connects two perpendicular pipes.

    Parameters
    ----------
    start : ndarray of shape (3,)
        End of the first pipe (m).
    along, toward : ndarray of shape (3,)
        Directions of the first and second pipe, unit vectors.
    bend, radius : float
        Radii of the bent axis and of the pipe, m.
    """
    center, side = start + bend * toward, np.cross(along, toward)

    def sample(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
        # The outside of a bend is longer: rejection sampling by area, from three times as many points as needed.
        turn, around, keep = rng.uniform(0, 1, (3, 3 * count))
        turn, around = turn * np.pi / 2, around * 2 * np.pi
        kept = np.flatnonzero(keep * (bend + radius) <= bend + radius * np.cos(around))[:count]
        turn, around = turn[kept, None], around[kept, None]
        outward = np.sin(turn) * along - np.cos(turn) * toward
        away = np.cos(around) * outward + np.sin(around) * side
        return center + bend * outward + radius * away, away

    return PlantPart("elbow", Shape.NONE, float(np.pi**2 * bend * radius), center, sample)


def plate(kind: str, corner: np.ndarray, first: np.ndarray, second: np.ndarray) -> PlantPart:
    """Return a thin plate, visible from both sides.

    Parameters
    ----------
    kind : str
        Kind of the part.
    corner, first, second : ndarray of shape (3,)
        A corner and the edges from it, m.
    """
    across = np.cross(first, second)
    area = float(np.linalg.norm(across))
    normal = across / area

    def sample(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
        share = rng.uniform(0, 1, (count, 2))
        side = np.where(rng.random(count) < 0.5, 1.0, -1.0)[:, None]
        # A plate is a centimeter thick.
        positions = corner + share[:, :1] * first + share[:, 1:] * second + 0.005 * side * normal
        return positions, side * normal

    return PlantPart(kind, Shape.PLANE, 2 * area, corner + (first + second) / 2, sample)


def beam(start: np.ndarray, end: np.ndarray, height: float, width: float, up: np.ndarray) -> list[PlantPart]:
    """Return the web and the two flanges of an I-beam.

    Parameters
    ----------
    start, end : ndarray of shape (3,)
        Centers of both ends, m.
    height, width : float
        Height of the profile and width of the flanges, m.
    up : ndarray of shape (3,)
        Direction of the web.
    """
    along = end - start
    side = np.cross(along, up)
    side *= width / np.linalg.norm(side)
    rise = up * height
    web = plate("beam", start - rise / 2, along, rise)
    return [web, *(plate("beam", start + sign * rise / 2 - side / 2, along, side) for sign in (-1, 1))]


def grating(corner: np.ndarray, first: np.ndarray, second: np.ndarray) -> PlantPart:
    """Return a level grating from a corner (3,) along two edges (3,), m: upright bars with gaps."""
    long, wide = float(np.linalg.norm(first)), float(np.linalg.norm(second))
    n_bars, (high, thick) = max(1, int(wide / _MESH)), _BAR

    def sample(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
        along = rng.uniform(0, 1, count)[:, None]
        bar = (rng.integers(0, n_bars, count) / n_bars)[:, None]
        down = rng.uniform(0, high, count)[:, None]
        side = np.where(rng.random(count) < 0.5, 1.0, -1.0)[:, None]
        positions = corner + along * first + bar * second + thick / 2 * side * second / wide - down * [0.0, 0.0, 1.0]
        return positions, side * second / wide

    return PlantPart("grating", Shape.NONE, 2 * n_bars * long * high, corner + (first + second) / 2, sample)


def heap(center: np.ndarray, size: float) -> PlantPart:
    """Return clutter in a ball of radius ``size`` (m): surfaces with random normals, like hoses and bushes."""

    def sample(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
        away, normal = rng.normal(size=(2, count, 3))
        away *= size * np.cbrt(rng.random((count, 1))) / np.linalg.norm(away, axis=1)[:, None]
        return center + away, normal / np.linalg.norm(normal, axis=1)[:, None]

    return PlantPart("clutter", Shape.NONE, 4 * np.pi * size**2, center, sample)
