"""Facades and outlines as segments in plan."""

import tracemalloc

import numpy as np
import pytest

from lidar_buildings.algorithms.facades.plan_segments import facade_segments
from lidar_buildings.algorithms.stage import LayerFeatures


def facade(count, rng):
    """Return a facade 20 m by 10 m with ends that scatter by 5 cm, by a boundary of so many points on each side."""
    up = np.sort(rng.uniform(0, 10, count))
    sides = [np.column_stack([x + rng.normal(0, 0.05, count), np.zeros(count), up]) for x in (0, 20)]
    ring = np.concatenate([sides[1], sides[0][::-1]])
    return LayerFeatures([[np.concatenate([ring, ring[:1]])]], {})


@pytest.mark.parametrize("count", [40, 6000])
def test_a_wall_ends_where_it_does_over_most_of_its_height(count, rng):
    """By the 12,000 points of a dense scan, too: all their heights with all their edges would take gigabytes."""
    features = facade(count, rng)
    tracemalloc.start()
    found = facade_segments(features)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    np.testing.assert_allclose(np.sort([found.start[0, 0], found.end[0, 0]]), [0, 20], atol=0.04)
    assert most < 500e6
