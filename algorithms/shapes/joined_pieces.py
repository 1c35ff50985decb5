"""Join pieces of one shape, found in overlapping parts of a cloud, to one feature."""

import numpy as np

from ..geometry.grid import grid_over
from ..geometry.polygon_overlap import are_in_polygons, as_polygons, shared_areas
from ..geometry.polygons import area_vector, axes_across
from ..geometry.rings import signed_area
from ..stage import LayerFeatures, Monitor
from .plane_polygons import outline_of_cells

# A piece is dropped if this share of it lies in the largest one.
_WITHIN = 0.95

# Size (m) of the cells around which the outline of several pieces of a plane is drawn.
_CELL = 0.1

# Largest number of these cells: in larger planes they are enlarged.
_MOST_CELLS = 2_000_000


def whole_axis(pieces: LayerFeatures, points: int) -> LayerFeatures:
    """Return the cylinder of pieces with overlapping axes, from one farthest end to the other.

    Parameters
    ----------
    pieces : LayerFeatures
        Axes (2, 3) of cylinders, m, and their fields, the longest first.
    points : int
        Points of all of them.
    """
    line = np.asarray(pieces.geometries[0])
    way = (line[1] - line[0]) / max(float(np.linalg.norm(line[1] - line[0])), 1e-12)
    ends = np.concatenate(pieces.geometries)
    along = (ends - line[0]) @ way
    axis = np.stack([ends[np.argmin(along)], ends[np.argmax(along)]])
    sizes = {"length": [float(np.linalg.norm(axis[1] - axis[0]))], "radius": [_mean(pieces, "radius")]}
    seen = {"seen": [float(max(pieces.columns["seen"]))]}
    return LayerFeatures([axis], {**_of_first(pieces, points), **sizes, **seen})


def whole_plane(pieces: LayerFeatures, points: int) -> LayerFeatures:
    """Return the plane of pieces that overlap in it, with the outline around all of them.

    Where no piece goes beyond the largest, its polygon stays as it is; else the outline is drawn around cells.

    Parameters
    ----------
    pieces : LayerFeatures
        Polygons with heights, m, and their fields, the largest first.
    points : int
        Points of all of them.
    """
    axes, start = _frame(pieces.geometries[0])
    flat = [[(ring - start) @ axes.T for ring in rings] for rings in pieces.geometries]
    polygons = as_polygons(flat)
    rest = np.arange(1, len(flat))
    shared = shared_areas(polygons, polygons, np.zeros(len(rest), np.int64), rest, Monitor())
    columns = _of_first(pieces, points)
    if (shared >= _WITHIN * np.abs(polygons.area[1:])).all():
        return LayerFeatures(pieces.geometries[:1], columns)
    rings = _outline(flat)
    columns["area"] = [sum(signed_area(ring) for ring in rings)]
    return LayerFeatures([[start + ring @ axes for ring in rings]], columns)


def _of_first(pieces: LayerFeatures, points: int) -> dict[str, list]:
    """Return the fields of the largest piece, with the number of points and the deviation of all."""
    first = {name: [values[0]] for name, values in pieces.columns.items()}
    return {**first, "rms": [float(np.sqrt(_mean(pieces, "rms", 2)))], "points": [points]}


def _mean(pieces: LayerFeatures, name: str, power: int = 1) -> float:
    """Return the mean of a field's power, pieces weighted by their points."""
    return float(np.average(np.asarray(pieces.columns[name], float) ** power, weights=pieces.columns["points"]))


def _frame(rings: list) -> tuple[np.ndarray, np.ndarray]:
    """Return two unit vectors (2, 3) along the plane of a polygon, counterclockwise as its ring, and a point of it."""
    normal = area_vector(rings[0])
    return np.stack(axes_across(normal / max(float(np.linalg.norm(normal)), 1e-12))), rings[0][:-1].mean(axis=0)


def _outline(flat: list) -> list[np.ndarray]:
    """Return the rings (m, 2) around the largest group of cells whose middles lie in polygons, simplified by a cell."""
    polygons = as_polygons(flat)
    low, high = polygons.box[:, 0].min(axis=0), polygons.box[:, 1].max(axis=0)
    cell = max(_CELL, float(np.sqrt(np.prod(high - low) / _MOST_CELLS)))
    grid = grid_over(np.stack([low, high]), cell)
    every = np.arange(grid.rows * grid.columns)
    cells = every[are_in_polygons(grid.center(every), polygons, Monitor())]
    return outline_of_cells(grid, cells, np.ones(len(cells)), 0.0)
