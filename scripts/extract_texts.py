"""Write the texts that users see, as the source of translations: ``resources/translations/lidar_buildings.ts``.

``lupdate`` finds texts in calls alone; here those of the declarations of stages are added. A translator copies the file
to ``lidar_buildings_<language>.ts``, fills it in with Qt Linguist, and makes the .qm with ``lrelease``.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from pathlib import Path
from xml.sax.saxutils import escape

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import conftest  # noqa: E402, F401 - registers the checkout as the package lidar_buildings
from lidar_buildings.algorithms.captions import captions  # noqa: E402
from lidar_buildings.algorithms.help import pipeline_help, stage_help, step_title, translated  # noqa: E402
from lidar_buildings.algorithms.pipelines import PIPELINES  # noqa: E402
from lidar_buildings.algorithms.presets import PRESETS  # noqa: E402
from lidar_buildings.algorithms.stage import Stage  # noqa: E402
from lidar_buildings.algorithms.stages import STAGES  # noqa: E402
from lidar_buildings.algorithms.tiling.settings import CUT_SETTINGS, SETTINGS  # noqa: E402
from lidar_buildings.algorithms.tiling.tiled_pipelines import (  # noqa: E402
    CUT_INTO_TILES,
    TILED_PIPELINES,
    survey_tool_help,
    tiled_pipeline_help,
)

CONTEXT = "LidarBuildings"
TARGET = ROOT / "resources" / "translations" / "lidar_buildings.ts"

# Tables of provider/ whose values are texts that are translated where they are shown.
_TABLES = ("_BY_ATTRIBUTE", "_BY_DIMENSION", "_COLUMNS", "_FILTERS", "_NUMBERS")


def texts() -> list[str]:
    """Return all texts, sorted, each once."""
    found = {text for path in sorted((ROOT / "provider").glob("*.py")) for text in _of_module(path)}
    for stage in STAGES.values():
        found.update(_of_stage(stage))
    for made in (*PIPELINES.values(), *TILED_PIPELINES.values(), CUT_INTO_TILES):
        found.update((made.title, made.group, made.summary))
    for pipeline in PIPELINES.values():
        found.update(step_title(step) for step in pipeline.steps)
    for setting in (*SETTINGS.values(), *CUT_SETTINGS.values()):
        found.update((setting.title, setting.help))
        # The meaning of an empty value is shown in the field as well.
        if "empty = " in setting.title:
            found.add(setting.title.split("empty = ")[1].rstrip(")"))
    found.update(preset.title for preset in PRESETS.values())
    found.update(captions().values())

    def collected(line: str) -> str:
        found.add(line)
        return line

    # Helps are translated line by line.
    for text in _helps():
        translated(text, collected)
    return sorted(found - {""})


def _helps() -> Iterator[str]:
    """Yield the helps of all algorithms."""
    yield from map(stage_help, STAGES.values())
    yield from map(pipeline_help, PIPELINES.values())
    yield from map(tiled_pipeline_help, TILED_PIPELINES.values())
    yield survey_tool_help(CUT_INTO_TILES)


def _of_module(path: Path) -> Iterator[str]:
    """Yield the texts that are given to ``tr`` in a module, titles of options, and values of tables."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if (
            isinstance(node, ast.Call)
            and getattr(node.func, "id", "") == "tr"
            and isinstance(node.args[0], ast.Constant)
        ):
            yield node.args[0].value
        elif isinstance(node, ast.Call) and getattr(node.func, "id", "") == "Option":
            yield node.args[1].value
        elif isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") in _TABLES:
            yield from (value.value for value in node.value.values if isinstance(value, ast.Constant))


def _of_stage(stage: Stage) -> Iterator[str]:
    """Yield the texts of a stage in its dialog."""
    yield from (stage.title, stage.group, stage.summary, stage.report_title)
    yield from (stage.input_title, stage.reference_title, stage.reference)
    for tunable in stage.tunables.values():
        yield from (tunable.param.label, tunable.param.help, tunable.param.unset, tunable.param.unset_text)
    for made in (*stage.layers, *stage.rasters, *stage.measures, *stage.files, *stage.input_layers):
        yield made.title
    yield from (input_layer.help for input_layer in stage.input_layers)


def source() -> str:
    """Return the file of the texts, for Qt Linguist."""
    messages = "\n".join(
        f"    <message>\n        <source>{escape(text)}</source>\n"
        '        <translation type="unfinished"></translation>\n    </message>'
        for text in texts()
    )
    return (
        '<?xml version="1.0" encoding="utf-8"?>\n<!DOCTYPE TS>\n<TS version="2.1" sourcelanguage="en">\n<context>\n'
        f"    <name>{CONTEXT}</name>\n{messages}\n</context>\n</TS>\n"
    )


def write_texts() -> None:
    """Write the file."""
    TARGET.parent.mkdir(parents=True, exist_ok=True)
    TARGET.write_text(source(), encoding="utf-8")


if __name__ == "__main__":
    write_texts()
    print(f"{TARGET.relative_to(ROOT)}: {len(texts())} texts")
