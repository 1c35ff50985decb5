"""Composites as data: which stage feeds which, and the same chains run in memory.

The .model3 files under ``resources/models`` are generated from this module, so
the graph that a user opens in the modeller and the chain that runs here can't differ.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Optional, Union

from .cloud.cloud import Cloud
from .run import Outcome, run_stage
from .stage import Features, Monitor, Report, Source, Stage, Tunable, given_layers
from .stages import STAGES

_CLOUD, _REPORT = "output", "report"


@dataclass(frozen=True)
class Step:
    """One stage of a chain; it works on the last cloud that a step before it made.

    ``name`` prefixes the composite's parameters (``GROUND_CELL_SIZE``); ``tunables``
    are the defaults that differ from the stage's own. ``cloud`` names an earlier step
    whose cloud it works on instead. ``layers`` says which of its sources is a layer of an
    earlier step, ``{"new": "walls.footprints"}``; the composite asks for all others,
    under the source's own name. A stage that merges is given all clouds of the composite.
    """

    name: str
    stage_name: str
    tunables: dict[str, Any] = field(default_factory=dict)
    cloud: str = ""
    layers: dict[str, str] = field(default_factory=dict)

    @property
    def stage(self) -> Stage:
        """The stage that this step runs."""
        return STAGES[self.stage_name]


@dataclass(frozen=True)
class Output:
    """One output of a composite: its name, and which output of which step it is.

    ``of`` is ``"output"`` for a cloud, ``"report"``, or the name of a layer or raster.
    """

    name: str
    step: Step
    of: str


@dataclass(frozen=True)
class Pipeline:
    """A chain of stages that users meet as one algorithm.

    The last step that makes a cloud gives the composite's OUTPUT; every layer, raster and
    report of every step is an output of its own, and so are the clouds of the steps that
    ``kept`` names. ``shared`` names tunables that are one parameter of the composite and go
    to all the steps beside them; they have the same declaration and default there. ``shown``
    are the parameters that users meet first, in this order; all others are folded away.
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
    kept: tuple[str, ...] = ()

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

    def cloud_of(self, step: Step) -> Optional[str]:
        """Return the name of the step whose cloud ``step`` works on, "" for what is given, None where it reads none."""
        if not step.stage.reads_cloud:
            return None
        if step.stage.merges or step.cloud:
            return step.cloud
        before = self.steps[: self.steps.index(step)]
        return next((other.name for other in reversed(before) if other.stage.makes_cloud), "")

    @property
    def reads_cloud(self) -> bool:
        """Whether the composite is given a cloud, or several."""
        return any(self.cloud_of(step) == "" for step in self.steps)

    @property
    def merges(self) -> bool:
        """Whether it is given several clouds."""
        return any(step.stage.merges for step in self.steps)

    @property
    def sources(self) -> dict[str, Source]:
        """Vector layers that the composite is given, by name."""
        found: dict[str, Source] = {}
        for step in self.steps:
            for source in step.stage.sources:
                if source.name not in step.layers:
                    found.setdefault(source.name, source)
        return found

    @property
    def outputs(self) -> tuple[Output, ...]:
        """All outputs in the order of steps; where two would have one name, the step's name is put before it."""
        makers = [step for step in self.steps if step.stage.makes_cloud]
        found = [(step, of) for step in self.steps for of in _made(step)]
        names = [of for _, of in found]
        outputs = []
        for step, of in found:
            is_single = step is makers[-1] if of == _CLOUD else names.count(of) == 1
            if is_single or of != _CLOUD or step.name in self.kept:
                outputs.append(Output(of if is_single else f"{step.name}_{of}", step, of))
        return tuple(outputs)

    def needs(self, output: Output) -> bool:
        """Whether an output is made even if nobody asks for it: a cloud, or a layer that another step reads."""
        return output.of == _CLOUD or any(
            f"{output.step.name}.{output.of}" in step.layers.values() for step in self.steps
        )

    @property
    def id(self) -> str:
        """Processing id, ``detectbuildings``."""
        return self.name.replace("_", "")


def _made(step: Step) -> list[str]:
    """Return what a step makes: its cloud, layers, rasters, report."""
    stage = step.stage
    files = [*(layer.name for layer in stage.layers), *(raster.name for raster in stage.rasters)]
    return [_CLOUD] * stage.makes_cloud + files + [_REPORT] * bool(stage.measures)


_SANTOS = (
    "Santos, R. C. dos, Pessoa, G. G., Carrilho, A. C., Galo, M., 2019. Building detection from LiDAR data using "
    "entropy and the k-means concept. International Archives of the Photogrammetry, Remote Sensing and Spatial "
    "Information Sciences XLII-2/W13."
)

_HRUTKA = (
    "Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection. "
    "International Archives of the Photogrammetry, Remote Sensing and Spatial Information Sciences XLVIII-4/W1."
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
            "told apart by their mean entropy; then whole buildings with their walls, and their outlines. Distances "
            "and tolerances follow the density and the noise of the cloud."
        ),
        references=_SANTOS,
        steps=(
            Step("noise", "classify_noise_histogram"),
            Step("ground", "classify_ground_tin"),
            Step("height", "compute_height_above_ground"),
            Step("roofs", "segment_roofs"),
            Step(
                "buildings",
                "classify_buildings",
                {"neighborhood": "surface", "max_penetration": 0.4, "min_share_around": 0.4},
            ),
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
            Step("noise", "classify_noise_histogram", {"isolated": False}),
            Step("ground", "classify_ground_tin", {"seeds": "lowest"}),
            Step("regions", "segment_regions"),
            Step("buildings", "classify_buildings", {"guard": False}),
            Step("footprints", "extract_footprints"),
        ),
        shared={"min_area": ("regions", "buildings", "footprints"), "density": ("regions", "buildings")},
        shown=("min_area", "ground_max_building_size", "regions_plan_distance", "regions_height_distance"),
    ),
    Pipeline(
        name="interpret_structure",
        title="Interpret structure",
        group="Models",
        tags="linear,planar,volumetric,dimensionality,voxel,drone,UAV,scanner,scene,structure,Weinmann",
        summary="Tell lines, surfaces and volumes apart in the merged clouds of several scanners or scans.",
        description=(
            "Merges the clouds, leaves one point per voxel, so that places that were scanned for long don't count more "
            "than others, describes the neighborhood of each point, and sorts points by the largest of linearity, "
            "planarity and scattering: wires and edges, ground and walls, crowns and bushes. The features stay in the "
            "cloud. The neighborhood of 50 points gives smooth results on noisy scans; 'optimal' chooses a number for "
            "each point and keeps more detail. Of a single cloud, start with 'Downsample to voxels'."
        ),
        references=(
            "Weinmann, M., Müller, M. S., Hillemann, M., Reydel, N., Hinz, S., Jutzi, B., 2017. Point cloud analysis "
            "for UAV-borne laser scanning with horizontally and vertically oriented line scanners - concept and first "
            "results. International Archives of the Photogrammetry, Remote Sensing and Spatial Information Sciences "
            "XLII-2/W6."
        ),
        steps=(
            Step("merge", "merge_clouds"),
            Step("voxels", "downsample_voxels"),
            Step(
                "features",
                "compute_features",
                {"features": ("linearity", "planarity", "scattering", "verticality", "optimal_neighbors")},
            ),
            Step("structure", "classify_dimensionality"),
        ),
        shown=("voxels_voxel_size", "features_neighborhood", "features_n_neighbors", "merge_transforms"),
    ),
    Pipeline(
        name="map_footprints",
        title="Map footprints",
        group="Models",
        tags="cadastre,land registry,wall,footprint,corner,drone,UAV,photogrammetry,map,update,Hrutka",
        summary="Map the walls of buildings from a drone's point cloud, and compare them with the old map.",
        description=(
            "Noise is removed and one point left per voxel; a cloth finds the ground, and a terrain model is made of "
            "it; planes high above it are roofs, and what is low and upright below them is their walls. Footprints "
            "are the outlines of walls, without the eaves, with a quality for every edge; where too little of the "
            "walls was seen, which is what clouds from airplanes come to, they are outlines of roofs and say so. "
            "Where an old map is given, its corners are compared with the new ones. The terrain and the cloud of every "
            "step can be kept."
        ),
        references=_HRUTKA,
        steps=(
            Step("noise", "classify_noise_statistical"),
            Step("voxels", "downsample_voxels"),
            Step("ground", "classify_ground_cloth"),
            Step("terrain", "rasterize_terrain"),
            Step("height", "compute_height_above_ground"),
            Step("planes", "segment_planes_ransac", {"min_height": 1.5}),
            Step("roofs", "classify_roofs"),
            Step("walls", "classify_walls"),
            Step("footprints", "extract_wall_footprints"),
            Step("comparison", "compare_corners", layers={"footprints": "footprints.wall_footprints"}),
        ),
        shared={"min_area": ("roofs", "footprints"), "split_height": ("roofs", "walls")},
        shown=("min_area", "voxels_voxel_size", "ground_rigidness", "split_height", "footprints_min_seen"),
        kept=("noise", "voxels", "ground", "height", "planes", "roofs"),
    ),
)

PIPELINES = {pipeline.name: pipeline for pipeline in _PIPELINES}


@dataclass
class Results(Outcome):
    """What a chain made: the last cloud, and layers, rasters, reports and kept clouds by the composite's names."""

    clouds: dict[str, Cloud] = field(default_factory=dict)
    reports: dict[str, Report] = field(default_factory=dict)


def run_pipeline(
    pipeline: Pipeline,
    cloud: Union[Cloud, Sequence[Cloud], None] = None,
    monitor: Optional[Monitor] = None,
    sources: Optional[dict[str, Optional[Features]]] = None,
    kept: Optional[Collection[str]] = None,
    **tunables: Any,
) -> Results:
    """Run all steps on ``cloud``, in place as far as they do so, and return all that they made.

    ``cloud`` is several clouds where the pipeline merges. ``sources`` are the layers that the pipeline
    is given, by name, in meters relative to the cloud's origin. ``kept`` are the steps whose clouds
    are wanted, of those that the pipeline keeps; None is all of them. ``tunables`` are named
    ``<step>_<tunable>`` (``ground_cell_size``), and so are the monitor's values; what steps share is
    named ``<tunable>``.

    Raises
    ------
    ValueError
        If a tunable or layer is unknown, a layer is missing, or a step refuses its data.
    """
    monitor = monitor or Monitor()
    chosen = _by_step(pipeline, tunables)
    given = given_layers(pipeline.name, pipeline.sources.values(), sources or {})
    # Later steps change the cloud that they work on: what is wanted as it was is copied when it is made.
    wanted = {*(pipeline.kept if kept is None else kept), *(step.cloud for step in pipeline.steps)}
    copies: dict[str, Cloud] = {}
    outcomes: dict[str, Outcome] = {}
    current = cloud
    for i, step in enumerate(pipeline.steps):
        part = monitor.part(i / len(pipeline.steps), (i + 1) / len(pipeline.steps), f"{step.name}_")
        layers = {source.name: _layer(step, source.name, outcomes, given) for source in step.stage.sources}
        works_on = copies[step.cloud].copy() if step.cloud else current if step.stage.reads_cloud else None
        outcome = run_stage(step.stage, works_on, monitor=part, sources=layers, **chosen[step.name])
        outcomes[step.name] = replace(outcome, cloud=None)
        if step.stage.makes_cloud:
            current = outcome.cloud
            if step.name in wanted and outcome.cloud is not None:
                copies[step.name] = outcome.cloud.copy()
    return _results(pipeline, outcomes, copies, current if isinstance(current, Cloud) else None)


def _layer(
    step: Step, source: str, outcomes: dict[str, Outcome], given: dict[str, Optional[Features]]
) -> Optional[Features]:
    """Return the layer that a source of a step is: of an earlier step, or given."""
    if source not in step.layers:
        return given[source]
    earlier, layer = step.layers[source].split(".")
    return outcomes[earlier].layers[layer]


def _results(
    pipeline: Pipeline, outcomes: dict[str, Outcome], copies: dict[str, Cloud], cloud: Optional[Cloud]
) -> Results:
    results = Results(cloud)
    for output in pipeline.outputs:
        outcome = outcomes[output.step.name]
        if output.of in outcome.layers:
            results.layers[output.name] = outcome.layers[output.of]
        elif output.of in outcome.rasters:
            results.rasters[output.name] = outcome.rasters[output.of]
        elif output.of == _REPORT and outcome.report is not None:
            results.report = results.reports[output.name] = outcome.report
        elif output.name != _CLOUD and output.step.name in copies:
            results.clouds[output.name] = copies[output.step.name]
    return results


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
