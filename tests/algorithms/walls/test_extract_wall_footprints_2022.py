"""Edges of walls as published, on walls made point by point: corners are known, and densities are counted again."""

import numpy as np
import pytest

from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.algorithms.walls.extract_wall_footprints_2022 import extract_wall_footprints_2022
from lidar_buildings.tests.builders import is_inside
from lidar_buildings.tests.monitors import Listening
from lidar_buildings.tests.polygon_validity import assert_valid

L_SHAPE = np.array([(0, 0), (12, 0), (12, 10), (7, 10), (7, 6), (0, 6)], float)
COURT = [np.array([(0, 0), (20, 0), (20, 20), (0, 20)], float), np.array([(6, 6), (14, 6), (14, 14), (6, 14)], float)]
SKEW = np.array([(0, 0), (10, 0), (14, 6), (0, 6)], float)


def walls(rng, *rings, per_meter=40, noise=0.02, missing=(), turn=0.4):
    """Return the arguments of the stage for one building, and its true corners; walls ``missing`` have no points."""
    points = []
    for ring in rings:
        for i, (a, b) in enumerate(zip(ring, np.roll(ring, -1, 0))):
            share = rng.random((0 if i in missing else round(np.hypot(*(b - a)) * per_meter), 1))
            points.append(a + share * (b - a))
    xy = np.concatenate(points) + rng.normal(0, noise, (sum(map(len, points)), 2))
    rotation = np.array([(np.cos(turn), np.sin(turn)), (-np.sin(turn), np.cos(turn))])
    xyz = np.column_stack([xy @ rotation + 500.0, rng.uniform(0.3, 2.5, len(xy))])
    arrays = {"xyz": xyz, "cluster_id": np.zeros(len(xy), int), "wall_of": np.full(len(xy), 7)}
    return arrays, np.concatenate(rings) @ rotation + 500.0


def farthest(true, found):
    """Return the largest distance of a true corner from the nearest found one."""
    return np.hypot(*(true[:, None] - np.asarray(found)).transpose(2, 0, 1)).min(axis=1).max()


def test_corners_and_edges_are_those_of_the_walls(rng):
    arrays, true = walls(rng, L_SHAPE)
    footprints, edges, corners, report = extract_wall_footprints_2022(**arrays)
    assert len(footprints) == 1
    assert_valid(footprints.geometries[0])
    assert len(footprints.geometries[0][0]) - 1 == len(true)
    assert farthest(true, footprints.geometries[0][0]) < 0.03
    assert footprints.columns["area"] == pytest.approx([92], rel=0.01)
    assert footprints.columns["cluster_id"] == [7]
    # Three walls in each of two directions cross in nine points. Two lie on long walls, which they part.
    assert sorted(edges.columns["length"]) == pytest.approx([4, 4, 5, 5, 6, 6, 7, 7], abs=0.05)
    assert sorted(corners.columns["edges"]) == [0, 2, 2, 2, 2, 2, 2, 2, 2]
    assert (report.values["candidates"], report.values["kept_corners"]) == (9, 6)


def test_densities_are_those_of_rectangles_as_the_authors_program_draws_them(rng):
    arrays, _ = walls(rng, L_SHAPE)
    edges = extract_wall_footprints_2022(**arrays, ends=0.3, width=0.15)[1]
    xy = arrays["xyz"][:, :2]
    for (start, end), count, density in zip(edges.geometries, edges.columns["points"], edges.columns["density"]):
        bearing, length = np.arctan2(*(end - start)[::-1]), np.hypot(*(end - start))
        way, side = np.array([np.cos(bearing), np.sin(bearing)]), np.array([-np.sin(bearing), np.cos(bearing)])
        shares = ((0.3, 1), (0.3, -1), (length - 0.3, -1), (length - 0.3, 1), (0.3, 1))
        ring = np.array([start + along * way + 0.15 * across * side for along, across in shares])
        assert count == is_inside(xy, [ring]).sum() > 0
        assert density == pytest.approx(count / (0.3 * (length - 0.6)))


def test_courtyards_are_holes(rng):
    arrays, true = walls(rng, *COURT)
    (rings,) = extract_wall_footprints_2022(**arrays)[0].geometries
    assert_valid(rings)
    assert [len(ring) - 1 for ring in rings] == [4, 4]
    assert farthest(true, np.concatenate(rings)) < 0.03


def test_only_right_angles_are_corners(rng):
    arrays, true = walls(rng, SKEW)
    footprints, edges, corners, _ = extract_wall_footprints_2022(**arrays)
    assert len(footprints) == 0
    assert len(edges) == 1
    assert farthest(true[[0, 3]], corners.geometries) < 0.03
    assert len(corners) == 2
    assert len(extract_wall_footprints_2022(**arrays, max_skew=80.0)[0]) == 1


def test_a_wall_that_was_not_seen_leaves_the_outline_open(rng):
    arrays, _ = walls(rng, L_SHAPE, missing=(2,))
    footprints, edges, *_ = extract_wall_footprints_2022(**arrays)
    assert len(footprints) == 0
    assert sorted(edges.columns["length"]) == pytest.approx([5, 6, 6, 7, 7], abs=0.05)


def test_a_thin_wall_is_no_edge_where_the_density_is_too_small(rng):
    arrays, _ = walls(rng, L_SHAPE)
    listening = Listening()
    extract_wall_footprints_2022(**arrays, monitor=listening)
    # A buffer is 0.4 m wide: 40 points per meter are 100 per square meter, a quarter of which is enough.
    assert listening.values["min_density"] == pytest.approx(25, rel=0.1)
    assert listening.values["min_points"] == pytest.approx(60, rel=0.4)
    assert len(extract_wall_footprints_2022(**arrays, min_density=120.0)[1]) == 0


def test_the_order_of_points_does_not_matter(rng):
    arrays, _ = walls(rng, L_SHAPE)
    order = rng.permutation(len(arrays["xyz"]))
    one = extract_wall_footprints_2022(**arrays)[1]
    other = extract_wall_footprints_2022(**{name: values[order] for name, values in arrays.items()})[1]
    np.testing.assert_array_equal(one.geometries, other.geometries)
    assert one.columns == other.columns


def test_without_walls_there_is_nothing(rng):
    arrays, _ = walls(rng, L_SHAPE)
    arrays["wall_of"][:] = 0
    assert [len(layer) for layer in extract_wall_footprints_2022(**arrays, monitor=Monitor())[:3]] == [0, 0, 0]
