"""Bare earth and bridges, from the segments of a cloud."""

import math
from typing import Optional

import numpy as np

from ..cloud.asprs import PointClass
from ..criteria import MAJORITY
from ..geometry.grid import distinct, find_cells, fixed_grid_over
from ..geometry.groups import least_of, placed
from ..params import BRIDGE_AREA, BRIDGE_HEIGHT, BRIDGE_WIDTH, POINT_DENSITY, SURFACE_NOISE
from ..sampling.cloud_sampling import MEASURED, CloudSampling, not_noise
from ..sampling.kinds import LASER
from ..stage import stage, tunable
from ..terrain.on_decks import on_decks
from .bridge_decks import DECK, Decks

# Steepest terrain (degrees) within a cell: about the angle of repose of soil.
_STEEPEST = 30.0


@stage(
    "Terrain",
    tags="ground,bare earth,DTM,bridge,fly-over,bridge deck,segments,filter,Sithole,Vosselman",
    writes=("classification",),
    # Of a square object that a window cuts off in the middle, half of the border is seen and shows its steps. A
    # segment of the bare earth that is cut off has no steps, however far it goes on.
    reach=lambda tunables: max(math.sqrt(tunables["max_object_area"]) / 2, 2 * tunables["max_width"]),
)
def classify_ground_segments(
    xyz,
    classification,
    segment_id,
    *,
    min_height: float = BRIDGE_HEIGHT,
    max_width: float = BRIDGE_WIDTH,
    min_bridge_area: float = BRIDGE_AREA,
    min_area: float = tunable(10.0, label="Minimum ground area", within="[1, 100_000] m²"),
    max_object_area: float = tunable(50_000.0, within="[1, 10_000_000] m²"),
    noise: Optional[float] = SURFACE_NOISE,
    density: Optional[float] = POINT_DENSITY,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Separate bare earth from objects by how segments end, then bridges from bare earth.

    Segments that are higher than their surroundings are objects, the others bare earth; bridges and fly-overs,
    which go on into the terrain at their ends, belong to its segments. On lines in eight directions a bridge is raised
    on both sides. Such parts become bridge deck (17) if they are opaque and smooth, large enough, and joined to the
    terrain at both ends. Run 'Segment scan lines' first, and in towns and forests 'Classify ground points (TIN)', too.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; noise (7, 18) and water (9) stay, earlier bridge deck (17) is forgotten. Where there
        is ground (2), it stays but for decks, and bridges must lead to it.
    segment_id : ndarray of shape (n,), int32
        Segments; 0 if unassigned.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        Ground (2), bridge deck (17); other points keep their class, or are unclassified (1).

    Other Parameters
    ----------------
    min_area
        Area of the smallest segment of the bare earth.
    max_object_area
        Area of the largest object: larger segments are bare earth, also where they are raised along their border, as
        islands and quarters between canals are.

    Notes
    -----
    Decks are looked for among all points of the bare earth, as the paper does, in eight directions instead of four.
    Unlike in the paper, beams must not pass through them and both ends must be joined, since crowns over the terrain
    are raised, too. Of the bare earth only the points near the lowest of their cell are ground. In towns and forests
    roofs and crowns are connected with the terrain by pieces of walls and leaves. Run a ground filter first there; its
    ground points are then the terrain. 'Classify bridges' works on the ground of a filter alone.

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
    >>> classes = classify_ground_segments(xyz, np.zeros(len(xyz)), np.where(z > 0, 1, 2))
    >>> bool((classes[z == 0] == 2).all()), bool((classes[z > 0] == 2).any())
    (True, False)
    """
    density = sampling.density if density is None else density
    noise = sampling.noise if noise is None else noise
    monitor.resolved(density=density, noise=noise)
    decks = Decks.of(min_height, max_width, min_bridge_area, 1 / float(np.sqrt(density)), noise)
    used = not_noise(classification)
    if not len(used):
        return classification.astype(np.uint8)
    points, segment = sampling.from_corner(xyz[used]), segment_id[used]

    is_earth = _bare_earth(points, segment, decks.cell, min_height, min_area, max_object_area)
    monitor.progress(0.2)
    is_terrain = classification[used] == PointClass.GROUND
    if not is_terrain.any():
        is_terrain = is_earth.copy()
        is_terrain[is_earth] = _is_low(points[is_earth], decks.cell / 2, DECK.noise_step * noise)
        monitor.inform("The cloud has no ground points (class 2); bare earth is found by the segments alone.")
    is_deck = decks.find(points, is_earth, is_terrain, monitor.part(0.2, 0.9))
    is_ground = is_terrain & ~is_deck
    # Cars and parapets on a deck are no ground; terrain that rises next to the deck stays.
    others = np.flatnonzero(is_ground)
    is_ground[others[on_decks(points[others], points[is_deck], LASER.foot)[0]]] = False

    classes = classification.astype(np.uint8)
    classes[np.isin(classes, (PointClass.GROUND, PointClass.BRIDGE_DECK))] = PointClass.UNCLASSIFIED
    changes = classes[used] != PointClass.WATER
    classes[used[is_ground & changes]] = PointClass.GROUND
    classes[used[is_deck & changes]] = PointClass.BRIDGE_DECK
    return classes


def _bare_earth(
    points: np.ndarray, segment: np.ndarray, cell: float, min_height: float, min_area: float, max_object_area: float
) -> np.ndarray:
    """Return the mask of points (n,) of segments that are large enough and not raised along most of their border."""
    grid = fixed_grid_over(points, cell)
    room = grid.rows * grid.columns
    cells, which = distinct(grid.number(points))
    low = least_of(points[:, 2], which, len(cells))
    member = np.flatnonzero(segment > 0)
    # Other programs number segments as they like.
    segments, of = distinct(segment[member].astype(np.int64))
    own, position = distinct(of * room + grid.number(points[member]))
    level = np.bincount(position, points[member, 2]) / np.bincount(position)
    number = own // room
    border, raised = np.zeros(len(own), bool), np.zeros(len(own), bool)
    for step in grid.around:
        beside, known = find_cells(cells, own % room + step)
        outside = ~find_cells(own, own + step)[1]
        border |= outside
        raised |= outside & known & (low[beside] <= level - min_height)
    n = len(segments)
    n_border = np.bincount(number, border, n)
    area = np.bincount(number, minlength=n) * cell**2
    # The border includes the edge of the cloud.
    is_object = np.bincount(number, raised, n) >= MAJORITY * np.maximum(n_border, 1)
    is_object &= area <= max_object_area
    return placed((~is_object & (area >= min_area))[of], member, len(points))


def _is_low(points: np.ndarray, cell: float, step: float) -> np.ndarray:
    """Return the mask of points (n,) no higher over the lowest of their cell than terrain and a step (m) rise in it."""
    which = distinct(fixed_grid_over(points, cell).number(points))[1] if len(points) else np.zeros(0, int)
    low = least_of(points[:, 2], which, int(which.max(initial=-1)) + 1)
    rises = float(np.tan(np.radians(_STEEPEST))) * np.sqrt(2) * cell
    return points[:, 2] <= low[which] + rises + step
