"""Views of a building: sections run along and across it, and walls are drawn where its outline ends."""

from __future__ import annotations

import re

import numpy as np
import pytest

from lidar_buildings.algorithms.report.building_views import draw_sections

WHITE_GRAY_RED = np.array([[255, 255, 255], [187, 187, 187], [187, 85, 102]])


@pytest.fixture
def house(rng):
    """A house of 12 by 6 m, 5 m high, turned by 30°, at (50, 40), and the ground around it."""
    plan = rng.uniform(-10, 10, (4000, 2))
    is_roof = (np.abs(plan) < (6, 3)).all(axis=1)
    turn = np.array([[np.cos(np.pi / 6), np.sin(np.pi / 6)], [-np.sin(np.pi / 6), np.cos(np.pi / 6)]])
    ring = np.array([[-6, -3], [6, -3], [6, 3], [-6, 3], [-6, -3]]) @ turn + (50, 40)
    return np.column_stack([plan @ turn + (50, 40), np.where(is_roof, 5.0, 0.0)]), is_roof, ring


def walls(view):
    """The positions of the walls of a section, as shares of its width."""
    width = float(re.search(r'width="(\d+)"', view)[1])
    return [float(x) / width for x in re.findall(r'polyline points="([\d.]+),', view)]


def test_sections_lie_along_and_across_the_house(house):
    plan, along, across = draw_sections(*house, WHITE_GRAY_RED)
    assert plan.count("<polyline") == 3
    assert walls(along) == pytest.approx([4 / 20, 16 / 20], abs=0.01)
    assert walls(across) == pytest.approx([4 / 14, 10 / 14], abs=0.01)
    # 12 and 6 m with 4 m at each end; 5 m with 1 m above and below.
    sizes = [[int(one) for one in re.search(r'viewBox="0 0 (\d+) (\d+)"', view).groups()] for view in (along, across)]
    assert [width / height for width, height in sizes] == pytest.approx([20 / 7, 14 / 7], rel=0.02)


def test_without_points_there_is_the_outline_alone(house):
    views = draw_sections(np.zeros((0, 3)), np.zeros(0, np.uint8), house[2])
    assert len(views) == 1
    assert views[0].count("<polyline") == 1
