"""Clusters that are roof surfaces, and clusters of what else stands above the ground."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Optional, Union

import numpy as np

from ..cloud.asprs import NOISE
from ..cloud.reasons import Reason
from ..geometry.components import connect, number_large
from ..neighborhoods.covariance import Nearest
from ..neighborhoods.wide_in_plan import Wide
from ..params import PointDensity, PointSource, SurfaceNoise
from ..sampling.cloud_sampling import CloudSampling
from ..sampling.surface_noise import plane_roughness
from ..stage import Monitor, Param, stage
from ..terrain.on_decks import on_bridges
from .cluster_measures import plan_areas, share_joined
from .planar_patches import segment_patches
from .top_surface import TopSurface, highest_of_cells

# Points lower than this stand on the ground (kerbs, cars' bonnets, low plants), m.
_RAISED = 1.5

# Mean height (m) of the lowest roof in laser clouds: cars are lower.
_LOWEST = 2.0

# The same in matched images, where sheds and carports of 2 m have rounded edges, which lower the mean over their
# surface; cars are told from them by their shape.
_LOWEST_IN_IMAGES = 1.2

# In matched images, points lower than this (m) are in no cluster: the edge of the lowest roof is as low.
_RAISED_IN_IMAGES = 1.0

# Radius (m) of the neighborhoods that planes are fitted to in matched images: crowns are smooth over less.
_REACH_IN_IMAGES = 0.6

# Least standard deviation (m) of points from planes in matched images: errors of matching are shared by neighbors, so
# that the measured noise does not show them.
_OFF_PLANE_IN_IMAGES = 0.05

# Side (m) of the cells of which one point is taken in matched images: as dense as planes need it, which bounds time
# and memory.
_CELL_IN_IMAGES = 0.15

# Points of a neighborhood in matched images, where so few lie within its reach.
_FEWEST_IN_IMAGES = 12

# Share of low points from which a surface goes on into the ground: a bridge, a ramp, a slope.
_LOW_SHARE = 0.1

# Height (m) above ground up to which points are low.
_LOW = 0.5

# With fewer points per square meter than this, planes reach farther than half a meter.
_DENSE = 10.0

# Additional deviation (point spacings) of points from the planes of their neighbors, to which they are compared.
_FARTHER = 0.12

# Roofs with tiles, ribs and gravel are no rougher than this (m); crops and crowns are, smooth spots of them apart.
_ROUGHEST = 0.055

# Where the cloud is noisier, roofs are no rougher than this many times the noise.
_ROUGHEST_NOISE = 1.1597

# Where it is sparse, they are no rougher than this share of the deviation of points from planes.
_ROUGHEST_OFF_PLANE = 0.7732

# Least share of smooth surfaces among those connected with a rough or a small one that make it a roof: eaves, dormers,
# machines.
_SMOOTH_SHARE = 0.3

# Area (m²) from which a smooth surface is a roof by itself: crops have smaller smooth spots.
_LARGE = 10.0

# Reach (m) of the surroundings that decide on a cluster; clusters themselves may be of any size.
_REACH = 5.0


@stage(
    "Segment roofs",
    group="Segmentation",
    tags="roof,plane,planar,surface growing,segmentation",
    writes=("segment_id", "cluster_id", "reason"),
    reach=_REACH,
)
def segment_roofs(
    xyz,
    classification,
    height_above_ground,
    *,
    min_height: Annotated[
        Optional[float],
        Param(
            "Minimum height",
            "Mean height above ground of the lowest roof and of other clusters.",
            unit="m",
            low=0,
            high=100,
            automatic="2 m; 1.2 m in clouds of matched images, where edges are rounded.",
        ),
    ] = None,
    min_area: Annotated[
        float,
        Param(
            "Minimum roof area", "Area of the smallest roof surface, seen from above.", unit="m²", low=0.1, high=10_000
        ),
    ] = 2.0,
    max_slope: Annotated[
        float,
        Param(
            "Maximum slope",
            "Slope of the steepest roof surface. Up to 90° walls are surfaces, too, so that towers are not lost in the "
            "trees that they touch; outlines then get less even.",
            unit="°",
            low=0,
            high=90,
        ),
    ] = 75.0,
    noise: SurfaceNoise = None,
    density: PointDensity = None,
    source: PointSource = "automatic",
    sampling: Optional[CloudSampling] = None,
    monitor=None,
):
    """Gather the points above the ground into roof surfaces and clusters of everything else.

    A roof surface is a patch on which neighbors share a plane, that is large and high enough and does not go on
    into the ground as bridges, ramps and slopes do. The remaining points above the ground (crowns, hedges, wires, roof
    edges) are clustered by distance, so that both kinds can be told apart by their entropy afterwards.

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

    Notes
    -----
    The noise and the density of the cloud set every tolerance: a plane's neighborhood, and the distance at which
    a point lies on it, 2.3 times the roughness of roofs (more with less than 10 points/m²). This is the "more robust
    segmentation" that the paper names as future work.

    In clouds of matched images, walls and what else lies below the surface seen from above are left out, and planes
    are laid through all points within 0.6 m: crowns are closed surfaces there, and smooth over less than that.

    References
    ----------
    Santos, R. C. dos, Pessoa, G. G., Carrilho, A. C., Galo, M., 2019. Building detection from LiDAR data using
    entropy and the k-means concept, section 4. Sampath, A., Shan, J., 2007, as in "Segment regions".
    """
    sampling = sampling or CloudSampling.of(xyz, classification)
    xyz = sampling.from_corner(xyz)
    density = sampling.effective_density if density is None else density
    noise = sampling.noise if noise is None else noise
    in_images = sampling.is_closed_surface(source)
    if min_height is None:
        min_height = _LOWEST_IN_IMAGES if in_images else _LOWEST
    monitor.resolved(density=density, noise=noise, min_height=min_height, matched_images=in_images)
    off_plane = _off_plane_deviation(noise, density)
    used = _seen(xyz, classification, height_above_ground, density, in_images)
    around = None if in_images else sampling.neighborhood(density, off_plane)
    part = monitor.part(0, 0.75)
    patch, roughness = _patches_among(xyz, used, around, density, off_plane, max_slope, part)

    patches = _Patches(xyz, patch, height_above_ground, density)
    monitor.progress(0.8)
    roughest = max(_ROUGHEST, _ROUGHEST_NOISE * noise, _ROUGHEST_OFF_PLANE * off_plane)
    is_roof = patches.smooth(patches.roofs(min_height, min_area), roughness, roughest)
    segment_id = _renumbered(patches.number, is_roof)
    monitor.progress(0.85)

    raised = height_above_ground >= min(_RAISED_IN_IMAGES if in_images else _RAISED, min_height)
    goes_on = patches.points_of(patches.is_terrain)
    others = used[(raised & (segment_id == 0) & ~goes_on)[used]]
    part = monitor.part(0.85, 1)
    ids = _clusters(xyz[others], height_above_ground[others], min_height, min_area, density, part)
    cluster_id = segment_id.copy()
    cluster_id[others] = np.where(ids > 0, ids + segment_id.max(initial=0), 0)
    return segment_id, cluster_id, np.where(raised & goes_on, np.uint8(Reason.INTO_GROUND), np.uint8(0))


def _seen(
    xyz: np.ndarray, classification: np.ndarray, height: np.ndarray, density: float, in_images: bool
) -> np.ndarray:
    """Return the rows of points that may be of roofs or other clusters; in matched images, of the top surface only."""
    is_used = ~np.isin(classification, NOISE) & ~on_bridges(xyz, classification)
    if in_images:
        is_used &= TopSurface(xyz, height, is_used, density).on_top(xyz)
    return np.flatnonzero(is_used)


def _patches_among(
    xyz: np.ndarray,
    used: np.ndarray,
    around: Union[Nearest, Wide, None],
    density: float,
    off_plane: float,
    max_slope: float,
    monitor: Monitor,
) -> tuple[np.ndarray, np.ndarray]:
    """Return the patch (n,) from 0, -1 for none, and the roughness (n,), m, of all points.

    Patches are searched for among the ``used`` rows, in neighborhoods ``around`` points, None in matched images.
    """
    patch, roughness = np.full(len(xyz), -1, np.int32), np.zeros(len(xyz), np.float32)
    if around is None:
        found = _patches_of_images(xyz[used], density, off_plane, max_slope, monitor)
    else:
        found = segment_patches(xyz[used], around, off_plane, max_slope, monitor)
    patch[used], roughness[used] = found
    return patch, roughness


def _clusters(
    xyz: np.ndarray, height: np.ndarray, min_height: float, min_area: float, density: float, monitor: Monitor
) -> np.ndarray:
    """Return the cluster (k,), from 1, of points that are of no roof surface; 0 for low and small ones."""
    reach = 2 / np.sqrt(density)
    component = connect(xyz, reach, reach, monitor)
    return number_large(_high(component, height, min_height), min_area * density)


def _patches_of_images(
    xyz: np.ndarray, density: float, off_plane: float, max_slope: float, monitor: Monitor
) -> tuple[np.ndarray, np.ndarray]:
    """Return what :func:`.segment_patches` does, for the surface (n, 3) that matched images show."""
    if not len(xyz):
        return np.zeros(0, np.int32), np.zeros(0, np.float32)
    highest, under = highest_of_cells(xyz, _CELL_IN_IMAGES)
    thinned = xyz[highest]
    # Of cells that hold points at random, with the density's number on the average, these have one.
    kept = -np.expm1(-density * _CELL_IN_IMAGES**2) / _CELL_IN_IMAGES**2
    count = max(_FEWEST_IN_IMAGES, round(np.pi * _REACH_IN_IMAGES**2 * kept))
    deviation = max(off_plane, _OFF_PLANE_IN_IMAGES)
    patch, roughness = segment_patches(thinned, Nearest(count), deviation, max_slope, monitor)
    return patch[under], roughness[under]


def _off_plane_deviation(noise: float, density: float) -> float:
    """Return how far points of a roof lie off the planes of their neighbors (one standard deviation), m."""
    farther = np.sqrt(max(0.0, 1 / density - 1 / _DENSE))
    return float(np.hypot(plane_roughness(noise, density), _FARTHER * farther))


@dataclass(frozen=True)
class _Patches:
    """Smooth surfaces: of which each point is (n,), from 0 and -1 for none, with heights above ground (m)."""

    xyz: np.ndarray
    number: np.ndarray
    height: np.ndarray
    density: float

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
        return self.mean(self.height < _LOW) > _LOW_SHARE

    def roofs(self, min_height: float, min_area: float) -> np.ndarray:
        """Return which of them are high and large enough, and do not go on into the ground."""
        return (self.areas >= min_area) & (self.mean(self.height) >= min_height) & ~self.is_terrain

    def smooth(self, chosen: np.ndarray, roughness: np.ndarray, most: float) -> np.ndarray:
        """Return which of the chosen are smooth enough: ``roughness`` (n,) of the points and ``most`` of it, in m."""
        if not chosen.any():
            return chosen
        group = np.where(self.points_of(chosen), self.number, -1)
        is_smooth = chosen & (self.mean(roughness) <= most)
        share = share_joined(self.xyz, group, is_smooth, self.density)
        return chosen & ((is_smooth & (self.areas >= _LARGE)) | (share >= _SMOOTH_SHARE))

    @cached_property
    def _member(self) -> np.ndarray:
        return self.number >= 0

    def points_of(self, mask: np.ndarray) -> np.ndarray:
        """Return which points (n,) are of patches that a mask has."""
        # Points of no patch, -1, find the last entry.
        return np.append(mask, False)[self.number]


def _high(component: np.ndarray, height: np.ndarray, min_height: float) -> np.ndarray:
    """Return the components, -1 for those that are lower than ``min_height`` on the mean."""
    if not len(component):
        return component
    mean = np.bincount(component, height) / np.bincount(component)
    return np.where(mean[component] >= min_height, component, -1)


def _renumbered(patch: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    """Return ids (n,), int32, from 1 for the chosen patches, 0 elsewhere."""
    number = np.append(np.where(chosen, np.cumsum(chosen), 0), 0).astype(np.int32)
    return number[patch]
