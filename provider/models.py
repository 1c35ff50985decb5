"""Pipelines as Processing models: written from ``pipelines.py``, shipped, and loaded as algorithms."""

from __future__ import annotations

import uuid
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
    QgsProcessingModelChildAlgorithm,
    QgsProcessingModelChildParameterSource,
    QgsProcessingModelGroupBox,
    QgsProcessingModelOutput,
    QgsProcessingModelParameter,
    QgsProcessingOutputNumber,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterMultipleLayers,
    QgsProcessingParameterPointCloudLayer,
)
from qgis.PyQt.QtCore import QPointF, QSizeF, QUrl
from qgis.PyQt.QtGui import QColor, QIcon

from ..algorithms.cloud.cloud import check_readable
from ..algorithms.pipelines import Output, Pipeline, Step
from . import paths
from .crs import crs_units
from .dependencies import missing_sentence
from .errors import one_sentence
from .feedback import ChainFeedback, tell_unknown
from .help import lower_first, pipeline_help, step_title
from .outputs import check_targets, files_of, nothing_left_on_failure
from .parameters import number_outputs, parameter, parameter_name, tunable_values
from .sources import refuse_elsewhere, source_files, source_name, source_parameter
from .stage_algorithm import (
    INPUT,
    INPUTS,
    OUTPUT,
    REPORT,
    cloud_title,
    input_parameter,
    input_paths,
    on_command_line,
    shown_help,
)

PROVIDER = "lidarbuildings"


def step_output_name(step: Step, name: str) -> str:
    """Return the composite's name of a step's output, ``GROUND_CELL_SIZE_USED``."""
    return f"{step.name.upper()}_{name}"


def step_label(step: Step, label: str) -> str:
    """Return the composite's label of a step's parameter or output, "Ground: cell size (m)"."""
    return f"{step_title(step)}: {lower_first(label)}"


def pipeline_parameters(pipeline: Pipeline) -> dict[str, QgsProcessingParameterDefinition]:
    """Return the parameters of a composite by name, made from the stages' own definitions.

    Names and labels begin with the step unless steps share them, defaults are the step's
    where it has its own, and all are advanced but those that the pipeline shows.
    """
    definitions = {}
    for name, (step, tunable) in pipeline.parameters.items():
        definition = parameter(tunable)
        definition.setName(name.upper())
        if name not in pipeline.shared:
            definition.setDescription(step_label(step, definition.description()))
        if tunable.name in step.tunables:
            default = step.tunables[tunable.name]
            definition.setDefaultValue(list(default) if isinstance(default, tuple) else default)
        advanced = Qgis.ProcessingParameterFlag.Advanced
        flags = definition.flags()
        definition.setFlags(flags & ~advanced if name in pipeline.shown else flags | advanced)
        definitions[definition.name()] = definition
    return definitions


class _Layout:
    """Where things are drawn: one band per step, its parameters on the left, its algorithm right of them."""

    columns, cell, box = 3, QSizeF(250, 66), QSizeF(220, 52)
    child = QSizeF(260, 50)
    margin, gap = 40.0, 40.0

    def __init__(self) -> None:
        self.top = 150.0

    def band(self, n_parameters: int, n_outputs: int) -> float:
        """Return the height of a band with so many parameters and outputs."""
        return max(self.rows(n_parameters), n_outputs) * self.cell.height() + 1.5 * self.margin

    def rows(self, n_parameters: int) -> int:
        """Return the rows of cells for so many parameters."""
        return max(2, -(-n_parameters // self.columns))

    def parameter(self, i: int) -> QPointF:
        """Return the center of the ``i``-th parameter of the band."""
        row, column = divmod(i, self.columns)
        x = self.margin + self.cell.width() * (column + 0.5)
        return QPointF(x, self.top + self.margin + self.cell.height() * (row + 0.5))

    @property
    def right(self) -> float:
        """Where the algorithms' column has its middle."""
        return 2 * self.margin + self.columns * self.cell.width() + self.child.width() / 2

    def middle(self, height: float) -> QPointF:
        """Return the center of the band's algorithm."""
        return QPointF(self.right, self.top + height / 2)

    def frame(self, height: float) -> tuple[QPointF, QSizeF]:
        """Return center and size of the box around the band."""
        width = self.right + self.child.width() / 2 + self.margin
        return QPointF(width / 2, self.top + height / 2), QSizeF(width, height)


def build_model(pipeline: Pipeline) -> QgsProcessingModelAlgorithm:
    """Return the model of a pipeline: steps in order, each fed as the pipeline says."""
    model = QgsProcessingModelAlgorithm(pipeline.title, pipeline.group, "")
    layout = _Layout()
    clouds = _clouds(pipeline)
    for definition in clouds:
        where = QgsProcessingModelParameter(definition.name())
        where.setPosition(QPointF(layout.right, 60))
        where.setSize(layout.box)
        model.addModelParameter(definition, where)
    definitions = {source_name(source): source_parameter(source) for source in pipeline.sources.values()}
    definitions.update(pipeline_parameters(pipeline))
    for step in pipeline.steps:
        _add_parameters(model, pipeline, step, definitions, layout)
        _add_step(model, pipeline, step, layout)
    model.setHelpContent({"ALG_DESC": pipeline_help(pipeline), "SHORT_DESCRIPTION": pipeline.summary})
    model.setParameterOrder([*(definition.name() for definition in clouds), *definitions])
    return model


def _clouds(pipeline: Pipeline) -> list[QgsProcessingParameterDefinition]:
    """Return the parameter for the cloud or clouds that a composite reads, in QGIS's own type, as the designer does."""
    if pipeline.merges:
        return [QgsProcessingParameterMultipleLayers(INPUTS, "Point clouds", Qgis.ProcessingSourceType.PointCloud)]
    return [QgsProcessingParameterPointCloudLayer(INPUT, "Point cloud")] if pipeline.reads_cloud else []


def output_title(pipeline: Pipeline, output: Output) -> str:
    """Return what an output of a composite is called; the step's name is said where it tells outputs apart."""
    stage = output.step.stage
    if output.of == "output":
        makers = [step.stage for step in pipeline.steps if step.stage.makes_cloud]
        title = cloud_title(makers if output.name == "output" else [stage])
    else:
        titles = {made.name: made.title for made in (*stage.layers, *stage.rasters)}
        title = titles.get(output.of, "Report")
    return title if output.name == output.of else step_label(output.step, title)


def _layers_taken(pipeline: Pipeline, step: Step) -> list[str]:
    """Return the names of the layers given to the composite that ``step`` is the first to read."""
    before = [_given(other) for other in pipeline.steps[: pipeline.steps.index(step)]]
    return [name.upper() for name in _given(step) if not any(name in names for names in before)]


def _given(step: Step) -> list[str]:
    return [source.name for source in step.stage.sources if source.name not in step.layers]


def _first_taken(pipeline: Pipeline, step: Step) -> list[str]:
    """Return the names of the layers and other parameters that ``step`` is the first to take."""
    tunables = [name.upper() for name, (first, _) in pipeline.parameters.items() if first is step]
    return tunables + _layers_taken(pipeline, step)


def _add_parameters(
    model: QgsProcessingModelAlgorithm,
    pipeline: Pipeline,
    step: Step,
    definitions: dict[str, QgsProcessingParameterDefinition],
    layout: _Layout,
) -> None:
    """Add the parameters that a step is the first to take, laid out beside its box."""
    names = _first_taken(pipeline, step)
    last = layout.rows(len(names)) * layout.columns - 1
    layers = _layers_taken(pipeline, step)
    own = [name for name in names if name.lower() not in pipeline.shared and name not in layers]
    cells = {name: i for i, name in enumerate(own)}
    # Layers, and what goes on to other steps, stand at the lower right, where their lines cross the fewest boxes.
    cells.update({name: last - i for i, name in enumerate(name for name in names if name not in own)})
    for name, cell in cells.items():
        component = QgsProcessingModelParameter(name)
        component.setPosition(layout.parameter(cell))
        component.setSize(layout.box)
        model.addModelParameter(definitions[name], component)


def _add_step(
    model: QgsProcessingModelAlgorithm,
    pipeline: Pipeline,
    step: Step,
    layout: _Layout,
) -> None:
    """Add the child algorithm of a step, its parameters wired to those of the model and to earlier steps."""
    child = QgsProcessingModelChildAlgorithm(f"{PROVIDER}:{step.stage.id}")
    child.setChildId(step.name)
    child.setDescription(step.stage.title)
    for name, source in _sources(pipeline, step).items():
        child.addParameterSources(name, [source])
    made = [output for output in pipeline.outputs if output.step is step]
    height = layout.band(len(_first_taken(pipeline, step)), len(made))
    for tunable in step.stage.tunables.values():
        name = pipeline.parameter(step, tunable.name).upper()
        sources = [QgsProcessingModelChildParameterSource.fromModelParameter(name)]
        child.addParameterSources(parameter_name(tunable), sources)
    child.setPosition(layout.middle(height))
    child.setSize(layout.child)
    child.setModelOutputs(_model_outputs(pipeline, made, layout.middle(height)))
    model.addChildAlgorithm(child)
    model.addGroupBox(_frame(step, layout, height))
    layout.top += height + layout.gap


def _sources(pipeline: Pipeline, step: Step) -> dict[str, QgsProcessingModelChildParameterSource]:
    """Return where a step's cloud and layers come from, by the names of its stage's inputs."""
    found = {}
    feeder = pipeline.cloud_of(step)
    name = INPUTS if step.stage.merges else INPUT
    if feeder is not None:
        found[name] = _from_child(feeder, OUTPUT) if feeder else _from_parameter(name)
    for source in step.stage.sources:
        if source.name in step.layers:
            found[source_name(source)] = _from_child(*step.layers[source.name].split("."))
        else:
            found[source_name(source)] = _from_parameter(source_name(source))
    return found


def _from_parameter(name: str) -> QgsProcessingModelChildParameterSource:
    return QgsProcessingModelChildParameterSource.fromModelParameter(name)


def _from_child(step_name: str, output: str) -> QgsProcessingModelChildParameterSource:
    return QgsProcessingModelChildParameterSource.fromChildOutput(step_name, output.upper())


def _model_outputs(
    pipeline: Pipeline, outputs_of_step: list[Output], middle: QPointF
) -> dict[str, QgsProcessingModelOutput]:
    """Return what the model shows of a step, laid out to the right of its box."""
    outputs = {}
    for i, made in enumerate(outputs_of_step):
        shown = output_title(pipeline, made)
        # A layer that QGIS loads is called as the model's output.
        output = QgsProcessingModelOutput(shown)
        output.setChildId(made.step.name)
        output.setChildOutputName(made.of.upper())
        output.setDescription(shown)
        output.setMandatory(pipeline.needs(made))
        output.setPosition(QPointF(middle.x() + 360, middle.y() + 70 * (i - (len(outputs_of_step) - 1) / 2)))
        output.setSize(QSizeF(240, 40))
        outputs[shown] = output
    return outputs


def _frame(step: Step, layout: _Layout, height: float) -> QgsProcessingModelGroupBox:
    box = QgsProcessingModelGroupBox(step.stage.title)
    # QGIS draws a random id, which would make each generated file another.
    facts = box.toVariant()
    facts["uuid"] = "{" + str(uuid.uuid5(uuid.NAMESPACE_URL, f"{PROVIDER}:{step.name}")) + "}"
    box.loadVariant(facts)
    position, size = layout.frame(height)
    box.setPosition(position)
    box.setSize(size)
    box.setColor(QColor(235, 240, 245))
    return box


# Outputs of this rank or a higher one are what the result comes from.
_FROM_BETWEEN = 3


def _rank(output: Output) -> int:
    """Return where an output stands in the dialog: cloud, layers, reports; rasters and kept clouds come last."""
    if output.of == OUTPUT.lower():
        return 0 if output.name == output.of else 4
    rasters = [raster.name for raster in output.step.stage.rasters]
    return 2 if output.of == REPORT.lower() else _FROM_BETWEEN if output.of in rasters else 1


def model_file(pipeline: Pipeline) -> Path:
    """Return where the model of a pipeline is shipped."""
    return paths.MODELS / f"{pipeline.id}.model3"


class PipelineAlgorithm(QgsProcessingModelAlgorithm):
    """A shipped model with its pipeline's id and title.

    A model loaded as it is has its title as id, refuses LAS and LAZ where QGIS has no PDAL,
    ignores its own defaults and names its outputs by their titles; this class mends these and nothing else.
    """

    def __init__(self, pipeline: Pipeline) -> None:
        super().__init__()
        self.pipeline = pipeline
        if not self.fromFile(str(model_file(pipeline))):
            raise QgsProcessingException(
                f"The model {model_file(pipeline).name} of the plugin can't be read; install it again."
            )
        self._mend_parameters()
        if on_command_line():
            # Of models it shows this alone.
            self.setHelpContent({"ALG_DESC": f"{pipeline.summary}\n{self.shortHelpString()}"})

    def _mend_parameters(self) -> None:
        """Let the input take any path, and name outputs by their names instead of their titles."""
        # A model's file holds no tooltips.
        helps = {name: definition.help() for name, definition in pipeline_parameters(self.pipeline).items()}
        helps.update({source_name(source): source.help for source in self.pipeline.sources.values()})
        mended = [self._mended(definition, helps) for definition in self.parameterDefinitions()]
        order = [output.name.upper() for output in sorted(self.pipeline.outputs, key=_rank)]
        mended.sort(key=lambda made: order.index(made.name()) if made.isDestination() else -1)
        for definition in self.parameterDefinitions():
            self.removeParameter(definition.name())
        for definition in mended:
            self.addParameter(definition)

    def _mended(
        self, definition: QgsProcessingParameterDefinition, helps: dict[str, str]
    ) -> QgsProcessingParameterDefinition:
        """Return a parameter of the model with its help, an output under the name that the chain gives it."""
        if definition.name() in (INPUT, INPUTS):
            return input_parameter(self.pipeline.merges)
        mended = definition.clone()
        mended.setHelp(helps.get(definition.name(), definition.help()))
        if definition.isDestination():
            facts = definition.metadata()
            made = self.childAlgorithm(facts["_modelChildId"]).modelOutput(facts["_modelChildOutputName"])
            output = self._output(made.childId(), made.childOutputName().lower())
            mended.setName(output.name.upper())
            if mended.name() != OUTPUT:
                mended.setFlags(mended.flags() | Qgis.ProcessingParameterFlag.Optional)
                # Who wants what the result comes from asks for it.
                mended.setCreateByDefault(_rank(output) < _FROM_BETWEEN)
        return mended

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

    def name(self) -> str:
        """Return the id, frozen: saved models depend on it."""
        return self.pipeline.id

    def displayName(self) -> str:  # noqa: N802
        """Return the title."""
        return self.pipeline.title

    def group(self) -> str:
        """Return the group's title."""
        return self.pipeline.group

    def groupId(self) -> str:  # noqa: N802
        """Return the group's id."""
        return self.pipeline.group.lower().replace(" ", "")

    def tags(self) -> list:
        """Return words that the toolbox finds the pipeline by."""
        return [tag.strip() for tag in self.pipeline.tags.split(",") if tag.strip()]

    def icon(self) -> QIcon:
        """Return the plugin's icon."""
        return QIcon(str(paths.ICON))

    def svgIconPath(self) -> str:  # noqa: N802
        """Return the icon's file."""
        return str(paths.ICON)

    def shortDescription(self) -> str:  # noqa: N802
        """Return what the pipeline is for."""
        return self.pipeline.summary

    def shortHelpString(self) -> str:  # noqa: N802
        """Return the help that the dialog shows beside the parameters."""
        return shown_help(pipeline_help(self.pipeline))

    def helpUrl(self) -> str:  # noqa: N802
        """Return the help page, which comes with the plugin."""
        return QUrl.fromLocalFile(str(paths.HELP / f"{self.pipeline.id}.html")).toString()

    def asPythonCommand(self, parameters: dict, context: QgsProcessingContext) -> str:  # noqa: N802
        """Return the call that the dialog copies; of a model as such QGIS knows none."""
        return QgsProcessingAlgorithm.asPythonCommand(self, parameters, context)

    def canExecute(self) -> tuple[bool, str]:  # noqa: N802
        """Whether all packages are there, and how to install what is missing."""
        missing = missing_sentence()
        return (False, missing) if missing else super().canExecute()

    def checkParameterValues(self, parameters: dict, context: QgsProcessingContext) -> tuple[bool, str]:  # noqa: N802
        """Refuse what can be refused before the run, in the words that the run would use."""
        try:
            self._check(parameters, context)
        except ValueError as error:
            return False, str(error)
        return super().checkParameterValues(self._with_defaults(parameters), context)

    def _check(self, parameters: dict, context: QgsProcessingContext) -> None:
        """Refuse with a ValueError what can be refused before the first step."""
        missing = missing_sentence()
        if missing:
            raise ValueError(missing)
        given = self._with_defaults(parameters)
        for step in self.pipeline.steps:
            named = {name: self.pipeline.parameter(step, name).upper() for name in step.stage.tunables}
            tunable_values(self, step.stage, given, context, named)
        clouds = input_paths(self, self.pipeline.merges, given, context) if self.pipeline.reads_cloud else []
        read = [*clouds, *source_files(self, self.pipeline.sources.values(), given, context)]
        check_targets(self.destinationParameterDefinitions(), given, read)
        for cloud in clouds:
            # Now, as QGIS opens the input of a model as a layer too, and a damaged COPC can hang it.
            check_readable(cloud, crs_units)
        if clouds:
            refuse_elsewhere(self, self.pipeline.sources.values(), clouds, given, context)

    def _with_defaults(self, parameters: dict) -> dict:
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
        return [name for name in needed if name != OUTPUT and parameters.get(name) in (None, "")]

    def processAlgorithm(  # noqa: N802
        self, parameters: dict, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ) -> dict:
        """Run the graph; all or nothing."""
        tell_unknown(self, parameters, feedback)
        with one_sentence(), nothing_left_on_failure(self._target_files(parameters)):
            self._check(parameters, context)
            results = super().processAlgorithm(self._with_defaults(parameters), context, ChainFeedback(feedback))
        gone = self._not_kept(parameters)
        made = {name: value for name, value in results.items() if value is not None and name not in gone}
        return {**made, **self._numbers(results.get("CHILD_RESULTS", {}))}

    def _target_files(self, parameters: dict) -> list:
        definitions = self.destinationParameterDefinitions()
        return [path for d in definitions for path in files_of(d, parameters.get(d.name()))]

    def _numbers(self, child_results: dict[str, dict[str, Any]]) -> dict:
        numbers = {}
        for step in self.pipeline.steps:
            for name in number_outputs(step.stage):
                numbers[step_output_name(step, name)] = child_results.get(step.name, {}).get(name)
        return numbers
