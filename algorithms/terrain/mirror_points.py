"""Mirror points after Axelsson (2000): the surface goes on over a breakline to the upper edge of a terrace."""

from __future__ import annotations

import numpy as np

from ..geometry.tin import CORNERS, Tin
from .tin_densification import offset_and_angle, to_nearest_node

# Beyond a breakline the surface continues where it is less steep than this, °.
_LEVEL = 20.0

# A mirrored point joins within this share of the distance at which others join.
_MIRROR_SHARE = 0.25


def mirrored_angle(
    tin: Tin, facet: np.ndarray, points: np.ndarray, distance: float, n_start: int, *, longest: float
) -> np.ndarray:
    """Return the angles (°) of points that lie beyond a breakline, at their mirror images; inf where they don't fit.

    A point above its facet is turned about the facet's highest node (Axelsson's mirror point). Where the surface on
    that other side is nearly level and has the image, the point carries it on to the upper edge of a terrace. Only
    seeds mirror, so that the surface can't climb on by itself.

    Parameters
    ----------
    tin : Tin
        The surface.
    facet : ndarray of shape (n,), int
        The facet under each point.
    points : ndarray of shape (n, 3), float64
        Points, m.
    distance : float
        Largest distance at which a point joins its facet, m.
    n_start : int
        Number of seeds, the first nodes of the surface.
    longest : float
        Longest distance in plan over which a point is mirrored, m.
    """
    angle = np.full(len(points), np.inf)
    corners = tin.facets[facet]
    highest = corners[np.arange(len(corners)), np.argmax(tin.nodes[corners, 2], axis=1)]
    image = 2 * (tin.nodes[highest] + tin.shift) - points
    reach = np.linalg.norm(points[:, :2] - image[:, :2], axis=1) / 2
    rows = np.flatnonzero((corners >= CORNERS).all(axis=1) & (reach < longest) & (highest < CORNERS + n_start))
    rows = rows[points[rows, 2] > tin.elevation(points[rows], facet[rows])]
    image = image[rows]
    other_facet = tin.locate_near(image, highest[rows])
    offset, image_angle = offset_and_angle(tin, other_facet, image, to_nearest_node(tin, other_facet, image))
    level = (tin.slope_cosine() > np.cos(np.radians(_LEVEL))) & ~tin.is_extrapolated()
    fits = (offset <= _MIRROR_SHARE * distance) & level[other_facet]
    angle[rows[fits]] = image_angle[fits]
    return angle
