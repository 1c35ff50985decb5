"""Which tiles a run writes: one for each file, or for each block of a large file that is cut by its index."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any, Optional

import numpy as np

from ..cloud.outputs import COPC, stem_of
from ..cloud.points import open_header
from .array_files import write_arrays
from .blocks import Block
from .survey import Source, boxes_meet
from .tiled_run import JOINED, RunSettings, TilesOutcome, WorkedOn
from .tiles import TileTask, points_outside, rows_of, write_tile
from .views import View
from .workers import run_all

# The folder among the tiles with the COPC files that QGIS shows.
SHOWN = "shown"


class TileWriter:
    """Writes every tile whose blocks are all done, and says which can't be written.

    Parameters
    ----------
    settings : RunSettings
        Folders and options of the run.
    outcome : TilesOutcome
        Receives the tiles and the failures.
    by_index : list of Path
        Files of the survey that are cut by their index: each of their blocks becomes a tile.
    view : View, optional
        See :attr:`.TileTask.view`.
    """

    def __init__(
        self, settings: RunSettings, outcome: TilesOutcome, by_index: list[Path], view: Optional[View]
    ) -> None:
        self.settings, self.outcome, self.by_index, self.view = settings, outcome, by_index, view

    def write(self, executor: Any, blocks: WorkedOn) -> None:
        """Write the tiles; add them to the outcome, and what went wrong."""
        settings, outcome = self.settings, self.outcome
        tasks = self._tasks(blocks, self._final_numbers(blocks))
        part = settings.monitor.part(JOINED, 1.0)
        results, errors = run_all(executor, write_tile, tasks, settings.stop, part, lambda _: None)
        outcome.tiles = [results[at] for at in sorted(results) if results[at] is not None]
        if outcome.survey.extent is not None:
            outcome.points = sum(open_header(tile).count for tile in outcome.tiles)
        outcome.failures += [f"{tasks[at].source.name}: {why}" for at, why in sorted(errors.items())]

    def _final_numbers(self, blocks: WorkedOn) -> list[Path]:
        """Write what the numbers of each block become; return the files."""
        paths = [self.settings.work / f"numbers-{block.name}.npz" for block, _ in blocks.done]
        for path, of_block in zip(paths, blocks.numbers):
            write_arrays(path, of_block)
        return paths

    def _tasks(self, blocks: WorkedOn, becomes: list[Path]) -> list[TileTask]:
        """Return the tiles to write."""
        settings, outcome, survey = self.settings, self.outcome, self.outcome.survey
        if settings.options.shown:
            (settings.folder / SHOWN).mkdir(exist_ok=True)
        tasks: list[TileTask] = []
        done, boxes, lost = blocks.done, _boxes(blocks.done_blocks), _boxes([block for block, _ in blocks.failed])
        for number, (source, stem) in enumerate(zip(survey.sources, unique_stems(survey.sources))):
            near = np.flatnonzero(boxes_meet(boxes, source.box))
            is_lost = boxes_meet(lost, source.box).any()
            if source.path in self.by_index:
                tasks += self._pieces(number, stem, [(*done[at], becomes[at]) for at in near])
                worked_on = sum(len(rows_of(done[at][1], number)) for at in near)
                if worked_on < source.header.count and survey.extent is None and not is_lost:
                    outcome.failures.append(points_outside(source.path, source.header.count - worked_on))
            elif is_lost:
                outcome.failures.append(f"{source.path.name} is not written, as a block of it failed.")
            else:
                parts, final = tuple(done[at][1] for at in near), tuple(becomes[at] for at in near)
                tasks.append(self._tile(source.path, number, stem, parts, final))
        return tasks

    def _pieces(self, number: int, stem: str, blocks: list[tuple[Block, Path, Path]]) -> list[TileTask]:
        """Return the tiles of a file that is cut by its index: one for each block, with its result and numbers."""
        path = self.outcome.survey.sources[number].path
        return [
            self._tile(path, number, f"{stem}_{block.name}", (result,), (numbers,), block.box)
            for block, result, numbers in blocks
        ]

    def _tile(
        self,
        path: Path,
        number: int,
        name: str,
        parts: tuple[Path, ...],
        numbers: tuple[Path, ...],
        piece: Optional[np.ndarray] = None,
    ) -> TileTask:
        """Return the task of a tile that a file, or a piece of it, becomes."""
        settings, survey = self.settings, self.outcome.survey
        target = settings.folder / f"{name}{settings.options.suffix}"
        shown = settings.folder / SHOWN / f"{name}{COPC}" if settings.options.shown else None
        of_survey = settings.stop, survey.units, survey.extent
        return TileTask(path, number, target, parts, numbers, *of_survey, piece, self.view, settings.options.crs, shown)


def _boxes(blocks: list[Block]) -> np.ndarray:
    """Return the boxes (k, 2, 2) of blocks, m."""
    return np.array([block.box for block in blocks]).reshape(-1, 2, 2)


def unique_stems(sources: Iterable[Source]) -> list[str]:
    """Return the names of files without extension, each once, also where two folders have files of one name."""
    # Some file systems don't distinguish upper from lower case.
    taken: dict[str, str] = {}
    for source in sources:
        stem = name = stem_of(source.path)
        again = 1
        while name.lower() in taken:
            again += 1
            name = f"{stem}_{again}"
        taken[name.lower()] = name
    return list(taken.values())
