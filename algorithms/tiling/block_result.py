"""Results of a block of a survey: arrays and features in one file."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..stage import LayerFeatures
from .array_files import is_as_written, write_arrays

# Fields of a result with arrays by name, of dimensions and rasters: their sizes grow with the points or the cells of a
# block, and they are not read where all blocks are in memory.
_LARGE = ("dimensions", "inside", "beside", "rasters")

# All fields with arrays by name, of dimensions, rasters, layers, steps or values.
_KINDS = (*_LARGE, "used", "counts", "most", "lattices", "pieces", "seconds", "values")


@dataclass
class BlockResult:
    """Results of a block."""

    #: source, position, (n,): file, and position in it, of every record of the block
    source: np.ndarray
    position: np.ndarray
    #: (n,), bool: which records are left by a chain that selects; empty where all are
    stays: np.ndarray = field(default_factory=lambda: np.zeros(0, bool))
    #: dict of str to (n, ...): dimensions that the chain wrote; coordinates in meters from the zero of the map
    dimensions: dict[str, np.ndarray] = field(default_factory=dict)
    #: dict of str to (k,), int64: for each numbered dimension the numbers that records of the block have, ascending
    used: dict[str, np.ndarray] = field(default_factory=dict)
    #: dict of str to (k,), int64: for each of them how many points of the block have it
    counts: dict[str, np.ndarray] = field(default_factory=dict)
    #: dict of str to (1,), int64: for each numbered dimension the largest number in ``inside`` and ``beside``
    most: dict[str, np.ndarray] = field(default_factory=dict)
    #: inside, beside, dict of str to (m, 3), int64: for each numbered dimension file, position and number of records
    #: that lie just inside and just outside the edges
    inside: dict[str, np.ndarray] = field(default_factory=dict)
    beside: dict[str, np.ndarray] = field(default_factory=dict)
    #: dict of str to (rows, columns), float32: cells whose middles lie in the block
    rasters: dict[str, np.ndarray] = field(default_factory=dict)
    #: dict of str to (5,): for each raster its southern row, western column, rows, columns, and the side of a cell (m);
    #: rows and columns are counted from the survey's origin, northward and eastward
    lattices: dict[str, np.ndarray] = field(default_factory=dict)
    #: Features that have a part in the block, in meters from the survey's origin
    layers: dict[str, LayerFeatures] = field(default_factory=dict)
    #: dict of str to (n,), bool: by layer, for features that can be put together from pieces, whether the edge of the
    #: window may have cut them off
    pieces: dict[str, np.ndarray] = field(default_factory=dict)
    #: By class of the items of text files: name in the block and record of each item that belongs to these features
    items: dict[str, list[tuple[str, dict[str, Any]]]] = field(default_factory=dict)
    seconds: dict[str, np.ndarray] = field(default_factory=dict)  #: dict of str to (): how long each step took, s
    #: dict of str to (): values of automatic tunables, and other values that steps found, by their names in the
    #: chain
    values: dict[str, np.ndarray] = field(default_factory=dict)
    #: messages, absent: Warnings, and sentences of steps that found nothing, each once
    messages: list[str] = field(default_factory=list)
    absent: list[str] = field(default_factory=list)
    #: (k, 4): cost of each window that was tried: its widest margin around the block (m), its points, and the processor
    #: time of reading and of the chain (s)
    tries: np.ndarray = field(default_factory=lambda: np.zeros((0, 4)))

    def write(self, path: Path) -> None:
        """Write everything to a file, which is complete when it appears."""
        arrays = {"source": self.source, "position": self.position, "stays": self.stays, "tries": self.tries}
        for kind in _KINDS:
            arrays.update({f"{kind}.{name}": values for name, values in getattr(self, kind).items()})
        for name, features in self.layers.items():
            arrays.update({f"layer.{name}.{key}": values for key, values in flat(features).items()})
        arrays.update({f"items.{kind}": _text(items) for kind, items in self.items.items()})
        arrays.update({"messages": _text(self.messages), "absent": _text(self.absent)})
        write_arrays(path, arrays)

    @classmethod
    def read(cls, path: Path, with_points: bool = True) -> BlockResult:
        """Return a result as :meth:`write` wrote it, without its items; without points, also without large arrays."""
        # The file is closed here: numpy leaves it open if it can't read it.
        with path.open("rb") as file, np.load(file, allow_pickle=False) as stored:
            by_kind: dict[str, dict[str, np.ndarray]] = {kind: {} for kind in _KINDS}
            layers: dict[str, dict[str, np.ndarray]] = {}
            for key in stored.files:
                kind, _, name = key.partition(".")
                if kind == "layer":
                    layer, _, part = name.partition(".")
                    layers.setdefault(layer, {})[part] = stored[key]
                elif kind in by_kind and (with_points or kind not in _LARGE):
                    by_kind[kind][name] = stored[key]
            return cls(
                stored["source"] if with_points else np.zeros(0, np.int32),
                stored["position"] if with_points else np.zeros(0, np.int64),
                stored["stays"] if with_points else np.zeros(0, bool),
                **by_kind,
                layers={name: _features(parts) for name, parts in layers.items()},
                messages=json.loads(bytes(stored["messages"])),
                absent=json.loads(bytes(stored["absent"])),
                tries=stored["tries"],
            )

    @classmethod
    def is_complete(cls, path: Path, counts: Sequence[int]) -> bool:
        """Whether a file holds a result of :meth:`write`, of files with these numbers of points.

        One that is missing, cut off, damaged or somebody else's does not.
        """
        if not is_as_written(path):
            return False
        with np.load(path, allow_pickle=False) as stored:
            source, position = stored["source"], stored["position"]
        if source.shape != position.shape or not ((source >= 0) & (source < len(counts))).all():
            return False
        return bool(((position >= 0) & (position < np.asarray(counts, np.int64)[source])).all())

    @classmethod
    def edges(cls, path: Path) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
        """Return the records inside and beside the edges from a file of :meth:`write`."""
        with np.load(path, allow_pickle=False) as stored:
            inside, beside = (
                {key.partition(".")[2]: stored[key] for key in stored.files if key.startswith(f"{kind}.")}
                for kind in ("inside", "beside")
            )
        return inside, beside

    @classmethod
    def items_of(cls, path: Path, kind: str) -> list[tuple[str, dict[str, Any]]]:
        """Return the items of one class in a file of :meth:`write`, none where the block has no points."""
        with np.load(path, allow_pickle=False) as stored:
            return json.loads(bytes(stored[f"items.{kind}"])) if f"items.{kind}" in stored.files else []

    @classmethod
    def raster(cls, path: Path, name: str) -> np.ndarray:
        """Return the cells (rows, columns) of one raster in a file of :meth:`write`."""
        with np.load(path, allow_pickle=False) as stored:
            return stored[f"rasters.{name}"]


def flat(features: LayerFeatures) -> dict[str, np.ndarray]:
    """Return features as arrays: vertices, how many each ring has, how many rings each feature has, columns as JSON."""
    rings = [geometry if isinstance(geometry, list) else [np.asarray(geometry)] for geometry in features.geometries]
    all_rings = [ring for of_one in rings for ring in of_one]
    kind = "rings" if features.geometries and isinstance(features.geometries[0], list) else "array"
    columns = {name: np.asarray(values).tolist() for name, values in features.columns.items()}
    return {
        "vertices": np.concatenate([np.ravel(ring) for ring in all_rings]) if all_rings else np.zeros(0),
        "shapes": np.array([_shape(ring) for ring in all_rings], np.int64).reshape(-1, 3),
        "counts": np.array([len(of_one) for of_one in rings], np.int64),
        "columns": _text({"kind": kind, "values": columns}),
    }


def _shape(ring: np.ndarray) -> tuple[int, ...]:
    """Return the number of axes of vertices (m, 2 or 3) or of a point (2 or 3,), and their lengths."""
    return (2, *ring.shape) if np.ndim(ring) > 1 else (1, len(ring), 0)


def _features(parts: dict[str, np.ndarray]) -> LayerFeatures:
    """Return the features that :func:`flat` flattened."""
    described = json.loads(bytes(parts["columns"]))
    rings, start = [], 0
    for axes, rows, columns in parts["shapes"].tolist():
        size = rows * columns if axes > 1 else rows
        shape = (rows, columns) if axes > 1 else (rows,)
        rings.append(parts["vertices"][start : start + size].reshape(shape))
        start += size
    ends = np.cumsum(parts["counts"])
    grouped = [rings[end - count : end] for end, count in zip(ends, parts["counts"])]
    return LayerFeatures(grouped if described["kind"] == "rings" else [one[0] for one in grouped], described["values"])


def _text(value: Any) -> np.ndarray:
    """Return a value as JSON in bytes, uint8 (n,)."""
    return np.frombuffer(json.dumps(value).encode(), np.uint8)
