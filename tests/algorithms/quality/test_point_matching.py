"""The same points are found again in any order, others are refused."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.asprs import parse_classes
from lidar_buildings.algorithms.quality.point_matching import match_points


@pytest.fixture
def cloud(rng):
    """Coordinates as a file with millimeters gives them, a quarter of them twice."""
    xyz = rng.integers(0, 20_000, (2000, 3)) * 0.001 + [600_000.0, 5_000_000.0, 0]
    return np.concatenate([xyz, xyz[::4]])


def test_any_order(cloud, rng):
    order = rng.permutation(len(cloud))
    found = match_points(cloud, cloud[order])
    assert len(np.unique(found)) == len(cloud)
    assert (cloud[order][found] == cloud).all()


def test_points_at_one_position_keep_their_order():
    xyz = np.array([[0.0, 0, 0], [1, 1, 1], [0, 0, 0]])
    assert match_points(xyz, xyz).tolist() == [0, 1, 2]
    assert match_points(xyz, np.array([[1.0, 1, 1], [0, 0, 0], [0, 0, 0]])).tolist() == [1, 0, 2]


def test_rounding_of_the_file_is_forgiven(cloud, rng):
    order = rng.permutation(len(cloud))
    # Feet brought to meters fall anywhere between millimeters, and differ in the last bits.
    feet, again = cloud * 0.3048, (cloud[order] * 0.3048 + 1e-9)
    found = match_points(feet, again)
    assert np.abs(again[found] - feet).max() < 1e-6
    assert len(np.unique(found)) == len(cloud)


def test_points_on_a_border_of_rounding_are_found():
    xyz = np.array([[0.0, 0, 0], [0.0015, 0, 0], [5, 5, 5]])
    other = np.array([[5.0, 5, 5], [0.0015 + 1e-7, 0, 0], [0, 0, 0]])
    assert match_points(xyz, other - [0, 0, 0]).tolist() == [2, 1, 0]


def test_a_reference_with_more_points_will_do(cloud, rng):
    more = np.concatenate([rng.uniform(0, 1, (50, 3)), cloud])
    assert (match_points(cloud, more) >= 50).all()


def test_other_points_are_refused(cloud):
    moved = cloud.copy()
    moved[7, 2] += 0.01
    with pytest.raises(
        ValueError, match=r"1 of 2500 points are not in the reference, the first at 6\d+\.\d{3}, .*order"
    ):
        match_points(moved, cloud)
    with pytest.raises(ValueError, match="1 of 2500 points are not in the reference"):
        match_points(cloud, cloud[1:])


def test_classes_in_words():
    assert parse_classes("7, 18,64-67").tolist() == [7, 18, 64, 65, 66, 67]
    assert parse_classes(" ").tolist() == []
    for text in ("7;18", "300", "9-7", "1-2-3", "noise", "-3"):
        with pytest.raises(ValueError, match="Ignored classes must be numbers from 0 to 255"):
            parse_classes(text)
