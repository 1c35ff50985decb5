"""A scene seen from above: height, class and object of the visible surface in fine cells."""

from dataclasses import dataclass

import numpy as np

from ..cloud.asprs import PointClass
from ..packages import ndimage
from .beams import vegetation_class
from .bodies import Body
from .scene import Scene

# Side of a cell, m: finer than the point spacing of drone clouds.
CELL = 0.1


@dataclass
class HeightField:
    """The visible surface of each cell."""

    #: ground, top, (rows, columns): elevation of the ground and of the visible surface, m
    ground: np.ndarray
    top: np.ndarray
    #: classification, object_id, (rows, columns): class and object of the visible surface
    classification: np.ndarray
    object_id: np.ndarray

    def at(self, xy: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the row and column of the cells at positions (n, 2), m."""
        column, row = np.floor(xy / CELL).astype(np.int64).T
        return np.clip(row, 0, self.top.shape[0] - 1), np.clip(column, 0, self.top.shape[1] - 1)

    def beside(self) -> tuple[np.ndarray, np.ndarray]:
        """Return, for each cell, the row and column of the nearest cell that is not ground."""
        is_ground = self.classification == PointClass.GROUND
        if is_ground.all():
            row, column = np.indices(is_ground.shape)
        else:
            row, column = ndimage.distance_transform_edt(is_ground, return_distances=False, return_indices=True)
        return row, column


def see_from_above(scene: Scene, unevenness: float, rng: np.random.Generator) -> HeightField:
    """Return the visible surface of a scene, with closed lumpy crowns, on ground of the given unevenness (m)."""
    middle = (np.arange(round(scene.size / CELL)) + 0.5) * CELL
    x, y = np.meshgrid(middle, middle)
    ground = scene.relief.ground(x, y)
    # Gardens, curbs and ruts: two wavelengths (m) with shares whose squares add up to about one.
    ground += unevenness * sum(share * smooth_noise(x.shape, long, rng) for long, share in ((2.5, 0.25), (8.0, 0.97)))
    field = HeightField(
        ground, ground.copy(), np.full(x.shape, PointClass.GROUND, np.uint8), np.zeros(x.shape, np.int32)
    )
    # Lumps of crowns: two wavelengths and heights (m).
    lumps = sum(height * smooth_noise(x.shape, width, rng) for width, height in ((1.2, 0.35), (0.5, 0.15)))
    for crown in scene.crowns:
        _add_crown(field, crown, lumps)
    for solid in scene.solids:
        _add_solid(field, solid)
    return field


def smooth_noise(shape: tuple[int, int], wavelength: float, rng: np.random.Generator) -> np.ndarray:
    """Return a smooth random field (rows, columns) of standard deviation 1 with about the given wavelength (m)."""
    sigma = wavelength / CELL / 4
    # Computed on coarse cells and interpolated: as smooth, and faster for long waves.
    step = max(1, int(sigma))
    coarse = rng.standard_normal((shape[0] // step + 8, shape[1] // step + 8))
    smooth = ndimage.gaussian_filter(coarse, sigma / step)
    smooth /= smooth.std()
    rows, columns = (np.arange(k) / step + 3.0 for k in shape)
    return ndimage.map_coordinates(smooth, np.meshgrid(rows, columns, indexing="ij"), order=1)


def _window(field: HeightField, corners: np.ndarray) -> tuple[tuple[slice, slice], np.ndarray, np.ndarray]:
    """Return the cells in the box around corners (k, 2), m, and the easting and northing of their centers."""
    shape = field.top.shape
    first = np.clip(np.floor(corners.min(axis=0) / CELL).astype(int), 0, [shape[1], shape[0]])
    last = np.clip(np.ceil(corners.max(axis=0) / CELL).astype(int), 0, [shape[1], shape[0]])
    x, y = np.meshgrid(*((np.arange(a, b) + 0.5) * CELL for a, b in zip(first, last)))
    return (slice(first[1], last[1]), slice(first[0], last[0])), x, y


def _raise_cells(field: HeightField, where: tuple, higher: np.ndarray, z: np.ndarray, classes, number: int) -> None:
    field.top[where][higher] = z[higher]
    field.classification[where][higher] = np.broadcast_to(classes, higher.shape)[higher]
    field.object_id[where][higher] = number


def _add_solid(field: HeightField, solid: Body) -> None:
    where, x, y = _window(field, solid.rect.corners())
    z = solid.top(x, y)
    higher = solid.rect.contains(x, y) & (z > field.top[where])
    _raise_cells(field, where, higher, z, solid.classification, solid.object_id)


def _add_crown(field: HeightField, crown: tuple, lumps: np.ndarray) -> None:
    x0, y0, z0, radius, half, _, number = crown
    reach = 1.2 * radius
    where, x, y = _window(field, np.array([(x0 - reach, y0 - reach), (x0 + reach, y0 + reach)]))
    # Lumps of small crowns are smaller.
    lump = lumps[where] * min(1.0, radius / 1.5)
    inside = 1 - np.hypot(x - x0, y - y0) ** 2 / (radius + 0.4 * lump) ** 2
    z = z0 + half * np.sqrt(np.maximum(inside, 0.0)) + lump
    higher = (inside > 0) & (z > field.top[where])
    _raise_cells(field, where, higher, z, vegetation_class(z - field.ground[where]), int(number))
