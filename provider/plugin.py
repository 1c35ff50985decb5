"""The plugin as QGIS sees it: it adds the provider, and takes everything away again."""

from __future__ import annotations

import sys
from pathlib import Path

from qgis.core import QgsApplication, QgsProcessingRegistry

from .provider import Provider


class Plugin:
    """Entry point of QGIS.

    ``initProcessing`` is all that ``qgis_process`` calls; ``initGui`` adds what needs a desktop.
    """

    def __init__(self, iface) -> None:
        self.iface = iface
        self.provider = None
        self._actions: list = []
        self._added_path = ""

    def initProcessing(self) -> None:  # noqa: N802 - QGIS asks for this name
        """Add the provider to Processing."""
        self._add_dependencies_folder()
        self.provider = Provider()
        self._registry().addProvider(self.provider)
        # Models look their children up in the registry, where they are only now.
        self.provider.refreshAlgorithms()

    def initGui(self) -> None:  # noqa: N802 - QGIS asks for this name
        """Add the provider, and "open in the model designer" to the toolbox."""
        from processing.gui.ProviderActions import ProviderContextMenuActions

        from .designer import OpenInDesigner

        self.initProcessing()
        self._actions = [OpenInDesigner()]
        ProviderContextMenuActions.registerProviderContextMenuActions(self._actions)

    def unload(self) -> None:
        """Take away what was added."""
        if self._actions:
            from processing.gui.ProviderActions import ProviderContextMenuActions

            ProviderContextMenuActions.deregisterProviderContextMenuActions(self._actions)
            self._actions = []
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
