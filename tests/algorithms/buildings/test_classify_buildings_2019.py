"""Equations 5 to 11 of the published method by hand and by another route, its two means and its limits."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from lidar_buildings.algorithms.buildings.classify_buildings_2019 import classify_buildings_2019, k_means, two_means
from lidar_buildings.algorithms.buildings.entropy_split import reference_entropies
from lidar_buildings.algorithms.cloud.reasons import Reason
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.tests.algorithms.buildings.parts import clusters, ones, reasons_of
from lidar_buildings.tests.builders import FAR, crown, roof
from lidar_buildings.tests.monitors import Listening


def test_entropies_by_hand():
    """Neighborhoods whose eigenvalues are plain to see: six points on the axes at +-a, +-b, +-c from nothing.

    Their covariance (divisor 6) is diagonal: a²/3, b²/3, c²/3. With squares 4, 2, 1: L = 1/2, P = 1/4, S = 1/4.
    """
    cases = {
        (2.0, np.sqrt(2), 1.0): 0.5 * np.log(2) + 2 * 0.25 * np.log(4),
        (1.0, 1.0, 1.0): 0.0,  # all scattering
        (1.0, 1.0, 0.0): 0.0,  # all planarity
        (3.0, np.sqrt(6), np.sqrt(3)): np.log(3),  # a third of each
    }
    for (a, b, c), expected in cases.items():
        axes = np.diag([a, b, c])
        xyz = np.concatenate([axes, -axes]) + [7, 8, 9]
        entropy = classify_buildings_2019(xyz, np.ones(6), np.ones(6, int), n_neighbors=6, density=1.0)[1]
        np.testing.assert_allclose(entropy, expected, atol=1e-6)


def literal_entropies(points, n_neighbors):
    """Return E_i of each point by equations 6 to 11, one point at a time, with numpy's covariance and eigenvalues."""
    tree, entropies = cKDTree(points), []
    for point in points:
        near = points[tree.query(point, k=n_neighbors)[1]]  # the point itself is the first
        covariance = np.cov(near.T, bias=True)  # N^-1 sum XX' - mm'
        third, second, first = np.linalg.eigh(covariance)[0]
        shares = np.array([first - second, second - third, max(third, 0.0)]) / first
        entropies.append(-sum(share * np.log(share) for share in shares if share > 0))
    return np.array(entropies)


@pytest.mark.parametrize("shift", [0, 1])
def test_entropies_and_cluster_means_by_another_route(garden, shift):
    xyz, cluster_id = garden
    xyz = xyz + shift * FAR
    is_clustered = np.arange(len(xyz)) % 7 != 0
    cluster_id = np.where(is_clustered, cluster_id, 0)
    _, entropy, cluster_entropy, *_ = classify_buildings_2019(xyz, ones(xyz), cluster_id, n_neighbors=24)
    # The points to find neighbors among are the clustered ones; local coordinates keep the digits.
    expected = literal_entropies((xyz - shift * FAR)[is_clustered], 24)
    np.testing.assert_allclose(entropy[is_clustered], expected, atol=2e-5)
    assert np.isnan(entropy[~is_clustered]).all()
    assert np.isnan(cluster_entropy[~is_clustered]).all()
    for number in range(1, 7):
        mean = expected[cluster_id[is_clustered] == number].mean()  # equation 5
        np.testing.assert_allclose(cluster_entropy[cluster_id == number], mean, atol=2e-5)


def test_the_result_is_that_of_the_best_split_in_two(rng):
    """Two means in one dimension: try every place to part the sorted entropies, take the least sum of squares."""
    for _ in range(12):
        parts = [roof(rng, 20 * i, 0, 6, 6, noise=rng.uniform(0.01, 0.25)) for i in range(rng.integers(1, 5))]
        parts += [crown(rng, 20 * i, 40, rng.uniform(2, 4), 7, 250) for i in range(rng.integers(1, 5))]
        xyz, cluster_id = clusters(*parts)
        monitor = Monitor()
        tunables = {"n_neighbors": 20, "monitor": monitor}
        found, _, cluster_entropy, *_ = classify_buildings_2019(xyz, ones(xyz), cluster_id, **tunables)
        means = np.array([cluster_entropy[cluster_id == number][0] for number in range(1, len(parts) + 1)], float)
        ordered = np.sort(means)
        squares = [ordered[:k].var() * k + ordered[k:].var() * (len(ordered) - k) for k in range(1, len(ordered))]
        lower = int(np.argmin(squares)) + 1
        expected = means <= ordered[lower - 1]
        np.testing.assert_array_equal(found == 6, expected[cluster_id - 1])
        assert monitor.values["building_entropy"] == pytest.approx(ordered[:lower].mean(), abs=1e-5)
        assert monitor.values["other_entropy"] == pytest.approx(ordered[lower:].mean(), abs=1e-5)


@pytest.mark.parametrize(("min_area", "density", "expected"), [(4.0, 12.5, 50), (4.0, 4.0, 16), (0.1, 2.0, 3)])
def test_neighbors_are_area_times_density(garden, min_area, density, expected):
    """The paper's 50 and 16; never fewer than three, which a covariance needs."""
    monitor = Monitor()
    xyz, cluster_id = garden
    by_density = classify_buildings_2019(
        xyz, ones(xyz), cluster_id, min_area=min_area, density=density, monitor=monitor
    )
    assert monitor.values["n_neighbors"] == expected
    by_hand = classify_buildings_2019(xyz, ones(xyz), cluster_id, n_neighbors=expected)
    np.testing.assert_array_equal(by_density[1], by_hand[1])


@pytest.mark.parametrize(("thresholds", "expected"), [("12.5 points/m² (table 2)", 50), ("4 points/m² (table 2)", 16)])
def test_neighbors_of_the_papers_surveys(garden, thresholds, expected):
    xyz, cluster_id = garden
    monitor = Monitor()
    classify_buildings_2019(xyz, ones(xyz), cluster_id, thresholds=thresholds, monitor=monitor)
    assert monitor.values["n_neighbors"] == expected


def test_reasons_of_the_published_method(garden):
    reasons, _, report = reasons_of(classify_buildings_2019, *garden)
    assert reasons == [Reason.PLANE] * 3 + [Reason.ROUGH] * 3
    assert "low entropy, typical of planes" in report.html
    assert "Share of the beam" not in report.html


@pytest.mark.parametrize("copies", [2, 5])
def test_clusters_that_are_all_alike_are_said_to_be(rng, copies):
    one = crown(rng, 0, 0)
    xyz, cluster_id = clusters(*[one + [50.0 * i, 0, 0] for i in range(copies)])
    monitor = Monitor()
    found = classify_buildings_2019(xyz, ones(xyz), cluster_id, monitor=monitor)[0]
    assert not (found == 6).any()
    assert len(monitor.warnings) == 1
    assert "only clusters of the same entropy" in monitor.warnings[0]
    assert not (classify_buildings_2019(xyz, ones(xyz), cluster_id)[0] == 6).any()


def test_scale_changes_nothing(garden):
    """Entropy has no unit: a scene twice as large has the same."""
    xyz, cluster_id = garden
    small = classify_buildings_2019(xyz, ones(xyz), cluster_id, n_neighbors=24)
    large = classify_buildings_2019(xyz * 2, ones(xyz), cluster_id, n_neighbors=24)
    np.testing.assert_allclose(large[1], small[1], atol=1e-6)
    np.testing.assert_array_equal(large[0], small[0])


def test_other_points_keep_their_class_and_old_buildings_do_not(garden):
    xyz, cluster_id = garden
    classification = np.resize([1, 2, 6, 9, 17, 5], len(xyz)).astype(np.uint8)
    cluster_id = np.where(np.arange(len(xyz)) % 2, cluster_id, 0)
    found = classify_buildings_2019(xyz, classification, cluster_id)[0]
    is_building = (cluster_id > 0) & (cluster_id <= 3)
    assert (found[is_building] == 6).all()
    expected = np.where(classification == 6, 1, classification)
    np.testing.assert_array_equal(found[~is_building], expected[~is_building])


def test_without_clusters_nothing_is_found_and_the_log_says_so(rng):
    xyz = roof(rng, 0, 0)
    monitor = Monitor()
    found, *measures, reason, _, report = classify_buildings_2019(
        xyz, np.full(len(xyz), 6), np.zeros(len(xyz), int), monitor=monitor
    )
    assert (found == 1).all()
    assert all(np.isnan(measure).all() for measure in measures)
    assert (reason == Reason.NOT_LOOKED_AT).all()
    assert (report.values["clusters"], report.values["building_clusters"]) == (0, 0)
    assert "0 of 0 clusters of points are called building. A cluster is often one surface of a roof" in report.html
    assert monitor.warnings == ["There are no clusters, so no buildings were found."]


@pytest.mark.parametrize("count", [1, 2, 9])
def test_clusters_without_extent_have_no_entropy_and_are_no_building(count):
    xyz = np.concatenate([np.zeros((count, 3)), [[5.0, 5, 0]]])
    cluster_id = np.append(np.ones(count, int), 0)
    found, entropy, _, confidence, *_ = classify_buildings_2019(xyz, ones(xyz), cluster_id)
    assert not (found == 6).any()
    assert np.isnan(entropy).all()
    assert np.isnan(confidence[-1])


def test_a_lone_tree_is_never_a_building(rng):
    xyz, cluster_id = clusters(crown(rng, 0, 0))
    assert not (classify_buildings_2019(xyz, ones(xyz), cluster_id)[0] == 6).any()


def test_what_was_said_of_points_outside_clusters_stays(garden):
    xyz, cluster_id = garden
    cluster_id = np.where(cluster_id == 2, 0, cluster_id)
    said = np.full(len(xyz), Reason.INTO_GROUND, np.uint8)
    reason = classify_buildings_2019(xyz, ones(xyz), cluster_id, said)[4]
    np.testing.assert_array_equal(reason == Reason.INTO_GROUND, cluster_id == 0)


def test_order_position_and_numbers_change_nothing(garden, rng):
    xyz, cluster_id = garden
    found, entropy, cluster_entropy, confidence, *_ = classify_buildings_2019(
        xyz, ones(xyz), cluster_id, n_neighbors=24
    )
    order = rng.permutation(len(xyz))
    for place in (0, FAR):
        other = classify_buildings_2019(xyz[order] + place, ones(xyz), 7 - cluster_id[order], n_neighbors=24)
        np.testing.assert_array_equal(other[0], found[order])
        np.testing.assert_allclose(other[1], entropy[order], atol=1e-5)
        np.testing.assert_allclose(other[2], cluster_entropy[order], atol=1e-5)
        np.testing.assert_allclose(other[3], confidence[order], atol=1e-4)


def test_the_report_shows_means_and_counts(garden):
    monitor = Monitor()
    report = classify_buildings_2019(*garden[:1], ones(garden[0]), garden[1], monitor=monitor)[-1]
    assert report.values == {
        "clusters": 6,
        "building_clusters": 3,
        "undecided_clusters": 0,
        "building_entropy": monitor.values["building_entropy"],
        "other_entropy": monitor.values["other_entropy"],
    }
    assert f"buildings: {report.values['building_entropy']:.3g}" in report.html
    assert f"everything else: {report.values['other_entropy']:.3g}" in report.html
    assert "The two means of their entropies decided" in report.html


def test_the_smaller_a_roof_the_less_sure(rng):
    """Confidence of a plane of n smallest buildings' points: half, and n² / (n² + 4) of the rest."""
    sizes = [2, 4, 8, 16]
    parts = [roof(rng, 30 * i, 0, side, side, noise=0.01) for i, side in enumerate(sizes)]
    parts += [crown(rng, 20 * i, 60) for i in range(4)]
    xyz, cluster_id = clusters(*parts)
    _, confidence, _ = reasons_of(classify_buildings_2019, xyz, cluster_id, density=6.0, n_neighbors=16)
    assert (np.diff(confidence[:4]) > 0).all()
    for side, sure in zip(sizes, confidence):
        n = side**2 / 4
        assert sure == pytest.approx(0.5 + 0.5 * n**2 / (n**2 + 4), abs=0.02)
    assert (confidence[4:] < 0.5).all()


def test_entropies_of_planes_and_volumes_are_those_of_large_samples(rng):
    plane, volume = reference_entropies(40)
    assert reference_entropies(40) == (plane, volume)
    cube = rng.uniform(-1, 1, (4000, 3))
    disk = cube[np.hypot(cube[:, 0], cube[:, 1]) < 1] * [1, 1, 0]
    ball = cube[np.linalg.norm(cube, axis=1) < 1]
    rough = disk + np.array([0, 0, 0.3]) * rng.normal(size=disk.shape)
    for points, expected in ((disk, plane), (ball, volume), (rough, reference_entropies(40, 0.3)[0])):
        drawn = [literal_entropies(rng.permutation(points)[:40], 40)[0] for _ in range(100)]
        assert expected == pytest.approx(np.mean(drawn), abs=4 * np.std(drawn) / 10)


def test_roofs_are_buildings_and_crowns_are_not(garden):
    xyz, cluster_id = garden
    found, _, _, confidence, *_ = classify_buildings_2019(xyz, ones(xyz), cluster_id)
    np.testing.assert_array_equal(found == 6, cluster_id <= 3)
    assert found.dtype == np.uint8
    assert (confidence[cluster_id <= 3] > 0.8).all()
    assert (confidence[cluster_id > 3] < 0.2).all()


def test_a_lone_flat_roof_is_undecided(rng):
    xyz, cluster_id = clusters(roof(rng, 0, 0))
    monitor = Monitor()
    found, _, _, confidence, *_ = classify_buildings_2019(xyz, ones(xyz), cluster_id, monitor=monitor)
    assert not (found == 6).any()
    assert (confidence == 0.5).all()
    assert monitor.warnings == ["There is only one cluster: nothing to separate, so nothing was called a building."]


def test_reasons_of_what_is_undecided(rng):
    one = crown(rng, 0, 0)
    scene = clusters(one, one + [50.0, 0, 0])
    reasons, confidence, report = reasons_of(classify_buildings_2019, *scene)
    assert reasons == [Reason.ALIKE] * 2
    assert (confidence == 0.5).all()
    assert report.values["undecided_clusters"] == 2
    three = clusters(one, roof(rng, 30, 30), np.full((30, 3), 90.0))
    reasons, confidence, _ = reasons_of(classify_buildings_2019, *three, n_neighbors=24)
    assert reasons[2] == Reason.WITHOUT_ENTROPY
    assert confidence[2] == 0.5


def test_cancel_gets_through(garden):
    xyz, cluster_id = garden
    with pytest.raises(Cancelled):
        classify_buildings_2019(xyz, ones(xyz), cluster_id, monitor=Listening(0.0))


@pytest.mark.parametrize("seed", range(4))
def test_k_means_finds_the_exact_split(seed):
    """Of scikit-learn, on groups of other sizes and overlaps; it may end near the optimum, but not here."""
    random = np.random.default_rng(seed)
    means = np.concatenate([random.normal(0.6, 0.05, 30 + 20 * seed), random.normal(0.9, 0.04, 60), [np.nan]])
    exact, found = two_means(means, Monitor()), k_means(means, Monitor())
    assert (found.building, found.other) == pytest.approx((exact.building, exact.other), abs=1e-9)


def test_two_classes_by_k_means_are_those_by_sorting(garden):
    xyz, cluster_id = garden
    given = {"n_neighbors": 24, "density": 6.0}
    exact = classify_buildings_2019(xyz, ones(xyz), cluster_id, **given)
    found = classify_buildings_2019(xyz, ones(xyz), cluster_id, two_classes="k-means", **given)
    np.testing.assert_array_equal(found[0], exact[0])
    assert (found[0] == 6).any()


def test_k_means_of_a_single_cluster_calls_nothing_a_building():
    monitor = Monitor()
    assert not k_means(np.array([0.7, np.nan]), monitor).separates
    assert monitor.warnings == ["There is only one cluster: nothing to separate, so nothing was called a building."]
