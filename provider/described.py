"""What QGIS asks of every algorithm and its stage or pipeline knows: names, group, tags, icon, help page."""

from __future__ import annotations

from typing import Union

from qgis.PyQt.QtCore import QUrl
from qgis.PyQt.QtGui import QIcon

from ..algorithms.pipelines import Pipeline
from ..algorithms.stage import Stage
from .paths import HELP, ICON


class Described:
    """An algorithm that tells what its stage or pipeline, ``described``, declares."""

    described: Union[Stage, Pipeline]

    def name(self) -> str:
        """Return the id, frozen: saved models depend on it."""
        return self.described.id

    def displayName(self) -> str:  # noqa: N802 - QGIS asks for these names
        """Return the title."""
        return self.described.title

    def group(self) -> str:
        """Return the group's title."""
        return self.described.group

    def groupId(self) -> str:  # noqa: N802
        """Return the group's id."""
        return self.described.group.lower().replace(" ", "")

    def tags(self) -> list:
        """Return words that the toolbox finds the algorithm by."""
        return [tag.strip() for tag in self.described.tags.split(",") if tag.strip()]

    def icon(self) -> QIcon:
        """Return the plugin's icon."""
        return QIcon(str(ICON))

    def svgIconPath(self) -> str:  # noqa: N802
        """Return the icon's file."""
        return str(ICON)

    def shortDescription(self) -> str:  # noqa: N802
        """Return what it is for, in a sentence."""
        return self.described.summary

    def helpUrl(self) -> str:  # noqa: N802
        """Return the help page, which comes with the plugin."""
        return QUrl.fromLocalFile(str(HELP / f"{self.described.id}.html")).toString()
