"""The worked example of CONTRIBUTING.md, taken through its steps in a copy: five files, and it is in the toolbox."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
MODULE = "algorithms/segmentation/segment_storeys.py"
TEST = "tests/algorithms/segmentation/test_segment_storeys.py"

# Step 9 in two lines: truth by construction.
TEST_TEXT = '''"""Storeys of a tower of points."""

from __future__ import annotations

import numpy as np

from lidar_buildings.algorithms.segmentation.segment_storeys import segment_storeys


def test_storeys_are_counted_from_the_lowest_point():
    z = np.repeat([2.0, 5.5, 9.0], 4)
    np.testing.assert_array_equal(segment_storeys(np.column_stack([z, z, z])), np.repeat([1, 2, 3], 4))
'''

ASKS_THE_PROVIDER = """
import conftest
from pathlib import Path
from qgis.core import QgsApplication

application = QgsApplication([], False)
QgsApplication.initQgis()
from lidar_buildings.provider.provider import Provider

provider = Provider()
QgsApplication.processingRegistry().addProvider(provider)
algorithm = provider.algorithm("segmentstoreys")
print(algorithm.displayName(), "|", algorithm.group(), "|", algorithm.parameterDefinition("HEIGHT").description())
print(Path(algorithm.helpUrl().removeprefix("file://")).is_file(), "<img" in algorithm.shortHelpString())
QgsApplication.exitQgis()
"""


def inserted(path: Path, before: str, text: str) -> None:
    """Put a line before the first one that starts so."""
    source = path.read_text(encoding="utf-8")
    assert before in source
    path.write_text(source.replace(before, text + before, 1), encoding="utf-8")


@pytest.fixture(scope="module")
def copy(tmp_path_factory) -> Path:
    """A copy of the project with the stage of the example, after its ten steps."""
    copy = tmp_path_factory.mktemp("copy") / "lidar_buildings"
    unneeded = shutil.ignore_patterns(
        ".git", ".venv", "__pycache__", "_build", "demo", "dist", "benchmarks", ".*_cache"
    )
    shutil.copytree(ROOT, copy, ignore=unneeded)
    (example,) = re.findall(r"```python\n(.*?)```", (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"), re.DOTALL)
    (copy / MODULE).write_text(example, encoding="utf-8")
    stages = copy / "algorithms" / "stages.py"
    inserted(stages, '    "segmentation.segment_surfaces",\n', '    "segmentation.segment_storeys",\n')
    inserted(copy / "tests" / "test_contract.py", '    "segmentsurfaces",\n', '    "segmentstoreys",\n')
    (copy / TEST).write_text(TEST_TEXT, encoding="utf-8")
    inserted(copy / "CHANGELOG.md", "- ", "- *Segment storeys* numbers the storeys of a cloud.\n")
    run(copy, "scripts/help_pictures.py", "segmentstoreys")
    return copy


def run(copy: Path, *arguments: str) -> str:
    """Return what a Python process in the copy prints; it must succeed."""
    command = ["scripts/offscreen.sh", sys.executable, *arguments]
    done = subprocess.run(command, cwd=copy, capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    return done.stdout


def test_five_files_are_written_by_hand(copy):
    """All others that differ are generated."""
    files = {path.relative_to(copy) for path in copy.rglob("*") if path.is_file() and "__pycache__" not in path.parts}
    changed = {file for file in files if not same(ROOT / file, copy / file)}
    generated = {file for file in changed if file.parts[0] == "resources"}
    assert {str(file) for file in changed - generated} == {
        MODULE,
        TEST,
        "algorithms/stages.py",
        "tests/test_contract.py",
        "CHANGELOG.md",
    }
    assert {file.name for file in generated} == {"segmentstoreys.png"}


def same(one: Path, other: Path) -> bool:
    """Return whether two files are there and have the same content."""
    return one.is_file() and one.read_bytes() == other.read_bytes()


def test_it_is_in_the_toolbox_with_help_and_picture(copy):
    assert run(copy, "-c", ASKS_THE_PROVIDER).splitlines() == [
        "Segment storeys | Segmentation | Height (m)",
        "True True",
    ]


@pytest.mark.slow
def test_it_keeps_the_contract_and_passes_its_own_test(copy):
    tests = ["tests/test_contract.py", TEST, MODULE, "tests/algorithms/test_help.py"]
    run(copy, "-m", "pytest", "-q", "-p", "no:cacheprovider", *tests, "-k", "storeys or frozen or pages or picture")
