"""Clusters that are roof surfaces, and clusters of other objects above the ground."""

from dataclasses import dataclass
from functools import cached_property
from typing import Optional

import numpy as np

from ..cloud.asprs import NOISE
from ..cloud.reasons import Reason
from ..geometry.boxes import connect
from ..geometry.groups import number_large, placed
from ..neighborhoods.covariance import Nearest
from ..params import POINT_DENSITY, POINT_SOURCE, SURFACE_NOISE
from ..planes.planar_patches import segment_patches
from ..rules import rule, rules
from ..sampling.cloud_sampling import GROUND_NOISE, MEASURED, CloudSampling
from ..sampling.density import DENSITY
from ..sampling.kinds import IMAGES, LASER
from ..sampling.surface_noise import LEAST_NEIGHBORS, SURFACES, plane_roughness
from ..sampling.top_surface import TopSurface, highest_of_cells
from ..stage import Monitor, stage, tunable
from ..terrain.on_decks import on_bridges
from .cluster_measures import plan_areas


@rules
class SURFACE:
    """Criteria of a roof surface."""

    low_share: float = rule(0.1, "share", "of low points, from which a surface goes on into the ground: a ramp")
    farther: float = rule(
        0.12,
        "point spacings",
        "fitted on thinned clouds of two towns: added deviation where neighbors are over 0.5 m off",
    )


@rules
class IMAGE_SURFACE:
    """Planes in clouds of matched images."""

    cell: float = rule(0.15, "m", "one point of each is taken: as dense as planes need, which bounds time and memory")


@stage(
    "Segmentation",
    tags="roof,plane,planar,surface growing,segmentation",
    writes=("segment_id", "cluster_id", "reason"),
    # Width (m) of the surroundings that decide on a cluster; clusters themselves may be of any size.
    reach=5.0,
    of_whole=(GROUND_NOISE,),
    cost=7.0,
)
def segment_roofs(
    xyz,
    classification,
    height_above_ground,
    *,
    min_height: Optional[float] = tunable(
        None,
        within="[0, 100] m",
        automatic=(
            f"{LASER.lowest_roof:g} m; {IMAGES.lowest_roof:g} m in clouds of matched images, where edges are rounded."
        ),
    ),
    min_area: float = tunable(2.0, label="Minimum roof area", within="[0.1, 10_000] m²"),
    max_slope: float = tunable(75.0, within="[0, 90]°"),
    noise: Optional[float] = SURFACE_NOISE,
    density: Optional[float] = POINT_DENSITY,
    source: str = POINT_SOURCE,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Gather the points above the ground into roof surfaces and clusters of everything else.

    A roof surface is a patch on which neighbors share a plane, that is large and high enough and does not go on
    into the ground as bridges, ramps and slopes do. The remaining points above the ground (crowns, hedges, wires, roof
    edges) are clustered by distance, so that both kinds can be distinguished by their entropy afterwards.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; noise (7, 18), bridge decks (17) and points up to 4.5 m above these are left out.
    height_above_ground : ndarray of shape (n,), float32
        Heights, m.

    Returns
    -------
    segment_id : ndarray of shape (n,), int32
        Roof surfaces from 1; 0 if unassigned.
    cluster_id : ndarray of shape (n,), int32
        Roof surfaces (same numbers as segment_id), then clusters of everything else; 0 if unassigned.
    reason : ndarray of shape (n,), uint8
        Raised points of surfaces that go on into the ground have one, see :class:`~..cloud.reasons.Reason`.

    Other Parameters
    ----------------
    min_height
        Mean height above ground of the lowest roof and of other clusters.
    min_area
        Area of the smallest roof surface, seen from above.
    max_slope
        Slope of the steepest roof surface. Up to 90° walls are surfaces, too, so that towers are not lost in the trees
        that they touch; outlines then get less even.

    Notes
    -----
    The noise and the density of the cloud set every tolerance: a plane's neighborhood, and the distance at which a
    point lies on it, 2.3 times the roughness of roofs, more with less than 10 points/m². Noise in excess of the
    ground's comes from crowns and does not count. This is the "more robust segmentation" that the paper names as future
    work.

    In clouds of matched images, walls and other points below the surface seen from above are left out, and planes are
    laid through all points within half a meter. Crowns are closed surfaces there, and smooth over less than that.

    References
    ----------
    Santos, R. C. dos, Pessoa, G. G., Carrilho, A. C., Galo, M., 2019. Building detection from LiDAR data using entropy
    and the k-means concept, section 4. [santos2019]
    Sampath, A., Shan, J., 2007. Building boundary tracing and regularization from airborne LiDAR point clouds.
    Photogrammetric Engineering and Remote Sensing 73 (7), 805-812. [sampath2007]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 1, 2)
    >>> segments, clusters, _ = segment_roofs(xyz, classes, z)
    >>> bool((segments[z > 0] == 1).all()), int(segments.max())
    (True, 1)
    """
    density = sampling.effective_density if density is None else density
    noise = sampling.noise_with_ground(xyz, classification) if noise is None else noise
    kind = sampling.kind(source)
    min_height = kind.lowest_roof if min_height is None else min_height
    monitor.resolved(density=density, noise=noise, min_height=min_height, matched_images=kind.is_surface)

    # 1. Smooth surfaces.
    is_used = ~np.isin(classification, NOISE) & ~on_bridges(xyz, classification)
    if kind.is_surface:
        # Roofs lie on the surface that is seen from above.
        from_corner = sampling.from_corner(xyz)
        is_used &= TopSurface(from_corner, height_above_ground, is_used, density).on_top(from_corner)
    used = np.flatnonzero(is_used)
    find_patches = kind.choose(_patches_of_scan, _patches_of_images)
    found = find_patches(xyz, used, sampling, _Planes(density, noise, max_slope), monitor.part(0, 0.75))
    patch = placed(found, used, len(xyz), -1)

    # 2. Those that are high and large enough, and do not go on into the ground.
    xyz = sampling.from_corner(xyz)
    patches = _Patches(xyz, patch, height_above_ground, density, kind.foot)
    monitor.progress(0.8)
    segment_id = _renumbered(patches.number, patches.roofs(min_height, min_area))
    monitor.progress(0.85)

    # 3. Clusters of all other raised points.
    raised = height_above_ground >= min(kind.raised, min_height)
    goes_on = patches.points_of(patches.is_terrain)
    others = used[(raised & (segment_id == 0) & ~goes_on)[used]]
    part = monitor.part(0.85, 1)
    ids = _clusters(xyz.take(others, axis=0), height_above_ground[others], min_height, min_area, density, part)
    cluster_id = segment_id.copy()
    cluster_id[others] = np.where(ids > 0, ids + segment_id.max(initial=0), 0)
    return segment_id, cluster_id, np.where(raised & goes_on, np.uint8(Reason.INTO_GROUND), np.uint8(0))


@dataclass(frozen=True)
class _Planes:
    """Input of the search for smooth surfaces: density (points/m²), noise (m), steepest slope (°)."""

    density: float
    noise: float
    max_slope: float

    @property
    def off_plane(self) -> float:
        """Standard deviation (m) of roof points across the planes of their neighbors."""
        # At lower densities the nearest points that define a plane reach beyond half a meter.
        dense = LEAST_NEIGHBORS / (np.pi * SURFACES.least_reach**2)
        farther = np.sqrt(max(0.0, 1 / self.density - 1 / dense))
        return float(np.hypot(plane_roughness(self.noise, self.density), SURFACE.farther * farther))


def _patches_of_scan(
    xyz: np.ndarray, used: np.ndarray, sampling: CloudSampling, planes: _Planes, monitor: Monitor
) -> np.ndarray:
    """Return the patch (u,) from 0, -1 for none, of the ``used`` rows of the points (n, 3) of a laser scan."""
    around = sampling.neighborhood(planes.density, planes.off_plane)
    return segment_patches(xyz, used, around, planes.off_plane, planes.max_slope, monitor, sampling.corner)


def _patches_of_images(
    xyz: np.ndarray, used: np.ndarray, sampling: CloudSampling, planes: _Planes, monitor: Monitor
) -> np.ndarray:
    """Return the same as :func:`_patches_of_scan`, for clouds of matched images."""
    if not len(used):
        return np.zeros(0, np.int32)
    rules = IMAGE_SURFACE
    highest, under = highest_of_cells(sampling.from_corner(xyz.take(used, axis=0)), rules.cell)
    # Expected number of occupied cells per m² for random points, each of which keeps one point.
    kept = -np.expm1(-planes.density * rules.cell**2) / rules.cell**2
    count = max(LEAST_NEIGHBORS, round(np.pi * SURFACES.least_reach**2 * kept))
    # Matched points share the error of their window, which is as large as their own.
    deviation = float(np.sqrt(2)) * planes.off_plane
    steepest, corner = planes.max_slope, sampling.corner
    return segment_patches(xyz, used[highest], Nearest(count), deviation, steepest, monitor, corner)[under]


def _clusters(
    xyz: np.ndarray, height: np.ndarray, min_height: float, min_area: float, density: float, monitor: Monitor
) -> np.ndarray:
    """Return the cluster (k,), from 1, of points that are of no roof surface; 0 for low and small ones."""
    reach = DENSITY.link / np.sqrt(density)
    component = connect(xyz, reach, reach, monitor)
    mean = np.bincount(component, height) / np.bincount(component)
    return number_large(np.where(mean[component] >= min_height, component, -1), min_area * density)


@dataclass(frozen=True)
class _Patches:
    """Smooth surfaces of a cloud."""

    xyz: np.ndarray  #: (n, 3): points, m
    number: np.ndarray  #: (n,): surface of each point from 0, -1 for none
    height: np.ndarray  #: (n,): heights above ground, m
    density: float  #: Points per square meter
    foot: float  #: Height under which points are low, m

    def mean(self, values: np.ndarray) -> np.ndarray:
        """Return the mean value of the points of each patch."""
        on_patch = self.number[self._member]
        return np.bincount(on_patch, values[self._member]) / np.maximum(np.bincount(on_patch), 1)

    @cached_property
    def areas(self) -> np.ndarray:
        """The area (m²) of each, seen from above."""
        if not self._member.any():
            return np.zeros(0)
        return plan_areas(self.xyz[self._member], self.number[self._member], self.density)

    @cached_property
    def is_terrain(self) -> np.ndarray:
        """Which of them go on into the ground."""
        return self.mean(self.height < self.foot) > SURFACE.low_share

    def roofs(self, min_height: float, min_area: float) -> np.ndarray:
        """Return the mask of those that are high and large enough, and do not go on into the ground."""
        return (self.areas >= min_area) & (self.mean(self.height) >= min_height) & ~self.is_terrain

    @cached_property
    def _member(self) -> np.ndarray:
        return self.number >= 0

    def points_of(self, mask: np.ndarray) -> np.ndarray:
        """Return the mask of points (n,) that are of patches that a mask has."""
        # Points of no patch, -1, find the last entry.
        return np.append(mask, False)[self.number]


def _renumbered(patch: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    """Return ids (n,), int32, from 1 for the chosen patches, 0 elsewhere."""
    number = np.append(np.where(chosen, np.cumsum(chosen), 0), 0).astype(np.int32)
    return number[patch]
