"""Areas and outlines of polygons: GEOS, by way of OGR, is the second opinion."""

from __future__ import annotations

import numpy as np
import pytest
from osgeo import gdal, ogr

from lidar_buildings.algorithms.geometry.cell_outlines import outline_cells
from lidar_buildings.algorithms.geometry.grid import Grid, connected_cells
from lidar_buildings.algorithms.geometry.polygon_overlap import as_polygons, overlaps
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.builders import FAR, star

gdal.UseExceptions()


def polygon(rings):
    """Return closed rings as a polygon of OGR."""
    text = ",".join("(" + ",".join(f"{x!r} {y!r}" for x, y in ring.tolist()) + ")" for ring in rings)
    return ogr.CreateGeometryFromWkt(f"POLYGON ({text})")


def test_shared_areas_of_any_polygons(rng):
    polygons = []
    while len(polygons) < 80:
        center = FAR[:2] + rng.uniform(0, 40, 2)
        rings = star(rng, center)
        angle = np.sort(np.arctan2(*(rings[0][:-1] - center).T))
        # With the center inside, the outline is simple and its copy a hole in it.
        if np.diff(angle, append=angle[0] + 2 * np.pi).max() < 3:
            polygons.append(rings)
    first, second = polygons[:40], polygons[40:]
    expected = np.array([[polygon(a).Intersection(polygon(b)).Area() for b in second] for a in first])
    assert np.count_nonzero(expected) > 50
    found = np.zeros_like(expected)
    one, other, area = overlaps(as_polygons(first), as_polygons(second), Monitor())
    found[one, other] = area
    np.testing.assert_allclose(found, expected, atol=1e-6)
    np.testing.assert_allclose(as_polygons(first).area, [polygon(rings).Area() for rings in first], atol=1e-6)


@pytest.mark.parametrize("share", [0.2, 0.5, 0.8])
def test_outlines_of_any_pattern_are_valid_and_hold_its_cells_only(rng, share):
    for _ in range(8):
        mask = np.pad(rng.random(rng.integers(1, 20, 2)) < share, 1)
        grid, cells = Grid((7.0, -3.0), 0.5, *mask.shape), np.flatnonzero(mask)
        group = connected_cells(grid, cells)[1]
        centers = [(x, y) for x, y in grid.center(np.arange(grid.rows * grid.columns)).tolist()]
        for number, rings in enumerate(outline_cells(grid, cells, group)):
            outline = polygon(rings)
            assert outline.IsValid()
            inside = [outline.Contains(ogr.CreateGeometryFromWkt(f"POINT ({x} {y})")) for x, y in centers]
            assert np.flatnonzero(inside).tolist() == cells[group == number].tolist()
