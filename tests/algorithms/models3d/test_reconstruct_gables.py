"""Gable houses whose fifteen parameters are known."""

import json

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.models3d.reconstruct_gables import reconstruct_gables
from lidar_buildings.algorithms.models3d.solid_faults import fault_of
from lidar_buildings.algorithms.stage import MapFrame, Monitor
from lidar_buildings.tests.builders import FAR, turned

# A house of 12 m by 8 m: ridge at 9 m, eaves at 6 m, ground at 1 m.
RIDGE, EAVES, GROUND = 9.0, 6.0, 1.0
TRUE = {
    "ridge": [[0, 0, RIDGE], [12, 0, RIDGE]],
    "eaves": [[x, y, EAVES] for x in (0, 12) for y in (-4, 4)],
    "feet": [[x, y, GROUND] for x in (0, 12) for y in (-4, 4)],
}


def house(rng, density=12, noise=0.03):
    """Return coordinates, classes and planes of the roof of a house and the ground around it."""
    roof = rng.uniform((0, -4), (12, 4), (12 * 8 * density, 2))
    ground = rng.uniform((-8, -12), (20, 12), (28 * 24 * 4, 2))
    ground = ground[(np.abs(ground[:, 0] - 6) > 6) | (np.abs(ground[:, 1]) > 4)]
    z = np.concatenate([RIDGE - 0.75 * np.abs(roof[:, 1]), np.full(len(ground), GROUND)])
    xyz = np.column_stack([np.concatenate([roof, ground]), z + rng.normal(0, noise, len(z))])
    classes = np.repeat([PointClass.BUILDING, PointClass.GROUND], [len(roof), len(ground)]).astype(np.uint8)
    plane = np.zeros(len(xyz), np.int32)
    plane[: len(roof)] = np.where(roof[:, 1] < 0, 1, 2)
    return xyz, classes, plane


def gables_of(*arrays, **tunables):
    """Return the layer of gables."""
    return reconstruct_gables(*arrays, **tunables)[0]


def vertices_of(gables):
    return np.unique(np.concatenate([ring for (ring,) in gables.geometries]).round(6), axis=0)


def test_ten_vertices_lie_where_they_are(rng):
    """Heights within 5 cm, corners within 15 cm, at 12 points per m² with 3 cm of noise."""
    gables = gables_of(*house(rng))
    found = vertices_of(gables)
    assert len(found) == 10
    for true in TRUE.values():
        distance = np.linalg.norm(found[:, None] - np.array(true, float), axis=2)
        assert distance.min(axis=0).max() < 0.15
    for name, elevation in (("z1", RIDGE), ("z3", EAVES), ("z7", GROUND)):
        assert gables.columns[name] == pytest.approx([elevation] * 7, abs=0.05)
    assert gables.columns["rms"][0] == pytest.approx(0.03 * 0.8, rel=0.1)


def test_parameters_are_the_vertices_of_the_paper(rng):
    """1 and 2 end the ridge, 3 and 4 one eave, 5 and 6 the other; 1, 3 and 6 are at one end."""
    gables = gables_of(*house(rng))
    plan = np.array([[gables.columns[f"{axis}{k}"][0] for axis in "xy"] for k in range(1, 7)])
    assert np.abs(plan[:2, 1]).max() < 0.1
    np.testing.assert_allclose(plan[0], (plan[2] + plan[5]) / 2, atol=0.1)
    np.testing.assert_allclose(plan[1], (plan[3] + plan[4]) / 2, atol=0.1)
    assert (plan[2, 1] > 0) == (plan[3, 1] > 0) != (plan[4, 1] > 0)


def test_faces_close_a_solid_and_face_outward(rng):
    """Each edge is run once in either direction, and the volume by the divergence theorem is the house's."""
    gables = gables_of(*house(rng))
    edges = [
        (tuple(a), tuple(b)) for (ring,) in gables.geometries for a, b in zip(ring[:-1].round(6), ring[1:].round(6))
    ]
    assert len(set(edges)) == len(edges)
    assert {(b, a) for a, b in edges} == set(edges)
    volume = 0.0
    for (ring,) in gables.geometries:
        for b, c in zip(ring[1:-2], ring[2:-1]):
            volume += float(ring[0] @ np.cross(b, c)) / 6
    assert volume == pytest.approx(12 * 8 * (5 + 1.5), rel=0.03)
    assert sum(a for a, kind in zip(gables.columns["area"], gables.columns["kind"]) if kind == "roof") == pytest.approx(
        2 * 12 * 5, rel=0.02
    )


def test_faces_are_planar(rng):
    for (ring,) in gables_of(*house(rng)).geometries:
        places = ring[:-1] - ring[:-1].mean(axis=0)
        assert np.linalg.svd(places)[1][2] < 1e-9


def test_position_turn_and_order_change_nothing(rng):
    xyz, classes, plane = house(rng)
    order = rng.permutation(len(xyz))
    expected = vertices_of(gables_of(xyz, classes, plane))
    for moved, back in ((xyz[order] + FAR, expected + FAR), (turned(xyz[order], 70.0), turned(expected, 70.0))):
        found = vertices_of(gables_of(moved, classes[order], plane[order]))
        assert np.linalg.norm(found[:, None] - back, axis=2).min(axis=0).max() < 1e-5


def test_without_ground_the_lowest_points_around_are_the_ground(rng):
    xyz, classes, plane = house(rng)
    found = gables_of(xyz, np.zeros_like(classes), plane)
    assert found.columns["z7"][0] == pytest.approx(GROUND, abs=0.1)


def test_ground_far_from_the_corners_is_that_around_the_house_wherever_it_lies(rng):
    """On a slope of 10 % the ground 60 m uphill is 6 m higher: it must not count, also far from the origin."""
    xyz, classes, plane = house(rng)
    x, y = xyz[:, :2].T
    is_ground = classes == PointClass.GROUND
    xyz[is_ground, 2] += 0.1 * x[is_ground]
    uphill = rng.uniform((20, -40), (80, 40), (4000, 2))
    xyz = np.concatenate([xyz, np.column_stack([uphill, GROUND + 0.1 * uphill[:, 0]])])
    classes = np.concatenate([classes, np.full(len(uphill), PointClass.GROUND, np.uint8)])
    plane = np.concatenate([plane, np.zeros(len(uphill), np.int32)])
    # Nothing within 2 m of the corners.
    kept = (classes != PointClass.GROUND) | (np.abs(xyz[:, 0] - 6) > 8.5) | (np.abs(xyz[:, 1]) > 6.5)
    xyz, classes, plane = xyz[kept], classes[kept], plane[kept]
    for shift in (np.zeros(3), np.array([0.0, 5000.0, 0.0])):
        assert gables_of(xyz + shift, classes, plane).columns["z7"] == pytest.approx([1.6] * 7, abs=0.6)


def test_ground_on_a_slope_or_far_off_and_gentle_slopes_make_gables_too(rng):
    """Hillside of 20 % with the ground along the house at 1 m in the median; ground 22 m off; a roof of 6.5°."""
    xyz, classes, plane = house(rng)
    is_ground = classes == PointClass.GROUND
    hillside, lonely, gentle = (xyz.copy() for _ in range(3))
    hillside[is_ground, 2] += 0.2 * (xyz[is_ground, 0] - 6)
    lonely[is_ground, :2] += [40.0, 0.0]
    gentle[~is_ground, 2] = RIDGE - np.tan(np.radians(6.5)) * np.abs(xyz[~is_ground, 1])
    for points in (hillside, lonely, gentle):
        found = gables_of(points, classes, plane)
        assert found.columns["z7"] == pytest.approx([GROUND] * 7, abs=0.25)
    # Without classes, the lowest points next to the eaves: each within 2 m, so up to 0.4 m lower on this slope.
    for points in (hillside, gentle):
        found = gables_of(points, np.zeros_like(classes), plane)
        assert found.columns["z7"] == pytest.approx([GROUND] * 7, abs=0.5)


def test_valleys_single_planes_and_level_roofs_are_no_gables(rng):
    xyz, classes, plane = house(rng)
    valley = xyz.copy()
    valley[plane > 0, 2] = 12 - xyz[plane > 0, 2]
    level = xyz.copy()
    level[plane > 0, 2] = 6.0
    for points, planes in ((valley, plane), (xyz, np.where(plane == 1, 1, 0)), (level, plane), (xyz, 0 * plane)):
        monitor = Monitor()
        assert not len(gables_of(points, classes, planes.astype(np.int32), monitor=monitor))
        assert monitor.warnings == [
            "No two roof planes rise toward each other to a level ridge, so there is no gable; run "
            "'Segment planes (RANSAC)' first, with a smaller minimum plane area if roofs are small."
        ]


def test_tunables_have_the_described_effect(rng):
    xyz, classes, plane = house(rng)
    assert not len(gables_of(xyz, classes, plane, min_area=80.0))
    seen = np.abs(xyz[:, 1]) > 1.0
    assert not len(gables_of(xyz[seen], classes[seen], plane[seen]))
    assert len(gables_of(xyz[seen], classes[seen], plane[seen], max_gap=4.0)) == 7


def test_cityjson_has_a_closed_solid_of_each_house(rng):
    """Far from the origin; ten vertices, two roofs, four walls and the ground, with the heights of the house."""
    xyz, classes, plane = house(rng)
    made = reconstruct_gables.stage.unpack(reconstruct_gables(xyz + FAR, classes, plane))
    (model,) = made.files["cityjson"].items
    (solid,) = model.model.best
    assert fault_of(solid) == ""
    assert solid.volume == pytest.approx(12 * 8 * (5 + 1.5), rel=0.03)
    written = json.loads("".join(made.files["cityjson"].pieces("CityJSON", MapFrame(np.asarray, "EPSG:25832"))))
    assert len(written["vertices"]) == 10
    (building,) = written["CityObjects"].values()
    (geometry,) = building["geometry"]
    assert (geometry["type"], geometry["lod"]) == ("Solid", "2.2")
    kinds = [surface["type"] for surface in geometry["semantics"]["surfaces"]]
    assert kinds == ["RoofSurface"] * 2 + ["WallSurface"] * 4 + ["GroundSurface"]
    facts = building["attributes"]
    assert facts["roof_type"] == "gable"
    assert facts["eave_height"] == pytest.approx(EAVES - GROUND, abs=0.1)
    assert facts["ridge_height"] == pytest.approx(RIDGE - GROUND, abs=0.1)
    assert facts["points"] == 12 * 8 * 12
