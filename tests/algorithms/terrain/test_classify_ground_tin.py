"""The ground of scenes whose ground is known by formula."""

from __future__ import annotations

import numpy as np
import pytest

from lidar_buildings.algorithms.geometry.tin import node_fits, robust_deviation
from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.algorithms.terrain.classify_ground_tin import classify_ground_tin, on_smeared_objects
from lidar_buildings.algorithms.terrain.classify_ground_tin_2000 import classify_ground_tin_2000
from lidar_buildings.algorithms.terrain.tin_densification import JoinRules, grow
from lidar_buildings.tests.algorithms.terrain.terrains import HOUSES, TERRAINS, WIDTH, errors, scan, unclassified
from lidar_buildings.tests.builders import EXACT_FAR, FAR
from lidar_buildings.tests.monitors import Listening
from lidar_buildings.tests.surfaces import box, seen_from_above


@pytest.mark.parametrize("name", TERRAINS)
def test_houses_on_terrain(name, rng):
    xyz, is_house = scan(rng, TERRAINS[name], HOUSES)
    missed, wrong = errors(classify_ground_tin(xyz, unclassified(xyz)), is_house)
    assert wrong == 0
    assert missed < (0.03 if name in ("steep", "terrace") else 0.01)


@pytest.mark.parametrize(("density", "noise"), [(0.5, 0.05), (8, 0.03), (3, 0.1)])
def test_density_and_noise(density, noise, rng):
    xyz, is_house = scan(rng, TERRAINS["slope"], HOUSES, density, noise)
    missed, wrong = errors(classify_ground_tin(xyz, unclassified(xyz)), is_house)
    assert wrong == 0
    assert missed < 0.02


def test_a_terrace_is_ground_on_both_levels_up_to_its_step(rng):
    xyz, _ = scan(rng, TERRAINS["terrace"])
    is_ground = classify_ground_tin(xyz, unclassified(xyz)) == 2
    from_step = np.abs(xyz[:, 0] - 35)
    assert is_ground[from_step > 2].mean() > 0.999
    assert is_ground[from_step <= 2].mean() > 0.8


@pytest.mark.parametrize("step", [0.1, 0.3])
def test_the_levels_of_rounded_heights_are_all_ground(step, rng):
    """A slope of 3 %: most of the surface looks perfectly smooth, with regular steps."""
    xyz, is_house = scan(rng, lambda x, y: 0.03 * x, HOUSES, density=8)
    xyz[:, 2] = np.round(xyz[:, 2] / step) * step
    assert max(errors(classify_ground_tin(xyz, unclassified(xyz)), is_house)) < 0.01


@pytest.mark.parametrize(
    "houses",
    [[(0, 15, 50, WIDTH, 7)], [(30, 25, WIDTH, WIDTH, 7), (20, 40, 30, 70, 4.5)]],
    ids=["corner", "corner with a wing"],
)
@pytest.mark.parametrize("density", [1.5, 8])
def test_a_hall_that_the_end_of_the_cloud_cuts_off_is_no_ground(houses, density, rng):
    """Windows of the size of the building don't fit into the part of it inside the cloud."""
    xyz, is_hall = scan(rng, TERRAINS["level"], houses, density)
    missed, wrong = errors(classify_ground_tin(xyz, unclassified(xyz)), is_hall)
    assert wrong == 0
    assert missed < 0.01


@pytest.mark.parametrize("source", ["matched images", "laser scanner"])
def test_a_hall_on_a_slope_with_a_low_rounded_eave_uphill_is_no_ground_in_matched_images(source, rng):
    """63 m wide, on a slope of 5 %, its uphill eave 2 m above the terrain and rounded over 0.3 m."""
    places = rng.uniform(0, 100, (80_000, 2))
    inside = np.minimum(*(31.5 - np.abs(places - 50)).T)
    share = np.clip(0.5 + inside / 0.3, 0, 1)
    level = 0.05 * 81.5 + 2.0
    z = (1 - share) * 0.05 * places[:, 0] + share * level + rng.normal(0, 0.02, len(places))
    xyz = np.column_stack([places, z])
    classes = classify_ground_tin(xyz, unclassified(xyz), source=source)
    on_roof = (classes == 2)[inside > 0.3].mean()
    assert on_roof == 0 if source == "matched images" else on_roof > 0.5
    assert (classes == 2)[inside < -0.3].mean() > 0.97


def test_a_courtyard_is_ground(rng):
    xyz, _ = scan(rng, TERRAINS["slope"])
    from_middle = np.abs(xyz[:, :2] - 40).max(axis=1)
    is_block = (from_middle > 10) & (from_middle < 22)
    xyz[is_block, 2] += 9
    found = classify_ground_tin(xyz, unclassified(xyz))
    assert errors(found, is_block)[1] == 0
    assert (found[from_middle < 9.5] == 2).mean() > 0.98


def test_a_bridge_over_a_valley_is_not_ground_and_the_valley_is(rng):
    xyz, _ = scan(rng, lambda x, y: -6 * np.exp(-(((y - 40) / 8) ** 4)))
    on_deck = np.abs(xyz[:, 0] - 40) < 4
    xyz[on_deck, 2] = rng.normal(0, 0.03, on_deck.sum())
    is_ground = classify_ground_tin(xyz, unclassified(xyz)) == 2
    hovering = on_deck & (np.abs(xyz[:, 1] - 40) < 8)
    assert is_ground[hovering].mean() < 0.15  # its ends join the banks
    assert is_ground[~on_deck].mean() > 0.99


@pytest.mark.parametrize("is_free", [True, False])
def test_what_is_free_standing_does_not_join_the_surface_however_near_it_is(is_free, rng):
    """A platform 0.3 m over a field: a step that the surface would climb if it were not free-standing."""
    plan = rng.uniform(0, 20, (2000, 2))
    on_top = np.abs(plan - 10).max(axis=1) < 4
    points = np.column_stack([plan, np.where(on_top, 0.3, 0.0)])
    rules = JoinRules(max_angle=20.0, max_distance=0.5, bend=0.0, edge_length=0.5)
    is_node = grow(points, np.flatnonzero(~on_top), ~(on_top & is_free), rules, Monitor())[0].is_node
    assert is_node[on_top].any() != is_free
    assert is_node[~on_top].all()


def test_points_beside_nodes_of_their_facet_do_not_join(rng):
    """Close points make slivers and no new detail: no node is nearer to another than a quarter of the edge length."""
    points = rng.uniform(0, 20, (4000, 3)) * [1, 1, 0.01]
    corners = np.array([[x, y, 0.1] for x in range(0, 21, 4) for y in range(0, 21, 4)], float)
    rules = JoinRules(max_angle=45.0, max_distance=0.5, bend=0.0, edge_length=2.0)
    both = np.concatenate([corners, points])
    is_node = grow(both, np.arange(len(corners)), np.ones(len(both), bool), rules, Monitor())[0].is_node
    joined = points[is_node[len(corners) :]]
    assert len(joined) > 50
    assert np.linalg.norm(joined[:, None] - corners, axis=2).min() > 0.5


def test_low_objects_are_not_ground(rng):
    """A car, 1.5 m high, and a hedge of 1 m."""
    xyz, is_low = scan(rng, TERRAINS["slope"], [(30, 30, 34.5, 32, 1.5), (10, 60, 40, 61, 1.0)], density=5)
    missed, wrong = errors(classify_ground_tin(xyz, unclassified(xyz)), is_low)
    assert wrong < 0.01
    assert missed < 0.01


def test_under_trees_the_last_returns_find_the_ground(rng):
    """Above closed crowns one pulse in three reaches the ground; first returns stay in the leaves."""
    ground, _ = scan(rng, TERRAINS["hill"])
    crowns = ground[rng.random(len(ground)) < 0.7] + [0, 0, 8]
    crowns[:, 2] += rng.uniform(-3, 3, len(crowns))
    xyz = np.concatenate([ground, crowns])
    number = np.concatenate([np.full(len(ground), 2), np.ones(len(crowns), int)])
    found = classify_ground_tin(xyz, unclassified(xyz), number, np.full(len(xyz), 2))
    missed, wrong = errors(found, np.arange(len(xyz)) >= len(ground))
    assert wrong == 0
    assert missed < 0.02


def test_return_numbers_decide_where_the_surface_starts(rng):
    """First returns far below, flagged as not last, must not pull the surface down."""
    xyz, _ = scan(rng, TERRAINS["level"])
    below = rng.random(len(xyz)) < 0.05
    xyz[below, 2] -= 3
    number, of = np.where(below, 1, 2), np.full(len(xyz), 2)
    assert (classify_ground_tin(xyz, unclassified(xyz), number, of)[~below] == 2).mean() > 0.99
    assert (classify_ground_tin(xyz, unclassified(xyz))[~below] == 2).mean() < 0.9


def test_return_numbers_that_are_all_zero_are_unknown(rng):
    xyz, _ = scan(rng, TERRAINS["slope"], HOUSES)
    zero = np.zeros(len(xyz), np.uint8)
    without = classify_ground_tin(xyz, unclassified(xyz))
    np.testing.assert_array_equal(classify_ground_tin(xyz, unclassified(xyz), zero, zero), without)


@pytest.mark.parametrize("number", [7, 18])
def test_noise_is_not_used_and_keeps_its_class(number, rng):
    xyz, _ = scan(rng, TERRAINS["slope"])
    is_noise = rng.random(len(xyz)) < 0.1
    xyz[is_noise, 2] -= 40
    classification = np.where(is_noise, number, 1).astype(np.uint8)
    found = classify_ground_tin(xyz, classification)
    assert (found[is_noise] == number).all()
    np.testing.assert_array_equal(found[~is_noise], classify_ground_tin(xyz[~is_noise], classification[~is_noise]))
    assert (found[~is_noise] == 2).mean() > 0.99


def test_what_was_ground_before_and_is_not_found_becomes_unclassified(rng):
    xyz, is_house = scan(rng, TERRAINS["level"], HOUSES)
    found = classify_ground_tin(xyz, np.full(len(xyz), 2))
    assert found.dtype == np.uint8
    assert (found[is_house] == 1).all()


def test_other_classes_stay_where_no_ground_is_found(rng):
    xyz, is_house = scan(rng, TERRAINS["level"], HOUSES)
    found = classify_ground_tin(xyz, np.where(is_house, 6, 0))
    assert (found[is_house] == 6).all()
    assert set(found[~is_house]) <= {0, 2}


@pytest.mark.parametrize("classify", [classify_ground_tin, classify_ground_tin_2000])
def test_all_ground(classify, rng):
    xyz, _ = scan(rng, TERRAINS["level"])
    assert (classify(xyz, unclassified(xyz)) == 2).mean() > 0.995


def test_a_building_wider_than_the_largest_is_taken_for_a_hill(rng):
    """What the tunable means: with a larger one the same building is found."""
    xyz, is_house = scan(rng, TERRAINS["level"], [(10, 10, 70, 70, 9)])
    assert errors(classify_ground_tin(xyz, unclassified(xyz), max_building_size=20), is_house)[1] > 0.9
    assert errors(classify_ground_tin(xyz, unclassified(xyz), max_building_size=75), is_house)[1] == 0


def test_order_and_position_change_nothing(rng):
    """True where no two points are equally low or equally good for a facet, which random ones never are."""
    xyz, _ = scan(rng, TERRAINS["bumpy"], HOUSES)
    found = classify_ground_tin(xyz, unclassified(xyz))
    order = rng.permutation(len(xyz))
    np.testing.assert_array_equal(classify_ground_tin(xyz[order], unclassified(xyz)), found[order])
    np.testing.assert_array_equal(classify_ground_tin(xyz + FAR, unclassified(xyz)), found)
    np.testing.assert_array_equal(classify_ground_tin(xyz + [0, 0, -55.5], unclassified(xyz)), found)


def test_sweep_distance_is_the_width_of_the_ground(rng):
    xyz, _ = scan(rng, TERRAINS["level"], noise=0.0)
    above = rng.random(len(xyz)) < 0.2
    xyz[above, 2] = rng.uniform(0.3, 1.0, above.sum())
    found = classify_ground_tin(xyz, unclassified(xyz), sweep_distance=0.6, iteration_distance=0.1)
    np.testing.assert_array_equal(found == 2, xyz[:, 2] <= 0.6)
    nodes = classify_ground_tin(xyz, unclassified(xyz), sweep_distance=0.0, iteration_distance=0.1) == 2
    assert 0.05 < nodes.mean() < 0.6
    assert (xyz[nodes, 2] == 0).all()


@pytest.mark.parametrize(
    ("classify", "cap", "density", "noise"),
    [
        (classify_ground_tin_2000, np.inf, 2, 0.2),
        (classify_ground_tin, 0.1, 2, 0.2),
        (classify_ground_tin, 0.1, 2, 0.02),
        (classify_ground_tin, 0.1, 30, 0.03),
    ],
)
def test_sweep_distance_is_six_roughnesses_with_the_last_two_capped(classify, cap, density, noise, rng):
    """As published it is six times the roughness of the nodes; on rough terrain a decimeter caps the last two of these.

    The lowest points of a dense cloud agree, and a tenth of its ground was left out by their roughness.
    """
    xyz, _ = scan(rng, TERRAINS["level"], density=density, noise=noise)
    is_node = classify(xyz, unclassified(xyz), sweep_distance=0.0) == 2
    roughness = robust_deviation(node_fits(xyz[is_node])[0])
    roughness = max(roughness, CloudSampling.of(xyz).noise) if classify is classify_ground_tin else roughness
    monitor = Monitor()
    found = classify(xyz, unclassified(xyz), monitor=monitor)
    assert monitor.values["sweep_distance"] == pytest.approx(4 * roughness + min(2 * roughness, cap))
    assert (found == 2).mean() > 0.98


def test_low_plants_are_no_ground(rng):
    """A field of 0.3 m, through which every second beam gets to the ground."""
    xyz, _ = scan(rng, TERRAINS["level"], density=8, noise=0.02)
    is_plant = (np.abs(xyz[:, :2] - 40).max(axis=1) < 25) & (rng.random(len(xyz)) < 0.5)
    xyz[is_plant, 2] += rng.uniform(0.0, 0.3, is_plant.sum())
    monitor = Monitor()
    is_ground = classify_ground_tin(xyz, unclassified(xyz), monitor=monitor) == 2
    assert is_ground[is_plant & (xyz[:, 2] > monitor.values["sweep_distance"])].mean() < 0.01
    assert is_ground[~is_plant].mean() > 0.99


def test_automatic_values_follow_the_cloud(rng):
    for density, noise in ((3, 0.03), (0.25, 0.1)):
        xyz, _ = scan(rng, TERRAINS["level"], density=density, noise=noise)
        monitor = Monitor()
        classify_ground_tin(xyz, unclassified(xyz), monitor=monitor)
        spacing = 1 / np.sqrt(density)
        assert monitor.values["cell_size"] == pytest.approx(max(1.0, spacing / 2), rel=0.1)
        assert monitor.values["edge_length"] == pytest.approx(2 * monitor.values["cell_size"])
        low, high = (max(8 * rough, 4 * rough + 0.5 * spacing) for rough in (0.8 * noise, 1.4 * noise))
        assert low < monitor.values["iteration_distance"] < high
        assert 3 * noise < monitor.values["sweep_distance"] < 9 * noise
        assert monitor.values["granularity"] == ("fine" if density < 1 else "medium")
        assert (monitor.values["terrain"], monitor.values["max_building_size"]) == ("town", 60.0)
        assert monitor.values["iteration_angle"] == 20.0


def test_values_given_by_hand_are_used(rng):
    xyz, _ = scan(rng, TERRAINS["level"], density=1)
    monitor = Monitor()
    given = {
        "terrain": "nature",
        "granularity": "coarse",
        "max_building_size": 33.0,
        "cell_size": 2.5,
        "iteration_angle": 12.0,
        "edge_length": 3.0,
        "iteration_distance": 0.7,
        "sweep_distance": 0.2,
    }
    classify_ground_tin(xyz, unclassified(xyz), **given, monitor=monitor)
    assert monitor.values == given


@pytest.mark.parametrize(
    ("word", "size", "angle"),
    [("nature", 15, 30), ("village", 30, 20), ("town", 60, 20), ("city", 120, 20), ("industry", 240, 20)],
)
def test_the_terrain_sets_building_size_and_angle(word, size, angle, rng):
    """A kind of terrain gives the result of its size, and finds a building of that size but not a larger one."""
    xyz, _ = scan(rng, TERRAINS["slope"], HOUSES)
    monitor = Monitor()
    found = classify_ground_tin(xyz, unclassified(xyz), terrain=word, monitor=monitor)
    assert (monitor.values["max_building_size"], monitor.values["iteration_angle"]) == (size, angle)
    same = classify_ground_tin(xyz, unclassified(xyz), max_building_size=size, iteration_angle=angle)
    np.testing.assert_array_equal(found, same)


def test_in_nature_a_large_building_is_a_hill_and_in_a_town_it_is_not(rng):
    xyz, is_house = scan(rng, TERRAINS["level"], [(20, 20, 60, 60, 5)])
    assert errors(classify_ground_tin(xyz, unclassified(xyz), terrain="nature"), is_house)[1] > 0.9
    assert errors(classify_ground_tin(xyz, unclassified(xyz), terrain="town"), is_house)[1] == 0


@pytest.mark.parametrize(
    ("word", "density", "cell"),
    [("coarse", 1.5, 2.0), ("medium", 1.5, 1.0), ("fine", 0.25, 1.0), ("extra fine", 9, 0.5), ("medium", 0.25, 2.0)],
)
def test_the_granularity_sets_the_cell(word, density, cell, rng):
    xyz, _ = scan(rng, TERRAINS["level"], density=density)
    monitor = Monitor()
    classify_ground_tin(xyz, unclassified(xyz), granularity=word, monitor=monitor)
    assert monitor.values["cell_size"] == pytest.approx(cell, rel=0.1)
    assert monitor.values["granularity"] == word


def test_a_quarry_is_ground_on_its_floor_its_benches_and_around(rng):
    """Two benches, 6 m each, with faces of 70°."""
    from_rim = 30 - WIDTH / 2
    depth = lambda x, y: from_rim + np.maximum(np.abs(x - 40), np.abs(y - 40))  # noqa: E731
    steps = lambda d: np.clip(2.7 * (d + 20), 0, 6) + np.clip(2.7 * (d + 10), 0, 6)  # noqa: E731
    xyz, _ = scan(rng, lambda x, y: steps(depth(x, y)), density=4)
    is_ground = classify_ground_tin(xyz, unclassified(xyz)) == 2
    where = depth(*xyz[:, :2].T)
    is_face = ((where > -20.5) & (where < -17.2)) | ((where > -10.5) & (where < -7.2))
    assert is_ground[~is_face].mean() > 0.99
    assert is_ground[is_face].mean() > 0.75


def test_an_edge_between_two_slopes_is_ground(rng):
    """A bank of 45° between two levels: its upper edge lies beyond the reach of any facet below."""
    bank = lambda x, y: np.clip(x - 40, 0, 5)  # noqa: E731
    xyz, _ = scan(rng, bank, density=1.0)
    is_ground = classify_ground_tin(xyz, unclassified(xyz)) == 2
    assert is_ground[np.abs(xyz[:, 0] - 45) < 2].mean() > 0.97


def test_low_noise_does_not_become_ground(rng):
    """Single points and pairs 6 m and deeper under a slope; the ground around them is still found."""
    xyz, _ = scan(rng, TERRAINS["slope"], HOUSES, density=4)
    low = rng.choice(len(xyz), 40, replace=False)
    xyz[low, 2] -= rng.uniform(6, 30, 40)
    found = classify_ground_tin(xyz, unclassified(xyz)) == 2
    assert not found[low].any()
    around = np.linalg.norm(xyz[:, None, :2] - xyz[low, :2], axis=2).min(axis=1) < 3
    at_house = ((xyz[:, None, :2] >= [h[:2] for h in HOUSES]) & (xyz[:, None, :2] <= [h[2:4] for h in HOUSES])).all(2)
    around[low] = False
    assert found[around & ~at_house.any(axis=1)].mean() > 0.98


@pytest.mark.parametrize("side", [0.9, 1.5, 2.5])
def test_a_cloud_of_few_cells_is_ground_as_far_as_it_is_level(side, rng):
    """Three nodes have no neighbors by which to measure the roughness; points on their facet were left out."""
    xyz = rng.uniform(0, side, (300, 3)) * [1, 1, 0.02]
    xyz[:30, 2] += 1.0
    found = classify_ground_tin(xyz, unclassified(xyz))
    np.testing.assert_array_equal(found == 2, np.arange(300) >= 30)


@pytest.mark.parametrize("count", [1, 2])
def test_too_few_points_are_refused(count):
    xyz = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 5, 5.0]])
    classification = np.full(4, 7)
    classification[:count] = 1
    with pytest.raises(ValueError, match=rf"at least 3 points that are not noise, got {count}; choose"):
        classify_ground_tin(xyz, classification)


@pytest.mark.parametrize("digits", [12, 3, 2])
def test_points_on_one_line_are_refused_also_when_the_file_rounds_them(digits):
    x = np.linspace(0, 100, 300)
    line = np.round(np.column_stack([x, 0.37 * x, np.sin(x)]) + FAR, digits)
    with pytest.raises(ValueError, match="^All 300 points lie on one line or at one position in plan; ground needs"):
        classify_ground_tin(line, unclassified(line))


def test_points_at_one_position_are_refused():
    with pytest.raises(ValueError, match="one line or at one position"):
        classify_ground_tin(np.column_stack([np.full((9, 2), 7.0), np.arange(9)]), np.ones(9))


def test_progress_only_grows_and_a_cancel_gets_through(rng):
    xyz, _ = scan(rng, TERRAINS["slope"], HOUSES, density=1)
    monitor = Listening()
    classify_ground_tin(xyz, unclassified(xyz), monitor=monitor)
    assert monitor.heard == sorted(monitor.heard)
    assert 0 <= monitor.heard[0] <= monitor.heard[-1] <= 1

    with pytest.raises(Cancelled):
        classify_ground_tin(xyz, unclassified(xyz), monitor=Listening(stop_at=0.5))


def test_existing_ground_is_kept_where_asked_for_and_looked_for_where_there_is_none():
    xy = np.stack(np.meshgrid(np.arange(30.0), np.arange(30.0)), axis=-1).reshape(-1, 2)
    xyz = np.column_stack([xy, np.zeros(len(xy))])
    given = np.where(xy[:, 0] < 10, 2, 6).astype(np.uint8)
    np.testing.assert_array_equal(classify_ground_tin(xyz, given, keep_ground=True), given)
    assert (classify_ground_tin(xyz, given) == 2).sum() > (given == 2).sum()
    assert (classify_ground_tin(xyz, np.zeros(len(xyz), np.uint8), keep_ground=True) == 2).mean() > 0.9


def climbed(xyz, is_ground=None):
    return on_smeared_objects(xyz, np.ones(len(xyz), bool) if is_ground is None else is_ground, 0.16)


@pytest.mark.parametrize("slope", [0.0, 0.3])
def test_a_shed_is_found_on_any_slope(rng, slope):
    xyz, part = seen_from_above(rng, box(10, 10, 13, 13, 2.1, smeared=0.5))
    height = xyz[:, 2].copy()
    xyz[:, 2] += slope * xyz[:, 0]
    found = climbed(xyz)
    # Cells take in the slope within them.
    assert found[height > 0.5 + 2 * slope].all()
    assert not found[part == 0].any()


def test_the_ring_of_climbed_walls_around_a_house_is_found(rng):
    xyz, part = seen_from_above(rng, box(8, 8, 20, 20, 5.0, smeared=0.7))
    # The surface climbed the walls to 2.5 m; the roof itself is no ground.
    is_ground = xyz[:, 2] < 2.5
    found = climbed(xyz, is_ground)
    assert not found[~is_ground].any()
    assert found[is_ground & (xyz[:, 2] > 1.0)].mean() > 0.95
    assert not found[part == 0].any()


@pytest.mark.parametrize(
    "terrain",
    [
        lambda x, y: 0.6 * x + 0.2 * y,
        lambda x, y: 2.5 * np.clip((x - 15) / 2.5, 0, 1),
        lambda x, y: 1.5 * np.sin(x / 4) * np.sin(y / 5),
        lambda x, y: -2.0 * ((np.abs(x - 15) < 2) & (np.abs(y - 15) < 2)),
        lambda x, y: -np.tan(np.radians(20)) * np.abs(x + 0.3 * y - 19),
        lambda x, y: np.clip(2.5 - 0.6 * np.abs(y - 15), 0, 2),
    ],
    ids=["slope", "terrace", "hills", "pit", "ridge", "dike"],
)
def test_terrain_stays(rng, terrain):
    xyz = seen_from_above(rng, lambda x, y: terrain(x, y) + 10.0)[0]
    # At the very corners of the cloud no window reaches into the slope.
    in_corner = (np.abs(xyz[:, :2] - 15) > 14).all(axis=1)
    assert not climbed(xyz)[~in_corner].any()


def test_order_and_position_do_not_matter(rng):
    xyz = seen_from_above(rng, box(10, 10, 13, 13, 2.1, smeared=0.5))[0]
    xyz = np.round(xyz * 2**10) / 2**10
    order, found = rng.permutation(len(xyz)), climbed(xyz)
    assert found.any()
    np.testing.assert_array_equal(climbed(xyz[order] + EXACT_FAR), found[order])


def test_no_points():
    assert len(climbed(np.zeros((0, 3)))) == 0
