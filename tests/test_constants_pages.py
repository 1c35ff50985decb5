"""Pages of constants: each row has the line of the code in which the constant is found."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

from lidar_buildings.algorithms.pipelines import PIPELINES

ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture(scope="module")
def constants():
    sys.path.insert(0, str(ROOT / "docs"))
    try:
        import constants as module
    finally:
        sys.path.pop(0)
    return module


def rows(page: str) -> list[list[str]]:
    return [
        [cell.strip(" `") for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
        for line in page.splitlines()
        if line[:3] == "| `"
    ]


@pytest.mark.parametrize("name", [*PIPELINES, "in_tiles"])
def test_lines_are_those_of_the_constants(constants, name):
    page = constants.tiling_page() if name == "in_tiles" else constants.constants_page(PIPELINES[name])
    found = rows(page)
    assert len(found) > 20
    for constant, _, _, why, where in found:
        file, line = where.split(":")
        text = (ROOT / file).read_text(encoding="utf-8").splitlines()[int(line) - 1]
        assert constant.rsplit(".", 1)[1] in text
        assert why


def test_all_three_ways_to_give_a_constant_are_read(constants):
    page = constants.constants_page(PIPELINES["detect_buildings"])
    value = {constant: value for constant, value, *_ in rows(page)}
    assert value["refine_buildings._RULES.becomes"] == "0.65"
    assert value["classify_water._RULES.window"] == "5.0"
    assert value["soft_shares._NEAR"] == "0.9"
