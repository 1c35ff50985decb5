"""ASPRS point classes (LAS 1.4 R15): the only place where a class has a number."""

from enum import IntEnum

import numpy as np


class PointClass(IntEnum):
    """Standard classes of LAS 1.4; 8 and 12 are reserved, 23-63 too, 64-255 are the user's."""

    NEVER_CLASSIFIED = 0
    UNCLASSIFIED = 1
    GROUND = 2
    LOW_VEGETATION = 3
    MEDIUM_VEGETATION = 4
    HIGH_VEGETATION = 5
    BUILDING = 6
    LOW_NOISE = 7
    WATER = 9
    RAIL = 10
    ROAD_SURFACE = 11
    WIRE_GUARD = 13
    WIRE_CONDUCTOR = 14
    TRANSMISSION_TOWER = 15
    WIRE_CONNECTOR = 16
    BRIDGE_DECK = 17
    HIGH_NOISE = 18
    OVERHEAD_STRUCTURE = 19
    IGNORED_GROUND = 20
    SNOW = 21
    TEMPORAL_EXCLUSION = 22


# Numbers that a class can have.
CODES = 256

NOISE = (PointClass.LOW_NOISE, PointClass.HIGH_NOISE)
VEGETATION = (PointClass.LOW_VEGETATION, PointClass.MEDIUM_VEGETATION, PointClass.HIGH_VEGETATION)


def parse_classes(text: str, label: str = "Ignored classes", most: int = 255) -> np.ndarray:
    """Return the class numbers of a text such as ``"7, 18, 64-67"``, ascending; ``label`` is named in errors.

    Other numbers than classes, too, with ``most`` the greatest.

    Raises
    ------
    ValueError
        If the text is anything else than numbers from 0 to ``most`` and ranges of them.
    """
    classes: set[int] = set()
    for part in filter(None, (piece.strip() for piece in text.split(","))):
        ends = [int(end) if end.strip().isdecimal() else most + 1 for end in part.split("-")]
        if len(ends) > 2 or not ends[0] <= ends[-1] <= most:
            raise ValueError(f"{label} must be numbers from 0 to {most} and ranges such as 64-67, got {part!r}.")
        classes.update(range(ends[0], ends[-1] + 1))
    return np.array(sorted(classes), dtype=np.int64)
