"""Models of Delft's houses on their base map: valid, near the points, and hardly any below level 2.2."""

from __future__ import annotations

import numpy as np
import pytest
from osgeo import ogr
from scipy.spatial import cKDTree

from lidar_buildings.algorithms.cloud.files import read_cloud
from lidar_buildings.algorithms.models3d.reconstruct_roofs import reconstruct_roofs
from lidar_buildings.algorithms.stage import LayerFeatures, MapFrame
from lidar_buildings.tests.real.clouds import DATA, DELFT, path_of, truth
from lidar_buildings.tests.solid_validity import assert_valid_cityjson

MAP = DATA / "footprints" / "delft-bgt.gpkg"

# One of this number of polygons of the map is modelled.
_STEP = 4


@pytest.fixture(scope="module")
def models():
    """What is made of the points with their true classes."""
    cloud = read_cloud(path_of(DELFT))
    polygons = []
    source = ogr.Open(str(MAP))
    for feature in source.GetLayer(0):
        geometry = feature.GetGeometryRef()
        for part in [geometry] if geometry.GetGeometryName() == "POLYGON" else geometry:
            polygons.append([np.array(ring.GetPoints())[:, :2] - cloud.origin[:2] for ring in part])
    features = LayerFeatures(polygons[::_STEP], {"id": list(range(len(polygons[::_STEP])))})
    made = reconstruct_roofs(cloud.get("xyz"), truth(DELFT), features, terrain_tolerance=0.2)
    return reconstruct_roofs.stage.unpack(made)


def test_solids_are_valid(models):
    text = "".join(models.files["cityjson"].pieces("CityJSON", MapFrame(np.asarray)))
    kinds = [one["type"] for one in assert_valid_cityjson(text)["CityObjects"].values()]
    assert kinds.count("Building") >= 30
    assert kinds.count("TINRelief") >= 10


def test_walls_end_on_the_terrain(models):
    """Its triangles and the grounds of solids have corners in common, but on common walls of two buildings."""
    ends = np.concatenate([rings[0] for rings in models.layers["terrain"].geometries])
    solids = [solid for one in models.files["cityjson"].items if not one.is_terrain for solid in one.model.best]
    assert all(solid.kinds.count("ground") > 1 for solid in solids)
    corners = [
        solid.vertices[[v for rings, kind in zip(solid.faces, solid.kinds) if kind == "ground" for v in rings[0]]]
        for solid in solids
    ]
    corners = np.concatenate(corners)
    apart, nearest = cKDTree(ends[:, :2]).query(corners[:, :2])
    is_node = apart < 0.001
    assert is_node.mean() > 0.85
    np.testing.assert_allclose(corners[is_node, 2], ends[nearest[is_node], 2], atol=0.001)


def test_roofs_are_near_their_points_and_at_the_level_wanted(models):
    facts = models.layers["buildings"].columns
    assert np.mean(np.array(facts["level"]) == "2.2") >= 0.95
    # Of all roof points: chimneys, plants on terraces and the points of neighbors count.
    assert np.median(facts["rms"]) <= 0.33
    assert np.median(facts["off"]) <= 0.065
