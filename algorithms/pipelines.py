"""Composites as data: which stage feeds which, and the same chains run in memory.

The .model3 files under ``resources/models`` are generated from this module, so
the graph that a user opens in the modeller and the chain that runs here can't differ.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Optional

from .cloud.cloud import Cloud
from .run import Outcome, run_stage
from .stage import Monitor, Stage, Tunable
from .stages import STAGES


@dataclass(frozen=True)
class Step:
    """One stage of a chain; it works on the cloud that the step before it made.

    ``name`` prefixes the composite's parameters (``GROUND_CELL_SIZE``); ``tunables``
    are the defaults that differ from the stage's own.
    """

    name: str
    stage_name: str
    tunables: dict[str, Any] = field(default_factory=dict)

    @property
    def stage(self) -> Stage:
        """The stage that this step runs."""
        return STAGES[self.stage_name]


@dataclass(frozen=True)
class Pipeline:
    """A chain of stages that users meet as one algorithm.

    The last step that writes a cloud gives the composite's OUTPUT; every layer of
    every step is an output of its own. ``shared`` names tunables that are one parameter
    of the composite and go to all the steps beside them; they have the same declaration
    and default there. ``shown`` are the parameters that users meet first, in this order;
    all others are folded away.
    """

    name: str
    title: str
    group: str
    tags: str
    summary: str
    description: str
    references: str
    steps: tuple[Step, ...]
    shared: dict[str, tuple[str, ...]] = field(default_factory=dict)
    shown: tuple[str, ...] = ()

    def parameter(self, step: Step, tunable: str) -> str:
        """Return what the composite calls a step's tunable: ``ground_cell_size``, shared ``min_area``."""
        return tunable if step.name in self.shared.get(tunable, ()) else f"{step.name}_{tunable}"

    @property
    def parameters(self) -> dict[str, tuple[Step, Tunable]]:
        """Every parameter once, by name, with the first step that takes it; shown ones first."""
        found: dict[str, tuple[Step, Tunable]] = {}
        for step in self.steps:
            for tunable in step.stage.tunables.values():
                found.setdefault(self.parameter(step, tunable.name), (step, tunable))
        return {name: found[name] for name in (*self.shown, *(name for name in found if name not in self.shown))}

    @property
    def id(self) -> str:
        """Processing id, ``detectbuildings``."""
        return self.name.replace("_", "")


_SANTOS = (
    "Santos, R. C. dos, Pessoa, G. G., Carrilho, A. C., Galo, M., 2019. Building detection from LiDAR data using "
    "entropy and the k-means concept. International Archives of the Photogrammetry, Remote Sensing and Spatial "
    "Information Sciences XLII-2/W13."
)

_PIPELINES = (
    Pipeline(
        name="detect_buildings",
        title="Detect buildings",
        group="Models",
        tags="building,detection,roof,footprint,classification,entropy,k-means",
        summary="Find the buildings in a point cloud: classified points and footprints, with nothing to set.",
        description=(
            "Noise, ground and heights first; then roof surfaces and clusters of everything else above the ground, "
            "told apart by their mean entropy; then whole buildings with their walls, and their outlines. Every "
            "threshold is derived from the density and the noise of the cloud."
        ),
        references=_SANTOS,
        steps=(
            Step("noise", "classify_noise_histogram"),
            Step("ground", "classify_ground_tin"),
            Step("height", "compute_height_above_ground"),
            Step("roofs", "segment_roofs"),
            Step("buildings", "classify_buildings", {"neighborhood": "surface", "max_penetration": 0.4}),
            Step("complete", "complete_buildings"),
            Step("footprints", "extract_footprints"),
        ),
        shared={
            "min_area": ("buildings", "complete", "footprints"),
            "density": ("roofs", "buildings", "complete"),
        },
        shown=("min_area", "roofs_min_height", "ground_max_building_size", "footprints_regularize"),
    ),
    Pipeline(
        name="detect_buildings_2019",
        title="Detect buildings (as published 2019)",
        group="Models",
        tags="building,detection,entropy,k-means,region growing,Santos",
        summary="Find the buildings in a point cloud exactly as the paper of 2019 does.",
        description=(
            "The published chain with the paper's rules and nothing else: cell histogram filter, progressive TIN "
            "densification from the lowest point of each cell of the largest building's size (with a final sweep, as "
            "the paper's tool for it has), region growing, mean entropy per cluster and two-class K-means. For "
            "comparisons; 'Detect buildings' finds more and errs less."
        ),
        references=_SANTOS,
        steps=(
            Step("noise", "classify_noise_histogram"),
            Step("ground", "classify_ground_tin", {"seeds": "lowest"}),
            Step("regions", "segment_regions"),
            Step("buildings", "classify_buildings", {"guard": False}),
            Step("footprints", "extract_footprints"),
        ),
        shared={"min_area": ("regions", "buildings", "footprints"), "density": ("regions", "buildings")},
        shown=("min_area", "ground_max_building_size", "regions_plan_distance", "regions_height_distance"),
    ),
)

PIPELINES = {pipeline.name: pipeline for pipeline in _PIPELINES}


def run_pipeline(pipeline: Pipeline, cloud: Cloud, monitor: Optional[Monitor] = None, **tunables: Any) -> Outcome:
    """Run all steps on ``cloud``, in place, and return the cloud and every layer.

    ``tunables`` are named ``<step>_<tunable>`` (``ground_cell_size``), and so are the monitor's values;
    what steps share is named ``<tunable>``.

    Raises
    ------
    ValueError
        If a tunable is unknown or a step refuses its data.
    """
    monitor = monitor or Monitor()
    chosen = _by_step(pipeline, tunables)
    layers = {}
    for i, step in enumerate(pipeline.steps):
        part = monitor.part(i / len(pipeline.steps), (i + 1) / len(pipeline.steps), f"{step.name}_")
        outcome = run_stage(step.stage, cloud, monitor=part, **chosen[step.name])
        layers.update(outcome.layers)
    return Outcome(cloud, layers)


def _by_step(pipeline: Pipeline, tunables: dict[str, Any]) -> dict[str, dict[str, Any]]:
    """Sort the composite's parameters by step, over the pipeline's own defaults."""
    unknown = [name for name in tunables if name not in pipeline.parameters]
    if unknown:
        raise ValueError(f"{pipeline.name} has no tunable {unknown[0]!r}; it has {', '.join(pipeline.parameters)}.")
    chosen = {step.name: dict(step.tunables) for step in pipeline.steps}
    for step in pipeline.steps:
        for tunable in step.stage.tunables:
            name = pipeline.parameter(step, tunable)
            if name in tunables:
                chosen[step.name][tunable] = tunables[name]
    return chosen
