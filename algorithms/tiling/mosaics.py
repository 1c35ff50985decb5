"""Rasters of a survey from the parts of its blocks: without seams, never whole in memory."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .block_result import BlockResult


@dataclass(frozen=True)
class RasterMosaic:
    """A raster in parts, each in the file of its block."""

    name: str  #: The composite's output
    #: west, north: Outer edges, m from the survey's origin
    west: float
    north: float
    cell_size: float  #: Side of a cell, m
    shape: tuple[int, int]  #: Rows and columns
    #: For each part the file, and the row and the column of its north-western cell
    parts: tuple[tuple[Path, int, int], ...]

    def __iter__(self) -> Iterator[tuple[int, int, np.ndarray]]:
        """Yield the row and the column of the north-western cell of each part, and its cells.

        They are float32, the northern ones first, NaN where there is nothing.
        """
        for path, row, column in self.parts:
            yield row, column, BlockResult.raster(path, self.name)


def join_rasters(paths: list[Path], found: list[BlockResult]) -> list[RasterMosaic]:
    """Return each raster of a survey from what blocks made of it.

    Parameters
    ----------
    paths : list of Path
        The files of the blocks.
    found : list of BlockResult
        Their contents; the cells themselves are left there.
    """
    mosaics = []
    for name in dict.fromkeys(name for one in found for name in one.lattices):
        lattices = np.array([one.lattices[name] if name in one.lattices else np.zeros(5) for one in found])
        has = np.flatnonzero((lattices[:, 2:4] > 0).all(axis=1))
        if not len(has):
            continue
        south, west, rows, columns, size = lattices[has].T
        top, left = (south + rows).max(), west.min()
        at = np.column_stack([top - south - rows, west - left]).astype(int).tolist()
        shape = int(top - south.min()), int((west + columns).max() - left)
        parts = tuple((paths[one], *where) for one, where in zip(has, at))
        mosaics.append(RasterMosaic(name, float(left * size[0]), float(top * size[0]), float(size[0]), shape, parts))
    return mosaics
