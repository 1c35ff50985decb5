"""Features of cells whose points lie on a plane, a line and in a ball, and of the columns that they are part of."""

import numpy as np
import pytest

from lidar_buildings.algorithms.buildings.cell_features import CellFeatures, CellPoints
from lidar_buildings.algorithms.buildings.space_cells import SpaceCells

# Columns of the features: the block, then the cell itself, then what follows.
BLOCK, OWN, AFTER = 0, 9, 18


def features_of(xyz, size, is_ground=None, returns=None, intensity=None):
    is_ground = np.zeros(len(xyz), bool) if is_ground is None else is_ground
    cells = SpaceCells(xyz, size)
    points = CellPoints(xyz, xyz[:, 2], is_ground, returns, intensity)
    every = np.arange(len(cells.count))
    return CellFeatures(points, cells, every, cells.around(every)).of(every), cells


def lattice(*axes):
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)


@pytest.mark.parametrize(
    ("axes", "linearity", "planarity", "scattering"),
    [
        ((np.arange(0, 6, 0.1), np.arange(0, 6, 0.1), [5.0]), 0.0, 1.0, 0.0),
        ((np.arange(0, 6, 0.01), [2.5], [5.0]), 1.0, 0.0, 0.0),
        ((np.arange(0, 6, 0.2), np.arange(0, 6, 0.2), np.arange(0, 6, 0.2)), 0.0, 0.0, 1.0),
    ],
)
def test_the_shape_of_a_plane_a_line_and_a_volume(axes, linearity, planarity, scattering):
    xyz = lattice(*axes) + 1e-4
    found, cells = features_of(xyz, 2.0)
    middle = np.argmin(np.abs(cells.centers - xyz.mean(axis=0)).sum(axis=1))
    for start in (BLOCK, OWN):
        np.testing.assert_allclose(found[middle, start : start + 3], [linearity, planarity, scattering], atol=0.02)


def test_the_column_holds_ground_top_and_bottom(rng):
    """Ground at 0, a roof at 6 and a wire at 9 m over one square."""
    plan = rng.uniform(0.1, 0.9, (90, 2))
    xyz = np.column_stack([plan, np.repeat([0.0, 6.0, 9.0], 30)])
    found, cells = features_of(xyz, 1.0, xyz[:, 2] == 0)
    roof = np.flatnonzero(np.isclose(cells.centers[:, 2], 6.0))[0]
    expected = [1 / 3, 9.0, 3.0, 6.0, np.std([0.0, 6.0, 9.0])]
    np.testing.assert_allclose(found[roof, -5:], expected, atol=1e-9)


def test_features_do_not_depend_on_the_order_of_points(rng):
    """Coordinates of full centimeters: many columns have several topmost points, which differ in height above ground.

    Cells of 0.7 m and columns of 2.1 m, both divided as floats, have edges on the same centimeters.
    """
    xyz = np.round(rng.uniform(0, [20, 20, 0.3], (20_000, 3)), 2)
    height = xyz[:, 2] + rng.uniform(0, 1, len(xyz))
    found = []
    for order in (np.arange(len(xyz)), rng.permutation(len(xyz))):
        cells = SpaceCells(xyz[order], 0.7)
        every = np.arange(len(cells.count))
        points = CellPoints(xyz[order], height[order], np.zeros(len(xyz), bool), None, None)
        found.append(CellFeatures(points, cells, every, cells.around(every)).of(every))
    np.testing.assert_allclose(found[0][:, -5:], found[1][:, -5:], atol=1e-9)


def test_returns_and_intensity_are_means_of_the_cell_and_the_cells_around():
    """Two cells side by side, of one and of three points."""
    xyz = np.array([[0.5, 0.5, 0.5], [1.2, 0.5, 0.5], [1.5, 0.5, 0.5], [1.8, 0.5, 0.5]])
    returns = np.array([1, 1, 2, 2], np.uint8), np.array([1, 2, 2, 3], np.uint8)
    intensity = np.array([10, 20, 30, 40], np.uint16)
    found, _ = features_of(xyz, 1.0, returns=returns, intensity=intensity)
    # After the shapes: two counts, elevation against the block, height.
    np.testing.assert_allclose(found[0, AFTER + 4 : AFTER + 8], [0, 1, 1, 0.5])
    np.testing.assert_allclose(found[1, AFTER + 4 : AFTER + 8], [2 / 3, 5 / 3, 7 / 3, 0.5])
    np.testing.assert_allclose(found[0, AFTER + 8 : AFTER + 11], [10, 25, np.std([10, 20, 30, 40])])
    np.testing.assert_allclose(found[1, AFTER + 8 : AFTER + 11], [30, 25, np.std([10, 20, 30, 40])])
