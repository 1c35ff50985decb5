"""Results of a benchmark: a table in Markdown for people, row by row, and a JSON file of the same for programs."""

from __future__ import annotations

import argparse
import configparser
import datetime
import json
import math
import os
import platform
import subprocess
from collections.abc import Callable
from importlib import metadata
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
# Where results go unless the command line says otherwise.
FOLDER = ROOT / "benchmarks"
PACKAGES = ("numpy", "scipy", "scikit-learn", "laspy", "lazrs")


class Table:
    """A table that prints each row as soon as it is known; ``rows`` has the figures by heading, not rounded.

    ``name`` is its file's, without extension; ``columns`` are headings with units, the keys of the figures in the
    file. The first columns, as many as ``texts`` says, hold text and are aligned to the left.
    """

    def __init__(self, name: str, *columns: str, texts: int = 1) -> None:
        if len(set(columns)) < len(columns):
            raise ValueError(f"The columns of {name} must have different headings, these are {', '.join(columns)}.")
        self.name, self.columns, self.rows = name, columns, []
        print("\n| " + " | ".join(columns) + " |")
        print("|" + " --- |" * texts + " ---: |" * (len(columns) - texts), flush=True)

    def add(self, *cells: Any, digits: int = 1) -> None:
        """Print a row, fractions with ``digits`` decimals, and keep it; None is an empty cell."""
        if len(cells) != len(self.columns):
            raise ValueError(f"A row of {self.name} needs {len(self.columns)} cells, it has {len(cells)}.")
        self.rows.append({column: _plain(cell) for column, cell in zip(self.columns, cells)})
        print("| " + " | ".join(_shown(cell, digits) for cell in cells) + " |", flush=True)

    def write(self, folder: Path) -> Path:
        """Write the table to the folder, and return its file."""
        return write(folder, self.name, self.rows)


def write(folder: Path, name: str, rows: list[dict[str, Any]]) -> Path:
    """Write figures with what they depend on to ``<name>.json``, and return the file."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.json"
    content = {"table": name, **circumstances(), "rows": rows}
    path.write_text(json.dumps(content, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    return path


def print_tables(tables: dict[str, Callable[[], list[Table]]], description: str | None, check: Any = None) -> None:
    """Print and write the tables that the command line names, or all; ``check`` returns why these can't be made."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tables", nargs="*", metavar="table", help=", ".join(tables))
    parser.add_argument("--output", type=Path, default=FOLDER, help="folder of the JSON files (benchmarks)")
    chosen = parser.parse_args()
    wanted = chosen.tables or list(tables)
    if set(wanted) - set(tables):
        parser.error(f"there is no table {(set(wanted) - set(tables)).pop()!r}; there are {', '.join(tables)}")
    if check is not None and (reason := check(wanted)):
        parser.error(reason)
    for name in wanted:
        print(f"\n## {name}")
        for table in tables[name]():
            print(f"\n{table.write(chosen.output)}")


def circumstances() -> dict[str, Any]:
    """Return what figures depend on besides the data: version and commit of the code, date, machine."""
    general = configparser.ConfigParser(interpolation=None)
    general.read(ROOT / "metadata.txt", encoding="utf-8")
    return {
        "version": general["general"]["version"],
        "commit": _git("rev-parse", "HEAD"),
        # Whether tracked files differ from the commit; None without git.
        "changed": None if _git("rev-parse", "HEAD") is None else bool(_git("status", "--porcelain", "-uno")),
        "date": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
        "machine": machine(),
    }


def machine() -> dict[str, Any]:
    """Return what times depend on: processor, cores, memory, versions."""
    return {
        "processor": platform.machine(),
        "cores": os.cpu_count(),
        "memory_gb": round(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 1e9),
        "system": platform.platform(terse=True),
        "python": platform.python_version(),
        **{name: metadata.version(name) for name in PACKAGES},
    }


def _git(*arguments: str) -> str | None:
    """Return what git says of the checkout, None where there is no git or no repository."""
    try:
        done = subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        return None
    return done.stdout.strip() if done.returncode == 0 else None


def _plain(cell: Any) -> Any:
    """Return a figure as JSON has it: numbers of numpy as Python's, what is not a number as None."""
    value = cell.item() if hasattr(cell, "item") else cell
    return None if isinstance(value, float) and math.isnan(value) else value


def _shown(cell: Any, digits: int) -> str:
    """Return the text of a cell."""
    if cell is None:
        return ""
    return f"{cell:.{digits}f}" if isinstance(cell, float) else str(cell)
