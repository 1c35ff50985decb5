"""Noise in a real cloud, found with nothing set.

The figure comes from ``python tests/benchmarks/accuracy.py noise``. Most of the 322 points that the survey's makers
rejected lie among the others, between ground and crowns, where no filter of heights can find them. The points far from
the scene must be found, and no good point may be lost.
"""

import numpy as np

from lidar_buildings.algorithms.cloud.asprs import NOISE
from lidar_buildings.tests.real.clouds import OUTLIERS, classified, score, truth

# Percent of all rejected points that are found.
REACHED = 10.2
MARGIN = 1.0

# No ground or crown in this cloud is higher, m.
HIGHEST = 250.0


def result():
    return classified(OUTLIERS, "classify_noise_histogram")


def test_every_point_far_off_is_found():
    far = result().cloud.get("xyz")[:, 2] > HIGHEST
    assert far.any()
    assert np.isin(result().classification[far], NOISE).all()


def test_no_good_point_is_called_noise():
    assert not np.isin(result().classification[truth(OUTLIERS) != 65], NOISE).any()


def test_rejected_points_are_found_as_well_as_before():
    assert score("noise", OUTLIERS, result())["completeness"] >= REACHED - MARGIN
