"""Run a composite on a survey of any size: block by block in several processes, tile by tile into a folder."""

from __future__ import annotations

import hashlib
import json
import shutil
import time
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any, Callable, Optional, Union

import numpy as np

from ..cloud.cloud import Cloud, create_cloud
from ..cloud.copc_index import has_index
from ..cloud.files import readable
from ..cloud.outputs import COPC, LAS, LAZ, replacing, stem_of
from ..cloud.points import open_header
from ..cloud.units import Resolver
from ..pipeline import REPORT, Pipeline, Step
from ..report.hillshade import CELLS
from ..run import run_stage
from ..sampling.cloud_sampling import CloudSampling
from ..stage import FileContent, LayerFeatures, Monitor, Report
from .block_result import BlockResult
from .blocks import Block, BlockTask, work_on_block
from .cutting import cut_into_tiles
from .joined_files import join_files
from .joining import References, feature_numbers, join_belonging, join_features, join_numbers, refer_to_features
from .mosaics import RasterMosaic, join_rasters
from .survey import Source, Survey, boxes_meet, check_folder, files_of_survey, open_survey
from .survey_sampling import samplings_of
from .tiled_steps import afterwards, in_blocks, layers_of, made_by, owners, tunables_of, why_whole
from .tiles import TileTask, points_outside, rows_of, write_tile
from .views import View
from .work_folder import remove_work, work_folder
from .workers import Workers, run_all

# A window has at most about this many points, so that a worker needs 1.8 GB (340 bytes per point). Two of them, one
# with a window that was enlarged, need less than 4 GB with the main process.
_MOST_POINTS = 5_300_000

# Sides of blocks are multiples of the step from the least to the greatest, m; smaller ones would work mostly on what
# lies around them.
_SIDE_STEP, _LEAST_SIDE, _MOST_SIDE = 50.0, 100.0, 1600.0

# In dense clouds sides are multiples of a smaller step (m), and their least
# value a multiple of the distance around a block: the block is then a seventh of its window.
_DENSE_STEP, _LEAST_HALOS = 10.0, 1.25

# A file of more points is cut first: read again for each of its blocks it would be read too often.
_LARGEST_FILE = 25_000_000

# Shares of the progress: cutting, sampling, blocks, layers; the rest is writing.
_CUT, _SAMPLED, _WORKED, _JOINED = 0.05, 0.1, 0.88, 0.9

# Largest number of blocks, and least mean number of points of a block in a survey of more: otherwise a single point far
# away makes the extent too large.
_MANY_BLOCKS, _POINTS_PER_BLOCK = 10_000, 100

# What finds the layers that a composite is given, and what takes the rasters and text files that it makes.
FindLayers = Callable[[Survey], dict[str, Optional[LayerFeatures]]]
TakeRaster = Callable[[Survey, RasterMosaic], None]
TakeFile = Callable[[Survey, str, FileContent], None]

# The folder among the tiles with the COPC files that QGIS shows.
SHOWN = "shown"

# Seconds between two messages about how far it is.
_BETWEEN_MESSAGES = 10.0


@dataclass
class TilesOutcome:
    """What came of a survey: the tiles written, layers in meters from ``survey.origin``, reports, what went wrong.

    ``side`` is that of the blocks, m.

    ``tries`` are those of all blocks, see :class:`.BlockResult`; ``seconds`` are those of each step in all blocks, and
    ``values`` those that automatic tunables and others had in blocks, each once.
    """

    survey: Survey
    tiles: list[Path]
    layers: dict[str, LayerFeatures] = field(default_factory=dict)
    reports: dict[str, Report] = field(default_factory=dict)
    failures: list[str] = field(default_factory=list)
    sampling: Optional[CloudSampling] = None
    blocks: int = 0
    side: float = 0.0
    points: int = 0
    tries: np.ndarray = field(default_factory=lambda: np.zeros((0, 4)))
    seconds: dict[str, float] = field(default_factory=dict)
    values: dict[str, list] = field(default_factory=dict)

    def add(self, results: Iterable[BlockResult]) -> None:
        """Take over what blocks cost, and the values that they found."""
        found: dict[str, set] = {}
        for result in results:
            self.tries = np.concatenate([self.tries, result.tries])
            for step, seconds in result.seconds.items():
                self.seconds[step] = self.seconds.get(step, 0.0) + float(seconds)
            for name, value in result.values.items():
                found.setdefault(name, set()).add(value.item())
        self.values = {name: sorted(values) for name, values in found.items()}


def run_in_tiles(
    pipeline: Pipeline,
    paths: Iterable[Union[str, Path]],
    folder: Union[str, Path],
    monitor: Optional[Monitor] = None,
    *,
    workers: Optional[Workers] = None,
    block_side: Optional[float] = None,
    compressed: bool = True,
    crs_units: Optional[Resolver] = None,
    largest_file: int = _LARGEST_FILE,
    extent: Optional[np.ndarray] = None,
    find_layers: Optional[FindLayers] = None,
    take_raster: Optional[TakeRaster] = None,
    take_file: Optional[TakeFile] = None,
    crs: Optional[tuple[str, str]] = None,
    shown: bool = False,
    **tunables: Any,
) -> TilesOutcome:
    """Run a composite on a survey; write its classified tiles to a folder and return its layers.

    The survey is worked on in blocks of a lattice that starts at the zero of the map, each with the points around it
    as far as the steps reach. So the result does not depend on how the points are spread over files. How the cloud was
    sampled is measured once for all blocks. Segments that go on in the next block get one number, and features that
    several blocks found come once. A run that was stopped goes on where it was when it is started again with the same
    files, tunables and version.

    Parameters
    ----------
    pipeline : Pipeline
        A composite that works on one cloud and keeps its points.
    paths : iterable of str or Path
        Files, virtual point clouds or folders. Each file becomes a tile of the same name; a file of more than
        ``largest_file`` points becomes tiles of the size of a block. It is cut by its index where it is a COPC file,
        else into pieces that lie uncompressed beside the tiles while they are worked on.
    folder : str or Path
        Where the tiles go; it is made where it is missing.
    monitor : Monitor, optional
        Receives progress, and how far it is in words.
    workers : Workers, optional
        Processes of this machine, one for each core, where nothing is given.
    block_side : float, optional
        Side of a block, m; None is the largest multiple of 50 m from 100 to 1600 m with room for its points, of 10 m
        where none has.
    compressed : bool
        Tiles as LAZ, or as LAS.
    crs_units : callable, optional
        As for :func:`.read_cloud`.
    largest_file : int
        Points of the largest file that is read as it is.
    extent : ndarray of shape (2, 2), optional
        Least and greatest easting and northing, in coordinates of the files: only points within are worked on, and
        written, edges included.
    find_layers : callable, optional
        Is given the survey, and returns by name the layers that the composite is given, in meters from its origin.
    take_raster : callable, optional
        Is given the survey and each raster, while the parts of it are there.
    take_file : callable, optional
        Is given the survey, and name and content of each text file, while the parts of it are there.
    crs : tuple of str, optional
        The coordinate reference system of files that name none, as for :func:`.open_survey`; tiles get it too.
    shown : bool
        Write each tile as COPC too, into a folder "shown" among the tiles: QGIS shows the points of no other tiles.
    **tunables
        Of the composite.

    Raises
    ------
    ValueError
        If the composite can't be run in tiles, an input can't be read or is in the folder, another run works in it, or
        a tunable is unknown.
    """
    monitor, workers, folder = monitor or Monitor(), workers or Workers(), Path(folder)
    check_can_be_tiled(pipeline)
    for step, chosen in pipeline.by_step(tunables):
        step.stage.check(chosen)
    given = [Path(path) for path in paths]
    survey = open_survey(given, crs_units, monitor, extent, crs)
    check_folder(folder, [*files_of_survey(given), *given])
    with work_folder(folder) as work:
        run = _Run(pipeline, survey, folder, work, monitor, workers, tunables, compressed, crs_units)
        run.find_layers, run.take_raster, run.take_file = find_layers, take_raster, take_file
        run.crs, run.shown = crs, shown
        outcome = run.all(block_side, largest_file)
    if not outcome.failures:
        # Windows removes no lock that is open.
        remove_work(work)
    return outcome


def check_can_be_tiled(pipeline: Pipeline) -> None:
    """Refuse a composite whose points or steps can't be put together from parts.

    Raises
    ------
    ValueError
        With the step that can't be run in tiles, and why.
    """
    why = why_whole(pipeline)
    if why:
        raise ValueError(f"{pipeline.title} can't be run in tiles: {why}; run it on each tile by itself.")


def can_be_tiled(pipeline: Pipeline) -> bool:
    """Whether a composite can be run in tiles: it works on one cloud, and no step of it is decided by the whole."""
    return not why_whole(pipeline)


class _Run:
    """One run: what all its steps need."""

    def __init__(
        self,
        pipeline: Pipeline,
        survey: Survey,
        folder: Path,
        work: Path,
        monitor: Monitor,
        workers: Workers,
        tunables: dict[str, Any],
        compressed: bool,
        crs_units: Optional[Resolver],
    ) -> None:
        self.crs_units = crs_units
        self.pipeline, self.survey, self.folder, self.work = pipeline, survey, folder, work
        self.monitor, self.workers, self.tunables = monitor, workers, tunables
        self.suffix = LAZ if compressed else LAS
        self.stop = work / "stop"
        # Large files that are cut by their index.
        self.by_index: list[Path] = []
        self.find_layers: Optional[FindLayers] = None
        self.take_raster: Optional[TakeRaster] = None
        self.take_file: Optional[TakeFile] = None
        self.view: Optional[View] = None
        self.crs: Optional[tuple[str, str]] = None
        self.shown = False

    def all(self, block_side: Optional[float], largest_file: int) -> TilesOutcome:
        """Sample, work on the blocks, write the tiles."""
        given = self.survey
        halo = self.pipeline.reach(self.tunables)
        samplings = samplings_of(self.pipeline, given, self.tunables, self.monitor.part(0.0, _CUT))
        sampling = samplings[""]
        side = block_side or _side(sampling.density, halo)
        self.monitor.resolved(sampling=sampling)
        self.monitor.inform(f"Blocks of {side:g} m, each worked on with {halo:.4g} m around it.")
        self._cut_large_files(side, largest_file)
        outcome = TilesOutcome(self.survey, [], sampling=sampling, side=side, points=len(self.survey))
        with self.workers.open({source.path.parent for source in given.sources} | {self.folder}) as executor:
            blocks, results, failed = self._work_on_blocks(executor, side, halo, samplings)
            outcome.blocks = len(blocks)
            outcome.failures = [f"Block {blocks[number].name}: {why}" for number, why in sorted(failed.items())]
            done = [(blocks[number], results[number]) for number in sorted(results)]
            found = [BlockResult.read(path, with_points=False) for _, path in done]
            outcome.add(found)
            positions = [block for block, _ in done]
            numbers = join_numbers(
                positions, found, lambda at: BlockResult.edges(done[at][1]), feature_numbers(self.pipeline, found)
            )
            joining = self.monitor.part(_WORKED, _JOINED)
            outcome.layers, kept = self._layers(positions, found, numbers, joining)
            steps = afterwards(self.pipeline)
            self._run_on_layers([step for step in steps if not step.stage.shows], outcome)
            if self.take_raster:
                for mosaic in join_rasters([path for _, path in done], found):
                    self.take_raster(self.survey, mosaic)
            if self.take_file:
                for name, content in join_files(self.pipeline, [path for _, path in done], kept).items():
                    self.take_file(self.survey, name, content)
            self._warn_of_blocks(found)
            paged = [step for step in steps if step.stage.shows]
            self.view = self._view(paged, outcome) if paged and outcome.layers else None
            self._write_tiles(executor, done, numbers, [blocks[number] for number in failed], outcome)
            self._run_on_layers(paged, outcome)
        if not outcome.failures:
            # Nothing is left to go on with.
            remove_work(self.work)
        self.monitor.progress(1.0)
        return outcome

    def _cut_large_files(self, side: float, largest_file: int) -> None:
        """Cut files that are too large to be read once for each of their blocks, and take the pieces in their place.

        Of a COPC file each block reads what it needs.
        """
        large = [source for source in self.survey.sources if source.header.count > largest_file]
        self.by_index = [source.path for source in large if has_index(source.header)]
        large = [source for source in large if source.path not in self.by_index]
        if not large:
            return
        pieces = self.work / "pieces"
        key = self._key([source.path for source in large], side, str(self.survey.extent))
        if not (pieces / key).is_file():
            shutil.rmtree(pieces, ignore_errors=True)
            pieces.mkdir()
            for done, (source, stem) in enumerate(zip(large, _unique_stems(large))):
                part = self.monitor.part(_CUT, _SAMPLED).part(done / len(large), (done + 1) / len(large))
                alone = open_survey([source.path], self.crs_units, extent=self.survey.extent, crs=self.crs)
                cut_into_tiles(alone, side, pieces, stem, False, part)
            (pieces / key).touch()
        rest = [source.path for source in self.survey.sources if source not in large]
        whole, paths = self.survey, [*rest, *sorted(pieces.glob(f"*{LAS}"))]
        self.survey = open_survey(paths, self.crs_units, extent=whole.extent, crs=self.crs)
        if whole.extent is None and len(self.survey) != len(whole):
            raise ValueError(
                f"The pieces of large files have {len(self.survey):,} of {len(whole):,} points; remove {self.work} and "
                "start again."
            )

    def _key(self, paths: Iterable[Path], *facts: Any) -> str:
        """Return a name for the result of files in their present state, of facts, tunables and this version."""
        described = [[_state(path) for path in paths], self.pipeline.name, self.tunables, _version(), facts]
        return hashlib.sha256(json.dumps(described, default=str, sort_keys=True).encode()).hexdigest()[:16]

    def _work_on_blocks(
        self, executor: Any, side: float, halo: float, samplings: dict[str, CloudSampling]
    ) -> tuple[list[Block], dict[int, Path], dict[int, str]]:
        """Have all blocks worked on that are not done yet; return blocks, results and failures by position."""
        blocks = _blocks(self.survey, side)
        tasks = [self._task(block, halo, samplings) for block in blocks]
        known = {number: task.result for number, task in enumerate(tasks) if BlockResult.is_complete(task.result)}
        if known:
            self.monitor.inform(
                f"{len(known)} of {len(blocks)} blocks were worked on before and are taken as they are."
            )
        todo = [number for number in range(len(blocks)) if number not in known]
        tell = self._teller(len(todo), self.survey.expected * len(todo) / max(1, len(blocks)))
        results, failed = run_all(
            executor,
            work_on_block,
            [tasks[number] for number in todo],
            self.stop,
            self.monitor.part(_SAMPLED, _WORKED),
            tell,
        )
        known.update({todo[at]: path for at, path in results.items()})
        return blocks, known, {todo[at]: why for at, why in failed.items()}

    def _task(self, block: Block, halo: float, samplings: dict[str, CloudSampling]) -> BlockTask:
        margin = np.array([[-8 * halo], [8 * halo]])
        near = self.survey.near(block.box + margin)
        # Results identify files by their numbers, which change when a file is added or taken away.
        key = self._key(
            (self.survey.sources[one].path for one in near),
            near,
            block.name,
            block.side,
            halo,
            {name: (str(one), one.corner.tolist(), one.of_whole) for name, one in samplings.items()},
            str(self.survey.extent),
            str(self.survey.units),
        )
        part = Survey(
            tuple(self.survey.sources[one] for one in near),
            self.survey.header,
            self.survey.units,
            self.survey.wkt,
            self.survey.origin,
            self.survey.extent,
        )
        result = self.work / f"block-{block.name}-{key}.npz"
        tunables = tunables_of(in_blocks(self.pipeline), self.tunables)
        return BlockTask(block, part, tuple(near), self.pipeline.name, tunables, samplings, halo, result, self.stop)

    def _teller(self, blocks: int, points: float) -> Callable[[int], None]:
        """Return a function that logs from time to time how many blocks are done, how fast, and the time left."""
        start = last = time.monotonic()
        done = 0

        def tell(_: int) -> None:
            nonlocal done, last
            done += 1
            now = time.monotonic()
            if now - last > _BETWEEN_MESSAGES or done == blocks:
                last = now
                pace = done / max(now - start, 1e-9)
                self.monitor.inform(
                    f"{done} of {blocks} blocks, {pace * points / max(1, blocks):,.0f} points per second, "
                    f"{_minutes((blocks - done) / pace)} left."
                )

        return tell

    def _layers(
        self, blocks: list[Block], found: list[BlockResult], numbers: list[dict[str, np.ndarray]], monitor: Monitor
    ) -> tuple[dict[str, LayerFeatures], dict[str, np.ndarray]]:
        """Return each layer of the composite, of all blocks together, and block and number of the features kept."""
        names = list(dict.fromkeys(name for result in found for name in result.layers))
        layers: dict[str, LayerFeatures] = {}
        kept: dict[str, np.ndarray] = {}
        owner, declared = owners(self.pipeline), layers_of(self.pipeline)
        clusters = [of_block.get("cluster_id", np.zeros(0, np.int32)) for of_block in numbers]
        references = {one.numbers: References.of(found, one.numbers) for one in declared.values() if one.numbers}
        for number, name in enumerate(sorted(names, key=lambda name: name in owner)):
            part = monitor.part(number / len(names), (number + 1) / len(names))
            # A block without points has no layers, any other one has all of them.
            of_blocks = [result.layers.get(name, LayerFeatures([], {})) for result in found]
            if name in owner:
                column, of = owner[name]
                layers[name] = join_belonging(of_blocks, clusters, column, kept[of])
                continue
            layers[name], kept[name] = join_features(
                blocks,
                of_blocks,
                clusters,
                self.survey.origin,
                part,
                declared[name],
                references.get(declared[name].numbers),
                [result.pieces.get(name, np.zeros(0, bool)) for result in found] if declared[name].whole else None,
            )
        for dimension, of_features in references.items():
            refer_to_features(numbers, dimension, of_features.known)
        return {name: layers[name] for name in names}, kept

    def _view(self, steps: list[Step], outcome: TilesOutcome) -> View:
        """Return what the tiles keep of their points for the pages of steps."""
        boxes = [np.zeros((0, 2, 2))]
        for step in steps:
            layers = self._layers_of(step, outcome, {})
            boxes.append(step.stage.shows(**layers))  # type: ignore[misc]
        # Of a survey without extent any cell will do.
        cell = float(np.ptp(self.survey.box, axis=0).max()) / CELLS or 1.0
        return View(self.work, self.survey.origin, cell, np.concatenate(boxes))

    def _layers_of(
        self, step: Step, outcome: TilesOutcome, given: dict[str, Optional[LayerFeatures]]
    ) -> dict[str, Optional[LayerFeatures]]:
        """Return the layers that a step reads, by the names that it gives them."""
        names = {(output.step.name, output.of): output.name for output in self.pipeline.outputs}
        return {
            one.name: outcome.layers[names[made_by(step.layers[one.name])]]
            if one.name in step.layers
            else given.get(one.name)
            for one in step.stage.input_layers
        }

    def _run_on_layers(self, steps: list[Step], outcome: TilesOutcome) -> None:
        """Run steps on the layers of the whole survey, pages with what the tiles have kept of their points."""
        if not steps or not outcome.layers:
            return
        given = self.find_layers(self.survey) if self.find_layers else {}
        names = {(output.step.name, output.of): output.name for output in self.pipeline.outputs}
        chosen = {step.name: of_step for step, of_step in self.pipeline.by_step(self.tunables)}
        for step in steps:
            monitor = self.monitor.part(_JOINED, _JOINED, f"{step.name}_")
            cloud = self._shown(outcome) if step.stage.shows else None
            layers = self._layers_of(step, outcome, given)
            made = run_stage(step.stage, cloud, monitor=monitor, input_layers=layers, **chosen[step.name])
            outcome.layers.update({names[step.name, of]: features for of, features in made.layers.items()})
            if made.report is not None:
                outcome.reports[names[step.name, REPORT]] = made.report

    def _shown(self, outcome: TilesOutcome) -> Optional[Cloud]:
        """Return the points that the tiles have kept, None without any."""
        if self.view is None:
            return None
        xyz, classification = self.view.points(outcome.tiles)
        if not len(xyz):
            return None
        return create_cloud({"xyz": xyz, "classification": classification})

    def _warn_of_blocks(self, found: list[BlockResult]) -> None:
        """Pass on each warning once, and in how many of the blocks with points it was given, if not in all.

        That steps found nothing is passed on only if all blocks say so.
        """
        count = sum(len(result.tries) > 0 for result in found)
        for sentence, given in Counter(one for result in found for one in result.messages).items():
            self.monitor.warn(sentence if given == count else f"In {given} of {count} blocks: {sentence}")
        for sentence, given in Counter(one for result in found for one in result.absent).items():
            if given == count:
                self.monitor.none_found(sentence)

    def _pieces(self, number: int, stem: str, blocks: list[tuple[Block, Path, Path]]) -> list[TileTask]:
        """Return the tiles that a file becomes which is cut by its index: one for each block, result and numbers."""
        path = self.survey.sources[number].path
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
        survey, target = self.survey, self.folder / f"{name}{self.suffix}"
        shown = self.folder / SHOWN / f"{name}{COPC}" if self.shown else None
        task = TileTask(path, number, target, parts, numbers, self.stop, survey.units, survey.extent, piece, self.view)
        return replace(task, crs=self.crs, shown=shown)

    def _write_tiles(
        self,
        executor: Any,
        done: list[tuple[Block, Path]],
        numbers: list[dict[str, np.ndarray]],
        failed: list[Block],
        outcome: TilesOutcome,
    ) -> None:
        """Write every tile whose blocks are all done."""
        becomes = []
        for (block, _), of_block in zip(done, numbers):
            becomes.append(self.work / f"numbers-{block.name}.npz")
            with replacing(becomes[-1]) as stream:
                np.savez(stream, **of_block)
        if self.shown:
            (self.folder / SHOWN).mkdir(exist_ok=True)
        tasks = []
        stems = _unique_stems(self.survey.sources)
        boxes, lost = (_boxes(some) for some in ([block for block, _ in done], failed))
        for number, (source, stem) in enumerate(zip(self.survey.sources, stems)):
            near = np.flatnonzero(boxes_meet(boxes, source.box))
            if source.path in self.by_index:
                tasks += self._pieces(number, stem, [(*done[at], becomes[at]) for at in near])
                worked_on = sum(len(rows_of(done[at][1], number)) for at in near)
                whole = self.survey.extent is None
                if worked_on < source.header.count and whole and not boxes_meet(lost, source.box).any():
                    outcome.failures.append(points_outside(source.path, source.header.count - worked_on))
                continue
            if boxes_meet(lost, source.box).any():
                outcome.failures.append(f"{source.path.name} is not written, as a block of it failed.")
                continue
            parts, final = tuple(done[at][1] for at in near), tuple(becomes[at] for at in near)
            tasks.append(self._tile(source.path, number, stem, parts, final))
        results, errors = run_all(
            executor, write_tile, tasks, self.stop, self.monitor.part(_JOINED, 1.0), lambda _: None
        )
        outcome.tiles = [results[at] for at in sorted(results) if results[at] is not None]
        if self.survey.extent is not None:
            outcome.points = sum(open_header(tile).count for tile in outcome.tiles)
        outcome.failures += [f"{tasks[at].source.name}: {why}" for at, why in sorted(errors.items())]


def _side(density: float, halo: float) -> float:
    """Return the largest side of a block, m, whose window has room for its points."""
    fits = np.sqrt(_MOST_POINTS / density) - 2 * halo
    if fits >= _LEAST_SIDE:
        return float(min(np.floor(fits / _SIDE_STEP) * _SIDE_STEP, _MOST_SIDE))
    least = max(np.ceil(_LEAST_HALOS * halo / _DENSE_STEP), 1.0) * _DENSE_STEP
    return float(min(max(np.floor(fits / _DENSE_STEP) * _DENSE_STEP, least), _LEAST_SIDE))


def _blocks(survey: Survey, side: float) -> list[Block]:
    """Return the blocks that files of the survey reach into, from south-west to north-east.

    Raises
    ------
    ValueError
        If there are many more than the points can fill.
    """
    lowest, highest = (np.floor(survey.boxes[:, end] / side) for end in (0, 1))
    count = (highest - lowest + 1).prod(axis=1)
    if count.sum() > max(_MANY_BLOCKS, len(survey) / _POINTS_PER_BLOCK):
        file = survey.sources[int(np.argmax(count))].path.name
        raise ValueError(
            f"The {len(survey):,} points are spread over {count.sum():,.0f} blocks of {side:g} m, most of them in "
            f"{file}; remove points that lie far off in plan."
        )
    found = set()
    for low, high in zip(lowest.astype(int), highest.astype(int)):
        found |= {(column, row) for row in range(low[1], high[1] + 1) for column in range(low[0], high[0] + 1)}
    return [Block(column, row, side) for column, row in sorted(found, key=lambda position: position[::-1])]


def _boxes(blocks: list[Block]) -> np.ndarray:
    """Return the boxes (k, 2, 2) of blocks, m."""
    return np.array([block.box for block in blocks]).reshape(-1, 2, 2)


def _unique_stems(sources: Iterable[Source]) -> list[str]:
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


def _state(path: Path) -> tuple[str, int, int]:
    """Return what identifies a state of a file: where it is, its size, when it was written."""
    with readable(path):
        stat = path.stat()
    return str(path.resolve()), stat.st_size, stat.st_mtime_ns


def _minutes(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 100 else f"{seconds / 60:.0f} min"


@cache
def _version() -> str:
    """Return what identifies a state of the program: a digest of its source."""
    digest = hashlib.sha256()
    for path in sorted(Path(__file__).resolve().parents[1].rglob("*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()
