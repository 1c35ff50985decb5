"""The command: what it reads and writes, and that it says in a sentence what it can't do."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.command import command_line
from lidar_buildings.algorithms.command.command_arguments import dashed, find_algorithm, parser_of
from lidar_buildings.algorithms.command.command_line import main, overview
from lidar_buildings.algorithms.command.feature_files import read_layer
from lidar_buildings.algorithms.geometry.rings import signed_area
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.algorithms.stage import InputLayer, Monitor
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.tests.algorithms.cloud.crs_texts import ETRS_32
from lidar_buildings.tests.web_server import serving

EAST, NORTH = 500_000.0, 5_600_000.0


@pytest.fixture
def tile(tmp_path):
    """A grid of 20 by 20 points, each in the middle of a square meter, on a plane that rises by 0.1 to the east."""
    x, y = (axis.ravel() + 0.5 for axis in np.meshgrid(np.arange(20), np.arange(20)))
    xyz = np.column_stack([EAST + x, NORTH + y, 0.1 * x])
    path = tmp_path / "tile.laz"
    write_cloud(create_cloud({"xyz": xyz, "classification": np.full(400, 2)}, ETRS_32), path)
    return path


def square(west, south, side):
    ring = [[west, south], [west, south + side], [west + side, south + side], [west + side, south], [west, south]]
    return [[[EAST + x, NORTH + y] for x, y in ring]]


def features(path, *geometries, code="EPSG:25832"):
    of_map = [{"type": "Feature", "properties": {"id": i}, "geometry": one} for i, one in enumerate(geometries)]
    crs = {"type": "name", "properties": {"name": f"urn:ogc:def:crs:{code.replace(':', '::')}"}}
    path.write_text(json.dumps({"type": "FeatureCollection", "crs": crs, "features": of_map}))
    return path


@pytest.mark.parametrize("name", [*PIPELINES, *STAGES])
def test_help_of_each_algorithm_tells_all_that_it_declares(name):
    algorithm = find_algorithm(dashed(name))
    text = parser_of(algorithm).format_help()
    names = (*algorithm.parameters, *algorithm.input_layers, *(output.name for output in algorithm.outputs))
    assert not [one for one in names if f"--{dashed(one)} " not in text]
    assert ("CLOUD" in text.split("\n")[0]) == algorithm.reads_cloud
    assert dashed(name) in overview()


@pytest.mark.parametrize("kind", ["Polygon", "MultiPolygon"])
def test_points_within_polygons_of_a_file(tile, tmp_path, kind):
    first, second = square(2, 3, 5), square(10, 10, 4)
    shapes = [{"type": "Polygon", "coordinates": one} for one in (first, second)]
    if kind == "MultiPolygon":
        shapes = [{"type": kind, "coordinates": [first, second]}]
    areas, out = features(tmp_path / "areas.geojson", *shapes), tmp_path / "kept.laz"
    assert main(["clip-cloud", str(tile), "--polygons", str(areas), "--output", str(out)]) == 0
    xyz = read_cloud(out).to_map(read_cloud(out).get("xyz")) - [EAST, NORTH, 0]
    assert len(xyz) == 5 * 5 + 4 * 4
    is_in = [
        (xyz[:, :2] > low).all(axis=1) & (xyz[:, :2] < high).all(axis=1) for low, high in (((2, 3), (7, 8)), (10, 14))
    ]
    assert np.logical_or(*is_in).all()


def test_layers_are_read_as_stages_want_them(tmp_path):
    """Exteriors counterclockwise, holes clockwise, each part by itself, upright polygons as they are."""
    clockwise, hole = square(0, 0, 9)[0], square(2, 2, 3)[0][::-1]
    shapes = [{"type": "Polygon", "coordinates": [clockwise, hole]}, {"type": "Point", "coordinates": [1, 2, 3]}]
    shapes.append({"type": "MultiLineString", "coordinates": [[[0, 0], [1, 1]], [[2, 2], [3, 3]]]})
    path, monitor = features(tmp_path / "all.geojson", *shapes), Monitor()
    wanted = InputLayer("areas", "Areas", "Some.")
    read, code = read_layer(path, wanted, monitor)
    assert [signed_area(ring) for ring in read.geometries[0]] == [81.0, -9.0]
    assert (code, read.columns["id"].tolist(), len(monitor.warnings)) == ("EPSG:25832", [0], 1)
    upright = read_layer(path, replace(wanted, upright=True), monitor)[0]
    assert [signed_area(ring) for ring in upright.geometries[0]] == [-81.0, 9.0]
    lines = read_layer(path, replace(wanted, geometry="LineString"), monitor)[0]
    assert [line.tolist() for line in lines.geometries] == [[[0, 0], [1, 1]], [[2, 2], [3, 3]]]
    assert read_layer(path, replace(wanted, geometry="Point"), monitor)[0].geometries[0].tolist() == [1, 2, 3]


def test_points_within_an_extent(tile, tmp_path):
    out, extent = tmp_path / "part.las", f"{EAST},{NORTH},{EAST + 3},{NORTH + 2}"
    assert main(["downsample-voxels", str(tile), "--extent", extent, "--output", str(out)]) == 0
    assert len(read_cloud(out)) == 3 * 2


def test_a_cloud_on_the_web(tile, tmp_path):
    out = tmp_path / "copy.las"
    with serving(tmp_path) as server:
        assert main(["classify-ground-tin", server.address(tile.name), "--output", str(out)]) == 0
    assert np.array_equal(read_cloud(out).get("xyz"), read_cloud(tile).get("xyz"))


def test_a_raster_is_a_grid_at_its_place(tile, tmp_path):
    out = tmp_path / "dtm.asc"
    assert main(["rasterize-terrain", str(tile), "--cell-size", "1", "--dtm", str(out)]) == 0
    head = dict(line.split() for line in out.read_text().splitlines()[:6])
    grid = np.loadtxt(out, skiprows=6)
    grid[grid == float(head["NODATA_value"])] = np.nan
    assert grid.shape == (int(head["nrows"]), int(head["ncols"]))
    east = float(head["xllcorner"]) + (np.arange(grid.shape[1]) + 0.5) * float(head["cellsize"]) - EAST
    assert float(head["yllcorner"]) == pytest.approx(NORTH, abs=1)
    assert np.isfinite(grid).sum() >= 300
    assert np.nanmax(np.abs(grid - 0.1 * east)) < 0.011  # points are stored to a millimeter, heights to 6 digits


def test_the_same_as_the_chain_in_memory(tmp_path, capsys):
    cloud, footprints, page = tmp_path / "v.laz", tmp_path / "f.geojson", tmp_path / "r.html"
    made = tmp_path / "c.laz"
    small = ["--size", "100", "--density", "4", "--seed", "3", "--buildings", "20"]
    simulate = ["simulate-town", *small, "--output", str(cloud)]
    assert main(simulate) == 0
    asked = ["--output", str(made), "--footprints", str(footprints), "--report", str(page)]
    assert main(["detect", str(cloud), "--min-area", "8", *asked]) == 0
    results = run_pipeline(PIPELINES["detect_buildings"], read_cloud(cloud), min_area=8.0)
    assert np.array_equal(read_cloud(made).get("classification"), results.cloud.get("classification"))
    layer, written = results.layers["footprints"], json.loads(footprints.read_text())["features"]
    assert len(written) == len(layer) >= 3
    for row, feature in enumerate(written):
        rings = [results.cloud.to_map(ring) for ring in layer.geometries[row]]
        assert all(np.array_equal(one, ring) for one, ring in zip(feature["geometry"]["coordinates"], rings))
        assert feature["properties"]["area"] == pytest.approx(layer.columns["area"][row])
    assert f"buildings: {len(layer)}" in capsys.readouterr().out
    assert "<html" in page.read_text(encoding="utf-8")
    # The layer of one run is the input of the next.
    again = ["report-buildings", str(made), "--footprints", str(footprints), "--report", str(tmp_path / "again.html")]
    assert main(again) == 0
    assert f"buildings: {len(layer)}" in capsys.readouterr().out


def test_layers_alone_keep_their_coordinates(tmp_path):
    crooked = [[[0, 0], [10, 0.05], [10.03, 8], [0, 8.02], [0, 0]]]
    ring = [[EAST + x, NORTH + y] for x, y in crooked[0]]
    given, out = tmp_path / "in.geojson", tmp_path / "out.geojson"
    features(given, {"type": "Polygon", "coordinates": [ring]})
    assert main(["regularize-polygons", "--polygons", str(given), "--regularized", str(out)]) == 0
    made = json.loads(out.read_text())
    assert made["crs"]["properties"]["name"] == "urn:ogc:def:crs:EPSG::25832"
    made_ring = np.array(made["features"][0]["geometry"]["coordinates"][0])
    assert np.abs(made_ring.max(axis=0) - [EAST + 10, NORTH + 8]).max() < 0.1
    assert np.abs(made_ring.min(axis=0) - [EAST, NORTH]).max() < 0.1


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["nonsense"], "There is no algorithm 'nonsense'"),
        (["classify-ground-tin", "TILE"], "Nothing is asked for; give at least one of --output."),
        (["classify-ground-tin", "no.laz", "--output", "a.laz"], "no.laz"),
        (["classify-ground-tin", "TILE", "--output", "TILE"], "is also an input"),
        (["classify-ground-tin", "TILE", "--output", "no/a.laz"], "does not exist"),
        (["classify-ground-tin", "TILE", "--output", "a.txt"], "give it the extension .las, .laz or .copc.laz"),
        (["rasterize-terrain", "TILE", "--dtm", "a.tif"], "give it the extension .asc"),
        (["clip-cloud", "TILE", "--polygons", "LINES", "--output", "a.laz"], "has no polygons"),
        (
            ["clip-cloud", "TILE", "--polygons", "OTHER", "--output", "a.laz"],
            "is in EPSG:28992 and the rest in EPSG:25832",
        ),
        (["clip-cloud", "TILE", "--polygons", "BROKEN", "--output", "a.laz"], "can't be read as vector features"),
        (["clip-cloud", "TILE", "--extent", "0,0,1,1", "--output", "a.laz"], "no points within the extent"),
    ],
)
def test_refusals_are_one_sentence_and_nothing_is_written(tile, tmp_path, monkeypatch, capsys, words, sentence):
    monkeypatch.chdir(tmp_path)
    files = {"TILE": tile, "BROKEN": tmp_path / "broken.geojson"}
    files["LINES"] = features(tmp_path / "lines.geojson", {"type": "LineString", "coordinates": [[0, 0], [1, 1]]})
    polygon = {"type": "Polygon", "coordinates": square(0, 0, 5)}
    files["OTHER"] = features(tmp_path / "other.geojson", polygon, code="EPSG:28992")
    files["BROKEN"].write_text('{"features": [{"geometry": ')
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    assert main([str(files.get(word, word)) for word in words]) == 1
    said = [line for line in capsys.readouterr().err.splitlines() if not line.startswith("Warning: ")]
    assert sentence in said[-1]
    assert len(said) == 1
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_a_value_out_of_bounds_is_refused_by_name(tile, capsys):
    with pytest.raises(SystemExit) as ended:
        main(["classify-ground-tin", str(tile), "--cell-size", "-4", "--output", "a.laz"])
    assert ended.value.code == 2
    assert "--cell-size" in capsys.readouterr().err


def test_a_run_that_is_stopped_leaves_the_older_file(tile, tmp_path, monkeypatch, capsys):
    def stop(_, path, *__):
        path.write_bytes(b"half")
        raise KeyboardInterrupt

    out = tmp_path / "out.laz"
    out.write_bytes(b"older")
    monkeypatch.setattr(command_line, "write_cloud", stop)
    assert main(["classify-ground-tin", str(tile), "--output", str(out)]) == 130
    assert out.read_bytes() == b"older"
    assert "Cancelled; nothing was written." in capsys.readouterr().err


def test_a_missing_package_is_named(tile, monkeypatch, capsys):
    monkeypatch.setattr(command_line, "absent", lambda needed: [name for name in ("scikit-learn",) if name in needed])
    assert main(["detect-buildings-2019", str(tile), "--output", "a.laz"]) == 1
    assert "needs scikit-learn; run 'pip install scikit-learn'" in capsys.readouterr().err
