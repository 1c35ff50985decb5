"""Greenness separates plants from materials in any light, and gives no result where there are no two kinds."""

from __future__ import annotations

import numpy as np

from lidar_buildings.algorithms.features.greenness import greenness, greenness_between

GRASS, ASPHALT = np.array([90.0, 130.0, 60.0]), np.array([128.0, 126.0, 122.0])


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
