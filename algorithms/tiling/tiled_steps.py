"""Sort the steps of a composite: run in blocks, run once for the whole survey, or not possible in tiles."""

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from ..pipeline import REFERENCE, REPORT, Pipeline, Step, made_by
from ..stage import Layer, TextFile

# Steps of this group decide which points there are and which of them are noise.
_PREPARATION = "Preparation"


def of_survey(pipeline: Pipeline) -> Pipeline:
    """Return a composite without steps that merge clouds, as the files of a survey are one, or only measure points."""
    left_out = [step for step in pipeline.steps if step.stage.merges or _only_measures(step)]
    superfluous = {name for name, (step, _) in pipeline.parameters.items() if step in left_out}
    steps = tuple(step for step in pipeline.steps if step not in left_out)
    return replace(pipeline, steps=steps, shown=tuple(name for name in pipeline.shown if name not in superfluous))


def _only_measures(step: Step) -> bool:
    """Whether a step measures points, or assesses them, and makes nothing of them."""
    return REFERENCE in step.only_with or (step.stage.needs_cloud and set(step.stage.outputs) == {REPORT})


def in_blocks(pipeline: Pipeline) -> Pipeline:
    """Return the part of a composite that works on points: it is run on each block."""
    return part_of(pipeline, [step for step in of_survey(pipeline).steps if step.stage.needs_cloud])


def part_of(pipeline: Pipeline, steps: Iterable[Step]) -> Pipeline:
    """Return a composite of some of the steps of another one, with parameters of the same names."""
    return replace(pipeline, steps=tuple(steps), shown=(), kept=())


def afterwards(pipeline: Pipeline) -> list[Step]:
    """Return the steps that can do with layers alone: they are run once, on the layers of the whole survey."""
    return [step for step in pipeline.steps if not step.stage.needs_cloud]


def tunables_of(pipeline: Pipeline, tunables: dict) -> dict:
    """Return those tunables of a composite that a part of it has."""
    return {name: value for name, value in tunables.items() if name in pipeline.parameters}


def preparing(pipeline: Pipeline) -> list[Step]:
    """Return the steps of preparation before any other step that asks how the cloud was sampled."""
    steps = []
    for step in pipeline.steps:
        if step.stage.group == _PREPARATION:
            steps.append(step)
        elif step.stage.samples:
            break
    return steps


def measuring(pipeline: Pipeline) -> list[Step]:
    """Return the steps up to the last that prepares the points or measures values that parts take of the whole."""
    prepares = preparing(pipeline)
    last = (at for at, step in enumerate(pipeline.steps, start=1) if step.stage.of_whole or step in prepares)
    return list(pipeline.steps[: max(last, default=0)])


def owners(pipeline: Pipeline) -> dict[str, tuple[str, str]]:
    """Return for each layer whose features belong to another: the field with the number of the other, and that layer.

    Layers go by the composite's names.
    """
    names = {(output.step.name, output.of): output.name for output in pipeline.outputs}
    found = {}
    for step in pipeline.steps:
        for layer in step.stage.layers:
            for field in layer.fields:
                if field.of:
                    found[names[step.name, layer.name]] = field.name, _named(names, step, field.of)
    return found


def layers_of(pipeline: Pipeline) -> dict[str, Layer]:
    """Return for each layer of a composite, by its names, how the stage declares it."""
    declared = {output.name: output.declared for output in pipeline.outputs}
    return {name: layer for name, layer in declared.items() if isinstance(layer, Layer)}


def files_of(pipeline: Pipeline) -> dict[str, tuple[TextFile, str]]:
    """Return for each text file of a composite its declaration, and the layer whose features its items are of.

    Files and layers go by the composite's names.
    """
    names = {(output.step.name, output.of): output.name for output in pipeline.outputs}
    found = {}
    for output in pipeline.outputs:
        if isinstance(output.declared, TextFile):
            file = output.declared
            also = names[output.step.name, file.also] if file.also else ""
            found[output.name] = replace(file, name=output.name, also=also), _named(names, output.step, file.of)
    return found


def _named(names: dict[tuple[str, str], str], step: Step, layer: str) -> str:
    """Return the composite's name of a layer that a step makes, or is given by an earlier one."""
    return names[made_by(step.layers[layer]) if layer in step.layers else (step.name, layer)]


def why_whole(pipeline: Pipeline) -> str:
    """Return the reason why a composite works on whole clouds only; "" where it can be run in tiles."""
    if not pipeline.reads_cloud:
        return "it reads no cloud"
    steps = in_blocks(pipeline).steps
    given = pipeline.input_layers
    for step in steps:
        stage, title = step.stage, f"'{step.stage.title}'"
        if step.cloud:
            return f"{title} works on another cloud than the steps before it"
        if any(one.name in given and one.name not in step.layers and not one.optional for one in stage.input_layers):
            return f"{title} reads points and needs a layer that it is given"
        if stage.reads_reference:
            return f"{title} reads a second cloud"
        if stage.reach == np.inf:
            return f"{title} is decided by the whole cloud"
    return ""
