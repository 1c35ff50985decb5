"""Footprints of Delft with its points and its base map, in QGIS's geometries."""

from __future__ import annotations

import functools

import numpy as np
from qgis.core import QgsGeometry, QgsPointXY, QgsVectorLayer

from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.cloud.files import read_cloud
from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.tests.real.clouds import DATA, DELFT, detected, path_of, truth
from lidar_buildings.tests.shared_results import made_once

MAP = DATA / "footprints" / "delft-bgt.gpkg"

# Side of the cells in which footprints and true points are compared (m).
_CELL = 0.5

# Vertices of the map at which a wall turns by less (radians) are no corners.
_CORNER = np.deg2rad(20)

# Steps of the map as small as the distance between two points (m) can't be seen in these.
_STEP = 0.3

# Seams between the houses of a block up to this width (m) are closed.
_SEAM = 0.05


def polygon(rings):
    return QgsGeometry.fromPolygonXY([[QgsPointXY(x, y) for x, y in ring.tolist()] for ring in rings])


@functools.cache
def footprints(kind, in_blocks=False):
    """Return the footprints, and the cloud, of the true or the found buildings, in blocks or house by house."""
    if kind == "chain":
        cloud = detected(DELFT).cloud
    else:
        cloud = read_cloud(path_of(DELFT))
        cloud.set("classification", truth(DELFT))

    def extracted():
        return run_stage(STAGES["extract_footprints"], cloud, merge_touching=in_blocks).layers["footprints"]

    return made_once(f"footprints {kind} {in_blocks}", extracted), cloud


@functools.cache
def base_map():
    """Return the buildings of the map one by one, and the blocks that they make, without steps too small to be seen."""
    layer = QgsVectorLayer(str(MAP), "map", "ogr")
    houses = [QgsGeometry(part) for f in layer.getFeatures() for part in _parts(f.geometry())]
    union = QgsGeometry.unaryUnion([house.buffer(_SEAM, 3) for house in houses]).buffer(-_SEAM, 3)
    return tuple([building.simplify(_STEP) for building in buildings] for buildings in (houses, _parts(union)))


def _parts(geometry):
    whole = QgsGeometry(geometry)
    whole.convertToMultiType()
    return [QgsGeometry(part.clone()) for part in whole.constParts()]


def corners_of(geometry):
    """Return the places (n, 2) where the walls of a polygon turn."""
    found = []
    for ring in geometry.asPolygon():
        places = np.array([(point.x(), point.y()) for point in ring[:-1]])
        before, after = places - np.roll(places, 1, axis=0), np.roll(places, -1, axis=0) - places
        turn = np.arctan2(after[:, 1], after[:, 0]) - np.arctan2(before[:, 1], before[:, 0])
        found.append(places[np.abs(np.angle(np.exp(1j * turn))) > _CORNER])
    return np.concatenate(found)


def corner_distances(found, reference, least=0.5):
    """Return how far (m) each corner of the reference is from the nearest of the polygon that is the same building.

    ``found`` and ``reference`` are lists of QgsGeometry; two are the same building where their intersection is at
    least half of their union. Buildings that only one of the lists has, and their corners, don't count.
    """
    distances, matched = [], 0
    for building in reference:
        shares = [0.0 if not building.boundingBoxIntersects(other) else _iou(building, other) for other in found]
        best = int(np.argmax(shares))
        if shares[best] >= least:
            matched += 1
            apart = corners_of(building)[:, None] - corners_of(found[best])
            distances.append(np.hypot(*apart.transpose(2, 0, 1)).min(axis=1))
    return matched, np.concatenate(distances)


def _iou(one, other):
    both = one.intersection(other).area()
    return both / (one.area() + other.area() - both)


def cell_iou(kind):
    """Return the intersection over union of the footprints and the cells that are building in truth."""
    found, cloud = footprints(kind)
    xyz = cloud.get("xyz")
    low = xyz[:, :2].min(axis=0)
    index = np.floor((xyz[:, :2] - low) / _CELL).astype(int)
    order = np.argsort(xyz[:, 2], kind="stable")
    is_true = np.zeros(index.max(axis=0) + 1, bool)
    is_true[tuple(index[order].T)] = (truth(DELFT) == PointClass.BUILDING)[order]
    is_found = np.zeros_like(is_true)
    for rings in found.geometries:
        is_found ^= _covered([(ring - low) / _CELL - 0.5 for ring in rings], is_true.shape)
    return (is_true & is_found).sum() / (is_true | is_found).sum()


def _covered(rings, shape):
    """Return the cells whose middle a polygon holds, by the parity of its walls; rings in cells."""
    odd = np.zeros(shape, bool)
    for ring in rings:
        for (x0, y0), (x1, y1) in zip(ring, ring[1:]):
            rows = np.arange(*np.clip(np.ceil(np.sort([y0, y1])), 0, shape[1]).astype(int))
            at = np.ceil(x0 + (rows - y0) * (x1 - x0) / (y1 - y0 or 1)).clip(0, shape[0]).astype(int)
            for row, column in zip(rows.tolist(), at.tolist()):
                odd[:column, row] ^= True
    return odd


def map_distances(kind, level):
    """Return how many buildings of the map are found, and how far their corners are; 0 is houses, 1 blocks."""
    found, cloud = footprints(kind, in_blocks=True)
    made = [polygon([cloud.to_map(ring) for ring in rings]) for rings in found.geometries]
    return corner_distances(made, base_map()[level])
