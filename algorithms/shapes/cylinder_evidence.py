"""Evidence of a cylinder: distances of its points, their coverage, and the free space around it."""

from dataclasses import dataclass

import numpy as np

from ..rules import rules
from .cylinder_fits import SECTORS, Cylinder, bends

# Largest angle between the normal of a point on a cylinder and the direction away from the axis, as its cosine. It is
# 30°, as normals on thin pipes are rounded by neighborhoods nearly as wide as the pipe.
FACING = float(np.cos(np.radians(30.0)))

# Most points of a fit or a test of shape: more do not change the result.
MOST_LOOKED_AT = 1500


@rules
class EVIDENCE:
    """Criteria for points on a cylinder."""

    #: Least share of the points within the tolerance, of those that face the axis within twice the tolerance. It is
    #: 0.97 of plates that protrude by one to two standard deviations, 0.82 of elbows, 0.5 without a surface.
    close: float = 0.9
    #: Largest median angle (°) between normals and the directions away from the axis, in addition to the angle of
    #: uneven points: the rounded normals of an edge have more
    median_angle: float = 10.0
    #: Median angle (°, times point spacing over radius) by which normals are off because points are uneven. The center
    #: of random points in a disk deviates by 1 / (2 √π) spacings from its middle, and the normal is that there.
    uneven_angle: float = 10.9
    #: If normals are worse than at most edges, the points must be as close to the cylinder as noise allows. The root
    #: mean square of k points exceeds the deviation by 2 / √(2 k) of it in one case of forty.
    confidence: float = 2.0
    #: Largest part of the distances (standard deviations of the noise) that a bend, a cone or faces explain
    bent: float = 0.6
    #: Largest part of the distances (of the radius) that is no noise: steel tanks of 12 to 45 m may be built 19 mm off
    #: their radius at the foot and three times that above (API 650, 7.5.3)
    as_built: float = 0.003
    #: Most points inside, per point on it, in the middle one of the slices along the axis: solids have more
    inside: float = 0.15
    inner: float = 0.9  #: Distance from the axis, as a share of the radius, up to which points are inside
    slices: int = 10  #: Slices along the axis: the roof in a tank lies in one or two
    #: Least number of points beyond each end of the arc where the surface goes on, as a share of those on an equally
    #: long part of the arc. About half of them lie within the tolerance and are not counted.
    goes_on: float = 0.25
    stray: float = 0.02  #: Share of the points that lie at either end of the arc by chance
    seen: float = 0.3  #: Least share of the cells of a sector with points: sectors with fewer hold stray points only
    length: float = 1.5  #: Least length (diameters): shorter pieces cannot be distinguished from elbows
    short: float = 0.3  #: Least length (diameters) of wide ones: shorter pieces cannot be distinguished from spheres
    long_enough: float = 1.0  #: Length (m) that is enough unless ``short`` asks for more: of tanks less may be seen


@dataclass(frozen=True)
class Points:
    """Coordinates (k, 3), m, and unit normals (k, 3) of points."""

    xyz: np.ndarray
    normals: np.ndarray


@dataclass(frozen=True)
class CylinderEvidence:
    """Noise, tolerance and spacing (m) of the points among which cylinders are looked for, and all these points."""

    noise: float
    tolerance: float
    spacing: float
    positions: np.ndarray  #: (n, 3): all points, m, of all segments if there are any, sorted by elevation

    def is_round(self, cylinder: Cylinder, own: Points, near: Points) -> bool:
        """Return whether points (k) look like a cylinder's among all points (m) near it."""
        along, distance, away = cylinder.local(own.xyz)
        near_along, near_distance, near_away = cylinder.local(near.xyz)
        angle = np.degrees(np.arccos(min(float(np.median(facing(away, own.normals))), 1.0)))
        if angle > EVIDENCE.median_angle + EVIDENCE.uneven_angle * self.spacing / cylinder.radius:
            return False
        rough = float(np.sqrt(((distance - cylinder.radius) ** 2).mean())) / self.noise
        if angle > EVIDENCE.median_angle and rough > 1 + EVIDENCE.confidence / np.sqrt(2 * len(along)):
            return False
        count = _in_slices(along, along)
        is_close = np.abs(near_distance - cylinder.radius) <= 2 * self.tolerance
        facing_it = near_along[is_close & (facing(near_away, near.normals) >= FACING)]
        if len(along) < EVIDENCE.close * _in_slices(facing_it, along).sum():
            return False
        is_inside = near_distance < EVIDENCE.inner * cylinder.radius - 2 * self.tolerance
        inside = _in_slices(near_along[is_inside], along)
        if np.median(inside / np.maximum(count, 1)) > EVIDENCE.inside:
            return False
        most = float(np.hypot(EVIDENCE.bent * self.noise, EVIDENCE.as_built * cylinder.radius))
        return bends(cylinder, own.xyz[:: len(along) // MOST_LOOKED_AT + 1]) <= most

    def is_long(self, along: np.ndarray, cylinder: Cylinder) -> bool:
        """Return whether points at positions ``along`` the axis (k,), m, are of a cylinder, not of an elbow."""
        diameter = 2 * cylinder.radius
        least = max(min(EVIDENCE.length * diameter, EVIDENCE.long_enough), EVIDENCE.short * diameter)
        return bool(np.ptp(along) >= least)

    def coverage(self, along: np.ndarray, angle: np.ndarray, cylinder: Cylinder) -> tuple[float, float]:
        """Return the share of the circumference with points, and of the cells there that hold some."""
        sectors = int(np.clip(2 * np.pi * cylinder.radius / (2 * self.spacing), 8, SECTORS))
        sector = np.minimum(((angle / (2 * np.pi) + 0.5) * sectors).astype(np.int64), sectors - 1)
        length = float(np.ptp(along))
        slices = int(np.clip(length / max(3 * self.spacing, 0.5 * cylinder.radius), 1, 30))
        at = np.minimum(((along - along.min()) / max(length, 1e-9) * slices).astype(np.int64), slices - 1)
        cells = np.bincount(sector * slices + at, minlength=sectors * slices).reshape(sectors, slices) > 0
        is_seen = cells.mean(axis=1) >= EVIDENCE.seen
        return float(is_seen.mean()), float(cells[is_seen].mean()) if is_seen.any() else 0.0

    def goes_on(self, cylinder: Cylinder, along: np.ndarray) -> bool:
        """Return whether the surface continues beyond both ends of the arc of points, as at a kerb or an edge.

        Parameters
        ----------
        cylinder : Cylinder
            In the coordinates of ``positions``.
        along : ndarray of shape (k,)
            Positions of its points along the axis (m).

        Notes
        -----
        Seen from outside, a pipe ends in the air, wherever it hides itself. Points off the cylinder are counted around
        both ends of the arc, as far as the tolerance and the spacing hide a gap.
        """
        reach = 2 * self.tolerance + self.spacing
        at, distance, turn = self._around(cylinder, along, reach)
        is_off = np.abs(distance - cylinder.radius) > self.tolerance
        *ends, gap = _arc(turn[~is_off])
        if gap * cylinder.radius < 2 * reach:
            return False
        own = _in_slices(at[~is_off], along) * reach / ((ends[1] - ends[0]) * cylinder.radius)
        for end in ends:
            squared = distance**2 + cylinder.radius**2 - 2 * distance * cylinder.radius * np.cos(turn - end)
            beyond = _in_slices(at[is_off & (squared < reach**2)], along)
            if np.median(beyond / np.maximum(own, 0.5)) < EVIDENCE.goes_on:
                return False
        return True

    def _around(self, cylinder: Cylinder, along: np.ndarray, reach: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return position along, distance from (m) and angle around the axis of all points up to ``reach`` (m) off."""
        ends = cylinder.center + np.outer([along.min(), along.max()], cylinder.axis)
        low, high = ends.min(axis=0) - cylinder.radius - reach, ends.max(axis=0) + cylinder.radius + reach
        near = self.positions[slice(*np.searchsorted(self.positions[:, 2], [low[2], high[2]]))]
        near = near[((near[:, :2] >= low[:2]) & (near[:, :2] <= high[:2])).all(axis=1)]
        at, distance, away = cylinder.local(near)
        between = (at >= along.min()) & (at <= along.max())
        return at[between], distance[between], cylinder.angle(away[between])


def _arc(turn: np.ndarray) -> tuple[float, float, float]:
    """Return both ends of the arc that angles (k,) lie on, stray ones aside, and the gap between them, radians."""
    turned = np.sort(np.mod(turn, 2 * np.pi))
    gap = np.diff(np.append(turned, turned[0] + 2 * np.pi))
    widest = int(np.argmax(gap))
    start = float(turned[(widest + 1) % len(turned)])
    first, last = np.quantile(np.mod(turned - start, 2 * np.pi), [EVIDENCE.stray, 1 - EVIDENCE.stray])
    return start + float(first), start + float(last), float(gap[widest])


def facing(away: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Return the cosine (k,) of the angle between directions away from the axis and normals (k, 3) of any sign."""
    return np.abs(np.einsum("ij,ij->i", away, normals))


def _in_slices(at: np.ndarray, along: np.ndarray) -> np.ndarray:
    """Count the positions ``at`` the axis in each slice, from the first to the last of ``along``."""
    low, high = float(along.min()), float(along.max())
    return np.histogram(at, EVIDENCE.slices, (low, max(high, low + 1e-9)))[0]
