"""The shipped models as algorithms: what QGIS does with a model, and what it leaves out."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Optional

from qgis.core import (
    Qgis,
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProcessingFeedback,
    QgsProcessingModelAlgorithm,
    QgsProcessingModelResult,
    QgsProcessingOutputNumber,
    QgsProcessingParameterDefinition,
)

from ..algorithms.cloud.files import check_readable, count_points, read_extent, write_cloud
from ..algorithms.help import pipeline_help
from ..algorithms.pipeline import CLOUD, Output, Pipeline, Step
from ..algorithms.stage import Cancelled
from .algorithm import CheckedAlgorithm
from .clouds import cloud_path, files_read
from .crs import FULL, crs_units
from .declared import on_command_line
from .errors import as_processing_errors
from .feedback import ChainFeedback, FeedbackMonitor, warn_unknown_parameters
from .input_layers import input_layer_files, input_layer_name, refuse_elsewhere
from .inputs import (
    EXTENT,
    INPUT,
    INPUTS,
    OUTPUT,
    REFERENCE,
    REPORT,
    crs_parameter,
    extent_box,
    extent_parameter,
    given_crs,
    input_parameter,
    input_paths,
    reference_parameter,
    refuse_same,
    subject_of,
)
from .models import model_file, pipeline_parameters, step_label
from .named_clouds import names_of_crs, read_named
from .outputs import all_in_place, check_targets
from .parameters import number_outputs, tunable_values
from .run_log import RunLog, about_run, complete_page, run_log
from .styles import switch_off

# Outputs of this rank and of higher ones are intermediate results.
_INTERMEDIATE = 3


def _rank(output: Output) -> int:
    """Return the rank of an output in the dialog: cloud, layers, reports; rasters and kept clouds come last."""
    if output.of == OUTPUT.lower():
        return 0 if output.name == output.of else 4
    rasters = [raster.name for raster in output.step.stage.rasters]
    if output.of in rasters:
        return _INTERMEDIATE
    return 2 if output.of == REPORT.lower() else 1


def step_output_name(step: Step, name: str) -> str:
    """Return the composite's name of a step's output, ``GROUND_CELL_SIZE_USED``."""
    return f"{step.name.upper()}_{name}"


@contextmanager
def _own_steps(context: QgsProcessingContext) -> Iterator[None]:
    """Have QGIS run all steps of a model.

    It keeps the finished steps of a model with the context, by their names. It skips them in every further model that
    runs in this context: in the next run of a script, or in a model around this one.
    """
    before = QgsProcessingModelResult(context.modelResult())
    context.clearModelResult()
    try:
        yield
    finally:
        context.clearModelResult()
        context.modelResult().mergeWith(before)


class PipelineAlgorithm(CheckedAlgorithm, QgsProcessingModelAlgorithm):
    """A shipped model with its pipeline's id and title.

    A model loaded as it is has its title as id, refuses LAS and LAZ where QGIS has no PDAL,
    ignores its own defaults and names its outputs by their titles. This class mends these. It also has parameters for
    an extent and a CRS, outputs with the numbers of its steps, and results that are put in place together.
    """

    def __init__(self, pipeline: Pipeline) -> None:
        super().__init__()
        self.pipeline = self.declared = pipeline
        if not self.fromFile(str(model_file(pipeline))):
            raise QgsProcessingException(
                f"The model {model_file(pipeline).name} of the plugin can't be read; install it again."
            )
        self._mend_parameters()
        if on_command_line():
            # On the command line QGIS shows only the description of a model.
            self.setHelpContent({"ALG_DESC": f"{pipeline.summary}\n{self.shortHelpString()}"})

    def _mend_parameters(self) -> None:
        """Let the input take any path, and name outputs by their names instead of their titles."""
        # A model's file holds no tooltips.
        shown = pipeline_parameters(self.pipeline)
        # Titles in the language of QGIS; those in the model's file are English.
        self._titles = {name: definition.description() for name, definition in shown.items()}
        helps = {name: definition.help() for name, definition in shown.items()}
        helps.update({input_layer_name(layer): layer.help for layer in self.pipeline.input_layers.values()})
        mended = [self._mended(definition, helps) for definition in self.parameterDefinitions()]
        order = [output.name.upper() for output in sorted(self.pipeline.outputs, key=_rank)]
        mended.sort(key=lambda definition: order.index(definition.name()) if definition.isDestination() else -1)
        for definition in self.parameterDefinitions():
            self.removeParameter(definition.name())
        for definition in mended:
            if definition.isDestination() and self.pipeline.reads_cloud and not self.parameterDefinition(EXTENT):
                self.addParameter(extent_parameter())
                self.addParameter(crs_parameter())
            self.addParameter(definition)

    def _mended(
        self, definition: QgsProcessingParameterDefinition, helps: dict[str, str]
    ) -> QgsProcessingParameterDefinition:
        """Return a parameter of the model with its help, an output under the name that the chain gives it."""
        if definition.name() in (INPUT, INPUTS):
            return input_parameter(self.pipeline.merges, self.pipeline.input_title)
        if definition.name() == REFERENCE and self.pipeline.compared is not None:
            return reference_parameter(self.pipeline.compared)
        mended = definition.clone()
        mended.setHelp(helps.get(definition.name(), definition.help()))
        mended.setDescription(self._titles.get(definition.name(), definition.description()))
        if definition.isDestination():
            facts = definition.metadata()
            child_output = self.childAlgorithm(facts["_modelChildId"]).modelOutput(facts["_modelChildOutputName"])
            output = self._output(child_output.childId(), child_output.childOutputName().lower())
            mended.setName(output.name.upper())
            if mended.name() != OUTPUT or self._makes_more_than_clouds():
                mended.setFlags(mended.flags() | Qgis.ProcessingParameterFlag.Optional)
            if mended.name() != OUTPUT:
                # Results of steps in between are made on request only.
                mended.setCreateByDefault(_rank(output) < _INTERMEDIATE)
        return mended

    def _makes_more_than_clouds(self) -> bool:
        """Whether it has outputs, such as footprints, that may be all that is wanted."""
        return any(output.of != CLOUD for output in self.pipeline.outputs)

    def _output(self, step_name: str, of: str) -> Output:
        return next(output for output in self.pipeline.outputs if (output.step.name, output.of) == (step_name, of))

    def as_model(self) -> QgsProcessingModelAlgorithm:
        """Return the plain model, as the designer edits it."""
        model = QgsProcessingModelAlgorithm()
        model.fromFile(str(model_file(self.pipeline)))
        model.setSourceFilePath("")
        return model

    def createInstance(self) -> PipelineAlgorithm:  # noqa: N802 - QGIS asks for these names
        """Return a new algorithm of the same pipeline."""
        return PipelineAlgorithm(self.pipeline)

    def initAlgorithm(self, configuration: Optional[dict] = None) -> None:  # noqa: N802
        """Declare the numbers of the steps (used values, measures) as outputs of the whole."""
        for step in self.pipeline.steps:
            for name, title in number_outputs(step.stage).items():
                self.addOutput(QgsProcessingOutputNumber(step_output_name(step, name), step_label(step, title)))
        self.name_pages()

    def shortHelpString(self) -> str:  # noqa: N802
        """Return the help that the dialog shows beside the parameters."""
        return self.shown(pipeline_help(self.pipeline))

    def asPythonCommand(self, parameters: dict, context: QgsProcessingContext) -> str:  # noqa: N802
        """Return the call that the dialog copies; QGIS gives none for models."""
        return QgsProcessingAlgorithm.asPythonCommand(self, parameters, context)

    def check(self, parameters: dict, context: QgsProcessingContext) -> None:
        """Find out the clouds and what is read of them; refuse what can be refused before the first step."""
        given = self.completed(parameters)
        for step in self.pipeline.steps:
            named = {name: self.pipeline.parameter(step, name).upper() for name in step.stage.tunables}
            tunable_values(self, step.stage, given, context, named)
        clouds = input_paths(self, self.pipeline.merges, given, context) if self.pipeline.reads_cloud else []
        read_too = [cloud_path(self, REFERENCE, given, context)] if self.pipeline.compared else []
        read = [
            *files_read([*clouds, *read_too]),
            *input_layer_files(self, self.pipeline.input_layers.values(), given, context),
        ]
        check_targets(self.destinationParameterDefinitions(), given, read, clouds)
        for reference in read_too:
            refuse_same(clouds, reference)
        for cloud in (*clouds, *read_too):
            # Now, as QGIS opens the input of a model as a layer too, and a damaged COPC can hang it.
            check_readable(cloud, crs_units)
        if clouds:
            refuse_elsewhere(self, self.pipeline.input_layers.values(), clouds, given, context)
            self._crs = given_crs(self, given, context)
            systems = [read_extent(cloud)[2] for cloud in clouds]
            self._box = extent_box(self, systems[0] or self._crs.toWkt(FULL), given, context)
            self._needs_no_crs = not self._crs.isValid() or all(systems)
        self._clouds = clouds

    def systems(self) -> list[str]:
        """Return the coordinate reference systems of the clouds, and the one that is given."""
        given = names_of_crs(self._crs) if self._clouds else []
        return [*(read_extent(path)[2] for path in self._clouds), *given]

    def completed(self, parameters: dict) -> dict:
        """Return ``parameters`` with the model's defaults, where QGIS would take the child's.

        What one step makes and another one reads is temporary where nobody keeps it.
        """
        names = [name.upper() for name in self.pipeline.parameters]
        defaults = {name: self.parameterDefinition(name).defaultValue() for name in names}
        temporary = dict.fromkeys(self._not_kept(parameters), QgsProcessing.TEMPORARY_OUTPUT)
        return {**defaults, **parameters, **temporary}

    def _not_kept(self, parameters: dict) -> list[str]:
        """Return the names of outputs that nobody asks for and a step makes for another one."""
        needed = [output.name.upper() for output in self.pipeline.outputs if self.pipeline.needs(output)]
        return [name for name in needed if parameters.get(name) in (None, "")]

    def processAlgorithm(  # noqa: N802
        self, parameters: dict, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ) -> dict:
        """Run the graph; all or nothing. What was cancelled has no results."""
        warn_unknown_parameters(self, parameters, feedback)
        definitions, given = self.destinationParameterDefinitions(), self.completed(parameters)
        subject = subject_of(self._clouds, feedback)
        with as_processing_errors(feedback):
            with run_log() as log, all_in_place(definitions, given, context, subject, self.displayName()) as run:
                results = self._run_steps(run.parameters, context, feedback)
                log.end()
                self._complete_pages(results, log)
                finished = self._finished(run.final(results), parameters)
            helpers = (name.upper() for name in self.pipeline.switched_off)
            switch_off(context, [finished[name] for name in helpers if name in finished])
            return finished
        return {}

    def _complete_pages(self, results: dict, log: RunLog) -> None:
        """Write on the report pages of the steps what was run on which clouds, and with which parameters."""
        systems = [read_extent(path)[2] or self._crs.toWkt(FULL) for path in self._clouds]
        rows = about_run(self.displayName(), self._clouds, self._points(), systems[0] if systems else "")
        for output in self.pipeline.outputs:
            page = results.get(output.name.upper())
            if output.of == REPORT.lower() and page:
                complete_page(Path(page), rows, log.steps)

    def _points(self) -> int:
        return sum(count_points(path, self._box) for path in self._clouds)

    def _run_steps(self, parameters: dict, context: QgsProcessingContext, feedback: QgsProcessingFeedback) -> dict:
        with _own_steps(context), tempfile.TemporaryDirectory() as folder:
            given = {**parameters, **self._parts(Path(folder), feedback)}
            steps = ChainFeedback(feedback)
            results = super().processAlgorithm(given, context, steps)
            steps.end_step()
        if feedback.isCanceled():
            # QGIS leaves out the steps that are left and returns what the others made.
            raise Cancelled
        return results

    def _parts(self, folder: Path, feedback: QgsProcessingFeedback) -> dict:
        """Return the inputs that are parts of clouds or get a CRS, written to a folder; nothing for whole clouds."""
        if not self._clouds or (self._box is None and self._needs_no_crs):
            return {}
        parts = []
        for number, path in enumerate(self._clouds):
            cloud = read_named(path, FeedbackMonitor(feedback).part(0.0, 0.0), self._crs, self._box)
            parts.append(str(folder / f"{number}" / f"{path.name.split('.')[0]}.las"))
            Path(parts[-1]).parent.mkdir()
            write_cloud(cloud, parts[-1])
        return {INPUTS: parts} if self.pipeline.merges else {INPUT: parts[0]}

    def _finished(self, results: dict, parameters: dict) -> dict:
        """Return the results of the steps under the names of the composite's outputs."""
        gone = self._not_kept(parameters)
        made = {name: value for name, value in results.items() if value is not None and name not in gone}
        return {**made, **self._numbers(results.get("CHILD_RESULTS", {}))}

    def _numbers(self, child_results: dict[str, dict[str, Any]]) -> dict:
        numbers = {}
        for step in self.pipeline.steps:
            for name in number_outputs(step.stage):
                numbers[step_output_name(step, name)] = child_results.get(step.name, {}).get(name)
        return numbers
