"""Attributes of buildings and faces from their models, for layers and CityJSON, and these layers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, Optional

import numpy as np

from ..criteria import MAJORITY, SAME_WAY
from ..footprints.footprint_attributes import EAVE
from ..geometry.groups import split_groups
from ..rules import rules
from ..stage import Field, LayerFeatures
from .building_models import FINE, OVERHANGS, BuildingModel
from .mending import LARGE
from .roof_limits import OFF
from .solids import GROUND, ROOF, SOFFIT, TERRAIN, WALL, Solid

# Roofs below this slope (°) are flat: drains need 1 to 3°, and 5° is the least for tiles.
FLAT = 5.0

# Directions with less than this share of the sloping area are ignored for the type.
_MINOR = 0.03

# Faces with less than this share of the area are dormers, annexes and lean-tos.
_ANNEX = 0.1

# Roofs with more than this share of level parts are of no simple type.
_LEVEL = 0.35


@rules
class CHECKS:
    """Limits beyond which a model needs a look."""

    #: doubtful, poor: Shares of roof points off the model: twice and five times the median building's on maps
    doubtful: float = 0.1
    poor: float = 0.25
    #: Share of the area with points: walls hide a strip of narrow courts, water and glass all of a roof
    covered: float = 0.75


# Pieces of the descriptions of fields.
_LARGE_FACE, _IF_WEAK = f"a roof face of {LARGE:g} m² or more", f"if weakest_face is under {MAJORITY:g}"

BUILDING_FIELDS = (
    Field("id", int, "number of the building, from 1"),
    Field("building", str, "footprint below it: its attribute id, or its number", of="footprints"),
    Field("level", str, "level of detail that it has: 1.2, 1.3, 2.0, 2.2 or 2.3"),
    Field("reason", str, "why it has a simpler level than was asked for, empty where it has that one"),
    Field("roof_type", str, "flat, stepped flat, shed, gable, hip, mansard, truncated (with a flat top) or other"),
    Field("ground", float, "elevation of its base, near the lowest ground next to it", "m"),
    Field("eave_height", float, "lower quartile of the heights above the terrain at which its roof ends outside", "m"),
    Field("ridge_height", float, "98th percentile of the heights of its roof points above the terrain", "m"),
    Field("roof_area", float, "area of its roof, in its slopes", "m²"),
    Field("volume", float, "volume", "m³"),
    Field("rms", float, "root mean square height of its roof points above or below the model", "m"),
    Field("off", float, f"share of its roof points more than {OFF} m above or below the model, 0 to 1"),
    Field("explained", float, "share of its roof points that lie on the model, 0 to 1"),
    Field("weakest_face", float, f"least share of the points of {_LARGE_FACE} that lie on it, 0 to 1"),
    Field("covered", float, "share of its area that has points, 0 to 1"),
    Field(
        "gap_area", float, "area of its footprint without points; sort by it to find holes too small for check", "m²"
    ),
    Field(
        "check",
        int,
        f"2: a level under 2.2 and under the one asked for, or over {CHECKS.poor:.0%} of the roof points off. 1: over "
        f"{CHECKS.doubtful:.0%} off, or points on less than {CHECKS.covered:.0%} of the area, or less than "
        f"{MAJORITY:.0%} of the points of a large face on it. 0: sound",
    ),
    Field("confidence", float, f"confidence in the model: explained times covered, less {_IF_WEAK}, 0 to 1"),
    Field("points", int, "points over its footprint"),
)
ROOF_FIELDS = (
    Field("id", int, "number of the face, from 1"),
    Field("building", str, "building that it is part of, as in the layer of buildings", of="footprints"),
    Field("slope", float, "slope", "°"),
    Field("azimuth", float, "direction that it faces, clockwise from north; empty for level faces", "°"),
    Field("area", float, "area, in the slope", "m²"),
    Field(
        "usable_area",
        float,
        "area times the share of its points that lie on it: without chimneys, windows and dormers that it lacks",
        "m²",
    ),
    Field("eave", float, "elevation of its lowest corner", "m"),
    Field("ridge", float, "elevation of its highest corner", "m"),
    Field("rms", float, "root mean square height of its points above or below it", "m"),
    Field("parapet", float, "height of a parapet on its outer edges, if it is level; empty without one", "m"),
)
WALL_FIELDS = (
    Field("id", int, "number of the face, from 1"),
    Field("building", str, "building that it is part of, as in the layer of buildings", of="footprints"),
    Field("azimuth", float, "direction that it faces, clockwise from north", "°"),
    Field("area", float, "area", "m²"),
)
SOFFIT_WALL_FIELDS = (*WALL_FIELDS, Field("kind", str, "wall, or soffit: underside of an eave, without azimuth"))


# Facts by plane number, which JSON would turn into text.
_OF_PLANES = ("face_rms", "face_on", "face_parapet")


@dataclass(frozen=True)
class NamedModel:
    """A model with the name of its footprint, the rings of this (m), and its attributes if an identifier was chosen."""

    name: str
    rings: list
    model: BuildingModel
    attributes: Optional[dict[str, Any]] = None

    @property
    def is_terrain(self) -> bool:
        """Whether it is terrain between buildings."""
        return self.model.level == TERRAIN

    def record(self) -> dict[str, Any]:
        """Return it as plain values, which JSON keeps to the last bit."""
        kept = (one.name for one in fields(self.model) if one.name not in ("solids", "walls"))
        facts = {name: getattr(self.model, name) for name in kept}
        solids = {level: [_plain_solid(solid) for solid in some] for level, some in self.model.solids.items()}
        of_planes = {name: list(getattr(self.model, name).items()) for name in _OF_PLANES}
        rings = [np.asarray(ring).tolist() for ring in self.rings]
        return {"rings": rings, "model": {**facts, **of_planes}, "solids": solids, "attributes": self.attributes}

    @classmethod
    def of_record(cls, record: dict[str, Any], name: str) -> NamedModel:
        """Return the model of plain values, on the footprint of a name."""
        solids = {
            level: [Solid(**{**solid, "vertices": np.array(solid["vertices"])}) for solid in some]
            for level, some in record["solids"].items()
        }
        facts = {**record["model"], **{name: dict(record["model"][name]) for name in _OF_PLANES}}
        rings = [np.array(ring) for ring in record["rings"]]
        return cls(name, rings, BuildingModel(**facts, solids=solids), record["attributes"])

    @classmethod
    def of_triangles(cls, name: str, corners: np.ndarray) -> NamedModel:
        """Return the patch of terrain of triangles with corners (f, 3, 3), m."""
        vertices, rows = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
        faces = [[ring] for ring in rows.reshape(-1, 3).tolist()]
        solid = Solid(vertices, faces, [TERRAIN] * len(faces), [-1] * len(faces))
        return cls(name, [], BuildingModel(np.nan, TERRAIN, solids={TERRAIN: [solid]}), {})

    @classmethod
    def of_features(cls, features: LayerFeatures) -> list[NamedModel]:
        """Return the patches of a layer of terrain."""
        names, patch = np.unique(features.columns["patch"], return_inverse=True)
        corners = np.array([exterior[:3] for (exterior,) in features.geometries])
        rows = split_groups(patch, len(names))
        return [cls.of_triangles(name, corners[own]) for name, own in zip(names.tolist(), rows)]


def _plain_solid(solid: Solid) -> dict[str, Any]:
    return {**{one.name: getattr(solid, one.name) for one in fields(solid)}, "vertices": solid.vertices.tolist()}


def slope_and_azimuth(solid: Solid, face: int) -> tuple[float, float]:
    """Return slope and azimuth (°) of a face; the azimuth of a level one is NaN."""
    x, y, z = solid.normals[face].tolist()
    across = math.hypot(x, y)
    if across < 1e-6 * abs(z):
        return 0.0, math.nan
    return math.degrees(math.atan2(across, abs(z))), math.degrees(math.atan2(x, y)) % 360


def face_area(solid: Solid, face: int) -> float:
    """Return the area (m²) of a face."""
    return float(np.linalg.norm(solid.normals[face]))


def faces_of(solids: Sequence[Solid], kind: str) -> list[tuple[Solid, int]]:
    """Return the faces of one kind: roof, wall, ground or soffit."""
    return [(solid, face) for solid in solids for face, face_kind in enumerate(solid.kinds) if face_kind == kind]


def face_rings(solid: Solid, face: int) -> list[np.ndarray]:
    """Return the closed rings (k, 3) of a face, m."""
    return [solid.vertices[[*ring, ring[0]]] for ring in solid.faces[face]]


def building_attributes(one: NamedModel) -> dict[str, Any]:
    """Return the attributes of a building by its model, without its number."""
    model = one.model
    roofs = faces_of(model.best, ROOF)
    area = sum(float(abs(solid.normals[face, 2])) for solid, face in roofs)
    return {
        "building": one.name,
        "level": model.level,
        "reason": model.reason,
        "roof_type": roof_type(model.best),
        "ground": model.base,
        "eave_height": _eave(model.solids[FINE] if model.level == OVERHANGS else model.best) - model.terrain,
        "ridge_height": model.ridge - model.terrain,
        "roof_area": sum(face_area(solid, face) for solid, face in roofs),
        "volume": sum(solid.volume for solid in model.best),
        "rms": model.rms,
        "off": model.off,
        "explained": model.explained,
        "weakest_face": model.weakest,
        "covered": model.covered,
        "gap_area": (1 - model.covered) * area,
        "check": _check(model),
        "confidence": model.explained * model.covered * min(1.0, model.weakest / MAJORITY),
        "points": model.n_points,
    }


def _check(model: BuildingModel) -> int:
    """Return 0 for a sound model, 1 for a doubtful and 2 for a poor one."""
    if (model.reason and model.level < FINE) or not model.off <= CHECKS.poor:
        return 2
    return int(model.off > CHECKS.doubtful or model.covered < CHECKS.covered or model.weakest < MAJORITY)


def _eave(solids: Sequence[Solid]) -> float:
    """Return the height (m) of the eaves: a quantile, by length, of the upper edges of the walls down to the ground."""
    edges = []
    for solid in solids:
        base = [v for _, face in faces_of([solid], GROUND) for ring in solid.faces[face] for v in ring]
        for ring in (solid.faces[face][0] for _, face in faces_of([solid], WALL)):
            is_base = np.isin(ring, base)
            if not is_base.any():
                continue
            start, is_upper = solid.vertices[ring], ~(is_base | np.roll(is_base, -1))
            end = np.roll(start, -1, axis=0)
            length = np.hypot(*(end - start)[is_upper, :2].T)
            # The middles of the quarters of an edge have its heights.
            for share in (0.125, 0.375, 0.625, 0.875):
                edges.append(np.column_stack([(start + share * (end - start))[is_upper, 2], length / 4]))
    found = np.concatenate(edges)
    height, length = found[np.argsort(found[:, 0], kind="stable")].T
    return float(height[np.searchsorted(np.cumsum(length), EAVE / 100 * length.sum())])


def face_attributes(one: NamedModel, solid: Solid, face: int) -> dict[str, Any]:
    """Return the attributes of a face by its model, without its number."""
    slope, azimuth = slope_and_azimuth(solid, face)
    area = face_area(solid, face)
    facts = {"building": one.name, "azimuth": azimuth, "area": area}
    kind = solid.kinds[face]
    if kind != ROOF:
        return {**facts, "kind": kind, "azimuth": math.nan if kind == SOFFIT else azimuth}
    z = solid.vertices[solid.faces[face][0]][:, 2]
    rms, on, rim = (getattr(one.model, name).get(solid.planes[face], math.nan) for name in _OF_PLANES)
    facts.update(slope=slope, usable_area=area * on, eave=float(z.min()), ridge=float(z.max()), rms=rms)
    return {**facts, "parapet": rim if slope < FLAT else math.nan}


def model_layers(models: Sequence[NamedModel]) -> tuple[LayerFeatures, LayerFeatures, LayerFeatures]:
    """Return the grounds, walls and roofs of buildings."""
    grounds = LayerFeatures.numbered([(one.rings, building_attributes(one)) for one in models], BUILDING_FIELDS)
    of_map = [one.attributes or {} for one in models]
    names = dict.fromkeys(name for facts in of_map for name in facts)
    grounds.columns.update({name: [facts.get(name) for facts in of_map] for name in names})
    return grounds, _face_layer(models, SOFFIT_WALL_FIELDS, WALL, SOFFIT), _face_layer(models, ROOF_FIELDS, ROOF)


def _face_layer(models: Sequence[NamedModel], described: tuple[Field, ...], *kinds: str) -> LayerFeatures:
    """Return the faces of some kinds."""
    faces = [(one, solid, face) for one in models for kind in kinds for solid, face in faces_of(one.model.best, kind)]
    features = [(face_rings(solid, face), face_attributes(one, solid, face)) for one, solid, face in faces]
    return LayerFeatures.numbered(features, described)


def roof_type(solids: Sequence[Solid]) -> str:
    """Return the type of a roof by the slopes and directions of its faces."""
    roofs = faces_of(solids, ROOF)
    area = np.array([face_area(solid, face) for solid, face in roofs])
    slope, azimuth = np.array([slope_and_azimuth(solid, face) for solid, face in roofs]).T
    heights = [solid.vertices[solid.faces[face][0], 2] for solid, face in roofs]
    low, high = np.array([(z.min(), z.max()) for z in heights]).T
    return type_of_faces(area, slope, azimuth, low, high)


def type_of_faces(area: np.ndarray, slope: np.ndarray, azimuth: np.ndarray, low: np.ndarray, high: np.ndarray) -> str:
    """Return the type of a roof.

    Parameters
    ----------
    area, slope, azimuth : ndarray of shape (n,)
        Areas of its faces, m², their slopes and the directions that they face, °.
    low, high : ndarray of shape (n,)
        Heights of their lowest and highest corners, m.

    Returns
    -------
    str
        A value of the field ``roof_type``.
    """
    # Annexes and lean-tos do not change the type of a sloping roof: they end below the middle of its largest face.
    largest = int(np.argmax(area))
    if slope[largest] > FLAT:
        is_body = high >= (low[largest] + high[largest]) / 2
        area, slope, azimuth, low, high = area[is_body], slope[is_body], azimuth[is_body], low[is_body], high[is_body]
    kind = _type_of(area, slope, azimuth)
    if kind != "other":
        return kind
    # Neither do dormers; hips are small themselves.
    is_main = area >= _ANNEX * area.sum()
    kind = _type_of(area[is_main], slope[is_main], azimuth[is_main])
    if kind not in ("hip", "other"):
        return kind
    return "truncated" if _has_flat_top(low[is_main], high[is_main], slope[is_main] <= FLAT) else "other"


def _has_flat_top(low: np.ndarray, high: np.ndarray, is_level: np.ndarray) -> bool:
    """Return whether all level faces, a mask (n,), lie in the top quarter of the heights of the other faces."""
    if is_level.all() or not is_level.any():
        return False
    eave, ridge = low[~is_level].min(), high[~is_level].max()
    return bool(low[is_level].min() >= ridge - (ridge - eave) / 4)


def _type_of(area: np.ndarray, slope: np.ndarray, azimuth: np.ndarray) -> str:
    """Return the type of faces (n,) with areas (m²), slopes and azimuths (°)."""
    sloping = slope > FLAT
    if area[sloping].sum() < 0.5 * area.sum():
        return "flat" if len(area) == 1 else "stepped flat" if not sloping.any() else "other"
    ways = _ways(azimuth[sloping], area[sloping])
    if area[~sloping].sum() > _LEVEL * area.sum():
        return "other"
    if len(ways) == 1:
        return "shed"
    opposite = any(abs((ways[0] - way) % 360 - 180) < SAME_WAY for way in ways[1:])
    if len(ways) == 2 and opposite:
        # A mansard roof has two slopes each way, which differ as directions do.
        steep = max(np.ptp(slope[sloping][_near(azimuth[sloping], way)]) for way in ways)
        return "mansard" if steep > SAME_WAY and sloping.sum() >= 4 else "gable"
    # A hipped roof has one face each way, unless all ways have large ones: not dormers'.
    largely = [area[sloping][_near(azimuth[sloping], way)].sum() >= _ANNEX * area.sum() for way in ways]
    is_hip = opposite and len(ways) in (3, 4) and (sloping.sum() == len(ways) or all(largely))
    return "hip" if is_hip else "other"


def _near(azimuth: np.ndarray, way: float) -> np.ndarray:
    return np.abs((azimuth - way + 180) % 360 - 180) < SAME_WAY


def _ways(azimuth: np.ndarray, area: np.ndarray) -> list[float]:
    """Return the directions (°) in which a roof slopes, the one of the largest area first."""
    ways: list[float] = []
    remaining = area.copy()
    while remaining.sum() > 0:
        best = azimuth[np.argmax(remaining)]
        close = _near(azimuth, best) & (remaining > 0)
        if remaining[close].sum() >= _MINOR * area.sum():
            ways.append(float(best))
        remaining[close] = 0
    return sorted(ways, key=lambda way: -area[_near(azimuth, way)].sum())
