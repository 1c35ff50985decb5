"""OBJ files hold together: materials, image, and faces that look their colors up in it."""

import re

import numpy as np

from lidar_buildings.algorithms.export.export_models import export_models, obj_pieces
from lidar_buildings.algorithms.geometry.polygons import area_vector
from lidar_buildings.algorithms.stage import LayerFeatures, MapFrame
from lidar_buildings.tests.colored_models import BLUE, RED, decoded, exported, points


class Obj:
    """An OBJ file as other programs read it: corners and places in the image of each face, by object and material."""

    def __init__(self, models, frame):
        pieces = list(obj_pieces(models, "OBJ", frame))
        self.files = {piece[0]: piece[1] for piece in pieces if isinstance(piece, tuple)}
        self.text = "".join(piece for piece in pieces if isinstance(piece, str))
        corners, places, self.faces, self.objects = [], [], [], []
        for word, *rest in map(str.split, self.text.splitlines()):
            if word == "v":
                corners.append(list(map(float, rest)))
            elif word == "vt":
                places.append(list(map(float, rest)))
            elif word == "o":
                self.objects.append(rest[0])
            elif word == "usemtl":
                material = rest[0]
            elif word == "mtllib":
                (self.library,) = rest
            elif word == "f":
                found = [[int(number) - 1 for number in one.split("/")] for one in rest]
                self.faces.append(
                    (
                        self.objects[-1],
                        material,
                        np.array([corners[one[0]] for one in found]),
                        np.array([places[one[1]] for one in found if len(one) > 1]),
                    )
                )
        lines = self.files[self.library].decode()
        self.materials = {
            name: (color, image)
            for name, color, image in re.findall(r"newmtl (\w+)\nKd (.+)\nillum 1\n(?:map_Kd (\S+)\n)?", lines)
        }


def frame(**more):
    return MapFrame(lambda local: local + [85_000.25, 446_000.5, 0.0][: local.shape[1]], **more)


def test_faces_have_the_colors_of_their_points_in_the_image():
    obj = Obj(exported(*points()), frame(file="my models"))
    assert set(obj.files) == {"my_models.mtl", "my_models.png"}
    assert obj.materials["roof"] == ("1 1 1", "my_models.png")
    image = decoded(obj.files["my_models.png"])
    weights = np.random.default_rng(1).dirichlet([1, 1, 1], 400)
    roofs = [(corners, places) for _, material, corners, places in obj.faces if material == "roof"]
    at, where = (np.concatenate([weights @ one for one in each]) for each in zip(*roofs))
    assert at[:, 0].min() < 3
    assert at[:, 0].max() > 5
    # Rows of images count from below.
    column, row = (np.column_stack([where[:, 0], 1 - where[:, 1]]) * image.shape[1::-1]).astype(int).T
    colors = image[row, column].astype(int)
    for side, expected in ((at[:, 0] < 3.5, RED), (at[:, 0] > 4.5, BLUE)):
        assert np.abs(colors[side] - expected).max() <= 1


def test_without_colors_materials_have_the_colors_of_their_kinds():
    ring = np.array([[0, 0, 3.0], [4, 0, 3], [4, 5, 3], [0, 5, 3], [0, 0, 3]])
    hole = np.array([[1, 1, 3.0], [1, 2, 3], [2, 2, 3], [2, 1, 3], [1, 1, 3]])
    models = export_models(roofs=LayerFeatures([[ring, hole], [ring + [9, 0, 0]]], {"building": ["town hall", "2"]}))[3]
    obj = Obj(models, frame(crs="EPSG:28992"))
    assert set(obj.files) == {"models.mtl"}
    assert obj.materials["roof"] == ("0.6980 0.2824 0.2118", "")
    assert obj.objects == ["town_hall", "2"]
    # Each object names its material, as some programs read objects one by one.
    assert obj.text.count("usemtl roof") == 2
    assert obj.text.splitlines()[:2] == [
        "# LiDAR Buildings, EPSG:28992, meters from the offset",
        "# offset 85000.250 446000.500 0",
    ]
    areas = {name: 0.0 for name in obj.objects}
    for name, _, corners, _ in obj.faces:
        areas[name] += np.linalg.norm(area_vector(corners))
    # OBJ has no holes: what is around one is triangles.
    np.testing.assert_allclose(list(areas.values()), [19.0, 20.0])
