"""Match features of different blocks that are the same one."""

from typing import Any, Optional

import numpy as np

from ..criteria import DEVIATIONS, MAJORITY
from ..geometry.groups import components, placed
from ..geometry.polygon_overlap import as_polygons, meeting_boxes, shared_areas
from ..geometry.polygons import area_vector, axes_across
from ..stage import Layer, LayerFeatures, Monitor
from .blocks import feature_boxes

# Largest distance between axes or centers that are the same one, and largest difference of their radii (of the smaller
# radius). Shapes of the same points differ by less, and pipes in insulation or next to each other by more.
_OFF = 0.2

# The size (n,) of each feature, and what pairs (k,) of them share of it.
_Sizes = tuple[np.ndarray, np.ndarray]


def leaders(
    features: LayerFeatures, layer: Layer, of_block: np.ndarray, is_own: np.ndarray, is_piece: Any, monitor: Monitor
) -> np.ndarray:
    """Return for each feature (n,) the one that stays in its place, itself where it stays; -1 where none does.

    Of features of different blocks that are the same one, the one stays in whose block its middle lies; where none
    or several claim it, the largest. Pieces of one feature give way to it where a block has seen all of it; else the
    largest piece stays for all. Lines and points of which no radius is known stay where their middle lies.

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
    is_piece : ndarray of shape (n,), bool, or None
        Which may have been cut off, where pieces can be put together.
    monitor : Monitor
        Receives progress.
    """
    if layer.geometry != "Polygon" and not layer.radius:
        return np.where(is_own, np.arange(len(features)), -1)
    boxes = feature_boxes(features, layer.radius)
    if layer.deviation:
        boxes += _tolerance(features, layer)[:, None, None] * [[-1], [1]]
    one, other = meeting_boxes(boxes, boxes)
    of_two = (of_block[one] != of_block[other]) & (one < other)
    one, other = one[of_two], other[of_two]
    size, shared = _sizes(features, layer, one, other, monitor)
    share = shared / np.maximum(np.minimum(size[one], size[other]), 1e-12)
    is_same = share > MAJORITY
    if is_piece is None:
        return _led(one[is_same], other[is_same], share[is_same], _ranks(size, is_own))
    are_pieces = is_piece[one] & is_piece[other]
    is_same &= ~are_pieces
    leader = _led(one[is_same], other[is_same], share[is_same], _ranks(size, is_own, is_piece))
    stays = leader == np.arange(len(leader))
    # Pieces of one feature overlap around the edge between their blocks by a tenth of the smaller one, or 1 m or m².
    # Features that merely touch do not.
    meet = are_pieces & stays[one] & stays[other] & ((share > 0.1) | (shared > 1.0))
    largest = _largest(size, components(one[meet], other[meet], len(size))[1])
    return np.where(stays, largest, leader)


def _sizes(features: LayerFeatures, layer: Layer, one: np.ndarray, other: np.ndarray, monitor: Monitor) -> _Sizes:
    """Return the size (n,) of each feature (m², m, or 1), and what pairs (k,) share of it."""
    if layer.geometry == "Point":
        return np.ones(len(features)), _same_spheres(features, layer, one, other).astype(float)
    if layer.geometry == "LineString":
        return _shared_lines(features, layer, one, other)
    if layer.deviation:
        return _shared_area(features, layer, one, other, monitor)
    polygons = as_polygons(features.geometries)
    return np.abs(polygons.area), shared_areas(polygons, polygons, one, other, monitor)


def _ranks(size: np.ndarray, is_own: np.ndarray, is_piece: Optional[np.ndarray] = None) -> np.ndarray:
    """Return the rank (n,) of each feature, 0 for the best: no pieces, of the own block, then the largest."""
    is_piece = np.zeros(len(size), bool) if is_piece is None else is_piece
    every = np.arange(len(size))
    return placed(every, np.lexsort([every, -size, ~is_own, is_piece]), len(size))


def _led(one: np.ndarray, other: np.ndarray, share: np.ndarray, rank: np.ndarray) -> np.ndarray:
    """Return for each feature the one that stays in its place, of pairs (k,) that are the same.

    One stays if none that is better stays next to it; another one gives way to that with which it shares most.
    """
    is_better = rank[one] < rank[other]
    better, worse = np.where(is_better, one, other), np.where(is_better, other, one)
    leader = np.arange(len(rank))
    most = np.zeros(len(rank))
    for at in np.argsort(rank[better], kind="stable"):
        if leader[better[at]] == better[at] and share[at] > most[worse[at]]:
            leader[worse[at]], most[worse[at]] = better[at], share[at]
    return leader


def _largest(size: np.ndarray, group: np.ndarray) -> np.ndarray:
    """Return for each feature (n,) the largest of its group."""
    best = np.lexsort([np.arange(len(size)), -size, group])
    first = best[np.unique(group[best], return_index=True)[1]]
    return first[group]


def _same_spheres(features: LayerFeatures, layer: Layer, one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return of which pairs (k,) centers and radii agree."""
    center, radius = np.reshape(features.geometries, (-1, 3)), _radius(features, layer)
    near = _OFF * np.minimum(radius[one], radius[other])
    off = np.linalg.norm(center[one] - center[other], axis=1)
    return (off < near) & (np.abs(radius[one] - radius[other]) < near)


def _shared_lines(features: LayerFeatures, layer: Layer, one: np.ndarray, other: np.ndarray) -> _Sizes:
    """Return the length (n,) of each axis, and the length that pairs (k,) share of one axis with one radius (m)."""
    start, end = np.moveaxis(np.reshape([line[[0, -1]] for line in features.geometries], (-1, 2, 3)), 1, 0)
    length, radius = np.linalg.norm(end - start, axis=1), _radius(features, layer)
    is_longer = length[one] >= length[other]
    long, short = np.where(is_longer, one, other), np.where(is_longer, other, one)
    way = (end[long] - start[long]) / np.maximum(length[long], 1e-12)[:, None]
    positions = np.stack([start[short] - start[long], end[short] - start[long]], axis=1)
    along = np.einsum("kej,kj->ke", positions, way)
    shared = np.minimum(along.max(axis=1), length[long]) - np.maximum(along.min(axis=1), 0.0)
    # Compare positions only where both axes extend: an extrapolated axis is less precise.
    step = np.diff(along, axis=1)[:, 0]
    near = _OFF * np.minimum(radius[one], radius[other])
    is_one = np.abs(radius[one] - radius[other]) < near
    for low_or_high in (np.maximum(along.min(axis=1), 0.0), np.minimum(along.max(axis=1), length[long])):
        part = np.clip((low_or_high - along[:, 0]) / np.where(step == 0, 1.0, step), 0.0, 1.0)
        position = positions[:, 0] + part[:, None] * (positions[:, 1] - positions[:, 0])
        is_one &= np.linalg.norm(position - low_or_high[:, None] * way, axis=1) < near
    return length, np.where(is_one, np.maximum(shared, 0.0), 0.0)


def _radius(features: LayerFeatures, layer: Layer) -> np.ndarray:
    return np.asarray(features.columns[layer.radius], float)


def _shared_area(features: LayerFeatures, layer: Layer, one: np.ndarray, other: np.ndarray, monitor: Monitor) -> _Sizes:
    """Return the area (n,) of each plane in space, and the area that pairs (k,) share in one plane (m²), 0 in two."""
    area, normal = _areas(features.geometries)
    tolerance = _tolerance(features, layer)
    is_larger = area[one] >= area[other]
    large, small = np.where(is_larger, one, other), np.where(is_larger, other, one)
    off = np.array([_off(features.geometries[i], normal[i], features.geometries[j]) for i, j in zip(large, small)])
    in_plane = np.flatnonzero(off <= np.maximum(tolerance[one], tolerance[other]))
    flat: list[list] = [[], []]
    for pair in in_plane:
        axes, start = np.stack(axes_across(normal[large[pair]])), features.geometries[large[pair]][0][0]
        for side, feature in zip(flat, (large[pair], small[pair])):
            side.append([(ring - start) @ axes.T for ring in features.geometries[feature]])
    shared = np.zeros(len(one))
    pairs = np.arange(len(in_plane))
    shared[in_plane] = shared_areas(as_polygons(flat[0]), as_polygons(flat[1]), pairs, pairs, monitor)
    return area, shared


def _tolerance(features: LayerFeatures, layer: Layer) -> np.ndarray:
    """Return the distances (n,), m, within which another plane is the same as a feature's."""
    # 5 mm where its points have no noise.
    return DEVIATIONS * np.asarray(features.columns[layer.deviation], float) + 0.005


def _areas(geometries: list) -> tuple[np.ndarray, np.ndarray]:
    """Return the area (n,), m², and the unit normal (n, 3) of polygons in space, from their rings."""
    vector = np.array([sum(map(area_vector, rings)) for rings in geometries]).reshape(-1, 3)
    length = np.linalg.norm(vector, axis=1)
    return length, vector / np.maximum(length, 1e-12)[:, None]


def _off(rings: list, normal: np.ndarray, others: list) -> float:
    """Return the distance (root mean square, m) of the corners of a polygon from the plane of another one."""
    corners = others[0][:-1] - rings[0][:-1].mean(axis=0)
    return float(np.sqrt(np.mean((corners @ normal) ** 2)))
