"""Features of shapes whose features are known, and what must not change them."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from lidar_buildings.algorithms.features.compute_features import _FEATURES, compute_features
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
        "height_range": 0,
        "height_deviation": 0,
        "plan_radius": np.sqrt(2),
        "plan_density": 4 / (2 * np.pi),
        "plan_eigenvalue_ratio": 1,
        "optimal_neighbors": 4,
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


@pytest.mark.parametrize("neighborhood", ["nearest", "radius", "optimal"])
def test_position_turn_and_scale_change_nothing(gable, neighborhood):
    turn = np.array([[0.6, -0.8, 0], [0.8, 0.6, 0], [0, 0, 1]])
    original = named(gable, neighborhood=neighborhood, radius=1.7, n_neighbors=15)
    moved = named(3 * gable @ turn.T + [6e5, 5e6, 0], neighborhood=neighborhood, radius=5.1, n_neighbors=15)
    factors = {"eigenvalue_sum": 9, "height_range": 3, "height_deviation": 3, "plan_radius": 3}
    for name in set(_FEATURES) - {"normal", "omnivariance", "plan_density"}:
        expected = factors.get(name, 1) * original[name]
        np.testing.assert_allclose(moved[name], expected, rtol=1e-4, atol=2e-5, err_msg=name)
    np.testing.assert_allclose(9 * moved["plan_density"], original["plan_density"], rtol=1e-4)


@pytest.mark.parametrize("neighborhood", ["nearest", "radius", "optimal"])
def test_features_are_those_of_brute_force(gable, neighborhood):
    """Whatever the neighborhood, its features are its points'; the count says which they are."""
    made = named(gable, neighborhood=neighborhood, radius=1.5, n_neighbors=15, max_neighbors=40)
    counts = made["optimal_neighbors"]
    assert (counts == 15).all() if neighborhood == "nearest" else len(np.unique(counts)) > 10
    for i in (0, 17, 399, 400, 555, 801, 1100):
        offsets = gable - gable[i]
        near = offsets[np.argsort((offsets**2).sum(axis=1))[: counts[i]]]
        if len(near) < 3:
            assert np.isnan(made["height_range"][i])
            continue
        low, high = np.linalg.eigvalsh(np.cov(near[:, :2].T, bias=True))
        reach = np.hypot(near[:, 0], near[:, 1]).max()
        expected = {
            "height_range": np.ptp(near[:, 2]),
            "height_deviation": near[:, 2].std(),
            "plan_radius": reach,
            "plan_density": len(near) / (np.pi * reach**2),
            "plan_eigenvalue_ratio": low / high,
            "eigenvalue_sum": near.var(axis=0).sum(),
        }
        for name, value in expected.items():
            assert made[name][i] == pytest.approx(value, rel=1e-5, abs=1e-7), name


def test_a_plumb_line_has_no_plan():
    made = named(np.arange(30)[:, None] * [0, 0, 0.1] + [6e5, 5e6, 0], n_neighbors=9)
    for name in ("plan_radius", "plan_density", "plan_eigenvalue_ratio"):
        assert np.isnan(made[name]).all(), name
    np.testing.assert_allclose(made["linearity"], 1)
    np.testing.assert_allclose(made["height_range"][4:-4], 0.8, rtol=1e-5)


def test_what_jakteristics_says(gable):
    """It divides by n - 1, calls two points defined, and its normals may look down."""
    jakteristics = pytest.importorskip("jakteristics")
    same = ("linearity", "planarity", "anisotropy", "surface_variation", "verticality")
    theirs_of = {
        **{name: name for name in same},
        "scattering": "sphericity",
        "optimal_neighbors": "number_of_neighbors",
    }
    asked = [*theirs_of.values(), "eigenvalue_sum", "omnivariance", "nx", "ny", "nz"]
    theirs = dict(zip(asked, jakteristics.compute_features(gable, 2.0, feature_names=asked).T))
    made = named(gable, neighborhood="radius", radius=2.0)
    several = made["optimal_neighbors"] > 2
    made, theirs = ({name: values[several] for name, values in both.items()} for both in (made, theirs))
    for name, other in theirs_of.items():
        np.testing.assert_allclose(made[name], theirs[other], atol=1e-5, err_msg=name)
    count = made["optimal_neighbors"]
    for name in ("eigenvalue_sum", "omnivariance"):
        np.testing.assert_allclose(made[name], theirs[name] * (count - 1) / count, rtol=1e-4, atol=2e-5, err_msg=name)
    normal = np.column_stack([theirs[name] for name in ("nx", "ny", "nz")])
    along = np.abs((normal * made["normal"]).sum(axis=1))
    np.testing.assert_allclose(along[made["planarity"] > 0.1], 1, atol=1e-4)


def test_what_pgeof_says(gable):
    """It takes square roots of the eigenvalues, adds a millimeter to divisors, and has zero for undefined."""
    pgeof = pytest.importorskip("pgeof")
    neighbors = cKDTree(gable).query(gable, k=20)[1].astype(np.uint32)
    starts = np.arange(len(gable) + 1, dtype=np.uint32) * 20
    theirs = pgeof.compute_features(gable.astype(np.float32), neighbors.ravel(), starts)
    made = named(gable, n_neighbors=20)
    linearity, planarity, scattering = (theirs[:, :3] * (theirs[:, 7:8] + 1e-3) / theirs[:, 7:8]).T
    np.testing.assert_allclose(made["scattering"], scattering**2, atol=1e-5)
    np.testing.assert_allclose(made["linearity"], 1 - (1 - linearity) ** 2, atol=1e-5)
    np.testing.assert_allclose(made["planarity"], (planarity + scattering) ** 2 - scattering**2, atol=1e-5)
    np.testing.assert_allclose(made["verticality"], 1 - np.abs(theirs[:, 6]), atol=1e-4)
    np.testing.assert_allclose(np.abs((made["normal"] * theirs[:, 4:7]).sum(axis=1)), 1, atol=1e-4)
    np.testing.assert_allclose(made["omnivariance"][800:], theirs[800:, 9] ** 2, atol=1e-4)


def test_sums_hold(gable):
    made = named(gable, n_neighbors=10)
    np.testing.assert_allclose(made["linearity"] + made["planarity"] + made["scattering"], 1, rtol=1e-6)
    np.testing.assert_allclose(made["anisotropy"], 1 - made["scattering"], atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(made["normal"], axis=1), 1, rtol=1e-6)


def test_only_what_is_ticked_is_made(gable):
    made = named(gable, features=("verticality", "linearity"))
    assert {name for name, values in made.items() if values is not None} == {"verticality", "linearity"}
    assert made["linearity"].dtype == np.float32


def test_the_count_alone_is_reported_everywhere(gable):
    xyz = np.concatenate([gable, [[500.0, 0, 0]]])
    monitor = Monitor()
    made = named(xyz, features=("optimal_neighbors",), neighborhood="radius", radius=20.0, monitor=monitor)
    assert made["optimal_neighbors"][-1] == 1
    assert made["optimal_neighbors"].dtype == np.int32
    assert len(monitor.warnings) == 1


@pytest.mark.parametrize(
    ("neighborhood", "reported"),
    [({"n_neighbors": 6}, [6]), ({"n_neighbors": 5}, []), ({"neighborhood": "optimal"}, [10])],
)
def test_a_cloud_smaller_than_its_neighborhoods_is_reported(neighborhood, reported):
    monitor = Monitor()
    points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1]]
    compute_features(points, features=("planarity",), monitor=monitor, **neighborhood)
    assert monitor.warnings == [
        f"The cloud has fewer points (5) than a neighborhood asks for ({wanted}): all points have the features of the "
        "whole cloud."
        for wanted in reported
    ]


def test_fewest_more_than_most_is_one_sentence(gable):
    with pytest.raises(
        ValueError, match=r"minimum of nearest points \(30\) is above the maximum \(20\); exchange the two\.$"
    ):
        compute_features(gable, neighborhood="optimal", min_neighbors=30, max_neighbors=20)
    compute_features(gable, min_neighbors=30, max_neighbors=20)  # of no interest where they are not used


def test_no_feature_is_refused(gable):
    with pytest.raises(ValueError, match="No feature is chosen; choose at least one of linearity"):
        compute_features(gable, features=())


def test_lonely_points_are_undefined_and_reported(gable):
    monitor = Monitor()
    xyz = np.concatenate([gable, [[500.0, 0, 0]]])
    made = dict(zip(_FEATURES, compute_features(xyz, neighborhood="radius", radius=20.0, monitor=monitor)))
    assert np.isnan(made["linearity"]).tolist() == [False] * 1200 + [True]
    assert monitor.warnings == ["1 of 1201 points have too few distinct neighbors: their features are undefined."]


def test_automatic_radius_is_reported(rng):
    monitor = Monitor()
    flat = np.column_stack([rng.uniform(0, 40, (16_000, 2)), np.zeros(16_000)])  # 10 points per m²
    compute_features(flat, neighborhood="radius", n_neighbors=31, monitor=monitor)
    assert monitor.values["radius"] == pytest.approx(1.0, rel=0.05)
