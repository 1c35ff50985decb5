"""Nodes of an octree of points, as COPC files and Entwine point tiles have it."""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path
from typing import Optional

import numpy as np

from .header import truncated
from .web_file import AT_ONCE, MOST_AT_ONCE

# No octree is deeper: a cell of this level of the whole Earth is a hundredth of a millimeter wide.
_DEEPEST = 42
# In place of a number of points: the entry leads to a further page of entries.
PAGE = -1
# Bytes of points on the web that are fetched before they are decompressed: by the requests that are sent at once.
FETCHED = AT_ONCE * MOST_AT_ONCE


@dataclass(frozen=True)
class Nodes:
    """Nodes that have points, in the order in which they are read."""

    #: low, high, (m, 2): least and greatest easting and northing of each node, in coordinates of the file
    low: np.ndarray
    high: np.ndarray
    points: np.ndarray  #: (m,), int64: number of points
    #: (m,): distance of the points that the parent of each node shows, in units of the file; infinite of the root's
    above: np.ndarray

    def touch(self, box: np.ndarray, spacing: Optional[np.ndarray] = None) -> np.ndarray:
        """Return the mask of nodes (m,) that touch a box (2, 2) in plan and have points that a spacing (3,) needs."""
        touch = ((self.low <= box[1]) & (self.high >= box[0])).all(axis=1)
        # Some writers state no spacing: of theirs, all is read.
        return touch if spacing is None else touch & ((self.above > spacing[0]) | ~(self.above > 0))

    def take(self, which: np.ndarray) -> Nodes:
        """Return some of the nodes."""
        return Nodes(*(getattr(self, one.name)[which] for one in fields(self)))


def nodes_of(
    path: Path, keys: np.ndarray, points: np.ndarray, root: np.ndarray, margin: np.ndarray, spacing: float
) -> Nodes:
    """Return the nodes of an octree.

    Parameters
    ----------
    path : Path
        The file, for the message.
    keys : ndarray of shape (m, 4), int64
        Level, column, row and layer of each node.
    points : ndarray of shape (m,), int64
        Points of each node.
    root : ndarray of shape (2, 2)
        Lower corner of the root in plan, and its sides.
    margin : ndarray of shape (2,)
        How far coordinates may be rounded, also on the faces of nodes.
    spacing : float
        Distance of the points that the root shows, which halves from level to level.

    Raises
    ------
    ValueError
        If no node has a key.
    """
    level, position = keys[:, 0], keys[:, 1:3]
    is_odd = (level < 0) | (level > _DEEPEST)
    is_odd |= ((position < 0) | (position >= 2.0 ** np.clip(level, 0, _DEEPEST)[:, None])).any(axis=1)
    if is_odd.any():
        key = tuple(keys[is_odd][0, :3].tolist())
        raise truncated(path, f"of its index, it names a node {key} (level, column, row)")
    sides = root[1] / (2.0**level)[:, None]
    low = root[0] + position * sides
    above = np.where(level > 0, 2.0 * spacing / 2.0**level, np.inf)
    return Nodes(low - margin, low + sides + margin, points, above)


def fetched_to(chunks: np.ndarray, parts: list[np.ndarray], first: int) -> int:
    """Return the portion behind those from the first on that are fetched together; chunks (m, 3) name their bytes."""
    sizes = np.cumsum([chunks[some, 1].sum() for some in parts[first:]])
    return first + max(1, int(np.searchsorted(sizes, FETCHED, side="right")))
