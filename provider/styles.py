"""How results look when QGIS loads them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from itertools import count
from pathlib import Path
from typing import Callable, Optional, Union

from qgis.core import (
    QgsEditorWidgetSetup,
    QgsLayerTreeLayer,
    QgsLayerTreeNode,
    QgsMapLayer,
    QgsPointCloudLayer,
    QgsProcessingContext,
    QgsProcessingLayerPostProcessorInterface,
    QgsRasterLayer,
    QgsVectorLayer,
)
from qgis.PyQt import sip

try:
    from qgis._3d import QgsPointCloudLayer3DRenderer
except ImportError:  # QGIS built without 3D views
    QgsPointCloudLayer3DRenderer = None

from ..algorithms.cloud.cloud import Cloud
from ..algorithms.cloud.copc_sidecar import copc_path
from ..algorithms.cloud.outputs import LAS, LAZ, kind_of
from ..algorithms.stage import Field, Layer, Raster, Stage
from .named_styles import add_named_styles, fit_ramp
from .paths import STYLES
from .qgis_crs import crs_of

# Kinds of results from the bottom of the map to the top: QGIS would stack them by the names of their files.
_DRAWN = ("Raster", "Cloud", "Polygon", "LineString", "Point")

# Kinds of layers that others are drawn over, from the bottom.
_BELOW = (QgsRasterLayer, QgsPointCloudLayer)

# Decimals of numbers in tables: millimeters.
_DECIMALS = 3

# Property of a layer with the algorithm that made it and the parameters, as JSON.
RUN = "lidar_buildings/run"

# What the desktop calls with the style, the layer and the context of each result that is loaded.
WHEN_LOADED: list[Callable[[Optional[str], QgsMapLayer, QgsProcessingContext], None]] = []

# Attributes that a map tip shows, in this order, the most of them, and their decimals where these are not one.
_IN_TIPS = ("status", "kind", "roof_type", "height", "area", "length", "width", "radius", "confidence")
_MOST_IN_TIPS = 4
_DECIMALS_IN_TIPS = {"area": 0, "confidence": 2, "radius": 2}

# Texts that it shows below.
_TEXTS_IN_TIPS = ("reason", "evidence")


class Styler(QgsProcessingLayerPostProcessorInterface):
    """Gives a loaded result the style of one file, and its table the units of the fields and few decimals.

    With ``is_off`` the layer is loaded but not visible: it is the result of a step that another step has used.
    ``crs`` (code or WKT) is for clouds in which QGIS finds none: it reads WKT alone. ``run`` is kept as the property
    ``RUN`` of the layer.
    """

    def __init__(
        self, stem: Optional[str], fields: Sequence[Field] = (), is_off: bool = False, crs: str = "", run: str = ""
    ) -> None:
        super().__init__()
        self.stem, self.fields, self.is_off, self.crs, self.run = stem, fields, is_off, crs, run

    @staticmethod
    def file(stem: str) -> Path:
        """Return the file of a style."""
        return STYLES / f"{stem}.qml"

    def copy(self) -> Styler:
        """Return another one that does the same."""
        return Styler(self.stem, self.fields, self.is_off, self.crs, self.run)

    def postProcessLayer(self, layer, context, feedback) -> None:  # noqa: N802 - QGIS asks for this name
        """Load the style, if there is one, and say so in the log when it can't be."""
        # The system that QGIS takes for a virtual point cloud is the catalog entry's, not the points'.
        if self.crs and (not layer.crs().isValid() or layer.providerType() == "vpc"):
            layer.setCrs(crs_of(self.crs))
        message = self.apply(layer)
        if message:
            feedback.pushWarning(f"The style {self.stem} can't be loaded: {message}")
        if self.run:
            layer.setCustomProperty(RUN, self.run)
        layer.triggerRepaint()
        stack_results(context)
        if len(context.layersToLoadOnCompletion()) == 1:
            put_below(layer, context)
        for told in WHEN_LOADED:
            told(self.stem, layer, context)
        node = context.project().layerTreeRoot().findLayer(layer.id()) if self.is_off else None
        if node is not None:
            node.setItemVisibilityChecked(False)

    def apply(self, layer: QgsMapLayer) -> str:
        """Give a layer the style, its tables and tips, and the named styles; return why the style can't be loaded."""
        why = ""
        if self.stem is not None:
            message, loaded = layer.loadNamedStyle(str(STYLES / f"{self.stem}.qml"))
            why = "" if loaded else message
        if isinstance(layer, QgsRasterLayer):
            fit_ramp(layer)
        if self.fields:
            # A feature is called by its number; QGIS would take the first long text.
            layer.setDisplayExpression(f'"{self.fields[0].name}"')
            layer.setMapTipTemplate(_map_tip(self.fields))
        for declared in self.fields:
            index = layer.fields().indexOf(declared.name)
            if declared.unit:
                layer.setFieldAlias(index, f"{declared.name} ({declared.unit})")
            if declared.type is float:
                rounded = QgsEditorWidgetSetup("Range", {"Precision": _DECIMALS, "AllowNull": True})
                layer.setEditorWidgetSetup(index, rounded)
        add_named_styles(layer)
        if isinstance(layer, QgsPointCloudLayer):
            show_in_3d(layer)
        return why


def _map_tip(fields: Sequence[Field]) -> str:
    """Return the map tip of a feature: its number, its main attributes, the reason and the evidence."""
    names = {field.name: field for field in fields}
    main = [names[name] for name in _IN_TIPS if name in names] or [one for one in fields[1:] if one.type is float]
    facts = [f'to_string("{fields[0].name}")', *(_shown_in_tip(field) for field in main[:_MOST_IN_TIPS])]
    tip = f"<b>[% array_to_string(array_filter(array({', '.join(facts)}), @element is not null), ' · ') %]</b>"
    texts = [name for name in _TEXTS_IN_TIPS if name in names]
    return tip + "".join(f"<br>[% coalesce(\"{name}\", '') %]" for name in texts)


def _shown_in_tip(field: Field) -> str:
    """Return the expression of a field's value with its unit, or its name where it has none; NULL where it is."""
    decimals = _DECIMALS_IN_TIPS.get(field.name, 1)
    value = f'"{field.name}"' if field.type is str else f'format_number("{field.name}", {decimals})'
    return f"{value} || ' {field.unit}'" if field.unit else f"'{field.name.replace('_', ' ')} ' || {value}"


# QGIS deletes post processors with the run's context, but keeps no reference until then: one that Python forgets
# is never called.
_KEPT: list[Styler] = []


def store_styles(source: str, stem: Optional[str], fields: Sequence[Field]) -> None:
    """Store the styles of a layer in the GeoPackage that holds it: QGIS shows it so wherever it is opened.

    Parameters
    ----------
    source : str
        The layer, as QGIS opens it.
    stem : str, optional
        Its style, which becomes the one that QGIS takes.
    fields : sequence of Field
        Its fields, for names, units and tips.

    Raises
    ------
    ValueError
        If the file can't be written.
    """
    layer = QgsVectorLayer(source, "stored", "ogr")
    if not layer.isValid():
        return
    Styler(stem, fields).apply(layer)
    manager = layer.styleManager()
    first = manager.currentStyle()
    for name in manager.styles():
        manager.setCurrentStyle(name)
        style = "Default" if name == first else name, "", name == first, ""
        # QGIS 3.44 deprecates the first of these; 3.40 has no other.
        newer = getattr(layer, "saveStyleToDatabaseV2", None)
        error = newer(*style)[1] if newer else layer.saveStyleToDatabase(*style)
        if error:
            raise ValueError(f"The styles can't be stored in {Path(source.split('|', maxsplit=1)[0]).name}: {error}")


def show_in_3d(layer: QgsPointCloudLayer) -> None:
    """Draw a cloud in 3D views as on the map, at its heights; layers have this in their styles."""
    if QgsPointCloudLayer3DRenderer is None:
        return
    renderer = QgsPointCloudLayer3DRenderer()
    renderer.convertFrom2DRenderer(layer.renderer())
    layer.setRenderer3D(renderer)


def cloud_style(stage: Stage, cloud: Cloud) -> Optional[str]:
    """Return the style of a stage's cloud: of the first dimension it wrote that has one."""
    return style_of(name for name in (*stage.writes, *stage.creates) if cloud.has(name))


def style_of(names: Iterable[str]) -> Optional[str]:
    """Return the first of some dimensions that has a style."""
    return next((name for name in names if (STYLES / f"{name}.qml").is_file()), None)


def layer_style(layer: Union[Layer, Raster]) -> Optional[str]:
    """Return the style of a layer or raster: the declared one, or its name's."""
    stem = layer.style or layer.name
    return stem if (STYLES / f"{stem}.qml").is_file() else None


def show_on_load(context: QgsProcessingContext, target: str, kind: str, styler: Styler) -> None:
    """Have the result ``target`` styled and ordered among the others if and when it is loaded.

    ``kind`` is one of those in the order of drawing: "Raster", "Cloud", or the geometry of a layer.
    """
    if not context.willLoadLayerOnCompletion(target):
        return
    details = context.layerToLoadOnCompletionDetails(target)
    details.layerSortKey = _DRAWN.index(kind)
    if styler.stem is not None or styler.fields or styler.crs:
        details.setPostProcessor(_kept(styler))


def switch_off(context: QgsProcessingContext, targets: Iterable[str]) -> None:
    """Have results switched off when they are loaded; of a cloud the COPC file that is loaded in its place, too."""
    for target in (path for one in targets for path in (one, *_views_of(one))):
        if context.willLoadLayerOnCompletion(target):
            details = context.layerToLoadOnCompletionDetails(target)
            styler = details.postProcessor()
            if isinstance(styler, Styler):
                styler.is_off = True
            else:
                details.setPostProcessor(_kept(Styler(None, is_off=True)))


def _views_of(target: str) -> list[str]:
    """Return the COPC file that QGIS may load in place of a LAS or LAZ file."""
    return [str(copc_path(Path(target)))] if kind_of(Path(target)) in (LAS, LAZ) else []


def _kept(styler: Styler) -> Styler:
    """Keep a styler until QGIS has deleted it, and return it."""
    _KEPT[:] = [styler for styler in _KEPT if not sip.isdeleted(styler)]
    _KEPT.append(styler)
    return styler


def load_from(context: QgsProcessingContext, final: Callable[[str], str]) -> None:
    """Have QGIS load results from where they are now: ``final`` turns the path of a result into its present one."""
    layers = context.layersToLoadOnCompletion()
    # QGIS deletes the post processor of a result that it is no longer to load: the one in its place gets a copy.
    stylers = {path: details.postProcessor().copy() for path, details in layers.items() if details.postProcessor()}
    context.setLayersToLoadOnCompletion({final(path): _without_styler(details) for path, details in layers.items()})
    for path, styler in stylers.items():
        context.layerToLoadOnCompletionDetails(final(path)).setPostProcessor(_kept(styler))


def stack_results(context: QgsProcessingContext) -> None:
    """Put the layers of a run into the order of drawing: QGIS reverses it where a layer of the project is selected."""
    keys = {path: details.layerSortKey for path, details in context.layersToLoadOnCompletion().items()}
    root = context.project().layerTreeRoot()
    # None for layers that are no results of this run.
    layers = {node: node.layer() for node in root.findLayers() if node.layer() is not None}
    found = {node: keys.get(layer.id(), keys.get(layer.source())) for node, layer in layers.items()}
    nodes = [node for node, key in found.items() if key is not None]
    wanted = sorted(nodes, key=lambda node: found[node] or 0, reverse=True)
    if wanted == nodes or len({node.parent() for node in nodes}) > 1:
        return
    parent = nodes[0].parent()
    parent.insertChildNodes(parent.children().index(nodes[0]), [node.clone() for node in wanted])
    for node in nodes:
        parent.removeChildNode(node)


def put_below(layer: QgsMapLayer, context: QgsProcessingContext) -> None:
    """Put a raster that comes alone below all polygons and clouds of earlier runs, a cloud below all polygons."""
    root = context.project().layerTreeRoot()
    node, children = root.findLayer(layer.id()), root.children()
    if node not in children or not isinstance(layer, _BELOW):
        return
    above = [i for i, child in enumerate(children) if _height_of(child) > _height_of(node)]
    if above and above[-1] > children.index(node):
        root.insertChildNode(above[-1] + 1, node.clone())
        root.removeChildNode(node)


def _height_of(node: QgsLayerTreeNode) -> int:
    """Return the rank of a layer in the tree, from the bottom; groups hold the polygons of a run."""
    layer = node.layer() if isinstance(node, QgsLayerTreeLayer) else None
    return next((i for i, kind in enumerate(_BELOW) if isinstance(layer, kind)), len(_BELOW))


def name_after(context: QgsProcessingContext, titles: Collection[str], subject: str, run: str = "") -> None:
    """Put the layers of a run in a group that is named after its input, "Delft: Detect buildings".

    A single one, where there is no other group, is named after the input itself, "Footprints (Delft)", unless the user
    has named it. A group has a number where there is one of that name.
    """
    layers = context.layersToLoadOnCompletion()
    group, is_group = _new_group(context, ": ".join(part for part in (subject, run) if part))
    for path, details in layers.items():
        loaded = context.layerToLoadOnCompletionDetails(path)
        _SUBJECTS[path] = subject
        # Next to groups QGIS would put a single layer into the current one.
        if group and (len(layers) > 1 or is_group) and not details.groupName:
            loaded.groupName = group
        elif subject and details.name in titles:
            loaded.name = f"{details.name} ({subject})"


# Subject of each loaded file by its path: results of runs on it get that name, as temporary files have no plain ones.
_SUBJECTS: dict[str, str] = {}


def subject_of_file(path: Path) -> str:
    """Return the subject of a file: of the run that made it, else its own name."""
    return _SUBJECTS.get(str(path)) or path.name.split(".")[0]


def _new_group(context: QgsProcessingContext, name: str) -> tuple[str, bool]:
    """Return a name that no group of the project has, and whether the project has groups."""
    project = context.project()
    taken = {group.name() for group in project.layerTreeRoot().findGroups()} if project is not None else set()
    numbered = (f"{name} {number}" if number > 1 else name for number in count(1))
    return next(one for one in numbered if one not in taken), bool(taken)


def _without_styler(details: QgsProcessingContext.LayerDetails) -> QgsProcessingContext.LayerDetails:
    copy = QgsProcessingContext.LayerDetails(details.name, details.project, details.outputName, details.layerTypeHint)
    copy.forceName, copy.groupName, copy.layerSortKey = details.forceName, details.groupName, details.layerSortKey
    return copy
