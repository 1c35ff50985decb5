"""What takes its time is made once by all processes of a run."""

import time
from concurrent.futures import ThreadPoolExecutor
from weakref import ref

import numpy as np

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.tests.shared_results import SHARED_RESULTS, made_once


def test_one_makes_what_the_others_wait_for(tmp_path, monkeypatch):
    monkeypatch.setenv(SHARED_RESULTS, str(tmp_path))
    made = []

    def make():
        made.append(time.sleep(0.1))
        return np.arange(3)

    with ThreadPoolExecutor(4) as pool:
        results = list(pool.map(lambda _: made_once("a/b", make), range(4)))
    assert len(made) == 1
    assert [one.tolist() for one in results] == [[0, 1, 2]] * 4
    assert made_once("a/c", make).tolist() == [0, 1, 2]
    assert len(made) == 2


def test_a_cloud_is_read_as_it_was_made(tmp_path, monkeypatch):
    """It refers to the coordinates that it made last, which no file can hold."""
    monkeypatch.setenv(SHARED_RESULTS, str(tmp_path))
    xyz = np.arange(30.0).reshape(10, 3)
    cloud = create_cloud({"xyz": xyz, "classification": np.arange(10, dtype=np.uint8)})
    held = cloud.get("xyz")
    made_once("cloud", lambda: (cloud, ref(held)))
    again, gone = made_once("cloud", lambda: None)
    assert gone() is None
    assert again is not cloud
    np.testing.assert_array_equal(again.to_map(again.get("xyz")), xyz)
    np.testing.assert_array_equal(again.get("classification"), np.arange(10))


def test_without_a_folder_each_process_makes_its_own(monkeypatch):
    monkeypatch.delenv(SHARED_RESULTS, raising=False)
    assert [made_once("a", lambda value=value: value) for value in (1, 2)] == [1, 2]
