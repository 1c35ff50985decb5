"""Shapes of neighborhoods, without lists of their points.

A k-d tree finds the neighbors of one point after the other and sorts them. A covariance needs sums over them alone.
So points that lie side by side, a block, share a list of candidates. All squared distances between the two are one
matrix product, and the sums over the candidates that are near enough are another.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Callable

import numpy as np

from ..packages import spatial
from ..threads import NEIGHBORS_AT_ONCE

# Order of the six numbers of a symmetric matrix: xx, yy, zz, xy, xz, yz.
PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))

# Candidates of a block (times those that it needs on a plane): 95 % of the points find all their neighbors among these.
_SPARE = 1.3

# A covariance about the middle of a block loses the digits by which the spread is smaller than the second moment there.
_LEAST_SPREAD = 1e-3

# Tries for a distance that parts a point's neighbors from the others.
_TRIES = 9

# Share of the points of a chunk that are sorted when no others are left: that takes less time than another try.
_FEW = 0.06

# The first try (times the squared reach of the block's middle): no ratio of squared distances on a grid.
_FIRST_TRY = 1.0371

# Squared distances that differ by less than this share are equal: coordinates of 5,000 km are right to a nanometer.
EQUAL_SQUARES = 1e-7

# Squared distances in 32 bits that differ by less than this share are equal: each is off by up to 6e-8 of itself.
_EQUAL_ROUNDED = 5e-7

# Points of a chunk whose neighbors within a radius are counted, to choose the size of its blocks.
_SAMPLE = 200

# Blocks are worked on together whose numbers of candidates differ by this factor at most.
_ALIKE = 0.8

# Most squared distances of a block: with ten multiplications each, up to 2^18 in all, OpenBLAS uses one thread.
_PRODUCT = 26_000

# Returns the number of candidates that blocks need, for their middles (b, 3), the reach (b,) of their points, and the
# points of a block.
_Candidates = Callable[[np.ndarray, np.ndarray, int], np.ndarray]


@dataclass
class Shapes:
    """Sums over the neighborhoods of m points."""

    covariances: np.ndarray  #: (m, 6): xx, yy, zz, xy, xz, yz (m²), divided by the number of points
    counts: np.ndarray  #: (m,): points of each neighborhood, the point itself among them
    #: height_range, plan_radius, (m,): highest less lowest elevation, and the largest horizontal distance from the
    #: point (m); empty unless asked for
    height_range: np.ndarray = field(default_factory=lambda: np.empty(0))
    plan_radius: np.ndarray = field(default_factory=lambda: np.empty(0))


@dataclass
class Batch:
    """Some blocks, in coordinates (m) from the middle of each."""

    #: (b, s): which points each block holds; of smaller blocks among larger ones the last point several times
    rows: np.ndarray
    own: np.ndarray  #: (b, s, 3): positions of these points
    others: np.ndarray  #: (3, b, c): the candidates
    distances: np.ndarray  #: (b, c): distances of the candidates from the middle, ascending

    @cached_property
    def own_squares(self) -> np.ndarray:
        """Squared distances (b, s) of the points from the middle."""
        return np.einsum("ijk,ijk->ij", self.own, self.own)

    @cached_property
    def squares(self) -> np.ndarray:
        """Squared distances (b, s, c) between points and candidates."""
        left = np.empty((*self.rows.shape, 5))
        left[..., 0], left[..., 1] = self.own_squares, 1
        np.multiply(self.own, -2, out=left[..., 2:])
        right = np.empty((5, *self.distances.shape))
        right[0] = 1
        np.einsum("ijk,ijk->jk", self.others, self.others, out=right[1])
        right[2:] = self.others
        return left @ right.transpose(1, 0, 2)


def nearest_shapes(columns: np.ndarray, tree: Any, rows: np.ndarray, count: int, extents: bool) -> Shapes:
    """Return the shapes of the ``count`` points nearest to each of some points.

    Parameters
    ----------
    columns : ndarray of shape (3, n), float64
        Coordinates (m).
    tree : scipy.spatial.cKDTree
        Tree of the points.
    rows : ndarray of shape (m,)
        The points whose neighborhoods are wanted; fastest where they lie together.
    count : int
        Points of a neighborhood, the point itself among them; at most n.
    extents : bool
        Whether height range and plan radius are wanted too.

    Notes
    -----
    Where several points are equally far and not all of them belong, they share the rest: each counts in part, the
    same for all, so that their order in the cloud decides nothing. So it is for all that are among the
    1.3 (sqrt(count) + 1)² nearest; of even more at one distance (a sphere of points around another) some are left out.
    """

    def candidates(centers: np.ndarray, radii: np.ndarray, size: int) -> np.ndarray:
        # A circle that holds ``count`` points, widened by one that holds ``size``.
        return np.full(len(centers), reach_of_ties(count, size))

    def weigh(batch: Batch) -> tuple[np.ndarray, np.ndarray]:
        limits, weights = _nearest(batch.squares, count, _FIRST_TRY * batch.distances[:, count - 1] ** 2)
        if batch.distances.shape[1] == columns.shape[1]:
            return weights, np.full(limits.shape, True)
        # Others as far as the last candidate may have been left out.
        return weights, np.sqrt(limits) + np.sqrt(batch.own_squares) < (1 - EQUAL_SQUARES) * batch.distances[:, -1:]

    return _shapes(columns, tree, rows, min(count, _size(count)), candidates, weigh, extents)


def reach_of_ties(count: int, size: int = 1) -> int:
    """Return the number of points around a block of ``size`` that hold the ``count`` nearest of each, ties included."""
    return int(_SPARE * (np.sqrt(count) + np.sqrt(size)) ** 2)


def shapes_within(columns: np.ndarray, tree: Any, rows: np.ndarray, radius: float, extents: bool) -> Shapes:
    """Return the shapes of all points at most ``radius`` (m) from each of some points; see :func:`nearest_shapes`.

    Parameters
    ----------
    columns : ndarray of shape (3, n)
        Coordinates of the points, m.
    tree : cKDTree
        Tree of the points.
    rows : ndarray of shape (m,), int64
        Points that are asked for.
    radius : float
        Radius, m.
    extents : bool
        Whether height range and plan radius are wanted too.
    """
    sample = columns[:, rows[:: max(1, len(rows) // _SAMPLE)]].T
    mean = tree.query_ball_point(sample, radius, return_length=True).mean()

    def candidates(centers: np.ndarray, radii: np.ndarray, size: int) -> np.ndarray:
        return tree.query_ball_point(centers, radii + radius * (1 + EQUAL_SQUARES), return_length=True)

    def weigh(batch: Batch) -> tuple[np.ndarray, np.ndarray]:
        weights = (batch.squares <= radius**2 * (1 + EQUAL_SQUARES)).astype(np.float64)
        return weights, np.full(batch.rows.shape, True)

    return _shapes(columns, tree, rows, _size(mean), candidates, weigh, extents)


def _size(count: float) -> int:
    """Return the points of the largest block whose products with its candidates are not worth two threads of BLAS."""
    root = np.sqrt(count)
    return int(max((np.sqrt(root**2 + 4 * np.sqrt(_PRODUCT / _SPARE)) - root) / 2, 1) ** 2)


def _shapes(
    columns: np.ndarray,
    tree: Any,
    rows: np.ndarray,
    size: int,
    candidates: _Candidates,
    weigh: Callable[[Batch], tuple[np.ndarray, np.ndarray]],
    extents: bool,
) -> Shapes:
    """Return the shapes of the neighborhoods of ``rows`` (m,), from blocks of at most ``size`` of them.

    The result of ``weigh`` is the weight (b, s, c) of each candidate in a neighborhood, and which (b, s) have all.
    """
    made = Shapes(np.empty((len(rows), 6)), np.empty(len(rows), np.int64), *np.empty((2, len(rows) * extents)))
    remaining, points = np.arange(len(rows)), columns[:, rows].T
    # Points at a block's corner may have neighbors beyond its candidates: those are done each by itself.
    for block_size in (size, 1):
        sure = np.empty(len(remaining), bool)
        for batch in _batches(columns, tree, points[remaining], block_size, candidates):
            weights, complete = weigh(batch)
            counts, covariances, precise = _covariances(batch.others, weights)
            sure[batch.rows] = complete & precise
            at = remaining[batch.rows]
            made.covariances[at], made.counts[at] = covariances, np.rint(counts)
            if extents:
                made.height_range[at], made.plan_radius[at] = _extents(batch, weights)
        remaining = remaining[~sure]
        if not len(remaining):
            break
    return made


def _batches(columns: np.ndarray, tree: Any, points: np.ndarray, size: int, candidates: _Candidates) -> Iterator[Batch]:
    """Yield ``points`` (m, 3) in blocks of at most ``size``, several with alike numbers of points and candidates."""
    order, starts = _leaves(points, size)
    points, sizes = points[order], np.diff(starts, append=len(points))
    low, high = np.minimum.reduceat(points, starts), np.maximum.reduceat(points, starts)
    centers, radii = (low + high) / 2, np.sqrt(((high - low) ** 2).sum(axis=1)) / 2
    wanted = np.minimum(candidates(centers, radii, size), columns.shape[1])
    by_wanted, first = np.lexsort((-sizes, -wanted)), 0
    while first < len(by_wanted):
        most = wanted[by_wanted[first]]
        alike = by_wanted[first : first + max(1, NEIGHBORS_AT_ONCE // most)]
        alike = alike[wanted[alike] >= _ALIKE * most]
        first += len(alike)
        # All searches first: what comes between would drive the tree out of the caches.
        distances, found = (made.reshape(len(alike), most) for made in tree.query(centers[alike], k=most))
        step = max(1, NEIGHBORS_AT_ONCE // (most * sizes[alike].max()))
        for part in (slice(start, start + step) for start in range(0, len(alike), step)):
            blocks = alike[part]
            slots = starts[blocks, None] + np.minimum(np.arange(sizes[blocks].max()), sizes[blocks, None] - 1)
            others = np.take(columns, found[part], axis=1)
            others -= centers[blocks].T[:, :, None]
            yield Batch(order[slots], points[slots] - centers[blocks, None], others, distances[part])


def _leaves(points: np.ndarray, size: int) -> tuple[np.ndarray, np.ndarray]:
    """Return an order of ``points`` (m, 3) in which those side by side follow, and where in it each block begins."""
    if size == 1:
        return np.arange(len(points)), np.arange(len(points))
    tree = spatial.cKDTree(points, leafsize=size, balanced_tree=False)
    starts, nodes = [], [tree.tree]
    while nodes:
        node = nodes.pop()
        if node.split_dim < 0:
            starts.append(node.start_idx)
        else:
            nodes += (node.greater, node.lesser)
    return tree.indices, np.array(starts)


def _nearest(squares: np.ndarray, count: int, guess: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the reach, squared, (b, s) of the ``count`` smallest ``squares`` (b, s, c), and the weight of each."""
    flat = squares.reshape(-1, squares.shape[2])
    # Rounding keeps the order: what parts the rounded squares parts the others, and is looked for in half the memory.
    rounded = flat.astype(np.float32)
    limits = _limits(rounded, count, np.repeat(guess, squares.shape[1]))
    # Slightly more: a limit between equal distances would separate equal points.
    inside = rounded <= (limits * (1 + _EQUAL_ROUNDED))[:, None]
    weights = inside.astype(np.float64)
    undecided = (_counts(inside) != count).nonzero()[0]
    if len(undecided):
        rest = flat[undecided]
        last = np.maximum(np.partition(rest, count - 1, axis=1)[:, count - 1 : count], 0)
        below = rest < last * (1 - EQUAL_SQUARES)
        equal = (rest <= last * (1 + EQUAL_SQUARES)) & ~below
        share = (count - below.sum(axis=1)) / np.maximum(equal.sum(axis=1), 1)
        weights[undecided] = below + equal * share[:, None]
        limits[undecided] = last[:, 0]
    return limits.reshape(squares.shape[:2]), weights.reshape(squares.shape)


def _limits(squares: np.ndarray, count: int, guess: np.ndarray) -> np.ndarray:
    """Return a number (r,) for each row of ``squares`` (r, c) that ``count`` of them don't exceed; for a few any other.

    On surfaces the number of points within a distance grows with its square. So a few tries between one that is too
    short and one that is too long are enough, and each is much cheaper than to sort.
    """
    limits, rows = np.empty(len(squares), np.float32), np.arange(len(squares))
    ends, counts = np.zeros((2, 2, len(squares)), np.float32)
    ends[1], counts[1] = 4 * guess, 4 * count
    few = _FEW * len(squares)
    for _ in range(_TRIES):
        limit = ends[0] + (ends[1] - ends[0]) * ((count - counts[0]) / (counts[1] - counts[0]))
        inside = _counts(squares <= limit[:, None])
        limits[rows] = limit
        # A limit that fits becomes the lower end and stays it.
        end = (inside > count).view(np.int8), np.arange(len(rows))
        ends[end], counts[end] = limit, inside
        unfit = (inside != count).nonzero()[0]
        # Copying the rest pays off only when many are done.
        if len(unfit) < 0.7 * len(rows):
            rows, squares, ends, counts = rows[unfit], squares[unfit], ends[:, unfit], counts[:, unfit]
        if len(unfit) <= few:
            break
    return limits


def _counts(inside: np.ndarray) -> np.ndarray:
    """Return the number of true values of each row (r, c), c < 65,536."""
    return np.add.reduce(inside.view(np.uint8), axis=1, dtype=np.uint16)


def _covariances(others: np.ndarray, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the sums of ``weights`` (b, s, c), the covariances of ``others`` (3, b, c), and which are precise."""
    terms = np.empty((10, *others.shape[1:]))
    terms[0], terms[1:4] = 1, others
    for i, (a, b) in enumerate(PAIRS, start=4):
        np.multiply(others[a], others[b], out=terms[i])
    sums = weights @ terms.transpose(1, 2, 0)
    counts = sums[..., 0]
    moments = sums[..., 1:] / counts[..., None]
    covariances = moments[..., 3:].copy()
    for i, (a, b) in enumerate(PAIRS):
        covariances[..., i] -= moments[..., a] * moments[..., b]
    spread, second = (values[..., :3].sum(axis=-1) for values in (covariances, moments[..., 3:]))
    return counts, covariances, spread > _LEAST_SPREAD * second


def _extents(batch: Batch, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return height range and plan radius (b, s) of the candidates that have weight (b, s, c)."""
    inside = weights > 0
    x, y, z = batch.others[:, :, None]
    low, high = z.min(axis=-1), z.max(axis=-1)
    above, below = ((off * inside).max(axis=-1) for off in (z - low[..., None], high[..., None] - z))
    plan = (x - batch.own[..., :1]) ** 2 + (y - batch.own[..., 1:2]) ** 2
    return above + below - (high - low), np.sqrt((plan * inside).max(axis=-1))
