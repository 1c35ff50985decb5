"""Why points are called building or not: a number, a name and a sentence for each reason, and the weakest evidence."""

from enum import IntEnum
from typing import Callable

import numpy as np


class Reason(IntEnum):
    """Why a cluster, or a point that was added to a building, is called building (1 to 10) or not (from 11 on)."""

    NOT_LOOKED_AT = 0
    PLANE = 1
    SOLID_PLANE = 2
    SOLID = 3
    ATTACHED = 4
    NEXT_TO_BUILDINGS = 5
    SURFACE = 7
    LIKE_BUILDINGS = 8
    KEPT = 9
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
    DELETED = 24
    BY_CHANCE = 25

    @property
    def label(self) -> str:
        """The name for users, in footprints, reports and legends."""
        return self.name.replace("_", " ").capitalize()

    @property
    def text(self) -> str:
        """The sentence that explains the name."""
        return _TEXTS[self]

    @property
    def is_building(self) -> bool:
        """Whether this is a reason for calling something a building."""
        return Reason.NOT_LOOKED_AT < self < Reason.ROUGH


# Reasons of points that belong to a building by the roof next to them: walls, edges, equipment on it.
ADDED = (Reason.ATTACHED, Reason.LIKE_BUILDINGS)

_TEXTS = {
    Reason.NOT_LOOKED_AT: "In no cluster: ground, or too low or too small to be considered.",
    Reason.PLANE: "Building: low entropy, typical of planes.",
    Reason.SOLID_PLANE: "Building: low entropy, typical of planes, and impenetrable to the laser beam.",
    Reason.SOLID: "Building: moderate entropy, but the laser beam hardly penetrates it.",
    Reason.ATTACHED: "Building: connected to the roof above, below or next to it.",
    Reason.NEXT_TO_BUILDINGS: "Building: low entropy, and adjacent to or surrounded by buildings, where points seen "
    "past an edge are no evidence of vegetation.",
    Reason.SURFACE: "Building: planar over meters, like what surrounds it (matched images).",
    Reason.LIKE_BUILDINGS: "Building: next to a building, and like the buildings of the scene.",
    Reason.KEPT: "Building: kept or drawn by a reviewer.",
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
    Reason.BY_CHANCE: "Not a building: doubtful, in a scene without a sure building, as crowns are by chance.",
    Reason.DELETED: "Not a building: deleted by a reviewer.",
    Reason.WITHOUT_ENTROPY: "Undecided: the points have no extent, so their entropy is undefined.",
}


class Evidence(IntEnum):
    """Kinds of evidence in the decision on a cluster."""

    NONE = 0
    POINTS = 1
    ENTROPY = 2
    PENETRATION = 3
    SURROUNDINGS = 4

    def sentence(self, value: int, limit: int) -> str:
        """Return the measured value and its limit: a number of points, or thousandths."""
        form, as_words = _EVIDENCE[self]
        return form.format(as_words(value), as_words(limit))


# Values and limits are stored in thousandths: entropies are known to 0.01, shares to a percent.
_PARTS = 1000

# Kind, value and limit are decimal digits of one number, kvvvvllll: readable in a table, and one dimension.
_DIGITS = 10_000


def _as_percent(parts: int) -> str:
    return f"{100 * parts / _PARTS:.0f} %"


def _as_entropy(parts: int) -> str:
    return f"{parts / _PARTS:.2f}"


_EVIDENCE: dict[Evidence, tuple[str, Callable[[int], str]]] = {
    Evidence.NONE: ("", str),
    Evidence.POINTS: ("{} points of a roof surface (confidence 0.5 at {})", str),
    Evidence.ENTROPY: ("entropy {} (limit {})", _as_entropy),
    Evidence.PENETRATION: ("{} of the beam passes (limit {})", _as_percent),
    Evidence.SURROUNDINGS: ("{} of the points around are on buildings (limit {})", _as_percent),
}


def packed_evidence(kind: np.ndarray, value: np.ndarray, limit: np.ndarray) -> np.ndarray:
    """Return kind, value and limit (m,) as one number (m,), uint32, 0 where one is unknown.

    Numbers of points are stored as they are, up to 9,999, all else in thousandths.
    """
    parts = np.where(kind == Evidence.POINTS, 1, _PARTS)
    known = np.isfinite(value) & np.isfinite(limit) & (kind != Evidence.NONE)
    value, limit = (np.clip(np.rint(np.where(known, one, 0) * parts), 0, _DIGITS - 1) for one in (value, limit))
    return np.where(known, (kind * _DIGITS + value) * _DIGITS + limit, 0).astype(np.uint32)


def evidence_text(packed: int) -> str:
    """Return a packed kind, value and limit in words, "" of 0 and of numbers that other programs wrote."""
    kind, value = divmod(packed // _DIGITS, _DIGITS)
    return Evidence(kind).sentence(value, packed % _DIGITS) if kind <= max(Evidence) else ""
