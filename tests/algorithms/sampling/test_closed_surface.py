"""Clouds that show one closed surface are distinguished from those whose pulses pass through crowns."""

from __future__ import annotations

import numpy as np
import pytest

from lidar_buildings.algorithms.sampling.closed_surface import seen_through_share
from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling
from lidar_buildings.tests.builders import crown


def scene(rng, is_closed):
    """Ground and a house of 8 m, seen from above with its walls, and four crowns, closed or seen through."""
    xy = rng.uniform(0, 40, (32_000, 2))
    inside = ((xy > 5) & (xy < 15)).all(axis=1)
    parts = [np.column_stack([xy, np.where(inside, 8.0, 0.0)])]
    edge = rng.uniform(5, 15, 1500)
    parts.append(np.column_stack([edge, np.full(1500, 5.0), rng.uniform(0, 8, 1500)]))
    for x, y in ((25, 25), (32, 10), (10, 30), (30, 33)):
        distance = np.hypot(*(xy - [x, y]).T)
        if is_closed:
            dome = distance < 3
            parts[0][dome, 2] = 4.0 + np.sqrt(9 - distance[dome] ** 2)
        else:
            parts.append(crown(rng, x, y, 3.0, 6.0, 1500))
    return np.concatenate(parts)


@pytest.mark.parametrize("is_closed", [True, False])
def test_crowns_decide(is_closed):
    xyz = scene(np.random.default_rng(4), is_closed)
    assert (seen_through_share(xyz, 0.22) < 0.012) == is_closed
    assert CloudSampling(lambda: xyz, single_returns=True).is_closed_surface() == is_closed


def test_colors_decide_where_points_are_fewer():
    closed, open_ = (scene(np.random.default_rng(4), is_closed)[::4] for is_closed in (True, False))
    for xyz, has_colors in ((closed, True), (closed, False), (open_, True)):
        sampling = CloudSampling(lambda xyz=xyz: xyz, single_returns=True, has_colors=has_colors)
        assert sampling.is_closed_surface() == (xyz is closed and has_colors)
    assert not CloudSampling(lambda: closed[::2], single_returns=True, has_colors=True).is_closed_surface()


def test_second_returns_and_few_points_are_of_laser_scanners():
    xyz = scene(np.random.default_rng(4), True)
    assert not CloudSampling(lambda: xyz).is_closed_surface()
    assert not CloudSampling(lambda: xyz[::5], single_returns=True).is_closed_surface()


def test_the_source_can_be_forced():
    sampling = CloudSampling(lambda: scene(np.random.default_rng(4), True), single_returns=True)
    assert not sampling.is_closed_surface("laser scanner")
    assert CloudSampling(lambda: np.zeros((1, 3))).is_closed_surface("matched images")
