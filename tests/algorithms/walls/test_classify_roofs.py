"""Roofs of simulated planes: which are high and large enough, what belongs together, and what party walls part."""

import numpy as np
import pytest
from scipy import ndimage

from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.algorithms.walls.classify_roofs import classify_roofs, join_stacked, split_blocks

DENSITY = 20.0

# Width and depth of a house, room around the block, cells in which matching rounds edges (m).
WIDTH, DEPTH, ROOM, CELL = 8.0, 9.0, 3.0, 0.1

SIZE = 0.6


def plane(rng, west, south, width, depth, height, slope=0.0):
    n = round(width * depth * DENSITY)
    xy = rng.uniform((west, south), (west + width, south + depth), (n, 2))
    return np.column_stack([xy, height + slope * (xy[:, 1] - south)])


@pytest.fixture
def scene(rng):
    """A gable roof of two planes, a shed, a car, a small plane, a house without planes, all on level ground."""
    parts = [
        plane(rng, 0, 0, 10, 4, 3.0, 0.5),
        plane(rng, 0, 4, 10, 4, 5.0, -0.5),
        plane(rng, 20, 0, 4, 3, 2.6),
        plane(rng, 30, 0, 4.3, 1.8, 1.4),
        plane(rng, 40, 0, 1.5, 1.5, 4.0),
        plane(rng, 50, 0, 8, 8, 4.0),
        plane(rng, 0, 20, 60, 20, 0.0),
    ]
    sizes = [len(part) for part in parts]
    xyz = np.concatenate(parts)
    return {
        "xyz": xyz,
        "classification": np.repeat([1, 6, 1, 6, 1, 1, 2], sizes).astype(np.uint8),
        "height_above_ground": xyz[:, 2].astype(np.float32),
        "segment_id": np.repeat([1, 2, 3, 4, 5, 0, 0], sizes).astype(np.int32),
    }, np.repeat(np.arange(7), sizes)


def test_planes_above_the_least_height_that_lie_together_are_buildings(scene):
    arrays, part = scene
    classification, cluster_id = classify_roofs(**arrays)
    # From west to east; the car, the small plane and points on no plane are none.
    assert [sorted(set(cluster_id[part == i])) for i in range(7)] == [[1], [1], [2], [0], [0], [0], [0]]
    assert [sorted(set(classification[part == i])) for i in range(7)] == [[6], [6], [6], [1], [1], [1], [2]]


def test_segments_of_other_programs_have_any_number(scene):
    """-1 for none was refused with numpy's own words, and a number of two billion needed 16 GB."""
    arrays, _ = scene
    numbers = np.array([-1, 2_000_000_000, 7, 2**31 - 1, -2, 15], np.int32)
    renumbered = {**arrays, "segment_id": numbers[arrays["segment_id"]]}
    # The small plane, -2 here, is too small to be a roof under either number.
    for one, other in zip(classify_roofs(**renumbered), classify_roofs(**arrays)):
        np.testing.assert_array_equal(one, other)


def test_tunables_have_the_described_effect(scene):
    arrays, part = scene

    def found(**tunables):
        return [int(i) for i in range(6) if classify_roofs(**arrays, **tunables)[1][part == i].any()]

    assert found(min_height=1.0) == [0, 1, 2, 3]
    assert found(min_height=2.7) == [0, 1]
    assert found(min_area=1.0) == [0, 1, 2, 4]
    assert found(min_area=50.0) == [0, 1]
    joined = classify_roofs(**arrays, gap=12.0)[1]
    assert joined[part == 0].max() == joined[part == 2].max()


def test_a_roof_goes_down_to_its_eaves(rng):
    """Slopes from 2 to 4 m and from 1 to 3.4 m above the ground are roofs as a whole, one from 0.4 to 2.8 m is none."""
    for low, slope, found in ((2.0, 0.5, True), (1.0, 0.6, True), (0.4, 0.6, False)):
        roof = plane(rng, 0, 0, 10, 4, low, slope)
        height = roof[:, 2].astype(np.float32)
        _, cluster_id = classify_roofs(roof, np.ones(len(roof), np.uint8), height, np.ones(len(roof), np.int32))
        assert cluster_id.all() if found else not cluster_id.any()


def test_noise_is_no_roof(scene):
    arrays, part = scene
    arrays["classification"][part == 2] = PointClass.HIGH_NOISE
    classification, cluster_id = classify_roofs(**arrays)
    assert not cluster_id[part == 2].any()
    assert (classification[part == 2] == PointClass.HIGH_NOISE).all()


def test_the_order_of_points_changes_nothing(scene, rng):
    arrays, _ = scene
    order = rng.permutation(len(arrays["xyz"]))
    np.testing.assert_array_equal(
        classify_roofs(**{name: values[order] for name, values in arrays.items()})[1],
        classify_roofs(**arrays)[1][order],
    )


def test_a_few_points_far_apart_do_not_widen_the_gap_without_end():
    xyz = np.array([[0, 0, 0], [300, 0, 1], [0, 300, 8]], float)
    monitor = Monitor()
    classify_roofs(xyz, np.ones(3, np.uint8), xyz[:, 2].astype(np.float32), np.zeros(3, np.int32), monitor=monitor)
    assert monitor.values["gap"] == 5


def test_without_planes_nothing_is_a_roof_and_the_log_says_so(scene):
    arrays, _ = scene
    monitor = Monitor()
    classification, cluster_id = classify_roofs(
        **{**arrays, "segment_id": np.zeros(len(arrays["xyz"]), np.int32)}, monitor=monitor
    )
    assert not cluster_id.any()
    assert PointClass.BUILDING not in classification
    assert "No plane of 6 m² lies 2 m or more above the ground" in monitor.warnings[0]


def block(rng, levels, parapet=0.0, slope=0.0, density=40.0):
    """Return points of houses side by side on sloping ground, the house (from 1) that each is on, and heights (m)."""
    size = np.array([len(levels) * WIDTH, DEPTH]) + 2 * ROOM
    x, y = ((np.arange(round(length / CELL)) + 0.5) * CELL - ROOM for length in size)
    house = np.clip((x // WIDTH).astype(int), 0, len(levels) - 1)
    on_edge = np.minimum(x % WIDTH, WIDTH - x % WIDTH) < 0.3
    z = slope * np.tile(x, (len(y), 1))
    is_in = np.ix_((y >= 0) & (y < DEPTH), (x >= 0) & (x < len(levels) * WIDTH))
    is_edge = on_edge[None, :] | (np.minimum(y, DEPTH - y) < 0.3)[:, None]
    z[is_in] = (np.array(levels)[house][None, :] + parapet * is_edge)[is_in]
    z = ndimage.gaussian_filter(z, 0.15 / CELL)
    places = rng.uniform(0, size, (round(density * size.prod()), 2))
    column, row = (places / CELL).astype(int).T
    xyz = np.column_stack([places - ROOM, z[row, column] + rng.normal(0, 0.02, len(places))])
    height = xyz[:, 2] - slope * xyz[:, 0]
    return xyz, np.where(xyz[:, 2] > min(levels) - 0.5, house[column] + 1, 0), height


def parted(xyz, house, height):
    return split_blocks(xyz, height, (house > 0).astype(np.int32), 0.16, Monitor())


@pytest.mark.parametrize(
    ("levels", "parapet"),
    [((6, 6, 6, 6), 0.7), ((6, 6, 6, 6), 1.0), ((6, 6.5, 6, 6.5), 0.0), ((6, 7, 6), 0.0), ((6, 6.3, 6.6), 0.3)],
)
def test_walls_are_seen_by_parapets_and_steps(rng, levels, parapet):
    """On ground that falls by a meter and more next to the block."""
    xyz, house, height = block(rng, levels, parapet, slope=0.04)
    found = parted(xyz, house, height)
    assert found.max() == len(levels)
    # Houses are numbered from west to east, and points of the walls themselves may be on either side.
    assert (found == house).mean() > 0.97


@pytest.mark.parametrize("levels", [(6, 6, 6, 6), (6, 6.5)], ids=["nothing shows walls", "two are no row"])
def test_other_blocks_stay_one(rng, levels):
    xyz, house, height = block(rng, levels)
    np.testing.assert_array_equal(parted(xyz, house, height), house > 0)


def test_parts_of_a_building_beside_a_gap_stay_together(rng):
    """Two planes of one building two meters apart, which tracing parts."""
    xyz, house, height = block(rng, (6, 6))
    house[(xyz[:, 0] > 8) & (xyz[:, 0] < 11)] = 0
    np.testing.assert_array_equal(parted(xyz, house, height), house > 0)


@pytest.mark.parametrize("shape", ["a row", "far apart"])
def test_a_building_of_few_points_far_from_a_block_is_none_of_its_houses(rng, shape):
    """No triangle is drawn between points in a row, or too far apart."""
    xyz, house, height = block(rng, (6, 6.5, 6, 7))
    plan = [np.full(40, 80.0), np.linspace(0, 8, 40)] if shape == "a row" else rng.uniform(80, 100, (2, 40))
    xyz = np.concatenate([xyz, np.column_stack([*plan, np.full(40, 5.0)])])
    cluster_id = np.concatenate([house > 0, np.full(40, 2)]).astype(np.int32)
    found = split_blocks(xyz, np.append(height, np.full(40, 5.0)), cluster_id, 0.16, Monitor())
    assert found.max() == 5
    assert (found[-40:] == 5).all()
    assert (found[:-40] == house).mean() > 0.97


def test_the_order_of_points_does_not_matter(rng):
    xyz, house, height = block(rng, (6, 6.5, 6, 7))
    order = rng.permutation(len(xyz))
    expected = parted(xyz, house, height)[order]
    np.testing.assert_array_equal(parted(xyz[order], house[order], height[order]), expected)


def test_no_roof(rng):
    xyz = rng.uniform(0, 9, (50, 3))
    assert not split_blocks(xyz, xyz[:, 2], np.zeros(50, np.int32), 0.13, Monitor()).any()


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


def test_the_order_of_points_changes_no_stacked_roof(rng):
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
