"""Windows and doors of scanned shop fronts, held to the table of ``benchmarks/facades.py fronts``."""

import pytest

from lidar_buildings.tests.real.clouds import path_of
from lidar_buildings.tests.real.fronts import FRONTS, front_figures

# Front: windows and doors that are there, and least that are found of each.
LEAST = {"facades/nuist-facade-1": ((4, 4), (4, 4)), "facades/nuist-facade-3": ((4, 3), (7, 5))}


@pytest.mark.parametrize("name", FRONTS)
def test_windows_and_doors_of_fronts_are_found_and_none_invented(name):
    if not path_of(name).exists():
        pytest.skip(f"{path_of(name)} is missing")
    rows, invented = front_figures(name)
    assert invented == 0
    for (kind, count, found, right, edges), (true, least) in zip(rows, LEAST[name]):
        assert count == true, kind
        assert found >= least, kind
        assert right >= least - 1
        # Within 10 cm, the aim at these densities.
        assert sorted(edges)[len(edges) // 2] < 0.1
