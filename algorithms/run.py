"""Run a stage on a cloud: fetch what it reads, leave out withheld points, store what it writes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Optional

import numpy as np

from .cloud.cloud import Cloud, create_cloud
from .cloud.dimensions import DIMENSIONS
from .stage import REFERENCE_PREFIX, Features, Monitor, Report, Stage
from .stages import STAGES


@dataclass
class Outcome:
    """What a stage made: the cloud with its new dimensions, its layers by name, its report."""

    cloud: Optional[Cloud]
    layers: dict[str, Features] = field(default_factory=dict)
    report: Optional[Report] = None


def run_stage(
    stage: Stage,
    cloud: Optional[Cloud] = None,
    reference: Optional[Cloud] = None,
    monitor: Optional[Monitor] = None,
    **tunables: Any,
) -> Outcome:
    """Run ``stage`` and return what it made.

    ``cloud`` is changed in place: the dimensions that the stage writes are stored
    in it. Withheld points are not shown to the stage; in its result they keep
    their classification and are undefined in everything else. Coordinates of layers come back in
    metres relative to the cloud's origin, as the stage gave them.

    Raises
    ------
    ValueError
        If a dimension is missing, a tunable is out of bounds, or the stage refuses its data.
    """
    arguments: dict[str, Any] = stage.check(tunables)
    if cloud is not None and reference is not None:
        # Coordinates of two clouds can be compared only from one origin.
        reference.origin = cloud.origin
    used = None if cloud is None or not cloud.withheld.any() else ~cloud.withheld
    if used is not None and not used.any():
        raise ValueError(f"All {len(used)} points are marked as withheld, so none may be used; choose another cloud.")
    made = stage.function(*_dimensions(stage, cloud, reference, used), **arguments, monitor=monitor or Monitor())
    results = list(made) if isinstance(made, tuple) else [made]
    if stage.creates:
        cloud = create_cloud({name: results.pop(0) for name in stage.creates})
    for name in stage.writes:
        values = results.pop(0)
        if values is not None and cloud is not None:
            cloud.set(name, _whole(cloud, name, values, used))
    layers = {layer.name: results.pop(0) for layer in stage.layers}
    return Outcome(cloud, layers, results.pop(0) if stage.measures else None)


def _dimensions(stage: Stage, cloud: Optional[Cloud], reference: Optional[Cloud], used: Optional[np.ndarray]) -> list:
    """Return the arrays that the stage's positional arguments name; None where an optional one is absent."""
    arrays: list[Optional[np.ndarray]] = []
    for name in (*stage.reads, *stage.optional):
        of_reference = name.startswith(REFERENCE_PREFIX)
        source = reference if of_reference else cloud
        dimension = name[len(REFERENCE_PREFIX) :] if of_reference else name
        if source is None or (name in stage.optional and not source.has(dimension)):
            arrays.append(None)
            continue
        values = _present(source, dimension)
        arrays.append(values if of_reference or used is None else values[used])
    return arrays


def _present(cloud: Cloud, name: str) -> np.ndarray:
    """Return a dimension, or say which stage writes it."""
    writers = [stage.title for stage in STAGES.values() if name in stage.writes]
    if writers and not cloud.has(name):
        raise ValueError(f"The cloud has no {DIMENSIONS[name].disk[0]} dimension; run '{writers[0]}' first.")
    return cloud.get(name)


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
