"""Write the tiles of a run: one for each file, or for each block of a large file that is cut by its index."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterable
from pathlib import Path
from typing import Any, Optional

import numpy as np

from ..cloud.outputs import COPC, stem_of
from ..cloud.points import open_header
from .array_files import write_arrays
from .blocks import Block
from .survey import SHOWN, Source, boxes_meet
from .tiled_run import JOINED, RunSettings, TilesOutcome, WorkedOn
from .tiles import Tile, TileTask, points_outside, rows_of, write_tile
from .views import View
from .workers import run_all

# What follows the name of a file in the names of its pieces: the lower left corner of a block.
_CORNER = re.compile(r"_-?\d+_-?\d+")


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
        """Write the tiles; add them and their errors to the outcome."""
        settings, outcome = self.settings, self.outcome
        tasks = self._tasks(blocks, self._final_numbers(blocks))
        part = settings.monitor.part(JOINED, 1.0)
        _check_targets(tasks)
        results, errors = run_all(executor, write_tile, tasks, settings.stop, part, lambda _: None)
        outcome.failures += [f"{tasks[at].source.path.name}: {why}" for at, why in sorted(errors.items())]
        self._take([results[at] for at in sorted(results)])

    def _take(self, written: list[Tile]) -> None:
        """Take over the tiles; hold the points that are in the files now against those that were read."""
        outcome, survey = self.outcome, self.outcome.survey
        in_files = 0
        for tile in written:
            if tile.path is None:
                continue
            outcome.tiles.append(tile.path)
            count = open_header(tile.path).count
            in_files += count
            if count != tile.points:
                outcome.failures.append(f"{tile.path.name} has {count:,} points of the {tile.points:,} written to it.")
        if not survey.is_whole:
            outcome.points = in_files
        accounted = in_files + sum(tile.left_out for tile in written)
        if survey.is_whole and not outcome.failures and accounted != len(survey):
            outcome.failures.append(
                f"The tiles account for {accounted:,} of the {len(survey):,} points read; do not use them."
            )

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
        for number, (source, stem) in enumerate(zip(survey.sources, unique_stems(survey.sources, self.by_index))):
            near = np.flatnonzero(boxes_meet(boxes, source.box))
            is_lost = boxes_meet(lost, source.box).any()
            if source.path in self.by_index:
                tasks += self._pieces(number, stem, [(*done[at], becomes[at]) for at in near])
                worked_on = sum(len(rows_of(done[at][1], number)) for at in near)
                if worked_on < source.header.count and survey.is_whole and not is_lost:
                    outcome.failures.append(points_outside(source.path, source.header.count - worked_on))
            elif is_lost:
                outcome.failures.append(f"{source.path.name} is not written, as a block of it failed.")
            else:
                parts, final = tuple(done[at][1] for at in near), tuple(becomes[at] for at in near)
                tasks.append(self._tile(source, number, stem, parts, final))
        return tasks

    def _pieces(self, number: int, stem: str, blocks: list[tuple[Block, Path, Path]]) -> list[TileTask]:
        """Return the tiles of a file that is cut by its index: one for each block, with its result and numbers."""
        source = self.outcome.survey.sources[number]
        return [
            self._tile(source, number, f"{stem}_{block.name}", (result,), (numbers,), block.box)
            for block, result, numbers in blocks
        ]

    def _tile(
        self,
        source: Source,
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
        of_survey = settings.stop, survey.crs, survey.extent
        return TileTask(source, number, target, parts, numbers, *of_survey, piece, self.view, shown)


def _boxes(blocks: list[Block]) -> np.ndarray:
    """Return the boxes (k, 2, 2) of blocks, m."""
    return np.array([block.box for block in blocks]).reshape(-1, 2, 2)


def _check_targets(tasks: list[TileTask]) -> None:
    """Refuse tiles of which two would be one file, whatever their names were made of.

    Raises
    ------
    ValueError
        With the name that two have.
    """
    for name, count in Counter(str(task.target).lower() for task in tasks).items():
        if count > 1:
            raise ValueError(f"{count} tiles would be written to {name}; give the files of the survey other names.")


def unique_stems(sources: Iterable[Source], by_index: Collection[Path] = ()) -> list[str]:
    """Return the names of files without extension, each once, also where two folders have files of one name.

    Those ``by_index`` become tiles with the corner of a block behind the name: none has the name of another file then.
    """
    sources = list(sources)
    # Some file systems don't distinguish upper from lower case.
    taken: set[str] = set()
    stems: dict[int, str] = {}
    for number in sorted(range(len(sources)), key=lambda number: sources[number].path in by_index):
        path = sources[number].path
        stem = name = stem_of(path)
        again = 1
        while name.lower() in taken or (path in by_index and _is_of_piece(name.lower(), taken)):
            again += 1
            name = f"{stem}_{again}"
        taken.add(name.lower())
        stems[number] = name
    return [stems[number] for number in range(len(sources))]


def _is_of_piece(stem: str, names: Iterable[str]) -> bool:
    """Whether a piece of a file of this name could have one of these names."""
    return any(one.startswith(stem) and _CORNER.fullmatch(one, len(stem)) for one in names)
