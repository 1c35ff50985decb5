"""Settings and results of a run in tiles."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Callable, Optional

import numpy as np

from ..cloud.units import Resolver
from ..pipeline import Pipeline
from ..sampling.cloud_sampling import CloudSampling
from ..stage import FileContent, LayerFeatures, Monitor, Report
from .block_result import BlockResult
from .blocks import Block
from .mosaics import RasterMosaic
from .survey import Survey
from .workers import Workers

# Shares of the progress: cutting, sampling, blocks, layers; the rest is writing.
CUT, SAMPLED, WORKED, JOINED = 0.05, 0.1, 0.88, 0.9

# What finds the layers that a composite is given, and what takes the rasters and text files that it makes.
FindLayers = Callable[[Survey], dict[str, Optional[LayerFeatures]]]
TakeRaster = Callable[[Survey, RasterMosaic], None]
TakeFile = Callable[[Survey, str, FileContent], None]


@dataclass(frozen=True)
class RunSettings:
    """Arguments of :func:`.run_in_tiles.run_in_tiles`, and the folder of the work in progress."""

    pipeline: Pipeline
    folder: Path
    work: Path
    monitor: Monitor
    workers: Workers
    tunables: dict[str, Any]
    suffix: str  #: Extension of the tiles: LAZ or LAS
    crs_units: Optional[Resolver]
    crs: Optional[tuple[str, str]]
    shown: bool
    find_layers: Optional[FindLayers]
    take_raster: Optional[TakeRaster]
    take_file: Optional[TakeFile]

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
    def positions(self) -> list[Block]:
        """The blocks that are done."""
        return [block for block, _ in self.done]


@dataclass
class TilesOutcome:
    """The results of a survey: the tiles written, layers in meters from ``survey.origin``, reports, what went wrong.

    ``side`` is that of the blocks, m.

    ``tries`` are those of all blocks, see :class:`.BlockResult`. ``seconds`` has the sum over the blocks for each step,
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
        """Take over which blocks failed, what blocks cost, and the values that they found."""
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
