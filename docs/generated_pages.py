"""Pages and charts of the documentation that are made from the declarations in the code."""

from __future__ import annotations

import html
import shutil
import textwrap
from pathlib import Path

from constants import constants_page, tiling_page

from lidar_buildings.algorithms.captions import captions
from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.cloud.dimensions import DIMENSIONS
from lidar_buildings.algorithms.cloud.reasons import Reason
from lidar_buildings.algorithms.help import pipeline_help, stage_help, step_title
from lidar_buildings.algorithms.pipeline import Pipeline, Step
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.stage import Stage
from lidar_buildings.algorithms.stages import STAGES

ROOT = Path(__file__).resolve().parents[1]

# Boxes of flow charts, in pixels of the picture.
_BOX, _GAP, _WIDTH, _CHARACTER = 44, 46, 560, 6.6


def write(docs: Path) -> None:
    """Write all generated pages below the folder of the documentation."""
    charts, reference = docs / "methods" / "generated", docs / "reference" / "generated"
    for folder in (charts, reference):
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
    for name, pipeline in PIPELINES.items():
        (charts / f"{name}.svg").write_text(flow_chart(pipeline), encoding="utf-8")
        (charts / f"{name}_constants.md").write_text(constants_page(pipeline), encoding="utf-8")
        _page(reference / f"{pipeline.id}.md", pipeline.title, pipeline_help(pipeline))
    (charts / "in_tiles_constants.md").write_text(tiling_page(), encoding="utf-8")
    for stage in STAGES.values():
        _page(reference / f"{stage.id}.md", stage.title, stage_help(stage))
    (reference / "algorithms.md").write_text(_algorithms(), encoding="utf-8")
    (reference / "functions.rst").write_text(_functions(), encoding="utf-8")
    (reference / "dimensions.md").write_text(_dimensions(), encoding="utf-8")
    (reference / "codes.md").write_text(_codes(), encoding="utf-8")


def flow_chart(pipeline: Pipeline) -> str:
    """Return a composite as a picture (SVG): its steps, and on the arrows the dimensions that pass along them."""
    steps = [step for step in pipeline.steps if step.stage.makes_cloud or step.stage.layers or step.stage.rasters]
    parts, height = [], 0
    for number, step in enumerate(steps):
        height = 10 + number * (_BOX + _GAP)
        if number:
            parts += _arrow(height - _GAP, _passing(pipeline, step))
        parts += _step(height, step)
    height += _BOX + 10
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH} {height}" width="{_WIDTH}" height="{height}" '
        f'font-family="sans-serif" font-size="12">\n' + "\n".join(parts) + "\n</svg>\n"
    )


def _step(top: int, step: Step) -> list[str]:
    made = ", ".join([*(layer.title for layer in step.stage.layers), *(one.title for one in step.stage.rasters)])
    rows = [
        f'<rect x="10" y="{top}" width="250" height="{_BOX}" rx="6" fill="#eef3f8" stroke="#46627f"/>',
        f'<text x="22" y="{top + 18}" font-weight="bold">{html.escape(step_title(step))}</text>',
        f'<text x="22" y="{top + 35}" fill="#444">{html.escape(step.stage.title)}</text>',
    ]
    if made:
        lines = textwrap.wrap(made, int(260 / _CHARACTER))[:2]
        rows.append(
            f'<path d="M260 {top + _BOX / 2} h24 m-6 -4 l6 4 l-6 4" stroke="#46627f" fill="none" stroke-width="1.4"/>'
        )
        rows += [
            f'<text x="290" y="{top + 20 + 15 * at}" fill="#7a4a00">{html.escape(line)}</text>'
            for at, line in enumerate(lines)
        ]
    return rows


def _arrow(top: int, names: list[str]) -> list[str]:
    lines = textwrap.wrap(", ".join(names), int((_WIDTH - 150) / _CHARACTER))[:2]
    return [
        f'<path d="M135 {top} v{_GAP} m-4 -7 l4 7 l4 -7" stroke="#46627f" fill="none" stroke-width="1.4"/>',
        *(
            f'<text x="146" y="{top + 20 + 14 * at}" fill="#225588">{html.escape(line)}</text>'
            for at, line in enumerate(lines)
        ),
    ]


def _passing(pipeline: Pipeline, step: Step) -> list[str]:
    """Return the dimensions that a step reads and an earlier one writes, by their names in files."""
    before = pipeline.steps[: pipeline.steps.index(step)]
    written = {name for one in before for name in one.stage.writes}
    return [disk for name in step.stage.reads if name in written for disk in DIMENSIONS[name].disk[:1]] or ["points"]


def _page(path: Path, title: str, body: str) -> None:
    """Write the page on an algorithm: the picture of its help, where it has one, and its help."""
    picture = ROOT / "resources" / "help" / "pictures" / f"{path.stem}.png"
    shown = f"![{captions()[path.stem]}](../../../{picture.relative_to(ROOT)})\n\n" if picture.is_file() else ""
    text = f"---\norphan: true\n---\n# {title}\n\n{shown}```{{raw}} html\n{body}\n```\n"
    path.write_text(text, encoding="utf-8")


def _algorithms() -> str:
    """Return the list of all algorithms by group, with what each does."""
    rows = ["# Algorithms", "", "## Models", "", "| algorithm | id | what it does |", "| --- | --- | --- |"]
    rows += [f"| [{one.title}]({one.id}.md) | `{one.id}` | {one.summary} |" for one in PIPELINES.values()]
    for group in dict.fromkeys(stage.group for stage in STAGES.values()):
        rows += ["", f"## {group}", "", "| algorithm | id | what it does |", "| --- | --- | --- |"]
        rows += [_row(stage) for stage in STAGES.values() if stage.group == group]
    return "\n".join(rows) + "\n"


def _row(stage: Stage) -> str:
    return f"| [{stage.title}]({stage.id}.md) | `{stage.id}` | {' '.join(stage.summary.split())} |"


def _functions() -> str:
    """Return the page on the functions behind the algorithms."""
    rows = [
        "Functions",
        "=========",
        "",
        "Conventions",
        "-----------",
        "",
        ".. automodule:: lidar_buildings.algorithms",
        "",
    ]
    for group in dict.fromkeys(stage.group for stage in STAGES.values()):
        rows += [group, "-" * len(group), ""]
        for stage in STAGES.values():
            if stage.group == group:
                rows += [f".. autofunction:: {stage.function.__module__}.{stage.function.__name__}", ""]
    return "\n".join(rows)


def _dimensions() -> str:
    rows = ["# Dimensions", "", "| in Python | in files | type | unit | meaning |", "| --- | --- | --- | --- | --- |"]
    rows += [
        f"| `{one.name}` | {', '.join(one.disk)} | {one.dtype} | {one.unit} | {one.description} |"
        for one in DIMENSIONS.values()
    ]
    return "\n".join(rows) + "\n"


def _codes() -> str:
    rows = [
        "# Codes",
        "",
        "## Classes",
        "",
        "As ASPRS defines them in LAS 1.4 R15.",
        "",
        "| code | class |",
        "| ---: | --- |",
    ]
    rows += [f"| {one.value} | {one.name.replace('_', ' ').capitalize()} |" for one in PointClass]
    rows += ["", "## Reasons", "", "*Reason* is a dimension of the points and an attribute of footprints.", ""]
    rows += ["| code | meaning |", "| ---: | --- |", *(f"| {one.value} | {one.text} |" for one in Reason)]
    return "\n".join(rows) + "\n"
