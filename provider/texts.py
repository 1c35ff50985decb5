"""Texts of menus and messages in the language of QGIS."""

from __future__ import annotations

from qgis.PyQt.QtCore import QCoreApplication

_CONTEXT = "LidarBuildings"


def tr(text: str) -> str:
    """Return a text in the language of QGIS, or as it is where there is no translation."""
    return QCoreApplication.translate(_CONTEXT, text)
