"""Models of buildings as CityJSON with images on their faces."""

from collections.abc import Collection, Iterator, Sequence
from typing import Any, Optional

import numpy as np

from ..models3d.cityjson import RELIEF, SURFACES, Vertices, dumped, head_of, plain_facts, unique_names
from ..models3d.solids import TERRAIN
from ..report.page import png
from ..stage import MapFrame, Piece
from .exported_models import Atlas, ExportedModel, Face, atlas_of

# Level of detail of faces whose layers name none, and of terrain.
_LEVEL, _LEVEL_OF_TERRAIN = "2", "1"

_THEME = "colors"


def cityjson_pieces(models: Collection[ExportedModel], called: str, frame: MapFrame) -> Iterator[Piece]:
    """Yield the image of a CityJSON file with its name, where faces have textures, and its text.

    References
    ----------
    CityJSON Specifications 2.0.1, sections 3 and 6. [cityjson2024]
    """
    textured = [face for model in models for face in model.best if face.texture is not None]
    corners = [face.corners for model in models for faces in model.levels.values() for face in faces]
    positions = frame.to_map(np.concatenate(corners))
    extent = positions.min(axis=0), positions.max(axis=0)
    vertices = Vertices(np.floor(extent[0]), frame)
    look = _Look(textured)
    names = unique_names(model.name for model in models)
    objects = {name: _object(model, vertices, look) for name, model in zip(names, models)}
    appearance: dict[str, Any] = {}
    if look.atlas is not None:
        image = f"{frame.file}.png"
        yield image, png(look.atlas.image)
        textures = {"textures": [{"type": "PNG", "image": image}], "vertices-texture": look.places}
        appearance["appearance"] = {**textures, "default-theme-texture": _THEME}
    head = head_of(extent, vertices.translate, frame.crs)
    yield dumped({**head, **appearance, "CityObjects": objects, "vertices": vertices.rows}) + "\n"


class _Look:
    """The image of all faces with textures, and the positions in it that corners have been given."""

    def __init__(self, faces: Sequence[Face]) -> None:
        images = [face.texture.image for face in faces if face.texture is not None]
        self.atlas: Optional[Atlas] = atlas_of(images) if images else None
        self.places: list[list[float]] = []
        self._number = {id(face): number for number, face in enumerate(faces)}

    def of(self, face: Face) -> list[list[Optional[int]]]:
        """Return the texture of each ring of a face: number of the image, then of the positions; None without one."""
        if self.atlas is None or id(face) not in self._number:
            return [[None] for _ in face.rings]
        across, down = self.atlas.coordinates(self._number[id(face)], face.texture, face.corners).T
        first = len(self.places)
        # Rows of images count from below.
        self.places += np.round(np.column_stack([across, 1 - down]), 6).tolist()
        return [[0, *(first + at for at in ring)] for ring in face.numbered_rings]


def _object(model: ExportedModel, vertices: Vertices, look: _Look) -> dict[str, Any]:
    """Return the city object of a building, with its surfaces by level of detail, or of a patch of terrain."""
    if model.best[0].kind == TERRAIN:
        surface = {"type": "CompositeSurface", "lod": _LEVEL_OF_TERRAIN, **_surfaces(model.best, vertices, look)}
        return {"type": RELIEF, "geometry": [surface]}
    geometry = []
    for level, faces in model.levels.items():
        kinds = [{**_facts(face.facts), "type": SURFACES[face.kind]} for face in faces]
        semantics = {"surfaces": kinds, "values": list(range(len(faces)))}
        made = _surfaces(faces, vertices, look)
        geometry.append({"type": "MultiSurface", "lod": level or _LEVEL, **made, "semantics": semantics})
    return {"type": "Building", "attributes": _facts(model.facts), "geometry": geometry}


def _surfaces(faces: Sequence[Face], vertices: Vertices, look: _Look) -> dict[str, Any]:
    """Return the boundaries of faces, with their textures where some have one."""
    boundaries = []
    for face in faces:
        numbers = vertices.numbers(face.corners)
        boundaries.append([[numbers[at] for at in ring] for ring in face.numbered_rings])
    textures = [look.of(face) for face in faces]
    if all(ring[0] is None for rings in textures for ring in rings):
        return {"boundaries": boundaries}
    return {"boundaries": boundaries, "texture": {_THEME: {"values": textures}}}


def _facts(facts: dict[str, Any]) -> dict[str, Any]:
    """Return attributes as JSON has them; dates and the like are texts."""
    known = (int, float, str, bool, type(None))
    return plain_facts({name: value if isinstance(value, known) else str(value) for name, value in facts.items()})
