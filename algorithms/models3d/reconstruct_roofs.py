"""Models of buildings: closed solids with the planes of their roofs, from points and footprints."""

from collections import Counter
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from ..cloud.asprs import PointClass
from ..footprints import footprint_points
from ..footprints.footprint_points import GROUND_PERCENTILE, TOLERANCE_TEXT
from ..packages import spatial
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..sampling.density import point_spacing
from ..sampling.points_on_top import are_low
from ..stage import InputLayer, Layer, LayerFeatures, Monitor, TextFile, feature_names, stage, tunable
from . import cityjson, wavefront
from .building_facts import BUILDING_FIELDS, ROOF_FIELDS, SOFFIT_WALL_FIELDS, NamedModel, model_layers
from .building_models import LEVELS, Settings, model_building
from .joined_terrain import PATCH, TERRAIN_FIELDS, on_terrain, terrain_layer, triangulate_terrain
from .roof_limits import RADIUS
from .roof_planes import STEEPEST

# Number of footprints without a model that a warning names.
_NAMED = 5

# Items of files: models of the footprints, and patches of terrain.
_ITEMS = (NamedModel, "footprints", "terrain")


@stage(
    "3D",
    tags="3D,LoD1.2,LoD1.3,LoD2.0,LoD2.2,LoD2.3,LOD2,roof,solid,city model,CityJSON,CityJSONSeq,CityGML,OBJ,3DBAG,"
    "ridge,gable,hip,dormer,overhang,eave,soffit",
    input_layers=(InputLayer("footprints", buildings=True),),
    layers=(
        Layer("buildings", "Buildings", "Polygon", BUILDING_FIELDS, style="model_grounds"),
        Layer("walls", "Walls", "Polygon", SOFFIT_WALL_FIELDS, style="model_walls"),
        Layer("roofs", "Roofs", "Polygon", ROOF_FIELDS, style="model_roofs"),
        Layer(
            *("terrain", "Terrain", "Polygon", TERRAIN_FIELDS),
            style="model_terrain",
            on_demand="set the terrain tolerance, to 0.2 m for example",
        ),
    ),
    files=(
        TextFile("cityjson", "CityJSON", cityjson.FORMATS, cityjson.cityjson_pieces, *_ITEMS),
        TextFile("obj", "Wavefront OBJ", wavefront.FORMATS, wavefront.obj_pieces, *_ITEMS),
    ),
    cost=70.0,
    reach=lambda tunables: PATCH if tunables["terrain_tolerance"] else 0.0,
)
def reconstruct_roofs(
    xyz,
    classification,
    footprints,
    *,
    level_of_detail: str = tunable("2.2", choices=LEVELS),
    min_plane_area: float = tunable(1.5, within="[0.1, 1000] m²"),
    min_step: float = tunable(3.0, within="[0, 100] m"),
    top_percentile: float = tunable(70.0, label="Percentile of level tops", within="[0, 100] %", advanced=True),
    terrain_tolerance: float = tunable(0.0, within="[0, 10] m"),
    max_slope: float = tunable(STEEPEST, within="[1, 85]°", advanced=True),
    tolerance: Optional[float] = tunable(None, within="[0.01, 5] m", automatic=TOLERANCE_TEXT, advanced=True),
    id_field: str = tunable("", label="Identifier"),
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Model buildings as closed solids of roof planes, walls and ground, at levels of detail from 1.2 to 2.3.

    Planes grow over the points of each footprint. The lines in which they intersect, and those where one ends above
    another, divide the footprint into cells; each cell takes a plane, all together so that points and borders cost
    least. A building that is too far from its points gets the next simpler level, with the reason.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m).
    classification : ndarray of shape (n,)
        Classes; points of class 6 are modelled, points of class 2 are the ground.
    footprints : LayerFeatures
        Outlines of the buildings: from 'Extract footprints', or any other map of roofs or walls.

    Returns
    -------
    buildings : LayerFeatures
        The ground of each building, at its height, with the attributes of the model.
    walls, roofs : LayerFeatures
        The other faces of the best level of each building, as polygons with heights; soffits are among the walls.
    terrain : LayerFeatures
        Triangles of the terrain around the buildings, with their outlines as edges; none without a tolerance.
    cityjson, obj : list of NamedModel
        The same for one file: CityJSON 2.0 or CityJSONSeq with all levels and semantic surfaces, and Wavefront OBJ.

    Other Parameters
    ----------------
    level_of_detail
        1.2: one level top per building; 1.3: one per part where heights differ clearly; 2.0: the large planes of the
        roof, without dormers, chimneys and parts of under 10 m²; 2.2: all planes. 2.3: also eaves that overhang walls
        where these were seen. Files have the simpler levels too, 2.0 only where it is chosen.
    min_plane_area
        Area of the smallest roof plane, seen from above; dormers have 2 m² and more.
    min_step
        At level 1.3, parts of a roof that step by less are one part.
    top_percentile
        At levels 1.2 and 1.3, the share of the roof points below the top: 50 is the median, 100 the ridge.
    terrain_tolerance
        Largest height of ground points above or below a terrain of triangles, on which the walls end; 0.2 m is usual.
        0: no terrain, and a level ground under each building.
    max_slope
        Slope of the steepest roof plane.
    tolerance
        Distance at which a point lies on a plane. A larger one gives fewer planes.
    id_field
        Attribute of the footprints that names buildings in all results. With it, the layer of buildings and CityJSON
        keep all attributes of the footprints. If empty, buildings are named by the attribute 'id' or 'fid', or
        numbered, and in CityJSON also by their position, so that files can be merged.

    Raises
    ------
    ValueError
        If no point is called building, or none ground, or no footprint has an area.

    Notes
    -----
    Solids are valid by the rules of ISO 19107. Corners lie where planes intersect, to 0.1 mm, so that faces are plane;
    where more than two walls would meet in an edge, the smallest piece of roof there joins a neighbor. A part of a roof
    with a fault takes the plane of a neighbor or becomes level. Parts of a footprint that touch in a point only are
    solids of their own. A level that is farther from the points than a simpler one is left out. The ground is level,
    at the ``GROUND_PERCENTILE``th percentile of the ground points nearest to the outline. Curved roofs become strips.

    With a tolerance of the terrain, the lower edges of all walls are edges of its triangles, so that there is no gap,
    and the ground of a solid is in triangles, too. Where that is no valid solid, as where terrain lies above an eave,
    its ground is level, as low as the lowest terrain at its walls. CityJSON has the terrain as ``TINRelief``;
    it has no geometry for the line where terrain and walls meet.

    Unlike in the publications, lines cut only the cells along which planes adjoin, so that the cost
    grows with the border of planes and not with the square of their number. A border costs its length and the
    wall that it needs, in the same unit as the roof that no plane explains: square meters.

    References
    ----------
    Peters, R., Dukai, B., Vitalis, S., van Liempt, J., Stoter, J., 2022. Automated 3D reconstruction of LoD2 and LoD1
    models for all 10 million buildings of the Netherlands. Photogrammetric Engineering & Remote Sensing 88(3).
    [peters2022]
    Nan, L., Wonka, P., 2017. PolyFit: polygonal surface reconstruction from point clouds. ICCV. [nan2017]
    Huang, J., Stoter, J., Peters, R., Nan, L., 2022. City3D: large-scale building reconstruction from airborne LiDAR
    point clouds. Remote Sensing 14(9). [huang2022]
    Biljecki, F., Ledoux, H., Stoter, J., 2016. An improved LOD specification for 3D building models. Computers,
    Environment and Urban Systems 59. [biljecki2016]

    Examples
    --------
    >>> from lidar_buildings.algorithms.stage import LayerFeatures
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 6, 2)
    >>> ring = np.array([[15, 16], [25, 16], [25, 24], [15, 24], [15, 16.0]])
    >>> buildings, walls, roofs, *_ = reconstruct_roofs(xyz, classes, footprints=LayerFeatures([[ring]], {}))
    >>> len(buildings), len(walls), len(roofs)
    (1, 4, 1)
    """
    if not len(footprints):
        monitor.none_found("There are no footprints, so there are no models.")
        return *model_layers([]), terrain_layer([]), [], []
    building, ground = _points(xyz, classification)
    outlines = _outlines(footprints, id_field, monitor)
    if tolerance is None:
        tolerance = footprint_points.plane_tolerance(sampling.roughness)
        monitor.resolved(tolerance=tolerance)
    settings = Settings(
        point_spacing(building), tolerance, min_plane_area, max_slope, min_step, top_percentile, level_of_detail
    )
    part = monitor.part(0.0, 0.8 if terrain_tolerance else 1.0)
    models, patches = _modelled(building, ground, outlines, settings, part), []
    if terrain_tolerance and models:
        terrain = triangulate_terrain(ground, models, terrain_tolerance, monitor.part(0.8, 1.0))
        models, patches = on_terrain(models, terrain), terrain.models()
    return *model_layers(models), terrain_layer(patches), [*models, *patches], [*models, *patches]


@dataclass(frozen=True)
class _Outline:
    """A footprint: its name, its closed rings in plan (m), and its attributes in the layer if an identifier is set."""

    name: str
    rings: list
    attributes: Optional[dict[str, Any]] = None


def _points(xyz: np.ndarray, classification: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the points of buildings in the order of their eastings, and the points of the ground."""
    footprint_points.require_buildings(classification)
    footprint_points.require_ground(classification)
    building, ground = (xyz[classification == kind] for kind in (PointClass.BUILDING, PointClass.GROUND))
    return footprint_points.by_easting(building), ground


def _outlines(footprints: LayerFeatures, id_field: str, monitor: Monitor) -> list[_Outline]:
    """Return the footprints that have an area; say how many don't."""
    outlines = []
    for row, (rings, name) in enumerate(zip(footprints.geometries, feature_names(footprints, id_field))):
        sound = footprint_points.sound_rings(rings)
        if sound:
            facts = {field: value for field, (value,) in footprints.kept([row], BUILDING_FIELDS).items()}
            outlines.append(_Outline(name, sound, facts if id_field else None))
    footprint_points.tell_without_area(len(outlines), len(footprints), monitor)
    return outlines


def _modelled(
    building: np.ndarray, ground: np.ndarray, outlines: list[_Outline], settings: Settings, monitor: Monitor
) -> list[NamedModel]:
    """Return the models of all footprints that can be modelled; log their levels, and why the others have no model.

    The points are of buildings, in the order of their eastings.
    """
    tree, is_low = spatial.cKDTree(ground[:, :2]), are_low(building, settings.spacing)
    models, empty, failed = [], 0, []
    for number, outline in enumerate(outlines):
        over = footprint_points.rows_within(building, outline.rings)
        if not footprint_points.shows_roof(len(over), settings.spacing, outline.rings):
            empty += 1
        else:
            beside = footprint_points.ground_beside(ground, tree, outline.rings)
            base, terrain = np.percentile(beside, (GROUND_PERCENTILE, 50)).tolist()
            around = building[footprint_points.rows_near(building, outline.rings, RADIUS)]
            model = model_building(building[over], is_low[over], around, outline.rings, base, settings)
            model.terrain = terrain
            if model.level:
                rings = [np.column_stack([ring, np.full(len(ring), base)]) for ring in model.walls or outline.rings]
                models.append(NamedModel(outline.name, rings, model, outline.attributes))
            else:
                failed.append((outline.name, model.reason))
        monitor.progress((number + 1) / len(outlines))
    _inform_of_levels(models, len(outlines), monitor)
    _warn_of_others(empty, failed, len(outlines), monitor)
    return models


def _inform_of_levels(models: list[NamedModel], count: int, monitor: Monitor) -> None:
    """Say which levels the models of ``count`` footprints have."""
    levels = Counter(one.model.level for one in models)
    shares = ", ".join(f"{levels[name]} at level {name}" for name in LEVELS[::-1] if levels[name])
    if shares:
        monitor.inform(f"Of {count} footprints: {shares}.")


def _warn_of_others(empty: int, failed: list[tuple[str, str]], count: int, monitor: Monitor) -> None:
    """Say how many footprints have no model, and why."""
    if empty:
        monitor.warn(
            f"{empty} of {count} footprints have no points of buildings over them, or hardly any, and so no model."
        )
    if failed:
        named = "; ".join(f"{name}: {reason}" for name, reason in failed[:_NAMED])
        more = f"; and {len(failed) - _NAMED} more" if len(failed) > _NAMED else ""
        monitor.warn(f"{len(failed)} of {count} footprints have points but no model ({named}{more}).")
