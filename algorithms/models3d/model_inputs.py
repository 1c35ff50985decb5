"""Input of models of buildings: classified points, footprints with an area, and how far points lie off planes."""

from __future__ import annotations

import numpy as np

from ..cloud.asprs import PointClass
from ..stage import Monitor

# Rings with less area (m²) are no footprints.
NO_AREA = 0.5

# Points of a roof lie on its plane within this many times their roughness; in the mean of many that is all of them.
_TOLERANCE_ROUGHNESS = 3.0

# Tolerances (m) that are neither finer than the courses of tiles, nor coarser than the steps that parts have.
_TOLERANCES = 0.08, 0.35

# What a stage says of its automatic tolerance.
TOLERANCE_TEXT = (
    f"{_TOLERANCE_ROUGHNESS:g} times the roughness of the cloud's surfaces, {_TOLERANCES[0]} to {_TOLERANCES[1]} m."
)


def plane_tolerance(roughness: float) -> float:
    """Return the distance (m) at which a point lies on a plane of a roof, from the roughness (m) of surfaces."""
    return float(np.clip(_TOLERANCE_ROUGHNESS * roughness, *_TOLERANCES))


def require_buildings(classification: np.ndarray) -> None:
    """Refuse with a ValueError classes (n,) without buildings."""
    if not (classification == PointClass.BUILDING).any():
        raise ValueError("No point is called building (class 6); run 'Detect buildings' first.")


def require_ground(classification: np.ndarray) -> None:
    """Refuse with a ValueError classes (n,) without ground."""
    if not (classification == PointClass.GROUND).any():
        raise ValueError("No point is called ground (class 2); run 'Classify ground points (TIN)' first.")


def tell_without_area(n_sound: int, count: int, monitor: Monitor) -> None:
    """Say how many of ``count`` footprints have no area; refuse with a ValueError if none has one."""
    if not n_sound:
        raise ValueError(f"None of the {count} footprints has an area of {NO_AREA} m² or more; choose another layer.")
    if n_sound < count:
        monitor.warn(f"{count - n_sound} of {count} footprints have no area and are left out.")
