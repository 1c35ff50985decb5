#!/usr/bin/env python3
"""Run what QGIS's plugin repository scans a zip with; end with exit code 1 on any finding.

Its tools are listed in requirements-dev.txt: bandit, detect-secrets, and flake8 with lines of 120 characters.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

# E203 asks for "a[b:c]" where the formatter of this project writes "a[b + 1 : c]".
FLAKE8 = ("--isolated", "--max-line-length=120", "--extend-ignore=E203")


def findings(archive: Path) -> list[str]:
    """Return a line for each finding of the scanners in a zip.

    Raises
    ------
    RuntimeError
        If a scanner is missing or fails.
    """
    with tempfile.TemporaryDirectory() as folder:
        with zipfile.ZipFile(archive) as opened:
            opened.extractall(folder)
        return [*_of_bandit(folder), *_of_secrets(folder), *_of_flake8(folder)]


def _of_bandit(folder: str) -> list[str]:
    """Return the findings of all tests of bandit, but for lines that say ``nosec`` with the reason."""
    found = json.loads(_said("bandit", "--quiet", "--recursive", "--format", "json", ".", folder=folder))
    failed = [f"bandit: {one['filename']}: {one['reason']}" for one in found["errors"]]
    return failed + [
        f"bandit {one['test_id']}: {one['filename']}:{one['line_number']}: {one['issue_text']}"
        for one in found["results"]
    ]


def _of_secrets(folder: str) -> list[str]:
    """Return the findings of detect-secrets, whose exit code is 0 whatever it finds."""
    found = json.loads(_said("detect_secrets", "scan", "--all-files", ".", folder=folder))
    return [
        f"detect-secrets: {path}:{one['line_number']}: {one['type']}"
        for path, several in found["results"].items()
        for one in several
    ]


def _of_flake8(folder: str) -> list[str]:
    """Return the lines of flake8."""
    return [f"flake8: {line}" for line in _said("flake8", *FLAKE8, ".", folder=folder).splitlines()]


def _said(module: str, *arguments: str, folder: str) -> str:
    """Return what a scanner prints of a folder; those that found something end with exit code 1."""
    done = subprocess.run(
        [sys.executable, "-m", module, *arguments], cwd=folder, capture_output=True, text=True, check=False
    )
    if done.returncode not in (0, 1) or "No module named" in done.stderr:
        why = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
        raise RuntimeError(f"{module} can't scan the package ({why}); install requirements-dev.txt.")
    return done.stdout


def main(archive: Path) -> int:
    """Print the findings; return the exit code."""
    found = findings(archive)
    print("\n".join(found) or f"{archive.name}: bandit, detect-secrets and flake8 find nothing.")
    return min(1, len(found))


if __name__ == "__main__":
    try:
        sys.exit(main(Path(sys.argv[1])))
    except RuntimeError as error:
        sys.exit(str(error))
