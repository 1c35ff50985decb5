"""The terrain around buildings: triangles that end at their walls, and walls that end on these triangles."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from ..criteria import MICROMETER
from ..geometry.groups import components, items, split_groups, topmost
from ..geometry.polygon_overlap import are_in_polygons, as_polygons
from ..geometry.polylines import simplify
from ..geometry.rings import nearest_edge_distances
from ..geometry.tiled_tin import TiledTin
from ..packages import spatial
from ..stage import Field, LayerFeatures, Monitor
from .building_facts import NamedModel, face_rings, faces_of
from .face_triangles import triangulate_face
from .solid_faults import fault_of
from .solids import DECIMALS, GROUND, ROOF, TERRAIN, Solid, edges_around

# Side (m) of the patches in which terrain is triangulated. Their lattice is the coordinates', and each depends
# on what lies in it alone: all blocks of a survey make the same ones.
PATCH = 50.0

# Distance (m) between nodes on the sides of patches, and between positions on outlines at which terrain is measured.
_STEP = 2.0

# Positions nearer to each other, or to the side of an outline, than this (m) are one: footprints with a common wall are
# often a millimeter apart.
_SAME = 0.002

# Ground points nearer to an outline than this (m) are no nodes: the positions on the outline have their height.
_BESIDE = 0.3

# Pieces of outlines that are shorter (m) are not divided: outlines of footprints that overlap cross without a node.
_SHORTEST = 0.05

# Triangulations of a patch, at most; 10 to 20 are enough for nearly all.
_ROUNDS = 40

TERRAIN_FIELDS = (
    Field("id", int, "number of the triangle, from 1"),
    Field("patch", str, f"square of {PATCH:g} m that it lies in, by its column and row"),
)


@dataclass(frozen=True)
class Terrain:
    """Triangles of the terrain outside buildings: nodes (n, 3), m, and their numbers (f, 3) by name of the patch."""

    nodes: np.ndarray
    patches: dict[str, np.ndarray]

    def models(self) -> list[NamedModel]:
        """Return the patches as items of files."""
        return [NamedModel.of_triangles(name, self.nodes[facets]) for name, facets in self.patches.items()]


def terrain_layer(patches: Iterable[NamedModel]) -> LayerFeatures:
    """Return the triangles of patches."""
    faces = [(one, solid, face) for one in patches for solid, face in faces_of(one.model.best, TERRAIN)]
    features = [(face_rings(solid, face), {"patch": one.name}) for one, solid, face in faces]
    return LayerFeatures.numbered(features, TERRAIN_FIELDS)


def triangulate_terrain(ground: np.ndarray, models: list[NamedModel], tolerance: float, monitor: Monitor) -> Terrain:
    """Return the terrain with the lower edges of all models as edges, and none below models.

    Parameters
    ----------
    ground : ndarray of shape (n, 3)
        Ground points, m.
    models : list of NamedModel
        Buildings on level ground.
    tolerance : float
        Height (m) by which ground points and outlines are above or below their triangles, at most.
    monitor : Monitor
        Receives progress.

    Notes
    -----
    Each patch begins with the outlines and nodes on its sides. The worst point of each triangle becomes a node until
    all are within the tolerance. A piece of an outline that is no edge of the Delaunay triangulation is divided across
    from the node in its way.

    References
    ----------
    Garland, M., Heckbert, P. S., 1995. Fast polygonal approximation of terrains and height fields. [garland1995]
    """
    lines = list(_base_lines(models))
    plan, pieces = _noded(lines, np.unique(_cells(np.concatenate([ground[:, :2], *lines])), axis=0))
    surface, polygons = TiledTin(ground), as_polygons([one.rings for one in models])
    heights = surface.elevation(plan, monitor.part(0.0, 0.2))
    beyond = np.unique(pieces[np.isnan(heights[pieces])])
    heights[beyond] = ground[spatial.cKDTree(ground[:, :2]).query(plan[beyond])[1], 2]
    nodes = np.column_stack([plan, heights])
    along = _along(plan, pieces)
    along = np.column_stack([along, surface.elevation(along)])
    free = ground[~are_in_polygons(ground[:, :2], polygons, monitor.part(0.2, 0.3))]
    points, is_ground = np.concatenate([free, along]), np.arange(len(free) + len(along)) < len(free)
    cells, cell_of = np.unique(_cells(points), axis=0, return_inverse=True)
    cell_of_piece = _cells(plan[pieces].mean(axis=1))
    grown, count = [nodes], len(nodes)
    patches: dict[str, np.ndarray] = {}
    for number, (cell, rows) in enumerate(zip(cells, split_groups(cell_of.ravel(), len(cells)))):
        monitor.progress(0.3 + 0.7 * number / len(cells))
        near = pieces[(cell_of_piece == cell).all(axis=1)]
        is_free = np.isfinite(points[rows, 2])
        if len(near):
            is_free &= ~is_ground[rows] | (nearest_edge_distances(points[rows, :2], *plan[near.T]) > _BESIDE)
        is_own = (np.abs(plan - (cell + 0.5) * PATCH) <= 0.5 * PATCH + _SAME).all(axis=1) & np.isfinite(heights)
        own, shift = np.flatnonzero(is_own), np.append(cell * PATCH, 0.0)
        # Rounded, so that nodes on one circle have the same triangles wherever the origin of the coordinates is.
        begun, seen = (some.round(DECIMALS) for some in (nodes[own] - shift, points[rows[is_free]] - shift))
        local, facets = _patch(begun, np.searchsorted(own, near), seen, tolerance)
        facets = facets[~are_in_polygons(local[facets, :2].mean(axis=1) + shift[:2], polygons, Monitor())]
        numbers = np.append(own, count + np.arange(len(local) - len(own)))
        if len(facets):
            patches[f"{TERRAIN} {cell[0]:.0f} {cell[1]:.0f}"] = numbers[facets]
        grown.append(local[len(own) :] + shift)
        count += len(grown[-1])
    return Terrain(np.concatenate(grown).round(DECIMALS), patches)


def _cells(plan: np.ndarray) -> np.ndarray:
    """Return the column and row (n, 2) of the patch that each position lies in."""
    return np.floor(plan[:, :2] / PATCH)


def _base_lines(models: list[NamedModel]) -> Iterator[np.ndarray]:
    """Yield the lower edges of solids: their ends in plan, and where they cross the sides of patches (k, 2), m."""
    solids = [solid for one in models for some in one.model.solids.values() for solid in some]
    for solid, face in faces_of(solids, GROUND):
        for a, b in (edge for ring in solid.faces[face] for edge in edges_around(ring)):
            start, end = solid.vertices[[a, b], :2]
            shares = [0.0, 1.0]
            for axis in np.flatnonzero(start != end):
                low, high = np.sort([start[axis], end[axis]]) / PATCH
                sides = np.arange(np.floor(low) + 1, np.ceil(high)) * PATCH
                shares += ((sides - start[axis]) / (end - start)[axis]).tolist()
            line = start + np.sort(shares)[:, None] * (end - start)
            sides = np.round(line / PATCH) * PATCH
            line = np.where(np.abs(line - sides) < MICROMETER, sides, line)
            line[[0, -1]] = start, end
            yield line


def _noded(lines: list[np.ndarray], cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return nodes (n, 2), m, of lines and of the sides of patches, and the pieces (m, 2) of lines between nodes."""
    way, none = np.arange(0, PATCH + _STEP, _STEP), np.zeros(round(PATCH / _STEP) + 1)
    lines_of_sides = (way, none), (way, none + PATCH), (none, way), (none + PATCH, way)
    sides = np.concatenate([np.column_stack(side) for side in lines_of_sides])
    border = np.unique((cells[:, None] * PATCH + sides).reshape(-1, 2), axis=0)
    plan = np.concatenate([*lines, border])
    near = spatial.cKDTree(plan).query_pairs(_SAME, output_type="ndarray")
    group = components(near[:, 0], near[:, 1], len(plan))[1]
    ends = np.cumsum(list(map(len, lines)))
    start = np.setdiff1d(np.arange(len(plan) - len(border)), ends - 1)
    pieces = np.unique(np.sort(np.column_stack([group[start], group[start + 1]]), axis=1), axis=0)
    return plan[np.unique(group, return_index=True)[1]], pieces[pieces[:, 0] < pieces[:, 1]]


def _along(plan: np.ndarray, pieces: np.ndarray) -> np.ndarray:
    """Return positions (k, 2) on pieces between nodes, about one step apart."""
    start, end = plan[pieces.T]
    count = (np.linalg.norm(end - start, axis=1) / _STEP).astype(np.int64)
    piece, item = items(count)
    share = ((item + 1) / (count[piece] + 1))[:, None]
    return (1 - share) * start[piece] + share * end[piece]


def _patch(nodes: np.ndarray, pieces: np.ndarray, seen: np.ndarray, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the nodes of a patch with those that joined, and its triangles (f, 3), counterclockwise.

    ``pieces`` (m, 2) are nodes between which there is an edge; points ``seen`` (k, 3), m, are of the terrain.
    """
    # At the end of the cloud the sides of the patch have no height, and the triangles end with the points.
    both = np.concatenate([nodes, seen])
    if len(both) < 3 or np.linalg.matrix_rank(both[:, :2] - both[0, :2], _SAME) < 2:
        return nodes, np.zeros((0, 3), np.int64)
    rim = spatial.ConvexHull(both[:, :2]).vertices
    nodes = np.concatenate([nodes, both[rim[rim >= len(nodes)]]])
    for _ in range(_ROUNDS):
        mesh = spatial.Delaunay(nodes[:, :2])
        new, pieces = _divided(nodes, pieces, mesh.simplices)
        joining = np.concatenate([new, _worst(mesh, nodes, seen, tolerance)])
        nodes = np.concatenate([nodes, joining])
        if not len(joining):
            break
    facets = mesh.simplices
    u, v = (nodes[facets[:, k], :2] - nodes[facets[:, 0], :2] for k in (1, 2))
    return nodes, facets[u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] > MICROMETER]


def _worst(mesh, nodes: np.ndarray, points: np.ndarray, tolerance: float) -> np.ndarray:
    """Return the point farthest above or below each triangle, where that is farther than the tolerance."""
    facet = mesh.find_simplex(points[:, :2])
    points, facet = points[facet >= 0], facet[facet >= 0]
    to_weights = mesh.transform[facet]
    weights = np.einsum("nij,nj->ni", to_weights[:, :2], points[:, :2] - to_weights[:, 2])
    weights = np.column_stack([weights, 1 - weights.sum(axis=1)])
    off = np.abs(points[:, 2] - (nodes[mesh.simplices[facet], 2] * weights).sum(axis=1))
    rows = np.flatnonzero(off > tolerance)
    return points[rows[topmost(off[rows], facet[rows])]]


def _divided(nodes: np.ndarray, pieces: np.ndarray, facets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return new nodes (k, 3), and the pieces, of which those that are no edges are divided by a node."""
    sides = np.sort(facets[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    size = len(nodes)
    is_edge = np.isin(np.sort(pieces, axis=1) @ [size, 1], sides @ [size, 1])
    new: list[np.ndarray] = []
    made = pieces[is_edge].tolist()
    for a, b in pieces[~is_edge].tolist():
        way = nodes[b, :2] - nodes[a, :2]
        length = float(np.hypot(*way))
        share = (nodes[:, :2] - nodes[a, :2]) @ way / length**2
        off = np.abs((nodes[:, :2] - nodes[a, :2]) @ [way[1], -way[0]]) / length
        is_inside = (off**2 < share * (1 - share) * length**2) & (np.abs(share - 0.5) * length < 0.5 * length - _SAME)
        row = int(np.argmin(np.where(is_inside, off, np.inf)))
        position = nodes[a] + (share[row] if is_inside[row] else 0.5) * (nodes[b] - nodes[a])
        apart = np.linalg.norm(np.concatenate([nodes, *new])[:, :2] - position[:2], axis=1)
        at = int(np.argmin(apart))
        if apart[at] > _SAME and length > _SHORTEST:
            at = len(apart)
            new.append(position[None])
        is_divided = at not in (a, b) and (at == len(apart) or apart[at] <= _SAME)
        made += [[a, at], [at, b]] if is_divided else [[a, b]]
    return np.concatenate([np.zeros((0, 3)), *new]), np.reshape(made, (-1, 2)).astype(np.int64)


class _Foot:
    """Where the walls of solids end on a terrain."""

    def __init__(self, nodes: np.ndarray) -> None:
        self.nodes, self.tree = nodes, spatial.cKDTree(nodes[:, :2])

    def placed(self, one: NamedModel) -> NamedModel:
        """Return a model whose solids end on the terrain."""
        solids = {level: [self._on_terrain(solid) for solid in some] for level, some in one.model.solids.items()}
        rings = [np.column_stack([ring[:, :2], self._height(ring)]) for ring in one.rings]
        return replace(one, rings=rings, model=replace(one.model, solids=solids))

    def _height(self, plan: np.ndarray) -> np.ndarray:
        return self.nodes[self.tree.query(plan[:, :2])[1], 2]

    def _on_terrain(self, solid: Solid) -> Solid:
        """Return a solid whose lower edges are the terrain's, or a level ground under it where it has faults."""
        grounds = [ring for rings, kind in zip(solid.faces, solid.kinds) if kind == GROUND for ring in rings]
        on_roof = {v for rings, kind in zip(solid.faces, solid.kinds) if kind == ROOF for ring in rings for v in ring}
        base = sorted({v for ring in grounds for v in ring} - on_roof)
        # Nodes of a neighbor whose wall is a millimeter off bend this one. Where that is a fault, only their heights
        # count, but no three in line: rounding would turn them into a narrow triangle of any direction.
        for is_straight in (False, True):
            vertices = solid.vertices.copy()
            vertices[base, 2] = self._height(vertices[base])
            below: dict[tuple[int, int], list[int]] = {}
            for a, b in (edge for ring in grounds for edge in edges_around(ring)):
                new = self._between(vertices[a], vertices[b], is_straight)
                below[a, b] = list(range(len(vertices), len(vertices) + len(new)))
                below[b, a] = below[a, b][::-1]
                vertices = np.concatenate([vertices, new])
            made = _parted(solid, vertices, below)
            if not fault_of(made):
                return made
        level = solid.vertices.copy()
        level[base, 2] = min(level[base, 2].min(), vertices[base, 2].min(), *vertices[len(level) :, 2])
        return replace(solid, vertices=level)

    def _between(self, start: np.ndarray, end: np.ndarray, is_straight: bool) -> np.ndarray:
        """Return the nodes (k, 3) of the terrain on the line between two positions (3,), in order."""
        way = (end - start)[:2]
        length = float(np.hypot(*way))
        nodes = self.nodes[self.tree.query_ball_point((start + end)[:2] / 2, length / 2)]
        along, across = np.array([way, [way[1], -way[0]]]) @ (nodes[:, :2] - start[:2]).T / length
        is_between = (along > _SAME) & (along < length - _SAME) & (np.abs(across) <= _SAME)
        order = np.flatnonzero(is_between)[np.argsort(along[is_between])]
        nodes, along = nodes[order], along[order]
        if is_straight:
            nodes[:, :2] = (start[:2] + along[:, None] * way / length).round(DECIMALS)
            line = np.column_stack([[0.0, *along, length], [start[2], *nodes[:, 2], end[2]]])
            nodes = nodes[simplify(line, _SAME, is_closed=False)[1:-1] - 1]
        return nodes


def _parted(solid: Solid, vertices: np.ndarray, below: dict[tuple[int, int], list[int]]) -> Solid:
    """Return a solid with these vertices, some of them on its lower edges, and its ground in triangles."""
    made = Solid(vertices)
    for rings, kind, plane in zip(solid.faces, solid.kinds, solid.planes):
        faces = [[[v for a, b in edges_around(ring) for v in (a, *below.get((a, b), ()))] for ring in rings]]
        if kind == GROUND:
            faces = [[ring] for ring in triangulate_face(vertices * [1, 1, 0], faces[0])]
        made.faces += faces
        made.kinds += [kind] * len(faces)
        made.planes += [plane] * len(faces)
    return made


def on_terrain(models: list[NamedModel], terrain: Terrain) -> list[NamedModel]:
    """Return models whose walls end on the terrain."""
    # On the sides of patches beyond the cloud are nodes without a height.
    foot = _Foot(terrain.nodes[np.isfinite(terrain.nodes[:, 2])])
    return [foot.placed(one) for one in models]
