"""Tests on real clouds run where these are, and say so where they aren't."""

import pytest

from lidar_buildings.tests.real.clouds import DATA, SCORER


@pytest.fixture(autouse=True, scope="session")
def real_clouds():
    """Skip everything here without the folder of real clouds and the program that scores it."""
    for path in (DATA, SCORER):
        if not path.exists():
            pytest.skip(f"no real clouds: {path} is missing; LIDAR_BUILDINGS_DATA names another folder of data")
