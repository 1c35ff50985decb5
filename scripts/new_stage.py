#!/usr/bin/env python3
"""Begin a stage: the example of CONTRIBUTING.md under another name, its test, and the lines that make it known.

::

    make new-stage NAME=segmentation.segment_storeys

Then edit the module and its test; both run as they are. What was begun is undone by deleting both, and
their lines in ``algorithms/stages.py`` and ``CHANGELOG.md``.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
EXAMPLE = "segment_storeys"
STAGES = ROOT / "algorithms" / "stages.py"
CHANGES = ROOT / "CHANGELOG.md"

TEST = '''"""Storeys of a tower of points."""

import numpy as np

from lidar_buildings.algorithms.{room}.{name} import {name}


def test_storeys_are_counted_from_the_lowest_point():
    z = np.repeat([2.0, 5.5, 9.0], 4)
    np.testing.assert_array_equal({name}(np.column_stack([z, z, z])), np.repeat([1, 2, 3], 4))
'''


def example() -> str:
    """Return the module of the example."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    return re.findall(r"```python\n(.*?)```", text, re.DOTALL)[0]


def group_of(room: str) -> str:
    """Return the toolbox group of most stages in a room.

    Raises
    ------
    ValueError
        If the room has no stage.
    """
    sources = [path.read_text(encoding="utf-8") for path in (ROOT / "algorithms" / room).glob("*.py")]
    groups = re.findall(r'^@stage\(\s*"([^"]+)"', "\n".join(sources), re.MULTILINE)
    if not room or not groups:
        raise ValueError(f"algorithms/{room} is no room with stages; name the stage as in segmentation.{EXAMPLE}.")
    return max(sorted(set(groups)), key=groups.count)


def begin(room: str, name: str) -> list[Path]:
    """Write the files of a stage and return those that were written or changed.

    Raises
    ------
    ValueError
        If the room has no stage, or the name is taken or has no verb and object.
    """
    module = ROOT / "algorithms" / room / f"{name}.py"
    test = ROOT / "tests" / "algorithms" / room / f"test_{name}.py"
    if not re.fullmatch(r"[a-z]+(_[a-z0-9]+)+", name):
        raise ValueError(f"{name!r} is no verb with its object, in lower case with underscores.")
    if module.exists() or test.exists():
        raise ValueError(f"There is a module or a test of {name} already; choose another name.")
    group = group_of(room)
    module.write_text(example().replace(EXAMPLE, name).replace('"Segmentation"', f'"{group}"'), encoding="utf-8")
    test.write_text(TEST.format(room=room, name=name), encoding="utf-8")
    stages = STAGES.read_text(encoding="utf-8")
    last = list(re.finditer(rf'^    "{room}\.\w+",\n', stages, re.MULTILINE))[-1]
    STAGES.write_text(f'{stages[: last.end()]}    "{room}.{name}",\n{stages[last.end() :]}', encoding="utf-8")
    changes, news = CHANGES.read_text(encoding="utf-8"), f"- *{name.replace('_', ' ').capitalize()}* is new.\n"
    at = changes.index("\n- ", changes.index("### ")) + 1
    CHANGES.write_text(changes[:at] + news + changes[at:], encoding="utf-8")
    return [module, test, STAGES, CHANGES]


def main(words: list[str]) -> int:
    """Begin the stage of the name that is given; return the exit code."""
    try:
        room, name = words[0].split(".") if words and words[0].count(".") == 1 else ("", "")
        files = begin(room, name)
    except ValueError as error:
        print(error, file=sys.stderr)
        return 1
    print("\n".join(str(file.relative_to(ROOT)) for file in files))
    print("Edit the two modules, and put the line of CHANGELOG.md under its heading.")
    print(f"Then run: make pictures IDS={name.replace('_', '')} && make check")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
