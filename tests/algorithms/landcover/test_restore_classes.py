"""Remembered classes that are put back."""

import numpy as np

from lidar_buildings.algorithms.landcover.restore_classes import restore_classes

XYZ = np.array([[0.0, 0, 0], [0.3, 0, 9], [9, 0, 0], [9.3, 0, 0], [20, 0, 0], [21, 0, 0]])
NOW = np.array([6, 1, 6, 2, 5, 6], np.uint8)


def test_without_remembered_classes_nothing_changes():
    for earlier in (None, np.zeros(6, np.uint8)):
        classes, number = restore_classes(XYZ, NOW, None, earlier)
        np.testing.assert_array_equal(classes, NOW)
        assert number is None


def test_remembered_classes_are_put_back_and_no_other_buildings_stay():
    classes, _ = restore_classes(XYZ, NOW, None, np.array([0, 0, 6, 6, 0, 9], np.uint8))
    assert classes.tolist() == [1, 1, 6, 6, 5, 9]


def test_where_no_buildings_are_kept_those_found_stay():
    classes, number = restore_classes(XYZ, NOW, np.ones(6, np.int32), np.array([0, 2, 0, 0, 0, 0], np.uint8))
    assert classes.tolist() == [6, 2, 6, 1, 5, 6]
    assert number is None


def test_kept_buildings_are_numbered_by_what_is_close_in_plan():
    earlier = np.array([6, 6, 6, 6, 0, 0], np.uint8)
    _, number = restore_classes(XYZ, NOW, np.zeros(6, np.int32), earlier, sampling=_Spacing())
    assert number.tolist() == [1, 1, 2, 2, 0, 0]


class _Spacing:
    spacing = 0.2
