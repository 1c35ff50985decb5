"""Outlines of the buildings of a block: the edges drawn around each cut the plane into cells, which buildings divide.

Borders that two buildings have in common, and polygons that are valid and do not overlap, follow from that.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ..geometry.cell_polygons import cell_polygons, joined_cells
from ..geometry.cheapest_labels import cheapest_labels
from ..geometry.groups import mask_of, placed
from ..geometry.ring_directions import along_two_directions
from ..geometry.ring_drawing import Edge, Prices, aligned, draw_ring
from ..geometry.rings import sides_of_rings
from ..geometry.subdivision import Subdivision
from ..packages import ndimage
from ..threads import ROWS_AT_ONCE
from .outline_pieces import OutlinePiece
from .row_houses import Houses
from .soft_shares import Lattice, Shares, spread_out

# Cost of a corner (times the cubed scale of simplification), in m³ as squared distances along an outline: a bay of two
# scales by four is not drawn. The scale is the spacing unless a tolerance is given. With 10, corners of the map in
# Delft are 0.04 m farther off; with 6 there are more corners, no closer.
_CORNER = 8.0

# An outline is straight if more than this share of its length runs along or square to one main direction; of a circle
# it is half.
_STRAIGHT_SHARE = 0.6

# A border between cells is part of a drawn edge if its midpoint lies within this distance (m).
_ON_EDGE = 0.03


@dataclass(frozen=True)
class Outlined:
    """The outline of a building or a part of it."""

    building: int  #: Its number
    rings: list[np.ndarray]  #: Closed, the exterior first, m
    nodes: np.ndarray  #: (k, 2): nodes of the lattice within it, m
    is_straight: bool  #: Whether most of its edges run along main directions


@dataclass(frozen=True)
class BlockDrawing:
    """How outlines are drawn: spacing of points, scale of simplification (m), least areas (m²), whole blocks or not.

    ``finer`` are the shares of the scale, 0 to 1, at which some buildings are drawn, by their numbers.
    """

    spacing: float
    scale: float
    min_area: float
    min_hole_area: float
    is_merged: bool = False
    finer: Mapping[int, float] = field(default_factory=dict)

    def prices(self, building: int) -> Prices:
        """Return the costs of corners and directions of a building."""
        return Prices(_CORNER * (self.finer.get(building, 1.0) * self.scale) ** 3)


def draw_block(
    pieces: list[OutlinePiece],
    shares: dict[int, Shares],
    directions: dict[int, np.ndarray],
    houses: dict[int, Houses],
    how: BlockDrawing,
) -> list[Outlined]:
    """Return the outlines of a block of buildings.

    Parameters
    ----------
    pieces : list of OutlinePiece
        What lies close together.
    shares : dict of int to Shares
        Of each of their buildings.
    directions : dict of int to ndarray of shape (k,)
        Main directions, °, of each of their buildings.
    houses : dict of int to Houses
        Houses of those buildings that are rows.
    how : BlockDrawing
        Spacing, scale of simplification and least areas.
    """
    drawn = [(ring, directions[piece.building], how.prices(piece.building)) for piece in pieces for ring in piece.rings]
    rings = [draw_ring(*each) for each in drawn]
    # Merge edges less than a spacing apart into one line: both sides of a border and a continued front come from the
    # same points. An edge next to a party wall merges, too, so that no strip is left between.
    numbers = sorted({piece.building for piece in pieces})
    both = [ends for number in numbers if number in houses for ends in houses[number].walls]
    there_and_back = [[Edge(start, end, True), Edge(end, start, True)] for start, end in both]
    made = aligned([*rings, *there_and_back], how.spacing)
    edges, walls = [edge for ring in made[: len(rings)] for edge in ring], [ring[0] for ring in made[len(rings) :]]
    if not edges:
        return []
    lattice, share = _shares_of(pieces, numbers, shares, edges, how)
    cells = _cut([*edges, *walls], lattice)
    # Cost (cells, labels) of each label in each cell: the area (m²) of the cell with another label.
    flat = share.reshape(len(share), -1)
    mean = np.array([flat[:, nodes].mean(axis=1) for nodes in _nodes_of(cells, lattice)], float)
    cost = cells.areas()[:, None] * np.clip(1 - mean, 0.0, None)
    label = _without_scraps(cells, _labels(cells, cost, edges, how), how)
    building = np.array([0, *numbers])
    if walls:
        label, building = _by_house(cells, label, building, houses, shares, lattice)
        label = _without_scraps(cells, label, how)
    found = []
    for polygon in cell_polygons(cells, np.minimum(label, 1) if how.is_merged else label):
        nodes = np.concatenate([cells.members[cell] for cell in polygon.cells])
        is_straight = _is_straight(polygon.rings, [*edges, *walls])
        largest = np.bincount(label[polygon.cells], cells.areas()[polygon.cells]).argmax()
        row, column = np.divmod(nodes, lattice.shape[1])
        positions = lattice.in_plan(np.column_stack([column, row]))
        found.append(Outlined(int(building[largest]), polygon.rings, positions, is_straight))
    return found


def _by_house(
    cells: Subdivision,
    label: np.ndarray,
    building: np.ndarray,
    houses: dict[int, Houses],
    shares: dict[int, Shares],
    lattice: Lattice,
) -> tuple[np.ndarray, np.ndarray]:
    """Return labels (cells,) of houses, and the building of each label.

    A cell is of the house that most of its nodes are of.
    """
    found, of_label, nodes = label.copy(), building.tolist(), _nodes_of(cells, lattice)
    for at, number in enumerate(building.tolist()):
        if number not in houses or len(houses[number].walls) == 0:
            continue
        house = _moved(houses[number].house, shares[number].lattice, lattice)
        flat = spread_out(house).ravel()
        for cell in np.flatnonzero(label == at):
            found[cell] = len(of_label) - 1 + np.bincount(flat[nodes[cell]]).argmax()
        of_label += [number] * int(house.max())
    return found, np.array(of_label)


def _nodes_of(cells: Subdivision, lattice: Lattice) -> list[np.ndarray]:
    """Return the nodes of the lattice in each cell, the one nearest to its middle where it holds none."""
    found = list(cells.members)
    for cell in np.flatnonzero([len(nodes) == 0 for nodes in found]):
        row, column = lattice.nearest(np.mean([cells.vertices[v] for v in cells.loops[cell]], axis=0))
        found[cell] = np.array([row * lattice.shape[1] + column])
    return found


def _shares_of(
    pieces: list[OutlinePiece], numbers: list[int], shares: dict[int, Shares], edges: list[Edge], how: BlockDrawing
) -> tuple[Lattice, np.ndarray]:
    """Return the lattice of a block, and the shares (1 + buildings, rows, columns) of the ground and of each building.

    Other parts of these buildings, which are not of this block, have no share.
    """
    samples = (ring for piece in pieces for ring in piece.rings)
    lattice = Lattice.around(np.concatenate([[edge.start for edge in edges], *samples]), how.spacing)
    share = np.zeros((len(numbers) + 1, *lattice.shape), np.float32)
    for at, number in enumerate(numbers, start=1):
        own = shares[number]
        rings = [ring for piece in pieces if piece.building == number for ring in piece.rings]
        share[at] = _moved(np.where(_is_near(own, rings), own.share, 0.0), own.lattice, lattice)
    share[0] = 1 - share[1:].sum(axis=0)
    return lattice, share


def _is_near(own: Shares, rings: list[np.ndarray]) -> np.ndarray:
    """Return the mask (rows, columns) of cells nearest to a part of a building with one of these rings."""
    part, count = ndimage.label(own.share > own.rest)
    if count <= 1:
        return np.ones(part.shape, bool)
    # Rings pass between nodes of their part and others.
    at = own.lattice.nodes(np.concatenate(rings)).astype(np.int64)
    beside = [part[at[:, 1] + row, at[:, 0] + column] for row in (0, 1) for column in (0, 1)]
    return np.isin(spread_out(part), np.setdiff1d(np.concatenate(beside), 0))


def _moved(values: np.ndarray, own: Lattice, lattice: Lattice) -> np.ndarray:
    """Resample values to the nodes of another lattice with the same step; 0 outside the first lattice."""
    column, row = np.subtract(lattice.first, own.first)
    at = [np.arange(size) + start for size, start in zip(lattice.shape, (row, column))]
    is_there = np.outer(*((one >= 0) & (one < size) for one, size in zip(at, own.shape)))
    return np.where(is_there, values[np.ix_(*(one.clip(0, size - 1) for one, size in zip(at, own.shape)))], 0)


def _cut(edges: list[Edge], lattice: Lattice) -> Subdivision:
    """Cut the box of the lattice along the edges, longest first; return the cells."""
    positions = lattice.positions
    # A little beyond the outer nodes, so that these lie in cells and not on the rim.
    cells = Subdivision(positions[0] - 0.3 * lattice.step, positions[-1] + 0.3 * lattice.step, positions)
    for number in np.argsort([-float(np.hypot(*(edge.end - edge.start))) for edge in edges], kind="stable"):
        cells.cut(edges[number].start, edges[number].end)
    return cells


def _labels(cells: Subdivision, cost: np.ndarray, edges: list[Edge], how: BlockDrawing) -> np.ndarray:
    """Return the label of each cell, 0 for ground, with the least total cost of cells and borders."""
    pairs, sides = cells.edges()
    start, end = np.swapaxes(np.array(cells.vertices)[pairs], 0, 1)
    # A meter of border without a drawn edge costs as much as an area of 1 m by one spacing.
    weight = np.where(_are_drawn(start, end, edges), 0.0, how.spacing * np.hypot(*(end - start).T))
    most = np.bincount(sides.ravel(), np.repeat(weight, 2), len(cells))
    first = cost.argmin(axis=1)
    return cheapest_labels(cost, sides, lambda one, other, rows: weight[rows] * (one != other), most, first)


def _are_drawn(start: np.ndarray, end: np.ndarray, edges: list[Edge]) -> np.ndarray:
    """Return the mask of borders of cells, (n, 2) to (n, 2), that lie on an edge that was drawn."""
    is_drawn = np.zeros(len(start), bool)
    if not edges:
        return is_drawn
    first, last = (np.array([getattr(edge, name) for edge in edges]) for name in ("start", "end"))
    length = np.hypot(*(last - first).T)
    middle, (step_x, step_y) = (start + end) / 2, (end - start).T
    # As many edges at once as fill the processor's caches with all borders.
    size = max(1, ROWS_AT_ONCE // max(len(start), 1))
    for own in (slice(at, at + size) for at in range(0, len(edges), size)):
        x, y = ((last - first)[own] / length[own, None]).T[..., None]
        east, north = (middle - first[own, None]).transpose(2, 0, 1)
        along = x * east + y * north
        is_on = (np.abs(x * north - y * east) <= _ON_EDGE) & (along >= 0) & (along <= length[own, None])
        is_drawn |= (is_on & (np.abs(x * step_y - y * step_x) <= 2 * _ON_EDGE)).any(axis=0)
    return is_drawn


def _without_scraps(cells: Subdivision, label: np.ndarray, how: BlockDrawing) -> np.ndarray:
    """Relabel holes and polygons below the minimum area with the label around them."""
    for is_ground, least in ((True, how.min_hole_area), (False, how.min_area)):
        piece = joined_cells(cells, label)
        size = np.bincount(piece, cells.areas())
        is_open = mask_of(len(size), piece[cells.is_on_rim()])
        pairs, sides = cells.edges()
        length = np.hypot(*np.diff(np.array(cells.vertices)[pairs], axis=1)[:, 0].T)
        kind = placed(label, piece, len(size))
        for number in np.flatnonzero((size < least) & ~is_open & ((kind == 0) == is_ground)):
            own = piece[sides] == number
            at_border = own[:, 0] != own[:, 1]
            others = label[np.where(own[at_border, 0], sides[at_border, 1], sides[at_border, 0])]
            label = label.copy()
            label[piece == number] = np.bincount(others, length[at_border]).argmax()
    return label


def _is_straight(rings: list[np.ndarray], edges: list[Edge]) -> bool:
    """Return whether most of the length of rings was drawn along one main direction and square to it."""
    start, end = np.moveaxis(sides_of_rings(rings), 1, 0)
    length, angle = np.hypot(*(end - start).T), np.degrees(np.arctan2(*(end - start).T[::-1]))
    is_main = _are_drawn(start, end, [edge for edge in edges if edge.is_main])
    return along_two_directions(length[is_main], angle[is_main]) > _STRAIGHT_SHARE * length.sum()
