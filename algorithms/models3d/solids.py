"""Closed solids: vertices, and faces by kind."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ..geometry.groups import components

ROOF, WALL, GROUND, SOFFIT, TERRAIN = "roof", "wall", "ground", "soffit", "terrain"
WINDOW, DOOR = "window", "door"

# Positions have as many decimals (m) as files: a corner that rounding moves by half a tenth of a millimeter turns a
# triangle 5 mm high by less than a degree.
DECIMALS = 4

# The step (m) of positions.
RESOLUTION = 10.0**-DECIMALS

Ring = list[int]


@dataclass
class Solid:
    """A closed surface."""

    vertices: np.ndarray  #: (n, 3): positions (m)
    #: The rings of each face, exterior first: counterclockwise seen from outside the solid, holes clockwise; open (the
    #: last vertex is not the first one again)
    faces: list[list[Ring]] = field(default_factory=list)
    kinds: list[str] = field(default_factory=list)  #: Kind of each face, as "roof"
    planes: list[int] = field(default_factory=list)  #: Plane of each roof face, -1 for other faces

    @cached_property
    def normals(self) -> np.ndarray:
        """Vectors (faces, 3) across the faces, outward, as long as their areas (m²)."""
        rings = [ring for rings in self.faces for ring in rings]
        length = np.array([len(ring) for ring in rings])
        corner = self.vertices[np.concatenate(rings)]
        start = np.cumsum(length) - length
        offset = corner - corner[np.repeat(start, length)]
        following = np.arange(1, len(corner) + 1)
        following[start + length - 1] = start
        x, y, z = offset.T
        u, v, w = offset[following].T
        across = 0.5 * np.column_stack([y * w - z * v, z * u - x * w, x * v - y * u])
        first = np.cumsum([0, *(len(rings) for rings in self.faces[:-1])])
        return np.add.reduceat(across, start[first], axis=0)

    @property
    def volume(self) -> float:
        """Volume (m³)."""
        corner = self.vertices[[rings[0][0] for rings in self.faces]] - self.vertices.mean(axis=0)
        return float(np.einsum("ij,ij->", corner, self.normals)) / 3


def edges_around(ring: Ring) -> list[tuple[int, int]]:
    """Return the edges of an open ring, as pairs of vertices."""
    return list(zip(ring, [*ring[1:], *ring[:1]]))


def groups_of(pairs: list[tuple[int, int]], count: int) -> list[int]:
    """Return the group of each of ``count`` items that pairs hold together, from 0."""
    one, other = np.array(pairs, int).reshape(-1, 2).T
    return components(one, other, count)[1].tolist()
