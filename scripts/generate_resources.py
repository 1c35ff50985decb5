"""Write the generated files of the plugin: help pages and models of pipelines.

``make resources`` runs it with the Python of QGIS.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

# Qt shuffles the attributes of XML unless this is set before it starts: each model would be a new file.
os.environ["QT_HASH_SEED"] = "0"
ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))
from qgis.core import QgsApplication  # noqa: E402

import conftest  # noqa: E402, F401 - registers the checkout as the package lidar_buildings
from lidar_buildings.algorithms.help import page, pipeline_help, stage_help  # noqa: E402
from lidar_buildings.algorithms.pipelines import PIPELINES  # noqa: E402
from lidar_buildings.algorithms.stages import STAGES  # noqa: E402
from lidar_buildings.algorithms.tiling.tiled_pipelines import (  # noqa: E402
    CUT_INTO_TILES,
    TILED_PIPELINES,
    survey_tool_help,
    tiled_pipeline_help,
)
from lidar_buildings.provider import models  # noqa: E402
from lidar_buildings.provider.paths import HELP, MODELS  # noqa: E402
from lidar_buildings.provider.provider import Provider  # noqa: E402


def help_pages() -> dict[str, str]:
    """Return the help pages by file name."""
    pages = {f"{stage.id}.html": page(stage.title, stage_help(stage), stage.id) for stage in STAGES.values()}
    pages.update({f"{p.id}.html": page(p.title, pipeline_help(p), p.id) for p in PIPELINES.values()})
    pages.update({f"{t.id}.html": page(t.title, tiled_pipeline_help(t), t.id) for t in TILED_PIPELINES.values()})
    pages[f"{CUT_INTO_TILES.id}.html"] = page(CUT_INTO_TILES.title, survey_tool_help(CUT_INTO_TILES), CUT_INTO_TILES.id)
    return pages


def _remove_others(folder: Path, suffix: str, wanted: set[str]) -> None:
    """Remove the files of a folder with a suffix that are not wanted; make the folder where it is missing."""
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob(f"*{suffix}"):
        if old.name not in wanted:
            old.unlink()


def main() -> None:
    """Write all files and remove those of algorithms that no longer exist."""
    pages = help_pages()
    _remove_others(HELP, ".html", set(pages))
    for name, text in pages.items():
        (HELP / name).write_text(text, encoding="utf-8")
    application = QgsApplication([], False)
    QgsApplication.initQgis()
    provider = Provider(with_pipelines=False)
    QgsApplication.processingRegistry().addProvider(provider)
    _remove_others(MODELS, ".model3", {models.model_file(p).name for p in PIPELINES.values()})
    for pipeline in PIPELINES.values():
        models.build_model(pipeline).toFile(str(models.model_file(pipeline)))
    QgsApplication.exitQgis()
    del application


if __name__ == "__main__":
    main()
