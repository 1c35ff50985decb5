"""Run a composite on a survey of any size: block by block in several processes, tile by tile into a folder."""

import hashlib
import json
import shutil
import time
from collections import Counter
from collections.abc import Iterable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any, Callable, NamedTuple, Optional, Union

import numpy as np

from ..cloud.laz import writing_backend
from ..cloud.outputs import LAS
from ..cloud.points import has_octree
from ..cloud.web_file import file_at, is_on_web
from ..pipeline import Pipeline
from ..sampling.cloud_sampling import CloudSampling
from ..stage import LayerFeatures, Monitor
from . import joining
from .block_plan import blocks_of, larger_blocks, memory_of, points_of_window, side_of_blocks
from .block_result import BlockResult, flat
from .blocks import MOST_HALOS, Block, BlockTask, feature_boxes, take_features, work_on_block
from .cutting import cut_into_tiles
from .survey import Source, Survey, files_of_survey, open_survey, tiles_folder
from .survey_sampling import samplings_of
from .survey_steps import SurveySteps
from .tile_writing import TileWriter, unique_stems
from .tiled_run import CUT, JOINED, SAMPLED, WORKED, RunSettings, TilesOptions, TilesOutcome, WorkedOn
from .tiled_steps import in_blocks, layers_of, owners, tunables_of, why_whole
from .work_folder import remove_work, work_folder
from .workers import BETWEEN_MESSAGES, run_all


def run_in_tiles(
    pipeline: Pipeline,
    paths: Iterable[Union[str, Path]],
    folder: Union[str, Path],
    monitor: Optional[Monitor] = None,
    options: Optional[TilesOptions] = None,
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
        Files, virtual point clouds or folders. Each file becomes a tile of the same name; a file of more points than
        ``options.largest_file`` becomes tiles of the size of a block. It is cut by its index where it is a COPC file,
        else into pieces that lie uncompressed next to the tiles while they are worked on.
    folder : str or Path
        Where the tiles go; it is made where it is missing.
    monitor : Monitor, optional
        Receives progress, and how far it is in words.
    options : TilesOptions, optional
        How files are read, worked on and written.
    **tunables
        Tunables of the composite, by their names.

    Raises
    ------
    ValueError
        If the composite can't be run in tiles, an input can't be read or is in the folder, another run works in it, or
        a tunable is unknown.
    """
    monitor, options, folder = monitor or Monitor(), options or TilesOptions(), Path(folder)
    why = why_whole(pipeline)
    if why:
        raise ValueError(f"{pipeline.title} can't be run in tiles: {why}; run it on each tile by itself.")
    for step, chosen in pipeline.by_step(tunables):
        step.stage.check(chosen)
    given = [file_at(path) for path in paths]
    survey = open_survey(given, options.read, monitor, options.extent, options.spacing)
    if options.compressed:
        writing_backend(survey.header.layout.point_format)
    with tiles_folder(folder, [*files_of_survey(given), *given]), work_folder(folder, monitor.warn) as work:
        return _Run(RunSettings(pipeline, folder, work, monitor, options, tunables), survey).all()


class _Plan(NamedTuple):
    """The samplings of a survey by step, the side of its blocks (m), and the distance (m) read around each.

    ``memory`` is what a process needs for a block (bytes).
    """

    samplings: dict[str, CloudSampling]
    side: float
    halo: float
    memory: float


class _Run:
    """One run: the survey, cut where its files are too large, and how its blocks are worked on and joined."""

    def __init__(self, settings: RunSettings, survey: Survey) -> None:
        self.settings, self.survey, self.monitor = settings, survey, settings.monitor
        # Large files that are cut by their index.
        self.by_index: list[Path] = []
        # Layers that blocks are given, m from the origin of the survey.
        wanted = in_blocks(settings.working).input_layers
        find = settings.options.find_layers if wanted else None
        found = find(survey).items() if find else ()
        self.layers = {name: one for name, one in found if name in wanted and one is not None}

    def all(self) -> TilesOutcome:
        """Sample, work on the blocks, join their objects, write the tiles."""
        settings = self.settings
        folders = {source.path.parent for source in self.survey.sources if not is_on_web(source.path)}
        plan = self._plan()
        outcome = TilesOutcome(self.survey, [], sampling=plan.samplings[""], side=plan.side, points=len(self.survey))
        steps = SurveySteps(settings, outcome)
        with settings.options.workers.open(folders | {settings.folder}, plan.memory) as executor:
            blocks = self._work_on_blocks(executor, plan)
            outcome.take(blocks)
            kept = self._join(blocks, outcome)
            steps.run_others()
            self._pass_on(blocks, kept, outcome.layers)
            view = steps.view()
            TileWriter(settings, outcome, self.by_index, view).write(executor, blocks)
            steps.run_paged(view)
        if not outcome.failures:
            # Nothing is left to go on with.
            remove_work(settings.work)
        self.monitor.progress(1.0)
        return outcome

    def _plan(self) -> _Plan:
        """Measure how the survey is sampled and choose the side of its blocks; cut files that are too large."""
        settings = self.settings
        working = settings.working
        halo = working.reach(tunables_of(working, settings.tunables))
        samplings = samplings_of(working, self.survey, settings.tunables, self.monitor.part(0.0, SAMPLED))
        density = samplings[""].density
        side = settings.options.block_side or side_of_blocks(density, halo)
        points = min(points_of_window(density, side, halo), len(self.survey))
        plan = _Plan(samplings, side, halo, memory_of(points))
        self.monitor.resolved(sampling=samplings[""])
        self.monitor.inform(f"Blocks of {side:g} m, each worked on with {halo:.4g} m around it.")
        workers = settings.options.workers
        if not (settings.options.block_side or workers.scheduler):
            extent = float(np.ptp(self.survey.box, axis=0).max())
            advice = larger_blocks(density, side, halo, workers.memory(workers.count(plan.memory)), extent)
            if advice:
                self.monitor.inform(advice)
        self._cut_large_files(side)
        return plan

    def _join(self, blocks: WorkedOn, outcome: TilesOutcome) -> dict[str, np.ndarray]:
        """Give objects that go on in the next block one number, and join layers; return the features kept of each."""
        done, paths, found = blocks.done_blocks, [path for _, path in blocks.done], blocks.found
        features = joining.feature_numbers(self.settings.pipeline, found)
        blocks.numbers[:] = joining.join_numbers(done, found, lambda at: BlockResult.edges(paths[at]), features)
        outcome.layers, kept = self._layers(blocks, self.monitor.part(WORKED, JOINED))
        return kept

    def _pass_on(self, blocks: WorkedOn, kept: dict[str, np.ndarray], layers: dict[str, LayerFeatures]) -> None:
        """Hand over rasters, text files and warnings."""
        settings, options, paths = self.settings, self.settings.options, [path for _, path in blocks.done]
        if options.take_raster:
            for mosaic in joining.join_rasters(paths, blocks.found):
                options.take_raster(self.survey, mosaic)
        if options.take_file:
            for name, content in joining.join_files(settings.pipeline, settings.steps, paths, kept, layers).items():
                options.take_file(self.survey, name, content)
        self._warn_of_blocks(blocks.found)

    def _cut_large_files(self, side: float) -> None:
        """Cut files that are too large to be read once for each of their blocks, and take the pieces in their place.

        Of a COPC file each block reads the nodes that it needs.
        """
        large = [source for source in self.survey.sources if source.header.count > self.settings.options.largest_file]
        self.by_index = [source.path for source in large if has_octree(source.path, source.header)]
        large = [source for source in large if source.path not in self.by_index]
        if not large:
            return
        pieces = self.settings.work / "pieces"
        key = self._key(large, side, str(self.survey.extent))
        if not (pieces / key).is_file():
            shutil.rmtree(pieces, ignore_errors=True)
            pieces.mkdir()
            parts = self.monitor.part(SAMPLED, CUT).parts(len(large))
            for source, stem, part in zip(large, unique_stems(large), parts):
                cut_into_tiles(self._opened([source.path]), side, pieces, stem, False, part)
            (pieces / key).touch()
        rest = [source.path for source in self.survey.sources if source not in large]
        whole, paths = self.survey, [*rest, *sorted(pieces.glob(f"*{LAS}"))]
        self.survey = self._opened(paths)
        if whole.extent is None and len(self.survey) != len(whole):
            raise ValueError(
                f"The pieces of large files have {len(self.survey):,} of {len(whole):,} points; remove "
                f"{self.settings.work} and start again."
            )

    def _opened(self, paths: list[Path]) -> Survey:
        """Return files as a survey of the same extent and spacing."""
        whole = self.survey
        return open_survey(paths, lambda _: whole.crs, None, whole.extent, whole.header.spacing)

    def _key(self, sources: Iterable[Source], *facts: Any) -> str:
        """Return a name for the result of files in the state at the start, of facts, tunables and this version."""
        settings = self.settings
        states = [[str(source.path.resolve()), *source.state] for source in sources]
        described = [states, settings.pipeline.name, settings.steps, settings.tunables, _version(), facts]
        return hashlib.sha256(json.dumps(described, default=str, sort_keys=True).encode()).hexdigest()[:16]

    def _work_on_blocks(self, executor: Any, plan: _Plan) -> WorkedOn:
        """Have all blocks worked on that are not done yet."""
        blocks = blocks_of(self.survey, plan.side)
        tasks = [self._task(block, plan) for block in blocks]
        counts = [source.header.count for source in self.survey.sources]
        is_done = [BlockResult.is_complete(task.result, counts) for task in tasks]
        known = {number: tasks[number].result for number in np.flatnonzero(is_done).tolist()}
        if known:
            of_all = f"{len(known)} of {len(blocks)} blocks"
            self.monitor.inform(f"{of_all} were worked on before and are taken as they are.")
        todo = [number for number in range(len(blocks)) if number not in known]
        log_block = self._block_log(len(todo), self.survey.expected * len(todo) / max(1, len(blocks)))
        wanted, part = [tasks[number] for number in todo], self.monitor.part(CUT, WORKED)
        results, failed = run_all(executor, work_on_block, wanted, self.settings.stop, part, log_block)
        known.update({todo[at]: path for at, path in results.items()})
        done = [(blocks[number], known[number]) for number in sorted(known)]
        lost = [(blocks[todo[at]], failed[at]) for at in sorted(failed)]
        return WorkedOn(done, lost, [BlockResult.read(path, with_points=False) for _, path in done])

    def _task(self, block: Block, plan: _Plan) -> BlockTask:
        """Return the task of a worker for a block; its result is kept under a name for all that it depends on."""
        settings, halo, samplings = self.settings, plan.halo, plan.samplings
        around = block.box + MOST_HALOS * halo * np.array([[-1], [1]])
        near, layers = self.survey.near(around), self._layers_in(around)
        part = replace(self.survey, sources=tuple(self.survey.sources[one] for one in near))
        read = str((part.extent, part.header.spacing))
        measured = {name: (str(one), one.corner.tolist(), one.of_whole) for name, one in samplings.items()}
        given = [{part: of.tolist() for part, of in flat(one).items()} for one in layers.values() if one]
        # Results identify files by their numbers, which change when a file is added or taken away.
        key = self._key(part.sources, near, block.name, block.side, halo, measured, read, str(part.crs), given)
        result = settings.work / f"block-{block.name}-{key}.npz"
        tunables = tunables_of(in_blocks(settings.pipeline), settings.tunables)
        run = settings.pipeline.name, settings.steps, tunables, samplings, layers, halo
        return BlockTask(block, part, tuple(near), *run, result, settings.stop)

    def _layers_in(self, box: np.ndarray) -> dict[str, Optional[LayerFeatures]]:
        """Return the features in a box (2, 2), m, of the layers that blocks are given."""
        low, high = box - self.survey.origin[:2]
        boxes = {name: feature_boxes(one) for name, one in self.layers.items()}
        inside = {name: ((of[:, 1] >= low) & (of[:, 0] <= high)).all(axis=1) for name, of in boxes.items()}
        return {name: take_features(one, np.flatnonzero(inside[name])) for name, one in self.layers.items()}

    def _block_log(self, blocks: int, points: float) -> Callable[[int], None]:
        """Return a function that logs from time to time how many blocks are done, how fast, and the time left."""
        start = last = time.monotonic()
        done = 0

        def log_block(_: int) -> None:
            nonlocal done, last
            done += 1
            now = time.monotonic()
            if now - last > BETWEEN_MESSAGES or done == blocks:
                last = now
                pace = done / max(now - start, 1e-9)
                speed, left = pace * points / max(1, blocks), _minutes((blocks - done) / pace)
                self.monitor.inform(f"{done} of {blocks} blocks, {speed:,.0f} points per second, {left} left.")

        return log_block

    def _layers(self, blocks: WorkedOn, monitor: Monitor) -> tuple[dict[str, LayerFeatures], dict[str, np.ndarray]]:
        """Return each layer of the composite, of all blocks together, and block and number of the features kept."""
        found, numbers = blocks.found, blocks.numbers
        names = list(dict.fromkeys(name for result in found for name in result.layers))
        layers: dict[str, LayerFeatures] = {}
        kept: dict[str, np.ndarray] = {}
        owner, declared = owners(self.settings.pipeline), layers_of(self.settings.pipeline)
        clusters = [of_block.get("cluster_id", np.zeros(0, np.int32)) for of_block in numbers]
        numbered = [layer.numbers for layer in declared.values() if layer.numbers]
        references = {dimension: joining.References.of(found, dimension) for dimension in numbered}
        for name, part in zip(sorted(names, key=lambda name: name in owner), monitor.parts(len(names))):
            # A block without points has no layers, any other one has all of them.
            of_blocks = [result.layers.get(name, LayerFeatures([], {})) for result in found]
            if name in owner:
                column, of = owner[name]
                layers[name] = joining.join_owned(of_blocks, clusters, column, kept[of])
                continue
            layer = declared[name]
            pieces = [result.pieces.get(name, np.zeros(0, bool)) for result in found] if layer.whole else None
            layers[name], kept[name] = joining.join_features(
                blocks.done_blocks,
                of_blocks,
                clusters,
                self.survey.origin,
                part,
                layer,
                references.get(layer.numbers),
                pieces,
            )
        for dimension, of_features in references.items():
            joining.refer_to_features(numbers, dimension, of_features.known)
        return {name: layers[name] for name in names}, kept

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


def _minutes(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 100 else f"{seconds / 60:.0f} min"


@cache
def _version() -> str:
    """Return the identity of a state of the program: a digest of its source."""
    digest = hashlib.sha256()
    for path in sorted(Path(__file__).resolve().parents[1].rglob("*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()
