"""Tunables that two stages or more share: label, help, unit and bounds, once."""

from typing import Any, NamedTuple

from .stage import tunable


class PaperThresholds(NamedTuple):
    """A column of table 2 of the paper of 2019: T_Dxy (m), T_Dh (m), and the points/m² from which T_Np and N follow."""

    plan_distance: float
    height_distance: float
    density: float


# T_Np and N of the table, 50 and 16 points, are the minimum building area of 4 m² at these densities.
PAPER_THRESHOLDS = {
    "12.5 points/m² (table 2)": PaperThresholds(0.6, 0.2, 12.5),
    "4 points/m² (table 2)": PaperThresholds(1.4, 0.3, 4.0),
}

THRESHOLDS = tunable(
    "automatic",
    "'automatic' follows the density and the noise of the cloud. The others are from the paper of 2019, for "
    "its two surveys (table 2), whatever the cloud is like. They are planimetric distance 0.6 m and height "
    "difference 0.2 m with 50 points per minimum building area of 4 m², or 1.4 m, 0.3 m and 16 points. Values that "
    "are set replace these.",
    choices=("automatic", *PAPER_THRESHOLDS),
)

SEED = tunable(
    1, "Start of the random numbers: the same seed gives the same result.", within=f"[0, {2**31 - 1}]", advanced=True
)

POINT_DENSITY = tunable(
    None,
    "Average number of points per square meter of occupied area.",
    label="Point density",
    within="[0.001, inf) points/m²",
    automatic="measured on the cloud; 'Segment roofs', 'Classify buildings' and 'Complete buildings' take the "
    "effective density, less where points lie on lines, in pairs or in dense strips, so that distances reach over "
    "the gaps.",
    advanced=True,
)

MIN_BUILDING_AREA = tunable(
    4.0, "Area of the smallest building to be found.", label="Minimum building area", within="[0.1, 10_000] m²"
)

# The same where walls are mapped.
MIN_MAPPED_AREA = MIN_BUILDING_AREA.with_default(6.0)

POINT_SOURCE = tunable(
    "automatic",
    "Matched images show one closed surface, crowns included. There, roofs are distinguished from crowns by "
    "planarity within half a meter of each point and by color, and low buildings are looked for. 'automatic' "
    "takes a cloud for matched images that has no second returns, no points beneath crowns, and at least 8 points "
    "per m², or 4 and colors.",
    label="Source of the points",
    choices=("automatic", "laser scanner", "matched images"),
)

MIN_FREQUENCY = tunable(
    5,
    "Points that a bin of the histogram needs to belong to the scene (T_f). More of them remove denser noise, "
    "and thin objects such as wires with it.",
    within="[1, 10_000]",
)

SURFACE_NOISE = tunable(
    None,
    "Standard deviation of the points across a smooth surface. Roofs and walls may be rougher, by tiles, gravel "
    "and the spacing of the points.",
    label="Surface noise",
    within="(0, 10] m",
    automatic="measured on the cloud, on its smoothest fifth; at least 0.01 m.",
    advanced=True,
)

BRIDGE_HEIGHT = tunable(
    1.0,
    "Least height of a bridge above its surroundings; in 'Classify ground segments' of an object, too.",
    within="[0.1, 100] m",
)

BRIDGE_WIDTH = tunable(
    40.0, "Width of the widest bridge; 0 looks for no bridges.", label="Maximum bridge width", within="[0, 1000] m"
)

BRIDGE_AREA = tunable(20.0, "Area of the smallest bridge.", within="[1, 100_000] m²")

MIN_CLUSTER_HEIGHT = tunable(
    0.0, "Only points at least this high above the ground are used, where heights are known.", within="[0, 100] m"
)

IGNORED_CLASSES = tunable(
    "7, 17, 18, 26, 64-67",
    "Points that have one of these classes in the reference are not counted: numbers and ranges, "
    "separated by commas (7, 64-67); empty counts every point.",
)

FACADE_TILT = tunable(10.0, "Largest angle of a facade to the vertical.", within="[0, 45]°")

FACADE_GAP = tunable(
    1.0,
    "Points of one plane at most this far apart belong to one facade; trees and poles leave such gaps.",
    label="Widest gap",
    within="[0.1, 100] m",
)

CORNER_DISTANCE = tunable(
    0.4,
    "Edges of neighboring facades move onto the intersection line of their planes from this far at most; "
    "0 leaves them where they are.",
    within="[0, 10] m",
)

BOUNDARY = tunable(
    "straight edges",
    "Straight edges are fitted by least squares, along the main directions of the facade; key points are those "
    "of the traced boundary where it turns by more than 40°, as published.",
    choices=("straight edges", "key points"),
)

COMPLETE_FACADES = tunable(
    True,
    "Fill what cars, trees and people hide of the foot and the sides of a facade; without it a facade ends where "
    "its points do.",
    label="Complete hidden parts",
)


def nearest_points(automatic: str) -> Any:
    """Return the declaration of N, the points of a neighborhood, which each method derives in its own way."""
    return tunable(
        None,
        "Points of the neighborhood in which the entropy of a point is measured, itself included (N).",
        label="Nearest points",
        within="[3, 10_000]",
        automatic=automatic,
    )
