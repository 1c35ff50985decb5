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
        Buildings, from 1; 0 if unassigned.
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
    # Roofs are compared by their elevations: above sloping ground the heights of a level roof differ.
    lowest = np.full(int(cluster_id.max()) + 1, np.inf)
    np.minimum.at(lowest, cluster_id[top], (xyz[:, 2] - height)[top])
    parted = split_rows(tracing, xyz[top, 2] - lowest[cluster_id[top]], size, _TOLERANCE, monitor)
    if len(parted.labels) == len(tracing.labels):
        return cluster_id
    corner = parted.triangles[parted.face >= 0]
    face_of = np.full(len(top), -1)
    face_of[corner] = parted.face[parted.face >= 0][:, None]
    nearest = _nearest_of_building(xyz[own, :2], cluster_id[own], xyz[top, :2], cluster_id[top], face_of >= 0)
    # What tracing alone has parted, beside a gap, stays one building.
    first = len(tracing.labels)
    building = np.append(tracing.labels, int(cluster_id.max()) + 1 + np.arange(len(parted.labels) - first))
    # A building without an outline, of a few points or a row of them, stays as it is.
    house = np.where(nearest >= 0, building[face_of[nearest]], cluster_id[own])
    result = np.zeros_like(cluster_id)
    result[own] = _from_west_to_east(xyz[own, 0], house)
    return result


def _nearest_of_building(
    xy: np.ndarray, cluster: np.ndarray, places: np.ndarray, of: np.ndarray, known: np.ndarray
) -> np.ndarray:
    """Return the nearest of the ``known`` places (m, 2) of its own building for each point (n, 2), -1 without any."""
    rows = np.flatnonzero(known)
    # Buildings one above the other, farther apart than any two points of one.
    apart = 1 + 2 * float(np.ptp(xy, axis=0).sum())
    tree = spatial.cKDTree(np.column_stack([places[rows], apart * of[rows]]))
    _, found = tree.query(np.column_stack([xy, apart * cluster]), distance_upper_bound=apart, workers=n_threads())
    return np.append(rows, -1)[found]


def _from_west_to_east(x: np.ndarray, building: np.ndarray) -> np.ndarray:
    """Return buildings (n,) with numbers from 1 in the order of their westernmost points."""
    which = np.unique(building, return_inverse=True)[1]
    west = np.full(int(which.max()) + 1, np.inf)
    np.minimum.at(west, which, x)
    number = np.empty(len(west), np.int32)
    number[np.argsort(west, kind="stable")] = np.arange(1, len(west) + 1)
    return number[which]
