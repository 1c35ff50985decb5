"""ASPRS point classes (LAS 1.4 R15): the only place where a class has a number."""

from __future__ import annotations

from enum import IntEnum


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


NOISE = (PointClass.LOW_NOISE, PointClass.HIGH_NOISE)
