"""The points of a survey that its pages show."""

import numpy as np

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.tiling.views import View


def test_tiles_keep_topmost_points_and_all_in_boxes(tmp_path):
    origin = np.array([1000.0, 2000.0, 0.0])
    boxes = np.array([[[10.0, 10.0], [11.0, 11.0]]])
    view = View(tmp_path, origin, 1.0, boxes)
    low = [[0.5, 0.5, 1.0], [0.6, 0.6, 3.0], [0.7, 0.7, 2.0], [0.5, 0.5, 99.0]]
    near = [[10.2, 10.2, 1.0], [10.3, 10.3, 2.0], [10.4, 10.4, 0.0]]
    xyz = np.array(low + near) + origin
    classes = np.array([2, 6, 5, 18, 2, 6, 2], np.uint8)
    view.add("a.laz", create_cloud({"xyz": xyz, "classification": classes}))
    view.add("b.laz", create_cloud({"xyz": xyz[:1] + 5, "classification": classes[:1]}))
    found, of_them = view.points([tmp_path / "a.laz", tmp_path / "b.laz"])
    np.testing.assert_allclose(found, np.array([low[1], *near, [5.5, 5.5, 6.0]]), atol=1e-6)
    assert of_them.tolist() == [6, 2, 6, 2, 2]
    assert len(view.points([])[0]) == 0
