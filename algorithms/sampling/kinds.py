"""Kinds of clouds, chosen once per run: what steps do otherwise where points were matched from images."""

from dataclasses import dataclass
from typing import TypeVar

from ..rules import rule, rules

Choice = TypeVar("Choice")


@dataclass(frozen=True)
class CloudKind:
    """How the clouds of one source show roofs and ground.

    ``is_surface`` is whether a cloud is one surface seen from above: nothing lies beneath roofs and crowns, and
    edges and walls are smeared.
    """

    is_surface: bool
    lowest_roof: float = rule(2.0, "m", "physics: mean height of the lowest roof; cars are lower")
    foot: float = rule(0.5, "m", "physics: lower points are of the ground, of plants, kerbs and steps")

    @property
    def raised(self) -> float:
        """Height (m) from which points may be of a roof, whose edge is lower than its mean by the height of a foot."""
        return self.lowest_roof - self.foot

    def choose(self, laser: Choice, images: Choice) -> Choice:
        """Return the one of two methods that is for clouds of this kind."""
        return images if self.is_surface else laser


@rules
class MATCHING:
    """What matching does to clouds of images."""

    rounded: float = rule(0.7, "m", "physics: images are matched by windows as large, which round edges of roofs")


@rules
class SCENE:
    """What any cloud shows of a scene."""

    ground_within: float = rule(10.0, "m", "physics: distance within which some ground is seen, even among trees")
    least_cell: float = rule(
        0.5, "m", "of cells of roofs and ground, at least: eaves are as wide, terrain models are delivered at it"
    )


LASER = CloudKind(is_surface=False)

# Sheds and carports of 2 m have rounded edges, which lower the mean over their surface; cars differ by shape.
# Walls are seen down to their feet, and ground is smooth.
IMAGES = CloudKind(is_surface=True, lowest_roof=1.2, foot=0.2)
