"""Faces have the colors of the points on them, where viewers look them up in the image of the file."""

import numpy as np
import pytest

from lidar_buildings.algorithms.export.export_models import export_models, glb_pieces
from lidar_buildings.algorithms.export.exported_models import atlas_of
from lidar_buildings.algorithms.report.page import png
from lidar_buildings.algorithms.stage import LayerFeatures, MapFrame
from lidar_buildings.tests.colored_models import BLUE, RED, ROOF, decoded, exported, points
from lidar_buildings.tests.glb_reader import Glb


def looked_up(models):
    """Return of positions on the triangles of each material: where they are, and the color that the image has there."""
    glb = Glb(b"".join(glb_pieces(models, "GLB", MapFrame(np.asarray))))
    image = decoded(glb.view(glb.root["images"][0]["bufferView"]))
    weights = np.random.default_rng(1).dirichlet([1, 1, 1], 400)
    found = {}
    for one in glb.root["meshes"][0]["primitives"]:
        triangles = glb.accessor(one["indices"]).reshape(-1, 3).astype(int)
        corners, places = (glb.accessor(one["attributes"][name])[triangles] for name in ("POSITION", "TEXCOORD_0"))
        assert places.min() >= 0
        assert places.max() <= 1
        at, where = (np.einsum("wc,tcd->twd", weights, some).reshape(-1, some.shape[2]) for some in (corners, places))
        column, row = (where * image.shape[1::-1]).astype(int).T
        material = glb.root["materials"][one["material"]]
        assert material["pbrMetallicRoughness"]["baseColorTexture"] == {"index": 0}
        found[material["name"]] = at, image[row, column]
    return found


@pytest.mark.parametrize("depth", [1, 256])
def test_roofs_have_the_colors_of_their_points(depth):
    xyz, colors = points()
    found = looked_up(exported(xyz, colors * depth))
    at, color = found["roof"]
    for name, is_there in ((RED, at[:, 0] < 3.7), (BLUE, at[:, 0] > 4.3)):
        np.testing.assert_allclose(color[is_there], np.broadcast_to(name, (is_there.sum(), 3)), atol=1)
    # No point is on the wall: it keeps the color of walls.
    assert (found["wall"][1] == (226, 216, 196)).all()


def test_texels_without_points_have_the_nearest_color():
    xyz, colors = points()
    seen = (abs(xyz[:, 0] - 4) > 1) & (xyz[:, 1] < 5)
    at, color = looked_up(exported(xyz[seen], colors[seen]))["roof"]
    assert set(map(tuple, color.tolist())) <= {RED, BLUE}
    assert (color[at[:, 0] < 3.7] == RED).all()


def test_without_points_near_or_without_colors_there_are_no_images():
    xyz, colors = points()
    (model,) = exported(xyz + [0, 0, 5], colors)
    assert all(face.texture is None for face in model.best)
    with pytest.raises(ValueError, match="has no colors"):
        export_models(xyz, roofs=LayerFeatures([[ROOF]], {"building": ["1"]}))


def test_images_lie_side_by_side_with_a_rim_of_their_own():
    rng = np.random.default_rng(2)
    images = [rng.integers(1, 255, (*size, 3)).astype(np.uint8) for size in rng.integers(1, 40, (60, 2))]
    atlas = atlas_of(images)
    taken = np.zeros(atlas.image.shape[:2], int)
    for one, (column, row) in zip(images, atlas.starts):
        rows, columns = one.shape[:2]
        np.testing.assert_array_equal(atlas.image[row : row + rows, column : column + columns], one)
        np.testing.assert_array_equal(atlas.image[row - 1, column : column + columns], one[0])
        taken[row - 1 : row + rows + 1, column - 1 : column + columns + 1] += 1
    assert taken.max() == 1
    assert taken.mean() > 0.6
    np.testing.assert_array_equal(decoded(png(atlas.image)), atlas.image)


def test_images_too_large_for_browsers_are_refused():
    with pytest.raises(ValueError, match="make texels larger"):
        atlas_of([np.zeros((1, 9000, 3), np.uint8)])
