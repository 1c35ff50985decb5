"""Outlines of two real clouds with fixed classes hold still when points move by 2 mm."""

import numpy as np
import pytest

from lidar_buildings.algorithms.footprints.extract_footprints import extract_footprints
from lidar_buildings.algorithms.quality.polygon_comparison import hausdorff, match_polygons
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.real.clouds import detected

DIMENSIONS = ("classification", "cluster_id", "height_above_ground")


@pytest.mark.parametrize(
    ("name", "least_iou", "most_distance"),
    # Reached: 0.12 m and less than 0.15 m. Traced alpha shapes moved by 0.7 m in Delft.
    [("buildings/ign-stbarth-4", 0.98, 0.15), ("buildings/ahn3-delft-4", 0.985, 0.15)],
)
def test_points_moved_by_two_millimeters_hardly_move_outlines(name, least_iou, most_distance):
    cloud = detected(name).cloud
    xyz, arrays = cloud.get("xyz"), {dimension: cloud.get(dimension) for dimension in DIMENSIONS}
    moved = xyz + np.random.default_rng(1).normal(0, 0.002, xyz.shape)
    one, other = (extract_footprints(places, **arrays).geometries for places in (xyz, moved))
    found = match_polygons(one, other, Monitor())
    assert len(found.one) == len(one)
    assert np.median(found.iou) >= least_iou
    assert np.median([hausdorff(one[i], other[j]) for i, j in zip(found.one, found.other)]) <= most_distance
