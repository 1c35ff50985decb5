"""Kinds of clouds, chosen once per run: what steps do otherwise where points were matched from images."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

from ..rules import rule

Choice = TypeVar("Choice")


@dataclass(frozen=True)
class CloudKind:
    """How the clouds of one source show roofs and ground.

    ``is_surface`` is whether a cloud is one surface seen from above: nothing lies beneath roofs and crowns, and
    edges and walls are smeared.
    """

    is_surface: bool
    lowest_roof: float = rule(2.0, "m", "physics: mean height of the lowest roof; cars are lower")
    raised: float = rule(1.5, "m", "physics: lower points are of kerbs, bonnets of cars and low plants")

    foot: float = rule(0.5, "m", "physics: lower points are of the ground, of plants, kerbs and steps")

    def choose(self, laser: Choice, images: Choice) -> Choice:
        """Return the one of two methods that is for clouds of this kind."""
        return images if self.is_surface else laser


@dataclass(frozen=True)
class MatchingRules:
    """What matching does to clouds of images."""

    rounded: float = rule(0.7, "m", "physics: images are matched by windows as large, which round edges of roofs")


LASER = CloudKind(is_surface=False)

# Sheds and carports of 2 m have rounded edges, which lower the mean over their surface; cars differ by shape.
# Walls are seen down to their feet, and ground is smooth.
IMAGES = CloudKind(is_surface=True, lowest_roof=1.2, raised=1.0, foot=0.2)
MATCHING = MatchingRules()
