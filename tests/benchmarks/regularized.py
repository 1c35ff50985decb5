"""*Regularize footprints* compared with QGIS's *Orthogonalize*, on Delft's base map traced from noisy rasters.

Prints a row for each size of the cells (m) and each method::

    scripts/offscreen.sh .venv/bin/python tests/benchmarks/regularized.py [0.3 0.5]
"""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

import numpy as np
from scipy import ndimage

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
importlib.import_module("conftest")

from qgis.core import QgsGeometry, QgsPointXY, QgsVectorLayer  # noqa: E402

from lidar_buildings.algorithms.footprints.regularize_polygons import regularize_polygons  # noqa: E402
from lidar_buildings.algorithms.geometry.cell_outlines import outline_cells  # noqa: E402
from lidar_buildings.algorithms.geometry.grid import Grid  # noqa: E402
from lidar_buildings.algorithms.models3d.roof_partition import inside_rings  # noqa: E402
from lidar_buildings.algorithms.quality.polygon_comparison import polis  # noqa: E402
from lidar_buildings.algorithms.stage import LayerFeatures, Monitor  # noqa: E402
from lidar_buildings.tests.real.clouds import DATA  # noqa: E402

# Displacement of cells (cells, root mean square) that neighbors share, over how many, and that of each by itself.
SHARED, OVER, OWN = 0.6, 2.0, 0.3


def rings_of(geometry):
    return [np.array([(point.x(), point.y()) for point in ring]) for ring in geometry.asPolygon()]


def polygon(rings):
    return QgsGeometry.fromPolygonXY([[QgsPointXY(*place) for place in ring.tolist()] for ring in rings])


def base_map():
    layer = QgsVectorLayer(str(DATA / "footprints" / "delft-bgt.gpkg"), "map", "ogr")
    parts = [part for feature in layer.getFeatures() for part in feature.geometry().asGeometryCollection()]
    return [rings_of(part.forcePolygonCounterClockwise()) for part in parts]


def traced(polygons, cell, seed):
    """Return the outlines of the largest parts of polygons on displaced cells."""
    places = np.concatenate([ring for rings in polygons for ring in rings])
    low, shape = places.min(axis=0) - 2, np.ceil((np.ptp(places, axis=0)[::-1] + 4) / cell).astype(int)
    random = np.random.default_rng(seed)
    noise = [ndimage.gaussian_filter(random.normal(size=shape), OVER) for _ in range(2)]
    shift = np.stack([SHARED * one / one.std() + random.normal(0, OWN, shape) for one in noise], axis=-1)
    middles = (low + (np.moveaxis(np.indices(shape)[::-1], 0, -1) - 0.5 + shift) * cell).reshape(-1, 2)
    made = []
    for rings in polygons:
        near = ((middles > rings[0].min(axis=0)) & (middles < rings[0].max(axis=0))).all(axis=1)
        near[near] = inside_rings(middles[near], rings)
        part = ndimage.label(near.reshape(shape))[0]
        largest = part == 1 + np.bincount(part.ravel())[1:].argmax()
        cells = np.flatnonzero(ndimage.binary_fill_holes(largest) if len(rings) == 1 else largest)
        made.append(outline_cells(Grid(low, cell, *shape), cells, np.zeros(len(cells), int))[0])
    return made


def orthogonalized(polygons, tolerance):
    return [rings_of(polygon(rings).simplify(tolerance).orthogonalize()) or rings for rings in polygons]


def regularized(polygons):
    return regularize_polygons(LayerFeatures(polygons, {}), monitor=Monitor()).geometries


def iou(one, other):
    both = polygon(one).intersection(polygon(other)).area()
    return both / (polygon(one).area() + polygon(other).area() - both)


def main(cells):
    true = base_map()
    for cell in cells:
        given = [traced(true, cell, seed) for seed in (0, 1)]
        methods = {"as traced": given, "Regularize footprints": [regularized(one) for one in given]}
        for cells_off in (1, 2):
            methods[f"simplified by {cells_off}, Orthogonalize"] = [
                orthogonalized(one, cells_off * cell) for one in given
            ]
        for name, (first, second) in methods.items():
            areas = [(polygon(a).area(), polygon(b).area()) for a, b in zip(first, given[0])]
            print(
                f"{cell} m, {name}: IoU {np.mean(list(map(iou, first, true))):.3f}, "
                f"PoLiS {np.mean(list(map(polis, first, true))):.3f} m, "
                f"corners {sum(len(ring) - 1 for rings in first for ring in rings):,}, "
                f"two seeds {np.mean(list(map(iou, first, second))):.3f}, "
                f"areas off {np.mean([abs(a / b - 1) > 0.01 for a, b in areas]):.0%}"
            )


if __name__ == "__main__":
    main([float(cell) for cell in sys.argv[1:]] or [0.3, 0.5])
