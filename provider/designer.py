"""The toolbox entry that opens a composite as a graph."""

from processing.gui.ContextAction import ContextAction
from qgis.PyQt.QtWidgets import QMessageBox

from .models import build_model
from .pipeline_algorithm import PipelineAlgorithm


class OpenInDesigner(ContextAction):
    """Open a composite in the model designer, as a model of the user's own to look at and change."""

    def __init__(self) -> None:
        super().__init__()
        self.name = "Open in Model Designer…"

    def isEnabled(self) -> bool:  # noqa: N802 - QGIS asks for this name
        """Whether the entry under the mouse is a composite of this plugin."""
        return isinstance(self.itemData, PipelineAlgorithm)

    def execute(self) -> None:
        """Show the graph."""
        try:
            from processing.modeler.ModelerDialog import ModelerDialog
        except ImportError as error:
            text = f"This version of QGIS opens its Model Designer in another way ({error}); the help lists all steps."
            QMessageBox.information(None, self.name, text)
            return
        dialog = ModelerDialog.create(build_model(self.itemData.pipeline))
        dialog.show()
        dialog.activate()
