"""The structure of trees: shortest paths from the roots, slices across them, branches by length and order."""

from dataclasses import dataclass

import numpy as np

from ..geometry.groups import components, placed, run_starts
from ..geometry.sparse_voxels import close_voxels, locate_voxels, neighbor_pairs, voxelize
from ..packages import csgraph, sparse, spatial
from ..stage import Monitor
from ..threads import n_threads

# Cost of a step over a gap, in multiples of its length, so that paths keep to the wood where there is some.
_GAP_PRICE = 3.0

# Thickness of a slice (voxels): thinner ones don't define a position, thicker ones hold two forks.
_SLICE = 3.0

# Distance (m) within which the root of a stem is looked for: in plan from its axis, and above breast height.
_SAME_STEM = 0.5

# A branch leads from its base to its tip without too many turns: its chord over its length. Paths through leaves and
# grass turn.
_LEAST_STRAIGHT = 0.6

# Voxels whose neighbors across gaps are listed at once: with nothing set up to 2100 each, of 40 bytes, so 84 MB.
_CHUNK = 1_000

# Rounds in which a line is smoothed: its steps are from voxel to voxel.
_SMOOTHINGS = 4

# Height (m) that a tree with a diameter of 1 m does not exceed, growing with the diameter to the power of 2/3. A column
# of green wood buckles under its own weight at 95 m: McMahon (1973), 0.79 times the cube root of 1.7e6 m, which is
# elasticity over weight. Forest spruces a hundred diameters high, of 30 cm, reach 0.7 of that; this is three quarters.
_SLENDER = 71.25

# Branches leave their stem at least this high over its root (m): lower points are grass.
_CLEAR = 0.5


@dataclass(frozen=True)
class Voxels:
    """Closed voxels of a cloud and the steps between them."""

    positions: np.ndarray  #: (m, 3): centers of the voxels (m)
    of_point: np.ndarray  #: (n,): the voxel of each point, -1 if unassigned
    #: one, other, (k,): the voxels at both ends of each step
    one: np.ndarray
    other: np.ndarray
    length: np.ndarray  #: (k,): lengths of the steps (m), gaps at their price


@dataclass(frozen=True)
class Slices:
    """Slices across stems and branches: connected voxels about as far from the root."""

    positions: np.ndarray  #: (s, 3): means of their voxels (m)
    parent: np.ndarray  #: (s,): the slice on the way to the root, before it in the order; -1 for roots
    tree: np.ndarray  #: (s,): which root they belong to
    of_voxel: np.ndarray  #: (m,): slice of each voxel, -1 where no root reaches it


@dataclass(frozen=True)
class Branch:
    """A branch: its slices (k,) from its base on its parent to its tip, the number of its tree, and its order."""

    slices: np.ndarray
    tree: int
    order: int


def voxels_of(xyz: np.ndarray, voxel_size: float, min_count: int, max_gap: float, monitor: Monitor) -> Voxels:
    """Return the closed voxels of points (n, 3), their pieces linked over gaps up to ``max_gap`` (m).

    Voxels with fewer points than ``min_count`` are empty; points there have the voxel -1, unless closing fills it.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Points, m.
    voxel_size : float
        Side of a voxel, m.
    min_count : int
        Fewest points of a voxel.
    max_gap : float
        Gaps that are closed, m.
    monitor : Monitor
        Receives the progress.
    """
    occupied, voxel, count = voxelize(xyz, voxel_size)
    cells = close_voxels(occupied[count >= min_count], 26, 1)
    positions = (cells + 0.5) * voxel_size
    one, other, axes = neighbor_pairs(cells, 26)
    gaps = _gaps(positions, components(one, other, len(positions))[1], max_gap, monitor)
    gap = np.linalg.norm(positions[gaps[:, 0]] - positions[gaps[:, 1]], axis=1)
    return Voxels(
        positions,
        locate_voxels(cells, occupied)[voxel],
        np.concatenate([one, gaps[:, 0]]),
        np.concatenate([other, gaps[:, 1]]),
        np.concatenate([voxel_size * np.sqrt(axes), _GAP_PRICE * gap]),
    )


def _gaps(positions: np.ndarray, piece: np.ndarray, max_gap: float, monitor: Monitor) -> np.ndarray:
    """Return the shortest pair (k, 2) of voxels between any two pieces at most ``max_gap`` (m) apart."""
    shortest = [np.zeros((0, 2), np.int64)]
    tree = spatial.cKDTree(positions)
    is_small = piece != np.argmax(np.bincount(piece)) if len(piece) else np.zeros(0, bool)
    small = np.flatnonzero(is_small)
    for start in range(0, len(small), _CHUNK):
        monitor.progress(start / len(small))
        own = small[start : start + _CHUNK]
        near = tree.query_ball_point(positions[own], max_gap, workers=n_threads())
        neighbor = np.concatenate([np.array(one, np.int64) for one in near])
        center = np.repeat(own, [len(one) for one in near])
        # A pair of voxels of two small pieces is found from both sides, and counted once.
        is_pair = (piece[center] != piece[neighbor]) & ((center < neighbor) | ~is_small[neighbor])
        shortest.append(_shortest(positions, piece, np.column_stack([center[is_pair], neighbor[is_pair]])))
    return _shortest(positions, piece, np.concatenate(shortest))


def _shortest(positions: np.ndarray, piece: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    """Return of pairs (k, 2) of voxels the shortest one between any two pieces."""
    ends = np.sort(piece[pairs], axis=1)
    distance = np.linalg.norm(positions[pairs[:, 0]] - positions[pairs[:, 1]], axis=1)
    order = np.lexsort((pairs[:, 1], pairs[:, 0], distance, ends[:, 1], ends[:, 0]))
    return pairs[order[run_starts(ends[order, 0].astype(np.int64) * len(positions) + ends[order, 1])]]


def roots_of(voxels: Voxels, stems: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """Return the lowest voxel of each of the stems at positions (s, 3) of their axes at breast height (m).

    The ``radii`` (s,), m, say how far from its axis a stem has voxels: it is a tube.
    """
    roots = []
    for stem, widest in zip(stems, np.maximum(_SAME_STEM, 2 * radii)):
        reach = np.linalg.norm(voxels.positions[:, :2] - stem[:2], axis=1)
        near = np.flatnonzero((reach <= widest) & (voxels.positions[:, 2] <= stem[2] + _SAME_STEM))
        if len(near):
            # Of several equally low voxels, the one nearest to the axis.
            roots.append(near[np.lexsort((reach[near], voxels.positions[near, 2]))[0]])
    return np.unique(np.array(roots, np.int64))


def self_supporting(voxels: Voxels, stems: np.ndarray, radii: np.ndarray, voxel_size: float) -> Slices:
    """Return the slices of the trees over those stems that can carry themselves; the thickest stem always stays.

    Parameters
    ----------
    voxels : Voxels
        Voxels of the trees.
    stems : ndarray of shape (s, 3)
        Positions of the axes of stems at breast height (m).
    radii : ndarray of shape (s,)
        Their radii (m).
    voxel_size : float
        Side of a voxel, m.
    """
    thickest_first = np.argsort(-radii, kind="stable")
    stems, radii = stems[thickest_first], radii[thickest_first]
    while True:
        slices = slices_of(voxels, roots_of(voxels, stems, radii), voxel_size)
        foot, tree = slices.positions[slices.parent < 0], slices.tree[slices.parent < 0]
        top = np.full(int(tree.max(initial=-1)) + 1, -np.inf)
        np.maximum.at(top, slices.tree, slices.positions[:, 2])
        nearest = np.argmin(np.linalg.norm(foot[:, None, :2] - stems[:, :2], axis=2), axis=1)
        height = np.zeros(len(stems))
        np.maximum.at(height, nearest, top[tree] - foot[:, 2])
        is_slender = height > _SLENDER * (2 * radii) ** (2 / 3)
        if not is_slender[1:].any():
            return slices
        # The thinnest one goes first: its wood may belong to any of the others.
        stems, radii = (np.delete(values, np.flatnonzero(is_slender)[-1], axis=0) for values in (stems, radii))


def slices_of(voxels: Voxels, roots: np.ndarray, voxel_size: float) -> Slices:
    """Return the slices of the trees over some roots (t,), those near the roots first.

    A scanned stem is a hollow tube: a skeleton of its voxels would be a net, while slices between two lengths of the
    path from the root cut across it.
    """
    n = len(voxels.positions)
    graph = sparse.coo_matrix((voxels.length, (voxels.one, voxels.other)), (n, n)).tocsr()
    paths = csgraph.dijkstra(graph, directed=False, indices=roots, return_predecessors=True, min_only=True)
    distance, before, source = paths
    reached = np.isfinite(distance)
    level = np.where(reached, distance / (_SLICE * voxel_size), -1).astype(np.int64)
    same = reached[voxels.one] & (level[voxels.one] == level[voxels.other])
    same &= source[voxels.one] == source[voxels.other]
    group = components(voxels.one[same], voxels.other[same], n)[1]
    order = np.lexsort((np.arange(n), distance))
    order = order[reached[order]]
    # The voxel of each slice that is nearest to the root.
    numbers, first = np.unique(group[order], return_index=True)
    rank = np.argsort(first)
    nearest = order[first[rank]]
    of_group = placed(np.arange(len(rank)), numbers[rank], int(group.max()) + 1, -1)
    of_voxel = np.where(reached, of_group[group], -1)
    own, every = of_voxel[reached], voxels.positions[reached].T
    count = np.bincount(own, minlength=len(rank))
    positions = np.column_stack([np.bincount(own, column, len(rank)) / count for column in every])
    parent = np.where(before[nearest] >= 0, of_voxel[np.maximum(before[nearest], 0)], -1)
    return Slices(positions, parent, np.searchsorted(roots, source[nearest]), of_voxel)


def branches_of(slices: Slices, min_length: float, monitor: Monitor) -> tuple[list[Branch], np.ndarray]:
    """Return the branches, each after its parent, and the branch (s,) of each slice, -1 for twigs and leaves.

    At a fork the branch goes on where the way to the farthest tip is longest; the others are branches of the next
    order. Branches shorter than ``min_length`` (m), and crooked ones, are left out with all that grows on them.
    """
    positions, parent = slices.positions, slices.parent
    step = np.where(parent >= 0, np.linalg.norm(positions - positions[parent], axis=1), 0.0)
    n = len(positions)
    beyond, heir = np.zeros(n), np.full(n, -1)
    for one in range(n - 1, -1, -1):
        above = parent[one]
        if above >= 0 and (heir[above] < 0 or beyond[one] + step[one] > beyond[above]):
            beyond[above], heir[above] = beyond[one] + step[one], one
    monitor.progress(0.5)
    branch, order, foot = np.full(n, -1), np.zeros(n, np.int64), positions[parent < 0]
    branches: list[Branch] = []
    for first in range(n):
        base = int(parent[first])
        if base >= 0 and (heir[base] == first or branch[base] < 0):
            continue
        line = [first]
        while heir[line[-1]] >= 0:
            line.append(int(heir[line[-1]]))
        if base >= 0:
            low = positions[base, 2] < foot[slices.tree[first], 2] + _CLEAR
            length = beyond[first] + step[first]
            if low or length < min_length or not _is_straight(positions[[base, *line]]):
                continue
            order[line] = order[base] + 1
        branch[line] = len(branches)
        whole = line if base < 0 else [base, *line]
        branches.append(Branch(np.array(whole), int(slices.tree[first]), int(order[first])))
    return branches, branch


def lengths_beyond(slices: Slices, branch: np.ndarray) -> np.ndarray:
    """Return the length (s,), m, of all branches beyond each slice, from the branch (s,) of each, -1 for leaves."""
    step = np.linalg.norm(slices.positions - slices.positions[slices.parent], axis=1)
    beyond = np.zeros(len(branch))
    # Slices come after those that they grow from.
    for one in np.flatnonzero((branch >= 0) & (slices.parent >= 0))[::-1]:
        beyond[slices.parent[one]] += beyond[one] + step[one]
    return beyond


def smooth(line: np.ndarray) -> np.ndarray:
    """Return a line (k, 3) without the steps of its voxels: inner vertices move halfway to the mean of their neighbors.

    That is done ``_SMOOTHINGS`` times.
    """
    line = line.copy()
    for _ in range(_SMOOTHINGS):
        line[1:-1] = (line[:-2] + 2 * line[1:-1] + line[2:]) / 4
    return line


def _is_straight(line: np.ndarray) -> bool:
    """Return whether a line (k, 3) is straight enough for a branch, unlike paths through leaves."""
    line = smooth(line)
    length = np.linalg.norm(np.diff(line, axis=0), axis=1).sum()
    return bool(np.linalg.norm(line[-1] - line[0]) >= _LEAST_STRAIGHT * length)
