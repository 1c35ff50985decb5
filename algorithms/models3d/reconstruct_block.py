"""A city block from the street and from the air: roofs, walls where they were seen, windows and doors."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..criteria import MAJORITY, SAME_WAY
from ..facades.facade_frame import frame_of
from ..facades.plan_segments import PlanSegments, facade_segments
from ..facades.street_walls import fitted_to_walls
from ..geometry.polygons import area_vector
from ..geometry.rings import are_inside, is_valid, nearest_edge_distances
from ..packages import spatial
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..stage import Field, InputLayer, Layer, LayerFeatures, Monitor, TextFile, stage, tunable
from . import cityjson
from .building_facts import BUILDING_FIELDS, ROOF_FIELDS, WALL_FIELDS, NamedModel, face_attributes, face_rings, faces_of
from .reconstruct_roofs import reconstruct_roofs
from .solid_faults import fault_of
from .solids import DOOR, WALL, WINDOW, Solid

# The level of detail with windows and doors, as CityJSON writes it.
LEVEL_OF_OPENINGS = "3"

# A wall of the model was seen from the street if the middle of its foot lies within this distance (m) of a facade:
# rounding, and the tilt of facades.
_ON_FACADE = 0.1

STREET, AIR = "street", "air"

BLOCK_WALL_FIELDS = (*WALL_FIELDS, Field("source", str, f"{STREET}: on a facade; {AIR}: on the outline of a footprint"))
OPENING_FIELDS = (
    Field("id", int, "number of the opening, from 1"),
    Field("building", str, "building that it is part of, as in the layer of buildings", of="footprints"),
    Field("kind", str, "window or door"),
    Field("width", float, "width", "m"),
    Field("height", float, "height", "m"),
    Field("sill", float, "height of its lower side over the ground of the building", "m"),
)

# Distance (m) of the middle of an opening from the plane of its wall, at most.
_OFF = 0.5

# Least distance (m) between an opening and the edge of its wall: thinner strips make no sound triangles.
_MARGIN = 0.03


@stage(
    "3D",
    tags="3D,LoD3,city block,street,facade,window,door,roof,solid,city model,CityJSON,mobile mapping,airborne,Peng",
    input_layers=(
        InputLayer("footprints", buildings=True),
        InputLayer("facades", upright=True),
        InputLayer("openings", "Windows and doors", upright=True),
    ),
    layers=(
        Layer("buildings", "Buildings", "Polygon", BUILDING_FIELDS, style="model_grounds"),
        Layer("walls", "Walls", "Polygon", BLOCK_WALL_FIELDS, style="model_walls"),
        Layer("roofs", "Roofs", "Polygon", ROOF_FIELDS, style="model_roofs"),
        Layer("set_openings", "Windows and doors of the model", "Polygon", OPENING_FIELDS, style="openings"),
    ),
    files=(TextFile("cityjson", "CityJSON", cityjson.FORMATS, cityjson.cityjson_pieces, NamedModel, "footprints"),),
    cost=70.0,
)
def reconstruct_block(
    xyz,
    classification,
    footprints,
    facades,
    openings,
    *,
    min_plane_area: float = tunable(1.5, within="[0.1, 1000] m²"),
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Model the buildings of a block with the walls, windows and doors that were seen from the street.

    The outline of each building follows the facades where they were seen: fronts, recesses, bays. Elsewhere it follows
    the footprint. Roofs are reconstructed on it, and windows and doors set into the walls.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m) of the airborne cloud.
    classification : ndarray of shape (n,)
        Its classes; points of class 6 are modelled, points of class 2 are the ground.
    footprints : LayerFeatures
        Outlines of the buildings, from the airborne cloud.
    facades : LayerFeatures
        Upright polygons of the walls seen from the street, in the frame of the cloud, as 'Register street scan' makes
        them.
    openings : LayerFeatures
        Polygons in the planes of the facades.

    Returns
    -------
    buildings, roofs : LayerFeatures
        As of "Reconstruct roofs", on the outlines that follow the facades.
    walls : LayerFeatures
        Walls with holes for their windows and doors, and whether each was seen from the street.
    set_openings : LayerFeatures
        Windows and doors as faces of the walls.
    cityjson : list of NamedModel
        The same for one file: CityJSON 2.0 with levels of detail 1.2, 1.3, 2.2 and, with ``Window`` and ``Door``
        surfaces, 3.

    Other Parameters
    ----------------
    min_plane_area
        Area of the smallest roof plane, seen from above.

    Raises
    ------
    ValueError
        If no point is called building, or none ground, or no footprint has an area.

    Notes
    -----
    A wall belongs to the nearest footprint within 1.6 m. An edge of the footprint up to 0.5 m before a wall is the
    outline of its eaves and moves onto it; walls with less than 3 m between them are joined. Of two parallel walls the
    outer one hides the end of the inner one, so the step between them is at the end of the outer one. A facade that
    ends near a corner of the footprint is the corner. Windows and doors lie in the plane of the wall, 3 cm from its
    edges at least; those that cross an edge of a wall are left out, and their number is reported.

    References
    ----------
    Peng, C., Yu, Z., 2018. Research on 3D building information extraction and image post-processing based on vehicle
    LIDAR. EURASIP Journal on Image and Video Processing 2018:121. [peng2018]
    CityJSON Specifications 2.0.1, section 3.3 (semantics of geometric primitives). [cityjson2024]

    Examples
    --------
    >>> from lidar_buildings.algorithms.stage import LayerFeatures
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 6, 2)
    >>> ring = np.array([[15, 16], [25, 16], [25, 24], [15, 24], [15, 16.0]])
    >>> house, none = LayerFeatures([[ring]], {}), LayerFeatures([], {})
    >>> buildings, walls, roofs, *_ = reconstruct_block(xyz, classes, house, none, none)
    >>> len(buildings), len(roofs)
    (1, 1)
    """
    segments = facade_segments(facades)
    fitted, seen = fitted_to_walls(footprints, segments)
    monitor.progress(0.1)
    buildings, _, roofs, _, models, _ = reconstruct_roofs(
        xyz, classification, fitted, min_plane_area=min_plane_area, sampling=sampling, monitor=monitor.part(0.1, 0.9)
    )
    pierced, done = _pierced(models, _openings(openings))
    if not len(segments):
        monitor.warn("No facade is an upright polygon with heights, so all walls are taken from footprints.")
    _inform(int((seen > 0).sum()), len(footprints), len(done), len(openings), monitor)
    return buildings, _walls(pierced, segments), roofs, _opening_layer(done), pierced


def _openings(features: LayerFeatures) -> list[WallOpening]:
    """Return windows and doors; what no attribute calls a door is a window. Polygons without heights are left out."""
    kinds = features.columns.get("kind", [WINDOW] * len(features))
    return [
        WallOpening(number, DOOR if kind == DOOR else WINDOW, np.asarray(rings[0], float)[:-1])
        for number, (rings, kind) in enumerate(zip(features.geometries, kinds), start=1)
        if np.asarray(rings[0]).shape[1] == 3
    ]


def _pierced(models: list[NamedModel], openings: list[WallOpening]) -> tuple[list[NamedModel], list[tuple]]:
    """Return the models with a level of detail that has openings, and each opening that was set with its model."""
    pierced, done, left = [], [], openings
    for one in models:
        solids = []
        for solid in one.model.best:
            made, found = with_openings(solid, left)
            if found and fault_of(made):
                made, found = solid, []
            solids.append(made)
            done += [(one, opening) for opening in found]
            taken = {opening.number for opening in found}
            left = [opening for opening in left if opening.number not in taken]
        pierced.append(replace(one, model=replace(one.model, solids={**one.model.solids, LEVEL_OF_OPENINGS: solids})))
    return pierced, done


def _inform(n_fitted: int, n_footprints: int, n_set: int, n_openings: int, monitor: Monitor) -> None:
    """Say how many footprints follow facades, and how many openings were set."""
    monitor.inform(f"{n_fitted} of {n_footprints} footprints follow facades; {n_set} of {n_openings} openings are set.")
    if n_set < n_openings:
        monitor.warn(
            f"{n_openings - n_set} of {n_openings} windows and doors lie in no wall of a model and are left out."
        )


def _walls(models: list[NamedModel], segments: PlanSegments) -> LayerFeatures:
    """Return the walls of models with the holes of their openings."""
    walls = [
        (face_rings(solid, face), {**face_attributes(one, solid, face), "source": _wall_source(solid, face, segments)})
        for one in models
        for solid, face in faces_of(one.model.solids[LEVEL_OF_OPENINGS], WALL)
    ]
    return LayerFeatures.numbered(walls, BLOCK_WALL_FIELDS)


def _wall_source(solid: Solid, face: int, segments: PlanSegments) -> str:
    """Return whether a wall was seen from the street."""
    ring = solid.vertices[solid.faces[face][0]][:, :2]
    middle = (ring.min(axis=0) + ring.max(axis=0)) / 2
    if not len(segments):
        return AIR
    return STREET if nearest_edge_distances(middle[None], segments.start, segments.end)[0] <= _ON_FACADE else AIR


def _opening_layer(done: list[tuple]) -> LayerFeatures:
    """Return windows and doors as polygons."""
    features = []
    for one, opening in done:
        ring = opening.ring
        facts = {
            "building": one.name,
            "kind": opening.kind,
            "width": float(spatial.distance.pdist(ring[:, :2]).max()),
            "height": float(np.ptp(ring[:, 2])),
            "sill": float(ring[:, 2].min() - one.model.base),
        }
        features.append(([np.concatenate([ring, ring[:1]])], facts))
    return LayerFeatures.numbered(features, OPENING_FIELDS)


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
