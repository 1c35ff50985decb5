"""Streets scanned from a vehicle: points lie where the truth says, and what hides a front is before it."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.simulation.simulate_street import simulate_street

QUICK = {"length": 30.0, "line_rate": 25.0, "angular_step": 1.0}


@pytest.fixture(scope="module")
def street():
    return made()


def made(**tunables):
    *arrays, facades, openings, corners, _ = simulate_street(**{**QUICK, **tunables})
    return dict(zip(simulate_street.stage.creates, arrays)), facades, openings, corners


def plane(ring):
    """Return a point and the outward unit normal of a ring."""
    normal = np.cross(ring[:-1] - ring[0], ring[1:] - ring[0]).sum(axis=0)
    return ring[0], normal / np.linalg.norm(normal)


def test_points_of_facades_lie_on_them_but_for_the_noise(street):
    points, facades, _, _ = street
    for number, (ring,) in zip(facades.columns["id"], facades.geometries):
        origin, normal = plane(ring)
        off = (points["xyz"][points["segment_id"] == number] - origin) @ normal
        assert np.abs(off).max(initial=0) < 0.06
        assert len(off) < 100 or np.std(off) < 0.015
    assert np.mean(np.bincount(points["segment_id"])[1:] > 100) > 0.8


def test_facades_are_upright_planar_and_face_the_street(street):
    points, facades, _, corners = street
    middle = np.mean([ring[:-1].mean(axis=0) for (ring,) in facades.geometries], axis=0)
    for (ring,), kind in zip(facades.geometries, facades.columns["kind"]):
        origin, normal = plane(ring)
        assert abs(normal[2]) < 1e-9
        assert np.abs((ring - origin) @ normal).max() < 1e-9
        if kind in ("plain", "balconies", "curved"):
            assert (middle - origin) @ normal > 0
    rings = np.concatenate([ring[:-1] for (ring,) in facades.geometries])
    np.testing.assert_array_equal(np.array(corners.geometries), rings)


def test_openings_lie_in_the_plane_of_their_facade_and_their_points_behind_it(street):
    points, facades, openings, _ = street
    for i, (ring,) in enumerate(openings.geometries):
        origin, normal = plane(facades.geometries[openings.columns["facade"][i] - 1][0])
        assert np.abs((ring - origin) @ normal).max() < 1e-9
        own = points["xyz"][points["cluster_id"] == openings.columns["id"][i]]
        off = (own - origin) @ normal
        assert ((off > -0.25) & (off < -0.05)).all()
    assert set(openings.columns["kind"]) == {"window", "door"}
    windows = [w for w, kind in zip(openings.columns["width"], openings.columns["kind"]) if kind == "window"]
    assert windows == pytest.approx([1.2] * len(windows))


def test_lines_are_reported_by_time_and_scanner(street):
    points, *_ = street
    assert set(points["point_source_id"]) == {1, 2}
    assert (np.diff(points["gps_time"]) >= 0).all()
    assert points["gps_time"].max() == pytest.approx(30.0 / 5.0, rel=0.02)


def test_glass_lets_pulses_pass_and_clutter_hides():
    through, _, _, _ = made(glass=100.0, clutter=False)
    mirrored, _, _, _ = made(glass=0.0, clutter=False)
    cluttered, _, _, _ = made(glass=0.0)
    assert 0 < np.sum(through["cluster_id"] > 0) < 0.5 * np.sum(mirrored["cluster_id"] > 0)
    assert np.sum(cluttered["segment_id"] > 0) < 0.95 * np.sum(mirrored["segment_id"] > 0)
    assert set(np.unique(mirrored["classification"])) == {PointClass.GROUND, PointClass.BUILDING}
    assert PointClass.UNCLASSIFIED in cluttered["classification"]


def test_stoops_raise_doors_and_have_stairs_up_to_them():
    """Each door begins 2 m over the street, with something of a building up to its sill before it."""
    points, facades, openings, _ = made(stoops=2.0, slope=0.0, clutter=False, line_rate=50.0, angular_step=0.5)
    kinds = np.array(openings.columns["kind"])
    low = np.array([ring[:, 2].min() for (ring,) in openings.geometries])
    assert low[kinds == "door"] == pytest.approx([2.0] * np.sum(kinds == "door"))
    assert sorted(set(np.round(low[kinds == "window"], 2)))[:2] == [0.25, 2.9]
    stairs = points["xyz"][(points["classification"] == PointClass.BUILDING) & (points["segment_id"] == 0)]
    seen = 0
    for (ring,), kind, facade in zip(openings.geometries, kinds, openings.columns["facade"]):
        origin, normal = plane(facades.geometries[facade - 1][0])
        near = np.linalg.norm((stairs - ring[:2].mean(axis=0))[:, :2], axis=1) < 1.4
        before = near & ((stairs - origin) @ normal > 0.3) & (stairs[:, 2] < 2.05)
        seen += kind == "door" and before.sum() > 5 and stairs[before, 2].max() > 1.7
    assert seen > 0.5 * np.sum(kinds == "door")


def test_uneven_fronts_differ_from_one_line_by_what_is_said():
    _, even, *_ = made(slope=0.0)
    _, uneven, *_ = made(slope=0.0, unevenness=0.2)
    one, other = (np.concatenate([ring[:2, :2] for (ring,) in some.geometries]) for some in (even, uneven))
    off = np.linalg.norm(one[:, None] - other, axis=2).min(axis=1)
    assert 0.05 < off.max() < 0.3


def test_the_same_seed_gives_the_same_street_and_another_another():
    one, other, another = (made(seed=seed, length=12.0)[0]["xyz"] for seed in (3, 3, 4))
    np.testing.assert_array_equal(one, other)
    assert len(another) != len(one)


def test_too_many_pulses_are_refused():
    with pytest.raises(ValueError, match=r"has \d+ million pulses, more than 50 million; shorten it"):
        simulate_street(length=2000.0, speed=0.5)
    with pytest.raises(ValueError, match=r"has \d+ million pulses, more than 50 million; shorten the street or lower"):
        simulate_street(length=2000.0, view="airplane", density=100.0)
