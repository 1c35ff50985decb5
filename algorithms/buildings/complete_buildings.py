"""Whole buildings from their roofs: gaps, edges, structures on the roof, and the walls below."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..cloud.asprs import NOISE, PointClass
from ..cloud.reasons import Reason
from ..geometry.grid import raster_cells, refuse_sparse
from ..geometry.groups import least_of, placed, ranked_by_least
from ..geometry.raster_filling import nearest_known
from ..packages import ndimage
from ..params import MIN_BUILDING_AREA, POINT_DENSITY, POINT_SOURCE
from ..rules import rule, rules
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..sampling.kinds import IMAGES, LASER, SCENE
from ..sampling.surface_noise import ON_PLANE
from ..sampling.top_surface import TopSurface
from ..stage import stage, tunable
from .building_columns import ColumnPoints, Columns, column_size
from .roof_coverage import Cell, Coverage, cells_with, covered_cells, mostly_roof, numbered, renumbered, roof_top
from .roof_extent import RoofExtent, amid_rough, without_vehicles

# Values (n,) of a dimension, None where the cloud lacks it.
_Dimension = Optional[np.ndarray]

# Width of the widest court (m), and the distance within which streets count: beyond a building of 15 m, as far again.
AROUND = 30.0


@rules
class COMPLETION:
    """Gaps of buildings."""

    gap: float = rule(4.0, "point spacings", "statistics: random points hardly ever leave larger gaps in a roof")
    least_gap: float = rule(3.0, "m", "physics: ridges, gutters and skylights are narrower")


@stage(
    "Buildings",
    tags="building,roof,facade,chimney,dormer,attach",
    writes=("classification", "cluster_id", "confidence", "reason"),
    written_if={"confidence": "where the cloud has them", "reason": "where the cloud has them"},
    # Gaps are closed from both sides. This reach shows a court at the edge of a tile whole, the reach of later steps
    # its streets.
    reach=lambda tunables: max(tunables["gap"] or 0.0, AROUND),
    cost=0.7,
)
def complete_buildings(
    xyz,
    classification,
    height_above_ground,
    confidence=None,
    reason=None,
    segment_id=None,
    return_number=None,
    number_of_returns=None,
    *,
    gap: Optional[float] = tunable(
        None,
        label="Gap to close",
        within=f"[0, {2 * SCENE.ground_within}] m",
        automatic=f"{COMPLETION.gap:g} point spacings, from {COMPLETION.least_gap:g} to {2 * SCENE.ground_within:g} m.",
    ),
    roof_clearance: float = tunable(1.0, label="Clearance above the roof", within="[0, 20] m"),
    structure_height: float = tunable(4.0, label="Structures on the roof", within="[0, 100] m"),
    min_area: float = MIN_BUILDING_AREA,
    min_roof_share: float = tunable(0.6, label="Minimum share of roof surfaces", within="[0, 1]"),
    density: Optional[float] = POINT_DENSITY,
    source: str = POINT_SOURCE,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Add walls, chimneys, edges and gaps to each building, and number the buildings.

    Buildings are decided in columns: where a roof was found, everything from the foot of the walls to just above
    the roof is building, and so are chimneys and the walls along its edge. Small gaps between roof surfaces are
    closed where the ground does not show in them. In clouds of matched images roofs reach to where the rounded edge has
    half of their height, and the smeared walls below belong to them. Ground of an inner court that lies as high over
    the streets around as a roof is a deck, and of the building. Where the scanner numbered its returns, crowns
    at a wall are separated from it by the pulses that pass through them.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; points of class 6 are the roofs to start from.
    height_above_ground : ndarray of shape (n,), float32
        Heights, m.
    confidence : ndarray of shape (n,), float32, optional
        How sure the roofs are buildings, 0 to 1.
    reason : ndarray of shape (n,), uint8, optional
        Why the roofs are buildings, see :class:`~..cloud.reasons.Reason`.
    segment_id : ndarray of shape (n,), int32, optional
        Roof surfaces; 0 if unassigned. Without it the share of roof surfaces is not examined.
    return_number, number_of_returns : ndarray of shape (n,), uint8, optional
        Without them crowns are not looked for.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        Buildings 6, among them decks of inner courts that were ground; roofs of less than the minimum area or share of
        roof surfaces become 1.
    cluster_id : ndarray of shape (n,), int32
        Buildings from 1, from the south-west northward; 0 if unassigned.
    confidence : ndarray of shape (n,), float32, or None
        Points added to a building get the mean of its roofs, rejected roofs at most 0.5; None where not given.
    reason : ndarray of shape (n,), uint8, or None
        Why points were added to a building and roofs rejected; other points keep theirs. None where not given.

    Other Parameters
    ----------------
    gap
        Gaps in a roof up to this wide are filled where no ground is seen in them (gutters, skylights, ridges).
    roof_clearance
        Points up to this far above the roof belong to it.
    structure_height
        Points up to this far above the roof belong to it where they cover a small part of it only (chimneys, dormers,
        masts). Trees cover more.
    min_roof_share
        Share of the points at about the height of a building's roof, within the clearance above and below, that must
        lie on roof surfaces. In crowns with a smooth side it is less. 0 accepts any; in clouds of matched images it is
        not examined.

    Raises
    ------
    ValueError
        If the points are spread so thinly that the cloud is nearly empty.

    Notes
    -----
    This stage is not part of the published method, whose clusters are roofs and lose points that are not planar or not
    connected with them.

    References
    ----------
    Santos, R. C. dos, Pessoa, G. G., Carrilho, A. C., Galo, M., 2019. Building detection from LiDAR data using entropy
    and the k-means concept, section 4 (critical regions). [santos2019]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 6, 2)
    >>> found, clusters, *_ = complete_buildings(xyz, classes, z)
    >>> int(clusters.max())
    1
    """
    xyz = sampling.from_corner(xyz)
    density = sampling.effective_density if density is None else density
    kind = sampling.kind(source)
    if gap is None:
        # Wider gaps show ground in their middle.
        gap = float(np.clip(COMPLETION.gap / np.sqrt(density), COMPLETION.least_gap, 2 * SCENE.ground_within))
    monitor.resolved(density=density, gap=gap)
    result = np.where(classification == PointClass.BUILDING, np.uint8(PointClass.UNCLASSIFIED), classification)
    is_roof = classification == PointClass.BUILDING
    if not is_roof.any():
        return result.astype(np.uint8), np.zeros(len(xyz), np.int32), confidence, reason

    # 1. Where buildings are in plan.
    roofs = _Roofs.of(xyz, height_above_ground, classification, segment_id)
    limits = _Limits(gap, density, min_area, min_roof_share, roof_clearance)
    coverage = kind.choose(laser=_coverage_in_scan, images=_coverage_in_images)(roofs, limits)
    monitor.progress(0.5)

    # 2. The points in their columns.
    columns = Columns(coverage.building, coverage.top, coverage.cell_size)
    has_returns = return_number is not None and number_of_returns is not None
    goes_on = return_number < number_of_returns if has_returns else np.zeros(len(xyz), bool)
    points = ColumnPoints(coverage.cell, xyz[:, 2], height_above_ground, coverage.raised, goes_on)
    owner = columns.owners(points, roof_clearance, structure_height)
    is_ground = classification == PointClass.GROUND
    decks = deck_cells(coverage.building, coverage.cell, xyz[:, 2], is_ground, coverage.cell_size, min_area)
    owner = np.where(is_ground & (owner == 0), decks[coverage.cell], owner)
    cluster_id = _in_order(owner, np.ravel_multi_index(coverage.cell, coverage.building.shape))

    result[cluster_id > 0] = PointClass.BUILDING
    explained = _explained(confidence, reason, is_roof, cluster_id, coverage.refusal(owner))
    return result.astype(np.uint8), cluster_id, *explained


@dataclass(frozen=True)
class _Limits:
    """Requirements of a building: gap that is closed (m), points per m², least area (m²), roof share, clearance (m)."""

    gap: float
    density: float
    min_area: float
    min_roof_share: float
    clearance: float


@dataclass(frozen=True)
class _Roofs:
    """All points (n,), with the roofs to start from."""

    xyz: np.ndarray  #: (n, 3): coordinates, m
    height: np.ndarray  #: (n,): height above ground, m
    is_roof: np.ndarray  #: (n,), bool: points of the roofs to start from
    is_noise: np.ndarray  #: (n,), bool: points of noise
    may_belong: np.ndarray  #: (n,), bool: points that may be of a building: neither noise nor bridge decks
    segment_id: _Dimension  #: (n,): roof surface of each point; 0 if unassigned

    @classmethod
    def of(cls, xyz: np.ndarray, height: np.ndarray, classification: np.ndarray, segment_id: _Dimension) -> _Roofs:
        """Find roofs, noise and bridge decks by the classes of points."""
        is_roof, is_noise = classification == PointClass.BUILDING, np.isin(classification, NOISE)
        # Points on a bridge deck have no ground below them and are no walls.
        return cls(xyz, height, is_roof, is_noise, ~is_noise & (classification != PointClass.BRIDGE_DECK), segment_id)


def _coverage_in_scan(roofs: _Roofs, limits: _Limits) -> Coverage:
    """Return the area of buildings in a laser scan: cells with roof points, and gaps between them without ground."""
    cell_size = column_size(limits.density)
    refuse_sparse(roofs.xyz, cell_size)
    cell = raster_cells(roofs.xyz[:, :2], cell_size, int(np.ceil(limits.gap / cell_size)) + 2)
    raised = (roofs.height >= LASER.foot) & roofs.may_belong
    # Multipath points below a skylight are no visible ground.
    covered = covered_cells(cell, roofs.is_roof, ~raised & ~roofs.is_noise, limits.gap, cell_size)
    building, refused = numbered(covered, limits.min_area, cell_size)
    top = roof_top(cell, roofs.xyz[:, 2], roofs.is_roof, covered.shape)
    if roofs.segment_id is not None:
        at_roof = raised & (np.abs(roofs.xyz[:, 2] - top[cell]) <= limits.clearance)
        on_surface = roofs.is_roof & (roofs.segment_id > 0)
        building, refused = mostly_roof(building, refused, cell, at_roof, on_surface, limits.min_roof_share)
    return Coverage(cell, cell_size, building, refused, top, raised)


def _coverage_in_images(roofs: _Roofs, limits: _Limits) -> Coverage:
    """Return the area of buildings in a cloud of matched images, whose rounded edges end at half the roof's height."""
    surface = TopSurface(roofs.xyz, roofs.height, ~roofs.is_noise, limits.density)
    cell = surface.cell
    core = roofs.is_roof
    if roofs.segment_id is not None:
        core = core & ~amid_rough(surface, roofs.xyz, roofs.segment_id)
    extent = RoofExtent(surface, cells_with(cell, core, surface.height.shape))
    covered = extent.covered(limits.gap)
    building, refused = numbered(covered, limits.min_area, surface.size)
    refused[cells_with(cell, roofs.is_roof & ~core, refused.shape) & (building == 0)] = Reason.MOSTLY_OTHER
    building, refused = without_vehicles(extent, building, refused)
    building = renumbered(np.bincount(building.ravel()) > 0)[building]
    # Nothing is seen beneath a roof but its own walls, down to their feet.
    raised = (roofs.height >= LASER.foot) | (building[cell] > 0)
    building = extent.faces(building)
    raised |= (building[cell] > 0) & (roofs.height >= IMAGES.foot)
    top = roof_top(cell, roofs.xyz[:, 2], roofs.is_roof, covered.shape)
    return Coverage(cell, surface.size, building, refused, top, raised & roofs.may_belong)


def _in_order(owner: np.ndarray, cell: np.ndarray) -> np.ndarray:
    """Return the numbers (n,), int32, of buildings with points, from 1 without gaps, in the order of their cells."""
    rows = np.flatnonzero(owner)
    return placed(ranked_by_least(cell[rows], owner[rows]), rows, len(owner))


def _explained(
    confidence: _Dimension, reason: _Dimension, is_roof: np.ndarray, cluster_id: np.ndarray, refusal: np.ndarray
) -> tuple[_Dimension, _Dimension]:
    """Return confidence and reason of points added to buildings and of rejected roofs."""
    is_added, is_dropped = (cluster_id > 0) & ~is_roof, (cluster_id == 0) & is_roof
    if reason is not None:
        reason = np.where(is_added, Reason.ATTACHED, np.where(is_dropped, refusal, reason)).astype(np.uint8)
    if confidence is not None:
        known = is_roof & (cluster_id > 0) & np.isfinite(confidence)
        count = np.bincount(cluster_id[known], minlength=int(cluster_id.max()) + 1)
        total = np.bincount(cluster_id[known], confidence[known], len(count))
        mean = np.divide(total, count, out=np.full(len(count), np.nan), where=count > 0)
        most = np.where(is_dropped, np.minimum(confidence, 0.5), confidence)
        confidence = np.where(is_added, mean[cluster_id], most).astype(np.float32)
    return confidence, reason


def deck_cells(
    building: np.ndarray, cell: Cell, elevation: np.ndarray, is_ground: np.ndarray, cell_size: float, min_area: float
) -> np.ndarray:
    """Return the building (rows, columns) that surrounds the deck in each cell; 0 in cells without a deck.

    A deck lies higher than the streets around by at least the height of the lowest roof. Their slope is continued to
    the court, as the court of a castle on a hill is ground.

    Parameters
    ----------
    building : ndarray of shape (rows, columns), int32
        Number of the building that covers each cell, 0 for none; the outermost cells have none.
    cell : Cell
        Cell of each point.
    elevation : ndarray of shape (n,)
        Elevation of each point, m.
    is_ground : ndarray of shape (n,), bool
        Points of the ground.
    cell_size : float
        Side of a cell, m.
    min_area : float
        Least area of a deck, m².
    """
    region, count = ndimage.label(building == 0)
    number = np.ravel_multi_index(cell, building.shape)[is_ground]
    ground = least_of(elevation[is_ground], number, building.size).reshape(building.shape)
    boxes = ndimage.find_objects(region)
    widest = np.array([max(side.stop - side.start for side in box) for box in boxes]) * cell_size
    is_court = np.append(False, widest <= AROUND)
    is_large = np.bincount(region.ravel(), minlength=count + 1) * cell_size**2 >= min_area
    street = np.where(is_court[region] | (region == 0), np.inf, ground)
    margin = int(np.ceil(AROUND / cell_size))
    deck = np.zeros(building.shape, bool)
    for court in np.flatnonzero(is_court & is_large):
        around = tuple(slice(max(0, side.start - margin), side.stop + margin) for side in boxes[court - 1])
        is_inside = region[around] == court
        deck[around] |= is_inside & (_rise(street[around], ground[around], is_inside, cell_size) > LASER.lowest_roof)
    patch, count = ndimage.label(deck)
    is_large = np.bincount(patch.ravel(), minlength=count + 1) * cell_size**2 >= min_area
    return np.where(deck & is_large[patch], nearest_known(building, building == 0), 0)


def _rise(street: np.ndarray, ground: np.ndarray, is_court: np.ndarray, cell_size: float) -> np.ndarray:
    """Return how high (rows, columns) the ground of a court lies over the streets, continued to it, m.

    ``street`` and ``ground`` are elevations, m, infinite in cells without; -inf where there are fewer cells of streets
    than of the court.
    """
    outside = np.isfinite(street)
    if outside.sum() < is_court.sum():
        return np.full(ground.shape, -np.inf)
    away, depth = (ndimage.distance_transform_edt(cells) * cell_size for cells in (~is_court, is_court))
    near, level = away[outside], street[outside]
    fall = max(0.0, -float(np.cov(near, level)[0, 1] / near.var())) if np.ptp(near) else 0.0
    continued = level + fall * near
    # This percentile leaves out stairs and walls, which few cells of streets have.
    rise = ground - (continued.mean() + ON_PLANE * continued.std()) - fall * depth
    return np.where(np.isfinite(ground), rise, -np.inf)
