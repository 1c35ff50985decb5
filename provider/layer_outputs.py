"""Layers and text files that algorithms make, written to the outputs that the user chose."""

from dataclasses import replace
from pathlib import Path

from qgis.core import QgsCoordinateReferenceSystem, QgsCsException, QgsFeatureSink, QgsProcessingException

from ..algorithms.cloud.outputs import replacing
from ..algorithms.stage import FileContent, Layer, LayerFeatures, MapFrame, Monitor, TextFile
from .given import Given
from .places import Place
from .qgis_crs import crs_of, to_degrees
from .run_outputs import target_path, through_memory
from .styles import Styler, layer_style, show_on_load, store_styles, switch_off
from .vectors import BETWEEN_CHECKS, fields_of, qgis_features, wkb_type

# Formats that name systems by a code only.
_BY_CODE = (".geojson", ".json")
# What GeoPackage calls a plane of which nothing is known (srs_id -1).
_UNDEFINED = 'LOCAL_CS["Undefined Cartesian SRS",UNIT["metre",1],AXIS["Easting",EAST],AXIS["Northing",NORTH]]'

# The format whose files hold the styles of their layers.
GPKG = ".gpkg"


def write_layer(given: Given, name: str, layer: Layer, features: LayerFeatures, place: Place, monitor: Monitor) -> dict:
    """Write a layer, if it is wanted, to the output ``name``; return it by that name.

    Features are in meters from the origin of the frame ``place``.

    Raises
    ------
    ValueError, QgsProcessingException
        If it can't be written.
    """
    if not given.has(name):
        return {}
    monitor.resolved(**{layer.name: len(features)})
    path = target_path(given.parameters[name])
    place = replace(place, crs=_crs_in_file(path.name.lower() if path else "", place.crs, monitor))
    with through_memory(given.parameters, name, given.context) as (redirected, final):
        target = _fill_sink(replace(given, parameters=redirected), name, layer, features, place, monitor)
        if Path(target.split("|")[0]).suffix.lower() == GPKG:
            store_styles(target, layer_style(layer), layer.fields)
    target = final(target)
    if given.context.willLoadLayerOnCompletion(target):
        # For the text QGIS tries to open each input as a layer of any kind, and its libraries print what they can't.
        styler = Styler(layer_style(layer), layer.fields, run=given.as_text())
        show_on_load(given.context, target, layer.geometry, styler)
    if not len(features):
        switch_off(given.context, [target])
        if layer.on_demand:
            monitor.warn(f"{layer.title} has no features; {layer.on_demand}.")
    return {name: target}


def _crs_in_file(file: str, crs: QgsCoordinateReferenceSystem, monitor: Monitor) -> QgsCoordinateReferenceSystem:
    """Return the CRS by which a file names it; warn where its format can't."""
    if file.endswith(".gpkg") and not crs.isValid():
        # QGIS would say "geographic", that is degrees.
        return crs_of(_UNDEFINED)
    if file.endswith(_BY_CODE) and crs.isValid() and not crs.authid().startswith("EPSG:"):
        monitor.warn(
            f"{file} names no coordinate reference system: GeoJSON knows codes only, and this one has none; choose a "
            "GeoPackage."
        )
    return crs


def _fill_sink(given: Given, name: str, layer: Layer, features: LayerFeatures, place: Place, monitor: Monitor) -> str:
    """Write the features of a layer where the parameter ``name`` says; return where that is."""
    sink, target = given.read("Sink", name, fields_of(layer, features), wkb_type(layer, features), place.crs)
    if sink is None:
        raise QgsProcessingException(given.algorithm.invalidSinkError(given.parameters, name))
    try:
        for row, feature in enumerate(qgis_features(layer, features, place.to_map)):
            if row % BETWEEN_CHECKS == 0:
                monitor.progress(1.0)
            if not sink.addFeature(feature, QgsFeatureSink.Flag.FastInsert):
                raise QgsProcessingException(_unwritten(layer, target, sink))
        if not sink.flushBuffer():
            raise QgsProcessingException(_unwritten(layer, target, sink))
    finally:
        # The file is closed with the sink, and complete.
        del sink
    return target


def _unwritten(layer: Layer, target: str, sink: QgsFeatureSink) -> str:
    """Return why a layer can't be written, with the reason that its format gives, if any."""
    why = f" ({sink.lastError()})" if sink.lastError() else ""
    return f"{layer.title} can't be written to {target}{why}; free some space or choose another folder."


def write_text(given: Given, name: str, file: TextFile, content: FileContent, place: Place, monitor: Monitor) -> dict:
    """Write a text file, such as CityJSON and GLB, if it is wanted, to the output ``name``; return it by that name."""
    target = given.read("FileOutput", name) if given.has(name) else ""
    if not target:
        return {}
    path = Path(target)
    frame = MapFrame(place.to_map, place.code, to_degrees(place.crs, given.context), path.name.split(".")[0])
    try:
        with replacing(path) as stream:
            for number, piece in enumerate(content.pieces(file.format_of(target), frame)):
                if number % BETWEEN_CHECKS == 0 or isinstance(piece, tuple):
                    monitor.progress(0.0)
                if isinstance(piece, tuple):
                    # Into the working folder of the run, from which it is put in place with the file.
                    path.with_name(piece[0]).write_bytes(piece[1])
                else:
                    stream.write(piece.encode() if isinstance(piece, str) else piece)
    except QgsCsException as error:
        raise ValueError(
            f"The models lie outside of {place.crs.userFriendlyIdentifier()}; check the coordinate reference system."
        ) from error
    return {name: target}
