"""The one Processing algorithm that turns any stage into a dialog, a model child and a command."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Optional

from qgis.core import (
    QgsApplication,
    QgsFeatureSink,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProcessingFeedback,
    QgsProcessingOutputNumber,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterPointCloudDestination,
    QgsProcessingParameterRasterDestination,
)

from ..algorithms.cloud.cloud import Cloud, count_points, read_cloud
from ..algorithms.cloud.dimensions import DIMENSIONS
from ..algorithms.cloud.outputs import replacing
from ..algorithms.run import Outcome, run_stage
from ..algorithms.stage import Features, Layer, Monitor, Raster, Stage, Surface
from .clouds import CloudParameter, CloudsParameter, cloud_path, cloud_paths
from .crs import crs_units
from .dependencies import missing_sentence
from .described import Described
from .errors import one_sentence
from .feedback import FeedbackMonitor, announce, tell_unknown
from .help import as_text, stage_help
from .memory import tell_if_short
from .outputs import check_targets, files_of, nothing_left_on_failure, write_for_qgis
from .parameters import automatic_numbers, number_outputs, parameter, tunable_values, used_name
from .places import Place, place_of_cloud, place_of_layers
from .rasters import write_raster
from .sources import find_source, read_source, refuse_elsewhere, source_files, source_parameter
from .styles import cloud_style, layer_style, style_on_load
from .vectors import SOURCE_TYPES, fields_of, plain, qgis_features, wkb_type

INPUT, INPUTS, REFERENCE, OUTPUT, REPORT = "INPUT", "INPUTS", "REFERENCE", "OUTPUT", "REPORT"

# How far the progress is when clouds are read, when the stage is done, and when the cloud is written.
_READ, _RUN, _WRITTEN = 0.15, 0.8, 0.97

# What an optional output is that nobody asks for: left out, or written without a value on the command line.
_UNWANTED = (None, "")

# Features that are written between two looks at whether to stop.
_BETWEEN_CHECKS = 1000


@dataclass
class _Job:
    """What a run needs of its parameters, found out before it starts."""

    tunables: dict[str, Any]
    inputs: list[Path] = field(default_factory=list)
    reference: Optional[Path] = None

    @property
    def paths(self) -> list[Path]:
        """All clouds that are read, the reference last."""
        return [*self.inputs, *([self.reference] if self.reference else [])]


class StageAlgorithm(Described, QgsProcessingAlgorithm):
    """A stage as a Processing algorithm; everything it shows comes from the stage's declaration."""

    def __init__(self, stage: Stage) -> None:
        super().__init__()
        self.stage = self.described = stage

    def createInstance(self) -> StageAlgorithm:  # noqa: N802 - QGIS asks for these names
        """Return a new algorithm of the same stage."""
        return StageAlgorithm(self.stage)

    def shortHelpString(self) -> str:  # noqa: N802
        """Return the help that the dialog shows beside the parameters."""
        return shown_help(stage_help(self.stage))

    def initAlgorithm(self, configuration: Optional[dict] = None) -> None:  # noqa: N802
        """Declare inputs, tunables and outputs."""
        if self.stage.reads_cloud:
            self.addParameter(input_parameter(self.stage.merges))
        if self.stage.reads_reference:
            what = "File or layer to compare with: the same points with the true values."
            self.addParameter(_helped(CloudParameter(REFERENCE, "Reference point cloud"), what))
        for source in self.stage.sources:
            self.addParameter(source_parameter(source))
        for tunable in self.stage.tunables.values():
            self.addParameter(parameter(tunable))
        self._add_destinations()
        self._add_numbers()

    def _add_destinations(self) -> None:
        """Declare what the stage writes: cloud, layers, rasters, report."""
        stage = self.stage
        if stage.makes_cloud:
            cloud = QgsProcessingParameterPointCloudDestination(OUTPUT, cloud_title([stage]))
            self.addParameter(_helped(cloud, "A .las, .laz or .copc.laz file."))
        # Who wants the cloud or the numbers may do without the layers.
        optional = bool(stage.makes_cloud or stage.measures)
        for layer in stage.layers:
            sink = QgsProcessingParameterFeatureSink(
                layer.name.upper(), layer.title, SOURCE_TYPES[layer.geometry], optional=optional
            )
            # Of layers alone the first is what the stage is for.
            optional = True
            self.addParameter(_helped(sink, "A GeoPackage or any other vector format that QGIS writes."))
        optional = optional or len(stage.rasters) > 1
        for raster in stage.rasters:
            image = QgsProcessingParameterRasterDestination(raster.name.upper(), raster.title, optional=optional)
            self.addParameter(_helped(image, "A GeoTIFF, tiled and compressed."))
        if self.stage.measures:
            page = QgsProcessingParameterFileDestination(REPORT, "Report", "HTML files (*.html)", optional=True)
            self.addParameter(_helped(page, "A page that shows the numbers."))

    def _add_numbers(self) -> None:
        """Declare the numbers that the stage returns: what automatic tunables took, and its measures."""
        for name, title in number_outputs(self.stage).items():
            self.addOutput(QgsProcessingOutputNumber(name, title))

    def canExecute(self) -> tuple[bool, str]:  # noqa: N802
        """Whether all packages are there, and how to install what is missing."""
        missing = missing_sentence()
        return not missing, missing

    def checkParameterValues(self, parameters: dict, context: QgsProcessingContext) -> tuple[bool, str]:  # noqa: N802
        """Refuse what can be refused before the run, in the words that the run would use."""
        try:
            self._job(parameters, context)
        except ValueError as error:
            return False, str(error)
        return super().checkParameterValues(parameters, context)

    def prepareAlgorithm(  # noqa: N802
        self, parameters: dict, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ) -> bool:
        """Find out files and values; layers may be asked only here, in the main thread.

        Models and scripts come here without :meth:`checkParameterValues`, so everything is checked again.
        """
        with one_sentence():
            self.job = self._job(parameters, context)
        return True

    def _job(self, parameters: dict, context: QgsProcessingContext) -> _Job:
        """Return what a run needs; refuse with a ValueError what can be refused before it."""
        missing = missing_sentence()
        if missing:
            raise ValueError(missing)
        job = _Job(tunable_values(self, self.stage, parameters, context))
        if self.stage.reads_cloud:
            job.inputs = input_paths(self, self.stage.merges, parameters, context)
        if self.stage.reads_reference:
            job.reference = cloud_path(self, REFERENCE, parameters, context)
        read = [*job.paths, *source_files(self, self.stage.sources, parameters, context)]
        check_targets(self.destinationParameterDefinitions(), parameters, read)
        if job.inputs:
            refuse_elsewhere(self, self.stage.sources, job.inputs, parameters, context)
        return job

    def processAlgorithm(  # noqa: N802
        self, parameters: dict, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ) -> dict:
        """Read, run the stage, write; all or nothing."""
        announce(self.stage.title, feedback)
        tell_unknown(self, parameters, feedback)
        monitor = FeedbackMonitor(feedback, self.stage, self.job.tunables)
        with one_sentence(), nothing_left_on_failure(self._target_files(parameters)) as written:
            outcome, place = self._run(parameters, context, monitor)
            results = self._numbers(outcome, monitor)
            if self.stage.makes_cloud:
                part = monitor.part(_RUN, _WRITTEN)
                results[OUTPUT] = self._write_cloud(outcome.cloud, parameters, context, part, written)
            for layer in self.stage.layers:
                features = outcome.layers[layer.name]
                results.update(self._write_layer(layer, features, place, parameters, context, monitor))
            for raster in self.stage.rasters:
                surface = outcome.rasters[raster.name]
                results.update(self._write_raster(raster, surface, place, parameters, context, monitor, written))
            if outcome.report is not None:
                results.update(self._write_report(outcome.report.html, parameters, context))
            monitor.progress(1.0)
        return results

    def _target_files(self, parameters: dict) -> list:
        """Return the files that a run may write."""
        definitions = self.destinationParameterDefinitions()
        return [path for d in definitions for path in files_of(d, parameters.get(d.name()))]

    def _run(self, parameters: dict, context: QgsProcessingContext, monitor: Monitor) -> tuple[Outcome, Place]:
        """Read clouds and layers and run the stage; return what it made, and where on Earth that lies."""
        paths = self.job.paths
        # Where memory ends while they are read, nothing can be told any more.
        tell_if_short(sum(map(count_points, paths)), monitor)
        share = _READ / max(1, len(paths))
        clouds = [read_cloud(path, monitor.part(i * share, (i + 1) * share), crs_units) for i, path in enumerate(paths)]
        reference = clouds.pop() if self.job.reference else None
        found = {source: find_source(self, source, parameters, context) for source in self.stage.sources}
        given = {source: layer for source, layer in found.items() if layer is not None}
        place = place_of_cloud(clouds[0]) if clouds else place_of_layers(given, monitor)
        sources = {
            source.name: read_source(source, layer, place, context, monitor.part(_READ, _READ))
            for source, layer in given.items()
        }
        cloud = clouds if self.stage.merges else clouds[0] if clouds else None
        tunables = self.job.tunables
        outcome = run_stage(self.stage, cloud, reference, monitor.part(_READ, _RUN), sources, **tunables)
        return outcome, place_of_cloud(outcome.cloud) if outcome.cloud is not None else place

    def _numbers(self, outcome: Outcome, monitor: Monitor) -> dict:
        """Return the numbers by the names of their outputs."""
        numbers = {}
        for tunable in automatic_numbers(self.stage):
            given = self.job.tunables[tunable.name]
            numbers[used_name(tunable)] = plain(monitor.values.get(tunable.name) if given is None else given)
        if outcome.report is not None:
            for measure in self.stage.measures:
                numbers[measure.name.upper()] = plain(outcome.report.values[measure.name])
        return numbers

    def _write_cloud(
        self, cloud: Cloud, parameters: dict, context: QgsProcessingContext, monitor: Monitor, written: list
    ) -> str:
        """Write the cloud and return its file; what is written under a name found here joins ``written``."""
        target = self.parameterAsOutputLayer(parameters, OUTPUT, context)
        written += files_of(self.parameterDefinition(OUTPUT), target)
        shown = write_for_qgis(cloud, target, context, monitor)
        style_on_load(context, shown, cloud_style(self.stage, cloud))
        return target

    def _write_layer(
        self,
        layer: Layer,
        features: Features,
        place: Place,
        parameters: dict,
        context: QgsProcessingContext,
        monitor: Monitor,
    ) -> dict:
        """Write a layer, if it is wanted; return its output. Features are in meters from the origin of the place."""
        name = layer.name.upper()
        if parameters.get(name) in _UNWANTED:
            return {}
        sink, target = self.parameterAsSink(
            parameters, name, context, fields_of(layer), wkb_type(layer, features), place.crs
        )
        if sink is None:
            raise QgsProcessingException(self.invalidSinkError(parameters, name))
        monitor.resolved(**{layer.name: len(features)})
        try:
            for row, feature in enumerate(qgis_features(layer, features, place.to_map)):
                if row % _BETWEEN_CHECKS == 0:
                    monitor.progress(_WRITTEN)
                if not sink.addFeature(feature, QgsFeatureSink.Flag.FastInsert):
                    raise QgsProcessingException(_unwritten(layer, target, sink))
            if not sink.flushBuffer():
                raise QgsProcessingException(_unwritten(layer, target, sink))
        finally:
            # The file is closed with the sink: complete for the next step of a model, or free to be removed.
            del sink
        style_on_load(context, target, layer_style(layer), layer.fields)
        return {name: target}

    def _write_raster(
        self,
        raster: Raster,
        surface: Surface,
        place: Place,
        parameters: dict,
        context: QgsProcessingContext,
        monitor: Monitor,
        written: list,
    ) -> dict:
        """Write a raster, if it is wanted; return its output."""
        name = raster.name.upper()
        if parameters.get(name) in _UNWANTED:
            return {}
        target = self.parameterAsOutputLayer(parameters, name, context)
        written += files_of(self.parameterDefinition(name), target)
        write_raster(raster, surface, place, Path(target), monitor.part(_WRITTEN, _WRITTEN))
        style_on_load(context, target, layer_style(raster))
        return {name: target}

    def _write_report(self, html: str, parameters: dict, context: QgsProcessingContext) -> dict:
        """Write the page of numbers, if it is wanted; return its output."""
        target = self.parameterAsFileOutput(parameters, REPORT, context)
        if not target:
            return {}
        with replacing(Path(target)) as stream:
            stream.write(html.encode())
        return {REPORT: target}


def _unwritten(layer: Layer, target: str, sink: QgsFeatureSink) -> str:
    """Return why a layer can't be written, as far as its format tells."""
    why = f" ({sink.lastError()})" if sink.lastError() else ""
    return f"{layer.title} can't be written to {target}{why}; free some space or choose another folder."


def on_command_line() -> bool:
    """Whether this is ``qgis_process``, which shows HTML as it is written."""
    return QgsApplication.platform() == "qgis_process"


def shown_help(text: str) -> str:
    """Return a help as dialogs or the command line show it."""
    return as_text(text) if on_command_line() else text


def _helped(definition: QgsProcessingParameterDefinition, text: str) -> QgsProcessingParameterDefinition:
    """Return the parameter with its tooltip."""
    definition.setHelp(text)
    return definition


def input_parameter(several: bool) -> QgsProcessingParameterDefinition:
    """Return the parameter of the cloud, or of the clouds, that a stage or chain works on."""
    if several:
        return _helped(CloudsParameter(INPUTS, "Point clouds"), "Two or more files or layers of points.")
    return _helped(CloudParameter(INPUT, "Point cloud"), "File or layer of the points.")


def input_paths(
    algorithm: QgsProcessingAlgorithm, several: bool, parameters: dict, context: QgsProcessingContext
) -> list[Path]:
    """Return the file of the cloud, or the files of the clouds, that an algorithm works on."""
    if several:
        return cloud_paths(algorithm, INPUTS, parameters, context)
    return [cloud_path(algorithm, INPUT, parameters, context)]


def cloud_title(stages: Sequence[Stage]) -> str:
    """Return what the cloud is called that these stages make one after the other, in the dialog and as a layer."""
    # What a selection or a merger writes is what its points had before.
    of_their_own = [stage for stage in stages if not (stage.selects or stage.merges)]
    writes = [name for stage in of_their_own for name in stage.writes]
    if any(stage.creates for stage in stages):
        return "Simulated point cloud"
    if all(stage.merges for stage in stages):
        return "Merged point cloud"
    if all(stage.selects for stage in stages):
        return "Selected points"
    if "classification" in writes:
        return "Classified point cloud"
    if len(writes) == 1:
        return f"Point cloud with {DIMENSIONS[writes[0]].disk[0]}"
    return "Point cloud with new dimensions"
