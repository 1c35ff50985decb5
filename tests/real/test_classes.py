"""Land cover in real clouds, found with nothing set: the figures are F (%) of merged classes, measured as here."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.asprs import VEGETATION, PointClass
from lidar_buildings.tests.real.clouds import WITHOUT_BUILDINGS, detected, each, truth

MARGIN = 1.0

# Classes of the truth that are left out: what nobody classified (cars, poles and walls among it), bridges, artefacts.
IGNORED = (0, 1, 17, 26, 64, 65, 66, 67)


def f_score(name: str, classes: tuple) -> float:
    """Return the F (%) of merged classes in a cloud."""
    true, made = truth(name), detected(name).classification
    counted = ~np.isin(true, IGNORED)
    is_true, is_found = np.isin(true[counted], classes), np.isin(made[counted], classes)
    return 200 * (is_true & is_found).sum() / (is_true.sum() + is_found.sum())


# Of the plants of the chalet's meadow, most under 0.2 m, two thirds are ground to the filter.
@pytest.mark.parametrize(
    ("name", "reached"),
    [
        ("ign-forest-none", 98.6),
        pytest.param("ign-bridge-none", 94.3, marks=pytest.mark.slow),
        pytest.param("ign-chalet", 87.0, marks=pytest.mark.slow),
        ("ign-stbarth-4", 88.8),
    ],
)
def test_vegetation_is_found_as_well_as_before(name, reached):
    assert f_score(f"buildings/{name}", VEGETATION) >= reached - MARGIN


def test_every_point_has_been_looked_at():
    assert not (detected("buildings/ign-stbarth-4").classification == PointClass.NEVER_CLASSIFIED).any()


# Canals under 30 m wide, of which most pulses are lost. At 4 points per m² the points at the foot of the quays count.
@pytest.mark.parametrize(
    ("name", "reached"),
    [pytest.param("ahn3-delft-4", 94.6, marks=pytest.mark.slow), ("amsterdam-centre-10", 98.8)],
)
def test_canals_are_found_as_well_as_before(name, reached):
    assert f_score(f"buildings/{name}", (PointClass.WATER,)) >= reached - MARGIN


@pytest.mark.parametrize("name", each(["buildings/ign-chalet", "buildings/ign-stbarth-4", "buildings/ahn-amsterdam-1"]))
def test_no_water_is_found_where_there_is_none(name):
    assert not (detected(name).classification == PointClass.WATER).any()


# A tower crane on the hillside hangs its jib as wires do; the other clouds have neither wires nor cranes.
@pytest.mark.parametrize("name", each((*WITHOUT_BUILDINGS, "buildings/ahn3-delft-4", "buildings/amsterdam-centre-10")))
def test_no_wires_are_found_where_there_are_none(name):
    assert not (detected(name).classification == PointClass.WIRE_CONDUCTOR).any()
