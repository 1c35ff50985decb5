"""Blocks of touching level roofs: party walls where parapets or steps between the roofs show them."""

from __future__ import annotations

import numpy as np

from ..footprints.alpha_shape import trace_outlines
from ..footprints.row_houses import split_rows
from ..packages import spatial
from ..segmentation.top_surface import highest_of_cells
from ..stage import Monitor
from ..threads import n_threads

# Side of the cells (m) whose highest points show parapets: these are about as wide.
_CELL = 0.3

# Tolerance (m) of the outlines that the directions of walls are taken from: eaves that matching has rounded wiggle.
_TOLERANCE = 0.6


def split_blocks(
    xyz: np.ndarray, height: np.ndarray, cluster_id: np.ndarray, spacing: float, monitor: Monitor
) -> np.ndarray:
    """Return the buildings (n,), from 1 and from west to east, with the houses of rows and blocks one by one.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m).
    height : ndarray of shape (n,)
        Heights above ground, m.
    cluster_id : ndarray of shape (n,)
        Buildings, from 1; 0 is none.
    spacing : float
        Mean distance between points, m.
    monitor : Monitor
        Receives progress.

    Notes
    -----
    Houses are told as in rows of gables: along a line from one side of the block to the other, with another such line a
    house away, a wall stands above both roofs or one roof steps down to the other.
    """
    own = np.flatnonzero(cluster_id > 0)
    if not len(own):
        return cluster_id
    size = max(_CELL, 2 * spacing)
    top = own[highest_of_cells(xyz[own], size)[0]]
    tracing = trace_outlines(xyz[top, :2], cluster_id[top].astype(np.int64), size)
    if tracing is None:
        return cluster_id
    # Roofs are held against each other by their elevations: the heights of a level roof on a slope are not level.
    lowest = np.full(int(cluster_id.max()) + 1, np.inf)
    np.minimum.at(lowest, cluster_id[top], (xyz[:, 2] - height)[top])
    parted = split_rows(tracing, xyz[top, 2] - lowest[cluster_id[top]], size, _TOLERANCE, monitor)
    if len(parted.labels) == len(tracing.labels):
        return cluster_id
    corner = parted.triangles[parted.face >= 0]
    face_of = np.full(len(top), -1)
    face_of[corner] = parted.face[parted.face >= 0][:, None]
    known = np.flatnonzero(face_of >= 0)
    nearest = known[spatial.cKDTree(xyz[top[known], :2]).query(xyz[own, :2], workers=n_threads())[1]]
    # What tracing alone has parted, beside a gap, stays one building.
    first = len(tracing.labels)
    building = np.append(tracing.labels, int(cluster_id.max()) + 1 + np.arange(len(parted.labels) - first))
    result = np.zeros_like(cluster_id)
    result[own] = _from_west_to_east(xyz[own, 0], building[face_of[nearest]])
    return result


def _from_west_to_east(x: np.ndarray, building: np.ndarray) -> np.ndarray:
    """Return buildings (n,) with numbers from 1 in the order of their westernmost points."""
    which = np.unique(building, return_inverse=True)[1]
    west = np.full(int(which.max()) + 1, np.inf)
    np.minimum.at(west, which, x)
    number = np.empty(len(west), np.int32)
    number[np.argsort(west, kind="stable")] = np.arange(1, len(west) + 1)
    return number[which]
