"""The dialog of composites: parameters in groups that fold, one per step, and presets that fill them."""

from __future__ import annotations

from typing import Any, Optional

from processing.gui.ParametersPanel import ParametersPanel
from processing.gui.wrappers import WidgetWrapper
from qgis.core import Qgis
from qgis.gui import QgsCollapsibleGroupBox, QgsExtentWidget
from qgis.PyQt import QtWidgets, sip

from ..algorithms.cloud.files import dimension_names
from ..algorithms.presets import Preset, presets_of
from ..algorithms.stage import DIMENSION
from .clouds import cloud_path
from .given import Given
from .inputs import INPUT
from .options import CODES, PRESET
from .pickers import Picker, fill_with_classes, fill_with_names
from .sections import Section, sections_of

try:
    from processing.gui.AlgorithmDialog import AlgorithmDialog
except ImportError:  # from QGIS 4.2 on it is a widget that can be docked, with the same methods
    from processing.gui.algorithm_widget import AlgorithmWidget as AlgorithmDialog

# The parameter of a composite whose class codes are written.
_CODES = "CODES_CODES"

# Outputs that stay shown where others are folded, which are two or more.
_OUTPUTS = 3


class GroupedDialog(AlgorithmDialog):
    """QGIS's dialog of an algorithm, with another panel of parameters."""

    def getParametersPanel(self, alg: Any, parent: Any) -> GroupedPanel:  # noqa: N802 - QGIS asks for this name
        """Return the panel."""
        return GroupedPanel(parent, alg, self.in_place, self.active_layer)


class GroupedPanel(ParametersPanel):
    """QGIS's panel, whose widgets are put into groups."""

    def initWidgets(self) -> None:  # noqa: N802 - QGIS asks for this name
        """Make QGIS's widgets, and arrange them."""
        super().initWidgets()
        self._presets: list[Preset] = []
        # Python owns a widget put into a layout of QGIS, and deletes it with the last reference to it.
        self._kept: list[QtWidgets.QWidget] = []
        sections = sections_of(self.algorithm())
        for section in sections:
            for name, label in section.labels.items():
                self._rename(name, label)
        self._name_automatic(sections)
        self._add_pickers(sections)
        layout = self._layout()
        if layout is None:
            return
        at = layout.indexOf(self._advanced()) if self._advanced() is not None else layout.count() - 1
        for section in sections:
            names = [name for name in section.labels if self._is_advanced(name) and name in self.wrappers]
            if section.title and names:
                layout.insertWidget(at, self._group(section.title, names))
                at += 1
        self._hide_empty_advanced()
        self._fold_outputs(layout)
        self._add_presets(layout)
        self._set_codes()

    def _set_codes(self) -> None:
        """Set the class codes to those chosen in the options of the plugin."""
        if _CODES in self.wrappers and CODES.value != CODES.default:
            self.wrappers[_CODES].setParameterValue(CODES.value, self.processing_context)

    def _is_advanced(self, name: str) -> bool:
        """Return whether a parameter is one of those that QGIS folds."""
        definition = self.algorithm().parameterDefinition(name)
        return definition is not None and bool(definition.flags() & Qgis.ProcessingParameterFlag.Advanced)

    def _parts(self, name: str) -> tuple[Optional[QtWidgets.QWidget], Optional[QtWidgets.QWidget]]:
        """Return the label and the widget of a parameter."""
        wrapper = self.wrappers[name]
        if isinstance(wrapper, WidgetWrapper):
            return wrapper.label, wrapper.widget
        return wrapper.wrappedLabel(), wrapper.wrappedWidget()

    def _layout(self) -> Optional[QtWidgets.QVBoxLayout]:
        """Return the layout that holds the parameters."""
        for name in self.wrappers:
            if not self._is_advanced(name):
                widget = self._parts(name)[1]
                holder = widget.parentWidget() if widget is not None else None
                if holder is not None and isinstance(holder.layout(), QtWidgets.QVBoxLayout):
                    return holder.layout()
        return None

    def _advanced(self) -> Optional[QtWidgets.QWidget]:
        """Return QGIS's own group of advanced parameters."""
        return next((box for box in self.findChildren(QtWidgets.QWidget) if box.objectName() == "grpAdvanced"), None)

    def _group(self, title: str, names: list[str]) -> QgsCollapsibleGroupBox:
        """Return a folded group of the widgets of some parameters."""
        box = QgsCollapsibleGroupBox(title)
        box.setObjectName(f"group{title}")
        box.setSaveCollapsedState(False)
        inside = QtWidgets.QVBoxLayout(box)
        for name in names:
            for part in self._parts(name):
                if part is not None:
                    inside.addWidget(part)
        box.setCollapsed(True)
        self._kept.append(box)
        return box

    def _hide_empty_advanced(self) -> None:
        """Hide QGIS's own group of advanced parameters when all of them are in other groups."""
        box = self._advanced()
        if box is not None:
            widgets = box.findChildren(QtWidgets.QWidget)
            inside = [widget for widget in widgets if widget.objectName() != "" or widget.layout()]
            holds = any(box.isAncestorOf(part) for name in self.wrappers for part in self._parts(name) if part)
            box.setVisible(bool(inside) and holds)

    def _rename(self, name: str, label: str) -> None:
        """Give a parameter the label that it has within its group."""
        if name not in self.wrappers:
            return
        shown, widget = self._parts(name)
        labels = [part for part in (shown, widget) if isinstance(part, QtWidgets.QLabel)]
        # A check box is its own label.
        own = widget if shown is None and hasattr(widget, "setText") else None
        part = labels[0] if labels else own
        if part is not None:
            part.setText(label)

    def _name_automatic(self, sections: list[Section]) -> None:
        """Say what an empty field means in the field itself, with one word everywhere."""
        for section in sections:
            for name, word in section.unset.items():
                widget = self._parts(name)[1] if name in self.wrappers else None
                if widget is None:
                    continue
                for spin in (widget, *widget.findChildren(QtWidgets.QAbstractSpinBox)):
                    if isinstance(spin, QtWidgets.QAbstractSpinBox) and spin.specialValueText():
                        spin.setSpecialValueText(word)
                if widget.metaObject().className() == "QgsExtentWidget":
                    # In Python it has the type of a plain widget.
                    extent = sip.cast(widget, QgsExtentWidget)
                    extent.setNullValueAllowed(True, word)
                    extent.clear()
                for combo in (widget, *widget.findChildren(QtWidgets.QComboBox)):
                    if isinstance(combo, QtWidgets.QComboBox) and combo.count() and combo.itemData(0) is None:
                        combo.setItemText(0, word)

    def _add_pickers(self, sections: list[Section]) -> None:
        """Put buttons next to the fields for classes and dimensions."""
        for section in sections:
            for name, kind in section.pickers.items():
                field = self._parts(name)[1] if name in self.wrappers else None
                holder = field.parentWidget() if field is not None else None
                if not isinstance(field, QtWidgets.QLineEdit) or holder is None or holder.layout() is None:
                    continue
                layout, at = holder.layout(), holder.layout().indexOf(field)
                if kind == DIMENSION:
                    picker = Picker(field, "Dimensions of the point cloud", self._fill_with_dimensions)
                else:
                    picker = Picker(field, "Classes by their names", fill_with_classes)
                self._kept.append(picker)
                layout.insertWidget(at, picker)

    def _fill_with_dimensions(self, menu: QtWidgets.QMenu, field: QtWidgets.QLineEdit) -> None:
        """Fill a menu with the dimensions of the cloud that is chosen."""
        try:
            parameters = {INPUT: self.wrappers[INPUT].parameterValue()}
            names = dimension_names(cloud_path(Given(self.algorithm(), parameters, self.processing_context), INPUT))
        except (KeyError, ValueError):
            names = []
        fill_with_names(names, menu, field)

    def _fold_outputs(self, layout: QtWidgets.QLayout) -> None:
        """Fold all outputs but the first ones."""
        made = self.algorithm().destinationParameterDefinitions()
        names = [one.name() for one in made if one.name() in self.wrappers]
        if len(names) > _OUTPUTS + 1:
            layout.insertWidget(layout.count() - 1, self._group("More results", names[_OUTPUTS:]))

    def _add_presets(self, layout: QtWidgets.QVBoxLayout) -> None:
        """Add the choice of a kind of cloud above all parameters."""
        self._pipeline = getattr(self.algorithm(), "pipeline", None)
        self._presets = presets_of(self._pipeline) if self._pipeline is not None else []
        if not self._presets:
            return
        self.preset = QtWidgets.QComboBox()
        for preset in self._presets:
            self.preset.addItem(preset.title, preset.name)
        self.preset.setToolTip("Sets the parameters that are better set than measured for this kind of cloud.")
        holder = QtWidgets.QWidget()
        form = QtWidgets.QFormLayout(holder)
        form.setContentsMargins(0, 0, 0, 0)
        form.addRow("Kind of cloud", self.preset)
        self._kept.append(holder)
        layout.insertWidget(0, holder)
        self.preset.activated.connect(self.apply_preset)
        chosen = self.preset.findData(PRESET.value)
        if chosen > 0:
            self.preset.setCurrentIndex(chosen)
            self.apply_preset(chosen)

    def apply_preset(self, index: int) -> None:
        """Fill in the values of a preset; what another one had set goes back to its default."""
        names = {name for preset in self._presets for name in preset.of(self._pipeline)}
        values = self._presets[index].of(self._pipeline)
        for name in sorted(names):
            definition = self.algorithm().parameterDefinition(name.upper())
            value = values.get(name, definition.defaultValue())
            self.wrappers[name.upper()].setParameterValue(value, self.processing_context)
