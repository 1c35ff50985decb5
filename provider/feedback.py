"""Progress, values and warnings of a running stage, shown in QGIS's log and progress bar."""

import html
import time
from difflib import get_close_matches
from typing import Any, Optional

from qgis.core import QgsApplication, QgsProcessingAlgorithm, QgsProcessingFeedback

from ..algorithms.stage import SAMPLING, Cancelled, Monitor, Param, Part, Stage
from .caller import is_step, on_command_line
from .run_log import RunLog


class ProgressBar:
    """The line of numbers and dots that ``qgis_process`` draws; it has to end where a sentence begins."""

    def __init__(self, feedback: QgsProcessingFeedback) -> None:
        # What a step says is put on a line by its chain; with --json nothing is drawn.
        is_drawn = on_command_line() and not is_step(feedback) and "--json" not in QgsApplication.arguments()
        self._feedback = feedback if is_drawn else None
        self._drawn = 0

    def end_line(self) -> None:
        """Begin a new line if something was drawn since the last one."""
        if self._feedback is None:
            return
        # QGIS draws a dot or number every 2.5 % of progress, and ends the line itself at 100 %.
        drawn = int(self._feedback.progress() / 2.5)
        if self._drawn < drawn < 40:
            self._feedback.pushInfo("")
        self._drawn = drawn


class FeedbackMonitor(Monitor):
    """A monitor that reports to a QgsProcessingFeedback and stops when the user cancels.

    Parameters
    ----------
    feedback : QgsProcessingFeedback
        What shows progress and the log.
    log : RunLog, optional
        Keeps values and sentences for the pages of the run. The labels and units of the stage that runs are used;
        tunables that were given are not called automatic.
    """

    def __init__(self, feedback: QgsProcessingFeedback, log: Optional[RunLog] = None) -> None:
        super().__init__()
        self._feedback, self._log = feedback, log or RunLog()
        self._bar = ProgressBar(feedback)

    def progress(self, fraction: float) -> None:
        """Move the progress bar, or raise :class:`Cancelled`."""
        if self._feedback.isCanceled():
            raise Cancelled
        self._feedback.setProgress(100.0 * fraction)

    def resolved(self, **values: Any) -> None:
        """Keep the values that stages report, and log those that the user didn't give."""
        super().resolved(**values)
        for sentence in found_by(self._log, values):
            self._bar.end_line()
            self._feedback.pushInfo(sentence)

    def warn(self, sentence: str) -> None:
        """Log and keep a warning."""
        super().warn(sentence)
        self._log.note(sentence)
        self._bar.end_line()
        self._feedback.pushWarning(sentence)

    def inform(self, sentence: str) -> None:
        """Log and keep a sentence."""
        super().inform(sentence)
        self._log.note(sentence)
        self._bar.end_line()
        self._feedback.pushInfo(sentence)

    def end_steps(self) -> None:
        """End the last step: all is computed, and is written next."""
        self._log.end()

    def end(self) -> None:
        """End the run."""
        self.progress(1.0)


def found_by(log: RunLog, values: dict[str, Any]) -> list[str]:
    """Keep the values that the step that runs reports; return those that the user didn't give, as the log says them."""
    log.resolved(values)
    stage, given = log.running
    found = {name: value for name, value in values.items() if given.get(name) is None and value is not None}
    return [value_sentence(stage, name, value) for name, value in found.items()]


def value_sentence(stage: Optional[Stage], name: str, value: Any) -> str:
    """Return a value that a stage found or took, as the log says it, with label and unit."""
    tunable = stage.tunables.get(name) if stage else None
    param = tunable.param if tunable else Param(None, "")
    # Who needs all digits finds them among the results.
    if isinstance(value, bool):
        shown = "yes" if value else "no"
    elif isinstance(value, float):
        shown = param.written(float(f"{value:.4g}"))
    else:
        shown = f"{value} {param.unit}".rstrip()
    if tunable is None:
        return f"{name.replace('_', ' ').capitalize()}: {shown}"
    found = "none set, the cloud has" if param.empty else "automatic"
    return f"{tunable.label}, {found}: {shown}"


# How the log begins a line with measurements of a cloud, and what separates these.
_SAMPLING, _BETWEEN = "Sampling: ", ", "

# What a chain does before and after its steps, for the log.
_READING, _WRITING = "Reading", "Writing"

# Share of the work below which the time left can't be estimated.
_TOO_EARLY = 0.02


class ChainMonitor(FeedbackMonitor):
    """Shows the steps of a chain: a line for each with its seconds, and below it what the step found.

    Warnings and values are shown once, however many steps give them; what a step says that only measures the
    results comes last, as the summary of the run.
    """

    def __init__(self, feedback: QgsProcessingFeedback, log: RunLog) -> None:
        super().__init__(feedback, log)
        self._title, self._name = _READING, "reading"
        self._held: list[str] = []
        self._summary: list[str] = []
        self._sums_up = False
        self._shown: set[str] = set()
        self._began = self._start = time.monotonic()
        self._fraction = 0.0

    def progress(self, fraction: float) -> None:
        """Move the progress bar, or raise :class:`Cancelled`."""
        self._fraction = fraction
        super().progress(fraction)

    def step(self, name: str, stage: Stage, tunables: dict[str, Any], start: float, end: float) -> Monitor:
        """Begin a step, and end the one before it."""
        self._end_step(stage.title)
        self._log.begin(stage, tunables)
        self._title, self._name, self._began = stage.title, name, time.monotonic()
        self._sums_up = bool(stage.measures) and not stage.makes_cloud
        return _StepMonitor(self, self._log, name, start, end)

    def end_steps(self) -> None:
        """End the last step: all is computed, and is written next."""
        super().end_steps()
        self._end_step(_WRITING.lower())
        self._title, self._name, self._began = _WRITING, "writing", time.monotonic()

    def end(self) -> None:
        """End the run, and show its summary."""
        super().end()
        self._end_step()
        self._show(self._summary)

    def found(self, sentence: str) -> None:
        """Keep what the step that runs has found until its line is shown."""
        (self._summary if self._sums_up else self._held).append(sentence)

    def resolved(self, **values: Any) -> None:
        """Keep values; show those that the chain itself measures: how the cloud was sampled."""
        self.values.update(values)
        if SAMPLING in values:
            self._held.append(f"{_SAMPLING}{values[SAMPLING]}")

    def inform(self, sentence: str) -> None:
        """Keep a sentence and show it below the line of its step."""
        Monitor.inform(self, sentence)
        self._log.note(sentence)
        self.found(sentence)

    def warn(self, sentence: str) -> None:
        """Show and keep a warning, unless it was shown."""
        if sentence not in self._shown:
            self._shown.add(sentence)
            super().warn(sentence)

    def _end_step(self, following: str = "") -> None:
        """Show the line of the step that ran: its seconds, what comes next, and how much time is left."""
        self.values[f"{self._name}_seconds"] = seconds = time.monotonic() - self._began
        line = f"{self._title}: {seconds:.1f} s"
        coming = [f"next: {following}"] if following else []
        if following and self._fraction > _TOO_EARLY:
            left = (time.monotonic() - self._start) * (1 - self._fraction) / self._fraction
            coming.append(f"about {spoken_time(left)} left")
        self._bar.end_line()
        show_heading(self._feedback, line, f" ({', '.join(coming)})" if coming else "")
        self._show(self._held)
        self._held = []

    def _show(self, sentences: list[str]) -> None:
        """Show sentences and measurements that were not shown yet."""
        for sentence in sentences:
            is_sampling = sentence.startswith(_SAMPLING)
            facts = sentence[len(_SAMPLING) :].split(_BETWEEN) if is_sampling else [sentence]
            new = [fact for fact in facts if fact not in self._shown]
            self._shown.update(new)
            if new:
                self._bar.end_line()
                self._feedback.pushInfo((_SAMPLING if is_sampling else "") + _BETWEEN.join(new))


class _StepMonitor(Part):
    """The monitor of one step of a chain: values have its labels and units in the log, its name among the results."""

    def __init__(self, chain: ChainMonitor, log: RunLog, name: str, start: float, end: float) -> None:
        super().__init__(chain, start, end, f"{name}_")
        self._chain, self._log = chain, log

    def resolved(self, **values: Any) -> None:
        """Pass on values, and log those that the user didn't give."""
        super().resolved(**values)
        for sentence in found_by(self._log, values):
            self._chain.found(sentence)


def show_heading(feedback: QgsProcessingFeedback, heading: str, rest: str = "") -> None:
    """Log a line that begins in bold where the log can show it, as plain text on the command line."""
    if on_command_line():
        feedback.pushInfo(heading + rest)
    else:
        feedback.pushFormattedMessage(f"<b>{html.escape(heading)}</b>{html.escape(rest)}", heading + rest)


def spoken_time(seconds: float) -> str:
    """Return a time as people say it, in seconds or minutes."""
    return f"{max(1, round(seconds))} s" if seconds < 90 else f"{round(seconds / 60)} min"


def warn_unknown_names(algorithm: QgsProcessingAlgorithm, parameters: dict, feedback: QgsProcessingFeedback) -> None:
    """Warn of names on the command line or in a script that are no parameters: QGIS ignores them silently."""
    known = {definition.name() for definition in algorithm.parameterDefinitions()}
    for name in sorted(set(parameters) - known):
        similar = get_close_matches(name, sorted(known), 1)
        meant = f"; is {similar[0]} meant?" if similar else "."
        feedback.pushWarning(f"{name} is no parameter of '{algorithm.displayName()}', so it has no effect{meant}")


def announce(title: str, feedback: QgsProcessingFeedback) -> None:
    """Log the step that a chain has reached; an algorithm that runs alone is named by its dialog."""
    if is_step(feedback):
        feedback.setProgressText(title)
