#!/usr/bin/env python3
"""Fill version and changelog of metadata.txt from CHANGELOG.md; with ``--check`` only say whether they fit."""

from __future__ import annotations

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RELEASE = re.compile(r"^## (\d+\.\d+\.\d+)\b.*$", re.MULTILINE)

# The plugin manager shows the text as it is, in a small window: the heading and this many lines, details left out.
LINES = 10


def filled(metadata: str, changelog: str) -> str:
    """Return the text of metadata.txt with the version and the news of the latest release of CHANGELOG.md.

    The news are the list before the first heading within the release, its first ten lines, without Markdown.

    Raises
    ------
    ValueError
        If the changelog has no heading of a version.
    """
    newest = RELEASE.search(changelog)
    if newest is None:
        raise ValueError("CHANGELOG.md has no heading like '## 1.2.3'; add one for the version to be released.")
    after = changelog[newest.end() :]
    news = re.split(r"^#", after, maxsplit=1, flags=re.MULTILINE)[0]
    lines = [line for line in re.sub(r"[*`]", "", news).splitlines() if line.strip()][:LINES]
    # To the reader of metadata.txt a percent sign is special, and only indented lines go on.
    indented = "\n    ".join([newest[0].lstrip("# "), *lines]).replace("%", "%%")
    metadata = re.sub(r"^version=.*$", f"version={newest[1]}", metadata, flags=re.MULTILINE)
    return re.sub(
        r"^changelog=.*\Z", lambda _: f"changelog=\n    {indented}\n", metadata, flags=re.MULTILINE | re.DOTALL
    )


def main(arguments: list[str]) -> int:
    """Write metadata.txt, or only compare; return the exit code."""
    path = ROOT / "metadata.txt"
    before = path.read_text(encoding="utf-8")
    after = filled(before, (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"))
    if before == after:
        return 0
    if "--check" in arguments:
        print("metadata.txt differs from CHANGELOG.md; run scripts/metadata.py and commit.", file=sys.stderr)
        return 1
    path.write_text(after, encoding="utf-8")
    print("metadata.txt: version and changelog filled in from CHANGELOG.md")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
