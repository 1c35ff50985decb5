"""What all algorithms of the provider do alike: what they answer QGIS, checks before a run, systems that last."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Optional, Union

from qgis.core import QgsProcessingContext, QgsProcessingFeedback, QgsProcessingOutputHtml, QgsProcessingUtils
from qgis.PyQt.QtCore import QUrl
from qgis.PyQt.QtGui import QIcon
from qgis.PyQt.QtWidgets import QWidget

from ..algorithms.help import as_text, page, with_picture
from ..algorithms.pipeline import Pipeline
from ..algorithms.stage import Stage
from .caller import on_command_line
from .dependencies import missing_sentence
from .errors import as_processing_errors, sentence_of
from .options import apply_options
from .paths import GROUP_ICONS, ICON, PICTURES
from .qgis_crs import make_in_main_thread, renew_in_main_thread

# The groups that the toolbox shows first.
_FIRST_GROUPS = ("Models", "Models in tiles", "Models as published")

# The icon of these.
_MODELS = "models"

# Search words that apply to every algorithm; formats find those that are about files.
_TAGS_OF_ALL = ("lidar", "point cloud")


class CheckedAlgorithm:
    """An algorithm that refuses what it can before it runs, in the words that the run would use.

    It answers QGIS's questions from the declaration of a stage or pipeline. Subclasses implement :meth:`check`; their
    second base is QGIS's own class.
    """

    declared: Union[Stage, Pipeline]

    def createInstance(self) -> CheckedAlgorithm:  # noqa: N802 - QGIS asks for these names
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

    def check(self, parameters: dict, context: QgsProcessingContext) -> None:
        """Find out what a run needs; refuse with a ValueError what can be refused before it."""
        raise NotImplementedError

    def systems(self) -> Iterable[str]:
        """Return the coordinate reference systems (codes or WKT) that a checked run needs."""
        raise NotImplementedError

    def completed(self, parameters: dict) -> dict:
        """Return parameters as QGIS is to see them."""
        return parameters

    def canExecute(self) -> tuple[bool, str]:  # noqa: N802 - QGIS asks for these names
        """Whether the packages that it uses are there, and how to install what is missing."""
        missing = missing_sentence(self.declared.needed_packages)
        return (False, missing) if missing else super().canExecute()  # type: ignore[misc]

    def checkParameterValues(self, parameters: dict, context: QgsProcessingContext) -> tuple[bool, str]:  # noqa: N802
        """Refuse what can be refused before the run, in the words that the run would use."""
        try:
            self._checked(parameters, context)
        except ValueError as error:
            return False, str(error)
        except OSError as error:
            return False, sentence_of(error)
        return super().checkParameterValues(self.completed(parameters), context)  # type: ignore[misc]

    def prepareAlgorithm(  # noqa: N802
        self, parameters: dict, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ) -> bool:
        """Find out files and values; layers may be asked only here, in the main thread.

        Models and scripts come here without :meth:`checkParameterValues`, so everything is checked again.
        """
        with as_processing_errors():
            self._checked(parameters, context)
            # Those made last while something refers to them.
            self._made = make_in_main_thread(self.systems())
        return super().prepareAlgorithm(self.completed(parameters), context, feedback)  # type: ignore[misc]

    def postProcessAlgorithm(  # noqa: N802
        self, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ) -> dict:
        """Make the CRS of results last."""
        renew_in_main_thread(context.temporaryLayerStore().mapLayers().values())
        return {}

    def _checked(self, parameters: dict, context: QgsProcessingContext) -> None:
        missing = missing_sentence(self.declared.needed_packages)
        if missing:
            raise ValueError(missing)
        apply_options()
        self.check(parameters, context)
