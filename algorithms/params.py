"""Tunables that two stages or more share: label, help, unit and bounds, once."""

from __future__ import annotations

from typing import Annotated, Optional

from .stage import Param

Seed = Annotated[
    int,
    Param("Seed", "Start of the random numbers: the same seed gives the same result.", low=0, high=2**31 - 1, advanced=True),
]

PointDensity = Annotated[
    Optional[float],
    Param(
        "Point density",
        "Average density over the occupied area.",
        unit="points/m²",
        low=0,
        open_low=True,
        automatic="measured, points per occupied area.",
        advanced=True,
    ),
]

MinBuildingArea = Annotated[
    float,
    Param("Minimum building area", "Area of the smallest building to be found.", unit="m²", low=0.1, high=10_000),
]
