"""Models of buildings as CityJSON 2.0 and CityJSONSeq."""

import json
import math
import re
from collections.abc import Collection, Iterable, Iterator
from typing import Any
from uuid import NAMESPACE_URL, uuid5

import numpy as np

from ..stage import Field, MapFrame
from .building_facts import BUILDING_FIELDS, ROOF_FIELDS, NamedModel, building_attributes, face_attributes
from .solids import DOOR, GROUND, RESOLUTION, ROOF, SOFFIT, WALL, WINDOW, Solid, edges_around

CITYJSON, CITYJSON_SEQ = "CityJSON", "CityJSONSeq"
FORMATS = {CITYJSON: (".city.json", ".json"), CITYJSON_SEQ: (".city.jsonl", ".jsonl")}

SURFACES = {
    **{ROOF: "RoofSurface", WALL: "WallSurface", GROUND: "GroundSurface", SOFFIT: "OuterCeilingSurface"},
    **{WINDOW: "Window", DOOR: "Door"},
}

# The type of triangulated terrain.
RELIEF = "TINRelief"

# Decimals of attributes.
_DIGITS = 3


def cityjson_pieces(models: Collection[NamedModel], called: str, frame: MapFrame) -> Iterator[str]:
    """Yield the text of a CityJSON file, or, for CityJSONSeq, its lines; CityJSON has all vertices in memory.

    References
    ----------
    CityJSON Specifications 2.0.1, sections 2 to 6; CityJSONSeq, RFC 8142 without record separators. [cityjson2024]
    """
    extent = _extent(models, frame)
    translate = np.floor(extent[0])
    head = head_of(extent, translate, frame.crs)
    names = object_names(models, frame)
    if called == CITYJSON_SEQ:
        yield dumped({**head, "CityObjects": {}, "vertices": []}) + "\n"
        for one, name in zip(models, names):
            vertices = Vertices(translate, frame)
            feature = {"type": "CityJSONFeature", "id": name, "CityObjects": {name: _building(one, vertices)}}
            yield dumped({**feature, "vertices": vertices.rows}) + "\n"
        return
    vertices = Vertices(translate, frame)
    yield dumped(head)[:-1] + ',"CityObjects":{'
    for number, (one, name) in enumerate(zip(models, names)):
        yield ("," if number else "") + f"\n{json.dumps(name)}:{dumped(_building(one, vertices))}"
    yield '\n},"vertices":' + dumped(vertices.rows) + "}\n"


def _extent(models: Iterable[NamedModel], frame: MapFrame) -> tuple[np.ndarray, np.ndarray]:
    """Return the least and greatest coordinates of all models, in map units; 0 without any."""
    ends = [(positions.min(axis=0), positions.max(axis=0)) for one in models for positions in _positions(one, frame)]
    if not ends:
        return np.zeros(3), np.zeros(3)
    low, high = zip(*ends)
    return np.min(low, axis=0), np.max(high, axis=0)


def _positions(one: NamedModel, frame: MapFrame) -> Iterator[np.ndarray]:
    """Yield the vertices of the solids of a model, in map units."""
    for solids in one.model.solids.values():
        for solid in solids:
            yield frame.to_map(solid.vertices)


def object_names(models: Iterable[NamedModel], frame: MapFrame) -> Iterator[str]:
    """Yield the names of models in files: the keys of their map, or numbers with a part that their position gives.

    Numbers begin anew in each file. With the position, files can be merged, and a second run gives the same names.
    """
    return unique_names(_name_in_files(one, frame) for one in models)


def _name_in_files(one: NamedModel, frame: MapFrame) -> str:
    if one.attributes is not None:
        return one.name
    corner = frame.to_map(np.append(np.min(one.rings[0][:, :2], axis=0), 0.0)[None])[0]
    return f"{one.name}-{uuid5(NAMESPACE_URL, f'{frame.crs}/{corner[0]:.1f}/{corner[1]:.1f}').hex[:8]}"


def unique_names(names: Iterable[str]) -> Iterator[str]:
    """Yield names with a number behind those that came before: parts of one footprint share a name."""
    taken: set[str] = set()
    for name in names:
        free, number = name, 1
        while free in taken:
            number += 1
            free = f"{name}-{number}"
        taken.add(free)
        yield free


def head_of(extent: tuple[np.ndarray, np.ndarray], translate: np.ndarray, crs: str) -> dict[str, Any]:
    """Return the members of a file but its objects; ``extent`` are the ends (3,) of its vertices, map units."""
    metadata: dict[str, Any] = {}
    if np.any(extent[1] > extent[0]):
        metadata["geographicalExtent"] = np.round(extent, _DIGITS).reshape(-1).tolist()
    authority = re.fullmatch(r"([A-Za-z]+):(\w+)", crs)
    if authority:
        metadata["referenceSystem"] = f"https://www.opengis.net/def/crs/{authority[1].upper()}/0/{authority[2]}"
    return {
        "type": "CityJSON",
        "version": "2.0",
        "transform": {"scale": [RESOLUTION] * 3, "translate": translate.tolist()},
        "metadata": metadata,
    }


class Vertices:
    """The vertices of a file or feature, each position once."""

    def __init__(self, translate: np.ndarray, frame: MapFrame) -> None:
        self.translate, self.frame = translate, frame
        self._number: dict[tuple[int, ...], int] = {}

    @property
    def rows(self) -> list[tuple[int, ...]]:
        """The positions by number."""
        return list(self._number)

    def numbers(self, local: np.ndarray) -> list[int]:
        """Return the numbers of positions (n, 3), local m; new ones are added."""
        # Whole steps, in map units, as solids have them: faces stay plane.
        rows = np.rint((self.frame.to_map(local) - self.translate) / RESOLUTION).astype(np.int64).tolist()
        return [self._number.setdefault(tuple(row), len(self._number)) for row in rows]


def _building(one: NamedModel, vertices: Vertices) -> dict[str, Any]:
    """Return the city object of a building with a geometry for each level of detail, or of terrain."""
    if one.is_terrain:
        (solid,) = one.model.best
        numbers = vertices.numbers(solid.vertices)
        triangles = [[[numbers[v] for v in ring] for ring in rings] for rings in solid.faces]
        return {"type": RELIEF, "geometry": [{"type": "CompositeSurface", "lod": "1", "boundaries": triangles}]}
    geometry = []
    for level, solids in one.model.solids.items():
        parts = [_shell(one, solid, vertices, level == one.model.level) for solid in solids]
        first = np.cumsum([0, *(len(of_part) for _, of_part in parts)]).tolist()
        surfaces = [_numbered(surface, start) for (_, some), start in zip(parts, first) for surface in some]
        values: list = [[list(range(start, end))] for start, end in zip(first, first[1:])]
        boundaries: list = [[shell] for shell, _ in parts]
        kind = "MultiSolid"
        if len(parts) == 1:
            kind, boundaries, values = "Solid", boundaries[0], values[0]
        semantics = {"surfaces": surfaces, "values": values}
        geometry.append({"type": kind, "lod": level, "boundaries": boundaries, "semantics": semantics})
    facts = in_units(building_attributes(one), BUILDING_FIELDS, vertices.frame)
    attributes = {**plain_facts(facts), **plain_facts(one.attributes or {})}
    return {"type": "Building", "attributes": attributes, "geometry": geometry}


def in_units(facts: dict[str, Any], fields: Iterable[Field], frame: MapFrame) -> dict[str, Any]:
    """Return attributes in the units of the vertices: CityJSON has no field for other units."""
    plan, height = frame.units
    factor = {"m": height, "m²": plan**2, "m³": plan**2 * height}
    units = {field.name: factor.get(field.unit, 1.0) for field in fields}
    return {name: value * units[name] if units.get(name, 1.0) != 1.0 else value for name, value in facts.items()}


def _shell(one: NamedModel, solid: Solid, vertices: Vertices, is_best: bool) -> tuple[list, list[dict[str, Any]]]:
    """Return the faces of a solid as rings of vertices, and what each of them is."""
    numbers = vertices.numbers(solid.vertices)
    shell = [[[numbers[v] for v in ring] for ring in rings] for rings in solid.faces]
    surfaces = []
    for face, kind in enumerate(solid.kinds):
        facts: dict[str, Any] = {}
        if is_best and kind == ROOF:
            facts = plain_facts(in_units(face_attributes(one, solid, face), ROOF_FIELDS, vertices.frame))
            facts.pop("building")
        surfaces.append({"type": SURFACES[kind], **facts})
    for face, wall in _walls_of_openings(solid).items():
        surfaces[face]["parent"] = wall
        surfaces[wall].setdefault("children", []).append(face)
    return shell, surfaces


def _walls_of_openings(solid: Solid) -> dict[int, int]:
    """Return the wall, by face, of each face that is a window or door: the one that has its edges the other way."""
    openings = [face for face, kind in enumerate(solid.kinds) if kind in (WINDOW, DOOR)]
    if not openings:
        return {}
    face_of = {edge: face for face, rings in enumerate(solid.faces) for ring in rings for edge in edges_around(ring)}
    return {face: face_of[solid.faces[face][0][1], solid.faces[face][0][0]] for face in openings}


def _numbered(surface: dict[str, Any], start: int) -> dict[str, Any]:
    """Return a surface of a solid whose surfaces begin at a number, with the numbers of its parent and children."""
    parent = {"parent": surface["parent"] + start} if "parent" in surface else {}
    children = {"children": [child + start for child in surface["children"]]} if "children" in surface else {}
    return {**surface, **parent, **children}


def plain_facts(facts: dict[str, Any]) -> dict[str, Any]:
    """Return attributes as JSON has them: rounded, null where undefined."""

    def plain(value: Any) -> Any:
        return (round(value, _DIGITS) if math.isfinite(value) else None) if isinstance(value, float) else value

    return {name: plain(value) for name, value in facts.items()}


def dumped(value: Any) -> str:
    """Return a value as JSON without blanks."""
    return json.dumps(value, separators=(",", ":"), allow_nan=False, ensure_ascii=False)
