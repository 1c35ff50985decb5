"""The simulated flight agrees with its truth: a point is the first object on its beam, and has its class."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.asprs import VEGETATION, PointClass
from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.simulation.beams import Beams
from lidar_buildings.algorithms.simulation.bodies import Body, Rect, stack
from lidar_buildings.algorithms.simulation.drone import FIELD, DroneWorld, Flight, plan_flight, pulses_per_line
from lidar_buildings.algorithms.simulation.scene import Scene
from lidar_buildings.algorithms.simulation.simulate_flight import simulate_flight
from lidar_buildings.algorithms.simulation.street_site import build_site
from lidar_buildings.algorithms.stage import Cancelled
from lidar_buildings.tests.monitors import Listening

NAMES = simulate_flight.stage.creates
DURATION = 40.0


@cache
def small(**tunables) -> dict[str, np.ndarray]:
    return dict(zip(NAMES, simulate_flight(**{"duration": DURATION, "line_rate": 2.0, **tunables})))


def site() -> Scene:
    return build_site(trees=4, slope=1.5, seed=1)


def flight_of_small() -> Flight:
    return plan_flight(site(), 8.0, DURATION, 1)


def exact() -> tuple[np.ndarray, np.ndarray, np.ndarray, dict]:
    """Return where beams start, where they go (unit vectors), how far, and the points, all without noise."""
    made = small(range_noise=0.0)
    start = flight_of_small().positions(made["gps_time"])
    way = made["xyz"] - start
    ranges = np.linalg.norm(way, axis=1)
    return start, way / ranges[:, None], ranges, made


def of(made: dict, *classes: int) -> np.ndarray:
    return np.isin(made["classification"], classes)


def inside(solid, xyz: np.ndarray, margin: float) -> np.ndarray:
    """Which points lie deeper than a margin (m) in a solid."""
    x, y, z = xyz.T
    return solid.rect.contains(x, y, -margin) & (z > solid.bottom + margin) & (z < solid.top(x, y) - margin)


# --- Truth


def test_points_lie_on_ground_and_solids_and_in_crowns():
    scene = site()
    made = small(range_noise=0.0)
    x, y, z = made["xyz"].T
    is_ground = of(made, PointClass.GROUND)
    np.testing.assert_allclose(z[is_ground], scene.relief.ground(x, y)[is_ground], atol=1e-9)
    found = is_ground.copy()
    for solid in scene.solids:
        mine = (made["segment_id"] == solid.object_id) & (made["classification"] == solid.classification)
        along, across = solid.rect.local(x, y)
        beside = np.minimum(solid.rect.length / 2 - np.abs(along), solid.rect.width / 2 - np.abs(across))
        over, under = solid.top(x, y) - z, z - solid.bottom
        depth = np.min([beside, over, under], axis=0)
        found |= mine & (np.abs(depth) < 1e-6)
    leaves = of(made, *VEGETATION) & ~found
    crowns = np.array(scene.crowns)
    for row in np.unique(crowns[:, 6]):
        own = crowns[crowns[:, 6] == row]
        mine = np.flatnonzero(leaves & (made["segment_id"] == row))
        parts = (made["xyz"][mine, None] - own[:, :3]) / own[:, [3, 3, 4]]
        found[mine[((parts**2).sum(axis=-1) < 1 + 1e-9).any(axis=1)]] = True
    assert found.all()
    assert leaves.sum() > 500


def test_nothing_is_between_the_scanner_and_a_point():
    """Steps along the beams stay outside of every solid and over the ground: not by rays, but point by point."""
    start, way, ranges, _ = exact()
    scene = site()
    some = np.random.default_rng(0).choice(len(ranges), 4000, replace=False)
    steps = np.linspace(0.01, 1.0, 150, endpoint=False)
    places = (start[some, None] + way[some, None] * (ranges[some, None] * steps)[..., None]).reshape(-1, 3)
    for solid in scene.solids:
        assert not inside(solid, places, 1e-6).any()
    assert (places[:, 2] > scene.relief.ground(*places[:, :2].T) - 1e-6).all()


def test_beams_that_come_back_empty_meet_nothing_solid():
    """A pulse without a point is followed to the scanner's reach."""
    made = small(range_noise=0.0, trees=0, scanners="vertical")
    per_line = pulses_per_line(0.25)
    time = ((np.arange(int(DURATION * 2.0))[:, None] + np.arange(per_line) * (0.25 / 360)) / 2.0).ravel()
    empty = time[~np.isin(time, made["gps_time"])]
    assert len(empty) + len(made["gps_time"]) == len(time)
    empty = empty[:: len(empty) // 1500]
    plan = flight_of_small()
    _, left, up = plan.axes(empty)
    angle = np.deg2rad(np.mod(empty * 2.0, 1.0) * 360 - 135)[:, None]
    steps = np.linspace(0.1, 30.0, 400, endpoint=False)
    way = np.sin(angle) * left - np.cos(angle) * up
    places = (plan.positions(empty)[:, None] + way[:, None] * steps[:, None]).reshape(-1, 3)
    scene = build_site(trees=0, slope=1.5, seed=1)
    # Steps of 7 cm can miss a corner that a beam only grazes, and never a wall.
    assert not any(inside(solid, places, 0.06).any() for solid in scene.solids)
    assert (places[:, 2] > scene.relief.ground(*places[:, :2].T)).all()


@pytest.mark.parametrize("place", [(40.0, 40.0, 3.0), (30.0, 62.5, 8.0), (63.0, 20.0, 12.0), (66.0, 34.0, 10.0)])
def test_no_beam_misses_what_is_sought_in_its_direction_only(place):
    """All pairs of beams and things, from the sides, between and over them, against the few that are looked at."""
    rng = np.random.default_rng(0)
    way = rng.normal(size=(3000, 3))
    way /= np.linalg.norm(way, axis=1)[:, None]
    start = place + rng.uniform(-0.5, 0.5, (3000, 3))
    aim = np.column_stack([np.arctan2(way[:, 1], way[:, 0]), np.arcsin(way[:, 2])])
    beams = Beams(np.arange(3000), start, way, aim)
    world = DroneWorld(build_site(trees=22, slope=1.5, seed=1), 30.0)
    crowns = world.crowns
    hits = {}
    for kind, count in (("solids", len(world.solids.low)), ("crowns", len(crowns))):
        beam, thing = (part.ravel() for part in np.meshgrid(np.arange(3000), np.arange(count), indexing="ij"))
        if kind == "solids":
            ranges = world.solids.enter(thing, start[beam], way[beam])
        else:
            radius = crowns[thing][:, [3, 3, 4]]
            to, along = (start[beam] - crowns[thing, :3]) / radius, way[beam] / radius
            a, b, c = (along**2).sum(axis=1), (to * along).sum(axis=1), (to**2).sum(axis=1) - 1
            with np.errstate(invalid="ignore"):
                ranges = np.where(c > 0, (-b - np.sqrt(b * b - a * c)) / a, np.nan)
        is_hit = (ranges > 0) & (ranges < 30)
        hits[kind] = set(zip(beam[is_hit].tolist(), thing[is_hit].tolist()))
        assert hits[kind] <= set(zip(*(part.tolist() for part in world.met(kind, beams))))
    assert len(hits["solids"]) > 10
    assert len(hits["crowns"]) > 10


def test_what_lies_behind_a_beam_is_not_met():
    box = stack([Body(Rect(0.0, 0.0, 2.0, 2.0, 0.0), np.array([[0.0, 0.0, 1.0]]), -1.0, 1, 1)])
    way = np.array([[1.0, 0, 0], [-1.0, 0, 0], [1.0, 0, 0]])
    start = np.array([[-3.0, 0, 0], [-3.0, 0, 0], [0.0, 0, 0]])
    assert box.enter(np.zeros(3, int), start, way).tolist() == [2.0, np.inf, np.inf]


def test_range_noise_moves_points_along_the_beam_only():
    _, way, _, made = exact()
    shift = small(range_noise=0.05)["xyz"] - made["xyz"]
    along = np.einsum("ij,ij->i", shift, way)
    assert along.std() == pytest.approx(0.05, rel=0.02)
    assert abs(along.mean()) < 0.001
    np.testing.assert_allclose(shift, along[:, None] * way, atol=1e-9)


def test_ids_are_those_of_the_buildings():
    made = small()
    ids = {building.object_id for building in site().buildings}
    assert set(made["segment_id"][of(made, PointClass.BUILDING)]) == ids
    assert not set(made["segment_id"][~of(made, PointClass.BUILDING)]) & ids
    assert not made["segment_id"][of(made, PointClass.GROUND)].any()
    assert set(made["classification"]) == {1, 2, 4, 5, 6}


def test_things_are_not_in_each_other_or_in_the_way():
    for seed in range(1, 6):
        scene = build_site(trees=22, slope=5.0, seed=seed)
        houses = [building.solids[0].rect for building in scene.buildings]
        feet = np.array([(s.rect.x, s.rect.y) for s in scene.solids if s.classification != PointClass.BUILDING])
        assert not any(house.contains(*feet.T, 0.5).any() for house in houses)
        path = plan_flight(scene, 25.0, 60.0, seed).positions(np.linspace(0, 60, 500))
        assert not any(inside(solid, path, -0.5).any() for solid in scene.solids)
        crowns = np.array(scene.crowns)
        parts = (path[:, None] - crowns[:, :3]) / crowns[:, [3, 3, 4]]
        assert ((parts**2).sum(axis=-1) > 1).all()


# --- Flight and scanners


def test_the_drone_climbs_turns_once_and_lands_where_it_stood():
    scene = site()
    plan = plan_flight(scene, 8.0, 100.0, 1)
    time = np.linspace(0, 100, 2001)
    places, (forward, left, up) = plan.positions(time), plan.axes(time)
    height = places[:, 2] - scene.relief.ground(*places[:, :2].T)
    np.testing.assert_allclose(places[0], places[-1], atol=1e-9)
    assert height[0] == pytest.approx(0.4)
    assert np.abs(height[(time > 20) & (time < 80)] - 8.0).max() < 0.35
    assert height.min() > 0.1
    assert np.hypot(*(places - places[0])[:, :2].T).max() < 0.45
    heading = np.unwrap(np.arctan2(forward[:, 1], forward[:, 0]))
    assert heading[-1] - heading[0] == pytest.approx(2 * np.pi)
    assert np.ptp(heading[time < 20]) < np.deg2rad(1.1)
    assert np.rad2deg(np.arccos(up[:, 2])).max() < 2 * np.sqrt(2)
    frame = np.stack([forward, left, up], axis=1)
    np.testing.assert_allclose(frame @ frame.transpose(0, 2, 1), np.tile(np.eye(3), (2001, 1, 1)), atol=1e-12)
    assert (np.linalg.det(frame) > 0).all()


def test_beams_lie_in_the_planes_of_the_scanners_and_leave_a_quarter_out():
    start, way, ranges, made = exact()
    assert ranges.min() > 0.1
    assert ranges.max() < 30.0
    forward, left, up = flight_of_small().axes(made["gps_time"])
    for number, ahead, across in ((1, forward, up), (2, -up, forward)):
        mine = made["point_source_id"] == number
        assert np.abs(np.einsum("ij,ij->i", way, across)[mine]).max() < 1e-6
        angle = np.arctan2(np.einsum("ij,ij->i", way, left), np.einsum("ij,ij->i", way, ahead))[mine]
        assert np.rad2deg(np.abs(angle)).max() <= FIELD / 2 + 1e-6
        step = (np.rad2deg(angle) + FIELD / 2) / 0.25
        np.testing.assert_allclose(step, np.rint(step), atol=1e-4)
    nadir = np.rad2deg(np.arccos(-way[:, 2]))
    np.testing.assert_allclose(np.abs(made["scan_angle"]), nadir, atol=1e-4)
    is_left = np.einsum("ij,ij->i", way, left) > 1e-6
    assert (made["scan_angle"][is_left] < 0).all()


def test_each_scanner_sees_what_it_is_for():
    made = small()
    height = made["xyz"][:, 2] - site().relief.ground(*made["xyz"][:, :2].T)
    is_vertical = made["point_source_id"] == 2
    share = [of(made, PointClass.GROUND)[which].mean() for which in (~is_vertical, is_vertical)]
    assert share[0] < 0.01
    assert share[1] > 0.6
    # The turn shows all directions; before it, the vertical scanner sees one plane only.
    start = flight_of_small().positions(made["gps_time"])
    azimuth = np.rad2deg(np.arctan2(*(made["xyz"] - start)[:, [1, 0]].T))
    seen = [
        len(np.unique(azimuth[is_vertical & during] // 10))
        for during in (made["gps_time"] < DURATION / 5, made["gps_time"] > DURATION / 5)
    ]
    # Steeply down, a few degrees of tilt show more azimuths.
    far = np.abs(made["scan_angle"]) > 30
    first = is_vertical & far & (made["gps_time"] < DURATION / 5)
    assert len(np.unique(azimuth[first] // 10)) <= 6
    assert seen[1] == 36
    assert np.ptp(height[~is_vertical]) > 6


def test_one_scanner_at_a_time_gives_the_points_of_both():
    both, parts = small(), [small(scanners=name) for name in ("horizontal", "vertical")]
    for number, part in enumerate(parts, start=1):
        mine = both["point_source_id"] == number
        for name in NAMES:
            np.testing.assert_array_equal(both[name][mine], part[name])


def test_points_come_by_time_and_have_one_return():
    made = small()
    assert (np.diff(made["gps_time"]) >= 0).all()
    assert made["gps_time"][0] >= 0
    assert made["gps_time"][-1] < DURATION
    assert set(made["return_number"]) == set(made["number_of_returns"]) == {1}
    _, often = np.unique(np.column_stack([made["gps_time"], made["point_source_id"]]), axis=0, return_counts=True)
    assert (often == 1).all()


def test_with_nothing_set_there_are_as_many_points_as_in_the_publication():
    """1.44 and 5.29 million points of the two scanners; a twentieth of the lines is simulated."""
    made = dict(zip(NAMES, simulate_flight(line_rate=2.0)))
    counts = 20 * np.bincount(made["point_source_id"])[1:] / 1e6
    assert counts.sum() == pytest.approx(6.73, rel=0.05)
    assert counts[0] == pytest.approx(1.44, rel=0.2)
    assert counts[1] == pytest.approx(5.29, rel=0.1)


# --- The stage


CHANGES = {
    "height": 12.0,
    "duration": 50.0,
    "scanners": "vertical",
    "trees": 12,
    "slope": 5.0,
    "line_rate": 3.0,
    "angular_step": 1.0,
    "max_range": 12.0,
    "range_noise": 0.1,
    "seed": 2,
}


def test_every_tunable_is_tried():
    assert set(CHANGES) == set(simulate_flight.stage.tunables)


@pytest.mark.parametrize("name", CHANGES)
def test_every_tunable_has_an_effect(name):
    usual, changed = (small(**{"angular_step": 0.8, **more}) for more in ({}, {name: CHANGES[name]}))
    assert usual["xyz"].shape != changed["xyz"].shape or not np.array_equal(usual["xyz"], changed["xyz"])


def test_the_same_seed_gives_the_same_bytes():
    once, again = (simulate_flight(duration=10.0, line_rate=2.0, seed=7) for _ in range(2))
    assert [array.tobytes() for array in once] == [array.tobytes() for array in again]


def test_a_cloud_is_made_that_keeps_all_dimensions():
    cloud = run_stage(simulate_flight.stage, duration=DURATION, line_rate=2.0).cloud
    made = small()
    np.testing.assert_allclose(cloud.get("xyz"), made["xyz"], atol=6e-4)
    for name in NAMES[1:]:
        np.testing.assert_allclose(cloud.get(name), made[name], atol=0.01 if name == "scan_angle" else 0)


def test_too_many_pulses_are_refused():
    with pytest.raises(ValueError, match=r"600 s has 259 million pulses, more than 50 million; lower the duration"):
        simulate_flight(duration=600.0, line_rate=200.0)


def test_a_scanner_that_sees_nothing_is_reported():
    with pytest.raises(ValueError, match=r"Nothing is within 1 m of the scanner; raise the maximum range\."):
        simulate_flight(duration=5.0, line_rate=1.0, max_range=1.0, scanners="horizontal")


@pytest.mark.parametrize(
    "tunables",
    [
        {"height": 25.0, "trees": 22, "slope": 10.0, "max_range": 40.0},
        {"height": 2.0, "trees": 0, "slope": 0.0, "angular_step": 5.0},
        {"duration": 5.0, "line_rate": 1.0},
    ],
)
def test_extremes_work(tunables):
    made = small(**tunables)
    assert np.isfinite(made["xyz"]).all()
    assert len(made["xyz"]) > 100


def test_it_can_be_cancelled_and_progress_only_grows(monkeypatch):
    monitor = Listening(stop_at=0.5)
    with pytest.raises(Cancelled):
        simulate_flight(duration=60.0, line_rate=8.0, monitor=monitor)
    assert monitor.heard == sorted(monitor.heard)
    assert len(monitor.heard) > 3
