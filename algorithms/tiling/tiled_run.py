"""Settings and results of a run in tiles."""

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Callable, Optional

import numpy as np

from ..cloud.crs import CrsReader, read_crs
from ..cloud.outputs import LAS, LAZ
from ..pipeline import CLOUD, Pipeline
from ..sampling.cloud_sampling import CloudSampling
from ..stage import FileContent, LayerFeatures, Monitor, Report
from .block_result import BlockResult
from .blocks import Block
from .joining import RasterMosaic
from .survey import Survey
from .tiled_steps import part_of
from .workers import Workers

# Progress when the survey is sampled, large files are cut, blocks are worked on, and layers are joined; the rest is
# writing.
SAMPLED, CUT, WORKED, JOINED = 0.05, 0.1, 0.88, 0.9

# Functions that find the given layers of a composite, and that take its rasters and text files.
FindLayers = Callable[[Survey], dict[str, Optional[LayerFeatures]]]
TakeRaster = Callable[[Survey, RasterMosaic], None]
TakeFile = Callable[[Survey, str, FileContent], None]


@dataclass(frozen=True)
class TilesOptions:
    """How a survey is read, processed and written in tiles, and the functions that pass layers, rasters and files."""

    #: Processes of this machine, by default one for each core
    workers: Workers = Workers()
    #: Side of a block, m; None is the largest multiple of 10 m with room for its points, from 100 to 1600 m, or less
    #: where none has room
    block_side: Optional[float] = None
    #: Points of the largest file that is read as it is: of a larger one too much is read again for each of its blocks
    largest_file: int = 25_000_000
    #: Least and greatest easting and northing (2, 2), in coordinates of the files: only points within are worked on,
    #: and written, edges included
    extent: Optional[np.ndarray] = None
    #: Sides of cubes (3,), in units of the files, of which only the lowest point is worked on and written; None is all
    spacing: Optional[np.ndarray] = None
    #: As for :func:`.read_cloud`
    read: CrsReader = read_crs
    #: Names of the outputs besides the tiles that are made; None is all of them
    wanted: Optional[tuple[str, ...]] = None
    #: Tiles as LAZ, or as LAS
    compressed: bool = True
    #: Write each tile as COPC too, into a folder "shown" among the tiles: QGIS shows the points of no other tiles
    shown: bool = False
    #: Is given the survey, and returns by name the layers that the composite is given, in meters from its origin
    find_layers: Optional[FindLayers] = None
    #: Is given the survey and each raster, while the parts of it are there
    take_raster: Optional[TakeRaster] = None
    #: Is given the survey, and name and content of each text file, while the parts of it are there
    take_file: Optional[TakeFile] = None

    @property
    def suffix(self) -> str:
        """Extension of the tiles."""
        return LAZ if self.compressed else LAS


@dataclass(frozen=True)
class RunSettings:
    """Arguments of :func:`.run_in_tiles.run_in_tiles`, and the folder of the work in progress."""

    pipeline: Pipeline
    folder: Path
    work: Path
    monitor: Monitor
    options: TilesOptions
    tunables: dict[str, Any]

    @cached_property
    def working(self) -> Pipeline:
        """The steps that the tiles and the wanted outputs need; the names of its outputs may be others."""
        wanted = self.options.wanted
        names = [output.name for output in self.pipeline.outputs] if wanted is None else wanted
        return part_of(self.pipeline, self.pipeline.steps_for({CLOUD, *names}))

    @property
    def steps(self) -> tuple[str, ...]:
        """Names of the steps that are run."""
        return tuple(step.name for step in self.working.steps)

    @property
    def stop(self) -> Path:
        """The file at which workers stop as soon as it exists."""
        return self.work / "stop"


@dataclass(frozen=True)
class WorkedOn:
    """The blocks of a survey once they are worked on."""

    done: list[tuple[Block, Path]]  #: Blocks with their results, in the order of their positions
    failed: list[tuple[Block, str]]  #: Blocks that failed, and why
    found: list[BlockResult]  #: Results of the blocks that are done, without points
    #: For each block that is done and each numbered dimension what its numbers become, once blocks are joined
    numbers: list[dict[str, np.ndarray]] = field(default_factory=list)

    @property
    def done_blocks(self) -> list[Block]:
        """The blocks that are done."""
        return [block for block, _ in self.done]


@dataclass
class TilesOutcome:
    """The results of a survey: the tiles written, layers in meters from ``survey.origin``, reports, errors.

    ``side`` is the side of the blocks, m.

    ``tries`` are of all blocks, see :class:`.BlockResult`. ``seconds`` has the sum over the blocks for each step,
    and ``values`` the different values of automatic tunables and others that blocks found.
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

    def take(self, blocks: WorkedOn) -> None:
        """Take over failed blocks, the costs of blocks, and the values that they found."""
        self.blocks = len(blocks.done) + len(blocks.failed)
        self.failures = [f"Block {block.name}: {why}" for block, why in blocks.failed]
        found: dict[str, set] = {}
        for result in blocks.found:
            self.tries = np.concatenate([self.tries, result.tries])
            for step, seconds in result.seconds.items():
                self.seconds[step] = self.seconds.get(step, 0.0) + float(seconds)
            for name, value in result.values.items():
                found.setdefault(name, set()).add(value.item())
        self.values = {name: sorted(values) for name, values in found.items()}
