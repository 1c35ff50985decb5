"""Names, group, tags, icon and help of an algorithm, from the declaration of its stage or pipeline."""

from __future__ import annotations

from pathlib import Path
from typing import Optional, Union

from qgis.core import QgsProcessingOutputHtml, QgsProcessingUtils
from qgis.PyQt.QtCore import QUrl
from qgis.PyQt.QtGui import QIcon
from qgis.PyQt.QtWidgets import QWidget

from ..algorithms.help import as_text, page, with_picture
from ..algorithms.pipeline import Pipeline
from ..algorithms.stage import Stage
from .caller import on_command_line
from .paths import GROUP_ICONS, ICON, PICTURES

# The groups that the toolbox shows first.
_FIRST_GROUPS = ("Models", "Models in tiles", "Models as published")

# The icon of these.
_MODELS = "models"

# Search words that apply to every algorithm; formats find those that are about files.
_TAGS_OF_ALL = ("lidar", "point cloud")


class DeclaredAlgorithm:
    """Answers QGIS's questions from the declaration of a stage or pipeline."""

    declared: Union[Stage, Pipeline]

    def createInstance(self) -> DeclaredAlgorithm:  # noqa: N802 - QGIS asks for these names
        """Return a new algorithm of the same stage or pipeline."""
        return type(self)(self.declared)  # type: ignore[call-arg]

    def name(self) -> str:
        """Return the id, frozen: saved models depend on it."""
        return self.declared.id

    def displayName(self) -> str:  # noqa: N802
        """Return the title."""
        return self.declared.title

    def group(self) -> str:
        """Return the group's title.

        QGIS sorts groups by it; the space has the models come first.
        """
        return f" {self.declared.group}" if self.declared.group in _FIRST_GROUPS else self.declared.group

    def groupId(self) -> str:  # noqa: N802
        """Return the group's id."""
        return self.declared.group.lower().replace(" ", "")

    def tags(self) -> list:
        """Return words that the toolbox finds the algorithm by."""
        return [*(tag.strip() for tag in self.declared.tags.split(",") if tag.strip()), *_TAGS_OF_ALL]

    def icon(self) -> QIcon:
        """Return the icon of the group."""
        return QIcon(self.svgIconPath())

    def svgIconPath(self) -> str:  # noqa: N802
        """Return the file of the group's icon, or of the plugin's where the group has none."""
        group = _MODELS if self.declared.group in _FIRST_GROUPS else self.groupId()
        icon = GROUP_ICONS / f"{group}.svg"
        return str(icon if icon.is_file() else ICON)

    def shortDescription(self) -> str:  # noqa: N802
        """Return what it is for, in a sentence."""
        return self.declared.summary

    def help(self) -> str:
        """Return the help as HTML."""
        raise NotImplementedError

    def shortHelpString(self) -> str:  # noqa: N802
        """Return the help for the dialog, with the picture, or as plain text for the command line."""
        return as_text(self.help()) if on_command_line() else self._illustrated()

    def helpUrl(self) -> str:  # noqa: N802
        """Return a page with the help, written among the temporary files of this QGIS; the command line needs none."""
        if on_command_line():
            return ""
        path = Path(QgsProcessingUtils.tempFolder()) / f"{self.declared.id}.html"
        path.write_text(page(self.declared.title, self._illustrated()), encoding="utf-8")
        return QUrl.fromLocalFile(str(path)).toString()

    def _illustrated(self) -> str:
        return with_picture(self.help(), self.declared.id, QUrl.fromLocalFile(str(PICTURES)).toString())

    def createCustomParametersWidget(self, parent: Optional[QWidget] = None) -> Optional[QWidget]:  # noqa: N802
        """Return the dialog with parameters in groups; None, for QGIS's own one, where this QGIS lacks parts of it."""
        try:
            from .dialog import GroupedDialog
        except ImportError:
            return None
        return GroupedDialog(self, parent=parent)

    def name_pages(self) -> None:
        """Name the algorithm with its pages: QGIS lists the pages of all runs by the names of outputs alone."""
        for output in self.outputDefinitions():  # type: ignore[attr-defined]
            if isinstance(output, QgsProcessingOutputHtml):
                output.setDescription(f"{output.description()} ({self.displayName()})")
