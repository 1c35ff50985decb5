"""How a survey was sampled, measured before it is worked on in blocks, and what blocks take of the whole."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np

from ..cloud.cloud import Cloud
from ..geometry.grid import SparsePointsError
from ..pipeline import Pipeline
from ..run import counted, has_several_returns, run_pipeline
from ..sampling.cloud_sampling import CloudSampling
from ..stage import Monitor, ProgressOnly
from .survey import Survey
from .tiled_steps import in_blocks, measuring, part_of, preparing, tunables_of

# How a survey was sampled is measured on all its points up to this many, else on windows of that side (m) at most, as
# many in each direction.
_SAMPLED_WHOLE = 3_000_000
_SAMPLES_ACROSS, _SAMPLE_SIDE = 4, 100.0

# What steps make of the points, and blocks take of the whole, is measured on as many of these windows as hold this many
# points, one at least: a second of a core for each 60,000.
_MEASURED = 1_500_000


def samplings_of(
    pipeline: Pipeline, survey: Survey, tunables: dict[str, Any], monitor: Monitor
) -> dict[str, CloudSampling]:
    """Return how a survey was sampled, "", and how what its preparing steps make of it is, by their names.

    Each has the values that blocks take of the whole (``of_whole``). All is measured on windows whose places depend on
    the extent of the survey alone.

    Raises
    ------
    ValueError
        If the survey has no points within its extent, or a step refuses its points.
    """
    sampling = monitor.part(0, 0.3)
    boxes, corner = _sample_boxes(survey), survey.corner
    clouds, survey = _sampled(survey, boxes, sampling)
    if len(clouds) < len(boxes) / 4:
        # It fills little of its extent, as a corridor or a coast does.
        places = survey.places(_SAMPLES_ACROSS**2, sampling.part(1.0, 1.0))
        clouds, _ = _sampled(survey, _squares_around(places, _sample_side(survey)), sampling.part(1.0, 1.0))
    if not clouds:
        raise ValueError("The survey has no points within the extent; choose another extent.")
    samplings = {"": _sampling_of(clouds, corner)}
    pipeline = in_blocks(pipeline)
    steps, prepares = measuring(pipeline), preparing(pipeline)
    for done, step in enumerate(steps):
        before = list(samplings.values())[-1]
        clouds = clouds if step in prepares else _enough(clouds)
        part = monitor.part(0.3 + 0.7 * done / len(steps), 0.3 + 0.7 * (done + 1) / len(steps))
        try:
            clouds, measured = _worked_on(part_of(pipeline, [step]), clouds, before, tunables, part)
        except SparsePointsError:
            if step in prepares:
                raise
            # Islands far from each other are no surface, but their blocks are.
            break
        before.of_whole.update(measured)
        if step in prepares:
            samplings[step.name] = _sampling_of(clouds, corner)
    return samplings


def _sample_side(survey: Survey) -> float:
    """Return the side of the windows that the sampling is measured on, m; all have _SAMPLED_WHOLE points at most."""
    density = survey.expected / np.prod(survey.boxes[:, 1] - survey.boxes[:, 0], axis=1).sum()
    return float(min(_SAMPLE_SIDE, np.sqrt(_SAMPLED_WHOLE / _SAMPLES_ACROSS**2 / density)))


def _sample_boxes(survey: Survey) -> list[np.ndarray]:
    """Return the boxes (2, 2), m, that the sampling is measured on: the whole survey, or squares spread over it."""
    low, high = survey.box
    if survey.expected <= _SAMPLED_WHOLE:
        return [np.array([low, high + 1.0])]
    across = (np.arange(_SAMPLES_ACROSS) + 0.5) / _SAMPLES_ACROSS
    centers = np.array([low + (high - low) * (x, y) for x in across for y in across])
    return _squares_around(centers, _sample_side(survey))


def _squares_around(places: np.ndarray, side: float) -> list[np.ndarray]:
    """Return the squares (2, 2), m, of a lattice from zero that places (k, 2) lie in, each once."""
    return [np.array([corner, corner + side]) for corner in np.unique(np.floor(places / side) * side, axis=0)]


def _sampled(survey: Survey, boxes: list[np.ndarray], monitor: Monitor) -> tuple[list[Cloud], Survey]:
    """Return the points of each box that has any, and the survey without files found damaged."""
    found = []
    for done, box in enumerate(boxes):
        part = monitor.part(done / len(boxes), (done + 1) / len(boxes))
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


def _worked_on(
    step: Pipeline, clouds: list[Cloud], sampling: CloudSampling, tunables: dict[str, Any], monitor: Monitor
) -> tuple[list[Cloud], dict[str, float]]:
    """Return what a step makes of parts of a survey, and the medians of what it measures there for the whole."""
    made, values = [], []
    for done, cloud in enumerate(clouds):
        heard = ProgressOnly(monitor.part(done / len(clouds), (done + 1) / len(clouds)))
        outcome = run_pipeline(step, cloud, heard, kept=(), samplings={"": sampling}, **tunables_of(step, tunables))
        made += [] if outcome.cloud is None else [outcome.cloud]
        values.append(heard.values)
    names = {name: f"{one.name}_{name}" for one in step.steps for name in one.stage.of_whole}
    found = {name: [of_one[value] for of_one in values if value in of_one] for name, value in names.items()}
    return made, {name: float(np.median(of_all)) for name, of_all in found.items() if of_all}


def _enough(clouds: list[Cloud]) -> list[Cloud]:
    """Return as many of the clouds, spread over all of them, as hold _MEASURED points, one at least."""
    count = max(1, int(len(clouds) * min(1.0, _MEASURED / sum(len(cloud) for cloud in clouds))))
    return [clouds[at] for at in np.linspace(0, len(clouds) - 1, count).round().astype(int)]


def _sampling_of(clouds: list[Cloud], corner: np.ndarray) -> CloudSampling:
    """Return how several parts of a survey with a south-western ``corner`` (2,) were sampled, all measures taken."""
    together = np.concatenate([cloud.get("xyz")[counted(cloud)] for cloud in clouds])
    sampling = CloudSampling(lambda: together, not any(has_several_returns(cloud) for cloud in clouds), corner)
    # The points are left behind, as on the way to another process.
    return pickle.loads(pickle.dumps(sampling))
