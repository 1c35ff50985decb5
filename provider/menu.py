"""The plugin's menu and toolbar button: the way to a first result, and what helps where something is missing."""

from importlib import import_module
from pathlib import Path
from typing import Any, Callable, Optional

from qgis.core import (
    QgsApplication,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCsException,
    QgsMapLayer,
    QgsPointCloudLayer,
    QgsProcessingContext,
    QgsProject,
    QgsReferencedRectangle,
)
from qgis.PyQt.QtCore import Qt, QUrl
from qgis.PyQt.QtGui import QIcon
from qgis.PyQt.QtWidgets import QAction, QDockWidget, QTextBrowser

from ..algorithms.cloud.files import NOWHERE, read_extent
from ..algorithms.cloud.web_file import is_on_web
from . import DETECT, REVIEW_WINDOW
from .clouds import cloud_path, file_of_layer
from .crs_authority import crs_reader
from .given import Given
from .inputs import EXTENT, INPUT, extent_box
from .options import WEB_LIMIT
from .paths import GROUP_ICONS, ICON, PLUGIN
from .questions import is_answered_yes
from .styles import WHEN_LOADED
from .web import Size, agree_to, is_over_limit, web_size

MENU = "LiDAR Buildings"

# Text of the menu entry and of the button.
FIND_IN_VIEW = "Find buildings in this view…"

# Entries of the menu: text, icon, and the module and the function that are called. The first one is the button, too.
_ENTRIES = (
    (FIND_IN_VIEW, GROUP_ICONS / "buildings.svg", "menu", "open_dialog"),
    ("Show models in 3D", GROUP_ICONS / "3d.svg", "view3d", "show_view"),
    ("Review buildings…", GROUP_ICONS / "quality.svg", "review_dock", "show_review"),
    ("Open sample data", GROUP_ICONS / "simulation.svg", "sample", "open_sample"),
    ("First steps", ICON, "menu", "show_first_steps"),
    ("Check installation…", ICON, "installation", "show_installation"),
)

# Points that it works on in a minute, from file to file, on the slowest computer that it was measured on (2 cores).
_POINTS_PER_MINUTE = 2_000_000

# Styles of the results whose buildings are reviewed.
_REVIEWED = ("footprints", "updated_map")


def add_menu(iface: Any) -> Callable[[], None]:
    """Add the menu and the toolbar button; return what takes them away again."""
    actions = [_action(iface, *entry) for entry in _ENTRIES]
    find = actions[0]
    find.setToolTip("Find the buildings of the active point cloud within the map view")
    for action in actions:
        iface.addPluginToMenu(MENU, action)
    iface.addToolBarIcon(find)

    def remove() -> None:
        iface.removeToolBarIcon(find)
        for action in actions:
            iface.removePluginMenu(MENU, action)
        dock = iface.mainWindow().findChild(QDockWidget, REVIEW_WINDOW)
        if dock is not None:
            dock.close()
            iface.removeDockWidget(dock)
            dock.deleteLater()

    return remove


def offer_reviews(iface: Any) -> Callable[[], None]:
    """Offer the review of each result with buildings that is loaded; return what ends that."""

    def offer(style: Optional[str], layer: QgsMapLayer, context: QgsProcessingContext) -> None:
        if style in _REVIEWED:
            from .review_dock import offer_review

            offer_review(iface, layer, context)

    WHEN_LOADED.append(offer)
    return lambda: WHEN_LOADED.remove(offer)


def _action(iface: Any, text: str, icon: Path, module: str, function: str) -> QAction:
    """Return an entry that calls a function with QGIS's windows; its module is imported then."""
    action = QAction(QIcon(str(icon)), text, iface.mainWindow())
    action.triggered.connect(lambda: getattr(import_module(f".{module}", __package__), function)(iface))
    return action


def show_first_steps(iface: Any) -> None:
    """Show the page with the way to a first result."""
    page = QTextBrowser(iface.mainWindow())
    page.setWindowFlags(Qt.WindowType.Window)
    page.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    page.setWindowTitle("First steps")
    page.setSource(QUrl.fromLocalFile(str(PLUGIN / "docs" / "first_steps.md")))
    page.resize(1060, 800)  # pixels: its pictures are 1000 wide
    page.show()


def open_dialog(iface: Any) -> None:
    """Open the dialog of *Detect buildings* with the cloud and the extent that the map shows."""
    from processing import execAlgorithmDialog

    parameters = view_parameters(iface)
    if not parameters or _is_wanted(iface, parameters):
        execAlgorithmDialog(DETECT, parameters)


def _is_wanted(iface: Any, parameters: dict[str, Any]) -> bool:
    """Say how much of a cloud on the web a run reads; if it is over the limit, return whether the user wants it."""
    try:
        size = _size_of_view(parameters)
        if size is None:
            return True
        minutes = max(1, round(size.points / _POINTS_PER_MINUTE))
        told = f"{size.name}: {size} are in this view. Finding buildings in them takes about {minutes} min."
        if not is_over_limit(size):
            iface.messageBar().pushMessage(MENU, told)
            return True
    except ValueError as error:
        # The dialog shows it once more, where another cloud can be chosen.
        iface.messageBar().pushWarning(MENU, str(error))
        return True
    asked = f"{told}\n\nThat is more than the {WEB_LIMIT.value} MB that are read at once. Read it all the same?"
    if not is_answered_yes(iface.mainWindow(), MENU, asked):
        return False
    agree_to(size)
    return True


def _size_of_view(parameters: dict[str, Any]) -> Optional[Size]:
    """Return the size of the part of a cloud on the web that lies in the view; None for a cloud on this computer."""
    algorithm, context = QgsApplication.processingRegistry().createAlgorithmById(DETECT), QgsProcessingContext()
    context.setProject(QgsProject.instance())
    given = Given(algorithm, parameters, context)
    path = cloud_path(given, INPUT)
    if not is_on_web(path):
        return None
    plane = read_extent(path, crs_reader(QgsCoordinateReferenceSystem()), NOWHERE)[2].plane
    return web_size([path], extent_box(given, plane))


def view_parameters(iface: Any) -> dict[str, Any]:
    """Return the point cloud that the map shows, and the part of it within the map view, as parameters.

    The active layer is taken, or the first point cloud that is visible; without one, both are left to the user. There
    is no extent where the view shows the whole cloud or nothing of it.
    """
    cloud = _cloud(iface.activeLayer(), iface.mapCanvas().layers())
    if cloud is None:
        return {}
    extent = _visible_part(cloud, iface.mapCanvas())
    return {INPUT: cloud.id(), **({EXTENT: extent} if extent is not None else {})}


def _cloud(active: Optional[QgsMapLayer], visible: list[QgsMapLayer]) -> Optional[QgsPointCloudLayer]:
    """Return the active layer if it is a point cloud with a file, else the first visible one; the web has files too."""
    clouds = (one for one in (active, *visible) if isinstance(one, QgsPointCloudLayer))
    return next((one for one in clouds if _has_file(one)), None)


def _has_file(cloud: QgsPointCloudLayer) -> bool:
    """Whether a layer has a file; where its address is refused, the dialog says so."""
    try:
        return file_of_layer(cloud) is not None
    except ValueError:
        return True


def _visible_part(cloud: QgsPointCloudLayer, canvas: Any) -> Optional[QgsReferencedRectangle]:
    """Return the part of a cloud's extent in the map view, in the CRS of the map; None if that is all or nothing."""
    view, crs = canvas.extent(), canvas.mapSettings().destinationCrs()
    try:
        change = QgsCoordinateTransform(cloud.crs(), crs, QgsProject.instance())
        whole = change.transformBoundingBox(cloud.extent())
    except QgsCsException:
        return None
    if view.contains(whole) or not view.intersects(whole):
        return None
    return QgsReferencedRectangle(view.intersect(whole), crs)
