"""Outlines of single roofs, drawn as footprints are."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Callable, Optional

import numpy as np

from ..footprints.drawn_blocks import Drawing, draw_block
from ..footprints.outline_pieces import blocks_of, pieces_alone
from ..footprints.soft_shares import LEAST_SPACING
from ..geometry.rings import sides_of_rings, signed_area
from .surroundings import without_nested

# Area of the smallest part and of the smallest courtyard (square spacings).
_LEAST_AREA = 16.0

# Scale (spacings) of the sides under which walls are searched for: of twelve bends beside holes two were cut off at 0.8
# and at 1, and one at 0.6. The price of corners leaves superfluous lines out.
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
    """Return the outline of a roof with points (n, 2) at a mean distance ``spacing`` (m), None where it has no area."""
    spacing = max(spacing, LEAST_SPACING)
    area = _LEAST_AREA * spacing**2
    shares, pieces, directions = pieces_alone(roof, spacing, area)
    blocks = blocks_of(pieces, spacing)

    def drawn(scale: float) -> list[list[np.ndarray]]:
        how = Drawing(spacing, scale * spacing, area, area)
        found = [one.rings for block in blocks for one in draw_block(block, {1: shares}, {1: directions}, {}, how)]
        return without_nested(sorted(found, key=lambda part: -sum(map(signed_area, part))))

    parts = drawn(1.0)
    return RoofOutline(parts, drawn) if parts else None
