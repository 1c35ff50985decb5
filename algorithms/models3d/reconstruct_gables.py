"""Gable houses of ten vertices and fifteen parameters, from two roof planes, the eaves and the ground."""

from dataclasses import dataclass, replace
from typing import Optional

import numpy as np

from ..cloud.asprs import PointClass
from ..footprints.footprint_points import ground_beside
from ..geometry.groups import members
from ..geometry.polygons import area_vector, line_of_planes
from ..geometry.rings import sampled_rings
from ..packages import spatial
from ..planes.least_squares_planes import Planes, planes_of
from ..stage import Field, Layer, LayerFeatures, Monitor, TextFile, stage, tunable
from . import cityjson
from .building_facts import FLAT, NamedModel
from .building_models import BuildingModel
from .solids import GROUND, ROOF, WALL, Solid

# Both planes of a gable rise toward each other within this angle (°), so that their ridge is nearly level.
_OPPOSITE = 15.0

# Edges of a roof lie at the quantile of its points that leaves out this share, so that stray points do not move them.
# For evenly spread points the same share of the width lies beyond, and is added.
_EDGE = 0.02

# The faces of a house by their vertices, from 1 as in the paper, counterclockwise seen from outside.
_FACES = (
    *((ROOF, face) for face in ((3, 4, 2, 1), (5, 6, 1, 2))),
    *((WALL, face) for face in ((7, 8, 4, 3), (8, 9, 5, 2, 4), (9, 10, 6, 5), (10, 7, 3, 1, 6))),
    (GROUND, (10, 9, 8, 7)),
)

# Distance (m) within which the ground next to an eave is seen from the air: eaves overhang walls by a meter at most.
_BESIDE = 2.0

GABLE_FIELDS = (
    Field("id", int, "Number of the house, from 1"),
    Field("face", int, "Number of the face of the house, from 1"),
    Field("kind", str, "roof, wall or ground"),
    Field("area", float, "Area of the face", "m²"),
    Field("slope", float, "Slope of the face", "°"),
    *(
        Field(f"{name}{k}", float, f"Parameter: {name} of vertex {k}, in the units of the map", axis=axis)
        for k in range(1, 7)
        for axis, name in enumerate("xy")
    ),
    Field("z1", float, "Parameter: elevation of the ridge", "m"),
    Field("z3", float, "Parameter: elevation of the eaves", "m"),
    Field("z7", float, "Parameter: elevation of the ground", "m"),
    Field("rms", float, "Root mean square distance of the roof's points from its two planes", "m"),
)


@stage(
    "Facades",
    tags="gable,roof,ridge,eave,house,building,3D,LoD2,reconstruction,Peng",
    layers=(Layer("gables", "Gable houses", "Polygon", GABLE_FIELDS, style="facades"),),
    files=(TextFile("cityjson", "CityJSON", cityjson.FORMATS, cityjson.cityjson_pieces, NamedModel, "gables"),),
)
def reconstruct_gables(
    xyz,
    classification,
    segment_id,
    *,
    min_area: float = tunable(4.0, label="Minimum plane area", within="[0.5, 10_000] m²"),
    max_gap: float = tunable(1.5, label="Largest gap at the ridge", within="(0, 10] m"),
    monitor=None,
):
    """Reconstruct gable houses: ten vertices from two roof planes and the heights of eaves and ground.

    Two roof planes that rise toward each other are a gable. Their intersection line, made level, is the ridge; the
    outer edges of their points are the eaves, which get one height; walls are upright below the edges of the
    roof, down to the ground around.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes: ground (2) gives the elevation of the ground; without any, the lowest points around do.
    segment_id : ndarray of shape (n,), int32
        Roof planes from 1, as "Segment planes (RANSAC)" or "Segment roofs" finds them; 0 if unassigned.

    Returns
    -------
    gables : LayerFeatures
        Seven polygons with Z for each house (two of the roof, four walls, one on the ground), counterclockwise seen
        from outside, with the fifteen parameters of the house.
    cityjson : list of NamedModel
        The same for one file: a closed solid for each house, CityJSON 2.0 or CityJSONSeq, level of detail 2.2.

    Other Parameters
    ----------------
    min_area
        Area of the smallest roof plane of a gable.
    max_gap
        Points of both roof planes come this near to each other.

    Notes
    -----
    Vertices are numbered as in the paper's figure 8: 1 and 2 are the ends of the ridge, 3 to 6 of the eaves,
    7 to 10 lie below these on the ground. The fifteen parameters are x and y of 1 to 6, z1, z3 and z7. The paper offers
    two ways to a level ridge; here the ridge is the intersection line, turned level at its middle. Both eaves get the
    mean of their elevations and stay in their planes, so that all faces are planar; walls below them are upright, and
    gable walls are square to the ridge. A plane is used for the neighbor that it shares the longest ridge with.

    References
    ----------
    Peng, C., Yu, Z., 2018. Research on 3D building information extraction and image post-processing based on vehicle
    LIDAR. EURASIP Journal on Image and Video Processing 2018:121, section 3.4. [peng2018]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> is_roof = (abs(x - 20) < 5) & (abs(y - 20) < 4)
    >>> xyz = np.column_stack([x, y, np.where(is_roof, 8 - abs(y - 20), 0)])
    >>> planes = np.where(is_roof & (y > 20), 1, np.where(is_roof & (y < 20), 2, 0))
    >>> len(reconstruct_gables(xyz, np.where(is_roof, 6, 2), planes)[0])
    7
    """
    groups = list(members(segment_id).values())
    houses = []
    if groups:
        start = xyz.min(axis=0)
        local = xyz - start
        label = np.repeat(np.arange(len(groups)), [len(points) for points in groups])
        planes = planes_of(local[np.concatenate(groups)], label, len(groups))
        pairs = _gables(local, groups, planes, min_area, max_gap, monitor.part(0, 0.7))
        ground = _Ground(local, classification)
        for done, (a, b) in enumerate(pairs, start=1):
            house = _house(local, groups, planes, a, b, ground)
            if house is not None:
                houses.append(replace(house, vertices=house.vertices + start))
            monitor.progress(0.7 + 0.3 * done / len(pairs))
    if not houses:
        monitor.warn(
            "No two roof planes rise toward each other to a level ridge, so there is no gable; run "
            "'Segment planes (RANSAC)' first, with a smaller minimum plane area if roofs are small."
        )
    return _features(houses), [_model(number, house) for number, house in enumerate(houses, start=1)]


@dataclass(frozen=True)
class House:
    """Ten vertices (10, 3), m, in the order of the paper, and the rms (m) and number of the points of the roof."""

    vertices: np.ndarray
    rms: float
    n_points: int


class _Ground:
    """Elevation of the ground around houses."""

    def __init__(self, xyz: np.ndarray, classification: np.ndarray) -> None:
        is_ground = classification == PointClass.GROUND
        self.is_known = bool(is_ground.any())
        self.points = xyz[is_ground] if self.is_known else xyz
        self.tree = spatial.cKDTree(self.points[:, :2])

    def near(self, corners: np.ndarray) -> float:
        """Return the elevation (m) around corners (4, 2): the median of the ground, or of the lowest points, beside."""
        ring = corners[[0, 1, 2, 3, 0]]
        if self.is_known:
            return float(np.median(ground_beside(self.points, self.tree, [ring])))
        around = self.tree.query_ball_point(sampled_rings([ring], _BESIDE), _BESIDE)
        # Infinite if nothing is seen there.
        return float(np.median([self.points[near, 2].min() for near in around if near] or np.inf))


def _gables(
    xyz: np.ndarray, groups: list[np.ndarray], planes: Planes, min_area: float, max_gap: float, monitor: Monitor
) -> list[tuple[int, int]]:
    """Return pairs of planes that are gables, each plane once, the ones with the longest ridge first."""
    normal, area = planes.normal, planes.area
    steep = np.degrees(np.arccos(np.clip(normal[:, 2], 0, 1)))
    # Steeper planes than 80° are walls.
    good = np.flatnonzero((steep >= FLAT) & (steep <= 80.0) & (area >= min_area))
    trees = {int(k): spatial.cKDTree(xyz[groups[k]]) for k in good}
    found = []
    for done, a in enumerate(good):
        monitor.progress(done / len(good))
        for b in good[done + 1 :]:
            if not _are_opposite(planes, a, b):
                continue
            # Half the diagonal of a rectangle is at most 2.5 standard deviations: the centers of two that touch are
            # closer.
            reach = np.sqrt(planes.eigenvalues[[a, b], 0].sum()) * 4 + max_gap
            if np.linalg.norm(planes.center[a] - planes.center[b]) > reach:
                continue
            near = trees[int(a)].query(xyz[groups[b]], distance_upper_bound=max_gap)[0] <= max_gap
            if not near.any():
                continue
            direction = _ridge(planes, a, b)[1]
            found.append((float(np.ptp(xyz[groups[b]][near] @ direction)), int(a), int(b)))
    used: set[int] = set()
    pairs = []
    for _, a, b in sorted(found, reverse=True):
        if not {a, b} & used:
            used |= {a, b}
            pairs.append((a, b))
    return pairs


def _are_opposite(planes: Planes, a: int, b: int) -> bool:
    """Return whether two planes rise toward each other."""
    one, other = planes.normal[a], planes.normal[b]
    downhill = [plane[:2] / np.hypot(*plane[:2]) for plane in (one, other)]
    if downhill[0] @ downhill[1] > -np.cos(np.radians(_OPPOSITE)):
        return False
    # Downhill leads away from the other plane; otherwise it is a valley.
    apart = planes.center[a, :2] - planes.center[b, :2]
    return bool(downhill[0] @ apart > 0 and downhill[1] @ -apart > 0)


def _ridge(planes: Planes, a: int, b: int) -> tuple[np.ndarray, np.ndarray]:
    """Return a point (3,), m, of the ridge, and its level unit direction (3,)."""
    point, direction = line_of_planes(planes.center[[a, b]], planes.normal[[a, b]])
    level = np.array([direction[0], direction[1], 0.0])
    return point, level / np.linalg.norm(level)


def _house(
    xyz: np.ndarray, groups: list[np.ndarray], planes: Planes, a: int, b: int, ground: _Ground
) -> Optional[House]:
    """Return the house under two roof planes, None without ground below its eaves."""
    point, along = _ridge(planes, a, b)
    across = np.array([-along[1], along[0], 0.0])
    # Plane a lies to the right of the ridge.
    if (planes.center[a] - point) @ across > 0:
        across, along = -across, -along
    positions = [np.column_stack([(xyz[groups[k]] - point) @ way for way in (along, across)]) for k in (a, b)]
    every = np.concatenate(positions)
    first, last = _ends(every[:, 0])
    falls = [abs(_rise(planes.normal[k], across)) for k in (a, b)]
    right, left = _ends(positions[0][:, 1])[0], _ends(positions[1][:, 1])[1]
    # One height for both eaves; each moves along its plane to it.
    drop = (abs(right * falls[0]) + abs(left * falls[1])) / 2
    right, left = -drop / falls[0], drop / falls[1]
    flat = [(first, 0), (last, 0), (first, right), (last, right), (last, left), (first, left)]
    upper = np.array([point + u * along + v * across for u, v in flat])
    upper[2:, 2] = point[2] - drop
    base = ground.near(upper[2:, :2])
    if base >= point[2] - drop:
        return None
    feet = upper[2:].copy()
    feet[:, 2] = base
    rms = np.sqrt(np.average(planes.eigenvalues[[a, b], 2], weights=planes.count[[a, b]]))
    return House(np.concatenate([upper, feet]), float(rms), len(every))


def _ends(positions: np.ndarray) -> tuple[float, float]:
    """Return the ends (m) of the uniform distribution that positions (n,) were drawn from."""
    low, high = np.quantile(positions, [_EDGE, 1 - _EDGE])
    beyond = (high - low) * _EDGE / (1 - 2 * _EDGE)
    return float(low - beyond), float(high + beyond)


def _rise(normal: np.ndarray, across: np.ndarray) -> float:
    """Return the rise (m per m) of a plane in a level direction."""
    return float(-(normal @ across) / normal[2])


def _model(number: int, house: House) -> NamedModel:
    """Return a house as a model of a building."""
    rings, kinds = [[[vertex - 1 for vertex in face]] for _, face in _FACES], [kind for kind, _ in _FACES]
    roofs = [number if kind == ROOF else -1 for number, kind in enumerate(kinds)]
    solid = Solid(house.vertices, rings, kinds, roofs)
    base = float(house.vertices[6, 2])
    model = BuildingModel(base, "2.2", solids={"2.2": [solid]}, rms=house.rms, n_points=house.n_points)
    model.terrain, model.ridge = base, float(house.vertices[:, 2].max())
    return NamedModel(str(number), [house.vertices[[6, 7, 8, 9, 6], :2]], model)


def _features(houses: list[House]) -> LayerFeatures:
    geometries, table = [], []
    for number, house in enumerate(houses, start=1):
        own = house.vertices
        of_house = (*own[:6, :2].ravel().tolist(), *own[[0, 2, 6], 2].tolist(), house.rms)
        for k, (kind, face) in enumerate(_FACES, start=1):
            ring = own[[vertex - 1 for vertex in (*face, face[0])]]
            normal = area_vector(ring)
            size = float(np.linalg.norm(normal))
            slope = float(np.degrees(np.arccos(np.clip(abs(normal[2]) / size, 0, 1))))
            geometries.append([ring])
            table.append((number, k, kind, size, slope, *of_house))
    return LayerFeatures(geometries, {field.name: [row[i] for row in table] for i, field in enumerate(GABLE_FIELDS)})
