"""Pipelines as Processing models, drawn from ``pipelines.py`` when the designer asks for them."""

from typing import Any

from qgis.core import (
    Qgis,
    QgsProcessingModelAlgorithm,
    QgsProcessingModelChildAlgorithm,
    QgsProcessingModelChildParameterSource,
    QgsProcessingModelGroupBox,
    QgsProcessingModelOutput,
    QgsProcessingModelParameter,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterFile,
    QgsProcessingParameterMultipleLayers,
)
from qgis.PyQt.QtCore import QPointF, QSizeF
from qgis.PyQt.QtGui import QColor

from ..algorithms.help import lower_first, pipeline_help, step_label, step_title
from ..algorithms.pipeline import Output, Pipeline, Step
from ..algorithms.stage import CLOUD, REPORT
from . import PROVIDER_ID
from .clouds import FILTER
from .input_layers import input_layer_name, input_layer_parameter
from .inputs import INPUT, INPUTS, OUTPUT, REFERENCE, cloud_title, result_title
from .parameters import parameter, parameter_name


def output_label(step: Step, label: str) -> str:
    """Return the composite's label of a step's output, "Openings: facades with openings"."""
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
    """Positions (pixels) in the drawing of a model: a band per step, parameters left, the algorithm on the right."""

    columns, cell, box = 3, QSizeF(250, 66), QSizeF(220, 52)  #: of parameters: columns, cells, and boxes within these
    child = QSizeF(260, 50)  #: the box of an algorithm
    margin, gap = 40.0, 40.0  #: inside a band, and between bands

    def __init__(self) -> None:
        self.top = 150.0  #: of the band, under the row of the clouds

    def band(self, n_parameters: int, n_outputs: int) -> float:
        """Return the height of a band with these numbers of parameters and outputs."""
        return max(self.rows(n_parameters), n_outputs) * self.cell.height() + 1.5 * self.margin

    def rows(self, n_parameters: int) -> int:
        """Return the rows of cells for a number of parameters."""
        return max(2, -(-n_parameters // self.columns))

    def parameter(self, i: int) -> QPointF:
        """Return the center of the ``i``-th parameter of the band."""
        row, column = divmod(i, self.columns)
        x = self.margin + self.cell.width() * (column + 0.5)
        return QPointF(x, self.top + self.margin + self.cell.height() * (row + 0.5))

    @property
    def algorithm_x(self) -> float:
        """Middle of the column of algorithms, from the left."""
        return 2 * self.margin + self.columns * self.cell.width() + self.child.width() / 2

    def middle(self, height: float) -> QPointF:
        """Return the center of the band's algorithm."""
        return QPointF(self.algorithm_x, self.top + height / 2)

    def frame(self, height: float) -> tuple[QPointF, QSizeF]:
        """Return center and size of the box around the band."""
        width = self.algorithm_x + self.child.width() / 2 + self.margin
        return QPointF(width / 2, self.top + height / 2), QSizeF(width, height)


def _placed(component: Any, center: QPointF, size: QSizeF) -> Any:
    """Return a component of the drawing with its center and its size."""
    component.setPosition(center)
    component.setSize(size)
    return component


def build_model(pipeline: Pipeline) -> QgsProcessingModelAlgorithm:
    """Return the model of a pipeline: steps in order, each fed as the pipeline says."""
    model = QgsProcessingModelAlgorithm(pipeline.title, pipeline.group, "")
    layout = _Layout()
    clouds = _clouds(pipeline)
    for column, definition in enumerate(clouds):
        center = QPointF(layout.algorithm_x - column * layout.cell.width(), 60)
        component = _placed(QgsProcessingModelParameter(definition.name()), center, layout.box)
        model.addModelParameter(definition, component)
    definitions = {input_layer_name(layer): input_layer_parameter(layer) for layer in pipeline.input_layers.values()}
    definitions.update(pipeline_parameters(pipeline))
    for step in pipeline.steps:
        _add_parameters(model, pipeline, step, definitions, layout)
        _add_step(model, pipeline, step, layout)
    model.setHelpContent({"ALG_DESC": pipeline_help(pipeline), "SHORT_DESCRIPTION": pipeline.summary})
    model.setParameterOrder([*(definition.name() for definition in clouds), *definitions])
    return model


def _clouds(pipeline: Pipeline) -> list[QgsProcessingParameterDefinition]:
    """Return the parameter for the cloud or clouds that a composite reads: files.

    The designer runs a model with QGIS's own parameters; those for layers take no LAS and LAZ where QGIS has no PDAL.
    """
    others = []
    if pipeline.compared is not None:
        title, optional = pipeline.compared.reference_title, not pipeline.needs_reference
        others = [QgsProcessingParameterFile(REFERENCE, title, optional=optional, fileFilter=FILTER)]
    elif pipeline.merges:
        return [QgsProcessingParameterMultipleLayers(INPUTS, "Point clouds", Qgis.ProcessingSourceType.File)]
    if not pipeline.reads_cloud:
        return []
    return [QgsProcessingParameterFile(INPUT, pipeline.input_title, fileFilter=FILTER), *others]


def output_title(pipeline: Pipeline, output: Output) -> str:
    """Return what an output of a composite is called; the step's name is part of it where it distinguishes outputs."""
    stage = output.step.stage
    if output.of == CLOUD:
        makers = [step.stage for step in pipeline.steps if step.stage.makes_cloud]
        title = cloud_title(makers if output.name == CLOUD else [stage])
    else:
        title = result_title(stage, output.declared)
    is_alone = output.name == output.of or (output.of == REPORT and title != "Report")
    return title if is_alone else output_label(output.step, title)


def _layers_taken(pipeline: Pipeline, step: Step) -> list[str]:
    """Return the names of the layers given to the composite that ``step`` is the first to read."""
    before = [_given(other) for other in pipeline.steps[: pipeline.steps.index(step)]]
    return [name.upper() for name in _given(step) if not any(name in names for names in before)]


def _given(step: Step) -> list[str]:
    """Return the names of the layers that a step reads of those given to the composite."""
    return [input_layer.name for input_layer in step.stage.input_layers if input_layer.name not in step.layers]


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
    """Add the parameters that a step is the first to take, laid out next to its box."""
    names = _first_taken(pipeline, step)
    last = layout.rows(len(names)) * layout.columns - 1
    layers = _layers_taken(pipeline, step)
    own = [name for name in names if name.lower() not in pipeline.shared and name not in layers]
    cells = {name: i for i, name in enumerate(own)}
    # Layers and parameters that steps share are at the lower right, where their lines cross the fewest boxes.
    cells.update({name: last - i for i, name in enumerate(name for name in names if name not in own)})
    for name, cell in cells.items():
        component = _placed(QgsProcessingModelParameter(name), layout.parameter(cell), layout.box)
        model.addModelParameter(definitions[name], component)


def _add_step(model: QgsProcessingModelAlgorithm, pipeline: Pipeline, step: Step, layout: _Layout) -> None:
    """Add the child algorithm of a step, its parameters wired to the model's and to earlier steps."""
    child = QgsProcessingModelChildAlgorithm(f"{PROVIDER_ID}:{step.stage.id}")
    child.setChildId(step.name)
    child.setDescription(step.stage.title)
    # A model runs all of its steps: who has a reference activates the one that needs it.
    child.setActive(REFERENCE.lower() not in step.only_with)
    for name, source in _sources(pipeline, step).items():
        child.addParameterSources(name, [source])
    made = [output for output in pipeline.outputs if output.step is step]
    height = layout.band(len(_first_taken(pipeline, step)), len(made))
    for tunable in step.stage.tunables.values():
        name = pipeline.parameter(step, tunable.name).upper()
        sources = [QgsProcessingModelChildParameterSource.fromModelParameter(name)]
        child.addParameterSources(parameter_name(tunable), sources)
    child.setModelOutputs(_model_outputs(pipeline, made, layout.middle(height)))
    model.addChildAlgorithm(_placed(child, layout.middle(height), layout.child))
    box = _placed(QgsProcessingModelGroupBox(step.stage.title), *layout.frame(height))
    box.setColor(QColor(235, 240, 245))
    model.addGroupBox(box)
    layout.top += height + layout.gap


def _sources(pipeline: Pipeline, step: Step) -> dict[str, QgsProcessingModelChildParameterSource]:
    """Return where a step's cloud and layers come from, by the names of its stage's inputs."""
    found = {}
    feeder = pipeline.cloud_of(step)
    name = INPUTS if step.stage.merges else INPUT
    if feeder is not None:
        found[name] = _from_child(feeder, OUTPUT) if feeder else _from_parameter(name)
    if step.stage.reads_reference:
        found[REFERENCE] = _from_parameter(REFERENCE)
    for input_layer in step.stage.input_layers:
        name, made = input_layer_name(input_layer), step.layers.get(input_layer.name)
        found[name] = _from_child(*made.split(".")) if made else _from_parameter(name)
    return found


def _from_parameter(name: str) -> QgsProcessingModelChildParameterSource:
    return QgsProcessingModelChildParameterSource.fromModelParameter(name)


def _from_child(step_name: str, output: str) -> QgsProcessingModelChildParameterSource:
    return QgsProcessingModelChildParameterSource.fromChildOutput(step_name, output.upper())


def _model_outputs(pipeline: Pipeline, of_step: list[Output], middle: QPointF) -> dict[str, QgsProcessingModelOutput]:
    """Return what the model shows of a step, laid out to the right of its box."""
    outputs = {}
    for i, made in enumerate(of_step):
        shown = output_title(pipeline, made)
        # QGIS gives a layer that it loads the name of the model's output.
        output = QgsProcessingModelOutput(shown)
        output.setChildId(made.step.name)
        output.setChildOutputName(made.of.upper())
        output.setDescription(shown)
        output.setMandatory(pipeline.needs(made))
        center = QPointF(middle.x() + 360, middle.y() + 70 * (i - (len(of_step) - 1) / 2))
        outputs[shown] = _placed(output, center, QSizeF(240, 40))
    return outputs
