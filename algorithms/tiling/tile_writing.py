"""The tiles of a survey's output: one for each file, or for each block of a large file that is cut by its index."""

import re
from collections import Counter
from collections.abc import Collection, Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Optional

import numpy as np

from ..cloud.cloud import Cloud
from ..cloud.crs import Crs
from ..cloud.dimensions import DIMENSIONS
from ..cloud.files import read_cloud, readable, write_cloud
from ..cloud.header import OF_OLD_POINTS
from ..cloud.outputs import COPC, stem_of
from ..cloud.points import EVERYWHERE, chunks_near, open_header
from ..stage import Monitor
from .array_files import write_arrays
from .block_result import BlockResult
from .blocks import REFERRING, Block, StoppableMonitor
from .survey import SHOWN, Source, boxes_meet
from .tiled_run import JOINED, RunSettings, TilesOutcome, WorkedOn
from .views import View
from .workers import run_all

# What follows the name of a file in the names of its pieces: the lower left corner of a block.
_CORNER = re.compile(r"_-?\d+_-?\d+")


@dataclass(frozen=True)
class TileTask:
    """A tile of the output: the file that it is made of, and the blocks that have its points."""

    source: Source  #: The file that the tile is made of
    number: int  #: Its number in the survey
    target: Path  #: The tile
    results: list[Path]  #: Results of the blocks that have its points
    becomes: list[Path]  #: Files with the final numbers of the objects of each of these blocks
    stop: Path  #: A file whose existence ends the work
    crs: Crs  #: CRS of the survey, which files that name none get
    extent: Optional[np.ndarray] = None  #: (2, 2): extent of the survey, in coordinates of the file; None is all
    #: (2, 2): box, m, of the part of the file that becomes this tile, upper edges excluded; None is all
    piece: Optional[np.ndarray] = None
    view: Optional[View] = None  #: Keeps points for the pages of the survey; None where no page shows points
    shown: Optional[Path] = None  #: COPC file of the tile that is written for QGIS to show


@dataclass(frozen=True)
class Tile:
    """A tile that was written."""

    path: Optional[Path]  #: The file; None where none of its points stay
    points: int  #: How many points it has
    left_out: int  #: How many of its points the chain has left out


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
            found = f"{accounted:,} of the {len(survey):,} points read"
            outcome.failures.append(f"The tiles account for {found}; do not use them.")

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
                for (block, result), final in ((done[at], becomes[at]) for at in near):
                    tasks.append(self._tile(number, f"{stem}_{block.name}", [result], [final], block.box))
                worked_on = sum(len(rows_of(done[at][1], number)) for at in near)
                if worked_on < source.header.count and survey.is_whole and not is_lost:
                    outcome.failures.append(points_outside(source.path, source.header.count - worked_on))
            elif is_lost:
                outcome.failures.append(f"{source.path.name} is not written, as a block of it failed.")
            else:
                tasks.append(self._tile(number, stem, [done[at][1] for at in near], [becomes[at] for at in near]))
        return tasks

    def _tile(
        self, number: int, name: str, parts: list[Path], numbers: list[Path], piece: Optional[np.ndarray] = None
    ) -> TileTask:
        """Return the task of a tile that a file, or a piece of it, becomes."""
        settings, survey = self.settings, self.outcome.survey
        target = settings.folder / f"{name}{settings.options.suffix}"
        shown = settings.folder / SHOWN / f"{name}{COPC}" if settings.options.shown else None
        of_survey = settings.stop, survey.crs, survey.extent
        return TileTask(survey.sources[number], number, target, parts, numbers, *of_survey, piece, self.view, shown)


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


def points_outside(path: Path, count: int) -> str:
    """Return the sentence on a file of which ``count`` points are in no block."""
    # Files are assigned to blocks by the bounds in their headers.
    return f"{path.name} has {count} points outside the bounds in its header; repair its header first."


def rows_of(result: Path, number: int) -> np.ndarray:
    """Return the rows (n,) of the records of a file in the results of a block."""
    with np.load(result, allow_pickle=False) as stored:
        return np.flatnonzero(stored["source"] == number)


def write_tile(task: TileTask) -> Tile:
    """Write a tile with what its blocks found; return it.

    Raises
    ------
    ValueError
        If a file can't be read or written, or has changed since the run began.
    """
    is_whole = task.extent is None and task.piece is None and task.source.header.spacing is None
    position = None if is_whole else _positions(task)
    if position is not None and not len(position):
        return Tile(None, 0, 0)
    monitor = StoppableMonitor(task.stop)
    cloud = _points_of(task, position, monitor)
    task.source.check_state()
    stays, values, worked_on = _results_of_blocks(task, position, len(cloud))
    if worked_on != len(cloud):
        raise ValueError(points_outside(task.source.path, len(cloud) - worked_on))
    rows = np.flatnonzero(stays)
    if not len(rows):
        return Tile(None, 0, len(cloud))
    left_out = len(cloud) - len(rows)
    cloud = cloud if len(rows) == len(cloud) else cloud.take(rows)
    for name, whole in values.items():
        cloud.set(name, whole[rows] - cloud.origin if name == "xyz" else whole[rows])
    for target in filter(None, (task.target, task.shown)):
        write_cloud(cloud, target, monitor)
    if task.view is not None:
        task.view.add(task.target.name, cloud)
    return Tile(task.target, len(cloud), left_out)


def _results_of_blocks(
    task: TileTask, position: Optional[np.ndarray], count: int
) -> tuple[np.ndarray, dict[str, np.ndarray], int]:
    """Return the mask of points (n,) of a tile that stay, their values by blocks, and the number of these blocks."""
    stays = np.ones(count, bool)
    values: dict[str, np.ndarray] = {}
    worked_on = 0
    for path, numbers in zip(task.results, task.becomes):
        result = BlockResult.read(path)
        rows = np.flatnonzero(result.source == task.number)
        if not len(rows):
            continue
        worked_on += len(rows)
        own = result.position[rows] if position is None else np.searchsorted(position, result.position[rows])
        if len(result.stays):
            stays[own] = result.stays[rows]
        with np.load(numbers, allow_pickle=False) as final:
            for name, of_block in result.dimensions.items():
                number = REFERRING.get(name, name)
                own_values = of_block[rows]
                if number in final.files:
                    # Numbers beyond the final ones are of segments that no block keeps: they become 0.
                    own_values = final[number][np.where(own_values < len(final[number]), own_values, 0)]
                if name not in values:
                    # A block that lacks a dimension of an earlier run leaves it undefined.
                    values[name] = np.full((count, *own_values.shape[1:]), DIMENSIONS[name].undefined, own_values.dtype)
                values[name][own] = own_values
    return stays, values, worked_on


def _points_of(task: TileTask, position: Optional[np.ndarray], monitor: Monitor) -> Cloud:
    """Return the points of a file that a tile is made of, in its order; of a part those at ``position`` (n,)."""
    path, spacing = task.source.path, task.source.header.spacing
    if position is None or (task.piece is None and spacing is None):
        # A worker has nothing to look systems up in.
        return read_cloud(path, monitor, lambda _: task.crs, task.extent)
    header = replace(open_header(path), reach=task.extent, spacing=spacing)
    box = task.extent if task.piece is None else task.piece / task.crs.horizontal
    found = [np.empty(0, header.layout.dtype)]
    with readable(path):
        for start, records in chunks_near(path, header, EVERYWHERE if box is None else box, monitor):
            first, end = np.searchsorted(position, [start, start + len(records)])
            found.append(records[position[first:end] - start])
    header = replace(header.without(*OF_OLD_POINTS), count=len(position))
    return Cloud(header, np.concatenate(found), task.crs, [path])


def _positions(task: TileTask) -> np.ndarray:
    """Return the positions (n,) in a file of its points within the extent, ascending: every one is in one block."""
    found = [np.zeros(0, np.int64)]
    for path in task.results:
        with np.load(path, allow_pickle=False) as stored:
            found.append(stored["position"][stored["source"] == task.number])
    return np.sort(np.concatenate(found))
