"""What the steps of a run did, for its pages: parameters as used, seconds, and what they said."""

import time
from collections.abc import Iterable, Sequence
from datetime import datetime
from pathlib import Path
from typing import Any, Optional

import numpy as np

from ..algorithms.cloud.header import SOFTWARE
from ..algorithms.cloud.outputs import replacing
from ..algorithms.report.page import Row, StepFacts, with_run
from ..algorithms.stage import Stage, Tunable
from .paths import PLUGIN
from .qgis_crs import crs_of


class RunLog:
    """The steps of one run, in the order in which they began."""

    def __init__(self) -> None:
        self.steps: list[StepFacts] = []
        # By step: its stage, the tunables it was given, and what automatic ones took.
        self._given: list[tuple[Stage, dict[str, Any], dict[str, Any]]] = []
        self._began = time.monotonic()

    def begin(self, stage: Stage, given: dict[str, Any]) -> None:
        """Begin a step with its tunables; those that are None are automatic."""
        self.end()
        self.steps.append(StepFacts(stage.title))
        self._given.append((stage, given, {}))
        self._began = time.monotonic()

    @property
    def running(self) -> tuple[Optional[Stage], dict[str, Any]]:
        """The stage that runs and the tunables that it was given, None and none before the first."""
        return self._given[-1][:2] if self._given else (None, {})

    def resolved(self, values: dict[str, Any]) -> None:
        """Keep the values that automatic tunables of the step took."""
        if self._given:
            self._given[-1][2].update(values)

    def note(self, sentence: str) -> None:
        """Keep what the step said, if no step before it has said so."""
        if self.steps and not any(sentence in step.notes for step in self.steps):
            self.steps[-1].notes.append(sentence)

    def end(self) -> None:
        """End the step that runs, if one does."""
        if self.steps and not self.steps[-1].seconds:
            self.steps[-1].seconds = time.monotonic() - self._began
            self.steps[-1].parameters = parameter_rows(*self._given[-1])


def parameter_rows(stage: Stage, given: dict[str, Any], used: dict[str, Any]) -> list[Row]:
    """Return a row for each tunable of a stage: its value, and whether that is automatic, the default or set.

    What automatic ones took is in ``used``, a list where the blocks of a survey took several values.
    """
    rows = []
    for name, tunable in stage.tunables.items():
        value = given.get(name, tunable.default)
        if value is None:
            took = used.get(name)
            ends = list(dict.fromkeys((took[0], took[-1]))) if isinstance(took, list) else [took]
            shown = " to ".join(written(tunable, one) for one in ends)
            rows.append(Row(tunable.label, shown, tunable.param.unset))
        else:
            how = "default" if value == tunable.default else f"set; default: {written(tunable, tunable.default)}"
            rows.append(Row(tunable.label, written(tunable, value), how))
    others = {name: value for name, value in used.items() if name not in stage.tunables and np.isscalar(value)}
    return rows + [Row(name.replace("_", " ").capitalize(), _short(value), "found") for name, value in others.items()]


def _short(value: Any) -> str:
    """Return a value that has no tunable, and so no unit, as text."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:,.4g}" if isinstance(value, float) else f"{value:,d}" if isinstance(value, int) else str(value)


def written(tunable: Tunable, value: Any) -> str:
    """Return the value of a tunable as text."""
    if value is None:
        return tunable.param.unset
    if value == "" or isinstance(value, bool):
        return "none" if value == "" else _short(value)
    if isinstance(value, float):
        return tunable.param.written(float(f"{value:.4g}"))
    if isinstance(value, int):
        return tunable.param.written(value)
    return ", ".join(map(str, value)) if isinstance(value, (tuple, list)) else str(value)


def plugin_version() -> str:
    """Return the version of this plugin."""
    lines = (PLUGIN / "metadata.txt").read_text(encoding="utf-8").splitlines()
    return next((line.partition("=")[2] for line in lines if line.startswith("version=")), "")


def about_run(title: str, inputs: Sequence[Path], points: int, plane: str) -> list[Row]:
    """Return what a page says first of a run: files with their points, CRS, date, version and algorithm."""
    rows, crs = [], crs_of(plane)
    if inputs:
        names = [path.name for path in inputs]
        shown = f"{names[0]} and {len(names) - 1:,} more" if len(names) > 1 else names[0]
        rows.append(Row("Input", shown, f"{points:,} points, in {inputs[0].parent}"))
    if crs.isValid():
        rows.append(Row("Coordinates", crs.authid() or "user-defined", crs.description()))
    else:
        rows.append(Row("Coordinates", "in meters", "The input names no coordinate reference system."))
    rows.append(Row("Date", datetime.now().strftime("%Y-%m-%d %H:%M"), ""))
    return [*rows, Row("Made by", f"{SOFTWARE} {plugin_version()}", title)]


def write_page(target: str, page: str, rows: Iterable[Row], steps: Iterable[StepFacts], of_seconds: str = "") -> None:
    """Write a page with the facts about its run, and the steps with their parameters.

    ``of_seconds`` says what the seconds of the steps are of.
    """
    with replacing(Path(target)) as stream:
        stream.write(with_run(page, rows, steps, of_seconds).encode())
