"""Extent of roofs in clouds of matched images, whose edges are rounded, and objects of the size of vehicles."""

from dataclasses import dataclass

import numpy as np

from ..cloud.reasons import Reason
from ..geometry.grid import EIGHT
from ..geometry.raster_filling import nearest_known
from ..packages import ndimage
from ..rules import rule, rules
from ..sampling.kinds import IMAGES, MATCHING
from ..sampling.top_surface import TopSurface
from ..terrain.free_standing import FREE
from .roof_coverage import disk


@rules
class IMAGE_ROOFS:
    """Roofs and vehicles in clouds of matched images."""

    least_width: float = rule(1.5, "m", "physics: narrower objects are walls, railings or hedges")


@rules
class VEHICLES:
    """Sizes of cars and vans, with their smeared edges; buses are wider and longer."""

    width: float = rule(2.6, "m", "physics: the width that roads admit")
    least_length: float = rule(4.0, "m", "fitted: 4.3 m, the shortest van, loses 0.4 % of F of a real town")
    most_length: float = rule(7.5, "m", "physics: length of the longest van")
    height: float = rule(3.0, "m", "physics: height of the highest van")


# Directions (radians) tried for the smallest rectangle around an object.
_DIRECTIONS = np.radians(np.arange(0.0, 90.0, 5.0))


def amid_rough(surface: TopSurface, xyz: np.ndarray, segment_id: np.ndarray) -> np.ndarray:
    """Return the mask of points (n,) that are of roof surfaces that rough points surround.

    Parameters
    ----------
    surface : TopSurface
        The surface of the points ``xyz`` (n, 3), m, seen from above.
    segment_id : ndarray of shape (n,), int32
        Roof surfaces from 1; 0 if unassigned.
    """
    on_top = np.flatnonzero((segment_id > 0) & surface.on_top(xyz))
    row, column = surface.cell[0][on_top], surface.cell[1][on_top]
    on_surface, raised = np.zeros((2, *surface.height.shape))
    raised[surface.height >= IMAGES.raised] = 1.0
    on_surface[row, column] = raised[row, column]
    side = 2 * max(1, round(IMAGE_ROOFS.least_width / surface.size)) + 1
    part, whole = (ndimage.uniform_filter(cells, side, mode="constant") for cells in (on_surface, raised))
    share = np.divide(part, whole, out=np.zeros_like(part), where=raised > 0)[row, column]
    # Other programs number surfaces as they like.
    segments, which = np.unique(segment_id[on_top], return_inverse=True)
    mean = np.bincount(which, share) / np.bincount(which)
    return np.isin(segment_id, segments[mean < FREE.most])


@dataclass(frozen=True)
class RoofExtent:
    """Roofs in the cells of a surface, up to their edges."""

    surface: TopSurface  #: The surface seen from above
    is_roof: np.ndarray  #: (rows, columns), bool: cells with points of roofs that are buildings

    def covered(self, gap: float) -> np.ndarray:
        """Return the cells (rows, columns) that roofs cover.

        Narrow parts are left out; gaps of at most ``gap`` (m) between roofs are closed.
        """
        raised = self.surface.height >= IMAGES.raised
        closed = self.is_roof
        if gap >= self.surface.size:
            closed = closed | (ndimage.binary_closing(self.is_roof, self._disk(gap / 2)) & raised)
            closed |= self._small_holes(closed, gap) & raised
        wide = ndimage.binary_opening(closed, self._disk(IMAGE_ROOFS.least_width / 2))
        # Opening also rounds corners; restore them within two cells.
        wide = ndimage.binary_dilation(wide, EIGHT, 2, mask=closed) if wide.any() else wide
        return self._to_edges(wide)

    def _to_edges(self, core: np.ndarray) -> np.ndarray:
        """Return roofs (rows, columns) with the cells next to them that have at least half of their height.

        These are at most ``MATCHING.rounded`` m away.
        """
        if not core.any():
            return core
        # Image matching smears a step evenly to both sides.
        is_edge = self.surface.height >= 0.5 * nearest_known(self.surface.height, ~core)
        steps = max(1, round(MATCHING.rounded / self.surface.size))
        grown = ndimage.binary_dilation(core, ndimage.generate_binary_structure(2, 1), steps, mask=core | is_edge)
        # Smeared walls, fences and branches that reach out are thinner than the objects that carry them.
        return core | ndimage.binary_opening(grown, EIGHT)

    def faces(self, building: np.ndarray) -> np.ndarray:
        """Return numbered buildings (rows, columns) with the smeared walls around them.

        Walls are steep faces that fall from the edge of the roof without a break. What grows at their foot has a top of
        its own, where the surface is level again.
        """
        cross = ndimage.generate_binary_structure(2, 1)
        grown = building.copy()
        for _ in range(max(1, round(MATCHING.rounded / self.surface.size))):
            above = ndimage.grey_dilation(np.where(grown > 0, self.surface.elevation, -np.inf), footprint=cross)
            falls = self.surface.elevation <= above - FREE.steep * self.surface.size
            is_face = (grown == 0) & falls & (self.surface.height >= IMAGES.foot)
            grown = np.where(is_face, ndimage.grey_dilation(grown, footprint=cross), grown)
        return grown

    def vehicles(self, region: np.ndarray, count: int) -> np.ndarray:
        """Return the mask of regions (count + 1,) of labeled cells that are of the size of a car or van."""
        found = np.zeros(count + 1, bool)
        for number, where in enumerate(ndimage.find_objects(region, count), start=1):
            extent = [(part.stop - part.start) * self.surface.size for part in where]
            if max(extent) <= np.hypot(VEHICLES.width, VEHICLES.most_length):
                inside = region[where] == number
                found[number] = self._is_vehicle(inside, self.surface.height[where][inside])
        return found

    def _is_vehicle(self, inside: np.ndarray, height: np.ndarray) -> bool:
        """Return whether cells (rows, columns) with heights (k,), m, have the size of a vehicle."""
        # The sides are accurate to one cell.
        cell = self.surface.size
        width, length = smallest_rectangle(inside, cell)
        has_length = VEHICLES.least_length - cell <= length <= VEHICLES.most_length + cell
        # A tenth of its points may be higher, such as wires and branches above.
        is_low = float(np.percentile(height, 90)) <= VEHICLES.height
        return bool(width <= VEHICLES.width + cell and has_length and is_low)

    def _small_holes(self, closed: np.ndarray, gap: float) -> np.ndarray:
        """Return holes (rows, columns) of at most the area of a square as wide as the gap (m)."""
        holes, count = ndimage.label(ndimage.binary_fill_holes(closed) & ~closed)
        size = np.bincount(holes.ravel(), minlength=count + 1)
        size[0] = 0
        return (holes > 0) & (size * self.surface.size**2 <= gap**2)[holes]

    def _disk(self, radius: float) -> np.ndarray:
        """Return a disk of ``radius`` (m) as cells."""
        return disk(max(1, round(radius / self.surface.size)))


def smallest_rectangle(inside: np.ndarray, size: float) -> tuple[float, float]:
    """Return width and length (m) of the smallest rectangle around cells of ``size`` (m)."""
    positions = np.argwhere(inside) * size
    along = np.column_stack([np.cos(_DIRECTIONS), np.sin(_DIRECTIONS)])
    across = np.column_stack([-np.sin(_DIRECTIONS), np.cos(_DIRECTIONS)])
    sides = np.array([np.ptp(positions @ axis.T, axis=0) + size for axis in (along, across)])
    width, length = np.sort(sides[:, int(np.argmin(sides[0] * sides[1]))]).tolist()
    return width, length


def without_vehicles(extent: RoofExtent, building: np.ndarray, refused: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return numbered regions (rows, columns) without vehicles, and why cells are refused."""
    gone = extent.vehicles(building, int(building.max(initial=0)))[building]
    return np.where(gone, 0, building), np.where(gone, np.uint8(Reason.VEHICLE), refused)
