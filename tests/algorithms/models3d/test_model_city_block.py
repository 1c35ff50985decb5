"""Model city block: a block seen from the street and from the air, whose scans are off each other."""

import json

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.algorithms.stage import MapFrame
from lidar_buildings.tests.blocks import seen_from
from lidar_buildings.tests.solid_validity import assert_valid_cityjson

BLOCK = PIPELINES["model_city_block"]
OFF = np.array([1.1, -0.6, 0.4])


@pytest.fixture(scope="module")
def made():
    air, street = (seen_from(view)[0] for view in ("airplane", "vehicle"))
    recorded = {name: air[name] for name in ("xyz", "return_number", "number_of_returns", "scan_angle", "gps_time")}
    cloud = create_cloud(recorded)
    reference = create_cloud({"xyz": street["xyz"] - OFF, "classification": np.zeros(len(street["xyz"]), np.uint8)})
    return run_pipeline(BLOCK, cloud, reference=reference), cloud.origin


def test_the_shift_between_the_scans_is_reported(made):
    values = made[0].report.values
    found = [values[name] for name in ("shift_x", "shift_y", "shift_z")]
    np.testing.assert_allclose(found, OFF, atol=0.15)
    assert values["residual"] < 0.15


def test_corners_along_the_street_are_those_of_the_fronts(made):
    """Half of them within 10 cm, the aim: the scans are coarse, and bays without roof points have no model."""
    results, origin = made
    corners = np.concatenate([rings[0][:-1, :2] for rings in results.layers["buildings"].geometries]) + origin[:2]
    fronts = np.concatenate([ring[:2, :2] for (ring,) in seen_from("vehicle")[1]["facades"].geometries])
    off = np.linalg.norm(fronts[:, None] - corners, axis=2).min(axis=1)
    assert np.median(off) < 0.1


def test_most_openings_that_were_seen_lie_in_their_wall(made):
    results, origin = made
    _, layers = seen_from("vehicle")
    found = np.array([ring[:-1].mean(axis=0) for (ring,) in results.layers["set_openings"].geometries]) + origin
    true = np.array([ring[:-1].mean(axis=0) for (ring,) in layers["openings"].geometries])
    off = np.linalg.norm(found[:, None] - true, axis=2).min(axis=1)
    assert len(found) >= 0.6 * len(true)
    assert np.mean(off < 0.4) >= 0.9
    text = "".join(results.files["cityjson"].pieces("CityJSON", MapFrame(np.asarray, "EPSG:25832")))
    assert_valid_cityjson(text)
    written = json.loads(text)
    kinds = [
        surface["type"]
        for building in written["CityObjects"].values()
        for geometry in building["geometry"]
        for surface in geometry["semantics"]["surfaces"]
    ]
    assert {"Window", "Door", "WallSurface", "RoofSurface", "GroundSurface"} == set(kinds)
    assert kinds.count("Window") + kinds.count("Door") == len(found)


def test_the_second_cloud_is_asked_for():
    cloud = create_cloud({"xyz": np.zeros((1, 3))})
    with pytest.raises(ValueError, match=r"Model city block reads a second point cloud \(reference\); give one\."):
        run_pipeline(BLOCK, cloud)
