"""Pages of constants: each row has the line of the code in which the constant is found."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.tiling.run_in_tiles import tunables_of
from lidar_buildings.algorithms.tiling.tiled_steps import in_blocks

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


def test_pages_name_the_distances_that_are_read_around_blocks():
    page = (ROOT / "docs" / "surveys.md").read_text(encoding="utf-8")
    named = re.findall(r"^\| (\*.+\*) \| ([\d.]+) m \|", page, re.MULTILINE)
    assert len(named) == 7
    reaches = {one.title: (in_blocks(one), tunables_of(in_blocks(one), {})) for one in PIPELINES.values()}
    for titles, meters in named:
        for title in re.findall(r"\*([^*]+)\*", titles):
            composite, tunables = reaches[title]
            assert composite.reach(tunables) == pytest.approx(float(meters), abs=0.5), title
    methods = (ROOT / "docs" / "methods" / "in_tiles.md").read_text(encoding="utf-8")
    detected = named[0][1]
    assert f"{detected} m for *Detect buildings*" in methods
    assert f"That is {detected} m for *Detect buildings*" in page
