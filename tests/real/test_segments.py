"""Segments of the recorded lines of real scans: streets and roofs are smooth, crowns are not.

The classes of the points are by hand and independent of the method. Where lines of the scanner are recorded, streets
are smooth segments almost whole, crowns are none, and a segment holds one class of points: facades and steps part
streets from roofs.
"""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.files import read_cloud
from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.tests.real.clouds import path_of

AMSTERDAM, ST_BARTH = "buildings/ahn-amsterdam-1", "buildings/ign-stbarth"


def segments(name):
    """Return the segment (n,) and the true class (n,) of each point, from the lines of the scanner."""
    path = path_of(name)
    if not path.exists():
        pytest.skip(f"{path} is not there")
    truth = np.load(path.with_suffix(".truth.npz"))["classification"]
    return run_stage(STAGES["segment_recorded_lines"], read_cloud(path)).cloud.get("segment_id"), truth


def test_streets_are_segments_and_trees_are_not_and_no_segment_holds_both_streets_and_roofs():
    segment_id, truth = segments(AMSTERDAM)
    is_of_one = segment_id > 0
    assert is_of_one[truth == 2].mean() > 0.95
    assert is_of_one[truth == 1].mean() < 0.03
    number = segment_id[is_of_one]
    counts = np.zeros((number.max() + 1, 256), np.int64)
    np.add.at(counts, (number, truth[is_of_one]), 1)
    assert counts.max(axis=1).sum() > 0.99 * len(number)


def test_roofs_of_villas_are_segments_and_crowns_are_not():
    segment_id, truth = segments(ST_BARTH)
    assert (segment_id[truth == 6] > 0).mean() > 0.7
    assert (segment_id[truth == 5] > 0).mean() < 0.1
