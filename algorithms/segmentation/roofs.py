"""Clusters that are roof surfaces, and clusters of what else stands above the ground."""

from __future__ import annotations

from typing import Annotated, Optional

import numpy as np

from ..cloud.asprs import NOISE
from ..cloud.cells import grid_over
from ..cloud.density import point_density
from ..features.noise import surface_noise
from ..packages import ndimage
from ..params import PointDensity
from ..stage import Monitor, Param, stage
from .connectivity import connect, number_large
from .patches import segment_patches

# Roof tiles, gravel and gutters are rougher than the smoothest surfaces, by which the noise is measured.
_LEAST_ROUGHNESS = 0.02

# Cells in which a patch's area and what lies beneath it are counted, in point spacings, and their least size (m).
_CELL_SPACINGS, _LEAST_CELL = 1.5, 0.3

# What lies at least so far beneath a patch lies under it and not on it, m.
_BENEATH = 1.0
_LOW=0.05


@stage(
    "Segment roofs",
    group="Segmentation",
    tags="roof,plane,planar,surface growing,segmentation",
    writes=("segment_id", "cluster_id"),
)
def segment_roofs(
    xyz,
    classification,
    height_above_ground,
    *,
    min_height: Annotated[
        float,
        Param("Minimum height", "Mean height above ground of the lowest roof.", unit="m", low=0, high=100),
    ] = 2.0,
    min_area: Annotated[
        float,
        Param("Minimum roof area", "Area of the smallest roof surface, seen from above.", unit="m²", low=0.1, high=10_000),
    ] = 2.0,
    max_slope: Annotated[
        float,
        Param("Maximum slope", "Slope of the steepest roof.", unit="°", low=0, high=90),
    ] = 75.0,
    max_penetration: Annotated[
        float,
        Param(
            "Maximum penetration",
            "Share of a surface's cells with points well beneath it, from which it is taken for a canopy: "
            "the beam passes through leaves and not through roofs.",
            low=0,
            high=1,
        ),
    ] = 0.5,
    noise: Annotated[
        Optional[float],
        Param(
            "Surface noise",
            "Standard deviation of the points across a smooth surface.",
            unit="m",
            low=0,
            high=10,
            open_low=True,
            automatic="measured on the smoothest fifth of the cloud, at least 0.02 m.",
            advanced=True,
        ),
    ] = None,
    density: PointDensity = None,
    monitor=None,
):
    """Gather the points above the ground into roof surfaces and clusters of everything else.

    A roof surface is a patch on which neighbors share a plane, that is large and high enough and that the beam
    does not pass through. What is left above the ground (crowns, hedges, wires, roof edges) is clustered by
    distance, so that both kinds can be told apart by their entropy afterwards.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; noise (7, 18) is left out.
    height_above_ground : ndarray of shape (n,), float32
        Heights, m.

    Returns
    -------
    segment_id : ndarray of shape (n,), int32
        Roof surfaces from 1; 0 is none.
    cluster_id : ndarray of shape (n,), int32
        Roof surfaces (same numbers as segment_id), then clusters of everything else; 0 is none.

    Notes
    -----
    The noise and the density of the cloud set every tolerance: a plane's neighborhood, the distance at which a
    point lies on it, and the cells in which area and penetration are counted. Penetration needs no return numbers.
    This is the "more robust segmentation" that the paper names as future work.

    References
    ----------
    Santos, R. C. dos, Pessoa, G. G., Carrilho, A. C., Galo, M., 2019. Building detection from LiDAR data using
    entropy and the k-means concept, section 4. Sampath, A., Shan, J., 2007, as in "Segment regions".
    """
    density = point_density(xyz) if density is None else density
    noise = max(surface_noise(xyz), _LEAST_ROUGHNESS) if noise is None else noise
    monitor.resolved(density=density, noise=noise)
    used = np.flatnonzero(~np.isin(classification, NOISE))
    raised = used[height_above_ground[used] >= min(min_height, 1.5)]

    patch, _ = segment_patches(xyz[used], density, noise, max_slope, monitor.part(0, 0.8))
    whole = np.full(len(xyz), -1, np.int32)
    whole[used] = patch
    is_roof = _roofs(xyz, whole, height_above_ground, density, min_height, min_area, max_penetration)
    segment_id = _renumbered(whole, is_roof)
    others = raised[segment_id[raised] == 0]
    cluster_id = segment_id.copy()
    ids = _other_clusters(xyz[others], density, min_area, monitor.part(0.8, 1))
    cluster_id[others] = np.where(ids > 0, ids + segment_id.max(initial=0), 0)
    return segment_id, cluster_id


def _roofs(
    xyz: np.ndarray,
    patch: np.ndarray,
    height: np.ndarray,
    density: float,
    min_height: float,
    min_area: float,
    max_penetration: float,
) -> np.ndarray:
    """Return for each patch whether it is large, high and solid enough for a roof."""
    member = patch >= 0
    if not member.any():
        return np.zeros(0, bool)
    number, count = patch[member], int(patch.max()) + 1
    size = np.maximum(np.bincount(number, minlength=count), 1)
    mean_height = np.bincount(number, height[member], count) / size
    area, penetration = _area_and_penetration(xyz, patch, density)
    low = np.bincount(number, height[member] < 0.5, count) / size
    return (area >= min_area) & (mean_height >= min_height) & (penetration <= max_penetration) & (low <= _LOW)


def _area_and_penetration(xyz: np.ndarray, patch: np.ndarray, density: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the area (m²) of each patch seen from above, and the share of its cells with points well beneath it."""
    size = max(_LEAST_CELL, _CELL_SPACINGS / np.sqrt(density))
    grid = grid_over(xyz, size)
    cell = grid.number(xyz)
    cells, index = np.unique(cell, return_inverse=True)
    lowest = ndimage.minimum(xyz[:, 2], index, np.arange(len(cells)))

    member = np.flatnonzero(patch >= 0)
    pair = patch[member].astype(np.int64) * len(cells) + index[member]
    pairs, position = np.unique(pair, return_inverse=True)
    bottom = ndimage.minimum(xyz[member, 2], position, np.arange(len(pairs)))
    owner, where = np.divmod(pairs, len(cells))
    count = int(patch.max()) + 1
    occupied = np.bincount(owner, minlength=count)
    beneath = np.bincount(owner, lowest[where] < bottom - _BENEATH, count)
    return occupied * size**2, beneath / np.maximum(occupied, 1)


def _renumbered(patch: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    """Return ids (n,), int32, from 1 for the chosen patches, 0 elsewhere."""
    number = np.append(np.where(chosen, np.cumsum(chosen), 0), 0).astype(np.int32)
    return number[patch]


def _other_clusters(xyz: np.ndarray, density: float, min_area: float, monitor: Monitor) -> np.ndarray:
    """Return ids (n,) of clusters of points that are no roof: near in plan and in height alike."""
    reach = 2 / np.sqrt(density)
    return number_large(connect(xyz, reach, reach, monitor), min_area * density)
