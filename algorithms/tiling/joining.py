"""Join the results of blocks: segments that continue in the next block, features that several blocks found, files.

Rasters and text files are never whole in memory; rasters have no seams.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any, Callable, Optional

import numpy as np

from ..geometry.grid import find_cells
from ..geometry.groups import components, placed
from ..pipeline import Pipeline
from ..stage import FileContent, FileItem, Layer, LayerFeatures, Monitor
from .block_result import BlockResult
from .blocks import NUMBERED, Block, feature_boxes, take_features
from .same_features import leaders
from .tiled_steps import files_of, layers_of

# Fields with the number of a feature in its layer, and with the number of the cluster that it outlines.
_ID, _CLUSTER = "id", "cluster_id"

# The numbers of a block without any.
_NO_NUMBERS = np.zeros(0, np.int64)

# Returns the records inside and outside the edges of a block, by the position of the block.
Edges = Callable[[int], tuple[dict[str, np.ndarray], dict[str, np.ndarray]]]


def join_numbers(
    blocks: list[Block], results: list[BlockResult], edges: Edges, features: dict[str, list[np.ndarray]]
) -> list[dict[str, np.ndarray]]:
    """Return for each block and numbered dimension what its numbers become: an array that they are positions in.

    Segments of two blocks are one if they have a record in common that lies just outside one of the blocks: both
    worked on it, and each gave it the number of its own segment. Numbers go from 1 without gaps, in the order of the
    blocks; 0 stays 0, and a number that no point of any block has becomes 0.

    Parameters
    ----------
    blocks : list of Block
        Squares of one lattice.
    results : list of BlockResult
        Results of the blocks; their edges are read by ``edges`` only.
    edges : callable
        As ``edges`` of :class:`.BlockResult`. Memory: a few blocks at a time.
    features : dict of str to list of ndarray
        For each dimension by which points refer to features the numbers of these in each block; they become 0, since
        features are recognized as the same by their geometry.
    """
    joined: list[dict[str, np.ndarray]] = [{} for _ in results]
    links = _links(blocks, edges)
    for name in NUMBERED:
        of_features = features.get(name, [_NO_NUMBERS] * len(results))
        most = [max(_largest(one, name), int(own.max(initial=0))) for one, own in zip(results, of_features)]
        first = np.concatenate([[0], np.cumsum(most)])
        found = [np.zeros((0, 2), np.int64)]
        found += [pairs + [first[one] - 1, first[other] - 1] for one, other, of, pairs in links if of == name]
        ends = np.concatenate(found)
        is_feature = np.zeros(int(first[-1]), bool)
        for start, own in zip(first, of_features):
            is_feature[start + own - 1] = True
        one_end, other_end = ends[~is_feature[ends].any(axis=1)].T
        _, group = components(one_end, other_end, int(first[-1]))
        parts = [start + one.used[name] - 1 for one, start in zip(results, first) if name in one.used]
        used = np.concatenate([_NO_NUMBERS, *parts])
        # Numbers in the order of the blocks, as in one cloud they follow its points.
        distinct, at = np.unique(group[used[~is_feature[used]]], return_index=True)
        final = placed(np.arange(1, len(at) + 1, dtype=np.int32), distinct[np.argsort(at)], len(group) + 1)
        for become, start, count in zip(joined, first, most):
            become[name] = np.concatenate([np.zeros(1, np.int32), final[group[start : start + count]]])
    return joined


def feature_numbers(pipeline: Pipeline, results: list[BlockResult]) -> dict[str, list[np.ndarray]]:
    """Return for each dimension by which points refer to features the numbers (k,) that these have in each block."""
    found: dict[str, list[np.ndarray]] = {}
    for name, layer in layers_of(pipeline).items():
        if layer.numbers:
            before = found.get(layer.numbers, [_NO_NUMBERS] * len(results))
            own = [one.layers[name].columns[_ID] if name in one.layers else _NO_NUMBERS for one in results]
            found[layer.numbers] = [np.union1d(one, np.asarray(ids, np.int64)) for one, ids in zip(before, own)]
    return found


def refer_to_features(numbers: list[dict[str, np.ndarray]], name: str, known: dict[tuple[int, int], int]) -> None:
    """Give the points of features, in place, the numbers that these have now; other segments' numbers follow.

    Parameters
    ----------
    numbers : list of dict
        From :func:`join_numbers`.
    name : str
        The dimension.
    known : dict of (int, int) to int
        Numbers of features by the position of the block and their number in it, from :func:`join_features`.
    """
    count = max(known.values(), default=0)
    for of_block in numbers:
        of_block[name] = np.where(of_block[name] > 0, of_block[name] + count, 0).astype(np.int32)
    for (block, number), now in known.items():
        numbers[block][name][number] = now


def _largest(result: BlockResult, name: str) -> int:
    """Return the largest number that a block gave: in it, just outside, or to a feature whose box reaches into it."""
    parts = [kind[name] for kind in (result.used, result.most) if name in kind]
    parts += [np.asarray(layer.columns[name], np.int64) for layer in result.layers.values() if name in layer.columns]
    return int(max((part.max(initial=0) for part in parts), default=0))


def _links(blocks: list[Block], edges: Edges) -> list[tuple[int, int, str, np.ndarray]]:
    """Return for pairs of neighboring blocks and each dimension which numbers (k, 2) of the two are one segment."""
    position = {(block.column, block.row): at for at, block in enumerate(blocks)}
    # Kept in memory: a block, its four neighbors, and some that it shares with the block before.
    read = lru_cache(8)(edges)
    found = []
    for (column, row), one in position.items():
        # The neighbors that come after it in the order of the blocks.
        for east, north in ((1, 0), (-1, 1), (0, 1), (1, 1)):
            other = position.get((column + east, row + north))
            if other is None:
                continue
            (inside_one, beside_one), (inside_other, beside_other) = read(one), read(other)
            for name in inside_one.keys() & inside_other.keys():
                ways = [_same_records(beside_one[name], inside_other[name])]
                ways.append(_same_records(beside_other[name], inside_one[name])[:, ::-1])
                pairs = np.unique(np.concatenate(ways), axis=0)
                if len(pairs):
                    found.append((one, other, name, pairs))
    return found


def _same_records(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return the numbers (k, 2) that records in both have, by file, position in it and number (n, 3) and (m, 3)."""
    other = other[np.argsort(_record_keys(other[:, 0], other[:, 1]))]
    at, is_there = find_cells(_record_keys(other[:, 0], other[:, 1]), _record_keys(one[:, 0], one[:, 1]))
    return np.column_stack([one[is_there, 2], other[at[is_there], 2]])


def _record_keys(source: np.ndarray, position: np.ndarray) -> np.ndarray:
    """Return one number for each record: files have far fewer than 2^40 records."""
    return (source.astype(np.int64) << 40) | position.astype(np.int64)


@dataclass
class References:
    """How points refer to features by a dimension: features have the numbers of their points."""

    counts: list[dict[int, int]]  #: For each block the number of its points with each number there
    #: What numbers of features are now, by the position of the block and the number in it
    known: dict[tuple[int, int], int] = field(default_factory=dict)

    @classmethod
    def of(cls, results: list[BlockResult], name: str) -> References:
        """Return the objects that points of blocks refer to by a dimension, before any number is known."""
        kinds = [(one.used.get(name, _NO_NUMBERS), one.counts.get(name, _NO_NUMBERS)) for one in results]
        return cls([dict(zip(used.tolist(), counts.tolist())) for used, counts in kinds])


def join_features(
    blocks: list[Block],
    layers: list[LayerFeatures],
    numbers: list[np.ndarray],
    origin: np.ndarray,
    monitor: Monitor,
    declared: Layer,
    references: Optional[References] = None,
    pieces: Optional[list[np.ndarray]] = None,
) -> tuple[LayerFeatures, np.ndarray]:
    """Return the features of all blocks, each once, numbered from north-west to south-east, and which they were.

    Parameters
    ----------
    blocks : list of Block
        Where they were found.
    layers : list of LayerFeatures
        Of one layer, in meters from ``origin``; those that cross an edge were found by several blocks.
    numbers : list of ndarray
        What the cluster numbers of each block become.
    origin : ndarray of shape (3,)
        Of the survey, m.
    monitor : Monitor
        Receives progress.
    declared : Layer
        How the stage declares them.
    references : References, optional
        Where points refer to the features. A feature that has a number from another layer keeps it; the others get
        the numbers after these, which are added to ``known``.
    pieces : list of ndarray, optional
        Where pieces can be put together, which of the features of each block may have been cut off.

    Returns
    -------
    features : LayerFeatures
        The features of the survey.
    kept : ndarray of shape (m, 3), int64
        For each of them its position among ``blocks``, its number in that block, and its number now.
    """
    features = _all(layers, numbers)
    if not len(features):
        return features, np.zeros((0, 3), np.int64)
    of_block = np.repeat(np.arange(len(blocks)), [len(layer) for layer in layers])
    boxes = feature_boxes(features, declared.radius)
    middle = boxes.mean(axis=1) + origin[:2]
    own = np.array([block.box for block in blocks])[of_block]
    is_own = ((middle >= own[:, 0]) & (middle < own[:, 1])).all(axis=1)
    is_piece = np.concatenate(pieces) if declared.whole and pieces is not None else None
    leader = leaders(features, declared, of_block, is_own, is_piece, monitor)
    own_id = np.asarray(features.columns.get(_ID, np.zeros(len(features))), np.int64)
    references = references or References([])
    keys = list(zip(of_block.tolist(), own_id.tolist()))
    called = _called(keys, leader, boxes, references.known)
    rows = np.flatnonzero(called)
    rows = rows[np.argsort(called[rows])]
    if declared.whole and is_piece is not None:
        leader = np.where(is_piece[leader], leader, np.arange(len(leader)))
        _put_together(features, declared.whole, leader, [references.counts[block].get(one, 0) for block, one in keys])
    return _numbered(features, rows, called[rows]), np.column_stack([of_block[rows], own_id[rows], called[rows]])


def _put_together(
    features: LayerFeatures, whole: Callable[[LayerFeatures, int], LayerFeatures], leader: np.ndarray, counts: list[int]
) -> None:
    """Replace, in place, each feature that stays for several pieces by the whole put together of these."""
    points = np.bincount(leader, counts, len(leader)).astype(np.int64)
    order = np.argsort(leader, kind="stable")
    for group in np.split(order, np.flatnonzero(np.diff(leader[order])) + 1):
        if len(group) > 1:
            row = int(leader[group[0]])
            best_first = np.concatenate([[row], group[group != row]])
            one = whole(take_features(features, best_first), int(points[row]))
            features.geometries[row] = one.geometries[0]
            for name, values in one.columns.items():
                features.columns[name][row] = values[0]


def _called(
    keys: list[tuple[int, int]], leader: np.ndarray, boxes: np.ndarray, known: dict[tuple[int, int], int]
) -> np.ndarray:
    """Return the number of each feature (n,) that stays, 0 for the others; add the numbers of all to the known ones."""
    stays = np.flatnonzero(leader == np.arange(len(leader)))
    called = np.zeros(len(leader), np.int64)
    called[stays] = [known.get(keys[row], 0) for row in stays]
    # Features that another layer took for one: the first of them stays.
    again = np.setdiff1d(stays[called[stays] > 0], stays[np.unique(called[stays], return_index=True)[1]])
    new = stays[called[stays] == 0]
    new = new[np.lexsort([boxes[new, 0, 0], -boxes[new, 1, 1]])]
    called[new] = max(known.values(), default=0) + np.arange(1, len(new) + 1)
    for row, one in enumerate(leader.tolist()):
        if one >= 0:
            known.setdefault(keys[row], int(called[one]))
    called[again] = 0
    return called


def join_owned(layers: list[LayerFeatures], numbers: list[np.ndarray], column: str, kept: np.ndarray) -> LayerFeatures:
    """Return the features of all blocks that belong to features that stay, with the numbers that these have now.

    Parameters
    ----------
    layers : list of LayerFeatures
        Of one layer.
    numbers : list of ndarray
        What the cluster numbers of each block become.
    column : str
        The field with the number of the object that a feature belongs to.
    kept : ndarray of shape (m, 3), int64
        From :func:`join_features` of the other layer.
    """
    features = _all(layers, numbers)
    if not len(features):
        return features
    of_block = np.repeat(np.arange(len(layers)), [len(layer) for layer in layers])
    becomes = new_names(kept)
    owner = features.columns[column]
    now = np.array([becomes.get((block, str(one)), 0) for block, one in zip(of_block.tolist(), owner)], np.int64)
    rows = np.flatnonzero(now)
    rows = rows[np.argsort(now[rows], kind="stable")]
    joined = _numbered(features, rows, np.arange(1, len(rows) + 1))
    joined.columns[column] = [type(owner[0])(number) for number in now[rows].tolist()]
    return joined


def new_names(kept: np.ndarray) -> dict[tuple[int, str], int]:
    """Return the present numbers of features, by their block and their number there, of ``kept`` (m, 3)."""
    return {(block, str(one)): number for block, one, number in kept.tolist()}


def _numbered(features: LayerFeatures, rows: np.ndarray, called: np.ndarray) -> LayerFeatures:
    """Return some features by their positions (m,), with their numbers (m,) now."""
    some = take_features(features, rows)
    if _ID in some.columns:
        some.columns[_ID] = called.tolist()
    return some


def _all(layers: list[LayerFeatures], numbers: list[np.ndarray]) -> LayerFeatures:
    """Return the features of all blocks together, with the numbers that their clusters have in the end."""
    geometries = [geometry for layer in layers for geometry in layer.geometries]
    columns: dict[str, Any] = {}
    for layer, becomes in zip(layers, numbers):
        for name, values in layer.columns.items():
            final = [int(becomes[value]) for value in values] if name == _CLUSTER and len(becomes) else list(values)
            columns.setdefault(name, []).extend(final)
    return LayerFeatures(geometries, columns)


@dataclass(frozen=True)
class RasterMosaic:
    """A raster in parts, each in the file of its block."""

    name: str  #: The composite's output
    #: west, north: Outer edges, m from the survey's origin
    west: float
    north: float
    cell_size: float  #: Side of a cell, m
    shape: tuple[int, int]  #: Rows and columns
    #: For each part the file, and the row and the column of its north-western cell
    parts: tuple[tuple[Path, int, int], ...]

    def __iter__(self) -> Iterator[tuple[int, int, np.ndarray]]:
        """Yield the row and the column of the north-western cell of each part, and its cells.

        They are float32, the northern ones first, NaN where there is nothing.
        """
        for path, row, column in self.parts:
            yield row, column, BlockResult.raster(path, self.name)


def join_rasters(paths: list[Path], found: list[BlockResult]) -> list[RasterMosaic]:
    """Return each raster of a survey from what blocks made of it.

    Parameters
    ----------
    paths : list of Path
        The files of the blocks.
    found : list of BlockResult
        Their contents; the cells themselves are left there.
    """
    mosaics = []
    for name in dict.fromkeys(name for one in found for name in one.lattices):
        lattices = np.array([one.lattices[name] if name in one.lattices else np.zeros(5) for one in found])
        has = np.flatnonzero((lattices[:, 2:4] > 0).all(axis=1))
        if not len(has):
            continue
        south, west, rows, columns, size = lattices[has].T
        top, left = (south + rows).max(), west.min()
        at = np.column_stack([top - south - rows, west - left]).astype(int).tolist()
        shape = int(top - south.min()), int((west + columns).max() - left)
        parts = tuple((paths[one], *where) for one, where in zip(has, at))
        mosaics.append(RasterMosaic(name, float(left * size[0]), float(top * size[0]), float(size[0]), shape, parts))
    return mosaics


def join_files(
    pipeline: Pipeline,
    steps: Collection[str],
    results: list[Path],
    kept: dict[str, np.ndarray],
    layers: dict[str, LayerFeatures],
) -> dict[str, FileContent]:
    """Return the text files of a composite, by its names: each item once, block by block.

    Parameters
    ----------
    pipeline : Pipeline
        The composite.
    steps : collection of str
        Names of its steps that were run.
    results : list of Path
        Files of :meth:`.BlockResult.write`, which stay until the text is written.
    kept : dict of str to ndarray of shape (m, 3), int64
        Of each layer, from :func:`.join_features`: of the features that stay their position among ``results``, their
        number in that block, and their number in the survey.
    layers : dict of str to LayerFeatures
        All layers of the survey, joined.
    """
    made = [output.name for output in pipeline.outputs if output.step.name in steps]
    return {
        name: FileContent(_Items(results, file.item, new_names(kept[of]), layers.get(file.also)), file.write)
        for name, (file, of) in files_of(pipeline).items()
        if name in made and of in kept
    }


@dataclass(frozen=True)
class _Items(Collection):
    """The items of a text file under the names of the survey, one block in memory at a time.

    ``becomes`` are the numbers in the survey by block and name there; items without one are left out.
    The features of ``also`` are items, too.
    """

    results: list[Path]
    item: type[FileItem]
    becomes: dict[tuple[int, str], int]
    also: Optional[LayerFeatures]

    def __iter__(self) -> Iterator[Any]:
        for block, path in enumerate(self.results):
            for name, record in BlockResult.items_of(path, self.item.__name__):
                if (block, name) in self.becomes:
                    yield self.item.of_record(record, str(self.becomes[block, name]))
        if self.also:
            yield from self.item.of_features(self.also)

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def __contains__(self, item: object) -> bool:
        return any(item == one for one in self)
