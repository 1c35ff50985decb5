"""Freed memory goes back to the system."""

import mmap
import platform
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from lidar_buildings.algorithms import memory


def held():
    """Return the bytes of memory that this process holds."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * mmap.PAGESIZE


def test_this_computers_memory_is_known_or_taken_for_enough(monkeypatch):
    assert 1e8 < memory.installed_memory() < 1e15
    monkeypatch.delattr(memory.os, "sysconf")
    assert memory.installed_memory() == float("inf")


@pytest.mark.parametrize(("answers", "expected"), [(True, 16 * 1024.0**3), (False, float("inf"))])
def test_windows_is_asked_for_its_memory(monkeypatch, answers, expected):
    class Windows:
        """Answers in kilobytes; false without a table of the hardware."""

        @staticmethod
        def GetPhysicallyInstalledSystemMemory(kilobytes):  # noqa: N802 - Windows' name
            kilobytes._obj.value = 16 * 1024**2
            return answers

    monkeypatch.setattr(memory.sys, "platform", "win32")
    monkeypatch.setattr(memory.ctypes, "windll", SimpleNamespace(kernel32=Windows), raising=False)
    assert memory.installed_memory() == expected


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
    asked = []
    monkeypatch.setattr(memory.ctypes, "CDLL", asked.append)
    monkeypatch.setattr(memory.sys, "platform", "win32")
    memory.return_freed()
    memory.share_freed()
    assert not asked


# Eight threads, one after the other, fill 16 MB with arrays too small to have pages of their own, and keep the last.
TURNS = """
import sys, threading
sys.path.insert(0, {root!r})
import conftest
import numpy as np
from lidar_buildings.algorithms import memory
from lidar_buildings.tests.algorithms.test_memory import held
{first}
turn, ended, kept = [threading.Event() for _ in range(9)], threading.Event(), []
turn[0].set()
def work(number):
    turn[number].wait()
    arrays = [np.ones(10_000) for _ in range(200)]
    kept.append(arrays[-1])
    del arrays
    turn[number + 1].set()
    ended.wait()
before = held()
threads = [threading.Thread(target=work, args=(number,)) for number in range(8)]
[thread.start() for thread in threads]
turn[8].wait()
print(held() - before)
ended.set()
"""


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="other libraries have no arenas")
def test_threads_share_what_others_have_freed():
    taken = []
    for first in ("", "memory.share_freed()"):
        script = TURNS.format(root=str(Path(__file__).parents[2]), first=first)
        done = subprocess.run([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True, check=True)
        taken.append(int(done.stdout))
    assert taken[1] < taken[0] / 3
