"""Images on the faces of models, from the colors of points, and one image for all of a file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Optional

import numpy as np

from ..footprints.footprint_points import rows_near
from ..geometry.polygons import area_vector, axes_across
from ..packages import ndimage
from ..stage import Monitor
from .exported_models import ExportedModel, Face, Texture

# Points within this distance (m) of a face color it: noise, tiles, sills.
_NEAR = 0.3

# A face has an image if points are seen on this share of its texels at least; one of its kind's color is more honest.
_SEEN = 0.1

# Widest image (texels): what browsers of any device show.
_WIDEST = 8192


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
    """Return the texture of a face, None where hardly any point is on it."""
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
    if (count > 0).sum() < _SEEN * size or not on.any():
        return None
    sums = np.column_stack([np.bincount(cell, band, size) for band in colors[on].T])
    mean = (sums / np.maximum(count, 1)[:, None]).reshape(height, width, 3)
    rows, columns = ndimage.distance_transform_edt(
        count.reshape(height, width) == 0, return_distances=False, return_indices=True
    )
    return Texture(start, axes / texel, mean[rows, columns].astype(np.uint8))


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
