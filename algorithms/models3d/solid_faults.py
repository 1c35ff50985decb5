"""Faults of a solid, by the rules of ISO 19107, and in which of its faces they are."""

from collections import defaultdict
from collections.abc import Iterable, Iterator

import numpy as np

from ..criteria import MILLIMETER
from ..geometry.polygon_overlap import are_within
from ..geometry.polygons import axes_across
from ..geometry.rings import edge_distances, nearest_edge_distances, sides_of_rings, signed_area
from ..packages import spatial
from ..rules import rules
from .face_triangles import triangulate_face
from .solids import Ring, Solid, edges_around, groups_of


@rules
class RULES:
    """How exact a solid has to be."""

    #: Tolerance (m) of corners from the plane of their face: the default of val3dity
    off_plane: float = 0.01
    #: Triangles of a face turn by no more than this (°): ten times less than val3dity's default of 20°. A corner off
    #: the plane turns a triangle by its distance over the height of the triangle.
    turn: float = 2.0
    folded: float = 0.1  #: Faces that share an edge are at least this far (°) from lying on each other


def fault_of(solid: Solid) -> str:
    """Return the first fault of a solid, "" where it is valid."""
    return next(iter(faults_of(solid).values()), "")


def faults_of(solid: Solid) -> dict[int, str]:
    """Return the first fault of each face of a solid; empty where it is valid.

    Notes
    -----
    The rules are those that val3dity documents as errors 101 to 405, of solids with one shell. Geometry is looked at
    where the topology is sound.

    References
    ----------
    Ledoux, H., 2018. val3dity: validation of 3D GIS primitives according to the international standards. Open
    Geospatial Data, Software and Standards 3(1). [ledoux2018]
    """
    found: dict[int, str] = {}
    for check in (_ring_faults, _edge_faults, _shell_faults, _corner_faults):
        for face, fault in check(solid):
            found.setdefault(face, fault)
        if found:
            return found
    faces = [_Face(solid, face) for face in range(len(solid.faces))]
    found = {one.number: fault for one in faces if (fault := one.fault())}
    found = found or _fan_faults(faces) or _meeting_faults(solid, faces)
    return found or ({0: "the faces look inward"} if solid.volume <= 0 else {})


def _edges(rings: Iterable[Ring]) -> list[tuple[int, int]]:
    return [edge for ring in rings for edge in edges_around(ring)]


def _ring_faults(solid: Solid) -> Iterator[tuple[int, str]]:
    """Yield faces with a ring of fewer than three corners, or one that comes to a corner twice."""
    for face, rings in enumerate(solid.faces):
        if not rings or any(len(ring) < 3 or len(set(ring)) != len(ring) for ring in rings):
            yield face, "a ring is degenerate"


def _edge_faults(solid: Solid) -> Iterator[tuple[int, str]]:
    """Yield faces with an edge that has not exactly two faces, one in each direction."""
    faces_of: dict[tuple[int, int], list[int]] = defaultdict(list)
    for face, rings in enumerate(solid.faces):
        for edge in _edges(rings):
            faces_of[edge].append(face)
    for (a, b), faces in faces_of.items():
        if len(faces) > 1:
            yield from ((face, "an edge has more than two faces") for face in faces)
        if (b, a) not in faces_of:
            yield faces[0], "the surface is open"


def _shell_faults(solid: Solid) -> Iterator[tuple[int, str]]:
    """Yield the faces of all pieces but the largest one; the first face where a solid has fewer than four."""
    if len(solid.faces) < 4:
        yield 0, "there are fewer than four faces"
        return
    owner = {edge: face for face, rings in enumerate(solid.faces) for edge in _edges(rings)}
    piece = groups_of([(face, owner[b, a]) for (a, b), face in owner.items()], len(solid.faces))
    largest = int(np.argmax(np.bincount(piece)))
    yield from ((face, "it is in pieces") for face, number in enumerate(piece) if number != largest)


def _corner_faults(solid: Solid) -> Iterator[tuple[int, str]]:
    """Yield the faces at corners that are nearer to each other than programs resolve."""
    close = spatial.cKDTree(solid.vertices).query_pairs(MILLIMETER, output_type="ndarray")
    if len(close):
        corners = set(close.ravel().tolist())
        for face, rings in enumerate(solid.faces):
            if any(not corners.isdisjoint(ring) for ring in rings):
                yield face, "two corners are too close"


class _Face:
    """A face in its plane: the corners of its edges (k, 2) in two axes, and how far they are off the plane (m)."""

    def __init__(self, solid: Solid, number: int) -> None:
        self.number, self.rings, self.vertices = number, solid.faces[number], solid.vertices
        self.edge = np.array(_edges(self.rings))
        vector = solid.normals[number]
        self.area = float(np.linalg.norm(vector))
        self.normal = vector / self.area if self.area > 0 else np.eye(3)[2]
        corners = solid.vertices[self.edge[:, 0]]
        self.center = corners.mean(axis=0)
        self.axes = np.column_stack(axes_across(self.normal))
        self.start = self.in_plane(corners)
        self.end = self.in_plane(solid.vertices[self.edge[:, 1]])
        self.off = float(np.abs((corners - self.center) @ self.normal).max())
        self.low, self.high = corners.min(axis=0), corners.max(axis=0)

    def in_plane(self, xyz: np.ndarray) -> np.ndarray:
        """Return positions (n, 2) in the axes of the plane."""
        return (xyz - self.center) @ self.axes

    def fault(self) -> str:
        """Return a fault of the face by itself, "" without one."""
        if self.area < MILLIMETER**2:
            return "a face has no area"
        if self.off > RULES.off_plane:
            return "a face is not plane"
        width = self._least_width()
        if width < MILLIMETER:
            return "edges of a face touch"
        if len(self.edge) == 3:
            return ""
        if self._crosses_itself():
            return "edges of a face cross"
        fault = self._ring_fault() if len(self.rings) > 1 else ""
        if not fault and self._has_turned_triangle(width):
            return "triangles of a face are not plane"
        return fault

    def _least_width(self) -> float:
        """Return the least distance (m) of a corner to an edge that does not end in it."""
        distance = edge_distances(self.start, self.start, self.end)
        ends_there = (self.edge[:, :1] == self.edge[None, :, 0]) | (self.edge[:, :1] == self.edge[None, :, 1])
        return float(np.min(distance, initial=np.inf, where=~ends_there))

    def _has_turned_triangle(self, width: float) -> bool:
        """Return whether a triangle of the face turns too far from it, where it is ``width`` (m) wide everywhere."""
        longest = float(np.hypot(*np.ptp(self.start, axis=0)))
        # No triangle is lower than width² / longest: a short edge seen from the other end of a strip makes the lowest.
        if 2 * self.off * longest <= width**2 * np.tan(np.deg2rad(RULES.turn)):
            return False
        corner = self.vertices[np.array(triangulate_face(self.vertices, self.rings))]
        across = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        length = np.sqrt((across**2).sum(axis=1))
        return bool((across @ self.normal < length * np.cos(np.deg2rad(RULES.turn))).any())

    def _crosses_itself(self) -> bool:
        """Return whether edges that have no corner in common cross."""
        step = self.end - self.start

        def side(positions: np.ndarray) -> np.ndarray:
            """Return on which side of each edge (k, 1) each position (k,) is, as an area."""
            offset = positions[None] - self.start[:, None]
            return step[:, None, 0] * offset[..., 1] - step[:, None, 1] * offset[..., 0]

        parts = side(self.start) * side(self.end) < 0
        apart = (self.edge[:, None, :, None] != self.edge[None, :, None, :]).all(axis=(2, 3))
        return bool((parts & parts.T & apart).any())

    def _ring_fault(self) -> str:
        """Return a fault of the exterior and the holes, "" where each hole lies inside by itself."""
        first = np.cumsum([0, *(len(ring) for ring in self.rings)])
        plans = [self.start[[*range(a, b), a]] for a, b in zip(first, first[1:])]
        areas = list(map(signed_area, plans))
        if areas[0] <= 0 or max(areas[1:]) >= 0:
            return "a ring of a face runs the wrong way"
        for number, hole in enumerate(plans[1:], start=1):
            # Holes may touch other rings in one corner.
            inside = [are_within(hole[:-1], sides_of_rings([plan])).sum() for plan in plans]
            if inside[0] < len(hole) - 2 or any(n > 1 for k, n in enumerate(inside) if k not in (0, number)):
                return "a hole of a face is not inside it"
        return "holes divide a face" if self._is_divided() else ""

    def _is_divided(self) -> bool:
        """Return whether rings that touch in corners go around a part of the face."""
        rings_at: dict[int, list[int]] = defaultdict(list)
        for number, ring in enumerate(self.rings):
            for corner in ring:
                rings_at[corner].append(number)
        links = [(ring, len(self.rings) + k) for k, at in enumerate(rings_at.values()) if len(at) > 1 for ring in at]
        count = len(self.rings) + len(rings_at)
        # Each tree of a forest has one link less than nodes.
        return len(links) > count - 1 - max(groups_of(links, count))

    def holds(self, xyz: np.ndarray) -> np.ndarray:
        """Return the mask of positions (n,) of the plane in the face, farther from its edges than corners may be."""
        plan = self.in_plane(xyz)
        inside = are_within(plan, np.stack([self.start, self.end], axis=1))
        return inside & (nearest_edge_distances(plan, self.start, self.end) > MILLIMETER)


def _fan_faults(faces: list[_Face]) -> dict[int, str]:
    """Return the faces at corners in which surfaces only touch."""
    following: dict[int, dict[int, int]] = defaultdict(dict)
    at: dict[int, list[int]] = defaultdict(list)
    for face in faces:
        for corner, ways in _sectors(face).items():
            following[corner].update(ways)
            at[corner].append(face.number)
    found = {}
    for corner, ways in following.items():
        start = next(iter(ways))
        count, way = 1, ways[start]
        while way != start and count <= len(ways):
            count, way = count + 1, ways[way]
        if count != len(ways):
            found.update(dict.fromkeys(at[corner], "faces only touch in a corner"))
    return found


def _sectors(face: _Face) -> dict[int, dict[int, int]]:
    """Return the sectors of a face by their corner: the corner after it and, for each of these, the one before it.

    Where two rings touch in a corner the face has two sectors there. Each reaches from the next corner of one ring
    counterclockwise to the nearest corner before, which may be of the other ring.
    """
    ends: dict[int, dict[int, int]] = defaultdict(dict)
    for ring in face.rings:
        for before, corner, after in zip([ring[-1], *ring[:-1]], ring, [*ring[1:], ring[0]]):
            ends[corner][after] = before
    position = dict(zip(face.edge[:, 0].tolist(), face.start))
    for corner, ways in ends.items():
        if len(ways) > 1:
            befores = list(ways.values())
            angle = {
                other: float(np.arctan2(*(position[other] - position[corner])[::-1])) for other in (*ways, *befores)
            }
            for after in ways:
                ways[after] = min(befores, key=lambda before: (angle[before] - angle[after]) % (2 * np.pi))
    return ends


def _meeting_faults(solid: Solid, faces: list[_Face]) -> dict[int, str]:
    """Return the faces that lie on a neighbor, and those that an edge of others runs through or lies in."""
    owner = {tuple(edge): face for face in faces for edge in face.edge.tolist()}
    pairs = [(a, b) for a, b in owner if a < b]
    edge = np.array(pairs)
    found = {}
    normal = np.array([[owner[a, b].normal, owner[b, a].normal] for a, b in pairs])
    along = solid.vertices[edge[:, 1]] - solid.vertices[edge[:, 0]]
    inward = np.cross(normal[:, 0], along), np.cross(normal[:, 1], -along)
    # Both faces lie to the same side of their edge where they are folded.
    cosine = np.einsum("ij,ij->i", *inward) / np.maximum((along**2).sum(axis=1), 1e-18)
    for row in np.flatnonzero(cosine > np.cos(np.deg2rad(RULES.folded))):
        a, b = pairs[row]
        found[owner[a, b].number] = found[owner[b, a].number] = "faces are folded"
    one, two = solid.vertices[edge[:, 0]], solid.vertices[edge[:, 1]]
    low, high = np.minimum(one, two), np.maximum(one, two)
    is_corner = np.zeros(len(solid.vertices), bool)
    for face in faces:
        near = np.flatnonzero((low <= face.high).all(axis=1) & (high >= face.low).all(axis=1))
        is_corner[face.edge[:, 0]] = True
        near = near[~is_corner[edge[near]].all(axis=1)]
        is_corner[face.edge[:, 0]] = False
        if len(near) and _is_crossed(face, one[near], two[near]):
            found[face.number] = "faces cross"
    return found


def _is_crossed(face: _Face, one: np.ndarray, two: np.ndarray) -> bool:
    """Return whether edges, by their ends (n, 3), run through a face or lie in it."""
    off_one, off_two = (one - face.center) @ face.normal, (two - face.center) @ face.normal
    far = np.minimum(np.abs(off_one), np.abs(off_two)) > MILLIMETER
    through = far & (off_one * off_two < 0)
    lies = np.maximum(np.abs(off_one), np.abs(off_two)) <= MILLIMETER
    share = np.where(through, off_one / np.where(through, off_one - off_two, 1.0), 0.5)
    rows = np.flatnonzero(through | lies)
    crossings = one[rows] + share[rows, None] * (two[rows] - one[rows])
    return bool(len(rows)) and bool(face.holds(crossings).any())
