"""Planes as polygons: the cells of a plane that hold its points, outlined and lifted onto it."""

import numpy as np

from ..criteria import CELL_SPACINGS
from ..geometry.cell_outlines import outline_cells
from ..geometry.grid import Grid, connected_cells, grid_over
from ..geometry.polylines import simplify_ring
from ..geometry.rings import is_valid, signed_area
from ..planes.least_squares_planes import planes_of
from ..stage import Field, LayerFeatures

PLANE_FIELDS = (
    Field("id", int, "number of the plane, as SegmentID of its points", numbers="segment_id"),
    Field("points", int, "points on the plane"),
    Field("slope", float, "slope of the plane: 0 is level, 90 a wall", "°"),
    Field("aspect", float, "direction that the plane faces, clockwise from north; empty where it is level", "°"),
    Field("area", float, "area of the polygon, measured on the plane", "m²"),
    Field("rms", float, "root mean square distance of the points from the plane", "m"),
)

# How far cells with points reach beyond the edge of a surface (cells). With four points to a cell on average, a cell of
# which the surface covers the share f has one with the probability 1 - exp(-4 f).
_OVERSHOOT = 0.5 - (1 - np.exp(-(CELL_SPACINGS**2))) / CELL_SPACINGS**2

# Slope (°) below which a plane faces no direction.
_LEVEL = 0.5


def plane_polygons(xyz: np.ndarray, label: np.ndarray, offset: int, density: float) -> LayerFeatures:
    """Return the largest piece of each plane as a polygon with heights.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m).
    label : ndarray of shape (n,), int
        Plane of each point, from 1; 0 if unassigned.
    offset : int
        Number that is added to these in the layer.
    density : float
        Points per square meter of surface.
    """
    on_plane = np.flatnonzero(label > 0)
    geometries: list = []
    columns: dict[str, list] = {field.name: [] for field in PLANE_FIELDS}
    if len(on_plane):
        planes = planes_of(xyz[on_plane], label[on_plane] - 1, int(label.max()))
        order = np.argsort(label[on_plane], kind="stable")
        for number, part in enumerate(np.split(on_plane[order], np.cumsum(planes.count)[:-1].astype(np.int64))):
            normal, center = planes.normal[number], planes.center[number]
            rings = _outline(xyz[part], center, normal, CELL_SPACINGS / np.sqrt(density))
            area = sum(signed_area(ring) for ring in rings)
            level, upward = plane_axes(normal)
            geometries.append([center + ring[:, :1] * level + ring[:, 1:] * upward for ring in rings])
            slope = float(np.degrees(np.arccos(np.clip(normal[2], 0, 1))))
            aspect = float(np.degrees(np.arctan2(normal[0], normal[1])) % 360) if slope > _LEVEL else float("nan")
            rms = float(np.sqrt(max(planes.eigenvalues[number, 2], 0)))
            for field, value in zip(PLANE_FIELDS, (number + 1 + offset, len(part), slope, aspect, area, rms)):
                columns[field.name].append(value)
    return LayerFeatures(geometries, columns)


def plane_axes(normal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return two unit vectors (3,) on a plane, the second up the slope: with the unit normal a right-handed frame."""
    level = np.array([-normal[1], normal[0], 0.0])
    length = float(np.linalg.norm(level))
    first = level / length if length > 1e-9 else np.array([1.0, 0.0, 0.0])
    return first, np.cross(normal, first)


def _outline(xyz: np.ndarray, center: np.ndarray, normal: np.ndarray, cell: float) -> list:
    """Return the rings (m, 2) on the plane of the largest group of cells that hold points."""
    first, second = plane_axes(normal)
    positions = np.column_stack([(xyz - center) @ first, (xyz - center) @ second])
    grid = grid_over(positions, cell)
    cells, count = np.unique(grid.number(positions), return_counts=True)
    return outline_of_cells(grid, cells, count, _OVERSHOOT * cell)


def outline_of_cells(grid: Grid, cells: np.ndarray, count: np.ndarray, overshoot: float) -> list:
    """Return the rings (m, 2) around the largest group of cells, simplified by a cell and drawn in.

    Where that makes no valid polygon, they run along the sides of the cells.

    Parameters
    ----------
    grid : Grid
        The cells.
    cells : ndarray of shape (k,), int64
        Numbers of those that are covered.
    count : ndarray of shape (k,)
        What each counts for the size of its group.
    overshoot : float
        By how much rings are drawn in, m.
    """
    n_groups, group = connected_cells(grid, cells)
    cells = cells[group == np.argmax(np.bincount(group, count, n_groups))]
    rings = outline_cells(grid, cells, np.zeros(len(cells), np.int64))[0]
    simple = [_inset(simplify_ring(ring, grid.size), overshoot) for ring in rings]
    simple = [ring for ring in simple if len(ring) >= 4 and abs(signed_area(ring)) > grid.size**2]
    is_sound = bool(simple) and signed_area(simple[0]) > 0 and all(signed_area(hole) < 0 for hole in simple[1:])
    return simple if is_sound and is_valid(simple) else rings


def _inset(ring: np.ndarray, distance: float) -> np.ndarray:
    """Return a closed ring whose edges are moved to their left, into the polygon, by a distance (m)."""
    step = np.diff(ring, axis=0)
    along = step / np.maximum(np.linalg.norm(step, axis=1, keepdims=True), 1e-12)
    left = np.column_stack([-along[:, 1], along[:, 0]])
    before = np.roll(left, 1, axis=0)
    # Both edges at a corner are moved; at a sharp one the corner goes no farther than twice the distance.
    corner = (before + left) / np.maximum(1 + (before * left).sum(axis=1), 0.5)[:, None]
    moved = ring[:-1] + distance * corner
    return np.concatenate([moved, moved[:1]])
