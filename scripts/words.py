#!/usr/bin/env python3
"""Count words and forms that make text hard to read, in documentation, docstrings, comments and texts for users.

``make lint`` fails when a form is more frequent than its bound (occurrences per 1,000 words).

    words.py            the counts
    words.py --lines    every paragraph with one of the forms
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
from typing import NamedTuple

ROOT = Path(__file__).resolve().parent.parent

# Most words of a sentence that is not counted as too long.
LONGEST = 35


class Form(NamedTuple):
    """A pattern, and the occurrences per 1,000 words that are accepted."""

    pattern: str
    bound: float


FORMS = {
    "so many, so much, so far": Form(r"\bso (?:many|much|far)\b", 0.05),
    "stands, for a state": Form(r"\bstands?\b(?! (?:for|in the way))", 0.05),
    "tells": Form(r"\btells?\b|\btold\b", 0.05),
    "place for a position": Form(r"\b(?:at|of) (?:the |a |its |one |each )?places?\b", 0.05),
    "let go, hears": Form(r"\blet go\b|\bhears?\b", 0.05),
    "none as a predicate": Form(r"(?-i:\b(?:is|are|be) none\b)", 0.05),
    "what is, for a noun": Form(r"\bwhat is\b(?! (?:missing|wrong|normal|new))", 0.05),
    "return which, for a mask": Form(r"\breturns? which\b", 0.05),
    "beside, for next to": Form(r"\bbeside\b", 0.05),
    "that of, those of": Form(r"\b(?:that|those) of\b", 0.1),
}
SENTENCES, SENTENCE_BOUND = f"sentences over {LONGEST} words", 0.01

# Where a sentence ends: a mark, and what begins the next one.
_END = re.compile(r"(?<=[.!?])[\"')*]*\s+(?=[A-Z0-9\"*`\[('])")
_WORD = re.compile(r"[A-Za-z][\w'-]*")
# Code and formulas are read as one word, which may begin a sentence.
_CODE = re.compile(r"`[^`]*`|\$[^$]*\$")

# Lines of docstrings that are no prose: underlines of sections, parameters, names of tunables, examples.
_NO_PROSE = re.compile(r"-{3,}|[\w, *`]+ : |[a-z]\w*$|>>>")

# Lines that begin a paragraph of their own in docstrings: these, references, items, formulas.
_OWN = re.compile(_NO_PROSE.pattern + r"|\.\. |[-*] |\$\$")


def paragraphs(path: Path) -> Iterator[tuple[int, str]]:
    """Yield the paragraphs of prose of a file, with the numbers of their first lines."""
    source = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        yield from _of_comments(source)
        yield from _of_strings(ast.parse(source))
    else:
        yield from _parted(re.sub(r"```.*?```", lambda code: "\n" * code[0].count("\n"), source, flags=re.DOTALL), 1)


def _parted(text: str, line: int) -> Iterator[tuple[int, str]]:
    """Yield paragraphs of a text that begins at a line: items and cells of tables are paragraphs, too."""
    own: list[str] = []
    start = line
    for number, one in enumerate([*text.splitlines(), ""], line):
        bare = one.strip()
        if not bare or bare[0] in "|#" or _OWN.match(bare):
            if own:
                yield start, " ".join(own)
            own = []
            yield from ((number, cell.strip()) for cell in bare.strip("|").split("|") if bare.startswith("|"))
        if bare and bare[0] not in "|#" and not _NO_PROSE.match(bare):
            start = start if own else number
            own.append(bare)


def _of_comments(source: str) -> Iterator[tuple[int, str]]:
    """Comments on lines of their own continue; those behind code are paragraphs, as each describes its line."""
    own: list[str] = []
    start = last = 0
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type != tokenize.COMMENT:
            continue
        is_behind = bool(token.line[: token.start[1]].strip())
        if own and (token.start[0] != last + 1 or is_behind):
            yield start, " ".join(own)
            own = []
        start, last = start if own else token.start[0], -1 if is_behind else token.start[0]
        own.append(token.string.lstrip("#: "))
    if own:
        yield start, " ".join(own)


def _of_strings(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Docstrings, helps and messages have spaces; names and keys have none."""
    parts: set[int] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            parts |= {id(part) for part in node.values}
            text = "".join(str(part.value) if isinstance(part, ast.Constant) else "0" for part in node.values)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in parts:
            text = node.value
        else:
            continue
        if text.count(" ") > 2 and not text.lstrip().startswith("<") and "{" not in text:
            yield from _parted(text, node.lineno)


def files() -> list[Path]:
    """Return the files that users and developers read, without tests, generated pages and the log."""
    found = [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md"), *(ROOT / "docs" / "methods").glob("*.md")]
    for folder in ("algorithms", "provider"):
        found += (ROOT / folder).rglob("*.py")
    return sorted(path for path in found if path.name != "rules.md")


def findings(text: str) -> Iterator[str]:
    """Yield the name of each form in a paragraph, as often as it occurs."""
    for name, form in FORMS.items():
        yield from [name] * len(re.findall(form.pattern, text, re.IGNORECASE))
    yield from [SENTENCES] * sum(
        len(_WORD.findall(sentence)) > LONGEST for sentence in _END.split(_CODE.sub("X", text))
    )


def main(arguments: list[str]) -> int:
    """Print the counts or paragraphs; return 1 if a form is too frequent."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lines", action="store_true")
    shows_lines = parser.parse_args(arguments).lines
    bounds = {**{name: form.bound for name, form in FORMS.items()}, SENTENCES: SENTENCE_BOUND}
    counts, words = dict.fromkeys(bounds, 0), 0
    for path in files():
        for line, text in paragraphs(path):
            words += len(text.split())
            for name in findings(text):
                counts[name] += 1
                if shows_lines:
                    print(f"{path.relative_to(ROOT)}:{line}: {name}: {text[:600]}")
    rates = {name: 1000 * count / words for name, count in counts.items()}
    if not shows_lines:
        for name, rate in rates.items():
            print(f"{name:28s} {counts[name]:5d}  {rate:.2f} per 1,000 words, at most {bounds[name]:.2f}")
    return int(any(rate > bounds[name] for name, rate in rates.items()))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
