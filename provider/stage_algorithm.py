"""The one Processing algorithm that turns any stage into a dialog, a model child and a command."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Optional

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingOutputNumber,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterPointCloudDestination,
    QgsProcessingParameterRasterDestination,
)

from ..algorithms.cloud.cloud import Cloud
from ..algorithms.cloud.dimensions import DIMENSIONS
from ..algorithms.cloud.files import count_points, read_extent
from ..algorithms.cloud.outputs import replacing
from ..algorithms.help import stage_help
from ..algorithms.report.page import with_coordinates
from ..algorithms.run import Outcome, run_stage
from ..algorithms.stage import Monitor, Raster, RasterSurface, Stage
from .algorithm import CheckedAlgorithm
from .clouds import cloud_path, files_read
from .crs import FULL, crs_of
from .errors import as_processing_errors
from .feedback import FeedbackMonitor, announce, is_step, warn_unknown_parameters
from .input_layers import find_input_layer, input_layer_files, input_layer_parameter, read_input_layer, refuse_elsewhere
from .inputs import (
    CRS,
    OUTPUT,
    REFERENCE,
    REPORT,
    cloud_title,
    crs_parameter,
    extent_box,
    extent_parameter,
    given_crs,
    input_parameter,
    input_paths,
    reference_parameter,
    refuse_same,
    subject_of,
    with_help,
)
from .layer_outputs import UNWANTED, write_layer
from .memory import warn_if_memory_is_short
from .named_clouds import SIMULATED_CRS, named, names_of_crs, read_named
from .outputs import all_in_place, check_targets, write_for_qgis
from .parameters import automatic_numbers, number_outputs, parameter, tunable_values, used_name
from .places import Place, place_of_cloud, place_of_layers
from .rasters import write_raster
from .run_log import RunLog, about_run, complete_page, run_log
from .styles import cloud_style, layer_style, show_on_load
from .text_files import file_parameter, write_text
from .texts import tr
from .vectors import SOURCE_TYPES, number

# Progress when clouds are read, when the stage is done, and when the cloud is written, 0 to 1.
_READ, _RUN, _WRITTEN = 0.15, 0.8, 0.97


@dataclass
class _Job:
    """What a run needs of its parameters, found out before it starts."""

    tunables: dict[str, Any]
    inputs: list[Path] = field(default_factory=list)
    reference: Optional[Path] = None
    box: Optional[np.ndarray] = None
    crs: QgsCoordinateReferenceSystem = field(default_factory=QgsCoordinateReferenceSystem)

    @property
    def paths(self) -> list[Path]:
        """All clouds that are read, the reference last."""
        return [*self.inputs, *([self.reference] if self.reference else [])]


class StageAlgorithm(CheckedAlgorithm, QgsProcessingAlgorithm):
    """A stage as a Processing algorithm; everything it shows comes from the stage's declaration."""

    def __init__(self, stage: Stage) -> None:
        super().__init__()
        self.stage = self.declared = stage

    def createInstance(self) -> StageAlgorithm:  # noqa: N802 - QGIS asks for these names
        """Return a new algorithm of the same stage."""
        return StageAlgorithm(self.stage)

    def shortHelpString(self) -> str:  # noqa: N802
        """Return the help that the dialog shows beside the parameters."""
        return self.shown(stage_help(self.stage))

    def initAlgorithm(self, configuration: Optional[dict] = None) -> None:  # noqa: N802
        """Declare inputs, tunables and outputs."""
        if self.stage.reads_cloud:
            self.addParameter(input_parameter(self.stage.merges, self.stage.input_title))
        if self.stage.reads_reference:
            self.addParameter(reference_parameter(self.stage))
        for input_layer in self.stage.input_layers:
            self.addParameter(input_layer_parameter(input_layer))
        for tunable in self.stage.tunables.values():
            self.addParameter(parameter(tunable))
        if self.stage.reads_cloud:
            self.addParameter(extent_parameter())
        if self.stage.reads_cloud or self.stage.creates:
            self.addParameter(crs_parameter(SIMULATED_CRS if self.stage.creates else None))
        self._add_destinations()
        self._add_numbers()
        self.name_pages()

    def _add_destinations(self) -> None:
        """Declare what the stage writes: cloud, layers, rasters, text files, report."""
        stage = self.stage
        if stage.makes_cloud:
            cloud = QgsProcessingParameterPointCloudDestination(OUTPUT, cloud_title([stage]))
            self.addParameter(with_help(cloud, tr("A .las, .laz or .copc.laz file.")))
        # Layers are optional where there is a cloud, a report or a file.
        optional = bool(stage.makes_cloud or stage.measures or stage.files)
        for layer in stage.layers:
            sink = QgsProcessingParameterFeatureSink(
                layer.name.upper(), tr(layer.title), SOURCE_TYPES[layer.geometry], optional=optional
            )
            # Where a stage writes layers only, the first is required and the others are optional.
            optional = True
            self.addParameter(with_help(sink, tr("A GeoPackage or any other vector format that QGIS writes.")))
        optional = optional or len(stage.rasters) > 1
        for raster in stage.rasters:
            image = QgsProcessingParameterRasterDestination(raster.name.upper(), tr(raster.title), optional=optional)
            self.addParameter(with_help(image, tr("A GeoTIFF, tiled and compressed.")))
        for file in stage.files:
            self.addParameter(file_parameter(file))
        if self.stage.measures:
            page = QgsProcessingParameterFileDestination(REPORT, tr("Report"), "HTML files (*.html)", optional=True)
            self.addParameter(with_help(page, tr("A page that shows the numbers.")))

    def _add_numbers(self) -> None:
        """Declare the numbers that the stage returns: what automatic tunables took, and its measures."""
        for name, title in number_outputs(self.stage).items():
            self.addOutput(QgsProcessingOutputNumber(name, title))

    def check(self, parameters: dict, context: QgsProcessingContext) -> None:
        """Find out what a run needs; refuse what can be refused before it."""
        self.job = self._job(parameters, context)

    def systems(self) -> list[str]:
        """Return the coordinate reference systems of the clouds, and the one that is given."""
        return [*(read_extent(path)[2] for path in self.job.paths), *names_of_crs(self.job.crs)]

    def _job(self, parameters: dict, context: QgsProcessingContext) -> _Job:
        """Return what a run needs; refuse with a ValueError what can be refused before it."""
        job = _Job(tunable_values(self, self.stage, parameters, context))
        if self.stage.reads_cloud:
            job.inputs = input_paths(self, self.stage.merges, parameters, context)
        is_given = self.stage.needs_reference or parameters.get(REFERENCE) not in (None, "")
        if self.stage.reads_reference and is_given:
            job.reference = cloud_path(self, REFERENCE, parameters, context)
        job.crs = given_crs(self, parameters, context) if self.parameterDefinition(CRS) else job.crs
        if job.inputs:
            job.box = extent_box(self, read_extent(job.inputs[0])[2] or job.crs.toWkt(FULL), parameters, context)
        read = [*files_read(job.paths), *input_layer_files(self, self.stage.input_layers, parameters, context)]
        check_targets(self.destinationParameterDefinitions(), parameters, read, job.inputs)
        if job.reference:
            refuse_same(job.inputs, job.reference)
        if job.inputs:
            refuse_elsewhere(self, self.stage.input_layers, job.inputs, parameters, context)
        return job

    def processAlgorithm(  # noqa: N802
        self, parameters: dict, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ) -> dict:
        """Read, run the stage, write; all or nothing. What was cancelled has no results."""
        announce(self.stage.title, feedback)
        self._alone = not is_step(feedback)
        warn_unknown_parameters(self, parameters, feedback)
        monitor = FeedbackMonitor(feedback, self.stage, self.job.tunables)
        definitions, subject = self.destinationParameterDefinitions(), subject_of(self.job.paths, feedback)
        # In a chain, the chain itself puts the layers into a group.
        title = self.displayName() if self._alone else ""
        with (
            run_log() as log,
            as_processing_errors(feedback),
            all_in_place(definitions, parameters, context, subject, title) as run,
        ):
            log.begin(self.stage, self.job.tunables)
            outcome, place = self._run(parameters, context, monitor)
            results = self._numbers(outcome, monitor)
            if self.stage.makes_cloud:
                part = monitor.part(_RUN, _WRITTEN)
                results[OUTPUT] = self._write_cloud(outcome.cloud, run.parameters, context, part)
            for layer in self.stage.layers:
                features = outcome.layers[layer.name]
                part, name = monitor.part(_WRITTEN, _WRITTEN), layer.name.upper()
                results.update(write_layer(self, name, layer, features, place, run.parameters, context, part))
            for raster in self.stage.rasters:
                surface = outcome.rasters[raster.name]
                results.update(self._write_raster(raster, surface, place, run.parameters, context, monitor))
            for file in self.stage.files:
                content = outcome.files[file.name]
                part = monitor.part(_WRITTEN, _WRITTEN)
                results.update(write_text(self, file, content, place, run.parameters, context, part))
            log.end()
            if outcome.report is not None:
                results.update(self._write_report(outcome.report.html, place, log, run.parameters, context))
            monitor.progress(1.0)
            return run.final(results)
        return {}

    def _run(self, parameters: dict, context: QgsProcessingContext, monitor: Monitor) -> tuple[Outcome, Place]:
        """Read clouds and layers and run the stage; return what it made, and where on Earth that lies."""
        paths = self.job.paths
        # Before reading: a process that runs out of memory is ended without a message.
        warn_if_memory_is_short(self._points(), monitor)
        share = _READ / max(1, len(paths))
        parts = [monitor.part(i * share, (i + 1) * share) for i in range(len(paths))]
        clouds = [read_named(path, part, self.job.crs, self.job.box) for path, part in zip(paths, parts)]
        reference = clouds.pop() if self.job.reference else None
        self._log_earlier_dimensions(clouds, monitor)
        found = {wanted: find_input_layer(self, wanted, parameters, context) for wanted in self.stage.input_layers}
        given = {wanted: layer for wanted, layer in found.items() if layer is not None}
        place = place_of_cloud(clouds[0]) if clouds else place_of_layers(given, monitor)
        input_layers = {
            input_layer.name: read_input_layer(input_layer, layer, place, context, monitor.part(_READ, _READ))
            for input_layer, layer in given.items()
            if place is not None
        }
        cloud = clouds if self.stage.merges else clouds[0] if clouds else None
        tunables = self.job.tunables
        outcome = run_stage(self.stage, cloud, reference, monitor.part(_READ, _RUN), input_layers, **tunables)
        self._warn_if_nothing_was_selected(clouds, outcome, monitor)
        if self.stage.creates and outcome.cloud is not None:
            outcome.cloud = named(outcome.cloud, self.job.crs)
        place = place_of_cloud(outcome.cloud) if outcome.cloud is not None else place
        if place is None:
            raise ValueError(f"{self.displayName()} has neither a point cloud nor a layer; choose one.")
        return outcome, place

    def _points(self) -> int:
        """Return how many points are read."""
        return sum(count_points(path, self.job.box) for path in self.job.paths)

    def _warn_if_nothing_was_selected(self, clouds: list[Cloud], outcome: Outcome, monitor: Monitor) -> None:
        """Warn where a selection by the user is the whole cloud: an area or a limit was forgotten."""
        is_whole = self.stage.selects and self.job.box is None and len(outcome.cloud) == len(clouds[0])
        if self._alone and is_whole:
            monitor.warn(
                f"All {len(clouds[0]):,} points stay: no extent is set, nor anything else that leaves points out."
            )

    def _log_earlier_dimensions(self, clouds: list[Cloud], monitor: Monitor) -> None:
        """Log which dimensions of earlier runs are read; in a chain, where its own steps made them, none."""
        names = [name for name in self.stage.optional if name in DIMENSIONS and not DIMENSIONS[name].standard]
        earlier = [DIMENSIONS[name].disk[0] for name in names if all(cloud.has(name) for cloud in clouds)]
        if self._alone and earlier:
            monitor.inform(f"The cloud has {', '.join(earlier)} of an earlier run; they are taken as they are.")

    def _numbers(self, outcome: Outcome, monitor: Monitor) -> dict:
        """Return the numbers by the names of their outputs."""
        numbers = {}
        for tunable in automatic_numbers(self.stage):
            given = self.job.tunables[tunable.name]
            numbers[used_name(tunable)] = number(monitor.values.get(tunable.name) if given is None else given)
        if outcome.report is not None:
            for measure in self.stage.measures:
                numbers[measure.name.upper()] = number(outcome.report.values[measure.name])
        return numbers

    def _write_cloud(self, cloud: Cloud, parameters: dict, context: QgsProcessingContext, monitor: Monitor) -> str:
        """Write the cloud and return its file."""
        target = self.parameterAsOutputLayer(parameters, OUTPUT, context)
        shown = write_for_qgis(cloud, target, context, monitor)
        show_on_load(context, shown, "Cloud", cloud_style(self.stage, cloud), crs=crs_of(cloud.wkt).toWkt(FULL))
        return target

    def _write_raster(
        self,
        raster: Raster,
        surface: RasterSurface,
        place: Place,
        parameters: dict,
        context: QgsProcessingContext,
        monitor: Monitor,
    ) -> dict:
        """Write a raster, if it is wanted; return its output."""
        name = raster.name.upper()
        if parameters.get(name) in UNWANTED:
            return {}
        target = self.parameterAsOutputLayer(parameters, name, context)
        write_raster(raster, surface, place, Path(target), monitor.part(_WRITTEN, _WRITTEN))
        show_on_load(context, target, "Raster", layer_style(raster))
        return {name: target}

    def _write_report(
        self, html: str, place: Place, log: RunLog, parameters: dict, context: QgsProcessingContext
    ) -> dict:
        """Write the page of numbers, if it is wanted; return its output. The chain completes the page of a step."""
        target = self.parameterAsFileOutput(parameters, REPORT, context)
        if not target:
            return {}
        page = with_coordinates(html, place.to_map)
        with replacing(Path(target)) as stream:
            stream.write(page.encode())
        if self._alone:
            rows = about_run(self.displayName(), self.job.paths, self._points(), place.crs.toWkt(FULL))
            complete_page(Path(target), rows, log.steps)
        return {REPORT: target}
