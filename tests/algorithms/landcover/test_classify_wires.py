"""Wires and masts: catenaries of known points, what looks like them, and simulated lines."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.landcover.classify_wires import classify_wires
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling
from lidar_buildings.algorithms.simulation.simulate_power_line import simulate_power_line

GROUND, WIRE, POLE, TREE = 2, 14, 15, 5

# Parameter of the catenary (m) of a span of 40 m with a sag of 0.8 m: horizontal tension by weight per meter.
PARAMETER = 250.0


def line(per_meter=2.0, spans=2, angle=25.0, sides=(-0.8, 0.0, 0.8), seed=4):
    """A meadow with poles of 9 m every 40 m, catenaries between them and a tree; coordinates and classes."""
    rng = np.random.default_rng(seed)
    ground = np.column_stack([rng.uniform(0, 100, (30_000, 2)), np.zeros(30_000)])
    parts, kinds = [ground], [np.full(len(ground), GROUND)]
    direction = np.array([np.cos(np.deg2rad(angle)), np.sin(np.deg2rad(angle))])
    across = np.array([-direction[1], direction[0]])
    for span in range(spans):
        for side in sides:
            along = rng.uniform(0, 40, round(40 * per_meter))
            sag = PARAMETER * (np.cosh((along - 20) / PARAMETER) - np.cosh(20 / PARAMETER))
            plan = np.array([10.0, 20.0]) + (along + 40 * span)[:, None] * direction + side * across
            parts.append(np.column_stack([plan, 8.8 + sag]))
            kinds.append(np.full(len(along), WIRE))
    for pole in range(spans + 1):
        plan = np.array([10.0, 20.0]) + 40 * pole * direction
        parts.append(np.column_stack([plan + rng.uniform(-0.15, 0.15, (20, 2)), np.linspace(0.6, 9.0, 20)]))
        kinds.append(np.full(20, POLE))
    crown = rng.normal(0, 1, (600, 3)) * [2.0, 2.0, 1.5] + [60.0, 20.0, 6.0]
    xyz = np.concatenate([*parts, crown])
    return xyz + rng.normal(0, 0.03, xyz.shape), np.concatenate([*kinds, np.full(600, TREE)])


def classified(xyz, kind, **tunables):
    return classify_wires(
        xyz, np.where(kind == GROUND, 2, 1).astype(np.uint8), xyz[:, 2].astype(np.float32), **tunables
    )


def f_score(found, true):
    return 200 * (found & true).sum() / (found.sum() + true.sum())


@pytest.mark.parametrize(("per_meter", "least"), [(0.6, 75), (2.0, 90), (8.0, 90)])
@pytest.mark.parametrize("angle", [0.0, 25.0])
def test_catenaries_are_wires_and_their_poles_are_masts(per_meter, least, angle):
    xyz, kind = line(per_meter, angle=angle)
    made = classified(xyz, kind)
    assert f_score(made == WIRE, kind == WIRE) > least
    assert f_score(made == POLE, kind == POLE) > 80
    assert (made[kind == TREE] == 1).mean() > 0.99


def test_a_single_wire_is_found():
    xyz, kind = line(sides=(0.0,), spans=1)
    assert f_score(classified(xyz, kind) == WIRE, kind == WIRE) > 90


@pytest.mark.parametrize("density", [4.0, 20.0])
def test_lines_of_many_wires_are_found(density):
    """Eight wires on poles, four of them in a rack, 0.3 m above one another: each looked like leaves below the next."""
    xyz, true, *_, number = simulate_power_line(size=130.0, density=density, angle=25.0, trees=0.0, forest=0.0, seed=4)
    ground = xyz[true == GROUND]
    slope = np.polyfit(ground[:, 1], ground[:, 2], 1)
    height = np.where(true == GROUND, 0.0, xyz[:, 2] - np.polyval(slope, xyz[:, 1])).astype(np.float32)
    classes = np.where(np.isin(true, (GROUND, 6)), true, 1).astype(np.uint8)
    made = classify_wires(xyz, classes, height)
    on_poles = (true == WIRE) & (height < 12)
    assert len(np.unique(number[on_poles])) >= 8
    assert (made[on_poles] == WIRE).mean() > 0.6
    assert f_score(made == WIRE, true == WIRE) > 85


def test_a_straight_beam_is_no_wire():
    xyz, kind = line(sides=(0.0,), spans=1)
    xyz[kind == WIRE, 2] = 8.8 + np.random.default_rng(2).normal(0, 0.03, (kind == WIRE).sum())
    assert not (classified(xyz, kind) == WIRE).any()


def test_what_bends_down_is_no_wire():
    xyz, kind = line(sides=(0.0,), spans=1)
    xyz[kind == WIRE, 2] = 17.6 - xyz[kind == WIRE, 2]
    assert not (classified(xyz, kind) == WIRE).any()


def test_a_curved_sheet_is_no_wire():
    """A tensioned roof bends as wires do, but goes on to the sides."""
    xyz, kind = line(per_meter=20.0, spans=1, sides=tuple(np.arange(-3, 3, 0.2)))
    assert not (classified(xyz, kind) == WIRE).any()


def test_a_sagging_edge_of_a_building_is_no_wire():
    xyz, kind = line(sides=(0.0, 0.4), spans=1)
    is_building = kind == WIRE
    is_building[np.flatnonzero(kind == WIRE)[:80]] = False
    classes = np.where(kind == GROUND, 2, np.where(is_building, 6, 1)).astype(np.uint8)
    made = classify_wires(xyz, classes, xyz[:, 2].astype(np.float32))
    assert not (made == WIRE).any()
    assert (made[is_building] == 6).all()


def test_a_wire_over_close_leaves_is_no_wire():
    """A line of points in the top of a long hedge."""
    xyz, kind = line(sides=(0.0,), spans=1)
    rng = np.random.default_rng(1)
    above = xyz[kind == WIRE]
    leaves = np.repeat(above, 4, axis=0) - rng.uniform(0.0, (0.0, 0.0, 2.0), (4 * len(above), 3))
    made = classified(np.concatenate([xyz, leaves]), np.concatenate([kind, np.full(len(leaves), TREE)]))
    assert not (made == WIRE).any()


def test_lower_limit_and_switch_have_their_effect():
    xyz, kind = line()
    assert not (classified(xyz, kind, min_height=10.0) == WIRE).any()
    classes = np.where(kind == GROUND, 2, 14).astype(np.uint8)
    height = xyz[:, 2].astype(np.float32)
    np.testing.assert_array_equal(classify_wires(xyz, classes, height, look_for=False), classes)


def test_clouds_of_matched_images_are_left_as_they_are(monkeypatch):
    xyz, kind = line()
    classes, height = np.where(kind == GROUND, 2, 14).astype(np.uint8), xyz[:, 2].astype(np.float32)
    assert (classify_wires(xyz, classes, height) != classes).any()
    monkeypatch.setattr(CloudSampling, "is_closed_surface", lambda sampling: True)
    np.testing.assert_array_equal(classify_wires(xyz, classes, height), classes)


def test_earlier_wires_are_classified_anew_and_other_classes_stay():
    xyz, kind = line()
    height = xyz[:, 2].astype(np.float32)
    made = classify_wires(xyz, np.where(kind == GROUND, 2, 14).astype(np.uint8), height)
    assert (made[kind == TREE] == 1).mean() > 0.99
    for kept in (2, 6, 7, 9, 17, 26):
        np.testing.assert_array_equal(classify_wires(xyz, np.full(len(xyz), kept, np.uint8), height), kept)


def test_order_changes_nothing():
    xyz, kind = line()
    order = np.random.default_rng(3).permutation(len(xyz))
    np.testing.assert_array_equal(classified(xyz[order], kind[order]), classified(xyz, kind)[order])


@pytest.mark.parametrize(
    ("density", "angle", "seed", "least"),
    [(2.0, 15.0, 1, 76), pytest.param(8.0, 40.0, 2, 85, marks=pytest.mark.slow)],
)
def test_simulated_lines_are_found(density, angle, seed, least):
    xyz, true, number, count, *_ = simulate_power_line(density=density, angle=angle, seed=seed)
    cloud = create_cloud({"xyz": xyz, "return_number": number, "number_of_returns": count})
    run_pipeline(PIPELINES["detect_buildings"], cloud)
    assert f_score(cloud.get("classification") == WIRE, true == WIRE) > least


@pytest.mark.parametrize(("angle", "seed"), [(15.0, 1), (60.0, 5)])
def test_towers_of_simulated_lines_are_found_whole(angle, seed):
    """The axis was at one of the legs, and the other ones were taken for a crown around it."""
    xyz, true, _, _, _, _, _, _, number = simulate_power_line(size=110.0, density=12.0, angle=angle, seed=seed)
    height = np.where(true == GROUND, 0.0, xyz[:, 2] - xyz[true == GROUND, 2].mean()).astype(np.float32)
    made = classify_wires(xyz, np.where(true == GROUND, 2, np.where(true == 6, 6, 1)).astype(np.uint8), height)
    tower = number == np.bincount(number[true == POLE]).argmax()
    assert (made[tower] == POLE).mean() > 0.75
