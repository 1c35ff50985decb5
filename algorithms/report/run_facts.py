"""What a page says of the run that made it: input, date, version, and each step with its parameters and seconds."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from .page import Row, draw_rows


@dataclass
class StepFacts:
    """A step of a run: its title, its seconds, its parameters as used, and what it said."""

    title: str
    seconds: float = 0.0
    parameters: list[Row] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


def draw_facts(rows: Iterable[Row]) -> str:
    """Return the HTML of facts about a run: its input, date and version."""
    return draw_rows("Run", rows)


def draw_steps(steps: Iterable[StepFacts], of_seconds: str = "") -> str:
    """Return the HTML of the steps with their seconds, then of the parameters of each.

    ``of_seconds`` names the work that took the seconds.
    """
    steps = list(steps)
    times = [
        Row(step.title, f"{step.seconds:.1f} s", " ".join(_sentence(note) for note in step.notes)) for step in steps
    ]
    times.append(Row("All steps", f"{sum(step.seconds for step in steps):.1f} s", of_seconds))
    set_up = [f"<div>{draw_rows(step.title, step.parameters, 3)}</div>" for step in steps if step.parameters]
    parts = [draw_rows("Steps", times), "<h2>Parameters</h2>", '<div class="parameters">', *set_up, "</div>"]
    return "\n".join(parts)


def _sentence(note: str) -> str:
    return note if note.endswith((".", "!", "?")) else f"{note}."
