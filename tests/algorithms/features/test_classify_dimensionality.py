"""The largest of three shares decides; a wire, a roof and a crown get different classes."""

import numpy as np

from lidar_buildings.algorithms.features.classify_dimensionality import Dimensionality, classify_dimensionality
from lidar_buildings.algorithms.features.compute_features import compute_features
from lidar_buildings.algorithms.stage import Monitor


def test_the_largest_counts_and_of_equal_ones_the_lower():
    shares = np.array(
        [[0.5, 0.3, 0.2], [0.2, 0.5, 0.3], [0.1, 0.2, 0.7], [0.4, 0.4, 0.2], [0.2, 0.4, 0.4], [1 / 3] * 3]
    )
    monitor = Monitor()
    assert classify_dimensionality(*shares.T, monitor=monitor).tolist() == [1, 2, 3, 1, 2, 1]
    assert monitor.warnings == []


def test_undefined_is_none_of_them():
    monitor = Monitor()
    found = classify_dimensionality([0.1, np.nan], [0.9, np.nan], [0.0, np.nan], monitor=monitor)
    assert found.tolist() == [Dimensionality.PLANAR, Dimensionality.UNDEFINED]
    assert monitor.warnings == ["1 of 2 points have no features, so they are left undefined (0)."]


def test_wire_roof_and_crown(rng):
    wire = np.column_stack([np.arange(0, 30, 0.1), np.zeros(300), np.full(300, 10)]) + rng.normal(0, 0.01, (300, 3))
    roof = np.column_stack([rng.uniform(50, 60, (2000, 2)), rng.normal(5, 0.02, 2000)])
    crown = rng.uniform(-2, 2, (2000, 3)) + [100, 0, 5]
    shares = compute_features(np.concatenate([wire, roof, crown]), features=("linearity", "planarity", "scattering"))
    found = classify_dimensionality(*shares[:3])
    assert (found[:300] == Dimensionality.LINEAR).all()
    # At the rims half of the neighborhood is missing.
    inside = (np.abs(roof[:, :2] - 55) < 4).all(axis=1)
    assert (found[300:2300][inside] == Dimensionality.PLANAR).mean() > 0.95
    inside = (np.abs(crown - [100, 0, 5]) < 1.2).all(axis=1)
    assert (found[2300:][inside] == Dimensionality.VOLUMETRIC).mean() > 0.95
