"""Why points are called building or not: a number and a sentence for each reason."""

from __future__ import annotations

from enum import IntEnum


class Reason(IntEnum):
    """Why a cluster, or a point that was added to a building, is called building or not."""

    NOT_LOOKED_AT = 0
    PLANE = 1
    SOLID_PLANE = 2
    SOLID = 3
    ATTACHED = 4
    BESIDE = 5
    SURFACE = 7
    LIKE_BUILDINGS = 8
    ROUGH = 11
    PENETRATED = 12
    INTO_GROUND = 13
    TOO_SMALL = 14
    TOO_LOW = 16
    MOSTLY_OTHER = 17
    AMID_OTHERS = 18
    GREEN = 19
    VEHICLE = 20
    ALIKE = 21
    WITHOUT_ENTROPY = 22
    UNLIKE_BUILDINGS = 23

    @property
    def text(self) -> str:
        """The sentence for users, in footprints, reports and legends."""
        return _TEXTS[self]

    @property
    def is_building(self) -> bool:
        """Whether this is a reason for calling something a building."""
        return self in _FOR_BUILDING


_FOR_BUILDING = frozenset(
    {
        Reason.PLANE,
        Reason.SOLID_PLANE,
        Reason.SOLID,
        Reason.ATTACHED,
        Reason.BESIDE,
        Reason.SURFACE,
        Reason.LIKE_BUILDINGS,
    }
)

# Reasons of points that belong to a building by the roof beside them: walls, edges, equipment on it.
ADDED = (Reason.ATTACHED, Reason.LIKE_BUILDINGS)

_TEXTS = {
    Reason.NOT_LOOKED_AT: "In no cluster: ground, or too low or too small to be considered.",
    Reason.PLANE: "Building: low entropy, typical of planes.",
    Reason.SOLID_PLANE: "Building: low entropy, typical of planes, and impenetrable to the laser beam.",
    Reason.SOLID: "Building: moderate entropy, but the laser beam hardly penetrates it.",
    Reason.ATTACHED: "Building: connected to the roof above, below or beside it.",
    Reason.BESIDE: "Building: low entropy, and adjacent to or surrounded by buildings, where points seen past an edge "
    "are no evidence of vegetation.",
    Reason.SURFACE: "Building: planar over meters, like what surrounds it (matched images).",
    Reason.LIKE_BUILDINGS: "Building: beside a building, and like the buildings of the scene.",
    Reason.ROUGH: "Not a building: high entropy, typical of tree crowns.",
    Reason.PENETRATED: "Not a building: low entropy, but the laser beam penetrates it.",
    Reason.INTO_GROUND: "Not a building: the surface continues into the ground.",
    Reason.TOO_SMALL: "Not a building: smaller than the minimum building area, together with everything it touches.",
    Reason.TOO_LOW: "Not a building: too close to the ground to belong to the roof at its location.",
    Reason.MOSTLY_OTHER: "Not a building: too few of the points at roof height lie on surfaces, as in tree crowns.",
    Reason.AMID_OTHERS: "Not a building: surrounded mostly by non-building points, like smooth spots of tree crowns.",
    Reason.GREEN: "Not a building: as green as the vegetation of the scene.",
    Reason.VEHICLE: "Not a building: as wide, long and high as a car, a van or a caravan (matched images).",
    Reason.ALIKE: "Undecided: all clusters have the same entropy.",
    Reason.UNLIKE_BUILDINGS: "Not a building: unlike the other buildings of the scene.",
    Reason.WITHOUT_ENTROPY: "Undecided: the points have no extent, so their entropy is undefined.",
}
