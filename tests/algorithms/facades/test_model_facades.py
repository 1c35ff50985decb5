"""The chain from the points of a front to its polygon with windows."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.tests.facades import street_floor, wall


def test_a_front_becomes_a_polygon_with_its_windows(rng):
    """A front of 8 m by 5 m with two windows of 1.2 m by 1.5 m, whose panes are 0.15 m behind it."""
    points, panes = wall(rng, (0, 0), (8, 0), density=200), wall(rng, (0, 0.15), (8, 0.15), density=200)

    def in_window(xyz):
        x, z = xyz[:, 0] % 4, xyz[:, 2]
        return (x > 1.4) & (x < 2.6) & (z > 1.5) & (z < 3.0)

    parts = [points[~in_window(points)], panes[in_window(panes)], street_floor(rng, 0, -4, 8, -0.1)]
    xyz = np.concatenate(parts)
    outcome = run_pipeline(PIPELINES["model_facades"], create_cloud({"xyz": xyz}))
    assert len(outcome.layers["openings"]) == 2
    assert outcome.layers["openings"].columns["kind"] == ["window"] * 2
    (rings,) = outcome.layers["openings_facades"].geometries
    assert len(rings) == 3
    whole, pierced = (outcome.layers[name].columns["area"][0] for name in ("planes_facades", "openings_facades"))
    assert whole - pierced == pytest.approx(sum(outcome.layers["openings"].columns["area"]), abs=1e-6)
    assert pierced == pytest.approx(40 - 3.6, rel=0.02)
