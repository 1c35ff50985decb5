"""Heights of buildings: houses whose ground, eaves, ridge and volume are known, and what hides them."""

import numpy as np
import pytest

from lidar_buildings.algorithms.models3d.compute_building_heights import (
    ABSENT,
    EMPTY,
    PARTLY,
    SEEN,
    TREES,
    compute_building_heights,
)
from lidar_buildings.algorithms.models3d.reconstruct_roofs import reconstruct_roofs
from lidar_buildings.algorithms.stage import LayerFeatures, Monitor
from lidar_buildings.tests.builders import is_inside
from lidar_buildings.tests.roof_shapes import SHAPES

GROUND = 20.0


def scene(shape, turn=20.0, origin=(0.0, 0.0), density=12.0):
    """Return points (n, 3) and classes (n,) of a house on level ground, and its ring."""
    roof, ring = shape.scanned(density, turn=turn, origin=origin)
    rng = np.random.default_rng(1)
    around = np.column_stack([rng.uniform(-14, 28, (8000, 2)) + origin, rng.normal(0, 0.03, 8000)])
    around = around[~is_inside(around[:, :2], [ring])]
    xyz = np.concatenate([roof, around]) + [0, 0, GROUND]
    return xyz, np.repeat([6, 2], [len(roof), len(around)]).astype(np.uint8), ring


def measured(xyz, classes, rings, columns=None, **tunables):
    """Return the attributes of each footprint and the messages."""
    monitor = Monitor()
    made = compute_building_heights(
        xyz, classes, footprints=LayerFeatures([[ring] for ring in rings], columns or {}), monitor=monitor, **tunables
    )
    return [dict(zip(made.columns, row)) for row in zip(*made.columns.values())], monitor


def true_surface(shape):
    """Return the elevations (k,) of a roof every 0.05 m."""
    low, high = shape.outline.min(axis=0), shape.outline.max(axis=0)
    xy = np.mgrid[low[0] : high[0] : 0.05, low[1] : high[1] : 0.05].reshape(2, -1).T + 0.025
    return shape.top(*xy[is_inside(xy, [shape.ring])].T) + GROUND


@pytest.mark.parametrize("name", ["flat", "shed", "gable", "hip", "mansard", "steps"])
def test_heights_volume_and_type_are_those_of_the_house(name):
    shape = SHAPES[name]
    xyz, classes, ring = scene(shape)
    (facts,), _ = measured(xyz, classes, [ring])
    surface = true_surface(shape)
    assert facts["state"] == SEEN
    assert facts["roof_type"] == shape.kind
    assert facts["h_ground"] == pytest.approx(GROUND, abs=0.08)
    for field, percent in (("h_roof_min", 0), ("h_roof_50p", 50), ("h_roof_70p", 70), ("h_roof_max", 100)):
        assert facts[field] == pytest.approx(np.percentile(surface, percent), abs=0.25 if "m" in field[-3:] else 0.1)
    area = len(surface) * 0.05**2
    assert facts["volume"] == pytest.approx(area * (surface.mean() - GROUND), rel=0.02)
    assert facts["covered"] > 0.95
    assert facts["trees"] == 0


def test_eaves_ridge_and_ground_are_those_of_the_model():
    """The same house by the model that is made of it."""
    xyz, classes, ring = scene(SHAPES["gable"])
    (facts,), _ = measured(xyz, classes, [ring])
    model = reconstruct_roofs(xyz, classes, LayerFeatures([[ring]], {}))[0].columns
    assert facts["h_ground"] == model["ground"][0]
    assert facts["eave_height"] == pytest.approx(model["eave_height"][0], abs=0.15)
    assert facts["ridge_height"] == pytest.approx(model["ridge_height"][0], abs=0.05)
    assert facts["points"] == model["points"][0]
    assert facts["roof_type"] == model["roof_type"][0]


def test_strips_that_were_scanned_twice_count_once():
    """Percentiles are of the surface: with twice the points on its upper half, the median of points would rise."""
    xyz, classes, ring = scene(SHAPES["shed"])
    roof = np.flatnonzero(classes == 6)
    upper = roof[xyz[roof, 2] > np.median(xyz[roof, 2])]
    again = np.concatenate([np.arange(len(xyz)), np.repeat(upper, 2)])
    (once,), _ = measured(xyz, classes, [ring])
    (twice,), _ = measured(xyz[again], classes[again], [ring])
    assert twice["h_roof_50p"] == pytest.approx(once["h_roof_50p"], abs=0.06)


def test_chimneys_walls_and_floors_are_no_roof():
    xyz, classes, ring = scene(SHAPES["flat"])
    low, high = SHAPES["flat"].outline.min(axis=0), SHAPES["flat"].outline.max(axis=0)
    rng = np.random.default_rng(2)
    (clean,), _ = measured(xyz, classes, [ring])
    inner = xyz[classes == 6][::9] - [0, 0, 3.0]
    chimney = xyz[classes == 6][:3] + [0, 0, rng.uniform(1, 2)]
    more = np.concatenate([inner, chimney])
    assert (high - low > 5).all()
    (found,), _ = measured(np.concatenate([xyz, more]), np.append(classes, np.full(len(more), 6, np.uint8)), [ring])
    for field in ("h_roof_min", "h_roof_max", "ridge_height", "eave_height"):
        assert found[field] == pytest.approx(clean[field], abs=0.1)


def test_eaves_are_not_looked_for_where_a_neighbor_adjoins():
    """The gutter of a lean-to is its lowest quarter, unless another house of the map begins there."""
    shape = SHAPES["shed"]
    xyz, classes, ring = scene(shape, turn=0.0)
    low = np.array(sorted(ring[:-1].tolist(), key=lambda place: shape.top(*np.array(place)))[:2])
    outward = low.mean(axis=0) - ring[:-1].mean(axis=0)
    neighbor = np.array([low[0], low[1], low[1] + outward, low[0] + outward, low[0]])
    ((alone,), _), ((beside, _), _) = measured(xyz, classes, [ring]), measured(xyz, classes, [ring, neighbor])
    assert alone["eave_height"] == pytest.approx(shape.eave, abs=0.1)
    assert beside["eave_height"] > shape.eave + 0.5


def test_what_hides_a_roof_is_said():
    xyz, classes, ring = scene(SHAPES["gable"])
    is_roof, west = classes == 6, xyz[:, 0] < np.median(xyz[classes == 6, 0])
    (facts,), _ = measured(xyz[~(is_roof & west)], classes[~(is_roof & west)], [ring])
    assert facts["state"] == PARTLY
    assert facts["covered"] == pytest.approx(0.5, abs=0.1)
    under = np.where(is_roof & west, 5, classes).astype(np.uint8)
    (facts,), _ = measured(xyz, under, [ring])
    assert facts["state"] == TREES
    assert facts["trees"] == pytest.approx(0.5, abs=0.1)
    assert facts["h_roof_max"] == pytest.approx(SHAPES["gable"].ridge + GROUND, abs=0.1)
    (_, on_ground), _ = measured(xyz, classes, [ring, ring + [11.0, -12.0]])
    assert on_ground["state"] == ABSENT
    assert np.isnan(on_ground["h_roof_50p"])
    assert on_ground["h_ground"] == pytest.approx(GROUND, abs=0.08)
    assert on_ground["roof_type"] is None


def test_a_hole_in_the_cloud_is_no_points():
    xyz, classes, ring = scene(SHAPES["flat"])
    small = np.array([[-10, -10], [-8, -10], [-8, -8], [-10, -8], [-10, -10.0]])
    gone = ((xyz[:, :2] > (-10, -10)) & (xyz[:, :2] < (-8, -8))).all(axis=1)
    rows, monitor = measured(xyz[~gone], classes[~gone], [ring, small])
    assert [row["state"] for row in rows] == [SEEN, EMPTY]


def test_without_class_6_planes_are_roofs_and_crowns_are_not():
    xyz, classes, ring = scene(SHAPES["gable"])
    rng = np.random.default_rng(3)
    crown = np.column_stack([rng.uniform(0, 4, (400, 2)), rng.uniform(3, 14, 400) + GROUND])
    crown[:, :2] += ring[:-1].mean(axis=0) - 2
    all_points = np.concatenate([xyz, crown])
    kinds = np.append(np.where(classes == 6, 1, 2), np.full(len(crown), 1)).astype(np.uint8)
    (facts,), _ = measured(all_points, kinds, [ring])
    assert facts["roof_type"] == "gable"
    assert facts["h_roof_max"] == pytest.approx(SHAPES["gable"].ridge + GROUND, abs=0.3)
    assert facts["volume"] == pytest.approx(measured(xyz, classes, [ring])[0][0]["volume"], rel=0.05)


def test_a_crown_without_class_is_no_building():
    xyz, classes, ring = scene(SHAPES["gable"])
    ground = xyz[classes == 2]
    rng = np.random.default_rng(3)
    crown = np.column_stack([ring[0] + rng.uniform(-8, 12, (6000, 2)), rng.uniform(3, 14, 6000) + GROUND])
    kinds = np.repeat([2, 1], [len(ground), len(crown)]).astype(np.uint8)
    (facts,), monitor = measured(np.concatenate([ground, crown]), kinds, [ring])
    assert facts["state"] == TREES


def test_dates_are_of_adjusted_times_and_weeks_have_none():
    xyz, classes, ring = scene(SHAPES["flat"])
    flown = (np.datetime64("2023-06-18T10:00:00") - np.datetime64("1980-01-06T00:00:00")).astype(float)
    for time, expected in ((flown - 1e9, "2023-06-18"), (228_671.0, None)):
        made = compute_building_heights(
            xyz, classes, np.full(len(xyz), time), footprints=LayerFeatures([[ring]], {}), monitor=Monitor()
        )
        assert made.columns["date"] == [expected]


def test_attributes_of_the_map_stay_and_used_names_are_marked():
    xyz, classes, ring = scene(SHAPES["flat"])
    columns = {"Height": np.array([3.5]), "key": ["NL.1"], "floors": np.array([2]), "roof": [None]}
    (facts,), _ = measured(xyz, classes, [ring], columns)
    assert (facts["map_Height"], facts["key"], facts["floors"], facts["roof"]) == (3.5, "NL.1", 2, None)
    assert facts["height"] > 3.5


def test_what_can_not_be_measured_is_refused_in_a_sentence():
    xyz, classes, ring = scene(SHAPES["flat"])
    for footprints, kinds, message in (
        ([], classes, "has no features"),
        ([ring], np.full(len(xyz), 6, np.uint8), r"No point is called ground \(class 2\); run 'Classify ground points"),
        ([ring], np.full(len(xyz), 2, np.uint8), r"No point is called building \(class 6\)"),
        ([ring + 1e5], classes, "None of the 1 footprints touches the extent"),
        ([ring[[0, 1, 0, 0]]], classes, "None of the 1 footprints has an area"),
    ):
        with pytest.raises(ValueError, match=message):
            measured(xyz, kinds, footprints)
    rows, _ = measured(xyz, classes, [ring, ring + 1e5])
    assert len(rows) == 1
