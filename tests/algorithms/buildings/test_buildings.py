"""Equations 5 to 11 of the published method by hand and by another route, its two means, its guard and its limits."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from lidar_buildings.algorithms.buildings.buildings import classify_buildings, reference_entropies
from lidar_buildings.algorithms.buildings.reasons import Reason
from lidar_buildings.algorithms.cloud.density import even_density, point_density
from lidar_buildings.algorithms.features.noise import SurfaceSample
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.tests.monitors import Listening

FAR = np.array([600_000.0, 5_000_000.0, 0.0])


def roof(rng, west, south, width=10.0, depth=8.0, elevation=6.0, density=6.0, noise=0.02):
    plan = rng.uniform([west, south], [west + width, south + depth], (int(width * depth * density), 2))
    return np.column_stack([plan, elevation + rng.normal(0, noise, len(plan))])


def crown(rng, x, y, radius=3.0, middle=7.0, count=400):
    direction = rng.normal(size=(count, 3))
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    return direction * radius * rng.random((count, 1)) ** (1 / 3) + [x, y, middle]


def clusters(*parts):
    return np.concatenate(parts), np.repeat(np.arange(1, len(parts) + 1), [len(part) for part in parts])


def ones(values):
    return np.ones(len(values), np.uint8)


@pytest.fixture
def garden(rng):
    """Three roofs and three crowns: clusters 1 to 6."""
    roofs = [roof(rng, 0, 0), roof(rng, 20, 0, 6, 6, 4), roof(rng, 40, 0, 20, 10, 9)]
    crowns = [crown(rng, 5, 30), crown(rng, 25, 30, 4, 9, 900), crown(rng, 45, 30, 2.5, 5, 250)]
    return clusters(*roofs, *crowns)


# --- the equations ---------------------------------------------------------------------------------------------------


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
        entropy = classify_buildings(xyz, np.ones(6), np.ones(6, int), n_neighbors=6, density=1.0)[1]
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
    _, entropy, cluster_entropy, *_ = classify_buildings(xyz, ones(xyz), cluster_id, n_neighbors=24)
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
        tunables = {"guard": False, "n_neighbors": 20, "monitor": monitor}
        found, _, cluster_entropy, *_ = classify_buildings(xyz, ones(xyz), cluster_id, **tunables)
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
    by_density = classify_buildings(xyz, ones(xyz), cluster_id, min_area=min_area, density=density, monitor=monitor)
    assert monitor.values["n_neighbors"] == expected
    by_hand = classify_buildings(xyz, ones(xyz), cluster_id, n_neighbors=expected)
    np.testing.assert_array_equal(by_density[1], by_hand[1])


@pytest.mark.parametrize(("neighborhood", "density"), [("published", point_density), ("surface", even_density)])
def test_gaps_between_scan_lines_count_for_surfaces_and_not_as_published(neighborhood, density, rng):
    """On lines 2 m apart points are dense where they lie, which the paper's N = Ar_min d goes by."""
    xyz, cluster_id = clusters(roof(rng, 0, 0, 30, 30, 0.0, 8), roof(rng, 10, 10))
    xyz[:, 1] = 2 * np.round(xyz[:, 1] / 2)
    monitor = Monitor()
    classify_buildings(xyz, ones(xyz), cluster_id - 1, neighborhood=neighborhood, monitor=monitor)
    assert monitor.values["density"] == density(xyz)
    assert even_density(xyz) < 0.6 * point_density(xyz)


@pytest.mark.parametrize(("gap", "expected"), [(0.4, 12), (2.0, 14)])
def test_entropies_of_surfaces_need_half_as_many_points_again_as_planes_and_more_on_lines(gap, expected, rng):
    """Precise and sparse points need 8 for a plane: on a grid 12, on lines with a point every 40 cm 14."""
    x, y = np.meshgrid(np.arange(0, 30, 0.4), np.arange(0, 30, gap))
    xyz = np.column_stack([x.ravel(), y.ravel(), rng.normal(0, 0.01, x.size)])
    monitor = Monitor()
    classify_buildings(xyz, ones(xyz), ones(xyz), neighborhood="surface", density=5.0, monitor=monitor)
    assert monitor.values["n_neighbors"] == expected


# --- what is found ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("guard", [True, False])
def test_roofs_are_buildings_and_crowns_are_not(garden, guard):
    xyz, cluster_id = garden
    found, _, _, confidence, *_ = classify_buildings(xyz, ones(xyz), cluster_id, guard=guard)
    np.testing.assert_array_equal(found == 6, cluster_id <= 3)
    assert found.dtype == np.uint8
    assert (confidence[cluster_id <= 3] > 0.8).all()
    assert (confidence[cluster_id > 3] < 0.2).all()
    assert confidence.min() >= 0
    assert confidence.max() <= 1


def test_where_both_kinds_are_there_the_guard_decides_the_same(garden):
    xyz, cluster_id = garden
    guarded = classify_buildings(xyz, ones(xyz), cluster_id, n_neighbors=24)
    published = classify_buildings(xyz, ones(xyz), cluster_id, n_neighbors=24, guard=False)
    for one, other in zip(guarded[:3], published[:3]):
        np.testing.assert_array_equal(one, other)


def test_other_points_keep_their_class_and_old_buildings_do_not(garden):
    xyz, cluster_id = garden
    classification = np.resize([1, 2, 6, 9, 17, 5], len(xyz)).astype(np.uint8)
    cluster_id = np.where(np.arange(len(xyz)) % 2, cluster_id, 0)
    found = classify_buildings(xyz, classification, cluster_id)[0]
    is_building = (cluster_id > 0) & (cluster_id <= 3)
    assert (found[is_building] == 6).all()
    expected = np.where(classification == 6, 1, classification)
    np.testing.assert_array_equal(found[~is_building], expected[~is_building])


def test_cluster_numbers_may_have_gaps(garden):
    xyz, cluster_id = garden
    numbers = np.array([0, 900, 7, 31, 2, 100_000, 15])[cluster_id]
    for tunables in ({}, {"max_penetration": 0.4, "min_share_around": 0.4}):
        expected = classify_buildings(xyz, ones(xyz), cluster_id, **tunables)
        for one, other in zip(classify_buildings(xyz, ones(xyz), numbers, **tunables), expected):
            np.testing.assert_array_equal(one, other)


# --- one kind only ---------------------------------------------------------------------------------------------------


def test_a_lone_flat_roof_is_found_by_the_guard_only(rng):
    xyz, cluster_id = clusters(roof(rng, 0, 0))
    monitor = Monitor()
    assert (classify_buildings(xyz, ones(xyz), cluster_id, monitor=monitor)[0] == 6).all()
    assert "compared with the entropy of planes" in monitor.warnings[0]

    monitor = Monitor()
    found, _, _, confidence, *_ = classify_buildings(xyz, ones(xyz), cluster_id, guard=False, monitor=monitor)
    assert not (found == 6).any()
    assert (confidence == 0.5).all()
    assert monitor.warnings == ["There is only one cluster: nothing to separate, so nothing was called a building."]


@pytest.mark.parametrize("guard", [True, False])
def test_a_lone_tree_is_never_a_building(rng, guard):
    xyz, cluster_id = clusters(crown(rng, 0, 0))
    assert not (classify_buildings(xyz, ones(xyz), cluster_id, guard=guard)[0] == 6).any()


def test_a_town_without_trees_keeps_all_its_roofs_and_a_forest_gets_none(rng):
    """K-means would part each in two; that is what the guard is for."""
    town = clusters(*[roof(rng, 20 * i, 0, noise=0.01 + 0.01 * i) for i in range(6)])
    forest = clusters(*[crown(rng, 20 * i, 0, 2 + 0.4 * i) for i in range(6)])
    for (xyz, cluster_id), expected in ((town, True), (forest, False)):
        guarded = classify_buildings(xyz, ones(xyz), cluster_id)[0] == 6
        assert (guarded == expected).all()
        published = classify_buildings(xyz, ones(xyz), cluster_id, guard=False)[0] == 6
        assert 0 < published.mean() < 1


@pytest.mark.parametrize("copies", [3, 60])
def test_the_guard_counts_as_a_hundred_clusters(rng, copies):
    """Of m clusters of mean entropy e, and planes as rough of entropy p, the mean is (m e + 100 p)/(m + 100)."""
    xyz, cluster_id = clusters(*[roof(rng, 30.0 * i, 0, 5, 5, density=12, noise=0.05) for i in range(copies)])
    monitor = Monitor()
    means = classify_buildings(xyz, ones(xyz), cluster_id, n_neighbors=24, density=12.0, monitor=monitor)[2]
    measured = np.mean([means[cluster_id == i][0] for i in range(1, copies + 1)])
    plane, volume = reference_entropies(24, SurfaceSample(xyz).roughness(12.0) / np.sqrt(24 / (12 * np.pi)))
    expected = (copies * measured + 100 * plane) / (copies + 100)
    assert monitor.values["building_entropy"] == pytest.approx(expected, abs=1e-6)
    assert monitor.values["other_entropy"] == volume


@pytest.mark.parametrize("copies", [2, 5])
def test_clusters_that_are_all_alike_are_said_to_be(rng, copies):
    one = crown(rng, 0, 0)
    xyz, cluster_id = clusters(*[one + [50.0 * i, 0, 0] for i in range(copies)])
    monitor = Monitor()
    found = classify_buildings(xyz, ones(xyz), cluster_id, guard=False, monitor=monitor)[0]
    assert not (found == 6).any()
    assert len(monitor.warnings) == 1
    assert "only clusters of the same entropy" in monitor.warnings[0]
    assert not (classify_buildings(xyz, ones(xyz), cluster_id)[0] == 6).any()


def test_without_clusters_nothing_is_found_and_the_log_says_so(rng):
    xyz = roof(rng, 0, 0)
    monitor = Monitor()
    found, *measures, reason, report = classify_buildings(
        xyz, np.full(len(xyz), 6), np.zeros(len(xyz), int), monitor=monitor
    )
    assert (found == 1).all()
    assert all(np.isnan(measure).all() for measure in measures)
    assert (reason == Reason.NOT_LOOKED_AT).all()
    assert (report.values["clusters"], report.values["building_clusters"]) == (0, 0)
    assert "0 of 0 clusters of points are called building. A cluster is often one surface of a roof" in report.html
    assert monitor.warnings == ["There are no clusters, so no buildings were found."]


@pytest.mark.parametrize("guard", [True, False])
@pytest.mark.parametrize("count", [1, 2, 9])
def test_clusters_without_extent_have_no_entropy_and_are_no_building(count, guard):
    xyz = np.concatenate([np.zeros((count, 3)), [[5.0, 5, 0]]])
    cluster_id = np.append(np.ones(count, int), 0)
    found, entropy, _, confidence, *_ = classify_buildings(xyz, ones(xyz), cluster_id, guard=guard)
    assert not (found == 6).any()
    assert np.isnan(entropy).all()
    assert np.isnan(confidence[-1])


# --- penetration -----------------------------------------------------------------------------------------------------


def test_a_planar_cluster_with_ground_beneath_is_no_building(rng):
    """A spot of a crown as flat as a roof: its entropy says building, the points beneath it say leaves."""
    solid, canopy = roof(rng, 0, 0, 12, 12), roof(rng, 30, 0, 5, 5)
    ground = roof(rng, 30, 0, 5, 5, elevation=0.0)
    xyz, part = clusters(solid, canopy, crown(rng, 20, 40), ground)
    cluster_id = np.where(part == 4, 0, part)
    published = classify_buildings(xyz, ones(xyz), cluster_id)[0]
    assert (published[cluster_id == 2] == 6).all()
    found, _, _, confidence, *_ = classify_buildings(xyz, ones(xyz), cluster_id, max_penetration=0.4)
    assert (found[cluster_id == 1] == 6).all()
    assert not (found[cluster_id > 1] == 6).any()
    assert (confidence[cluster_id == 2] <= 0.5).all()


def test_returns_that_are_not_the_last_tell_penetration_too(rng):
    """The same points, once returned in one piece and once the first of two."""
    xyz, cluster_id = clusters(roof(rng, 0, 0, 12, 12), roof(rng, 30, 0, 5, 5), crown(rng, 20, 40))
    single, several = np.ones(len(xyz), int), np.where(cluster_id == 2, 2, 1)
    tunables = {"max_penetration": 0.4, "n_neighbors": 12}
    for of_pulse, expected in ((single, True), (several, False)):
        found = classify_buildings(xyz, ones(xyz), cluster_id, single, of_pulse, **tunables)[0]
        assert (found[cluster_id == 1] == 6).all()
        assert (found[cluster_id == 2] == 6).all() == expected


@pytest.mark.parametrize("density", [4.0, 12.0, 40.0, 80.0])
@pytest.mark.parametrize("is_numbered", [True, False])
def test_a_roof_of_glass_is_a_building_at_any_density(rng, density, is_numbered):
    """Half of the beam passes. Of wires in a plane more does, and spots of crowns are smaller."""
    glass, floor = (roof(rng, 0, 0, 12, 10, z, 0.5 * density) for z in (5, 0))
    spot, leaves = (roof(rng, 0, 30, 5, 5, z, 0.5 * density) for z in (5, 3))
    wires, field = roof(rng, 30, 0, 4, 20, 9, 0.1 * density), roof(rng, 30, 0, 4, 20, 0, 0.9 * density)
    crowns = [crown(rng, 50, y, count=round(30 * density)) for y in (0, 10, 20)]
    xyz, part = clusters(glass, spot, wires, *crowns, floor, leaves, field)
    cluster_id = np.where(part > 6, 0, part)
    # Of pulses that come back from above half go on.
    first_of_two = np.where((cluster_id > 0) & (rng.random(len(xyz)) < 0.5), 1, 2)
    returns = (first_of_two, np.full(len(xyz), 2)) if is_numbered else ()
    tunables = {"max_penetration": 0.4, "neighborhood": "surface", "density": density}
    reasons, confidence, _ = reasons_of(xyz, cluster_id, *returns, **tunables)
    assert reasons == [Reason.LARGE_PLANE, Reason.PENETRATED, Reason.PENETRATED] + [Reason.ROUGH] * 3
    assert confidence[0] > 0.6


# --- reasons and confidence ------------------------------------------------------------------------------------------


def reasons_of(xyz, cluster_id, *more, **tunables):
    """Return the reason and the confidence of each cluster, and whether it is a building, by its number from 1."""
    found, _, _, confidence, reason, report = classify_buildings(xyz, ones(xyz), cluster_id, *more, **tunables)
    firsts = [np.flatnonzero(cluster_id == number)[0] for number in range(1, cluster_id.max() + 1)]
    for number, first in enumerate(firsts, start=1):
        assert len(np.unique(reason[cluster_id == number])) == 1
        assert len(np.unique(confidence[cluster_id == number])) == 1
        assert Reason(reason[first]).is_building == (found[first] == 6)
    assert (reason[cluster_id == 0] == Reason.NOT_LOOKED_AT).all()
    return [Reason(number) for number in reason[firsts]], confidence[firsts], report


def test_reasons_of_the_published_method(garden):
    reasons, _, report = reasons_of(*garden)
    assert reasons == [Reason.PLANE] * 3 + [Reason.ROUGH] * 3
    assert "low entropy, as planes have" in report.html
    assert "Share of the beam" not in report.html


def test_reasons_with_penetration(rng):
    """A roof, a canopy as flat as a roof, a crown, and a rough thing that nothing passes through."""
    ground = roof(rng, 30, 0, 5, 5, elevation=0.0)
    crowns = [crown(rng, 20, 40), crown(rng, 40, 40), crown(rng, 60, 40)]
    under = np.column_stack([rng.uniform([10, 30], [70, 50], (6000, 2)), np.zeros(6000)])
    rubble = roof(rng, 80, 0, 12, 12, noise=0.2)
    parts = [roof(rng, 0, 0, 12, 12), roof(rng, 30, 0, 5, 5), rubble, *crowns, ground, under]
    xyz, part = clusters(*parts)
    cluster_id = np.where(part > 6, 0, part)
    reasons, confidence, report = reasons_of(xyz, cluster_id, max_penetration=0.4)
    assert reasons == [Reason.SOLID_PLANE, Reason.PENETRATED, Reason.SOLID] + [Reason.ROUGH] * 3
    assert confidence[0] > confidence[2] > 0.5 >= confidence[1]
    assert "Share of the beam" in report.html
    assert (report.values["clusters"], report.values["building_clusters"]) == (6, 2)


def test_reasons_of_what_is_undecided(rng):
    one = crown(rng, 0, 0)
    reasons, confidence, report = reasons_of(*clusters(one, one + [50.0, 0, 0]), guard=False)
    assert reasons == [Reason.ALIKE] * 2
    assert (confidence == 0.5).all()
    assert report.values["undecided_clusters"] == 2
    reasons, confidence, _ = reasons_of(*clusters(one, roof(rng, 30, 30), np.full((30, 3), 90.0)), n_neighbors=24)
    assert reasons[2] == Reason.WITHOUT_ENTROPY
    assert confidence[2] == 0.5


def test_what_was_said_of_points_outside_clusters_stays(garden):
    xyz, cluster_id = garden
    cluster_id = np.where(cluster_id == 2, 0, cluster_id)
    said = np.full(len(xyz), Reason.INTO_GROUND, np.uint8)
    reason = classify_buildings(xyz, ones(xyz), cluster_id, None, None, said)[4]
    np.testing.assert_array_equal(reason == Reason.INTO_GROUND, cluster_id == 0)


def test_the_report_tells_means_and_counts(garden):
    monitor = Monitor()
    report = classify_buildings(*garden[:1], ones(garden[0]), garden[1], monitor=monitor)[-1]
    assert report.values == {
        "clusters": 6,
        "building_clusters": 3,
        "undecided_clusters": 0,
        "building_entropy": monitor.values["building_entropy"],
        "other_entropy": monitor.values["other_entropy"],
    }
    assert f"buildings: {report.values['building_entropy']:.3g}" in report.html
    assert f"everything else: {report.values['other_entropy']:.3g}" in report.html


def test_the_report_tells_when_the_means_are_not_those_of_clusters(rng):
    report = classify_buildings(*[(p, ones(p), c) for p, c in [clusters(roof(rng, 0, 0))]][0])[-1]
    assert "compared with the entropies of planes and volumes" in report.html
    assert f"planes: {report.values['building_entropy']:.3g}" in report.html


def test_the_smaller_a_roof_the_less_sure(rng):
    """Confidence of a plane of n smallest buildings' points: half, and n² / (n² + 4) of the rest."""
    sizes = [2, 4, 8, 16]
    parts = [roof(rng, 30 * i, 0, side, side, noise=0.01) for i, side in enumerate(sizes)]
    parts += [crown(rng, 20 * i, 60) for i in range(4)]
    xyz, cluster_id = clusters(*parts)
    _, confidence, _ = reasons_of(xyz, cluster_id, density=6.0, n_neighbors=16)
    assert (np.diff(confidence[:4]) > 0).all()
    for side, sure in zip(sizes, confidence):
        n = side**2 / 4
        assert sure == pytest.approx(0.5 + 0.5 * n**2 / (n**2 + 4), abs=0.02)
    assert (confidence[4:] < 0.5).all()


@pytest.mark.parametrize("kinds", ["both", "roofs", "crowns"])
def test_who_is_more_sure_is_more_often_right(rng, kinds):
    """Roofs and crowns of all sizes and shapes, of which some look like the other kind; with the guard too."""
    parts, is_roof = [], []
    for i in range(240):
        west, south = 40 * (i % 20), 40 * (i // 20)
        is_roof.append(kinds == "roofs" or (kinds == "both" and i % 2 == 0))
        if is_roof[-1]:
            parts.append(roof(rng, west, south, *rng.uniform(2, 8, 2), noise=rng.uniform(0.01, 0.15)))
        else:
            thing = crown(rng, west, south, rng.uniform(0.8, 3), 7, int(rng.uniform(20, 200)))
            parts.append((thing - [west, south, 7]) * [1, 1, rng.uniform(0.05, 1)] + [west, south, 7])
    xyz, cluster_id = clusters(*parts)
    _, confidence, _ = reasons_of(xyz, cluster_id, density=6.0, n_neighbors=16)
    right = np.array(is_roof) == (confidence > 0.5)
    sureness = np.abs(confidence - 0.5)
    low, middle, high = np.array_split(right[np.argsort(sureness, kind="stable")], 3)
    assert low.mean() <= middle.mean() + 0.05
    assert middle.mean() <= high.mean() + 0.05
    assert low.mean() < high.mean() or right.all()


def test_a_narrow_roof_beside_a_building_is_one_in_spite_of_the_ground_seen_past_it(rng):
    """An eave as wide as the spacing of two points, lower than the roof, over a strip of lawn; once more far off."""
    house, trees = roof(rng, 0, 0, 12, 12), crown(rng, 40, 40)
    eave, lawn = roof(rng, 12, 0, 0.8, 12, elevation=4.0, density=20), roof(rng, 11.8, 0, 1.2, 12, 0.0, density=20)
    away = np.array([60.0, 0, 0])
    xyz, part = clusters(house, trees, eave, eave + away, lawn, lawn + away)
    cluster_id = np.where(part <= 4, part, 0)
    several = np.ones(len(xyz), int)
    tunables = {"max_penetration": 0.4, "n_neighbors": 12, "density": 6.0}
    found, *_, reason, _ = classify_buildings(xyz, ones(xyz), cluster_id, **tunables)
    assert (found[part == 3] == 6).all()
    assert (reason[part == 3] == Reason.BESIDE).all()
    assert (reason[part == 4] == Reason.PENETRATED).all()
    assert not (found[part == 4] == 6).any()
    several[part == 3] = 2  # pulses that go on below are those of a hedge
    assert not (classify_buildings(xyz, ones(xyz), cluster_id, ones(xyz), several, **tunables)[0][part == 3] == 6).any()


def test_a_crown_beside_a_building_is_none_though_few_of_its_pulses_go_on(rng):
    """What joins a building in spite of the ground beneath has to be planar."""
    house, tree, others = roof(rng, 0, 0, 12, 12), crown(rng, 13.5, 6, 2.0), [crown(rng, 40, 20 * i) for i in range(3)]
    xyz, part = clusters(house, tree, *others, roof(rng, 11.5, 0, 8, 12, 0.0, 20.0))
    cluster_id = np.where(part < 6, part, 0)
    reasons, *_ = reasons_of(xyz, cluster_id, max_penetration=0.4, n_neighbors=12, density=6.0)
    assert reasons == [Reason.SOLID_PLANE] + [Reason.ROUGH] * 4


def test_a_smooth_spot_smaller_than_a_building_is_one_only_beside_another(rng):
    house, spot = roof(rng, 0, 0, 12, 12, density=12), roof(rng, 12, 0, 1.6, 1.6, density=12)
    alone = spot + [30.0, 0, 0]
    xyz, cluster_id = clusters(house, spot, alone, crown(rng, 40, 40))
    tunables = {"n_neighbors": 12, "max_penetration": 0.4}
    found, *_, reason, _ = classify_buildings(xyz, ones(xyz), cluster_id, **tunables)
    assert (found[cluster_id <= 2] == 6).all()
    assert not (found[cluster_id == 3] == 6).any()
    assert (reason[cluster_id == 3] == Reason.TOO_SMALL).all()
    smaller = classify_buildings(xyz, ones(xyz), cluster_id, min_area=2.0, **tunables)[0]
    assert (smaller[cluster_id == 3] == 6).all()


@pytest.mark.parametrize("east", [0.0, 13.7])
def test_a_smooth_spot_amid_leaves_is_no_building_and_a_roof_beside_a_tree_is(rng, east):
    """In a crown some points lie on a plane by chance: leaves stand all around them, and around no roof."""
    wood = np.concatenate([crown(rng, x, y, 4, 6, 1500) for x in (0, 5) for y in (0, 5)])
    spot = roof(rng, 1, 1, 3, 3, elevation=8.5, density=12)
    roofs = [roof(rng, x, 0, 3, 3, elevation=2.5, density=12) for x in (30, 50)]
    tree = crown(rng, 54, 3, 2.5, 4, 300)
    house = roof(rng, 70, 0, 10, 10, density=12)
    leaning = crown(rng, 82, 5, 4, 6, 1500)
    xyz, cluster_id = clusters(wood, spot, *roofs, tree, house, leaning)
    reasons, confidence = zip(
        *(
            reasons_of(xyz + [east, 0, 0], cluster_id, n_neighbors=12, min_share_around=least)[:2]
            for least in (0.0, 0.4)
        )
    )
    rough, plane = Reason.ROUGH, Reason.PLANE
    assert reasons[0] == [rough, plane, plane, plane, rough, plane, rough]
    assert reasons[1] == [rough, Reason.AMID_OTHERS, plane, plane, rough, plane, rough]
    assert confidence[1][1] == 0.5 < confidence[0][1]


@pytest.mark.parametrize(
    ("side", "around", "reason"),
    [(3.0, roof, Reason.BESIDE), (3.0, crown, Reason.PENETRATED), (1.5, roof, Reason.PENETRATED)],
)
def test_balconies_amid_buildings_are_part_of_them(rng, side, around, reason):
    """A floor past which what is below is seen, apart from the roofs around: such spots amid crowns are leaves."""
    balcony = roof(rng, -side / 2, -side / 2, side, side, density=12)
    below = balcony - [0, 0, 3]
    places = [(x, y) for x in (-4, 4) for y in (-4, 0, 4)]
    if around is roof:
        parts = [roof(rng, x - 1.5, y - 2, 3, 4, elevation=7.5, density=24) for x, y in places]
    else:
        parts = [crown(rng, x, y, 1.5, 7) for x, y in places]
    far = roof(rng, 30, 0, density=12), crown(rng, 30, 30)
    xyz, cluster_id = clusters(balcony, *far, *parts, below)
    cluster_id[-len(below) :] = 0
    tunables = {"n_neighbors": 12, "max_penetration": 0.4}
    before, after = (reasons_of(xyz, cluster_id, min_share_around=least, **tunables)[0] for least in (0.0, 0.4))
    assert before[0] == Reason.PENETRATED
    assert after[0] == reason
    assert before[1:] == after[1:]


# --- properties ------------------------------------------------------------------------------------------------------


def test_order_place_and_numbers_change_nothing(garden, rng):
    xyz, cluster_id = garden
    found, entropy, cluster_entropy, confidence, *_ = classify_buildings(xyz, ones(xyz), cluster_id, n_neighbors=24)
    order = rng.permutation(len(xyz))
    for place in (0, FAR):
        other = classify_buildings(xyz[order] + place, ones(xyz), 7 - cluster_id[order], n_neighbors=24)
        np.testing.assert_array_equal(other[0], found[order])
        np.testing.assert_allclose(other[1], entropy[order], atol=1e-5)
        np.testing.assert_allclose(other[2], cluster_entropy[order], atol=1e-5)
        np.testing.assert_allclose(other[3], confidence[order], atol=1e-4)


def test_scale_changes_nothing(garden):
    """Entropy has no unit: a scene twice as large has the same."""
    xyz, cluster_id = garden
    small = classify_buildings(xyz, ones(xyz), cluster_id, n_neighbors=24)
    large = classify_buildings(xyz * 2, ones(xyz), cluster_id, n_neighbors=24)
    np.testing.assert_allclose(large[1], small[1], atol=1e-6)
    np.testing.assert_array_equal(large[0], small[0])


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


@pytest.mark.parametrize("stop_at", [0.0, 0.9, 0.94, 0.98])
def test_cancel_gets_through(garden, stop_at):
    """Also between penetration, what lies beside and what stands around, which take a second each of large clouds."""
    xyz, cluster_id = garden
    monitor, tunables = Listening(stop_at), {"max_penetration": 0.4, "min_share_around": 0.4}
    with pytest.raises(Cancelled):
        classify_buildings(xyz, ones(xyz), cluster_id, monitor=monitor, **tunables)
    assert stop_at in {0.0, monitor.heard[-1]}
    assert monitor.heard == sorted(monitor.heard)


def test_solid_clusters_are_undecided_where_nothing_tells_them_apart(rng):
    """A roof lets nothing through, but the log says that none was called a building: so none is."""
    xyz, cluster_id = clusters(roof(rng, 0, 0))
    monitor = Monitor()
    found, _, _, confidence, *_ = classify_buildings(
        xyz, ones(xyz), cluster_id, guard=False, max_penetration=0.4, monitor=monitor
    )
    assert "nothing was called a building" in monitor.warnings[0]
    assert not (found == 6).any()
    assert (confidence == 0.5).all()


def test_solid_clusters_without_entropy_are_no_buildings(garden):
    """Thirty points at one place stop the beam and are no roof."""
    xyz, cluster_id = garden[0], garden[1]
    xyz = np.concatenate([xyz, np.full((30, 3), 500.0)])
    cluster_id = np.append(cluster_id, np.full(30, cluster_id.max() + 1))
    found = classify_buildings(xyz, ones(xyz), cluster_id, n_neighbors=24, max_penetration=0.4)[0]
    assert (found == 6).any()
    assert not (found[-30:] == 6).any()
