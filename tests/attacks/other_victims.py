"""What is done with damaged results of blocks and odd layers, and what may come of it."""

from __future__ import annotations

import os
from functools import cache
from pathlib import Path

import numpy as np

from lidar_buildings.algorithms.cloud.cloud import Cloud, create_cloud
from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.algorithms.tiling.block_result import BlockResult
from lidar_buildings.tests.attacks.other_mutants import POINTS, SOUND
from lidar_buildings.tests.builders import roof


def take_result(path: Path, _: int = 0) -> str:
    """Take a result as a run takes it up again; return why not, or "" where it is what was written.

    Raises
    ------
    AssertionError
        If something else is taken for a result.
    """
    if not BlockResult.is_complete(path, [POINTS]):
        return "It is worked on again."
    with np.load(path, allow_pickle=False) as found, np.load(path.with_name(SOUND), allow_pickle=False) as sound:
        assert sorted(found.files) == sorted(sound.files), "other arrays were taken for a block's"
        for name in sound.files:
            np.testing.assert_array_equal(found[name], sound[name])
    return ""


@cache
def _cloud() -> Cloud:
    """Return a house on a field."""
    rng = np.random.default_rng(3)
    plan = rng.uniform(0, 20, (1200, 2))
    under = ((plan > [5, 5]) & (plan < [12, 10])).all(axis=1)
    ground = np.column_stack([plan, rng.normal(0, 0.02, len(plan))])[~under]
    house = roof(rng, 5, 5, 7, 5, 5.0, density=3.0)
    classes = np.repeat(np.array([2, 6], np.uint8), [len(ground), len(house)])
    xyz = np.concatenate([ground, house]) + [85_000, 446_000, 0]
    heights = np.concatenate([ground[:, 2], house[:, 2]]).astype(np.float32)
    return create_cloud({"xyz": xyz, "classification": classes, "height_above_ground": heights}, "EPSG:28992")


@cache
def _qgis() -> object:
    """Start QGIS without windows, and return what has to live as long."""
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    from qgis.core import QgsApplication

    application = QgsApplication([], False)
    application.initQgis()
    return application


def read_layer(path: Path, number: int) -> str:
    """Read a layer as one of the stages that take layers does, and run it; return why it was refused, or ""."""
    _qgis()
    from qgis.core import QgsProcessingContext, QgsProcessingFeatureSource, QgsVectorLayer

    from lidar_buildings.provider.input_layers import GivenLayer
    from lidar_buildings.provider.places import place_of_cloud

    readers = [stage for stage in STAGES.values() if stage.input_layers]
    stage = readers[np.random.default_rng(number).integers(len(readers))]
    context, cloud = QgsProcessingContext(), _cloud().copy()
    layer = QgsVectorLayer(str(path), "layer", "ogr")
    if not layer.isValid():
        return "QGIS reads no layer from it."
    source = QgsProcessingFeatureSource(layer, context)
    try:
        layers = {
            wanted.name: GivenLayer(wanted, source, context).read(place_of_cloud(cloud), Monitor())
            for wanted in stage.input_layers
        }
        clouds = cloud if stage.reads else None
        run_stage(stage, clouds, cloud.copy(), Monitor(), layers)
    except ValueError as error:
        said = str(error)
        if type(error).__module__ == "builtins" and said.endswith(".") and said.isprintable():
            return said
        raise
    return ""
