"""Why points are called building or not: a number, a name and a sentence for each reason, and the weakest evidence."""

from __future__ import annotations

from enum import IntEnum
from typing import Callable

import numpy as np


class Reason(IntEnum):
    """Why a cluster, or a point that was added to a building, is called building (1 to 10) or not (from 11 on)."""

    text: str  #: The sentence that explains the name

    def __new__(cls, number: int, text: str = "") -> Reason:
        """Return the reason of a number, with its sentence."""
        reason = int.__new__(cls, number)
        reason._value_, reason.text = number, text
        return reason

    NOT_LOOKED_AT = 0, "In no cluster: ground, or too low or too small to be considered."
    PLANE = 1, "Building: low entropy, typical of planes."
    SOLID_PLANE = 2, "Building: low entropy, typical of planes, and impenetrable to the laser beam."
    SOLID = 3, "Building: moderate entropy, but the laser beam hardly penetrates it."
    ATTACHED = 4, "Building: connected to the roof above, below or next to it."
    NEXT_TO_BUILDINGS = (
        5,
        "Building: low entropy, and adjacent to or surrounded by buildings, where points seen past an edge are no "
        "evidence of vegetation.",
    )
    SURFACE = 7, "Building: planar over meters, like what surrounds it (matched images)."
    LIKE_BUILDINGS = 8, "Building: next to a building, and like the buildings of the scene."
    KEPT = 9, "Building: kept or drawn by a reviewer."
    ROUGH = 11, "Not a building: high entropy, typical of tree crowns."
    PENETRATED = 12, "Not a building: low entropy, but the laser beam penetrates it."
    INTO_GROUND = 13, "Not a building: the surface continues into the ground."
    TOO_SMALL = 14, "Not a building: smaller than the minimum building area, together with everything it touches."
    TOO_LOW = 16, "Not a building: too close to the ground to belong to the roof at its location."
    MOSTLY_OTHER = 17, "Not a building: too few of the points at roof height lie on surfaces, as in tree crowns."
    AMID_OTHERS = 18, "Not a building: surrounded mostly by non-building points, like smooth spots of tree crowns."
    GREEN = 19, "Not a building: as green as the vegetation of the scene."
    VEHICLE = 20, "Not a building: as wide, long and high as a car, a van or a caravan (matched images)."
    ALIKE = 21, "Undecided: all clusters have the same entropy."
    WITHOUT_ENTROPY = 22, "Undecided: the points have no extent, so their entropy is undefined."
    UNLIKE_BUILDINGS = 23, "Not a building: unlike the other buildings of the scene."
    DELETED = 24, "Not a building: deleted by a reviewer."
    BY_CHANCE = 25, "Not a building: doubtful, in a scene without a sure building, as crowns are by chance."

    @property
    def label(self) -> str:
        """The name for users, in footprints, reports and legends."""
        return self.name.replace("_", " ").capitalize()

    @property
    def is_building(self) -> bool:
        """Whether this is a reason for calling something a building."""
        return Reason.NOT_LOOKED_AT < self < Reason.ROUGH


# Reasons of points that belong to a building by the roof next to them: walls, edges, equipment on it.
ADDED = (Reason.ATTACHED, Reason.LIKE_BUILDINGS)

# Values and limits are stored in thousandths: entropies are known to 0.01, shares to a percent.
_PARTS = 1000

# Kind, value and limit are decimal digits of one number, kvvvvllll: readable in a table, and one dimension.
_DIGITS = 10_000


def _as_percent(parts: int) -> str:
    return f"{100 * parts / _PARTS:.0f} %"


def _as_entropy(parts: int) -> str:
    return f"{parts / _PARTS:.2f}"


class Evidence(IntEnum):
    """Kinds of evidence in the decision on a cluster."""

    form: str  #: Sentence with places for the measured value and its limit
    as_words: Callable[[int], str]  #: Gives a stored value or limit in words

    def __new__(cls, number: int, form: str = "", as_words: Callable[[int], str] = str) -> Evidence:
        """Return the kind of a number, with its sentence."""
        kind = int.__new__(cls, number)
        kind._value_, kind.form, kind.as_words = number, form, as_words
        return kind

    NONE = 0, "", str
    POINTS = 1, "{} points of a roof surface (confidence 0.5 at {})", str
    ENTROPY = 2, "entropy {} (limit {})", _as_entropy
    PENETRATION = 3, "{} of the beam passes (limit {})", _as_percent
    SURROUNDINGS = 4, "{} of the points around are on buildings (limit {})", _as_percent

    def sentence(self, value: int, limit: int) -> str:
        """Return the measured value and its limit: a number of points, or thousandths."""
        return self.form.format(self.as_words(value), self.as_words(limit))


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
