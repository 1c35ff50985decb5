"""Docstrings of the core: functions with many parameters describe each, and stages begin near their names."""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

from lidar_buildings.algorithms.stages import STAGES

ROOT = Path(__file__).resolve().parent.parent / "algorithms"

# As they are when tests are collected: tests of the provider add toys of their own while they run.
ALL = dict(STAGES)

# Parameters from which on a public function has sections, and lines from the name of a stage to its body.
MANY, FAR = 4, 120


@cache
def functions() -> list[tuple[str, ast.FunctionDef]]:
    """Return the public functions of all modules, by module and name."""
    found = []
    for path in sorted(ROOT.rglob("*.py")):
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
                found.append((f"{path.relative_to(ROOT).with_suffix('')}:{node.name}", node))
    return found


def is_stage(node: ast.FunctionDef) -> bool:
    """Return whether a function is decorated as a stage."""
    return any(getattr(getattr(one, "func", one), "id", "") == "stage" for one in node.decorator_list)


def parameters(node: ast.FunctionDef) -> list[str]:
    """Return the names of the parameters of a function."""
    return [one.arg for one in (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs)]


def without_section(name: str, node: ast.FunctionDef) -> list[str]:
    """Return the parameters that the section of a function does not describe."""
    doc = ast.get_docstring(node) or ""
    section = re.search(r"^Parameters\n-+\n(.*?)(?:\n\n[A-Z]\w+\n-|\Z)", doc, re.MULTILINE | re.DOTALL)
    described = re.findall(r"^([\w, ]+?)(?: : .+)?\n +\S", section.group(1), re.MULTILINE) if section else []
    named = {one.strip() for line in described for one in line.split(",")}
    return [f"{name}({one})" for one in parameters(node) if one not in named]


def test_functions_with_many_parameters_describe_each():
    many = [(name, node) for name, node in functions() if len(parameters(node)) >= MANY and not is_stage(node)]
    assert len(many) > 100
    assert not [one for name, node in many for one in without_section(name, node)]


def test_functions_with_many_parameters_say_what_they_return():
    many = [(name, node) for name, node in functions() if len(parameters(node)) >= MANY and not is_stage(node)]
    returning = [(name, node) for name, node in many if ast.unparse(node.returns) != "None"]
    docs = {name: ast.get_docstring(node) or "" for name, node in returning}
    sections = re.compile(r"^(Returns|Yields)\n-", re.MULTILINE)
    summaries = re.compile(r"\b([Rr]eturn|Yield)s?\b")
    silent = [name for name, doc in docs.items() if not summaries.search(doc.split("\n\n")[0])]
    assert not [name for name in silent if not sections.search(docs[name])]


def test_the_body_of_a_stage_is_near_its_name():
    nodes = {node.name: node for _, node in functions() if is_stage(node)}
    assert nodes.keys() == ALL.keys()
    assert not [name for name, node in nodes.items() if node.body[1].lineno - node.lineno > FAR]


def test_a_stage_has_an_example_that_runs():
    """The doctests of its module run it."""
    assert not [name for name, stage in ALL.items() if ">>>" not in stage.section("Examples")]


def test_headings_of_sections_are_on_lines_of_their_own():
    assert not [name for name, node in functions() if re.search(r"\w -{3,}|-{3,} \w", ast.get_docstring(node) or "")]
