"""Text files of a survey, from the items that its blocks have kept."""

from __future__ import annotations

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


def join_files(
    pipeline: Pipeline,
    steps: Collection[str],
    results: list[Path],
    kept: dict[str, np.ndarray],
    layers: dict[str, LayerFeatures],
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
