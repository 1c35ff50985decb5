"""Roofs on and in other roofs, on roofs whose arrangement is known."""

import numpy as np
import pytest

from lidar_buildings.algorithms.walls.classify_roofs import classify_roofs, join_stacked

SIZE = 0.6


def roof(rng, west, south, width, depth, height, density=25.0):
    xy = rng.uniform((west, south), (west + width, south + depth), (round(width * depth * density), 2))
    return np.column_stack([xy, np.full(len(xy), float(height))])


def joined(*roofs):
    """Return which roof each of the given ones becomes, from 0."""
    number = np.repeat(np.arange(len(roofs)), [len(points) for points in roofs])
    found = join_stacked(np.concatenate(roofs), number, SIZE)
    assert all(len(set(found[number == i])) == 1 for i in range(len(roofs)))
    return [int(found[number == i][0]) for i in range(len(roofs))]


def without(points, west, south, width, depth):
    x, y = points[:, 0], points[:, 1]
    return points[~((x > west) & (x < west + width) & (y > south) & (y < south + depth))]


@pytest.mark.parametrize(("west", "south"), [(8, 4), (0, 4), (16.5, 4)])
def test_a_stair_house_is_of_the_roof_it_stands_on_also_at_its_edge(rng, west, south):
    main = without(roof(rng, 0, 0, 20, 12, 9), west - 0.6, south - 0.6, 4.7, 4.2)
    assert joined(main, roof(rng, west, south, 3.5, 3, 11.4)) == [0, 0]


def test_a_glass_roof_over_a_court_is_of_the_roof_around_it(rng):
    main = without(roof(rng, 0, 0, 20, 16, 9), 6, 5, 8, 6)
    assert joined(main, roof(rng, 6.5, 5.5, 7, 5, 6)) == [0, 0]


def test_objects_on_a_stair_house_are_of_the_same_roof(rng):
    main = without(roof(rng, 0, 0, 20, 16, 9), 6, 5, 8, 6)
    stairs = without(roof(rng, 6.5, 5.5, 7, 5, 12), 9, 7, 2, 2)
    assert joined(main, stairs, roof(rng, 9.2, 7.2, 1.6, 1.6, 14)) == [0, 0, 0]


def test_houses_in_a_row_and_back_to_back_stay_houses(rng):
    rows = [roof(rng, x, y, 8, 10, 6 + (x + y) % 9) for x in (0, 8, 16) for y in (0, 10)]
    assert joined(*rows) == [0, 1, 2, 3, 4, 5]


def test_a_house_in_a_courtyard_and_an_annex_in_a_nook_stay_buildings(rng):
    ring = without(roof(rng, 0, 0, 40, 40, 9), 8, 8, 24, 24)
    assert joined(ring, roof(rng, 15, 15, 8, 8, 6)) == [0, 1]
    nook = without(roof(rng, 0, 0, 20, 20, 9), 10, 10, 20, 20)
    assert joined(nook, roof(rng, 10.5, 10.5, 6, 6, 3)) == [0, 1]


def test_the_order_of_points_changes_nothing(rng):
    main, stairs = without(roof(rng, 0, 0, 20, 12, 9), 7, 3, 5, 5), roof(rng, 8, 4, 3.5, 3, 11.4)
    xyz, number = np.concatenate([main, stairs]), np.repeat([0, 1], [len(main), len(stairs)])
    order = rng.permutation(len(xyz))
    np.testing.assert_array_equal(join_stacked(xyz[order], number[order], SIZE), join_stacked(xyz, number, SIZE)[order])
    nothing = join_stacked(np.zeros((0, 3)), np.zeros(0, int), SIZE)
    assert len(nothing) == 0


def test_a_block_with_stair_houses_is_one_cluster(rng):
    main = without(without(roof(rng, 0, 0, 30, 12, 9), 5, 4, 4.2, 4.2), 20, 4, 4.2, 4.2)
    parts = [main, roof(rng, 5.6, 4.6, 3, 3, 11.4), roof(rng, 20.6, 4.6, 3, 3, 11.4), roof(rng, 40, 0, 8, 8, 5)]
    segment = np.repeat(np.arange(1, 5, dtype=np.int32), [len(part) for part in parts])
    xyz = np.concatenate(parts)
    _, cluster = classify_roofs(
        xyz, np.ones(len(xyz), np.uint8), xyz[:, 2].astype(np.float32), segment, min_area=4.0, density=25.0
    )
    assert [sorted(set(cluster[segment == i])) for i in (1, 2, 3, 4)] == [[1], [1], [1], [2]]
