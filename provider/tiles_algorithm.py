"""A composite in tiles as a Processing algorithm: a survey in, a folder of tiles and the layers of the whole out."""

from pathlib import Path
from typing import Any, Optional

from qgis.core import (
    Qgis,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingOutputFile,
    QgsProcessingOutputNumber,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterFolderDestination,
    QgsProcessingParameterNumber,
    QgsProcessingParameterString,
    QgsProcessingUtils,
)

from ..algorithms.cloud.outputs import COPC, stem_of
from ..algorithms.pipeline import CLOUD
from ..algorithms.report.page import Row, StepFacts, with_coordinates
from ..algorithms.stage import FileContent, Layer, LayerFeatures, Raster, TextFile
from ..algorithms.tiling.joining import RasterMosaic
from ..algorithms.tiling.run_in_tiles import run_in_tiles
from ..algorithms.tiling.settings import SETTINGS
from ..algorithms.tiling.survey import Survey, crs_of_survey, files_of_survey
from ..algorithms.tiling.tile_writing import SHOWN
from ..algorithms.tiling.tiled_pipelines import TiledPipeline, tiled_pipeline_help
from ..algorithms.tiling.tiled_run import TilesOptions, TilesOutcome
from ..algorithms.tiling.workers import Workers
from . import inputs
from .algorithm import CheckedAlgorithm
from .caller import is_step, on_command_line
from .clouds import CloudsParameter, survey_paths
from .crs_authority import crs_reader
from .destinations import Made
from .errors import as_processing_errors
from .feedback import FeedbackMonitor, warn_unknown_names
from .given import Given
from .input_layers import GivenLayer, find_input_layers, input_layer_parameter, layer_files, read_input_layers
from .inputs import INPUT, OUTPUT, REPORT
from .layer_outputs import write_layer, write_text
from .models import pipeline_parameters
from .named_clouds import names_of_crs
from .pipeline_algorithm import pipeline_tunables
from .qgis_crs import WGS84
from .rasters import write_mosaic
from .run_log import about_run, parameter_rows, write_page
from .run_outputs import all_in_place, check_targets, target_path
from .schedulers import check_scheduler
from .styles import Styler, layer_style, show_on_load, style_of
from .surveys import VPC, check_vpc, place_of_survey, write_survey
from .web import check_sizes, log_size

BLOCK_SIDE, PROCESSES, COMPRESSED, LOAD = "BLOCK_SIDE", "PROCESSES", "COMPRESSED", "LOAD"
SCHEDULER, CERTIFICATES = "SCHEDULER", "CERTIFICATES"
# Numbers that the algorithm returns.
_NUMBERS = {
    "TILES": "Tiles written",
    "BLOCKS": "Blocks",
    "POINTS": "Points",
    "FAILURES": "Blocks and tiles that failed",
}

# The progress when blocks and tiles are done; the rest is writing the layers.
_DONE = 0.97


class TilesAlgorithm(CheckedAlgorithm, QgsProcessingAlgorithm):
    """A composite on a survey of any size; everything it shows comes from the composite's declaration."""

    def __init__(self, tiled: TiledPipeline) -> None:
        super().__init__()
        self.tiled = self.declared = tiled
        self.pipeline, self.made = tiled.pipeline, _made(tiled)

    def help(self) -> str:
        """Return the help as HTML."""
        return tiled_pipeline_help(self.tiled)

    def initAlgorithm(self, configuration: Optional[dict] = None) -> None:  # noqa: N802
        """Declare the survey, the composite's parameters, how it is worked on, and the outputs."""
        self.addParameter(inputs.with_setting(CloudsParameter(INPUT, ""), SETTINGS))
        for definition in pipeline_parameters(self.pipeline).values():
            self.addParameter(definition)
        for input_layer in self.pipeline.input_layers.values():
            self.addParameter(input_layer_parameter(input_layer))
        self.addParameter(inputs.extent_parameter())
        self.addParameter(inputs.spacing_parameter())
        self.addParameter(inputs.with_setting(inputs.crs_parameter(), SETTINGS))
        for definition in _work_parameters():
            self.addParameter(definition)
        folder = QgsProcessingParameterFolderDestination(OUTPUT, "Folder of the tiles")
        self.addParameter(inputs.with_help(folder, "A tile for each file, and a virtual point cloud over all of them."))
        for made in self.made:
            self.addParameter(made.definition())
        self.addOutput(QgsProcessingOutputFile(VPC, "Virtual point cloud over the tiles"))
        for name, title in _NUMBERS.items():
            self.addOutput(QgsProcessingOutputNumber(name, title))
        self.name_pages()

    def check(self, parameters: dict, context: QgsProcessingContext) -> None:
        """Find out files, tunables and workers; refuse what can be refused before the run."""
        given = Given(self, parameters, context)
        self.paths = survey_paths(given, INPUT)
        check_vpc(target_path(parameters.get(OUTPUT)), self.paths)
        files = files_of_survey(self.paths)
        self.tunables = pipeline_tunables(given, self.pipeline)
        self.crs = inputs.given_crs(given)
        crs = crs_of_survey(self.paths, crs_reader(self.crs))
        self.plane, self.spacing = crs.plane, inputs.given_spacing(given, crs.factors)
        self.extent = inputs.extent_box(given, self.plane)
        check_sizes(self.paths, self.extent, self.spacing)
        self.workers, self.wanted = _workers(given), tuple(made.key for made in self.made if given.has(made.name))
        self.sinks = [one for one in self.destinationParameterDefinitions() if one.name() != OUTPUT]
        check_targets(self.sinks, parameters, [*files, *layer_files(given, self._given_layers(given))])

    def _given_layers(self, given: Given) -> list[GivenLayer]:
        """Return the layers that the composite is given."""
        return find_input_layers(given, self.pipeline.input_layers.values())

    def systems(self) -> list[str]:
        """Return the coordinate reference systems of the survey and of its virtual point cloud."""
        return [self.plane, WGS84, *names_of_crs(self.crs)]

    def processAlgorithm(  # noqa: N802
        self, parameters: dict, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ) -> dict:
        """Run the survey; then write the layers. What failed is named at the end, and the run fails with it."""
        warn_unknown_names(self, parameters, feedback)
        monitor = FeedbackMonitor(feedback)
        is_asked = self.parameterAsBool(parameters, LOAD, context)
        self.shows = is_asked and context.project() is not None and not (is_step(feedback) or on_command_line())
        folder = Path(self.parameterAsString(parameters, OUTPUT, context))
        cancelled = f"Cancelled; what was done is kept in {folder}, and the same run goes on with it."
        with as_processing_errors(feedback, cancelled):
            with all_in_place(self.sinks, parameters, context, self._subject(folder), self.displayName()) as run:
                results: dict[str, Any] = {}
                given = Given(self, run.parameters, context)
                outcome = self._run(folder, given, monitor, results)
                results.update(self._write_layers(outcome, given, monitor))
                results.update(self._write_report(outcome, given))
                results[VPC] = str(write_survey(outcome.survey, outcome.tiles, folder, context, monitor))
                results = run.final(results)
                if self.shows and outcome.tiles:
                    self._show(outcome, folder, given, monitor)
            _refuse_failures(outcome, folder)
            monitor.progress(1.0)
            numbers = (len(outcome.tiles), outcome.blocks, outcome.points, len(outcome.failures))
            return {OUTPUT: str(folder), **results, **dict(zip(_NUMBERS, numbers))}
        return {}

    def _show(self, outcome: TilesOutcome, folder: Path, given: Given, monitor: FeedbackMonitor) -> None:
        """Have QGIS load a virtual point cloud over the COPC files of the tiles."""
        files = [folder / SHOWN / f"{stem_of(tile)}{COPC}" for tile in outcome.tiles]
        shown = str(write_survey(outcome.survey, files, folder / SHOWN, given.context, monitor))
        makers = [step.stage for step in self.pipeline.steps if step.stage.makes_cloud]
        # The style is that of the last step that makes a cloud and has one.
        styles = (style_of(stage.writes) for stage in reversed(makers))
        title, style = inputs.cloud_title(makers), next(filter(None, styles), None)
        # Without the hint QGIS takes it for polygons in JSON.
        hint = QgsProcessingUtils.LayerHint.PointCloud
        details = QgsProcessingContext.LayerDetails(title, given.context.project(), VPC, hint)
        given.context.addLayerToLoadOnCompletion(shown, details)
        show_on_load(given.context, shown, "Cloud", Styler(style, crs=self.plane))

    def _subject(self, folder: Path) -> str:
        """Return what the layers are of: the folder of the tiles, or the input where that is temporary."""
        is_temporary = Path(QgsProcessingUtils.tempFolder()) in folder.parents
        return self.paths[0].name.split(".")[0] if is_temporary else folder.name

    def _run(self, folder: Path, given: Given, monitor: FeedbackMonitor, results: dict) -> TilesOutcome:
        """Run the survey, and write the rasters and text files that are wanted, which are added to the results."""
        log_size(self.paths, self.extent, self.spacing, monitor)
        side = given.parameters.get(BLOCK_SIDE)
        declared = {made.key: made.declared for made in self.made if made.key in self.wanted}

        def find_layers(survey: Survey) -> dict[str, LayerFeatures]:
            part, place = monitor.part(_DONE, _DONE), place_of_survey(survey)
            return read_input_layers(self._given_layers(given), place, part)

        def take_raster(survey: Survey, mosaic: RasterMosaic) -> None:
            raster, name = declared.get(mosaic.name), mosaic.name.upper()
            if isinstance(raster, Raster):
                target = given.read("OutputLayer", name)
                write_mosaic(raster, mosaic, place_of_survey(survey), Path(target), monitor.part(_DONE, _DONE))
                show_on_load(given.context, target, "Raster", Styler(layer_style(raster)))
                results[name] = target

        def take_file(survey: Survey, name: str, content: FileContent) -> None:
            part, place, file = monitor.part(_DONE, _DONE), place_of_survey(survey), declared.get(name)
            if isinstance(file, TextFile):
                results.update(write_text(given, name.upper(), file, content, place, part))

        options = TilesOptions(
            workers=self.workers,
            block_side=None if side is None else given.read("Double", BLOCK_SIDE),
            compressed=given.read("Bool", COMPRESSED),
            read=crs_reader(self.crs),
            extent=self.extent,
            spacing=self.spacing,
            wanted=self.wanted,
            find_layers=find_layers,
            take_raster=take_raster,
            take_file=take_file,
            shown=self.shows,
        )
        return run_in_tiles(self.pipeline, self.paths, folder, monitor.part(0.0, _DONE), options, **self.tunables)

    def _write_report(self, outcome: TilesOutcome, given: Given) -> dict:
        """Write the page of numbers, if it is wanted; return its output."""
        report = outcome.reports.get(self.tiled.report.name) if self.tiled.report else None
        if report is None or not given.has(REPORT):
            return {}
        target, place = given.read("FileOutput", REPORT), place_of_survey(outcome.survey)
        rows = about_run(self.displayName(), self.paths, outcome.points, self.plane)
        blocks = f"{outcome.blocks:,} of {outcome.side:g} m"
        rows.append(Row("Blocks", blocks, f"Tiles written: {len(outcome.tiles):,}. Sampling: {outcome.sampling}."))
        steps, page = self._steps(outcome), with_coordinates(report.html, place.to_map)
        write_page(target, page, rows, steps, "In all processes together.")
        return {REPORT: target}

    def _steps(self, outcome: TilesOutcome) -> list[StepFacts]:
        """Return the steps that were run, their parameters as used and their seconds in all processes together."""
        steps, run = [], self.pipeline.steps_for({CLOUD, *self.wanted})
        for step, chosen in self.pipeline.by_step(self.tunables):
            if step not in run:
                continue
            found = {name: outcome.values.get(f"{step.name}_{name}") for name in step.stage.tunables}
            used = {name: values for name, values in found.items() if values}
            seconds = outcome.seconds.get(step.name, 0.0)
            steps.append(StepFacts(step.stage.title, seconds, parameter_rows(step.stage, chosen, used)))
        return steps

    def _write_layers(self, outcome: TilesOutcome, given: Given, monitor: FeedbackMonitor) -> dict:
        """Write the layers that are wanted; return their outputs."""
        place, results = place_of_survey(outcome.survey), {}
        for made in self.made:
            features = outcome.layers.get(made.key)
            if isinstance(made.declared, Layer) and features is not None:
                part = monitor.part(_DONE, _DONE)
                results.update(write_layer(given, made.name, made.declared, features, place, part))
        return results


def _workers(given: Given) -> Workers:
    """Return where blocks are worked on; refuse a scheduler or certificates that can't be used."""
    processes = given.parameters.get(PROCESSES)
    count = None if processes is None else given.read("Int", PROCESSES)
    scheduler = given.read("String", SCHEDULER).strip()
    check_scheduler(scheduler)
    listed = given.read("String", CERTIFICATES).split(";")
    certificates = tuple(one.strip() for one in listed if one.strip())
    if len(certificates) not in (0, 3):
        count = len(certificates)
        raise ValueError(f"The certificates must be three files (authority; certificate; key), got {count}.")
    missing = [one for one in certificates if not Path(one).is_file()]
    if missing:
        raise ValueError(f"There is no certificate {missing[0]}; check the name.")
    return Workers(count, scheduler, certificates)


def _made(tiled: TiledPipeline) -> list[Made]:
    """Return the outputs other than the tiles."""
    return [
        Made(one.name.upper(), inputs.result_title(one.step.stage, one.declared), one.step.stage, one.declared)
        for one in tiled.outputs
    ]


def _refuse_failures(outcome: TilesOutcome, folder: Path) -> None:
    """Say what failed, if anything did.

    Raises
    ------
    ValueError
        With all that failed.
    """
    if outcome.failures:
        count = len(outcome.failures)
        raise ValueError(
            f"{count} {'part' if count == 1 else 'parts'} of the survey failed; all others are in {folder}. "
            f"{' '.join(outcome.failures)} Run it again to try {'it' if count == 1 else 'these'} once more."
        )


def _work_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters of how a survey is worked on."""
    number = Qgis.ProcessingNumberParameterType
    made = [
        QgsProcessingParameterNumber(BLOCK_SIDE, "", number.Double, None, True, 20.0, 10_000.0),
        QgsProcessingParameterNumber(PROCESSES, "", number.Integer, None, True, 1, 512),
        QgsProcessingParameterString(SCHEDULER, "", "", False, True),
        QgsProcessingParameterString(CERTIFICATES, "", "", False, True),
        QgsProcessingParameterBoolean(COMPRESSED, "", True),
        QgsProcessingParameterBoolean(LOAD, "", True),
    ]
    for definition in made[:-1]:
        definition.setFlags(definition.flags() | Qgis.ProcessingParameterFlag.Advanced)
    return [inputs.with_setting(definition, SETTINGS) for definition in made]
