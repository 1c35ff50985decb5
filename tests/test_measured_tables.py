"""Tables of measured figures in the documentation match the files that benchmarks wrote."""

from __future__ import annotations

import importlib.util
import json
import shutil
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
MEASURED = ROOT / "docs" / "measured"


@pytest.fixture(scope="module")
def tables():
    spec = importlib.util.spec_from_file_location("measured_tables", ROOT / "scripts" / "measured_tables.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_pages_have_the_figures_of_the_files(tables):
    for name in tables.PAGES:
        page = (ROOT / "docs" / name).read_text(encoding="utf-8")
        assert tables.filled(page) == page
    shown = "".join((ROOT / "docs" / name).read_text(encoding="utf-8") for name in tables.PAGES)
    assert all(f"<!-- measured: {name} -->" in shown for name in tables.TABLES)


@pytest.mark.parametrize("path", sorted(MEASURED.glob("*.json")), ids=lambda path: path.stem)
def test_files_name_a_clean_commit_the_day_and_the_machine(path):
    content = json.loads(path.read_text(encoding="utf-8"))
    assert len(content["commit"]) == 40
    assert content["changed"] is False
    assert content["date"][:2] == "20"
    assert {"cores", "python", "numpy"} < set(content["machine"])


def test_another_figure_makes_another_page(tables, tmp_path):
    for path in MEASURED.glob("*.json"):
        shutil.copy(path, tmp_path)
    content = json.loads((tmp_path / "photos.json").read_text(encoding="utf-8"))
    content["rows"][0]["F"] = 12.34
    (tmp_path / "photos.json").write_text(json.dumps(content), encoding="utf-8")
    page = (ROOT / "docs" / "accuracy.md").read_text(encoding="utf-8")
    assert "**12.3**" in tables.filled(page, tmp_path)


def test_a_row_that_the_file_has_not_is_refused(tables, tmp_path):
    content = json.loads((MEASURED / "photos.json").read_text(encoding="utf-8"))
    (tmp_path / "photos.json").write_text(json.dumps({**content, "rows": content["rows"][1:]}), encoding="utf-8")
    with pytest.raises(ValueError, match="exactly one is needed"):
        tables.written(tables.TABLES["photos"], tmp_path)
