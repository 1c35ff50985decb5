"""The dialog of composites and steps: groups, words and presets."""

from __future__ import annotations

import sys
import types

import pytest
from qgis.gui import QgsCollapsibleGroupBox, QgsFilterLineEdit
from qgis.PyQt.QtWidgets import QLineEdit, QMainWindow

from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.presets import PRESETS
from lidar_buildings.algorithms.tiling.settings import READ_SETTINGS, SETTINGS
from lidar_buildings.provider.options import CODES, PRESET, THREADS, apply_options
from lidar_buildings.provider.pickers import Picker, fill_with_classes, with_class
from lidar_buildings.provider.sections import Section, sections_of


@pytest.fixture
def window(qgis_application, monkeypatch):
    from processing.gui import ParametersPanel

    # The tests' QGIS has no browser.
    monkeypatch.setattr(ParametersPanel, "iface", None)
    return QMainWindow()


@pytest.fixture
def dialog(provider, window):
    return provider.algorithm("detectbuildings").create().createCustomParametersWidget(window)


def group(dialog, title):
    (found,) = [box for box in dialog.findChildren(QgsCollapsibleGroupBox) if box.title() == title]
    return found


def test_parameters_of_a_step_are_a_group_that_is_folded(dialog):
    titles = [box.title() for box in dialog.findChildren(QgsCollapsibleGroupBox)]
    assert titles[:4] == ["All steps", "Noise", "Earlier", "Ground"]
    ground = group(dialog, "Ground")
    assert ground.isCollapsed()
    panel = dialog.mainWidget()
    assert ground.isAncestorOf(panel.wrappers["GROUND_CELL_SIZE"].wrappedWidget())
    assert panel.wrappers["GROUND_CELL_SIZE"].wrappedLabel().text() == "Grid cell size (m)"
    assert panel.wrappers["ROOFS_MIN_HEIGHT"].wrappedLabel().text() == "Roofs: minimum height (m)"
    assert not ground.isAncestorOf(panel.wrappers["GROUND_MAX_BUILDING_SIZE"].wrappedWidget())
    assert group(dialog, "All steps").isAncestorOf(panel._parts("REVIEWED")[1])
    assert not panel.findChild(type(panel._advanced()), "grpAdvanced").isVisibleTo(panel)


def test_an_empty_field_says_automatic_in_one_word(dialog):
    panel = dialog.mainWidget()
    assert panel.wrappers["GROUND_CELL_SIZE"].wrappedWidget().specialValueText() == "automatic"
    assert panel.wrappers["GROUND_TERRAIN"].wrappedWidget().itemText(0) == "automatic"
    assert panel.wrappers["EXTENT"].wrappedLabel().text() == "Extent"
    (line,) = panel.wrappers["EXTENT"].wrappedWidget().findChildren(QgsFilterLineEdit)
    assert line.nullValue() == "the whole cloud"
    assert panel.wrappers["GROUND_CELL_SIZE"].parameterValue() is None
    assert panel.wrappers["GROUND_TERRAIN"].parameterValue() is None


def test_the_first_results_are_shown_and_the_others_folded(provider, window):
    dialog = provider.algorithm("mapfootprints").create().createCustomParametersWidget(window)
    more, panel = group(dialog, "More results"), dialog.mainWidget()
    outputs = [one.name() for one in panel.algorithm().destinationParameterDefinitions()]
    folded = [name for name in outputs if more.isAncestorOf(panel.wrappers[name].wrappedWidget())]
    assert folded == outputs[3:]


def test_a_preset_fills_fields_and_another_one_empties_them(dialog):
    panel = dialog.mainWidget()

    def chosen(name):
        index = panel.preset.findData(name)
        panel.apply_preset(index)
        return [panel.wrappers[one].parameterValue() for one in ("SOURCE", "MIN_AREA")]

    assert chosen("airborne_sparse") == ["laser scanner", 10.0]
    assert chosen("drone_photogrammetry") == ["matched images", 4.0]
    assert chosen("automatic") == ["automatic", 4.0]


@pytest.fixture
def options():
    """The options of the plugin, as they were before afterwards."""
    before = {one: one.value for one in (PRESET, CODES, THREADS)}
    yield before
    for one, value in before.items():
        one.set(value)
    apply_options()


def test_dialogs_begin_with_the_kind_of_cloud_in_the_options(provider, window, options):
    PRESET.set("drone_photogrammetry")
    panel = provider.algorithm("detectbuildings").create().createCustomParametersWidget(window).mainWidget()
    assert panel.preset.currentData() == "drone_photogrammetry"
    assert panel.wrappers["SOURCE"].parameterValue() == "matched images"


def test_threads_are_those_of_the_options(provider, options):
    from lidar_buildings.algorithms.threads import n_threads

    THREADS.set("3")
    apply_options()
    assert n_threads() == 3
    THREADS.set("many")
    with pytest.raises(ValueError, match="must be a whole number from 1, got 'many'"):
        apply_options()


@pytest.mark.parametrize("preset", PRESETS.values(), ids=PRESETS)
def test_presets_set_parameters_that_there_are_to_values_that_they_take(preset):
    taken = set()
    for pipeline in PIPELINES.values():
        for name, value in preset.of(pipeline).items():
            step, tunable = pipeline.parameters[name]
            assert step.stage.tunables[tunable.name].check(value) == value
            taken.add(name)
    assert taken == set(preset.values)


def test_titles_of_settings_say_what_empty_is():
    section = Section("")
    for name in ("BLOCK_SIDE", "PROCESSES", "SCHEDULER"):
        section.add_setting(SETTINGS[name])
    section.add_setting(READ_SETTINGS["SPACING"])
    labels = ["Side of a block (m)", "Processes", "Address of a Dask scheduler", "Spacing (m)"]
    assert list(section.labels.values()) == labels
    assert section.unset == {"BLOCK_SIDE": "automatic", "PROCESSES": "one for each core", "SPACING": "all points"}


def test_every_parameter_of_a_composite_is_in_one_group(provider):
    for name in ("detectbuildings", "mapfootprintsintiles", "classifygroundtin"):
        labels = [label for section in sections_of(provider.algorithm(name)) for label in section.labels]
        assert len(labels) == len(set(labels))


def test_without_parts_of_qgis_its_own_dialog_is_shown(provider, window, monkeypatch):
    monkeypatch.setitem(sys.modules, "lidar_buildings.provider.dialog", None)
    assert provider.algorithm("detectbuildings").create().createCustomParametersWidget(window) is None


def test_composites_keep_their_groups_where_dialogs_are_widgets(provider, window, monkeypatch):
    """QGIS 4.2 has AlgorithmWidget, with other arguments and the same method for the panel, and no AlgorithmDialog."""
    from processing.gui.AlgorithmDialog import AlgorithmDialog

    class AlgorithmWidget(AlgorithmDialog):
        def __init__(self, alg, in_place=False, parent=None, flags=None, initialState=None):  # noqa: N803 - as QGIS's
            super().__init__(alg, in_place, parent)

    moved = types.ModuleType("processing.gui.algorithm_widget")
    moved.AlgorithmWidget = AlgorithmWidget
    monkeypatch.setitem(sys.modules, "processing.gui.AlgorithmDialog", None)
    monkeypatch.setitem(sys.modules, "processing.gui.algorithm_widget", moved)
    monkeypatch.delitem(sys.modules, "lidar_buildings.provider.dialog", raising=False)
    dialog = provider.algorithm("detectbuildings").create().createCustomParametersWidget(window)
    assert isinstance(dialog, AlgorithmWidget)
    assert len(group(dialog, "Ground").findChildren(QLineEdit)) > 3
    monkeypatch.delitem(sys.modules, "lidar_buildings.provider.dialog")


def test_every_algorithm_has_a_dialog(provider, window):
    """That of *Cut into tiles* was an error."""
    for name in ("cutintotiles", "simulatetown", "reportbuildings", "mergeclouds", "modelcityblock"):
        assert provider.algorithm(name).create().createCustomParametersWidget(window) is not None


@pytest.mark.parametrize("name", ["detectbuildingsintiles", "mergeclouds"])
def test_surveys_and_merged_clouds_come_back_from_the_history(provider, window, context, tmp_path, name):
    """Opened with the parameters of an earlier run, the field had "0 inputs selected"."""
    files = [str(tmp_path), str(tmp_path / "a.laz"), str(tmp_path / "b.las"), str(tmp_path / "all.vpc")]
    algorithm = provider.algorithm(name).create()
    given = "INPUTS" if name == "mergeclouds" else "INPUT"
    dialog = algorithm.createCustomParametersWidget(window)
    dialog.setParameters({given: files})
    parameters = dialog.createProcessingParameters()
    assert parameters[given] == files
    kept = algorithm.asMap(parameters, context)["inputs"]
    again = provider.algorithm(name).create().createCustomParametersWidget(window)
    again.setParameters(kept)
    assert again.createProcessingParameters()[given] == files


def test_the_list_of_files_adds_each_once_and_removes_what_is_selected(qgis_application):
    from lidar_buildings.provider.file_list import FileList

    field = FileList()
    field.set_names(["a.laz", "b.laz"])
    field.add(["b.laz", "c.vpc"])
    assert field.names() == ["a.laz", "b.laz", "c.vpc"]
    field.list.item(1).setSelected(True)
    field._remove()
    assert field.names() == ["a.laz", "c.vpc"]


def test_classes_are_picked_by_their_names(provider, window):
    from qgis.PyQt.QtWidgets import QMenu

    panel = provider.algorithm("filterpoints").create().createCustomParametersWidget(window).mainWidget()
    field = panel.wrappers["CLASSES"].wrappedWidget()
    field.setText("2, 6")
    assert isinstance(field.parentWidget(), Picker)
    menu = QMenu()
    fill_with_classes(menu, field)
    shown = {action.text(): action for action in menu.actions()}
    assert [text for text, action in shown.items() if action.isChecked()] == ["2 Ground", "6 Building"]
    for name in ("3 Low vegetation", "4 Medium vegetation", "6 Building"):
        shown[name].trigger()
    assert panel.wrappers["CLASSES"].parameterValue() == "2-4"


@pytest.mark.parametrize(
    ("text", "number", "is_chosen", "wanted"),
    [("", 6, True, "6"), ("64-67", 65, False, "64, 66, 67"), ("nonsense", 2, True, "2"), ("2,3", 4, True, "2-4")],
)
def test_texts_of_classes(text, number, is_chosen, wanted):
    assert with_class(text, number, is_chosen) == wanted


def test_dimensions_are_those_of_the_chosen_cloud(provider, window, town_file):
    from qgis.PyQt.QtWidgets import QMenu

    panel = provider.algorithm("filterpoints").create().createCustomParametersWidget(window).mainWidget()
    field, menu = panel.wrappers["DIMENSION"].wrappedWidget(), QMenu()
    panel._fill_with_dimensions(menu, field)
    assert [action.isEnabled() for action in menu.actions()] == [False]
    panel.wrappers["INPUT"].setParameterValue(str(town_file), panel.processing_context)
    menu = QMenu()
    panel._fill_with_dimensions(menu, field)
    shown = {action.text(): action for action in menu.actions()}
    assert {"Z", "Intensity", "Classification"} <= set(shown)
    shown["Intensity"].trigger()
    assert panel.wrappers["DIMENSION"].parameterValue() == "Intensity"


def test_an_empty_extent_says_what_that_is(dialog):
    (line,) = dialog.mainWidget().wrappers["EXTENT"].wrappedWidget().findChildren(QgsFilterLineEdit)
    assert line.text() in ("", "the whole cloud")
    assert dialog.mainWidget().wrappers["EXTENT"].parameterValue() in (None, "")


def test_dialogs_begin_with_the_class_codes_in_the_options(provider, window, options):
    CODES.set("AHN (Netherlands)")
    panel = provider.algorithm("detectbuildings").create().createCustomParametersWidget(window).mainWidget()
    assert panel.wrappers["CODES_CODES"].parameterValue() == "AHN (Netherlands)"
