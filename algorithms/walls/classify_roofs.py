"""Find the planes and bent surfaces that are roofs, join those of each building, and split blocks at party walls."""

from typing import Optional

import numpy as np

from ..buildings.roof_extent import amid_rough
from ..cloud.asprs import NOISE, PointClass
from ..footprints.outline_pieces import pieces_alone
from ..footprints.row_houses import split_row
from ..footprints.soft_shares import spread_out
from ..geometry.grid import find_cells, raster_cells
from ..geometry.groups import mask_of, placed, ranked_by_least, topmost
from ..neighborhoods.dbscan import dbscan, points_at_corner
from ..packages import ndimage, spatial
from ..params import MIN_MAPPED_AREA, POINT_DENSITY, POINT_SOURCE
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..sampling.kinds import LASER
from ..sampling.top_surface import TopSurface, highest_of_cells
from ..segmentation.cluster_measures import plan_areas
from ..segmentation.segment_roofs import segment_roofs
from ..stage import Monitor, stage, tunable
from ..threads import n_threads

# Surfaces closer than this (m) belong to one roof: roofs of two buildings are seldom as close.
_LEAST_GAP = 0.6

# Surfaces closer than this (point spacings) belong to one roof, if it is more than the least distance.
_GAP_SPACINGS = 3.0

# Surfaces farther apart than this (m), the width of a lane, are different roofs at any density.
_MOST_GAP = 5.0

# A roof is part of a larger one if more than this share of its border meets that one. A house between two others shares
# at most a third with each, an annex in a nook half. A stair house at the edge of a roof has three quarters.
_ENCLOSED = 0.6

# Roofs meet across up to this many cells without a roof: parapets, and walls smeared by image matching.
_OVER = 2

# Side of the cells (m) whose highest points are used: about the width of parapets.
_CELL = 0.3

# Width (m) of the ground around an object that is examined with it, to see whether a surface continues into the ground
# and what surrounds it.
_AROUND = 2.0


@stage(
    "Buildings",
    tags="building,roof,plane,cluster,DBSCAN,photogrammetry,UAV,cadastre",
    writes=("classification", "cluster_id"),
    cost=4.0,
)
def classify_roofs(
    xyz,
    classification,
    height_above_ground,
    segment_id,
    *,
    min_height: float = tunable(2.0, within="[0.5, 100] m"),
    min_area: float = MIN_MAPPED_AREA,
    gap: Optional[float] = tunable(
        None, label="Gap between roofs", within="(0, 20] m", automatic="3 times the point spacing, from 0.6 to 5 m."
    ),
    density: Optional[float] = POINT_DENSITY,
    source: str = POINT_SOURCE,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Gather the planes above a height into the roofs of buildings.

    Planes that lie higher above the ground than cars and hedges are roofs; those whose points lie near each other are
    one building (class 6).

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; noise (7, 18) is left out.
    height_above_ground : ndarray of shape (n,), float32
        Heights, m.
    segment_id : ndarray of shape (n,), int32
        Planes from 1, as "Segment planes (RANSAC)" finds them; 0 if unassigned.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        Roofs get 6; points of class 6 on no roof become 1.
    cluster_id : ndarray of shape (n,), int32
        Buildings from 1, from west to east; 0 if unassigned.

    Other Parameters
    ----------------
    min_height
        Height above the ground over which half of a roof lies.
    gap
        Points of planes at most this far apart belong to one building.

    Notes
    -----
    In clouds of matched images, in which roofs are bent, smooth surfaces next to the planes of a building belong to it.
    There, rows and blocks of three level roofs or more fall into houses where walls rise 0.3 m above both roofs or the
    roofs step by 0.4 m. Matching rounds both: parapets of half a meter between level roofs are not seen at 59 points
    per m², and of steps of 0.4 m every other one is.

    The clusters are made by DBSCAN with the gap as radius and a quarter of the points that a level roof has within it.
    A cluster that one larger cluster surrounds on more than three fifths of its border, seen from above, belongs to it:
    stair houses and penthouses on flat roofs, skylights in them. The paper takes the points above the height; here
    a plane is taken whole, down to eaves that are lower, if half of it is above. That height is 2 m and not the 2.5
    m up to which "Classify walls" looks for walls, so that lean-tos are roofs and walls have as many points.
    Numbers follow the westernmost points of clusters, not the order of points.

    References
    ----------
    Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection.
    International Archives of the Photogrammetry, Remote Sensing and Spatial Information Sciences XLVIII-4/W1, section
    2.3. [hrutka2022]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 1, 2)
    >>> found, clusters = classify_roofs(xyz, classes, z, np.where(z > 0, 1, 0))
    >>> bool((found[z > 0] == 6).all()), int(clusters.max())
    (True, 1)
    """
    density = sampling.density if density is None else density
    if gap is None:
        gap = float(np.clip(_GAP_SPACINGS / np.sqrt(density), _LEAST_GAP, _MOST_GAP))
    monitor.resolved(density=density, gap=gap)
    is_roof = _is_on_roof(segment_id, height_above_ground, min_height) & ~np.isin(classification, NOISE)
    roof = np.flatnonzero(is_roof)
    result = np.where(classification == PointClass.BUILDING, np.uint8(PointClass.UNCLASSIFIED), classification)
    cluster_id = placed(_clusters(xyz[roof], gap, min_area, density, monitor.part(0, 0.5)), roof, len(xyz))
    if sampling.is_closed_surface(source) and cluster_id.any():
        bent = bent_roofs(xyz, classification, height_above_ground, cluster_id, sampling, monitor.part(0.5, 0.9))
        is_bent = _is_on_roof(bent, height_above_ground, min_height) & (cluster_id == 0)
        cluster_id = with_bent_roofs(xyz, cluster_id, is_bent, gap, min_area, density, monitor.part(0.9, 0.95))
        # A plane whose building was only found with its bent parts is surrounded by these, from close by.
        cluster_id = join_stacked(xyz, cluster_id - 1, gap / 2) + 1
        cluster_id = split_blocks(xyz, height_above_ground, cluster_id, sampling.spacing, monitor.part(0.95, 1))
    result[cluster_id > 0] = PointClass.BUILDING
    if not cluster_id.any():
        monitor.none_found(
            f"No plane of {min_area:g} m² lies {min_height:g} m or more above the ground, so no roof was found; "
            "check that the cloud shows the ground next to the buildings."
        )
    return result.astype(np.uint8), cluster_id


def _is_on_roof(segment_id: np.ndarray, height: np.ndarray, min_height: float) -> np.ndarray:
    """Return the mask of points (n,) of planes of which half of the points at least lie above a height (m)."""
    # Other programs number segments as they like, and use -1 for points of no segment.
    number, segment = np.unique(segment_id, return_inverse=True)
    high = np.bincount(segment, height >= min_height)
    return ((2 * high >= np.bincount(segment)) & (number > 0))[segment]


def _clusters(xyz: np.ndarray, gap: float, min_area: float, density: float, monitor: Monitor) -> np.ndarray:
    """Return the building (n,) of each roof point, from 1 and from west to east; 0 where it is too small."""
    if not len(xyz):
        monitor.progress(1.0)
        return np.zeros(0, np.int32)
    cluster = join_stacked(xyz, dbscan(xyz, gap, points_at_corner(gap, density), monitor), gap)
    number = np.zeros(len(xyz), np.int32)
    member = np.flatnonzero(cluster >= 0)
    if len(member):
        member = member[(plan_areas(xyz[member], cluster[member], density) >= min_area)[cluster[member]]]
    if len(member):
        number[member] = ranked_by_least(xyz[member, 0], cluster[member])
    return number


def join_stacked(xyz: np.ndarray, cluster: np.ndarray, size: float) -> np.ndarray:
    """Return the roofs (n,) of points (n, 3), m, where one larger roof that surrounds others takes their place.

    ``cluster`` (n,) are the roofs before, from 0; -1 if unassigned. Cells have the ``size`` (m) of the distance within
    which points are of one roof.
    """
    joined = cluster.copy()
    while True:
        into = _surrounding(xyz, joined, size)
        if (into == np.arange(len(into))).all():
            return joined
        own = joined >= 0
        joined[own] = into[joined[own]]


def _surrounding(xyz: np.ndarray, cluster: np.ndarray, size: float) -> np.ndarray:
    """Return the roof (k,) that surrounds each roof, the roof itself where none does."""
    count = int(cluster.max(initial=-1)) + 1
    own = np.flatnonzero(cluster >= 0)
    into = np.arange(count)
    if count < 2:
        return into
    # A margin, so that the numbers of cells next to the border are unique.
    row, column = raster_cells(xyz[own], size, _OVER + 1)
    columns = int(column.max()) + _OVER + 2
    number = row * columns + column
    top = topmost(xyz[own, 2], number, -cluster[own])
    cells, label = number[top], cluster[own[top]]
    area = np.bincount(label, minlength=count)
    ending, beginning = _borders(cells, columns, label)
    length = np.bincount(ending, minlength=count)
    meets = beginning >= 0
    pairs, shared = np.unique(ending[meets] * count + beginning[meets], return_counts=True)
    one, other = np.divmod(pairs, count)
    inner = (shared > _ENCLOSED * length[one]) & (area[one] < area[other])
    # The surrounding roof is larger, so that there is no circle.
    into[one[inner]] = other[inner]
    return into


def _borders(cells: np.ndarray, columns: int, label: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the roof (k,) of each side of a cell where a roof ends, and the one that begins there, -1 for none.

    ``cells`` (m,) are numbers, ascending; from one row to the next they differ by ``columns``.
    """
    ending, beginning = [], []
    for step in (1, -1, columns, -columns):
        beside = np.full(len(cells), -1)
        for times in range(1, _OVER + 2):
            position, found = find_cells(cells, cells + times * step)
            beside = np.where((beside < 0) & found, label[position], beside)
        ends = beside != label
        ending.append(label[ends])
        beginning.append(beside[ends])
    return np.concatenate(ending), np.concatenate(beginning)


def split_blocks(
    xyz: np.ndarray, height: np.ndarray, cluster_id: np.ndarray, spacing: float, monitor: Monitor
) -> np.ndarray:
    """Return the buildings (n,), each house of rows and blocks as one, from 1 from west to east; 0 if unassigned.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m).
    height : ndarray of shape (n,)
        Heights above ground, m.
    cluster_id : ndarray of shape (n,)
        Buildings, from 1; 0 if unassigned.
    spacing : float
        Mean distance between points, m.
    monitor : Monitor
        Receives progress.

    Notes
    -----
    Houses are separated as in rows of gables: along lines from one side of the block to the other, a house apart. Along
    such a line a wall rises above both roofs, or one roof steps down to the other.
    """
    own = np.flatnonzero(cluster_id > 0)
    if not len(own):
        return cluster_id
    size = max(_CELL, 2 * spacing)
    top = own[highest_of_cells(xyz[own], size)[0]]
    # Roofs are compared by their elevations: over sloping ground, heights above ground vary on a level roof.
    lowest_ground = np.full(int(cluster_id.max()) + 1, np.inf)
    np.minimum.at(lowest_ground, cluster_id[top], (xyz[:, 2] - height)[top])
    corner = xyz[own, :2].min(axis=0)
    count = int(cluster_id.max())
    house = cluster_id[own].astype(np.int64)
    buildings = np.unique(cluster_id[top])
    for done, number in enumerate(buildings.tolist()):
        roof, mine = top[cluster_id[top] == number], cluster_id[own] == number
        over_lowest = xyz[roof, 2] - lowest_ground[number]
        part = _houses_at(xyz[roof, :2] - corner, over_lowest, xyz[own[mine], :2] - corner, size)
        house[mine] = np.where(part > 1, count + part - 1, number)
        count += int(part.max()) - 1
        monitor.progress((done + 1) / len(buildings))
    return placed(ranked_by_least(xyz[own, 0], house), own, len(cluster_id))


def _houses_at(plan: np.ndarray, height: np.ndarray, positions: np.ndarray, spacing: float) -> np.ndarray:
    """Return the house (k,), from 1, at positions (k, 2), m, of a building.

    Its roof has points at ``plan`` (n, 2), m, ``spacing`` (m) apart, with heights (n,) above one level, m.
    """
    shares, pieces, directions = pieces_alone(plan, spacing, 0.0)
    if not pieces:
        return np.ones(len(positions), np.int64)
    houses = split_row(shares.lattice, shares.share > shares.rest, plan, height, directions, spacing)
    return spread_out(houses.house)[shares.lattice.nearest(positions)]


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
    contacts = np.column_stack([part[touches], cluster_id[plane[nearest[touches]]]])
    pairs, count = np.unique(contacts, axis=0, return_counts=True)
    owner = np.zeros(int(part.max()) + 1, np.int32)
    # Of several buildings that a part touches, the one assigned last counts: that with the most contacts.
    order = np.lexsort((pairs[:, 1], count))
    owner[pairs[order, 0]] = pairs[order, 1]
    owner[plan_areas(xyz[bent], part, density) < min_area] = 0
    result = cluster_id.copy()
    result[bent] = owner[part]
    return result
