"""From a drone's cloud to corrected corners: the whole chain on simulated villages, with nothing set."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.geometry.polygon_overlap import are_in_polygons, as_polygons
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline, run_stage
from lidar_buildings.algorithms.stage import LayerFeatures, Monitor
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.tests.villages import corner_distances, mapped, village

CHAIN = PIPELINES["map_footprints"]


def turned(arrays, layers, angle, shift):
    """Return cloud and layers turned about z and moved."""
    cos, sin = np.cos(angle), np.sin(angle)
    rotation = np.array([(cos, sin), (-sin, cos)])
    xyz = arrays["xyz"].copy()
    xyz[:, :2] = xyz[:, :2] @ rotation + shift
    moved = [
        LayerFeatures([[ring @ rotation + shift for ring in rings] for rings in f.geometries], f.columns)
        for f in layers
    ]
    return {**arrays, "xyz": xyz}, moved


@pytest.mark.parametrize(
    ("tunables", "angle"),
    [
        ({"density": 30.0, "noise": 0.05, "seed": 2}, 0.0),
        pytest.param({"density": 70.0, "noise": 0.03, "seed": 3}, 0.7, marks=pytest.mark.slow),
    ],
)
def test_buildings_are_found_and_their_corners_are_where_they_are(tunables, angle):
    arrays, true, old_map = village(size=100.0, **tunables)
    arrays, (true, old_map) = turned(arrays, (true, old_map), angle, (0.0, 0.0))
    made = mapped(arrays, old_map)
    distances, used = corner_distances(made.layers["wall_footprints"], true)
    assert len(true) >= 8
    assert len(distances) == len(true)
    assert len(used) == len(made.layers["wall_footprints"]) == len(true)
    assert set(made.layers["wall_footprints"].columns["source"]) == {"wall"}
    assert np.concatenate(distances).mean() < 0.08
    # The old map lies 0.3 m to the east and north, turned with everything else.
    shift = -0.3 * np.array([np.cos(angle) - np.sin(angle), np.sin(angle) + np.cos(angle)])
    assert [made.report.values[name] for name in ("mean_dx", "mean_dy")] == pytest.approx(shift, abs=0.1)
    assert made.report.values["new"] == made.report.values["missed"] == round(0.1 * len(true))
    assert made.report.values["found"] == len(true) - round(0.1 * len(true))


@pytest.mark.slow
def test_the_published_chain_finds_most_of_the_corners():
    """Ours closes all outlines; corners that both have are as near to the true ones."""
    arrays, true, old_map = village(size=100.0, density=75.0, noise=0.02, seed=2)
    cloud = create_cloud(arrays)
    made = run_pipeline(PIPELINES["map_footprints_2022"], cloud, input_layers={"old_map": old_map})
    distances, used = corner_distances(made.layers["wall_footprints"], true)
    assert len(used) == len(made.layers["wall_footprints"]) >= 0.6 * len(true)
    assert np.concatenate(distances).mean() < 0.08
    is_end = np.array(made.layers["candidate_corners"].columns["edges"]) > 0
    corners = np.array(made.layers["candidate_corners"].geometries)[is_end]
    walls = np.concatenate([rings[0][:-1] for rings in true.geometries])
    assert (np.hypot(*(walls[:, None] - corners).transpose(2, 0, 1)).min(axis=1) < 0.3).mean() > 0.8
    points = made.reports["footprints_report"].values
    counts = [points[name] for name in ("original_points", "points", "points_above_ground", "roof_points")]
    assert counts == sorted(counts, reverse=True)
    assert counts[0] == len(arrays["xyz"])
    assert 0 < points["wall_points"] < 0.2 * points["roof_points"]
    assert made.reports["report"].values["found"] <= len(used)


def test_without_an_old_map_footprints_are_made_all_the_same():
    arrays, true, _ = village(size=70.0, density=30.0, seed=4)
    monitor = Monitor()
    made = mapped(arrays, None, monitor)
    assert len(made.layers["wall_footprints"]) == len(true) > 2
    assert not {"displacements", "buildings"} & set(made.layers), "there is nothing to compare with"


@pytest.mark.slow
def test_where_no_walls_are_seen_footprints_are_roofs():
    """Straight down, eaves hide the walls, as from an airplane."""
    arrays, true, _ = village(size=90.0, density=40.0, oblique=0.0, clutter=False, trees=0.0, seed=4)
    made = mapped(arrays, None)
    footprints = made.layers["wall_footprints"]
    assert set(footprints.columns["source"]) == {"roof"}
    assert len(footprints) == len(true)
    # Eaves of 0.5 m all around (0.25 m of sheds) make roofs larger than their walls.
    larger = np.sort(footprints.columns["area"]) / np.sort(true.columns["area"])
    assert (larger > 1.1).all()
    assert (larger < 1.5).all()


def test_the_clouds_of_the_steps_can_be_kept():
    arrays, _, _ = village(size=60.0, density=20.0, seed=4)
    made = run_pipeline(CHAIN, create_cloud(arrays))
    assert set(made.clouds) == {f"{step}_output" for step in CHAIN.kept}
    assert made.clouds["ground_output"].has("voxel_count")
    assert not made.clouds["ground_output"].has("height_above_ground")
    assert made.clouds["roofs_output"].has("cluster_id")
    assert not made.clouds["roofs_output"].has("wall_of")
    assert made.cloud.has("wall_of")


def test_a_field_without_buildings_has_no_footprints():
    arrays, _, old_map = village(size=60.0, density=30.0, buildings=0.0, trees=60.0)
    monitor = Monitor()
    made = mapped(arrays, old_map, monitor)
    assert len(made.layers["wall_footprints"]) == 0
    assert made.report.values["all_footprints"] == 0


def test_walls_without_roofs_are_no_buildings(rng):
    """Ruins and fences: vertical planes only, each of them higher than roofs begin."""
    ground = np.column_stack([rng.uniform(0, 40, (16_000, 2)), np.zeros(16_000)])
    walls = []
    for start, end in (((10, 10), (20, 10)), ((20, 10), (20, 18)), ((10, 30), (25, 33))):
        share = rng.random((4000, 1))
        plan = np.array(start) + share * (np.array(end) - start)
        walls.append(np.column_stack([plan, rng.uniform(0, 5, 4000)]))
    xyz = np.concatenate([ground, *walls])
    monitor = Monitor()
    made = mapped({"xyz": xyz + rng.normal(0, 0.02, xyz.shape)}, None, monitor)
    assert len(made.layers["wall_footprints"]) == 0
    assert any("No plane" in warning for warning in monitor.warnings)


def test_without_ground_the_sentence_says_what_is_missing(rng):
    nothing = {"xyz": np.column_stack([np.arange(50.0), np.zeros(50), np.zeros(50)])}
    with pytest.raises(ValueError, match=r"line|ground"):
        mapped(nothing, None)


@pytest.mark.slow
def test_bridges_over_a_river_are_no_buildings():
    town = run_stage(STAGES["simulate_town"], size=110.0, density=12.0).cloud
    xyz, is_deck = town.get("xyz"), town.get("classification") == PointClass.BRIDGE_DECK
    assert is_deck.sum() > 1000, "the town has bridges"
    returns = {name: town.get(name) for name in ("return_number", "number_of_returns")}
    made = run_pipeline(CHAIN, create_cloud({"xyz": xyz, **returns}))
    outlines = as_polygons(made.layers["wall_footprints"].geometries)
    # Five houses and a shed of 9 m², each an object of its own in the truth.
    buildings = np.unique(town.get("segment_id")[town.get("classification") == PointClass.BUILDING])
    assert len(made.layers["wall_footprints"]) == len(buildings) == 6
    assert not are_in_polygons(xyz[is_deck, :2], outlines, Monitor()).any()
