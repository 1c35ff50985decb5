"""Seeds of the terrain: certain ground points, from which a TIN can grow."""

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..geometry.grid import is_nearly_empty, lattice, plan_box, refuse_sparse, turned_in_plan
from ..geometry.groups import least_of
from ..geometry.raster_filling import nearest_known
from ..geometry.raster_opening import open_surface
from ..packages import ndimage
from ..rules import rule, rules
from ..sampling.kinds import MATCHING, SCENE
from ..stage import Monitor
from ..threads import made_ahead
from .free_standing import find_free_standing
from .removed_objects import ObjectRemoval


@rules
class SEEDS:
    """Which lowest points are seeds of the ground."""

    pit_slope: float = rule(5.0, "tangent", "physics: sides of pits of multipath, 5 m deep in a cell of 1 m")
    pit_share: float = rule(0.1, "share", "physics: more pulses reach the ground of dense forest")
    most_turned: float = rule(2.5, "ratio", "of the box of a turned cloud to its own; narrow strips have more")
    grids: int = rule(3, "grids of cells", "turned, decide together: on bushes it matters which points share a cell")


# Without a largest building given, windows go up to this size (m); larger halls are found as free-standing segments.
USUAL_BUILDING = 60.0


@dataclass
class Lowest:
    """Lowest points of cells from ``origin`` on.

    Index (along x, along y) of the lowest point, -1 where empty; size of the cells (m), and the number of each point's.
    """

    index: np.ndarray
    origin: np.ndarray
    cell_size: float
    cell: np.ndarray

    def points(self, chosen: np.ndarray) -> np.ndarray:
        """Return the indices of the points of the chosen, occupied cells."""
        index = self.index[chosen]
        return index[index >= 0]

    def at_points(self, values: np.ndarray) -> np.ndarray:
        """Return the value (n,) of each point's cell."""
        return values.ravel()[self.cell]


def lowest_points(xyz: np.ndarray, cell_size: float) -> Lowest:
    """Return the lowest point of each square cell of ``cell_size`` (m), at multiples of it."""
    x, y, z = xyz.T
    first = lattice(plan_box(xyz)[0], cell_size)
    row, column = ((lattice(axis, cell_size) - start).astype(np.int32) for axis, start in zip((x, y), first))
    shape = int(row.max()) + 1, int(column.max()) + 1
    cell = np.ravel_multi_index((row, column), shape)
    as_low = np.flatnonzero(z == least_of(z, cell, shape[0] * shape[1])[cell])
    # The last one written stays, so that ties go to the least x, then y, in any order of points.
    as_low = as_low[np.lexsort((-y[as_low], -x[as_low]))]
    index = np.full(shape, -1, np.int64)
    index.ravel()[cell[as_low]] = as_low
    return Lowest(index, first * cell_size, cell_size, cell)


def seeds_by_opening(
    xyz: np.ndarray,
    cell_size: float,
    max_building_size: Optional[float],
    monitor: Monitor,
    spacing: float = 0.0,
    low_uphill: bool = False,
) -> tuple[np.ndarray, np.ndarray, float]:
    """Find ground points by opening the lowest surface with growing windows.

    Segments with steps down all round are free-standing objects. So is what a window lowers by more than terrain of the
    local slope could rise. Of that, regions that join the terrain on half of their edge come back, and so do smooth
    parts that are level with the terrain around.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m).
    cell_size : float
        Cell of the surface, m.
    max_building_size : float, optional
        Least extent of the largest building, m: the last window. None is 60 m, and any size for free-standing segments.
    monitor : Monitor
        Receives progress.
    spacing : float
        Point spacing (m), where that is more than a cell.
    low_uphill : bool
        Whether the uphill eaves of halls may be as low as of any roof, see :func:`.find_free_standing`.

    Returns
    -------
    seeds : ndarray of shape (m,), int64
        Indices of the seeds.
    stands_free : ndarray of shape (n,), bool
        Points of free-standing segments, or above them: no terrain.
    size : float
        Least extent of the largest building that was looked for or found, m.

    Notes
    -----
    Progressive opening after Pingel et al. (2013), with a threshold that follows the slope of the result before, a
    coarse one first; the return of smoothly joined regions is this project's, and so are the free-standing segments. By
    these, low houses with large roofs on a slope are found, which windows shave down little by little, and halls that
    no window is large enough for. All this is done on cells that are laid in three directions, which decide together,
    so that less depends on where cells fall. Narrow strips and nearly empty clouds have one direction.

    References
    ----------
    Pingel, T. J., Clarke, K. C., McBride, W. A., 2013. An improved simple morphological filter for the terrain
    classification of airborne LIDAR data. ISPRS Journal of Photogrammetry and Remote Sensing 77, 21-30. [pingel2013]
    """
    refuse_sparse(xyz, cell_size)
    box = plan_box(xyz)
    nearly_empty = is_nearly_empty(xyz, cell_size)
    angles = _turns() if _is_compact(box) and not nearly_empty else np.zeros(1)

    count = len(angles)

    def look(number: int, part: Monitor) -> tuple[_Surface, Optional[_View]]:
        # Shift the points of each by a further third of a cell east and south, so that the cells of two grids share no
        # side.
        begin = np.array([number, -number, 0.0]) / count % 1
        cells = _Cells(box, angles[number], cell_size, spacing, low_uphill, nearly_empty)
        turned = turned_in_plan(xyz, angles[number]) + begin * cell_size
        surface = _lowest_surface(turned, cells, max_building_size, part.part(0, 0.3))
        return surface, None if number else _view(surface, xyz[:, 2], None, part.part(0.3, 1))

    # Threads find the other surfaces while the slope of the first is measured, which serves for all, as it changes
    # little.
    surfaces, (first, *_) = zip(*made_ahead(look, count, monitor.part(0, 0.7)))

    def look_again(number: int, part: Monitor) -> _View:
        return _view(surfaces[number + 1], xyz[:, 2], first.slope, part)

    views = [first, *made_ahead(look_again, count - 1, monitor.part(0.7, 1))]
    candidates = views[0].candidates
    # The first direction is the box's: it shows best which objects the end of the cloud cuts off.
    stands_free = views[0].stands_free | np.logical_and.reduce([view.stands_free for view in views[1:] or views])
    is_terrain = (sum(view.says_terrain[candidates] for view in views) > 0) & ~stands_free[candidates]
    return candidates[is_terrain], stands_free, max(max_building_size or USUAL_BUILDING, views[0].size)


@dataclass(frozen=True)
class _View:
    """Evidence of cells that are laid in one direction."""

    candidates: np.ndarray  #: (m,), int64: lowest points of the cells, without pits
    #: (n,), int8: 1 for points on or below the lowest surface where it is terrain, 0 over it, -1 where it is an object
    says_terrain: np.ndarray
    stands_free: np.ndarray  #: (n,), bool: which points lie on a free-standing segment, or above one
    size: float  #: Shorter side (m) of the largest free-standing segment
    slope: np.ndarray  #: (n,), float64: slope of the terrain (rise over run) at each point


@dataclass(frozen=True)
class _Cells:
    """Square cells over points that were turned."""

    box: np.ndarray  #: (2, 2), float64: the least and greatest easting and northing (m) before they were turned
    angle: float  #: By how much they were turned, °
    #: size, spacing: Size of the cells and spacing of the points, m
    size: float
    spacing: float
    low_uphill: bool = False  #: Whether the uphill eaves of halls may be as low as of any roof
    is_nearly_empty: bool = False  #: Whether there are far more cells than points

    def outside(self, lowest: Lowest) -> np.ndarray:
        """Return the mask of cells that lie outside the box."""
        cos, sin = np.cos(np.radians(self.angle)), np.sin(np.radians(self.angle))
        middles = (start + self.size * (np.arange(n) + 0.5) for n, start in zip(lowest.index.shape, lowest.origin))
        x, y = np.meshgrid(*middles, indexing="ij", sparse=True)
        outside = np.zeros(lowest.index.shape, bool)
        for position, low, high in zip((cos * x + sin * y, cos * y - sin * x), *self.box):
            outside |= (position < low - self.size) | (position > high + self.size)
        return outside


@dataclass(frozen=True)
class _Surface:
    """The lowest surface in cells that are laid in one direction, with its free-standing segments."""

    cells: _Cells
    lowest: Lowest
    unknown: np.ndarray  #: (rows, columns), bool: gaps and pits
    removal: ObjectRemoval  #: The surface, its free-standing segments, and how other objects are removed
    size: float  #: Shorter side (m) of the largest free-standing segment


def _lowest_surface(turned: np.ndarray, cells: _Cells, max_building: Optional[float], monitor: Monitor) -> _Surface:
    """Return the lowest surface of points (n, 3) that are ``turned`` as the cells are (m)."""
    lowest = lowest_points(turned, cells.size)
    surface, unknown = _surface(turned, lowest, monitor.part(0, 0.3))
    size, largest = max_building or USUAL_BUILDING, max_building or np.inf
    seen = np.where(cells.outside(lowest), np.nan, surface) if cells.angle else surface
    is_free, found = find_free_standing(
        seen, cells.size, size, largest, cells.spacing, monitor.part(0.3, 1), cells.low_uphill
    )
    removal = ObjectRemoval(surface, is_free, size, cells.size, cells.spacing, cells.is_nearly_empty)
    return _Surface(cells, lowest, unknown, removal, found)


def _view(seen: _Surface, z: np.ndarray, slope: Optional[np.ndarray], monitor: Monitor) -> _View:
    """Return the evidence for points of elevations ``z`` (n,), m; their slope (n,) is measured where none is given."""
    lowest, removal, is_free = seen.lowest, seen.removal, seen.removal.is_free_standing
    known = removal.slope(monitor.part(0, 0.7)) if slope is None else nearest_known(slope[lowest.index], seen.unknown)
    is_object = lowest.at_points(removal.objects(known, monitor.part(0.7, 1)))
    slope = lowest.at_points(known)
    above = z - lowest.at_points(removal.surface)
    says_terrain = np.where(is_object, -1, above <= removal.rise(slope)).astype(np.int8)
    # Points below a roof, as in a pit, lie lower than the surface there.
    stands_free = lowest.at_points(is_free) & (above >= 0)
    if seen.cells.low_uphill:
        below = lowest.at_points(_rim_levels(removal.surface, is_free)) - z
        stands_free |= (below >= 0) & (below <= MATCHING.rounded)
    return _View(lowest.points(~seen.unknown), says_terrain, stands_free, seen.size, slope)


def _rim_levels(surface: np.ndarray, is_free: np.ndarray) -> np.ndarray:
    """Return the elevation (m) of the free-standing segment next to each other cell, -inf without any.

    Matching rounds edges, so that a rim as wide as a cell lies between a roof and the terrain and joins both.
    """
    return np.where(is_free, -np.inf, ndimage.maximum_filter(np.where(is_free, surface, -np.inf), 3))


def _turns() -> np.ndarray:
    """Return the directions (°) of the grids of cells, of which a quarter turn makes the same."""
    return 90.0 * np.arange(SEEDS.grids) / SEEDS.grids


def _is_compact(box: np.ndarray) -> bool:
    """Return whether the boxes around a turned ``box`` (2, 2) are small enough to be covered by cells."""
    sides = np.ptp(box, axis=0)
    turns = ((np.cos(angle), np.sin(angle)) for angle in np.radians(_turns()))
    return all((cos * sides + sin * sides[::-1]).prod() <= SEEDS.most_turned * sides.prod() for cos, sin in turns)


def seeds_by_lowest(xyz: np.ndarray, max_building_size: float) -> np.ndarray:
    """Return the lowest point (its index) of each cell as large as the largest building, as Axelsson does."""
    refuse_sparse(xyz, max_building_size)
    lowest = lowest_points(xyz, max_building_size)
    return lowest.points(lowest.index >= 0)


def _surface(xyz: np.ndarray, lowest: Lowest, monitor: Monitor) -> tuple[np.ndarray, np.ndarray]:
    """Return the lowest surface without gaps and pits, and where these are."""
    empty = lowest.index < 0
    height = np.where(empty, np.inf, xyz[lowest.index, 2])
    unknown = empty | _pits(height, lowest.cell_size, monitor)
    return nearest_known(height, unknown), unknown


def _pits(height: np.ndarray, cell_size: float, monitor: Monitor) -> np.ndarray:
    """Return the mask of cells that hold stray points far below all others around, by their heights (inf where empty).

    Ground seen through the gaps of a forest is as far below the crowns next to it, but other gaps are near.
    """
    depth = SEEDS.pit_slope * cell_size
    surface = nearest_known(height, np.isinf(height))
    pits = (surface + open_surface(-surface, 1) < -depth) & np.isfinite(height)
    row, column = np.nonzero(pits)
    reach = max(1, round(SCENE.ground_within / cell_size))
    offsets = np.arange(-reach, reach + 1)
    around = np.pad(height, reach, constant_values=np.inf)
    level = height[row, column] + depth
    n_deep, n_known = np.zeros((2, len(row)))
    for done, down in enumerate(offsets, start=1):
        for right in offsets:
            other = around[row + reach + down, column + reach + right]
            n_deep += other < level
            n_known += np.isfinite(other)
        monitor.progress(done / len(offsets))
    # The cell itself is among them.
    pits[row, column] = n_deep - 1 < SEEDS.pit_share * n_known
    return pits
