"""Blocks of touching level roofs: party walls where parapets or steps between the roofs show them."""

from __future__ import annotations

import numpy as np

from ..footprints.outline_pieces import pieces_alone
from ..footprints.row_houses import split_row
from ..footprints.soft_shares import spread_out
from ..geometry.groups import placed, ranked_by_least
from ..sampling.top_surface import highest_of_cells
from ..stage import Monitor

# Side of the cells (m) whose highest points are used: about the width of parapets.
_CELL = 0.3


def split_blocks(
    xyz: np.ndarray, height: np.ndarray, cluster_id: np.ndarray, spacing: float, monitor: Monitor
) -> np.ndarray:
    """Return the buildings (n,), each house of rows and blocks as one, from 1 from west to east; 0 if unassigned.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m).
    height : ndarray of shape (n,)
        Heights above ground, m.
    cluster_id : ndarray of shape (n,)
        Buildings, from 1; 0 if unassigned.
    spacing : float
        Mean distance between points, m.
    monitor : Monitor
        Receives progress.

    Notes
    -----
    Houses are separated as in rows of gables: along lines from one side of the block to the other, a house apart. Along
    such a line a wall rises above both roofs, or one roof steps down to the other.
    """
    own = np.flatnonzero(cluster_id > 0)
    if not len(own):
        return cluster_id
    size = max(_CELL, 2 * spacing)
    top = own[highest_of_cells(xyz[own], size)[0]]
    # Roofs are compared by their elevations: over sloping ground, heights above ground vary on a level roof.
    lowest_ground = np.full(int(cluster_id.max()) + 1, np.inf)
    np.minimum.at(lowest_ground, cluster_id[top], (xyz[:, 2] - height)[top])
    corner = xyz[own, :2].min(axis=0)
    count = int(cluster_id.max())
    house = cluster_id[own].astype(np.int64)
    buildings = np.unique(cluster_id[top])
    for done, number in enumerate(buildings.tolist()):
        roof, mine = top[cluster_id[top] == number], cluster_id[own] == number
        over_lowest = xyz[roof, 2] - lowest_ground[number]
        part = _houses_at(xyz[roof, :2] - corner, over_lowest, xyz[own[mine], :2] - corner, size)
        house[mine] = np.where(part > 1, count + part - 1, number)
        count += int(part.max()) - 1
        monitor.progress((done + 1) / len(buildings))
    return placed(ranked_by_least(xyz[own, 0], house), own, len(cluster_id))


def _houses_at(plan: np.ndarray, height: np.ndarray, positions: np.ndarray, spacing: float) -> np.ndarray:
    """Return the house (k,), from 1, at positions (k, 2), m, of a building.

    Its roof has points at ``plan`` (n, 2), m, ``spacing`` (m) apart, with heights (n,) above one level, m.
    """
    shares, pieces, directions = pieces_alone(plan, spacing, 0.0)
    if not pieces:
        return np.ones(len(positions), np.int64)
    houses = split_row(shares.lattice, shares.share > shares.rest, plan, height, directions, spacing)
    return spread_out(houses.house)[shares.lattice.nearest(positions)]
