"""Whole buildings from their roofs: gaps, edges, structures on the roof, and the walls below."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Annotated, Optional

import numpy as np

from ..cloud.asprs import NOISE, PointClass
from ..cloud.reasons import Reason
from ..geometry.grid import raster_cells, refuse_sparse
from ..packages import ndimage
from ..params import MinBuildingArea, PointDensity, PointSource
from ..sampling.cloud_sampling import CloudSampling
from ..segmentation.top_surface import TopSurface
from ..stage import Monitor, Param, stage
from ..threads import made_ahead
from .agreed_buildings import agreed
from .roof_extent import FOOT, GAP, RoofExtent, amid_rough, without_vehicles

# Side of the cells (point spacings): where a roof was seen, they hold at least a point.
_CELL_SPACINGS = 1.2

# Least side of the cells (m).
_LEAST_CELL = 0.5

# Positions of the cells of a laser scan (parts of their side), of which most decide: which bushes and ends of walls
# beside the eaves share a cell with the roof is chance. With positions at thirds of a diagonal cells at the corners of
# thinly scanned roofs hold no point in two of three, and walls below them are lost.
_POSITIONS = ((0.0, 0.0), (0.5, 0.0), (0.0, 0.5))

# Points lower than this stand on the ground (kerbs, plants, steps) and are no wall, m.
_WALL_FOOT = 0.5

# Largest vertical distance (m) from the roof of a building at which points are compared with its surfaces.
_AT_ROOF = 1.0

# Largest gap that is closed (point spacings).
_GAP_SPACINGS = 4.0

# Least value of that gap (m).
_LEAST_GAP = 3.0

# Largest value of that gap (m), that of the tunable.
_MOST_GAP = 20.0

# Share of the cells around that an object on a roof covers, below which it is a chimney or a dormer and no crown.
_SPARSE = 0.3

# Side (cells) of the square in which these are counted.
_AROUND = 7

# Height (share of the roof's height) up to which objects beside a roof may be bushes.
_BUSHES = 0.33

# Largest height (m) of bushes.
_HIGHEST_BUSHES = 2.5

# The wall of a higher roof stands no farther from it than this, m: eaves reach out, and roof surfaces end before them.
_WALL_REACH = 1.0

# Smallest patch of cells beside a building that may be a crown: walls are narrower.
_CROWN = np.ones((2, 2), bool)

# Least share of the points of a crown that the beam passed; points beside a crown are not added as wall.
_PASSED = 0.5

# Side (cells) of the square in which this share is measured.
_WITHIN = 5

_EIGHT = np.ones((3, 3), bool)


# Gaps of 3 to 20 m are closed from both sides; usual clouds have the least (m).
_REACH = 10.0


@stage(
    "Complete buildings",
    group="Buildings",
    tags="building,roof,facade,chimney,dormer,attach",
    writes=("classification", "cluster_id", "confidence", "reason"),
    reach=lambda tunables: tunables["gap"] or _REACH,
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
    gap: Annotated[
        Optional[float],
        Param(
            "Gap to close",
            "Gaps in a roof up to this wide are filled where no ground is seen in them (gutters, skylights, ridges).",
            unit="m",
            low=0,
            high=20,
            automatic="four point spacings, from 3 to 20 m; 1.5 m in clouds of matched images, which are dense.",
        ),
    ] = None,
    roof_clearance: Annotated[
        float,
        Param(
            "Clearance above the roof",
            "Points up to this far above the roof belong to it.",
            unit="m",
            low=0,
            high=20,
        ),
    ] = 1.0,
    structure_height: Annotated[
        float,
        Param(
            "Structures on the roof",
            "Points up to this far above the roof belong to it where they cover a small part of it only (chimneys, "
            "dormers, masts); what covers more is a tree.",
            unit="m",
            low=0,
            high=100,
        ),
    ] = 4.0,
    min_area: MinBuildingArea = 4.0,
    min_width: Annotated[
        float,
        Param(
            "Minimum building width",
            "Objects that are narrower everywhere are walls, railings or wires and not buildings.",
            unit="m",
            low=0,
            high=100,
        ),
    ] = 1.5,
    min_roof_share: Annotated[
        float,
        Param(
            "Minimum share of roof surfaces",
            "Share of the points up to a meter above and below a building's roof that must lie on roof surfaces; in "
            "clouds of matched images of the points inside its edges. In crowns with a smooth side it is less. 0 takes "
            "any.",
            low=0,
            high=1,
        ),
    ] = 0.6,
    density: PointDensity = None,
    source: PointSource = "automatic",
    sampling: Optional[CloudSampling] = None,
    monitor=None,
):
    """Add walls, chimneys, edges and gaps to each building, and number the buildings.

    Buildings are decided in columns: where a roof was found, everything from the foot of the walls to just above
    the roof is building, and so are chimneys and the walls along its edge. Small gaps between roof surfaces are
    closed where the ground does not show in them. In clouds of matched images roofs reach to where the rounded edge has
    half of their height, and the smeared walls below belong to them. Where the scanner numbered its returns, crowns
    beside a wall are told from it by the pulses that pass through them.

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
        Buildings 6; roofs of less than the minimum area, width or share of roof surfaces become 1.
    cluster_id : ndarray of shape (n,), int32
        Buildings from 1, from the south-west northward; 0 if unassigned.
    confidence : ndarray of shape (n,), float32, or None
        Points added to a building get the mean of its roofs, rejected roofs at most 0.5; None where not given.
    reason : ndarray of shape (n,), uint8, or None
        The same for added points and rejected roofs; None where not given.

    Raises
    ------
    ValueError
        If the points are spread so thinly that the cloud is nearly empty.

    Notes
    -----
    This stage is not part of the published method, whose clusters are roofs and lose points that are not planar or not
    connected with them. In laser scans the cells are laid in three positions, and a point is of a building where two of
    them say so, so that less depends on where cells fall.

    References
    ----------
    Santos, R. C. dos, Pessoa, G. G., Carrilho, A. C., Galo, M., 2019. Building detection from LiDAR data using
    entropy and the k-means concept, section 4 (critical regions).
    """
    sampling = sampling or CloudSampling.of(xyz, classification)
    xyz = sampling.from_corner(xyz)
    density = sampling.effective_density if density is None else density
    spacing = 1 / np.sqrt(density)
    in_images = sampling.is_closed_surface(source)
    if gap is None:
        gap = GAP if in_images else float(np.clip(_GAP_SPACINGS * spacing, _LEAST_GAP, _MOST_GAP))
    monitor.resolved(density=density, gap=gap)
    result = np.where(classification == PointClass.BUILDING, np.uint8(PointClass.UNCLASSIFIED), classification)
    is_roof = classification == PointClass.BUILDING
    if not is_roof.any():
        return result.astype(np.uint8), np.zeros(len(xyz), np.int32), confidence, reason

    roofs = _Roofs.of(xyz, height_above_ground, classification, segment_id)
    limits = _Limits(gap, density, min_area, min_width, min_roof_share)
    has_returns = return_number is not None and number_of_returns is not None
    goes_on = return_number < number_of_returns if has_returns else None
    positions = _POSITIONS[:1] if in_images else _POSITIONS

    def divided(number: int, part: Monitor) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        part.progress(0.0)
        extents = _extents_in_images(roofs, limits) if in_images else _extents_in_scan(roofs, limits, positions[number])
        columns = _Columns(extents.building, extents.top, extents.cell_size)
        points = _Points(extents.cell, xyz[:, 2], height_above_ground, extents.raised, goes_on)
        owner = columns.owners(points, roof_clearance, structure_height)
        return owner, extents.refusal(owner), np.ravel_multi_index(extents.cell, extents.building.shape)

    owners, refusals, places = zip(*made_ahead(divided, len(positions), monitor))
    cluster_id = agreed(owners, places[0])
    refusal = functools.reduce(lambda first, other: np.where(first > 0, first, other), refusals)
    result[cluster_id > 0] = PointClass.BUILDING
    return result.astype(np.uint8), cluster_id, *_explained(confidence, reason, is_roof, cluster_id, refusal)


@dataclass(frozen=True)
class _Limits:
    """Requirements of a building: gap that is closed (m), points per m², least area (m²), width (m) and roof share."""

    gap: float
    density: float
    min_area: float
    min_width: float
    min_roof_share: float


@dataclass(frozen=True)
class _Roofs:
    """All points (n,), with the roofs among them.

    Attributes
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    height : ndarray of shape (n,)
        Heights above ground, m.
    is_roof, is_noise : ndarray of shape (n,), bool
        Points of roofs to start from, and of noise.
    may_stand : ndarray of shape (n,), bool
        Points that can be of a building: neither noise nor bridge deck.
    on_surface : ndarray of shape (n,), bool, optional
        Points of roofs on a roof surface; None where these are not known.
    segment_id : ndarray of shape (n,), int32, optional
        Roof surfaces; 0 if unassigned.
    """

    xyz: np.ndarray
    height: np.ndarray
    is_roof: np.ndarray
    is_noise: np.ndarray
    may_stand: np.ndarray
    on_surface: Optional[np.ndarray]
    segment_id: Optional[np.ndarray]

    @classmethod
    def of(
        cls, xyz: np.ndarray, height: np.ndarray, classification: np.ndarray, segment_id: Optional[np.ndarray]
    ) -> _Roofs:
        """Tell roofs, noise and bridge decks by the classes of points."""
        is_roof, is_noise = classification == PointClass.BUILDING, np.isin(classification, NOISE)
        # Points on a bridge deck have no ground below them and are no walls.
        may_stand = ~is_noise & (classification != PointClass.BRIDGE_DECK)
        on_surface = None if segment_id is None else is_roof & (segment_id > 0)
        return cls(xyz, height, is_roof, is_noise, may_stand, on_surface, segment_id)


@dataclass(frozen=True)
class _Extents:
    """Where buildings are in plan.

    Attributes
    ----------
    cell : tuple of two ndarrays of shape (n,)
        Row and column of the cell that each point is in.
    cell_size : float
        Their size, m.
    building : ndarray of shape (rows, columns), int32
        Number of the building that covers each cell; 0 for cells without building.
    refused : ndarray of shape (rows, columns), uint8
        Reason why the roof over a cell was rejected.
    top : ndarray of shape (rows, columns)
        Elevation of the roof in each cell or the nearest one with a roof, m.
    raised : ndarray of shape (n,), bool
        Points that belong to a building if their cell does.
    """

    cell: tuple[np.ndarray, np.ndarray]
    cell_size: float
    building: np.ndarray
    refused: np.ndarray
    top: np.ndarray
    raised: np.ndarray

    def refusal(self, owner: np.ndarray) -> np.ndarray:
        """Return why points (n,) are of no building, as :class:`~..cloud.reasons.Reason`; 0 for points of one."""
        why = np.where(self.building[self.cell] > 0, np.uint8(Reason.TOO_LOW), self.refused[self.cell])
        return np.where(owner > 0, np.uint8(0), why)


def _extents_in_scan(roofs: _Roofs, limits: _Limits, position: tuple[float, float]) -> _Extents:
    """Return where buildings are in a laser scan: in cells with roof points, gaps closed where no ground shows.

    Cells are moved by ``position``, in parts of their side.
    """
    cell_size = max(_LEAST_CELL, _CELL_SPACINGS / np.sqrt(limits.density))
    refuse_sparse(roofs.xyz, cell_size)
    margin = int(np.ceil(limits.gap / cell_size)) + 2
    cell = raster_cells(roofs.xyz[:, :2] + np.array(position) * cell_size, cell_size, margin)
    raised = (roofs.height >= _WALL_FOOT) & roofs.may_stand
    # Multipath through a skylight is no ground that shows in it.
    covered = _covered(cell, roofs.is_roof, ~raised & ~roofs.is_noise, limits.gap, cell_size)
    building, refused = _numbered(covered, limits.min_area, limits.min_width, cell_size)
    top = _roof_top(cell, roofs.xyz[:, 2], roofs.is_roof, covered)
    if roofs.on_surface is not None:
        at_roof = raised & (np.abs(roofs.xyz[:, 2] - top[cell]) <= _AT_ROOF)
        building, refused = _mostly_roof(building, refused, cell, at_roof, roofs.on_surface, limits.min_roof_share)
    return _Extents(cell, cell_size, building, refused, top, raised)


def _extents_in_images(roofs: _Roofs, limits: _Limits) -> _Extents:
    """Return where buildings are in a cloud of matched images: to half the height of the rounded edges of roofs."""
    surface = TopSurface(roofs.xyz, roofs.height, ~roofs.is_noise, limits.density)
    cell = surface.cell
    core = roofs.is_roof
    if roofs.segment_id is not None:
        core = core & ~amid_rough(surface, roofs.xyz, roofs.segment_id)
    extent = RoofExtent(surface, _cells_with(cell, core, surface.height.shape))
    covered = extent.covered(limits.min_width, limits.gap)
    building, refused = _numbered(covered, limits.min_area, limits.min_width, surface.size)
    refused[_cells_with(cell, roofs.is_roof & ~core, refused.shape) & (building == 0)] = Reason.MOSTLY_OTHER
    building, refused = without_vehicles(extent, building, refused)
    building = _numbers(np.bincount(building.ravel()) > 0)[building]
    if roofs.on_surface is not None:
        at_roof = extent.interior(building)[cell] & surface.on_top(roofs.xyz) & ~roofs.is_noise
        building, refused = _mostly_roof(building, refused, cell, at_roof, roofs.on_surface, limits.min_roof_share)
    # Nothing is seen beneath a roof but its own walls, down to their feet.
    raised = (roofs.height >= _WALL_FOOT) | (building[cell] > 0)
    building = extent.faces(building)
    raised |= (building[cell] > 0) & (roofs.height >= FOOT)
    top = _roof_top(cell, roofs.xyz[:, 2], roofs.is_roof, covered)
    return _Extents(cell, surface.size, building, refused, top, raised & roofs.may_stand)


def _explained(
    confidence: Optional[np.ndarray],
    reason: Optional[np.ndarray],
    is_roof: np.ndarray,
    cluster_id: np.ndarray,
    refusal: np.ndarray,
) -> tuple[Optional[np.ndarray], Optional[np.ndarray]]:
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


def _may_be_bush(height: np.ndarray, roof: np.ndarray) -> np.ndarray:
    """Return which points beside a building are so low that bushes at the foot of its wall reach them."""
    return height < np.minimum(_BUSHES * roof, _HIGHEST_BUSHES)


@dataclass(frozen=True)
class _Points:
    """All points (n,), as they are compared with buildings.

    Attributes
    ----------
    cell : tuple of two ndarrays of shape (n,)
        Row and column of the cell that each is in.
    elevation, height : ndarray of shape (n,)
        Elevation and height above ground, m.
    raised : ndarray of shape (n,), bool
        Higher than the foot of a wall, and no noise.
    goes_on : ndarray of shape (n,), bool, optional
        Whether the pulse went on to another return; None where returns are not known.
    """

    cell: tuple[np.ndarray, np.ndarray]
    elevation: np.ndarray
    height: np.ndarray
    raised: np.ndarray
    goes_on: Optional[np.ndarray]


class _Columns:
    """The cells of buildings: whose they are, whose roof they stand beside, and how high it and the highest near is."""

    def __init__(self, building: np.ndarray, top: np.ndarray, cell_size: float) -> None:
        self.building = building
        self.top = top
        reach = 2 * max(1, round(_WALL_REACH / cell_size)) + 1
        self.highest = ndimage.maximum_filter(np.where(building > 0, top, -np.inf), reach)
        beside = ndimage.grey_dilation(building, footprint=_EIGHT)
        self.beside = np.where(building > 0, 0, beside)

    def owners(self, points: _Points, clearance: float, structure_height: float) -> np.ndarray:
        """Return the building (n,), int32, that each point belongs to; 0 if unassigned.

        Points up to the clearance (m) above the roof do, those up to the height of structures (m) where they are few.
        """
        above = points.elevation - self.top[points.cell]
        inside = points.raised & (self.building[points.cell] > 0)
        stands_above = inside & (above > clearance)
        is_chimney = stands_above & (above <= structure_height) & self.is_sparse(points.cell, stands_above)[points.cell]
        may_be_plant = _may_be_bush(points.height, points.height - above)
        if points.goes_on is not None:
            may_be_plant |= self.is_beside_crown(points.cell, points.raised, points.goes_on)[points.cell]
        # Points between a roof and the next higher one are the wall of the higher one.
        is_wall = points.raised & (points.elevation <= self.highest[points.cell]) & (inside | ~may_be_plant)
        owner = np.where(inside, self.building[points.cell], self.beside[points.cell])
        return np.where((inside & (above <= clearance)) | is_chimney | is_wall, owner, 0).astype(np.int32)

    def is_sparse(self, cell: tuple[np.ndarray, np.ndarray], stands_above: np.ndarray) -> np.ndarray:
        """Return the cells around which the points that stand above the roof cover a small part of it."""
        row, column = cell
        standing = np.zeros(self.building.shape)
        standing[row[stands_above], column[stands_above]] = 1
        around = ndimage.uniform_filter(standing, _AROUND, mode="constant")
        roof = ndimage.uniform_filter((self.building > 0).astype(float), _AROUND, mode="constant")
        return around < _SPARSE * roof

    def is_beside_crown(
        self, cell: tuple[np.ndarray, np.ndarray], raised: np.ndarray, goes_on: np.ndarray
    ) -> np.ndarray:
        """Return the cells of crowns that stand apart from buildings, and the cells next to them."""
        row, column = cell
        apart = raised & (self.building[cell] == 0) & (self.beside[cell] == 0)
        shape = self.building.shape
        number = np.ravel_multi_index((row[apart], column[apart]), shape)
        # Means of whole numbers would be rounded to such.
        standing, passed = (
            np.bincount(number, weights, np.prod(shape)).reshape(shape).astype(float)
            for weights in (None, goes_on[apart])
        )
        around, passed_around = (
            ndimage.uniform_filter(count, _WITHIN, mode="constant") for count in (standing, passed)
        )
        crown = ndimage.binary_opening(standing > 0, _CROWN) & (passed_around > _PASSED * around)
        return ndimage.binary_dilation(crown, _EIGHT)


def _covered(
    cell: tuple[np.ndarray, np.ndarray], is_roof: np.ndarray, is_low: np.ndarray, gap: float, cell_size: float
) -> np.ndarray:
    """Return the cells (rows, columns) that roofs cover, gaps closed where the ground doesn't show."""
    row, column = cell
    margin = int(np.ceil(gap / cell_size)) + 2
    shape = (row.max() + margin, column.max() + margin)
    roof, open_ground = (_cells_with(cell, points, shape) for points in (is_roof, is_low))
    closed = roof
    reach = round(gap / 2 / cell_size)
    if reach:
        closed = roof | ndimage.binary_closing(roof, _disk(reach))
    holes = ndimage.binary_fill_holes(closed) & ~closed
    # A hole as narrow as the gap may be closed too; a courtyard may not.
    small = _small(holes, max(1.0, (gap / cell_size) ** 2))
    return roof | ((closed | small) & ~open_ground)


def _cells_with(cell: tuple[np.ndarray, np.ndarray], points: np.ndarray, shape: tuple[int, int]) -> np.ndarray:
    """Return which cells of a raster hold one of the chosen points (n,)."""
    row, column = cell
    cells = np.zeros(shape, bool)
    cells[row[points], column[points]] = True
    return cells


def _small(mask: np.ndarray, most: float) -> np.ndarray:
    """Return the part of ``mask`` that lies in regions of at most ``most`` cells."""
    region, count = ndimage.label(mask)
    size = np.bincount(region.ravel(), minlength=count + 1)
    size[0] = 0
    return mask & (size <= most)[region]


def _numbered(
    covered: np.ndarray, min_area: float, min_width: float, cell_size: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return numbers from 1 for regions that are large and wide enough, from the south-west; why the others are not."""
    region, count = ndimage.label(covered, _EIGHT)
    is_large = np.bincount(region.ravel(), minlength=count + 1) * cell_size**2 >= min_area
    # The distance to the nearest cell outside is 1 in a strip of one or two cells, 2 in one of three or four.
    inward = ndimage.maximum(ndimage.distance_transform_edt(covered), region, np.arange(count + 1))
    number = _numbers(is_large & ((2 * inward - 1) * cell_size >= min_width))
    return number[region], np.where(is_large, Reason.TOO_NARROW, Reason.TOO_SMALL).astype(np.uint8)[region]


def _mostly_roof(
    building: np.ndarray,
    refused: np.ndarray,
    cell: tuple[np.ndarray, np.ndarray],
    at_roof: np.ndarray,
    on_surface: np.ndarray,
    least: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Return what :func:`_numbered` does, without buildings with less than ``least`` of their roof on surfaces."""
    number = building[cell]
    whole, part = (np.bincount(number[of], minlength=building.max() + 1) for of in (at_roof, at_roof & on_surface))
    # Buildings too narrow for anything but edges are not judged.
    share = np.where(whole > 0, part / np.maximum(whole, 1), 1.0)
    kept = _numbers(share >= least)[building]
    return kept, np.where((building > 0) & (kept == 0), np.uint8(Reason.MOSTLY_OTHER), refused)


def _numbers(kept: np.ndarray) -> np.ndarray:
    """Return the new numbers (m,), int32, of regions: from 1 for those that are kept, 0 for others and for region 0."""
    kept = kept & (np.arange(len(kept)) > 0)
    return np.where(kept, np.cumsum(kept), 0).astype(np.int32)


def _roof_top(
    cell: tuple[np.ndarray, np.ndarray], elevation: np.ndarray, is_roof: np.ndarray, covered: np.ndarray
) -> np.ndarray:
    """Return the elevation (rows, columns) of the highest roof point of each cell, or of the nearest such cell."""
    row, column = cell
    top = np.full(covered.shape, -np.inf)
    np.maximum.at(top, (row[is_roof], column[is_roof]), elevation[is_roof])
    nearest = ndimage.distance_transform_edt(~np.isfinite(top), return_distances=False, return_indices=True)
    return top[tuple(nearest)]


def _disk(radius: int) -> np.ndarray:
    row, column = np.mgrid[-radius : radius + 1, -radius : radius + 1]
    return row**2 + column**2 <= radius**2 + 0.5 * radius
