"""Text files of a survey in tiles: each building once and whole, under its number in the survey."""

import json

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import write_cloud
from lidar_buildings.algorithms.models3d.building_facts import NamedModel
from lidar_buildings.algorithms.models3d.cityjson import cityjson_pieces
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.algorithms.stage import MapFrame
from lidar_buildings.algorithms.tiling.run_in_tiles import run_in_tiles
from lidar_buildings.algorithms.tiling.tiled_run import TilesOptions
from lidar_buildings.algorithms.tiling.workers import Workers
from lidar_buildings.tests.solid_validity import assert_valid_cityjson

MODEL = PIPELINES["model_buildings"]
# Blocks of this side (m) have edges through two of the three houses.
SIDE = 40.0
CORNER = np.array([600_010.0, 5_000_010.0, 0.0])
HOUSES = ((24, 8), (8, 24), (46, 46))
WITH_TERRAIN = {"models_terrain_tolerance": 0.1}


@pytest.fixture(scope="module")
def cloud():
    """Three gable houses of 12 m by 10 m, eaves at 4 m and ridges at 8 m, on a plain of 66 m by 66 m."""
    rng = np.random.default_rng(3)
    xyz = np.column_stack([rng.uniform(0, 66, (20_000, 2)), rng.normal(0, 0.02, 20_000)])
    for x, y in HOUSES:
        along, across = xyz[:, 0] - x, xyz[:, 1] - y
        over = (along > 0) & (along < 12) & (across > 0) & (across < 10)
        xyz[over, 2] += 8 - 0.8 * np.abs(across[over] - 5)
    return create_cloud({"xyz": np.round(xyz + CORNER, 3)}, "EPSG:28992")


@pytest.fixture(scope="module")
def survey(cloud, tmp_path_factory):
    """The outcome in tiles, and the text of every file in all of its formats."""
    folder = tmp_path_factory.mktemp("survey")
    paths = []
    for number, part in enumerate(np.array_split(np.arange(len(cloud)), 2)):
        paths.append(folder / f"{number}.las")
        write_cloud(cloud.take(part), paths[-1])
    texts = {}

    def take_file(survey, name, content):
        frame = MapFrame(lambda local: local + survey.origin, "EPSG:28992")
        for called in ("CityJSON", "CityJSONSeq") if name == "cityjson" else ("Wavefront OBJ",):
            texts[called] = "".join(content.pieces(called, frame))

    options = TilesOptions(Workers(processes=1), SIDE, take_file=take_file)
    outcome = run_in_tiles(MODEL, paths, folder / "out", options=options, **WITH_TERRAIN)
    return outcome, texts


@pytest.fixture(scope="module")
def whole(cloud):
    """The results of the cloud at once."""
    return run_pipeline(MODEL, cloud.copy(), **WITH_TERRAIN)


def test_every_building_is_modelled_once_and_valid(survey):
    outcome, texts = survey
    assert not outcome.failures
    assert outcome.blocks == 4
    things = assert_valid_cityjson(texts["CityJSON"])["CityObjects"]
    ids = [str(number) for number in outcome.layers["footprints"].columns["id"]]
    houses = {name: thing for name, thing in things.items() if thing["type"] == "Building"}
    assert sorted(name.split("-")[0] for name in houses) == ids == ["1", "2", "3"]
    for thing in houses.values():
        assert [geometry["lod"] for geometry in thing["geometry"]] == ["1.2", "1.3", "2.2"]
        assert thing["attributes"]["roof_type"] == "gable"
        # 12 m by 10 m, 6 m high in the mean.
        assert thing["attributes"]["volume"] == pytest.approx(720, rel=0.05)


def test_models_stand_where_their_footprints_are(survey):
    outcome, texts = survey
    whole = json.loads(texts["CityJSON"])
    places = np.array(whole["vertices"]) * whole["transform"]["scale"] + whole["transform"]["translate"]
    footprints = outcome.layers["footprints"]
    named = {
        thing["attributes"]["building"]: thing for thing in whole["CityObjects"].values() if thing["type"] == "Building"
    }
    for name, rings in zip(footprints.columns["id"], footprints.geometries):
        shell = named[str(name)]["geometry"][-1]["boundaries"][0]
        own = places[[vertex for face in shell for ring in face for vertex in ring]]
        around = rings[0] + outcome.survey.origin[:2]
        np.testing.assert_allclose(own[:, :2].min(axis=0), around.min(axis=0), atol=0.01)
        np.testing.assert_allclose(own[:, :2].max(axis=0), around.max(axis=0), atol=0.01)


def test_faces_belong_to_their_buildings(survey):
    outcome, _ = survey
    assert outcome.layers["buildings"].columns["building"] == ["1", "2", "3"]
    assert outcome.layers["roofs"].columns["building"] == ["1", "1", "2", "2", "3", "3"]
    assert outcome.layers["roofs"].columns["id"] == [1, 2, 3, 4, 5, 6]
    assert set(outcome.layers["walls"].columns["building"]) == {"1", "2", "3"}


def test_all_formats_have_all_buildings(survey):
    _, texts = survey
    head, *features = map(json.loads, texts["CityJSONSeq"].splitlines())
    assert head["type"] == "CityJSON"
    assert sorted(feature["id"].split("-")[0] for feature in features)[:3] == ["1", "2", "3"]
    assert [feature["id"][:7] for feature in features[3:]] == ["terrain"] * 4
    assert texts["Wavefront OBJ"].count("\no building_") == 3


def test_models_are_those_of_the_whole_cloud(survey, whole):
    outcome, _ = survey
    for layer in ("buildings", "roofs"):
        assert len(whole.layers[layer]) == len(outcome.layers[layer])
    for column, within in (("volume", 0.02), ("ridge_height", 0.01), ("roof_area", 0.02)):
        of_whole = sorted(whole.layers["buildings"].columns[column])
        np.testing.assert_allclose(sorted(outcome.layers["buildings"].columns[column]), of_whole, rtol=within)


def test_terrain_is_that_of_the_whole_cloud_without_seams(survey, whole):
    """Edges of blocks go through patches; three houses of 120 m² stand on 66 m by 66 m."""
    outcome, _ = survey
    found, expected = (
        sorted((rings[0][:3] + origin).round(3).tolist() for rings in layers["terrain"].geometries)
        for layers, origin in ((outcome.layers, outcome.survey.origin), (whole.layers, whole.cloud.origin))
    )
    assert len(expected) > 50
    assert found == expected
    assert len(set(outcome.layers["terrain"].columns["patch"])) == 4


def test_files_have_the_terrain_of_the_layer_once_and_its_vertices_are_those_of_walls(survey, whole):
    outcome, texts = survey
    read = json.loads(texts["CityJSON"])
    places = np.array(read["vertices"]) * read["transform"]["scale"] + read["transform"]["translate"]
    patches = [thing for thing in read["CityObjects"].values() if thing["type"] == "TINRelief"]
    triangles = [ring for patch in patches for (ring,) in patch["geometry"][0]["boundaries"]]
    found = sorted(sorted(places[ring].round(4).tolist()) for ring in triangles)
    geometries = whole.layers["terrain"].geometries
    assert len(patches) == 4
    assert found == sorted(sorted((rings[0][:3] + whole.cloud.origin).round(4).tolist()) for rings in geometries)
    edges = {edge for ring in triangles for edge in zip(ring, ring[1:] + ring[:1])}
    assert len(edges) == 3 * len(triangles), "a triangle is there twice"
    solids = [thing["geometry"][-1] for thing in read["CityObjects"].values() if thing["type"] == "Building"]
    grounds = [
        ring
        for solid in solids
        for (ring, *_), number in zip(solid["boundaries"][0], solid["semantics"]["values"][0])
        if solid["semantics"]["surfaces"][number]["type"] == "GroundSurface"
    ]
    below = {edge for ring in grounds for edge in zip(ring, ring[1:] + ring[:1])}
    border = {edge for edge in below if edge[::-1] not in below}
    assert len(border) >= 12
    # Grounds look down, terrain up: the same way along their common edges.
    assert border <= edges, "a gap between wall and terrain"


def test_models_are_kept_as_text_to_the_last_bit(whole):
    content = whole.files["cityjson"]
    kept = [NamedModel.of_record(json.loads(json.dumps(one.record())), one.name) for one in content.items]
    frame = MapFrame(np.asarray)
    for called in ("CityJSON", "CityJSONSeq"):
        assert list(cityjson_pieces(kept, called, frame)) == list(content.pieces(called, frame))
