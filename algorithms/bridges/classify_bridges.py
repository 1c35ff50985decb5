"""Find bridge decks among ground points: smooth surfaces with free air at both sides."""

from typing import Optional

import numpy as np

from ..cloud.asprs import VEGETATION, PointClass
from ..geometry.adjacent_cells import DIRECTIONS
from ..geometry.boxes import connect
from ..geometry.grid import raster_cells, refuse_sparse
from ..geometry.groups import least_of
from ..geometry.raster_filling import nearest_known
from ..packages import ndimage, spatial
from ..params import BRIDGE_AREA, BRIDGE_HEIGHT, BRIDGE_WIDTH, POINT_DENSITY, SURFACE_NOISE
from ..sampling.cloud_sampling import MEASURED, CloudSampling, not_noise
from ..sampling.kinds import LASER
from ..stage import Monitor, stage, tunable
from ..terrain.on_decks import on_decks
from .bridge_decks import DECK, Decks

# No deck is of these classes.
_NO_DECK = (*VEGETATION, PointClass.BUILDING, PointClass.WATER)

# Where bridges are looked for.
_EVERYWHERE, _OVER_GAPS = "everywhere", "gaps in the ground"


@stage(
    "Terrain",
    tags="bridge,fly-over,bridge deck,footbridge,viaduct,ground,terrain,DTM,Sithole,Vosselman",
    writes=("classification",),
    reach=lambda tunables: tunables["max_width"] * (2 if tunables["search"] == _EVERYWHERE else 0.5),
    cost=1.0,
)
def classify_bridges(
    xyz,
    classification,
    *,
    min_height: float = BRIDGE_HEIGHT,
    max_width: float = BRIDGE_WIDTH,
    min_bridge_area: float = BRIDGE_AREA,
    search: str = tunable(_EVERYWHERE, choices=(_EVERYWHERE, _OVER_GAPS)),
    noise: Optional[float] = SURFACE_NOISE,
    density: Optional[float] = POINT_DENSITY,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Find bridges and fly-overs in a cloud with classified ground, also where the ground filter took them for ground.

    On lines in eight directions the sections of a bridge are smooth, opaque and raised on both sides. Such parts become
    bridge deck (17) if they are large enough and go on into the ground at both ends. Bridges whose ends are not in the
    cloud, and embankments, are not found. A run in tiles reads twice the maximum width around each block, or half
    the maximum width where bridges are looked for at gaps only. Bridges of which an end lies farther out are not found
    in that block. For long ones set a larger block or maximum width.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes with ground (2); vegetation, buildings and water are no decks, earlier bridge deck (17) is
        discarded where bridges are looked for.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        The same with bridge deck (17); unchanged where no bridges are looked for.

    Other Parameters
    ----------------
    search
        Where bridges are looked for: everywhere, or only around level surfaces over a gap in the ground with ground at
        their height at both ends, in a fraction of the time.

    Raises
    ------
    ValueError
        If there are no ground points.

    Notes
    -----
    This is the second step of 'Classify ground segments', for the ground of any filter and without segments. All points
    can be of a deck, unless their class is no deck.

    References
    ----------
    Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds,
    section 5.3. [vosselman2004]
    Sithole, G., Vosselman, G., 2003. Automatic structure detection in a point cloud of an urban landscape. URBAN 2003,
    Berlin, 67-71. [sithole2003]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 1, 2)
    >>> bool((classify_bridges(xyz, classes) == 17).any())
    False
    """
    if not max_width:
        return classification.astype(np.uint8)
    if not (classification == PointClass.GROUND).any():
        raise ValueError("No ground points (class 2); run 'Classify ground points (TIN)' first.")
    density = sampling.density if density is None else density
    noise = sampling.noise if noise is None else noise
    monitor.resolved(density=density, noise=noise)
    used = not_noise(classification)
    points = sampling.from_corner(xyz.take(used, axis=0))
    decks = Decks.of(min_height, max_width, min_bridge_area, 1 / float(np.sqrt(density)), noise)
    may_be_deck = ~np.isin(classification[used], _NO_DECK)
    if search == _OVER_GAPS:
        is_level = np.isin(classification[used], (PointClass.GROUND, PointClass.WATER))
        near = deck_sites(points, may_be_deck, is_level, decks)
        used, points, may_be_deck = used[near], points[near], may_be_deck[near]
    is_deck = decks.find(points, may_be_deck, classification[used] == PointClass.GROUND, monitor)
    classes = classification.astype(np.uint8)
    classes[used[classification[used] == PointClass.BRIDGE_DECK]] = PointClass.UNCLASSIFIED
    ground = np.flatnonzero((classification[used] == PointClass.GROUND) & ~is_deck)
    # Ground points on a deck are of cars and parapets; ground that rises next to the deck stays ground.
    classes[used[ground[on_decks(points[ground], points[is_deck], LASER.foot)[0]]]] = PointClass.UNCLASSIFIED
    classes[used[is_deck]] = PointClass.BRIDGE_DECK
    return classes


def deck_sites(xyz: np.ndarray, is_open: np.ndarray, is_ground: np.ndarray, decks: Decks) -> np.ndarray:
    """Return the mask of points (n,) that are near surfaces that may be decks.

    In cells of one meter and more, a surface over the ground hides it, and ground between two lower sides may itself be
    a deck. Such cells are joined where they are level. The parts that are as large as bridges and reach ground of their
    own height at both ends stay, with the points around them that are no higher.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points, m.
    is_open : ndarray of shape (n,), bool
        Points that may be of decks.
    is_ground : ndarray of shape (n,), bool
        Ground and water.
    decks : Decks
        Criteria of bridges.
    """
    refuse_sparse(xyz, decks.cell)
    row, column = raster_cells(xyz, decks.cell, 0)
    shape = (int(row.max()) + 1, int(column.max()) + 1)
    cell = row * shape[1] + column
    ground = _lowest(cell[is_ground], xyz[is_ground, 2], shape)
    unseen = ~np.isfinite(ground)
    is_other = is_open & ~is_ground
    is_over = is_other & (xyz[:, 2] - nearest_known(ground, unseen).ravel()[cell] >= decks.min_height)
    hides = _count(cell[is_ground], shape) < DECK.most_below * _count(cell[is_over], shape)
    surface = np.where(unseen, _lowest(cell[is_other], xyz[is_other, 2], shape), ground)
    surface = np.where(hides, _lowest(cell[is_over], xyz[is_over, 2], shape), surface)
    is_raised = _between_lower(surface, ground, decks)
    is_site = np.zeros(shape, bool)
    raised, beside = np.argwhere(is_raised), np.argwhere(np.isfinite(surface) & ~is_raised)
    is_site[tuple(raised[_leads_on(raised, beside, surface, decks)].T)] = True
    if not is_site.any():
        return np.zeros(len(xyz), bool)
    reach = DECK.far * decks.reach
    is_near = ndimage.distance_transform_edt(~is_site) * decks.cell <= reach
    # A road that rises from the surfaces around gets no higher than this; points above it are of crowns.
    side = 2 * int(np.ceil(reach / decks.cell)) + 1
    highest = ndimage.maximum_filter(np.where(is_site, surface, -np.inf), side) + decks.near.slope * reach
    return is_near[row, column] & (xyz[:, 2] <= highest[row, column])


def _lowest(cell: np.ndarray, height: np.ndarray, shape: tuple[int, int]) -> np.ndarray:
    """Return the lowest of the heights in each cell, m; infinite without any."""
    return least_of(height, cell, shape[0] * shape[1]).reshape(shape)


def _count(cell: np.ndarray, shape: tuple[int, int]) -> np.ndarray:
    """Return the number of points in each cell."""
    return np.bincount(cell, minlength=shape[0] * shape[1]).reshape(shape)


def _between_lower(surface: np.ndarray, ground: np.ndarray, decks: Decks) -> np.ndarray:
    """Return the mask of cells that have a surface over the ground on both sides, within the width of decks."""
    result = np.zeros(ground.shape, bool)
    for down, right in DIRECTIONS:
        count = max(1, int(decks.max_width / 2 / decks.cell / np.hypot(down, right)))
        sides = [_lowest_ahead(ground, sign * down, sign * right, count) for sign in (1, -1)]
        result |= np.maximum(*sides) <= surface - decks.min_height
    return result & np.isfinite(surface)


def _lowest_ahead(ground: np.ndarray, down: int, right: int, count: int) -> np.ndarray:
    """Return the least height of the next ``count`` cells in a direction, m; infinite beyond the raster."""
    lowest, seen = _ahead(ground, down, right), 1
    while seen < count:
        more = min(seen, count - seen)
        lowest = np.minimum(lowest, _ahead(lowest, more * down, more * right))
        seen += more
    return lowest


def _ahead(values: np.ndarray, down: int, right: int) -> np.ndarray:
    """Return the value of the cell some rows and columns further for each cell, infinite beyond the raster."""
    padded = np.pad(values, [(max(0, -step), max(0, step)) for step in (down, right)], constant_values=np.inf)
    return padded[max(0, down) :, max(0, right) :][: values.shape[0], : values.shape[1]]


def _leads_on(raised: np.ndarray, beside: np.ndarray, surface: np.ndarray, decks: Decks) -> np.ndarray:
    """Return the mask of ``raised`` cells (m, 2) of large level parts with ground at their height at both ends."""
    if not len(raised) or not len(beside):
        return np.zeros(len(raised), bool)

    def points(cells: np.ndarray) -> np.ndarray:
        return np.column_stack([cells * decks.cell, surface[tuple(cells.T)]])

    cells = points(raised)
    # Level cells that touch at a side or a corner are of one part.
    part = connect(cells, 1.5 * decks.cell, LASER.foot, Monitor())
    # Heights are stretched, so that the largest step of a road counts as much as the reach in plan.
    stretch = np.array([1.0, 1.0, decks.reach / LASER.foot])
    distance, _ = spatial.cKDTree(points(beside) * stretch).query(cells * stretch, distance_upper_bound=decks.reach)
    touches = np.isfinite(distance)
    size = np.bincount(part)
    x, y = (axis - (np.bincount(part, axis) / size)[part] for axis in cells[:, :2].T)
    xx, yy, xy = (np.bincount(part, product) for product in (x * x, y * y, x * y))
    angle = np.arctan2(2 * xy, xx - yy)[part] / 2
    along = x * np.cos(angle) + y * np.sin(angle)
    half = np.zeros(len(size))
    np.maximum.at(half, part, np.abs(along))
    # Ends are the outer thirds of a part.
    far = np.abs(along) >= half[part] / 3
    ends = (np.bincount(part, touches & far & (way > 0)) > 0 for way in (along, -along))
    return (np.logical_and(*ends) & (size * decks.cell**2 >= decks.min_area))[part]
