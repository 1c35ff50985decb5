"""Progress, values and warnings of a running stage, shown in QGIS's log and progress bar."""

from __future__ import annotations

import time
from difflib import get_close_matches
from typing import Any, Optional

from qgis.core import QgsApplication, QgsProcessingAlgorithm, QgsProcessingFeedback, QgsProcessingMultiStepFeedback

from ..algorithms.stage import Cancelled, Monitor, Param, Stage
from .declared import on_command_line
from .run_log import current_log


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
    stage : Stage, optional
        The stage that runs: the log uses its labels and units.
    given : dict, optional
        Its tunables; those with a value were set by the user, and the log doesn't call them automatic.
    """

    def __init__(
        self, feedback: QgsProcessingFeedback, stage: Optional[Stage] = None, given: Optional[dict[str, Any]] = None
    ) -> None:
        super().__init__()
        self._feedback, self._stage, self._given = feedback, stage, given or {}
        self._bar = ProgressBar(feedback)

    def progress(self, fraction: float) -> None:
        """Move the progress bar, or raise :class:`Cancelled`."""
        if self._feedback.isCanceled():
            raise Cancelled
        self._feedback.setProgress(100.0 * fraction)

    def resolved(self, **values: Any) -> None:
        """Keep the values that stages report, and log those that the user didn't give."""
        super().resolved(**values)
        log = current_log()
        if log is not None:
            log.resolved(values)
        for name, value in values.items():
            if self._given.get(name) is None:
                self._bar.end_line()
                self._feedback.pushInfo(self._sentence(name, value))

    def warn(self, sentence: str) -> None:
        """Log and keep a warning."""
        super().warn(sentence)
        self._note(sentence)
        self._bar.end_line()
        self._feedback.pushWarning(sentence)

    def inform(self, sentence: str) -> None:
        """Log and keep a sentence."""
        super().inform(sentence)
        self._note(sentence)
        self._bar.end_line()
        self._feedback.pushInfo(sentence)

    def _note(self, sentence: str) -> None:
        log = current_log()
        if log is not None:
            log.note(sentence)

    def _sentence(self, name: str, value: Any) -> str:
        tunable = self._stage.tunables.get(name) if self._stage else None
        param = tunable.param if tunable else Param("", "")
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
        return f"{param.label}, {found}: {shown}"


# How the log begins a line with measurements of a cloud, and what separates these.
_SAMPLING, _BETWEEN = "Sampling: ", ", "


class ChainFeedback(QgsProcessingMultiStepFeedback):
    """Passes everything on, but shows warnings and values once, however many steps of a chain give them.

    Each step ends with the seconds that it took.
    """

    def __init__(self, feedback: QgsProcessingFeedback) -> None:
        super().__init__(1, feedback)
        self._bar = ProgressBar(feedback)
        self._shown: set[str] = set()
        self._began: Optional[float] = None

    def setProgressText(self, text: str) -> None:  # noqa: N802 - QGIS asks for these names
        """Log the title of a step, after the seconds of the one before it."""
        self.end_step()
        self._bar.end_line()
        self._began = time.monotonic()
        super().setProgressText(text)

    def end_step(self) -> None:
        """Log the seconds of the step that runs."""
        if self._began is not None:
            self._bar.end_line()
            super().pushInfo(f"{time.monotonic() - self._began:.1f} s")
            self._began = None

    def pushInfo(self, info: str) -> None:  # noqa: N802
        """Log a sentence or measurements that were not shown yet."""
        is_sampling = info.startswith(_SAMPLING)
        facts = info[len(_SAMPLING) :].split(_BETWEEN) if is_sampling else [info]
        new = [fact for fact in facts if fact not in self._shown]
        self._shown.update(new)
        if new:
            self._bar.end_line()
            super().pushInfo((_SAMPLING if is_sampling else "") + _BETWEEN.join(new))

    def pushWarning(self, warning: str) -> None:  # noqa: N802 - QGIS asks for this name
        """Log a warning that was not shown yet."""
        if warning not in self._shown:
            self._shown.add(warning)
            self._bar.end_line()
            super().pushWarning(warning)


def warn_unknown_parameters(
    algorithm: QgsProcessingAlgorithm, parameters: dict, feedback: QgsProcessingFeedback
) -> None:
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


def is_step(feedback: QgsProcessingFeedback) -> bool:
    """Whether a feedback is that of a step of a chain."""
    # By its Qt class: QGIS hands it to Python as a plain feedback.
    return feedback.inherits("QgsProcessingMultiStepFeedback")
