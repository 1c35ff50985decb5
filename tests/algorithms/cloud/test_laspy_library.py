"""laspy is imported when needed, without its optional packages; where it is missing, an error names it."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]


def run(script):
    """Run a script in a process of its own, in which every warning is an error; return what it printed."""
    command = [sys.executable, "-W", "error", "-c", "import sys, conftest\n" + script]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout.split("\n")


def test_laspy_is_imported_at_the_first_file_and_brings_neither_a_second_proj_nor_the_web():
    """pyproj, where it is installed, was loaded with laspy and may warn about its own data."""
    said = run(
        "from lidar_buildings.algorithms import STAGES\n"
        "from lidar_buildings.algorithms.cloud.cloud import create_cloud\n"
        "assert all(STAGES.values())\n"
        "print('laspy' in sys.modules)\n"
        "create_cloud({'xyz': [[0, 0, 0]]})\n"
        "print(*(name in sys.modules for name in ('laspy', 'pyproj', 'requests')))\n"
    )
    assert said[:2] == ["False", "True False False"]


def test_without_laspy_one_sentence_says_so(make_las):
    said = run(
        "sys.modules['laspy'] = None\n"
        "from lidar_buildings.algorithms.cloud.files import read_cloud\n"
        "try:\n"
        f"    read_cloud({str(make_las())!r})\n"
        "except ValueError as error:\n"
        "    print(error)\n"
    )
    assert said[0] == "Point clouds need the Python package laspy, which is not installed; install laspy."
