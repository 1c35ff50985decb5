"""Constants of the modules behind a composite, with their lines in the code: fields of rules, and commented names."""

from __future__ import annotations

import ast
import importlib
import inspect
import re
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

from lidar_buildings.algorithms.pipeline import Pipeline
from lidar_buildings.algorithms.rules import rules_of

_ROOT = Path(__file__).resolve().parent.parent
_PACKAGE = "lidar_buildings.algorithms."
# Rooms that read, write, declare and report; their constants decide nothing about points.
_OTHER_ROOMS = ("cloud", "stage", "report", "simulation")


class Constant(NamedTuple):
    """A constant: its name with its module, value, unit, the reason for it, and its file and line."""

    name: str
    value: str
    unit: str
    why: str
    where: str


def constants_page(pipeline: Pipeline) -> str:
    """Return the page of the constants of a composite: by step, for modules that no earlier step has."""
    return _page(pipeline.title, _parts(pipeline))


def tiling_page() -> str:
    """Return the page of the constants of runs in tiles."""
    return _page("In tiles", [("Surveys", _modules_of("tiling"))], ("tiling",))


def _page(title: str, parts: list[tuple[str, list[str]]], rooms: tuple[str, ...] = ()) -> str:
    """Return a page of constants by part; only of some rooms, if these are given."""
    rows = ["---", "orphan: true", "---", f"# Constants of {title}", ""]
    rows += ["Numbers that follow from the cloud, and those that can be set, are on the pages of the algorithms.", ""]
    seen: set[str] = set()
    for part, names in parts:
        modules = [module for name in names for module in _behind(name, seen)]
        modules = [module for module in modules if not rooms or module.__name__[len(_PACKAGE) :].split(".")[0] in rooms]
        found = [constant for module in modules for constant in constants_of(module)]
        if found:
            rows += [f"## {part}", "", "| constant | value | unit | meaning and reason | line |"]
            rows += ["| --- | ---: | --- | --- | --- |"]
            rows += [f"| `{one.name}` | {one.value} | {one.unit} | {one.why} | `{one.where}` |" for one in found]
            rows.append("")
    return "\n".join(rows) + "\n"


def _parts(pipeline: Pipeline) -> list[tuple[str, list[str]]]:
    """Return the parts of the page: measurements on the cloud first, then the stages in their order."""
    stages = {step.stage.name: step.stage for step in pipeline.steps}
    return [
        ("Sampling", _modules_of("sampling")),
        *((stage.title, [stage.function.__module__]) for stage in stages.values()),
    ]


def _modules_of(room: str) -> list[str]:
    """Return the names of the modules of a room."""
    return sorted(f"{_PACKAGE}{room}.{path.stem}" for path in (_ROOT / "algorithms" / room).glob("[a-z]*.py"))


def _behind(name: str, seen: set[str]) -> Iterator[ModuleType]:
    """Yield a module and those that it imports, with what these import, but for those seen before."""
    waiting = [name]
    while waiting:
        name = waiting.pop(0)
        parts = name[len(_PACKAGE) :].split(".")
        is_elsewhere = parts[0] in _OTHER_ROOMS or (len(parts) < 2 and parts[0] != "criteria")
        if name in seen or not name.startswith(_PACKAGE) or is_elsewhere:
            continue
        seen.add(name)
        module = importlib.import_module(name)
        yield module
        waiting += _imported(module)


def _imported(module: ModuleType) -> list[str]:
    """Return the modules of the package from which a module imports names."""
    nodes = ast.walk(ast.parse(inspect.getsource(module)))
    parts = module.__name__.split(".")
    return [
        ".".join([*parts[: -node.level], node.module])
        for node in nodes
        if isinstance(node, ast.ImportFrom) and node.level and node.module
    ]


def constants_of(module: ModuleType) -> list[Constant]:
    """Return the constants of a module in the order of their lines."""
    lines = inspect.getsource(module).splitlines()
    file = Path(inspect.getfile(module)).resolve().relative_to(_ROOT).as_posix()
    found = [
        (_line_of(lines, field.name), name, str(value), field.metadata["unit"], field.metadata["why"])
        for name, value, field in rules_of(module)
    ]
    short = module.__name__.rsplit(".", 1)[1]
    return [
        Constant(f"{short}.{name}", value, unit, re.sub(r":\w+:`\.?", "`", why), f"{file}:{line}")  # names, no roles
        for line, name, value, unit, why in sorted([*found, *_commented(lines)], key=lambda one: one[0])
    ]


def _line_of(lines: list[str], field: str) -> int:
    """Return the number of the line in which a field of rules is declared."""
    declared = re.compile(rf"    {field}: ")
    return next(number for number, line in enumerate(lines, 1) if declared.match(line))


def _commented(lines: list[str]) -> Iterator[tuple[int, str, str, str, str]]:
    """Yield line, name, value, unit and comment of each number that a module or a class of rules names."""
    tree = ast.parse("\n".join(lines))
    for node in tree.body:
        if isinstance(node, ast.Assign) and len(node.targets) == 1:
            comment = _above(lines, node.lineno) or _after(lines, node.lineno)
            pairs = _pairs(node.targets[0], node.value) if comment else []
            for name, value in pairs:
                yield node.lineno, name, value, _unit(comment) if len(pairs) == 1 else "", comment
        elif isinstance(node, ast.ClassDef) and node.decorator_list:
            yield from _of_class(lines, node, _instance(tree, node.name))


def _of_class(lines: list[str], node: ast.ClassDef, instance: str) -> Iterator[tuple[int, str, str, str, str]]:
    """Yield the same of the fields of a class; a comment above holds for those after it without one of their own."""
    shared = ""
    for field in node.body:
        if isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name) and field.value is not None:
            shared = _above(lines, field.lineno) or shared
            comment = _after(lines, field.lineno) or shared
            if comment and _is_number(field.value):
                name, value = f"{instance}.{field.target.id}", ast.unparse(field.value)
                yield field.lineno, name, value, _unit(comment), comment


def _instance(tree: ast.Module, name: str) -> str:
    """Return the name of the instance of a class that a module makes, or of the class."""
    for node in tree.body:
        value = node.value if isinstance(node, ast.Assign) else None
        if isinstance(value, ast.Call) and isinstance(value.func, ast.Name) and value.func.id == name:
            return ast.unparse(node.targets[0])
    return name


def _unit(comment: str) -> str:
    """Return the first unit in parentheses of a comment, none of one that is shared by several constants."""
    if re.match(r"\w+, \w+: ", comment):
        return ""
    units = "m|m²|°|s|point spacings|spacings|deviations|standard deviations|share|ratio|points|cells|samples|halos"
    found = re.search(rf"\(({units})\)", comment)
    return found[1] if found else ""


def _pairs(target: ast.expr, value: ast.expr) -> list[tuple[str, str]]:
    """Return the names in capitals and their numbers of an assignment, none if it is one of something else."""
    targets, values = ([one] if not isinstance(one, ast.Tuple) else one.elts for one in (target, value))
    if len(targets) == 1 and isinstance(value, ast.Tuple):
        targets, values = [target], [value]
    pairs = [
        (name.id, ast.unparse(number))
        for name, number in zip(targets, values)
        if isinstance(name, ast.Name) and name.id.strip("_").isupper() and _is_number(number)
    ]
    return pairs if len(pairs) == len(targets) else []


def _is_number(node: ast.expr) -> bool:
    """Return whether an expression holds numbers only, with operators, tuples and conversions of angles."""
    allowed = (ast.Constant, ast.Tuple, ast.UnaryOp, ast.BinOp, ast.operator, ast.unaryop, ast.expr_context)
    nodes = list(ast.walk(node))
    numbers = [one for one in nodes if isinstance(one, ast.Constant)]
    return (
        bool(numbers)
        and all(isinstance(one, allowed) for one in nodes)
        and all(isinstance(one.value, (int, float)) and not isinstance(one.value, bool) for one in numbers)
    )


def _above(lines: list[str], line: int) -> str:
    """Return the comment that ends above a line."""
    own: list[str] = []
    for above in reversed(lines[: line - 1]):
        if not above.lstrip().startswith("#"):
            break
        own.append(above.lstrip("#: "))
    return " ".join(reversed(own)).replace("|", "\\|")


def _after(lines: list[str], line: int) -> str:
    """Return the comment at the end of a line."""
    found = re.search(r"\s#:? (.*)$", lines[line - 1])
    return found[1].replace("|", "\\|") if found else ""
