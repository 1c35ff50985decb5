"""Polygons of groups of cells, by hand; `tests/qgis/test_polygons.py` holds any pattern against GEOS."""

import numpy as np

from lidar_buildings.algorithms.geometry.cell_outlines import outline_cells
from lidar_buildings.algorithms.geometry.grid import Grid, connected_cells


def outlined(drawing, size=1.0, origin=(0.0, 0.0)):
    """Return the grid, the cells, their groups and polygons of a drawing (the last line is the southernmost row)."""
    mask = np.pad(np.array([[letter == "#" for letter in line] for line in drawing.split()])[::-1], 1)
    grid = Grid(origin, size, *mask.shape)
    cells = np.flatnonzero(mask)
    group = connected_cells(grid, cells)[1]
    return grid, cells, group, outline_cells(grid, cells, group)


def test_one_cell():
    *_, polygons = outlined("#", size=0.5, origin=(10.0, 20.0))
    ((ring,),) = polygons
    np.testing.assert_array_equal(ring, [[10, 20], [10.5, 20], [10.5, 20.5], [10, 20.5], [10, 20]])


def test_straight_sides_have_no_vertices_and_a_courtyard_is_a_hole():
    *_, polygons = outlined("#### #..# #..# ####")
    ((exterior, hole),) = polygons
    assert exterior.tolist() == [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]]
    assert sorted(map(tuple, hole[:-1].tolist())) == [(1, 1), (1, 3), (3, 1), (3, 3)]
    x, y = hole.T
    assert np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]) < 0, "clockwise"


def test_groups_are_polygons_of_their_own():
    _, _, group, polygons = outlined("#.## #.##")
    assert len(polygons) == 2
    assert [np.ptp(rings[0], axis=0).tolist() for rings in polygons] == [[1, 2], [2, 2]]
    assert group.tolist() == [0, 1, 1, 0, 1, 1]


def test_cells_that_touch_by_a_corner_are_joined_by_a_neck():
    *_, polygons = outlined(".# #.")
    ((ring,),) = polygons
    assert len(ring) == 11, "six corners, and two for each of the two that the cells share"
    assert {(0.9, 1.0), (1.0, 1.1), (1.1, 1.0), (1.0, 0.9)} <= {tuple(np.round(v, 9).tolist()) for v in ring}


def test_nothing_gives_nothing():
    grid = Grid((0.0, 0.0), 1.0, 3, 3)
    assert outline_cells(grid, np.zeros(0, np.int64), np.zeros(0, np.int64)) == []
