"""Every stage, as it is declared, is what QGIS shows."""

from __future__ import annotations

import html
import json
import re
from pathlib import Path

import pytest
from qgis.core import (
    Qgis,
    QgsProcessingOutputNumber,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterEnum,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterFile,
    QgsProcessingParameterNumber,
    QgsProcessingParameterString,
)
from qgis.PyQt.QtCore import QUrl

from lidar_buildings.algorithms.help import pipeline_help, with_picture
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.algorithms.tiling.tiled_pipelines import CUT_INTO_TILES, TILED_PIPELINES
from lidar_buildings.provider.clouds import CloudParameter, CloudsParameter
from lidar_buildings.provider.models import build_model
from lidar_buildings.provider.paths import PICTURES
from lidar_buildings.provider.vectors import SOURCE_TYPES
from lidar_buildings.scripts.released import RELEASED, missing, names_of, with_new
from lidar_buildings.tests.toys import TOYS

ALL = {**STAGES, **TOYS}


@pytest.fixture(params=ALL)
def stage(request):
    return ALL[request.param]


@pytest.fixture
def algorithm(stage, provider):
    return provider.algorithm(stage.id).create()


def test_released_names_stay(provider):
    """Saved models and scripts call them; ``scripts/released.py`` adds a release's."""
    released, found = json.loads(RELEASED.read_text(encoding="utf-8")), names_of(provider)
    assert released["detectbuildings"]["outputs"]
    assert missing(released, found) == []


def test_names_that_are_taken_out_are_missed():
    released = {"a": {"parameters": ["X", "Y"]}, "b": {"outputs": ["Z"]}}
    assert missing(released, {"a": {"parameters": ["Y", "NEW"]}}) == ["a: parameters: X", "b: outputs: Z"]
    added = with_new(released, {"a": {"parameters": ["NEW", "X", "Y"]}, "c": {"outputs": []}})
    assert added["a"] == {"parameters": ["X", "Y", "NEW"]}
    assert set(added) == {"a", "b", "c"}


SAVED_OUTPUTS = {
    "detectbuildings": {"classified_point_cloud", "footprints", "report"},
    "modelbuildings": {"classified_point_cloud", "footprints", "buildings", "roofs", "walls", "cityjson"},
    "detectbuildings2019": {"classified_point_cloud", "footprints", "report"},
    "interpretstructure": {"point_cloud_with_new_dimensions"},
    "mapfootprints": {"classified_point_cloud", "wall_footprints", "terrain_model", "report"},
    "modelfacades": {"point_cloud_with_segmentid", "openings_facades_with_openings", "windows_and_doors"},
    "modelterrain": {"classified_point_cloud", "terrain_model", "surface_model"},
    "modelindustry": {"point_cloud_with_new_dimensions", "axes_of_cylinders", "centers_of_spheres", "planes"},
}


@pytest.mark.parametrize("name", SAVED_OUTPUTS)
def test_names_of_outputs_of_saved_models_are_frozen(provider, name):
    """QGIS names the outputs of a model that a user saves by their titles: with other ones, scripts would break."""
    model = build_model(provider.algorithm(name).pipeline)
    assert SAVED_OUTPUTS[name] <= {one.name() for one in model.destinationParameterDefinitions()}


def test_the_toolbox_has_all_and_nothing_else(provider):
    shown = {algorithm.name() for algorithm in provider.algorithms()}
    made = (*ALL.values(), *PIPELINES.values(), *TILED_PIPELINES.values(), CUT_INTO_TILES)
    assert shown == {one.id for one in made}


def test_the_algorithm_is_the_stage(stage, algorithm):
    assert (algorithm.name(), algorithm.displayName(), algorithm.group()) == (stage.id, stage.title, stage.group)
    own = [tag.strip() for tag in stage.tags.split(",") if tag.strip()]
    assert algorithm.tags() == [*own, "lidar", "point cloud"]
    assert not algorithm.icon().isNull()


def test_every_group_has_an_icon(provider):
    groups = {one.groupId(): one.svgIconPath() for one in provider.algorithms() if one.group() != "Toys"}
    models = ("modelsintiles", "modelsaspublished")
    assert {name: Path(path).stem for name, path in groups.items()} == {
        name: "models" if name in models else name for name in groups
    }


GROUPS = (" Models", " Models as published", " Models in tiles")


def test_the_toolbox_begins_with_the_models_and_these_with_detect_buildings(provider):
    assert min(one.group() for one in provider.algorithms()) == " Models"
    named = {group: [one.displayName() for one in provider.algorithms() if one.group() == group] for group in GROUPS}
    assert sorted(named[" Models"])[0] == "Detect buildings"
    assert len(named[" Models"]) == 8
    assert not [name for name in named[" Models"] if name.endswith(", in tiles")]
    published = ["Detect buildings, published 2019", "Map footprints, published 2022"]
    assert sorted(named[" Models as published"]) == published
    assert all(name.endswith(", in tiles") for name in named[" Models in tiles"])
    assert len(named[" Models in tiles"]) == len(TILED_PIPELINES)


def test_a_format_finds_algorithms_on_files_and_not_all(provider):
    """Each of four formats found all 91."""
    for word in ("las", "laz", "copc", "pdal"):
        found = [one.name() for one in provider.algorithms() if word in one.tags()]
        assert "mergeclouds" in found
        assert "clipcloud" in found
        assert len(found) < 10


@pytest.mark.parametrize(
    ("word", "wanted"),
    [
        ("las2building", "detectbuildings"),
        ("lasground", "classifygroundtin"),
        ("vegetation", "classifyvegetation"),
        ("canopy", "rasterizeterrain"),
        ("denoise", "classifynoisehistogram"),
        ("rmse", "comparecorners"),
        ("iou", "assessbuildings"),
        ("wire", "interpretstructure"),
        ("normalize", "computeheightaboveground"),
        ("copc", "clipcloud"),
        ("pdal", "mergeclouds"),
        ("kmeans", "classifybuildings2019"),
    ],
)
def test_words_that_users_type_find_it(provider, word, wanted):
    assert word in [tag.lower() for tag in provider.algorithm(wanted).tags()]


@pytest.mark.parametrize("name", ["registerstreet", "modelcityblock"])
def test_two_clouds_are_told_apart_by_their_labels(provider, name):
    """They were called "Point cloud" and "Reference point cloud"."""
    algorithm = provider.algorithm(name).create()
    labels = {d.name(): d.description() for d in algorithm.parameterDefinitions()}
    assert labels["INPUT"] == "Airborne point cloud"
    assert labels["REFERENCE"] == "Street scan"


def test_inputs_and_outputs_are_what_the_stage_reads_and_makes(stage, algorithm):
    clouds = [d.name() for d in algorithm.parameterDefinitions() if isinstance(d, (CloudParameter, CloudsParameter))]
    own = "INPUTS" if stage.merges else "INPUT"
    assert clouds == [own] * stage.reads_cloud + ["REFERENCE"] * stage.reads_reference
    layers = [d for d in algorithm.parameterDefinitions() if isinstance(d, QgsProcessingParameterFeatureSource)]
    declared = [input_layer for input_layer in stage.input_layers if input_layer.read is None]
    assert [layer.name() for layer in layers] == [input_layer.name.upper() for input_layer in declared]
    files = [d.name() for d in algorithm.parameterDefinitions() if isinstance(d, QgsProcessingParameterFile)]
    assert files == [input_layer.name.upper() for input_layer in stage.input_layers if input_layer not in declared]
    for layer, input_layer in zip(layers, declared):
        assert layer.dataTypes() == [SOURCE_TYPES[input_layer.geometry].value]
        assert bool(layer.flags() & Qgis.ProcessingParameterFlag.Optional) == input_layer.optional
    destinations = [definition.name() for definition in algorithm.destinationParameterDefinitions()]
    wanted = ["OUTPUT"] * bool(stage.writes or stage.creates or stage.selects or stage.merges)
    wanted += [made.name.upper() for made in (*stage.layers, *stage.rasters)] + ["REPORT"] * bool(stage.measures)
    wanted += [file.name.upper() for file in stage.files]
    assert destinations == wanted
    numbers = {
        output.name() for output in algorithm.outputDefinitions() if isinstance(output, QgsProcessingOutputNumber)
    }
    automatic = {f"{t.name.upper()}_USED" for t in stage.tunables.values() if t.is_optional and t.type in (int, float)}
    assert numbers == automatic | {measure.name.upper() for measure in stage.measures}


def test_only_what_a_stage_is_for_must_be_asked_for(stage, algorithm):
    """The cloud, or else the first layer; of numbers, several rasters and layers besides files each does by itself."""
    destinations = algorithm.destinationParameterDefinitions()
    needed = [d.name() for d in destinations if not d.flags() & Qgis.ProcessingParameterFlag.Optional]
    choice = stage.measures or len(stage.rasters) > 1 or stage.files
    assert needed == ([] if choice and not stage.makes_cloud else [destinations[0].name()])


def test_every_tunable_is_a_parameter(stage, algorithm):
    for tunable in stage.tunables.values():
        definition = algorithm.parameterDefinition(tunable.name.upper())
        default = list(tunable.default) if isinstance(tunable.default, tuple) else tunable.default
        assert definition.defaultValue() == default
        assert definition.description().startswith(tunable.label)
        assert definition.help().startswith(tunable.param.help)
        flags = definition.flags()
        assert bool(flags & Qgis.ProcessingParameterFlag.Advanced) == tunable.param.advanced
        assert bool(flags & Qgis.ProcessingParameterFlag.Optional) == (tunable.is_optional or default == "")
        if tunable.param.unit:
            assert f"({tunable.param.unit}" in definition.description()
        if tunable.is_optional:
            assert f"empty = {tunable.param.unset}" in definition.description()
            assert tunable.param.unset_text in definition.help()


KINDS = {
    float: QgsProcessingParameterNumber,
    int: QgsProcessingParameterNumber,
    bool: QgsProcessingParameterBoolean,
    tuple: QgsProcessingParameterEnum,
}


def test_every_tunable_has_its_type_bounds_and_choices(stage, algorithm):
    for tunable in stage.tunables.values():
        definition = algorithm.parameterDefinition(tunable.name.upper())
        words = QgsProcessingParameterEnum if tunable.param.choices else QgsProcessingParameterString
        assert isinstance(definition, KINDS.get(tunable.type, words))
        if isinstance(definition, QgsProcessingParameterEnum):
            assert tuple(definition.options()) == tunable.param.choices
            assert definition.usesStaticStrings()
            assert definition.allowMultiple() == (tunable.type is tuple)
            # QGIS takes a comma for the end of a choice and refuses what has one.
            assert all(definition.checkValueIsAcceptable(choice) for choice in tunable.param.choices)
        if isinstance(definition, QgsProcessingParameterNumber):
            kind = Qgis.ProcessingNumberParameterType
            assert definition.dataType() == (kind.Integer if tunable.type is int else kind.Double)
            if tunable.param.low is not None:
                assert definition.minimum() == tunable.param.low
            if tunable.param.high is not None:
                assert definition.maximum() == tunable.param.high


def test_bounds_are_refused_in_the_words_of_the_core(stage, algorithm, context, town_file, out):
    given = {"INPUT": str(town_file), "REFERENCE": str(town_file), "OUTPUT": str(out / "a.las")}
    given["INPUTS"] = [str(town_file), str(town_file)]
    for tunable in stage.tunables.values():
        if tunable.type not in (int, float) or tunable.param.high is None:
            continue
        high = tunable.param.high
        beyond = high if tunable.param.open_high else high + 1
        with pytest.raises(ValueError, match="must be") as refused:
            tunable.check(float(beyond), tunable.name.upper())
        accepted, message = algorithm.checkParameterValues({**given, tunable.name.upper(): beyond}, context)
        assert (accepted, message) == (False, str(refused.value))


def test_help_is_complete(stage, algorithm):
    text = algorithm.shortHelpString()
    assert stage.summary.split()[0] in text
    for tunable in stage.tunables.values():
        assert f"<b>{tunable.title}</b>".replace("<b>", "").replace("</b>", "").split("<")[0] in text
    for name in ("Notes", "References"):
        assert (f"<h3>{name}</h3>" in text) == bool(stage.section(name))
    for definition in algorithm.parameterDefinitions():
        assert definition.help(), definition.name()


@pytest.mark.parametrize("tiled", sorted(tiled.id for tiled in TILED_PIPELINES.values()))
def test_help_of_tiled_composites_describes_their_own_outputs(tiled, provider):
    algorithm = provider.algorithm(tiled)
    text = algorithm.shortHelpString().split("<h3>Outputs</h3>")[1].split("<h3>")[0]
    reported = {name for names in re.findall("<b>([A-Z_, ]+)</b>", text) for name in names.split(", ")}
    assert reported == {definition.name() for definition in algorithm.outputDefinitions()} - {"VPC"}


@pytest.mark.parametrize("name", sorted({*(tiled.id for tiled in TILED_PIPELINES.values()), CUT_INTO_TILES.id}))
def test_help_of_surveys_describes_every_setting(name, provider):
    algorithm = provider.algorithm(name)
    text = html.unescape(algorithm.shortHelpString())
    for definition in algorithm.parameterDefinitions():
        if not definition.isDestination():
            assert definition.help().split(". ")[0].rstrip(".") in text, definition.name()


@pytest.mark.parametrize("name", PIPELINES)
def test_composites_show_their_steps(name, provider):
    pipeline = PIPELINES[name]
    text = pipeline_help(pipeline)
    assert all(step.stage.title in text for step in pipeline.steps)
    shown = provider.algorithm(pipeline.id).create().shortHelpString()
    assert shown == with_picture(text, pipeline.id, QUrl.fromLocalFile(str(PICTURES)).toString())


def test_every_algorithm_has_a_help_page_with_its_pictures(provider):
    for algorithm in provider.algorithms():
        shown = Path(QUrl(algorithm.helpUrl()).toLocalFile()).read_text(encoding="utf-8")
        assert f"<h1>{html.escape(algorithm.displayName())}</h1>\n{algorithm.shortHelpString()}\n</body>" in shown
        assert all(Path(QUrl(picture).toLocalFile()).is_file() for picture in re.findall('<img src="(.*?)"', shown))


def test_pictures_of_the_help_are_there(provider):
    shown = re.findall('src="([^"]+)"', " ".join(algorithm.shortHelpString() for algorithm in provider.algorithms()))
    assert len(shown) > 40
    assert all(Path(QUrl(source).toLocalFile()).is_file() for source in shown)
