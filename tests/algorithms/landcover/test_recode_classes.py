"""Codes of agencies and of one's own."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.landcover.recode_classes import CODES, parse_mapping, recode_classes
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.algorithms.simulation.simulate_town import simulate_town

CLASSES = np.array([0, 1, 2, 3, 4, 5, 6, 7, 9, 14, 15, 17, 18], np.uint8)
XYZ = np.zeros((len(CLASSES), 3))


def test_by_default_nothing_changes():
    every = np.arange(256, dtype=np.uint8)
    np.testing.assert_array_equal(recode_classes(np.zeros((256, 3)), every), every)


@pytest.mark.parametrize(
    ("codes", "expected"),
    [
        ("AHN (Netherlands)", [1, 1, 2, 1, 1, 1, 6, 1, 9, 14, 1, 26, 1]),
        ("IGN LiDAR HD (France)", [1, 1, 2, 3, 4, 5, 6, 65, 9, 64, 64, 17, 65]),
        ("USGS 3DEP (United States)", [1, 1, 2, 1, 1, 1, 6, 7, 9, 1, 1, 17, 18]),
    ],
)
def test_agencies_write_their_codes(codes, expected):
    assert recode_classes(XYZ, CLASSES, codes=codes).tolist() == expected


def test_own_codes_come_over_those_of_an_agency():
    made = recode_classes(XYZ, CLASSES, codes="AHN (Netherlands)", mapping="3-5=5; 17 = 30;")
    assert made.tolist() == [1, 1, 2, 5, 5, 5, 6, 1, 9, 14, 1, 30, 1]
    assert parse_mapping("") == {}


@pytest.mark.parametrize("text", ["17", "17=", "=26", "17=256", "17=x", "300=1", "3-5=5, 17=26"])
def test_what_is_no_mapping_is_refused(text):
    with pytest.raises(ValueError, match="Own codes"):
        recode_classes(XYZ, CLASSES, mapping=text)


def test_a_chain_writes_them_and_finds_the_same_buildings():
    xyz, _, number, count, *_ = simulate_town(size=60.0, density=3.0, seed=2)
    given = {"xyz": xyz, "return_number": number, "number_of_returns": count}
    made, plain = create_cloud(given), create_cloud(given)
    one = run_pipeline(PIPELINES["detect_buildings"], made, codes_mapping="6=200; 3-5=201")
    other = run_pipeline(PIPELINES["detect_buildings"], plain)
    assert len(one.layers["footprints"]) == len(other.layers["footprints"])
    expected = recode_classes(xyz, plain.get("classification"), mapping="6=200; 3-5=201")
    np.testing.assert_array_equal(made.get("classification"), expected)
    assert set(CODES) == set(recode_classes.stage.tunables["codes"].param.choices)
