"""Pieces of pipes and planes, put together to whole pipes and planes."""

import numpy as np
import pytest

from lidar_buildings.algorithms.geometry.polygon_overlap import as_polygons
from lidar_buildings.algorithms.shapes.joined_pieces import whole_axis, whole_plane
from lidar_buildings.algorithms.stage import LayerFeatures
from lidar_buildings.tests.builders import turned


def rectangle(west, south, east, north):
    return np.array([[west, south], [east, south], [east, north], [west, north], [west, south]], float)


def pieces(*polygons, turn=0.0):
    """Return polygons, upright where they are turned, with areas and 100 points each."""
    lifted = [[np.column_stack([ring, np.zeros(len(ring))]) for ring in rings] for rings in polygons]
    tilt = np.array([[1, 0, 0], [0, np.cos(turn), -np.sin(turn)], [0, np.sin(turn), np.cos(turn)]])
    placed = [[ring @ tilt.T + [6e5, 5e6, 30] for ring in rings] for rings in lifted]
    count = len(polygons)
    area = np.abs(as_polygons([list(rings) for rings in polygons]).area).tolist()
    columns = {"id": list(range(count)), "points": [100] * count, "area": area, "rms": [0.01] * count}
    return LayerFeatures(placed, columns), tilt


@pytest.mark.parametrize("turn", [0.0, 1.2, np.pi / 2])
def test_a_plane_has_the_outline_of_all_its_pieces(turn):
    """An L with a hole in the part that both pieces have, at any slope: 20 m by 4 m and 4 m by 10 m."""
    hole = rectangle(5, 1, 7, 3)[::-1]
    both, tilt = pieces([rectangle(0, 0, 12, 4), hole], [rectangle(4, 0, 20, 4), hole], turn=turn)
    one = whole_plane(both, 150)
    assert one.columns["points"] == [150]
    assert one.columns["id"] == [0]
    assert one.columns["area"][0] == pytest.approx(80 - 4, rel=0.02)
    (outer, inner) = (((ring - [6e5, 5e6, 30]) @ tilt) for ring in one.geometries[0])
    for ring, west, east in ((outer, 0, 20), (inner, 5, 7)):
        np.testing.assert_allclose([ring[:, 0].min(), ring[:, 0].max()], [west, east], atol=0.11)
        assert np.abs(ring[:, 2]).max() < 1e-6
        # Closed, and turned as the first piece: the exterior counterclockwise, the hole clockwise.
        assert (ring[0] == ring[-1]).all()
    assert np.cross(outer[:-1], outer[1:])[:, 2].sum() > 0 > np.cross(inner[:-1], inner[1:])[:, 2].sum()


def test_a_piece_within_another_changes_nothing_of_its_outline():
    both, _ = pieces([rectangle(0, 0, 12, 4)], [rectangle(4, 0, 12.05, 4)])
    one = whole_plane(both, 120)
    assert one.geometries[0] is both.geometries[0]
    assert one.columns["area"] == [48.0]


def test_an_axis_goes_from_the_farthest_end_to_the_farthest_end(rng):
    """Pieces of a slanted pipe, in either direction, millimeters apart."""
    way = turned(np.array([[0.8, 0.6, 0.1]]), 30)[0]
    way /= np.linalg.norm(way)
    places = [(5.0, 30.0), (20.0, 0.0), (44.0, 28.0)]
    lines = [np.outer(ends, way) + [6e5, 5e6, 3] + rng.normal(0, 0.001, (2, 3)) for ends in places]
    columns = {"id": [1, 2, 3], "radius": [0.1, 0.102, 0.1], "length": [25.0, 20.0, 16.0], "points": [200, 100, 100]}
    columns.update(rms=[0.002] * 3, seen=[0.4, 0.5, 0.3])
    one = whole_axis(LayerFeatures(lines, columns), 350)
    (line,) = one.geometries
    np.testing.assert_allclose(sorted((line - [6e5, 5e6, 3]) @ way), [0, 44], atol=0.01)
    assert one.columns["length"] == pytest.approx([44], abs=0.01)
    assert one.columns["radius"] == pytest.approx([0.1005])
    assert (one.columns["points"], one.columns["seen"], one.columns["id"]) == ([350], [0.5], [1])
