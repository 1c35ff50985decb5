"""Decisions on clusters of matched images: by the share of surfaces, by the surroundings, by color."""

from __future__ import annotations

import numpy as np
import pytest

from lidar_buildings.algorithms.buildings.cluster_decisions import Decisions
from lidar_buildings.algorithms.buildings.cluster_evidence import ClusterEvidence
from lidar_buildings.algorithms.buildings.surface_evidence import (
    decide_in_images,
    green_clusters,
    greenness,
    greenness_between,
    without_green,
)
from lidar_buildings.algorithms.cloud.reasons import Reason
from lidar_buildings.tests.algorithms.buildings.parts import clusters
from lidar_buildings.tests.builders import crown, roof

GREEN, GRAY, RED = (20_000, 40_000, 15_000), (30_000, 30_000, 30_000), (40_000, 20_000, 18_000)

GRASS, ASPHALT = np.array([90.0, 130.0, 60.0]), np.array([128.0, 126.0, 122.0])


def decided(parts, surface_share, green=None, min_area=4.0, min_share=0.4):
    xyz, number = clusters(*parts)
    evidence = ClusterEvidence(xyz, number - 1, np.arange(len(parts)), 6.0, min_area, None)
    green = np.zeros(len(parts), bool) if green is None else np.array(green)
    return decide_in_images(np.array(surface_share, float), green, evidence, min_share)


@pytest.fixture
def parts(rng):
    """A roof and a crown far from each other."""
    return roof(rng, 0, 0), crown(rng, 40, 40)


def test_smooth_clusters_are_buildings_and_rough_ones_are_not(parts):
    found = decided(parts, [0.9, 0.2])
    assert [Reason(number) for number in found.reasons] == [Reason.SURFACE, Reason.ROUGH]
    np.testing.assert_array_equal(found.is_building, [True, False])
    # The roof is the only object.
    assert found.confidence[0] == 1.0


def test_a_smooth_spot_amid_leaves_is_no_building(rng):
    leaves = crown(rng, 5, 5, 4.0, 6.0, 3000)
    spot = roof(rng, 4, 4, 2.5, 2.5, 8.0)
    found = decided((leaves, spot), [0.1, 1.0])
    assert Reason(found.reasons[1]) == Reason.AMID_OTHERS
    assert not found.is_building.any()
    assert decided((leaves, spot), [0.1, 1.0], min_share=0.0).is_building[1]


def test_green_surfaces_are_plants(rng):
    found = decided((roof(rng, 0, 0, 5, 5), roof(rng, 40, 0, 12, 12)), [1.0, 1.0], green=[True, False])
    assert [Reason(number) for number in found.reasons] == [Reason.GREEN, Reason.SURFACE]


def test_confidence_follows_the_surroundings(rng):
    house, leaves = roof(rng, 0, 0), crown(rng, 12, 4, 2.5, 6.0, 500)
    alone, beside = decided((house,), [1.0]), decided((house, leaves), [1.0, 0.0])
    assert 0.5 < beside.confidence[0] < alone.confidence[0]


def colors(kinds, count):
    return tuple(np.concatenate([np.full(count, kind[band], np.uint16) for kind in kinds]) for band in range(3))


def green(bands, group, count):
    """Return the decisions on clusters of 100 m², the first of which is rough."""
    side = np.arange(len(group)) % 100
    xyz = np.column_stack([20.0 * group + side // 10, side % 10, np.zeros(len(group))])
    evidence = ClusterEvidence(xyz, group, np.arange(count), 1.0, 4.0, None)
    return green_clusters(bands, evidence, np.arange(count) > 0)


def test_green_clusters_are_distinguished_from_all_other_colors():
    group = np.repeat(np.arange(4), 100)
    is_green, least = green(colors((GREEN, GRAY, RED, GREEN), 100), group, 4)
    np.testing.assert_array_equal(is_green, [True, False, False, True])
    assert 0 < least < (2 * 40 - 20 - 15) / 75


def test_shadow_does_not_change_it():
    group = np.repeat(np.arange(3), 100)
    lit = colors((GREEN, GRAY, RED), 100)
    shadow = np.tile(np.repeat([1.0, 0.4], 50), 3)
    is_green, _ = green(tuple((band * shadow).astype(np.uint16) for band in lit), group, 3)
    np.testing.assert_array_equal(is_green, [True, False, False])


def test_most_points_of_a_cluster_decide():
    group = np.repeat(np.arange(2), 100)
    bands = colors((GREEN, GRAY), 100)
    # A quarter of the plant's points is gray, and a quarter of the gray cluster's is green; others have no cluster.
    for band, (of_green, of_gray) in zip(bands, zip(GREEN, GRAY)):
        band[:25], band[100:125] = of_gray, of_green
    is_green, _ = green(bands, group, 2)
    np.testing.assert_array_equal(is_green, [True, False])
    is_green, _ = green(bands, np.where(group == 0, -1, group), 2)
    np.testing.assert_array_equal(is_green, [False, False])


def test_a_roof_hardly_greener_than_the_limit_stays():
    """Three fifths of the points of a stadium's roof were greener than the middle of plants and roofs: it was lost."""
    group = np.repeat(np.arange(3), 100)
    bands = colors((GREEN, GRAY, GRAY), 100)
    for band, of_green in zip(bands, GREEN):
        band[240:] = of_green
    is_green, least = green(bands, group, 3)
    assert least is not None
    np.testing.assert_array_equal(is_green, [True, False, False])


@pytest.mark.parametrize("missing", [0, 1, 2])
def test_without_color_nothing_is_green(missing):
    bands = list(colors((GREEN, GRAY), 100))
    bands[missing] = None
    is_green, least = green(tuple(bands), np.repeat(np.arange(2), 100), 2)
    assert least is None
    assert not is_green.any()


def test_a_scene_of_one_color_has_no_plants():
    is_green, least = green(colors((GRAY, RED), 100), np.repeat(np.arange(2), 100), 2)
    assert least is None
    assert not is_green.any()


@pytest.fixture
def dry(rng):
    """A large roof, a rough crown and a smooth one, both hardly green, and a lawn; evidence and colors."""
    parts = roof(rng, 0, 0, 12, 12), crown(rng, 30, 5, 3.0), roof(rng, 50, 0, 4, 4)
    xyz, number = clusters(*parts)
    kinds = np.repeat(
        [(30_000, 30_000, 30_000), (29_000, 31_500, 28_500), (29_000, 31_500, 28_500)], list(map(len, parts)), axis=0
    )
    lawn = roof(rng, 0, 30, 20, 20, 0.0)
    xyz = np.concatenate([xyz, lawn])
    bands = np.concatenate([kinds, np.tile(GREEN, (len(lawn), 1))]) * rng.uniform(0.98, 1.02, (len(xyz), 3))
    group = np.append(number - 1, np.full(len(lawn), -1))
    return ClusterEvidence(xyz, group, np.arange(3), 6.0, 4.0, None), tuple(bands.T.astype(np.uint16))


def test_the_limit_lies_between_rough_crowns_and_large_roofs_and_not_at_the_lawn(dry):
    evidence, bands = dry
    is_green, least = green_clusters(bands, evidence, np.array([True, False, True]))
    np.testing.assert_array_equal(is_green, [False, True, True])
    assert least == pytest.approx(0.06 / 2, abs=0.015)
    # Without a rough crown nothing shows how green plants are: the lawn is no cluster.
    is_green, least = green_clusters(bands, evidence, np.array([True, True, True]))
    assert not is_green.any()
    assert least is None


def test_green_buildings_are_refused_in_scans_without_returns():
    before = Decisions(np.array([0.9, 0.2, 0.9]), np.array([Reason.SOLID, Reason.ROUGH, Reason.SOLID], np.uint8))
    found = without_green(before, np.array([False, True, True]))
    assert [Reason(number) for number in found.reasons] == [Reason.SOLID, Reason.ROUGH, Reason.GREEN]
    np.testing.assert_array_equal(found.confidence, [0.9, 0.2, 0.5])


def mixed(rng, share, count=4000):
    """Colors (count, 3) of which a share is grass, the rest asphalt, in light of 30 to 100 %; and which are grass."""
    is_grass = rng.random(count) < share
    colors = np.where(is_grass[:, None], GRASS, ASPHALT) * rng.uniform(0.3, 1.0, (count, 1))
    return colors * (1 + 0.05 * rng.standard_normal(colors.shape)), is_grass


def test_shadow_changes_nothing():
    lit, shaded = (greenness(*(part * GRASS[:, None])) for part in (1.0, 0.3))
    np.testing.assert_allclose(lit, shaded)
    np.testing.assert_allclose(lit, (260 - 150) / 280)


def test_black_points_have_none():
    assert np.isnan(greenness(np.array([0, 200, 200]), np.array([1, 200, 200]), np.array([0, 200, 200]))[0])


def test_threshold_parts_plants_from_materials():
    colors, is_grass = mixed(np.random.default_rng(1), 0.5)
    values = greenness(*colors.T)
    assert np.mean((values > greenness_between(values[is_grass], values[~is_grass])) == is_grass) > 0.99


def test_leaves_and_roofs_known_by_their_shape_give_the_middle_between_them():
    rng = np.random.default_rng(4)
    leaves, roofs = rng.normal(0.06, 0.03, 5000), rng.normal(-0.02, 0.03, 5000)
    assert abs(greenness_between(leaves, roofs) - 0.02) < 0.003
    # A fifth of the leaves are edges of roofs, and a fifth of the roofs are crowns.
    mixed = np.append(leaves[:4000], roofs[:1000]), np.append(roofs[:4000], leaves[:1000])
    assert abs(greenness_between(*mixed) - 0.02) < 0.01


def test_edges_of_gray_roofs_are_no_leaves():
    rng = np.random.default_rng(5)
    assert greenness_between(rng.normal(0.01, 0.03, 5000), rng.normal(0, 0.03, 5000)) is None
    assert greenness_between(np.array([np.nan]), np.array([0.0])) is None
    assert greenness_between(np.array([0.2]), np.zeros(0)) is None
