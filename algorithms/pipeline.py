"""The vocabulary of composites: steps, their outputs, the pipeline that they make, and its decorator."""

import inspect
from collections.abc import Collection
from dataclasses import dataclass, field
from typing import Any, Callable, Optional

from .stage import (
    CLOUD,
    REPORT,
    Declared,
    InputLayer,
    Stage,
    Tunable,
    description,
    in_words,
    sections,
    summary,
)
from .stages import STAGES

# The second cloud among what a step may depend on.
REFERENCE = "reference"


@dataclass(frozen=True)
class Step:
    """One stage of a chain; it works on the last cloud that a step before it made.

    ``name`` prefixes the composite's parameters (``GROUND_CELL_SIZE``); ``tunables``
    are the defaults that differ from the stage's own. ``cloud`` names an earlier step
    whose cloud it works on instead. ``layers`` says which of its input layers is a layer of an
    earlier step, ``{"new": "walls.footprints"}``; the composite asks for all others,
    under the input layer's own name. A stage that merges is given all clouds of the composite, one that
    reads a reference the second cloud. ``only_with`` names layers of the composite, or ``"reference"``, the second
    cloud, of which one must be given for it to be run. A step with a reference is run whatever outputs are wanted, for
    its numbers.
    """

    name: str
    stage_name: str
    tunables: dict[str, Any] = field(default_factory=dict)
    cloud: str = ""
    layers: dict[str, str] = field(default_factory=dict)
    only_with: tuple[str, ...] = ()

    @property
    def stage(self) -> Stage:
        """The stage that this step runs."""
        return STAGES[self.stage_name]


@dataclass(frozen=True)
class Output:
    """One output of a composite: its name, and which output of which step it is.

    ``of`` is ``"output"`` for a cloud, ``"report"``, or the name of a layer, raster or file.
    """

    name: str
    step: Step
    of: str

    @property
    def declared(self) -> Declared:
        """How its stage declares it."""
        return self.step.stage.outputs[self.of]


@dataclass(frozen=True)
class Pipeline:
    """A chain of stages that users meet as one algorithm.

    The last step that makes a cloud gives the composite's OUTPUT. Every layer, raster, file and report of every step is
    an output of its own. So are the clouds of the steps that ``kept`` names. ``shared`` gives, for each tunable that is
    one parameter of the composite, the names of the steps it goes to, which declare it alike and with one default.
    ``shown`` are the parameters that users meet first, in this order; all others are folded away. ``switched_off`` are
    layers that are loaded switched off, as another step has taken them further. The seconds of the steps of
    one that is ``timed`` are among its numbers.
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
    switched_off: tuple[str, ...] = ()
    timed: bool = False

    def parameter(self, step: Step, tunable: str) -> str:
        """Return the composite's name for a step's tunable: ``ground_cell_size``, shared ``min_area``."""
        return tunable if step.name in self.shared.get(tunable, ()) else f"{step.name}_{tunable}"

    @property
    def parameters(self) -> dict[str, tuple[Step, Tunable]]:
        """Every parameter once, by name, with the first step that takes it; shown ones first."""
        found: dict[str, tuple[Step, Tunable]] = {}
        for step in self.steps:
            for tunable in step.stage.tunables.values():
                found.setdefault(self.parameter(step, tunable.name), (step, tunable))
        return {name: found[name] for name in (*self.shown, *(name for name in found if name not in self.shown))}

    def by_step(self, tunables: dict[str, Any]) -> list[tuple[Step, dict[str, Any]]]:
        """Return each step with its tunables: the composite's that are given, over the step's own defaults.

        Raises
        ------
        ValueError
            If the composite has no tunable of a name.
        """
        unknown = [name for name in tunables if name not in self.parameters]
        if unknown:
            raise ValueError(f"{self.name} has no tunable {unknown[0]!r}; it has {', '.join(self.parameters)}.")
        chosen = []
        for step in self.steps:
            names = {name: self.parameter(step, name) for name in step.stage.tunables}
            given = {name: tunables[named] for name, named in names.items() if named in tunables}
            chosen.append((step, {**step.tunables, **given}))
        return chosen

    def reach(self, tunables: dict[str, Any]) -> float:
        """Return the distance (m) within which points decide on one another: the sum of the reaches of all steps."""
        return sum(step.stage.reach_of(chosen) for step, chosen in self.by_step(tunables))

    def cloud_of(self, step: Step) -> Optional[str]:
        """Return the name of the step whose cloud ``step`` works on, "" for the given one, None where it reads none."""
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
    def compared(self) -> Optional[Stage]:
        """The stage that reads the second cloud of the composite, None where none does."""
        return next((step.stage for step in self.steps if step.stage.reads_reference), None)

    @property
    def needs_reference(self) -> bool:
        """Whether it can't do without the second cloud."""
        return self.compared is not None and self.compared.needs_reference

    @property
    def input_title(self) -> str:
        """Label of the cloud that the composite is given: where there are two, what distinguishes it from the other."""
        return (self.compared or self.steps[0].stage).input_title

    @property
    def input_layers(self) -> dict[str, InputLayer]:
        """Vector layers that the composite is given, by name."""
        found: dict[str, InputLayer] = {}
        for step in self.steps:
            for input_layer in step.stage.input_layers:
                if input_layer.name not in step.layers:
                    found.setdefault(input_layer.name, input_layer)
        return found

    @property
    def outputs(self) -> tuple[Output, ...]:
        """All outputs in the order of steps; where several have one name, the step's is put before it.

        The last cloud keeps its plain name, and so does the last report but that on a reference.
        """
        makers = [step for step in self.steps if step.stage.makes_cloud]
        found = [(step, of) for step in self.steps for of in step.stage.outputs]
        names = [of for _, of in found]
        reports = [step for step, of in found if of == REPORT and REFERENCE not in step.only_with]
        outputs = []
        for step, of in found:
            last = {CLOUD: makers, REPORT: reports}.get(of)
            is_single = step is last[-1] if last else names.count(of) == 1
            if is_single or of != CLOUD or step.name in self.kept:
                outputs.append(Output(of if is_single else f"{step.name}_{of}", step, of))
        return tuple(outputs)

    def steps_for(self, wanted: Collection[str], given: Optional[Collection[str]] = None) -> tuple[Step, ...]:
        """Return the steps, in order, that the outputs of these names are made by or depend on.

        A step that only measures runs with the layers or the cloud that it measures: numbers are given with them.
        ``given`` are the layers that the composite is given, by name, and the reference; None is all that it can be
        given.
        """
        asked = {(output.step.name, output.of) for output in self.outputs if output.name in wanted}
        needed, steps = set(asked), []
        for step in reversed(self.steps):
            if step.only_with and given is not None and not set(step.only_with) & set(given):
                continue
            made = {(step.name, of) for of in step.stage.outputs}
            read = {made_by(layer) for layer in step.layers.values()}
            only_measures = made == {(step.name, REPORT)}
            assesses = REFERENCE in step.only_with and given is not None
            measured = read or {(self.cloud_of(step) or "", CLOUD)}
            if made & needed or (only_measures and measured & asked) or assesses:
                steps.append(step)
                needed |= {*read, (self.cloud_of(step) or "", CLOUD)}
        return tuple(reversed(steps))

    def needs(self, output: Output) -> bool:
        """Whether the graph makes an output even if nobody asks for it: a cloud, or a layer that another step reads."""
        return output.of == CLOUD or any(
            f"{output.step.name}.{output.of}" in step.layers.values() for step in self.steps
        )

    @property
    def needed_packages(self) -> tuple[str, ...]:
        """Packages that a step can't run without."""
        return tuple(dict.fromkeys(name for step in self.steps for name in step.stage.needed_packages))

    @property
    def id(self) -> str:
        """Processing id, ``detectbuildings``."""
        return self.name.replace("_", "")


def composite(group: str, *, title: str = "", tags: str, **fields: Any) -> Callable[[Callable], Pipeline]:
    """Declare a function as a composite: it returns its steps, and its docstring is the help.

    Parameters
    ----------
    group : str
        Group in the toolbox.
    title : str
        Title in the toolbox, where it is not the name of the function in words.
    tags : str
        Words to search for, with commas between.
    **fields
        Fields of :class:`Pipeline` from ``shared`` on.

    Returns
    -------
    callable
        The decorator, which puts the :class:`Pipeline` in the place of the function.
    """

    def declare(function: Callable) -> Pipeline:
        name, doc = function.__name__, inspect.cleandoc(function.__doc__ or "")
        texts = summary(doc), description(doc), sections(doc).get("References", "")
        return Pipeline(name, title or in_words(name), group, tags, *texts, function(), **fields)

    return declare


def made_by(layer: str) -> tuple[str, str]:
    """Return the step and the name of a layer that another step reads, "walls.footprints"."""
    step, name = layer.split(".")
    return step, name
