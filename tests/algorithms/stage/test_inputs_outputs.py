"""Contents of layers: the attributes that come from another layer, and the size of buildings."""

import numpy as np
import pytest

from lidar_buildings.algorithms.stage import Field, InputLayer, LayerFeatures, given_layers


def test_kept_attributes_have_names_of_their_own():
    """Parts of one geometry have the same fid, which a GeoPackage would refuse twice."""
    columns = {"fid": np.array([4, 4, 5]), "Height": np.array([1.5, np.nan, 2.0]), "key": ["a", None, "c"]}
    features = LayerFeatures([0, 1, 2], columns)
    kept = features.kept([0, 1], [Field("height", float, "height")])
    assert kept == {"map_fid": [4, 4], "map_Height": [1.5, None], "key": ["a", None]}
    assert type(kept["map_fid"][0]) is int


def boxes(*widths):
    """Return a layer of boxes 10 m high, of these widths (m)."""
    return LayerFeatures([[np.array([[0, 0], [w, 0], [w, 10], [0, 10], [0, 0]], float)] for w in widths], {})


def test_a_layer_of_buildings_has_none_that_is_wider_than_any():
    """The longest building there is has 3.1 km; a district or a damaged coordinate would fill the memory."""
    areas, houses = InputLayer("areas"), InputLayer("houses", buildings=True)
    for features in (boxes(12, 3100, 7), boxes(), None):
        given = {"houses": features, "areas": boxes(85_000)}
        assert given_layers("toy", (areas, InputLayer("houses", optional=True, buildings=True)), given) == given
    with pytest.raises(ValueError, match=r"^Houses: a polygon is 85\.0 km wide, and no building is wider than 4 km; "):
        given_layers("toy", (houses.described(""),), {"houses": boxes(12, 85_000, 7)})
    tall = LayerFeatures([[ring[:, ::-1].tolist()] for (ring,) in boxes(7, 5_000).geometries], {})
    with pytest.raises(ValueError, match=r"a polygon is 5\.0 km wide"):
        given_layers("toy", (houses.described(""),), {"houses": tall})
