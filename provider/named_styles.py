"""Styles that users switch between, under Styles in the menu of a layer: by height, confidence, reason, roof type."""

from qgis.core import (
    QgsCategorizedSymbolRenderer,
    QgsClassificationPrettyBreaks,
    QgsFillSymbol,
    QgsGradientColorRamp,
    QgsGradientStop,
    QgsGraduatedSymbolRenderer,
    QgsMapLayer,
    QgsPointCloudLayer,
    QgsRasterLayer,
    QgsRasterMinMaxOrigin,
    QgsRendererCategory,
    QgsRendererRange,
    QgsVectorLayer,
)
from qgis.PyQt.QtGui import QColor

from ..algorithms.cloud.dimensions import DIMENSIONS
from .paths import STYLES

# Attributes of polygons by which these are colored, and what the style is called.
_BY_ATTRIBUTE = {
    "height": "Height",
    "ridge_height": "Ridge height",
    "confidence": "Confidence",
    "reason": "Reason",
    "roof_type": "Roof type",
    "level": "Level of detail",
}

# Dimensions of clouds in the same way.
_BY_DIMENSION = {
    "classification": "Class",
    "height_above_ground": "Height above ground",
    "confidence": "Confidence",
    "reason": "Reason",
    "segment_id": "Segments",
    "cluster_id": "Clusters",
}

# Bounds of confidence on the pages, and their colors (Tol's high-contrast scheme).
_CONFIDENCE = ((0.0, 0.5, "#bb5566"), (0.5, 0.7, "#ddaa33"), (0.7, 1.0, "#004488"))

# Colors of kinds (Tol's muted scheme); further ones begin again.
_KINDS = ("#88ccee", "#cc6677", "#ddcc77", "#117733", "#332288", "#aa4499", "#44aa99", "#999933", "#882255")

# Colors of the lowest, middle and highest values of an attribute.
_LOW, _MIDDLE, _HIGH = "#4a6fa5", "#f5e6a1", "#b5202c"

# Number of classes of a numeric attribute, about: their bounds are round.
_CLASSES = 6

# Shares of the heights up to which their colors reach, as QGIS has them by default: single masts, birds and low noise
# would make all others pale.
CUTS = (QgsRasterMinMaxOrigin.CUMULATIVE_CUT_LOWER, QgsRasterMinMaxOrigin.CUMULATIVE_CUT_UPPER)


def add_named_styles(layer: QgsMapLayer) -> None:
    """Add styles to a layer; the style that it has remains the current one."""
    manager = layer.styleManager()
    first = manager.currentStyle()
    if isinstance(layer, QgsVectorLayer):
        for name, title in _BY_ATTRIBUTE.items():
            renderer = _renderer(layer, name) if layer.fields().indexOf(name) >= 0 else None
            if renderer is not None:
                manager.addStyleFromLayer(title)
                manager.setCurrentStyle(title)
                layer.setRenderer(renderer)
    elif isinstance(layer, QgsPointCloudLayer):
        on_disk = {one.name() for one in layer.attributes().attributes()}
        current_attribute = layer.renderer().attribute() if hasattr(layer.renderer(), "attribute") else ""
        for name, title in _BY_DIMENSION.items():
            disk = DIMENSIONS[name].disk[0]
            if disk == current_attribute:
                manager.renameStyle(first, title)
                first = title
            elif disk in on_disk:
                manager.addStyleFromLayer(title)
                manager.setCurrentStyle(title)
                layer.loadNamedStyle(str(STYLES / f"{name}.qml"))
    manager.setCurrentStyle(first)


def _renderer(layer: QgsVectorLayer, name: str):
    """Return the renderer of polygons by an attribute; None if it has no values."""
    if name == "confidence":
        ranges = [
            QgsRendererRange(low, high, _symbol(color), f"{low:g} - {high:g}") for low, high, color in _CONFIDENCE
        ]
        return QgsGraduatedSymbolRenderer(name, ranges)
    index = layer.fields().indexOf(name)
    if layer.fields()[index].isNumeric():
        if layer.minimumAndMaximumValue(index)[0] is None:
            return None
        renderer = QgsGraduatedSymbolRenderer(name)
        renderer.setSourceSymbol(_symbol(_LOW))
        renderer.setClassificationMethod(QgsClassificationPrettyBreaks())
        renderer.updateClasses(layer, _CLASSES)
        stops = [QgsGradientStop(0.5, QColor(_MIDDLE))]
        renderer.updateColorRamp(QgsGradientColorRamp(QColor(_LOW), QColor(_HIGH), False, stops))
        return renderer
    values = sorted(str(value) for value in layer.uniqueValues(index) if value)
    if not values:
        return None
    categories = [QgsRendererCategory(value, _symbol(_KINDS[i % len(_KINDS)]), value) for i, value in enumerate(values)]
    return QgsCategorizedSymbolRenderer(name, categories)


def _symbol(color: str) -> QgsFillSymbol:
    """Return polygons of a color with a thin dark outline (mm)."""
    return QgsFillSymbol.createSimple({"color": color, "outline_color": "#333333", "outline_width": "0.2"})


def fit_ramp(layer: QgsRasterLayer) -> None:
    """Stretch the ramp of heights, from 0, to the highest values of a raster."""
    function = _ramp(layer)
    if function is None:
        return
    _, high = layer.dataProvider().cumulativeCut(1, *CUTS, layer.extent(), int(QgsRasterLayer.SAMPLE_SIZE))
    items = function.colorRampItemList()
    if not items or not high > 0:
        return
    factor = high / items[-1].value
    for item in items:
        item.value *= factor
        item.label = f"{item.value:.1f} m"
    function.setColorRampItemList(items)
    function.setMaximumValue(high)
    layer.renderer().setClassificationMax(high)


def _ramp(layer: QgsRasterLayer):
    """Return the color ramp of a raster drawn by one, None of any other."""
    shader = getattr(layer.renderer(), "shader", lambda: None)()
    return shader.rasterShaderFunction() if shader is not None else None
