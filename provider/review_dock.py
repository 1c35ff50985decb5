"""The window in which buildings are reviewed one by one, the least sure first."""

from __future__ import annotations

import html
import json
from typing import Any, Callable, Optional

from qgis.core import (
    Qgis,
    QgsApplication,
    QgsExpression,
    QgsFeature,
    QgsFeatureRequest,
    QgsProcessingContext,
    QgsProcessingUtils,
    QgsProject,
    QgsVectorLayer,
)
from qgis.gui import QgsMapTool, QgsRubberBand
from qgis.PyQt import QtWidgets
from qgis.PyQt.QtCore import QEvent, QSignalBlocker, Qt, QTimer
from qgis.PyQt.QtGui import QColor, QKeySequence

from ..algorithms.buildings.reviewed_buildings import DELETED, KEPT, REVIEW, REVIEWED
from ..algorithms.quality.map_changes import STATUS, UNCHANGED
from ..algorithms.quality.report_buildings import SURE
from . import DETECT, REVIEW_WINDOW
from .input_layers import input_layer_name
from .inputs import INPUT
from .questions import push_with_button
from .review import CONFIDENCE, Review, changes_between, is_reviewable
from .review_views import PointViews, clouds_for
from .styles import RUN
from .view3d import look_at, view_angles

# Columns of the list: attributes and their titles.
_COLUMNS = {
    "id": "Building",
    CONFIDENCE: "Confidence",
    STATUS.name: "Change",
    REVIEW: "Review",
    "area": "Area (m²)",
    "points": "Points",
    "reason": "Reason",
}

# Which buildings can be listed, by name: the attribute that a layer must have, and the expression. Of a layer the first
# that it can have is chosen, which is also counted after a run; attributes that are still to come are NULL.
_FILTERS = {
    "Changed": (STATUS.name, f"\"{STATUS.name}\" <> '{UNCHANGED}'"),
    "Doubtful": (CONFIDENCE, f'"{CONFIDENCE}" < {SURE}'),
    "Simpler models": ("check", '"check" = 2'),
    "Not yet reviewed": (CONFIDENCE, f'"{REVIEW}" IS NULL'),
    "All buildings": (CONFIDENCE, "TRUE"),
}

# Attributes with the elevation of the ground, and the height above it.
_HEIGHTS = ("ground_elevation", "height")

# Width of the map, in widths of the building.
_AROUND = 4.0

# Color and width (pixels) of the outline of the current building on the map.
_OUTLINE, _WIDTH = QColor(0, 229, 255), 3

# The advice of an empty list.
_NOTHING = "No building is listed; choose a layer of footprints, or list all."

# Buttons in a row.
_IN_ROW = 3


def show_review(iface: Any, layer: Optional[QgsVectorLayer] = None) -> ReviewDock:
    """Open the window for a layer, else for the active one, or for the first that has a confidence."""
    dock = iface.mainWindow().findChild(QtWidgets.QDockWidget, REVIEW_WINDOW)
    if dock is None:
        dock = ReviewDock(iface)
        iface.addTabifiedDockWidget(Qt.DockWidgetArea.RightDockWidgetArea, dock, [], True)
    offered = (layer, iface.activeLayer(), *QgsProject.instance().mapLayers().values())
    dock.show()
    dock.raise_()
    dock.follow(next(filter(is_reviewable, offered), None))
    dock.list.setFocus()
    return dock


def _filters_of(layer: QgsVectorLayer) -> dict[str, str]:
    """Return the expressions of the filters that a layer can have, by name."""
    return {name: which for name, (needed, which) in _FILTERS.items() if layer.fields().lookupField(needed) >= 0}


def _run_of(layer: QgsVectorLayer) -> tuple[str, dict[str, Any]]:
    """Return the algorithm that made a layer, and its parameters; "" and none where they are not known."""
    return tuple(json.loads(layer.customProperty(RUN, '["", {}]')))


def offer_review(iface: Any, layer: QgsVectorLayer, context: QgsProcessingContext) -> None:
    """Say how many buildings a run has found and how many decisions have changed, with a button for their review."""
    if not is_reviewable(layer):
        return
    name, which = next(iter(_filters_of(layer).items()))
    open_ones = QgsExpression(f'({which}) AND "{REVIEW}" IS NULL')
    request = QgsFeatureRequest(open_ones).setFlags(Qgis.FeatureRequestFlag.NoGeometry)
    count, made = sum(1 for _ in layer.getFeatures(request)), layer.id()
    said = f"{layer.featureCount()} buildings, {count} of them {name.lower()}."
    source = _run_of(layer)[1].get(input_layer_name(REVIEWED))
    before = QgsProcessingUtils.mapLayerFromString(source, context) if source else None
    if before is not None:
        changes = changes_between(before, layer)
        said += f" Since the review: {', '.join(f'{count} {kind}' for kind, count in changes.items())}."
    find = QgsProject.instance().mapLayer
    push_with_button(iface, "LiDAR Buildings", said, "Review buildings…", lambda: show_review(iface, find(made)))


class ReviewDock(QtWidgets.QDockWidget):
    """A list of the buildings of the active layer, the evidence for the current one, and the decisions."""

    def __init__(self, iface: Any) -> None:
        super().__init__("Review buildings", iface.mainWindow())
        self.setObjectName(REVIEW_WINDOW)
        self.iface, self.canvas = iface, iface.mapCanvas()
        self.review: Any = None
        self._listed: list[QgsFeature] = []
        self._fid: Any = None
        self._tool: Optional[QgsMapTool] = None
        self._band = QgsRubberBand(self.canvas, Qgis.GeometryType.Polygon)
        self._band.setStrokeColor(_OUTLINE)
        self._band.setFillColor(QColor(0, 0, 0, 0))
        self._band.setWidth(_WIDTH)
        # Many signals of a layer end in one new list.
        self._later = QTimer(self, singleShot=True, interval=0)
        self._later.timeout.connect(self.fill)
        self.filter = QtWidgets.QComboBox()
        self.filter.currentIndexChanged.connect(self.fill)
        self.list = QtWidgets.QTreeWidget(rootIsDecorated=False, uniformRowHeights=True)
        self.list.setHeaderLabels(_COLUMNS.values())
        self.list.header().setSectionResizeMode(QtWidgets.QHeaderView.ResizeMode.ResizeToContents)
        self.list.currentItemChanged.connect(self._show)
        self.facts, self.count = QtWidgets.QLabel(wordWrap=True), QtWidgets.QLabel(wordWrap=True)
        self.views = PointViews()
        self.setWidget(QtWidgets.QWidget())
        layout = QtWidgets.QVBoxLayout(self.widget())
        for widget in (self.filter, self.list, self.facts, self.views):
            layout.addWidget(widget)
        layout.addLayout(self._buttons())
        layout.addWidget(self.count)
        iface.currentLayerChanged.connect(self.follow)

    def _buttons(self) -> QtWidgets.QGridLayout:
        """Return buttons, whose keys hold in this window and on the map."""
        grid = QtWidgets.QGridLayout()
        given = (
            ("Keep", "K", lambda _: self.decide(KEPT)),
            ("Delete", "D", lambda _: self.decide(DELETED)),
            ("Merge", "M", self.merge),
            ("Divide", "L", self.divide),
            ("Previous", "P", lambda _: self.go_to(self.row - 1)),
            ("Next", "N", lambda _: self.go_to(self.row + 1)),
            ("Undo", "", lambda review: review.layer.undoStack().undo()),
            ("Save", "", Review.save),
            ("Remove deleted", "", Review.remove_deleted),
            ("Run again…", "", self.run_again),
        )
        for number, (text, key, run) in enumerate(given):
            action = QtWidgets.QAction(f"{text} ({key})" if key else text, self)
            action.setShortcut(QKeySequence(key))
            action.setShortcutContext(Qt.ShortcutContext.WidgetWithChildrenShortcut)
            action.triggered.connect(lambda _, run=run: self._try(run))
            self.visibilityChanged.connect(action.setEnabled)
            self.addAction(action)
            self.canvas.addAction(action)
            button = QtWidgets.QToolButton()
            button.setDefaultAction(action)
            grid.addWidget(button, *divmod(number, _IN_ROW))
        return grid

    def follow(self, layer: Any) -> None:
        """Review a layer while the window is open, if it can be."""
        if not self.isHidden() and is_reviewable(layer) and not (self.review and self.review.layer == layer):
            self._begin(layer)

    def _begin(self, layer: Optional[QgsVectorLayer]) -> None:
        """Review a layer, or none; the decisions on the one before are saved."""
        if self.review is not None:
            self.review.layer.willBeDeleted.disconnect(self._forget)
            self._end_division()
            self._try(Review.end)
        self.review, self._fid = None, None
        if layer is not None:
            self.review = Review(layer, self._changed)
            layer.willBeDeleted.connect(self._forget)
            self._fit_to(layer)
        self.fill()
        self._go_to_open()

    def _fit_to(self, layer: QgsVectorLayer) -> None:
        """Offer the filters and columns that a layer has attributes for."""
        with QSignalBlocker(self.filter):
            self.filter.clear()
            for name, which in _filters_of(layer).items():
                self.filter.addItem(name, which)
        for column, name in enumerate(_COLUMNS):
            self.list.setColumnHidden(column, name != REVIEW and not self.review.has(name))

    def _forget(self) -> None:
        """Forget a layer that leaves the project."""
        self.review, self._tool = None, None
        self.fill()

    def _changed(self, fid: Optional[int]) -> None:
        """List the buildings anew, and go to the one of which a step was undone."""
        if fid is not None and not self.review.layer.isEditCommandActive():
            self._fid = fid
        self._later.start()

    @property
    def row(self) -> int:
        """The row of the current building."""
        return self.list.currentIndex().row()

    def fill(self, *_: Any) -> None:
        """List the buildings, and stay at the current one."""
        self._later.stop()
        self._listed = self.review.buildings(self.filter.currentData()) if self.review else []
        fids = [one.id() for one in self._listed]
        row = fids.index(self._fid) if self._fid in fids else max(0, min(self.row, len(fids) - 1))
        self.list.clear()
        self.list.addTopLevelItems([QtWidgets.QTreeWidgetItem(self._texts(one)) for one in self._listed])
        self.go_to(row)
        self._count()

    def _texts(self, building: QgsFeature) -> list[str]:
        """Return the texts of a building in the list."""
        values = {name: self.review.value(building, name) for name in _COLUMNS}
        numbers = {CONFIDENCE: ".2f", "area": ",.0f", "points": ",.0f"}
        return ["" if one is None else format(one, numbers.get(name, "")) for name, one in values.items()]

    def go_to(self, row: int) -> None:
        """Go to the building of a row, if there is one."""
        if 0 <= row < len(self._listed):
            self.list.setCurrentItem(self.list.topLevelItem(row))

    def _go_to_open(self) -> None:
        """Go to the first building without a decision, from the current one on."""
        rows = [*range(max(self.row, 0), len(self._listed)), *range(self.row)]
        self.go_to(next((row for row in rows if self.review.value(self._listed[row], REVIEW) is None), -1))

    def _show(self, *_: Any) -> None:
        """Show the current building: in words, on the map and in space."""
        before, self._fid = self._fid, self._listed[self.row].id() if 0 <= self.row < len(self._listed) else None
        self._end_division()
        self._band.reset(Qgis.GeometryType.Polygon)
        if self._fid is None:
            self.facts.setText(_NOTHING)
            return
        layer, outline = self.review.layer, self.review.layer.getGeometry(self._fid)
        why = [self.review.value(self._listed[self.row], name) for name in ("reason", "evidence")]
        facts = ": ".join(one for one in why if one)
        for other in self.review.overlapped(self._fid):
            facts += f" Overlaps building {self.review.value(other, 'id')}: move a wall of one, or delete it."
        self.facts.setText(html.escape(facts.strip()))
        self._band.setToGeometry(outline, layer)
        self.views.show_building(layer, outline)
        if self._fid != before:
            box = self.canvas.mapSettings().layerExtentToOutputExtent(layer, outline.boundingBox())
            box.scale(_AROUND)
            self.canvas.setExtent(box)
            self.canvas.refresh()
            low, height = (self.review.value(self._listed[self.row], name) or 0.0 for name in _HEIGHTS)
            for canvas in self.iface.mapCanvases3D():
                look_at(canvas, box, low, low + height, *view_angles([]))

    def _count(self) -> None:
        """Say how many are reviewed, and that decisions are to be saved."""
        done = sum(self.review.value(one, REVIEW) is not None for one in self._listed)
        said = [f"{done} of {len(self._listed)} reviewed."]
        if self.review is not None and self.review.layer.undoStack().index():
            said.append(f"Steps to save: {self.review.layer.undoStack().index()}.")
        if self.review is not None and self.review.layer.isTemporary():
            said.append("The layer is temporary: export it before QGIS closes.")
        self.count.setText(" ".join(said))

    def decide(self, decision: str) -> None:
        """Record a decision on the current building, and go to the next without one."""
        self.review.decide(self._current(), decision)
        self.fill()
        self._go_to_open()

    def merge(self, review: Review) -> None:
        """Merge the current building with others."""
        self._fid = review.merge(self._current())

    def divide(self, review: Review) -> None:
        """Have a line drawn that divides the current building; afterwards the tool is the one before."""
        review.prepare_division(self._current())
        self._tool = self.canvas.mapTool()
        self.iface.actionSplitFeatures().trigger()

    def _end_division(self) -> None:
        """Give the tool back that was there before a line was drawn."""
        if self._tool is not None:
            self.canvas.setMapTool(self._tool)
            self.review.layer.removeSelection()
            self._tool = None

    def run_again(self, review: Review) -> None:
        """Open the dialog of the run that made the buildings, with its parameters and with these decisions.

        It is *Detect buildings* with the cloud where the run is not known or takes no decisions.
        """
        from processing import execAlgorithmDialog

        review.save()
        decisions, (algorithm, given) = input_layer_name(REVIEWED), _run_of(review.layer)
        known = QgsApplication.processingRegistry().algorithmById(algorithm)
        if known is None or known.parameterDefinition(decisions) is None:
            algorithm, given = DETECT, {INPUT: next((one.id() for one in clouds_for(review.layer)), None)}
        execAlgorithmDialog(algorithm, {**given, decisions: review.layer.id()})

    def _current(self) -> int:
        """Return the current building, or refuse."""
        if self._fid is None:
            raise ValueError(_NOTHING)
        return self._fid

    def _try(self, run: Callable[[Review], None]) -> None:
        """Do something, or say why it can't be done; the layer becomes the active one, for QGIS's own undo."""
        if self.review is None:
            return
        self.iface.setActiveLayer(self.review.layer)
        try:
            run(self.review)
        except ValueError as error:
            self.iface.messageBar().pushWarning(self.windowTitle(), str(error))

    def closeEvent(self, event: QEvent) -> None:  # noqa: N802 - Qt asks for this name
        self._begin(None)
        super().closeEvent(event)
