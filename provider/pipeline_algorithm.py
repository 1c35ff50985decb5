"""The shipped composites as algorithms: all steps run in memory, and only those that the wanted outputs need."""

from typing import Any

from qgis.core import QgsProcessingContext, QgsProcessingFeedback

from ..algorithms.help import pipeline_help
from ..algorithms.pipeline import Output, Pipeline, Step
from ..algorithms.run import Results, run_pipeline
from ..algorithms.stage import CLOUD, REPORT, Monitor, Raster
from .cloud_algorithm import CloudAlgorithm, Read
from .destinations import Made
from .feedback import ChainMonitor
from .given import Given
from .models import output_label, output_title, pipeline_parameters
from .parameters import automatic_numbers, number_outputs, tunable_values, used_name
from .run_log import RunLog
from .styles import switch_off
from .vectors import number

# The number of each step of a composite that is timed, and its title.
_TIME = {"SECONDS": "Seconds"}

# Outputs of this rank and of higher ones are intermediate results.
_INTERMEDIATE = 3


def _rank(output: Output) -> int:
    """Return the rank of an output in the dialog: cloud, layers, reports; rasters and kept clouds come last."""
    if output.of == CLOUD:
        return 0 if output.name == output.of else 4
    if isinstance(output.declared, Raster):
        return _INTERMEDIATE
    return 2 if output.of == REPORT else 1


def step_output_name(step: Step, name: str) -> str:
    """Return the composite's name of a step's number, ``GROUND_CELL_SIZE_USED``."""
    return f"{step.name.upper()}_{name}"


class PipelineAlgorithm(CloudAlgorithm):
    """A composite as a Processing algorithm.

    It runs in memory. Its graph, which the designer opens and users change, is a model of the same steps.
    """

    # Steps take nearly all of the time.
    shares = (0.03, 0.96)

    def __init__(self, pipeline: Pipeline) -> None:
        super().__init__()
        self.pipeline = self.declared = pipeline
        self.compared = pipeline.compared
        self.layers = pipeline.input_layers.values()
        self.made = [_made(pipeline, output) for output in sorted(pipeline.outputs, key=_rank)]

    def help(self) -> str:
        """Return the help as HTML."""
        return pipeline_help(self.pipeline)

    def add_tunables(self) -> None:
        """Declare the parameters of all steps."""
        for definition in pipeline_parameters(self.pipeline).values():
            self.addParameter(definition)

    def tunables(self, given: Given) -> dict[str, Any]:
        """Return the checked values of the parameters of all steps by their names."""
        return pipeline_tunables(given, self.pipeline)

    def number_titles(self) -> dict[str, str]:
        """Return the titles of the numbers of all steps (used values, measures) by name."""
        return {
            step_output_name(step, name): output_label(step, title)
            for step in self.pipeline.steps
            for name, title in {**number_outputs(step.stage), **(_TIME if self.pipeline.timed else {})}.items()
        }

    def check(self, parameters: dict, context: QgsProcessingContext) -> None:
        """Check the parameters; raise a ValueError where a run can't succeed."""
        super().check(parameters, context)
        if not self.job.wanted:
            names = ", ".join(made.name for made in self.made)
            raise ValueError(f"'{self.displayName()}' has nothing to make; give at least one of its outputs: {names}.")

    def monitor(self, feedback: QgsProcessingFeedback, log: RunLog) -> ChainMonitor:
        """Return the monitor of a run: it shows the progress and keeps the messages of steps."""
        return ChainMonitor(feedback, log)

    def compute(self, read: Read, monitor: Monitor) -> Results:
        """Run the steps that the wanted outputs need."""
        cloud = read.clouds if self.pipeline.merges else read.clouds[0] if read.clouds else None
        wanted = [made.key for made in self.job.wanted]
        return run_pipeline(
            self.pipeline, cloud, monitor, read.layers, wanted, reference=read.reference, **self.job.tunables
        )

    def numbers(self, results: Results, values: dict[str, Any]) -> dict[str, Any]:
        """Return the numbers of the steps that were run, by the names of their outputs."""
        numbers = {}
        for step in self.pipeline.steps_for([made.key for made in self.job.wanted]):
            for tunable in automatic_numbers(step.stage):
                given = self.job.tunables[self.pipeline.parameter(step, tunable.name)]
                used = values.get(f"{step.name}_{tunable.name}") if given is None else given
                numbers[step_output_name(step, used_name(tunable))] = number(used)
            for name in _TIME if self.pipeline.timed else ():
                numbers[step_output_name(step, name)] = number(values[f"{step.name}_{name.lower()}"])
        for output in self.pipeline.outputs:
            report = results.reports.get(output.name)
            for measure in output.step.stage.measures if report is not None else ():
                numbers[step_output_name(output.step, measure.name.upper())] = number(report.values[measure.name])
        return numbers

    def processAlgorithm(  # noqa: N802
        self, parameters: dict, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ) -> dict:
        """Run the steps; layers that other steps have taken further are loaded switched off."""
        results = super().processAlgorithm(parameters, context, feedback)
        helpers = (name.upper() for name in self.pipeline.switched_off)
        switch_off(context, [results[name] for name in helpers if name in results])
        return results


def pipeline_tunables(given: Given, pipeline: Pipeline) -> dict[str, Any]:
    """Return the checked values of a composite's parameters by its own names."""
    values = {}
    for step in pipeline.steps:
        named = {name: pipeline.parameter(step, name) for name in step.stage.tunables}
        shown = {name: composite.upper() for name, composite in named.items()}
        of_step = tunable_values(given, step.stage, shown, step.tunables)
        values.update({named[name]: value for name, value in of_step.items()})
    return values


def _made(pipeline: Pipeline, output: Output) -> Made:
    """Return how an output is declared and shown. Results of steps in between are made on request only."""
    # Layers, such as footprints, may be all that is wanted.
    optional = output.name != CLOUD or any(other.of != CLOUD for other in pipeline.outputs)
    title, is_result = output_title(pipeline, output), output.name == CLOUD or _rank(output) < _INTERMEDIATE
    only_with = output.step.only_with
    return Made(output.name.upper(), title, output.step.stage, output.declared, optional, is_result, only_with)
