"""References of docstrings and pages are in docs/references.bib, by their keys."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
BIB = (ROOT / "docs" / "references.bib").read_text(encoding="utf-8")
KEYS = set(re.findall(r"^@\w+\{(\w+),", BIB, re.MULTILINE))

# Proceedings, reports and patents that have no DOI.
WITHOUT_DOI = {"asprs2014", "asprs2019", "axelsson2000", "cityjson2024", "ester1996", "gorte2002", "gorte2004"}
WITHOUT_DOI |= {"hough1962", "ign2023", "melzer2004", "rabbani2005", "sithole2003", "usgs2024", "vosselman2001"}
WITHOUT_DOI |= {"garland1995", "vosselman2004", "gltf2021", "tiles2023", "wiedemann1998", "santos2019", "weinmann2017"}
# Their DOIs are not in any source that could be read: a list of references, or the publisher's page.
WITHOUT_DOI |= {"hoefle2009", "hoover1996", "hrutka2022", "jiang1994", "kimme1975", "malandain1992", "murakami1999"}
WITHOUT_DOI |= {"avbelj2015", "palagyi1999", "rutzinger2009", "sampath2007"}


def sections(path: Path) -> list[str]:
    """Return the References sections of the docstrings of a module."""
    nodes = ast.walk(ast.parse(path.read_text(encoding="utf-8")))
    holders = (ast.Module, ast.ClassDef, ast.FunctionDef)
    docs = [ast.get_docstring(node) or "" for node in nodes if isinstance(node, holders)]
    return [
        found
        for doc in docs
        for found in re.findall(r"^References\n-+\n(.+?)(?:\n\n|\Z)", doc, re.MULTILINE | re.DOTALL)
    ]


# Parsing all modules would take two seconds of every collection.
MODULES = [
    path
    for path in sorted((ROOT / "algorithms").rglob("*.py"))
    if re.search(r"^ *References\n *-+\n", path.read_text(encoding="utf-8"), re.MULTILINE)
]


def test_sections_are_found():
    assert len(MODULES) > 60


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.stem)
def test_every_reference_has_a_key_of_the_list(path):
    found = sections(path)
    assert found
    for section in found:
        cited = re.findall(r"\[([a-z]+\d{4})\]", section)
        assert len(cited) >= max(1, len(re.findall(r"\b(?:19|20)\d\d(?:\.|\),) ", section)))
        assert set(cited) <= KEYS


def test_citations_of_the_pages_are_in_the_list():
    pages = [path.read_text(encoding="utf-8") for path in (ROOT / "docs").rglob("*.md")]
    cited = {key for page in pages for keys in re.findall(r"\{cite:\w+\}`([^`]+)`", page) for key in keys.split(",")}
    assert cited
    assert cited <= KEYS


def test_entries_have_their_doi():
    entries = re.findall(r"^@\w+\{(\w+),(.*?)(?=^@|\Z)", BIB, re.MULTILINE | re.DOTALL)
    assert {key for key, text in entries if not re.search(r"doi = \{10\.\d{4,}/\S+\}", text)} == WITHOUT_DOI
