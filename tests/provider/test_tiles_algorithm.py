"""Surveys in tiles through Processing: inputs, outputs and errors."""

import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.cloud.vpc import write_vpc
from lidar_buildings.algorithms.tiling.survey import files_of_survey
from lidar_buildings.provider import schedulers
from lidar_buildings.provider.given import Given
from lidar_buildings.provider.options import SCHEDULERS
from lidar_buildings.provider.pipeline_algorithm import pipeline_tunables
from lidar_buildings.tests.builders import roof
from lidar_buildings.tests.las_files import made_las
from lidar_buildings.tests.provider.helpers import opened, squares, values_of


def refused():
    from qgis.core import QgsProcessingException

    return QgsProcessingException


QUICKLY = {"PROCESSES": 1, "BLOCK_SIDE": 60.0}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Two tiles with a house on their edge."""
    rng = np.random.default_rng(7)
    folder = tmp_path_factory.mktemp("survey")
    plan = rng.uniform(0, 50, (50 * 50 * 4, 2))
    under = ((plan > [19, 20]) & (plan < [31, 30])).all(axis=1)
    ground = np.column_stack([plan, rng.normal(0, 0.02, len(plan))])[~under]
    xyz = np.concatenate([ground, roof(rng, 19, 20, 12, 10, 5.0, density=4.0)]) + [85_000, 447_000, 0]
    for name, part in (("west", xyz[:, 0] < 85_025), ("east", xyz[:, 0] >= 85_025)):
        write_cloud(create_cloud({"xyz": xyz[part]}, "EPSG:28992"), folder / f"{name}.laz")
    return folder


@pytest.fixture
def algorithm(provider):
    return provider.algorithm("detectbuildingsintiles")


def test_a_folder_becomes_tiles_a_virtual_point_cloud_and_one_layer(algorithm, context, log, folder, tmp_path):
    from qgis.core import QgsVectorLayer

    target = tmp_path / "footprints.gpkg"
    given = {"INPUT": str(folder), "OUTPUT": str(tmp_path / "tiles"), "FOOTPRINTS": str(target), **QUICKLY}
    results, succeeded = algorithm.run(given, context, log)
    assert succeeded, log.textLog()
    assert (results["TILES"], results["FAILURES"]) == (2, 0)
    assert results["POINTS"] == sum(len(read_cloud(path)) for path in folder.glob("*.laz"))
    layer = QgsVectorLayer(str(target))
    assert layer.crs().authid() == "EPSG:28992"
    (house,) = layer.getFeatures()
    assert house["area"] == pytest.approx(120, rel=0.1)
    center = house.geometry().centroid().asPoint()
    assert (center.x(), center.y()) == (pytest.approx(85_025, abs=0.5), pytest.approx(447_025, abs=0.5))
    whole = read_cloud(results["VPC"])
    assert len(whole) == results["POINTS"]
    assert (whole.get("classification") == 6).sum() > 400


def test_what_is_not_set_is_what_the_steps_have(provider, context):
    """Steps have values of their own where the stages have others: bridges at gaps, planes from 1.5 m on."""
    for name, parameter, value in (
        ("detectbuildingsintiles", "bridges_search", "gaps in the ground"),
        ("mapfootprintsintiles", "planes_min_height", 1.5),
    ):
        algorithm = provider.algorithm(name).create()
        for empty in ({}, {parameter.upper(): None}):
            given = pipeline_tunables(Given(algorithm, empty, context), algorithm.tiled.pipeline)
            assert given[parameter] == value
        pipeline = algorithm.tiled.pipeline
        assert pipeline.by_step(pipeline_tunables(Given(algorithm, {}, context), pipeline)) == [
            (step, {name: step.stage.check(of_step)[name] for name in step.stage.tunables})
            for step, of_step in pipeline.by_step({})
        ]


def test_the_virtual_point_cloud_lies_where_it_is_on_earth(algorithm, context, log, folder, tmp_path):
    given = {"INPUT": [str(folder / "west.laz")], "OUTPUT": str(tmp_path / "tiles"), **QUICKLY}
    results, succeeded = algorithm.run(given, context, log)
    assert succeeded, log.textLog()
    (tile,) = json.loads(Path(results["VPC"]).read_text(encoding="utf-8"))["features"]
    # Delft.
    np.testing.assert_allclose(np.array(tile["bbox"])[[0, 1, 3, 4]], [4.37, 52.0, 4.37, 52.0], atol=0.03)
    assert tile["assets"]["data"]["href"] == "./west.laz"
    assert tile["properties"]["pc:count"] == results["POINTS"]


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"INPUT": "nowhere"}, "must be a point cloud file or layer; nothing was found at nowhere"),
        ({"CERTIFICATES": "one.pem"}, "must be three files"),
        ({"CERTIFICATES": "a.pem;b.pem;c.pem"}, "There is no certificate a.pem"),
        ({"BLOCK_SIDE": 1.0}, "BLOCK_SIDE"),
        ({"FOOTPRINTS": "footprints.nonsense"}, "give it the extension .gpkg"),
    ],
)
def test_what_is_wrong_is_said_before_anything_runs(algorithm, context, folder, tmp_path, given, sentence):
    whole = {"INPUT": str(folder), "OUTPUT": str(tmp_path / "tiles"), **QUICKLY, **given}
    accepted, why = algorithm.checkParameterValues(whole, context)
    assert not accepted
    assert sentence in why
    assert not (tmp_path / "tiles").exists()


def test_a_scheduler_that_is_not_there_is_a_sentence(algorithm, context, log, folder, tmp_path, monkeypatch):
    from lidar_buildings.algorithms.tiling import workers

    pytest.importorskip("distributed")
    monkeypatch.setattr(workers, "ANSWER", 1)
    monkeypatch.setattr(schedulers, "confirmed", lambda: ["tcp://127.0.0.1:9"])
    given = {"INPUT": str(folder), "OUTPUT": str(tmp_path / "tiles"), "SCHEDULER": "tcp://127.0.0.1:9", **QUICKLY}
    with pytest.raises(refused(), match="No Dask scheduler answers at tcp://127.0.0.1:9"):
        algorithm.run(given, context, log, {}, False)


@pytest.fixture
def settings():
    """QGIS's settings, as they were before afterwards."""
    from qgis.core import QgsSettings

    before = QgsSettings().value(SCHEDULERS.key)
    yield QgsSettings()
    if before is None:
        QgsSettings().remove(SCHEDULERS.key)
    else:
        QgsSettings().setValue(SCHEDULERS.key, before)


@pytest.fixture
def connected(monkeypatch):
    """Addresses that something wanted to connect to."""
    from lidar_buildings.algorithms.tiling import workers

    asked = []

    def connect(self):
        asked.append(self.scheduler)
        raise ValueError("No Dask scheduler answers.")

    monkeypatch.setattr(workers.Workers, "_cluster", connect)
    return asked


def test_a_scheduler_that_nobody_confirmed_is_refused_before_anything_runs(
    algorithm, context, log, folder, tmp_path, settings, connected
):
    """The address was taken from a model of somebody else, whose scheduler then ran its code."""
    settings.remove(SCHEDULERS.key)
    given = {"INPUT": str(folder), "OUTPUT": str(tmp_path / "tiles"), "SCHEDULER": "tcp://elsewhere:1", **QUICKLY}
    accepted, why = algorithm.checkParameterValues(given, context)
    assert not accepted
    assert "'tcp://elsewhere:1' (SCHEDULER) was not confirmed" in why
    assert "Settings ▸ Options ▸ Processing ▸ Providers ▸ LiDAR Buildings" in why
    _, succeeded = algorithm.run(given, context, log, {}, False)
    assert not succeeded
    assert [one for one in log.errors if "was not confirmed" in one]
    assert connected == []
    assert not (tmp_path / "tiles").exists()


def test_a_scheduler_in_a_model_is_refused(provider, context, log, folder, tmp_path, settings, connected):
    from qgis.core import (
        QgsProcessingModelAlgorithm,
        QgsProcessingModelChildAlgorithm,
        QgsProcessingModelChildParameterSource,
    )

    settings.remove(SCHEDULERS.key)
    model = QgsProcessingModelAlgorithm("nice", "models", "")
    child = QgsProcessingModelChildAlgorithm("lidarbuildings:modelterrainintiles")
    given = {"INPUT": str(folder), "OUTPUT": str(tmp_path / "tiles"), "SCHEDULER": "tcp://elsewhere:1", **QUICKLY}
    for name, value in given.items():
        child.addParameterSources(name, [QgsProcessingModelChildParameterSource.fromStaticValue(value)])
    model.addChildAlgorithm(child)
    with pytest.raises(refused()):
        model.run({}, context, log, {}, False)
    assert [one for one in log.errors if "'tcp://elsewhere:1' (SCHEDULER) was not confirmed" in one]
    assert connected == []


@pytest.mark.parametrize(
    "address",
    [
        "tcp://localhost:8786<b></b><!-- tcp://evil:8786 -->",
        "tcp://localhost:8786 tcp://evil:8786",
        "tcp://localhost:8786@evil:8786",
        "tcp://localhost\u202e:8786",
    ],
)
def test_an_address_that_could_look_like_another_is_refused(settings, monkeypatch, address):
    asked = []
    monkeypatch.setattr(schedulers, "_has_windows", lambda: True)
    monkeypatch.setattr(schedulers, "_is_wanted", lambda address: asked.append(address) or True)
    with pytest.raises(ValueError, match=r"must be an address like tcp://host:8786, got 'tcp://localhost"):
        schedulers.check_scheduler(address)
    assert asked == []
    for sound in ("tcp://mine:1", "tls://[::1]:8786", "head-node.cluster:8786"):
        schedulers.check_scheduler(sound)
    assert asked == ["tcp://mine:1", "tls://[::1]:8786", "head-node.cluster:8786"]


def test_a_confirmed_scheduler_is_taken(algorithm, context, log, folder, tmp_path, settings, connected):
    settings.setValue(SCHEDULERS.key, "tcp://mine:1  tcp://mine:2")
    given = {"INPUT": str(folder), "OUTPUT": str(tmp_path / "tiles"), "SCHEDULER": "tcp://mine:2", **QUICKLY}
    with pytest.raises(refused(), match="No Dask scheduler answers"):
        algorithm.run(given, context, log, {}, False)
    assert connected == ["tcp://mine:2"]


@pytest.mark.parametrize("is_wanted", [True, False])
def test_in_the_desktop_the_user_is_asked_once(qgis_application, settings, monkeypatch, is_wanted):
    settings.remove(SCHEDULERS.key)
    asked = []
    monkeypatch.setattr(schedulers, "_has_windows", lambda: True)
    monkeypatch.setattr(schedulers, "_is_wanted", lambda address: asked.append(address) or is_wanted)
    for _ in range(2):
        if is_wanted:
            schedulers.check_scheduler("tcp://mine:1")
        else:
            with pytest.raises(ValueError, match="was not confirmed"):
                schedulers.check_scheduler("tcp://mine:1")
    assert len(asked) == (1 if is_wanted else 2)
    assert schedulers.confirmed() == (["tcp://mine:1"] if is_wanted else [])


def test_tiles_are_not_written_over_those_that_are_read(algorithm, context, log, folder):
    before = {path: path.read_bytes() for path in folder.iterdir()}
    with pytest.raises(refused(), match="choose another folder"):
        algorithm.run({"INPUT": str(folder), "OUTPUT": str(folder), **QUICKLY}, context, log, {}, False)
    assert {path: path.read_bytes() for path in folder.iterdir()} == before


@pytest.mark.parametrize("name", ["detectbuildingsintiles", "cutintotiles"])
@pytest.mark.parametrize("given", ["survey.vpc", ""], ids=["file", "folder"])
def test_a_virtual_point_cloud_that_is_read_is_not_written_over(provider, context, log, folder, tmp_path, name, given):
    survey = tmp_path / "survey"
    survey.mkdir()
    vpc = survey / "survey.vpc"
    write_vpc(sorted(folder.glob("*.laz")), vpc)
    before = vpc.read_bytes()
    parameters = {"INPUT": str(survey / given), "OUTPUT": str(survey), **(QUICKLY if "detect" in name else {})}
    _, succeeded = provider.algorithm(name).run(parameters, context, log)
    assert not succeeded
    assert "survey.vpc is an input" in log.errors[0]
    assert [path.name for path in survey.iterdir()] == ["survey.vpc"]
    assert vpc.read_bytes() == before


@pytest.mark.parametrize(
    ("name", "kept"), [("detectbuildingsintiles", "what was done is kept in"), ("cutintotiles", "that were complete")]
)
def test_a_stopped_run_reports_what_is_kept(provider, context, log, folder, tmp_path, name, kept):
    log.cancel()
    given = {"INPUT": str(folder), "OUTPUT": str(tmp_path / "out"), **(QUICKLY if "detect" in name else {})}
    provider.algorithm(name).run(given, context, log, {}, False)
    (said,) = [sentence for sentence in log.infos if "Cancelled" in sentence]
    assert kept in said


def test_coordinates_far_outside_of_their_system_are_a_warning(provider, context, log, tmp_path):
    xyz = np.random.default_rng(1).uniform(0, 20, (100, 3)) + [5e8, 5e8, 0]
    path = tmp_path / "far.las"
    write_cloud(create_cloud({"xyz": xyz}, "EPSG:32631"), path)
    given = {"INPUT": str(path), "OUTPUT": str(tmp_path / "cut")}
    results, succeeded = provider.algorithm("cutintotiles").run(given, context, log)
    assert succeeded
    assert any("outside of EPSG:32631" in sentence for sentence in log.warnings)
    assert len(read_cloud(results["VPC"])) == 100


def test_tiles_are_cut_with_a_virtual_point_cloud_over_them(provider, context, log, folder, tmp_path):
    given = {"INPUT": str(folder), "SIDE": 20.0, "OUTPUT": str(tmp_path / "cut")}
    results, succeeded = provider.algorithm("cutintotiles").run(given, context, log)
    assert succeeded, log.textLog()
    assert results["TILES"] == 9
    tiles = sorted((tmp_path / "cut").glob("*.laz"))
    assert tiles[0].name == "tile_85000_447000.laz"
    whole, parts = read_cloud(results["VPC"]), [read_cloud(path) for path in folder.glob("*.laz")]
    cut, uncut = (np.concatenate([one.to_map(one.get("xyz")) for one in clouds]) for clouds in ([whole], parts))
    np.testing.assert_array_equal(cut[np.lexsort(cut.T)], uncut[np.lexsort(uncut.T)])
    for tile in tiles:
        xyz = read_cloud(tile)
        assert np.ptp(xyz.to_map(xyz.get("xyz"))[:, :2], axis=0).max() < 20
    with pytest.raises(refused(), match="choose another folder"):
        provider.algorithm("cutintotiles").run({**given, "OUTPUT": str(folder)}, context, log, {}, False)


def test_a_tile_without_points_is_no_pattern_and_no_failure(provider, context, log, folder, tmp_path):
    """The first file was asked for the reference system of all, and refused the run as it had no points."""
    (tmp_path / "tiles").mkdir()
    (tmp_path / "tiles" / "a.las").write_bytes(made_las(n=0))
    shutil.copy(folder / "west.laz", tmp_path / "tiles")
    given = {"INPUT": str(tmp_path / "tiles"), "EXTENT": "85000,85010,447000,447010", "SIDE": 20.0}
    results, succeeded = provider.algorithm("cutintotiles").run(
        {**given, "OUTPUT": str(tmp_path / "cut")}, context, log
    )
    assert succeeded, log.textLog()
    assert results["TILES"] == 1
    assert "1 of 2 tiles have no points and are left out: a.las." in log.warnings
    algorithm = provider.algorithm("detectbuildingsintiles")
    accepted, why = algorithm.checkParameterValues({**given, "OUTPUT": str(tmp_path / "out"), **QUICKLY}, context)
    assert accepted, why


def test_footprints_of_walls_come_with_rasters_and_the_comparison(provider, context, log, folder, tmp_path):
    """Seams, chosen points and edges are tested without QGIS; this is about the files."""
    algorithm = provider.algorithm("mapfootprintsintiles")
    old = squares((85_019, 447_020), size=10.0)
    outputs = {"OUTPUT": "tiles", "WALL_FOOTPRINTS": "walls.gpkg", "BUILDINGS": "old.gpkg", "DTM": "dtm.tif"}
    outputs["REPORT"] = "report.html"
    given = {"INPUT": str(folder), "OLD_MAP": old, **QUICKLY}
    given.update({name: str(tmp_path / one) for name, one in outputs.items()})
    results, succeeded = algorithm.run(given, context, log)
    assert succeeded, log.textLog()
    assert results["TILES"] == 2
    image = opened(results["DTM"])
    west, size, _, north, *_ = image.GetGeoTransform()
    assert (west % size, north % size) == (0, 0)
    values = values_of(image)
    assert (image.RasterXSize * size, image.RasterYSize * size) == (pytest.approx(50, abs=2), pytest.approx(50, abs=2))
    np.testing.assert_allclose(values[values > -9999], 0.0, atol=0.3)
    assert (values == -9999).mean() < 0.1
    assert "Corners" in Path(results["REPORT"]).read_text(encoding="utf-8")
    assert sorted(one.name for one in tmp_path.iterdir()) == sorted(outputs.values())


def test_one_page_over_a_survey_has_its_map_and_what_the_steps_took(algorithm, context, log, folder, tmp_path):
    """In tiles the page had neither the shaded surface nor the date, parameters and seconds."""
    page = tmp_path / "report.html"
    given = {"INPUT": str(folder), "OUTPUT": str(tmp_path / "tiles"), "REPORT": str(page), **QUICKLY}
    results, succeeded = algorithm.run(given, context, log)
    assert succeeded, log.textLog()
    text = page.read_text(encoding="utf-8")
    assert "<image" in text
    assert "1 building," in text
    for what in (f"{results['POINTS']:,} points", "EPSG:28992", "Tiles written: 2.", "density 4", "In all processes"):
        assert what in text
    ground = text.split("<h3>Classify ground points (TIN)</h3>")[1].split("</table>")[0]
    # What automatic became, in the blocks.
    assert re.search(r'Grid cell size</th><td class="number">1 m</td><td>automatic', ground)
    (seconds,) = re.findall(r'All steps</th><td class="number">([\d.]+) s', text)
    assert float(seconds) > 0


def test_the_tiles_are_loaded_with_points_style_and_the_layers_in_one_group(algorithm, context, log, folder, tmp_path):
    """QGIS shows only the outlines of tiles that are no COPC; none were loaded at all."""
    from qgis.core import QgsPointCloudLayer, QgsProcessingOutputLayerDefinition, QgsProcessingUtils

    out = tmp_path / "tiles"
    target = str(tmp_path / "footprints.gpkg")
    loaded = QgsProcessingOutputLayerDefinition(target, context.project())
    given = {"INPUT": str(folder), "OUTPUT": str(out), "FOOTPRINTS": loaded, **QUICKLY}
    results, succeeded = algorithm.run(given, context, log)
    assert succeeded, log.textLog()
    layers = context.layersToLoadOnCompletion()
    shown = str(out / "shown" / "shown.vpc")
    assert {path: (one.name, one.groupName) for path, one in layers.items()} == {
        shown: ("Classified point cloud", "tiles: Detect buildings, in tiles"),
        target: ("Footprints", "tiles: Detect buildings, in tiles"),
    }
    assert layers[shown].layerTypeHint == QgsProcessingUtils.LayerHint.PointCloud, "QGIS took it for polygons"
    assert layers[shown].layerSortKey < layers[target].layerSortKey
    assert context.layerToLoadOnCompletionDetails(shown).postProcessor().stem == "classification"
    layer = QgsPointCloudLayer(shown, "tiles", "vpc")
    assert layer.isValid()
    assert layer.pointCount() == results["POINTS"] == len(read_cloud(shown))
    dimensions = {one.name() for one in layer.attributes().attributes()}
    assert {"Classification", "Intensity", "HeightAboveGround", "Confidence", "Reason"} <= dimensions
    # The folder as input of another run has each point once.
    assert sum(len(read_cloud(one)) for one in files_of_survey([out])) == results["POINTS"]
    assert not (out / ".lidar-buildings").exists(), "points kept for the page were left"


def test_who_wants_no_tiles_on_the_map_gets_no_copies_of_them(algorithm, context, log, folder, tmp_path):
    given = {"INPUT": str(folder), "OUTPUT": str(tmp_path / "tiles"), "LOAD": False, **QUICKLY}
    _, succeeded = algorithm.run(given, context, log)
    assert succeeded, log.textLog()
    assert not (tmp_path / "tiles" / "shown").exists()
    assert not context.layersToLoadOnCompletion()


def test_tiles_without_a_coordinate_system_get_the_given_one(algorithm, context, log, folder, tmp_path):
    """In tiles there was no way to say it: layers lay nowhere, and 3D views were empty."""
    from qgis.core import QgsVectorLayer

    bare = tmp_path / "bare"
    bare.mkdir()
    for path in folder.glob("*.laz"):
        write_cloud(create_cloud({"xyz": read_cloud(path).get("xyz") + read_cloud(path).origin}), bare / path.name)
    target = tmp_path / "footprints.gpkg"
    given = {"INPUT": str(bare), "OUTPUT": str(tmp_path / "tiles"), "FOOTPRINTS": str(target), **QUICKLY}
    results, succeeded = algorithm.run({**given, "CRS": "EPSG:28992"}, context, log)
    assert succeeded, log.textLog()
    assert QgsVectorLayer(str(target)).crs().authid() == "EPSG:28992"
    for tile in (tmp_path / "tiles").glob("*.laz"):
        assert read_cloud(tile).crs.plane == "EPSG:28992"
    assert not [one for one in log.warnings if "coordinate reference system" in one]


def test_feet_of_a_given_coordinate_system_are_feet(algorithm, context, log, folder, tmp_path):
    from qgis.core import QgsVectorLayer

    bare = tmp_path / "bare"
    bare.mkdir()
    for path in folder.glob("*.laz"):
        xyz = read_cloud(path).get("xyz") + read_cloud(path).origin
        write_cloud(create_cloud({"xyz": xyz / 0.3048}), bare / path.name)
    target = tmp_path / "footprints.gpkg"
    given = {"INPUT": str(bare), "OUTPUT": str(tmp_path / "tiles"), "FOOTPRINTS": str(target), **QUICKLY}
    # NAD83 / Oregon North in international feet, heights in feet too.
    _, succeeded = algorithm.run({**given, "CRS": "EPSG:2913"}, context, log)
    assert succeeded, log.textLog()
    (house,) = QgsVectorLayer(str(target)).getFeatures()
    assert house["area"] == pytest.approx(120, rel=0.1)
    assert house.geometry().area() == pytest.approx(120 / 0.3048**2, rel=0.1)
