"""Tilesets are read back: each vertex on the globe where an independent formula has it, in boxes that hold it."""

import json
from dataclasses import replace

import numpy as np
import pytest

from lidar_buildings.algorithms.export.export_models import export_models
from lidar_buildings.algorithms.export.tileset import ellipsoid_positions, tileset_pieces
from lidar_buildings.algorithms.stage import LayerFeatures, MapFrame
from lidar_buildings.tests.glb_reader import Glb

RISE = 43.0


def to_degrees(coordinates):
    """A map in plan near Delft whose axes lean against east and north, and whose meters are none of the ground."""
    x, y = np.asarray(coordinates).T
    return np.column_stack([4.36 + 1.5e-5 * x + 2e-7 * y, 52.0 + 9e-6 * y - 1e-7 * x])


FRAME = MapFrame(np.asarray, "EPSG:28992", to_degrees, "town")


def house(x, y, height):
    """Return the faces of a house of 8 m by 6 m at levels 1.2 (a box) and 2.2 (with a ridge 2 m above its eaves)."""
    corners = np.array([[0, 0], [8, 0], [8, 6], [0, 6]]) + (x, y)
    low, high = (np.column_stack([corners, np.full(4, z)]) for z in (0.0, height))
    ridge = np.array([[x, y + 3, height + 2], [x + 8, y + 3, height + 2]])
    walls = [np.stack([low[i], low[(i + 1) % 4], high[(i + 1) % 4], high[i]]) for i in range(4)]
    box = [(low[::-1], "ground"), (high, "roof"), *((wall, "wall") for wall in walls)]
    slopes = [np.stack([high[0], high[1], ridge[1], ridge[0]]), np.stack([high[2], high[3], ridge[0], ridge[1]])]
    ends = [
        np.stack([low[1], low[2], high[2], ridge[1], high[1]]),
        np.stack([low[3], low[0], high[0], ridge[0], high[3]]),
    ]
    gable = [(low[::-1], "ground"), *((one, "roof") for one in slopes), (walls[0], "wall"), (walls[2], "wall")]
    gable += [(end, "wall") for end in ends]
    return [
        (np.vstack([ring, ring[:1]]), kind, lod)
        for lod, faces in (("1.2", box), ("2.2", gable))
        for ring, kind in faces
    ]


def town(count):
    """Return as many houses in a square, in rows."""
    rows = [(f"h{i}", *face) for i in range(count) for face in house(20 * (i % 20), 15 * (i // 20), 4.0 + i % 5)]
    columns = {name: [row[i] for row in rows] for i, name in ((0, "building"), (2, "kind"), (3, "lod"))}
    return export_models(cityjson=LayerFeatures([[row[1]] for row in rows], columns), geoid_height=RISE)[-1]


def written(models, frame=FRAME):
    """Return the files of a tileset by name, and its JSON."""
    *files, text = tileset_pieces(models, "3D Tiles", frame)
    return {name: Glb(raw) for name, raw in files}, json.loads(text)


def all_tiles(tile):
    yield tile
    for child in tile.get("children", ()):
        yield from all_tiles(child)


def prime_vertical(degrees, height):
    """Return positions by the radius of curvature in the prime vertical, as textbooks have it."""
    flattening = 1 / 298.257223563
    eccentricity = flattening * (2 - flattening)
    longitude, latitude = np.radians(degrees).T
    radius = 6_378_137.0 / np.sqrt(1 - eccentricity * np.sin(latitude) ** 2)
    across = (radius + height) * np.cos(latitude)
    z = (radius * (1 - eccentricity) + height) * np.sin(latitude)
    return np.column_stack([across * np.cos(longitude), across * np.sin(longitude), z])


def test_positions_on_the_ellipsoid_are_those_of_the_textbook():
    degrees = np.array([[0.0, 0.0], [4.36, 52.0], [-73.9, 40.7], [151.2, -33.9], [10.0, 90.0]])
    height = np.array([0.0, 43.0, -32.0, 9000.0, 1.0])
    np.testing.assert_allclose(ellipsoid_positions(degrees, height), prime_vertical(degrees, height), atol=1e-5, rtol=0)


def test_vertices_are_on_the_globe_where_the_map_has_them():
    files, whole = written(town(3))
    matrix = np.array(whole["root"]["transform"]).reshape(4, 4).T
    np.testing.assert_allclose(matrix[:3, :3] @ matrix[:3, :3].T, np.eye(3), atol=1e-12)
    assert np.linalg.det(matrix[:3, :3]) == pytest.approx(1)
    positions = files["town-2.2.glb"].triangles()[0].reshape(-1, 3)
    on_globe = positions @ matrix[:3, :3].T + matrix[:3, 3]
    local = np.concatenate([ring[:-1] for i in range(3) for ring, _, lod in house(20 * i, 0, 4.0 + i) if lod == "2.2"])
    true = prime_vertical(to_degrees(local[:, :2]), local[:, 2] + RISE)
    off = np.linalg.norm(on_globe[:, None] - true[None], axis=2)
    assert off.min(axis=1).max() < 1e-4
    assert off.min(axis=0).max() < 1e-4


def test_the_tree_has_every_building_once_at_each_level_and_boxes_hold_it():
    files, whole = written(town(330))
    tiles = list(all_tiles(whole["root"]))
    used = [tile["content"]["uri"] for tile in tiles if "content" in tile]
    assert sorted(used) == sorted(files)
    for level in ("1.2", "2.2"):
        names = [name for file in used if level in file for name in files[file].table(0)["name"]]
        assert sorted(names) == sorted(f"h{i}" for i in range(330))
    assert (
        max(files[file].root["extensions"]["EXT_structural_metadata"]["propertyTables"][0]["count"] for file in used)
        <= 100
    )
    for tile in tiles:
        middle, axes = (
            np.array(tile["boundingVolume"]["box"][:3]),
            np.array(tile["boundingVolume"]["box"][3:]).reshape(3, 3),
        )
        for below in all_tiles(tile):
            assert below["geometricError"] <= tile["geometricError"]
            if "content" in below:
                positions = files[below["content"]["uri"]].triangles()[0].reshape(-1, 3)
                assert (abs(positions - middle) <= np.diag(axes)).all()
    coarse = [tile for tile in tiles if "content" in tile and "1.2" in tile["content"]["uri"]]
    assert [tile["geometricError"] for tile in coarse] == [2.0] * len(coarse), "ridges are 2 m above the boxes"
    assert all("2.2" in tile["children"][0]["content"]["uri"] for tile in coarse)
    assert [tile["geometricError"] for tile in tiles if not tile.get("children")] == [0.0] * len(coarse)


def test_a_building_without_a_level_has_the_next_simpler_one():
    models = town(2)
    levels = models[1].levels
    levels["1.3"] = levels.pop("2.2")
    files, _ = written(models)
    counts = {
        level: [(files[f"town-{level}.glb"].triangles()[2] == number).sum() for number in (0, 1)]
        for level in ("1.2", "2.2")
    }
    assert counts == {"1.2": [12, 12], "2.2": [16, 16]}


def test_levels_that_look_the_same_are_one_file():
    models = town(2)
    for model in models:
        model.levels["1.3"] = model.levels["1.2"]
    assert list(written(models)[0]) == ["town-2.2.glb", "town-1.3.glb"]


def test_names_of_files_are_addresses_and_lead_nowhere_else():
    ring = np.array([[0, 0, 3.0], [4, 0, 3], [4, 5, 3], [0, 0, 3]])
    features = LayerFeatures([[ring]], {"building": ["a"], "lod": ["../../2"]})
    models = export_models(roofs=features)[-1]
    files, whole = written(models, replace(FRAME, file="town #1"))
    assert list(files) == ["town #1-tile.glb"]
    assert whole["root"]["content"]["uri"] == "town%20%231-tile.glb"


def test_models_without_a_system_have_no_place_on_the_globe():
    with pytest.raises(ValueError, match="no coordinate reference system"):
        written(town(1), MapFrame(np.asarray))
