"""Measure the sampling of a survey, and the values that blocks take from the whole, before its blocks are processed."""

from functools import partial
from typing import Any, Callable, Optional

import numpy as np

from ..cloud.cloud import Cloud
from ..pipeline import Pipeline
from ..run import counted, has_colors, has_several_returns, run_pipeline
from ..sampling.cloud_sampling import CloudSampling, Learn
from ..stage import Monitor, ProgressOnly
from .survey import Survey
from .tiled_steps import in_blocks, measuring, part_of, preparing, tunables_of

# Most points that the sampling is measured on: all points of small surveys, else the points of windows.
_SAMPLED_WHOLE = 3_000_000

# Windows along each side of a survey.
_SAMPLES_ACROSS = 4


def samplings_of(
    pipeline: Pipeline, survey: Survey, tunables: dict[str, Any], monitor: Monitor, layers: Any = None
) -> dict[str, CloudSampling]:
    """Return the sampling of a survey, by the name "", and of the clouds that its preparing steps make, by theirs.

    Each has the values that blocks take of the whole (``of_whole``). All is measured on windows that depend on the
    survey alone, not on its blocks.

    Parameters
    ----------
    pipeline : Pipeline
        The composite.
    survey : Survey
        All points of all files.
    tunables : dict of str to Any
        Tunables of the composite by name.
    monitor : Monitor
        Receives the progress.
    layers : dict of str to LayerFeatures, optional
        Layers that steps read, by name, m from the origin of the survey.

    Raises
    ------
    ValueError
        If the survey has no points within its extent, or a step refuses its points.
    """
    reading = monitor.part(0, 0.3)
    boxes, corner = _sample_boxes(survey), survey.corner
    clouds, survey = _sampled(survey, boxes, reading)
    if len(clouds) < len(boxes) / 4:
        # The survey fills little of its extent, as a corridor or a coast does: windows are put around its points.
        positions = survey.positions(_SAMPLES_ACROSS**2, reading.part(1.0, 1.0))
        clouds, _ = _sampled(survey, _squares_around(positions, _sample_side(survey)), reading.part(1.0, 1.0))
    if not clouds:
        raise ValueError("The survey has no points within the extent; choose another extent.")
    samplings = {"": _sampling_of(clouds, corner)}
    pipeline = in_blocks(pipeline)
    steps, prepares = measuring(pipeline), preparing(pipeline)
    for done, step in enumerate(steps):
        before = list(samplings.values())[-1]
        part = monitor.part(0.3 + 0.7 * done / len(steps), 0.3 + 0.7 * (done + 1) / len(steps))
        make = partial(_made, part_of(pipeline, [step]), before, tunables, layers)
        monitor.inform(f"Measured on parts of the survey: {step.stage.title}.")
        # All parts, until the points are those that the others work on.
        if any(later in prepares for later in steps[done:]):
            made = list(map(make, clouds, part.parts(len(clouds))))
            clouds = [one for one in made if one is not None]
            if step in prepares:
                samplings[step.name] = _sampling_of(clouds, corner)
        elif clouds:
            clouds, measured = _measured(make, _enough(clouds), before, part)
            before.of_whole.update(measured)
    return samplings


def _sample_side(survey: Survey) -> float:
    """Return the side of the windows that the sampling is measured on, m; together they have _SAMPLED_WHOLE points."""
    density = survey.expected / np.prod(survey.boxes[:, 1] - survey.boxes[:, 0], axis=1).sum()
    return float(min(100.0, np.sqrt(_SAMPLED_WHOLE / _SAMPLES_ACROSS**2 / density)))


def _sample_boxes(survey: Survey) -> list[np.ndarray]:
    """Return the boxes (2, 2), m, that the sampling is measured on: the whole survey, or squares spread over it."""
    low, high = survey.box
    if survey.expected <= _SAMPLED_WHOLE:
        # A box lacks its upper edge.
        return [np.array([low, high + 1.0])]
    across = (np.arange(_SAMPLES_ACROSS) + 0.5) / _SAMPLES_ACROSS
    centers = np.array([low + (high - low) * (x, y) for x in across for y in across])
    return _squares_around(centers, _sample_side(survey))


def _squares_around(positions: np.ndarray, side: float) -> list[np.ndarray]:
    """Return the squares (2, 2), m, of a lattice from zero that positions (k, 2) lie in, each once."""
    return [np.array([corner, corner + side]) for corner in np.unique(np.floor(positions / side) * side, axis=0)]


def _sampled(survey: Survey, boxes: list[np.ndarray], monitor: Monitor) -> tuple[list[Cloud], Survey]:
    """Return the points of each box that has any, and the survey without files found damaged."""
    found = []
    for box, part in zip(boxes, monitor.parts(len(boxes))):
        try:
            window = survey.window(box, part)
        except ValueError as error:
            # The blocks of a damaged file fail by name later; all others are worked on.
            survey = survey.sound_part(box, monitor.part(1.0, 1.0))
            if not survey.sources:
                raise error from None
            window = survey.window(box, monitor.part(1.0, 1.0))
        if window is not None and not window.cloud.withheld.all():
            found.append(window.cloud)
    return found, survey


def _made(
    step: Pipeline, sampling: CloudSampling, tunables: dict[str, Any], layers: Any, cloud: Cloud, monitor: Monitor
) -> Optional[Cloud]:
    """Return the cloud that a step makes of a part of a survey."""
    own = tunables_of(step, tunables)
    return run_pipeline(step, cloud, ProgressOnly(monitor), layers, samplings={"": sampling}, **own).cloud


def _measured(
    make: Callable[[Cloud, Monitor], Optional[Cloud]], clouds: list[Cloud], sampling: CloudSampling, monitor: Monitor
) -> tuple[list[Cloud], dict[str, Any]]:
    """Return the clouds that a step makes of parts of a survey, and what it measures and learns on them together."""
    made: list[Optional[Cloud]] = []
    values: dict[str, list[float]] = {}
    tables: dict[str, list[tuple[np.ndarray, Learn]]] = {}
    for cloud, part in zip(clouds, monitor.parts(len(clouds))):
        sampling.found.clear()
        sampling.samples.clear()
        try:
            made.append(make(cloud, part))
        except ValueError:
            # A part without ground, as over water, or islands far from each other: blocks there report their errors.
            continue
        for name, value in sampling.found.items():
            values.setdefault(name, []).append(value)
        for name, table in sampling.samples.items():
            tables.setdefault(name, []).append(table)
    sampling.found.clear()
    sampling.samples.clear()
    measured: dict[str, Any] = {name: float(np.median(of_parts)) for name, of_parts in values.items()}
    for name, parts in tables.items():
        measured[name] = parts[0][1](np.concatenate([table for table, _ in parts]))
    return [one for one in made if one is not None], measured


def _enough(clouds: list[Cloud]) -> list[Cloud]:
    """Return as many of the clouds, spread over all of them, as hold 1.5 million points, one at least.

    *Detect buildings* takes a core half a minute for as many.
    """
    count = max(1, int(len(clouds) * min(1.0, 1_500_000 / sum(len(cloud) for cloud in clouds))))
    return [clouds[at] for at in np.linspace(0, len(clouds) - 1, count).round().astype(int)]


def _sampling_of(clouds: list[Cloud], corner: np.ndarray) -> CloudSampling:
    """Return the sampling of several parts of a survey with a south-western ``corner`` (2,), all measures taken."""
    together = np.concatenate([cloud.get("xyz")[counted(cloud)] for cloud in clouds])
    single, colored = not any(map(has_several_returns, clouds)), all(map(has_colors, clouds))
    return CloudSampling(lambda: together, single, corner, colored).without_points()
