"""The simulated village agrees with its truth: points lie on roofs, walls and ground; maps have the given errors."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.asprs import NOISE, PointClass
from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.simulation.bodies import Body, Rect, inclined, stack
from lidar_buildings.algorithms.simulation.simulate_village import photograph, simulate_village
from lidar_buildings.algorithms.simulation.village_layout import build_village
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.tests.builders import is_inside
from lidar_buildings.tests.monitors import Listening

NAMES = (*simulate_village.stage.creates, "footprints", "old_map")
OVERHANG = 0.5


@cache
def small(**tunables) -> dict:
    return dict(zip(NAMES, simulate_village(**{"size": 80.0, "density": 8.0, **tunables})))


@cache
def exact():
    """A village without trees or bushes, and what the camera sees of it before any noise."""
    made = build_village(150.0, 5.0, buildings=15.0, trees=0.0, overhang=OVERHANG, clutter=False, seed=3)
    return made, *photograph(made.scene, density=25.0, oblique=28.0, seed=3, monitor=Monitor())


def distance(ring, xy):
    """The distance of points (n, 2) to the nearest edge of a closed ring."""
    found = np.full(len(xy), np.inf)
    for a, b in zip(ring, ring[1:]):
        step = b - a
        share = np.clip((xy - a) @ step / (step @ step), 0, 1)
        found = np.minimum(found, np.hypot(*(xy - a - share[:, None] * step).T))
    return found


def test_points_of_a_building_lie_on_its_walls_or_on_the_roof_over_them():
    made, xyz, seen = exact()
    assert {building.kind for building in made.scene.buildings} == {"rectangle", "hip", "L", "bend", "shed"}
    for building in made.scene.buildings:
        mine = made.owner[seen.object_id] == building.object_id
        is_wall = seen.object_id[mine] == building.object_id
        points, ring = xyz[mine], building.outline
        # Gables show between the slabs of the roof; all other points of a wall lie on the outline.
        assert distance(ring, points[is_wall, :2]).max() < 1e-6
        roof = points[~is_wall]
        away = np.where(is_inside(roof[:, :2], [ring]), 0.0, distance(ring, roof[:, :2]))
        widest = OVERHANG / 2 if building.kind == "shed" else OVERHANG
        assert widest - 0.1 < away.max() < widest * np.sqrt(2) + 1e-6
        assert 12 < is_wall.sum() < 0.25 * len(points)


def test_the_wall_right_under_the_eaves_is_hidden():
    made, xyz, seen = exact()
    for building in made.scene.buildings:
        if building.kind != "hip":
            continue
        z = xyz[seen.object_id == building.object_id, 2]
        eave = min(solid.bottom for solid in building.solids[1:])
        assert eave - z.max() == pytest.approx(OVERHANG / np.tan(np.deg2rad(28.0)), abs=0.12)


def test_walls_have_the_density_of_their_views():
    """A wall that faces a view has the share of that view, times the tangent of its angle."""
    made, xyz, seen = exact()
    found, expected = 0.0, 0.0
    for building in made.scene.buildings:
        if building.kind != "hip":
            continue
        ring, eave = building.outline, min(solid.bottom for solid in building.solids[1:])
        top = eave - OVERHANG / np.tan(np.deg2rad(28.0)) * 1.6
        points = xyz[seen.object_id == building.object_id]
        for a, b in zip(ring, ring[1:]):
            middle, length = (a + b) / 2, np.hypot(*(b - a))
            outward = np.array([b[1] - a[1], a[0] - b[0]]) / length
            facing = [
                max(0.0, outward @ (np.cos(t), np.sin(t))) for t in made.scene.relief.angle + np.arange(4) * np.pi / 2
            ]
            low = made.scene.relief.ground(*middle) + 0.5
            near = distance(np.array([a, b]), points[:, :2]) < 1e-6
            found += (near & (points[:, 2] > low) & (points[:, 2] < top)).sum()
            expected += 25.0 / 5 * np.tan(np.deg2rad(28.0)) * sum(facing) * length * (top - low)
    assert expected > 400
    assert found == pytest.approx(expected, rel=0.1)


def test_a_slab_has_an_inclined_underside():
    slope = inclined(Rect(0.0, 0.0, 4.0, 4.0, 0.0), 0.0, 0.0, 5.0, 0.5, 0.0)
    slab = Body(Rect(0.0, 0.0, 4.0, 4.0, 0.0), slope[None], 3.8, 6, 1, slope - [0.0, 0.0, 0.2])
    arrays = stack([slab, slab])
    origin = np.array([[1.0, 0.0, 0.0], [1.0, 0.0, 10.0]])
    way = arrays.enter(np.array([0, 1]), origin, np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]))
    np.testing.assert_allclose(way, [5.3, 4.5])


@pytest.mark.parametrize("kind", ["rectangle", "hip", "L", "bend", "shed"])
def test_outlines_are_closed_counterclockwise_and_meet_the_walls(kind):
    made, _, _ = exact()
    for building in made.scene.buildings:
        if building.kind != kind:
            continue
        ring = building.outline
        np.testing.assert_array_equal(ring[0], ring[-1])
        assert len(ring) - 1 == {"L": 6, "bend": 6}.get(kind, 4)
        steps = np.diff(ring, axis=0)
        turns = np.rad2deg(
            np.arctan2(*np.array([(b[0] * c[1] - b[1] * c[0], b @ c) for b, c in zip(steps, np.roll(steps, -1, 0))]).T)
        )
        assert turns.sum() == pytest.approx(360)
        if kind == "bend":
            bends = np.sort(np.abs(turns))[:2]
            np.testing.assert_allclose(bends[0], bends[1])
            assert 15 <= bends[0] <= 40
        else:
            np.testing.assert_allclose(np.abs(turns), 90, atol=1e-6)
        # What solids with the walls' id cover is the inside of the ring.
        low, high = ring.min(axis=0) - 0.5, ring.max(axis=0) + 0.5
        grid = np.stack(np.meshgrid(*(np.arange(a, b, 0.1) for a, b in zip(low, high))), axis=-1).reshape(-1, 2)
        grid = grid[distance(ring, grid) > 1e-3]
        bodies = [solid for solid in building.solids if solid.object_id == building.object_id]
        covered = np.any([solid.rect.contains(*grid.T) for solid in bodies], axis=0)
        if kind == "L":  # the wing's body starts inside the main one
            covered |= bodies[0].rect.contains(*grid.T)
        np.testing.assert_array_equal(covered, is_inside(grid, [ring]))


def test_buildings_are_apart():
    made = build_village(250.0, 2.0, buildings=15.0, trees=0.0, overhang=0.6, clutter=False, seed=5)
    places = np.random.default_rng(0).uniform(0, 250, (100_000, 2))
    assert len(made.scene.buildings) > 60
    assert sum(building.contains(*places.T).astype(int) for building in made.scene.buildings).max() == 1


def test_density_and_noise_are_as_asked():
    empty = {"buildings": 0.0, "trees": 0.0, "holes": 0.0, "noise_points": 0.0, "slope": 0.0}
    made = small(**empty, noise=0.05)
    inner = (np.abs(made["xyz"][:, :2] - 40) < 35).all(axis=1)
    assert inner.sum() / 4900 == pytest.approx(8.0, rel=0.03)
    exact_ones, noisy = small(**empty, noise=0.0)["xyz"], made["xyz"]
    np.testing.assert_allclose((noisy - exact_ones).std(axis=0), 0.05, rtol=0.02)


@pytest.mark.parametrize("share", [0.1, 0.4])
def test_holes_take_their_share(share):
    whole, torn = (len(small(holes=holes, noise_points=0.0)["xyz"]) for holes in (0.0, share))
    assert 1 - torn / whole == pytest.approx(share, rel=0.25)


def test_returns_are_unknown_and_colors_separate_materials():
    made = small()
    assert not made["return_number"].any()
    assert not made["number_of_returns"].any()
    leaves, roofs = (made["classification"] == kind for kind in (PointClass.HIGH_VEGETATION, PointClass.BUILDING))
    assert made["green"][leaves].mean() > 1.2 * made["red"][leaves].mean()
    assert made["green"][roofs].mean() < made["red"][roofs].mean()
    assert np.isin(
        made["segment_id"][made["classification"] == PointClass.BUILDING], made["footprints"].columns["id"]
    ).all()
    assert not made["segment_id"][np.isin(made["classification"], (PointClass.GROUND, *NOISE))].any()


def test_the_old_map_is_displaced_as_asked():
    made = small(size=120.0, map_shift=0.7, map_noise=0.0, map_changes=0.0)
    assert len(made["old_map"]) == len(made["footprints"]) > 10
    for old, true in zip(made["old_map"].geometries, made["footprints"].geometries):
        np.testing.assert_allclose(old[0], true[0] + 0.7)
    made = small(size=220.0, density=5.0, trees=0.0, buildings=9.0, map_shift=0.2, map_noise=0.1, map_changes=0.2)
    truth = dict(zip(made["footprints"].columns["id"], made["footprints"].geometries))
    table = made["old_map"].columns
    missing = set(truth) - set(table["building"])
    assert len(missing) == round(0.2 * len(truth)) == table["state"].count("demolished")
    steps = [
        (old[0] - truth[number][0])[:-1] for old, number in zip(made["old_map"].geometries, table["building"]) if number
    ]
    steps = np.concatenate(steps)
    np.testing.assert_allclose(steps.mean(axis=0), 0.2, atol=0.04)
    np.testing.assert_allclose(steps.std(axis=0), 0.1, rtol=0.15)
    gone = [old[0] for old, state in zip(made["old_map"].geometries, table["state"]) if state == "demolished"]
    is_building = made["classification"] == PointClass.BUILDING
    assert all(not is_inside(made["xyz"][is_building, :2], [ring]).any() for ring in gone)


CHANGES = {
    "size": 90.0,
    "density": 6.0,
    "buildings": 6.0,
    "trees": 40.0,
    "slope": 8.0,
    "overhang": 0.2,
    "clutter": False,
    "noise": 0.06,
    "holes": 0.3,
    "oblique": 20.0,
    "noise_points": 100.0,
    "map_shift": 0.1,
    "map_noise": 0.3,
    "map_changes": 0.3,
    "seed": 2,
}


def test_every_tunable_is_tried():
    assert set(CHANGES) == set(simulate_village.stage.tunables)


@pytest.mark.parametrize("name", CHANGES)
def test_every_tunable_has_an_effect(name):
    usual, changed = small(), small(**{name: CHANGES[name]})
    if name.startswith("map"):
        usual, changed = (
            np.concatenate([rings[0] for rings in made["old_map"].geometries]) for made in (usual, changed)
        )
    else:
        usual, changed = usual["xyz"], changed["xyz"]
    assert usual.shape != changed.shape or not np.array_equal(usual, changed)


def test_the_same_seed_gives_the_same_bytes():
    once, again = (simulate_village(size=60.0, density=5.0, seed=7)[:-2] for _ in range(2))
    assert [array.tobytes() for array in once] == [array.tobytes() for array in again]


def test_points_do_not_depend_on_the_errors_of_the_map():
    a, b = (small(map_noise=noise)["xyz"] for noise in (0.15, 0.3))
    np.testing.assert_array_equal(a, b)


def test_a_cloud_is_made_that_keeps_all_dimensions():
    outcome = run_stage(simulate_village.stage, size=60.0, density=5.0)
    assert set(outcome.layers) == {"footprints", "old_map"}
    made = dict(zip(NAMES, simulate_village(size=60.0, density=5.0)))
    np.testing.assert_allclose(outcome.cloud.get("xyz"), made["xyz"], atol=6e-4)
    for name in simulate_village.stage.creates[1:]:
        np.testing.assert_array_equal(outcome.cloud.get(name), made[name])


def test_too_many_points_are_refused():
    with pytest.raises(ValueError, match=r"100 million points.*lower size or density"):
        simulate_village(size=1000.0, density=100.0)


def test_a_village_without_houses_is_reported():
    """Seed 1 has no whole plot within 60 m; where no houses are asked for, no warning comes."""
    reported = {}
    for size, buildings in ((60.0, 12.0), (60.0, 0.0), (80.0, 12.0)):
        monitor = Monitor()
        *_, footprints, _ = simulate_village(size=size, buildings=buildings, density=5.0, monitor=monitor)
        reported[size, buildings] = len(footprints) > 0, len(monitor.warnings)
    assert reported == {(60.0, 12.0): (False, 1), (60.0, 0.0): (False, 0), (80.0, 12.0): (True, 0)}


def test_it_can_be_cancelled():
    with pytest.raises(Cancelled):
        simulate_village(size=60.0, density=100.0, monitor=Listening(stop_at=0.4))


@pytest.mark.parametrize(
    "tunables",
    [
        {"size": 50.0, "buildings": 0.0},
        {"oblique": 0.0},
        {"overhang": 0.0},
        {"slope": 20.0, "oblique": 30.0},
        {"holes": 0.5, "trees": 200.0},
    ],
)
def test_extremes_work(tunables):
    made = small(**tunables)
    assert np.isfinite(made["xyz"]).all()
    assert (made["classification"] == PointClass.GROUND).sum() > 1000
