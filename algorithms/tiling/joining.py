"""What blocks found each for itself, as one: segments that go on in the next block, features that several found."""

from __future__ import annotations

from functools import lru_cache
from typing import Any, Callable

import numpy as np

from ..geometry.grid import find_cells
from ..geometry.groups import components
from ..geometry.polygon_overlap import as_polygons, meeting_boxes, shared_areas
from ..stage import LayerFeatures, Monitor
from .blocks import NUMBERED, Block, BlockResult, feature_boxes

# Two features of different blocks are the same one if they share more than this part of the smaller one.
_SAME = 0.5

# The neighbors of a block that come after it, by columns and rows, and of how many blocks the edges stay in memory.
_FORWARD = ((1, 0), (-1, 1), (0, 1), (1, 1))
_EDGES_KEPT = 8

# The number of a feature in its layer, and what numbers the cluster that it is the outline of.
_ID, _CLUSTER = "id", "cluster_id"


# What gives the records inside and beside the edges of a block, by its position.
Edges = Callable[[int], tuple[dict[str, np.ndarray], dict[str, np.ndarray]]]


def join_numbers(blocks: list[Block], results: list[BlockResult], edges: Edges) -> list[dict[str, np.ndarray]]:
    """Return for each block and numbered dimension what its numbers become: an array that they are positions in.

    A segment of one block and a segment of another are one if a record just outside the first block has the number of
    the first there and of the second in its own block. Numbers go from 1 without gaps, in the order of the blocks;
    0 stays 0, and a number that no point of any block has becomes 0.

    Parameters
    ----------
    blocks : list of Block
        Squares of one lattice.
    results : list of BlockResult
        What was found in them; their edges are not asked for.
    edges : callable
        As ``edges`` of :class:`.BlockResult`. Memory: those of a few blocks at a time.
    """
    joined: list[dict[str, np.ndarray]] = [{} for _ in results]
    links = _links(blocks, edges)
    for name in NUMBERED:
        most = [_largest(one, name) for one in results]
        first = np.concatenate([[0], np.cumsum(most)])
        found = [np.zeros((0, 2), np.int64)]
        found += [pairs + [first[one] - 1, first[other] - 1] for one, other, of, pairs in links if of == name]
        one_end, other_end = np.concatenate(found).T
        _, group = components(one_end, other_end, int(first[-1]))
        used = [start + one.used[name] - 1 for one, start in zip(results, first) if name in one.used]
        # Numbers in the order of the blocks, as those of one cloud are in that of its points.
        distinct, at = np.unique(group[np.concatenate([np.zeros(0, np.int64), *used])], return_index=True)
        final = np.zeros(len(group) + 1, np.int32)
        final[distinct[np.argsort(at)]] = np.arange(1, len(distinct) + 1, dtype=np.int32)
        for become, start, count in zip(joined, first, most):
            become[name] = np.concatenate([np.zeros(1, np.int32), final[group[start : start + count]]])
    return joined


def _largest(result: BlockResult, name: str) -> int:
    """Return the largest number that a block gave: in it, just outside, or to a feature whose box reaches into it."""
    parts = [kind[name] for kind in (result.used, result.most) if name in kind]
    parts += [np.asarray(layer.columns[name], np.int64) for layer in result.layers.values() if name in layer.columns]
    return int(max((part.max(initial=0) for part in parts), default=0))


def _links(blocks: list[Block], edges: Edges) -> list[tuple[int, int, str, np.ndarray]]:
    """Return for pairs of neighboring blocks and each dimension which numbers (k, 2) of the two are one segment."""
    position = {(block.column, block.row): at for at, block in enumerate(blocks)}
    read = lru_cache(_EDGES_KEPT)(edges)
    found = []
    for (column, row), one in position.items():
        for east, north in _FORWARD:
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
    """Return the numbers (k, 2) that records in both have, by file, place and number (n, 3) and (m, 3)."""
    other = other[np.argsort(_record_keys(other[:, 0], other[:, 1]))]
    at, is_there = find_cells(_record_keys(other[:, 0], other[:, 1]), _record_keys(one[:, 0], one[:, 1]))
    return np.column_stack([one[is_there, 2], other[at[is_there], 2]])


def _record_keys(source: np.ndarray, position: np.ndarray) -> np.ndarray:
    """Return one number for each record: files have far fewer than 2^40 records."""
    return (source.astype(np.int64) << 40) | position.astype(np.int64)


def join_features(
    blocks: list[Block], layers: list[LayerFeatures], numbers: list[np.ndarray], origin: np.ndarray, monitor: Monitor
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

    Returns
    -------
    features : LayerFeatures
        Of the survey.
    kept : ndarray of shape (m, 2), int64
        For each of them its position among ``blocks``, and its number in that block.
    """
    features = _all(layers, numbers)
    if not len(features):
        return features, np.zeros((0, 2), np.int64)
    of_block = np.repeat(np.arange(len(blocks)), [len(layer) for layer in layers])
    boxes = feature_boxes(features)
    middle = boxes.mean(axis=1) + origin[:2]
    own = np.array([block.box for block in blocks])[of_block]
    is_own = ((middle >= own[:, 0]) & (middle < own[:, 1])).all(axis=1)
    is_polygon = isinstance(features.geometries[0], list)
    is_kept = _once(features, of_block, is_own, monitor) if is_polygon else is_own
    rows = np.flatnonzero(is_kept)
    rows = rows[np.lexsort([boxes[rows, 0, 0], -boxes[rows, 1, 1]])]
    own_id = np.asarray(features.columns.get(_ID, np.zeros(len(features))), np.int64)[rows]
    return _numbered(features, rows), np.column_stack([of_block[rows], own_id])


def join_belonging(
    layers: list[LayerFeatures], numbers: list[np.ndarray], column: str, kept: np.ndarray
) -> LayerFeatures:
    """Return the features of all blocks that belong to features that stay, with the numbers that these have now.

    Parameters
    ----------
    layers : list of LayerFeatures
        Of one layer.
    numbers : list of ndarray
        What the cluster numbers of each block become.
    column : str
        The field that tells what a feature belongs to.
    kept : ndarray of shape (m, 2), int64
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
    joined = _numbered(features, rows)
    joined.columns[column] = [type(owner[0])(number) for number in now[rows].tolist()]
    return joined


def new_names(kept: np.ndarray) -> dict[tuple[int, str], int]:
    """Return what features are called now by their block and what they were called there, of ``kept`` (m, 2)."""
    return {(block, str(one)): number for number, (block, one) in enumerate(kept.tolist(), 1)}


def _numbered(features: LayerFeatures, rows: np.ndarray) -> LayerFeatures:
    """Return some features by their positions (m,), numbered anew."""
    columns = {name: [values[row] for row in rows] for name, values in features.columns.items()}
    if _ID in columns:
        columns[_ID] = list(range(1, len(rows) + 1))
    return LayerFeatures([features.geometries[row] for row in rows], columns)


def _all(layers: list[LayerFeatures], numbers: list[np.ndarray]) -> LayerFeatures:
    """Return the features of all blocks together, with the numbers that their clusters have in the end."""
    geometries = [geometry for layer in layers for geometry in layer.geometries]
    columns: dict[str, Any] = {}
    for layer, becomes in zip(layers, numbers):
        for name, values in layer.columns.items():
            final = [int(becomes[value]) for value in values] if name == _CLUSTER and len(becomes) else list(values)
            columns.setdefault(name, []).extend(final)
    return LayerFeatures(geometries, columns)


def _once(features: LayerFeatures, of_block: np.ndarray, is_own: np.ndarray, monitor: Monitor) -> np.ndarray:
    """Return which polygons (n,) stay where several blocks have found the same one.

    That of the block that its middle lies in stays; where none or several claim it, the largest.
    """
    polygons = as_polygons(features.geometries)
    area = np.abs(polygons.area)
    one, other = meeting_boxes(polygons.box, polygons.box)
    of_two = of_block[one] != of_block[other]
    one, other = one[of_two], other[of_two]
    shared = shared_areas(polygons, polygons, one, other, monitor)
    is_same = shared > _SAME * np.minimum(area[one], area[other])
    one, other = one[is_same], other[is_same]
    # Best first: the own block's, then the largest; a polygon stays if none that is better stays beside it.
    rank = np.empty(len(area), np.int64)
    rank[np.lexsort([np.arange(len(area)), -area, ~is_own])] = np.arange(len(area))
    is_kept = np.ones(len(area), bool)
    order = np.argsort(rank[one], kind="stable")
    for better, worse in zip(one[order], other[order]):
        if rank[better] < rank[worse] and is_kept[better]:
            is_kept[worse] = False
    return is_kept
