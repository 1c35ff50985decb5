"""Find bent parts of roofs in matched images, which deviate from planes by decimeters over meters."""

import numpy as np

from ..buildings.roof_extent import amid_rough
from ..cloud.asprs import NOISE
from ..geometry.groups import mask_of, placed
from ..neighborhoods.dbscan import dbscan, points_at_corner
from ..packages import ndimage, spatial
from ..sampling.cloud_sampling import CloudSampling
from ..sampling.kinds import LASER
from ..sampling.top_surface import TopSurface
from ..segmentation.cluster_measures import plan_areas
from ..segmentation.segment_roofs import segment_roofs
from ..stage import Monitor
from ..threads import n_threads

# Width (m) of the ground around an object that is examined with it, to see whether a surface continues into the ground
# and what surrounds it.
_AROUND = 2.0


def bent_roofs(
    xyz: np.ndarray,
    classification: np.ndarray,
    height: np.ndarray,
    cluster_id: np.ndarray,
    sampling: CloudSampling,
    monitor: Monitor,
) -> np.ndarray:
    """Return the smooth surface (n,), int32, from 1, that each point is of; 0 if unassigned.

    Surfaces are smooth where neighbors share a plane, however they bend on the whole. Smooth spots of crowns, which lie
    amid rough points, are left out. Only raised objects with a roof that is known already, and points close around
    them, are looked at.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m).
    classification : ndarray of shape (n,), uint8
        ASPRS classes; noise is left out.
    height : ndarray of shape (n,)
        Heights above ground, m.
    cluster_id : ndarray of shape (n,)
        Buildings of the points on planes, from 1; 0 if unassigned.
    sampling : CloudSampling
        How the cloud was sampled.
    monitor : Monitor
        Receives progress.
    """
    surface = TopSurface(xyz, height, ~np.isin(classification, NOISE), sampling.effective_density)
    is_near = _beside_roofs(surface, cluster_id > 0)[surface.cell]
    # Keep the westernmost and the southernmost point, so that cells begin where they do in the whole cloud.
    is_near[np.argmin(xyz[:, :2], axis=0)] = True
    near = np.flatnonzero(is_near)
    found = segment_roofs(
        xyz[near], classification[near], height[near], source="matched images", sampling=sampling, monitor=monitor
    )[0]
    segment_id = placed(found, near, len(xyz))
    return np.where(amid_rough(surface, xyz, segment_id), 0, segment_id)


def _beside_roofs(surface: TopSurface, is_roof: np.ndarray) -> np.ndarray:
    """Return the mask of cells in or near raised objects with a roof; ``is_roof`` (n,) are the points of roofs."""
    row, column = surface.cell
    has_roof = mask_of(surface.height.shape, (row[is_roof], column[is_roof]))
    label = ndimage.label(has_roof | (surface.height >= LASER.foot), np.ones((3, 3), bool))[0]
    is_object = mask_of(int(label.max()) + 1, label[has_roof])
    return ndimage.distance_transform_edt(~is_object[label]) * surface.size <= _AROUND


def with_bent_roofs(
    xyz: np.ndarray,
    cluster_id: np.ndarray,
    is_bent: np.ndarray,
    gap: float,
    min_area: float,
    density: float,
    monitor: Monitor,
) -> np.ndarray:
    """Return the buildings (n,) with the bent parts of roofs that lie next to their planes.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m).
    cluster_id : ndarray of shape (n,), int32
        Buildings of the points on planes, from 1; 0 if unassigned.
    is_bent : ndarray of shape (n,), bool
        Other points on smooth surfaces.
    gap : float
        Points at most this far apart lie next to each other, m.
    min_area : float
        Area of the smallest part that is added, m².
    density : float
        Points per square meter.
    monitor : Monitor
        Receives progress.

    Notes
    -----
    A part joins one building, the one that most of its points next to buildings lie nearest to, so that it never joins
    two houses that touch.
    """
    bent = np.flatnonzero(is_bent)
    if not len(bent):
        return cluster_id
    part = dbscan(xyz[bent], gap, points_at_corner(gap, density), monitor)
    bent, part = bent[part >= 0], part[part >= 0]
    if not len(bent):
        return cluster_id
    plane = np.flatnonzero(cluster_id > 0)
    distance, nearest = spatial.cKDTree(xyz[plane]).query(xyz[bent], distance_upper_bound=gap, workers=n_threads())
    touches = np.isfinite(distance)
    pairs, count = np.unique(
        np.column_stack([part[touches], cluster_id[plane[nearest[touches]]]]), axis=0, return_counts=True
    )
    owner = np.zeros(int(part.max()) + 1, np.int32)
    # Of several buildings that a part touches, the one assigned last counts: that with the most contacts.
    order = np.lexsort((pairs[:, 1], count))
    owner[pairs[order, 0]] = pairs[order, 1]
    owner[plan_areas(xyz[bent], part, density) < min_area] = 0
    result = cluster_id.copy()
    result[bent] = owner[part]
    return result
