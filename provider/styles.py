"""How results look when QGIS loads them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Optional, Union

from qgis.core import QgsEditorWidgetSetup, QgsProcessingContext, QgsProcessingLayerPostProcessorInterface
from qgis.PyQt import sip

from ..algorithms.cloud.cloud import Cloud
from ..algorithms.stage import Field, Layer, Raster, Stage
from .paths import STYLES

# Decimals of numbers in tables: millimeters.
_DECIMALS = 3


class Styler(QgsProcessingLayerPostProcessorInterface):
    """Gives a loaded result the style of one file, and its table the units of the fields and few decimals."""

    def __init__(self, stem: str, fields: Sequence[Field] = ()) -> None:
        super().__init__()
        self.stem, self.fields = stem, fields

    def postProcessLayer(self, layer, context, feedback) -> None:  # noqa: N802 - QGIS asks for this name
        """Load the style, and say so in the log when it can't be."""
        message, loaded = layer.loadNamedStyle(str(STYLES / f"{self.stem}.qml"))
        if not loaded:
            feedback.pushWarning(f"The style {self.stem} can't be loaded: {message}")
        for declared in self.fields:
            index = layer.fields().indexOf(declared.name)
            if declared.unit:
                layer.setFieldAlias(index, f"{declared.name} ({declared.unit})")
            if declared.type is float:
                rounded = QgsEditorWidgetSetup("Range", {"Precision": _DECIMALS, "AllowNull": True})
                layer.setEditorWidgetSetup(index, rounded)
        layer.triggerRepaint()


# QGIS deletes post processors with the run's context, but keeps no reference until then: one that Python forgets
# is never called.
_KEPT: list[Styler] = []


def cloud_style(stage: Stage, cloud: Cloud) -> Optional[str]:
    """Return the style of a stage's cloud: that of the first dimension it wrote that has one."""
    made = (name for name in (*stage.writes, *stage.creates) if cloud.has(name))
    return next((name for name in made if (STYLES / f"{name}.qml").is_file()), None)


def layer_style(layer: Union[Layer, Raster]) -> Optional[str]:
    """Return the style of a layer or raster: the declared one, or that of its name."""
    stem = layer.style or layer.name
    return stem if (STYLES / f"{stem}.qml").is_file() else None


def style_on_load(
    context: QgsProcessingContext, target: str, stem: Optional[str], fields: Sequence[Field] = ()
) -> None:
    """Have the result ``target`` styled when, and if, it is loaded."""
    if stem is None or not context.willLoadLayerOnCompletion(target):
        return
    _KEPT[:] = [styler for styler in _KEPT if not sip.isdeleted(styler)]
    _KEPT.append(Styler(stem, fields))
    context.layerToLoadOnCompletionDetails(target).setPostProcessor(_KEPT[-1])
