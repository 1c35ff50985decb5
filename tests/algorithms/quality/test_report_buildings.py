"""The page on the buildings found: numbers by hand, a map, and the views of the doubtful ones."""

import re

import numpy as np
import pytest

from lidar_buildings.algorithms.quality.report_buildings import report_buildings, summary_of
from lidar_buildings.algorithms.report.page import with_coordinates
from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stage import LayerFeatures, Monitor
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.tests.builders import roof


def square(x, y, side, hole=0.0):
    ring = np.array([[x, y], [x + side, y], [x + side, y + side], [x, y + side], [x, y]], float)
    if not hole:
        return [ring]
    middle = np.array([x + side / 2, y + side / 2])
    return [ring, middle + np.array([[-1, -1], [-1, 1], [1, 1], [1, -1], [-1, -1]]) * hole / 2]


@pytest.fixture
def footprints():
    columns = {
        "id": [7, 8, 9],
        "height": np.array([5.0, 9.0, np.nan]),
        "volume": np.array([500.0, 3000.0, 100.0]),
        "confidence": np.array([0.9, 0.45, 0.65]),
        "reason": ["<Solid>", "Solid & more", None],
        "evidence": ["entropy 0.61", "38 % of the beam passes", None],
    }
    return LayerFeatures([square(0, 0, 10), square(30, 0, 20, hole=10), square(0, 40, 5)], columns)


@pytest.fixture
def cloud(rng):
    ground = np.column_stack([rng.uniform(-10, 60, (4000, 2)), np.zeros(4000)])
    houses = np.concatenate([roof(rng, 0, 0, 10, 10, 5), roof(rng, 30, 0, 20, 20, 9)])
    return np.concatenate([ground, houses]), np.repeat([2, 6], [4000, len(houses)]).astype(np.uint8)


def test_totals_by_hand(footprints, cloud):
    monitor = Monitor()
    report = report_buildings(*cloud, footprints, monitor=monitor)
    assert report.values == {"buildings": 3, "area": 100 + 400 - 100 + 25, "volume": 3600, "doubtful": 2}
    assert monitor.infos == ["3 buildings, 425 m², 2 doubtful."]
    for text in ("3,600 m³", "425 m²", "7.0 m", "from 5.0 to 9.0 m"):
        assert text in report.html


@pytest.mark.parametrize(
    ("buildings", "doubtful", "said"),
    [
        (3, 3, "Perhaps no building: 3 buildings, 425 m², all doubtful."),
        (3, 2, "3 buildings, 425 m², 2 doubtful."),
        (0, 0, "0 buildings, 425 m², 0 doubtful."),
    ],
)
def test_the_summary_begins_with_a_doubt_of_all_buildings(buildings, doubtful, said):
    assert summary_of({"buildings": buildings, "area": 425.0, "doubtful": doubtful}) == said


def test_doubtful_buildings_come_least_sure_first_and_their_texts_are_escaped(footprints, cloud):
    page = report_buildings(*cloud, footprints).html
    assert re.findall(r"Building (\d+): confidence ([\d.]+)", page) == [("8", "0.45"), ("9", "0.65")]
    assert "Solid &amp; more; 38 % of the beam passes" in page
    # Each from above and in two sections.
    assert page.count('<svg class="view"') == 6
    # The outline and two cuts, and two walls in each section.
    assert page.count("<polyline") == 2 * (1 + 2 + 2 * 2)


def test_the_map_has_each_footprint_in_the_color_of_its_confidence(footprints, cloud):
    page = report_buildings(*cloud, footprints).html
    # The buildings of the highest confidence are drawn first; their paths differ in the first point, and north is up.
    fills = re.findall(r'<path fill="(#\w+)" d="M([\d.]+),', page)
    assert [color for color, _ in fills] == ["#004488", "#ddaa33", "#bb5566"]
    west = [float(x) for _, x in fills]
    assert west[0] == west[1] < west[2]
    assert "<image" in page
    assert not re.search(r'(?:src|href)="(?!data:)', page)


def test_of_footprints_alone_there_is_a_page_without_points(footprints):
    report = run_stage(STAGES["report_buildings"], input_layers={"footprints": footprints}).report
    assert report.values["buildings"] == 3
    assert "<image" not in report.html


def test_footprints_of_other_programs_have_areas_at_least():
    footprints = LayerFeatures([square(0, 0, 10)], {"name": ["hall"], "height": ["tall"]})
    report = report_buildings(None, None, footprints)
    assert report.values["area"] == 100
    assert np.isnan(report.values["volume"])
    assert report.values["doubtful"] == 0


def test_nothing_found_is_a_page_that_says_so(cloud):
    report = report_buildings(*cloud, LayerFeatures([], {}))
    assert report.values == {"buildings": 0, "area": 0.0, "volume": 0.0, "doubtful": 0}
    assert "no footprints to show" in report.html


def test_noise_above_is_not_the_surface_of_the_map(footprints, cloud, rng):
    xyz, classes = cloud
    birds = np.column_stack([rng.uniform(-10, 60, (500, 2)), np.full(500, 200.0)])
    noisy = np.concatenate([xyz, birds]), np.append(classes, np.full(500, 18, np.uint8))
    maps = [report_buildings(*one, footprints).html.split("<h2>Doubtful")[0] for one in (cloud, noisy)]
    assert maps[0] == maps[1]


def test_each_doubtful_building_has_its_position(footprints, cloud):
    page = with_coordinates(report_buildings(*cloud, footprints).html, lambda xy: xy + [85_000, 446_000])
    # Middles of the boxes around the squares at (30, 0) and (0, 40).
    assert "Solid &amp; more; 38 % of the beam passes. At 85040.0 E, 446010.0 N." in page
    assert "At 85002.5 E, 446042.5 N." in page
    assert "m east" not in page
