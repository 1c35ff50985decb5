"""The script that writes the help pages covers every stage and chain."""

from __future__ import annotations

import importlib.util

from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.algorithms.tiling.tiled_pipelines import CUT_INTO_TILES, TILED_PIPELINES
from lidar_buildings.provider.paths import PLUGIN


def test_every_stage_and_chain_gets_a_page():
    spec = importlib.util.spec_from_file_location("generate_resources", PLUGIN / "scripts" / "generate_resources.py")
    generator = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(generator)
    assert set(generator.help_pages()) == {
        f"{one.id}.html" for one in (*STAGES.values(), *PIPELINES.values(), *TILED_PIPELINES.values(), CUT_INTO_TILES)
    }
