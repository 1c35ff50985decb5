"""Models of buildings as a Wavefront OBJ file."""

import re
from collections.abc import Collection, Iterator

import numpy as np

from ..stage import MapFrame
from .building_facts import NamedModel
from .cityjson import object_names
from .face_triangles import triangulate_face
from .solids import DECIMALS, Solid

OBJ = "Wavefront OBJ"
FORMATS = {OBJ: (".obj",)}

# Step (map units) of the offset: many readers of OBJ have numbers of 24 bits, which resolve a millimeter up to 16 km.
_ROUND = 1000.0


def obj_pieces(models: Collection[NamedModel], called: str, frame: MapFrame) -> Iterator[str]:
    """Yield the text of an OBJ file: an object per building, a group per kind of face.

    Notes
    -----
    Coordinates are map units less an offset that the second line names. Faces with holes are triangles, as OBJ has no
    holes.
    """
    offset = np.zeros(3)
    if models:
        first = frame.to_map(next(iter(models)).model.best[0].vertices[:1])[0]
        offset[:2] = np.floor(first[:2] / _ROUND) * _ROUND
    yield f"# Buildings at the best level of detail of each, {frame.crs or 'no CRS'}\n"
    yield f"# offset {offset[0]:.0f} {offset[1]:.0f} 0\n"
    number = 1
    for one, name in zip(models, object_names(models, frame)):
        yield object_line(name if one.is_terrain else f"building_{name}")
        for solid in one.model.best:
            positions = frame.to_map(solid.vertices) - offset
            yield vertex_lines(positions)
            yield from _faces(solid, number)
            number += len(positions)


def object_line(name: str) -> str:
    """Return the line that begins an object; its name is without blanks."""
    return "o " + re.sub(r"[^\w.-]+", "_", name) + "\n"


def vertex_lines(positions: np.ndarray) -> str:
    """Return the lines of vertices at positions (n, 3)."""
    return "".join(f"v {x:.{DECIMALS}f} {y:.{DECIMALS}f} {z:.{DECIMALS}f}\n" for x, y, z in positions.tolist())


def _faces(solid: Solid, number: int) -> Iterator[str]:
    """Yield the faces of a solid whose first vertex has a number."""
    group = ""
    for rings, kind in sorted(zip(solid.faces, solid.kinds), key=lambda face: face[1]):
        if kind != group:
            yield f"g {kind}\n"
            group = kind
        for ring in rings if len(rings) == 1 else triangulate_face(solid.vertices, rings):
            yield "f " + " ".join(str(number + v) for v in ring) + "\n"
