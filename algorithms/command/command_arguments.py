"""The arguments of the command, from the declaration of an algorithm."""

import argparse
from pathlib import Path
from typing import Any, Callable

from ..pipeline import CLOUD, Pipeline, Step
from ..pipelines import PIPELINES
from ..stage import Layer, Raster, TextFile, Tunable
from ..stages import STAGES

# The three that are asked for most.
SHORT_NAMES = {"detect": "detect_buildings", "model": "model_buildings", "map": "map_footprints"}

_TRUE, _FALSE = ("true", "yes", "1"), ("false", "no", "0")


def dashed(name: str) -> str:
    """Return a name as the command line has it, ``min-area`` of ``min_area``."""
    return name.replace("_", "-")


def find_algorithm(word: str) -> Pipeline:
    """Return the composite of a name such as "detect-buildings", or the stage as a chain of one step.

    Raises
    ------
    ValueError
        If no algorithm has the name.
    """
    name = SHORT_NAMES.get(word, word.replace("-", "_"))
    if name in PIPELINES:
        return PIPELINES[name]
    if name not in STAGES:
        raise ValueError(f"There is no algorithm {word!r}; 'lidar-buildings' alone lists those there are.")
    stage, step = STAGES[name], Step("run", name)
    about = (stage.title, stage.group, stage.tags, stage.summary, stage.description, stage.section("References"))
    return Pipeline(name, *about, steps=(step,), shared={tunable: (step.name,) for tunable in stage.tunables})


def parser_of(algorithm: Pipeline) -> argparse.ArgumentParser:
    """Return the parser of the arguments of an algorithm: clouds, layers, parameters and outputs."""
    parser = argparse.ArgumentParser(
        usage=f"lidar-buildings {dashed(algorithm.name)} {'CLOUD ' * algorithm.reads_cloud}[options]",
        description=f"{algorithm.summary} {algorithm.description}".replace("%", "%%").replace("``", ""),
        epilog="Distances are in meters, whatever the unit of the cloud. At least one output is given.",
    )
    if algorithm.reads_cloud:
        needs_cloud = any(algorithm.cloud_of(step) == "" and step.stage.needs_cloud for step in algorithm.steps)
        count = "+" if algorithm.merges else None if needs_cloud else "?"
        about = "LAS, LAZ, COPC, VPC or EPT: a file or an address"
        parser.add_argument("cloud", nargs=count, metavar="CLOUD", help=about)
        parser.add_argument("--extent", type=_extent, metavar="W,S,E,N", help="read the points in this box, map units")
    if algorithm.compared is not None:
        needed = algorithm.compared.needs_reference
        parser.add_argument("--reference", metavar="CLOUD", required=needed, help=_text(algorithm.compared.reference))
    for layer in algorithm.input_layers.values():
        kind, about = "LAYER" if layer.read is None else "FILE", _text(f"{layer.title}. {layer.help}")
        needed = not layer.optional
        parser.add_argument(f"--{dashed(layer.name)}", type=Path, metavar=kind, required=needed, help=about)
    _add_outputs(parser.add_argument_group("outputs"), algorithm)
    parameters = parser.add_argument_group("parameters")
    for name, (step, tunable) in algorithm.parameters.items():
        default = step.tunables.get(tunable.name, tunable.default)
        about, kind = _text(_about(tunable, default)), _metavar(tunable)
        parameters.add_argument(f"--{dashed(name)}", type=_typed(tunable), metavar=kind, help=about)
    return parser


def _add_outputs(outputs: Any, algorithm: Pipeline) -> None:
    for output in algorithm.outputs:
        declared = output.declared
        what = f"{output.step.stage.report_title} (.html)"
        if declared == CLOUD:
            what = "Point cloud (.las, .laz or .copc.laz)"
        elif isinstance(declared, Layer):
            what = f"{declared.title} (.geojson; with pyogrio .gpkg and others)"
        elif isinstance(declared, Raster):
            what = f"{declared.title} (.asc)"
        elif isinstance(declared, TextFile):
            endings = ", ".join(ending for endings in declared.formats.values() for ending in endings)
            what = f"{declared.title} ({endings})"
        outputs.add_argument(f"--{dashed(output.name)}", type=Path, metavar="FILE", help=_text(what))


def _about(tunable: Tunable, default: Any) -> str:
    """Return the help of a parameter, with its default."""
    shown = default if not isinstance(default, tuple) else ",".join(default)
    end = tunable.param.unset_text if default is None else f"Default: {shown}." if default != "" else ""
    choices = f"One of {', '.join(map(repr, tunable.param.choices))}. " if tunable.param.choices else ""
    return f"{tunable.title}. {tunable.param.help} {choices}{end}"


def _text(help_text: str) -> str:
    """Return a help text as argparse takes it."""
    return help_text.replace("%", "%%").replace("``", "").strip()


def _metavar(tunable: Tunable) -> str:
    return {bool: "true|false", int: "N", float: "X"}.get(tunable.type, "WORD")


def _typed(tunable: Tunable) -> Callable[[str], Any]:
    """Return the function that converts a word to the checked value of a tunable."""

    def value_of(word: str) -> Any:
        try:
            return tunable.check(_converted(tunable, word))
        except ValueError as error:
            raise argparse.ArgumentTypeError(str(error).rstrip(".")) from None

    return value_of


def _converted(tunable: Tunable, word: str) -> Any:
    """Return a word in the type of a tunable, as it is where it has no such value: the check refuses it."""
    if tunable.is_optional and word == tunable.param.unset:
        return None
    if tunable.type is bool:
        return True if word.lower() in _TRUE else False if word.lower() in _FALSE else word
    if tunable.type is tuple:
        return tuple(part.strip() for part in word.split(",") if part.strip())
    if tunable.type is str:
        return word
    try:
        return int(word) if tunable.type is int else float(word)
    except ValueError:
        return word


def _extent(word: str) -> list[list[float]]:
    """Return a box as least and greatest easting and northing."""
    west, south, east, north = (float(part) for part in word.split(","))
    return [[west, south], [east, north]]
