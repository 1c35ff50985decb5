"""Buildings by entropy, penetration, adjacent clusters and surroundings, each by a scene in which it decides."""

import numpy as np
import pytest

from lidar_buildings.algorithms.buildings.classify_buildings import classify_buildings
from lidar_buildings.algorithms.buildings.classify_buildings_2019 import classify_buildings_2019
from lidar_buildings.algorithms.buildings.cluster_entropies import cluster_entropies
from lidar_buildings.algorithms.buildings.entropy_split import reference_entropies
from lidar_buildings.algorithms.cloud.reasons import Evidence, Reason, evidence_text
from lidar_buildings.algorithms.neighborhoods.covariance import Nearest
from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling
from lidar_buildings.algorithms.sampling.density import effective_density, point_density
from lidar_buildings.algorithms.sampling.surface_noise import plane_roughness
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.tests.algorithms.buildings.parts import clusters, ones, reasons_of
from lidar_buildings.tests.builders import crown, roof
from lidar_buildings.tests.monitors import Listening


def with_lawn(xyz, cluster_id, lawn):
    """Return a scene with points of the ground, which are in no cluster."""
    return np.concatenate([xyz, lawn]), np.append(cluster_id, np.zeros(len(lawn), int))


@pytest.fixture
def garden(garden, lawn):
    """The garden with the ground below its crowns."""
    return with_lawn(*garden, lawn)


# --- neighborhoods ---------------------------------------------------------------------------------------------------


def test_gaps_between_scan_lines_count_in_the_density(rng):
    """On lines 2 m apart points are dense along each line, and the paper's neighborhoods follow that density."""
    xyz, cluster_id = clusters(roof(rng, 0, 0, 30, 30, 0.0, 8), roof(rng, 10, 10))
    xyz[:, 1] = 2 * np.round(xyz[:, 1] / 2)
    for classify, density in ((classify_buildings, effective_density), (classify_buildings_2019, point_density)):
        monitor = Monitor()
        classify(xyz, ones(xyz), cluster_id - 1, monitor=monitor)
        assert monitor.values["density"] == density(xyz)
    assert effective_density(xyz) < 0.6 * point_density(xyz)


@pytest.mark.parametrize(("gap", "expected"), [(0.4, 12), (2.0, 14)])
def test_entropies_of_surfaces_need_half_as_many_points_again_as_planes_and_more_on_lines(gap, expected, rng):
    """Precise and sparse points need 8 for a plane: on a grid 12, on lines with a point every 40 cm 14."""
    x, y = np.meshgrid(np.arange(0, 30, 0.4), np.arange(0, 30, gap))
    xyz = np.column_stack([x.ravel(), y.ravel(), rng.normal(0, 0.01, x.size)])
    monitor = Monitor()
    classify_buildings(xyz, ones(xyz), ones(xyz), density=5.0, monitor=monitor)
    assert monitor.values["n_neighbors"] == expected


# --- what is found ---------------------------------------------------------------------------------------------------


def test_roofs_are_buildings_and_crowns_are_not(garden):
    xyz, cluster_id = garden
    found, _, _, confidence, *_ = classify_buildings(xyz, ones(xyz), cluster_id)
    np.testing.assert_array_equal(found == 6, (cluster_id > 0) & (cluster_id <= 3))
    assert found.dtype == np.uint8
    confidence, cluster_id = confidence[cluster_id > 0], cluster_id[cluster_id > 0]
    assert (confidence[cluster_id <= 3] > 0.8).all()
    assert (confidence[cluster_id > 3] < 0.2).all()
    assert confidence.min() >= 0
    assert confidence.max() <= 1


def test_a_scene_of_roofs_and_crowns_gets_the_published_classes(garden):
    xyz, cluster_id = garden
    ours = classify_buildings(xyz, ones(xyz), cluster_id, n_neighbors=24)
    published = classify_buildings_2019(xyz, ones(xyz), cluster_id, n_neighbors=24)
    np.testing.assert_array_equal(ours[0], published[0])
    # Ours are means of about 256 points of each cluster: three standard errors of 0.15 / sqrt(256).
    np.testing.assert_allclose(ours[2], published[2], atol=0.028)
    clustered = cluster_id > 0
    assert np.isfinite(ours[1][clustered]).mean() == np.isfinite(published[1][clustered]).mean() == 1.0
    is_measured = ours[1][clustered] != ours[2][clustered]
    np.testing.assert_array_equal(ours[1][clustered][is_measured], published[1][clustered][is_measured])
    assert 200 < is_measured.sum() / cluster_id.max() < 320


def test_a_cluster_has_the_same_mean_entropy_in_every_part_of_a_survey(garden):
    xyz, cluster_id = garden
    part = cluster_id != 1
    whole = cluster_entropies(xyz, cluster_id, Nearest(12), Monitor(), measured=64)
    alone = cluster_entropies(xyz[part][::-1], cluster_id[part][::-1], Nearest(12), Monitor(), measured=64)
    np.testing.assert_allclose(alone.means, whole.means[1:], atol=1e-12)


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
    expected = classify_buildings(xyz, ones(xyz), cluster_id)
    for one, other in zip(classify_buildings(xyz, ones(xyz), numbers), expected):
        np.testing.assert_array_equal(one, other)


def test_clusters_of_other_programs_have_any_number(garden):
    """A cloud whose clusters were numbered up to two billion, with -1 for none, needed 16 GB."""
    xyz, cluster_id = garden
    numbers = np.array([-1, 2_000_000_000, 7, 31, 2, 2**31 - 1, 15])[cluster_id].astype(np.int32)
    order = np.argsort(np.argsort([0, 5, 2, 4, 1, 6, 3]))
    expected = classify_buildings(xyz, ones(xyz), order[cluster_id])
    for one, other in zip(classify_buildings(xyz, ones(xyz), numbers), expected):
        np.testing.assert_array_equal(one, other)


def test_without_clusters_nothing_is_found_and_the_log_says_so(rng):
    xyz = roof(rng, 0, 0)
    monitor = Monitor()
    found, *_, report = classify_buildings(xyz, np.full(len(xyz), 6), np.zeros(len(xyz), int), monitor=monitor)
    assert (found == 1).all()
    assert report.values["clusters"] == 0
    assert monitor.warnings[-1] == "There are no clusters, so no buildings were found."


# --- one kind only ---------------------------------------------------------------------------------------------------


def test_a_lone_flat_roof_is_found(rng):
    xyz, cluster_id = clusters(roof(rng, 0, 0))
    monitor = Monitor()
    found, *_, report = classify_buildings(xyz, ones(xyz), cluster_id, monitor=monitor)
    assert (found == 6).all()
    assert "taken from simulated planes" in monitor.warnings[-1]
    assert "the missing one has the mean of simulated planes or volumes" in report.html
    assert f"buildings: {report.values['building_entropy']:.3g}" in report.html


def test_a_lone_tree_is_never_a_building(rng, lawn):
    xyz, cluster_id = with_lawn(*clusters(crown(rng, 5, 30)), lawn)
    assert not (classify_buildings(xyz, ones(xyz), cluster_id)[0] == 6).any()


def test_a_town_without_trees_keeps_all_its_roofs_and_a_forest_gets_none(rng):
    """K-means would split each in two; the reference entropies of planes and volumes prevent it."""
    town = clusters(*[roof(rng, 20 * i, 0, noise=0.01 + 0.01 * i) for i in range(6)])
    crowns = [crown(rng, 20 * i, 0, 2 + 0.4 * i) for i in range(6)]
    forest = with_lawn(*clusters(*crowns), roof(rng, -5, -5, 110, 10, 0.0))
    for (xyz, cluster_id), expected in ((town, True), (forest, False)):
        clustered = cluster_id > 0
        ours = classify_buildings(xyz, ones(xyz), cluster_id)[0] == 6
        assert (ours[clustered] == expected).all()
        published = classify_buildings_2019(xyz, ones(xyz), cluster_id)[0] == 6
        assert 0 < published[clustered].mean() < 1


@pytest.mark.parametrize("copies", [3, 60])
def test_planes_and_volumes_count_as_ten_times_the_clusters(rng, copies):
    """Of m clusters of mean entropy e, and planes as rough of entropy p, the mean is (e + 10 p)/11."""
    xyz, cluster_id = clusters(*[roof(rng, 30.0 * i, 0, 5, 5, density=12, noise=0.05) for i in range(copies)])
    monitor = Monitor()
    means = classify_buildings(xyz, ones(xyz), cluster_id, n_neighbors=24, density=12.0, monitor=monitor)[2]
    measured = np.mean([means[cluster_id == i][0] for i in range(1, copies + 1)])
    roughness = plane_roughness(CloudSampling.of(xyz).noise, 12.0)
    plane, volume = reference_entropies(24, roughness / np.sqrt(24 / (12 * np.pi)))
    expected = (measured + 10 * plane) / 11
    assert monitor.values["building_entropy"] == pytest.approx(expected, abs=1e-6)
    assert monitor.values["other_entropy"] == pytest.approx(volume, abs=1e-12)


def test_where_noise_makes_planes_volumes_nothing_is_a_building(rng):
    """Off the plane by a third of the neighborhood's radius, 50 points have more entropy than in a ball."""
    xyz, cluster_id = clusters(roof(rng, 0, 0, density=100, noise=0.4))
    monitor = Monitor()
    found, *_, confidence, reason, _, report = classify_buildings(
        xyz, ones(xyz), cluster_id, n_neighbors=50, density=100.0, monitor=monitor
    )
    assert "nothing was called a building" in monitor.warnings[-1]
    assert not (found == 6).any()
    assert (confidence == 0.5).all()
    assert (reason == Reason.ALIKE).all()
    assert report.values["undecided_clusters"] == 1


# --- penetration -----------------------------------------------------------------------------------------------------


def test_a_planar_cluster_with_ground_beneath_is_no_building(rng):
    """A spot of a crown as flat as a roof: it has the entropy of a building, but ground points beneath it."""
    solid, canopy = roof(rng, 0, 0, 12, 12), roof(rng, 30, 0, 5, 5)
    ground = roof(rng, 30, 0, 5, 5, elevation=0.0)
    xyz, part = clusters(solid, canopy, crown(rng, 20, 40), ground)
    cluster_id = np.where(part == 4, 0, part)
    published = classify_buildings_2019(xyz, ones(xyz), cluster_id)[0]
    assert (published[cluster_id == 2] == 6).all()
    found, _, _, confidence, *_ = classify_buildings(xyz, ones(xyz), cluster_id)
    assert (found[cluster_id == 1] == 6).all()
    assert not (found[cluster_id > 1] == 6).any()
    assert (confidence[cluster_id == 2] <= 0.5).all()


def test_returns_that_are_not_the_last_show_penetration_too(rng):
    """The same points, once returned in one piece and once the first of two."""
    xyz, cluster_id = clusters(roof(rng, 0, 0, 12, 12), roof(rng, 30, 0, 5, 5), crown(rng, 20, 40))
    single, several = np.ones(len(xyz), int), np.where(cluster_id == 2, 2, 1)
    tunables = {"n_neighbors": 12}
    for of_pulse, expected in ((single, True), (several, False)):
        found = classify_buildings(xyz, ones(xyz), cluster_id, single, of_pulse, **tunables)[0]
        assert (found[cluster_id == 1] == 6).all()
        assert (found[cluster_id == 2] == 6).all() == expected


# --- reasons and confidence ------------------------------------------------------------------------------------------


def test_reasons_with_penetration(rng):
    """A roof, a canopy as flat as a roof, a crown, and a rough object that no beam passes."""
    ground = roof(rng, 30, 0, 5, 5, elevation=0.0)
    crowns = [crown(rng, 20, 40), crown(rng, 40, 40), crown(rng, 60, 40)]
    under = np.column_stack([rng.uniform([10, 30], [70, 50], (6000, 2)), np.zeros(6000)])
    rubble = roof(rng, 80, 0, 12, 12, noise=0.2)
    parts = [roof(rng, 0, 0, 12, 12), roof(rng, 30, 0, 5, 5), rubble, *crowns, ground, under]
    xyz, part = clusters(*parts)
    cluster_id = np.where(part > 6, 0, part)
    reasons, confidence, report = reasons_of(classify_buildings, xyz, cluster_id, n_neighbors=24)
    assert reasons == [Reason.SOLID_PLANE, Reason.PENETRATED, Reason.SOLID] + [Reason.ROUGH] * 3
    assert confidence[0] > confidence[2] > 0.5 >= confidence[1]
    assert "Share of the beam" in report.html
    assert "which the two means of the clusters move by little" in report.html
    assert (report.values["clusters"], report.values["building_clusters"]) == (6, 2)


def test_the_weakest_evidence_is_what_is_nearest_to_its_limit(rng):
    """A large roof by a copse, a roof as small as a car, a flat canopy, rubble and crowns, each by itself."""
    ground = roof(rng, 30, 0, 5, 5, elevation=0.0)
    crowns = [crown(rng, 20, 40), crown(rng, 40, 40)]
    under = np.column_stack([rng.uniform([10, 30], [50, 50], (4000, 2)), np.zeros(4000)])
    parts = [roof(rng, 90, 40, 2.6, 2.4), roof(rng, 30, 0, 5, 5), roof(rng, 80, 0, 12, 12, noise=0.2), *crowns]
    xyz, part = clusters(*parts, ground, under)
    cluster_id = np.where(part > 5, 0, part)
    limits = {"max_penetration": 0.35, "min_area": 4.0, "density": 10.0}
    *_, weakest, report = classify_buildings(xyz, ones(xyz), cluster_id, n_neighbors=24, **limits)
    assert not weakest[cluster_id == 0].any()
    texts = [evidence_text(int(weakest[cluster_id == number][0])) for number in range(1, 6)]
    size = (cluster_id == 1).sum()
    assert texts[0] == f"{size} points of a roof surface (confidence 0.5 at 80)"
    assert texts[1].endswith("of the beam passes (limit 35 %)")
    assert float(texts[1].split(" %")[0]) > 35
    middle = (report.values["building_entropy"] + report.values["other_entropy"]) / 2
    assert texts[2].startswith("entropy ")
    # Stored in thousandths and shown in hundredths.
    assert float(texts[2].partition("(limit ")[2][:-1]) == pytest.approx(middle, abs=0.0055)
    # Crowns fail both by entropy and by the beam.
    assert all(text.startswith("entropy ") or "of the beam passes" in text for text in texts[3:])


def test_the_weakest_evidence_in_images_is_size_or_surroundings(rng):
    """There neither entropy nor the beam decides."""
    xyz, cluster_id = clusters(roof(rng, 0, 0, 12, 12), roof(rng, 40, 0, 12, 12))
    # Half of the points around the second roof is rough, and in no cluster.
    rough = np.column_stack([rng.uniform([38, -2], [54, 14], (900, 2)), rng.uniform(4, 6, 900)])
    xyz = np.concatenate([xyz, rough])
    cluster_id = np.append(cluster_id, np.full(900, 3))
    segment = np.where(cluster_id < 3, cluster_id, 0)
    *_, weakest, _ = classify_buildings(
        xyz, ones(xyz), cluster_id, segment_id=segment, source="matched images", min_share_around=0.3, density=10.0
    )
    kinds = [int(weakest[cluster_id == number][0]) // 100_000_000 for number in (1, 2, 3)]
    assert set(kinds) <= {Evidence.POINTS, Evidence.SURROUNDINGS}
    assert kinds[1] == Evidence.SURROUNDINGS


def test_a_narrow_roof_beside_a_building_is_one_in_spite_of_the_ground_seen_past_it(rng):
    """An eave as wide as the spacing of two points, lower than the roof, over a strip of lawn; once more far off."""
    house, trees = roof(rng, 0, 0, 12, 12), crown(rng, 40, 40)
    eave, lawn = roof(rng, 12, 0, 0.8, 12, elevation=4.0, density=20), roof(rng, 11.8, 0, 1.2, 12, 0.0, density=20)
    away = np.array([60.0, 0, 0])
    xyz, part = clusters(house, trees, eave, eave + away, lawn, lawn + away)
    cluster_id = np.where(part <= 4, part, 0)
    several = np.ones(len(xyz), int)
    tunables = {"n_neighbors": 12, "density": 6.0}
    found, *_, reason, _, _ = classify_buildings(xyz, ones(xyz), cluster_id, **tunables)
    assert (found[part == 3] == 6).all()
    assert (reason[part == 3] == Reason.NEXT_TO_BUILDINGS).all()
    assert (reason[part == 4] == Reason.PENETRATED).all()
    assert not (found[part == 4] == 6).any()
    several[part == 3] = 2  # pulses that go on below are of a hedge
    assert not (classify_buildings(xyz, ones(xyz), cluster_id, ones(xyz), several, **tunables)[0][part == 3] == 6).any()


def test_a_crown_beside_a_building_is_none_though_few_of_its_pulses_go_on(rng):
    """What joins a building in spite of the ground beneath has to be planar."""
    house, tree, others = roof(rng, 0, 0, 12, 12), crown(rng, 13.5, 6, 2.0), [crown(rng, 40, 20 * i) for i in range(3)]
    xyz, part = clusters(house, tree, *others, roof(rng, 11.5, 0, 8, 12, 0.0, 20.0))
    cluster_id = np.where(part < 6, part, 0)
    reasons, *_ = reasons_of(classify_buildings, xyz, cluster_id, n_neighbors=12, density=6.0)
    assert reasons == [Reason.SOLID_PLANE] + [Reason.ROUGH] * 4


def test_a_smooth_spot_smaller_than_a_building_is_one_only_beside_another(rng):
    house, spot = roof(rng, 0, 0, 12, 12, density=12), roof(rng, 12, 0, 1.6, 1.6, density=12)
    alone = spot + [30.0, 0, 0]
    xyz, cluster_id = clusters(house, spot, alone, crown(rng, 40, 40))
    tunables = {"n_neighbors": 12}
    found, *_, reason, _, _ = classify_buildings(xyz, ones(xyz), cluster_id, **tunables)
    assert (found[cluster_id <= 2] == 6).all()
    assert not (found[cluster_id == 3] == 6).any()
    assert (reason[cluster_id == 3] == Reason.TOO_SMALL).all()
    smaller = classify_buildings(xyz, ones(xyz), cluster_id, min_area=2.0, **tunables)[0]
    assert (smaller[cluster_id == 3] == 6).all()


@pytest.mark.parametrize("east", [0.0, 13.7])
def test_a_smooth_spot_amid_leaves_is_no_building_and_a_roof_beside_a_tree_is(rng, east):
    """In a crown some points lie on a plane by chance: leaves surround them, but no roof."""
    wood = np.concatenate([crown(rng, x, y, 4, 6, 1500) for x in (0, 5) for y in (0, 5)])
    spot = roof(rng, 1, 1, 3, 3, elevation=8.5, density=12)
    roofs = [roof(rng, x, 0, 3, 3, elevation=2.5, density=12) for x in (30, 50)]
    tree = crown(rng, 54, 3, 2.5, 4, 300)
    house = roof(rng, 70, 0, 10, 10, density=12)
    leaning = crown(rng, 82, 5, 4, 6, 1500)
    xyz, cluster_id = clusters(wood, spot, *roofs, tree, house, leaning)
    tunables = {"n_neighbors": 12, "max_penetration": 1.0}
    xyz = xyz + [east, 0, 0]
    reasons, confidence = zip(
        *(reasons_of(classify_buildings, xyz, cluster_id, min_share_around=least, **tunables)[:2] for least in (0, 0.4))
    )
    rough, plane = Reason.ROUGH, Reason.SOLID_PLANE
    assert reasons[0] == [rough, plane, plane, plane, rough, plane, rough]
    assert reasons[1] == [rough, Reason.AMID_OTHERS, plane, plane, rough, plane, rough]
    assert confidence[1][1] == 0.5 < confidence[0][1]


# --- properties ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("stop_at", [0.0, 0.9, 0.94, 0.98])
def test_cancel_gets_through(garden, stop_at):
    """Also between penetration and surroundings, which take a second each of large clouds."""
    xyz, cluster_id = garden
    monitor, tunables = Listening(stop_at), {}
    with pytest.raises(Cancelled):
        classify_buildings(xyz, ones(xyz), cluster_id, monitor=monitor, **tunables)
    assert stop_at in {0.0, monitor.heard[-1]}
    assert monitor.heard == sorted(monitor.heard)


def test_solid_clusters_without_entropy_are_no_buildings(garden):
    """Thirty points at one place stop the beam and are no roof."""
    xyz, cluster_id = garden[0], garden[1]
    xyz = np.concatenate([xyz, np.full((30, 3), 500.0)])
    cluster_id = np.append(cluster_id, np.full(30, cluster_id.max() + 1))
    found = classify_buildings(xyz, ones(xyz), cluster_id, n_neighbors=24)[0]
    assert (found == 6).any()
    assert not (found[-30:] == 6).any()


def test_clusters_without_entropy_are_undecided(rng):
    reasons, confidence, _ = reasons_of(
        classify_buildings, *clusters(crown(rng, 0, 0), roof(rng, 30, 30), np.full((30, 3), 90.0)), n_neighbors=24
    )
    assert reasons[2] == Reason.WITHOUT_ENTROPY
    assert confidence[2] == 0.5


@pytest.mark.parametrize("kinds", ["both", "roofs", "crowns"])
def test_clusters_of_more_confidence_are_more_often_right(rng, kinds):
    """Roofs and crowns of all sizes and shapes, of which some look like the other kind; ground lies under crowns."""
    parts, is_roof, ground = [], [], []
    for i in range(240):
        west, south = 40 * (i % 20), 40 * (i // 20)
        is_roof.append(kinds == "roofs" or (kinds == "both" and i % 2 == 0))
        if is_roof[-1]:
            parts.append(roof(rng, west, south, *rng.uniform(2, 8, 2), noise=rng.uniform(0.01, 0.15)))
        else:
            thing = crown(rng, west, south, rng.uniform(0.8, 3), 7, int(rng.uniform(20, 200)))
            parts.append((thing - [west, south, 7]) * [1, 1, rng.uniform(0.05, 1)] + [west, south, 7])
            ground.append(roof(rng, west - 3, south - 3, 6, 6, 0.0))
    xyz, cluster_id = with_lawn(*clusters(*parts), np.concatenate([np.empty((0, 3)), *ground]))
    _, confidence, _ = reasons_of(classify_buildings, xyz, cluster_id, density=6.0, n_neighbors=16)
    right = np.array(is_roof) == (confidence > 0.5)
    sureness = np.abs(confidence - 0.5)
    low, middle, high = np.array_split(right[np.argsort(sureness, kind="stable")], 3)
    assert low.mean() <= middle.mean() + 0.05
    assert middle.mean() <= high.mean() + 0.05
    assert low.mean() < high.mean() or right.all()


def test_without_second_returns_green_clusters_are_refused_and_with_them_the_beam_decides(rng):
    """Two gray roofs, one of them small, a smooth spot of a dry crown and rough leaves, which are as green as it."""
    parts = roof(rng, 0, 0, 12, 12), roof(rng, 30, 0, 5, 5), roof(rng, 60, 0, 5, 5), crown(rng, 90, 5, 4.0, 7.0, 800)
    xyz, number = clusters(*parts)
    is_plant = number > 2
    red, green, blue = (np.where(is_plant, of, 30_000).astype(np.uint16) for of in (29_000, 31_500, 28_500))
    segment = np.where(number < 4, number, 0).astype(np.int32)
    ones, twos = np.ones(len(xyz), np.uint8), np.full(len(xyz), 2, np.uint8)
    given = (ones, number, ones)
    more = (None, segment, red, green, blue)

    def found(returns):
        made = classify_buildings(xyz, *given, returns, *more, source="laser scanner")
        return [(int(made[0][number == one][0]), Reason(made[4][number == one][0])) for one in (1, 2, 3)]

    alone = found(ones)
    assert [kind for kind, _ in alone] == [6, 6, 1]
    assert alone[2][1] == Reason.GREEN
    several = found(np.where(number == 4, twos, ones))
    assert [kind for kind, _ in several] == [6, 6, 6]
