"""Files that algorithms write, such as CityJSON and GLB."""

from __future__ import annotations

from pathlib import Path

from qgis.core import (
    QgsCsException,
    QgsProcessingParameterFileDestination,
)

from ..algorithms.cloud.outputs import replacing
from ..algorithms.stage import FileContent, MapFrame, Monitor, TextFile
from .given import Given
from .inputs import with_help
from .layer_outputs import BETWEEN_CHECKS
from .places import Place
from .qgis_crs import to_degrees


def file_parameter(file: TextFile) -> QgsProcessingParameterFileDestination:
    """Return the parameter of a text file; its dialog has a filter for each format."""
    filters = ";;".join(f"{called} (*{' *'.join(endings)})" for called, endings in file.formats.items())
    definition = QgsProcessingParameterFileDestination(file.name.upper(), file.title, filters, optional=True)
    formats = " / ".join(file.formats)
    return with_help(definition, f"A file: {formats}, as its name ends.")


def write_text(given: Given, file: TextFile, content: FileContent, place: Place, monitor: Monitor) -> dict:
    """Write a text file, if it is wanted; return its output."""
    name = file.name.upper()
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
