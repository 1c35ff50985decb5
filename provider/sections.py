"""How the parameters of a composite are grouped in its dialog: each step's together, under its name."""

import re
from dataclasses import dataclass, field
from typing import Any, Optional

from ..algorithms.help import step_label, step_title
from ..algorithms.pipeline import Pipeline, Step
from ..algorithms.stage import DIMENSION, Tunable
from ..algorithms.tiling.settings import READ_SETTINGS, SETTINGS, Setting
from .input_layers import input_layer_name
from .inputs import CRS
from .parameters import parameter_name

# "Side of a block (m, empty = automatic)": the title, and what an empty field means.
_EMPTY = re.compile(r"(.*?)(?:[ (]*empty = (.*)\))?$")

# Tunables that list classes.
_CLASSES = ("classes", "ignored_classes")


@dataclass
class Section:
    """One group: its title, and by name of its parameters their labels, what an empty field means, what can be picked.

    What can be picked are "classes" or a "dimension".
    """

    title: str
    labels: dict[str, str] = field(default_factory=dict)
    unset: dict[str, str] = field(default_factory=dict)
    pickers: dict[str, str] = field(default_factory=dict)

    def add(self, name: str, tunable: Tunable, step: Optional[Step] = None) -> None:
        """Add a parameter; where its group does not name the step, its label does."""
        label = tunable.title
        self.labels[name] = step_label(step, label) if step is not None else label
        if tunable.name == DIMENSION:
            self.pickers[name] = DIMENSION
        elif tunable.name in _CLASSES:
            self.pickers[name] = "classes"
        if tunable.is_optional:
            self.unset[name] = tunable.param.unset

    def add_setting(self, setting: Setting) -> None:
        """Add a parameter that is no tunable; what an empty field means is in its title."""
        name, (title, empty) = setting.name, _EMPTY.findall(setting.title)[0]
        self.labels[name] = f"{title.rstrip(',')})" if "(" in title else title.rstrip()
        if empty:
            self.unset[name] = empty


def sections_of(algorithm: Any) -> list[Section]:
    """Return the groups of the parameters of an algorithm of this plugin, in the order of its steps."""
    pipeline, is_tiled = getattr(algorithm, "pipeline", None), hasattr(algorithm, "tiled")
    if pipeline is None:
        section = Section("")
        for setting in READ_SETTINGS.values():
            section.add_setting(setting)
        section.labels[CRS] = "Coordinate reference system"
        stage = getattr(algorithm, "stage", None)
        for tunable in stage.tunables.values() if stage is not None else ():
            section.add(parameter_name(tunable), tunable)
        return [section]
    sections = _of_steps(pipeline)
    if is_tiled:
        sections.append(Section("Survey: blocks, processes, files"))
    section = sections[-1 if is_tiled else 0]
    for setting in (SETTINGS if is_tiled else READ_SETTINGS).values():
        section.add_setting(setting)
    section.labels[CRS] = "Coordinate reference system (of a cloud that names none)"
    return sections


def _of_steps(pipeline: Pipeline) -> list[Section]:
    """Return a group for each step with parameters, after one for those that steps share."""
    folded = [layer for layer in pipeline.input_layers.values() if layer.advanced]
    sections = {"": Section("All steps", labels={input_layer_name(layer): layer.title for layer in folded})}
    sections.update({step.name: Section(step_title(step)) for step in pipeline.steps})
    for name, (step, tunable) in pipeline.parameters.items():
        is_shared = name in pipeline.shared
        # Parameters that are shown at once have no group that names their step.
        named = step if name in pipeline.shown and not is_shared else None
        sections["" if is_shared else step.name].add(name.upper(), tunable, named)
    return [section for section in sections.values() if section.labels]
