import json
import re
from dataclasses import replace

import numpy as np
import pytest

from lidar_buildings.algorithms.models3d.cityjson import CITYJSON, CITYJSON_SEQ
from lidar_buildings.algorithms.models3d.reconstruct_roofs import reconstruct_roofs
from lidar_buildings.algorithms.models3d.wavefront import OBJ
from lidar_buildings.algorithms.stage import LayerFeatures, MapFrame, Monitor
from lidar_buildings.tests.roof_shapes import SHAPES, moved
from lidar_buildings.tests.solid_validity import assert_valid_cityjson, assert_valid_sequence, edges_of

ORIGIN = (600_000.0, 5_000_000.0)


def scene(shape, density=12.0, seed=0, turn=0.0, origin=(0.0, 0.0)):
    """Return points and classes of a house on level ground, and its footprint."""
    points, ring = shape.scanned(density, seed=seed, turn=turn, origin=origin)
    rng = np.random.default_rng(seed)
    around = np.column_stack([rng.uniform(-12, 26, (2000, 2)) + origin, rng.normal(0, 0.03, 2000)])
    xyz = np.concatenate([points, around])
    classes = np.repeat([6, 2], [len(points), len(around)]).astype(np.uint8)
    return xyz, classes, LayerFeatures([[ring]], {"id": np.array([7])})


def reconstructed(xyz, classes, footprints, **tunables):
    """Return the results of the stage by name, and its messages."""
    monitor = Monitor()
    made = reconstruct_roofs.stage.unpack(reconstruct_roofs(xyz, classes, footprints, monitor=monitor, **tunables))
    return made.layers, made.files, monitor


def written(files, name, called, crs="EPSG:28992", offset=(0.0, 0.0, 0.0)):
    return "".join(files[name].pieces(called, MapFrame(lambda local: np.asarray(local) + offset, crs)))


def corners_of(layers):
    return np.unique(np.concatenate([ring for rings in layers["roofs"].geometries for ring in rings]), axis=0)


def distances(places, others):
    return np.sqrt(((places[:, None] - others[None]) ** 2).sum(axis=2)).min(axis=1)


@pytest.mark.parametrize("name", SHAPES)
def test_ridges_eaves_and_corners_are_where_they_are(name):
    shape = SHAPES[name]
    layers, files, _ = reconstructed(*scene(shape, turn=20.0))
    facts = {key: values[0] for key, values in layers["buildings"].columns.items()}
    assert facts["level"] == "2.2", facts["reason"]
    assert corners_of(layers)[:, 2].max() == pytest.approx(shape.ridge, abs=0.05)
    assert corners_of(layers)[:, 2].min() == pytest.approx(shape.eave, abs=0.05)
    true = np.column_stack([moved(shape.corners, 20.0, (0, 0)), shape.corners[:, 2]])
    walls = np.concatenate([ring for rings in layers["walls"].geometries for ring in rings])
    assert distances(true, np.concatenate([corners_of(layers), walls])).max() < 0.15
    assert_valid_cityjson(written(files, "cityjson", CITYJSON))


@pytest.mark.parametrize("name", ["flat", "shed", "gable", "hip", "mansard", "steps"])
def test_roof_types(name):
    layers, _, _ = reconstructed(*scene(SHAPES[name]))
    assert layers["buildings"].columns["roof_type"] == [SHAPES[name].kind]


def test_faces_know_their_slope_direction_and_area():
    layers, _, _ = reconstructed(*scene(SHAPES["gable"]))
    roofs = layers["roofs"].columns
    assert sorted(np.round(roofs["azimuth"], -1)) == [0, 180] or sorted(np.round(roofs["azimuth"], -1)) == [180, 360]
    assert roofs["slope"] == pytest.approx([np.degrees(np.arctan(0.8))] * 2, abs=0.5)
    assert roofs["area"] == pytest.approx([12 * 4 * np.hypot(1, 0.8)] * 2, rel=0.01)
    assert roofs["building"] == ["7", "7"]
    # The noise of the points, 3 cm in height.
    assert roofs["rms"] == pytest.approx([0.03, 0.03], rel=0.1)
    assert sum(layers["walls"].columns["area"]) == pytest.approx(2 * 12 * 4 + 2 * 8 * 5.6, rel=0.02)
    assert layers["buildings"].columns["volume"] == pytest.approx([12 * 8 * 5.6], rel=0.02)


def test_usable_area_is_without_what_is_not_modelled():
    """A chimney of 1 m² is no face: its area is its face's still, but nothing can lie there."""
    xyz, classes, footprints = scene(SHAPES["gable"], density=20.0)
    slopes = reconstructed(xyz, classes, footprints)[0]["roofs"].columns
    assert slopes["usable_area"] == pytest.approx(slopes["area"], rel=0.01)
    is_chimney = (classes == 6) & (abs(xyz[:, :2] - (4.0, 2.0)) < (0.5, 0.5)).all(axis=1)
    assert is_chimney.sum() == pytest.approx(20, abs=6)
    xyz[is_chimney, 2] += 1.0
    roofs = reconstructed(xyz, classes, footprints)[0]["roofs"].columns
    assert roofs["area"] == pytest.approx(slopes["area"], rel=0.01)
    lost = np.subtract(roofs["area"], roofs["usable_area"])
    assert sorted(lost) == pytest.approx([0.0, np.hypot(1, 0.8)], abs=0.35)
    assert roofs["azimuth"][lost.argmax()] == pytest.approx(180, abs=2)


@pytest.mark.parametrize("density", [5.0, 20.0])
def test_level_roofs_know_the_height_of_their_parapet(density):
    """Sides of a rim of 0.3 m are faces or not; points on the wall of a higher neighbor are no rim."""
    xyz, classes, footprints = scene(SHAPES["flat"], density=density)
    x, y = xyz[:, :2].T
    assert np.isnan(reconstructed(xyz, classes, footprints)[0]["roofs"].columns["parapet"]).all()
    rim = (classes == 6) & (np.minimum.reduce([x, 12 - x, y, 8 - y]) < 0.3)
    raised = xyz + np.outer(rim, [0, 0, 0.45])
    roofs = reconstructed(raised, classes, footprints)[0]["roofs"].columns
    assert roofs["parapet"][np.argmax(roofs["area"])] == pytest.approx(0.45, abs=0.03)
    rng = np.random.default_rng(0)
    count = round(100 * density)
    wall = np.column_stack([rng.uniform(0, 12, count), rng.normal(0.1, 0.02, count), rng.uniform(6, 8.6, count)])
    beside = np.concatenate([xyz, wall]), np.append(classes, np.full(count, 6))
    assert np.isnan(reconstructed(*beside, footprints)[0]["roofs"].columns["parapet"]).all()
    gable = scene(SHAPES["gable"], density=density)
    assert np.isnan(reconstructed(*gable)[0]["roofs"].columns["parapet"]).all()


def test_simpler_levels_have_level_tops():
    scanned = scene(SHAPES["steps"])
    simple, _, _ = reconstructed(*scanned, level_of_detail="1.2", top_percentile=50.0)
    assert simple["buildings"].columns["level"] == ["1.2"]
    assert corners_of(simple)[:, 2] == pytest.approx(6.5, abs=0.03)
    parts, files, _ = reconstructed(*scanned, level_of_detail="1.3", min_step=2.0)
    assert sorted({round(z) for z in 2 * corners_of(parts)[:, 2]}) == [7, 13, 19]
    geometry = next(iter(assert_valid_cityjson(written(files, "cityjson", CITYJSON))["CityObjects"].values()))[
        "geometry"
    ]
    assert [one["lod"] for one in geometry] == ["1.2", "1.3"]
    merged, _, _ = reconstructed(*scanned, level_of_detail="1.3", min_step=3.5)
    assert len(merged["roofs"]) == 1


@pytest.mark.parametrize("name", ["dormer", "gable", "hip"])
def test_level_without_dormers_has_the_sides_of_the_roof(name):
    """A dormer of 4 m² is at level 2.2 only; below it the roof goes on."""
    scanned = scene(SHAPES[name], density=20.0)
    layers, files, _ = reconstructed(*scanned, level_of_detail="2.0")
    assert layers["buildings"].columns["level"] == ["2.0"]
    plain = SHAPES["gable" if name == "dormer" else name]
    fine = reconstructed(*scene(plain, density=20.0))[0]
    assert len(layers["roofs"]) == len(fine["roofs"]) == (4 if name == "hip" else 2)
    assert layers["buildings"].columns["volume"] == pytest.approx(fine["buildings"].columns["volume"], rel=0.01)
    text = written(files, "cityjson", CITYJSON)
    assert_valid_cityjson(text)
    assert [geometry["lod"] for one in json.loads(text)["CityObjects"].values() for geometry in one["geometry"]] == [
        "1.2",
        "1.3",
        "2.0",
    ]
    assert len(reconstructed(*scanned)[0]["roofs"]) == len(fine["roofs"]) + (name == "dormer")


def test_level_without_dormers_keeps_the_sides_of_small_roofs():
    shape = replace(
        SHAPES["gable"], outline=SHAPES["gable"].outline * 0.3, top=lambda x, y: 2 + 0.8 * np.minimum(y, 2.4 - y)
    )
    layers, _, _ = reconstructed(*scene(shape, density=40.0), level_of_detail="2.0")
    assert len(layers["roofs"]) == 2


def test_order_of_points_and_far_coordinates_change_nothing():
    xyz, classes, footprints = scene(SHAPES["hip"])
    here, _, _ = reconstructed(xyz, classes, footprints)
    order = np.random.default_rng(1).permutation(len(xyz))
    mixed, _, _ = reconstructed(xyz[order], classes[order], footprints)
    assert corners_of(mixed) == pytest.approx(corners_of(here), abs=1e-6)
    far = LayerFeatures([[footprints.geometries[0][0] + ORIGIN]], footprints.columns)
    there, _, _ = reconstructed(xyz + [*ORIGIN, 0.0], classes, far)
    assert corners_of(there) - [*ORIGIN, 0.0] == pytest.approx(corners_of(here), abs=0.01)


def test_cityjson_names_crs_and_place():
    _, files, _ = reconstructed(*scene(SHAPES["gable"]))
    whole = assert_valid_cityjson(written(files, "cityjson", CITYJSON, offset=(85_000.0, 446_000.0, 0.0)))
    assert whole["metadata"]["referenceSystem"] == "https://www.opengis.net/def/crs/EPSG/0/28992"
    assert whole["metadata"]["geographicalExtent"] == pytest.approx([85000, 446000, 0, 85012, 446008, 7.2], abs=0.05)
    places = np.array(whole["vertices"]) * whole["transform"]["scale"] + whole["transform"]["translate"]
    assert places.max(axis=0) == pytest.approx([85012, 446008, 7.2], abs=0.05)
    (name, building), *_ = whole["CityObjects"].items()
    assert re.fullmatch("7-[0-9a-f]{8}", name)
    assert building["attributes"]["roof_type"] == "gable"
    assert [geometry["lod"] for geometry in building["geometry"]] == ["1.2", "1.3", "2.2"]
    assert "referenceSystem" not in json.loads(written(files, "cityjson", CITYJSON, crs=""))["metadata"]


def test_cityjsonseq_has_a_line_per_building():
    one, two = scene(SHAPES["gable"]), scene(SHAPES["hip"], origin=(40.0, 0.0))
    xyz, classes = (np.concatenate(pair) for pair in zip(one[:2], two[:2]))
    # Parts of one footprint share its name.
    footprints = LayerFeatures(one[2].geometries + two[2].geometries, {"id": ["a b", "a b"]})
    _, files, _ = reconstructed(xyz, classes, footprints)
    _, *features = assert_valid_sequence(written(files, "cityjson", CITYJSON_SEQ))
    names = [feature["id"] for feature in features]
    assert all(re.fullmatch("a b-[0-9a-f]{8}", name) for name in names)
    assert names[0] != names[1]
    # Other houses of another file have other names.
    _, elsewhere, _ = reconstructed(*scene(SHAPES["gable"], origin=(80.0, 0.0)))
    assert next(iter(json.loads(written(elsewhere, "cityjson", CITYJSON))["CityObjects"])) not in names


def test_map_keys_and_attributes_are_kept():
    xyz, classes, footprints = scene(SHAPES["gable"])
    columns = {"lokaalid": ["NL.1"], "year": np.array([1652]), "height": np.array([np.nan]), "Level": ["old"]}
    house = LayerFeatures(footprints.geometries, {**columns, "surveyed": [None]})
    layers, files, _ = reconstructed(xyz, classes, house, id_field="lokaalid")
    facts = layers["buildings"].columns
    assert (facts["building"], facts["lokaalid"], facts["year"]) == (["NL.1"], ["NL.1"], [1652])
    assert (facts["height"], facts["map_Level"], facts["level"]) == ([None], ["old"], ["2.2"])
    ((name, building),) = assert_valid_cityjson(written(files, "cityjson", CITYJSON))["CityObjects"].items()
    assert (name, building["attributes"]["year"], building["attributes"]["surveyed"]) == ("NL.1", 1652, None)
    parts = LayerFeatures(footprints.geometries * 2, {"key": ["a", "a"]})
    _, files, _ = reconstructed(xyz, classes, parts, id_field="key")
    assert list(json.loads(written(files, "cityjson", CITYJSON))["CityObjects"]) == ["a", "a-2"]
    with pytest.raises(ValueError, match=re.escape("no attribute 'gid' (Identifier); choose one of lokaalid, year")):
        reconstructed(xyz, classes, house, id_field="gid")


def test_a_file_has_one_unit():
    """Vertices were in feet and heights in meters."""
    foot = 0.3048
    _, files, _ = reconstructed(*scene(SHAPES["gable"]))
    frame = MapFrame(lambda local: np.asarray(local) / foot, "EPSG:2225")
    whole = json.loads("".join(files["cityjson"].pieces(CITYJSON, frame)))
    (building,) = whole["CityObjects"].values()
    facts = building["attributes"]
    assert facts["eave_height"] == pytest.approx(4 / foot, abs=0.2)
    assert facts["volume"] == pytest.approx(12 * 8 * 5.6 / foot**3, rel=0.02)
    roofs = [surface for surface in building["geometry"][-1]["semantics"]["surfaces"] if "ridge" in surface]
    assert [surface["ridge"] for surface in roofs] == pytest.approx([7.2 / foot] * 2, abs=0.2)
    assert facts["check"] == 0


def test_eaves_and_ridge_mean_what_they_mean_for_footprints():
    """A quartile of the heights along the outline, and a percentile of the roof points: a chimney is no ridge."""
    xyz, classes, footprints = scene(SHAPES["gable"])
    chimney = np.array([[6.0, 4.0, 12.0]] * 5) + np.random.default_rng(0).uniform(0, 0.3, (5, 3))
    layers, _, _ = reconstructed(np.concatenate([xyz, chimney]), np.append(classes, [6] * 5), footprints)
    facts = layers["buildings"].columns
    assert facts["eave_height"] == pytest.approx([4.0], abs=0.1)
    assert facts["ridge_height"] == pytest.approx([np.percentile(xyz[classes == 6, 2], 98)], abs=0.06)


def test_wrecked_models_sort_apart():
    """Half of a gable's points lie 2 m higher than the planes that were found: leaves on it."""
    xyz, classes, footprints = scene(SHAPES["gable"])
    sound, _, _ = reconstructed(xyz, classes, footprints)
    rng = np.random.default_rng(1)
    leaves = (classes == 6) & (rng.random(len(xyz)) < 0.4)
    xyz[leaves, 2] += rng.uniform(1.0, 4.0, leaves.sum())
    wrecked, _, _ = reconstructed(xyz, classes, footprints)
    assert sound["buildings"].columns["check"] == [0]
    assert sound["buildings"].columns["off"][0] == 0
    assert wrecked["buildings"].columns["check"] == [2]
    assert wrecked["buildings"].columns["off"][0] > 0.25
    assert sound["buildings"].columns["gap_area"][0] < 10


@pytest.mark.parametrize("density", [4.0, 12.0])
def test_the_area_of_a_hole_is_measured(density):
    """Cells that reach beyond the outline counted whole, and hid a hole of a seventh of the roof."""
    points, ring = SHAPES["gable"].scanned(density)
    hole = np.hypot(*(points[:, :2] - [6.0, 4.0]).T) < 2.14
    ground = np.random.default_rng(0).uniform((-5, -5, 0), (17, 13, 0), (1500, 3))
    xyz = np.concatenate([points[~hole], ground])
    classes = np.repeat([6, 2], [np.sum(~hole), len(ground)]).astype(np.uint8)
    layers, _, _ = reconstructed(xyz, classes, LayerFeatures([[ring]], {"id": [1]}))
    facts = layers["buildings"].columns
    # Cells are two spacings wide: up to half of those that the edge of the hole crosses may count as full.
    edge = 2 * np.pi * 2.14 * 2 / np.sqrt(density) / 2
    assert facts["gap_area"] == pytest.approx([np.pi * 2.14**2], abs=edge)
    assert facts["covered"] == pytest.approx([1 - facts["gap_area"][0] / 96], abs=0.01)


def test_keys_of_sixteen_digits_are_whole_where_others_are_missing():
    xyz, classes, footprints = scene(SHAPES["gable"])
    beside = [[footprints.geometries[0][0] + 40.0]]
    house = LayerFeatures(footprints.geometries + beside, {"key": np.array([1680100000012345.0, np.nan])})
    layers, files, _ = reconstructed(xyz, classes, house, id_field="key")
    assert layers["buildings"].columns["building"] == ["1680100000012345"]
    assert list(json.loads(written(files, "cityjson", CITYJSON))["CityObjects"]) == ["1680100000012345"]


def test_five_points_make_no_model():
    xyz, classes, footprints = scene(SHAPES["flat"])
    few = np.flatnonzero(classes == 6)[::230]
    rows = np.concatenate([few, np.flatnonzero(classes == 2)])
    away = LayerFeatures([*footprints.geometries, [footprints.geometries[0][0] + 40.0]], {"id": [1, 2]})
    dense = xyz[classes == 6] + [40.0, 40.0, 0.0]
    layers, _, monitor = reconstructed(
        np.concatenate([xyz[rows], dense]), np.append(classes[rows], [6] * len(dense)), away
    )
    assert layers["buildings"].columns["building"] == ["2"]
    assert any("1 of 2 footprints have no points of buildings over them, or hardly any" in w for w in monitor.warnings)


def test_a_gable_with_a_lean_to_is_a_gable():
    shape = SHAPES["gable"]
    xyz, classes, _ = scene(shape)
    rng = np.random.default_rng(4)
    xy = rng.uniform((12, 2), (14, 5), (80, 2))
    lean_to = np.column_stack([xy, 3.0 - 0.3 * (xy[:, 0] - 12)])
    ring = np.array([[0, 0], [12, 0], [12, 2], [14, 2], [14, 5], [12, 5], [12, 8], [0, 8], [0, 0]], float)
    features = LayerFeatures([[ring]], {"id": [1]})
    layers, _, _ = reconstructed(np.concatenate([xyz, lean_to]), np.append(classes, [6] * 80), features)
    assert len(layers["roofs"]) == 3
    assert layers["buildings"].columns["roof_type"] == ["gable"]


def test_obj_is_closed():
    _, files, _ = reconstructed(*scene(SHAPES["dormer"]))
    lines = written(files, "obj", OBJ, offset=(85_000.0, 446_000.0, 0.0)).splitlines()
    assert lines[1] == "# offset 85000 446000 0"
    places = [[float(value) for value in line.split()[1:]] for line in lines if line.startswith("v ")]
    assert np.array(places)[:, :2].max() == pytest.approx(12, abs=0.01)
    faces = [[int(value) for value in line.split()[1:]] for line in lines if line.startswith("f ")]
    edges = edges_of(faces)
    assert len(set(edges)) == len(edges)
    assert {(b, a) for a, b in edges} == set(edges)
    assert {line for line in lines if line.startswith("g ")} == {"g ground", "g roof", "g wall"}


def test_cloud_without_buildings_is_refused():
    xyz, classes, footprints = scene(SHAPES["flat"])
    with pytest.raises(ValueError, match=re.escape("No point is called building (class 6); run 'Detect buildings'")):
        reconstructed(xyz, np.full(len(classes), 2, np.uint8), footprints)


def test_cloud_without_ground_is_refused():
    xyz, classes, footprints = scene(SHAPES["flat"])
    with pytest.raises(ValueError, match=re.escape("No point is called ground (class 2); run 'Classify ground points")):
        reconstructed(xyz[classes == 6], classes[classes == 6], footprints)


def test_footprints_without_points_or_area_are_counted():
    xyz, classes, footprints = scene(SHAPES["flat"])
    ring = footprints.geometries[0][0]
    geometries = [[ring], [ring + 500.0], [np.repeat(ring[:1], 4, axis=0)]]
    layers, _, monitor = reconstructed(xyz, classes, LayerFeatures(geometries, {"id": [1, 2, 3]}))
    assert layers["buildings"].columns["building"] == ["1"]
    assert any("1 of 3 footprints have no area" in warning for warning in monitor.warnings)
    assert any("1 of 2 footprints have no points" in warning for warning in monitor.warnings)
    with pytest.raises(ValueError, match="None of the 1 footprints has an area"):
        reconstructed(xyz, classes, LayerFeatures(geometries[2:], {"id": [3]}))


def test_a_roof_below_the_ground_beside_it_has_no_model_and_the_reason_is_reported():
    """Two footprints of one name: one is a house, the other lies on a hill of 20 m that is called building."""
    xyz, classes, footprints = scene(SHAPES["gable"])
    sunk = xyz + [100.0, 0.0, 0.0]
    sunk[classes == 2, 2] += 20.0
    rings = [footprints.geometries[0], [footprints.geometries[0][0] + [100.0, 0.0]]]
    twice = LayerFeatures(rings, {"id": np.array([7, 7])})
    layers, _, monitor = reconstructed(np.concatenate([xyz, sunk]), np.tile(classes, 2), twice)
    assert len(layers["buildings"]) == 1
    (warning,) = monitor.warnings
    assert "1 of 2 footprints have points but no model" in warning
    assert "its roof is not above the ground next to it" in warning


def test_footprint_that_crosses_itself_gives_valid_solids():
    xyz, classes, _ = scene(SHAPES["flat"])
    # Two triangles that touch in a point, one of them larger.
    bow = np.array([[0, 0], [12, 8], [12, 0], [0, 6], [0, 0]], float)
    layers, files, _ = reconstructed(xyz, classes, LayerFeatures([[bow]], {"id": [1]}))
    (building,) = assert_valid_cityjson(written(files, "cityjson", CITYJSON))["CityObjects"].values()
    assert {geometry["type"] for geometry in building["geometry"]} == {"MultiSolid"}
    share = 6 / 14
    area = 0.5 * 6 * 12 * share + 0.5 * 8 * 12 * (1 - share)
    assert layers["buildings"].columns["volume"] == pytest.approx([6 * area], rel=0.01)


def test_roof_with_a_court_and_a_tower_in_it():
    """A hole of the footprint, and a part that touches no outline."""
    rng = np.random.default_rng(3)
    xy = rng.uniform(0, 20, (8000, 2))
    in_court = (np.abs(xy - 5) < 2).all(axis=1)
    z = np.where((np.abs(xy - 14) < 2).all(axis=1), 12.0, 6.0) + rng.normal(0, 0.03, len(xy))
    ring = np.array([[0, 0], [20, 0], [20, 20], [0, 20], [0, 0]], float)
    court = np.array([[3, 3], [3, 7], [7, 7], [7, 3], [3, 3]], float)
    xyz = np.column_stack([xy, z])[~in_court]
    footprints = LayerFeatures([[ring, court]], {"id": [1]})
    ground = np.column_stack([rng.uniform(-5, 25, (500, 2)), np.zeros(500)])
    classes = np.repeat([6, 2], [len(xyz), 500]).astype(np.uint8)
    layers, files, _ = reconstructed(np.concatenate([xyz, ground]), classes, footprints)
    assert_valid_cityjson(written(files, "cityjson", CITYJSON))
    assert layers["buildings"].columns["level"] == ["2.2"]
    assert layers["buildings"].columns["volume"] == pytest.approx([6 * (400 - 16) + 6 * 16], rel=0.01)
    assert sorted(len(rings) for rings in layers["roofs"].geometries) == [1, 3]
    objects = written(files, "obj", OBJ).splitlines()
    faces = [[int(value) for value in line.split()[1:]] for line in objects if line.startswith("f ")]
    places = np.array([[float(v) for v in line.split()[1:]] for line in objects if line.startswith("v ")])
    top = [face for face in faces if np.allclose(places[np.array(face) - 1, 2], 6, atol=0.02)]
    area = sum(np.cross(places[b - 1] - places[a - 1], places[c - 1] - places[a - 1])[2] / 2 for a, b, c in top)
    assert area == pytest.approx(400 - 16 - 16, rel=0.01)
