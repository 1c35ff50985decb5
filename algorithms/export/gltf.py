"""Models of buildings as binary glTF: triangles in the colors of their kinds, and attributes to query."""

from __future__ import annotations

import json
import re
import struct
from collections.abc import Sequence
from typing import Any, Callable, Optional

import numpy as np

from ..criteria import NO_DATA
from ..geometry.polygons import area_vector
from ..models3d.face_triangles import triangulate_face
from ..models3d.solids import GROUND, TERRAIN
from ..report.page import png
from .exported_models import KINDS, Atlas, ExportedModel, Face, atlas_of

# Colors (red, green, blue, 0 to 255) of roofs, walls, grounds, windows, doors, terrain and soffits, as in the styles of
# layers, where soffits are among the walls.
_WALL_COLOR = (226, 216, 196)
_RGB = (178, 72, 54), _WALL_COLOR, (150, 140, 125), (74, 134, 184), (112, 84, 62), (136, 148, 108), _WALL_COLOR
COLORS = dict(zip(KINDS, _RGB))

# From the axes of maps (east, north, up) to the axes of glTF (right, up, towards the viewer).
_Y_UP = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])


def glb(
    models: Sequence[ExportedModel],
    level: str,
    placed: Callable[[np.ndarray], np.ndarray],
    middle: Sequence[float] = (0.0, 0.0, 0.0),
    extras: Optional[dict[str, Any]] = None,
) -> bytes:
    """Return the bytes of a GLB file: one mesh with a material for each kind of face.

    Parameters
    ----------
    models : sequence of ExportedModel
        Buildings, one at least.
    level : str
        Level of detail; a building without it has the next simpler one.
    placed : callable
        Turns local positions (n, 3), m, into east, north and up.
    middle : sequence of float
        Position about which vertices are stored, so that their 24 bits suffice; the node moves them back.
    extras : dict, optional
        Facts about the file.

    References
    ----------
    Khronos Group, 2021. glTF 2.0 Specification. [gltf2021]
    Open Geospatial Consortium, 2023. 3D Tiles Specification 1.1, with EXT_mesh_features and EXT_structural_metadata.
    [tiles2023]
    """
    rows = [(number, face) for number, model in enumerate(models) for face in model.at(level)]
    rows.sort(key=lambda row: KINDS.index(row[1].kind))
    file = _File()
    atlas = shared_atlas([face for _, face in rows])
    primitives = _primitives(rows, lambda local: (placed(local) - np.asarray(middle)) @ _Y_UP.T, file, atlas)
    of_models = [{"name": model.name, **model.facts} for model in models]
    of_faces = [{"kind": face.kind, **({} if face.kind in (GROUND, TERRAIN) else face.facts)} for _, face in rows]
    tables = [_property_table(name, facts, file) for name, facts in (("building", of_models), ("face", of_faces))]
    schema = {"id": "models", "classes": {table["class"]: described for described, table in tables}}
    root = {
        "asset": {"version": "2.0", "generator": "LiDAR Buildings", **({"extras": extras} if extras else {})},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "translation": (_Y_UP @ middle).tolist()}],
        "meshes": [{"primitives": primitives}],
        "materials": [_material(kind, atlas is not None) for kind in KINDS],
        **(_images(png(atlas.image), file) if atlas else {}),
        "extensionsUsed": ["EXT_mesh_features", "EXT_structural_metadata"],
        "extensions": {"EXT_structural_metadata": {"schema": schema, "propertyTables": [table for _, table in tables]}},
    }
    return file.packed(root)


def shared_atlas(faces: Sequence[Face]) -> Optional[Atlas]:
    """Return the images of faces in one, None if no face has one."""
    is_textured = any(face.texture is not None for face in faces)
    return atlas_of([_image_of(face) for face in faces]) if is_textured else None


def _image_of(face: Face) -> np.ndarray:
    """Return the image on a face, one texel of the color of its kind where it has none."""
    return np.array([[COLORS[face.kind]]], np.uint8) if face.texture is None else face.texture.image


def _images(raw: bytes, file: _File) -> dict[str, Any]:
    """Return the one image of a file as glTF declares it."""
    image = {"bufferView": file.view(raw), "mimeType": "image/png"}
    sampler, texture = {"wrapS": 33071, "wrapT": 33071}, {"source": 0, "sampler": 0}
    return {"images": [image], "samplers": [sampler], "textures": [texture]}


def _material(kind: str, is_textured: bool) -> dict[str, Any]:
    # glTF stores linear light; screens and styles use the sRGB curve.
    shares = ((np.array(COLORS[kind]) / 255 + 0.055) / 1.055) ** 2.4
    plain = {"baseColorFactor": [*np.round(shares, 4).tolist(), 1.0]}
    color = {"baseColorTexture": {"index": 0}} if is_textured else plain
    surface = {"metallicFactor": 0.0, "roughnessFactor": 0.9, **color}
    return {"name": kind, "pbrMetallicRoughness": surface, "doubleSided": True}


class _File:
    """The buffer of a file, with the tables of its parts."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.views: list[dict[str, int]] = []
        self.accessors: list[dict[str, Any]] = []

    def view(self, raw: bytes, target: int = 0) -> int:
        """Add bytes; return the number of their view."""
        # Numbers of 64 bits must begin at multiples of 8 bytes.
        self.data += bytes(-len(self.data) % 8)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(raw)})
        if target:
            self.views[-1]["target"] = target
        self.data += raw
        return len(self.views) - 1

    def accessor(self, values: np.ndarray, are_indices: bool = False) -> int:
        """Add numbers (n,) or positions (n, 2 or 3), or indices of vertices; return the number of their accessor."""
        # Codes of glTF 2.0: the type of numbers, and what a part of the buffer is for.
        kind, code, target = ("<u4", 5125, 34963) if are_indices else ("<f4", 5126, 34962)
        made = np.ascontiguousarray(values, kind)
        described = {"bufferView": self.view(made.tobytes(), target), "componentType": code, "count": len(made)}
        columns = made.reshape(len(made), -1)
        ends = {"min": columns.min(axis=0).tolist(), "max": columns.max(axis=0).tolist()}
        self.accessors.append({**described, "type": "SCALAR" if made.ndim == 1 else f"VEC{made.shape[1]}", **ends})
        return len(self.accessors) - 1

    def packed(self, root: dict[str, Any]) -> bytes:
        """Return the file with a root."""
        binary = bytes(self.data) + bytes(-len(self.data) % 4)
        parts = {"accessors": self.accessors, "bufferViews": self.views, "buffers": [{"byteLength": len(binary)}]}
        text = json.dumps({**root, **parts}, separators=(",", ":"), allow_nan=False).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _primitives(
    rows: list[tuple[int, Face]], placed: Callable[[np.ndarray], np.ndarray], file: _File, atlas: Optional[Atlas]
) -> list[dict[str, Any]]:
    """Return the primitives of faces, with the numbers of their buildings, in the order of kinds."""
    corners = [face.corners for _, face in rows]
    ends = np.cumsum([0, *map(len, corners)])
    positions = placed(np.concatenate(corners))
    building = np.array([number for number, _ in rows])
    kind = np.array([KINDS.index(face.kind) for _, face in rows])
    made = []
    for material in np.unique(kind).tolist():
        first, last = np.searchsorted(kind, [material, material + 1]).tolist()
        part = slice(ends[first], ends[last])
        of_vertex = np.repeat(np.arange(first, last), np.diff(ends[first : last + 1]))
        triangles = [
            np.array(triangles_of(corners[row], rows[row][1]), np.int64).reshape(-1) + ends[row] - ends[first]
            for row in range(first, last)
        ]
        normals = np.array([_normal(positions[ends[row] :], rows[row][1]) for row in range(first, last)])
        attributes = {
            "POSITION": positions[part],
            "NORMAL": normals[of_vertex - first],
            "_FEATURE_ID_0": building[of_vertex],
            "_FEATURE_ID_1": of_vertex,
        }
        if atlas is not None:
            places = [atlas.coordinates(row, rows[row][1].texture, corners[row]) for row in range(first, last)]
            attributes["TEXCOORD_0"] = np.concatenate(places)
        counts = len(np.unique(building[first:last])), last - first
        stored = {name: file.accessor(one) for name, one in attributes.items()}
        indices = file.accessor(np.concatenate(triangles), are_indices=True)
        features = {"EXT_mesh_features": {"featureIds": [_features(n, one) for one, n in enumerate(counts)]}}
        made.append({"attributes": stored, "indices": indices, "material": material, "extensions": features})
    return made


def _features(count: int, number: int) -> dict[str, Any]:
    return {"featureCount": count, "attribute": number, "label": ("building", "face")[number], "propertyTable": number}


def triangles_of(corners: np.ndarray, face: Face) -> list[list[int]]:
    """Return the triangles of a face, numbers of its ``corners`` (n, 3) each."""
    rings = face.numbered_rings
    return rings if len(corners) == 3 else triangulate_face(corners, rings)


def _normal(positions: np.ndarray, face: Face) -> np.ndarray:
    """Return the unit normal (3,) of a face whose exterior is at the beginning of positions (n, 3)."""
    normal = area_vector(positions[: len(face.rings[0]) - 1])
    return normal / np.linalg.norm(normal)


def _property_table(name: str, rows: list[dict[str, Any]], file: _File) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the class and the table of the attributes of objects."""
    described: dict[str, Any] = {}
    stored: dict[str, Any] = {}
    for column in dict.fromkeys(key for facts in rows for key in facts):
        values = [facts.get(column) for facts in rows]
        called = re.sub(r"\W", "_", column, flags=re.ASCII)
        called = called if called[:1].isalpha() and called not in described else f"_{called}_{len(described)}"
        of_class, stored[called] = _property(values, file)
        described[called] = {"name": column, **of_class}
    return {"properties": described}, {"class": name, "count": len(rows), "properties": stored}


def _property(values: list, file: _File) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the declaration of an attribute and the places of its values; it is numeric if all values are numbers."""
    present = [value for value in values if value is not None]
    if all(isinstance(value, (int, float)) for value in present):
        is_whole = all(isinstance(value, int) and abs(value) < 2**31 for value in present)
        numbers = [NO_DATA if value is None else value for value in values]
        raw = np.array(numbers, "<i4" if is_whole else "<f8").tobytes()
        kind = {"type": "SCALAR", "componentType": "INT32" if is_whole else "FLOAT64", "noData": NO_DATA}
        return kind, {"values": file.view(raw)}
    texts = [("" if value is None else str(value)).encode() for value in values]
    offsets = np.cumsum([0, *map(len, texts)]).astype("<u4").tobytes()
    stored = {"values": file.view(b"".join(texts) or b"\0"), "stringOffsets": file.view(offsets)}
    return {"type": "STRING", "noData": ""}, stored
