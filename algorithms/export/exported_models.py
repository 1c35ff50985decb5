"""Models of buildings as faces with attributes, by level of detail, as they are exported."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from ..criteria import ROUNDING
from ..geometry.polygons import area_vector
from ..models3d.set_openings import DOOR, WINDOW
from ..models3d.solids import GROUND, ROOF, SOFFIT, TERRAIN, WALL
from ..stage import LayerFeatures, feature_names

# Attributes of a face: the building that it is part of, the level of detail, and roof, wall, ground, window, door,
# terrain or soffit; and the patch that a triangle of terrain is part of.
BUILDING, LEVEL, KIND, PATCH = "building", "lod", "kind", "patch"
KINDS = (ROOF, WALL, GROUND, WINDOW, DOOR, TERRAIN, SOFFIT)

# Levels of detail, of which files get their names.
_LEVELS = re.compile(r"\d(\.\d)?")

# Faces of unknown kind are walls if the vertical part of their unit normal is less than this: slopes over 80°.
_UPRIGHT = 0.17


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
    """Return whether a face with this exterior (k, 3), counterclockwise from outside, is a wall, roof or ground."""
    normal = area_vector(ring)
    if abs(normal[2]) < _UPRIGHT * np.linalg.norm(normal):
        return WALL
    return ROOF if normal[2] > 0 else GROUND
