"""Times of earlier commits: kept as a JSON file each, and compared in units of the floor of the same run.

Processor time in units of "read + neighbors" hardly depends on the machine and on what else it does. Rows are compared
by name and size. The first run in a checkout is compared with the published one, which is under version control.
"""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any, Optional

FLOOR = "read + neighbors"

# Change of a ratio that is more than two runs of one commit differ by, on a busy machine.
NOTEWORTHY = 0.05


def keep_copy(results: Path) -> Path:
    """Copy a file of results into the folder of the history next to it, and return the copy: one for each commit."""
    content = _content(results)
    name = content["commit"] or "without-git"
    if content["changed"]:
        name += "-changed"
    path = results.parent / "history" / f"{results.stem}-{name}.json"
    path.parent.mkdir(exist_ok=True)
    shutil.copyfile(results, path)
    return path


def before(path: Path, published: Path) -> Optional[dict[str, Any]]:
    """Return the results kept last before a file of the history.

    They are the ``published`` ones where it is the first, and None where that file does not exist.
    """
    own = _content(path)
    table = own["table"]
    others = [_content(other) for other in path.parent.glob(f"{table}-*.json") if other != path]
    if not others and published.exists():
        others = [_content(published)]
    return max((one for one in others if one["date"] <= own["date"]), key=lambda one: one["date"], default=None)


def changes(earlier: list[dict[str, Any]], later: list[dict[str, Any]]) -> list[tuple[float, str, float, float]]:
    """Return what both runs measured, in the order of the later one: million points, name, and its ratio in each.

    A ratio is processor time in units of the floor of the same run and size; what has no floor is left out.
    """
    then, now = _ratios(earlier), _ratios(later)
    return [(*key, then[key], ratio) for key, ratio in now.items() if key in then and key[1] != FLOOR]


def sentences(path: Path, published: Path) -> list[str]:
    """Return the lines in which a file of the history differs from the one before; see :func:`before`."""
    last, own = before(path, published), _content(path)
    if last is None:
        return ["No earlier results are kept to compare with."]
    lines = [f"Processor time in units of {FLOOR}, compared with {(last['commit'] or 'no commit')[:12]}:"]
    for millions, name, then, now in changes(last["rows"], own["rows"]):
        mark = "" if abs(now / then - 1) < NOTEWORTHY else " *"
        lines.append(f"{name:28s} {millions:6g} M {then:8.2f} {now:8.2f} {now / then - 1:+8.0%}{mark}")
    return lines


def _ratios(rows: list[dict[str, Any]]) -> dict[tuple[float, str], float]:
    """Return processor times in units of the floor of their size, by size and name."""
    floors = {row["millions"]: row["cpu_seconds"] for row in rows if row["name"] == FLOOR}
    return {
        (row["millions"], row["name"]): row["cpu_seconds"] / floors[row["millions"]]
        for row in rows
        if floors.get(row["millions"])
    }


def _content(path: Path) -> dict[str, Any]:
    return json.loads(path.read_text(encoding="utf-8"))
