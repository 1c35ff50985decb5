"""Models of buildings for browsers and other programs: GLB, a page that shows it, 3D Tiles and OBJ."""

import base64
import re
from collections.abc import Collection, Iterator
from pathlib import Path

import numpy as np

from ..models3d.solids import GROUND, ROOF, TERRAIN, WALL, WINDOW
from ..models3d.wavefront import object_line, vertex_lines
from ..report.page import png
from ..stage import InputLayer, MapFrame, Piece, TextFile, stage, tunable
from .cityjson_faces import ENDINGS, read_cityjson
from .exported_models import KINDS, ExportedModel, exported_models, textured
from .gltf import COLORS, glb, shared_atlas, triangles_of
from .textured_cityjson import cityjson_pieces
from .tileset import tileset_pieces

# The page around a file, with "@GLB@" in its place.
_PAGE = Path(__file__).with_name("page.html")


def glb_pieces(models: Collection[ExportedModel], called: str, frame: MapFrame) -> Iterator[bytes]:
    """Yield a GLB file with the finest level of each model, in meters from a round position that it names."""
    origin = frame.to_map(np.zeros((1, 3)))[0].tolist()
    finest = max(level for model in models for level in model.levels)
    yield glb(list(models), finest, np.asarray, extras={"crs": frame.crs, "origin": origin})


def page_pieces(models: Collection[ExportedModel], called: str, frame: MapFrame) -> Iterator[Piece]:
    """Yield a page that needs nothing else, with the GLB file in it."""
    before, after = _PAGE.read_text(encoding="utf-8").split("@GLB@")
    yield before
    yield from map(base64.b64encode, glb_pieces(models, called, frame))
    yield after


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


@stage(
    "3D",
    tags="3D,export,GLB,glTF,3D Tiles,Cesium,tileset,web,browser,CityJSON,metadata",
    input_layers=(
        InputLayer("buildings", optional=True, upright=True),
        InputLayer("walls", optional=True, upright=True),
        InputLayer("roofs", optional=True, upright=True),
        InputLayer("openings", "Windows and doors", optional=True, upright=True),
        InputLayer("terrain", optional=True, upright=True),
        InputLayer("cityjson", "CityJSON", upright=True, endings=ENDINGS, read=read_cityjson, optional=True),
    ),
    input_title="Point cloud with colors",
    files=(
        TextFile("glb", "GLB", {"GLB": (".glb",)}, glb_pieces),
        TextFile("page", "Web page", {"HTML": (".html",)}, page_pieces),
        TextFile("tileset", "Tileset", {"3D Tiles": (".json",)}, tileset_pieces),
        TextFile("obj", "OBJ", {"Wavefront OBJ": (".obj",)}, obj_pieces),
        TextFile("surfaces", "CityJSON with images", {"CityJSON": (".city.json", ".json")}, cityjson_pieces),
    ),
)
def export_models(
    xyz=None,
    red=None,
    green=None,
    blue=None,
    buildings=None,
    walls=None,
    roofs=None,
    openings=None,
    terrain=None,
    cityjson=None,
    *,
    geoid_height: float = tunable(0.0, within="[-120, 120] m"),
    texel_size: float = tunable(0.25, within="[0.01, 10] m"),
    monitor=None,
):
    """Write models of buildings for browsers and other programs, from the layers of a run or from CityJSON.

    GLB is one file that Blender, PowerPoint and games open: meters, the axis y up, roofs, walls, grounds, windows,
    doors and terrain in colors. The web page shows it in any browser, from a disk or a mail, without a server or a
    connection; a click shows the attributes of a building. A tileset (3D Tiles 1.1) is for Cesium, QGIS's tiled scenes
    and other globes: GLB files next to its JSON, simple levels of detail far away. OBJ is for modelling programs;
    CityJSON with images has faces in place of solids. Their materials and images are files next to them. Buildings and
    faces keep their attributes, but in OBJ.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), optional
        Coordinates (m) of points that color the faces.
    red, green, blue : ndarrays of shape (n,), optional
        Their colors.
    buildings : LayerFeatures, optional
        Grounds of the buildings, with the attributes that files keep.
    walls : LayerFeatures, optional
        Walls of the same run; an attribute 'building' says of which building.
    roofs : LayerFeatures, optional
        Roofs of the same run.
    openings : LayerFeatures, optional
        Windows and doors of the same run, where it has some.
    terrain : LayerFeatures, optional
        Triangles of the terrain of the same run, where it has some.
    cityjson : LayerFeatures, optional
        A CityJSON or CityJSONSeq file of any program, instead of layers; its levels of detail are kept.

    Returns
    -------
    glb, page, tileset, obj, surfaces : list of ExportedModel
        The models for the files.

    Other Parameters
    ----------------
    geoid_height
        For 3D Tiles, height of the geoid over the ellipsoid WGS 84, which is added to elevations: about 43 m in the
        Netherlands, 36 to 50 m in Germany, -32 m in New York. Without it models lie under or over the terrain of a
        globe by as much.
    texel_size
        Side of the texels of images on roofs, walls and terrain, where a point cloud with colors is given; about the
        distance between its points.

    Raises
    ------
    ValueError
        If there is nothing to export, or no polygon has heights, or points have no colors.

    Notes
    -----
    Coordinates in GLB have 24 bits, so they are relative to a round position, which the file names (``asset.extras``)
    with its coordinate reference system. Attributes are ``EXT_structural_metadata``, one table of buildings and one of
    faces. Layers have the finest level only, CityJSON has all; the grounds of layers lack corners that walls have, so
    that surfaces are closed without gaps from CityJSON only.

    With a point cloud, each face that it shows has an image of the mean colors of the points within 0.3 m; texels
    between points have the color of the nearest one. Other faces, such as walls in most airborne clouds, and simpler
    levels of detail keep the color of their kind.

    A tile of a quadtree has up to 100 buildings, in one file for each level of detail. Its geometric error is the
    height by which the worst corner of a roof is off at that level (root mean square of the buildings). Positions on
    the globe are QGIS's in plan; heights are elevations and ``geoid_height``.

    References
    ----------
    Khronos Group, 2021. glTF 2.0 Specification. [gltf2021]
    Open Geospatial Consortium, 2023. 3D Tiles Specification, version 1.1. [tiles2023]

    Examples
    --------
    >>> from lidar_buildings.algorithms.stage import LayerFeatures
    >>> ring = np.array([[0, 0, 3.0], [4, 0, 3], [4, 5, 3], [0, 5, 3], [0, 0, 3]])
    >>> roof = LayerFeatures([[ring]], {"building": ["town hall"], "slope": [0.0]})
    >>> [(model.name, len(model.best)) for model in export_models(roofs=roof)[0]]
    [('town hall', 1)]
    """
    layers = {GROUND: buildings, WALL: walls, ROOF: roofs, WINDOW: openings, TERRAIN: terrain, "": cityjson}
    models, left_out = exported_models(layers, geoid_height)
    if not models:
        raise ValueError(
            f"There is no model to export ({left_out} polygons without heights); give the layers of "
            "'Reconstruct roofs', or a CityJSON file."
        )
    if left_out:
        monitor.warn(f"{left_out} polygons have no heights and are left out.")
    if xyz is not None:
        if red is None or green is None or blue is None:
            raise ValueError("The point cloud has no colors; choose one that has, or none.")
        models = textured(models, xyz, np.column_stack([red, green, blue]), texel_size, monitor)
        n_images = sum(face.texture is not None for model in models for face in model.best)
        monitor.inform(f"{n_images} faces have images.")
    n_patches = sum(model.best[0].kind == TERRAIN for model in models)
    faces = sum(len(model.best) for model in models)
    monitor.inform(f"{len(models) - n_patches} buildings and {n_patches} patches of terrain with {faces} faces.")
    return models, models, models, models, models
