"""The simulated town agrees with its truth: every point lies on the object of its class."""

from __future__ import annotations

from functools import cache, lru_cache

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.asprs import NOISE, VEGETATION, PointClass
from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.simulation.scanner import AirSurvey, scan
from lidar_buildings.algorithms.simulation.scene import Scene
from lidar_buildings.algorithms.simulation.simulate_town import simulate_town
from lidar_buildings.algorithms.simulation.town_layout import TownPlan, build_town
from lidar_buildings.algorithms.stage import Cancelled
from lidar_buildings.tests.monitors import Listening

NAMES = simulate_town.stage.creates


@lru_cache(maxsize=2)
def exact_town(slope: float = 3.0) -> tuple[Scene, dict[str, np.ndarray]]:
    """A town of 150 m scanned without range noise."""
    scene = build_town(TownPlan(size=150.0, slope=slope, buildings=30.0))
    return scene, scan(scene, AirSurvey(density=6.0, range_noise=0.0))


@cache
def small(**tunables) -> dict[str, np.ndarray]:
    return dict(zip(NAMES, simulate_town(**{"size": 100.0, "density": 3.0, **tunables})))


def of(scanned: dict[str, np.ndarray], *classes: int) -> np.ndarray:
    return np.isin(scanned["classification"], classes)


# --- Truth


@pytest.mark.parametrize("slope", [3.0, 35.0])
def test_ground_points_lie_on_the_ground_and_water_is_level(slope):
    scene, made = exact_town(slope)
    x, y, z = made["xyz"][of(made, PointClass.GROUND)].T
    assert len(x) > 50_000
    np.testing.assert_allclose(z, scene.relief.ground(x, y), atol=1e-4)
    water = made["xyz"][of(made, PointClass.WATER)]
    assert len(water) > 50
    np.testing.assert_allclose(water[:, 2], scene.relief.water_level, atol=1e-4)
    assert (scene.relief.ground(*water[:, :2].T) <= scene.relief.water_level + 1e-4).all()


@pytest.mark.parametrize("slope", [3.0, 35.0])
def test_building_points_lie_on_roofs_or_on_walls(slope):
    scene, made = exact_town(slope)
    found = of(made, PointClass.BUILDING)
    n_roof = n_wall = 0
    for building in scene.buildings:
        x, y, z = made["xyz"][found & (made["segment_id"] == building.object_id)].T
        on_roof, on_wall = np.zeros((2, len(x)), bool)
        for solid in building.solids:
            along, across = solid.rect.local(x, y)
            inside = solid.rect.contains(x, y, 1e-6)
            edge = np.minimum(solid.rect.length / 2 - np.abs(along), solid.rect.width / 2 - np.abs(across))
            on_roof |= inside & (np.abs(z - solid.top(x, y)) < 1e-6)
            on_wall |= inside & (np.abs(edge) < 1e-6) & (z < solid.top(x, y) + 1e-6)
        assert (on_roof | on_wall).all()
        n_roof, n_wall = n_roof + on_roof.sum(), n_wall + (on_wall & ~on_roof).sum()
    assert n_roof + n_wall == found.sum()
    assert n_roof > 5_000
    assert 100 < n_wall < n_roof


def test_nothing_is_seen_inside_a_building():
    scene, made = exact_town()
    x, y, z = made["xyz"][~of(made, *NOISE, *VEGETATION)].T
    for building in scene.buildings:
        for solid in building.solids:
            assert not (solid.rect.contains(x, y, -1e-6) & (z < solid.top(x, y) - 1e-6)).any()


def test_range_noise_moves_points_along_the_beam_only():
    scene = build_town(TownPlan(size=100.0))
    exact, rough = (scan(scene, AirSurvey(density=4.0, range_noise=sigma)) for sigma in (0.0, 0.05))
    shift = rough["xyz"] - exact["xyz"]
    assert np.linalg.norm(shift, axis=1).std(ddof=0) > 0.02
    assert np.sqrt((shift**2).sum(axis=1).mean()) == pytest.approx(0.05, rel=0.02)
    # The strips are flown from west to east: beams lean to the north and south only, by the scan angle.
    lean = np.rad2deg(np.arctan2(np.hypot(shift[:, 0], shift[:, 1]), np.abs(shift[:, 2])))
    np.testing.assert_allclose(lean, np.abs(exact["scan_angle"]), atol=0.05)


def test_outlines_are_closed_counterclockwise_and_as_large_as_the_roofs():
    scene, _ = exact_town()
    kinds = {building.kind for building in build_town(TownPlan(size=300.0, forest=0.0, buildings=34.0)).buildings}
    assert kinds == {"gable", "hip", "flat", "L", "row", "shed", "hall"}
    for building in scene.buildings:
        np.testing.assert_array_equal(building.outline[0], building.outline[-1])
        low, high = building.outline.min(axis=0) - 1, building.outline.max(axis=0) + 1
        grid = np.stack(np.meshgrid(*(np.arange(a, b, 0.1) for a, b in zip(low, high))), axis=-1)
        assert building.contains(*grid.reshape(-1, 2).T).sum() * 0.01 == pytest.approx(building.area, rel=0.03)


def test_buildings_do_not_overlap():
    scene = build_town(TownPlan(size=300.0, forest=0.0, buildings=34.0))
    positions = np.random.default_rng(0).uniform(0, 300, (100_000, 2))
    assert sum(building.contains(*positions.T).astype(int) for building in scene.buildings).max() == 1


def test_rows_share_walls_and_differ_in_height():
    scene = build_town(TownPlan(size=300.0, forest=0.0, buildings=34.0))
    rows = [building for building in scene.buildings if building.kind == "row"]
    shared = 0
    for a, b in zip(rows, rows[1:]):
        same = np.linalg.norm(a.outline[:-1, None] - b.outline[None, :-1], axis=2) < 1e-6
        shared += same.sum() == 2
        if same.sum() == 2:
            assert a.solids[0].rect.width == b.solids[0].rect.width
    assert shared >= len(rows) / 2


# --- The scan


@pytest.mark.parametrize("pattern", ["lines", "zigzag", "random"])
@pytest.mark.parametrize("density", [1.0, 20.0])
def test_density_over_open_ground_is_as_asked(pattern, density):
    made = small(pattern=pattern, density=density, buildings=0.0, trees=0.0, forest=0.0, river=False, clutter=False)
    x, y, _ = made["xyz"].T
    inner = (np.abs(x - 50) < 40) & (np.abs(y - 50) < 40)
    assert inner.sum() / 6400 == pytest.approx(density, rel=0.1)


def test_strips_overlap_as_asked():
    made = small(size=400.0, density=1.0, overlap=0.5, buildings=0.0, trees=0.0, forest=0.0, river=False, clutter=False)
    x, y, _ = made["xyz"].T
    strips = [set(np.unique(made["point_source_id"][(y >= low) & (y < low + 20)])) for low in range(0, 400, 20)]
    # Half of every strip is scanned by the one before, half by the one after.
    assert np.mean([len(seen) for seen in strips[1:-1]]) == pytest.approx(2.0, abs=0.2)
    alone = small(
        size=400.0, density=1.0, overlap=0.0, buildings=0.0, trees=0.0, forest=0.0, river=False, clutter=False
    )
    assert len(alone["xyz"]) == pytest.approx(len(made["xyz"]), rel=0.01)


@pytest.mark.parametrize("max_scan_angle", [10.0, 30.0])
@pytest.mark.parametrize("slope", [0.0, 40.0])
def test_scan_angle_stays_within_its_bound_and_shows_the_side(max_scan_angle, slope):
    made = small(size=300.0, density=0.5, max_scan_angle=max_scan_angle, slope=slope)
    angle = np.abs(made["scan_angle"])
    assert 0.9 * max_scan_angle < angle.max() <= max_scan_angle + 0.1
    # The first strip is flown to the east, with the north on the left.
    first = made["point_source_id"] == 1
    assert np.corrcoef(made["xyz"][first, 1], made["scan_angle"][first])[0, 1] < -0.95
    assert np.corrcoef(made["xyz"][first, 0], made["gps_time"][first])[0, 1] > 0.99
    second = made["point_source_id"] == 2
    assert np.corrcoef(made["xyz"][second, 1], made["scan_angle"][second])[0, 1] > 0.95
    assert np.corrcoef(made["xyz"][second, 0], made["gps_time"][second])[0, 1] < -0.99


def test_wider_strips_show_more_of_walls():
    scene = build_town(TownPlan(size=150.0))
    seen = []
    for angle in (5.0, 30.0):
        made = scan(scene, AirSurvey(max_scan_angle=angle, range_noise=0.0))
        x, y, z = made["xyz"][of(made, PointClass.BUILDING)].T
        height = np.full(len(x), -np.inf)
        for building in scene.buildings:
            height = np.fmax(height, building.roof(x, y))
        seen.append(np.mean(z < height - 0.5))
    assert seen[1] > 2 * seen[0]


def test_returns_of_a_pulse_are_complete_and_in_order():
    _, made = exact_town()
    pulse, first, count = np.unique(made["pulse"], return_index=True, return_counts=True)
    assert (np.diff(made["pulse"]) >= 0).all()
    np.testing.assert_array_equal(made["number_of_returns"], np.repeat(count, count))
    np.testing.assert_array_equal(made["return_number"], np.arange(len(made["pulse"])) - np.repeat(first, count) + 1)
    assert made["number_of_returns"].max() == 5
    inner = np.flatnonzero(np.diff(made["pulse"]) == 0)
    gap = np.linalg.norm(made["xyz"][inner + 1] - made["xyz"][inner], axis=1)
    # Echoes of a pulse are further apart than the range resolution of the scanner, and never in the wrong order.
    assert gap.min() > 0.65
    assert (made["xyz"][inner + 1, 2] < made["xyz"][inner, 2]).all()
    assert (np.diff(made["gps_time"]) >= 0).all()
    assert (made["gps_time"][inner + 1] == made["gps_time"][inner]).all()


def test_trees_have_several_returns_and_let_pulses_through_and_open_ground_has_one():
    _, made = exact_town()
    several = made["number_of_returns"] > 1
    assert several[of(made, *VEGETATION)].mean() > 0.5
    assert several[of(made, PointClass.GROUND)].mean() < 0.2
    under = of(made, PointClass.GROUND) & several
    assert under.sum() > 500
    assert (made["return_number"][under] >= 1).all()
    # The edges of roofs give a return of the roof and one of what lies below.
    assert 0 < several[of(made, PointClass.BUILDING)].mean() < 0.2


def test_without_returns_only_first_surfaces_are_seen_and_numbers_are_unknown():
    every, top = small(), small(returns=False)
    assert not top["return_number"].any()
    assert not top["number_of_returns"].any()
    first = every["return_number"] == 1
    assert len(top["xyz"]) == pytest.approx(first.sum(), rel=0.01)
    # The ground below a crown is the last of several returns: it is lost.
    is_ground = every["classification"] == PointClass.GROUND
    n_seen = (top["classification"] == PointClass.GROUND).sum()
    assert n_seen == pytest.approx((is_ground & first).sum(), rel=0.01)
    assert n_seen < is_ground.sum() - 500


# --- Classes


def test_all_promised_classes_are_there():
    _, made = exact_town()
    assert set(np.unique(made["classification"])) == {1, 2, 3, 4, 5, 6, 7, 9, 14, 15, 17, 18}


def test_vegetation_is_classified_by_height_and_stems_are_high():
    scene, made = exact_town()
    on_stem = np.zeros(len(made["xyz"]), bool)
    for solid in scene.solids:
        if solid.classification == PointClass.HIGH_VEGETATION:
            on_stem |= (made["segment_id"] == solid.object_id) & solid.rect.contains(*made["xyz"][:, :2].T, 1e-6)
    height = made["xyz"][:, 2] - scene.relief.ground(*made["xyz"][:, :2].T)
    for classification, low, high in zip(VEGETATION, (-0.1, 0.5, 2.0), (0.5, 2.0, 30.0)):
        found = height[of(made, classification) & ~on_stem]
        assert len(found) > 20
        assert low <= found.min()
        assert found.max() <= high


def test_noise_points_are_as_many_as_asked_and_lie_far_off():
    for per_hectare in (0.0, 50.0, 1000.0):
        made = small(noise_points=per_hectare)
        counts = [int((made["classification"] == noise).sum()) for noise in NOISE]
        assert counts == [per_hectare / 2, per_hectare / 2]
    scene = build_town(TownPlan(size=100.0))
    made = scan(scene, AirSurvey(density=3.0, noise_points=200.0))
    height = made["xyz"][:, 2] - scene.relief.ground(*made["xyz"][:, :2].T)
    low, high = (height[of(made, noise)] for noise in (PointClass.LOW_NOISE, PointClass.HIGH_NOISE))
    # Heights lie along the beam; where the ground is steep that is a little less straight down.
    assert -20 < low.min() < low.max() < -0.5
    assert 20 < high.min() < high.max() < 130
    others = height[~of(made, *NOISE)]
    assert others.min() > -0.2
    assert others.max() < 30


def test_a_field_has_no_buildings_and_bare_ground_nothing_at_all():
    assert PointClass.BUILDING not in small(buildings=0.0)["classification"]
    bare = small(buildings=0.0, trees=0.0, forest=0.0, river=False, clutter=False, noise_points=0.0)
    assert set(bare["classification"]) == {PointClass.GROUND}
    assert not bare["segment_id"].any()
    assert (bare["number_of_returns"] == 1).all()
    assert len(bare["xyz"]) == pytest.approx(30_000, rel=0.02)


@pytest.mark.parametrize("slope", [0.0, 10.0, 40.0])
def test_the_ground_slopes_as_asked(slope):
    tunables = {"buildings": 0.0, "trees": 0.0, "forest": 0.0, "river": False, "clutter": False, "noise_points": 0.0}
    x, y, z = small(slope=slope, relief=0.0, terrace_height=0.0, range_noise=0.0, **tunables)["xyz"].T
    (a, b, _), residual, *_ = np.linalg.lstsq(np.column_stack([x, y, np.ones_like(x)]), z, rcond=None)
    assert np.rad2deg(np.arctan(np.hypot(a, b))) == pytest.approx(slope, abs=1e-3)
    assert residual.item() < 1e-4


def test_ids_are_those_of_the_buildings():
    scene, made = exact_town()
    ids = {building.object_id for building in scene.buildings}
    assert set(np.unique(made["segment_id"][of(made, PointClass.BUILDING)])) <= ids
    assert not set(np.unique(made["segment_id"][~of(made, PointClass.BUILDING)])) & ids
    assert not made["segment_id"][of(made, PointClass.GROUND, PointClass.WATER, *NOISE)].any()


# --- The stage


CHANGES = {
    "size": 120.0,
    "density": 4.0,
    "buildings": 34.0,
    "trees": 60.0,
    "forest": 0.4,
    "slope": 12.0,
    "relief": 6.0,
    "terrace_height": 3.0,
    "river": False,
    "clutter": False,
    "pattern": "zigzag",
    "max_scan_angle": 10.0,
    "overlap": 0.6,
    "range_noise": 0.1,
    "noise_points": 100.0,
    "returns": False,
    "seed": 2,
}


def test_every_tunable_is_tried():
    assert set(CHANGES) == set(simulate_town.stage.tunables)


@pytest.mark.parametrize("name", CHANGES)
def test_every_tunable_has_an_effect(name):
    usual, changed = (small(**{"density": 1.0, **more}) for more in ({}, {name: CHANGES[name]}))
    assert usual["xyz"].shape != changed["xyz"].shape or not np.array_equal(usual["xyz"], changed["xyz"])


@pytest.mark.parametrize(
    ("name", "classification"),
    [("buildings", PointClass.BUILDING), ("trees", PointClass.HIGH_VEGETATION), ("forest", PointClass.HIGH_VEGETATION)],
)
def test_more_is_more(name, classification):
    counts = [(small(**{name: value})["classification"] == classification).sum() for value in (0.0, CHANGES[name])]
    assert counts[1] > counts[0] + 500


def test_the_same_seed_gives_the_same_bytes():
    tunables = {"size": 80.0, "density": 4.0}
    once, again, other = (simulate_town(**tunables, seed=seed) for seed in (7, 7, 8))
    assert [array.tobytes() for array in once] == [array.tobytes() for array in again]
    assert once[0].tobytes() != other[0].tobytes()


def test_density_does_not_change_the_town():
    coarse, fine = (set(small(density=density)["segment_id"]) for density in (10.0, 20.0))
    assert len(fine - coarse) < 0.1 * len(fine)
    for a, b in zip(build_town(TownPlan(seed=3)).buildings, build_town(TownPlan(seed=3)).buildings):
        np.testing.assert_array_equal(a.outline, b.outline)


def test_a_cloud_is_made_that_keeps_all_dimensions():
    cloud = run_stage(simulate_town.stage, size=60.0, density=2.0).cloud
    made = dict(zip(NAMES, simulate_town(size=60.0, density=2.0)))
    np.testing.assert_allclose(cloud.get("xyz"), made["xyz"], atol=6e-4)
    for name in NAMES[1:]:
        np.testing.assert_allclose(cloud.get(name), made[name], atol=0.01 if name == "scan_angle" else 0)


def test_too_many_pulses_are_refused():
    with pytest.raises(ValueError, match=r"400 million pulses.*lower size or density"):
        simulate_town(size=2000.0, density=100.0)


@pytest.mark.parametrize("end", [0.05, 0.5])
def test_it_can_be_cancelled(end):
    monitor = Listening(stop_at=end)
    with pytest.raises(Cancelled):
        simulate_town(size=100.0, monitor=monitor)
    assert min(monitor.heard) >= 0
    assert end <= max(monitor.heard) <= 1


def test_progress_only_grows():
    monitor = Listening()
    simulate_town(size=100.0, density=3.0, monitor=monitor)
    assert monitor.heard == sorted(monitor.heard)
    assert monitor.heard[-1] == 1.0


@pytest.mark.parametrize(
    "tunables",
    [
        {"size": 50.0, "density": 0.5},
        {"forest": 1.0},
        {"trees": 200.0, "buildings": 34.0},
        {"slope": 40.0, "relief": 10.0, "terrace_height": 5.0, "max_scan_angle": 30.0, "overlap": 0.8},
    ],
)
def test_extremes_work(tunables):
    made = small(**tunables)
    assert np.isfinite(made["xyz"]).all()
    assert (made["classification"] == PointClass.GROUND).sum() > 100
