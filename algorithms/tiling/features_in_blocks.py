"""Stages that work on each feature of a layer, on surveys of any size: part by part, and each feature in one."""

from functools import partial
from typing import Any, Optional

import numpy as np

from ..pipeline import Pipeline, Step
from ..run import run_stage
from ..sampling.cloud_sampling import CloudSampling
from ..stage import LayerFeatures, Monitor, ProgressOnly, Stage, StageResults, given_layers
from .block_plan import side_of_blocks
from .blocks import feature_boxes, take_features
from .survey import Survey, boxes_meet
from .survey_sampling import samplings_of

# Points of the largest cloud that is worked on as a whole: it takes 4 GB of memory.
LARGEST = 10_000_000
# Attribute with the position of a feature in its layer.
_ROW = "row of the layer"


def measure_features(stage: Stage, survey: Survey, given: LayerFeatures, monitor: Monitor) -> LayerFeatures:
    """Return the results of a stage for the features of a layer that touch a survey, in their order.

    The values don't depend on the blocks where nothing beyond the reach of the stage decides on a feature. One run
    gives the same, but for measures that are taken on parts of large surveys, see :func:`.samplings_of`. Memory: the
    points of one block.

    Parameters
    ----------
    stage : Stage
        A stage without tunables that makes one feature of each feature of a layer (``each``).
    survey : Survey
        The points.
    given : LayerFeatures
        The features, m from the origin of the survey.
    monitor : Monitor
        Receives progress, and warnings of features that are left out.

    Raises
    ------
    ValueError
        If there are none, or all are left out.
    """
    sampling = _sampling(stage, survey, monitor.part(0.0, 0.1), {stage.each: given})
    reach, boxes = stage.reach_of({}), feature_boxes(given) + survey.origin[:2]
    side = side_of_blocks(sampling.density, reach)
    features = LayerFeatures(given.geometries, {**given.columns, _ROW: list(range(len(given)))})
    near = np.flatnonzero(boxes_meet(boxes, survey.box))
    blocks, of_block = np.unique(np.floor(boxes[near].mean(axis=1) / side), axis=0, return_inverse=True)
    monitor.inform(f"{len(near):,} of {len(given):,} features touch the points; {len(blocks):,} blocks of {side:g} m.")
    found, why = [], "None of the features has points near it; choose a layer of the same area as the point cloud."
    for number in range(len(blocks)):
        own, (start, end) = near[of_block.ravel() == number], 0.1 + 0.9 * np.array([number, number + 1]) / len(blocks)
        box = np.array([boxes[own, 0].min(axis=0) - reach, boxes[own, 1].max(axis=0) + reach])
        part, around = monitor.part(start, end), take_features(features, np.flatnonzero(boxes_meet(boxes, box)))
        window = survey.window(box, part)
        if window is None:
            continue
        try:
            made = run_stage(stage, window.cloud, None, ProgressOnly(part), {stage.each: around}, sampling)
        except ValueError as error:
            why = str(error)
            monitor.warn(f"{len(own):,} features of a block are left out: {why}")
            continue
        (layer,) = made.layers.values()
        found.append(take_features(layer, np.flatnonzero(np.isin(layer.columns[_ROW], own))))
    if not found:
        raise ValueError(why)
    columns = {name: [value for one in found for value in one.columns[name]] for name in found[0].columns}
    joined = LayerFeatures([geometry for one in found for geometry in one.geometries], columns)
    return take_features(joined, np.argsort(columns.pop(_ROW)))


def run_in_windows(
    stage: Stage, surveys: list[Survey], layers: dict[str, Optional[LayerFeatures]], monitor: Monitor, **tunables: Any
) -> StageResults:
    """Return the results of a stage that reads the points of surveys where it needs them (``windowed``).

    Parameters
    ----------
    stage : Stage
        The stage.
    surveys : list of Survey
        The points, and then a reference, where one is given.
    layers : dict of str to LayerFeatures
        Layers that it reads, by name, m from the origin of the first survey.
    monitor : Monitor
        Receives progress.
    **tunables
        Tunables by name.
    """
    given = given_layers(stage.name, stage.input_layers, layers)
    chosen, sampling = stage.check(tunables), _sampling(stage, surveys[0], monitor.part(0.0, 0.1))
    side, part = side_of_blocks(sampling.density, stage.reach_of(chosen)), monitor.part(0.1, 1.0)
    made = stage.windowed(partial(_points, surveys), side, **given, **chosen, sampling=sampling, monitor=part)
    return stage.unpack(made)


def _sampling(stage: Stage, survey: Survey, monitor: Monitor, layers: Any = None) -> CloudSampling:
    """Return the sampling of a survey, with the values that parts take of the whole."""
    alone = Pipeline(stage.name, stage.title, *("",) * 5, (Step(stage.name, stage.name),))
    return samplings_of(alone, survey, {}, monitor, layers)[""]


def _points(surveys: list[Survey], box: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return coordinates and classes of the points of each survey in a box (2, 2), m from the origin of the first."""
    origin, found = surveys[0].origin, []
    for survey in surveys:
        window = survey.window(box + origin[:2])
        if window is None:
            found.append((np.zeros((0, 3)), np.zeros(0, np.uint8)))
            continue
        cloud = window.cloud
        cloud.origin = origin
        used = ~cloud.withheld
        found.append((cloud.get("xyz")[used], cloud.get("classification")[used]))
    return found
