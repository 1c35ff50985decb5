"""Shared areas of polygons, by hand; `tests/qgis/test_polygons.py` holds any polygons against GEOS."""

import tracemalloc

import numpy as np
import pytest

from lidar_buildings.algorithms.geometry import polygon_overlap as module
from lidar_buildings.algorithms.geometry.polygon_overlap import as_polygons, meeting_boxes, overlaps, shared_areas
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.builders import star


def box(west, south, east, north):
    return np.array([[west, south], [east, south], [east, north], [west, north], [west, south]], float)


def shared(first, second):
    """Return the shared areas of all polygons of two lists, as a table."""
    table = np.zeros((len(first), len(second)))
    one, other, area = overlaps(as_polygons(first), as_polygons(second), Monitor())
    table[one, other] = area
    return table


def test_squares_by_hand():
    first = [[box(0, 0, 4, 4)], [box(10, 0, 14, 4)]]
    second = [[box(3, 3, 5, 5)], [box(4, 0, 5, 4)], [box(9, 1, 20, 2)]]
    np.testing.assert_allclose(shared(first, second), [[1, 0, 0], [0, 0, 4]], atol=1e-12)


def test_holes_are_not_shared_and_may_turn_any_way():
    court = [box(0, 0, 10, 10), box(2, 2, 8, 8)]
    for rings in (court, [court[0], court[1][::-1]], [court[0][::-1], court[1]]):
        np.testing.assert_allclose(shared([rings], [[box(1, 1, 5, 5)], [box(3, 3, 7, 7)]]), [[7, 0]], atol=1e-12)
        np.testing.assert_allclose(as_polygons([rings]).area, [64])


def test_triangles_whose_sides_cross():
    up, down = np.array([[0, 0], [2, 0], [1, 2], [0, 0.0]]), np.array([[0, 1], [2, 1], [1, -1], [0, 1.0]])
    # From 0 to 1 the hexagon between the two is as wide as the smaller of 1 + y and 2 - y.
    np.testing.assert_allclose(shared([[up]], [[down]]), [[1.25]])


def test_chunks_change_nothing(rng, monkeypatch):
    polygons = [star(rng, rng.uniform(0, 30, 2)) for _ in range(30)]
    whole = shared(polygons, polygons)
    # Fewer than the pairs of edges of two polygons, whose parts are added up.
    monkeypatch.setattr(module, "PAIRS_AT_ONCE", 50)
    np.testing.assert_allclose(shared(polygons, polygons), whole, rtol=1e-12, atol=1e-12)


def test_boxes_of_a_country_meet_in_little_memory():
    """All of a strip from south to north were held at once: 1.2 GB here."""
    low = np.stack(np.meshgrid(np.arange(20.0), np.arange(1000.0)), axis=-1).reshape(-1, 2)
    boxes = np.stack([low, low + 0.9], axis=1)
    tracemalloc.start()
    one, other = meeting_boxes(boxes, boxes)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert (one == np.arange(len(boxes))).all()
    assert (other == one).all()
    assert peak < 200e6


def test_two_outlines_of_many_corners_take_little_memory():
    """Two of 1,500 corners took 488 MB: all pairs of their edges at once."""
    angle = np.linspace(0, 2 * np.pi, 1501)
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    tracemalloc.start()
    (area,) = shared([[circle]], [[circle]])[0]
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert area == pytest.approx(np.pi, rel=1e-5)
    assert peak < 300e6


def test_what_winds_twice_or_the_wrong_way_is_seen_in_the_overlap_with_itself():
    bow = np.array([[0, 0], [4, 3], [4, 0], [0, 4], [0, 0.0]])
    twice = np.concatenate([box(0, 0, 2, 2), box(0, 0, 2, 2)[1:]])
    plain = box(0, 0, 3, 3)
    polygons = as_polygons([[bow], [twice], [plain]])
    every = np.arange(3)
    itself = shared_areas(polygons, polygons, every, every, Monitor())
    assert (np.abs(itself - polygons.area) > 0.1).tolist() == [True, True, False]


def test_nothing_shares_nothing():
    assert shared([], [[box(0, 0, 1, 1)]]).shape == (0, 1)
    assert [len(part) for part in overlaps(as_polygons([]), as_polygons([]), Monitor())] == [0, 0, 0]
