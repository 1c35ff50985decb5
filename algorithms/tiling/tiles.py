"""The tiles of a survey's output: the points of a file, or of a piece of it, with the results of the blocks."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Optional

import numpy as np

from ..cloud.cloud import Cloud
from ..cloud.crs import Crs
from ..cloud.dimensions import DIMENSIONS
from ..cloud.files import read_cloud, readable, write_cloud
from ..cloud.header import OF_OLD_POINTS
from ..cloud.points import EVERYWHERE, chunks_near, open_header
from ..stage import Monitor
from .block_result import BlockResult
from .blocks import REFERRING, StoppableMonitor
from .survey import Source
from .views import View


@dataclass(frozen=True)
class TileTask:
    """A tile of the output: the file that it is made of, and the blocks that have its points."""

    source: Source  #: The file that the tile is made of
    number: int  #: Its number in the survey
    target: Path  #: The tile
    results: tuple[Path, ...]  #: Results of the blocks that have its points
    becomes: tuple[Path, ...]  #: Files with the final numbers of the objects of each of these blocks
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
    write_cloud(cloud, task.target, monitor)
    if task.shown is not None:
        write_cloud(cloud, task.shown, monitor)
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
