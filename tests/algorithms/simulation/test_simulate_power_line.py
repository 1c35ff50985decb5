"""The simulated lines: wires are parabolas between masts, and everything else is where it was put."""

import numpy as np
import pytest

from lidar_buildings.algorithms.simulation.simulate_power_line import simulate_power_line


@pytest.fixture(scope="module")
def made():
    return simulate_power_line(size=150.0, density=8.0, span=60.0, angle=0.0, forest=0.0, trees=0.0, seed=2)


def test_wires_hang_as_parabolas(made):
    """Of each wire of the transmission line, from tower to tower, heights above the line of its ends are a parabola."""
    xyz, classes, segment = made[0], made[1], made[-1]
    is_high = (classes == 14) & (xyz[:, 2] - 0.04 * (xyz[:, 1] - 75) > 15)
    # Six bundles of two, and the guard wire.
    assert len(np.unique(segment[is_high])) == 13
    # Towers are at 45 and 105 m.
    for wire in np.unique(segment[is_high]):
        rows = is_high & (segment == wire) & (xyz[:, 0] > 45.5) & (xyz[:, 0] < 104.5)
        curve = np.polyfit(xyz[rows, 0], xyz[rows, 2], 2)
        assert np.abs(np.polyval(curve, xyz[rows, 0]) - xyz[rows, 2]).max() < 0.15
        assert curve[0] == pytest.approx(4 * 0.03 * 60 / 60**2, rel=0.05)


def test_there_are_masts_houses_and_ground(made):
    xyz, classes = made[:2]
    assert set(np.unique(classes)) == {2, 6, 14, 15}
    above = xyz[:, 2] - 0.04 * (xyz[:, 1] - 75)
    assert above[classes == 15].max() == pytest.approx(30, abs=0.5)
    assert np.abs(above[classes == 2]).max() < 0.2


def test_too_many_pulses_are_refused():
    with pytest.raises(ValueError, match="more than 50 million; lower the density or the size"):
        simulate_power_line(size=1000.0, density=100.0)
