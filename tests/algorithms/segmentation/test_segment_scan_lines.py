"""Artificial scan lines: components by brute force, and what joins the terrain."""

import numpy as np
import pytest
from scipy.sparse import csgraph

from lidar_buildings.algorithms.segmentation.scan_line_pieces import NearPoints, merged_pieces, pieces
from lidar_buildings.algorithms.segmentation.segment_scan_lines import segment_scan_lines as stage
from lidar_buildings.algorithms.stage import Cancelled
from lidar_buildings.tests.builders import FAR
from lidar_buildings.tests.monitors import Listening


def segment_scan_lines(xyz, **tunables):
    return stage(xyz, np.ones(len(xyz), np.uint8), **tunables)


def same_groups(one, other):
    pairs = np.unique(np.column_stack([one, other]), axis=0)
    return len(pairs) == len(np.unique(one)) == len(np.unique(other))


def test_pieces_and_their_merging_by_brute_force(rng):
    """Few points to a line, so that each is compared with all others of its line."""
    xyz = rng.uniform(0, [6, 6, 1], (90, 3))
    near = NearPoints(1.1, 0.5, 0.1)
    links = np.zeros((90, 90), bool)
    piece_sets = []
    for degrees in (0, 90):
        across = xyz[:, 1] if degrees == 0 else -xyz[:, 0]
        line = np.floor((across + 0.3) / 0.6)
        steps = xyz[:, None] - xyz
        apart, height = np.hypot(steps[..., 0], steps[..., 1]), np.abs(steps[..., 2])
        joined = (line[:, None] == line) & (np.hypot(apart, height) <= 1.1) & (height <= 0.1 + 0.5 * apart)
        piece_sets.append(pieces(xyz, degrees, 0.6, near, 1))
        window = {line_number: np.sum(line == line_number) for line_number in line}
        assert max(window.values()) < 20
        expected = csgraph.connected_components(joined)[1]
        assert same_groups(piece_sets[-1], expected)
        links |= joined
    assert same_groups(merged_pieces(piece_sets), csgraph.connected_components(links)[1])


@pytest.fixture(scope="module")
def scene():
    """Ground with a canal 3 m deep, a bridge over it, and a flat roof 4 m high; 6 points per m²."""
    rng = np.random.default_rng(8)
    x, y = rng.uniform(0, 50, (15_000, 2)).T
    # The bridge divides the canal in two: points south of it are of no segment.
    part = np.where((x > 20) & (x < 30), 1, 0)
    part[(part == 1) & (y > 22) & (y < 28)] = 2
    x, y, part = (values[(part != 1) | (y > 28)] for values in (x, y, part))
    part[(x > 5) & (x < 13) & (y > 5) & (y < 15)] = 3
    z = np.array([0.0, -3.0, 0.0, 4.0])[part] + rng.normal(0, 0.02, len(x))
    return np.column_stack([x, y, z]), part


@pytest.mark.parametrize("directions", [2, 3, 4])
def test_a_bridge_joins_the_terrain_and_a_roof_does_not(scene, directions):
    xyz, part = scene
    ids = segment_scan_lines(xyz, directions=directions)
    terrain, water, bridge, roof = (np.bincount(ids[part == number]).argmax() for number in range(4))
    assert terrain == bridge
    assert len({terrain, water, roof, 0}) == 4
    for number, segment in enumerate((terrain, water, bridge, roof)):
        assert (ids[part == number] == segment).mean() > 0.99


def test_a_piece_passes_over_outliers_and_narrow_obstacles(scene):
    xyz, part = scene
    ground = xyz[(part == 0) & (xyz[:, 0] < 20)].copy()
    fence = np.abs(ground[:, 0] - 10) < 0.5
    ground[fence, 2] += 1.5
    ids = segment_scan_lines(ground)
    assert len(set(ids[~fence & (ground[:, 0] < 9)]) | set(ids[~fence & (ground[:, 0] > 11)])) == 1
    near = segment_scan_lines(ground, distance=0.8)
    assert np.bincount(near[ground[:, 0] < 9]).argmax() != np.bincount(near[ground[:, 0] > 11]).argmax()


def test_a_piece_goes_on_behind_a_wide_obstacle_if_it_may(scene):
    """A hedge 2.5 m wide, denser than the ground, from edge to edge; ground behind it at the same height or 1 m up."""
    rng = np.random.default_rng(1)
    x, y = rng.uniform(0, (20, 30), (3600, 2)).T
    east = x > 11
    for rise in (0.0, 1.0):
        ground = np.column_stack([x, y, rise * east + rng.normal(0, 0.02, len(x))])[np.abs(x - 10) > 1.25]
        hedge = rng.uniform((8.75, 0, 0.8), (11.25, 30, 2), (3000, 3))
        xyz = np.concatenate([ground, hedge])
        for obstacle, is_one in ((0.0, False), (2.0, False), (3.5, rise == 0)):
            ids = segment_scan_lines(xyz, max_obstacle=obstacle, density=6.0, max_slope=10.0)[: len(ground)]
            sides = (np.bincount(ids[ground[:, 0] < 8]).argmax(), np.bincount(ids[ground[:, 0] > 12]).argmax())
            assert (sides[0] == sides[1]) == is_one
            assert min((ids[ground[:, 0] < 8] == sides[0]).mean(), (ids[ground[:, 0] > 12] == sides[1]).mean()) > 0.97


def test_slope_is_a_criterion_that_can_be_left_out(scene):
    xyz, part = scene
    assert len(np.unique(segment_scan_lines(xyz, max_slope=90.0, distance=5.0))) == 1
    assert len(np.unique(segment_scan_lines(xyz, distance=5.0))) >= 3


def test_order_and_position_change_nothing(scene):
    xyz = scene[0].round(3)
    tunables = {"line_width": 1.0, "distance": 3.0, "max_step": 0.1}
    ids = segment_scan_lines(xyz, **tunables)
    order = np.random.default_rng(2).permutation(len(xyz))
    assert same_groups(segment_scan_lines(xyz[order], **tunables), ids[order])
    assert (segment_scan_lines(xyz + FAR, **tunables) == ids).mean() > 0.999


def test_few_points_and_noise_give_no_segment(scene):
    assert not segment_scan_lines(scene[0][:1], density=1.0, noise=0.1).any()
    assert not segment_scan_lines(scene[0][:12]).any()
    classes = np.full(len(scene[0]), 18, np.uint8)
    classes[:5000] = 1
    assert not stage(scene[0], classes)[5000:].any()


def test_cancel_gets_through(scene):
    with pytest.raises(Cancelled):
        stage(scene[0], np.ones(len(scene[0]), np.uint8), monitor=Listening(stop_at=0.4))
