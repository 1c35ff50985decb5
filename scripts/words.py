#!/usr/bin/env python3
"""Count words and forms that make text hard to read, in documentation, docstrings, comments and texts for users.

``make lint`` fails when a form is more frequent than its bound (occurrences per 1,000 words).

    words.py            the counts
    words.py --lines    every line with one of the forms
"""

from __future__ import annotations

import argparse
import ast
import io
import re
import sys
import tokenize
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

# Occurrences per 1,000 words that are let pass.
BOUND = 0.1

FORMS = {
    "so many, so much, so far": r"\bso (?:many|much|far)\b",
    "stands, for a state": r"\bstands?\b(?! (?:for|in the way))",
    "tells": r"\btells?\b|\btold\b",
    "place for a position": r"\b(?:at|of) (?:the |a |its |one |each )?places?\b",
    "let go, hears": r"\blet go\b|\bhears?\b",
    "none as a predicate": r"(?-i:\b(?:is|are|be) none\b)",
}


def texts(path: Path) -> Iterator[tuple[int, str]]:
    """Yield the lines of prose of a file, with their numbers."""
    source = path.read_text(encoding="utf-8")
    if path.suffix != ".py":
        yield from enumerate(source.splitlines(), 1)
        return
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            yield token.start[0], token.string
    for node in ast.walk(ast.parse(source)):
        # Docstrings, helps and messages have spaces; names and keys have none.
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value.count(" ") > 2:
            yield from ((node.lineno + at, line) for at, line in enumerate(node.value.splitlines()))


def files() -> list[Path]:
    """Return the files that are read by users and developers, without tests and the log of what was tried."""
    found = [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md"), *(ROOT / "docs" / "methods").glob("*.md")]
    for folder in ("algorithms", "provider"):
        found += (ROOT / folder).rglob("*.py")
    return sorted(found)


def main(arguments: list[str]) -> int:
    """Print the counts or lines; return 1 if a form is too frequent."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lines", action="store_true")
    shows_lines = parser.parse_args(arguments).lines
    counts, words = dict.fromkeys(FORMS, 0), 0
    for path in files():
        for number, line in texts(path):
            words += len(line.split())
            for form, pattern in FORMS.items():
                hits = len(re.findall(pattern, line, re.IGNORECASE))
                counts[form] += hits
                if hits and shows_lines:
                    print(f"{path.relative_to(ROOT)}:{number}: {form}: {line.strip()[:150]}")
    if not shows_lines:
        for form, count in counts.items():
            print(f"{form:28s} {count:5d}  {1000 * count / words:.2f} per 1,000 words")
    return int(any(1000 * count / words > BOUND for count in counts.values()))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
