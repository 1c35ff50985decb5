"""The sections of numpydoc docstrings, read and written."""

import re
import textwrap
from collections.abc import Collection
from operator import attrgetter
from typing import Any

from .tunables import Tunable

# Sections that describe the arrays and layers of a stage, and its tunables.
ARGUMENTS, TUNABLES = "Parameters", "Other Parameters"
_HEADINGS = (ARGUMENTS, "Returns", "Raises", TUNABLES, "Notes", "References", "Examples", "See Also")


# A constant of a module, or a field of one, as docstrings name it.
_CONSTANT = re.compile(r"``(_?[A-Z][A-Z_]+)((?:\.\w+)?)``")


def with_values(doc: str, names: dict[str, Any]) -> str:
    """Return a docstring with the values of the constants that it names, so that the help shows numbers.

    ``names`` are the module's: a docstring repeats no digits that a change of the constant would make wrong.
    """

    def value(found: re.Match) -> str:
        owner = names.get(found[1])
        constant = attrgetter(found[2][1:])(owner) if found[2] else owner
        return f"{constant:,g}" if isinstance(constant, (int, float)) else found[0]

    return _CONSTANT.sub(value, doc)


def _is_heading(line: str, below: str) -> bool:
    """Whether a line is the title of a section, with hyphens below it."""
    return line in _HEADINGS and set(below.strip()) == {"-"}


def sections(doc: str) -> dict[str, str]:
    """Return the text of each section of a docstring by its title."""
    found: dict[str, list[str]] = {}
    lines, current = doc.splitlines(), None
    for line, below in zip(lines, [*lines[1:], ""]):
        if _is_heading(line, below):
            current = found.setdefault(line, [])
        elif current is not None and not (set(line.strip()) == {"-"} and not current):
            current.append(line)
    return {title: "\n".join(text).strip() for title, text in found.items()}


def before_first_section(doc: str) -> str:
    """Return what a docstring says before its first section."""
    lines = doc.splitlines()
    for i, (line, below) in enumerate(zip(lines, [*lines[1:], ""])):
        if _is_heading(line, below):
            return "\n".join(lines[:i])
    return doc


def summary(doc: str) -> str:
    """Return the first paragraph of a docstring on one line."""
    return " ".join(doc.split("\n\n", maxsplit=1)[0].split())


def description(doc: str) -> str:
    """Return the text of a docstring between the summary and the first section."""
    return before_first_section(doc.partition("\n\n")[2]).strip()


def described(doc: str, title: str) -> dict[str, str]:
    """Return the descriptions in a section of a docstring by the names that they describe, each on one line."""
    parts = re.split(r"^(\w+)(?: : .*)?\n", sections(doc).get(title, ""), flags=re.MULTILINE)
    return {name: " ".join(text.split()) for name, text in zip(parts[1::2], parts[2::2])}


def with_tunables(doc: str, tunables: Collection[Tunable], samples: bool = False) -> str:
    """Return a docstring with all that is declared of its tunables, so that ``help()`` shows what the dialog shows.

    ``samples`` is whether the stage asks how its cloud was sampled.
    """
    rows = []
    for t in tunables:
        kind = t.type.__name__ + (" or None" if t.is_optional else "")
        facts = [kind, *([t.param.unit] if t.param.unit else []), *([t.range] if t.range else [])]
        rows.append(f"{t.name} : {', '.join(facts)}, default {t.default!r}")
        text = f"{t.param.help} {t.param.unset_text}".rstrip()
        rows.extend(textwrap.wrap(text, 88, initial_indent="    ", subsequent_indent="    "))
    if samples:
        rows.append("sampling : CloudSampling, optional\n    Measured on the points that are not noise if not given.")
    if not rows:
        return doc
    rows.append("monitor : Monitor, optional\n    Receives progress, automatic values and warnings.")
    heading, text = f"{TUNABLES}\n{'-' * len(TUNABLES)}\n", "\n".join(rows)
    written = sections(doc).get(TUNABLES)
    return doc.replace(heading + written, heading + text) if written else f"{doc}\n\n{heading}{text}\n"
