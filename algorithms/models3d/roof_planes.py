"""The planes of one building's roof, grown from its smoothest positions."""

from dataclasses import dataclass

import numpy as np

from ..criteria import PLANE_NEIGHBORS
from ..geometry.groups import components, placed
from ..geometry.principal_axes import principal_axes
from ..neighborhoods.covariance import Nearest, smallest_eigenvectors, symmetric_eigenvalues
from ..packages import spatial
from ..planes.least_squares_planes import planes_of
from ..sampling.density import DENSITY

# Slope (°) of the steepest plane of a roof; steeper ones are walls.
STEEPEST = 75.0

# Largest angle (°) between the normals of a point and of its plane; normals of a dozen points with 3 cm of noise
# vary by less than half.
_FACING = 25.0

# Refit a plane after a round of growth has added this share of its points.
_REFIT = 0.3

# Rounds in which points choose the best plane of their neighborhood.
_CHOICES = 3


@dataclass(frozen=True)
class RoofPlanes:
    """Planes z = a x + b y + c of a roof, ``coefficients`` (m, 3), and each point's: ``label`` (n,), -1 none."""

    coefficients: np.ndarray
    label: np.ndarray

    def __len__(self) -> int:
        return len(self.coefficients)

    def height(self, plane, xy: np.ndarray) -> np.ndarray:
        """Return the height (n,), m, of planes at positions (n, 2); one plane, or one per position."""
        a, b, c = self.coefficients[plane].T
        return a * xy[..., 0] + b * xy[..., 1] + c

    @property
    def cosine(self) -> np.ndarray:
        """Cosine (m,) of the slope: the distance off a plane per difference in height."""
        return 1 / np.sqrt(1 + self.coefficients[:, 0] ** 2 + self.coefficients[:, 1] ** 2)


def find_roof_planes(xyz: np.ndarray, tolerance: float, max_slope: float, min_points: int) -> RoofPlanes:
    """Find the planes of a roof.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Points of the building (m), relative to a position nearby.
    tolerance : float
        Distance at which a point lies on a plane (m).
    max_slope : float
        Slope of the steepest roof plane (°); steeper planes are walls.
    min_points : int
        Points of the smallest plane.

    Returns
    -------
    RoofPlanes
        Largest plane first.
    """
    if len(xyz) < max(min_points, 4):
        return RoofPlanes(np.zeros((0, 3)), np.full(len(xyz), -1))
    neighbors, _, covariance = Nearest(PLANE_NEIGHBORS).moments(spatial.cKDTree(xyz), np.arange(len(xyz)))
    eigenvalues = symmetric_eigenvalues(covariance)
    normal = np.nan_to_num(smallest_eigenvectors(covariance, eigenvalues))
    growth = _Growth(xyz, neighbors, normal, tolerance, float(np.cos(np.deg2rad(max_slope))))
    label = growth.all_planes(eigenvalues[:, 2], min_points)
    label = _chosen_by_neighborhood(xyz, neighbors, label, tolerance)
    planes = planes_through(xyz, _large(label, min_points))
    # Points change planes after these have grown, and the last fit may turn a plane upright.
    return selected_planes(planes, planes.cosine >= growth.least_upward)


def with_level_patches(
    xyz: np.ndarray, is_top: np.ndarray, planes: RoofPlanes, spacing: float, min_points: int
) -> RoofPlanes:
    """Return planes and a level one for each patch of points on top that lies on no plane.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Points of the building (m).
    is_top : ndarray of shape (n,), bool
        Which of them have no higher point next to them.
    planes : RoofPlanes
        The planes of its roof.
    spacing : float
        Mean distance of neighboring points (m).
    min_points : int
        Points of the smallest patch.
    """
    rest = np.flatnonzero(is_top & (planes.label < 0))
    if len(rest) < min_points:
        return planes
    pairs = spatial.cKDTree(xyz[rest]).query_pairs(DENSITY.link * spacing, output_type="ndarray")
    _, patch = components(pairs[:, 0], pairs[:, 1], len(rest))
    patch = _large(patch, min_points)
    count = int(patch.max()) + 1
    heights = [float(np.median(xyz[rest[patch == number], 2])) for number in range(count)]
    label = planes.label.copy()
    label[rest[patch >= 0]] = len(planes) + patch[patch >= 0]
    level = np.column_stack([np.zeros((count, 2)), heights])
    return RoofPlanes(np.concatenate([planes.coefficients, level]), label)


def selected_planes(planes: RoofPlanes, is_kept: np.ndarray) -> RoofPlanes:
    """Return the planes that are kept (m,), with their points."""
    number = np.append(np.where(is_kept, np.cumsum(is_kept) - 1, -1), -1)
    return RoofPlanes(planes.coefficients[is_kept], number[planes.label])


class _Growth:
    """Growing of planes over the graph of nearest points."""

    def __init__(
        self, xyz: np.ndarray, neighbors: np.ndarray, normal: np.ndarray, tolerance: float, least_upward: float
    ) -> None:
        self.xyz, self.neighbors, self.normal = xyz, neighbors, normal
        self.tolerance, self.least_upward = tolerance, least_upward
        self.facing = float(np.cos(np.deg2rad(_FACING)))

    def all_planes(self, off_plane: np.ndarray, min_points: int) -> np.ndarray:
        """Return the plane of each point (n,), -1 for none.

        Seeds are tried in the order of ``off_plane`` (n,), m²: the variance of their neighborhood off its plane.
        """
        label = np.full(len(self.xyz), -1)
        usable = (off_plane < self.tolerance**2) & (self.normal[:, 2] >= self.least_upward)
        tried, count = ~usable, 0
        for seed in np.argsort(off_plane, kind="stable").tolist():
            if tried[seed] or label[seed] >= 0:
                continue
            grown = self._grow(seed, label < 0)
            tried[seed] = True
            if len(grown) >= min_points:
                label[grown] = count
                count += 1
            else:
                # Each of them would find the same few points again.
                tried[grown] = True
        return label

    def _grow(self, seed: int, free: np.ndarray) -> np.ndarray:
        """Return the free points of the plane around a seed, grown twice: from its normal, then from its plane."""
        center, normal = self.xyz[self.neighbors[seed, :4]].mean(axis=0), self.normal[seed]
        grown = self._reached(np.array([seed]), center, normal, free)
        if len(grown) < 4:
            return grown
        center, normal = _plane(self.xyz[grown])
        if normal[2] < self.least_upward:
            return np.array([seed])
        kept = grown[np.abs((self.xyz[grown] - center) @ normal) <= self.tolerance]
        return self._reached(kept, center, normal, free) if len(kept) else grown

    def _reached(self, start: np.ndarray, center: np.ndarray, normal: np.ndarray, free: np.ndarray) -> np.ndarray:
        """Return the points of a plane that are connected with ``start``, refitting it as it grows."""
        is_open = free.copy()
        is_open[start] = False
        found, front, fitted = [start], start, max(len(start), 8)
        count = len(start)
        while len(front):
            near = self.neighbors[front].ravel()
            near = np.unique(near[is_open[near]])
            off = np.abs((self.xyz[near] - center) @ normal)
            front = near[(off <= self.tolerance) & (self.normal[near] @ normal >= self.facing)]
            is_open[front] = False
            found.append(front)
            count += len(front)
            if count > (1 + _REFIT) * fitted:
                center, normal = _plane(self.xyz[np.concatenate(found)])
                fitted = count
        return np.concatenate(found)


def _plane(xyz: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return center and upward normal of the least-squares plane of points."""
    center, _, axes = principal_axes(xyz)
    return center, axes[:, 0] if axes[2, 0] >= 0 else -axes[:, 0]


def _chosen_by_neighborhood(xyz: np.ndarray, neighbors: np.ndarray, label: np.ndarray, tolerance: float) -> np.ndarray:
    """Return the labels after each point took the nearest plane among the planes of its neighbors."""
    for _ in range(_CHOICES):
        if label.max() < 0:
            break
        fitted = planes_through(xyz, label)
        label = fitted.label
        options = label[neighbors]
        a, b, c = fitted.coefficients[options].transpose(2, 0, 1)
        off = np.abs(xyz[:, 2:] - a * xyz[:, :1] - b * xyz[:, 1:2] - c) * fitted.cosine[options]
        off[options < 0] = np.inf
        best = np.argmin(off, axis=1)
        rows = np.arange(len(xyz))
        label = np.where(off[rows, best] <= tolerance, options[rows, best], -1)
    return label


def _large(label: np.ndarray, min_points: int) -> np.ndarray:
    """Return the labels, numbered anew from the largest; -1 for planes with fewer points."""
    if label.max(initial=-1) < 0:
        return label
    size = np.bincount(label[label >= 0])
    order = np.argsort(-size, kind="stable")
    kept = order[size[order] >= min_points]
    return placed(np.arange(len(kept)), kept, len(size) + 1, -1)[label]


def planes_through(xyz: np.ndarray, label: np.ndarray) -> RoofPlanes:
    """Return the least-squares planes of labeled points, numbered without gaps."""
    member = label >= 0
    if not member.any():
        return RoofPlanes(np.zeros((0, 3)), np.full(len(label), -1))
    number, group = np.unique(label[member], return_inverse=True)
    planes = planes_of(xyz[member], group, len(number))
    normal = np.where(np.abs(planes.normal[:, 2:]) > 1e-6, planes.normal, [0.0, 0.0, 1.0])
    slope = -normal[:, :2] / normal[:, 2:]
    constant = planes.center[:, 2] - np.einsum("ij,ij->i", slope, planes.center[:, :2])
    return RoofPlanes(np.column_stack([slope, constant]), placed(group, member, len(label), -1))
