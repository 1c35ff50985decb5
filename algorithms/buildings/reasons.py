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
    LARGE_PLANE = 6
    ROUGH = 11
    PENETRATED = 12
    INTO_GROUND = 13
    TOO_SMALL = 14
    TOO_NARROW = 15
    TOO_LOW = 16
    MOSTLY_OTHER = 17
    AMID_OTHERS = 18
    ALIKE = 21
    WITHOUT_ENTROPY = 22

    @property
    def text(self) -> str:
        """What people read: in footprints, reports and legends."""
        return _TEXTS[self]

    @property
    def is_building(self) -> bool:
        """Whether it is a reason for calling something a building."""
        return Reason.PLANE <= self <= Reason.LARGE_PLANE


_TEXTS = {
    Reason.NOT_LOOKED_AT: "In no cluster: ground, or too low or too small to be looked at.",
    Reason.PLANE: "Building: low entropy, as planes have.",
    Reason.SOLID_PLANE: "Building: low entropy, as planes have, and it stops the beam.",
    Reason.SOLID: "Building: the entropy is not low, but next to nothing of the beam passes through.",
    Reason.ATTACHED: "Building: belongs to the roof above, beneath or beside it.",
    Reason.BESIDE: "Building: low entropy, as planes have, and beside or amid buildings, where what is seen past its "
    "edges tells nothing.",
    Reason.LARGE_PLANE: "Building: a plane too large for a crown, though part of the beam passes, as through glass.",
    Reason.ROUGH: "No building: high entropy, as crowns have.",
    Reason.PENETRATED: "No building: low entropy, but the beam passes through.",
    Reason.INTO_GROUND: "No building: the surface goes on into the ground.",
    Reason.TOO_SMALL: "No building: smaller than the smallest building, with all that touches it.",
    Reason.TOO_NARROW: "No building: narrower everywhere than the narrowest building, as walls and railings are.",
    Reason.TOO_LOW: "No building: too near the ground to belong to the roof at its place.",
    Reason.MOSTLY_OTHER: "No building: too little of what lies at the height of the roof is on surfaces, as in crowns.",
    Reason.AMID_OTHERS: "No building: most of what stands around it is none, as around smooth spots of crowns.",
    Reason.ALIKE: "Undecided: all clusters have the same entropy.",
    Reason.WITHOUT_ENTROPY: "Undecided: its points have no extent, so they have no entropy.",
}
