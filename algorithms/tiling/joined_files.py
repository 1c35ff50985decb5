"""Rasters and text files of a survey, from what its blocks have kept: never whole in memory, rasters without seams."""

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional

import numpy as np

from ..pipeline import Pipeline
from ..stage import FileContent, FileItem, LayerFeatures
from .block_result import BlockResult
from .joining import new_names
from .tiled_steps import files_of


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


def join_files(
    pipeline: Pipeline, steps: Collection[str], results: list[Path], kept: dict[str, np.ndarray], layers: dict
) -> dict[str, FileContent]:
    """Return the text files of a composite, by its names: each item once, block by block.

    Parameters
    ----------
    pipeline : Pipeline
        The composite.
    steps : collection of str
        Names of its steps that were run.
    results : list of Path
        Files of :meth:`.BlockResult.write`, which stay until the text is written.
    kept : dict of str to ndarray of shape (m, 3), int64
        Of each layer, from :func:`.join_features`: of the features that stay their position among ``results``, their
        number in that block, and their number in the survey.
    layers : dict of str to LayerFeatures
        All layers of the survey, joined.
    """
    made = [output.name for output in pipeline.outputs if output.step.name in steps]
    return {
        name: FileContent(_Items(results, file.item, new_names(kept[of]), layers.get(file.also)), file.write)
        for name, (file, of) in files_of(pipeline).items()
        if name in made and of in kept
    }


@dataclass(frozen=True)
class _Items(Collection):
    """The items of a text file under the names of the survey, one block in memory at a time.

    ``becomes`` are the numbers in the survey by block and name there; items without one are left out.
    The features of ``also`` are items, too.
    """

    results: list[Path]
    item: type[FileItem]
    becomes: dict[tuple[int, str], int]
    also: Optional[LayerFeatures]

    def __iter__(self) -> Iterator[Any]:
        for block, path in enumerate(self.results):
            for name, record in BlockResult.items_of(path, self.item.__name__):
                if (block, name) in self.becomes:
                    yield self.item.of_record(record, str(self.becomes[block, name]))
        if self.also:
            yield from self.item.of_features(self.also)

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def __contains__(self, item: object) -> bool:
        return any(item == one for one in self)
