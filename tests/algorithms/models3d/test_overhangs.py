"""Eaves that overhang the walls: level 2.3."""

import json

import numpy as np
import pytest

from lidar_buildings.algorithms.export.cityjson_faces import read_cityjson
from lidar_buildings.algorithms.export.export_models import export_models
from lidar_buildings.algorithms.export.gltf import glb
from lidar_buildings.algorithms.geometry.rings import distances_to_rings, polygon_area
from lidar_buildings.algorithms.models3d import overhangs as overhangs_module
from lidar_buildings.algorithms.models3d.building_facts import NamedModel
from lidar_buildings.algorithms.models3d.cityjson import CITYJSON
from lidar_buildings.algorithms.models3d.reconstruct_roofs import reconstruct_roofs
from lidar_buildings.algorithms.stage import LayerFeatures, MapFrame, Monitor
from lidar_buildings.tests.overhanging_roofs import OVERHANG, THICKNESS, inset, overhanging
from lidar_buildings.tests.roof_shapes import SHAPES
from lidar_buildings.tests.solid_validity import assert_valid_cityjson, newell


def modelled(xyz, classes, footprints, level="2.3", **tunables):
    """Return the layers of the stage by name, the models, and the text of CityJSON, which is valid."""
    made = reconstruct_roofs(xyz, classes, footprints, level_of_detail=level, monitor=Monitor(), **tunables)
    made = reconstruct_roofs.stage.unpack(made)
    text = "".join(made.files["cityjson"].pieces(CITYJSON, MapFrame(np.asarray, "EPSG:28992")))
    assert_valid_cityjson(text)
    return made.layers, [one for one in made.files["cityjson"].items if not one.is_terrain], text


@pytest.mark.parametrize("turn", [0.0, 33.0])
@pytest.mark.parametrize("name", ["flat", "shed", "gable", "hip", "steps", "L", "dormer"])
def test_walls_are_where_they_were_seen_under_the_roof_of_level_2_2(name, turn):
    scanned = overhanging(SHAPES[name], turn)
    plain, (fine,), _ = modelled(*scanned, level="2.2")
    layers, (one,), _ = modelled(*scanned)
    assert one.model.level == "2.3", one.model.reason
    assert list(one.model.solids) == ["1.2", "1.3", "2.2", "2.3"]
    assert sorted(layers["roofs"].columns["area"]) == pytest.approx(sorted(plain["roofs"].columns["area"]), rel=0.003)
    assert layers["buildings"].columns["roof_type"] == plain["buildings"].columns["roof_type"]
    for column in ("eave_height", "roof_area", "check", "rms"):
        assert layers["buildings"].columns[column] == pytest.approx(
            plain["buildings"].columns[column], abs=0.01, rel=0.003
        )
    (outline,) = scanned[2].geometries[0]
    corners = np.concatenate([ring[:, :2] for ring in layers["buildings"].geometries[0]])
    # A corner that points inward is as far from the one of the roof as the diagonal of a square.
    off = np.abs(distances_to_rings(corners, [outline])[:, None] - [OVERHANG, OVERHANG * 2**0.5]).min(axis=1)
    assert off.max() < 0.03
    kinds = layers["walls"].columns["kind"]
    assert {"wall", "soffit"} == set(kinds)
    soffits = [rings for rings, kind in zip(layers["walls"].geometries, kinds) if kind == "soffit"]
    under = sum(-newell(ring[:-1])[2] for rings in soffits for ring in rings)
    ground = polygon_area([ring[:, :2] for ring in layers["buildings"].geometries[0]])
    assert under + ground == pytest.approx(polygon_area([outline]), rel=1e-3)


def test_what_is_below_the_eaves_is_cut_out_of_the_solid():
    scanned = overhanging(SHAPES["gable"])
    _, (one,), _ = modelled(*scanned)
    (fine,), (solid,) = one.model.solids["2.2"], one.model.solids["2.3"]
    x, y = (np.mgrid[0:12:0.01, 0:8:0.01] + 0.005).reshape(2, -1)
    is_eave = np.minimum.reduce([x, 12 - x, y, 8 - y]) < OVERHANG
    below = (SHAPES["gable"].top(x, y) - THICKNESS - one.model.base)[is_eave].sum() * 0.01**2
    assert fine.volume - solid.volume == pytest.approx(below, rel=0.03)
    walls, soffits, roofs = ([f for f, k in enumerate(solid.kinds) if k == kind] for kind in ("wall", "soffit", "roof"))
    assert len(soffits) == 2
    assert len(walls) == 4 + 4
    across = [
        {k: v / np.linalg.norm(v) for k, v in enumerate(solid.normals) if k in faces} for faces in (soffits, roofs)
    ]
    assert all(min(np.abs(one + other).max() for other in across[1].values()) < 1e-3 for one in across[0].values())


def test_sides_without_a_wall_and_sides_with_a_neighbor_do_not_overhang():
    xyz, classes, footprints = overhanging(SHAPES["flat"], seen=(0, 1))
    rng = np.random.default_rng(1)
    # The house next door, beyond the easting of 12 m, is as high.
    neighbor = np.column_stack([rng.uniform((12.05, 0), (18, 8), (700, 2)), rng.normal(6, 0.03, 700)])
    layers, _, _ = modelled(xyz, classes, footprints)
    assert layers["buildings"].geometries[0][0][:, :2].min(axis=0) == pytest.approx([0.0, OVERHANG], abs=0.03)
    assert layers["buildings"].geometries[0][0][:, :2].max(axis=0) == pytest.approx([12 - OVERHANG, 8.0], abs=0.03)
    beside = np.concatenate([xyz, neighbor]), np.append(classes, np.full(700, 6, np.uint8))
    layers, _, _ = modelled(*beside, footprints)
    assert layers["buildings"].geometries[0][0][:, 0].max() == 12.0
    assert layers["buildings"].geometries[0][0][:, 1].min() == pytest.approx(OVERHANG, abs=0.03)


def test_the_rim_of_a_roof_beyond_its_outline_is_no_house_next_door():
    """The outline lies 0.2 m inside of the edge that the points show, as many maps have it."""
    xyz, classes, footprints = overhanging(SHAPES["flat"])
    ((ring,),) = footprints.geometries
    drawn = ring - 0.2 * np.sign(ring - ring[:-1].mean(axis=0))
    layers, (one,), _ = modelled(xyz, classes, LayerFeatures([[drawn]], footprints.columns))
    assert one.model.level == "2.3", one.model.reason
    low, high = (getattr(ring[:-1], end)(axis=0) for end in ("min", "max"))
    corners = layers["buildings"].geometries[0][0][:, :2]
    assert corners.min(axis=0) == pytest.approx(low + OVERHANG, abs=0.03)
    assert corners.max(axis=0) == pytest.approx(high - OVERHANG, abs=0.03)


@pytest.mark.parametrize("seen", ["nothing", "points at all distances", "less than half", "a wall close to the eave"])
def test_without_a_wall_a_building_stays_at_level_2_2_and_is_sound(seen):
    xyz, classes, footprints = overhanging(SHAPES["gable"], seen=())
    rng = np.random.default_rng(2)
    end = {"nothing": 0.1, "less than half": 5.0}.get(seen, 12.0)
    positions = inset(np.array([0.0, 0.0]), np.array([end, 0.0]))
    if seen == "points at all distances":
        positions[:, 1] = rng.uniform(0.0, 1.2, len(positions))
    elif seen == "a wall close to the eave":
        positions[:, 1] = rng.normal(0.12, 0.02, len(positions))
    more = np.column_stack([positions, rng.uniform(0.6, 3.0, len(positions))])
    xyz, classes = np.concatenate([xyz, more]), np.append(classes, np.full(len(more), 6, np.uint8))
    layers, (one,), _ = modelled(xyz, classes, footprints)
    facts = {name: column[0] for name, column in layers["buildings"].columns.items()}
    assert (facts["level"], facts["reason"]) == ("2.2", "2.3: no wall was seen under an overhanging eave")
    assert facts["check"] == 0
    assert "2.3" not in one.model.solids
    assert set(layers["walls"].columns["kind"]) == {"wall"}


@pytest.mark.parametrize(("bend", "off"), [(7, 0.0), (15, 1.87)])
def test_walls_that_hardly_turn_have_a_step_where_one_overhang_ends(bend, off):
    """Their lines intersect meters away from the corner of the roof, the farther the less they turn (°)."""
    end = 20 + 20 * np.cos(np.radians(bend)), 20 * np.sin(np.radians(bend))
    ring = np.array([[0, 0], [20, 0], end, [30, 20], [0, 20], [0, 0]])
    made = overhangs_module._set_back(ring, np.array([OVERHANG, 0.0, 0.0, 0.0, 0.0]))
    assert made[np.isclose(made[:, 1], OVERHANG), 0].max() == pytest.approx(20 + off, abs=0.01)


def test_a_step_as_high_as_the_roof_is_thick_crosses_an_eave():
    """The step between two roofs falls from 0.4 to 0.1 m over the eave: one's roof meets the other one's soffit."""
    shape = SHAPES["flat"]

    def top(x, y):
        return np.where(x < 6, 6.0, 5.6 + 0.6 * y)

    xyz, classes, footprints = overhanging(shape)
    is_roof = (classes == 6) & (xyz[:, 2] > 4)
    xyz[is_roof, 2] = top(*xyz[is_roof, :2].T) + np.random.default_rng(0).normal(0, 0.01, is_roof.sum())
    _, (one,), _ = modelled(xyz, classes, footprints)
    assert one.model.level == "2.3", one.model.reason


def test_walls_set_back_end_on_the_terrain_that_goes_on_below_the_eaves():
    xyz, classes, footprints = overhanging(SHAPES["L"], turn=20.0)
    xyz[:, 2] += 0.05 * xyz[:, 0]
    layers, (one,), _ = modelled(xyz, classes, footprints, terrain_tolerance=0.1)
    assert one.model.level == "2.3", one.model.reason
    nodes = {tuple(row) for (ring,) in layers["terrain"].geometries for row in np.round(ring, 4).tolist()}
    (solid,) = one.model.best
    grounds = [ring for (ring, *_), kind in zip(solid.faces, solid.kinds) if kind == "ground"]
    assert len(grounds) > 1
    assert {tuple(row) for ring in grounds for row in np.round(solid.vertices[ring], 4).tolist()} <= nodes
    area = sum(newell(ring[:-1])[2] for (ring,) in layers["terrain"].geometries)
    ground = polygon_area([ring[:, :2] for ring in one.rings])
    assert area + ground == pytest.approx(60**2, rel=0.01)
    assert ground < polygon_area(footprints.geometries[0]) - 10


def test_soffits_are_exported_and_kept():
    layers, (one,), text = modelled(*overhanging(SHAPES["gable"]))
    walls = layers["walls"].columns
    assert [kind == "soffit" for kind in walls["kind"]] == np.isnan(walls["azimuth"]).tolist()
    coarser, *_ = modelled(*overhanging(SHAPES["gable"]), level="2.2")
    eave, expected = (some["buildings"].columns["eave_height"][0] for some in (layers, coarser))
    assert eave == pytest.approx(expected, abs=1e-9)
    (building,) = json.loads(text)["CityObjects"].values()
    surfaces = building["geometry"][-1]["semantics"]["surfaces"]
    assert building["geometry"][-1]["lod"] == "2.3"
    assert [surface["type"] for surface in surfaces].count("OuterCeilingSurface") == 2
    rows, _ = read_cityjson(text)
    for given in ({"cityjson": rows}, {name: layers[name] for name in ("buildings", "walls", "roofs")}):
        (model,), *_ = export_models(**given, monitor=Monitor())
        assert [face.kind for face in model.best].count("soffit") == 2
        assert b"soffit" in glb([model], "2.3", np.asarray)
    again = NamedModel.of_record(json.loads(json.dumps(one.record())), one.name)
    assert again.model.best[0].kinds == one.model.best[0].kinds
