"""Questions to the user, and messages with something to do."""

from contextlib import suppress
from typing import Any, Callable, Optional

from qgis.core import Qgis
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import QMessageBox, QPushButton, QWidget


def question_box(parent: Optional[QWidget], title: str, text: str) -> QMessageBox:
    """Return the window of a question whose text is shown as it is, character by character; No is the default.

    Qt would take an address or a path with markup for HTML and hide a part of it.
    """
    buttons = QMessageBox.StandardButton
    box = QMessageBox(QMessageBox.Icon.Question, title, text, buttons.Yes | buttons.No, parent)
    box.setTextFormat(Qt.TextFormat.PlainText)
    box.setDefaultButton(buttons.No)
    return box


def is_answered_yes(parent: Optional[QWidget], title: str, text: str) -> bool:
    """Ask, and return whether the answer is Yes."""
    return question_box(parent, title, text).exec() == QMessageBox.StandardButton.Yes


def push_with_button(
    iface: Any, title: str, text: str, label: str, run: Callable[[], Any], level: Any = Qgis.MessageLevel.Info
) -> Callable[[], None]:
    """Show a message above the map with a button, which closes it unless ``run`` returns False; return what does."""
    item = iface.messageBar().createMessage(title, text)
    button = QPushButton(label, item)

    def remove() -> None:
        # Qt may have deleted it with the bar.
        with suppress(RuntimeError):
            iface.messageBar().popWidget(item)

    button.clicked.connect(lambda: remove() if run() is not False else None)
    item.layout().addWidget(button)
    iface.messageBar().pushWidget(item, level)
    return remove
