"""Simulated bridges: decks have the declared positions and cross their obstacles; other kinds have none."""

import numpy as np
import pytest

from lidar_buildings.algorithms.geometry.rings import signed_area
from lidar_buildings.algorithms.simulation.bridge_site import KINDS, LOT
from lidar_buildings.algorithms.simulation.simulate_bridges import simulate_bridges
from lidar_buildings.tests.builders import is_inside

GROUND, WATER, DECK = 2, 9, 17


def made(**tunables):
    *arrays, decks = simulate_bridges(**{"density": 2.0, "range_noise": 0.0, **tunables})
    return arrays[0], arrays[1], arrays[8], decks


@pytest.mark.parametrize("kind", [kind for kind in KINDS if KINDS[kind].decks])
@pytest.mark.parametrize("angle", [0.0, 35.0])
def test_decks_lie_over_what_they_cross_and_rest_on_land(kind, angle):
    xyz, classes, segment_id, decks = made(kind=kind, angle=angle, trees=False)
    assert len(decks) == len(KINDS[kind].decks)
    for number, (ring,), width, length in zip(
        decks.columns["id"], decks.geometries, decks.columns["width"], decks.columns["length"]
    ):
        assert signed_area(ring) == pytest.approx(width * length)
        inside = is_inside(xyz[:, :2], [ring])
        assert (segment_id[classes == DECK] > 0).all()
        top = xyz[inside & (classes == DECK) & (segment_id == number), 2]
        assert len(top) > 0.5 * 2.0 * width * length
        # Both ends lie on land at the height of the deck.
        ends = (ring[[0, 1]] + ring[[3, 2]]) / 2
        outward = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
        for end, way in zip(ends, (-outward, outward)):
            near = np.linalg.norm(xyz[:, :2] - (end + 3 * way), axis=1) < 2.5
            assert (classes[near] == GROUND).all()
            ground = xyz[near, 2]
            assert np.abs(ground - np.median(top)).max() < 1.2 if kind == "fly-over" else np.abs(ground).max() < 0.1
    clearance = xyz[classes == DECK, 2].max() - xyz[np.isin(classes, (GROUND, WATER)), 2].min()
    assert clearance >= (5.0 if kind == "fly-over" else KINDS[kind].depth - 1.3)


@pytest.mark.parametrize("kind", [kind for kind in KINDS if not KINDS[kind].decks])
def test_what_is_no_bridge_has_no_deck(kind):
    xyz, classes, _, decks = made(kind=kind)
    assert not len(decks)
    assert not (classes == DECK).any()
    assert np.ptp(xyz[np.isin(classes, (GROUND, WATER)), 2]) > 1.9


def test_points_lie_on_the_terrain_and_water_is_level():
    xyz, classes, _, _ = made(kind="valley", trees=False)
    level = xyz[classes == WATER, 2]
    assert len(level) > 20
    assert np.ptp(level) < 1e-4
    assert (xyz[classes == GROUND, 2] > level[0] - 1e-4).all()


def test_all_kinds_lie_side_by_side_and_seeds_turn_them():
    *arrays, decks = simulate_bridges(density=0.5)
    assert set(decks.columns["kind"]) == {kind for kind in KINDS if KINDS[kind].decks}
    assert arrays[0][:, 0].max() > 3.9 * LOT
    one, other = (made(kind="canal", seed=seed)[3].geometries[0][0] for seed in (1, 2))
    assert np.abs(one - other).max() > 1
    again = made(kind="canal", seed=1)
    np.testing.assert_array_equal(again[3].geometries[0][0], one)


def test_cars_and_trees_are_there_on_request():
    with_both = made(kind="cutting")
    without = made(kind="cutting", cars=False, trees=False)
    assert (with_both[1] == 5).any()
    assert not (without[1] == 5).any()
    assert (with_both[1] == 1).sum() > (without[1] == 1).sum()
