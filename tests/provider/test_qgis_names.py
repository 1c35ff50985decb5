"""Where the parts of QGIS lie that the plugin imports: in this QGIS, and in later ones as far as they moved."""

from __future__ import annotations

import ast
import enum
import importlib
from pathlib import Path

import pytest

PROVIDER = Path(__file__).resolve().parents[2] / "provider"

# Processing's Python parts, which QGIS does not promise to keep, with where they lie from QGIS 4.2 on and what the
# plugin does without them. The public interface, qgis.core and qgis.gui, stays through a major version.
PROCESSING = {
    "processing.core.ProcessingConfig.ProcessingConfig": "the same",
    "processing.core.ProcessingConfig.Setting": "the same",
    "processing.execAlgorithmDialog": "the same",
    "processing.gui.AlgorithmDialog.AlgorithmDialog": "processing.gui.algorithm_widget.AlgorithmWidget",
    "processing.gui.algorithm_widget.AlgorithmWidget": "the same; up to QGIS 4.0 AlgorithmDialog",
    "processing.gui.ContextAction.ContextAction": "the same; without it no entry opens the Model Designer",
    "processing.gui.ParametersPanel.ParametersPanel": "the same; without it QGIS's own dialog is shown",
    "processing.gui.ProviderActions.ProviderContextMenuActions": "the same; without it as ContextAction",
    "processing.gui.wrappers.DIALOG_BATCH": "the same",
    "processing.gui.wrappers.WidgetWrapper": "the same",
    "processing.modeler.ModelerDialog.ModelerDialog": "the same; without it a message says so",
}
_LATER = {name for name, where in PROCESSING.items() if "up to QGIS 4.0" in where}


def named(tree: ast.Module, *roots: str) -> list[tuple[str, str]]:
    """Return what a module calls the names that it imports from packages or takes from their modules, and the names."""
    nodes = list(ast.walk(tree))
    found = [
        (one.asname or one.name, f"{node.module}.{one.name}")
        for node in nodes
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] in roots
        for one in node.names
    ]
    modules = {called: name for called, name in found if name.startswith("qgis.PyQt.") and name.count(".") == 2}
    for node in nodes:
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in modules:
            found.append((f"{node.value.id}.{node.attr}", f"{modules[node.value.id]}.{node.attr}"))
    return found


def imported(*roots: str) -> set[str]:
    """Return the names that the provider imports from packages or takes from their modules, with the modules."""
    trees = [ast.parse(path.read_text(encoding="utf-8")) for path in PROVIDER.glob("*.py")]
    return {name for tree in trees for _, name in named(tree, *roots)}


def named_by(name: str) -> object:
    """Return what an imported name is: a module, or a part of one."""
    module, _, attribute = name.rpartition(".")
    return getattr(importlib.import_module(module), attribute)


def test_parts_of_processing_are_those_listed():
    assert imported("processing") == set(PROCESSING)


@pytest.mark.parametrize("name", sorted(imported("qgis", "osgeo", "processing") - _LATER))
def test_this_qgis_has(name, qgis_application):
    module, _, attribute = name.rpartition(".")
    assert hasattr(importlib.import_module(module), attribute)


def short_enumerators(source: str) -> list[str]:
    """Return enumerators that a source takes from a class of Qt itself (Qt.AlignLeft), where PyQt6 has none."""
    tree, found = ast.parse(source), []
    classes = {called: named_by(name) for called, name in named(tree, "qgis") if name.startswith("qgis.PyQt.")}
    for node in ast.walk(tree):
        owner = ast.unparse(node.value) if isinstance(node, ast.Attribute) else ""
        if owner in classes and isinstance(getattr(classes[owner], node.attr), (int, enum.Enum)):
            found.append(f"{owner}.{node.attr}")
    return found


@pytest.mark.parametrize("path", sorted(PROVIDER.glob("*.py")), ids=lambda path: path.name)
def test_enumerators_have_their_full_names(path):
    assert short_enumerators(path.read_text(encoding="utf-8")) == []


def test_short_names_are_recognized():
    source = "from qgis.PyQt.QtCore import Qt, QDate\nQt.AlignLeft, Qt.AlignmentFlag.AlignLeft, QDate.currentDate"
    assert short_enumerators(source) == ["Qt.AlignLeft"]
    source = "from qgis.PyQt import QtWidgets as W\nW.QDialog.Accepted, W.QDialog.DialogCode.Accepted, W.QDialog.exec"
    assert short_enumerators(source) == ["W.QDialog.Accepted"]


def test_names_are_found_wherever_they_are_taken_from():
    source = "from qgis.PyQt import QtWidgets\nfrom qgis.core import Qgis as Q\nQtWidgets.QMenu, Q.version"
    assert named(ast.parse(source), "qgis") == [
        ("QtWidgets", "qgis.PyQt.QtWidgets"),
        ("Q", "qgis.core.Qgis"),
        ("QtWidgets.QMenu", "qgis.PyQt.QtWidgets.QMenu"),
    ]
    assert "qgis.PyQt.QtWidgets.QDockWidget" in imported("qgis")
