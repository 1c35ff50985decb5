"""The figures of a cloud's structure: thinning, and its linear, planar and volumetric points in two neighborhoods."""

import numpy as np

from ..neighborhoods.covariance import Nearest, Neighborhood, Shapes, defined_eigenvalues, reduce_neighborhoods
from ..neighborhoods.covariance import dimensionality as dimensionality_of
from ..neighborhoods.optimal_size import Optimal
from ..report.charts import draw_bars
from ..report.page import build_page, draw_map, draw_table, percent
from ..stage import Measure, Monitor, Report, stage
from .classify_dimensionality import classify_dimensionality
from .compute_features import MAX_NEIGHBORS, MIN_NEIGHBORS, N_NEIGHBORS

# Points that both neighborhoods are tried on: shares of them are right to a few tenths of a percent.
_COMPARED = 20_000

# The kinds of points by their number in the dimension.
_KINDS = ("undefined", "linear", "planar", "volumetric")

# Columns of shares, with their titles: the cloud, and the neighborhoods tried.
_OF = {"cloud": "As classified", "nearest": "Nearest points", "optimal": "Optimal"}


@stage(
    "Features",
    tags="linear,planar,volumetric,dimensionality,structure,report,eigenentropy,histogram,thinning,Weinmann",
    measures=(
        Measure("original_points", "Points before thinning"),
        Measure("points", "Points"),
        Measure("left", "Share left by thinning", "%"),
        *(Measure(f"{of}_{kind}", f"{title}: {kind}", "%") for of, title in _OF.items() for kind in _KINDS[1:]),
        Measure("median_neighbors", "Optimal: neighbors, median"),
        Measure("fewer_neighbors", "Optimal: points with fewer neighbors than 'Nearest points'", "%"),
    ),
)
def report_structure(xyz, dimensionality, voxel_count=None, *, n_neighbors: int = N_NEIGHBORS, monitor=None):
    """Report the points left by thinning, and the shares of linear, planar and volumetric points in two neighborhoods.

    In addition to the classes that points have, both neighborhoods of 'Compute features' are tried on some of the
    points: a number of nearest ones, and the number of least eigenentropy. A page shows the shares, how many points the
    second takes, and a map.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    dimensionality : ndarray of shape (n,), uint8
        1 linear, 2 planar, 3 volumetric, 0 undefined.
    voxel_count : ndarray of shape (n,), uint32, optional
        Points that each point was made of, for what thinning left.

    Returns
    -------
    report : Report
        Counts and shares, and a page with charts. What there is nothing to compute from is NaN.

    Notes
    -----
    About ``_COMPARED`` points at equal steps in the order of the cloud are compared, with all others as neighbors.
    'Downsample to voxels' leaves points from west to east; of clouds in another order other points are compared. The
    seconds of all steps are in the log of 'Interpret structure' and on its page.

    References
    ----------
    Weinmann et al. (2017), Point cloud analysis for UAV-borne laser scanning, sections 4 and 5. [weinmann2017]

    Examples
    --------
    >>> x, y = np.mgrid[0:10:0.5, 0:10:0.5].reshape(2, -1)
    >>> report = report_structure(np.column_stack([x, y, 0 * x]), np.full(len(x), 2))
    >>> report.values["nearest_volumetric"]
    0.0
    """
    chosen = np.zeros(len(xyz), bool)
    chosen[:: -(-len(xyz) // _COMPARED)] = True
    nearest, _ = _kinds(xyz, Nearest(n_neighbors), chosen, monitor.part(0.0, 0.3))
    optimal, neighbors = _kinds(xyz, Optimal(MIN_NEIGHBORS, MAX_NEIGHBORS), chosen, monitor.part(0.3, 1.0))
    original = np.nan if voxel_count is None else int(voxel_count.sum(dtype=np.int64))
    values = {"original_points": original, "points": len(xyz), "left": 100 * len(xyz) / original}
    for of, kinds in zip(_OF, (dimensionality, nearest, optimal)):
        shares = 100 * np.bincount(kinds, minlength=len(_KINDS)) / len(kinds)
        values.update({f"{of}_{kind}": float(share) for kind, share in zip(_KINDS[1:], shares[1:])})
    values["median_neighbors"] = float(np.median(neighbors))
    values["fewer_neighbors"] = 100 * float(np.mean(neighbors < n_neighbors))
    lead = _summary(values, n_neighbors)
    monitor.inform(lead)
    return Report(values, _page(lead, values, neighbors, draw_map(xyz, dimensionality, _KINDS)))


def _kinds(
    xyz: np.ndarray, neighborhood: Neighborhood, chosen: np.ndarray, monitor: Monitor
) -> tuple[np.ndarray, np.ndarray]:
    """Return the dimensionality (m,) of the chosen points (n,), bool, and how many neighbors show it."""
    kinds, counts = np.zeros(len(xyz), np.uint8), np.zeros(len(xyz), np.int64)

    def keep(rows: np.ndarray, shapes: Shapes) -> None:
        eigenvalues = defined_eigenvalues(shapes.covariances, shapes.counts)
        kinds[rows], counts[rows] = classify_dimensionality(*dimensionality_of(eigenvalues)), shapes.counts

    reduce_neighborhoods(xyz, neighborhood, keep, monitor=monitor, chosen=chosen)
    return kinds[chosen], counts[chosen]


def _summary(values: dict[str, float], n_neighbors: int) -> str:
    """Return the figures in sentences."""
    thinned = f"Thinning left {values['points']:,} of {values['original_points']:,} points, {values['left']:.2f} %. "
    shares = {of: " / ".join(percent(values[f"{of}_{kind}"]) for kind in _KINDS[1:]) for of in _OF}
    return (thinned if values["left"] > 0 else "") + (
        f"Linear / planar / volumetric: {shares['nearest']} with {n_neighbors} neighbors, {shares['optimal']} with the "
        f"number of least eigenentropy, {values['median_neighbors']:.0f} in the median."
    )


def _page(lead: str, values: dict[str, float], neighbors: np.ndarray, picture: str) -> str:
    """Return the page of a report."""
    rows = [[title, *(percent(values[f"{of}_{kind}"]) for kind in _KINDS[1:])] for of, title in _OF.items()]
    charts = draw_table("Shares of points", ["", *_KINDS[1:]], rows) + "<h2>Neighbors of least eigenentropy</h2>"
    charts += f"<p>Both neighborhoods were tried on {len(neighbors):,} points spread over the cloud.</p>"
    charts += draw_bars(neighbors.astype(float), "nearest points of least eigenentropy", "points")
    return build_page("Structure of the cloud", lead, {}, charts + picture)
