"""Attributes of the features that stages make, as files hold them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, Union

import numpy as np

from .inputs_outputs import Field, Layer, LayerFeatures


def all_fields(layer: Layer, features: LayerFeatures) -> list[Field]:
    """Return the fields of a layer, and of other columns that its features have: attributes of a map."""
    names = {declared.name for declared in layer.fields}
    others = [Field(name, _type_of(column), "") for name, column in features.columns.items() if name not in names]
    return [*layer.fields, *others]


def _type_of(column: Sequence) -> type:
    """Return the type of all values of a column, float for numbers of both types, text where they differ otherwise."""
    types = {type(value) for value in column if value is not None}
    return bool if types == {bool} else next((kind for kind in (int, float) if types and types <= {int, kind}), str)


def column_on_map(
    declared: Field, features: LayerFeatures, to_map: Callable[[np.ndarray], np.ndarray]
) -> Union[Sequence, np.ndarray]:
    """Return the values of a field, positions in map coordinates.

    ``to_map`` turns local meters (n, 2) into these.
    """
    column = features.columns[declared.name]
    if declared.type is str:
        return [None if value is None else str(value) for value in column]
    if declared.axis is None:
        return column
    positions = np.zeros((len(column), 2))
    positions[:, declared.axis] = column
    return to_map(positions)[:, declared.axis]


def plain(value: Any) -> Any:
    """Return a value, a numpy scalar as Python's own, None for NaN and infinity."""
    value = value.item() if isinstance(value, np.generic) else value
    return None if isinstance(value, float) and not math.isfinite(value) else value


def as_column(values: list) -> Any:
    """Return an attribute's values: int64, or float64 with NaN for null, or what they are."""
    kinds = {type(value) for value in values}
    if kinds == {int}:
        return np.array(values, np.int64)
    if kinds & {int, float} and kinds <= {int, float, type(None)}:
        return np.array([np.nan if value is None else value for value in values], float)
    return values
