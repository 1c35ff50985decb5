"""One block of a survey: the chain run on its points and those around, and its results kept in a file."""

import time
from copy import copy
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Optional

import numpy as np

from ..cloud.dimensions import DIMENSIONS
from ..pipeline import Pipeline
from ..pipelines import PIPELINES
from ..run import Results, run_pipeline
from ..sampling.cloud_sampling import CloudSampling
from ..stage import Cancelled, LayerFeatures, Monitor, RasterSurface
from ..threads import BETWEEN_LOOKS
from .block_result import BlockResult
from .survey import Survey, Window, inside
from .tiled_steps import files_of, in_blocks, layers_of, owners

# Dimensions that number what points belong to: each block has numbers of its own, which are joined afterwards.
NUMBERED = ("segment_id", "cluster_id")

# Dimensions that hold the numbers of another one.
REFERRING = {"wall_of": "cluster_id"}

# Points within this distance (m) outside a block show which of its segments continue in the next one. Points of one
# segment are closer in any cloud that the methods support (0.1 points/m² and more).
_BESIDE = 4.0

# A window is enlarged where it cuts off features, to at most this many times its halo on a side.
MOST_HALOS = 8


@dataclass(frozen=True)
class Block:
    """A square of a survey that is worked on at once: column and row of a lattice from zero, and its side (m)."""

    column: int
    row: int
    side: float

    @property
    def box(self) -> np.ndarray:
        """Least and greatest easting and northing (2, 2), m; the upper edges belong to the next blocks."""
        return np.array([[self.column, self.row], [self.column + 1, self.row + 1]]) * self.side

    @property
    def name(self) -> str:
        """Name for files and messages: its lower left corner in meters."""
        return f"{self.column * self.side:.0f}_{self.row * self.side:.0f}"


@dataclass(frozen=True)
class BlockTask:
    """The task of a worker on a block: all paths are seen by all workers."""

    block: Block
    survey: Survey  #: The files that may have points around the block
    numbers: tuple[int, ...]  #: Their numbers in the whole survey
    pipeline: str  #: Name of the composite
    steps: tuple[str, ...]  #: Names of the steps that are run
    tunables: dict[str, Any]  #: Its tunables by name
    samplings: dict[str, CloudSampling]  #: Samplings of the survey, see :func:`.run_pipeline`
    layers: dict[str, Optional[LayerFeatures]]  #: Layers that the composite is given, m from the origin of the survey
    halo: float  #: How far (m) around the block points are read, at least
    result: Path  #: File for the results
    stop: Path  #: A file whose existence ends the work


class StoppableMonitor(Monitor):
    """Stops a worker when a file appears that says so; collects sentences of steps that found nothing, and seconds."""

    def __init__(self, stop: Path) -> None:
        super().__init__()
        self.stop, self._looked = stop, 0.0
        self.absent: list[str] = []
        self._begins: list[tuple[str, float]] = []

    def part(self, start: float, end: float, prefix: str = "") -> Monitor:
        """Return the monitor of a part of the work; what gives its values a prefix is a step."""
        if prefix:
            self._begins.append((prefix.rstrip("_"), time.monotonic()))
        return super().part(start, end, prefix)

    def seconds(self) -> dict[str, np.ndarray]:
        """Return the duration (s) of each step; the last one has lasted until now."""
        ends = [*(began for _, began in self._begins[1:]), time.monotonic()]
        return {name: np.array(end - began) for (name, began), end in zip(self._begins, ends)}

    def none_found(self, sentence: str) -> None:
        """Keep a sentence that is a warning if steps found nothing in all parts of the cloud."""
        self.absent.append(sentence)

    def progress(self, fraction: float) -> None:
        """Raise :class:`Cancelled` when the file is there."""
        now = time.monotonic()
        if now - self._looked > BETWEEN_LOOKS:
            self._looked = now
            if self.stop.exists():
                raise Cancelled


def work_on_block(task: BlockTask) -> Path:
    """Run the chain on a block and its surroundings; return the file of its results.

    The window is enlarged on the sides on which it cuts off a feature that has a part in the block, or on all sides
    where it holds hardly any points.

    Raises
    ------
    ValueError
        If a file can't be read or the chain refuses the points.
    """
    most = MOST_HALOS * task.halo
    # West and south, east and north of the block, m.
    margin = np.full((2, 2), task.halo)
    tries = []
    while True:
        # Warnings of a smaller window may not hold for a larger one.
        monitor = StoppableMonitor(task.stop)
        box = task.block.box + margin * [[-1], [1]]
        start = time.process_time()
        window = _window(task, box, monitor)
        read = time.process_time()
        if window is None:
            result = BlockResult(np.zeros(0, np.int32), np.zeros(0, np.int64))
            break
        # Stages reject windows of a few points.
        if len(window.cloud) < 20 and margin.max() < most:
            margin *= 2
            continue
        result, cuts = _run(task, window, box, monitor)
        tries.append((margin.max(), len(window.cloud), read - start, time.process_time() - read))
        cuts &= margin < most
        if not cuts.any():
            break
        margin[cuts] *= 2
    result.tries = np.array(tries).reshape(-1, 4)
    result.write(task.result)
    return task.result


def _window(task: BlockTask, box: np.ndarray, monitor: Monitor) -> Optional[Window]:
    """Return the points in a box, None if the block itself has none of them."""
    window = task.survey.window(box, monitor)
    if window is None or not inside(_positions(task.survey, window), task.block.box).any():
        return None
    return replace(window, source=np.array(task.numbers, np.int32)[window.source])


def _positions(survey: Survey, window: Window) -> np.ndarray:
    """Return easting and northing (n, 2) of the records of a window, m."""
    return survey.in_plan(window.cloud.points, survey.header)[window.point]


def _run(task: BlockTask, window: Window, box: np.ndarray, monitor: StoppableMonitor) -> tuple[BlockResult, np.ndarray]:
    """Run the chain on a window; return the results of the block, and on which sides (2, 2) a feature was cut off."""
    pipeline = in_blocks(PIPELINES[task.pipeline])
    positions = _positions(task.survey, window)
    wanted = [output.name for output in pipeline.outputs if output.step.name in task.steps]
    block = task.block.box - task.survey.origin[:2]
    # Features around the block are asked for as far as a step reaches that reads their layer.
    around = sum(step.stage.reach_of(chosen) for step, chosen in pipeline.by_step(task.tunables) if step.layers)
    samplings = {name: copy(one) for name, one in task.samplings.items()}
    for one in samplings.values():
        one.asked = block + np.array([[-around], [around]])
    made = run_pipeline(pipeline, window.cloud, monitor, task.layers, wanted, samplings, **task.tunables)
    seconds = monitor.seconds()
    point, stays = _result_points(window, made)
    values = _written(pipeline, made, point, task.survey.origin)
    core = inside(positions, task.block.box)
    left = stays[core] if made.selected is not None else stays[:0]
    result = BlockResult(window.source[core], window.position[core], left)
    result.dimensions = {name: of_all[core] for name, of_all in values.items()}
    _number(result, window, values, stays, positions, task.block)
    cuts = _add_layers(result, pipeline, made, task, box)
    for name, (file, of) in files_of(pipeline).items():
        if name not in made.files:
            continue
        kept = set(_names(result.layers[of].columns["id"]))
        if file.item.__name__ not in result.items:
            items = made.files[name].items
            result.items[file.item.__name__] = [(one.name, one.record()) for one in items if one.name in kept]
    for name, surface in made.rasters.items():
        result.rasters[name], result.lattices[name] = _cropped(surface, block)
    result.seconds = seconds
    found = {name: value for name, value in monitor.values.items() if isinstance(value, (bool, int, float, str))}
    result.values = {name: np.array(value) for name, value in found.items()}
    result.messages = list(dict.fromkeys(monitor.warnings))
    result.absent = list(dict.fromkeys(monitor.absent))
    return result, cuts


def _result_points(window: Window, made: Results) -> tuple[np.ndarray, np.ndarray]:
    """Return for each record of a window its point in the result (n,), 0 without one, and whether it has one (n,)."""
    if made.selected is None:
        return window.point, np.ones(len(window.point), bool)
    became = np.full(len(window.cloud), -1, np.int64)
    became[made.selected] = np.arange(len(made.selected))
    point = became[window.point]
    return np.maximum(point, 0), point >= 0


def _written(pipeline: Pipeline, made: Results, point: np.ndarray, origin: np.ndarray) -> dict[str, np.ndarray]:
    """Return the dimensions that steps wrote or cleared for each record, coordinates in m from the zero of the map."""
    cloud = made.cloud
    names = dict.fromkeys(name for step in pipeline.steps for name in step.stage.writes)
    # Numbers of an earlier run were cleared where a step writes them anew.
    names.update(dict.fromkeys(one.name for one in DIMENSIONS.values() if one.of in names))
    values = {name: cloud.get(name)[point] for name in names if cloud is not None and cloud.has(name)}
    if "xyz" in values:
        values["xyz"] = values["xyz"] + origin
    return values


def _add_layers(result: BlockResult, pipeline: Pipeline, made: Results, task: BlockTask, box: np.ndarray) -> np.ndarray:
    """Add features that have a part in the block, and those that belong to them; return where one was cut off."""
    block, owner, declared = task.block.box, owners(pipeline), layers_of(pipeline)
    cuts = np.zeros((2, 2), bool)
    for name in sorted(made.layers, key=lambda name: name in owner):
        features = made.layers[name]
        if name in owner:
            column, of = owner[name]
            kept = np.isin(_names(features.columns[column]), _names(result.layers[of].columns["id"]))
        else:
            boxes = feature_boxes(features, declared[name].radius) + task.survey.origin[:2]
            kept = (boxes[:, 0] < block[1]).all(axis=1) & (boxes[:, 1] >= block[0]).all(axis=1)
            if declared[name].numbers:
                kept |= np.isin(features.columns["id"], result.used[declared[name].numbers])
            is_cut = _cut_off(boxes, box, task.survey.box, declared[name].around)
            grows = kept
            if declared[name].whole:
                # Features longer than two halos are left in pieces, which are put together afterwards.
                grows = kept & (np.ptp(boxes, axis=1).max(axis=1) < 2 * task.halo)
                result.pieces[name] = is_cut.any(axis=(1, 2))[kept]
            cuts |= is_cut[grows].any(axis=0)
        result.layers[name] = take_features(features, np.flatnonzero(kept))
    return cuts


def _names(ids: Any) -> np.ndarray:
    """Return numbers or names of features (m,) as text."""
    return np.asarray(ids).astype(str)


def _cropped(surface: RasterSurface, box: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the cells of a raster whose middles lie in a box (2, 2), local m, and their lattice.

    See :class:`.BlockResult` for both.
    """
    size, (n_rows, n_columns) = surface.cell_size, surface.values.shape
    first = np.rint(np.array([surface.west, surface.north - n_rows * size]) / size)
    # Cells that the box begins and ends with; a middle on its lower edge belongs to it.
    low, high = np.ceil(box / size - 0.5)
    low, high = np.maximum(low, first), np.maximum(np.minimum(high, first + [n_columns, n_rows]), first)
    west, south = (low - first).astype(int)
    east, north = np.maximum((high - first).astype(int), [west, south])
    values = surface.values[n_rows - north : n_rows - south, west:east]
    return values, np.array([low[1], low[0], *values.shape, size])


def _number(
    result: BlockResult,
    window: Window,
    values: dict[str, np.ndarray],
    stays: np.ndarray,
    positions: np.ndarray,
    block: Block,
) -> None:
    """Keep in a result which numbers its points have, and the numbers of records on both sides of its edges."""
    near = inside(positions, block.box + np.array([[-_BESIDE], [_BESIDE]]))
    near &= ~inside(positions, block.box + np.array([[_BESIDE], [-_BESIDE]]))
    core = inside(positions, block.box)
    for name in (name for name in NUMBERED if name in values):
        number = np.where(stays, values[name], 0).astype(np.int64)
        others = [values[one][core & stays] for one, of in REFERRING.items() if of == name and one in values]
        records = np.column_stack([window.source, window.position, number])
        result.used[name] = np.setdiff1d(np.concatenate([number[core], *others]), [0]).astype(np.int64)
        # A point that two overlapping tiles have counts once.
        of_points = number[core][np.unique(window.point[core], return_index=True)[1]]
        count = np.bincount(of_points, minlength=int(result.used[name].max(initial=0)) + 1)
        result.counts[name] = count[result.used[name]]
        result.inside[name] = records[near & core & (number > 0)]
        result.beside[name] = records[near & ~core & (number > 0)]
        result.most[name] = records[near, 2].max(initial=0, keepdims=True)


def _cut_off(boxes: np.ndarray, window: np.ndarray, survey: np.ndarray, around: float) -> np.ndarray:
    """Return for features which sides (n, 2, 2) of the window may cut them off, by their boxes widened by ``around``.

    Sides at the end of the survey cut nothing off.
    """
    low = (boxes[:, 0] < window[0] + around) & (window[0] > survey[0])
    high = (boxes[:, 1] > window[1] - around) & (window[1] < survey[1])
    return np.stack([low, high], axis=1)


def feature_boxes(features: LayerFeatures, radius: str = "") -> np.ndarray:
    """Return the least and greatest easting and northing (n, 2, 2) of each feature.

    ``radius`` is the field with the distance (m) of its points from its geometry, "" where they lie on it.
    """
    boxes = np.zeros((len(features), 2, 2))
    for row, geometry in enumerate(features.geometries):
        plan = np.reshape(_vertices(geometry)[:, :2], (-1, 2))
        boxes[row] = plan.min(axis=0), plan.max(axis=0)
    if radius and len(features):
        boxes += np.asarray(features.columns[radius], float)[:, None, None] * [[-1], [1]]
    return boxes


def take_features(features: LayerFeatures, rows: np.ndarray) -> LayerFeatures:
    """Return some features of a layer by their positions (m,), in that order."""
    columns = {
        name: values[rows] if isinstance(values, np.ndarray) else [values[row] for row in rows]
        for name, values in features.columns.items()
    }
    return LayerFeatures([features.geometries[row] for row in rows], columns)


def _vertices(geometry: Any) -> np.ndarray:
    """Return the vertices (m, 2 or 3) of a geometry of any kind: rings, a line, a point."""
    return np.concatenate(geometry) if isinstance(geometry, list) else np.atleast_2d(geometry)
