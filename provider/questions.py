"""Questions to the user, and messages with something to do."""

from __future__ import annotations

from typing import Any, Callable, Optional

from qgis.core import Qgis
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import QMessageBox, QPushButton, QWidget


def question_box(parent: Optional[QWidget], title: str, text: str) -> QMessageBox:
    """Return the window of a question whose text is shown as it is, character by character; No is the default.

    Qt would take an address or a path with markup in it for HTML, and not show a part of what is asked for.
    """
    buttons = QMessageBox.StandardButton
    box = QMessageBox(QMessageBox.Icon.Question, title, text, buttons.Yes | buttons.No, parent)
    box.setTextFormat(Qt.TextFormat.PlainText)
    box.setDefaultButton(buttons.No)
    return box


def is_answered_yes(parent: Optional[QWidget], title: str, text: str) -> bool:
    """Ask, and return whether the answer is Yes."""
    return question_box(parent, title, text).exec() == QMessageBox.StandardButton.Yes


def push_with_button(iface: Any, title: str, text: str, label: str, run: Callable[[], Any]) -> None:
    """Show a message above the map with a button, which closes it."""
    item = iface.messageBar().createMessage(title, text)
    button = QPushButton(label, item)
    button.clicked.connect(run)
    button.clicked.connect(lambda: iface.messageBar().popWidget(item))
    item.layout().addWidget(button)
    iface.messageBar().pushWidget(item, Qgis.MessageLevel.Info)
