"""Files that algorithms write, such as CityJSON and GLB."""

from __future__ import annotations

from pathlib import Path

from qgis.core import QgsProcessingAlgorithm, QgsProcessingContext, QgsProcessingParameterFileDestination

from ..algorithms.cloud.outputs import replacing
from ..algorithms.stage import FileContent, MapFrame, Monitor, TextFile
from .inputs import with_help
from .layer_outputs import BETWEEN_CHECKS, UNWANTED
from .places import Place


def file_parameter(file: TextFile) -> QgsProcessingParameterFileDestination:
    """Return the parameter of a text file; its dialog has a filter for each format."""
    filters = ";;".join(f"{called} (*{' *'.join(endings)})" for called, endings in file.formats.items())
    definition = QgsProcessingParameterFileDestination(file.name.upper(), file.title, filters, optional=True)
    formats = " / ".join(file.formats)
    return with_help(definition, f"A file: {formats}, as its name ends.")


def write_text(
    algorithm: QgsProcessingAlgorithm,
    file: TextFile,
    content: FileContent,
    place: Place,
    parameters: dict,
    context: QgsProcessingContext,
    monitor: Monitor,
) -> dict:
    """Write a text file, if it is wanted; return its output."""
    name = file.name.upper()
    wanted = parameters.get(name) not in UNWANTED
    target = algorithm.parameterAsFileOutput(parameters, name, context) if wanted else ""
    if not target:
        return {}
    frame = MapFrame(place.to_map, place.code)
    with replacing(Path(target)) as stream:
        for number, piece in enumerate(content.pieces(file.format_of(target), frame)):
            if number % BETWEEN_CHECKS == 0:
                monitor.progress(0.0)
            stream.write(piece.encode() if isinstance(piece, str) else piece)
    return {name: target}
