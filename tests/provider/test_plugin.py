"""The plugin comes and goes without a trace."""

from __future__ import annotations

import sys

import pytest
from qgis.core import Qgis, QgsApplication

import lidar_buildings
from lidar_buildings.algorithms import packages
from lidar_buildings.provider import dependencies
from lidar_buildings.provider.pipeline_algorithm import PipelineAlgorithm
from lidar_buildings.provider.plugin import LOG, Plugin


@pytest.fixture
def plugin(provider):
    """A second plugin object; the session's provider makes room for its own."""
    registry = QgsApplication.processingRegistry()
    before = [p.id() for p in registry.providers()]
    plugin = lidar_buildings.classFactory(None)
    yield plugin
    plugin.unload()
    assert [p.id() for p in registry.providers()] == before


def test_the_factory_gives_the_plugin(plugin):
    assert isinstance(plugin, Plugin)


def test_the_toolbox_menu_opens_graphs_of_composites_only(provider, qgis_application):
    from lidar_buildings.provider.designer import OpenInDesigner

    action = OpenInDesigner()
    action.setData(provider.algorithm("toychain"), None)
    assert action.isEnabled()
    action.setData(provider.algorithm("toylift"), None)
    assert not action.isEnabled()
    action.setData("a group", None)
    assert not action.isEnabled()


def test_the_graph_for_the_designer_is_a_model_of_the_users_own(provider):
    algorithm = provider.algorithm("toychain").create()
    assert isinstance(algorithm, PipelineAlgorithm)
    model = algorithm.as_model()
    assert not isinstance(model, PipelineAlgorithm)
    assert len(model.childAlgorithms()) == 3
    assert model.sourceFilePath() == "", "saving it must not overwrite the shipped file"


def test_what_is_added_is_taken_away(provider, qgis_application, monkeypatch):
    from processing.gui.ProviderActions import ProviderContextMenuActions

    registry = QgsApplication.processingRegistry()
    added, removed = [], []
    # The session's provider has the id already, so that the registry would refuse a second.
    monkeypatch.setattr(
        Plugin,
        "_registry",
        lambda self: type(
            "R", (), {"addProvider": staticmethod(added.append), "removeProvider": staticmethod(removed.append)}
        ),
    )
    actions, path, providers = list(ProviderContextMenuActions.actions), list(sys.path), len(registry.providers())
    plugin = lidar_buildings.classFactory(None)
    plugin.initGui()
    assert len(ProviderContextMenuActions.actions) == len(actions) + 1
    plugin.unload()
    assert added == removed
    assert len(added) == 1
    assert (ProviderContextMenuActions.actions, sys.path) == (actions, path)
    assert len(registry.providers()) == providers
    plugin.unload()


def without_modules_that_move(monkeypatch):
    """Have the modules of Processing that other versions of QGIS keep elsewhere not found."""
    for name in ("gui.ProviderActions", "gui.ContextAction", "modeler", "modeler.ModelerDialog"):
        monkeypatch.setitem(sys.modules, f"processing.{name}", None)
    monkeypatch.delitem(sys.modules, "lidar_buildings.provider.designer", raising=False)


def test_all_algorithms_are_there_where_modules_of_qgis_have_moved(provider, monkeypatch):
    without_modules_that_move(monkeypatch)
    kept = []
    registry = type(
        "R", (), {"addProvider": staticmethod(kept.append), "removeProvider": staticmethod(lambda provider: None)}
    )
    monkeypatch.setattr(Plugin, "_registry", lambda self: registry)
    messages = []
    QgsApplication.messageLog().messageReceived[str, str, Qgis.MessageLevel].connect(
        lambda text, tag, level: messages.append((tag, level, text))
    )
    plugin = lidar_buildings.classFactory(None)
    plugin.initGui()
    (added,) = kept
    assert {one.id() for one in added.algorithms()} == {one.id() for one in provider.algorithms()}
    ((_, level, text),) = [one for one in messages if one[0] == LOG]
    assert level == Qgis.MessageLevel.Warning
    assert "Open in Model Designer" in text
    plugin.unload()


def test_packages_of_another_installer_are_found_and_forgotten(provider, tmp_path, monkeypatch):
    folder = tmp_path / "python" / "dependencies"
    folder.mkdir(parents=True)
    monkeypatch.setattr(QgsApplication, "qgisSettingsDirPath", staticmethod(lambda: str(tmp_path)))
    plugin = Plugin(None)
    plugin._add_dependencies_folder()
    assert str(folder) in sys.path
    plugin.unload()
    assert str(folder) not in sys.path


@pytest.mark.parametrize(
    ("missing", "is_debian", "wanted"),
    [
        (["lazrs"], True, "{python} -m pip install --no-deps --target {profile}/python lazrs"),
        (["scipy", "scikit-learn"], True, "sudo apt-get install -y python3-scipy python3-sklearn"),
        (
            ["scikit-learn", "lazrs"],
            True,
            "sudo apt-get install -y python3-sklearn && "
            "{python} -m pip install --no-deps --target {profile}/python lazrs",
        ),
        (
            ["scikit-learn"],
            False,
            "{python} -m pip install --no-deps --target {profile}/python scikit-learn joblib threadpoolctl",
        ),
    ],
)
def test_one_command_mends_it(qgis_application, monkeypatch, missing, is_debian, wanted):
    monkeypatch.setattr(dependencies, "_is_debian", lambda: is_debian)
    monkeypatch.setattr(QgsApplication, "qgisSettingsDirPath", staticmethod(lambda: "/home/user/profile"))
    assert dependencies.command(missing) == wanted.format(python=dependencies.python(), profile="/home/user/profile")


def test_names_with_spaces_are_quoted(monkeypatch):
    monkeypatch.setattr(dependencies, "_is_debian", lambda: False)
    monkeypatch.setattr(QgsApplication, "qgisSettingsDirPath", staticmethod(lambda: "/home/a user/p"))
    assert "--target '/home/a user/p/python' lazrs" in dependencies.command(["lazrs"])


def test_python_is_never_qgis_itself(monkeypatch, tmp_path):
    monkeypatch.setattr(sys, "executable", str(tmp_path / "bin" / "qgis-ltr-bin.exe"))
    monkeypatch.setattr(sys, "base_prefix", str(tmp_path))
    assert dependencies.python() == "python3"
    (tmp_path / "python.exe").touch()
    assert dependencies.python() == str(tmp_path / "python.exe")


def test_packages_are_looked_up_by_import(monkeypatch):
    monkeypatch.setattr(packages.importlib.util, "find_spec", lambda name: None)
    assert packages.missing() == ["scipy", "scikit-learn", "laspy", "lazrs"]
