"""Planes that grow from voxel to voxel."""

import numpy as np

from lidar_buildings.algorithms.geometry.boxes import Boxes
from lidar_buildings.algorithms.planes.least_squares_planes import Planes, planes_of
from lidar_buildings.algorithms.planes.plane_merging import NearestPlanes, grown_planes
from lidar_buildings.algorithms.stage import Monitor


def test_a_plane_grows_along_a_strip_and_looks_at_each_point_a_few_times(rng, monkeypatch):
    """In each round all points next to the plane were looked at again: a strip of 40 voxels 22 times over."""
    xyz = np.column_stack([rng.uniform(0, 40, 4000), rng.uniform(0, 0.9, 4000), rng.normal(0, 0.01, 4000)])
    xyz[:, 2] -= xyz[:, 2].min()
    # Half way along, points of 0.1 m lie 10 cm higher: they are of no plane.
    is_off = (xyz[:, 0] > 20.2) & (xyz[:, 0] < 20.3)
    xyz[is_off, 2] += 0.1
    boxes = Boxes(xyz, 1.0)
    plane = planes_of(xyz[~is_off], np.zeros((~is_off).sum(), int), 1)
    looked_at, distance = [], Planes.distance
    monkeypatch.setattr(Planes, "distance", lambda *given: looked_at.append(len(given[1])) or distance(*given))
    found = grown_planes(NearestPlanes(boxes, plane, 0.05), np.zeros(1, int), np.zeros(1, int), Monitor())
    np.testing.assert_array_equal(found, np.where(is_off[boxes.order], -1, 0))
    assert sum(looked_at) <= 3 * len(xyz)
