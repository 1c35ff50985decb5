"""Run a stage on a cloud: fetch what it reads, leave out withheld points, store what it writes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Optional, Union

import numpy as np

from .cloud.cloud import Cloud, create_cloud
from .cloud.dimensions import DIMENSIONS
from .cloud.merging import merge_records
from .stage import DIMENSION, REFERENCE_PREFIX, VALUES, Features, Made, Monitor, Report, Stage, Surface, given_layers
from .stages import STAGES


@dataclass
class Outcome:
    """What a stage made: the cloud with its new dimensions, its layers and rasters by name, its report."""

    cloud: Optional[Cloud]
    layers: dict[str, Features] = field(default_factory=dict)
    report: Optional[Report] = None
    rasters: dict[str, Surface] = field(default_factory=dict)


def run_stage(
    stage: Stage,
    cloud: Union[Cloud, Sequence[Cloud], None] = None,
    reference: Optional[Cloud] = None,
    monitor: Optional[Monitor] = None,
    sources: Optional[dict[str, Optional[Features]]] = None,
    **tunables: Any,
) -> Outcome:
    """Run ``stage`` and return what it made.

    ``cloud`` is several clouds for a stage that merges. It sees them from the zero of the map, about which it may turn
    them; they, and the cloud that it makes, get the origin of the first.
    A cloud is changed in place: the dimensions that the stage writes are stored in it. Withheld
    points are not shown to the stage; in its result they keep their classification and are
    undefined in everything else. A stage that selects or merges makes a new cloud instead, in
    which withheld points are not. Coordinates of ``sources`` and of layers and rasters made are
    meters relative to the cloud's origin.

    Raises
    ------
    ValueError
        If a dimension or layer is missing, a tunable is out of bounds, or the stage refuses its data.
    """
    arguments: dict[str, Any] = stage.check(tunables)
    clouds = [cloud] if isinstance(cloud, Cloud) else list(cloud or ())
    # Coordinates of two clouds can be compared only from one origin.
    together = [*clouds, *([reference] if reference is not None and clouds else [])]
    origin = clouds[0].origin if clouds else np.zeros(3)
    _see_from(np.zeros(3) if stage.merges else origin, together)
    used = [_used(one) for one in clouds]
    arrays = [_argument(stage, name, clouds, reference, used, arguments) for name in (*stage.reads, *stage.optional)]
    layers = given_layers(stage.name, stage.sources, sources or {})
    monitor = monitor or Monitor()
    made = stage.sorted(stage.function(*arrays, **layers, **arguments, monitor=monitor))
    result = _result(stage, clouds, used, made, monitor)
    if stage.merges and result is not None:
        _see_from(origin, [*together, result])
    return Outcome(result, made.layers, made.report, made.rasters)


def _see_from(origin: np.ndarray, clouds: list[Cloud]) -> None:
    for cloud in clouds:
        cloud.origin = origin


def _used(cloud: Cloud) -> Optional[np.ndarray]:
    """Return which points stages may see, None when it is all of them."""
    withheld = cloud.withheld
    if withheld.all():
        raise ValueError(
            f"All {len(withheld)} points are marked as withheld, so none may be used; choose another cloud."
        )
    return ~withheld if withheld.any() else None


def _argument(
    stage: Stage,
    name: str,
    clouds: list[Cloud],
    reference: Optional[Cloud],
    used: list[Optional[np.ndarray]],
    tunables: dict[str, Any],
) -> Any:
    """Return the array that a positional argument names, or one per cloud; None where an optional one is absent."""
    if name.startswith(REFERENCE_PREFIX):
        dimension = name[len(REFERENCE_PREFIX) :]
        if reference is None or (name in stage.optional and not reference.has(dimension)):
            return None
        return _present(reference, dimension)
    if name == VALUES:
        if name in stage.optional and not tunables[DIMENSION]:
            return None
        arrays = [cloud.named(tunables[DIMENSION]) for cloud in clouds]
    elif name in stage.optional and not all(cloud.has(name) for cloud in clouds):
        return None
    else:
        arrays = [_present(cloud, name) for cloud in clouds]
    arrays = [array if points is None else array[points] for array, points in zip(arrays, used)]
    if stage.merges:
        return arrays
    return arrays[0] if arrays else None


def _present(cloud: Cloud, name: str) -> np.ndarray:
    """Return a dimension, or say which stage writes it."""
    writers = [stage.title for stage in STAGES.values() if name in stage.writes]
    if writers and not cloud.has(name):
        raise ValueError(f"The cloud has no {DIMENSIONS[name].disk[0]} dimension; run '{writers[0]}' first.")
    return cloud.get(name)


def _result(
    stage: Stage, clouds: list[Cloud], used: list[Optional[np.ndarray]], made: Made, monitor: Monitor
) -> Optional[Cloud]:
    """Return the cloud with what the stage made of it: the same one, or a new one."""
    if stage.creates:
        return create_cloud({name: values for name, values in made.dimensions.items() if values is not None})
    if not clouds:
        return None
    if stage.merges:
        seen = [cloud if points is None else cloud.take(np.flatnonzero(points)) for cloud, points in zip(clouds, used)]
        cloud, points = merge_records(seen, made.dimensions.pop("xyz", None), monitor), None
    elif stage.selects:
        cloud, points = _selected(stage, clouds[0], used[0], made.selected), None
    else:
        cloud, points = clouds[0], used[0]
    for name, values in made.dimensions.items():
        if values is not None:
            cloud.set(name, _whole(cloud, name, values, points))
    return cloud


def _selected(stage: Stage, cloud: Cloud, used: Optional[np.ndarray], selected: Optional[np.ndarray]) -> Cloud:
    """Return a cloud of the points that the stage chose of those that it saw."""
    chosen = np.asarray(selected)
    if not len(chosen):
        raise ValueError(f"{stage.title} leaves none of the points; choose wider limits.")
    return cloud.take(chosen if used is None else np.flatnonzero(used)[chosen])


def _whole(cloud: Cloud, name: str, values: np.ndarray, used: Optional[np.ndarray]) -> np.ndarray:
    """Return ``values`` of the points used as values of all points."""
    dtype = DIMENSIONS[name].dtype
    if used is None:
        return values.astype(dtype, copy=False)
    if cloud.has(name) and DIMENSIONS[name].standard:
        whole = cloud.get(name).copy()
    else:
        whole = np.full((len(cloud), *values.shape[1:]), np.nan if dtype[0] == "f" else 0, dtype)
    whole[used] = values
    return whole
