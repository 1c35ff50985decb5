"""Building measures: counted by hand, and against an independent scorer."""

import numpy as np
import pytest

from lidar_buildings.algorithms.quality.assess_buildings import assess_buildings, rates
from lidar_buildings.algorithms.stage import LayerFeatures, Monitor


def block(west, south, size, elevation, step=0.5):
    """Return points on a horizontal square, one in the middle of each cell of ``step``."""
    side = np.arange(step / 2, size, step)
    plan = np.stack(np.meshgrid(west + side, south + side), -1).reshape(-1, 2)
    return np.column_stack([plan, np.full(len(plan), elevation)])


def test_rates_by_hand():
    predicted = np.array([1, 1, 1, 0, 0, 0, 0, 0], bool)
    true = np.array([1, 1, 0, 1, 1, 1, 0, 0], bool)
    found = rates(predicted, true)
    assert found["completeness"] == pytest.approx(40)
    assert found["correctness"] == pytest.approx(200 / 3)
    assert found["f"] == pytest.approx(50)
    assert found["quality"] == pytest.approx(100 / 3)
    assert (found["hits"], found["misses"], found["false"]) == (2, 3, 1)


def test_scene_by_hand():
    """Two houses of 16 m² and one of 25 m²; the second is found by a quarter, the third is a tree."""
    ground = block(0, 0, 30, 0.0)
    first, second, tree = block(1, 1, 4, 5.0), block(10, 1, 4, 5.0), block(20, 20, 5, 6.0)
    wall = np.column_stack([np.full(10, 1.25), np.full(10, 1.25), np.linspace(0.5, 4.5, 10)])
    noise = np.array([[15.0, 15, 90], [15, 16, 90]])
    xyz = np.concatenate([ground, first, second, tree, wall, noise])
    sizes = [len(part) for part in (ground, first, second, tree, wall, noise)]
    true = np.repeat([2, 6, 6, 5, 1, 7], sizes)
    predicted = np.repeat([2, 6, 1, 6, 6, 6], sizes)
    predicted[sizes[0] + sizes[1] :][:16] = 6
    values = assess_buildings(xyz, predicted, xyz, true, cell_size=0.5)[1].values
    # Points: 64 + 16 of 128 found; 100 of the tree and 10 of the wall are false; noise is not counted.
    assert (values["points_hits"], values["points_misses"], values["points_false"]) == (80, 48, 110)
    assert values["points_completeness"] == pytest.approx(62.5)
    assert values["points_correctness"] == pytest.approx(100 * 80 / 190)
    # From above the wall is under the roof.
    assert (values["cells_hits"], values["cells_misses"], values["cells_false"]) == (80, 48, 100)
    assert values["objects_completeness"] == pytest.approx(50)
    assert (values["objects_true"], values["objects_predicted"]) == (2, 2)  # 4 m² of the second is no object
    assert values["objects_correctness"] == pytest.approx(50)
    smaller = assess_buildings(xyz, predicted, xyz, true, cell_size=0.5, min_area=4.0)[1].values
    assert (smaller["objects_true"], smaller["objects_predicted"]) == (2, 3)
    assert smaller["objects_correctness"] == pytest.approx(200 / 3)
    with_noise = assess_buildings(xyz, predicted, xyz, true, ignored_classes="")[1].values
    assert with_noise["points_false"] == 112


def test_cells_that_touch_by_a_corner_are_one_object():
    xyz = np.concatenate([block(0, 0, 20, 0.0), block(2, 2, 2, 4.0), block(4, 4, 2, 4.0)])
    true = np.where(xyz[:, 2] > 0, 6, 2)
    assert assess_buildings(xyz, true, xyz, true, cell_size=0.5, min_area=8.0)[1].values["objects_true"] == 1


def listed(layer):
    """Return (kind, area, points, covered) of each object."""
    return sorted(zip(*(layer.columns[name] for name in ("kind", "area", "points", "covered"))))


def test_layer_lists_what_was_found_missed_and_invented():
    """The scene by hand, with an annex that is missed and one that is invented at the house that is found."""
    ground = block(0, 0, 40, 0.0)
    house, missed, tree = block(2, 2, 8, 5.0), block(20, 2, 6, 5.0), block(20, 20, 5, 6.0)
    annex, carport = block(2, 10, 4, 3.0), block(10, 2, 4, 3.0)
    strip = np.column_stack([np.full(16, 1.75), np.arange(2.25, 10, 0.5), np.full(16, 5.0)])
    shed = block(32, 32, 2, 3.0)
    parts = (ground, house, missed, tree, annex, carport, strip, shed)
    xyz, sizes = np.concatenate(parts), [len(part) for part in parts]
    true = np.repeat([2, 6, 6, 5, 6, 1, 1, 6], sizes)
    predicted = np.repeat([2, 6, 1, 6, 1, 6, 6, 1], sizes)
    layer, report = assess_buildings(xyz, predicted, xyz, true, cell_size=0.5)
    # The strip along the wall is one cell wide, the shed is smaller than the smallest building.
    assert listed(layer) == [
        ("found", 80.0, 320, 0.8),
        ("invented", 25.0, 100, 0.0),
        ("invented part", 16.0, 64, 0.0),
        ("missed", 36.0, 144, 0.0),
        ("missed part", 16.0, 64, 0.0),
    ]
    assert layer.columns["id"] == [1, 2, 3, 4, 5]
    values = report.values
    assert (values["objects_true"], values["objects_misses"]) == (2, 1)
    assert (values["objects_predicted"], values["objects_false"]) == (2, 1)
    assert values["objects_f"] == pytest.approx(50)
    (ring,) = layer.geometries[layer.columns["kind"].index("missed")]
    # Cells begin at the first point, which is at 0.25.
    assert (ring.min(axis=0).tolist(), ring.max(axis=0).tolist()) == ([20.25, 2.25], [26.25, 8.25])


def test_layer_and_rates_count_the_same_objects(rng):
    xyz, predicted, true = random_scene(rng, 20_000, 80)
    layer, report = assess_buildings(xyz, predicted, xyz, true, min_area=4.0)
    kinds, values = layer.columns["kind"], report.values
    assert kinds.count("missed") == values["objects_misses"]
    assert kinds.count("found") + kinds.count("missed") == values["objects_true"]
    assert kinds.count("invented") == values["objects_false"]
    # Half is found.
    for kind, covered in zip(kinds, layer.columns["covered"]):
        assert kind.endswith("part") or (covered >= 0.5) == (kind == "found")
    swapped = assess_buildings(xyz, true, xyz, predicted, min_area=4.0, ignored_classes="")[0].columns["kind"]
    unswapped = assess_buildings(xyz, predicted, xyz, true, min_area=4.0, ignored_classes="")[0].columns["kind"]
    assert swapped.count("missed") == unswapped.count("invented")
    assert swapped.count("missed part") == unswapped.count("invented part")


def random_scene(rng, n, extent):
    xyz = np.round(rng.uniform(0, extent, (n, 3)), 3)
    blob = (np.sin(xyz[:, 0] / 4) > 0.2) & (np.cos(xyz[:, 1] / 5) > 0)
    true = np.where(blob, 6, rng.choice([1, 2, 5, 7, 9, 17, 26, 65], n))
    predicted = np.where(rng.random(n) < 0.15, rng.choice([1, 2, 6], n), true)
    return xyz, predicted.astype(np.uint8), true.astype(np.uint8)


@pytest.mark.parametrize(("n", "extent"), [(30_000, 60), (3_000, 60)])
def test_agrees_with_an_independent_scorer(rng, scorer, n, extent):
    xyz, predicted, true = random_scene(rng, n, extent)
    expected = scorer.score_buildings(xyz, predicted, true)
    values = assess_buildings(xyz, predicted, xyz, true)[1].values
    for group in ("points", "cells"):
        for ours, theirs in (("completeness",) * 2, ("correctness",) * 2, ("f", "F"), ("quality",) * 2):
            assert values[f"{group}_{ours}"] == pytest.approx(expected[group][theirs], abs=1e-9), (group, ours)
        assert values[f"{group}_false"] == expected[group]["false_positives"]
        assert values[f"{group}_misses"] == expected[group]["misses"]
    assert values["cell_size"] == expected["cells"]["cell_size"]
    for name in ("completeness", "correctness", "true", "predicted"):
        assert values[f"objects_{name}"] == pytest.approx(expected["objects"][name]), name


def test_order_and_position_change_nothing(rng):
    xyz, predicted, true = random_scene(rng, 4000, 40)
    here = assess_buildings(xyz, predicted, xyz, true)[1].values
    order = rng.permutation(len(xyz))
    assert assess_buildings(xyz, predicted, xyz[order], true[order])[1].values == here
    # Whole cells away: the same points share a cell.
    far = xyz + [600_000.0, 5_000_000.0, 0]
    there = assess_buildings(far, predicted, far, true)[1].values
    assert there["points_f"] == here["points_f"]


def test_no_building_anywhere_is_undefined_not_an_error():
    xyz = block(0, 0, 10, 0.0)
    layer, report = assess_buildings(xyz, np.full(len(xyz), 2), xyz, np.full(len(xyz), 2))
    assert np.isnan([report.values[name] for name in ("points_f", "cells_quality", "objects_completeness")]).all()
    assert "undefined" in report.html
    assert len(layer) == 0


def test_only_ignored_points_are_refused():
    xyz = block(0, 0, 3, 0.0)
    with pytest.raises(ValueError, match=r"All 36 points have an ignored class in the reference \(7\); ignore fewer"):
        assess_buildings(xyz, np.full(36, 6), xyz, np.full(36, 7))


def test_automatic_cell_size_is_reported_and_page_has_the_figures():
    monitor = Monitor()
    xyz = np.concatenate([block(0, 0, 20, 0.0, step=1.0), block(5, 5, 4, 4.0, step=1.0)])
    true = np.where(xyz[:, 2] > 0, 6, 2)
    predicted = true.copy()
    predicted[-1] = 1
    _, report = assess_buildings(xyz, predicted, xyz, true, monitor=monitor)
    assert monitor.values == {"cell_size": 1.0}
    assert "93.8 %" in report.html  # 15 of 16
    assert "15 of 16 points" in report.html
    assert set(report.values) == {measure.name for measure in assess_buildings.stage.measures}


def square(west, south, size):
    return [np.array([[0, 0], [size, 0], [size, size], [0, size], [0, 0]]) + [west, south]]


def test_polygons_are_a_reference_too():
    """People have base maps, and no second cloud: it refused them, though the first steps said otherwise."""
    ground = block(0, 0, 30, 0.0)
    first, second, invented = block(1, 1, 4, 5.0), block(10, 1, 4, 5.0), block(20, 20, 5, 6.0)
    noise = np.array([[2.0, 2, 90]])
    xyz = np.concatenate([ground, first, second, invented, noise])
    classes = np.repeat([2, 6, 1, 6, 18], [len(part) for part in (ground, first, second, invented, noise)])
    keys = LayerFeatures([square(1, 1, 4), square(10, 1, 4)], {"id": [1, 2]})
    objects, report = assess_buildings(xyz, classes, reference_map=keys, cell_size=0.5)
    values = report.values
    assert (values["cells_hits"], values["cells_misses"], values["cells_false"]) == (64, 64, 100)
    assert (values["objects_true"], values["objects_predicted"]) == (2, 2)
    assert objects.columns["kind"] == ["found", "missed", "invented"]
    # The ground below the two roofs is within the polygons, noise above is not counted.
    assert values["points_hits"] == 64
    assert values["points_misses"] == 64 + 128


def test_without_a_reference_it_is_refused_and_of_two_the_cloud_is_used():
    xyz, classes = block(0, 0, 5, 0.0), np.full(100, 2)
    with pytest.raises(ValueError, match="There is no reference"):
        assess_buildings(xyz, classes)
    monitor, keys = Monitor(), LayerFeatures([square(0, 0, 2)], {})
    values = assess_buildings(xyz, classes, xyz, classes, keys, monitor=monitor)[1].values
    assert values["points_misses"] == 0
    assert monitor.warnings == ["The reference cloud is compared with; the polygons are left out."]
