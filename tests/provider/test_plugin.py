"""The plugin is loaded and unloaded, and leaves nothing behind."""

from __future__ import annotations

import re
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from qgis.core import (
    Qgis,
    QgsApplication,
    QgsPointCloudLayer,
    QgsProcessingOutputLayerDefinition,
    QgsRectangle,
)
from qgis.PyQt.QtCore import Qt, QUrl
from qgis.PyQt.QtGui import QTextDocument
from qgis.PyQt.QtWidgets import QMainWindow, QMessageBox, QPushButton, QTextBrowser

import lidar_buildings
from lidar_buildings.algorithms import package_versions, packages
from lidar_buildings.algorithms.cloud import laspy_library
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.provider import dependencies, installation, menu, questions
from lidar_buildings.provider.menu import open_dialog, view_parameters
from lidar_buildings.provider.plugin import LOG, Plugin
from lidar_buildings.tests.provider.helpers import Interface, run


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


def test_the_menu_shows_the_first_steps_with_their_pictures():
    class Window:
        window = QMainWindow()

        def mainWindow(self):
            return self.window

    menu.show_first_steps(Window())
    page = Window.window.findChild(QTextBrowser)
    assert page.isVisible()
    assert "A first result" in page.toPlainText()
    shown = re.findall(r'<img src="([^"]+)"', page.toHtml())
    assert "pictures/toolbox.png" in shown
    for name in shown:
        assert page.loadResource(QTextDocument.ResourceType.ImageResource, QUrl(name)), name
    page.close()


def test_the_menu_has_six_entries_until_it_is_taken_away():
    class Windows:
        window, entries = QMainWindow(), []

        def mainWindow(self):
            return self.window

        def addPluginToMenu(self, _, action):
            self.entries.append(action)

        def removePluginMenu(self, _, action):
            self.entries.remove(action)

        addToolBarIcon = removeToolBarIcon = lambda *_: None

    remove = menu.add_menu(Windows())
    assert len({entry.text() for entry in Windows.entries}) == 6
    assert all(not entry.icon().isNull() for entry in Windows.entries)
    remove()
    assert not Windows.entries


def test_the_graph_for_the_designer_is_a_model_of_the_users_own(provider, monkeypatch):
    from processing.modeler.ModelerDialog import ModelerDialog

    from lidar_buildings.provider.designer import OpenInDesigner

    shown = []

    class Dialog:
        show = activate = lambda self: None

    monkeypatch.setattr(ModelerDialog, "create", lambda model: shown.append(model) or Dialog())
    action = OpenInDesigner()
    action.setData(provider.algorithm("toychain").create(), None)
    action.execute()
    (model,) = shown
    assert len(model.childAlgorithms()) == 3
    assert (model.displayName(), model.sourceFilePath()) == ("Toy chain", "")


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
    added.refreshAlgorithms()
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
        (["lazrs"], True, "{python} -I -m pip install --upgrade --no-deps --target {profile}/python 'lazrs>=0.6,<0.9'"),
        (["scipy", "scikit-learn"], True, "sudo apt-get install -y python3-scipy python3-sklearn"),
        (["scipy"], False, "{python} -I -m pip install --upgrade --no-deps --target {profile}/python scipy"),
        (
            ["scikit-learn", "lazrs"],
            True,
            "sudo apt-get install -y python3-sklearn && "
            "{python} -I -m pip install --upgrade --no-deps --target {profile}/python 'lazrs>=0.6,<0.9'",
        ),
        (
            ["scikit-learn"],
            False,
            "{python} -I -m pip install --upgrade --no-deps --target {profile}/python scikit-learn joblib "
            "threadpoolctl",
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
    assert "--target '/home/a user/p/python' 'lazrs>=0.6,<0.9'" in dependencies.command(["lazrs"])
    monkeypatch.setattr(sys, "platform", "win32")
    assert '"lazrs>=0.6,<0.9"' in dependencies.command(["lazrs"]), "a terminal would write to a file of that name"


def test_without_pip_debian_is_asked_for_it(qgis_application, monkeypatch):
    monkeypatch.setattr(dependencies, "_is_debian", lambda: True)
    monkeypatch.setattr(dependencies.importlib.util, "find_spec", lambda name: None)
    assert dependencies.system_command(["lazrs"]) == "sudo apt-get install -y python3-pip"


def test_python_is_never_qgis_itself(monkeypatch, tmp_path):
    monkeypatch.setattr(sys, "executable", str(tmp_path / "bin" / "qgis-ltr-bin.exe"))
    monkeypatch.setattr(sys, "exec_prefix", str(tmp_path))
    monkeypatch.setattr(sys, "base_prefix", str(tmp_path))
    assert dependencies.python() == f"python{sys.version_info.major}.{sys.version_info.minor}"
    (tmp_path / "python.exe").touch()
    assert dependencies.python() == str(tmp_path / "python.exe")


def test_another_python_that_comes_first_on_the_path_is_not_taken(monkeypatch, tmp_path):
    """Its minor version may differ, and lazrs for it can't be loaded."""
    other = tmp_path / "python3"
    other.write_text("#!/bin/sh\necho 3.1 elsewhere\n")
    other.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(other))
    asked = [dependencies.python(), "-c", "import sys; print(sys.version)"]
    reported = subprocess.run(asked, capture_output=True, text=True, check=True).stdout
    assert reported.strip() == sys.version


def test_packages_are_looked_up_by_import(monkeypatch):
    # The requirements are read once, and by what is patched next.
    assert packages.missing() == []
    monkeypatch.setattr(packages.importlib.util, "find_spec", lambda name: None)
    assert packages.missing() == ["scipy", "scikit-learn", "laspy"]
    assert packages.absent() == ["scipy", "scikit-learn", "laspy", "lazrs"]


def test_a_missing_package_stops_only_the_algorithms_that_use_it(provider, monkeypatch):
    find = packages.importlib.util.find_spec
    monkeypatch.setattr(packages.importlib.util, "find_spec", lambda name: None if name == "sklearn" else find(name))
    stopped = {one.name() for one in provider.algorithms() if not one.create().canExecute()[0]}
    assert stopped == {"classifybuildings2019", "detectbuildings2019", "detectbuildings2019intiles"}
    assert provider.warningMessage() == ""
    assert "scikit-learn" in installation.installation_text()


@pytest.fixture
def old_laspy(monkeypatch):
    """A Python with a laspy that reads no LAZ as this one does."""
    version = package_versions.importlib.metadata.version
    monkeypatch.setattr(
        package_versions.importlib.metadata, "version", lambda name: "2.4.1" if name == "laspy" else version(name)
    )
    package_versions.forget_versions()
    yield
    monkeypatch.undo()
    package_versions.forget_versions()


def test_a_package_that_is_too_old_is_as_good_as_missing(provider, old_laspy):
    """All was said to be well, and every LAZ ended with an AttributeError."""
    assert packages.missing() == ["laspy"]
    can_run, why = provider.algorithm("toylift").canExecute()
    assert not can_run
    assert why.startswith("Python package is missing or too old: laspy (2.4.1, laspy>=2.5,<3 is needed).")
    assert "--upgrade" in why
    assert why in installation.installation_text()
    with pytest.raises(ValueError, match=r"need the Python package laspy>=2\.5,<3, and 2\.4\.1 is installed"):
        laspy_library.need_laspy.__wrapped__()


@pytest.mark.parametrize(
    ("installed", "is_old"), [("2.4.1", True), ("2.5", False), ("2.5.0rc1", False), ("2.10.3", False), ("1.7", True)]
)
def test_versions_are_compared_by_their_numbers(monkeypatch, installed, is_old):
    monkeypatch.setattr(package_versions, "installed_version", lambda name: installed)
    assert bool(package_versions.too_old("laspy")) == is_old
    assert not package_versions.too_old("numpy")


def test_the_command_takes_no_module_of_the_current_folder(tmp_path, monkeypatch):
    """A pip.py in the folder from which QGIS was started was run."""
    for name in ("pip", "runpy"):
        (tmp_path / f"{name}.py").write_text(f"open({str(tmp_path / 'planted')!r}, 'w')\n")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    arguments = dependencies.pip_arguments(["lazrs"])
    command = [dependencies.python(), *arguments[: arguments.index("pip") + 1], "--version"]
    made = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert not (tmp_path / "planted").exists()
    assert made.stdout.startswith("pip ") or "No module named pip" in made.stderr


def test_a_question_is_shown_as_it_is(qgis_application):
    """Qt took an address with markup for HTML: one that read as localhost was another."""
    asked = "tcp://localhost:8786<b></b><!-- tcp://evil:8786 -->"
    box = questions.question_box(None, "LiDAR Buildings", asked)
    assert box.textFormat() == Qt.TextFormat.PlainText
    assert box.text() == asked
    assert box.defaultButton() == box.button(QMessageBox.StandardButton.No)


@pytest.fixture
def without_laz(monkeypatch):
    """A Python without lazrs and laszip."""
    find = packages.importlib.util.find_spec
    monkeypatch.setattr(
        packages.importlib.util, "find_spec", lambda name: None if name in ("lazrs", "laszip") else find(name)
    )


def test_las_needs_no_package_for_laz(provider, context, log, town, tmp_path, without_laz):
    write_cloud(create_cloud(town, wkt="EPSG:28992"), tmp_path / "town.las")
    lift = provider.algorithm("toylift")
    assert lift.canExecute()[0]
    assert provider.warningMessage().startswith("Only LAS files can be read and written.")
    wanted = QgsProcessingOutputLayerDefinition(str(tmp_path / "out.las"), context.project())
    run("toylift", {"INPUT": str(tmp_path / "town.las"), "OUTPUT": wanted}, context, log)
    assert read_cloud(tmp_path / "out.las").has("height_above_ground")
    assert [one for one in log.warnings if "needs the package lazrs" in one]
    assert context.layersToLoadOnCompletion() == {}


def test_what_is_installed_is_text_to_copy(qgis_application, without_laz):
    text = installation.installation_text()
    for wanted in (f"QGIS {Qgis.version()}", f"numpy {np.__version__}", "lazrs ", "Only LAS files"):
        assert wanted in text


def test_nothing_is_installed_without_a_yes(qgis_application, monkeypatch, without_laz):
    started, shown = [], []
    monkeypatch.setattr(installation, "_run", lambda parent, *command: started.append(command) or "")
    assert not installation.install_missing(None, lambda command: shown.append(command) or False)
    assert started == []
    assert shown == [dependencies.shown_command(["lazrs"])]


def test_a_yes_runs_the_command_that_was_shown(qgis_application, monkeypatch, without_laz):
    started = []
    monkeypatch.setattr(installation, "_run", lambda parent, *command: started.append(command) or "it failed")
    monkeypatch.setattr(QMessageBox, "warning", lambda *words: started.append(words[-1]))
    assert not installation.install_missing(None, lambda command: True)
    assert started[0] == (dependencies.python(), dependencies.pip_arguments(["lazrs"]))
    assert "lazrs" in started[1]
    assert "it failed" in started[1]


def test_the_button_fills_in_the_cloud_and_the_view(provider, town, tmp_path):
    write_cloud(create_cloud(town, wkt="EPSG:28992"), tmp_path / "town.copc.laz")
    layer = QgsPointCloudLayer(str(tmp_path / "town.copc.laz"), "town", "copc")
    assert layer.isValid()
    part = QgsRectangle(85_005, 446_005, 85_100, 446_012)
    given = view_parameters(Interface(None, [layer], part, "EPSG:28992"))
    assert given["INPUT"] == layer.id()
    assert given["EXTENT"].toString(0) == "85005,446005 : 85019,446012"
    assert given["EXTENT"].crs().authid() == "EPSG:28992"
    for whole in (QgsRectangle(80_000, 440_000, 90_000, 450_000), QgsRectangle(0, 0, 1, 1)):
        assert view_parameters(Interface(layer, [], whole, "EPSG:28992")) == {"INPUT": layer.id()}
    assert view_parameters(Interface(None, [], part, "EPSG:28992")) == {}


def test_the_button_opens_the_dialog_of_detect_buildings_and_keeps_it(provider, monkeypatch):
    """A dialog that only its window held lost what Python had added, and did nothing on Run."""
    import processing

    opened = []
    monkeypatch.setattr(processing, "execAlgorithmDialog", lambda *arguments: opened.append(arguments))
    open_dialog(Interface(None, [], QgsRectangle(0, 0, 1, 1), "EPSG:28992"))
    assert opened == [("lidarbuildings:detectbuildings", {})]


def test_a_message_says_what_is_missing_and_goes_when_it_is_installed(qgis_application, monkeypatch):
    from qgis.gui import QgsMessageBar

    bar, asked, missing = QgsMessageBar(), [], ["laspy"]
    iface = SimpleNamespace(messageBar=lambda: bar, mainWindow=lambda: None)
    monkeypatch.setattr(installation.packages, "missing", lambda needed: missing)
    monkeypatch.setattr(installation, "install_missing", lambda parent: asked.append(1) or len(asked) > 1)
    remove = installation.warn_at_start(iface)
    button = bar.currentItem().findChild(QPushButton)
    assert "laspy" in bar.currentItem().text()
    assert bar.currentItem().level() == Qgis.MessageLevel.Warning
    button.click()
    assert len(bar.items()) == 1
    button.click()
    assert bar.items() == []
    # The plugin takes it away once more when it is unloaded.
    remove()
    missing.clear()
    installation.warn_at_start(iface)()
    assert bar.items() == []
