"""Models of buildings as Wavefront OBJ: materials by the kind of face, or one image of the colors of points."""

import re
from collections.abc import Collection, Iterator

import numpy as np

from ..models3d.wavefront import object_line, vertex_lines
from ..report.page import png
from ..stage import MapFrame, Piece
from .exported_models import KINDS, ExportedModel
from .gltf import COLORS, shared_atlas, triangles_of


def obj_pieces(models: Collection[ExportedModel], called: str, frame: MapFrame) -> Iterator[Piece]:
    """Yield the materials and, with textures, the image of an OBJ file with their names, then its text.

    Notes
    -----
    Coordinates are meters, z up, less an offset that the second line names. Rows of images count from below.
    """
    faces = [(model, face) for model in models for face in model.best]
    atlas = shared_atlas([face for _, face in faces])
    stem = re.sub(r"\s+", "_", frame.file)
    if atlas is not None:
        yield f"{stem}.png", png(atlas.image)
    yield f"{stem}.mtl", "".join(_material(kind, f"{stem}.png" if atlas else "") for kind in KINDS).encode()
    east, north = frame.to_map(np.zeros((1, 3)))[0, :2].tolist()
    yield f"# LiDAR Buildings, {frame.crs or 'no CRS'}, meters from the offset\n# offset {east:.3f} {north:.3f} 0\n"
    yield f"mtllib {stem}.mtl\n"
    building, kind, before = None, "", 1
    for row, (model, face) in enumerate(faces):
        if model is not building:
            building, kind = model, ""
            yield object_line(model.name)
        if face.kind != kind:
            kind = face.kind
            yield f"usemtl {kind}\n"
        corners = face.corners
        yield vertex_lines(corners)
        if atlas is not None:
            places = atlas.coordinates(row, face.texture, corners)
            yield "".join(f"vt {across:.6f} {1 - down:.6f}\n" for across, down in places.tolist())
        numbers = [f"{before + at}/{before + at}" if atlas else str(before + at) for at in range(len(corners))]
        yield "".join("f " + " ".join(numbers[at] for at in each) + "\n" for each in triangles_of(corners, face))
        before += len(corners)


def _material(kind: str, image: str) -> str:
    """Return the lines of a material: the color of its kind, or an image."""
    color = "1 1 1" if image else " ".join(f"{band / 255:.4f}" for band in COLORS[kind])
    return f"newmtl {kind}\nKd {color}\nillum 1\n" + (f"map_Kd {image}\n" if image else "")
