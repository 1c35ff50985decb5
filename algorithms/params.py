"""Tunables that two stages or more share: label, help, unit and bounds, once."""

from __future__ import annotations

from typing import Annotated, Optional

from .stage import Param

Seed = Annotated[
    int,
    Param(
        "Seed",
        "Start of the random numbers: the same seed gives the same result.",
        low=0,
        high=2**31 - 1,
        advanced=True,
    ),
]

PointDensity = Annotated[
    Optional[float],
    Param(
        "Point density",
        "Average density over the occupied area.",
        unit="points/m²",
        low=0,
        open_low=True,
        automatic="measured, points per occupied area; 'Segment roofs', 'Complete buildings' and surface neighborhoods "
        "take less where points lie on lines, in pairs or in dense strips, so that distances reach over the gaps.",
        advanced=True,
    ),
]

MinBuildingArea = Annotated[
    float,
    Param("Minimum building area", "Area of the smallest building to be found.", unit="m²", low=0.1, high=10_000),
]

IsolatedPoints = Annotated[
    bool,
    Param(
        "Isolated points",
        "Also find what hangs free in the air (birds, flocks, plumes of dust) and what lies under the ground "
        "(multipath), within the heights of the scene. Without it the method is the published one.",
    ),
]

SplitHeight = Annotated[
    float,
    Param(
        "Split height",
        "Height above the ground that parts roofs, which are looked for above it, from walls, which are below.",
        unit="m",
        low=0.5,
        high=100,
    ),
]

SurfaceNoise = Annotated[
    Optional[float],
    Param(
        "Surface noise",
        "Standard deviation of the points across a smooth surface; roofs and walls are smooth to three of them.",
        unit="m",
        low=0,
        high=10,
        open_low=True,
        automatic="measured on the smoothest fifth of the cloud, at least 0.02 m; 0.05 point spacings on top, and more "
        "for roofs with less than 10 points/m².",
        advanced=True,
    ),
]

MinClusterHeight = Annotated[
    float,
    Param(
        "Minimum height",
        "Only points at least this high above the ground are clustered, where heights are known.",
        unit="m",
        low=0,
        high=100,
    ),
]

IgnoredClasses = Annotated[
    str,
    Param(
        "Ignored classes",
        "Points that have one of these classes in the reference are not counted: numbers and ranges, "
        "separated by commas (7, 64-67); empty counts every point.",
    ),
]
