"""Buttons next to text fields that fill them in: classes by their names, dimensions of the chosen cloud."""

from typing import Callable

from qgis.PyQt.QtWidgets import QHBoxLayout, QLineEdit, QMenu, QToolButton, QWidget

from ..algorithms.cloud.asprs import PointClass, parse_classes


class Picker(QWidget):
    """A text field with a button; ``fill`` gets the emptied menu and the field each time that the menu opens."""

    def __init__(self, field: QLineEdit, tip: str, fill: Callable[[QMenu, QLineEdit], None]) -> None:
        super().__init__()
        self.field = field
        self.button = QToolButton()
        self.button.setText("…")
        self.button.setToolTip(tip)
        self.button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.menu = QMenu(self.button)
        self.menu.aboutToShow.connect(self.open)
        self.button.setMenu(self.menu)
        self.fill = fill
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(field)
        row.addWidget(self.button)

    def open(self) -> None:
        """Make the menu anew."""
        self.menu.clear()
        self.fill(self.menu, self.field)


def fill_with_classes(menu: QMenu, field: QLineEdit) -> None:
    """Fill a menu with all classes; those that the field names are checked, and a click adds one or takes it away."""
    chosen = chosen_classes(field.text())
    for one in PointClass:
        # Number and name of the class: "6 Building".
        action = menu.addAction(f"{int(one)} {one.name.replace('_', ' ').capitalize()}")
        action.setCheckable(True)
        action.setChecked(int(one) in chosen)
        action.toggled.connect(lambda is_on, one=int(one): field.setText(with_class(field.text(), one, is_on)))


def chosen_classes(text: str) -> set[int]:
    """Return the numbers of the classes that a text names; an empty set where it can't be read."""
    try:
        return set(parse_classes(text).tolist())
    except ValueError:
        return set()


def with_class(text: str, number: int, is_chosen: bool) -> str:
    """Return the text of classes with or without one of them; consecutive numbers become a range."""
    chosen = chosen_classes(text)
    chosen = chosen | {number} if is_chosen else chosen - {number}
    parts: list[list[int]] = []
    for one in sorted(chosen):
        if parts and parts[-1][-1] == one - 1:
            parts[-1].append(one)
        else:
            parts.append([one])
    return ", ".join(f"{part[0]}-{part[-1]}" if len(part) > 2 else ", ".join(map(str, part)) for part in parts)


def fill_with_names(names: list[str], menu: QMenu, field: QLineEdit) -> None:
    """Fill a menu with names; a click puts one into the field."""
    for name in names:
        menu.addAction(name).triggered.connect(lambda _, name=name: field.setText(name))
    if not names:
        menu.addAction("Choose a point cloud first").setEnabled(False)
