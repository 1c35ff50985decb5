"""The zip for users: what QGIS's plugin repository asks of it, and that it holds what the plugin needs."""

from __future__ import annotations

import ast
import configparser
import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path, PurePosixPath

import pytest

from lidar_buildings.algorithms import packages
from lidar_buildings.scripts import metadata, scan

ROOT = Path(__file__).resolve().parent.parent
PLUGIN = "lidar_buildings"
LARGEST = 25e6  # bytes
REQUIRED_KEYS = (
    *("name", "description", "version", "qgisMinimumVersion", "author", "email", "about"),
    *("tracker", "repository", "homepage"),
)
COMPILED = {".so", ".pyd", ".dll", ".dylib", ".exe", ".o", ".a", ".pyc", ".pyo", ".class", ".jar", ".whl"}
# First bytes of programs for Linux, Windows and macOS.
PROGRAMS = (b"\x7fELF", b"MZ", b"\xcf\xfa\xed\xfe", b"\xca\xfe\xba\xbe")


@pytest.fixture(scope="module")
def made(tmp_path_factory) -> Path:
    """The zip, made as "make package" makes it."""
    folder = tmp_path_factory.mktemp("dist")
    subprocess.run([sys.executable, ROOT / "scripts/package.py", folder], check=True, capture_output=True)
    (path,) = folder.iterdir()
    return path


@pytest.fixture(scope="module")
def contents(made) -> dict[str, bytes]:
    with zipfile.ZipFile(made) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


@pytest.fixture(scope="module")
def general(contents) -> dict[str, str]:
    reader = configparser.ConfigParser()
    reader.optionxform = str
    reader.read_string(contents[f"{PLUGIN}/metadata.txt"].decode())
    return dict(reader["general"])


def test_make_package_runs_the_script_that_is_tested():
    planned = subprocess.run(["make", "-n", "package"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    assert "scripts/package.py" in planned


def test_make_package_scans_the_zip():
    planned = subprocess.run(["make", "-n", "package"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    assert planned.index("scripts/package.py") < planned.index("scripts/scan.py")


@pytest.mark.slow
def test_the_scanners_of_the_plugin_repository_find_nothing(made):
    assert scan.findings(made) == []


@pytest.mark.parametrize(
    ("planted", "found"),
    [
        ("import pickle\n\nthawed = pickle.loads(b'')\n", "bandit B301"),
        ("password = 'hunter2'\n", "bandit B105"),
        ("key = 'AKIAIOSFODNN7" + "EXAMPLE'\n", "detect-secrets"),
        ("import os\n", "flake8: ./lidar_buildings/planted.py:1:1: F401"),
        ("def\n", "bandit: ./lidar_buildings/planted.py"),
    ],
)
def test_a_planted_finding_fails(made, tmp_path, planted, found, capsys):
    archive = tmp_path / "planted.zip"
    with zipfile.ZipFile(archive, "w") as opened:
        opened.writestr(f"{PLUGIN}/planted.py", planted)
    assert scan.main(archive) == 1
    assert found in capsys.readouterr().out


def test_zip_is_named_after_its_version_and_not_too_large(made, general):
    assert made.name == f"{PLUGIN}-{general['version']}.zip"
    assert made.stat().st_size <= LARGEST


def test_one_top_folder_that_is_a_python_identifier(contents):
    tops = {PurePosixPath(name).parts[0] for name in contents}
    assert tops == {PLUGIN}
    assert PLUGIN.isidentifier()


def test_license_is_there_under_exactly_that_name(contents):
    assert b"GNU GENERAL PUBLIC LICENSE" in contents[f"{PLUGIN}/LICENSE"]


def test_nothing_hidden_compiled_or_cached(contents):
    for name, content in contents.items():
        path = PurePosixPath(name)
        assert not any(part.startswith(".") or part in {"__pycache__", "__MACOSX"} for part in path.parts), name
        assert path.suffix not in COMPILED, name
        assert not content.startswith(PROGRAMS), name


@pytest.mark.parametrize("key", REQUIRED_KEYS)
def test_required_keys_are_filled(general, key):
    assert general[key].strip()


def test_keys_have_the_form_that_the_repository_checks(general):
    assert re.fullmatch(r"\d+\.\d+\.\d+", general["version"])
    assert general["qgisMinimumVersion"] == "3.40"
    assert re.fullmatch(r"[^@\s]+@[^@\s]+\.[^@\s]+", general["email"])
    for key in ("tracker", "repository", "homepage"):
        assert re.fullmatch(r"https://\S+", general[key]), key
    assert general["hasProcessingProvider"] == "yes"
    assert "plugin" not in general["name"].lower()


def test_dependencies_are_named_in_about(general):
    for package in ("numpy", "lazrs", *packages.REQUIRED.values()):
        assert package in general["about"]


def test_icon_is_in_the_zip(contents, general):
    assert f"{PLUGIN}/{general['icon']}" in contents


@pytest.mark.parametrize(("folder", "page"), [("", "README.md"), ("docs/", "first_steps.md")])
def test_pictures_that_users_are_shown_are_in_the_zip(contents, folder, page):
    shown = re.findall(r"!\[[^]]*\]\(([^)]+)\)", contents[f"{PLUGIN}/{folder}{page}"].decode())
    assert shown
    assert not [name for name in shown if f"{PLUGIN}/{folder}{name}" not in contents]


def test_what_is_for_developers_stays_out(contents):
    folders = {PurePosixPath(name).parts[1] for name in contents}
    assert not folders & {"tests", "scripts", "Makefile", "conftest.py", "pyproject.toml", "demo", "dist"}


def test_everything_that_the_plugin_runs_on_is_in(contents):
    wanted = {"__init__.py", "metadata.txt", "README.md", "CHANGELOG.md", "requirements.txt"}
    for folder in ("algorithms", "provider", "resources"):
        files = (path for path in (ROOT / folder).rglob("*") if path.is_file() and "__pycache__" not in path.parts)
        wanted |= {path.relative_to(ROOT).as_posix() for path in files}
    assert not wanted - {str(PurePosixPath(name).relative_to(PLUGIN)) for name in contents}


def test_sources_are_written_for_the_oldest_python(contents):
    sources = {name: content for name, content in contents.items() if name.endswith(".py")}
    assert len(sources) > 100
    assert not [name for name, content in sources.items() if not is_of_python_39(content)]
    assert not is_of_python_39(b"match 1:\n    case 1: pass\n")


def is_of_python_39(content):
    try:
        ast.parse(content, feature_version=(3, 9))
    except SyntaxError:
        return False
    return True


def test_unpacked_zip_is_imported_under_its_name(made, tmp_path):
    with zipfile.ZipFile(made) as archive:
        archive.extractall(tmp_path)
    stages = "assert all(STAGES.values())"
    script = f"import {PLUGIN}; from {PLUGIN}.algorithms import STAGES, pipelines; {stages}; {PLUGIN}.classFactory"
    done = subprocess.run([sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_metadata_has_the_changelog():
    current = (ROOT / "metadata.txt").read_text(encoding="utf-8")
    filled = metadata.filled(current, (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"))
    assert filled == current, "run scripts/metadata.py"


def test_metadata_takes_the_newest_version_and_its_news():
    changelog = (
        "# Changelog\n\nHow to read it.\n\n## 1.2.0 (2030-01-02)\n\n- *Detect* is 90 % faster.\n\n### In detail\n\n"
        "- A tree.\n\n## 1.1.9\n\n- First.\n"
    )
    filled = metadata.filled("[general]\nname=A\nversion=0\nchangelog=old\n    older\n", changelog)
    reader = configparser.ConfigParser()
    reader.read_string(filled)
    assert reader["general"]["name"] == "A"
    assert reader["general"]["version"] == "1.2.0"
    assert reader["general"]["changelog"].split("\n") == [
        "",
        "1.2.0 (2030-01-02)",
        "- Detect is 90 % faster.",
    ]
    long = changelog.replace("- *Detect* is 90 % faster.", "\n".join(f"- {n}" for n in range(30)))
    reader.read_string(metadata.filled("[general]\nname=A\nversion=0\nchangelog=old\n", long))
    assert reader["general"]["changelog"].split("\n")[-1] == "- 9"


def test_metadata_refuses_a_changelog_without_a_version():
    with pytest.raises(ValueError, match="no heading like"):
        metadata.filled("version=\nchangelog=\n", "# Changelog\n")


def test_without_git_it_says_what_to_do(tmp_path):
    (tmp_path / "scripts").mkdir()
    for name in ("scripts/package.py", "metadata.txt"):
        shutil.copy(ROOT / name, tmp_path / name)
    command = [sys.executable, tmp_path / "scripts/package.py", tmp_path]
    nowhere = {**os.environ, "GIT_CEILING_DIRECTORIES": str(tmp_path.parent)}
    done = subprocess.run(command, check=False, capture_output=True, text=True, env=nowhere)
    assert done.returncode == 1
    assert done.stderr.startswith("git lists the files to ship, but can't here")
    assert not list(tmp_path.glob("*.zip"))
