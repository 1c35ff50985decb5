"""Segments made of the pieces of artificial scan lines in several directions."""

from typing import Optional

import numpy as np

from ..criteria import DIFFERENCE
from ..geometry.boxes import by_first_point
from ..geometry.groups import number_large, placed
from ..params import POINT_DENSITY, SURFACE_NOISE
from ..sampling.cloud_sampling import MEASURED, CloudSampling, not_noise
from ..stage import stage, tunable
from .candidate_points import AUTOMATIC_REACH
from .scan_line_pieces import NearPoints, merged_pieces, pieces

# Width of a line in point spacings: wider lines mix objects side by side; in narrower ones, neighbors on a line lie
# farther apart than the cloud's points do.
_WIDTH_SPACINGS = 3.0

# Distance in point spacings within which points of a line belong together: the gaps between scan lines that are
# recorded three times as densely along as across.
_DISTANCE_SPACINGS = 9.0


@stage(
    "Segmentation",
    tags="scan line,profile,slices,split and merge,region growing,segmentation,Sithole,Vosselman",
    writes=("segment_id",),
    reach=lambda tunables: max(tunables["distance"] or 0.0, tunables["max_obstacle"], AUTOMATIC_REACH),
)
def segment_scan_lines(
    xyz,
    classification,
    *,
    directions: int = tunable(4, within="[2, 16]"),
    line_width: Optional[float] = tunable(
        None, within="(0, 1000] m", automatic=f"{_WIDTH_SPACINGS:g} times the point spacing."
    ),
    distance: Optional[float] = tunable(
        None, within="(0, 1000] m", automatic=f"{_DISTANCE_SPACINGS:g} times the point spacing."
    ),
    max_slope: float = tunable(30.0, within="[0, 90]°"),
    max_step: Optional[float] = tunable(
        None,
        label="Height step",
        within="[0, 100] m",
        automatic=f"{DIFFERENCE:.2g} standard deviations of the surface noise.",
    ),
    max_obstacle: float = tunable(0.0, label="Widest obstacle", within="[0, 1000] m"),
    min_piece: int = tunable(5, label="Minimum points of a piece", within="[2, 10_000]"),
    min_points: int = tunable(20, within="[1, 10_000_000]"),
    noise: Optional[float] = SURFACE_NOISE,
    density: Optional[float] = POINT_DENSITY,
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Cut the cloud into artificial scan lines of several directions, group their points, and merge the groups.

    The cloud is split into thin parallel slices. Points of a slice that are near each other in space and not
    steeply above one another make a piece, also across points that lie off it. This is repeated for slices in other
    directions, and pieces that share points are merged. Bridges and ramps, which join the terrain at some side, become
    part of its segment; roofs, which join it nowhere, do not.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; noise (7, 18) is left out.

    Returns
    -------
    segment_id : ndarray of shape (n,), int32
        Segments from 1 in the order of their first points; 0 if unassigned.

    Other Parameters
    ----------------
    directions
        Directions of artificial scan lines, evenly spread.
    line_width
        Width of an artificial scan line.
    distance
        Points of a line that are closer in space may belong together; larger passes over wider obstacles.
    max_slope
        Points of a line belong together if the line between them is no steeper; 90 leaves the criterion out.
    max_step
        Points of a line also belong together if their heights differ by no more than this.
    max_obstacle
        A piece of a line goes on behind an obstacle up to this width, such as a hedge, a car or a gap without points.
        The ends on both sides must meet the criteria of slope and height step. 0: pieces end at every obstacle.
    min_piece
        Pieces of a line with fewer points join nothing.
    min_points
        Segments with fewer points get no id.

    Notes
    -----
    Each point is compared with the 8 that follow it on its line. Lines start at the lowest coordinate across them.
    A piece meets a wider obstacle where its last point and the first one of a piece further on are compared: the gap
    between them moves along the line with the pieces. For the scanner's own lines there is 'Segment recorded lines'
    (Jiang & Bunke 1994).

    References
    ----------
    Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds,
    section 2.1. [vosselman2004]
    Sithole, G., Vosselman, G., 2003. Automatic structure detection in a point cloud of an urban landscape. URBAN 2003,
    Berlin, 67-71. [sithole2003]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> ids = segment_scan_lines(xyz, np.zeros(len(xyz)))
    >>> int(ids.max())
    2
    """
    density = sampling.density if density is None else density
    noise = sampling.noise if noise is None else noise
    spacing = 1 / float(np.sqrt(density))
    line_width = _WIDTH_SPACINGS * spacing if line_width is None else line_width
    distance = _DISTANCE_SPACINGS * spacing if distance is None else distance
    max_step = DIFFERENCE * noise if max_step is None else max_step
    monitor.resolved(density=density, noise=noise, line_width=line_width, distance=distance, max_step=max_step)
    used = not_noise(classification)
    if not len(used):
        return np.zeros(len(xyz), np.int32)
    points = sampling.from_corner(xyz[used])
    slope = np.inf if max_slope == 90 else float(np.tan(np.radians(max_slope)))
    near = NearPoints(distance, slope, max_step)

    piece_sets = []
    for number in range(directions):
        piece_sets.append(pieces(points, 180 * number / directions, line_width, near, min_piece, max_obstacle))
        monitor.progress(0.9 * (number + 1) / directions)
    return placed(number_large(by_first_point(merged_pieces(piece_sets)), min_points), used, len(xyz))
