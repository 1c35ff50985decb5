"""The simulated site agrees with its truth: points on the right surfaces, with errors of the given size."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from lidar_buildings.algorithms.buildings.surface_evidence import greenness, greenness_between
from lidar_buildings.algorithms.cloud.asprs import VEGETATION, PointClass
from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling
from lidar_buildings.algorithms.simulation.simulate_drone_site import build_site, simulate_drone_site
from lidar_buildings.algorithms.simulation.town_layout import TownPlan
from lidar_buildings.tests.builders import is_inside

NAMES = (*simulate_drone_site.stage.creates, "footprints")
SMALL = {"size": 44.0, "density": 12.0, "halls": 1, "seed": 3}


@cache
def site(**tunables) -> dict:
    return dict(zip(NAMES, simulate_drone_site(**{**SMALL, **tunables})))


def scene_of(slope=4.0, trees=30.0):
    return build_site(TownPlan(44.0, slope, buildings=16.0, trees=trees, forest=0.0, river=False, seed=3), halls=1)


def scene():
    return scene_of()


@pytest.fixture
def exact():
    return site(unevenness=0.0, rounding=0.0, waves=0.0, noise=0.0, walls=0.0)


def test_points_of_a_building_lie_over_its_walls(exact):
    footprints = exact["footprints"]
    for rings, number in zip(footprints.geometries, footprints.columns["id"]):
        mine = exact["xyz"][exact["segment_id"] == number]
        # Cells at an edge reach half over it.
        assert is_inside(mine[:, :2], rings).mean() > 0.95


def test_points_lie_on_the_ground_and_on_roofs(exact):
    xyz, made = exact["xyz"], scene()
    on_ground = xyz[exact["classification"] == PointClass.GROUND]
    off = on_ground[:, 2] - made.relief.ground(*on_ground[:, :2].T)
    assert np.median(np.abs(off)) < 0.01
    for building in made.buildings:
        mine = xyz[exact["segment_id"] == building.object_id]
        assert np.nanmedian(np.abs(mine[:, 2] - building.roof(*mine[:, :2].T))) < 0.05


def test_nothing_lies_below_the_ground_at_the_border():
    # Faces were once drawn from each border to the one across the site.
    made = site(slope=15.0, unevenness=0.0, rounding=0.0, waves=0.0, noise=0.0, trees=0.0)
    ground = scene_of(slope=15.0, trees=0.0).relief.ground(*made["xyz"][:, :2].T)
    # Spikes are half a meter deep, one standard deviation.
    assert (made["xyz"][:, 2] - ground).min() > -2.0


def test_the_ground_is_as_uneven_as_asked(exact):
    uneven = site(unevenness=0.2, rounding=0.0, waves=0.0, noise=0.0, walls=0.0)
    xyz = uneven["xyz"][uneven["classification"] == PointClass.GROUND]
    off = xyz[:, 2] - scene().relief.ground(*xyz[:, :2].T)
    assert 0.12 < off.std() < 0.28
    # Neighbors share it: the ground is bumpy, not noisy.
    pair = np.argsort(np.floor(xyz[:, 0] / 0.5) * 1000 + np.floor(xyz[:, 1] / 0.5), kind="stable")
    beside = np.hypot(*np.diff(xyz[pair, :2], axis=0).T) < 0.3
    assert np.median(np.abs(np.diff(off[pair])[beside])) < 0.06


def test_waves_are_as_high_as_asked_and_shared_by_neighbors(exact):
    wavy = site(unevenness=0.0, rounding=0.0, waves=0.05, noise=0.0, walls=0.0)
    xyz = wavy["xyz"][wavy["classification"] == PointClass.GROUND]
    off = xyz[:, 2] - scene().relief.ground(*xyz[:, :2].T)
    off = off[np.abs(off) < 0.3]
    assert 0.025 < off.std() < 0.06


def test_rounding_lowers_the_edges_of_roofs(exact):
    def low(made):
        found = 0
        for building in scene().buildings:
            mine = made["xyz"][made["segment_id"] == building.object_id]
            found += (mine[:, 2] < building.roof(*mine[:, :2].T) - 0.3).sum()
        return found

    assert low(site(rounding=0.8, waves=0.0, noise=0.0, walls=0.0)) > 3 * low(exact) + 20


def test_it_is_one_closed_surface_crowns_included():
    made = site(density=30.0)
    sampling = CloudSampling(lambda: made["xyz"], single_returns=True)
    assert np.isin(made["classification"], VEGETATION).any()
    assert sampling.is_closed_surface()


def test_plants_are_greener_than_materials_in_light_and_shadow():
    made = site(density=30.0)
    values = greenness(*(made[color] for color in ("red", "green", "blue")))
    is_roof = made["classification"] == PointClass.BUILDING
    least = greenness_between(values[np.isin(made["classification"], VEGETATION)], values[is_roof])
    assert least is not None
    assert np.mean(values[is_roof] > least) < 0.02


def test_same_seed_gives_the_same_site_and_others_another():
    for name, values in dict(zip(NAMES[:-1], simulate_drone_site(**SMALL))).items():
        np.testing.assert_array_equal(site()[name], values)
    assert len(site(seed=4)["xyz"]) != len(site()["xyz"])


def test_too_many_points_are_refused():
    with pytest.raises(ValueError, match="million points"):
        simulate_drone_site(size=400.0, density=400.0)
