"""Texts that users see can be translated, and all of them are in the file for translators."""

import importlib.util
import re
from xml.etree import ElementTree

import pytest
from qgis.PyQt.QtWidgets import QMainWindow

from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.provider import texts
from lidar_buildings.provider.installation import InstallationDialog
from lidar_buildings.provider.menu import add_menu
from lidar_buildings.provider.paths import PLUGIN, TRANSLATIONS
from lidar_buildings.provider.settings import add_options
from lidar_buildings.tests.toys import TOY_CHAIN, TOY_MAPPING, TOYS


@pytest.fixture(scope="module")
def script():
    spec = importlib.util.spec_from_file_location("extract_texts", PLUGIN / "scripts" / "extract_texts.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def asked(monkeypatch):
    """Every text that is looked up; the translation is the text in brackets."""
    found = set()

    class Application:
        @staticmethod
        def translate(context, text):
            found.add(text)
            return f"[{text}]"

    monkeypatch.setattr(texts, "QCoreApplication", Application)
    return found


class Interface:
    """What the menu asks of QGIS's windows."""

    def __init__(self):
        self.window, self.entries = QMainWindow(), []

    def mainWindow(self):
        return self.window

    def addPluginToMenu(self, menu, action):
        self.entries.append(action.text())

    def addToolBarIcon(self, action):
        pass

    def removeToolBarIcon(self, action):
        pass

    def removePluginMenu(self, menu, action):
        self.entries.remove(action.text())


def test_all_texts_of_menu_dialogs_and_options_are_in_the_file(provider, script, asked, monkeypatch):
    from processing.gui import ParametersPanel

    # That of the tests has no browser.
    monkeypatch.setattr(ParametersPanel, "iface", None)
    interface = Interface()
    remove = add_menu(interface)
    assert len(interface.entries) == 6
    assert all(entry.startswith("[") for entry in interface.entries), "nothing of the menu is left out"
    remove()
    add_options()()
    InstallationDialog(None)
    window = QMainWindow()
    for name in ("detectbuildings", "mapfootprintsintiles", "classifygroundtin", "assessbuildings", "cutintotiles"):
        algorithm = provider.algorithm(name).create()
        assert algorithm.displayName().startswith("[")
        assert algorithm.group().strip().startswith("[")
        dialog = algorithm.createCustomParametersWidget(window)
        assert dialog is not None
    assert len(asked) > 200
    assert asked <= {*script.texts(), "LiDAR Buildings"}, sorted(asked - set(script.texts()))


def test_parameters_are_translated(provider, asked):
    stage, model = (provider.algorithm(name).create() for name in ("classifygroundtin", "detectbuildings"))
    assert stage.parameterDefinition("CELL_SIZE").description() == "[Grid cell size] (m, [empty] = [automatic])"
    assert "[" in model.parameterDefinition("GROUND_CELL_SIZE").description()


def test_helps_are_translated_line_by_line(provider, script, asked):
    for algorithm in provider.algorithms():
        lines = [re.sub(r"</?(p|li|ul|ol|h3)>", "", line) for line in algorithm.create().shortHelpString().split("\n")]
        said = [line for line in lines if line and not line.startswith("<img")]
        assert said
        assert all(line.startswith(("[", "<i>[")) for line in said), algorithm.id()
    left_out = asked - set(script.texts())
    assert not left_out, sorted(left_out)[:5]


def test_the_file_is_up_to_date_and_can_be_read(script, monkeypatch):
    # Other tests have added these.
    for table, names in ((STAGES, TOYS), (PIPELINES, (TOY_CHAIN.name, TOY_MAPPING.name))):
        for name in names:
            monkeypatch.delitem(table, name, raising=False)
    assert (TRANSLATIONS / "lidar_buildings.ts").read_text(encoding="utf-8") == script.source()
    sources = [one.text for one in ElementTree.parse(TRANSLATIONS / "lidar_buildings.ts").getroot().iter("source")]
    assert sources == script.texts()


def test_without_a_translation_texts_are_as_they_are(qgis_application):
    assert texts.install_translation() is None
    assert texts.tr("Find buildings") == "Find buildings"
