"""How a running stage reports to its caller."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .declaration import Stage


class Cancelled(Exception):
    """Raised by a monitor's ``progress`` when the user stops the run."""


class Monitor:
    """Receives progress, automatic values and warnings of a running stage; this one keeps them, others show them.

    Attributes
    ----------
    values : dict
        Values that automatic tunables took, and other estimates, by name.
    warnings : list of str
        Sentences for the log about problems.
    infos : list of str
        Sentences for the log that are no warnings.
    """

    def __init__(self) -> None:
        self.values: dict[str, Any] = {}
        self.warnings: list[str] = []
        self.infos: list[str] = []

    def progress(self, fraction: float) -> None:
        """Receive the share of the work that is done, 0 to 1; may raise :class:`Cancelled`."""

    def resolved(self, **values: Any) -> None:
        """Keep the values that automatic tunables took."""
        self.values.update(values)

    def warn(self, sentence: str) -> None:
        """Keep a warning, a sentence."""
        self.warnings.append(sentence)

    def none_found(self, sentence: str) -> None:
        """Warn that a stage found nothing in a cloud, which is normal for a part of a cloud."""
        self.warn(sentence)

    def inform(self, sentence: str) -> None:
        """Keep a sentence about something normal that the user may want to know."""
        self.infos.append(sentence)

    def part(self, start: float, end: float, prefix: str = "") -> Monitor:
        """Return a monitor that reports ``start`` to ``end`` of this one's range; its values get the prefix."""
        return Part(self, start, end, prefix)

    def parts(self, count: int) -> list[Monitor]:
        """Return the monitors of as many parts, which follow each other and take as long."""
        return [self.part(number / count, (number + 1) / count) for number in range(count)]

    def step(self, name: str, stage: Stage, tunables: dict[str, Any], start: float, end: float) -> Monitor:
        """Return the monitor of a step of a chain, a stage with its tunables; its values get the name as prefix."""
        return self.part(start, end, f"{name}_")


class ProgressOnly(Monitor):
    """Passes progress on; values and warnings stay here: they are of auxiliary work, not of the run."""

    def __init__(self, listener: Monitor) -> None:
        super().__init__()
        self.listener = listener

    def progress(self, fraction: float) -> None:
        """Pass it on; may raise :class:`Cancelled`."""
        self.listener.progress(fraction)


class Part(Monitor):
    """A stretch of another monitor's progress; everything else goes straight through."""

    def __init__(self, whole: Monitor, start: float, end: float, prefix: str) -> None:
        self.whole, self.start, self.end, self.prefix = whole, start, end, prefix
        self.values, self.warnings, self.infos = whole.values, whole.warnings, whole.infos

    def progress(self, fraction: float) -> None:
        """Pass it on, as a share of the whole; may raise :class:`Cancelled`."""
        self.whole.progress(self._of_whole(fraction))

    def step(self, name: str, stage: Stage, tunables: dict[str, Any], start: float, end: float) -> Monitor:
        """Return the monitor of a step, as the whole makes it."""
        return self.whole.step(self.prefix + name, stage, tunables, self._of_whole(start), self._of_whole(end))

    def _of_whole(self, fraction: float) -> float:
        # A rounding would lead beyond the end.
        return min(self.start + (self.end - self.start) * fraction, self.end)

    def resolved(self, **values: Any) -> None:
        """Pass values on, under their names with the prefix."""
        self.whole.resolved(**{self.prefix + name: value for name, value in values.items()})

    def warn(self, sentence: str) -> None:
        """Pass a warning on."""
        self.whole.warn(sentence)

    def none_found(self, sentence: str) -> None:
        """Pass it on."""
        self.whole.none_found(sentence)

    def inform(self, sentence: str) -> None:
        """Pass a sentence on."""
        self.whole.inform(sentence)
