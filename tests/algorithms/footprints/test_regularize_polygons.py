"""Footprints drawn anew: houses traced from cells, whose walls are known."""

import dataclasses

import numpy as np
import pytest

from lidar_buildings.algorithms.footprints import regularize_polygons as regularize_module
from lidar_buildings.algorithms.footprints.outline_pieces import sampled, shared_directions
from lidar_buildings.algorithms.footprints.regularize_polygons import regularize_polygons
from lidar_buildings.algorithms.geometry.polygon_overlap import as_polygons, overlaps
from lidar_buildings.algorithms.geometry.rings import polygon_area
from lidar_buildings.algorithms.quality.polygon_comparison import hausdorff, polis, squareness
from lidar_buildings.algorithms.stage import LayerFeatures, Monitor
from lidar_buildings.tests.polygon_validity import assert_valid
from lidar_buildings.tests.traced_polygons import CELL, box, traced


def drawn(polygons, columns=None, **tunables):
    """Return the new polygons, their attributes and the messages."""
    monitor = Monitor()
    made = regularize_polygons(LayerFeatures(polygons, columns or {}), monitor=monitor, **tunables)
    for rings, before in zip(made.geometries, polygons):
        assert_valid(rings)
        assert len(rings) == len(before)
        assert polygon_area(rings) == pytest.approx(polygon_area(before), rel=0.01)
    return made.geometries, made.columns, monitor


def corners(rings):
    return sum(len(ring) - 1 for ring in rings)


def test_a_house_traced_from_cells_has_its_four_walls():
    house = [box(0, 0, 14, 9)]
    (rings,), columns, monitor = drawn(traced([house]))
    assert corners(rings) == 4
    assert squareness(rings) == pytest.approx(1.0)
    assert polis(rings, house) < CELL / 3
    assert columns["regularized"] == [1]
    assert columns["moved"][0] == pytest.approx(hausdorff(rings, traced([house])[0]), abs=CELL)
    assert CELL / 2 < monitor.values["tolerance"] < 2 * CELL


def test_houses_of_a_row_share_their_walls_and_overlap_nowhere():
    row = [[box(6.0 * number, 0, 6, 10)] for number in range(4)]
    made, _, _ = drawn(traced(row, noise=0.15))
    edges = as_polygons(made)
    one, other, shared = overlaps(edges, edges, Monitor())
    assert (shared[one != other] < 1e-9).all()
    for left, right in zip(made, made[1:]):
        common = {tuple(place) for place in left[0].tolist()} & {tuple(place) for place in right[0].tolist()}
        assert len(common) >= 2
    assert sum(map(corners, made)) <= 20


def test_a_shed_has_the_directions_of_the_houses_around():
    """Its few cells say little of directions by themselves."""
    around = [[box(18.0 * east, 18.0 * north, 15, 10)] for east in (0, 1, 2) for north in (0, 1, 2)]
    off = []
    for seed in range(4):
        (*_, shed), _, _ = drawn(traced([*around, [box(16, 13, 3.5, 3.0)]], noise=0.2, seed=seed))
        edges = np.diff(shed[0], axis=0)
        off += (np.degrees(np.arctan2(edges[:, 1], edges[:, 0])) % 90 - 25).tolist()
    assert np.abs(off).max() < 3


def test_round_towers_stay_round_and_courts_stay_open():
    around = np.linspace(0, 2 * np.pi, 91)
    tower = [8.0 * np.column_stack([np.cos(around), np.sin(around)])]
    (rings,), _, _ = drawn(traced([tower]))
    assert hausdorff(rings, tower) < CELL
    assert corners(rings) >= 8
    court = [box(0, 0, 20, 16), box(6, 5, 7, 6)[::-1]]
    (rings,), _, _ = drawn(traced([court]))
    assert corners(rings) == 8
    assert polis(rings, court) < CELL / 3


def test_directions_are_found_square_by_square_as_at_once():
    """Memory would grow with the area; nothing else may depend on the squares."""
    turns = np.random.default_rng(3).uniform(0, 90, 40)
    houses = [[box(0, 0, 9, 7, turn) + [25 * (row % 8), 22 * (row // 8)]] for row, turn in enumerate(turns)]
    samples = [[sampled(ring, 0.75)] for (ring,) in traced(houses, noise=0.2)]
    whole = shared_directions(samples)
    for one, other in zip(shared_directions(samples, side=45.0), whole):
        np.testing.assert_array_equal(one, other)
    assert len({len(one) for one in whole}) > 1


def test_the_scale_of_many_outlines_is_measured_on_some(monkeypatch):
    houses = [[box(0, 0, 9, 7, turn) + [16 * turn, 0]] for turn in range(0, 60, 2)]
    whole = drawn(traced(houses))[2].values["tolerance"]
    monkeypatch.setattr(regularize_module, "_RULES", dataclasses.replace(regularize_module._RULES, measured=5))
    measured = []
    deviations = regularize_module.deviations
    monkeypatch.setattr(regularize_module, "deviations", lambda *of: measured.append(1) or deviations(*of))
    _, _, monitor = drawn(traced(houses))
    assert len(measured) == 5
    assert monitor.values["tolerance"] == pytest.approx(whole, rel=0.2)


def test_other_noise_changes_little():
    """Two outlines of one house differ less once they are drawn, and have few corners."""
    row = [[box(9.0 * number, 0, 9, 11)] for number in range(3)]
    first, second = (traced(row, 0.3, seed) for seed in (1, 2))
    made, again = drawn(first)[0], drawn(second)[0]

    def iou(one, other):
        edges = [as_polygons(each) for each in (one, other)]
        a, b, shared = overlaps(*edges, Monitor())
        return np.mean((shared / (edges[0].area[a] + edges[1].area[b] - shared))[a == b])

    assert iou(made, again) > iou(first, second) + 0.02
    assert iou(made, row) > iou(first, row)


def test_polygons_that_overlap_are_drawn_apart():
    """A part of a building lies in it: neither loses what both have."""
    made, _, _ = drawn([traced([[box(0, 0, 14, 9)]])[0], traced([[box(2, 2, 6, 5)]])[0]])
    assert [corners(rings) for rings in made] == [4, 4]


def test_what_is_too_small_for_the_tolerance_stays_as_it_is():
    house = traced([[box(0, 0, 3, 2)]])[0]
    (rings,), columns, monitor = drawn([house], tolerance=20.0)
    assert columns["regularized"] == [0]
    assert (rings[0] == house[0]).all()
    assert "too small for the tolerance" in monitor.warnings[0]


def test_a_larger_tolerance_gives_fewer_corners():
    house = [np.array([[0, 0], [12, 0], [12, 5], [13.2, 5], [13.2, 8], [12, 8], [12, 12], [0, 12], [0, 0.0]])]
    counts = [corners(drawn(traced([house]), tolerance=tolerance)[0][0]) for tolerance in (0.5, 4.0)]
    assert counts == [8, 4]


def test_attributes_stay_and_used_names_are_marked():
    house = traced([[box(0, 0, 14, 9)]])
    _, columns, _ = drawn(house, {"fid": np.array([3]), "Moved": ["yes"], "key": [None]})
    assert (columns["map_fid"], columns["map_Moved"], columns["key"]) == ([3], ["yes"], [None])


def test_an_empty_layer_is_refused():
    with pytest.raises(ValueError, match="has no features"):
        regularize_polygons(LayerFeatures([], {}))
