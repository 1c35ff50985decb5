"""The sections of numpydoc docstrings, read and written."""

from __future__ import annotations

import textwrap
from collections.abc import Collection

from .tunables import Tunable

_HEADINGS = ("Parameters", "Returns", "Raises", "Other Parameters", "Notes", "References", "Examples", "See Also")


def sections(doc: str) -> dict[str, str]:
    """Return the text of each section of a docstring by its title."""
    found: dict[str, list[str]] = {}
    lines, current = doc.splitlines(), None
    for line, below in zip(lines, [*lines[1:], ""]):
        if line in _HEADINGS and set(below.strip()) == {"-"}:
            current = found.setdefault(line, [])
        elif current is not None and not (set(line.strip()) == {"-"} and not current):
            current.append(line)
    return {title: "\n".join(text).strip() for title, text in found.items()}


def before_first_section(doc: str) -> str:
    """Return what a docstring says before its first section."""
    lines = doc.splitlines()
    for i, (line, below) in enumerate(zip(lines, [*lines[1:], ""])):
        if line in _HEADINGS and set(below.strip()) == {"-"}:
            return "\n".join(lines[:i])
    return doc


def with_tunables(doc: str, tunables: Collection[Tunable], samples: bool = False) -> str:
    """Return a docstring with a section for its tunables, if any, so that ``help()`` shows what the dialog shows.

    ``samples`` is whether the stage asks how its cloud was sampled.
    """
    rows = ["Other Parameters", "----------------"]
    for t in tunables:
        kind = t.type.__name__ + (" or None" if t.is_automatic else "")
        facts = [kind, *([t.param.unit] if t.param.unit else []), *([t.range] if t.range else [])]
        rows.append(f"{t.name} : {', '.join(facts)}, default {t.default!r}")
        text = f"{t.param.help} {t.param.unset_text}".rstrip()
        rows.extend(textwrap.wrap(text, 88, initial_indent="    ", subsequent_indent="    "))
    if samples:
        rows.append("sampling : CloudSampling, optional\n    Measured on the points that are not noise if not given.")
    rows.append("monitor : Monitor, optional\n    Receives progress, automatic values and warnings.")
    return f"{doc}\n\n" + "\n".join(rows) + "\n" if tunables or samples else doc
