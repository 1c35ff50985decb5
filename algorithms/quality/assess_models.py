"""Assess models of buildings by the points of their roofs."""

from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from ..cloud.asprs import PointClass
from ..criteria import MAJORITY
from ..footprints import footprint_points
from ..geometry.cell_outlines import outline_cells
from ..geometry.grid import connected_cells, grid_over
from ..geometry.rings import signed_area
from ..planes.least_squares_planes import planes_of
from ..report.charts import BLUE, Mark, Series, draw_histogram
from ..report.page import Row, build_page, meters, percent
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..sampling.points_on_top import RULES, are_low, are_on_roof, distances, root_mean_square
from ..segmentation.segment_surfaces import segment_surfaces
from ..stage import Field, InputLayer, Layer, LayerFeatures, Measure, Monitor, Report, stage, tunable

# Faces with less than this area in plan (m²) are upright: walls.
_UPRIGHT = 1e-3

# Slope (°) of the steepest plane of a roof; steeper ones are walls.
_MAX_SLOPE = 75.0

# Largest angle (°) between the normals of a point and of its plane: normals of a dozen points with 3 cm of noise vary
# by less than half.
_FACING = 25.0

# What a face or plane is, in the attribute status.
MATCHED, MISSING, INVENTED, UNSEEN = "matched", "missing", "invented", "unseen"

_FACES = Layer(
    "faces",
    "Distances of faces",
    "Polygon",
    (
        Field("id", int, "number of the face, from 1"),
        Field("building", str, "its building: the attribute building of the roofs, or empty"),
        Field(
            "status",
            str,
            f"{MATCHED}: most of its points lie on it; {INVENTED}: they don't; {UNSEEN}: it has no points; "
            f"{MISSING}: a plane of the points that the model lacks",
        ),
        Field("points", int, "roof points above or below it"),
        Field("mean", float, "mean height of these above the face", "m"),
        Field("rms", float, "root mean square height above or below it", "m"),
        Field("p95", float, "95th percentile of the heights above or below it", "m"),
    ),
)
_BUILDINGS = Layer(
    "building_distances",
    "Distances of buildings",
    "Point",
    (
        Field("id", int, "number of the building, from 1"),
        Field("building", str, "the attribute building of the roofs, or empty"),
        Field("points", int, "points of its roof"),
        Field("rms", float, "root mean square height of these above or below the model", "m"),
        Field("p95", float, "95th percentile of these heights", "m"),
        Field("faces", int, "faces of its roof"),
        Field("missing", int, "planes of the points that the model lacks"),
        Field("invented", int, "faces that most of their points don't lie on"),
        Field("volume", float, "volume between its roof and the lowest of its points or of the ground around it", "m³"),
    ),
)
_MEASURES = (
    Measure("buildings", "Buildings"),
    Measure("points", "Roof points"),
    Measure("rms", "RMS of the distances", "m"),
    Measure("p95", "95th percentile of the distances", "m"),
    Measure("median_rms", "Median of the buildings' RMS", "m"),
    Measure("on_model", "Points on the model", "%"),
    Measure("all_faces", "Faces"),
    Measure("missing", "Missing planes"),
    Measure("invented", "Invented faces"),
    Measure("volume", "Volume", "m³"),
)


@stage(
    "Quality",
    tags="3D,LoD2,city model,roof,accuracy,rms,distance,evaluation,validation,RMSE",
    input_layers=(InputLayer("roofs"),),
    layers=(_FACES, _BUILDINGS),
    measures=_MEASURES,
)
def assess_models(
    xyz,
    classification,
    roofs,
    *,
    min_plane_area: float = tunable(2.0, within="[0.1, 1000] m²"),
    tolerance: Optional[float] = tunable(
        None, within="[0.01, 5] m", automatic=footprint_points.TOLERANCE_TEXT, advanced=True
    ),
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Measure how far models of buildings are from the points of their roofs, and which planes are missing or invented.

    Each point of a roof is compared with the face above or below it. Planes that grow over the points of a building by
    themselves show what the model lacks; *Segment surfaces* finds them, not the reconstruction of models.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m).
    classification : ndarray of shape (n,)
        Classes; points of class 6 are compared.
    roofs : LayerFeatures
        Roof faces with heights, of any program; faces with the same attribute 'building' are one building.

    Returns
    -------
    faces : LayerFeatures
        The faces with their distances, and the planes that are missing, as cells with their points.
    building_distances : LayerFeatures
        A point per building, with its distances.
    report : Report
        Distances and counts of all, and a page. Figures without points are NaN.

    Other Parameters
    ----------------
    min_plane_area
        Smaller planes of the points, seen from above, are not reported as missing.
    tolerance
        Distance at which a point lies on a face or plane.

    Raises
    ------
    ValueError
        If no point is called building, or the layer has no faces with heights.

    Notes
    -----
    Distances are differences in height; those above ``RULES.farthest`` m count as ``RULES.farthest`` m. A point lies on
    a face within the tolerance across its plane. Points more than a meter below both the model and others of class 6
    next to them are of walls and are not counted. A face without points is unseen, neither matched nor invented. The
    volume is the sum of prisms between the faces and the lowest point of class 6 or 2 in the building's box.

    References
    ----------
    Peters, R., Dukai, B., Vitalis, S., van Liempt, J., Stoter, J., 2022. Automated 3D reconstruction of LoD2 and LoD1
    models for all 10 million buildings of the Netherlands, section on quality. Photogrammetric Engineering & Remote
    Sensing 88(3). [peters2022]

    Examples
    --------
    >>> from lidar_buildings.algorithms.stage import LayerFeatures
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 6, 2)
    >>> ring = np.array([[15, 16], [25, 16], [25, 24], [15, 24], [15, 16.0]])
    >>> roof = np.column_stack([ring, np.full(5, 5.0)])
    >>> roofs = LayerFeatures([[roof]], {"building": [1]})
    >>> faces, buildings, report = assess_models(xyz, classes, roofs)
    >>> report.values["missing"]
    0
    """
    footprint_points.require_buildings(classification)
    if tolerance is None:
        tolerance = footprint_points.plane_tolerance(sampling.roughness)
        monitor.resolved(tolerance=tolerance)
    faces = _faces(roofs, monitor)
    points = _RoofPoints(xyz, classification, sampling.spacing)
    min_points = max(5, round(min_plane_area * sampling.density))
    buildings = _compared(faces, points, _Search(tolerance, min_points, sampling), monitor)
    values = _values(buildings)
    report = Report(values, _page(buildings, values, tolerance))
    return _face_layer(buildings, points), _building_layer(buildings), report


@dataclass
class _Face:
    """A face of a roof as a plane through its corners."""

    rings: list  #: (m, 3) each: the exterior, then the holes, m
    building: str  #: Name of the building, "" for none
    plane: np.ndarray  #: (3,): a, b, c of z = a x + b y + c
    off: np.ndarray  #: (k,): heights of the roof points above it, m
    is_on: np.ndarray  #: (k,), bool: which of these lie on it

    def height(self, xy: np.ndarray) -> np.ndarray:
        """Return the height (n,) of the plane (m)."""
        return xy @ self.plane[:2] + self.plane[2]

    @property
    def cosine(self) -> float:
        """The distance off the plane per difference in height."""
        return 1 / float(np.sqrt(1 + self.plane[0] ** 2 + self.plane[1] ** 2))

    @property
    def status(self) -> str:
        """Whether its points lie on it."""
        if not len(self.off):
            return UNSEEN
        return MATCHED if np.mean(self.is_on) >= MAJORITY else INVENTED


@dataclass
class _Building:
    """A building: its faces, the points of planes that it lacks, each (k, 3), and its volume (m³)."""

    name: str
    faces: list[_Face]
    missing: list[np.ndarray]
    volume: float

    @property
    def off(self) -> np.ndarray:
        """Heights (m) of all its roof points above the faces."""
        return np.concatenate([face.off for face in self.faces])

    @property
    def is_on(self) -> np.ndarray:
        """Which of these lie on the faces."""
        return np.concatenate([face.is_on for face in self.faces])

    @property
    def n_invented(self) -> int:
        """Faces that are invented."""
        return sum(face.status == INVENTED for face in self.faces)


def _faces(roofs: LayerFeatures, monitor: Monitor) -> dict[str, list[_Face]]:
    """Return the faces by their building; log how many have no heights or are upright."""
    names = roofs.columns.get("building", [""] * len(roofs))
    found: dict[str, list[_Face]] = {}
    for rings, name in zip(roofs.geometries, names):
        corners = np.asarray(rings[0], float)
        has_heights = corners.shape[1] == 3 and all(np.isfinite(ring).all() for ring in rings)
        if not has_heights or abs(signed_area(corners[:, :2])) < _UPRIGHT:
            continue
        middle = corners[:-1].mean(axis=0)
        offset = corners[:-1] - middle
        slope = np.linalg.lstsq(offset[:, :2], offset[:, 2], rcond=None)[0]
        called = "" if name is None else str(name)
        plane = np.array([*slope, middle[2] - slope @ middle[:2]])
        found.setdefault(called, []).append(_Face(rings, called, plane, np.zeros(0), np.zeros(0, bool)))
    count = sum(map(len, found.values()))
    if not count:
        raise ValueError(
            f"None of the {len(roofs)} roof faces has heights and an area seen from above; "
            "choose the roofs of 'Reconstruct roofs', or other polygons with Z."
        )
    if count < len(roofs):
        monitor.warn(f"{len(roofs) - count} of {len(roofs)} faces have no heights or no area, and are left out.")
    return found


class _RoofPoints:
    """The building points ``xyz`` (n, 3) by easting, which are low (n,), and the lowest of buildings and ground."""

    def __init__(self, xyz: np.ndarray, classification: np.ndarray, spacing: float) -> None:
        self.spacing, self.xyz = spacing, footprint_points.by_easting(xyz[classification == PointClass.BUILDING])
        self.is_low = are_low(self.xyz, spacing)
        self._low = footprint_points.by_easting(xyz[np.isin(classification, (PointClass.BUILDING, PointClass.GROUND))])

    def over(self, rings: list) -> np.ndarray:
        """Return the building points (k,), rows of ``xyz``, that lie within rings in plan."""
        return footprint_points.rows_within(self.xyz, [ring[:, :2] for ring in rings])

    def lowest(self, plan: np.ndarray) -> float:
        """Return the lowest height (m) in the box around positions (n, 2), NaN where there are no points."""
        z = self._low[footprint_points.rows_near(self._low, [plan]), 2]
        return float(z.min()) if len(z) else np.nan


@dataclass(frozen=True)
class _Search:
    """The search for planes that a model lacks, which shares nothing with the reconstruction of models."""

    tolerance: float  #: Distance at which a point lies on a plane, m
    min_points: int  #: Points of the smallest plane
    sampling: CloudSampling  #: How the cloud is sampled

    def missing(self, xyz: np.ndarray, on_model: np.ndarray) -> list[np.ndarray]:
        """Return the points of each plane of a building of which most lie off the model."""
        if len(xyz) < self.min_points:
            return []
        plane = segment_surfaces(
            xyz,
            np.zeros(len(xyz), np.uint8),
            planarity="global",
            smooth_normals=True,
            max_angle=_FACING,
            tolerance=self.tolerance,
            min_points=self.min_points,
            sampling=self.sampling,
        )
        found = [np.flatnonzero(plane == number) for number in range(1, plane.max() + 1)]
        return [xyz[rows] for rows in found if on_model[rows].mean() < MAJORITY and not _is_wall(xyz[rows])]


def _is_wall(xyz: np.ndarray) -> bool:
    """Whether the plane of points is too steep for a roof."""
    return bool(abs(planes_of(xyz, np.zeros(len(xyz), np.int64), 1).normal[0][2]) < np.cos(np.deg2rad(_MAX_SLOPE)))


def _compared(faces: dict[str, list[_Face]], points: _RoofPoints, search: _Search, monitor: Monitor) -> list[_Building]:
    """Return the buildings with the distances of their points."""
    buildings = []
    for number, (name, of_one) in enumerate(faces.items()):
        roof = []
        for face in of_one:
            over = points.over(face.rings)
            xyz = points.xyz[over]
            above = xyz[:, 2] - face.height(xyz[:, :2])
            is_roof = are_on_roof(above, points.is_low[over])
            face.off = distances(above[is_roof])
            face.is_on = np.abs(face.off) * face.cosine <= search.tolerance
            roof.append(xyz[is_roof])
        building = _Building(name, of_one, [], _volume(of_one, points))
        building.missing = search.missing(np.concatenate(roof), building.is_on)
        buildings.append(building)
        monitor.progress((number + 1) / len(faces))
    return buildings


def _volume(faces: list[_Face], points: _RoofPoints) -> float:
    """Return the volume (m³) of the prisms under faces, whichever way their rings run."""
    base = points.lowest(np.concatenate([ring for face in faces for ring in face.rings])[:, :2])
    total = 0.0
    for face in faces:
        for number, ring in enumerate(face.rings):
            position = ring[:, :2] - ring[0, :2]
            cross = position[:-1, 0] * position[1:, 1] - position[1:, 0] * position[:-1, 1]
            # The exterior comes first; all others are holes.
            cross = cross if (cross.sum() > 0) == (number == 0) else -cross
            # Triangles from the first corner; a plane's mean over each is the mean of its corners.
            height = (face.height(ring[:-1, :2]) + face.height(ring[1:, :2]) + face.height(ring[:1, :2])) / 3 - base
            total += float((0.5 * cross * height).sum())
    return total


def _measured(off: np.ndarray) -> dict[str, Any]:
    """Return the number of distances (m), their root mean square and their 95th percentile, NaN without any."""
    p95 = float(np.percentile(np.abs(off), 95.0)) if len(off) else np.nan
    return {"points": len(off), "rms": root_mean_square(off), "p95": p95}


def _values(buildings: list[_Building]) -> dict[str, float]:
    """Return the measures of all buildings together."""
    off = np.concatenate([building.off for building in buildings])
    each = [rms for rms in (root_mean_square(building.off) for building in buildings) if np.isfinite(rms)]
    return {
        "buildings": len(buildings),
        **_measured(off),
        "median_rms": float(np.median(each)) if each else np.nan,
        "on_model": 100.0 * float(np.mean(np.concatenate([building.is_on for building in buildings]))),
        "all_faces": sum(len(building.faces) for building in buildings),
        "missing": sum(len(building.missing) for building in buildings),
        "invented": sum(building.n_invented for building in buildings),
        "volume": sum(building.volume for building in buildings),
    }


def _face_layer(buildings: list[_Building], points: _RoofPoints) -> LayerFeatures:
    """Return the faces, and the cells of missing planes at their mean height."""
    features: list[tuple[list, dict[str, Any]]] = []
    for building in buildings:
        features += [(face.rings, _attributes(building.name, face.status, face.off)) for face in building.faces]
        for xyz in building.missing:
            facts = {**_attributes(building.name, MISSING, np.zeros(0)), "points": len(xyz)}
            features += [(rings, facts) for rings in _outlines(xyz, RULES.cell_size(points.spacing))]
    return LayerFeatures.numbered(features, _FACES.fields)


def _attributes(building: str, status: str, off: np.ndarray) -> dict[str, Any]:
    """Return the attributes of a face, or of a plane that has points and no face to measure them from."""
    mean = float(off.mean()) if len(off) else np.nan
    return {"building": building, "status": status, "mean": mean, **_measured(off)}


def _outlines(xyz: np.ndarray, size: float) -> list:
    """Return the outlines of the cells that hold points, at the mean height of these."""
    grid = grid_over(xyz, size)
    cells = np.unique(grid.number(xyz))
    _, group = connected_cells(grid, cells)
    outlines = outline_cells(grid, cells, group)
    height = xyz[:, 2].mean()
    return [[np.column_stack([ring, np.full(len(ring), height)]) for ring in rings] for rings in outlines]


def _building_layer(buildings: list[_Building]) -> LayerFeatures:
    """Return a point per building."""
    features = []
    for building in buildings:
        facts = {
            "building": building.name,
            **_measured(building.off),
            "faces": len(building.faces),
            "missing": len(building.missing),
            "invented": building.n_invented,
            "volume": building.volume,
        }
        features.append((np.concatenate([face.rings[0][:-1] for face in building.faces]).mean(axis=0), facts))
    return LayerFeatures.numbered(features, _BUILDINGS.fields)


def _page(buildings: list[_Building], values: dict[str, float], tolerance: float) -> str:
    """Return the page: figures of distances and planes, and a histogram."""
    lead = (
        f"{values['points']:,} roof points of {values['buildings']:,} buildings were compared with "
        f"{values['all_faces']:,} faces."
    )
    distances = [
        Row("RMS", meters(values["rms"]), "Root mean square height of all roof points above or below the faces."),
        Row("95th percentile", meters(values["p95"]), "95 of 100 roof points are nearer."),
        Row("Median of buildings", meters(values["median_rms"]), "Half of the buildings have a smaller RMS."),
        Row("On the model", percent(values["on_model"]), f"Roof points within {tolerance:.2f} m of a face."),
    ]
    planes = [
        Row("Missing planes", f"{values['missing']:,}", "Planes of the points of which most lie off the model."),
        Row("Invented faces", f"{values['invented']:,}", "Faces that most of their points don't lie on."),
        Row("Volume", f"{values['volume']:,.0f} m³", "Between roofs and the lowest points next to them."),
    ]
    off = np.concatenate([building.off for building in buildings])
    # Farther points would make all bars narrow.
    near = off[np.abs(off) <= 4 * tolerance]
    picture = ""
    if len(near):
        series = [Series("roof points", BLUE, near)]
        picture = draw_histogram(series, "Distance (m)", "points", [Mark("mean", float(near.mean()))])
    return build_page("Quality of the models", lead, {"Distances": distances, "Planes": planes}, picture)
