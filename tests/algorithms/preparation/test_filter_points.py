"""Which points a filter keeps."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.preparation.filter_points import filter_points
from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stage import Monitor

XYZ = np.column_stack([np.arange(6.0), np.zeros(6), np.zeros(6)])
CLASSES = np.array([1, 2, 6, 7, 9, 64], np.uint8)
HEIGHTS = np.array([0.3, -0.1, 2.5, 2.6, np.nan, 0.2])


def kept(*arrays, **limits):
    return filter_points(XYZ, CLASSES, *arrays, **limits).tolist()


@pytest.mark.parametrize(
    ("text", "expected"),
    [("", [0, 1, 2, 3, 4, 5]), ("2", [1]), ("2, 6-9", [1, 2, 3, 4]), (" 64 ,1", [0, 5]), ("100-200", [])],
)
def test_classes(text, expected):
    assert kept(classes=text) == expected
    assert kept(classes=text, invert=True) == [i for i in range(6) if i not in expected]


@pytest.mark.parametrize(
    ("limits", "expected"),
    [
        ({"min_height": 0.3}, [0, 2, 3]),
        ({"max_height": 2.5}, [0, 1, 2, 5]),
        ({"min_height": 0.3, "max_height": 2.5}, [0, 2]),
        ({"min_height": 2.5, "max_height": 2.5}, [2]),
        ({}, [0, 1, 2, 3, 4, 5]),
    ],
)
def test_heights_with_their_limits_and_without_what_is_undefined(limits, expected):
    assert kept(HEIGHTS, **limits) == expected
    assert kept(HEIGHTS, **limits, invert=True) == [i for i in range(6) if i not in expected]


def test_all_limits_hold_together():
    intensity = np.array([5, 6, 7, 8, 9, 10], np.uint16)
    limits = {"classes": "1-9", "min_height": 0.0, "dimension": "Intensity", "low": 6, "high": 7.5}
    assert kept(HEIGHTS, intensity, **limits) == [2]
    assert kept(HEIGHTS, intensity, **limits, invert=True) == [0, 1, 3, 4, 5]


@given(st.lists(st.floats(-5, 5, allow_subnormal=False), min_size=1), st.floats(-5, 5), st.floats(0, 5))
def test_a_range_and_its_inverse_share_the_points(values, low, width):
    values = np.array(values)
    xyz, classes = np.zeros((len(values), 3)), np.ones(len(values))
    limits = {"dimension": "Z", "low": low, "high": low + width}
    inside = filter_points(xyz, classes, None, values, **limits)
    outside = filter_points(xyz, classes, None, values, **limits, invert=True)
    assert inside.tolist() == [i for i, value in enumerate(values) if low <= value <= low + width]
    assert sorted([*inside, *outside]) == list(range(len(values)))


def test_log_shows_the_range_of_what_is_not_limited():
    monitor = Monitor()
    filter_points(XYZ, CLASSES, HEIGHTS, np.arange(6), dimension="Z", high=3.0, min_height=0.0, monitor=monitor)
    assert monitor.values == {"max_height": 2.6, "low": 0.0}


def test_limits_may_be_as_large_as_values_are():
    """Times of some scanners count from 1970 and are past 10^9."""
    times = 1.7e9 + np.arange(6.0)
    made = filter_points(XYZ, CLASSES, None, times, dimension="GpsTime", low=1.7e9 + 2, high=1.7e9 + 4)
    assert made.tolist() == [2, 3, 4]


def test_limits_of_missing_dimensions_are_refused():
    with pytest.raises(ValueError, match="need HeightAboveGround; run 'Height above ground' first or set none"):
        kept(max_height=2.5)
    with pytest.raises(ValueError, match="are limits of a dimension; name it"):
        kept(high=2.5)
    with pytest.raises(ValueError, match=r"minimum \(3\) is above the maximum \(2.5\); exchange them"):
        kept(HEIGHTS, min_height=3.0, max_height=2.5)
    with pytest.raises(ValueError, match="Classes must be numbers from 0 to 255 and ranges such as 64-67, got 'roof'"):
        kept(classes="roof")


def test_the_cloud_keeps_everything_of_its_points_and_is_never_empty(rng):
    cloud = create_cloud(
        {
            "xyz": rng.uniform(0, 9, (6, 3)).round(3),
            "classification": CLASSES,
            "intensity": np.arange(6, dtype=np.uint16),
        }
    )
    made = run_stage(filter_points.stage, cloud, classes="6-64").cloud
    assert made.get("intensity").tolist() == [2, 3, 4, 5]
    np.testing.assert_array_equal(made.get("xyz"), cloud.get("xyz")[2:])
    made = run_stage(filter_points.stage, cloud, dimension="Intensity", low=4.0).cloud
    assert made.get("classification").tolist() == [9, 64]
    with pytest.raises(ValueError, match="Filter points leaves none of the points; choose wider limits"):
        run_stage(filter_points.stage, cloud, classes="100")
    with pytest.raises(ValueError, match="has no dimension 'Loudness'; it has"):
        run_stage(filter_points.stage, cloud, dimension="Loudness", low=4.0)
