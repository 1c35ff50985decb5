"""Vector layers as input: declared, checked, and read as the features that stages are given."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Callable, Optional

import numpy as np
from qgis.core import (
    Qgis,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCsException,
    QgsFeatureRequest,
    QgsGeometry,
    QgsProcessingContext,
    QgsProcessingFeatureSource,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterFile,
    QgsProviderRegistry,
    QgsRectangle,
    QgsVariantUtils,
    QgsVectorLayer,
    QgsWkbTypes,
)
from qgis.PyQt.QtCore import QDate, QDateTime, Qt, QTime

from ..algorithms.cloud.files import read_extent
from ..algorithms.criteria import EQUATORIAL_RADIUS
from ..algorithms.stage import InputLayer, Layer, LayerFeatures, Monitor, as_column
from .given import Given
from .places import Place, refuse_degrees
from .qgis_crs import crs_of, crs_of_layer
from .vectors import BETWEEN_CHECKS, SOURCE_TYPES, WKB, fields_of, qgis_features

# How many different vertices a ring, a line and a point have at least.
_FEWEST = {"Polygon": 3, "LineString": 2, "Point": 1}


def input_layer_name(input_layer: InputLayer) -> str:
    """Return the parameter's name, ``OLD_MAP`` of ``old_map``."""
    return input_layer.name.upper()


def input_layer_parameter(input_layer: InputLayer) -> QgsProcessingParameterDefinition:
    """Return the Processing parameter of a source, or of the file that takes its place."""
    name, title, optional = input_layer_name(input_layer), input_layer.title, input_layer.optional
    if input_layer.read is None:
        kinds = [SOURCE_TYPES[input_layer.geometry]]
        definition = QgsProcessingParameterFeatureSource(name, title, kinds, optional=optional)
    else:
        endings = f"{title} (*{' *'.join(input_layer.endings)})"
        definition = QgsProcessingParameterFile(name, title, optional=optional, fileFilter=endings)
    definition.setHelp(input_layer.help)
    if input_layer.advanced:
        definition.setFlags(definition.flags() | Qgis.ProcessingParameterFlag.Advanced)
    return definition


def find_input_layer(given: Given, input_layer: InputLayer) -> Optional[QgsProcessingFeatureSource]:
    """Return the layer that a parameter gives; None if an optional one is not given.

    Raises
    ------
    ValueError
        If it is missing, or no vector layer, or of another kind of geometry.
    """
    name = input_layer_name(input_layer)
    value = given.parameters.get(name)
    if QgsVariantUtils.isNull(value) or value == "":
        if input_layer.optional:
            return None
        raise ValueError(f"{input_layer.title} ({name}) is missing; choose a layer of {input_layer.objects}.")
    if input_layer.read is not None:
        return _read_file(given, input_layer, Path(given.read("File", name)))
    found = given.read("Source", name)
    if found is None:
        raise ValueError(f"{input_layer.title} ({name}) must be a vector layer; nothing was found at {value}.")
    kind = QgsWkbTypes.geometryType(found.wkbType())
    # Files of some formats, such as GeoJSON, say of their geometries only what the features have.
    is_empty = kind == Qgis.GeometryType.Null and found.featureCount() == 0
    if not is_empty and kind not in (QgsWkbTypes.geometryType(WKB[input_layer.geometry]), Qgis.GeometryType.Unknown):
        raise ValueError(
            f"{input_layer.title} ({name}) must be a layer of {input_layer.objects}, got {found.sourceName()!r} with "
            f"{QgsWkbTypes.geometryDisplayString(kind).lower()} geometries; choose another."
        )
    return found


def _read_file(given: Given, input_layer: InputLayer, path: Path) -> QgsProcessingFeatureSource:
    """Return a layer in memory with the features of a file."""
    name = input_layer_name(input_layer)
    if not path.is_file():
        raise ValueError(f"{input_layer.title} ({name}): there is no file {path}; choose another.")
    try:
        features, code = input_layer.read(path.read_text(encoding="utf-8", errors="replace"))
    except ValueError as error:
        raise ValueError(f"{path.name}: {error}") from error
    declared = Layer(input_layer.name, input_layer.title, input_layer.geometry, ())
    layer = QgsVectorLayer(f"{input_layer.geometry}Z", path.stem, "memory")
    layer.setCrs(crs_of(code))
    layer.dataProvider().addAttributes(fields_of(declared, features))
    layer.updateFields()
    layer.dataProvider().addFeatures(list(qgis_features(declared, features, np.asarray)))
    layer.updateExtents()
    source = replace(given, parameters={name: layer}).read("Source", name)
    source.layer = layer  # which lasts as long as its source
    return source


def find_input_layers(given: Given, wanted: Iterable[InputLayer]) -> list[GivenLayer]:
    """Return the layers that are given, see :func:`find_input_layer`."""
    found = ((input_layer, find_input_layer(given, input_layer)) for input_layer in wanted)
    return [GivenLayer(one, layer, given.context) for one, layer in found if layer is not None]


def layer_files(given: Given, found: Iterable[GivenLayer]) -> list[Path]:
    """Return the files of the layers that were found, if they have one."""
    files = []
    for one in found:
        name = input_layer_name(one.wanted)
        if one.wanted.read is not None:
            files.append(Path(given.read("File", name)))
        elif (layer := given.read("VectorLayer", name)) is not None:
            uri = QgsProviderRegistry.instance().decodeUri(layer.providerType(), layer.source())
            files.append(Path(uri.get("path") or ""))
    return [path for path in files if path.is_file()]


def refuse_elsewhere(layers: list[GivenLayer], clouds: Sequence[Path], box: Optional[np.ndarray]) -> None:
    """Refuse layers that lie wholly outside of the clouds, before any work; of tiles on the web those in a box count.

    Raises
    ------
    ValueError
        If a layer doesn't touch the bounding box of a single cloud.
    """
    boxes = [_plan_box(cloud, box) for cloud in clouds] if layers else []
    for one in layers:
        extent = one.source.sourceExtent()
        cloud_boxes = [one.brought_to(box, crs) for box, crs in boxes]
        if extent.isNull() or any(box is None or extent.intersects(box) for box in cloud_boxes):
            continue
        around = QgsRectangle()
        for cloud_box in cloud_boxes:
            around.combineExtentWith(cloud_box)
        raise ValueError(
            f"{one.wanted.title} and the point cloud{'s' * (len(clouds) > 1)} don't overlap: {_range(extent)} against "
            f"{_range(around)}; choose a layer of the same area, or check the coordinate reference systems of both."
        )


def _plan_box(cloud: Path, box: Optional[np.ndarray]) -> tuple[QgsRectangle, QgsCoordinateReferenceSystem]:
    """Return the bounding box of a cloud, empty where it has no area, and its CRS."""
    low, high, crs = read_extent(cloud, box=box)
    return QgsRectangle(low[0], low[1], high[0], high[1]), crs_of(crs.plane)


def _range(box: QgsRectangle) -> str:
    """Return the coordinates of a box as text for users."""
    return f"x {box.xMinimum():.7g} to {box.xMaximum():.7g}, y {box.yMinimum():.7g} to {box.yMaximum():.7g}"


def read_input_layers(found: Iterable[GivenLayer], place: Place, monitor: Monitor) -> dict[str, LayerFeatures]:
    """Return layers by their names, see :meth:`GivenLayer.read`."""
    return {one.wanted.name: one.read(place, monitor) for one in found}


@dataclass(frozen=True)
class GivenLayer:
    """A layer that is given for an input, and the context in which it is transformed."""

    wanted: InputLayer
    source: QgsProcessingFeatureSource
    context: QgsProcessingContext

    def brought_to(self, box: QgsRectangle, crs: QgsCoordinateReferenceSystem) -> Optional[QgsRectangle]:
        """Return the box of a cloud in the layer's CRS; None if the cloud has no area or can't be brought there."""
        if box.isEmpty():
            return None
        try:
            # The box of the cloud is transformed: a layer's may exceed the area that the cloud's system is made for.
            return self._transform(crs, Monitor()).transformBoundingBox(box, Qgis.TransformDirection.Reverse)
        except QgsCsException:
            return None

    def read(self, place: Place, monitor: Monitor) -> LayerFeatures:
        """Return a layer as a stage is given it: parts of geometries in local meters, with all attributes.

        Arcs become lines. Features without a sound geometry of the declared kind are left out, which a
        warning counts. Heights are taken in the vertical unit of the cloud; geometries that lack some are flat.

        Raises
        ------
        ValueError
            If there are features and all are left out.
        """
        wanted, layer, transform = self.wanted, self.source, self._transform(place.crs, monitor)
        geometries: list = []
        sources: list = []
        rows: list = []
        count = left_out = 0
        request = QgsFeatureRequest()
        for feature in layer.getFeatures(request, Qgis.ProcessingFeatureSourceFlag.SkipGeometryValidityChecks):
            if count % BETWEEN_CHECKS == 0:
                monitor.progress(min(1.0, count / max(1, layer.featureCount())))
            parts = _parts(feature.geometry(), wanted, transform, place)
            geometries += parts
            sources += _as_read(feature.geometry(), transform, len(parts))
            rows += [feature.attributes()] * len(parts)
            count += 1
            left_out += not parts
        if left_out and not rows:
            raise ValueError(
                f"{wanted.title} has no usable feature: none of {count} has a valid geometry of "
                f"{wanted.objects}; run 'Fix geometries' on the layer, or choose another."
            )
        if left_out:
            what = f"{left_out} of {count} features are left out"
            monitor.warn(f"{wanted.title}: {what}; they have no valid geometry of {wanted.objects}.")
        names = layer.fields().names()
        columns = {name: as_column([_plain(row[i]) for row in rows]) for i, name in enumerate(names)}
        return LayerFeatures(geometries, columns, sources)

    def _transform(self, crs: QgsCoordinateReferenceSystem, monitor: Monitor) -> QgsCoordinateTransform:
        """Return the transform of the layer to the CRS of the cloud; none is needed where one of the two has none."""
        own, title = crs_of_layer(self.source), self.wanted.title
        if own.isValid() and crs.isValid():
            return QgsCoordinateTransform(own, crs, self.context.transformContext())
        if own.isValid():
            refuse_degrees(title, own)
            name = own.userFriendlyIdentifier()
            monitor.warn(f"{title} is in {name}; everything without a CRS is taken to be in it.")
        elif crs.isValid():
            monitor.warn(f"{title} names no CRS; it is taken to be in {crs.userFriendlyIdentifier()}.")
        return QgsCoordinateTransform()


def _parts(geometry: QgsGeometry, input_layer: InputLayer, transform: QgsCoordinateTransform, place: Place) -> list:
    """Return the parts of a geometry as in :class:`LayerFeatures`; none where it is not valid or of another kind."""
    kind = input_layer.geometry
    if geometry.isNull() or geometry.isEmpty() or geometry.type() != QgsWkbTypes.geometryType(WKB[kind]):
        return []
    straight = QgsGeometry(geometry.constGet().segmentize())
    if not (input_layer.upright or straight.isGeosValid()):
        return []
    try:
        straight.transform(transform)
    except QgsCsException:
        return []
    straight.get().dropMValue()
    if kind == "Polygon" and not input_layer.upright:
        straight = straight.forcePolygonCounterClockwise()
    parts = [_vertices(bytes(part.asWkb()), place) for part in straight.asGeometryCollection()]
    if not all(len(rings) and all(_is_sound(ring, kind) for ring in rings) for rings in parts):
        return []
    return [_SHAPES[kind](rings) for rings in parts]


def _as_read(geometry: QgsGeometry, transform: QgsCoordinateTransform, count: int) -> list:
    """Return the parts of a geometry as they are, None for each of ``count`` of one that is transformed or has arcs."""
    parts = geometry.asGeometryCollection()
    is_same = transform.isShortCircuited() and len(parts) == count and not QgsWkbTypes.isCurvedType(geometry.wkbType())
    return parts if is_same else [None] * count


def _is_sound(vertices: np.ndarray, kind: str) -> bool:
    """Whether vertices (m, 2 or 3) are on the Earth, and enough of them differ for a geometry of a kind.

    For GEOS a ring without vertices is valid. No vertex is farther off than twice around the Earth.
    """
    left = vertices
    for _ in range(_FEWEST[kind] - 1):
        left = left[(left != left[:1]).any(axis=1)]
    return len(left) > 0 and bool((np.abs(vertices) < 4 * np.pi * EQUATORIAL_RADIUS).all())


def _vertices(wkb: bytes, place: Place) -> list:
    """Return the vertices of WKB in local meters, one array (m, 2 or 3) per ring; none of other shapes.

    Five times as fast as QGIS's own lists of points.
    """
    code = Qgis.WkbType(int.from_bytes(wkb[1:5], "little"))
    kind, width = QgsWkbTypes.flatType(code), 3 if QgsWkbTypes.hasZ(code) else 2
    if kind == WKB["Point"]:
        rings = [np.frombuffer(wkb, "<f8", width, 5)[None]]
    elif kind == WKB["LineString"]:
        rings = list(_rings(wkb, 5, width))
    else:
        rings = list(_rings(wkb, 9, width)) if kind == WKB["Polygon"] else []
    return [place.from_map(ring if np.isfinite(ring).all() else ring[:, :2]) for ring in rings]


def _rings(wkb: bytes, at: int, width: int) -> Iterator[np.ndarray]:
    """Yield the rings of WKB from a byte on, each a count and that many vertices of ``width`` coordinates."""
    while at < len(wkb):
        n = int.from_bytes(wkb[at : at + 4], "little")
        yield np.frombuffer(wkb, "<f8", n * width, at + 4).reshape(n, width)
        at += 4 + 8 * n * width


# A part of a layer of each kind, as stages are given it, from its rings.
_SHAPES: dict[str, Callable[[list], Any]] = {
    "Polygon": lambda rings: rings,
    "LineString": lambda rings: rings[0],
    "Point": lambda rings: rings[0][0],
}


def _plain(value: Any) -> Any:
    """Return dates and times as text (ISO 8601), None for NULL, and everything else as it is."""
    if QgsVariantUtils.isNull(value):
        return None
    return value.toString(Qt.DateFormat.ISODate) if isinstance(value, (QDate, QDateTime, QTime)) else value
