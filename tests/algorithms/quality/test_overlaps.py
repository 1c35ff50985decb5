"""Shared areas of polygons: by hand, and any polygons against GEOS."""

import numpy as np
import pytest

from lidar_buildings.algorithms.quality import overlaps as module
from lidar_buildings.algorithms.quality.overlaps import as_polygons, overlaps, shared_areas
from lidar_buildings.algorithms.stage import Monitor

FAR = np.array([600_000.0, 5_000_000.0])


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


def star(rng, center):
    """A simple polygon with up to 12 corners, some of them pointing inward."""
    angle = np.sort(rng.uniform(0, 2 * np.pi, rng.integers(5, 13)))
    reach = rng.uniform(1.5, 6, len(angle))
    ring = center + np.column_stack([reach * np.cos(angle), reach * np.sin(angle)])
    ring = np.concatenate([ring, ring[:1]])
    return [ring, (center + (ring - center) * 0.4)[::-1]] if rng.random() < 0.4 else [ring]


def test_any_polygons_agree_with_geos(rng):
    ogr = pytest.importorskip("osgeo.ogr")
    pytest.importorskip("osgeo.gdal").UseExceptions()

    def made(rings):
        text = ",".join("(" + ",".join(f"{x!r} {y!r}" for x, y in ring.tolist()) + ")" for ring in rings)
        return ogr.CreateGeometryFromWkt(f"POLYGON ({text})")

    polygons = []
    while len(polygons) < 80:
        center = FAR + rng.uniform(0, 40, 2)
        rings = star(rng, center)
        angle = np.sort(np.arctan2(*(rings[0][:-1] - center).T))
        # With the center inside, the outline is simple and its copy a hole in it.
        if np.diff(angle, append=angle[0] + 2 * np.pi).max() < 3:
            polygons.append(rings)
    first, second = polygons[:40], polygons[40:]
    expected = [[made(a).Intersection(made(b)).Area() for b in second] for a in first]
    assert np.count_nonzero(np.array(expected)) > 50
    np.testing.assert_allclose(shared(first, second), expected, atol=1e-6)
    np.testing.assert_allclose(as_polygons(first).area, [made(a).Area() for a in first], atol=1e-6)


def test_chunks_change_nothing(rng, monkeypatch):
    polygons = [star(rng, rng.uniform(0, 30, 2)) for _ in range(30)]
    whole = shared(polygons, polygons)
    monkeypatch.setattr(module, "_PAIRS_AT_ONCE", 50)
    np.testing.assert_array_equal(shared(polygons, polygons), whole)


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
