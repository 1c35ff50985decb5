"""Wires, as lines of points over free space that form spans, and the masts that carry them."""

from typing import Any, Optional

import numpy as np

from ..cloud.asprs import VEGETATION, PointClass
from ..criteria import DEVIATIONS
from ..geometry.grid import fixed_grid_over
from ..geometry.groups import components, items, mask_of, run_starts
from ..geometry.sparse_voxels import one_per_voxel
from ..packages import spatial
from ..params import SEED, SURFACE_NOISE
from ..rules import rules
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..stage import Monitor, stage, tunable
from ..threads import in_chunks
from .masts import on_masts
from .wire_spans import RULES as SPAN
from .wire_spans import Span, SpanSurroundings, parallels_of, spans_of

# Classes of wires and of the masts that carry them.
_LINES = (PointClass.WIRE_CONDUCTOR, PointClass.TRANSMISSION_TOWER)

# Points of these classes may be of wires and masts.
_OPEN = (PointClass.NEVER_CLASSIFIED, PointClass.UNCLASSIFIED, *VEGETATION, *_LINES, PointClass.HIGH_NOISE)

# Distance (spacings) within which points show the direction of a wire: five points of a wire in a thin cloud, which has
# one every three to four spacings.
_REACH_SPACINGS = 20.0

# Bounds of this distance (m).
_LEAST_REACH, _MOST_REACH = 8.0, 15.0


@rules
class _RULES:
    """Where wires are looked for."""

    least_column: float = 1.0  #: Least side of the columns in which heights are compared, m
    column_spacings: float = 2.0  #: Least side of these columns in point spacings: those in crowns hold several points
    free: float = 3.0  #: Height (m) below a bundle of wires that holds no points: crowns hold some
    thickest: float = 1.5  #: Largest height (m) of a bundle of wires one above the other
    thinning: float = 1.0  #: Side (m) of the voxels of which one point each is looked at
    around: float = 3.0  #: Radius (m) in which other points are counted
    #: Most thinned points around one of a wire: three parallel wires have 18 in dense clouds, surfaces 28, crowns more
    most_around: int = 20
    most_trials: int = 8  #: Lines through each point that are tried
    #: gap, gap_end: Multiples of ``SPAN.aside`` from a line between which points show a surface: parallel wires are
    #: farther away
    gap: float = 1.5
    gap_end: float = 2.5
    steepest: float = 0.4  #: Steepest slope of a wire (tangent), at masts in hills
    turn: float = 8.0  #: Largest angle (°) between directions at points of one wire
    bend: float = 0.02  #: Height over the tangent of a wire that farther points may have, as a share of their distance


# Points whose neighbors are found, and lines whose points are counted at once: some hundred neighbors each.
_CHUNK = 1000


@stage(
    "Land cover",
    tags="wire,power line,powerline,conductor,cable,catenary,span,pole,mast,pylon,tower,electricity,corridor,RANSAC",
    writes=("classification",),
    reach=_LEAST_REACH,
)
def classify_wires(
    xyz,
    classification,
    height_above_ground,
    *,
    look_for: bool = tunable(True, label="Look for wires"),
    min_height: float = tunable(4.0, within="[1, 100] m"),
    noise: Optional[float] = SURFACE_NOISE,
    seed: int = SEED.with_default(0),
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Classify the wires of power lines (14), of high and low voltage, and the masts and poles at their ends (15).

    A wire is a parabola in an upright plane, as the catenary of a tight wire nearly is. It is ``SPAN.least_length`` m
    long at least and bent upward, with free space below and no building next to it. Spans are found by RANSAC among
    points that lie on lines. Next to each, wires of the same masts have its direction and curve. Where spans end, the
    slender upright object that reaches up to them is a mast. Clouds of matched images are left as they are: wires are
    thinner than their pixels.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes. Points of 0, 1, vegetation and high noise are looked at, as thin clouds have wires of single
        points; earlier wires and masts are classified anew.
    height_above_ground : ndarray of shape (n,), float32
        Heights, m.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        The same with wires (14) and masts (15).

    Other Parameters
    ----------------
    look_for
        If not, no class changes. For models that contain this step.
    min_height
        Height above the ground of the lowest wires.

    Notes
    -----
    At 2 points per m² a wire has a point on 3 m or so, at 50 per m² several on each meter. Wires inside crowns, wires
    closer than 0.75 m to one another at the same height, and spans seen over less than ``SPAN.least_length`` m are not
    found.

    References
    ----------
    Melzer, T., Briese, C., 2004. Extraction and modeling of power lines from ALS point clouds. 28th Workshop of the
    Austrian Association for Pattern Recognition, 47-54. [melzer2004]
    Fischler, M. A., Bolles, R. C., 1981. Random sample consensus. Communications of the ACM 24(6), 381-395.
    [fischler1981]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 1, 2)
    >>> bool((classify_wires(xyz, classes, z) == 14).any())
    False
    """
    classes = classification.astype(np.uint8)
    if not look_for:
        return classes
    noise = sampling.noise if noise is None else noise
    monitor.resolved(noise=noise)
    if sampling.is_closed_surface():
        return classes
    classes[np.isin(classes, _LINES)] = PointClass.UNCLASSIFIED
    # In one order, whichever the file has: random choices are then the same.
    rows = np.flatnonzero(np.isin(classification, _OPEN) & (height_above_ground > 0))
    rows = rows[np.lexsort(xyz[rows].T)]
    points, height = sampling.from_corner(xyz[rows]), height_above_ground[rows]
    solid = sampling.from_corner(xyz[classification == PointClass.BUILDING])
    around = SpanSurroundings(points, solid, max(SPAN.least_off, DEVIATIONS * noise))
    spans = _spans(around, height >= min_height, sampling.spacing, seed, monitor)
    # Wires next to these are seen in part only, so that their ends show no masts.
    for span in (*spans, *parallels_of(spans, around)):
        classes[rows[around.on_wire(span, beyond=1.0)]] = PointClass.WIRE_CONDUCTOR
    is_wire = classes[rows] == PointClass.WIRE_CONDUCTOR
    classes[rows[on_masts(points, height, is_wire, spans)]] = PointClass.TRANSMISSION_TOWER
    return classes


def _spans(around: SpanSurroundings, is_high: np.ndarray, spacing: float, seed: int, monitor: Monitor) -> list[Span]:
    """Return the spans of the wires among the points (n,) that are high enough, bool."""
    points = around.xyz
    free = over_free_space(points, spacing)
    free = free[is_high[free]]
    monitor.progress(0.2)
    if not len(free):
        return []
    free = free[thinned(points[free])]
    reach = float(np.clip(_REACH_SPACINGS * spacing, _LEAST_REACH, _MOST_REACH))
    strand, direction = strands(points[free], reach, monitor.part(0.2, 0.7))
    return list(spans_of(points[free], strand, direction, around, reach, np.random.default_rng(seed)))


def over_free_space(xyz: np.ndarray, spacing: float) -> np.ndarray:
    """Return the rows (m,) of points (n, 3), m, in thin layers with free space below them."""
    if not len(xyz):
        return np.zeros(0, np.int64)
    column = fixed_grid_over(xyz, max(_RULES.least_column, _RULES.column_spacings * spacing)).number(xyz)
    order = np.lexsort((xyz[:, 2], column))
    z, column = xyz[order, 2], column[order]
    is_first = mask_of(len(z), run_starts(column)) | (np.diff(z, prepend=-np.inf) > _RULES.free)
    start = np.flatnonzero(is_first)
    thickness = z[np.append(start[1:], len(z)) - 1] - z[start]
    return np.sort(order[(thickness <= _RULES.thickest)[np.cumsum(is_first) - 1]])


def thinned(xyz: np.ndarray) -> np.ndarray:
    """Return the rows (m,) of one point per voxel, of those with few others around."""
    rows = one_per_voxel(xyz, _RULES.thinning)
    count = spatial.cKDTree(xyz[rows]).query_ball_point(xyz[rows], _RULES.around, return_length=True)
    return rows[count <= _RULES.most_around]


def strands(xyz: np.ndarray, reach: float, monitor: Monitor) -> tuple[np.ndarray, np.ndarray]:
    """Return the number (n,), from 0, of the line that each point is on, -1 for none, and its direction (n, 3).

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Thinned points.
    reach : float
        Distance (m) within which points are on a line together.
    monitor : Monitor
        Receives progress.
    """
    if len(xyz) < SPAN.least_points:
        return np.full(len(xyz), -1), np.zeros((len(xyz), 3))
    # Wires run far in plan and little in height.
    stretched = xyz * [1.0, 1.0, 2.0]
    tree = spatial.cKDTree(stretched)
    count, direction = np.zeros(len(xyz), np.int64), np.zeros((len(xyz), 3))

    def look(rows: np.ndarray) -> None:
        one, other = _pairs(stretched, rows, tree, reach)
        offset = xyz[other] - xyz[rows[one]]
        count[rows], direction[rows] = _best_lines(one, offset, len(rows), reach)

    # Neighbors in plan together: their own neighbors are the same.
    in_chunks(look, np.lexsort(xyz[:, :2].T), _CHUNK, monitor)
    is_linear = count >= SPAN.least_points - 1
    linear = np.flatnonzero(is_linear)
    one, other = linear[spatial.cKDTree(stretched[linear]).query_pairs(reach, output_type="ndarray")].T
    one, other = np.concatenate([one, other]), np.concatenate([other, one])
    offset = xyz[other] - xyz[one]
    aside, off_height, along = _off_line(offset, direction[one])
    alike = np.abs((direction[one, :2] * direction[other, :2]).sum(axis=1)) > np.cos(np.radians(_RULES.turn))
    # A wire bends: farther points are higher than its tangent.
    on_line = (aside <= SPAN.aside) & (off_height <= SPAN.aside + _RULES.bend * np.abs(along)) & alike
    _, line = components(one[on_line], other[on_line], len(xyz))
    return np.where(is_linear, line, -1), direction


def _pairs(points: np.ndarray, rows: np.ndarray, tree: Any, reach: float) -> tuple[np.ndarray, np.ndarray]:
    """Return pairs of some points, by their position among ``rows``, and others up to ``reach`` (m) away, in order."""
    found = spatial.cKDTree(points[rows]).sparse_distance_matrix(tree, reach, output_type="ndarray")
    one, other = found["i"], found["j"]
    is_other = rows[one] != other
    one, other = one[is_other], other[is_other]
    order = np.lexsort((other, one))
    return one[order], other[order]


def _best_lines(one: np.ndarray, offset: np.ndarray, count: int, reach: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the number (n,) of neighbors on the best line of each point, and its direction (n, 3), 1 m in plan."""
    distance, gap = np.hypot(offset[:, 0], offset[:, 1]), _RULES.gap * SPAN.aside
    # Neighbors above or below all lines count neither as on a line nor as next to one.
    near = np.abs(offset[:, 2]) <= _RULES.steepest * distance + gap
    one, offset, distance = one[near], offset[near], distance[near]
    # Nearer neighbors give the direction of a line less accurately.
    far = np.flatnonzero((distance >= reach / 3) & (np.abs(offset[:, 2]) <= _RULES.steepest * distance))
    start, size = np.searchsorted(one, np.arange(count)), np.bincount(one, minlength=count)
    # Evenly spread over the neighbors of a point.
    first, number = np.searchsorted(one[far], np.arange(count)), np.bincount(one[far], minlength=count)
    point, trial = items(np.minimum(number, _RULES.most_trials))
    tried = far[first[point] + trial * number[point] // np.minimum(number[point], _RULES.most_trials)]
    best, direction = np.zeros(count, np.int64), np.zeros((count, 3))
    for chunk in np.array_split(np.arange(len(tried)), len(tried) // _CHUNK + 1):
        rows = point[chunk]
        line = offset[tried[chunk]] / distance[tried[chunk], None]
        which, item = items(size[rows])
        aside, off_height, _ = _off_line(offset[start[rows][which] + item], line[which])
        on_line = np.bincount(which, (aside <= SPAN.aside) & (off_height <= SPAN.aside), len(rows))
        in_gap = (aside > gap) & (aside <= _RULES.gap_end * SPAN.aside) & (off_height <= gap)
        beside = np.bincount(which, in_gap, len(rows))
        score = np.where(beside <= on_line / 2, on_line - beside, 0).astype(np.int64)
        order = np.lexsort((-score, rows))
        leading = order[run_starts(rows[order])]
        leading = leading[score[leading] > best[rows[leading]]]
        best[rows[leading]], direction[rows[leading]] = score[leading], line[leading]
    return best, direction


def _off_line(offset: np.ndarray, line: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the distances (m) of offsets (m, 3) from lines (m, 3): across in plan, vertical, and along the lines."""
    along = offset[:, 0] * line[:, 0] + offset[:, 1] * line[:, 1]
    aside = np.abs(offset[:, 0] * line[:, 1] - offset[:, 1] * line[:, 0])
    return aside, np.abs(offset[:, 2] - along * line[:, 2]), along
