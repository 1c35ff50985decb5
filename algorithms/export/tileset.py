"""Models of buildings as a tileset of 3D Tiles 1.1: a quadtree of GLB files on the globe, coarse levels far away."""

import json
from collections.abc import Collection, Generator, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Callable
from urllib.parse import quote

import numpy as np

from ..criteria import EQUATORIAL_RADIUS, POLAR_RADIUS
from ..models3d.solids import ROOF
from ..stage import MapFrame, Piece
from .exported_models import ExportedModel
from .gltf import glb


def ellipsoid_positions(degrees: np.ndarray, height: np.ndarray) -> np.ndarray:
    """Return positions (n, 3), m, from the middle of the Earth.

    Parameters
    ----------
    degrees : ndarray of shape (n, 2)
        Longitudes and latitudes (°) on WGS 84.
    height : ndarray of shape (n,)
        Heights (m) above the ellipsoid.
    """
    longitude, latitude = np.radians(degrees).T
    up = _up(longitude, latitude)
    surface = up * np.array([EQUATORIAL_RADIUS, EQUATORIAL_RADIUS, POLAR_RADIUS]) ** 2
    return surface / np.sqrt((surface * up).sum(axis=1))[:, None] + height[:, None] * up


def _up(longitude: np.ndarray, latitude: np.ndarray) -> np.ndarray:
    across = np.cos(latitude)
    return np.stack([across * np.cos(longitude), across * np.sin(longitude), np.sin(latitude)], axis=-1)


@dataclass(frozen=True)
class _Site:
    """The plane that touches the ellipsoid at the middle of the models."""

    frame: MapFrame
    to_degrees: Callable[[np.ndarray], np.ndarray]
    middle: np.ndarray  #: Longitude and latitude (2,), °
    rise: float  #: Height (m) of the geoid over the ellipsoid

    @property
    def axes(self) -> np.ndarray:
        """East, north and up (3, 3) as rows."""
        longitude, latitude = np.radians(self.middle)
        east = np.array([-np.sin(longitude), np.cos(longitude), 0.0])
        up = _up(longitude, latitude)
        return np.stack([east, np.cross(up, east), up])

    @property
    def origin(self) -> np.ndarray:
        """Position (3,), m, from the middle of the Earth."""
        return ellipsoid_positions(self.middle[None], np.zeros(1))[0]

    def placed(self, local: np.ndarray) -> np.ndarray:
        """Return east, north and up (n, 3), m, of local positions (n, 3), m."""
        degrees = self.to_degrees(self.frame.to_map(local[:, :2]))
        return (ellipsoid_positions(degrees, local[:, 2] + self.rise) - self.origin) @ self.axes.T

    @property
    def transform(self) -> list[float]:
        """The matrix from here to the Earth, its columns one after the other."""
        return [float(value) for row, last in zip([*self.axes, self.origin], (0, 0, 0, 1)) for value in (*row, last)]


def tileset_pieces(models: Collection[ExportedModel], called: str, frame: MapFrame) -> Iterator[Piece]:
    """Yield the GLB files of a tileset with their names, then its JSON.

    References
    ----------
    Open Geospatial Consortium, 2023. 3D Tiles Specification 1.1. [tiles2023]
    """
    if frame.to_degrees is None:
        raise ValueError(
            "3D Tiles lie on the globe, and the models have no coordinate reference system; give them one, or leave "
            "the tileset out."
        )
    listed = list(models)
    corners = [np.concatenate([face.corners for faces in one.levels.values() for face in faces]) for one in listed]
    middle = np.mean([one.mean(axis=0) for one in corners], axis=0)
    degrees = frame.to_degrees(frame.to_map(middle[None, :2]))[0]
    site = _Site(frame, frame.to_degrees, degrees, listed[0].rise)
    placed = site.placed(np.concatenate(corners))
    starts = np.cumsum([0, *map(len, corners)])[:-1]
    boxes = np.stack([np.minimum.reduceat(placed, starts), np.maximum.reduceat(placed, starts)], axis=1)
    root = yield from _tile(listed, boxes, frame.file, site)
    asset = {"version": "1.1", "generator": "LiDAR Buildings"}
    whole = {"asset": asset, "geometricError": _extent(boxes), "root": {**root, "transform": site.transform}}
    yield json.dumps(whole, indent=1) + "\n"


# A tile as the JSON has it, after the files of its content.
_Tile = Generator[Piece, None, dict[str, Any]]


def _tile(models: Sequence[ExportedModel], boxes: np.ndarray, name: str, site: _Site, depth: int = 0) -> _Tile:
    """Yield the files of models with boxes (n, 2, 3), m, and return their tile: divided, or by levels of detail."""
    # A hundred buildings are about 1 MB. A deepest level ends the division of buildings at one position.
    if len(models) <= 100 or depth == 16:
        return (yield from _levels(models, boxes, name, site))
    middles = boxes[:, :, :2].mean(axis=1)
    quadrant = (middles > (middles.min(axis=0) + middles.max(axis=0)) / 2) @ [1, 2]
    children = []
    for number in np.unique(quadrant).tolist():
        rows = np.flatnonzero(quadrant == number)
        part = [models[row] for row in rows]
        children.append((yield from _tile(part, boxes[rows], f"{name}-{number}", site, depth + 1)))
    # Without content of its own it is divided as soon as it is seen.
    return {**_bounded(boxes, _extent(boxes)), "children": children}


def _levels(models: Sequence[ExportedModel], boxes: np.ndarray, name: str, site: _Site) -> _Tile:
    """Yield the files of a tile by levels of detail, and return it: each level has the next finer one as its child."""
    levels = sorted({level for model in models for level in model.levels}, reverse=True)
    middle = boxes.reshape(-1, 3).mean(axis=0)
    tile: dict[str, Any] = {}
    for level in levels:
        error = float(np.sqrt(np.mean([_error(model, level) ** 2 for model in models])))
        # Leave out a coarser level if its error exceeds the next finer one's by less than this (m).
        if tile and error < tile["geometricError"] + 0.1:
            continue
        file = f"{name}-{level or 'tile'}.glb"
        yield file, glb(models, level, site.placed, middle.tolist())
        finer = {"children": [tile]} if tile else {}
        tile = {**_bounded(boxes, error if tile else 0.0), "content": {"uri": quote(file)}, **finer}
    return tile


def _error(model: ExportedModel, level: str) -> float:
    """Return the greatest height (m) between corners of the best roof and the nearest corner of a coarser level."""
    best, coarse = (np.unique(_roof_heights(faces)) for faces in (model.best, model.at(level)))
    if not len(best) or not len(coarse):
        return 0.0
    return float(np.abs(best[:, None] - coarse).min(axis=1).max())


def _roof_heights(faces: Sequence[Any]) -> np.ndarray:
    return np.concatenate([np.empty(0), *(face.corners[:, 2] for face in faces if face.kind == ROOF)])


def _bounded(boxes: np.ndarray, error: float) -> dict[str, Any]:
    """Return the box around models, in the form of 3D Tiles: middle, and half of each side along its axis."""
    low, high = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
    # Vertices that are rounded to 24 bits stay within their box.
    box = np.concatenate([(low + high) / 2, np.diag((high - low) / 2 + 0.001).reshape(-1)]).round(4).tolist()
    return {"boundingVolume": {"box": box}, "geometricError": round(error, 3), "refine": "REPLACE"}


def _extent(boxes: np.ndarray) -> float:
    """Return the diagonal (m) of boxes: nothing is off by more where nothing is drawn."""
    return round(float(np.linalg.norm(boxes[:, 1].max(axis=0) - boxes[:, 0].min(axis=0))), 3)
