"""Buildings of known shape at any angle and density, and rows that share their walls; GEOS says what is valid."""

import numpy as np
import pytest
from qgis.core import QgsGeometry, QgsPointXY

from lidar_buildings.algorithms.footprints.extract_footprints import extract_footprints
from lidar_buildings.algorithms.simulation.scanner import AirSurvey, scan
from lidar_buildings.algorithms.simulation.town_layout import TownPlan, build_town
from lidar_buildings.tests.builders import is_inside, turned

SHAPES = {
    "L": [[(0, 0), (14, 0), (14, 8), (8, 8), (8, 14), (0, 14)]],
    "U": [[(0, 0), (18, 0), (18, 12), (12, 12), (12, 6), (6, 6), (6, 12), (0, 12)]],
    "T": [[(0, 8), (7, 8), (7, 0), (13, 0), (13, 8), (20, 8), (20, 14), (0, 14)]],
    "diagonal": [[(0, 0), (16, 0), (16, 6), (11, 11), (0, 11)]],
    "skewed": [[(0, 0), (14, 0), (14, 9), (0, 6)]],
    "courtyard": [[(0, 0), (18, 0), (18, 16), (0, 16)], [(6, 5), (6, 11), (12, 11), (12, 5)]],
}


def polygon(rings):
    return QgsGeometry.fromPolygonXY([[QgsPointXY(x, y) for x, y in ring.tolist()] for ring in rings])


def closed(rings):
    return [np.concatenate([ring, ring[:1]]) for ring in rings]


def scanned(buildings, density, rng):
    """Points on flat roofs of different heights and on the ground between them: coordinates, classes, clusters."""
    corners = np.concatenate([ring for rings in buildings for ring in rings])
    low, high = corners.min(axis=0) - 5, corners.max(axis=0) + 5
    plan = rng.uniform(low, high, (int(np.prod(high - low) * density), 2))
    cluster = np.zeros(len(plan), int)
    for number, rings in enumerate(buildings, start=1):
        cluster[is_inside(plan, rings)] = number
    z = np.where(cluster > 0, 5 + 0.7 * (cluster % 3), 0) + rng.normal(0, 0.03, len(plan))
    return np.column_stack([plan, z]), np.where(cluster > 0, 6, 2), cluster


def nearest(corners, rings):
    """Distance of each true corner to the nearest corner that was made."""
    made = np.concatenate([ring[:-1] for ring in rings])
    return np.sqrt(((corners[:, None] - made) ** 2).sum(axis=2).min(axis=1))


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize(("density", "degrees"), [(2, 0), (4, 77), (8, 31), (15, 200), (50, 45)])
def test_corners_of_known_buildings(name, density, degrees, rng):
    truth = [turned(ring, degrees) + [600_000, 5_000_000] for ring in SHAPES[name]]
    spacing, apart = density**-0.5, []
    # A house of 14 m by 9 m has a hundred points at 2 per m²: one draw is not enough.
    for _ in range(3 if density < 4 else 1):
        xyz, classification, _ = scanned([truth], density, rng)
        found = extract_footprints(xyz, classification)
        assert found.columns["regularized"] == [1]
        made, real = polygon(found.geometries[0]), polygon(closed(truth))
        assert made.isGeosValid()
        assert len(found.geometries[0]) == len(truth)
        beyond = made.symDifference(real).area() / real.length()
        assert beyond < (0.6 if density < 4 else 0.4) * spacing
        assert made.hausdorffDistance(real) < 2.5 * spacing
        apart.append(nearest(np.concatenate(truth), found.geometries[0]))
    assert np.median(apart) < spacing


@pytest.mark.parametrize("density", [2, 4, 15])
@pytest.mark.parametrize("step", [0.0, 2.0])
def test_row_houses_share_their_walls_exactly(density, step, rng):
    houses = [
        [turned([(6 * i, 0), (6 * i + 6, 0), (6 * i + 6, 9 + step * (i % 2)), (6 * i, 9 + step * (i % 2))], 25)]
        for i in range(4)
    ]
    xyz, classification, cluster = scanned(houses, density, rng)
    found = extract_footprints(xyz, classification, cluster)
    assert found.columns["cluster_id"] == [1, 2, 3, 4]
    assert found.columns["regularized"] == [1] * 4
    made = [polygon(rings) for rings in found.geometries]
    assert all(one.isGeosValid() for one in made)
    for i in range(3):
        assert made[i].intersection(made[i + 1]).area() == 0
        shared = edges(found.geometries[i]) & edges(found.geometries[i + 1], back=True)
        length = sum(np.hypot(x1 - x0, y1 - y0) for x0, y0, x1, y1 in shared)
        assert length == pytest.approx(9 + step * (i % 2) * 0, abs=3 * density**-0.5)
    union = QgsGeometry.unaryUnion(made)
    assert union.area() == pytest.approx(sum(one.area() for one in made), rel=1e-9)
    # One block without a seam between its houses.
    assert len(union.asPolygon()) == 1
    corners = np.concatenate([ring for rings in houses for ring in rings])
    distances = [nearest(rings[0], geometry) for rings, geometry in zip(houses, found.geometries)]
    assert len(corners) == 16
    assert np.median(distances) < density**-0.5


def edges(rings, back=False):
    """Edges of a polygon as numbers, each in the direction it has or in the other."""
    found = np.concatenate([np.hstack([ring[1:], ring[:-1]] if back else [ring[:-1], ring[1:]]) for ring in rings])
    return {tuple(edge) for edge in found.tolist()}


# In those after the first twelve, groups of buildings touch in a point where borders of one of them end.
@pytest.mark.parametrize(("seed", "n"), [*((i, 3000) for i in range(12)), (102, 1500), (134, 1500), (136, 3000)])
@pytest.mark.parametrize("regularize", [True, False])
def test_any_division_gives_valid_polygons_that_do_not_overlap(seed, n, regularize):
    """Clusters as no town has them: cells of chance, some within others, with gaps, holes and single points."""
    rng = np.random.default_rng(seed)
    xyz = np.column_stack([rng.uniform(0, 30, (n, 2)), rng.normal(5, 0.05, n)])
    centers = rng.uniform(0, 30, (9, 2))
    apart = np.hypot(*(xyz[:, None, :2] - centers).transpose(2, 0, 1))
    cluster = 1 + np.argmin(apart, axis=1)
    cluster[np.hypot(*(xyz[:, :2] - centers[0]).T) < 3] = 20
    cluster[rng.random(n) < 0.02] = 21
    classification = np.where((apart % 7 < 1.2).any(axis=1) & (seed % 2 == 0), 2, 6)
    xyz[classification == 2, 2] = 0
    found = extract_footprints(xyz, classification, cluster, regularize=regularize)
    made = [polygon(rings) for rings in found.geometries]
    assert made
    assert all(one.isGeosValid() for one in made)
    assert QgsGeometry.unaryUnion(made).area() == pytest.approx(sum(one.area() for one in made), rel=1e-6)
    assert min(found.columns["area"]) >= 4.0


def test_houses_with_a_gap_stay_apart_and_do_not_overlap(rng):
    """Two houses with an alley of 80 cm between them, at 15 points per m²."""
    houses = [[turned([(x, 0), (x + 8, 0), (x + 8, 9), (x, 9)], 40)] for x in (0, 8.8)]
    found = extract_footprints(*scanned(houses, 15, rng))
    first, second = (polygon(rings) for rings in found.geometries)
    assert first.distance(second) == pytest.approx(0.8, abs=0.35)


@pytest.mark.parametrize(("density", "radius"), [(15, 5), (40, 4), (40, 7)])
def test_a_round_tower_is_a_few_chords(density, radius):
    """Walls closer to the traced outline have right angles by chance: along these it would be a stair of 20 corners."""
    angle = np.deg2rad(np.arange(0, 360, 5))
    ring = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    draws = [scanned([[ring]], density, np.random.default_rng(seed)) for seed in range(10)]
    found = [extract_footprints(xyz, classification) for xyz, classification, _ in draws]
    assert sum(one.columns["regularized"][0] for one in found) <= 1
    # Chords that stay within 1.75 spacings.
    few = np.pi / np.arccos(1 - 1.75 * density**-0.5 / radius)
    assert max(len(one.geometries[0][0]) - 1 for one in found) < 2.2 * few
    assert np.mean([polygon(one.geometries[0]).hausdorffDistance(polygon([ring])) for one in found]) < 2 * density**-0.5


def test_order_position_and_direction_change_nothing(rng):
    houses = [[turned([(6 * i, 0), (6 * i + 6, 0), (6 * i + 6, 9 + i % 2), (6 * i, 9 + i % 2)], 25)] for i in range(4)]
    xyz, classification, cluster = scanned(houses, 8, rng)
    here = extract_footprints(xyz, classification, cluster)
    order = rng.permutation(len(xyz))
    permuted = extract_footprints(xyz[order], classification[order], cluster[order])
    for one, other in zip(here.geometries, permuted.geometries):
        np.testing.assert_array_equal(one[0], other[0])
    moved = extract_footprints(xyz + [600_000, 5_000_000, 100], classification, cluster)
    for one, other in zip(here.geometries, moved.geometries):
        np.testing.assert_allclose(one[0] + [600_000, 5_000_000], other[0], atol=1e-6)
    around = turned(xyz, 33)
    made = extract_footprints(around, classification, cluster)
    # Points below others are looked for in cells, which don't turn with the points.
    assert made.columns["area"] == pytest.approx(here.columns["area"], rel=0.01)


def test_houses_of_a_simulated_town():
    """Every house of a town on a slope, with shadows, trees over eaves and rows of different heights."""
    scene = build_town(TownPlan(size=120.0, slope=5.0, forest=0.0, river=False, seed=4))
    made = scan(scene, AirSurvey(seed=4))
    cluster = np.where(made["classification"] == 6, made["segment_id"], 0)
    found = extract_footprints(made["xyz"], made["classification"], cluster)
    polygons = dict(zip(found.columns["cluster_id"], found.geometries))
    houses = [house for house in scene.buildings if house.kind != "shed"]
    assert {house.object_id for house in houses} <= set(polygons)
    distances = np.concatenate([nearest(house.outline[:-1], polygons[house.object_id]) for house in houses])
    # Points are 35 cm apart.
    assert np.median(distances) < 0.2
    assert np.percentile(distances, 90) < 0.4
    assert all(polygon(rings).isGeosValid() for rings in found.geometries)
