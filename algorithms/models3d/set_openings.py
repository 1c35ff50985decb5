"""Windows and doors as faces of their own in the walls of a solid: level of detail 3."""

from dataclasses import dataclass

import numpy as np

from ..criteria import MAJORITY, SAME_WAY
from ..facades.facade_frame import frame_of
from ..geometry.polygons import area_vector
from ..geometry.rings import are_inside, is_valid
from .solids import WALL, Solid

WINDOW, DOOR = "window", "door"

# Distance (m) of the middle of an opening from the plane of its wall, at most.
_OFF = 0.5

# Least distance (m) between an opening and the edge of its wall: thinner strips make no sound triangles.
_MARGIN = 0.03


@dataclass(frozen=True)
class WallOpening:
    """A window or door: number, kind and open ring (m, 3), counterclockwise seen from outside, m."""

    number: int
    kind: str
    ring: np.ndarray


def with_openings(solid: Solid, openings: list[WallOpening]) -> tuple[Solid, list[WallOpening]]:
    """Return a solid with the openings that lie in its walls as faces, and those openings as they were set.

    A wall gets a hole for each, which the face of the opening closes: the solid stays closed. ``planes`` of these faces
    are the numbers of the openings.
    """
    vertices = [tuple(row) for row in solid.vertices.tolist()]
    faces, kinds, planes = [list(rings) for rings in solid.faces], list(solid.kinds), list(solid.planes)
    walls = [_Wall(solid, face) for face, kind in enumerate(solid.kinds) if kind == WALL]
    done = []
    for opening in openings:
        wall, flat = _best_wall(walls, opening)
        if wall is None:
            continue
        ring = wall.frame.space(flat)
        numbers = list(range(len(vertices), len(vertices) + len(ring)))
        vertices += [tuple(row) for row in ring.tolist()]
        wall.rings.append(np.concatenate([flat[::-1], flat[-1:]]))
        faces[wall.face].append(numbers[::-1])
        faces.append([numbers])
        kinds.append(opening.kind)
        planes.append(opening.number)
        done.append(WallOpening(opening.number, opening.kind, ring))
    return Solid(np.array(vertices), faces, kinds, planes), done


class _Wall:
    """An upright face of a solid, in its own plane: along and up it."""

    def __init__(self, solid: Solid, face: int) -> None:
        normal = solid.normals[face]
        self.face = face
        self.frame = frame_of(solid.vertices[solid.faces[face][0][0]], normal / np.linalg.norm(normal))
        self.rings = [self.flat(solid.vertices[[*ring, ring[0]]]) for ring in solid.faces[face]]

    def flat(self, positions: np.ndarray) -> np.ndarray:
        """Return positions (m, 2) along and up the wall of positions (m, 3)."""
        return self.frame.local(positions)[:, :2]


def _best_wall(walls: list[_Wall], opening: WallOpening) -> tuple:
    """Return the nearest wall that an opening can be set into, and its open ring (m, 2) there; None without any."""
    normal = area_vector(opening.ring)
    normal /= np.linalg.norm(normal)
    middle = opening.ring.mean(axis=0)
    off = [abs(float((middle - wall.frame.origin) @ wall.frame.normal)) for wall in walls]
    for number in np.argsort(off):
        wall = walls[number]
        if off[number] > _OFF:
            break
        if normal @ wall.frame.normal >= np.cos(np.radians(SAME_WAY)):
            flat = _cut_back(wall.rings, wall.flat(opening.ring))
            if flat is not None:
                return wall, flat
    return None, None


def _cut_back(rings: list[np.ndarray], flat: np.ndarray):
    """Return the open ring (m, 2) of an opening within the rings of a wall; None if it doesn't lie in it."""
    outer = rings[0]
    low, high = outer.min(axis=0) + _MARGIN, outer.max(axis=0) - _MARGIN
    inner = np.clip(flat, low, high)
    kept = np.ptp(inner, axis=0).prod() / max(np.ptp(flat, axis=0).prod(), 1e-9)
    # An opening is cut to its wall only if most of it lies there.
    if kept < MAJORITY or not are_inside(inner, outer).all():
        return None
    closed = np.concatenate([inner[::-1], inner[-1:]])
    return inner if is_valid([outer, *rings[1:], closed]) else None
