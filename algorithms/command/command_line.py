"""The command ``lidar-buildings``: read, compute in memory, write all results or none."""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any, Optional

import numpy as np

from ..cloud.cloud import Cloud, origin_before
from ..cloud.files import check_compression, read_cloud, write_cloud
from ..cloud.outputs import all_or_nothing, check_output, check_place, os_errors_as_messages
from ..cloud.web_addresses import is_address
from ..cloud.web_file import file_at
from ..criteria import NO_DATA
from ..packages import absent
from ..pipeline import CLOUD, Output, Pipeline
from ..pipelines import PIPELINES
from ..report.page import with_coordinates
from ..run import Results, run_pipeline
from ..stage import InputLayer, Layer, LayerFeatures, MapFrame, Monitor, Raster, RasterSurface, TextFile
from ..stages import STAGES, less_memory
from .command_arguments import SHORT_NAMES, dashed, find_algorithm, parser_of
from .feature_files import check_format, read_layer, write_features

# Exit codes of failures, and of runs that a user stopped (as shells have it: 128 + SIGINT).
_FAILED, _STOPPED = 1, 130


def main(words: Optional[Sequence[str]] = None) -> int:
    """Run the command with the words after its name, the process's by default; return its exit code."""
    words = sys.argv[1:] if words is None else list(words)
    if not words or words[0] in ("-h", "--help"):
        _say(overview())
        return 0
    if words[0] == "--version":
        _say(version("lidar-buildings"))
        return 0
    monitor = _Shown()
    try:
        algorithm = find_algorithm(words[0])
        run(algorithm, parser_of(algorithm).parse_args(words[1:]), monitor)
    except KeyboardInterrupt:
        return monitor.end("Cancelled; nothing was written.", _STOPPED)
    except MemoryError:
        return monitor.end(f"This needs more memory than there is; {less_memory()}.", _FAILED)
    except (ValueError, OSError) as error:
        return monitor.end(str(error), _FAILED)
    return 0


def overview() -> str:
    """Return the list of algorithms with a sentence on each, composites first."""
    short = ", ".join(f"{dashed(name)} as {word}" for word, name in SHORT_NAMES.items())
    lines = ["usage: lidar-buildings ALGORITHM CLOUD [options]; with --help in place of CLOUD its options", ""]
    summaries = {name: one.summary for some in (PIPELINES, STAGES) for name, one in some.items()}
    lines += [f"  {dashed(name):30} {summary}" for name, summary in summaries.items()]
    return "\n".join([*lines, "", f"Shorter: {short}. lidar-buildings --version prints the version."])


def run(algorithm: Pipeline, given: argparse.Namespace, monitor: Monitor) -> None:
    """Read the inputs, run the algorithm, and write its outputs.

    Raises
    ------
    ValueError
        In one sentence, whatever can't be read, computed or written; nothing is written then.
    """
    missing = absent(algorithm.needed_packages)
    if missing:
        raise ValueError(f"{algorithm.title} needs {', '.join(missing)}; run 'pip install {' '.join(missing)}'.")
    values = vars(given)
    targets = [(one, values[one.name]) for one in algorithm.outputs if values[one.name] is not None]
    clouds = _listed(values.get("cloud"))
    files = {one: values[one.name] for one in algorithm.input_layers.values() if values[one.name] is not None}
    _check(algorithm, targets, [*clouds, *_listed(values.get("reference")), *files.values()])
    for _, path in targets:
        check_compression(path, [file_at(one) for one in clouds])
    box = None if values.get("extent") is None else np.array(values["extent"])
    read = [read_cloud(path, monitor, box=box) for path in clouds]
    reference = read_cloud(values["reference"], monitor, box=box) if values.get("reference") else None
    layers, place = _layers(files, read[0] if read else None, monitor)
    tunables = {name: values[name] for name in algorithm.parameters if values[name] is not None}
    wanted = [output.name for output, _ in targets]
    cloud = read if algorithm.merges else read[0] if read else None
    results = run_pipeline(algorithm, cloud, monitor, layers, wanted, reference=reference, **tunables)
    if results.cloud is not None:
        place = _Place.of(results.cloud)
    if place is None:
        raise ValueError(f"{algorithm.title} has neither a point cloud nor a layer; give one.")
    with all_or_nothing() as written:
        for output, path in targets:
            with os_errors_as_messages(path):
                _write(output, results, place, written.beside(path), monitor)
    for report in results.reports.values():
        for name, value in report.values.items():
            _say(f"{name}: {value:.7g}")


@dataclass
class _Place:
    """How local meters become map coordinates and back, and the codes of the CRS in plan and with heights."""

    to_map: Callable[[np.ndarray], np.ndarray]
    from_map: Callable[[np.ndarray], np.ndarray]
    plane: str = ""
    code: str = ""

    @classmethod
    def of(cls, cloud: Cloud) -> _Place:
        """Return the place of a cloud."""
        crs = cloud.crs
        plane = next((text for text in (crs.plane, crs.code, crs.identity) if text.startswith("EPSG:")), "")
        return cls(cloud.to_map, cloud.from_map, plane, crs.code or plane)


def _listed(value: Any) -> list[str]:
    return [] if value is None else [value] if isinstance(value, str) else value


def _check(algorithm: Pipeline, targets: list[tuple[Output, Path]], sources: Sequence[Any]) -> None:
    """Refuse, before any work, outputs that can't be written, and a run without any."""
    if not targets:
        names = ", ".join(f"--{dashed(output.name)}" for output in algorithm.outputs)
        raise ValueError(f"Nothing is asked for; give at least one of {names}.")
    read = [Path(source) for source in sources if not is_address(source)]
    for output, path in targets:
        declared = output.declared
        if isinstance(declared, Layer):
            check_format(path)
        elif isinstance(declared, TextFile):
            declared.format_of(path.name)
        elif declared == CLOUD:
            check_output(path, read)
        else:
            ending = ".asc" if isinstance(declared, Raster) else ".html"
            if path.suffix.lower() != ending:
                raise ValueError(f"{path.name} can't be written as {declared}: give it the extension {ending}.")
        check_place(path, read)
    if len({path.resolve() for _, path in targets}) < len(targets):
        raise ValueError("Two outputs are the same file; give each its own.")


def _layers(
    files: dict[InputLayer, Path], cloud: Optional[Cloud], monitor: Monitor
) -> tuple[dict[str, Optional[LayerFeatures]], Optional[_Place]]:
    """Return the layers of files in local meters: from the cloud's origin, else from a corner of the first layer."""
    place = _Place.of(cloud) if cloud is not None else None
    layers: dict[str, Optional[LayerFeatures]] = {}
    for wanted, path in files.items():
        if wanted.read is not None:
            features, code = wanted.read(path.read_text(encoding="utf-8", errors="replace"))
        else:
            features, code = read_layer(path, wanted, monitor)
        place = place or _place_of(features, code)
        if code and place.plane and code != place.plane:
            raise ValueError(f"{path.name} is in {code} and the rest in {place.plane}; reproject it first.")
        features.geometries = [_local(geometry, place) for geometry in features.geometries]
        layers[wanted.name] = features
    return layers, place


def _place_of(features: LayerFeatures, code: str) -> _Place:
    first = features.geometries[0] if features.geometries else np.zeros(2)
    origin = origin_before(np.atleast_2d(first[0] if isinstance(first, list) else first)[0, :2])
    return _Place(lambda local: local + origin[: local.shape[-1]], lambda at: at - origin[: at.shape[-1]], code, code)


def _local(geometry: Any, place: _Place) -> Any:
    return [place.from_map(ring) for ring in geometry] if isinstance(geometry, list) else place.from_map(geometry)


def _write(output: Output, results: Results, place: _Place, path: Path, monitor: Monitor) -> None:
    """Write one output."""
    name, declared = output.name, output.declared
    if isinstance(declared, Layer):
        write_features(path, declared, results.layers[name], place.to_map, place.plane)
    elif isinstance(declared, Raster):
        _write_grid(results.rasters[name], place, path)
    elif isinstance(declared, TextFile):
        frame = MapFrame(place.to_map, place.code, file=path.name.split(".")[0])
        with path.open("wb") as stream:
            for piece in results.files[name].pieces(declared.format_of(path.name), frame):
                if isinstance(piece, tuple):
                    path.with_name(piece[0]).write_bytes(piece[1])
                else:
                    stream.write(piece.encode() if isinstance(piece, str) else piece)
    elif declared == CLOUD:
        cloud = results.cloud if name == CLOUD else results.clouds[name]
        if cloud is not None:
            write_cloud(cloud, path, monitor)
    else:
        path.write_text(with_coordinates(results.reports[name].html, place.to_map), encoding="utf-8")


def _write_grid(surface: RasterSurface, place: _Place, path: Path) -> None:
    """Write a raster as an Esri ASCII grid, which needs no library."""
    rows, columns = surface.values.shape
    corner = np.array([[surface.west, surface.north - rows * surface.cell_size], [surface.west, surface.north]])
    (west, south), (_, north) = place.to_map(corner).tolist()
    head = (
        f"ncols {columns}\nnrows {rows}\nxllcorner {west!r}\nyllcorner {south!r}\ncellsize {(north - south) / rows!r}\n"
    )
    filled = np.where(np.isnan(surface.values), NO_DATA, surface.values)
    np.savetxt(path, filled, fmt="%.6g", header=f"{head}NODATA_value {NO_DATA}", comments="")


def _say(text: str) -> None:
    with contextlib.suppress(BrokenPipeError):
        sys.stdout.write(f"{text}\n")


class _Shown(Monitor):
    """Shows messages on the standard error, and the progress where that is a terminal."""

    def progress(self, fraction: float) -> None:
        """Show the share of the work that is done."""
        if sys.stderr.isatty():
            sys.stderr.write(f"\r{100 * fraction:3.0f} %")

    def warn(self, sentence: str) -> None:
        """Show a warning."""
        super().warn(sentence)
        self.end(f"Warning: {sentence}")

    def inform(self, sentence: str) -> None:
        """Show a sentence."""
        super().inform(sentence)
        self.end(sentence)

    def end(self, sentence: str, code: int = 0) -> int:
        """Show a sentence on a line of its own; return the exit code that it goes with."""
        sys.stderr.write(f"\r{sentence}\n" if sys.stderr.isatty() else f"{sentence}\n")
        return code


if __name__ == "__main__":
    sys.exit(main())
