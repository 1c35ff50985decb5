"""Which label each cell of a partition takes so that all together cost least: alpha expansion with minimum cuts."""

from __future__ import annotations

from typing import Callable

import numpy as np

from ..packages import csgraph, sparse

# Costs become whole numbers of 32 bits for the flow, to this precision, and none larger than what leaves room to add.
_STEPS, _LARGEST = 10_000, 1e4

# Sweeps over all labels; costs hardly change after the second one.
_SWEEPS = 4


# Returns what two labels (k,) on the two sides of each edge cost (k,).
Border = Callable[[np.ndarray, np.ndarray], np.ndarray]


def cheapest_labels(
    cost: np.ndarray, edges: np.ndarray, border: Border, most: np.ndarray, start: np.ndarray
) -> np.ndarray:
    """Return the labels (n,) of cells, from the labels ``start`` on changed one label at a time until none helps.

    Parameters
    ----------
    cost : ndarray of shape (n, m)
        Of each label in each cell, >= 0.
    edges : ndarray of shape (k, 2)
        Cells that touch.
    border : callable
        Cost of the labels (k,) of both cells of each edge; a metric.
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
    lowest = _energy(cost, edges, border, label)
    for _ in range(_SWEEPS):
        before = lowest
        for alpha in range(cost.shape[1]):
            # Where a label costs more than all borders of a cell could save, the cell never takes it.
            wanted = cost[:, alpha] - cost[np.arange(len(cost)), label] <= most
            if not (wanted & (label != alpha)).any():
                continue
            changed = _expanded(cost, edges, border, label, alpha, wanted)
            energy = _energy(cost, edges, border, changed)
            if energy < lowest - 1e-9:
                label, lowest = changed, energy
        if lowest >= before - 1e-9:
            break
    return label


def _energy(cost: np.ndarray, edges: np.ndarray, border: Border, label: np.ndarray) -> float:
    on_edges = border(label[edges[:, 0]], label[edges[:, 1]])
    return float(cost[np.arange(len(cost)), label].sum() + on_edges.sum())


def _expanded(
    cost: np.ndarray, edges: np.ndarray, border: Border, label: np.ndarray, alpha: int, wanted: np.ndarray
) -> np.ndarray:
    """Return the labels after those cells ``wanted`` have taken ``alpha`` for which that is cheapest, together."""
    p, q = edges.T
    other = np.full(len(edges), alpha)
    both, first, second = border(label[p], label[q]), border(other, label[q]), border(label[p], other)
    rows = np.arange(len(cost))
    keep, take = cost[rows, label].copy(), cost[:, alpha].copy()
    # An edge costs "both" where both cells keep their labels, "first" or "second" where that one changes alone, and
    # nothing where both change. That is a sum of terms of one cell each, and one of the first keeping while the second
    # changes.
    inner, from_p, from_q = wanted[p] & wanted[q], wanted[p] & ~wanted[q], wanted[q] & ~wanted[p]
    np.add.at(take, p[inner | from_p], (first - both)[inner | from_p])
    np.add.at(take, q[inner], -first[inner])
    np.add.at(take, q[from_q], (second - both)[from_q])
    chosen = np.flatnonzero(wanted)
    number = np.cumsum(wanted) - 1
    changed = label.copy()
    capacity = np.maximum(first + second - both, 0.0)[inner]
    changed[chosen[_takes(keep[chosen], take[chosen], number[p[inner]], number[q[inner]], capacity)]] = alpha
    return changed


def _takes(keep: np.ndarray, take: np.ndarray, p: np.ndarray, q: np.ndarray, capacity: np.ndarray) -> np.ndarray:
    """Return which cells (n,) change, given what keeping and changing cost, and p keeping while q changes."""
    n, cells = len(keep), np.arange(len(keep))
    least = np.minimum(keep, take)
    keep, take = keep - least, take - least
    # The source's side keeps its label: to be cut from the source costs what taking costs.
    source, sink = n, n + 1
    start = np.concatenate([np.full(n, source), cells, p])
    end = np.concatenate([cells, np.full(n, sink), q])
    costs = np.concatenate([take, keep, capacity])
    whole = np.rint(np.minimum(costs, _LARGEST) * _STEPS).astype(np.int32)
    graph = sparse.csr_matrix((whole, (start, end)), shape=(n + 2, n + 2))
    residual = graph - csgraph.maximum_flow(graph, source, sink).flow
    residual.data = np.maximum(residual.data, 0)
    residual.eliminate_zeros()
    reached = csgraph.breadth_first_order(residual, source, return_predecessors=False)
    keeps = np.zeros(n + 2, bool)
    keeps[reached] = True
    return ~keeps[:n]
