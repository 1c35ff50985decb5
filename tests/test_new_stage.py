"""The worked example of CONTRIBUTING.md, taken through its steps in a copy: four files, and it is in the toolbox."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
MODULE = "algorithms/segmentation/segment_storeys.py"
TEST = "tests/algorithms/segmentation/test_segment_storeys.py"

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


@pytest.fixture(scope="module")
def copy(tmp_path_factory) -> Path:
    """A copy of the project with the stage of the example, after its ten steps."""
    copy = tmp_path_factory.mktemp("copy") / "lidar_buildings"
    unneeded = shutil.ignore_patterns(
        *(".git", ".venv", "__pycache__", "_build", "demo", "dist", "benchmarks", ".*_cache"),
        *(".qgis-settings", "build", "*.egg-info", ".pythons", ".hypothesis"),
    )
    shutil.copytree(ROOT, copy, ignore=unneeded)
    run(copy, "scripts/new_stage.py", "segmentation.segment_storeys")
    run(copy, "scripts/help_pictures.py", "segmentstoreys")
    return copy


def run(copy: Path, *arguments: str) -> str:
    """Return what a Python process in the copy prints; it must succeed."""
    command = ["scripts/offscreen.sh", sys.executable, *arguments]
    done = subprocess.run(command, cwd=copy, capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    return done.stdout


def test_four_files_are_edited(copy):
    """All others that differ are generated."""
    files = {path.relative_to(copy) for path in copy.rglob("*") if path.is_file() and "__pycache__" not in path.parts}
    changed = {file for file in files if not same(ROOT / file, copy / file)}
    generated = {file for file in changed if file.parts[0] == "resources"}
    assert {str(file) for file in changed - generated} == {
        MODULE,
        TEST,
        "algorithms/stages.py",
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
    said = run(copy, "-m", "pytest", "-q", "-p", "no:cacheprovider", *tests, "-k", "storeys or pages or picture")
    assert " passed" in said


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("segmentation.segment_storeys", "already"),
        ("nowhere.segment_rooms", "no room with stages"),
        ("segmentation.rooms", "no verb with its object"),
        ("", "no verb with its object"),
    ],
)
def test_names_that_do_not_fit_are_refused(copy, name, why):
    before = (copy / "algorithms" / "stages.py").read_bytes()
    command = [sys.executable, "scripts/new_stage.py", name]
    done = subprocess.run(command, cwd=copy, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr.count("\n")) == (1, 1)
    assert why in done.stderr
    assert (copy / "algorithms" / "stages.py").read_bytes() == before


@pytest.mark.slow
def test_it_passes_the_linters(copy):
    """A stage that was begun needs no mending before the first change."""
    # The folder is no repository, so that generated files would be checked, too.
    run(copy, "-m", "ruff", "check", "algorithms", "provider", "scripts", "tests")
    run(copy, "-m", "ruff", "format", "--check", MODULE, TEST)
    run(copy, "scripts/words.py")
    run(copy, "scripts/metadata.py", "--check")
