"""Outlines of real clouds hold still when points move by 2 mm with fixed classes, and are the same in blocks."""

import numpy as np
import pytest

from lidar_buildings.algorithms.footprints.extract_footprints import extract_footprints
from lidar_buildings.algorithms.quality.polygon_comparison import hausdorff
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.benchmarks.outlines import in_blocks
from lidar_buildings.tests.polygon_matches import match_polygons
from lidar_buildings.tests.real.clouds import detected, path_of

DIMENSIONS = ("classification", "cluster_id", "height_above_ground", "reason")


@pytest.mark.parametrize(
    ("name", "seeds", "least_iou", "most_distance"),
    # Reached in the worst of three draws: 0.14 and 0.08 m. Traced alpha shapes moved by 0.7 m in Delft.
    [
        ("buildings/ign-stbarth-4", (1,), 0.98, 0.15),
        pytest.param("buildings/ign-stbarth-4", (2, 3), 0.98, 0.15, marks=pytest.mark.slow),
        pytest.param("buildings/ahn3-delft-4", (1, 2, 3), 0.985, 0.15, marks=pytest.mark.slow),
    ],
)
def test_points_moved_by_two_millimeters_hardly_move_outlines(name, seeds, least_iou, most_distance):
    cloud = detected(name).cloud
    xyz, arrays = cloud.get("xyz"), {dimension: cloud.get(dimension) for dimension in DIMENSIONS}
    one = extract_footprints(xyz, **arrays).geometries
    for seed in seeds:
        moved = xyz + np.random.default_rng(seed).normal(0, 0.002, xyz.shape)
        other = extract_footprints(moved, **arrays).geometries
        found = match_polygons(one, other, Monitor())
        assert len(found.one) == len(one)
        assert np.median(found.iou) >= least_iou
        assert np.median([hausdorff(one[i], other[j]) for i, j in zip(found.one, found.other)]) <= most_distance


@pytest.mark.parametrize(
    ("name", "side", "most_distance"),
    [
        # How the survey was sampled counted its noise points, which moved two of the ten outlines by 0.5 and 1.2 m.
        pytest.param("buildings/ign-stbarth-4", 60.0, 0.01, marks=pytest.mark.slow),
        ("buildings/ign-stbarth-4", 140.0, 0.01),
        # With cells at the first point of each window, samples in the order of the points, and directions of walls
        # beyond the window, 32 and 27 of 51 outlines were within 5 cm.
        pytest.param("buildings/ahn3-delft-4", 100.0, 0.05, marks=pytest.mark.slow),
        pytest.param("buildings/ahn3-delft-4", 140.0, 0.05, marks=pytest.mark.slow),
    ],
)
def test_outlines_of_blocks_are_those_of_the_whole(name, side, most_distance):
    whole = detected(name)
    one = [[whole.cloud.to_map(ring) for ring in rings] for rings in whole.layers["footprints"].geometries]
    other = in_blocks(path_of(name), side)
    found = match_polygons(one, other, Monitor())
    assert len(found.one) == len(one) == len(other)
    assert max(hausdorff(one[i], other[j]) for i, j in zip(found.one, found.other)) <= most_distance
