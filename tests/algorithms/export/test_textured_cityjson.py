"""CityJSON with images: readers find the colors of points on faces, and the faces that the models have."""

import json

import numpy as np
import pytest

from lidar_buildings.algorithms.export.cityjson_faces import read_cityjson
from lidar_buildings.algorithms.export.export_models import export_models
from lidar_buildings.algorithms.export.textured_cityjson import cityjson_pieces
from lidar_buildings.algorithms.geometry.polygons import area_vector
from lidar_buildings.algorithms.stage import LayerFeatures, MapFrame
from lidar_buildings.tests.colored_models import BLUE, RED, ROOF, WALL, decoded, points

FRAME = MapFrame(lambda local: local + [85_000.25, 446_000.5, 0.0], "EPSG:7415", file="town")


def written(models):
    """Return the JSON of models, and the files next to it."""
    pieces = list(cityjson_pieces(models, "CityJSON", FRAME))
    files = {piece[0]: piece[1] for piece in pieces if isinstance(piece, tuple)}
    return json.loads("".join(piece for piece in pieces if isinstance(piece, str))), files


def test_faces_have_the_colors_of_their_points_in_the_image():
    """Of two roofs one is red in the west, the other one in the east; no point shows the wall."""
    xyz, colors = points()
    both, of_both = np.concatenate([xyz, xyz + [20, 0, 0]]), np.concatenate([colors, colors[:, ::-1]])
    roofs = LayerFeatures([[ROOF], [ROOF + [20, 0, 0]]], {"building": ["1", "1"]})
    walls = LayerFeatures([[WALL]], {"building": ["1"]})
    whole, files = written(export_models(both, *of_both.T, roofs=roofs, walls=walls)[4])
    look = whole["appearance"]
    assert look["textures"] == [{"type": "PNG", "image": "town.png"}]
    image, places = decoded(files["town.png"]), np.array(look["vertices-texture"])
    positions = np.array(whole["vertices"]) * whole["transform"]["scale"] + whole["transform"]["translate"]
    (geometry,) = whole["CityObjects"]["1"]["geometry"]
    weights = np.random.default_rng(1).dirichlet([1, 1, 1], 400)
    kinds = [geometry["semantics"]["surfaces"][value]["type"] for value in geometry["semantics"]["values"]]
    assert sorted(kinds) == ["RoofSurface", "RoofSurface", "WallSurface"]
    for kind, rings, looks in zip(kinds, geometry["boundaries"], geometry["texture"]["colors"]["values"]):
        if kind == "WallSurface":
            assert looks == [[None]]
            continue
        (ring,), ((number, *of_ring),) = rings, looks
        assert number == 0
        at, where = weights @ positions[ring[:3]] - [85_000.25, 446_000.5, 0], weights @ places[of_ring[:3]]
        column, row = (np.column_stack([where[:, 0], 1 - where[:, 1]]) * image.shape[1::-1]).astype(int).T
        west, east = (RED, BLUE) if at[:, 0].max() < 15 else (RED[::-1], BLUE[::-1])
        for side, expected in ((at[:, 0] % 20 < 3.5, west), (at[:, 0] % 20 > 4.5, east)):
            assert side.any()
            assert np.abs(image[row, column].astype(int)[side] - expected).max() <= 1


def test_faces_and_attributes_are_read_back_as_they_were():
    ring = np.array([[0, 0, 3.0], [4, 0, 3], [4, 5, 3], [0, 5, 3], [0, 0, 3]])
    hole = np.array([[1, 1, 3.0], [1, 2, 3], [2, 2, 3], [2, 1, 3], [1, 1, 3]])
    roofs = LayerFeatures(
        [[ring, hole], [ring + [9, 0, 0]]], {"building": ["town hall", "town hall"], "slope": [0.5, 7.0]}
    )
    whole, files = written(export_models(roofs=roofs)[4])
    assert not files
    assert "appearance" not in whole
    read, crs = read_cityjson(json.dumps(whole))
    assert crs == "EPSG:7415"
    areas = [sum(area_vector(one)[2] for one in rings) for rings in read.geometries]
    assert read.columns["building"] == ["town hall", "town hall"]
    assert areas == pytest.approx([19.0, 20.0])
    assert read.columns["slope"] == [0.5, 7.0]
