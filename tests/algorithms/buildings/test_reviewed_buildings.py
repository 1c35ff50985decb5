"""What a reviewer decided on buildings counts for their points, whatever a run finds."""

import numpy as np
import pytest

from lidar_buildings.algorithms.buildings.reviewed_buildings import CHANGED, DELETED, KEPT, ReviewedBuildings
from lidar_buildings.algorithms.cloud.reasons import Reason
from lidar_buildings.algorithms.stage import LayerFeatures, Monitor


def square(x, size=10.0):
    return [np.array([[x, 0], [x + size, 0], [x + size, size], [x, size], [x, 0]], float)]


def review(*decisions):
    """Squares of 10 m, 20 m apart, each with a decision."""
    squares = [square(20.0 * number) for number in range(len(decisions))]
    return ReviewedBuildings.of(LayerFeatures(squares, {"review": list(decisions)}))


def row(x, n, elevation):
    """Points a meter apart along a line through a square, from ``x`` on."""
    return np.column_stack([x + np.arange(n) + 0.5, np.full(n, 5.0), np.full(n, elevation)])


def test_deleted_buildings_go_with_their_edges_and_kept_ones_come_back():
    # A deleted building that sticks out of its outline by 3 m; a kept one that was not found, with a point of the
    # ground and one near it; a changed one that was found, with a tree over it; and one that nobody decided on.
    parts = [row(0, 13, 5.0), row(20, 8, 4.0), row(20, 1, 0.0), row(25, 1, 0.3), row(40, 8, 6.0), row(42, 3, 9.0)]
    xyz = np.concatenate([*parts, row(60, 5, 5.0)])
    sizes = [13, 8, 1, 1, 8, 3, 5]
    classes = np.repeat([6, 1, 2, 1, 6, 5, 6], sizes).astype(np.uint8)
    cluster = np.repeat([1, 0, 0, 0, 2, 0, 3], sizes).astype(np.int32)
    sure = np.where(classes == 6, 0.6, np.nan).astype(np.float32)
    given = xyz, xyz[:, 2], (classes, cluster, sure, np.zeros(len(xyz), np.uint8)), Monitor()
    found, number, confidence, reason = review(DELETED, KEPT, CHANGED, None).decide(*given)
    np.testing.assert_array_equal(found, np.repeat([1, 6, 2, 1, 6, 5, 6], sizes))
    np.testing.assert_array_equal(number, np.repeat([1, 4, 0, 0, 2, 0, 3], sizes))
    np.testing.assert_array_equal(reason, np.repeat([Reason.DELETED, Reason.KEPT, 0, 0, 0, 0, 0], sizes))
    np.testing.assert_array_equal(
        confidence, np.repeat(np.float32([0.0, 1.0, np.nan, np.nan, 0.6, np.nan, 0.6]), sizes)
    )
    assert found.dtype == np.uint8
    assert (number.dtype, confidence.dtype) == (np.int32, np.float32)


def test_only_the_part_within_its_outline_is_deleted_from_a_row():
    xyz = row(0, 30, 5.0)
    arrays = np.full(30, 6, np.uint8), np.ones(30, np.int32), None, None
    found, number, confidence, reason = review(DELETED).decide(xyz, xyz[:, 2], arrays, Monitor())
    np.testing.assert_array_equal(found, np.repeat([1, 6], [10, 20]))
    assert (number == 1).all()
    assert confidence is None
    assert reason is None


def test_a_layer_without_decisions_decides_nothing():
    assert ReviewedBuildings.of(None) is None
    assert review(None, None) is None
    with pytest.raises(ValueError, match="no attribute 'review'; choose footprints that were reviewed"):
        ReviewedBuildings.of(LayerFeatures([square(0.0)], {"id": [1]}))
