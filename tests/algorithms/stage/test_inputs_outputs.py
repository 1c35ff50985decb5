"""Contents of layers: the attributes that come from another layer."""

import numpy as np

from lidar_buildings.algorithms.stage import Field, LayerFeatures


def test_kept_attributes_have_names_of_their_own():
    """Parts of one geometry have the same fid, which a GeoPackage would refuse twice."""
    columns = {"fid": np.array([4, 4, 5]), "Height": np.array([1.5, np.nan, 2.0]), "key": ["a", None, "c"]}
    features = LayerFeatures([0, 1, 2], columns)
    kept = features.kept([0, 1], [Field("height", float, "height")])
    assert kept == {"map_fid": [4, 4], "map_Height": [1.5, None], "key": ["a", None]}
    assert type(kept["map_fid"][0]) is int
