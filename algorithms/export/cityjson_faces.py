"""Faces of the models in CityJSON and CityJSONSeq files, of this program or any other."""

import json
import re
from collections.abc import Iterator
from typing import Any

import numpy as np

from ..models3d.cityjson import RELIEF, SURFACES
from ..models3d.solids import GROUND, TERRAIN
from ..stage import LayerFeatures
from .exported_models import BUILDING, KIND, LEVEL, kind_by_slope

ENDINGS = (".json", ".jsonl")

# Levels of nesting above surfaces, by the type of a geometry; others, as lines and templates, have no faces.
_DEPTH = {"MultiSurface": 0, "CompositeSurface": 0, "Solid": 1, "MultiSolid": 2, "CompositeSolid": 2}

_KINDS: dict[Any, str] = {name: kind for kind, name in SURFACES.items()}

# Entries of a semantic surface that are no attributes.
_NO_FACTS = ("type", "parent", "children")


def read_cityjson(text: str) -> tuple[LayerFeatures, str]:
    """Return the faces of buildings and terrain in a file, in its coordinates, and the code of its CRS, "" without one.

    Each face has its building, level of detail and kind; the first ground of a building, or else its first face, has
    the attributes of the building and of its parents. Footprints (level 0) are left out.

    Raises
    ------
    ValueError
        If it is no CityJSON of version 1 or 2, or damaged.

    References
    ----------
    CityJSON Specifications 2.0.1. [cityjson2024]
    """
    try:
        documents = _documents(text)
        head = documents[0]
        if head["type"] != "CityJSON":
            raise ValueError(f"its type is {head['type']}")
        rows = [row for document in documents for row in _faces(document, head.get("transform"))]
        system = str(head.get("metadata", {}).get("referenceSystem", ""))
    except (ValueError, KeyError, IndexError, TypeError, AttributeError, RecursionError) as error:
        raise ValueError(f"The file is no sound CityJSON ({error}); choose another one.") from error
    names = dict.fromkeys(name for _, facts in rows for name in facts)
    columns = {name: [facts.get(name) for _, facts in rows] for name in names}
    code = re.search(r"EPSG(?:/[\d.]*/|:[\d.]*:|:)(\d+)", system, re.IGNORECASE)
    return LayerFeatures([rings for rings, _ in rows], columns), f"EPSG:{code[1]}" if code else ""


def _documents(text: str) -> list[dict]:
    """Return the objects of a file: one, or one for each line of CityJSONSeq."""
    try:
        return [json.loads(text)]
    except json.JSONDecodeError:
        return [json.loads(line) for line in text.splitlines() if line.strip()]


def _faces(document: dict, transform: Any) -> Iterator[tuple[list[np.ndarray], dict[str, Any]]]:
    """Yield the closed rings of each face of a file or feature, in map units, and its attributes."""
    vertices = np.array(document["vertices"], float).reshape(-1, 3)
    if transform is not None:
        vertices = vertices * transform["scale"] + transform["translate"]
    # Coordinates are less than this in all systems (m or feet).
    if not (np.abs(vertices) < 1e9).all():
        raise ValueError("a vertex lies beyond the Earth")
    objects = document["CityObjects"]
    for name, one in objects.items():
        is_terrain = one["type"] == RELIEF
        if not (is_terrain or one["type"].startswith("Building")):
            continue
        facts = _attributes(name, objects)
        for geometry in one.get("geometry", ()):
            level = str(geometry.get("lod", ""))
            if geometry["type"] in _DEPTH and not level.startswith("0"):
                faces = list(_of_geometry(geometry, vertices))
                own = next((number for number, (_, kind, _) in enumerate(faces) if kind == GROUND), 0)
                for number, (rings, kind, of_face) in enumerate(faces):
                    of_building = facts if number == own else {}
                    own_kind = TERRAIN if is_terrain else kind
                    yield rings, {**of_building, **of_face, BUILDING: name, LEVEL: level, KIND: own_kind}


def _attributes(name: str, objects: dict) -> dict[str, Any]:
    """Return the attributes of an object and of its parents, as numbers and text."""
    one = objects[name]
    of_parents = [objects[parent].get("attributes") or {} for parent in one.get("parents", ()) if parent in objects]
    found = {key: value for facts in (*of_parents, one.get("attributes") or {}) for key, value in facts.items()}
    plain = {key: value for key, value in found.items() if value is not None}
    return {key: value if isinstance(value, (int, float, str)) else json.dumps(value) for key, value in plain.items()}


def _of_geometry(geometry: dict, vertices: np.ndarray) -> Iterator[tuple[list[np.ndarray], str, dict[str, Any]]]:
    """Yield closed rings, kind and attributes of each face of a geometry."""
    semantics = geometry.get("semantics") or {}
    for numbers, value in _surfaces(geometry["boundaries"], semantics.get("values"), _DEPTH[geometry["type"]]):
        if not numbers or min(map(len, numbers)) < 3:
            continue
        rings = [vertices[[*ring, ring[0]]] for ring in numbers]
        surface = {} if value is None else semantics["surfaces"][value]
        kind = _KINDS.get(surface.get("type")) or kind_by_slope(rings[0])
        facts = {name: fact for name, fact in surface.items() if name not in _NO_FACTS and fact is not None}
        yield rings, kind, facts


def _surfaces(boundaries: list, values: Any, depth: int) -> Iterator[tuple[list, Any]]:
    """Yield the rings of each surface with its number among the semantic ones, None without any."""
    for number, part in enumerate(boundaries):
        value = None if values is None else values[number]
        if depth:
            yield from _surfaces(part, value, depth - 1)
        else:
            yield part, value
