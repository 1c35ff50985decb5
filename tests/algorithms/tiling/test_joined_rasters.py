"""What chains make of a survey besides classes: rasters without seams, chosen points, attributes of footprints."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.pipeline import Pipeline, Step
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.algorithms.stage import Layer, LayerFeatures, Monitor
from lidar_buildings.algorithms.tiling.blocks import Block
from lidar_buildings.algorithms.tiling.joining import join_features, join_owned
from lidar_buildings.algorithms.tiling.run_in_tiles import run_in_tiles
from lidar_buildings.algorithms.tiling.tiled_run import TilesOptions
from lidar_buildings.algorithms.tiling.workers import Workers
from lidar_buildings.tests.villages import village

CORNER = np.array([600_010.0, 5_000_010.0, 0.0])
THINNED = Step("voxels", "downsample_voxels", {"voxel_size": 0.4})
# Between cells around a gap, which lie on squares, triangles can be drawn either way: gaps stay.
TERRAIN = Step("terrain", "rasterize_terrain", {"cell_size": 0.7, "gap_distance": 0.0})
RASTERS = Pipeline("rasters", "Rasters", "Tests", "", "", "", "", (THINNED, TERRAIN))


@pytest.fixture(autouse=True)
def _rasters(monkeypatch):
    monkeypatch.setitem(PIPELINES, RASTERS.name, RASTERS)


def cloud_of(xyz, corner=CORNER, **dimensions):
    return create_cloud({"xyz": xyz + corner, **dimensions}, "EPSG:28992")


@pytest.fixture
def ground(rng):
    """Points on a wavy terrain, all of them ground."""
    plan = rng.uniform(0, 60, (20_000, 2))
    z = np.sin(plan[:, 0] / 9) + 0.2 * plan[:, 1]
    return np.round(np.column_stack([plan, z]), 3)


def run(pipeline, paths, folder, monitor=None, **options):
    chosen = TilesOptions(**{"workers": Workers(processes=1), "block_side": 25.0, "compressed": False, **options})
    return run_in_tiles(pipeline, paths, folder, monitor, chosen)


def assembled(found):
    """Return what takes rasters and keeps them whole, by name, with their northwestern corner on the map."""

    def take(survey, mosaic):
        cells = np.full(mosaic.shape, np.nan, np.float32)
        for row, column, values in mosaic:
            there = cells[row : row + values.shape[0], column : column + values.shape[1]]
            assert np.isnan(there).all(), "every cell is in one block"
            there[:] = values
        found[mosaic.name] = cells, np.array([mosaic.west, mosaic.north]) + survey.origin[:2]

    return take


def test_rasters_of_blocks_are_those_of_the_whole_cloud(ground, tmp_path, monkeypatch):
    cloud = cloud_of(ground, classification=np.full(len(ground), 2, np.uint8))
    half = ground[:, 0] < 33
    paths = []
    for number, part in enumerate((half, ~half)):
        paths.append(tmp_path / f"{number}.las")
        write_cloud(cloud.take(np.flatnonzero(part)), paths[-1])
    monkeypatch.setattr(Pipeline, "reach", lambda self, tunables: 8.0)
    found = {}
    outcome = run(RASTERS, paths, tmp_path / "out", take_raster=assembled(found))
    assert not outcome.failures
    # From a file, coordinates are counted from the same origin as the survey's, and so are voxels and cells.
    write_cloud(cloud, tmp_path / "whole.las")
    cloud = read_cloud(tmp_path / "whole.las")
    whole = run_pipeline(RASTERS, cloud)
    for name, surface in whole.rasters.items():
        cells, corner = found[name]
        assert cells.shape == surface.values.shape
        np.testing.assert_allclose(corner, np.array([surface.west, surface.north]) + cloud.origin[:2], atol=1e-6)
        np.testing.assert_array_equal(np.isnan(cells), np.isnan(surface.values))
        np.testing.assert_allclose(cells, surface.values, atol=1e-4)
    # And the points that are left are the whole cloud's, each in the tile that it came from.
    tiles = [read_cloud(tile) for tile in outcome.tiles]
    left, expected = np.concatenate([one.to_map(one.get("xyz")) for one in tiles]), whole.cloud
    expected = expected.to_map(expected.get("xyz"))
    np.testing.assert_allclose(left[np.lexsort(left.T)], expected[np.lexsort(expected.T)], atol=1e-6)
    assert tiles[0].get("voxel_count").sum() + tiles[1].get("voxel_count").sum() == len(ground)


def test_what_belongs_to_a_footprint_stays_with_it_and_gets_its_new_number():
    def square(x, y):
        return [np.array([[x, y], [x + 4, y], [x + 4, y + 4], [x, y + 4], [x, y]], float)]

    blocks = [Block(0, 0, 10.0), Block(1, 0, 10.0)]
    footprints = [
        LayerFeatures([square(2, 2), square(7, 2)], {"id": [1, 2]}),
        # The first one again, which has its middle in the other block.
        LayerFeatures([square(7, 2), square(14, 6)], {"id": [5, 3]}),
    ]
    lines = [
        LayerFeatures([np.zeros((2, 2))] * 3, {"id": [1, 2, 3], "footprint": [2, 1, 2], "edge": [7, 8, 9]}),
        LayerFeatures([np.ones((2, 2))] * 2, {"id": [1, 2], "footprint": [3, 5], "edge": [1, 2]}),
    ]
    none = [np.zeros(0, np.int32)] * 2
    found, kept = join_features(blocks, footprints, none, np.zeros(3), Monitor(), Layer("f", "F", "Polygon", ()))
    assert [ring[0][0].tolist() for ring in found.geometries] == [[14, 6], [2, 2], [7, 2]]
    assert kept.tolist() == [[1, 3, 1], [0, 1, 2], [0, 2, 3]]
    edges = join_owned(lines, none, "footprint", kept)
    assert edges.columns == {"id": [1, 2, 3, 4], "footprint": [1, 2, 3, 3], "edge": [1, 8, 7, 9]}


@pytest.mark.slow
def test_footprints_of_walls_are_mapped_in_tiles_and_compared_with_the_old_map(tmp_path):
    # The edge between two blocks goes through the middle of the village.
    arrays, true, old_map = village(size=90.0, density=20.0, seed=4)
    corner = np.array([600_055.0, 5_000_005.0, 0.0])
    others = {name: values for name, values in arrays.items() if name != "xyz"}
    cloud = cloud_of(arrays["xyz"], corner, **others)
    write_cloud(cloud, tmp_path / "village.las")
    moved = LayerFeatures([[ring + corner[:2] for ring in rings] for rings in old_map.geometries], old_map.columns)

    def find_layers(survey):
        there = [[ring - survey.origin[:2] for ring in rings] for rings in moved.geometries]
        return {"old_map": LayerFeatures(there, moved.columns)}

    outcome = run(
        PIPELINES["map_footprints"],
        [tmp_path / "village.las"],
        tmp_path / "out",
        block_side=100.0,
        find_layers=find_layers,
    )
    assert not outcome.failures
    footprints, edges = outcome.layers["wall_footprints"], outcome.layers["wall_edges"]
    assert outcome.blocks == 2
    assert len(footprints) == len(true) > 2
    assert set(footprints.columns["source"]) == {"wall"}
    assert set(edges.columns["footprint"]) == set(footprints.columns["id"])
    counts = np.bincount(edges.columns["footprint"], minlength=len(footprints) + 1)[1:]
    assert counts.tolist() == list(footprints.columns["edges"])
    (report,) = outcome.reports.values()
    assert [report.values[name] for name in ("mean_dx", "mean_dy")] == pytest.approx([-0.3, -0.3], abs=0.1)
    walls = read_cloud(outcome.tiles[0])
    assert set(np.unique(walls.get("wall_of"))) - {0} <= set(footprints.columns["cluster_id"])
