"""Features of shapes whose features are known, and what must not change them."""

import numpy as np
import pytest

from lidar_buildings.algorithms.features.features import _FEATURES, compute_features
from lidar_buildings.algorithms.stage import Monitor


def named(xyz, **tunables):
    return dict(zip(_FEATURES, compute_features(xyz, **{"features": _FEATURES, **tunables})))


@pytest.fixture
def gable(rng):
    """A 45° roof slope, a wall and scattered points, far from each other."""
    plan = rng.uniform(0, 10, (400, 2))
    slope = np.column_stack([plan, plan[:, 0]])
    wall = np.column_stack([np.full(400, 50.0), plan])
    crown = rng.normal(0, 2, (400, 3)) + [100, 0, 0]
    return np.concatenate([slope, wall, crown])


def test_flat_square():
    made = named([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], n_neighbors=4)
    expected = {
        "linearity": 0,
        "planarity": 1,
        "scattering": 0,
        "entropy": 0,
        "omnivariance": 0,
        "anisotropy": 1,
        "eigenentropy": np.log(2),
        "eigenvalue_sum": 0.5,
        "surface_variation": 0,
        "verticality": 0,
    }
    for name, value in expected.items():
        np.testing.assert_allclose(made[name], value, atol=1e-7, err_msg=name)
    np.testing.assert_allclose(made["normal"], [[0, 0, 1]] * 4, atol=1e-7)


def test_cube_is_scattered():
    corners = np.stack(np.meshgrid([0, 2], [0, 2], [0, 2]), -1).reshape(-1, 3)
    made = named(corners, n_neighbors=8)
    np.testing.assert_allclose(made["scattering"], 1)
    np.testing.assert_allclose(made["omnivariance"], 1)  # every variance is 1 m²
    np.testing.assert_allclose(made["surface_variation"], 1 / 3)
    np.testing.assert_allclose(made["eigenentropy"], np.log(3), rtol=1e-6)


def test_slope_wall_and_crown(gable):
    made = named(gable, n_neighbors=20)
    slope, wall, crown = slice(0, 400), slice(400, 800), slice(800, 1200)
    np.testing.assert_allclose(np.abs(made["normal"][slope]), [[np.sqrt(0.5), 0, np.sqrt(0.5)]] * 400, atol=1e-6)
    np.testing.assert_allclose(made["verticality"][slope], 1 - np.sqrt(0.5), atol=1e-6)
    np.testing.assert_allclose(made["verticality"][wall], 1, atol=1e-6)
    assert made["scattering"][slope].max() < 1e-6
    assert made["scattering"][crown].mean() > 0.1


@pytest.mark.parametrize("neighborhood", ["nearest", "radius"])
def test_place_turn_and_scale_change_nothing(gable, neighborhood):
    turn = np.array([[0.6, -0.8, 0], [0.8, 0.6, 0], [0, 0, 1]])
    here = named(gable, neighborhood=neighborhood, radius=1.7, n_neighbors=15)
    there = named(3 * gable @ turn.T + [6e5, 5e6, 0], neighborhood=neighborhood, radius=5.1, n_neighbors=15)
    for name in set(_FEATURES) - {"normal", "omnivariance", "eigenvalue_sum"}:
        np.testing.assert_allclose(there[name], here[name], atol=2e-5, err_msg=name)
    np.testing.assert_allclose(there["eigenvalue_sum"], 9 * here["eigenvalue_sum"], rtol=1e-4)


def test_sums_hold(gable):
    made = named(gable, n_neighbors=10)
    np.testing.assert_allclose(made["linearity"] + made["planarity"] + made["scattering"], 1, rtol=1e-6)
    np.testing.assert_allclose(made["anisotropy"], 1 - made["scattering"], atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(made["normal"], axis=1), 1, rtol=1e-6)


def test_only_what_is_ticked_is_made(gable):
    made = named(gable, features=("verticality", "linearity"))
    assert {name for name, values in made.items() if values is not None} == {"verticality", "linearity"}
    assert made["linearity"].dtype == np.float32


def test_no_feature_is_refused(gable):
    with pytest.raises(ValueError, match="No feature is chosen; choose at least one of linearity"):
        compute_features(gable, features=())


def test_lonely_points_are_undefined_and_reported(gable):
    monitor = Monitor()
    xyz = np.concatenate([gable, [[500.0, 0, 0]]])
    made = dict(zip(_FEATURES, compute_features(xyz, neighborhood="radius", radius=20.0, monitor=monitor)))
    assert np.isnan(made["linearity"]).tolist() == [False] * 1200 + [True]
    assert monitor.warnings == ["1 of 1201 points have too few distinct neighbors: their features are undefined."]


def test_automatic_radius_is_told(rng):
    monitor = Monitor()
    flat = np.column_stack([rng.uniform(0, 40, (16_000, 2)), np.zeros(16_000)])  # 10 points per m²
    compute_features(flat, neighborhood="radius", n_neighbors=31, monitor=monitor)
    assert monitor.values["radius"] == pytest.approx(1.0, rel=0.05)
