"""Sums over cells in space and those around them, against sums over the points themselves."""

import numpy as np

from lidar_buildings.algorithms.buildings.space_cells import SpaceCells, covariances
from lidar_buildings.algorithms.neighborhoods.covariance import full_matrices


def test_sums_are_those_of_the_points_of_the_cell_and_of_the_26_around(rng):
    xyz = rng.uniform(0, 4, (300, 3)) + [1000.0, 2000.0, 50.0]
    cells = SpaceCells(xyz, 1.0)
    values = rng.normal(size=len(xyz))
    block = cells.around(np.arange(len(cells.count))) @ cells.moments
    index = np.floor(xyz)
    for row in range(0, len(cells.count), 7):
        own = (index == cells.voxels[row]).all(axis=1)
        near = (np.abs(index - cells.voxels[row]) <= 1).all(axis=1)
        assert cells.count[row] == own.sum()
        np.testing.assert_allclose(cells.sums(values)[row], values[own].sum())
        np.testing.assert_allclose(cells.centers[row], xyz[own].mean(axis=0))
        for moments, inside in ((cells.moments[row], own), (block[row], near)):
            assert moments[0] == inside.sum()
            covariance = full_matrices(covariances(moments[None]))[0]
            np.testing.assert_allclose(covariance, np.cov(xyz[inside].T, bias=True), atol=1e-9)


def test_a_part_of_the_points_has_the_same_cells(rng):
    xyz = rng.uniform(0, 20, (2000, 3))
    whole = SpaceCells(xyz, 2.5)
    inside = xyz[:, 0] < 10.0
    part = SpaceCells(xyz[inside], 2.5)
    np.testing.assert_array_equal(part.voxels[part.cell], whole.voxels[whole.cell[inside]])
