"""Every stage in STAGES is tested against its declaration and the conventions of the project."""

from __future__ import annotations

import ast
import math
import re
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lidar_buildings.algorithms import STAGES
from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.cloud.cloud import Cloud, create_cloud
from lidar_buildings.algorithms.cloud.dimensions import DIMENSIONS
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import Outcome, run_stage
from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling
from lidar_buildings.algorithms.stage import (
    DIMENSION,
    REFERENCE_PREFIX,
    SAMPLING,
    VALUES,
    Cancelled,
    FileContent,
    LayerFeatures,
    MapFrame,
    Monitor,
    RasterSurface,
    Report,
    Stage,
    StageResults,
    Tunable,
)
from lidar_buildings.algorithms.tiling.settings import SETTINGS
from lidar_buildings.tests.monitors import Listening

SOURCES = [path for room in ("algorithms", "provider") for path in (Path(__file__).parent.parent / room).rglob("*.py")]
# Algorithms of QGIS itself that sentences name.
TITLES_OF_QGIS = {"Fix geometries", "Open in Model Designer"}
# Options in QGIS's settings, without what is said in brackets.
QGIS_OPTIONS = Path(__file__).parent.parent / "provider" / "options.py"
OPTIONS = set(re.findall(r'Option\("\w+", "([^"(]+?)(?: \(|")', QGIS_OPTIONS.read_text(encoding="utf-8")))

CLASSIFYING = {"classify", "complete", "refine", "recode", "restore"}
VERBS = CLASSIFYING | {"segment", "cluster", "compute", "extract", "regularize", "simplify", "assess", "simulate"}
VERBS |= {
    "detect",
    "clip",
    "filter",
    "downsample",
    "merge",
    "keep",
    "rasterize",
    "report",
    "register",
    "map",
    "compare",
    "update",
    "interpret",
    "reconstruct",
    "model",
    "export",
}
# Words that keep their capitals inside a title or label.
NAMES = {"Gauss", "Delaunay", "Shannon", "Hough", "3D"}
# Shares (0 to 1), multiples of what the data show, and limits of whatever dimension is named.
WITHOUT_UNIT = {
    "time_step",
    "low",
    "high",
    "deviations",
    "forest",
    "min_doubtful_share",
    "min_roof_share",
    "min_share_around",
    "holes",
    "leaves",
    "map_changes",
    "max_penetration",
    "min_overlap",
    "min_seen",
    "overlap",
    "walls",
}
# Sort points into kinds of their own, which are no classes of ASPRS.
OWN_CLASSES = {"classify_dimensionality"}
# Our own, after no publication.
WITHOUT_REFERENCES = {"simulate_plant", "simulate_town", "simulate_village", "simulate_street", "simulate_drone_site"}
WITHOUT_REFERENCES |= {
    "simulate_bridges",
    "simulate_tree",
    "simulate_power_line",
    "report_buildings",
    "reconstruct_pipes",
}
# Stems are scanned from the ground, and finer than the scene is; no building has gone from it; terrain has a tolerance.
WITHOUT_FEATURES = {"branches", "buildings_gone", "terrain"}
# Their layers have the attributes of the layer that they read after their own.
KEEPS_ATTRIBUTES = {
    **dict.fromkeys(("compute_building_heights", "regularize_polygons", "update_map"), ["id", "name"]),
    "extract_footprints": ["name", "review"],
}
# The layer of a review has decisions.
DECISIONS = {"reviewed": {"review": ["kept", None]}}
# Automatic tunables that matter only with another setting.
USED_WITH: dict[tuple[str, str], dict[str, Any]] = {
    ("compute_features", "radius"): {"neighborhood": "radius"},
    ("segment_planes_hough", "n_neighbors"): {"method": "normals"},
}
# Estimated again in each round: the log has the value of the last, and one value for all rounds is another surface.
ESTIMATED_IN_ROUNDS = {("classify_ground_tin_2000", "iteration_distance")}
# Read layers whose geometries have heights (m): roofs.
READS_HEIGHTS = {"assess_models": 6.0, "export_models": 6.0}

# Input layers with upright polygons: part of the southern wall of a house, by shares of its length, and heights (m).
UPRIGHT = {
    ("reconstruct_block", "facades"): (0.0, 1.0, 0.5, 4.0),
    ("reconstruct_block", "openings"): (0.4, 0.6, 2.0, 3.2),
}
# Tunables at which a stage that makes its own data is quick.
QUICK: dict[str, dict[str, Any]] = {
    "simulate_tree": {"height": 4.0, "dbh": 0.08, "n_branches": 2, "density": 300.0},
    "simulate_plant": {"pipes": 2, "tanks": 0, "spheres": 1, "density": 200.0},
    "filter_points": {"dimension": "Intensity"},
    "simulate_town": {"size": 80.0},
    "simulate_bridges": {"kind": "canal", "density": 1.0},
    "simulate_flight": {"duration": 10.0, "line_rate": 4.0},
    "simulate_village": {"size": 90.0, "density": 5.0},
    "segment_facade_lines": {"tolerance": 1.0},
    "simulate_street": {"length": 12.0, "line_rate": 10.0, "angular_step": 2.0, "houses": True},
    "simulate_drone_site": {"size": 40.0, "density": 5.0},
    "simulate_power_line": {"size": 80.0, "span": 50.0},
}

# As they are when tests are collected: tests of the provider add toys of their own while they run.
ALL = dict(STAGES)
ALL_PIPELINES = dict(PIPELINES)

TUNABLES = [
    pytest.param(stage, tunable, id=f"{stage.name}-{tunable.name}")
    for stage in ALL.values()
    for tunable in stage.tunables.values()
]
NUMBERS = [p for p in TUNABLES if p.values[1].type in (int, float)]
AUTOMATIC = [p for p in TUNABLES if p.values[1].is_optional]
each_stage = pytest.mark.parametrize("stage", ALL.values(), ids=lambda stage: stage.name)
each_reader = pytest.mark.parametrize(
    "stage", [stage for stage in ALL.values() if stage.reads_cloud], ids=lambda stage: stage.name
)
each_with_input = pytest.mark.parametrize(
    "stage", [stage for stage in ALL.values() if not stage.creates], ids=lambda stage: stage.name
)


# --- A scene that every stage can work on: all dimensions that some stage reads, as they would be read from a file.


def front(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return xy (n, 2), heights (n,) and which points (n,) are of a pane, of a wall of 10 m by 4 m along y = 38.

    It has 25 points per m² and an opening of 2 m by 2 m, whose pane lies 0.3 m behind it.
    """
    along, height = rng.uniform((8, 0), (18, 4), (1000, 2)).T
    is_pane = (along > 12) & (along < 14) & (height > 1.2) & (height < 3.2)
    xy = np.column_stack([along, 38.0 + 0.3 * is_pane + rng.normal(0, 0.02, len(along))])
    return np.round(xy * 1024) / 1024, height, is_pane


def tank(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Return xy (n, 2) and heights (n,) over the slope of an upright tank of 4 m with a half sphere on it."""
    angle = rng.uniform(0, 2 * np.pi, 2510)
    rise = np.concatenate([np.zeros(1880), rng.uniform(0, 1, 630)])
    reach = np.sqrt(1 - rise**2) * (2 + rng.normal(0, 0.02, len(angle)))
    xy = np.column_stack([36 + reach * np.cos(angle), 27 + reach * np.sin(angle)])
    xy = np.round(xy * 1024) / 1024
    elevation = np.where(rise > 0, 8 + 2 * rise, rng.uniform(2, 8, len(angle)))
    return xy, elevation - 0.05 * xy[:, 0]


def scanned(
    rng: np.random.Generator, west: float, south: float, width: float, depth: float, density: float
) -> np.ndarray:
    """Return xy (n, 2) at random over a rectangle, in steps of 1/1024 m, so that shifts lose no digit."""
    xy = rng.uniform((west, south), (west + width, south + depth), (round(width * depth * density), 2))
    return np.round(xy * 1024) / 1024


@lru_cache(maxsize=1)
def scene() -> dict[str, np.ndarray]:
    """A flat roof, a gable, a crown, a wall, a tank and two stray points on a slope of 40 m by 40 m, 4 to 12 per m²."""
    rng = np.random.default_rng(42)
    ground = scanned(rng, 0, 0, 40, 40, 4)
    houses = [scanned(rng, 5, 5, 12, 8, 6), scanned(rng, 22, 20, 9, 14, 6)]
    crown = scanned(rng, 28, 6, 6, 6, 12)
    for west, south, east, north in ((5, 5, 17, 13), (22, 20, 31, 34)):
        ground = ground[~((ground >= (west, south)) & (ground <= (east, north))).all(axis=1)]
    wall, wall_height, is_pane = front(np.random.default_rng(43))
    tank_xy, tank_height = tank(np.random.default_rng(44))
    parts = [ground, *houses, crown, np.array([[10.0, 30.0], [30.0, 15.0]]), wall, tank_xy]
    sizes = [len(part) for part in parts]
    xy = np.concatenate(parts)
    height = np.repeat([0.0, 4.0, 6.0, 0.0, 0.0, 0.0, 0.0], sizes)
    height[sum(sizes[:3]) : sum(sizes[:4])] = rng.uniform(2, 7, sizes[3])
    height[sum(sizes[:4]) : sum(sizes[:5])] = 60.0, -25.0
    height[sum(sizes[:5]) : sum(sizes[:6])] = wall_height
    height[sum(sizes[:6]) :] = tank_height
    is_gable = np.repeat(np.arange(len(sizes)) == 2, sizes)
    height[is_gable] = 6.75 - 0.5 * np.abs(xy[is_gable, 0] - 26.5)
    z = np.round((0.05 * xy[:, 0] + height + rng.normal(0, 0.02, len(xy))) * 1024) / 1024
    kind = np.repeat([0, 1, 2, 3, 4, 5, 6], sizes)
    classes = [
        PointClass.GROUND,
        PointClass.BUILDING,
        PointClass.BUILDING,
        PointClass.UNCLASSIFIED,
        PointClass.HIGH_NOISE,
        PointClass.UNCLASSIFIED,
        PointClass.UNCLASSIFIED,
    ]
    is_first = rng.random(len(xy)) < 0.5
    entropy = np.array([0.2, 0.3, 0.3, 0.9, 0.5, 0.5, 0.5])[kind] + rng.normal(0, 0.02, len(xy))
    cluster_id = np.array([0, 1, 2, 3, 0, 0, 0])[kind]
    segment_id = np.array([0, 1, 2, 3, 0, 4, 5])[kind]
    segment_id[np.flatnonzero(kind == 5)[is_pane]] = 0
    segment_id[is_gable & (xy[:, 0] > 26.5)] = 6
    # The edges of the flat roof are taken as its walls.
    to_edge = np.minimum(xy - (5, 5), (17, 13) - xy).min(axis=1)
    is_wall = (kind == 1) & (to_edge < 0.4)
    return {
        "xyz": np.column_stack([xy, z]),
        "classification": np.array(classes, np.uint8)[kind],
        "return_number": np.where((kind == 3) & ~is_first, 2, 1).astype(np.uint8),
        "number_of_returns": np.where(kind == 3, 2, 1).astype(np.uint8),
        "intensity": rng.integers(1, 1000, len(xy)).astype(np.uint16),
        "gps_time": np.arange(len(xy)) / 1024,
        "scan_angle": np.zeros(len(xy), np.float32),
        "scan_direction_flag": np.zeros(len(xy), np.uint8),
        "edge_of_flight_line": np.zeros(len(xy), np.uint8),
        "point_source_id": (np.arange(len(xy)) % 3).astype(np.uint16),
        "height_above_ground": height.astype(np.float32),
        "cluster_id": cluster_id.astype(np.int32),
        "earlier_class": np.array([2, 6, 6, 0, 18, 0, 0], np.uint8)[kind],
        "segment_id": segment_id.astype(np.int32),
        "shape": np.zeros(len(xy), np.uint8),
        "wall_of": is_wall.astype(np.int32),
        "voxel_count": np.ones(len(xy), np.uint32),
        "entropy": entropy.astype(np.float32),
        **{name: rng.random(len(xy)).astype(np.float32) for name in ("linearity", "planarity", "scattering")},
        "dimensionality": rng.integers(0, 4, len(xy)).astype(np.uint8),
        "cluster_entropy": np.array([np.nan, 0.3, 0.3, 0.9, np.nan, np.nan, np.nan], np.float32)[kind],
        "confidence": np.array([np.nan, 0.9, 0.9, 0.1, np.nan, np.nan, np.nan], np.float32)[kind],
        "reason": np.array([0, 2, 2, 11, 0, 0, 0], np.uint8)[kind],
        "weakest_evidence": np.array([0, 303800400, 303800400, 209120780, 0, 0, 0], np.uint32)[kind],
        "red": np.array([110, 150, 90, 60, 0, 200, 150], np.uint16)[kind] * 256,
        "green": np.array([120, 80, 90, 100, 0, 190, 150], np.uint16)[kind] * 256,
        "blue": np.array([90, 60, 95, 40, 0, 180, 150], np.uint16)[kind] * 256,
    }


def arrays_of(stage: Stage, dimensions: dict[str, np.ndarray]) -> list[Any]:
    """Return copies of what the stage's positional arguments name, locked against writing."""
    copies: list[Any] = []
    for name in (*stage.reads, *stage.optional):
        plain = name[len(REFERENCE_PREFIX) :] if name.startswith(REFERENCE_PREFIX) else name
        if name == VALUES:
            plain = named_by_default(stage)
        if not plain:
            copies.append(None)
            continue
        assert plain in dimensions, f"{stage.name} reads {plain}: give scene() that dimension"
        values = dimensions[plain].copy()
        values.flags.writeable = False
        copies.append(parts_of(values) if stage.merges else values)
    return copies


def named_by_default(stage: Stage) -> str:
    """Return the Python name of the dimension that the stage reads as ``values``, "" when it is none."""
    wanted = QUICK.get(stage.name, {}).get(DIMENSION, stage.tunables[DIMENSION].default)
    return next((name for name, one in DIMENSIONS.items() if wanted in (name, *one.disk)), "")


def parts_of(values: np.ndarray) -> list[np.ndarray]:
    """Return what a stage that merges is given of the scene: every other point, and the others."""
    return [values[::2], values[1::2]]


def upright(ring: np.ndarray, part: tuple[float, float, float, float]) -> np.ndarray:
    """Return the ring of a part of the wall over the southern edge of a ring: shares of it, and heights (m)."""
    first, last, low, high = part
    start, end = (ring[0] + share * (ring[1] - ring[0]) for share in (first, last))
    return np.array([(*start, low), (*end, low), (*end, high), (*start, high), (*start, low)])


def drawn(stage: Stage, shift: tuple[float, float] = (0.0, 0.0)) -> dict[str, LayerFeatures]:
    """Return a layer for each input layer of the stage: the houses of the scene, each layer a little further north."""
    boxes = ((5, 5, 17, 13), (22, 20, 31, 34))
    layers = {}
    for i, input_layer in enumerate(stage.input_layers):
        rings = [np.array([[w, s], [e, s], [e, n], [w, n], [w, s]], float) for w, s, e, n in boxes]
        rings = [ring + (0.0, 0.125 * i) + shift for ring in rings]
        if stage.name in READS_HEIGHTS:
            rings = [np.column_stack([ring, np.full(len(ring), READS_HEIGHTS[stage.name])]) for ring in rings]
        if (stage.name, input_layer.name) in UPRIGHT:
            rings = [upright(ring, UPRIGHT[stage.name, input_layer.name]) for ring in rings]
        shapes = {"Polygon": [[ring] for ring in rings], "LineString": rings, "Point": [ring[0] for ring in rings]}
        layers[input_layer.name] = LayerFeatures(
            shapes[input_layer.geometry],
            {"id": np.array([1, 2]), "name": ["one", None], **DECISIONS.get(input_layer.name, {})},
        )
    return layers


def made_by(
    stage: Stage,
    dimensions: dict[str, np.ndarray] | None = None,
    layers: dict[str, LayerFeatures] | None = None,
    **tunables: Any,
) -> tuple[StageResults, Monitor]:
    """Run the stage's function on the scene and return what it made and what it reported."""
    monitor = Monitor()
    given = {**(layers or drawn(stage)), **QUICK.get(stage.name, {}), **tunables}
    return stage.unpack(stage.function(*arrays_of(stage, dimensions or scene()), **given, monitor=monitor)), monitor


@cache
def made_by_default(name: str) -> tuple[StageResults, Monitor]:
    return made_by(ALL[name])


def made_with(stage: Stage, extra: dict[str, Any]) -> tuple[StageResults, Monitor]:
    """Return what a stage makes with some tunables, which runs once where there are none."""
    return made_by(stage, **extra) if extra else made_by_default(stage.name)


def results_of(made: StageResults) -> list:
    """Return all results in a row."""
    layers, rasters = made.layers.values(), made.rasters.values()
    return [made.selected, *made.dimensions.values(), *layers, *rasters, *made.files.values(), made.report]


def text_of(content: FileContent) -> str:
    """Return what a stage writes into a text file, in the first of its formats, on a map of meters."""
    stages = [stage for stage in ALL.values() if stage.files]
    called = [called for stage in stages for file in stage.files for called in file.formats]
    frame = MapFrame(np.asarray, "EPSG:25832", lambda coordinates: 1e-5 * coordinates)
    return "".join(str(piece) for one in dict.fromkeys(called) for piece in content.pieces(one, frame))


def are_same(made: StageResults, expected: StageResults) -> bool:
    """Whether two results of a stage are equal bit by bit."""
    try:
        assert_same(made, expected)
    except AssertionError:
        return False
    return True


def assert_same(made: StageResults, expected: StageResults) -> None:
    """Assert that two results of a stage are equal bit by bit."""
    for one, other in zip(results_of(made), results_of(expected)):
        if isinstance(one, LayerFeatures):
            assert one.columns.keys() == other.columns.keys()
            for name, column in one.columns.items():
                np.testing.assert_array_equal(np.asarray(column), np.asarray(other.columns[name]))
            flat, flat_other = ([v for g in features.geometries for v in g] for features in (one, other))
            assert len(flat) == len(flat_other)
            for ring, other_ring in zip(flat, flat_other):
                np.testing.assert_array_equal(ring, other_ring)
        elif isinstance(one, RasterSurface):
            np.testing.assert_array_equal(one.values, other.values)
            assert (one.west, one.north, one.cell_size) == (other.west, other.north, other.cell_size)
        elif isinstance(one, FileContent):
            assert text_of(one) == text_of(other)
        elif isinstance(one, Report):
            np.testing.assert_equal(one.values, other.values)
        elif one is None:
            assert other is None
        else:
            np.testing.assert_array_equal(one, other)


# --- The words.


def is_sentence_case(text: str) -> bool:
    """Whether only the first word has a capital, but for names and abbreviations (TIN, k-means, 3D)."""
    if text in NAMES:
        return True
    first, *others = re.findall(r"[^\W\d_][\w-]*", text)
    return text[0].isupper() and all(
        word.islower() or word in NAMES or (len(word) > 1 and word.isupper()) for word in others
    )


def is_sentences(text: str) -> bool:
    return text == text.strip() and (text[0].isupper() or not text[0].isalpha()) and text.endswith(".")


def test_sentence_case_is_recognized():
    assert is_sentence_case("Classify ground points of a TIN")
    assert not is_sentence_case("Classify Ground points")
    assert not is_sentence_case("classify ground points")


@each_stage
def test_name_is_a_verb_and_shows_what_is_set(stage):
    verb = stage.name.split("_")[0]
    assert verb in VERBS, f"choose a verb of the other stages: {', '.join(sorted(VERBS))}"
    # Points that are made of others have a class of theirs too.
    classifies = verb in CLASSIFYING and stage.name not in OWN_CLASSES
    assert stage.selects or stage.merges or classifies == ("classification" in stage.writes)


@each_stage
def test_title_group_and_tags_are_there(stage):
    assert is_sentence_case(stage.title)
    assert is_sentence_case(stage.group)
    icon = f"resources/icons/groups/{stage.group.replace(' ', '').lower()}.svg"
    assert (Path(__file__).parent.parent / icon).is_file(), f"{stage.group!r} is no group with an icon"
    assert [tag for tag in stage.tags.split(",") if tag.strip()]


@pytest.mark.parametrize(
    ("word", "names"),
    [
        ("powerline", ["classify_wires"]),
        ("citygml", ["reconstruct_roofs", "model_buildings"]),
        ("vegetation", ["classify_vegetation", "detect_buildings"]),
        ("water", ["classify_water", "detect_buildings"]),
        ("bridge", ["classify_bridges", "detect_buildings"]),
    ],
)
def test_toolbox_finds_what_users_type(word, names):
    declared = {**STAGES, **PIPELINES}
    for name in names:
        assert word in declared[name].tags.lower().split(",")


def quoted(path: Path) -> list[str]:
    """Return what the texts of a module put in single quotes with a capital: titles, as users read them."""
    nodes = ast.walk(ast.parse(path.read_text(encoding="utf-8")))
    texts = [node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)]
    found = [title for text in texts for title in re.findall(r"(?<!\w)'([A-Z][^'{}]*)'(?!\w)", text)]
    return [" ".join(title.split()) for title in found]


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: path.stem)
def test_titles_that_sentences_name_exist(path):
    """A sentence names a title as the toolbox shows it; stages cannot import each other to derive it."""
    ours = {one.title for one in (*STAGES.values(), *PIPELINES.values())}
    ours |= {tunable.label for stage in STAGES.values() for tunable in stage.tunables.values()}
    ours |= {setting.title.partition(" (")[0] for setting in SETTINGS.values()}
    assert not set(quoted(path)) - ours - TITLES_OF_QGIS - OPTIONS


@each_stage
def test_reach_is_a_distance(stage):
    """A function of the tunables gets them by name: ``lambda gap: gap`` would be given all of them."""
    reach = stage.reach_of({})
    assert isinstance(reach, (int, float)), f"{stage.name} reaches {reach!r}, which is no number of meters"
    assert reach >= 0


@pytest.mark.parametrize(("stage", "tunable"), TUNABLES)
def test_tunable_is_labeled_and_explained(stage, tunable):
    param = tunable.param
    assert is_sentence_case(tunable.label)
    assert not tunable.label.endswith((".", ":", ")"))
    assert param.help, f"the docstring of {stage.name} doesn't describe {tunable.name} under Other Parameters"
    assert is_sentences(param.help)
    assert [bool(param.automatic), bool(param.empty)].count(True) == tunable.is_optional
    assert not param.unset_text or param.unset_text.endswith(".")


@pytest.mark.parametrize(("stage", "tunable"), NUMBERS)
def test_number_has_bounds_and_a_unit_where_one_fits(stage, tunable):
    assert tunable.param.low is not None, "say what the smallest value is that makes sense"
    if tunable.type is float:
        assert bool(tunable.param.unit) != (tunable.name in WITHOUT_UNIT)


@each_stage
def test_dimensions_are_those_of_the_table(stage):
    for name in (*stage.reads, *stage.optional):
        plain = name[len(REFERENCE_PREFIX) :] if name.startswith(REFERENCE_PREFIX) else name
        assert plain in DIMENSIONS or plain == VALUES, f"cloud/dimensions.py has no {plain!r} to read"
    unknown = {*stage.writes, *stage.creates} - set(DIMENSIONS)
    assert not unknown, f"cloud/dimensions.py has no {unknown}: add a row"
    assert stage.makes_cloud or any((stage.layers, stage.rasters, stage.measures, stage.files)), (
        "the stage makes nothing"
    )


@each_stage
def test_layers_and_measures_are_labeled(stage):
    for layer in stage.layers:
        assert layer.geometry in {"Polygon", "LineString", "Point"}
        assert is_sentence_case(layer.title)
        assert all(field.help.strip() for field in layer.fields)
        assert len({field.name for field in layer.fields}) == len(layer.fields)
    for raster in stage.rasters:
        assert is_sentence_case(raster.title)
    for input_layer in stage.input_layers:
        assert input_layer.geometry in {"Polygon", "LineString", "Point"}
        assert is_sentence_case(input_layer.title)
        assert is_sentences(input_layer.help)
    made = [one.name for one in (*stage.layers, *stage.rasters)] + ["output", "report"]
    given = [input_layer.name for input_layer in stage.input_layers] + [*stage.tunables, "input", "inputs", "reference"]
    for names in (made + given, made + [measure.name for measure in stage.measures]):
        assert len(set(names)) == len(names), "inputs and outputs of an algorithm have names of their own"
    assert len({measure.name for measure in stage.measures}) == len(stage.measures)
    assert all(measure.title for measure in stage.measures)


@each_stage
def test_docstring_describes_what_comes_in_and_goes_out(stage):
    assert is_sentences(stage.summary)
    assert stage.section("Returns")
    for name in (*stage.reads, *stage.optional):
        assert re.search(rf"^(?:.*, )?{name}(?:, .*)? : .*shape", stage.section("Parameters"), re.MULTILINE), name
    for input_layer in stage.input_layers:
        assert re.search(
            rf"^(?:.*, )?{input_layer.name}(?:, .*)? : .*LayerFeatures", stage.section("Parameters"), re.MULTILINE
        )
    assert bool(stage.section("References")) != (stage.name in WITHOUT_REFERENCES)
    for name in stage.tunables:
        assert f"\n{name} : " in stage.function.__doc__
    # Coordinates are in every cloud, whether a stage moves them or not.
    none = re.findall(r"^(\w+) : .*, or None$", stage.section("Returns"), re.MULTILINE)
    assert [name for name in none if name != "xyz"] == list(stage.written_if), "the help says when they are written"


# --- The bounds.


def values_outside(tunable: Tunable) -> list:
    """Return values that the declaration excludes."""
    param = tunable.param
    if tunable.type is bool:
        return [1, "yes", None]
    if param.choices:
        wrong = "no such choice"
        return [(wrong,), wrong] if tunable.type is tuple else [wrong, 3]
    if tunable.type is str:
        return [3, None]
    outside: list = [math.nan, math.inf, -math.inf, "1", True, [1.0]]
    step = 1 if tunable.type is int else 1e-6
    if tunable.type is int:
        outside.append(tunable.default + 0.5 if tunable.default is not None else 1.5)
    if not tunable.is_optional:
        outside.append(None)
    if param.low is not None:
        outside.append(param.low if param.open_low else param.low - step)
    if param.high is not None:
        outside.append(param.high if param.open_high else param.high + step)
    return outside


@pytest.mark.parametrize(("stage", "tunable"), TUNABLES)
def test_bounds_refuse_with_a_sentence_that_names_the_tunable(stage, tunable):
    for value in values_outside(tunable):
        with pytest.raises(ValueError, match=re.escape(f"{tunable.label} ({tunable.name}) must be ")) as refusal:
            stage.check({tunable.name: value})
        shown = float(value) if tunable.type is float and isinstance(value, int) and value is not True else value
        assert str(refusal.value).endswith(f", got {shown!r}.")


@pytest.mark.parametrize(("stage", "tunable"), TUNABLES)
def test_function_refuses_like_the_declaration(stage, tunable):
    value = values_outside(tunable)[-1]
    with pytest.raises(ValueError, match=re.escape(f"({tunable.name}) must be ")):
        stage.function(*arrays_of(stage, scene()), **drawn(stage), **{tunable.name: value})


@pytest.mark.parametrize(("stage", "tunable"), TUNABLES)
def test_default_and_closed_bounds_pass(stage, tunable):
    param = tunable.param
    assert tunable.check(tunable.default) == tunable.default
    assert tunable.default is None or type(tunable.check(tunable.default)) is tunable.type
    if param.low is not None and not param.open_low:
        assert tunable.check(param.low) == param.low
    if param.high is not None and not param.open_high:
        assert tunable.check(param.high) == param.high


@each_stage
def test_unknown_tunable_is_refused_by_name(stage):
    with pytest.raises(ValueError, match=rf"{stage.name} has no tunable 'no_such'; it has "):
        stage.check({"no_such": 1})


def changed(arrays: Any, change) -> Any:
    """Return an argument changed; of several clouds, the first one's."""
    if arrays is None:
        return None
    return [change(arrays[0]), *arrays[1:]] if isinstance(arrays, list) else change(arrays)


@each_reader
def test_arrays_that_do_not_belong_together_are_refused(stage):
    arrays, layers = arrays_of(stage, scene()), drawn(stage)

    def nowhere(xyz):
        xyz = xyz.copy()
        xyz[3, 1] = np.nan
        return xyz

    if (*stage.reads, *stage.optional)[0].endswith("xyz"):
        with pytest.raises(ValueError, match=r"must be of shape \(n, 3\), got \(\d+, 2\)"):
            stage.function(changed(arrays[0], lambda xyz: xyz[:, :2]), *arrays[1:], **layers)
        with pytest.raises(ValueError, match=r"1 of \d+ points have coordinates that are not finite"):
            stage.function(changed(arrays[0], nowhere), *arrays[1:], **layers)
    with pytest.raises(ValueError, match=r"The (point|reference) cloud( 1)? has no points; choose another\."):
        stage.function(*(changed(array, lambda values: values[:0]) for array in arrays), **layers)
    for i, array in enumerate(arrays):
        if i and array is not None:
            shorter = changed(array, lambda values: values[:-1])
            with pytest.raises(ValueError, match=r"they must be of the same points\."):
                stage.function(*arrays[:i], shorter, *arrays[i + 1 :], **layers)


def one_point() -> dict[str, np.ndarray]:
    return {name: values[1000:1001] for name, values in scene().items()}


def one_place() -> dict[str, np.ndarray]:
    return {**one_hundred(), "xyz": np.full((100, 3), 7.0)}


def one_hundred() -> dict[str, np.ndarray]:
    return {name: values[1000:1100] for name, values in scene().items()}


def on_one_line() -> dict[str, np.ndarray]:
    return {**one_hundred(), "xyz": np.arange(100.0)[:, None] * [0.3, 0.4, 0.0] + [3.0, 5.0, 7.0]}


def all_noise() -> dict[str, np.ndarray]:
    return {**one_hundred(), "classification": np.full(100, PointClass.LOW_NOISE, np.uint8)}


@pytest.mark.parametrize("cloud", [one_point, one_place, on_one_line, all_noise], ids=lambda cloud: cloud.__name__)
@each_reader
def test_a_poor_cloud_has_a_result_or_is_refused_in_a_sentence(stage, cloud):
    refusal, made = "", StageResults()
    try:
        made, _ = made_by(stage, cloud())
    except ValueError as error:
        refusal = str(error)
    assert not refusal or is_sentences(refusal)
    if cloud is all_noise and not refusal and "classification" in stage.reads:
        assert_no_noise_found(stage, made)


def assert_no_noise_found(stage: Stage, made: StageResults) -> None:
    """Noise is of no segment, and no ground."""
    if "segment_id" in stage.writes:
        assert not made.dimensions["segment_id"].any()
    if "classification" in stage.writes and "noise" not in stage.name:
        classes = made.dimensions["classification"]
        is_restored = assert_restored(stage, all_noise(), classes)
        assert not (classes[~is_restored] == PointClass.GROUND).any()


def assert_restored(stage: Stage, cloud: dict[str, np.ndarray], classes: np.ndarray) -> np.ndarray:
    """A stage that puts classes back puts back what the cloud came with; return which points (n,) came with some."""
    if "earlier_class" not in stage.optional:
        return np.zeros(len(classes), bool)
    earlier = cloud["earlier_class"]
    np.testing.assert_array_equal(classes[earlier > 0], earlier[earlier > 0])
    return earlier > 0


RESTORING = [stage for stage in ALL.values() if "earlier_class" in stage.optional and "classification" in stage.writes]


@pytest.mark.parametrize("stage", RESTORING, ids=lambda stage: stage.name)
def test_a_stage_that_restores_gives_back_what_came_and_finds_nothing_of_its_own(stage):
    classes = made_by(stage, scene())[0].dimensions["classification"]
    is_restored = assert_restored(stage, scene(), classes)
    assert is_restored.any()
    assert not is_restored.all()
    came = scene()["classification"][~is_restored]
    is_changed = classes[~is_restored] != came
    assert (classes[~is_restored][is_changed] == PointClass.UNCLASSIFIED).all()


@pytest.mark.parametrize("stage", [stage for stage in ALL.values() if stage.merges], ids=lambda stage: stage.name)
def test_no_cloud_can_not_be_merged(stage):
    with pytest.raises(ValueError, match=rf"^{stage.title} needs a point cloud, got none; add one\.$"):
        stage.function(*(arrays and arrays[:0] for arrays in arrays_of(stage, scene())), **drawn(stage))


@each_with_input
def test_a_layer_that_is_needed_is_asked_for(stage):
    for input_layer in stage.input_layers:
        if input_layer.optional:
            continue
        layers = {**drawn(stage), input_layer.name: None}
        with pytest.raises(
            ValueError, match=re.escape(f"{input_layer.title} ({input_layer.name}) is missing; choose a layer.")
        ):
            stage.function(*arrays_of(stage, scene()), **layers)


# --- How the cloud was sampled.


SAMPLERS = [stage for stage in ALL.values() if stage.samples]


@pytest.mark.parametrize("stage", SAMPLERS, ids=lambda stage: stage.name)
def test_sampling_is_documented_and_no_tunable(stage):
    assert SAMPLING not in stage.tunables
    assert f"\n{SAMPLING} : CloudSampling" in stage.function.__doc__


@pytest.mark.parametrize("stage", SAMPLERS, ids=lambda stage: stage.name)
def test_a_sampling_that_is_given_is_the_one_that_counts(stage, monkeypatch):
    """A sampling of the same points changes nothing, and the stage measures none of its own besides."""
    settings = [more for (owner, _), more in USED_WITH.items() if owner == stage.name]
    extra = settings[0] if settings else {}
    expected = made_with(stage, extra)[0]
    classes = scene()["classification"] if "classification" in stage.reads else None
    given = CloudSampling.of(scene()["xyz"], classes)

    def refused(*_):
        raise AssertionError("the stage measures a sampling of its own")

    monkeypatch.setattr(CloudSampling, "of", refused)
    assert_same(made_by(stage, **extra, sampling=given)[0], expected)
    if not given.measured and not given.found:
        moved = CloudSampling(lambda: scene()["xyz"], corner=given.corner - 0.31)
        has_cells = not are_same(made_by(stage, **extra, sampling=moved)[0], expected)
        assert has_cells, "the stage asks for it and uses nothing of it"


# --- The results.


def points_of(stage: Stage, made: StageResults) -> np.ndarray:
    """Return which point of the scene each point of the result is."""
    points = np.arange(len(scene()["xyz"]))
    if stage.merges:
        return np.concatenate(parts_of(points))
    return points[made.selected] if stage.selects else points


def promised_dtype(name: str) -> np.dtype:
    return np.dtype(DIMENSIONS[name].dtype)


@each_stage
def test_results_have_the_promised_shape_and_dtype(stage):
    made, _ = made_by_default(stage.name)
    n = len(made.dimensions["xyz"]) if stage.creates else len(scene()["xyz"])
    if stage.selects:
        assert made.selected.dtype == np.int64
        assert len(np.unique(made.selected)) == len(made.selected) > 0, "the scene has points to keep"
        assert 0 <= made.selected.min() <= made.selected.max() < n
        n = len(made.selected)
    for name, values in made.dimensions.items():
        if values is None and not stage.creates:
            continue  # a choice of the user: not asked for
        components = len(DIMENSIONS[name].disk)
        assert values.shape == ((n,) if components == 1 else (n, components)), name
        assert np.can_cast(values.dtype, promised_dtype(name), "same_kind"), name
    for layer in stage.layers:
        features = made.layers[layer.name]
        assert isinstance(features, LayerFeatures)
        of_map = KEEPS_ATTRIBUTES.get(stage.name, [])
        assert list(features.columns) == [*(field.name for field in layer.fields), *of_map]
        assert all(len(column) == len(features) for column in features.columns.values())
        if layer.name not in WITHOUT_FEATURES:
            assert len(features) > 0, "the scene has something for every layer"
    for surface in made.rasters.values():
        assert isinstance(surface, RasterSurface)
        assert surface.values.dtype == np.float32
        assert surface.values.ndim == 2
        assert np.isfinite(surface.values).any(), "the scene has something for every raster"
        assert not np.isinf(surface.values).any()
        assert surface.cell_size > 0
    if stage.measures:
        assert isinstance(made.report, Report)
        assert set(made.report.values) == {measure.name for measure in stage.measures}
        assert "<html" in made.report.html
        assert "</html>" in made.report.html


def turn(ring: np.ndarray) -> np.ndarray:
    """Return the normal (3,) of a closed ring (m, 2 or 3), as long as twice its area, by Newell."""
    places = np.column_stack([ring, np.zeros((len(ring), 3 - ring.shape[1]))])
    places -= places[0]
    return np.cross(places[:-1], places[1:]).sum(axis=0)


@each_stage
def test_polygons_are_closed_and_turn_as_promised(stage):
    made, _ = made_by_default(stage.name)
    for layer in stage.layers:
        if layer.geometry != "Polygon":
            continue
        for rings in made.layers[layer.name].geometries:
            for i, ring in enumerate(rings):
                assert len(ring) >= 4
                np.testing.assert_array_equal(ring[0], ring[-1])
                if ring.shape[1] == 2:
                    doubled = turn(ring)[2]
                    assert (doubled > 0) == (i == 0), "exterior counterclockwise, holes clockwise"
                else:
                    # A wall has no area in plan: holes turn against the exterior, whichever way that one faces.
                    assert (turn(ring) @ turn(rings[0]) > 0) == (i == 0), "holes against the exterior"


def cloud_of_scene() -> Cloud:
    """Return the scene as a cloud of the steps of its coordinates, so that storing it rounds none."""
    cloud = create_cloud(scene())
    cloud.header.scale[:] = 1 / 1024
    cloud.set("xyz", scene()["xyz"])
    return cloud


def test_the_cloud_of_the_scene_is_the_scene():
    for name, values in scene().items():
        np.testing.assert_array_equal(cloud_of_scene().get(name), values, err_msg=name)


@each_stage
def test_runner_stores_what_the_stage_makes(stage):
    whole = cloud_of_scene() if stage.reads_cloud else None
    cloud = [whole.take(part) for part in parts_of(np.arange(len(whole)))] if stage.merges else whole
    reference = cloud_of_scene() if stage.reads_reference else None
    expected, _ = made_by_default(stage.name)
    outcome: Outcome = run_stage(stage, cloud, reference, input_layers=drawn(stage), **QUICK.get(stage.name, {}))
    for name, values in expected.dimensions.items():
        if name == "xyz" and values is not None:
            np.testing.assert_allclose(outcome.cloud.to_map(outcome.cloud.get(name)), values, rtol=0, atol=0.0006)
        elif values is not None:
            stored = outcome.cloud.get(name)
            assert stored.dtype == promised_dtype(name)
            np.testing.assert_array_equal(stored, values.astype(promised_dtype(name)))
    if stage.makes_cloud and not stage.creates and "intensity" not in stage.writes:
        np.testing.assert_array_equal(outcome.cloud.get("intensity"), scene()["intensity"][points_of(stage, expected)])
    assert set(outcome.layers) == {layer.name for layer in stage.layers}
    assert set(outcome.rasters) == {raster.name for raster in stage.rasters}
    assert (outcome.report is not None) == bool(stage.measures)


@pytest.mark.parametrize(("stage", "tunable"), AUTOMATIC)
def test_automatic_value_is_reported_and_is_one_that_could_be_given(stage, tunable):
    extra = USED_WITH.get((stage.name, tunable.name), {})
    made, monitor = made_with(stage, extra)
    assert tunable.name in monitor.values
    value = monitor.values[tunable.name]
    assert value is not None
    assert tunable.check(value) == value
    again, _ = made_by(stage, **extra, **{tunable.name: value})
    if (stage.name, tunable.name) not in ESTIMATED_IN_ROUNDS:
        assert_same(again, made)


@each_stage
def test_same_input_gives_the_same_result_and_progress_grows_from_0_to_1(stage):
    listener = Listening()
    again = stage.function(*arrays_of(stage, scene()), **drawn(stage), **QUICK.get(stage.name, {}), monitor=listener)
    assert_same(stage.unpack(again), made_by_default(stage.name)[0])
    assert listener.heard, "a stage without progress can't be stopped"
    assert all(0 <= fraction <= 1 for fraction in listener.heard)
    assert all(before <= after + 1e-9 for before, after in zip(listener.heard, listener.heard[1:]))


@each_stage
def test_stage_stops_when_it_is_cancelled(stage):
    with pytest.raises(Cancelled):
        stage.function(
            *arrays_of(stage, scene()), **drawn(stage), **QUICK.get(stage.name, {}), monitor=Listening(stop_at=0.0)
        )


# --- What must not matter.


def assert_alike(stage: Stage, made: StageResults, expected: StageResults) -> None:
    """Assert that layers, rasters and numbers of two results are equal but for rounding of coordinates."""
    for name, features in made.layers.items():
        assert len(features) == len(expected.layers[name])
    for name, surface in made.rasters.items():
        np.testing.assert_allclose(surface.values, expected.rasters[name].values, rtol=1e-4, atol=1e-4, err_msg=name)
    if stage.measures:
        assert made.report.values == pytest.approx(expected.report.values, rel=1e-6, nan_ok=True)


@each_with_input
def test_position_on_earth_does_not_matter(stage):
    shift = (2.0**19, 2.0**22)  # powers of two: the differences stay exactly the same
    far = dict(scene())
    far["xyz"] = far["xyz"] + (*shift, 0.0)
    made, expected = made_by(stage, far, drawn(stage, shift))[0], made_by_default(stage.name)[0]
    if stage.selects:
        np.testing.assert_array_equal(made.selected, expected.selected)
    for name, values in made.dimensions.items():
        if values is not None:
            near = values - (*shift, 0.0) if name == "xyz" else values
            np.testing.assert_allclose(near, expected.dimensions[name], rtol=1e-4, atol=1e-4, err_msg=name)
    for name, surface in made.rasters.items():
        wanted = expected.rasters[name]
        assert (surface.west - shift[0], surface.north - shift[1]) == pytest.approx((wanted.west, wanted.north))
    assert_alike(stage, made, expected)


@each_reader
def test_order_of_points_does_not_matter(stage):
    random = np.random.default_rng(7)
    order = np.arange(len(scene()["xyz"]))
    for part in parts_of(order) if stage.merges else [order]:
        part[:] = random.permutation(part)
    shuffled = {name: values[order] for name, values in scene().items()}
    made, expected = made_by(stage, shuffled)[0], made_by_default(stage.name)[0]
    points, wanted_points = order[points_of(stage, made)], points_of(stage, expected)
    here, there = np.argsort(points), np.argsort(wanted_points)
    np.testing.assert_array_equal(points[here], wanted_points[there])
    for name, found in made.dimensions.items():
        if found is None:
            continue
        values, wanted = found[here], expected.dimensions[name][there]
        if name.endswith("_id") and name != "point_source_id":
            pairs = np.unique(np.column_stack([values, wanted]), axis=0)
            assert len(pairs) == len(np.unique(values)) == len(np.unique(wanted)), "the same groups under other numbers"
            np.testing.assert_array_equal(values == 0, wanted == 0)
        else:
            np.testing.assert_allclose(values, wanted, rtol=1e-4, atol=1e-4, err_msg=name)
    assert_alike(stage, made, expected)
