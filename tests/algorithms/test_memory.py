"""Freed memory goes back to the system."""

import sys
from pathlib import Path

import numpy as np
import pytest

from lidar_buildings.algorithms import memory


def held():
    """Return the bytes of memory that this process holds."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="other systems return it by themselves")
def test_what_arrays_have_left_goes_back_to_the_system():
    # Arrays too small to have pages of their own, every second of which stays.
    arrays = [np.ones(10_000) for _ in range(2000)]
    full = held()
    stays = arrays[::2]
    del arrays
    memory.return_freed()
    assert full - held() > 0.4 * 8e4 * len(stays)


def test_systems_without_such_a_function_do_without(monkeypatch):
    monkeypatch.setattr(memory.sys, "platform", "win32")
    memory.return_freed()
