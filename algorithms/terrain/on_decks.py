"""Objects on bridge decks."""

from typing import Any

import numpy as np

from ..cloud.asprs import PointClass
from ..packages import spatial
from ..rules import rule, rules
from ..sampling.density import link_distance
from ..sampling.surface_noise import LEAST_NEIGHBORS


@rules
class ON_DECK:
    """Objects on the deck of a bridge."""

    hidden: float = rule(
        2.0, "m", "physics: from points over a deck to the nearest one of it that is seen; vehicles hide the others"
    )
    rough: float = rule(
        0.25, "m", "crown, camber and railings: depth of objects below a deck, and width of its side in plan"
    )
    traffic: float = rule(4.5, "m", "physics: the clearance of roads, over vehicles, parapets and signs")


def on_decks(points: np.ndarray, deck: np.ndarray, least: float = -ON_DECK.rough) -> tuple[np.ndarray, np.ndarray]:
    """Find the points of objects on bridge decks, such as cars and parapets.

    Parameters
    ----------
    points : ndarray of shape (n, 3), float64
        Points that are not of a deck, m.
    deck : ndarray of shape (m, 3), float64
        Points of decks, m.
    least : float
        Least height over the deck, m; negative for what begins in its surface.

    Returns
    -------
    rows : ndarray of shape (k,), int64
        Which points are on one.
    level : ndarray of shape (k,), float64
        Elevation of the deck there, m.
    """
    if len(deck) <= LEAST_NEIGHBORS or not len(points):
        return np.zeros(0, np.int64), np.zeros(0)
    around = (points[:, :2] >= deck[:, :2].min(axis=0) - ON_DECK.hidden).all(axis=1)
    around &= (points[:, :2] <= deck[:, :2].max(axis=0) + ON_DECK.hidden).all(axis=1)
    rows = np.flatnonzero(around)
    tree = spatial.cKDTree(deck[:, :2])
    # The point spacing of decks in plan, from the distances of neighbors.
    radius = float(np.median(tree.query(deck[:, :2], k=[LEAST_NEIGHBORS + 1])[0]))
    near = link_distance(radius * float(np.sqrt(np.pi / LEAST_NEIGHBORS)))
    distance, nearest = tree.query(points[rows, :2], distance_upper_bound=max(near, ON_DECK.hidden))
    known = np.isfinite(distance)
    rows, distance, nearest = rows[known], distance[known], nearest[known]
    level = deck[nearest, 2]
    is_above = points[rows, 2] >= level + least
    beyond = np.flatnonzero(is_above & (distance > near))
    is_above[beyond] = _has_deck_behind(points[rows[beyond], :2], deck[nearest[beyond], :2], tree)
    return rows[is_above], level[is_above]


def on_bridges(xyz: np.ndarray, classification: np.ndarray) -> np.ndarray:
    """Return the mask of points (n,) of bridge decks (class 17) or of vehicles and parapets on them: no buildings."""
    is_deck = classification == PointClass.BRIDGE_DECK
    result = is_deck.copy()
    if is_deck.any():
        others = np.flatnonzero(~is_deck)
        rows, level = on_decks(xyz[others], xyz[is_deck])
        result[others[rows]] = xyz[others[rows], 2] <= level + ON_DECK.traffic
    return result


def _has_deck_behind(positions: np.ndarray, nearest: np.ndarray, tree: Any) -> np.ndarray:
    """Return the mask of positions (n, 2) with points of the deck on the side away from their ``nearest`` (n, 2), too.

    They are looked for in the circle on that side that touches the position. A deck that ends next to the position with
    a straight edge does not reach into it.
    """
    away = positions - nearest
    away /= np.linalg.norm(away, axis=1, keepdims=True)
    distance, _ = tree.query(positions + ON_DECK.hidden * away, distance_upper_bound=ON_DECK.hidden)
    return np.isfinite(distance)
