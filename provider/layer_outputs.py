"""Layers that algorithms make, written to the outputs that the user chose."""

from __future__ import annotations

from qgis.core import QgsFeatureSink, QgsProcessingAlgorithm, QgsProcessingContext, QgsProcessingException

from ..algorithms.stage import Layer, LayerFeatures, Monitor
from .outputs import through_memory
from .places import Place
from .styles import layer_style, show_on_load, switch_off
from .vectors import fields_of, qgis_features, wkb_type

# Values of an optional output that is not wanted: None where it is left out, "" where the command line gives none.
UNWANTED = (None, "")

# Features, or pieces of a text, that are written between two looks at whether to stop.
BETWEEN_CHECKS = 1000


def write_layer(
    algorithm: QgsProcessingAlgorithm,
    name: str,
    layer: Layer,
    features: LayerFeatures,
    place: Place,
    parameters: dict,
    context: QgsProcessingContext,
    monitor: Monitor,
) -> dict:
    """Write a layer, if it is wanted, to the output ``name``; return it by that name.

    Features are in meters from the origin of the frame ``place``.

    Raises
    ------
    ValueError, QgsProcessingException
        If it can't be written.
    """
    if parameters.get(name) in UNWANTED:
        return {}
    monitor.resolved(**{layer.name: len(features)})
    with through_memory(parameters, name, context) as (redirected, final):
        target = _fill_sink(algorithm, name, layer, features, place, redirected, context, monitor)
    target = final(target)
    show_on_load(context, target, layer.geometry, layer_style(layer), layer.fields)
    if not len(features):
        switch_off(context, [target])
    return {name: target}


def _fill_sink(
    algorithm: QgsProcessingAlgorithm,
    name: str,
    layer: Layer,
    features: LayerFeatures,
    place: Place,
    parameters: dict,
    context: QgsProcessingContext,
    monitor: Monitor,
) -> str:
    """Write the features of a layer where the parameter ``name`` says; return where that is."""
    sink, target = algorithm.parameterAsSink(
        parameters, name, context, fields_of(layer, features), wkb_type(layer, features), place.crs
    )
    if sink is None:
        raise QgsProcessingException(algorithm.invalidSinkError(parameters, name))
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
