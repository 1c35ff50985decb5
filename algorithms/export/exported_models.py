"""Models of buildings as they are exported: faces with attributes, by level of detail, and images of colors on them."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, Optional

import numpy as np

from ..criteria import ROUNDING
from ..footprints.footprint_points import rows_near
from ..geometry.polygons import area_vector, axes_across
from ..geometry.raster_filling import nearest_known
from ..models3d.solids import DOOR, GROUND, ROOF, SOFFIT, TERRAIN, WALL, WINDOW
from ..stage import LayerFeatures, Monitor, feature_names

# Attributes of a face: the building that it is part of, the level of detail, and roof, wall, ground, window, door,
# terrain or soffit; and the patch that a triangle of terrain is part of.
BUILDING, LEVEL, KIND, PATCH = "building", "lod", "kind", "patch"
KINDS = (ROOF, WALL, GROUND, WINDOW, DOOR, TERRAIN, SOFFIT)

# Levels of detail, of which files get their names.
_LEVELS = re.compile(r"\d(\.\d)?")

# Points within this distance (m) of a face color it: noise, tiles, sills.
_NEAR = 0.3

# Widest image (texels): what browsers of any device show.
_WIDEST = 8192


@dataclass(frozen=True)
class Texture:
    """An image (rows, columns, 3), uint8, on a face: where it begins (3,), m, and its axes (2, 3), texels per m."""

    start: np.ndarray
    axes: np.ndarray
    image: np.ndarray


@dataclass(frozen=True)
class Face:
    """A plane polygon of a model: closed rings (k, 3), m, the exterior first, counterclockwise seen from outside."""

    kind: str
    rings: list[np.ndarray]
    facts: dict[str, Any]
    texture: Optional[Texture] = None

    @property
    def corners(self) -> np.ndarray:
        """The vertices (n, 3) of all rings, m, each once."""
        return np.concatenate([ring[:-1] for ring in self.rings])

    @property
    def numbered_rings(self) -> list[list[int]]:
        """The rings as numbers of the corners."""
        ends = np.cumsum([len(ring) - 1 for ring in self.rings]).tolist()
        return [list(range(start, end)) for start, end in zip([0, *ends], ends)]


@dataclass(frozen=True)
class ExportedModel:
    """A building or a patch of terrain: its name, its attributes, and its faces by level of detail.

    The level is "" where layers have one only. ``rise`` is the height (m) of the geoid over the ellipsoid there.
    """

    name: str
    facts: dict[str, Any]
    levels: dict[str, list[Face]]
    rise: float = 0.0

    def at(self, level: str) -> list[Face]:
        """Return the faces of the finest level up to the given one, or else of the simplest."""
        return self.levels[max((one for one in self.levels if one <= level), default=min(self.levels))]

    @property
    def best(self) -> list[Face]:
        """The faces of the finest level."""
        return self.levels[max(self.levels)]


def exported_models(layers: dict[str, Optional[LayerFeatures]], rise: float) -> tuple[list[ExportedModel], int]:
    """Return the models whose faces are in some layers, and the number of polygons without heights, which are left out.

    Parameters
    ----------
    layers : dict of str to LayerFeatures
        Polygons by the kind that they have where no attribute ``kind`` says it, "" where their slope does. An attribute
        ``building`` names the building, or else ``id``; ``lod`` is the level of detail. Grounds have the attributes of
        buildings.
    rise : float
        Height (m) of the geoid over the ellipsoid.
    """
    found: dict[str, dict[str, list[Face]]] = {}
    left_out = 0
    for kind, features in layers.items():
        for name, level, face in _faces(kind, features) if features is not None else ():
            if face is None:
                left_out += 1
            else:
                found.setdefault(name, {}).setdefault(level, []).append(face)
    return [_model(name, levels, rise) for name, levels in found.items()], left_out


def _faces(kind: str, features: LayerFeatures) -> Iterator[tuple[str, str, Optional[Face]]]:
    """Yield building, level and face of each polygon, None for those without heights."""
    columns = features.kept(range(len(features)), ())
    if kind == TERRAIN:
        names = columns.pop(PATCH, [TERRAIN] * len(features))
    else:
        names = columns.pop(BUILDING, feature_names(features))
    levels = columns.pop(LEVEL, [""] * len(names))
    for row, polygon in enumerate(features.geometries):
        rings = polygon
        facts = {name: column[row] for name, column in columns.items() if column[row] is not None}
        # Maps have attributes of that name, too.
        own = facts.pop(KIND) if facts.get(KIND) in KINDS else kind
        has_heights = all(ring.shape[1] == 3 and len(ring) > 3 for ring in rings)
        if has_heights and np.linalg.norm(area_vector(rings[0])) < ROUNDING:
            continue
        if not own and has_heights:
            own = kind_by_slope(rings[0])
        if own == GROUND and has_heights and area_vector(rings[0])[2] > 0:
            # Layers have it as it is seen on a map, solids as it is seen from below.
            rings = [ring[::-1] for ring in rings]
        level = str(levels[row])
        face = Face(own, rings, facts) if has_heights else None
        yield str(names[row]), level if _LEVELS.fullmatch(level) else "", face


def _model(name: str, levels: dict[str, list[Face]], rise: float) -> ExportedModel:
    """Return a building with the attributes of its ground, or of its first face where it has none."""
    best = levels[max(levels)]
    first = next((face for face in best if face.kind == GROUND), best[0])
    return ExportedModel(name, first.facts, levels, rise)


def kind_by_slope(ring: np.ndarray) -> str:
    """Return the kind of a face by its exterior ring (k, 3), counterclockwise from outside: wall, roof or ground."""
    normal = area_vector(ring)
    # Of the unit normal, less than this is vertical: slopes over 80° are walls.
    if abs(normal[2]) < 0.17 * np.linalg.norm(normal):
        return WALL
    return ROOF if normal[2] > 0 else GROUND


def textured(
    models: list[ExportedModel], xyz: np.ndarray, colors: np.ndarray, texel: float, monitor: Monitor
) -> list[ExportedModel]:
    """Return models whose finest faces have images of the mean colors of the points on them.

    Parameters
    ----------
    models : list of ExportedModel
        Buildings and terrain.
    xyz : ndarray of shape (n, 3)
        Points, m.
    colors : ndarray of shape (n, 3)
        Red, green and blue, of 8 bits, or of 16.
    texel : float
        Side of a texel, m.
    monitor : Monitor
        Receives progress.

    Notes
    -----
    Texels without points have the color of the nearest one that has some. Those beyond the edges of a face are filled,
    too, so that no border shows.
    """
    order = np.argsort(xyz[:, 0], kind="stable")
    xyz = xyz[order]
    # Files of 8 bits in fields of 16 are frequent.
    colors = np.asarray(colors)[order] / (256.0 if colors.max(initial=0) > 255 else 1.0)
    made = []
    for number, model in enumerate(models):
        # Points of the whole model first: faces are compared with a few of these.
        rows = rows_near(xyz, [np.concatenate([face.corners for face in model.best])[:, :2]], _NEAR)
        near, seen, faces = xyz[rows], colors[rows], []
        for face in model.best:
            own = rows_near(near, [face.rings[0][:, :2]], _NEAR)
            faces.append(replace(face, texture=_texture(face, near[own], seen[own], texel)))
        made.append(replace(model, levels={**model.levels, max(model.levels): faces}))
        monitor.progress((number + 1) / len(models))
    return made


def _texture(face: Face, xyz: np.ndarray, colors: np.ndarray, texel: float) -> Optional[Texture]:
    """Return the texture of a face, None if hardly any point is on it."""
    normal = area_vector(face.rings[0])
    normal /= np.linalg.norm(normal)
    axes, corners = np.stack(axes_across(normal)), face.rings[0]
    start = corners[0] + ((corners - corners[0]) @ axes.T).min(axis=0) @ axes
    width, height = np.ceil(((corners - start) @ axes.T).max(axis=0) / texel).astype(int).clip(1).tolist()
    offset = xyz - start
    column, row = np.floor(offset @ axes.T / texel).astype(np.int64).T
    on = (np.abs(offset @ normal) <= _NEAR) & (column >= 0) & (column < width) & (row >= 0) & (row < height)
    cell, size = (row * width + column)[on], width * height
    count = np.bincount(cell, minlength=size)
    # With less than a tenth of its texels seen, the color of its kind is more honest.
    if (count > 0).sum() < 0.1 * size or not on.any():
        return None
    sums = np.column_stack([np.bincount(cell, band, size) for band in colors[on].T])
    mean = (sums / np.maximum(count, 1)[:, None]).reshape(height, width, 3)
    filled = nearest_known(mean, count.reshape(height, width) == 0)
    return Texture(start, axes / texel, filled.astype(np.uint8))


@dataclass(frozen=True)
class Atlas:
    """One image (rows, columns, 3), uint8, of many, and the column and row (n, 2) at which each of them begins."""

    image: np.ndarray
    starts: np.ndarray

    def coordinates(self, number: int, texture: Optional[Texture], corners: np.ndarray) -> np.ndarray:
        """Return the image coordinates (n, 2), 0 to 1, of corners (n, 3), m, on the texture with this number."""
        place = np.full((len(corners), 2), 0.5) if texture is None else (corners - texture.start) @ texture.axes.T
        return (self.starts[number] + place) / self.image.shape[1::-1]


def atlas_of(images: Sequence[np.ndarray]) -> Atlas:
    """Return an image with many in it, each with a rim of one texel more, in rows of falling height."""
    padded = [np.pad(one, ((1, 1), (1, 1), (0, 0)), mode="edge") for one in images]
    sizes = np.array([one.shape[1::-1] for one in padded])
    side = int(min(max(np.sqrt(1.1 * sizes.prod(axis=1).sum()), sizes[:, 0].max()), _WIDEST))
    starts, x, y, tallest = np.zeros_like(sizes), 0, 0, 0
    for number in np.argsort(-sizes[:, 1], kind="stable").tolist():
        width, height = sizes[number].tolist()
        if x + width > side:
            x, y, tallest = 0, y + tallest, 0
        starts[number], x, tallest = (x, y), x + width, max(tallest, height)
    if y + tallest > _WIDEST or sizes[:, 0].max() > side:
        raise ValueError(
            f"The colors would take an image of {side} by {y + tallest} texels, and browsers show up to {_WIDEST}; "
            "make texels larger."
        )
    image = np.zeros((y + tallest, side, 3), np.uint8)
    for (column, row), one in zip(starts.tolist(), padded):
        image[row : row + one.shape[0], column : column + one.shape[1]] = one
    return Atlas(image, starts + 1)
