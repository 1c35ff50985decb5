"""Ground in real clouds, found with nothing set, against figures that were reached before.

The figures come from ``python tests/benchmarks/accuracy.py ground``, which prints them ready to be pasted here. The
samples are of the filter test of ISPRS WG III/3 (Sithole and Vosselman 2004), where the method's author reached a mean
of 4.8 % on all 15.
"""

import numpy as np
import pytest

from lidar_buildings.tests.real.clouds import GROUND_IN_TOWN, GROUND_SAMPLES, classified, each, score

# Total error (%): points on the wrong side among all.
REACHED = {
    "ground/samp11": 8.8,
    "ground/samp12": 2.5,
    "ground/samp22": 3.1,
    "ground/samp31": 1.2,
    "ground/samp41": 3.1,
    "ground/samp52": 2.4,
    "ground/samp53": 2.5,
    "ground/samp61": 1.0,
}
REACHED_MEAN = 3.08

# The same of the filter as published in 2000, on samples where it takes seconds. Rounds ended while some points still
# qualified once: these were 10.3, 6.1 and 3.8.
REACHED_AS_PUBLISHED = {"ground/samp22": 9.0, "ground/samp31": 4.4, "ground/samp61": 2.9}
REACHED_IN_TOWN = {"buildings/ahn3-delft": 1.0}

# Other versions of numpy and scipy round differently.
MARGIN, MEAN_MARGIN = 0.5, 0.2

# Above this (%) the filter would not do what it is for, whatever was reached.
LIMIT = 6.0


def test_every_cloud_of_the_table_is_held_to_its_figure():
    assert (tuple(REACHED), tuple(REACHED_IN_TOWN)) == (GROUND_SAMPLES, GROUND_IN_TOWN)


def total_error(name):
    return score("ground", name, classified(name, "classify_ground_tin"))["total"]


@pytest.mark.parametrize("name", REACHED)
def test_ground_of_a_sample_is_found_as_well_as_before(name):
    assert total_error(name) <= REACHED[name] + MARGIN


def test_mean_of_the_samples_is_as_good_as_before():
    assert np.mean([total_error(name) for name in REACHED]) <= min(REACHED_MEAN + MEAN_MARGIN, LIMIT)


@pytest.mark.parametrize("name", REACHED_IN_TOWN)
def test_ground_of_a_town_is_found_as_well_as_before(name):
    assert total_error(name) <= min(REACHED_IN_TOWN[name] + MARGIN, LIMIT)


@pytest.mark.parametrize("name", REACHED)
def test_neither_side_is_given_up_for_the_other(name):
    # All ground or none would be right for most points of some samples.
    assert score("ground", name, classified(name, "classify_ground_tin"))["kappa"] > 50


@pytest.mark.parametrize("name", each(REACHED_AS_PUBLISHED, slow=["ground/samp22", "ground/samp61"]))
def test_ground_as_published_does_not_get_worse(name):
    found = score("ground", name, classified(name, "classify_ground_tin_2000"))
    assert found["total"] <= REACHED_AS_PUBLISHED[name] + MARGIN
