"""Texts of menus, dialogs and messages in the language of QGIS."""

from __future__ import annotations

from typing import Optional

from qgis.core import QgsApplication
from qgis.PyQt.QtCore import QCoreApplication, QTranslator

from .paths import TRANSLATIONS

CONTEXT = "LidarBuildings"


def tr(text: str) -> str:
    """Return a text in the language of QGIS, or as it is where there is no translation."""
    return QCoreApplication.translate(CONTEXT, text) if text else ""


def install_translation() -> Optional[QTranslator]:
    """Load the translation into the language of QGIS, if there is one; it holds as long as the returned object."""
    translator = QTranslator()
    if not translator.load(str(TRANSLATIONS / f"lidar_buildings_{QgsApplication.locale()}.qm")):
        return None
    QCoreApplication.installTranslator(translator)
    return translator
