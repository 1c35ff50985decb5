"""Rounded heights show their step; finely measured ones, flat roofs and stairs have none."""

import numpy as np
import pytest

from lidar_buildings.algorithms.sampling.height_resolution import (
    LEAST_RESOLUTION,
    height_resolution,
    rounding_deviation,
)


@pytest.mark.parametrize("step", [0.001, 0.01, 0.1, 0.25, 0.3, 0.3048])
@pytest.mark.parametrize("lowest", [0.0, 1234.5])
def test_the_deviation_that_rounding_leaves(rng, step, lowest):
    exact = lowest + rng.uniform(0, 40, 200_000)
    rounded = np.round(exact / step) * step
    assert rounding_deviation(rounded) == pytest.approx(np.std(rounded - exact), rel=0.02)


def test_some_levels_may_be_empty(rng):
    levels = np.round(rng.uniform(0, 30, 20_000) / 0.3)
    levels = levels[~np.isin(levels, rng.choice(100, 20, replace=False))]
    assert rounding_deviation(levels * 0.3) == pytest.approx(0.3 / np.sqrt(12))


def test_heights_that_are_not_rounded_have_no_step(rng):
    for count in (50, 500, 5000):
        assert rounding_deviation(rng.uniform(0, 40, count)) == 0
    assert rounding_deviation(rng.uniform(0, 40, 100_000)) < 1e-3


@pytest.mark.parametrize("levels", [[0.0], [0.0, 0.3], np.arange(8) * 0.3, np.arange(30) * 3.0])
def test_flat_roofs_and_storeys_are_no_rounding(levels):
    assert rounding_deviation(np.repeat(levels, 100)) == 0


@pytest.mark.parametrize(("step", "least"), [(0.001, LEAST_RESOLUTION), (0.3, 0.3 / np.sqrt(12))])
def test_no_surface_is_known_to_be_smoother_than_what_is_stored(rng, step, least):
    assert height_resolution(np.round(rng.uniform(0, 40, 50_000) / step) * step) == pytest.approx(least)
