"""Bridges in classified ground: kinds and angles, objects that look like bridges, roofs, and missing inputs."""

import numpy as np
import pytest

from lidar_buildings.algorithms.bridges.bridge_decks import Decks
from lidar_buildings.algorithms.bridges.classify_bridges import classify_bridges, deck_sites
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.algorithms.simulation.simulate_bridges import simulate_bridges
from lidar_buildings.algorithms.stage import Cancelled
from lidar_buildings.tests.builders import FAR
from lidar_buildings.tests.monitors import Listening
from lidar_buildings.tests.river_town import river_town

EARTH, WATER, DECK, ROOF = range(4)


def canal(angle=0.0, gap=0.0, drop=0.0, seed=6):
    """A canal 12 m wide and 3 m deep between quays, a bridge 7 m wide, and a flat roof flush with a terrace behind it.

    The bridge ends ``gap`` (m) before the eastern quay, and lies ``drop`` (m) lower than that. 40 m by 40 m, 6 per m².
    """
    rng = np.random.default_rng(seed)
    x, y = rng.uniform(0, 40, (9600, 2)).T
    part = np.where(np.abs(x - 20) < 6, WATER, EARTH)
    off = (y - 20) * np.cos(np.radians(angle)) - (x - 20) * np.sin(np.radians(angle))
    part[(np.abs(off) < 3.5) & (part == WATER) & (x < 26 - gap)] = DECK
    part[(np.abs(x - 6) < 4) & (np.abs(y - 30) < 5)] = ROOF
    z = np.array([0.0, -3.0, -drop, 4.0])[part] + np.where((part == EARTH) & (x < 2), 4.0, 0.0)
    return np.column_stack([x, y, z + rng.normal(0, 0.02, len(x))]), part


def classified(xyz, part, **tunables):
    return classify_bridges(xyz, np.where((part == EARTH) | (part == WATER), 2, 1).astype(np.uint8), **tunables)


def f_score(found, true):
    return 2 * (found & true).sum() / (found.sum() + true.sum())


@pytest.mark.parametrize("angle", [0.0, 30.0])
def test_a_bridge_is_found_whether_it_is_ground_or_not(angle):
    xyz, part = canal(angle)
    for is_ground in (False, True):
        classes = np.where((part == EARTH) | (part == WATER) | ((part == DECK) & is_ground), 2, 1).astype(np.uint8)
        made = classify_bridges(xyz, classes)
        assert f_score(made == 17, part == DECK) > 0.95
        np.testing.assert_array_equal(made[made != 17], classes[made != 17])


def test_what_leads_to_no_ground_is_no_bridge():
    """A pier, a roof between terraces, and a deck that ends 1.5 m lower than the quay."""
    for xyz, part in (canal(gap=4.0), canal(drop=1.5)):
        assert not (classified(xyz, part) == 17).any()
    xyz, part = canal()
    assert not (classified(xyz, part)[part == ROOF] == 17).any()
    is_only_west = np.where((part == EARTH) & (xyz[:, 0] < 14), 2, 1).astype(np.uint8)
    assert not (classify_bridges(xyz, is_only_west) == 17).any()


@pytest.mark.parametrize(("kind", "least"), [("arch", 0.9), ("footbridge", 0.7), ("two decks", 0.9), ("fly-over", 0.9)])
def test_scanned_bridges_with_parapets_and_cars_are_found(kind, least):
    density = 8.0 if kind == "footbridge" else 4.0
    xyz, true, *_ = simulate_bridges(kind=kind, angle=20.0, density=density, seed=3)
    classes = np.where(np.isin(true, (2, 9)), 2, 1).astype(np.uint8)
    made = classify_bridges(xyz, classes)
    assert f_score(made == 17, true == 17) > least


@pytest.mark.parametrize(("kind", "angle", "density"), [("canal", 0.0, 1.0), ("arch", 30.0, 2.0)])
def test_bridges_in_thin_clouds_go_on_into_the_road(kind, angle, density):
    """The nearest points of terrain lie on the bank below; nothing of these bridges was found."""
    xyz, true = simulate_bridges(kind=kind, angle=angle, density=density, seed=5)[:2]
    classes = np.where(np.isin(true, (2, 9)), np.uint8(2), np.uint8(1))
    found, deck = classify_bridges(xyz, classes) == 17, true == 17
    assert 2 * (found & deck).sum() > 0.8 * (found.sum() + deck.sum())


@pytest.mark.parametrize("kind", ["tunnel", "jetty", "ramp"])
def test_tunnel_mouths_jetties_and_ramps_are_no_bridges(kind):
    xyz, true, *_ = simulate_bridges(kind=kind, density=4.0, seed=3)
    classes = np.where(np.isin(true, (2, 9)), 2, 1).astype(np.uint8)
    np.testing.assert_array_equal(classify_bridges(xyz, classes), classes)


@pytest.mark.parametrize(
    ("kind", "angle"), [("fly-over", 0.0), pytest.param("two decks", 20.0, marks=pytest.mark.slow)]
)
def test_a_bridge_with_cars_is_no_building(kind, angle):
    xyz, true, *_ = simulate_bridges(kind=kind, angle=angle, density=4.0, seed=3, trees=False)
    cloud = create_cloud({"xyz": xyz})
    run_pipeline(PIPELINES["detect_buildings"], cloud)
    made = cloud.get("classification")
    assert not (made == 6).any()
    assert (made[true == 17] == 17).mean() > 0.8


def test_limits_have_their_effect():
    xyz, part = canal()
    assert not (classified(xyz, part, min_height=3.5) == 17).any()
    assert not (classified(xyz, part, max_width=5.0) == 17).any()
    assert not (classified(xyz, part, min_bridge_area=120.0) == 17).any()


def test_nothing_changes_where_no_bridges_are_looked_for():
    xyz, part = canal()
    classes = np.where(part == DECK, 17, 1).astype(np.uint8)
    np.testing.assert_array_equal(classify_bridges(xyz, classes, max_width=0.0), classes)


def test_water_vegetation_buildings_and_noise_are_no_decks_and_earlier_decks_are_forgotten():
    xyz, part = canal()
    ground = np.where((part == EARTH) | (part == WATER), 2, 1).astype(np.uint8)
    for kept in (5, 6, 9, 18):
        classes = np.where(part == DECK, kept, ground).astype(np.uint8)
        np.testing.assert_array_equal(classify_bridges(xyz, classes), classes)
    classes = np.where(part == ROOF, 17, ground).astype(np.uint8)
    assert (classify_bridges(xyz, classes)[part == ROOF] == 1).all()


def test_ground_is_needed():
    with pytest.raises(ValueError, match=r"No ground points \(class 2\)"):
        classify_bridges(np.zeros((5, 3)), np.ones(5, np.uint8))


def test_order_and_position_change_nothing():
    xyz, part = canal(20.0)
    xyz = (xyz * 1024).round() / 1024
    made = classified(xyz, part)
    order = np.random.default_rng(3).permutation(len(xyz))
    np.testing.assert_array_equal(classified(xyz[order], part[order]), made[order])
    assert (classified(xyz + FAR, part) == made).mean() > 0.999


def test_cancel_gets_through():
    xyz, part = canal()
    with pytest.raises(Cancelled):
        classified(xyz, part, monitor=Listening(stop_at=0.5))


GAPS = "gaps in the ground"


@pytest.mark.parametrize("angle", [0.0, 30.0])
def test_at_gaps_the_bridge_over_a_canal_is_found_whether_it_is_ground_or_not(angle):
    xyz, part = canal(angle)
    for is_ground in (False, True):
        classes = np.where((part == EARTH) | (part == WATER) | ((part == DECK) & is_ground), 2, 1).astype(np.uint8)
        assert f_score(classify_bridges(xyz, classes, search=GAPS) == 17, part == DECK) > 0.95


@pytest.mark.parametrize(("kind", "angle"), [("cutting", 20.0), ("fly-over", 0.0), ("valley", 40.0)])
def test_at_gaps_bridges_without_water_below_are_those_of_everywhere(kind, angle):
    xyz, true, *_ = simulate_bridges(kind=kind, angle=angle, density=4.0, seed=3)
    classes = np.where(np.isin(true, (2, 9)), 2, 1).astype(np.uint8)
    at_gaps, everywhere = (classify_bridges(xyz, classes, search=search) == 17 for search in (GAPS, "everywhere"))
    assert f_score(everywhere, true == 17) > 0.85
    assert f_score(at_gaps, everywhere) > 0.95


def test_sites_of_bridges_are_few_beside_houses_and_none_on_a_slope():
    xyz, part = canal()
    decks = Decks.of(1.0, 40.0, 20.0, 1 / np.sqrt(6), 0.02)
    is_ground = (part == EARTH) | (part == WATER)
    near = deck_sites(xyz, ~is_ground, is_ground, decks)
    assert near[part == DECK].all()
    slope = np.column_stack([xyz[:, :2], xyz[:, 0] * 0.3 + np.where(part == ROOF, 4.0, 0.0)])
    assert not deck_sites(slope, part == ROOF, part != ROOF, decks).any()


def test_at_gaps_nothing_changes_where_there_is_none():
    xyz, part = canal()
    level = np.column_stack([xyz[:, :2], 0.01 * xyz[:, 2]])
    classes = np.where(part == ROOF, 17, 2).astype(np.uint8)
    np.testing.assert_array_equal(classify_bridges(level, classes, search=GAPS), classes)


def test_bridges_over_the_river_of_a_town_are_decks_by_default():
    classes, true = river_town(density=3.0)
    found, is_deck = classes == 17, true == 17
    # What else is called deck are its rails.
    assert (is_deck & found).sum() / found.sum() > 0.9
    assert (is_deck & found).sum() / is_deck.sum() > 0.5
