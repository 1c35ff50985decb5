"""What a running stage tells the outside."""

from __future__ import annotations

from typing import Any


class Cancelled(Exception):
    """Raised by a monitor's ``progress`` when the user stops the run."""


class Monitor:
    """What a running stage tells the outside; this one keeps it, others show it.

    Attributes
    ----------
    values : dict
        What automatic tunables resolved to, and other estimates, by name.
    warnings : list of str
        Sentences for the log.
    """

    def __init__(self) -> None:
        self.values: dict[str, Any] = {}
        self.warnings: list[str] = []

    def progress(self, fraction: float) -> None:
        """Hear how much is done, 0 to 1; may raise :class:`Cancelled`."""

    def resolved(self, **values: Any) -> None:
        """Keep the values that automatic tunables took."""
        self.values.update(values)

    def warn(self, sentence: str) -> None:
        """Keep a sentence that the user should read."""
        self.warnings.append(sentence)

    def part(self, start: float, end: float, prefix: str = "") -> Monitor:
        """Return a monitor whose 0 to 1 is ``start`` to ``end`` of this one, and whose values get a prefix here."""
        return _Part(self, start, end, prefix)


class _Part(Monitor):
    """A stretch of another monitor's progress; everything else goes straight through."""

    def __init__(self, whole: Monitor, start: float, end: float, prefix: str) -> None:
        self.whole, self.start, self.end, self.prefix = whole, start, end, prefix
        self.values, self.warnings = whole.values, whole.warnings

    def progress(self, fraction: float) -> None:
        self.whole.progress(self.start + (self.end - self.start) * fraction)

    def resolved(self, **values: Any) -> None:
        self.whole.resolved(**{self.prefix + name: value for name, value in values.items()})

    def warn(self, sentence: str) -> None:
        self.whole.warn(sentence)
