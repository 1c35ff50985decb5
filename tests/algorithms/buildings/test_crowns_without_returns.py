"""A site of flat roofs amid smooth dry crowns, seen without second returns: as matched images and as a scan show it."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline, sampling_of
from lidar_buildings.tests.surfaces import box, mound, seen_from_above

ROOFS = (10, 10, 40, 34, 9.0), (48, 12, 70, 30, 6.0), (12, 46, 30, 70, 7.0)
# Easting, northing, radius and height; some touch a roof.
CROWNS = (43, 20, 4, 13), (36, 38, 5, 15), (60, 36, 5, 14), (52, 50, 6, 16), (66, 52, 6, 14), (40, 55, 5, 12)
# Normalized excess green of ground, roofs and crowns: leaves of a dry summer.
GREENNESS = {"ground": 0.12, "roof": -0.01, "crown": 0.06}


def site(rng, gaps):
    """Return the cloud, and which points are of crowns; ground shows in gaps of most crowns, or in none."""
    parts = [box(*roof[:4], roof[4], 0.3) for roof in ROOFS]
    parts += [mound(crown[:2], crown[2], crown[3], 0.1) for crown in CROWNS]
    xyz, part = seen_from_above(rng, *parts, side=80.0, density=30.0)
    is_crown = part > len(ROOFS)
    xyz[:, 2] += rng.normal(0, 0.02, len(xyz))
    patch = np.sin(xyz[:, 0] * 0.9) + np.sin(xyz[:, 1] * 0.8)
    seen = gaps & is_crown & (patch > -1) & (rng.random(len(xyz)) < 0.4)
    xyz[seen, 2] = 0.0
    is_crown &= ~seen
    kinds = np.select([is_crown, part > 0], [GREENNESS["crown"], GREENNESS["roof"]], GREENNESS["ground"])
    excess = kinds + rng.normal(0, 0.03, len(xyz))
    green = 90_000 * (1 + excess) / 3
    other = (90_000 - green) / 2
    colors = {name: band.astype(np.uint16) for name, band in (("red", other), ("green", green), ("blue", other))}
    return create_cloud({"xyz": xyz, **colors}), is_crown, (part > 0) & (part <= len(ROOFS))


@pytest.mark.parametrize("gaps", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_dry_crowns_are_no_buildings_in_either_kind_of_cloud(rng, gaps):
    cloud, is_crown, is_roof = site(rng, gaps)
    assert sampling_of(cloud).is_closed_surface() != gaps
    is_building = run_pipeline(PIPELINES["detect_buildings"], cloud, wanted=("output",)).cloud.get(
        "classification"
    ) == (PointClass.BUILDING)
    assert is_building[is_roof].mean() > 0.9
    assert is_building[is_crown].mean() < 0.05


@pytest.mark.slow
def test_without_color_they_are_called_buildings(rng):
    """They have the shape of roofs: only color distinguishes them."""
    cloud, is_crown, _ = site(rng, True)
    plain = create_cloud({"xyz": cloud.get("xyz") + cloud.origin})
    classes = run_pipeline(PIPELINES["detect_buildings"], plain, wanted=("output",)).cloud.get("classification")
    assert (classes[is_crown] == PointClass.BUILDING).mean() > 0.3
