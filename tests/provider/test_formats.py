"""No format of an output decides whether a run works: what can't be written is refused before it, and nothing else."""

import itertools
import shutil
from pathlib import Path

import numpy as np
import pytest
from qgis.core import QgsVectorFileWriter

from lidar_buildings.algorithms.cloud import laz
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import write_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.provider.vectors import SOURCE_TYPES, check_layer
from lidar_buildings.tests.las_files import made_las, vlr
from lidar_buildings.tests.provider.helpers import run

# Formats that hold polygons with attributes, in every GDAL that QGIS comes with.
COMMON = ("gpkg", "shp", "geojson", "fgb", "gml", "kml", "sqlite")


def layer_formats(tmp_path):
    """Return the extensions that layers of polygons may have here."""
    found = []
    for extension in QgsVectorFileWriter.supportedFormatExtensions():
        try:
            check_layer(tmp_path / f"a.{extension}", SOURCE_TYPES["Polygon"])
        except ValueError:
            continue
        found.append(extension)
    return found


def test_formats_of_layers_are_those_that_hold_them(provider, tmp_path):
    """A table without geometry, or a drawing without attributes, failed at the end of a run."""
    formats = layer_formats(tmp_path)
    assert set(COMMON) <= set(formats)
    assert not {"csv", "xlsx", "ods", "dxf", "dgn", "gpx", "sql", "txt"} & set(formats)


@pytest.mark.parametrize("kind", ["LineString", "Point"])
def test_formats_hold_other_kinds_too(provider, tmp_path, kind):
    for extension in COMMON:
        check_layer(tmp_path / f"a.{extension}", SOURCE_TYPES[kind])


def test_an_empty_layer_of_any_kind_is_an_input(provider, context, log, town_file, out):
    """GeoJSON without features names no kind of geometry: it was refused as none."""
    (out / "none.geojson").write_text('{"type": "FeatureCollection", "features": []}')
    given = {"INPUT": str(town_file), "FOOTPRINTS": str(out / "none.geojson"), "REPORT": str(out / "a.html")}
    assert run("reportbuildings", given, context, log)["BUILDINGS"] == 0
    table = out / "table.csv"
    table.write_text("id\n1\n")
    accepted, message = (
        provider.algorithm("reportbuildings")
        .create()
        .checkParameterValues({**given, "FOOTPRINTS": str(table)}, context)
    )
    assert not accepted
    assert "must be a vector layer" in message or "must be a layer of polygons" in message


@pytest.fixture
def waveforms(tmp_path):
    """A file with references to waveforms, which laszip compresses and lazrs doesn't."""
    path = tmp_path / "waveforms.las"
    crs = vlr("LASF_Projection", 2112, b'PROJCS["RD",UNIT["metre",1],AUTHORITY["EPSG","28992"]]\0')
    path.write_bytes(made_las(point_format=9, vlrs=(crs,)))
    return path


@pytest.mark.parametrize(("name", "inputs"), [("toylift", "INPUT"), ("toychain", "INPUT"), ("toymerge", "INPUTS")])
def test_a_laz_that_no_package_writes_is_refused_before_the_work(
    provider, context, town_file, waveforms, out, monkeypatch, name, inputs
):
    """It was refused when everything was computed."""
    has_backend = laz.has_backend
    monkeypatch.setattr(laz, "has_backend", lambda name: name != "Laszip" and has_backend(name))
    clouds = [str(town_file), str(waveforms)] if inputs == "INPUTS" else str(waveforms)
    check = provider.algorithm(name).create().checkParameterValues
    accepted, message = check({inputs: clouds, "OUTPUT": str(out / "a.laz")}, context)
    assert not accepted
    assert message.startswith("LAZ with waveforms (point format")
    for ending in ("las", "copc.laz"):
        assert check({inputs: clouds, "OUTPUT": str(out / f"a.{ending}")}, context)[0]
    plain = [str(town_file)] if inputs == "INPUTS" else str(town_file)
    assert check({inputs: plain, "OUTPUT": str(out / "a.laz")}, context)[0]


@pytest.fixture
def meadow(tmp_path, rng):
    """A level meadow of 40 by 40 m, with nothing on it that any composite looks for."""
    path = tmp_path / "meadow.las"
    xyz = np.column_stack([rng.uniform(0, 40, (6400, 2)) + (85_000, 447_000), rng.normal(0, 0.02, 6400)])
    write_cloud(create_cloud({"xyz": xyz}, wkt="EPSG:28992"), path)
    return path


# Endings of outputs that are no layers, by their names; of all others, the page's.
ENDINGS = {"OUTPUT": "las", "CITYJSON": "city.json", "OBJ": "obj", "DTM": "tif", "DSM": "tif", "NDSM": "tif"}


def run_on(meadow, pipeline, layer_endings, provider, context, log, out):
    """Run a composite with all outputs but kept clouds; return the files of its layers."""
    given, algorithm = {}, provider.algorithm(pipeline.id).create()
    for definition in algorithm.parameterDefinitions():
        name = definition.name()
        if definition.type() in ("pointcloud", "multilayer"):
            given[name] = str(meadow) if name != "REFERENCE" else str(shutil.copy(meadow, meadow.with_name("2.las")))
        elif definition.type() == "sink":
            given[name] = str(out / f"{name}.{next(layer_endings)}")
        elif definition.isDestination() and not name.endswith("_OUTPUT"):
            given[name] = str(out / f"{name}.{ENDINGS.get(name, 'html')}")
    result = run(pipeline.id, given, context, log)
    layers = {
        output.name.upper() for output in pipeline.outputs if output.of in {x.name for x in output.step.stage.layers}
    }
    assert layers
    # Nothing is compared without a map.
    compared = {"DISPLACEMENTS", "BUILDINGS"} if pipeline.id.startswith("mapfootprints") else set()
    assert layers - set(result) == compared
    return [Path(result[name]) for name in sorted(layers & set(result))]


COMPOSITES = [name for name, pipeline in PIPELINES.items() if any(step.stage.layers for step in pipeline.steps)]


@pytest.mark.parametrize("name", COMPOSITES)
def test_every_composite_writes_that_it_found_nothing(provider, context, log, meadow, out, name):
    """*Detect buildings* kept nothing of a meadow if its footprints went to a GeoJSON, *Model buildings* never did."""
    endings = itertools.cycle(("geojson", "gpkg", "geojsonl", "shp", "kml", "fgb", "gml"))
    for path in run_on(meadow, PIPELINES[name], endings, provider, context, log, out):
        assert path.exists()
    assert (out / "OUTPUT.las").exists()


def test_a_composite_finds_nothing_in_every_format(provider, context, log, meadow, out, tmp_path):
    for extension in layer_formats(tmp_path):
        folder = out / extension
        folder.mkdir()
        endings = itertools.repeat(extension)
        (path,) = run_on(meadow, PIPELINES["detect_buildings"], endings, provider, context, log, folder)
        assert path == folder / f"FOOTPRINTS.{extension}"
        assert path.exists()
        assert "0 buildings, 0 m\u00b2" in (folder / "REPORT.html").read_text(encoding="utf-8")
