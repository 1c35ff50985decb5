"""Label the cells of a partition at least total cost, by α-expansion with minimum cuts."""

from typing import Callable, Optional

import numpy as np

from ..packages import csgraph, sparse
from .groups import mask_of, run_starts

# Steps per unit of cost in the cuts of :func:`cheapest_labels`.
STEPS_OF_LABELS = 10_000

# Returns the cost (k,) of edges (k,) with these labels (k,) on their two sides.
Border = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]


def cheapest_labels(
    cost: np.ndarray, edges: np.ndarray, border: Border, most: np.ndarray, start: np.ndarray
) -> np.ndarray:
    """Return labels (n,) of cells that cost least: each label in turn spreads from ``start`` on until none saves any.

    Parameters
    ----------
    cost : ndarray of shape (n, m)
        Cost of each label in each cell, >= 0.
    edges : ndarray of shape (k, 2)
        Cells that touch.
    border : callable
        Cost of the labels (j,) of both cells of some of the edges (j,), by their rows; a metric.
    most : ndarray of shape (n,)
        The most that all edges of a cell together can cost.
    start : ndarray of shape (n,)
        Labels to begin with.

    References
    ----------
    Boykov, Y., Veksler, O., Zabih, R., 2001. Fast approximate energy minimization via graph cuts, IEEE TPAMI 23(11).
    [boykov2001]
    """
    label = start.copy()
    every, cells = np.arange(len(edges)), np.arange(len(cost))
    border_cost = border(label[edges[:, 0]], label[edges[:, 1]], every)
    # Labels that were tried since the last change. Four sweeps over all: costs hardly change after the second one.
    tried = 0
    for alpha in list(range(cost.shape[1])) * 4:
        if tried == cost.shape[1]:
            break
        tried += 1
        extra = cost[:, alpha] - cost[cells, label]
        # A cell never takes a label that costs more than all its borders could save. Adjacent cells take it only if one
        # of them would cost less without its present borders.
        wanted = extra <= most
        own = np.bincount(edges.ravel(), np.repeat(border_cost, 2), len(cost))
        if not (wanted & (extra < own)).any():
            continue
        rows = np.flatnonzero(wanted[edges].any(axis=1))
        takes = _takers(extra, edges, rows, label, alpha, wanted, border)
        changed = np.where(takes, alpha, label)
        after = border(changed[edges[rows, 0]], changed[edges[rows, 1]], rows)
        if extra[takes].sum() + after.sum() - border_cost[rows].sum() < -1e-9:
            label, border_cost[rows], tried = changed, after, 1
    return label


def _takers(
    extra: np.ndarray,
    edges: np.ndarray,
    rows: np.ndarray,
    label: np.ndarray,
    alpha: int,
    wanted: np.ndarray,
    border: Border,
) -> np.ndarray:
    """Make one α-expansion: return the mask (n,) of the ``wanted`` cells that switch to ``alpha``.

    ``extra`` (n,) is what ``alpha`` costs beyond the present label in each cell; ``rows`` are the edges of those cells.
    """
    p, q = edges[rows].T
    other = np.full(len(rows), alpha)
    both, first, second = border(label[p], label[q], rows), border(other, label[q], rows), border(label[p], other, rows)
    # An edge costs "both" where both cells keep their labels, "first" or "second" where that one changes alone, and
    # nothing where both change. That is a sum of terms of one cell each, and one of the first keeping while the second
    # changes.
    inner, from_p, from_q = wanted[p] & wanted[q], wanted[p] & ~wanted[q], wanted[q] & ~wanted[p]
    take = extra.copy()
    np.add.at(take, p[inner | from_p], (first - both)[inner | from_p])
    np.add.at(take, q[inner], -first[inner])
    np.add.at(take, q[from_q], (second - both)[from_q])
    chosen, number = np.flatnonzero(wanted), np.cumsum(wanted) - 1
    take, edge_cost = take[chosen], np.maximum(first + second - both, 0.0)[inner]
    (one, other), back = number[[p[inner], q[inner]]], np.zeros_like(edge_cost)
    keeps = cheapest_cut(one, other, edge_cost, np.maximum(-take, 0.0), np.maximum(take, 0.0), back, STEPS_OF_LABELS)
    return mask_of(len(extra), chosen[~keeps])


def cheapest_cut(
    left: np.ndarray,
    right: np.ndarray,
    cost: np.ndarray,
    if_inside: np.ndarray,
    if_outside: np.ndarray,
    back: Optional[np.ndarray] = None,
    steps: int = 1000,
) -> np.ndarray:
    """Return the mask of cells (n,) to put inside so that it costs least: a minimum cut.

    Parameters
    ----------
    left, right : ndarray of shape (e,)
        The two cells of each edge.
    cost : ndarray of shape (e,)
        Cost of an edge with one of its cells inside and the other outside, >= 0.
    if_inside, if_outside : ndarray of shape (n,)
        Cost of a cell that is inside, and of one that is not, >= 0.
    back : ndarray of shape (e,), optional
        Cost of an edge whose left cell is outside and its right one inside; ``cost`` by default.
    steps : int
        Steps to which costs are rounded, per unit: the flow takes them as whole numbers of 32 bits.
    """
    n = len(if_inside)
    source, sink, cells = n, n + 1, np.arange(n)
    # With all edges both ways, the matrix of the flow has the entries of the graph, so that their data can be compared.
    to_source, to_sink = np.full(n, source), np.full(n, sink)
    rows = np.concatenate([left, right, to_source, cells, cells, to_sink])
    columns = np.concatenate([right, left, cells, to_source, to_sink, cells])
    costs = np.concatenate([cost, cost if back is None else back, if_outside, np.zeros(n), if_inside, np.zeros(n)])
    # At most a seventh of the largest number of 32 bits, as the costs of edges are added in these.
    capacity = np.rint(np.minimum(costs * steps, 3e8)).astype(np.int32)
    # Build the matrix by hand: most cuts have few cells, for which scipy's checks take longer than the flow.
    key = rows * (n + 2) + columns
    order = np.argsort(key, kind="stable")
    first = run_starts(key[order])
    start, end = np.divmod(key[order[first]], n + 2)
    total = np.add.reduceat(capacity[order], first, dtype=np.int32)
    row_starts = np.searchsorted(start, np.arange(n + 3)).astype(np.int32)
    graph = sparse.csr_matrix((total, end.astype(np.int32), row_starts), (n + 2, n + 2))
    has_room = total > csgraph.maximum_flow(graph, source, sink).flow.data
    start, end = start[has_room], end[has_room]
    inside = mask_of(n + 2, source)
    # All nodes that the source reaches over edges with capacity left.
    while (leads_on := inside[start] & ~inside[end]).any():
        inside[end[leads_on]] = True
    return inside[:n]
