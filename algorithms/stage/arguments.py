"""The arrays that a stage is called with: refused, in the same words for every stage, where they don't fit."""

from collections.abc import Iterable
from typing import Any

import numpy as np

# Positional arguments that begin so are of the second cloud of a comparison.
REFERENCE_PREFIX = "reference_"


def check_arrays(arguments: dict[str, Any], names: Iterable[str], merges: bool, title: str) -> None:
    """Make arrays of the arguments that are dimensions, in place; refuse what doesn't belong together.

    Parameters
    ----------
    arguments : dict
        What a stage was called with, by name.
    names : iterable of str
        Those that are dimensions; None and absent ones are passed over.
    merges : bool
        Whether each is a list with one array per cloud.
    title : str
        What the stage is called.

    Raises
    ------
    ValueError
        If arrays are of different lengths, coordinates of another shape or not finite, or clouds empty or too few.
    """
    lengths: dict[str, tuple[str, int]] = {}
    for name in names:
        if arguments.get(name) is None:
            continue
        if merges:
            arrays = arguments[name] = [np.asarray(array) for array in arguments[name]]
            if not arrays:
                raise ValueError(f"{title} needs a point cloud, got none; add one.")
            clouds = [f"point cloud {i}" for i in range(1, len(arrays) + 1)]
        else:
            arguments[name] = np.asarray(arguments[name])
            arrays = [arguments[name]]
            clouds = ["reference cloud" if name.startswith(REFERENCE_PREFIX) else "point cloud"]
        for cloud, array in zip(clouds, arrays):
            _check_array(name, array, cloud, lengths)


def _check_array(name: str, array: np.ndarray, cloud: str, lengths: dict[str, tuple[str, int]]) -> None:
    if name.endswith("xyz"):
        _check_coordinates(name, array)
    first, length = lengths.setdefault(cloud, (name, len(array)))
    if len(array) != length:
        raise ValueError(f"{name} has {len(array)} values, {first} has {length}; they must be of the same points.")
    if length == 0:
        raise ValueError(f"The {cloud} has no points; choose another.")


def _check_coordinates(name: str, array: np.ndarray) -> None:
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name} must be of shape (n, 3), got {array.shape}.")
    if array.dtype.kind == "f" and not np.isfinite(array).all():
        n_not_finite = int((~np.isfinite(array).all(axis=1)).sum())
        raise ValueError(
            f"{n_not_finite} of {len(array)} points have coordinates that are not finite; remove them first."
        )
