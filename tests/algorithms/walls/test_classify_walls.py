"""Wall points of a small scene: upright, low, smooth, and under a roof."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.algorithms.walls.classify_walls import classify_walls

NOISE = 0.02
KINDS = ("roof", "other roof", "wall", "other wall", "upper wall", "bush", "car", "fence", "ground", "base")


def upright(rng, start, end, low, high, density=20):
    start, end = np.array(start, float), np.array(end, float)
    n = round(np.hypot(*(end - start)) * (high - low) * density)
    return np.column_stack([start + rng.random(n)[:, None] * (end - start), rng.uniform(low, high, n)])


def level(rng, west, south, east, north, z, density=20):
    n = round((east - west) * (north - south) * density)
    return np.column_stack([rng.uniform((west, south), (east, north), (n, 2)), np.full(n, z)])


@pytest.fixture
def scene(rng):
    """A house with eaves of 0.5 m, a second one next to it, a bush, a car's bonnet and a fence in the yard."""
    parts = {
        "roof": level(rng, -0.5, -0.5, 10.5, 6.5, 3.2),
        "other roof": level(rng, 14.5, -0.5, 20.5, 6.5, 3.2),
        "wall": np.concatenate([upright(rng, (0, 0), (10, 0), 0.4, 2.4), upright(rng, (10, 0), (10, 6), 0.4, 2.4)]),
        "other wall": upright(rng, (15, 0), (15, 6), 0.4, 2.4),
        "upper wall": upright(rng, (0, 0), (10, 0), 2.6, 3.0),
        "bush": np.array([5, -0.4, 0.8]) + rng.normal(0, 0.25, (60, 3)),
        "car": level(rng, 10.6, 1, 10.79, 5, 0.9, 60),
        "fence": upright(rng, (12.5, 0), (12.5, 6), 0.4, 1.2),
        "ground": level(rng, -5, -5, 25, 12, 0.0, 8),
        "base": upright(rng, (0, 6), (10, 6), 0.0, 0.28),
    }
    sizes = [len(parts[kind]) for kind in KINDS]
    xyz = np.concatenate([parts[kind] for kind in KINDS])
    xyz = xyz + rng.normal(0, NOISE, xyz.shape)
    which = np.repeat(np.arange(len(KINDS)), sizes)
    classes = np.where(which == KINDS.index("ground"), PointClass.GROUND, PointClass.UNCLASSIFIED)
    cluster_id = np.where(which == 0, 1, np.where(which == 1, 2, 0))
    classes[cluster_id > 0] = PointClass.BUILDING
    return {
        "xyz": xyz,
        "classification": classes.astype(np.uint8),
        "height_above_ground": xyz[:, 2].astype(np.float32),
        "cluster_id": cluster_id.astype(np.int32),
    }, {kind: which == i for i, kind in enumerate(KINDS)}


@pytest.mark.parametrize("tunables", [{}, {"neighborhood": "radius", "radius": 0.6}])
def test_walls_are_found_and_belong_to_their_roofs(scene, tunables):
    arrays, of = scene
    classification, wall_of = classify_walls(**arrays, **tunables)
    assert np.mean(wall_of[of["wall"]] == 1) > 0.85
    assert np.mean(wall_of[of["other wall"]] == 2) > 0.85
    for kind in ("roof", "other roof", "upper wall", "fence", "ground", "base"):
        assert not wall_of[of[kind]].any(), kind
    assert np.mean(wall_of[of["bush"]] > 0) < 0.35
    assert np.mean(wall_of[of["car"]] > 0) < 0.1
    np.testing.assert_array_equal(classification, np.where(wall_of > 0, PointClass.BUILDING, arrays["classification"]))


def test_tunables_have_the_described_effect(scene):
    arrays, of = scene

    def share(kind, **tunables):
        return np.mean(classify_walls(**arrays, **tunables)[1][of[kind]] > 0)

    assert share("upper wall", max_height=3.1) > 0.7
    assert share("base", min_height=0.0, margin=0.5) > 0.7
    assert share("fence", margin=2.5) > 0.7
    assert share("car", max_tilt=90.0, margin=1.0) > 0.7
    assert share("wall", max_tilt=0.5) < 0.3
    # With as many neighbors, since their number follows the noise too.
    smooth = [share("bush", noise=noise, n_neighbors=10) for noise in (0.03, 0.045, 0.1)]
    assert smooth[0] < smooth[1] < smooth[2]
    assert share("wall", n_neighbors=200) < share("wall")


def test_leaning_surfaces_are_no_walls(scene, rng):
    """A roof slope of 45° that comes down next to the house is recognized by its normal."""
    arrays, of = scene
    arrays["xyz"][of["wall"], 1] += arrays["xyz"][of["wall"], 2]
    x = arrays["xyz"][:, 0]
    front = of["wall"] & (x < 9)
    assert np.mean(classify_walls(**arrays)[1][front] > 0) < 0.02


def test_the_order_of_points_changes_nothing(scene, rng):
    arrays, _ = scene
    order = rng.permutation(len(arrays["xyz"]))
    shuffled = classify_walls(**{name: values[order] for name, values in arrays.items()})[1]
    np.testing.assert_array_equal(shuffled, classify_walls(**arrays)[1][order])


def test_missing_walls_are_said_where_there_are_roofs(scene):
    arrays, of = scene
    low = of["wall"] | of["other wall"] | of["bush"] | of["car"] | of["fence"] | of["base"] | of["upper wall"]
    warning = "No wall was seen under any roof, so footprints can show the outlines of roofs only."
    for changed, reported in (
        ({name: values[~low] for name, values in arrays.items()}, [warning]),
        ({**arrays, "cluster_id": np.zeros_like(arrays["cluster_id"])}, []),
    ):
        monitor = Monitor()
        assert not classify_walls(**changed, monitor=monitor)[1].any()
        assert monitor.warnings == reported


def test_a_roof_on_one_line_has_no_walls(scene):
    arrays, of = scene
    arrays["xyz"][of["roof"], 1] = 0.0
    assert not (classify_walls(**arrays)[1] == 1).any()


def test_heights_the_wrong_way_round_are_refused(scene):
    with pytest.raises(ValueError, match=r"minimum height of walls \(3 m\) is above the maximum height \(2.5 m\)"):
        classify_walls(**scene[0], min_height=3.0)
