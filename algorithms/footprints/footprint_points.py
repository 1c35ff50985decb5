"""Input of models of buildings: classified points, footprints with an area, and distances of points from planes."""

from typing import Any

import numpy as np

from ..cloud.asprs import PointClass
from ..criteria import DEVIATIONS
from ..geometry.polygon_overlap import are_within
from ..geometry.polylines import simplify_ring
from ..geometry.rings import polygon_area, sampled_rings, sides_of_rings, signed_area
from ..geometry.tin import PLANE_POINTS
from ..stage import Monitor

# Rings with less area (m²) are no footprints.
NO_AREA = 0.5

# The ground of a building is this percentile of the elevations of ground points nearest to positions along its outline.
# It is low, so that walls reach the ground on slopes, but not the least, which may be an error.
GROUND_PERCENTILE = 5.0

# Least share of the area of a footprint with points that shows a roof: fewer may be of trees, masts and wires over it.
_COVERED = 0.1

# Least and greatest tolerance (m): above the courses of tiles, below the steps between parts of a roof.
_TOLERANCES = 0.08, 0.35

# Text about the automatic tolerance in the help of stages.
TOLERANCE_TEXT = f"{DEVIATIONS:g} times the roughness of the cloud's surfaces, {_TOLERANCES[0]} to {_TOLERANCES[1]} m."


def plane_tolerance(roughness: float) -> float:
    """Return the distance (m) at which a point lies on a plane of a roof, from the roughness (m) of surfaces."""
    return float(np.clip(DEVIATIONS * roughness, *_TOLERANCES))


def require_buildings(classification: np.ndarray) -> None:
    """Refuse with a ValueError classes (n,) without buildings."""
    if not (classification == PointClass.BUILDING).any():
        raise ValueError("No point is called building (class 6); run 'Detect buildings' first.")


def require_ground(classification: np.ndarray) -> None:
    """Refuse with a ValueError classes (n,) without ground."""
    if not (classification == PointClass.GROUND).any():
        raise ValueError("No point is called ground (class 2); run 'Classify ground points (TIN)' first.")


def tell_without_area(n_sound: int, count: int, monitor: Monitor) -> None:
    """Warn how many of ``count`` footprints have no area; refuse with a ValueError if none has one."""
    if not n_sound:
        raise ValueError(f"None of the {count} footprints has an area of {NO_AREA} m² or more; choose another layer.")
    if n_sound < count:
        monitor.warn(f"{count - n_sound} of {count} footprints have no area and are left out.")


def rows_near(xyz: np.ndarray, rings: list, margin: float = 0.0) -> np.ndarray:
    """Return the indices of points, sorted by easting, in the box around a footprint, widened by ``margin`` (m)."""
    (west, south), (east, north) = rings[0].min(axis=0) - margin, rings[0].max(axis=0) + margin
    rows = np.arange(np.searchsorted(xyz[:, 0], west), np.searchsorted(xyz[:, 0], east, side="right"))
    return rows[(xyz[rows, 1] >= south) & (xyz[rows, 1] <= north)]


def rows_within(xyz: np.ndarray, rings: list) -> np.ndarray:
    """Return the indices of points, sorted by easting, within a footprint."""
    rows = rows_near(xyz, rings)
    return rows[are_within(xyz[rows, :2], sides_of_rings(rings))]


def by_easting(xyz: np.ndarray) -> np.ndarray:
    """Sort points (n, 3) by easting."""
    return xyz[np.argsort(xyz[:, 0], kind="stable")]


def sound_rings(rings: list) -> list:
    """Return the rings of a footprint that have an area, in plan; none if its exterior has hardly any."""
    # Vertices within 1 cm of each other, or of the line between the kept ones, are superfluous.
    plan = [simplify_ring(np.asarray(ring, float)[:, :2], 0.01) for ring in rings]
    sound = [ring for ring in plan if len(ring) > 3 and np.isfinite(ring).all() and abs(signed_area(ring)) > 1e-6]
    has_area = bool(sound) and sound[0] is plan[0] and abs(signed_area(plan[0])) >= NO_AREA
    return sound if has_area else []


def shows_roof(count: int, spacing: float, rings: list) -> bool:
    """Return whether ``count`` points over a footprint, ``spacing`` m apart, show its roof."""
    # Twice as many points as a plane has.
    return count >= 2 * PLANE_POINTS and count * spacing**2 >= _COVERED * polygon_area(rings)


def ground_beside(ground: np.ndarray, tree: Any, rings: list) -> np.ndarray:
    """Return the elevations (m) of the ground every 2 m along a footprint; ``tree`` has the ground in plan."""
    return ground[tree.query(sampled_rings(rings[:1], 2.0))[1], 2]
