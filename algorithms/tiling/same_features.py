"""Which features of different blocks are the same one."""

from __future__ import annotations

import numpy as np

from ..geometry.polygon_overlap import as_polygons, meeting_boxes, shared_areas
from ..stage import Layer, LayerFeatures, Monitor
from .blocks import feature_boxes

# Two features of different blocks are the same one if they share more than this part of the smaller one.
_SAME = 0.5

# Largest distance between planes in space that are the same one: so many root mean square distances of their points,
# and this (m), for planes of points without noise.
_DEVIATIONS, _LEAST = 3.0, 0.005


def leaders(
    features: LayerFeatures, layer: Layer, of_block: np.ndarray, is_own: np.ndarray, monitor: Monitor
) -> np.ndarray:
    """Return for each feature (n,) the one that stays in its place, itself where it stays; -1 where none does.

    Of features of different blocks that are the same one, that of the block that its middle lies in stays; where none
    or several claim it, the largest. Of points and lines, those of the block of their middle stay.

    Parameters
    ----------
    features : LayerFeatures
        Of all blocks.
    layer : Layer
        How the stage declares them.
    of_block : ndarray of shape (n,), int
        Block of each.
    is_own : ndarray of shape (n,), bool
        Whether its middle lies in this block.
    monitor : Monitor
        Receives progress.
    """
    if layer.geometry != "Polygon":
        return np.where(is_own, np.arange(len(features)), -1)
    boxes = feature_boxes(features)
    if layer.deviation:
        boxes += _tolerance(features, layer)[:, None, None] * [[-1], [1]]
    one, other = meeting_boxes(boxes, boxes)
    of_two = (of_block[one] != of_block[other]) & (one < other)
    one, other = one[of_two], other[of_two]
    if layer.deviation:
        size, shared = _shared_in_space(features, layer, one, other, monitor)
    else:
        polygons = as_polygons(features.geometries)
        size, shared = np.abs(polygons.area), shared_areas(polygons, polygons, one, other, monitor)
    share = shared / np.maximum(np.minimum(size[one], size[other]), 1e-12)
    is_same = share > _SAME
    return _led(one[is_same], other[is_same], share[is_same], ranks(size, is_own))


def ranks(size: np.ndarray, is_own: np.ndarray) -> np.ndarray:
    """Return the rank (n,) of each feature, 0 for the best: those of the own block first, then the largest."""
    rank = np.empty(len(size), np.int64)
    rank[np.lexsort([np.arange(len(size)), -size, ~is_own])] = np.arange(len(size))
    return rank


def _led(one: np.ndarray, other: np.ndarray, share: np.ndarray, rank: np.ndarray) -> np.ndarray:
    """Return for each feature the one that stays in its place, of pairs (k,) that are the same.

    One stays if none that is better stays beside it; another one gives way to that with which it shares most.
    """
    is_better = rank[one] < rank[other]
    better, worse = np.where(is_better, one, other), np.where(is_better, other, one)
    leader = np.arange(len(rank))
    most = np.zeros(len(rank))
    for at in np.argsort(rank[better], kind="stable"):
        if leader[better[at]] == better[at] and share[at] > most[worse[at]]:
            leader[worse[at]], most[worse[at]] = better[at], share[at]
    return leader


def _shared_in_space(
    features: LayerFeatures, layer: Layer, one: np.ndarray, other: np.ndarray, monitor: Monitor
) -> tuple[np.ndarray, np.ndarray]:
    """Return the area (n,) of each plane in space, and what pairs (k,) share in one plane (m²): nothing in two."""
    area, normal = _areas(features.geometries)
    tolerance = _tolerance(features, layer)
    is_larger = area[one] >= area[other]
    large, small = np.where(is_larger, one, other), np.where(is_larger, other, one)
    off = np.array([_off(features.geometries[i], normal[i], features.geometries[j]) for i, j in zip(large, small)])
    in_plane = np.flatnonzero(off <= np.maximum(tolerance[one], tolerance[other]))
    flat: list[list] = [[], []]
    for pair in in_plane:
        axes, start = _axes(normal[large[pair]]), features.geometries[large[pair]][0][0]
        for side, feature in zip(flat, (large[pair], small[pair])):
            side.append([(ring - start) @ axes.T for ring in features.geometries[feature]])
    shared = np.zeros(len(one))
    pairs = np.arange(len(in_plane))
    shared[in_plane] = shared_areas(as_polygons(flat[0]), as_polygons(flat[1]), pairs, pairs, monitor)
    return area, shared


def _tolerance(features: LayerFeatures, layer: Layer) -> np.ndarray:
    """Return how far (n,) another plane may lie off that of a feature and be the same, m."""
    return _DEVIATIONS * np.asarray(features.columns[layer.deviation], float) + _LEAST


def _areas(geometries: list) -> tuple[np.ndarray, np.ndarray]:
    """Return the area (n,), m², and the unit normal (n, 3) of polygons in space, from their rings."""
    twice = np.zeros((len(geometries), 3))
    for row, rings in enumerate(geometries):
        for ring in rings:
            flat = ring - rings[0][0]
            twice[row] += np.cross(flat[:-1], flat[1:]).sum(axis=0)
    length = np.linalg.norm(twice, axis=1)
    return length / 2, twice / np.maximum(length, 1e-12)[:, None]


def _off(rings: list, normal: np.ndarray, others: list) -> float:
    """Return how far (root mean square, m) the corners of a polygon lie off the plane of another one."""
    corners = others[0][:-1] - rings[0][:-1].mean(axis=0)
    return float(np.sqrt(np.mean((corners @ normal) ** 2)))


def _axes(normal: np.ndarray) -> np.ndarray:
    """Return two unit vectors (2, 3) that span the plane of a normal."""
    steepest = np.eye(3)[np.argmin(np.abs(normal))]
    first = np.cross(normal, steepest)
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(normal, first)])
