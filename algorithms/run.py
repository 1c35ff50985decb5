"""Run a stage or a pipeline in memory.

A stage: fetch the dimensions that it reads, leave out withheld points, store those that it writes. A pipeline: one
stage after the other.
"""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Optional, Union

import numpy as np

from .cloud.cloud import Cloud, create_cloud
from .cloud.dimensions import DIMENSIONS
from .cloud.merging import in_one_crs, merge_records
from .geometry.grid import plan_box
from .memory import return_freed
from .pipeline import CLOUD, REFERENCE, REPORT, Pipeline, Step
from .sampling.cloud_sampling import CloudSampling, without_noise
from .stage import (
    DIMENSION,
    REFERENCE_PREFIX,
    SAMPLING,
    VALUES,
    FileContent,
    LayerFeatures,
    Monitor,
    RasterSurface,
    Report,
    Stage,
    StageResults,
    given_layers,
)
from .stages import STAGES
from .threads import one_blas_thread

# For each cloud the mask of points that stages may see, None where it is all of them.
_Masks = list[Optional[np.ndarray]]


@dataclass
class Outcome:
    """The results of a stage: the cloud with its new dimensions, its layers, rasters and files by name, its report.

    ``selected`` are the positions, int64 (m,), that the points of the cloud had in the one given; None where all stay.
    """

    cloud: Optional[Cloud]
    layers: dict[str, LayerFeatures] = field(default_factory=dict)
    report: Optional[Report] = None
    rasters: dict[str, RasterSurface] = field(default_factory=dict)
    files: dict[str, FileContent] = field(default_factory=dict)
    selected: Optional[np.ndarray] = None


def run_stage(
    stage: Stage,
    cloud: Union[Cloud, Sequence[Cloud], None] = None,
    reference: Optional[Cloud] = None,
    monitor: Optional[Monitor] = None,
    input_layers: Optional[dict[str, Optional[LayerFeatures]]] = None,
    sampling: Optional[CloudSampling] = None,
    **tunables: Any,
) -> Outcome:
    """Run ``stage`` and return its results.

    ``cloud`` is several clouds for a stage that merges. Their coordinates are then relative to the zero of the map,
    about which the stage may turn them; afterwards they and the merged cloud get the origin of the first.
    A cloud is changed in place: the dimensions that the stage writes are stored in it. Withheld
    points are not shown to the stage; in its result they keep their classification and are
    undefined in everything else. A stage that selects or merges makes a new cloud instead,
    without withheld points. Coordinates of ``input_layers`` and of layers and rasters made are
    meters relative to the cloud's origin.

    ``sampling`` is how the cloud was sampled, or the survey that it is a part of. Where it is not given, it is
    measured on the points of the cloud that are neither withheld nor noise, and logged.

    Parameters
    ----------
    stage : Stage
        The stage.
    cloud : Cloud or sequence of Cloud, optional
        The cloud, or several for a stage that merges.
    reference : Cloud, optional
        The second cloud of a stage that reads one.
    monitor : Monitor
        Receives the progress.
    input_layers : dict of str to LayerFeatures, optional
        Layers that the stage reads, by name, in m from the origin of the cloud.
    sampling : CloudSampling, optional
        How the cloud was sampled.
    **tunables
        Tunables by name.

    Raises
    ------
    ValueError
        If a dimension or layer is missing, a tunable is out of bounds, or the stage refuses its data.
    """
    arguments: dict[str, Any] = stage.check(tunables)
    clouds = [cloud] if isinstance(cloud, Cloud) else list(cloud or ())
    monitor = monitor or Monitor()
    if stage.merges:
        clouds = in_one_crs(clouds, monitor)
    elif clouds and reference is not None:
        reference = in_one_crs([clouds[0], reference], monitor)[1]
    # Coordinates of two clouds can be compared only from one origin.
    together = [*clouds, *([reference] if reference is not None and clouds else [])]
    origin = clouds[0].origin if clouds else np.zeros(3)
    _see_from(np.zeros(3) if stage.merges else origin, together)
    used = [_used(one) for one in clouds]
    arrays = [_argument(stage, name, clouds, reference, used, arguments) for name in (*stage.reads, *stage.optional)]
    layers = given_layers(stage.name, stage.input_layers, input_layers or {})
    own = sampling_of(clouds[0]) if stage.samples and clouds and sampling is None else None
    if stage.samples:
        arguments[SAMPLING] = sampling or own
    with one_blas_thread():
        made = stage.unpack(stage.function(*arrays, **layers, **arguments, monitor=monitor))
    _log(own, monitor)
    if made.selected is not None and used[0] is not None:
        made = replace(made, selected=np.flatnonzero(used[0])[made.selected])
    result = _result(stage, clouds, used, made, monitor)
    if stage.merges and result is not None:
        _see_from(origin, [*together, result])
    return Outcome(result, made.layers, made.report, made.rasters, made.files, made.selected)


def sampling_of(cloud: Cloud, corner: Optional[np.ndarray] = None) -> CloudSampling:
    """Return the sampling of the points of a cloud that are neither withheld nor noise now.

    Cells begin at the ``corner`` (2,), m; None is the cloud's.
    """
    used = counted(cloud)
    corner = _corner(cloud) if corner is None else corner
    single = not has_several_returns(cloud)
    return CloudSampling(lambda: cloud.get("xyz").compress(used, axis=0), single, corner, has_colors(cloud))


def _corner(cloud: Cloud) -> np.ndarray:
    """Return the least easting and northing (2,) of the points of a cloud that are not withheld, m."""
    withheld, xyz = cloud.withheld, cloud.get("xyz")
    return plan_box(xyz if withheld.all() else xyz[~withheld])[0]


def has_several_returns(cloud: Cloud) -> bool:
    """Whether a pulse of a cloud is known to have more than one return."""
    return cloud.has("number_of_returns") and int(cloud.get("number_of_returns").max(initial=0)) > 1


def has_colors(cloud: Cloud) -> bool:
    """Whether points of a cloud are known to have colors."""
    return cloud.has("red") and bool(cloud.get("red").any())


def counted(cloud: Cloud) -> np.ndarray:
    """Return the mask of points (n,) on which the sampling of a cloud is measured."""
    used = ~cloud.withheld
    used[used] = without_noise(cloud.get("classification")[used])
    return used


def _log(sampling: Optional[CloudSampling], monitor: Monitor) -> None:
    """Report the measurements of a sampling to the monitor, if there are any."""
    if sampling is not None and sampling.measured:
        monitor.resolved(sampling=sampling)


class _RunSampling:
    """How the points that a pipeline works on were sampled: given, or measured again where a step changed them.

    Parameters
    ----------
    given : mapping of str to CloudSampling
        The sampling of ``cloud`` by the name "", and of clouds that steps make by the names of the steps. Each
        applies until the next one, or until a step makes a cloud of other points.
    cloud : Cloud or several, optional
        The input of the pipeline.
    monitor : Monitor
        Receives the measurements.
    """

    def __init__(self, given: Mapping[str, CloudSampling], cloud: Any, monitor: Monitor) -> None:
        self.monitor = monitor
        self.own: Optional[CloudSampling] = None
        self._all = given
        self.given = given.get("") if isinstance(cloud, Cloud) else None
        self.points = cloud.points if isinstance(cloud, Cloud) else None
        self.counted: Optional[np.ndarray] = None
        # Held, so that steps share the coordinates: decoding them takes as long as a small step.
        self.xyz: Optional[np.ndarray] = None
        # Cells of all steps begin at the corner of the input, also where a step removes the points there.
        self.corner = _corner(cloud) if isinstance(cloud, Cloud) and self.given is None else None

    def after(self, step: Step, cloud: Any) -> None:
        """Take the sampling that is given for the result of a step, if one is."""
        if step.name in self._all and isinstance(cloud, Cloud):
            self.given, self.points = self._all[step.name], cloud.points

    def of(self, cloud: Cloud) -> CloudSampling:
        """Return the sampling of a cloud, the same as for the step before if it has the same points that count."""
        is_same, self.xyz = cloud.points is self.points, cloud.get("xyz")
        if is_same and self.given is not None:
            return self.given
        used = counted(cloud)
        if self.own is None or not is_same or not np.array_equal(used, self.counted):
            _log(self.own, self.monitor)
            self.own = sampling_of(cloud, self.corner)
            self.given, self.points, self.counted = None, cloud.points, used
        return self.own


def _see_from(origin: np.ndarray, clouds: list[Cloud]) -> None:
    for cloud in clouds:
        cloud.origin = origin


def _used(cloud: Cloud) -> Optional[np.ndarray]:
    """Return the mask of points that stages may see, None when it is all of them."""
    withheld = cloud.withheld
    if withheld.all():
        raise ValueError(
            f"All {len(withheld)} points are marked as withheld, so none may be used; choose another cloud."
        )
    return ~withheld if withheld.any() else None


def _argument(
    stage: Stage, name: str, clouds: list[Cloud], reference: Optional[Cloud], used: _Masks, tunables: dict[str, Any]
) -> Any:
    """Return the array that a positional argument names, or one per cloud; None where an optional one is absent."""
    if name.startswith(REFERENCE_PREFIX):
        dimension = name[len(REFERENCE_PREFIX) :]
        if reference is None or (name in stage.optional and not reference.has(dimension)):
            return None
        values, shown = _present(reference, dimension), _used(reference)
        return values if shown is None else values[shown]
    if name == VALUES:
        if name in stage.optional and not tunables[DIMENSION]:
            return None
        arrays = [cloud.named(tunables[DIMENSION]) for cloud in clouds]
    elif name in stage.optional and not (clouds and all(cloud.has(name) for cloud in clouds)):
        return None
    else:
        arrays = [_present(cloud, name) for cloud in clouds]
    arrays = [array if points is None else array[points] for array, points in zip(arrays, used)]
    if stage.merges:
        return arrays
    return arrays[0] if arrays else None


def _present(cloud: Cloud, name: str) -> np.ndarray:
    """Return a dimension, or say which stage writes it."""
    if not cloud.has(name):
        writers = [stage.title for stage in STAGES.values() if name in stage.writes]
        if writers:
            raise ValueError(f"The cloud has no {DIMENSIONS[name].disk[0]} dimension; run '{writers[0]}' first.")
    return cloud.get(name)


def _result(stage: Stage, clouds: list[Cloud], used: _Masks, made: StageResults, monitor: Monitor) -> Optional[Cloud]:
    """Return the cloud with the results of the stage: the same one, or a new one."""
    written = {name: values for name, values in made.dimensions.items() if values is not None}
    if stage.creates:
        return create_cloud(written)
    if not clouds:
        return None
    left_out = sum(int((~points).sum()) for points in used if points is not None)
    if left_out and (stage.merges or stage.selects):
        monitor.inform(f"{left_out:,} withheld points are left out.")
    if stage.merges:
        seen = [cloud if points is None else cloud.take(np.flatnonzero(points)) for cloud, points in zip(clouds, used)]
        cloud, points = merge_records(seen, written.pop("xyz", None), monitor), None
    elif stage.selects:
        cloud, points = _selected(stage, clouds[0], made.selected), None
    else:
        cloud, points = clouds[0], used[0]
    _warn_of_foreign(cloud, written, monitor)
    _clear(cloud, written, monitor)
    for name, values in written.items():
        cloud.set(name, _of_all_points(cloud, name, values, points))
    return cloud


def _warn_of_foreign(cloud: Cloud, written: Collection[str], monitor: Monitor) -> None:
    """Warn of dimensions that another program stored under names of this one, and that are written over or cleared."""
    lost = [one for one in DIMENSIONS.values() if one.name in written or one.of in written]
    names = [name for one in lost for name in cloud.foreign(one.name)]
    if names:
        monitor.warn(
            f"The cloud had {', '.join(names)} of another program; the new cloud has this program's values there. "
            "The input keeps the others."
        )


def _clear(cloud: Cloud, written: Collection[str], monitor: Monitor) -> None:
    """Clear the dimensions that describe numbers which are written anew, but are not written themselves."""
    stale = [one for one in DIMENSIONS.values() if one.of in written and one.name not in written]
    known = [one for one in stale if cloud.has(one.name) and not _is_undefined(cloud.get(one.name))]
    for one in known:
        cloud.set(one.name, np.full(len(cloud), one.undefined, one.dtype))
    if known:
        names = ", ".join(one.disk[0] for one in known)
        numbers = ", ".join(sorted({DIMENSIONS[one.of].disk[0] for one in known}))
        monitor.inform(f"Cleared {names}, as earlier runs left it: {numbers} is numbered anew.")


def _is_undefined(values: np.ndarray) -> bool:
    """Whether no point has a value."""
    return bool((np.isnan(values) if values.dtype.kind == "f" else values == 0).all())


def _selected(stage: Stage, cloud: Cloud, selected: Optional[np.ndarray]) -> Cloud:
    """Return a cloud of the points that the stage chose."""
    chosen = np.asarray(selected)
    if not len(chosen):
        raise ValueError(f"{stage.title} leaves none of the points; choose wider limits.")
    return cloud.take(chosen)


def _of_all_points(cloud: Cloud, name: str, values: np.ndarray, used: Optional[np.ndarray]) -> np.ndarray:
    """Return ``values`` of the points used as values of all points."""
    dtype = DIMENSIONS[name].dtype
    if used is None:
        return values.astype(dtype, copy=False)
    if cloud.has(name) and DIMENSIONS[name].standard:
        whole = cloud.get(name).copy()
    else:
        whole = np.full((len(cloud), *values.shape[1:]), DIMENSIONS[name].undefined, dtype)
    whole[used] = values
    return whole


@dataclass
class Results(Outcome):
    """The results of a chain: last cloud; layers, rasters, files, reports and kept clouds by the composite's names."""

    clouds: dict[str, Cloud] = field(default_factory=dict)
    reports: dict[str, Report] = field(default_factory=dict)


def run_pipeline(
    pipeline: Pipeline,
    cloud: Union[Cloud, Sequence[Cloud], None] = None,
    monitor: Optional[Monitor] = None,
    input_layers: Optional[dict[str, Optional[LayerFeatures]]] = None,
    wanted: Optional[Collection[str]] = None,
    samplings: Optional[Mapping[str, CloudSampling]] = None,
    reference: Optional[Cloud] = None,
    **tunables: Any,
) -> Results:
    """Run the steps on ``cloud``, changing it as the steps do, and return their results.

    ``cloud`` is several clouds where the pipeline merges. ``input_layers`` are the layers that the pipeline
    is given, by name, in meters relative to the cloud's origin. Steps that no ``wanted`` output depends on are not run,
    nor steps that compare with a layer that is not given. Further outputs of the steps run are among the results.
    ``tunables`` are named ``<step>_<tunable>`` (``ground_cell_size``), and so are the monitor's values; what steps
    share is named ``<tunable>``.

    How the cloud was sampled is measured once for all steps, and again where a step has changed the points that it is
    measured on: those that are neither withheld nor noise. ``samplings`` are measured before, on the survey that the
    cloud is a part of: of the given cloud by the name "", of clouds that steps make by the steps' names.
    ``reference`` is the second cloud of a pipeline with a step that reads one.

    Parameters
    ----------
    pipeline : Pipeline
        The composite.
    cloud : Cloud or sequence of Cloud, optional
        The cloud, or several where the pipeline merges.
    monitor : Monitor
        Receives the progress.
    input_layers : dict of str to LayerFeatures, optional
        Layers by name, in m from the origin of the cloud.
    wanted : collection of str, optional
        Names of the outputs to make, see :attr:`.Pipeline.outputs`; None is all of them.
    samplings : mapping of str to CloudSampling, optional
        Samplings that were measured before, by step.
    reference : Cloud, optional
        The second cloud of a pipeline with a step that reads one.
    **tunables
        Tunables by name.

    Raises
    ------
    ValueError
        If a tunable or layer is unknown, a layer or the second cloud is missing, or a step refuses its data.
    """
    if pipeline.needs_reference and reference is None:
        raise ValueError(f"{pipeline.title} reads a second point cloud (reference); give one.")
    monitor = monitor or Monitor()
    chosen = {step.name: of_step for step, of_step in pipeline.by_step(tunables)}
    given = given_layers(pipeline.name, pipeline.input_layers.values(), input_layers or {})
    names = [output.name for output in pipeline.outputs] if wanted is None else wanted
    there = [name for name, one in {**given, REFERENCE: reference}.items() if one is not None]
    steps = pipeline.steps_for(names, there)
    # Later steps change the cloud that they work on: a cloud that is kept as it was is copied when it is made.
    clouds = [output for output in pipeline.outputs if output.of == CLOUD != output.name]
    kept = {one.step.name for one in clouds if one.name in names} | {step.cloud for step in steps}
    copies: dict[str, Cloud] = {}
    outcomes: dict[str, Outcome] = {}
    current = cloud
    of_run = _RunSampling(samplings or {}, cloud, monitor)
    done = np.cumsum([step.stage.cost for step in steps])
    # Of the last of the same sums: from Python 3.12 on, another one may be smaller by a rounding.
    ends = done / done[-1:]
    for step, start, end in zip(steps, [0.0, *ends], ends):
        part = monitor.step(step.name, step.stage, chosen[step.name], float(start), float(end))
        part.progress(0.0)
        layers = {one.name: _layer(step, one.name, outcomes, given) for one in step.stage.input_layers}
        works_on = copies[step.cloud].copy() if step.cloud else current if step.stage.reads_cloud else None
        sampled = of_run.of(works_on) if step.stage.samples and isinstance(works_on, Cloud) else None
        second = reference if step.stage.reads_reference else None
        outcome = run_stage(step.stage, works_on, second, part, layers, sampled, **chosen[step.name])
        return_freed()
        outcomes[step.name] = replace(outcome, cloud=None)
        if step.stage.makes_cloud:
            current = outcome.cloud
            of_run.after(step, current)
            if step.name in kept and outcome.cloud is not None:
                copies[step.name] = outcome.cloud.copy()
    _log(of_run.own, monitor)
    results = Results(current if isinstance(current, Cloud) else None, selected=_selected_by_all(outcomes.values()))
    _add_results(results, pipeline, outcomes, copies)
    return results


def _selected_by_all(outcomes: Iterable[Outcome]) -> Optional[np.ndarray]:
    """Return the positions (m,) in the first cloud of the points that all steps, one after the other, have left."""
    left: Optional[np.ndarray] = None
    for outcome in outcomes:
        if outcome.selected is not None:
            left = outcome.selected if left is None else left[outcome.selected]
    return left


def _layer(
    step: Step, input_layer: str, outcomes: dict[str, Outcome], given: dict[str, Optional[LayerFeatures]]
) -> Optional[LayerFeatures]:
    """Return the layer for an input layer of a step: one of an earlier step, or the given one."""
    if input_layer not in step.layers:
        return given[input_layer]
    earlier, layer = step.layers[input_layer].split(".")
    return outcomes[earlier].layers[layer]


def _add_results(results: Results, pipeline: Pipeline, outcomes: dict[str, Outcome], copies: dict[str, Cloud]) -> None:
    """Add what the steps have made, and the clouds that are kept, by the names of the composite."""
    for output in pipeline.outputs:
        outcome = outcomes.get(output.step.name, Outcome(None))
        if output.of in outcome.layers:
            results.layers[output.name] = outcome.layers[output.of]
        elif output.of in outcome.rasters:
            results.rasters[output.name] = outcome.rasters[output.of]
        elif output.of in outcome.files:
            results.files[output.name] = outcome.files[output.of]
        elif output.of == REPORT and outcome.report is not None:
            results.report = results.reports[output.name] = outcome.report
        elif output.name != CLOUD and output.step.name in copies:
            results.clouds[output.name] = copies[output.step.name]
