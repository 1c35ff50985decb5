"""Outlines of single roofs, drawn like footprints, and the depth of positions inside them."""

from dataclasses import dataclass
from functools import cached_property
from typing import Callable, Optional

import numpy as np

from ..footprints.drawn_blocks import BlockDrawing, draw_block
from ..footprints.outline_pieces import blocks_of, pieces_alone
from ..footprints.soft_shares import LEAST_SPACING
from ..geometry.grid import plan_box
from ..geometry.polygon_overlap import are_within
from ..geometry.rings import sides_of_rings, signed_area
from ..packages import ndimage
from ..threads import PAIRS_AT_ONCE
from .surroundings import CELL, NEAR, without_nested

# Area of the smallest part and of the smallest courtyard (square spacings).
_LEAST_AREA = 16.0

# Point spacings per side when walls are searched. Of twelve test corners next to holes, one was lost at 0.6, two at 0.8
# or 1. Superfluous lines go later, by the cost of corners.
_FINE = 0.6


@dataclass(frozen=True)
class RoofOutline:
    """The outline of a roof."""

    parts: list[list[np.ndarray]]  #: The rings of its parts, the largest part first: closed (m), the exterior first
    drawn: Callable[[float], list[list[np.ndarray]]]  #: Draws the parts at another scale (spacings)

    @cached_property
    def sides(self) -> np.ndarray:
        """Start and end (m) of the sides (k, 2, 2) of the largest part, drawn more finely, the roof to the left."""
        return sides_of_rings([ring for part in self.drawn(_FINE)[:1] for ring in part])


def outline_roof(roof: np.ndarray, spacing: float) -> Optional[RoofOutline]:
    """Return the outline of a roof with points (n, 2) at a mean distance ``spacing`` (m), None if it has no area."""
    spacing = max(spacing, LEAST_SPACING)
    area = _LEAST_AREA * spacing**2
    shares, pieces, directions = pieces_alone(roof, spacing, area)
    blocks = blocks_of(pieces, spacing)

    def drawn(scale: float) -> list[list[np.ndarray]]:
        how = BlockDrawing(spacing, scale * spacing, area, area)
        polygons = [one.rings for block in blocks for one in draw_block(block, {1: shares}, {1: directions}, {}, how)]
        return without_nested(sorted(polygons, key=lambda part: -sum(map(signed_area, part))))

    parts = drawn(1.0)
    return RoofOutline(parts, drawn) if parts else None


class RoofCover:
    """A roof with rings (k, 2) as small cells, with the depth (m) of each inside the roof, negative outside.

    The roofs of the largest halls have larger cells.
    """

    def __init__(self, rings: list[np.ndarray]) -> None:
        low, high = plan_box(np.concatenate(rings))
        self.cell = max(float(np.sqrt((high - low).prod() / PAIRS_AT_ONCE)), CELL)
        shape = np.ceil((high - low + 2 * NEAR) / self.cell).astype(np.int64)
        self.low, self.high = low - NEAR, low - NEAR + shape * self.cell
        self.positions = self.low + (np.indices(shape).reshape(2, -1).T + 0.5) * self.cell
        covered = are_within(self.positions, sides_of_rings(rings)).reshape(shape)
        inside, outside = ndimage.distance_transform_edt(covered), ndimage.distance_transform_edt(~covered)
        self.depth = np.where(covered, inside - 0.5, 0.5 - outside).ravel() * self.cell
