"""Heights of the buildings of a map, from points and without models: ground, eaves, ridge, percentiles of the roof."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from ..cloud.asprs import VEGETATION, PointClass
from ..criteria import MAJORITY
from ..footprints import footprint_points
from ..footprints.footprint_attributes import roof_heights, surface_heights
from ..footprints.footprint_points import GROUND_PERCENTILE
from ..geometry.polygon_overlap import are_in_polygons, as_polygons
from ..geometry.rings import along_sides, polygon_area, sides_of_rings
from ..packages import spatial
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..sampling.density import DENSITY, point_spacing
from ..sampling.kinds import LASER
from ..sampling.points_on_top import RULES
from ..stage import Field, InputLayer, Layer, LayerFeatures, Monitor, stage
from .building_facts import CHECKS, type_of_faces
from .roof_partition import cells_inside, covered_share
from .roof_planes import STEEPEST, RoofPlanes, find_roof_planes

SEEN, PARTLY, TREES, ABSENT, EMPTY = "seen", "partly seen", "under trees", "no building", "no points"

# Points nearest to a position in plan that show whether it lies under something, itself among them.
_BESIDE = 4

# Area (m²) of the smallest plane of a roof, as in 'Reconstruct roofs'.
_MIN_AREA = 1.5

# Distance (m) from an outline within which its ground and its neighbors are: a wide building has none nearer.
_REACH = 100.0

# What parts of a cloud take of the whole: whether points have class 6, and the spacing (m) of roof points.
_ARE_CLASSIFIED, _ROOF_SPACING = "are_classified", "building_spacing"

# Adjusted standard GPS time is counted from this day, less 10⁹ s. Times of a week have no date.
_GPS_BEGIN, _ADJUSTED, _WEEK = np.datetime64("1980-01-06T00:00:00"), 1_000_000_000, 604_800.0

# Percentiles of the elevations of a roof's surface, by attribute. The first and the last leave out a branch on it.
_PERCENTILES = {"h_roof_min": 1, "h_roof_50p": 50, "h_roof_70p": 70, "h_roof_max": 99}

_FIELDS = (
    Field(
        "state",
        str,
        f"{SEEN}; {PARTLY}: points of the building on less than {CHECKS.covered:.0%} of the footprint; {TREES}: so, "
        f"with vegetation over most of the rest; {ABSENT}: only other points; {EMPTY}: none at all",
    ),
    Field("h_ground", float, "elevation of the ground, near the lowest next to the building", "m"),
    Field("h_roof_min", float, "least elevation of its roof, the 1st percentile", "m"),
    Field("h_roof_50p", float, "median elevation of its roof", "m"),
    Field("h_roof_70p", float, "70th percentile of the elevations of its roof, the top at level of detail 1.2", "m"),
    Field("h_roof_max", float, "greatest elevation of its roof, the 99th percentile", "m"),
    Field("eave_height", float, "lower quartile of the heights above the terrain at which its roof ends outside", "m"),
    Field("ridge_height", float, "98th percentile of the heights of its roof points above the terrain", "m"),
    Field("height", float, "median of these heights", "m"),
    Field("volume", float, "space between roof and terrain: mean height of the roof's surface times area", "m³"),
    Field("roof_type", str, "flat, stepped flat, shed, gable, hip, mansard, truncated (with a flat top) or other"),
    Field("covered", float, "share of its area that has points of the building, 0 to 1"),
    Field("trees", float, "share of its area that has points of vegetation and none of the building, 0 to 1"),
    Field("points", int, "points of the building over its footprint"),
    Field("date", str, "day on which half of the points of its roof were recorded, where these have a date"),
)


@stage(
    "3D",
    title="Heights of buildings",
    tags="height,heights,LoD1,LoD1.2,3DBAG,OpenStreetMap,Overture,cadastre,base map,eaves,ridge,volume,roof type,"
    "percentile,zonal statistics,attributes,extrusion",
    input_layers=(InputLayer("footprints", buildings=True),),
    layers=(Layer("buildings", "Buildings", "Polygon", _FIELDS, style="building_heights"),),
    cost=10.0,
    reach=_REACH,
    of_whole=(_ARE_CLASSIFIED, _ROOF_SPACING),
    each="footprints",
)
def compute_building_heights(
    xyz, classification, gps_time=None, footprints=None, *, sampling: CloudSampling = MEASURED, monitor=None
):
    """Measure the heights, volume and roof type of the buildings of a map, without models.

    Every polygon that touches the extent of the points keeps its outline and attributes, and gets the attributes of its
    roof. An attribute says where the roof was not seen, or where trees hide it. Clouds of any size will do: with more
    than 10 million points, surveys of many tiles too, they are read and worked on block by block.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m).
    classification : ndarray of shape (n,)
        Classes; points of class 6 are of buildings, points of class 2 are the ground.
    gps_time : ndarray of shape (n,), float64, optional
        Adjusted standard GPS time (s), for the date; times of a week (0 to 604,800 s) have none.
    footprints : LayerFeatures
        Outlines of buildings from any map: a cadastre, OpenStreetMap, Overture, 'Extract footprints'.

    Returns
    -------
    buildings : LayerFeatures
        The outlines in their order, with their measures, then with the attributes of the map. Of these, names that
        are used become ``map_…``.

    Raises
    ------
    ValueError
        If no point is called ground, none may be of a roof, there is no footprint with an area, or none touches the
        extent of the points.

    Notes
    -----
    Elevations are named and defined as in the 3DBAG, where they are called h_maaiveld and h_dak_50p: percentiles of the
    surface of the roof, not of its points, so that strips that were scanned twice count once. Here the surface has the
    height of the nearest roof point at positions a spacing apart, and not of a model. Chimneys, walls and floors seen
    through glass are left out: roof points lie on planes of ``_MIN_AREA`` m² or more, most of whose points have none
    above them. If less than half of a building lies on planes, as in domes, all of its points on top are its roof.

    The ground is the ``GROUND_PERCENTILE``th percentile of the ground points nearest to the outline; heights are above
    the median of these. Eaves are looked for where no other footprint adjoins.

    Where no point has class 6, roofs are the planes among the unclassified points ``LASER.lowest_roof`` m or more
    above the ground, and those clearly above them or next to them are vegetation.

    References
    ----------
    Peters, R., Dukai, B., Vitalis, S., van Liempt, J., Stoter, J., 2022. Automated 3D reconstruction of LoD2 and LoD1
    models for all 10 million buildings of the Netherlands. Photogrammetric Engineering & Remote Sensing 88(3).
    [peters2022]

    Examples
    --------
    >>> from lidar_buildings.algorithms.stage import LayerFeatures
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 6, 2)
    >>> ring = np.array([[15, 16], [25, 16], [25, 24], [15, 24], [15, 16.0]])
    >>> found = compute_building_heights(xyz, classes, footprints=LayerFeatures([[ring]], {"key": [7]}))
    >>> [found.columns[name] for name in ("key", "height", "roof_type")]
    [[7], [5.0], ['flat']]
    """
    footprint_points.require_ground(classification)
    rows, outlines = _outlines(footprints, xyz, monitor)
    points = _Points.of(xyz, classification, gps_time, sampling, monitor)
    tolerance = footprint_points.plane_tolerance(sampling.roughness)
    borders = _borders(outlines, points.spacing, monitor.part(0.0, 0.2))
    facts = []
    for number, (rings, border) in enumerate(zip(outlines, borders)):
        facts.append(_facts(points, rings, border, tolerance))
        monitor.progress(0.2 + 0.8 * (number + 1) / len(outlines))
    states = Counter(one["state"] for one in facts)
    shown = ", ".join(f"{states[state]} {state}" for state in (SEEN, PARTLY, TREES, ABSENT, EMPTY) if states[state])
    monitor.inform(f"Of {len(facts)} footprints: {shown}.")
    columns = {field.name: [one[field.name] for one in facts] for field in _FIELDS}
    return LayerFeatures(outlines, {**columns, **footprints.kept(rows, _FIELDS)})


def _outlines(footprints: LayerFeatures, xyz: np.ndarray, monitor: Monitor) -> tuple[list[int], list]:
    """Return the footprints that have an area and touch the extent of the points: their rows and their rings."""
    if not len(footprints):
        raise ValueError("The layer of footprints has no features; choose another.")
    rings_of = {row: footprint_points.sound_rings(rings) for row, rings in enumerate(footprints.geometries)}
    sound = {row: rings for row, rings in rings_of.items() if rings}
    footprint_points.tell_without_area(len(sound), len(footprints), monitor)
    low, high = xyz[:, :2].min(axis=0), xyz[:, :2].max(axis=0)
    boxes = {row: (rings[0].min(axis=0), rings[0].max(axis=0)) for row, rings in sound.items()}
    near = [row for row, (least, most) in boxes.items() if ((most >= low) & (least <= high)).all()]
    if not near:
        raise ValueError(
            f"None of the {len(footprints)} footprints touches the extent of the point cloud; choose a layer of the "
            "same area, or check the coordinate reference systems of both."
        )
    if len(near) < len(sound):
        monitor.inform(f"{len(sound) - len(near)} footprints beyond the extent of the point cloud are left out.")
    return near, [sound[row] for row in near]


@dataclass(frozen=True)
class _Points:
    """The points of a cloud in the order of their eastings, and the ground points among them."""

    xyz: np.ndarray
    classification: np.ndarray
    time: Optional[np.ndarray]  #: (n,): adjusted standard GPS time, s; None without a date
    ground: np.ndarray  #: (g, 3), m
    tree: Any  #: Search tree of the ground in plan
    roofs: tuple[int, ...]  #: Classes of points that may be of roofs
    spacing: float  #: Mean distance of neighboring points of these, m

    @classmethod
    def of(cls, xyz: np.ndarray, classification: np.ndarray, time: Any, sampling: Any, monitor: Monitor) -> _Points:
        """Return the points of a cloud; say so where no class calls any a building."""
        roofs: tuple[int, ...] = (PointClass.BUILDING,)
        if not sampling.shared(_ARE_CLASSIFIED, lambda: float((classification == roofs[0]).any())):
            roofs = PointClass.NEVER_CLASSIFIED, PointClass.UNCLASSIFIED
            if not np.isin(classification, roofs).any() and not sampling.of_whole:
                footprint_points.require_buildings(classification)
            monitor.inform(
                "No point is called building (class 6): roofs are the planes among the unclassified points over "
                "footprints. Run 'Detect buildings' first to know trees from roofs better."
            )
        order = np.argsort(xyz[:, 0], kind="stable")
        is_week = time is None or (time.min() >= 0 and time.max() <= _WEEK)
        ground = xyz[classification == PointClass.GROUND]
        dated = None if is_week or time is None else time[order]
        spacing = sampling.shared(_ROOF_SPACING, lambda: point_spacing(xyz[np.isin(classification, roofs)]))
        return cls(xyz[order], classification[order], dated, ground, spatial.cKDTree(ground[:, :2]), roofs, spacing)

    def date(self, rows: np.ndarray) -> Optional[str]:
        """Return the median day of some points, None if it is unknown."""
        if self.time is None:
            return None
        seconds = _ADJUSTED + int(np.median(self.time[rows]))
        return str((_GPS_BEGIN + np.timedelta64(seconds, "s")).astype("datetime64[D]"))


def _borders(outlines: list, spacing: float, monitor: Monitor) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return for each footprint positions (b, 2) along it, and which (b,) have no footprint beyond; all if none has."""
    along = [along_sides(sides_of_rings(rings), spacing) for rings in outlines]
    beyond = np.concatenate([positions + spacing * outward for positions, _, outward in along])
    is_outer = ~are_in_polygons(beyond, as_polygons(outlines), monitor)
    parts = np.split(is_outer, np.cumsum([len(positions) for positions, *_ in along])[:-1])
    return [(one[0], outer if outer.any() else np.ones(len(outer), bool)) for one, outer in zip(along, parts)]


def _facts(points: _Points, rings: list, border: tuple[np.ndarray, np.ndarray], tolerance: float) -> dict[str, Any]:
    """Measure the building on a footprint: its attributes by the names of the fields."""
    within, are_classified = footprint_points.rows_within(points.xyz, rings), PointClass.BUILDING in points.roofs
    kind = points.classification[within]
    beside = footprint_points.ground_beside(points.ground, points.tree, rings)
    base, terrain = np.percentile(beside, (GROUND_PERCENTILE, 50)).tolist()
    building, plants = within[np.isin(kind, points.roofs)], within[np.isin(kind, VEGETATION)]
    if not are_classified:
        building = building[points.xyz[building, 2] >= base + LASER.lowest_roof]
    least = max(5, round(_MIN_AREA / points.spacing**2))
    planes = find_roof_planes(points.xyz[building] - points.xyz[building[:1]], tolerance, STEEPEST, least)
    if not are_classified:
        is_plant = _are_plants(points.xyz[building], planes.label >= 0, points.spacing)
        plants = np.concatenate([plants, building[is_plant]])
        building, planes = building[~is_plant], RoofPlanes(planes.coefficients, planes.label[~is_plant])
    # Cells begin at the corner of each footprint, wherever the cloud does.
    corner = np.append(rings[0].min(axis=0), 0.0)
    moved, seen = [ring - corner[:2] for ring in rings], (building, np.append(building, plants))
    covered, beneath = (covered_share(moved, points.xyz[rows] - corner, points.spacing) for rows in seen)
    trees = beneath - covered
    facts: dict[str, Any] = dict.fromkeys((field.name for field in _FIELDS if field.type is float), np.nan)
    facts.update(h_ground=base, roof_type=None, date=None, points=len(building), covered=covered, trees=trees)
    has_roof = footprint_points.shows_roof(len(building), points.spacing, rings)
    facts["state"] = _state(len(within), has_roof, covered, trees)
    if has_roof:
        facts.update(_roof_facts(points, building, planes, rings, border, terrain))
    return facts


def _state(n_points: int, has_roof: bool, covered: float, trees: float) -> str:
    """Classify how well a building was seen, by its points and the shares of its area with roof and vegetation."""
    if not n_points:
        return EMPTY
    if has_roof and covered >= CHECKS.covered:
        return SEEN
    return TREES if trees >= MAJORITY * (1 - covered) else PARTLY if has_roof else ABSENT


def _are_plants(xyz: np.ndarray, is_on: np.ndarray, spacing: float) -> np.ndarray:
    """Return the mask of points (n, 3), m, clearly above or next to those on planes (n,), bool; all without planes.

    Farther in plan from those on planes than points of one object are apart, they are of plants next to the roof. The
    others off planes are walls, chimneys and edges.
    """
    if not is_on.any():
        return np.ones(len(xyz), bool)
    distance, nearest = spatial.cKDTree(xyz[is_on, :2]).query(xyz[:, :2])
    return ~is_on & ((distance > DENSITY.link * spacing) | (xyz[:, 2] > xyz[is_on, 2][nearest] + RULES.below))


def _roof_facts(
    points: _Points,
    building: np.ndarray,
    planes: RoofPlanes,
    rings: list,
    border: tuple[np.ndarray, np.ndarray],
    terrain: float,
) -> dict[str, Any]:
    """Measure the roof of a building by its points (rows of all); ``terrain`` is the elevation of the terrain, m."""
    xyz, spacing = points.xyz[building], points.spacing
    is_roof = _are_roof(xyz, planes, spacing)
    plan, z = xyz[is_roof, :2], xyz[is_roof, 2]
    corner = rings[0].min(axis=0)
    middles = (cells_inside([ring - corner for ring in rings], spacing) + 0.5) * spacing + corner
    surface = surface_heights(middles if len(middles) else plan, plan, z, spacing)
    return {
        **{name: float(np.percentile(surface, percent)) for name, percent in _PERCENTILES.items()},
        **roof_heights(*border, plan, z - terrain, spacing),
        "volume": polygon_area(rings) * (float(surface.mean()) - terrain),
        "roof_type": _roof_type(xyz[is_roof], planes, planes.label[is_roof]),
        "date": points.date(building[is_roof]),
    }


def _are_roof(xyz: np.ndarray, planes: RoofPlanes, spacing: float) -> np.ndarray:
    """Return the mask of the roof's points (n, 3), m: on planes with most of their points on top."""
    near = spatial.cKDTree(xyz[:, :2]).query(xyz[:, :2], min(_BESIDE, len(xyz)))[1]
    is_under, is_on = xyz[near, 2].max(axis=1) > xyz[:, 2] + RULES.below, planes.label >= 0
    # With fewer points on planes it is a dome or a wreck.
    if is_on.mean() < MAJORITY:
        return ~is_under
    count, under = (np.bincount(planes.label[one], minlength=len(planes)) for one in (is_on, is_on & is_under))
    # A steep plane rises as much from point to point as a floor lies below a roof.
    rise = 2 * spacing * np.hypot(*planes.coefficients[:, :2].T)
    return is_on & ((rise > RULES.below) | (under <= count / 2))[planes.label]


def _roof_type(xyz: np.ndarray, planes: RoofPlanes, label: np.ndarray) -> str:
    """Return the type of a roof by its planes and the points (n, 3) on them; their numbers are their areas."""
    used = [xyz[label == plane, 2] for plane in range(len(planes))]
    seen = np.flatnonzero([len(z) > 0 for z in used])
    if not len(seen):
        return "other"
    a, b, _ = planes.coefficients[seen].T
    low, high = np.array([(used[plane].min(), used[plane].max()) for plane in seen]).T
    area = np.array([len(used[plane]) for plane in seen]) / planes.cosine[seen]
    slope, azimuth = np.degrees(np.arctan(np.hypot(a, b))), np.degrees(np.arctan2(-a, -b)) % 360
    return type_of_faces(area, slope, azimuth, low, high)
