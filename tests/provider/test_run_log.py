"""The part of a page that describes the run that made it, and the rows of its parameters."""

import re

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import write_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.provider.run_log import RunLog, parameter_rows
from lidar_buildings.tests.builders import roof
from lidar_buildings.tests.provider.helpers import run


@pytest.fixture(scope="module")
def house(tmp_path_factory):
    """A house on level ground in the Dutch grid."""
    rng = np.random.default_rng(7)
    plan = rng.uniform(0, 40, (40 * 40 * 4, 2))
    under = ((plan > [14, 15]) & (plan < [26, 25])).all(axis=1)
    ground = np.column_stack([plan, rng.normal(0, 0.02, len(plan))])[~under]
    xyz = np.concatenate([ground, roof(rng, 14, 15, 12, 10, 5.0, density=4.0)]) + [85_000, 447_000, 0]
    path = tmp_path_factory.mktemp("house") / "house.laz"
    write_cloud(create_cloud({"xyz": xyz}, "EPSG:28992"), path)
    return path


def test_the_page_of_a_chain_names_its_cloud_and_the_values_of_automatic_parameters(provider, context, log, house, out):
    """It had neither file, date, version nor parameters."""
    given = {"INPUT": str(house), "OUTPUT": str(out / "a.las"), "REPORT": str(out / "a.html"), "MIN_AREA": 5.0}
    result = run("detectbuildings", given, context, log)
    page = (out / "a.html").read_text(encoding="utf-8")
    for text in ("house.laz", str(house.parent), "EPSG:28992", "Detect buildings", "LiDAR Buildings "):
        assert text in page
    assert re.search(r"\d{4}-\d\d-\d\d \d\d:\d\d", page)
    used = f"{result['GROUND_ITERATION_DISTANCE_USED']:.4g} m"
    assert f'Iteration distance</th><td class="number">{used}</td><td>automatic' in page
    assert 'Minimum building area</th><td class="number">5 m²</td><td>set; default: 4 m²' in page
    steps = page.split("<h2>Steps</h2>")[1].split("</table>")[0]
    seconds = [float(one) for one in re.findall(r"([\d.]+) s</td>", steps)]
    assert len(seconds) == len(PIPELINES["detect_buildings"].steps) + 1
    assert seconds[-1] == pytest.approx(sum(seconds[:-1]), abs=1.0)
    assert not re.search(r'(?:src|href)="(?!data:)', page)


def test_a_page_of_one_stage_has_its_parameters(provider, context, log, town_file, reference_file, out):
    given = {"INPUT": str(town_file), "REFERENCE": str(reference_file), "REPORT": str(out / "a.html")}
    run("assessbuildings", given, context, log)
    page = (out / "a.html").read_text(encoding="utf-8")
    assert "town.laz and 1 more" in page
    assert "<h3>Assess buildings</h3>" in page


def test_rows_of_parameters_name_the_source_of_each_value():
    stage = STAGES["classify_ground_tin"]
    rows = {
        row.name: (row.value, row.meaning) for row in parameter_rows(stage, {"cell_size": 2.0}, {"terrain": "town"})
    }
    assert rows["Terrain"] == ("town", "automatic")
    assert rows["Keep existing ground"] == ("no", "default")
    assert rows["Grid cell size"] == ("2 m", "set; default: automatic")
    several = parameter_rows(stage, {}, {"cell_size": [1.0, 1.5, 3.0]})
    assert {row.name: row.value for row in several}["Grid cell size"] == "1 m to 3 m"


def test_messages_of_steps_are_kept_once():
    log = RunLog()
    for _ in range(2):
        log.begin(STAGES["classify_ground_tin"], {})
        log.note("No coordinates.")
    log.end()
    assert [step.notes for step in log.steps] == [["No coordinates."], []]
