"""The field for several point clouds in a dialog: files, folders and layers in one list."""

from pathlib import Path
from typing import Any

from processing.gui.wrappers import DIALOG_BATCH, WidgetWrapper
from qgis.core import QgsPointCloudLayer, QgsProject, QgsSettings
from qgis.PyQt import QtWidgets

from .clouds import FILTER, names_of

# Rows that are seen at once.
_ROWS = 4
# Where QGIS keeps the folder that was chosen last.
_LAST_FOLDER = "Processing/LastInputPath"


class FileList(QtWidgets.QWidget):
    """A list of files, folders and layers, with buttons that add and remove."""

    def __init__(self) -> None:
        super().__init__()
        self.list = QtWidgets.QListWidget()
        self.list.setSelectionMode(QtWidgets.QListWidget.SelectionMode.ExtendedSelection)
        # 12 pixels for the frame and the spacing of rows.
        self.list.setMaximumHeight(_ROWS * self.list.fontMetrics().height() + 12)
        self.layers = QtWidgets.QToolButton()
        self.layers.setText("Layers")
        self.layers.setPopupMode(QtWidgets.QToolButton.ToolButtonPopupMode.InstantPopup)
        self.layers.setMenu(QtWidgets.QMenu(self.layers))
        self.layers.menu().aboutToShow.connect(self._fill_menu)
        grid = QtWidgets.QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.addWidget(self.list, 0, 0, 5, 1)
        slots = {"Files…": self._add_files, "Folder…": self._add_folder, "Remove": self._remove}
        for row, (text, slot) in enumerate(slots.items()):
            button = QtWidgets.QPushButton(text)
            button.clicked.connect(slot)
            grid.addWidget(button, row, 1)
        grid.addWidget(self.layers, 3, 1)

    def names(self) -> list[str]:
        """Return paths, and sources or ids of layers, in their order."""
        return [self.list.item(row).text() for row in range(self.list.count())]

    def set_names(self, names: list[str]) -> None:
        """Show these paths and layers instead of those in the list."""
        self.list.clear()
        self.add(names)

    def add(self, names: list[str]) -> None:
        """Add those paths and layers that are not in the list."""
        known = self.names()
        self.list.addItems([name for name in dict.fromkeys(names) if name not in known])

    def _add_files(self) -> None:
        start = QgsSettings().value(_LAST_FOLDER, "")
        files, _ = QtWidgets.QFileDialog.getOpenFileNames(self, "Point clouds", str(start), f"{FILTER};;VPC (*.vpc)")
        self._keep(files)

    def _add_folder(self) -> None:
        start = str(QgsSettings().value(_LAST_FOLDER, ""))
        folder = QtWidgets.QFileDialog.getExistingDirectory(self, "Folder of point clouds", start)
        self._keep([folder] if folder else [])

    def _keep(self, names: list[str]) -> None:
        self.add(names)
        if names:
            QgsSettings().setValue(_LAST_FOLDER, str(Path(names[0]).parent))

    def _remove(self) -> None:
        for item in self.list.selectedItems():
            self.list.takeItem(self.list.row(item))

    def _fill_menu(self) -> None:
        self.layers.menu().clear()
        for layer in QgsProject.instance().mapLayers().values():
            if isinstance(layer, QgsPointCloudLayer):
                action = self.layers.menu().addAction(layer.name())
                action.triggered.connect(lambda _, layer=layer: self.add([layer.source()]))


class FilesWrapper(WidgetWrapper):
    """The list as QGIS's dialogs use it; a line of text with semicolons in batches."""

    def createWidget(self) -> QtWidgets.QWidget:  # noqa: N802 - QGIS asks for these names
        """Return the field."""
        return QtWidgets.QLineEdit() if self.dialogType == DIALOG_BATCH else FileList()

    def setValue(self, value: Any) -> None:  # noqa: N802
        """Show a value: of a script, of the history, or of another dialog."""
        names = names_of(value) or []
        if isinstance(self.widget, QtWidgets.QLineEdit):
            self.widget.setText(";".join(names))
        else:
            self.widget.set_names(names)

    def value(self) -> list[str]:
        """Return the paths and layers in the field."""
        if isinstance(self.widget, QtWidgets.QLineEdit):
            return [name.strip() for name in self.widget.text().split(";") if name.strip()]
        return self.widget.names()
