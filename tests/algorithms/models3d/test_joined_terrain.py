"""Terrain and walls meet: each lower edge of a wall is an edge of the terrain, or of a neighbor's wall."""

import numpy as np
import pytest

from lidar_buildings.algorithms.export.cityjson_faces import read_cityjson
from lidar_buildings.algorithms.export.export_models import export_models
from lidar_buildings.algorithms.geometry.rings import nearest_edge_distances
from lidar_buildings.algorithms.models3d.building_facts import NamedModel
from lidar_buildings.algorithms.models3d.building_models import BuildingModel
from lidar_buildings.algorithms.models3d.cityjson import CITYJSON, CITYJSON_SEQ, cityjson_pieces
from lidar_buildings.algorithms.models3d.joined_terrain import Terrain, on_terrain
from lidar_buildings.algorithms.models3d.reconstruct_roofs import reconstruct_roofs
from lidar_buildings.algorithms.models3d.solids import Solid
from lidar_buildings.algorithms.models3d.wavefront import obj_pieces
from lidar_buildings.algorithms.stage import LayerFeatures, MapFrame
from lidar_buildings.tests.hill_towns import edges_of_terrain, hill, lower_edges, open_edges, town
from lidar_buildings.tests.solid_validity import assert_valid_cityjson, assert_valid_sequence, assert_valid_solid

TOLERANCE = 0.15


@pytest.fixture(scope="module")
def scene():
    return town()


@pytest.fixture(scope="module")
def made(scene):
    xyz, classes, footprints = scene
    return reconstruct_roofs(xyz, classes, footprints, terrain_tolerance=TOLERANCE)


def test_walls_end_on_edges_of_the_terrain(made):
    *_, terrain, items, _ = made
    lower, gaps = open_edges(items, terrain)
    assert len(lower) > 18 * 4 * 3
    assert gaps == []
    # Without a terrain they end at the lowest ground, level.
    z = np.array(lower)[:, :, 2] / 1e4
    assert np.ptp(z, axis=1).max() > 0.5
    xy = np.array(lower)[:, 0, :2].T / 1e4
    assert z[:, 0] == pytest.approx(hill(*xy), abs=0.15)


def test_terrain_is_within_the_tolerance_and_not_below_buildings(scene, made):
    xyz, classes, _ = scene
    corners = np.array([ring[:3] for (ring,) in made[3].geometries])
    middle = corners.mean(axis=1)
    # Along the end of the points, triangles are narrow and seen by none.
    middle = middle[(np.abs(middle[:, :2] - 33) < 32).all(axis=1)]
    assert len(middle) > 350
    assert middle[:, 2] == pytest.approx(hill(*middle[:, :2].T), abs=TOLERANCE + 0.05)
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2] / 2
    assert across.min() > 0, "a triangle looks down"
    # The square less 18 houses of 56 and 36 m².
    assert across.sum() == pytest.approx(66**2 - 9 * (56 + 36), rel=0.01)
    assert len(corners) < (classes == 2).sum() / 20


def test_ground_points_at_walls_are_no_nodes():
    """Flower beds a few centimeters before a wall would be steps in the terrain there."""
    xyz, classes, footprints = town(2)
    start, end = (np.concatenate([ring[some] for (ring,) in footprints.geometries]) for some in (slice(4), slice(1, 5)))
    at_wall = np.flatnonzero((classes == 2) & (nearest_edge_distances(xyz[:, :2], start, end) < 0.25))
    xyz[at_wall[::3], 2] += 0.5
    _, _, _, terrain, *_ = reconstruct_roofs(xyz, classes, footprints, terrain_tolerance=TOLERANCE)
    nodes = np.unique(np.concatenate([ring for (ring,) in terrain.geometries])[:, :2], axis=0)
    off = nearest_edge_distances(nodes, start, end)
    assert ((off < 0.005) | (off > 0.3)).all()
    assert (off > 0.3).sum() > 50


def test_sides_of_patches_have_no_cracks(made):
    """Each edge inside is there in both directions, or the edge of a house; up to 2 m from the end the sides end."""
    edges = edges_of_terrain(made[3])
    lower = {edge for one in made[4] if not one.is_terrain for solid in one.model.best for edge in lower_edges(solid)}
    alone = np.array([edge for edge in edges if edge[::-1] not in edges and edge[::-1] not in lower])[:, :, :2] / 1e4
    assert (np.abs(alone - 33) > 31).any(axis=(1, 2)).all()
    names = set(made[3].columns["patch"])
    assert len(names) == 4


def test_solids_and_files_are_valid(made):
    *_, cityjson, _ = made
    frame = MapFrame(np.asarray, "EPSG:25832")
    whole = assert_valid_cityjson("".join(cityjson_pieces(cityjson, CITYJSON, frame)))
    kinds = [one["type"] for one in whole["CityObjects"].values()]
    assert (kinds.count("Building"), kinds.count("TINRelief")) == (18, 4)
    assert_valid_sequence("".join(cityjson_pieces(cityjson, CITYJSON_SEQ, frame)))
    assert "".join(obj_pieces(cityjson, "OBJ", frame)).count("g terrain") == 4


def test_roofs_and_attributes_are_those_of_level_ground(scene, made):
    buildings, walls, roofs, none, *_ = reconstruct_roofs(*scene)
    assert len(none) == 0
    for one, other in zip(roofs.geometries, made[2].geometries):
        np.testing.assert_array_equal(one[0], other[0])
    for name in ("level", "ground", "eave_height", "ridge_height", "rms", "check"):
        assert buildings.columns[name] == made[0].columns[name]
    assert np.less(made[0].columns["volume"], buildings.columns["volume"]).mean() > 0.9


def test_exports_show_the_terrain(made):
    buildings, walls, roofs, terrain, cityjson, _ = made
    features, _ = read_cityjson("".join(cityjson_pieces(cityjson, CITYJSON, MapFrame(np.asarray))))
    layers = {"buildings": buildings, "walls": walls, "roofs": roofs, "terrain": terrain}
    for models in (export_models(**layers)[0], export_models(cityjson=features)[0]):
        patches = [one for one in models if one.best[0].kind == "terrain"]
        assert [one.name for one in patches] == [f"terrain {column} {row}" for column in (0, 1) for row in (0, 1)]
        assert sum(len(one.best) for one in patches) == len(terrain)
        assert len(models) == 22


def test_where_terrain_lies_above_an_eave_the_ground_is_level_and_low(scene):
    """A house in a hill: walls can't end above their own roof, so they go down to the lowest terrain."""
    xyz, classes, footprints = scene
    xyz = xyz.copy()
    xyz[classes == 2, 2] += 2.5 * np.maximum(xyz[classes == 2, 0] - 55, 0)
    items = reconstruct_roofs(xyz, classes, footprints, terrain_tolerance=TOLERANCE)[4]
    nodes = np.concatenate([one.model.best[0].vertices for one in items if one.is_terrain])
    solids = [solid for one in items if not one.is_terrain for solid in one.model.best]
    level = [solid for solid in solids if solid.kinds.count("ground") == 1]
    assert 0 < len(level) < 9
    for solid in level:
        (base,) = solid.faces[solid.kinds.index("ground")]
        apart = np.linalg.norm(nodes[:, None, :2] - solid.vertices[base, :2], axis=2).min(axis=1)
        assert solid.vertices[base, 2].max() <= nodes[apart < 1e-3, 2].min()
    assert_valid_cityjson("".join(cityjson_pieces(items, CITYJSON, MapFrame(np.asarray))))


def test_a_node_of_a_neighbor_almost_in_line_does_not_turn_a_wall():
    """It is 1.5 mm before the wall, 4 mm from its corner: the triangle up from there would turn by 20°."""
    corners = np.array([[x, y, z] for z in (0, 3) for y in (0, 4) for x in (0, 4)], float)
    sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]]
    box = Solid(corners, [[ring] for ring in sides], ["ground", "roof", *["wall"] * 4], [-1, 0, *[-1] * 4])
    one = NamedModel("1", [corners[[0, 1, 3, 2, 0]]], BuildingModel(0.0, "2.2", solids={"2.2": [box]}))
    nodes = np.concatenate([corners[:4], [[0.004, -0.0015, -0.0005]]])
    (made,) = on_terrain([one], Terrain(nodes, {}))
    assert made.model.best[0].kinds.count("ground") == 2
    assert_valid_solid(made.model.best[0].vertices, made.model.best[0].faces)


def test_common_walls_a_millimeter_apart_stay_valid(scene):
    """Maps have the wall of two houses twice, not quite at one place."""
    xyz, classes, footprints = scene
    rng = np.random.default_rng(1)
    moved = [
        [ring[:, :2] + np.append(off := rng.normal(0, 0.001, (4, 2)), off[:1], axis=0)]
        for (ring,) in footprints.geometries
    ]
    items = reconstruct_roofs(xyz, classes, LayerFeatures(moved, footprints.columns), terrain_tolerance=TOLERANCE)[4]
    assert_valid_cityjson("".join(cityjson_pieces(items, CITYJSON, MapFrame(np.asarray))))
    assert all(solid.kinds.count("ground") > 1 for one in items[:18] for solid in one.model.best)


@pytest.mark.parametrize("beyond", [-3.0, 0.0, 1.0])
def test_walls_at_the_end_of_the_cloud_have_heights(beyond):
    """A wall on the side of a patch, where no ground was seen, ended in nodes without a height."""
    rng = np.random.default_rng(0)
    ground = rng.uniform((0, 0), (50 + beyond, 40), (4000, 2))
    ground = ground[(np.abs(ground - [45, 14]) > [5, 4]).any(axis=1)]
    roof = rng.uniform((40, 10), (50, 18), (1200, 2))
    xyz = np.concatenate(
        [
            np.column_stack([ground, hill(*ground.T)]),
            np.column_stack([roof, 18 + np.minimum(roof[:, 1] - 10, 18 - roof[:, 1])]),
        ]
    )
    ring = np.array([[40, 10], [50, 10], [50, 18], [40, 18], [40, 10]], float)
    classes = np.repeat([2, 6], [len(ground), len(roof)])
    layers = reconstruct_roofs(xyz, classes, LayerFeatures([[ring]], {"id": [1]}), terrain_tolerance=TOLERANCE)
    items, terrain = layers[4], layers[3]
    house = items[0].model.best[0]
    assert np.isfinite(house.vertices).all()
    assert_valid_solid(house.vertices, house.faces)
    edges = edges_of_terrain(terrain)
    open_ = [edge for edge in lower_edges(house) if edge not in edges and edge[::-1] not in edges]
    # Beyond the last ground there is no terrain: the wall that looks there may stand free.
    assert all(x == 50 * 10**4 for edge in open_ for x, _, _ in edge)
    assert bool(open_) == (beyond <= 0)
