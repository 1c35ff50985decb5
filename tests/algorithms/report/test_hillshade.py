"""The shaded surface below maps."""

import numpy as np
import pytest

from lidar_buildings.algorithms.report.hillshade import _shade, draw_hillshade, topmost


def test_the_topmost_point_of_each_cell_counts():
    xyz = np.array([[0.5, 0.5, 3.0], [0.6, 0.4, 1.0], [1.5, 0.5, 2.0], [0.5, 2.5, 7.0]])
    np.testing.assert_array_equal(topmost(xyz, np.zeros(2), 1.0), [[3, 2], [np.nan, np.nan], [7, np.nan]])


def test_slopes_toward_the_light_are_bright_and_level_ground_is_lit_at_its_altitude():
    column, row = np.meshgrid(np.arange(5.0), np.arange(5.0))
    assert _shade(np.zeros((5, 5)), 1.0) == pytest.approx(np.sin(np.pi / 4))
    # The light is in the northwest: a plane that falls toward it at its altitude is hit at a right angle.
    toward = (column - row) / np.sqrt(2)
    assert _shade(toward, 1.0) == pytest.approx(1.0)
    assert _shade(-toward, 1.0) == pytest.approx(0.0)


def test_a_single_point_has_a_picture():
    assert "<image" in draw_hillshade(np.zeros((1, 3)), np.zeros(2), np.zeros(2), 1.0)
