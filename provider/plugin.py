"""The plugin as QGIS sees it: it adds the provider, and takes everything away again."""

import sys
from importlib import import_module
from pathlib import Path
from typing import Callable, Optional

from qgis.core import Qgis, QgsApplication, QgsMessageLog, QgsProcessingRegistry

from .options import add_options
from .provider import Provider

# Tab of the log messages.
LOG = "LiDAR Buildings"


class Plugin:
    """Entry point of QGIS.

    ``initProcessing`` is all that ``qgis_process`` calls; ``initGui`` adds what needs a desktop.
    """

    def __init__(self, iface) -> None:
        self.iface = iface
        self.provider: Optional[Provider] = None
        self._undo: list[Callable[[], None]] = []
        self._added_path: Optional[str] = None

    def initProcessing(self) -> None:  # noqa: N802 - QGIS asks for this name
        """Add the provider to Processing."""
        self._add_dependencies_folder()
        self.provider = Provider()
        self._registry().addProvider(self.provider)

    def initGui(self) -> None:  # noqa: N802 - QGIS asks for this name
        """Add the provider, and then the optional parts."""
        self.initProcessing()
        self._add("The page of the plugin in the options of Processing", add_options)
        self._add("The menu of the plugin", lambda: self._with_iface("menu", "add_menu"))
        self._add("The offer of a review", lambda: self._with_iface("menu", "offer_reviews"))
        self._add("The message on missing packages", lambda: self._with_iface("installation", "warn_at_start"))
        self._add("The toolbox entry 'Open in Model Designer'", self._add_designer)

    def _add(self, what: str, add: Callable[[], Callable[[], None]]) -> None:
        """Add an optional part to the desktop, and keep the call that removes it; where it fails, the log says so.

        Modules of QGIS's own plugins move between its versions, and the algorithms need none of them.
        """
        try:
            self._undo.append(add())
        except Exception as error:  # noqa: BLE001 - whatever another version of QGIS raises
            said = f"{what} is missing in this version of QGIS ({error}); all algorithms work without it."
            QgsMessageLog.logMessage(said, LOG, Qgis.MessageLevel.Warning)

    def _with_iface(self, module: str, function: str) -> Callable[[], None]:
        """Call a function of a module that needs the windows of QGIS, where there are some."""
        if self.iface is None:
            return lambda: None
        return getattr(import_module(f".{module}", __package__), function)(self.iface)

    def _add_designer(self) -> Callable[[], None]:
        """Add "open in the model designer" to the toolbox."""
        from processing.gui.ProviderActions import ProviderContextMenuActions

        from .designer import OpenInDesigner

        actions = [OpenInDesigner()]
        ProviderContextMenuActions.registerProviderContextMenuActions(actions)
        return lambda: ProviderContextMenuActions.deregisterProviderContextMenuActions(actions)

    def unload(self) -> None:
        """Take away what was added."""
        while self._undo:
            self._undo.pop()()
        if self.provider is not None:
            self._registry().removeProvider(self.provider)
            self.provider = None
        if self._added_path in sys.path:
            sys.path.remove(self._added_path)

    def _registry(self) -> QgsProcessingRegistry:
        return QgsApplication.processingRegistry()

    def _add_dependencies_folder(self) -> None:
        """Find packages that the QPIP plugin installed also in ``qgis_process``, where QPIP itself does not run."""
        folder = str(Path(QgsApplication.qgisSettingsDirPath()) / "python" / "dependencies")
        if Path(folder).is_dir() and folder not in sys.path:
            sys.path.append(folder)
            self._added_path = folder
