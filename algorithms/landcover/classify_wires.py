"""Wires and the masts that carry them."""

from typing import Optional

import numpy as np

from ..cloud.asprs import PointClass
from ..criteria import DEVIATIONS
from ..params import SEED, SURFACE_NOISE
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..stage import Monitor, stage, tunable
from .masts import on_masts
from .wire_candidates import over_free_space, strands, thinned
from .wire_spans import RULES, Span, SpanSurroundings, parallels_of, spans_of

# Points of these classes may be of wires and masts.
_OPEN = (
    PointClass.NEVER_CLASSIFIED,
    PointClass.UNCLASSIFIED,
    PointClass.LOW_VEGETATION,
    PointClass.MEDIUM_VEGETATION,
    PointClass.HIGH_VEGETATION,
    PointClass.WIRE_CONDUCTOR,
    PointClass.TRANSMISSION_TOWER,
    PointClass.HIGH_NOISE,
)

# Distance (spacings) within which points show the direction of a wire: five points of a wire in a thin cloud, which has
# one every three to four spacings.
_REACH_SPACINGS = 20.0

# Bounds of this distance (m).
_LEAST_REACH, _MOST_REACH = 8.0, 15.0


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

    A wire is a parabola in an upright plane, as the catenary of a tight wire nearly is. It is ``RULES.least_length`` m
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
    closer than 0.75 m to one another at the same height, and spans seen over less than ``RULES.least_length`` m are not
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
    classes[np.isin(classes, (PointClass.WIRE_CONDUCTOR, PointClass.TRANSMISSION_TOWER))] = PointClass.UNCLASSIFIED
    is_open = np.isin(classification, _OPEN) & (height_above_ground > 0)
    # In one order, whichever the file has: random choices are then the same.
    rows = np.flatnonzero(is_open)
    rows = rows[np.lexsort(xyz[rows].T)]
    points, height = sampling.from_corner(xyz[rows]), height_above_ground[rows]
    solid = sampling.from_corner(xyz[classification == PointClass.BUILDING])
    around = SpanSurroundings(points, solid, max(RULES.least_off, DEVIATIONS * noise))
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
