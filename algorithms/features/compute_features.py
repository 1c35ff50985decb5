"""Covariance features of each point's neighborhood."""

from functools import cached_property
from typing import Callable, Optional

import numpy as np

from ..cloud.dimensions import DIMENSIONS
from ..neighborhoods import covariance
from ..neighborhoods.covariance import Nearest, Neighborhood, Shapes, Within, reduce_neighborhoods, shannon_entropy
from ..neighborhoods.optimal_size import Optimal
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..stage import Monitor, stage, tunable


class _Described:
    """Input of the features (m,) of the neighborhoods of m points. Undefined values are NaN.

    l1 >= l2 >= l3 are the eigenvalues (m, 3) of a covariance, m². Lengths are in m.
    """

    def __init__(self, shapes: Shapes) -> None:
        self.shapes = shapes
        self.eigenvalues = covariance.defined_eigenvalues(shapes.covariances, shapes.counts)
        self.defined = ~np.isnan(self.eigenvalues[:, 0])

    @cached_property
    def dimensionality(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Linearity, planarity and scattering."""
        return covariance.dimensionality(self.eigenvalues)

    @cached_property
    def eigenvalue_sum(self) -> np.ndarray:
        """Sum l1 + l2 + l3."""
        return self.eigenvalues.sum(axis=1)

    @cached_property
    def normal(self) -> np.ndarray:
        """Upward unit eigenvector (m, 3) of l3."""
        return covariance.smallest_eigenvectors(self.shapes.covariances, self.eigenvalues)

    @cached_property
    def plan_radius(self) -> np.ndarray:
        """Largest horizontal distance from the point; undefined without neighbors."""
        radius = self.shapes.plan_radius
        return np.where(self.defined & (radius > 0), radius, np.nan)

    @property
    def plan_eigenvalue_ratio(self) -> np.ndarray:
        """Smaller by larger eigenvalue of the covariance in plan."""
        xx, yy, _, xy, _, _ = self.shapes.covariances.T
        mean, spread = (xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
        mean = np.where(self.defined & (mean > 0), mean, np.nan)
        return np.maximum(mean - spread, 0) / (mean + spread)


# Each feature by its name; the docstring of the stage has the formulas.
_FEATURES: dict[str, Callable[[_Described], np.ndarray]] = {
    "linearity": lambda of: of.dimensionality[0],
    "planarity": lambda of: of.dimensionality[1],
    "scattering": lambda of: of.dimensionality[2],
    "entropy": lambda of: shannon_entropy(*of.dimensionality),
    "omnivariance": lambda of: np.cbrt(of.eigenvalues.prod(axis=1)),
    "anisotropy": lambda of: of.dimensionality[0] + of.dimensionality[1],
    "eigenentropy": lambda of: shannon_entropy(*(of.eigenvalues.T / of.eigenvalue_sum)),
    "eigenvalue_sum": lambda of: of.eigenvalue_sum,
    "surface_variation": lambda of: of.eigenvalues[:, 2] / of.eigenvalue_sum,
    "verticality": lambda of: 1 - of.normal[:, 2],
    "normal": lambda of: of.normal,
    "height_range": lambda of: np.where(of.defined, of.shapes.height_range, np.nan),
    "height_deviation": lambda of: np.sqrt(np.where(of.defined, of.shapes.covariances[:, 2], np.nan).clip(0)),
    "plan_radius": lambda of: of.plan_radius,
    "plan_density": lambda of: of.shapes.counts / (np.pi * of.plan_radius**2),
    "plan_eigenvalue_ratio": lambda of: of.plan_eigenvalue_ratio,
    "optimal_neighbors": lambda of: of.shapes.counts,
}

# Features that need more than the covariance.
_OF_EXTENT = {"height_range", "plan_radius", "plan_density"}

# How far a neighborhood reaches (m) where its radius is not set: the 50 points of one by default lie that close on
# surfaces with 0.64 points per square meter and more, the 100 of 'optimal' with 1.3.
_REACH = 5.0

# Smallest and largest neighborhood that 'optimal' tries where it is not set, as published.
MIN_NEIGHBORS, MAX_NEIGHBORS = 10, 100


N_NEIGHBORS = tunable(
    50,
    "Points per neighborhood, the point itself among them; used by the neighborhood 'nearest'. "
    "More of them smooth noise away and blur small objects.",
    label="Nearest points",
    within="[3, 1000]",
)


@stage(
    "Features",
    tags="PCA,covariance,eigenvalues,linearity,planarity,scattering,entropy,normals,verticality,geometric,optimal,"
    "scale",
    writes=tuple(_FEATURES),
    reach=lambda tunables: (tunables["radius"] or _REACH) if tunables["neighborhood"] == "radius" else _REACH,
    cost=7.0,
)
def compute_features(
    xyz,
    *,
    neighborhood: str = tunable("nearest", choices=("nearest", "radius", "optimal")),
    n_neighbors: int = N_NEIGHBORS,
    radius: Optional[float] = tunable(
        None,
        within="(0, inf) m",
        automatic="the radius of a circle that holds 'Nearest points' at the measured density.",
    ),
    min_neighbors: int = tunable(MIN_NEIGHBORS, label="Minimum nearest points", within="[3, 1000]"),
    max_neighbors: int = tunable(MAX_NEIGHBORS, label="Maximum nearest points", within="[3, 1000]"),
    neighbors_step: int = tunable(1, label="Step of nearest points", within="[1, 100]", advanced=True),
    features: tuple[str, ...] = tunable(
        ("linearity", "planarity", "scattering", "entropy", "surface_variation", "verticality"),
        choices=tuple(_FEATURES),
    ),
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Describe the shape of each point's neighborhood by the eigenvalues of its covariance.

    Wires are linear, roofs and ground are planar, crowns are scattered; the entropy says how mixed the
    three are. Choose which features to keep: each becomes a dimension that can be drawn and filtered.

    How large a neighborhood should be depends on the noise, the density and the size of objects. One number of
    points for the whole cloud gives smooth results; the number that is best for each point ('optimal') keeps small
    objects apart and follows the noise more.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m).

    Returns
    -------
    ndarrays of shape (n,), float32, or (n, 3) for normal; None for each feature not asked for.
        ``linearity`` (l1 - l2) / l1, ``planarity`` (l2 - l3) / l1 and ``scattering`` l3 / l1, which add up to 1.
        ``entropy`` -L ln L - P ln P - S ln S of these, 0 to ln 3.
        ``omnivariance`` (l1 l2 l3)^(1/3) in m².
        ``anisotropy`` (l1 - l3) / l1.
        ``eigenentropy`` -sum e ln e with e = l / sum l, 0 to ln 3.
        ``eigenvalue_sum`` l1 + l2 + l3 in m².
        ``surface_variation`` l3 / (l1 + l2 + l3), 0 to 1/3.
        ``verticality`` 1 - abs(n_z), 0 on flat roofs and 1 on walls.
        ``normal`` the unit eigenvector of l3, upward.
        ``height_range`` highest less lowest elevation and ``height_deviation`` their standard deviation, m.
        ``plan_radius`` largest horizontal distance r from the point to its neighbors, m.
        ``plan_density`` points of the neighborhood per area of that circle, points/m².
        ``plan_eigenvalue_ratio`` m2 / m1 of the
        eigenvalues of the covariance in plan, 0 to 1.
        ``optimal_neighbors`` (int32) points of the neighborhood: chosen for 'optimal', found within a radius.
        NaN where a neighborhood has fewer than three points or all of them coincide, and for the features of the
        plan where all lie above one another; the number of points is defined everywhere.

    Other Parameters
    ----------------
    neighborhood
        Points that describe a point: a number of nearest ones, all within a radius, or as many nearest ones as show the
        clearest shape (least eigenentropy), chosen for each point.
    radius
        Radius of the sphere around a point; used by the neighborhood 'radius'.
    min_neighbors
        Smallest neighborhood that is tried by the neighborhood 'optimal'; fewer than ten describe noise.
    max_neighbors
        Largest neighborhood that is tried by the neighborhood 'optimal'; time grows with it.
    neighbors_step
        Step between the neighborhoods that 'optimal' tries; larger steps are faster and coarser.
    features
        What to compute; each becomes a dimension of the cloud.

    Raises
    ------
    ValueError
        If no feature is chosen, a radius holds more than 20,000 points on average, or the minimum of nearest
        points is above their maximum.

    Notes
    -----
    The covariance is taken over the point and its neighbors, with their number as divisor; its eigenvalues are l1, the
    largest, to l3, and of its part in plan m1 and m2. L, P and S are linearity, planarity and scattering.
    Coordinates are taken relative to each point, so that large ones lose nothing. Surface variation is what other
    programs call curvature; verticality is as by Demantké et al.

    Where the cloud has fewer points than a neighborhood asks for, it is made of all of them. Of several points equally
    far at the end of a neighborhood of 'nearest' or 'optimal', each counts in part, so that their order in the cloud
    decides nothing. This holds as long as they are among the 1.3 (sqrt(k) + 1)² nearest; the features of extent count
    all of them. 'optimal' tries the minimum of nearest points, then a step more, up to the maximum, and takes the one
    with the least eigenentropy; of several that differ by rounding only, the smallest.

    References
    ----------
    Santos et al. (2019), Building detection from LiDAR data using entropy and the k-means concept, equations 6-11.
    [santos2019]
    Weinmann et al. (2017), Point cloud analysis for UAV-borne laser scanning, section 4.2. [weinmann2017]
    Weinmann et al. (2015), Semantic point cloud interpretation based on optimal neighborhoods, relevant features and
    efficient classifiers: the choice of the neighborhood, the features of height and plan. [weinmann2015]
    Demantké et al. (2011), Dimensionality based scale selection in 3D lidar point clouds. [demantke2011]

    Examples
    --------
    >>> square = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]
    >>> made = compute_features(square, n_neighbors=4, features=("planarity", "normal"))
    >>> made[1], made[10][0]
    (array([1., 1., 1., 1.], dtype=float32), array([0., 0., 1.], dtype=float32))
    """
    if not features:
        raise ValueError(f"No feature is chosen; choose at least one of {', '.join(_FEATURES)}.")
    around: dict[str, Callable[[], Neighborhood]] = {
        "nearest": lambda: Nearest(n_neighbors),
        "radius": lambda: Within(radius or _automatic_radius(sampling, n_neighbors, monitor)),
        "optimal": lambda: Optimal(min_neighbors, max_neighbors, neighbors_step),
    }
    made = {one: np.empty((len(xyz), 3) if one == "normal" else len(xyz), DIMENSIONS[one].dtype) for one in features}
    undefined = np.empty(len(xyz), bool)

    def keep(rows: np.ndarray, shapes: Shapes) -> None:
        described = _Described(shapes)
        undefined[rows] = ~described.defined
        for name, values in made.items():
            values[rows] = _FEATURES[name](described)

    reduce_neighborhoods(xyz, around[neighborhood](), keep, monitor=monitor, extents=bool(_OF_EXTENT & set(features)))
    wanted = {"nearest": n_neighbors, "optimal": min_neighbors}.get(neighborhood, 0)
    if len(xyz) < wanted:
        monitor.warn(
            f"The cloud has fewer points ({len(xyz)}) than a neighborhood asks for ({wanted}): all points have the "
            "features of the whole cloud."
        )
    if undefined.any():
        monitor.warn(
            f"{undefined.sum()} of {len(xyz)} points have too few distinct neighbors: their features are undefined."
        )
    return tuple(made.get(name) for name in _FEATURES)


def _automatic_radius(sampling: CloudSampling, n_neighbors: int, monitor: Monitor) -> float:
    """Return the radius (m) of a circle with ``n_neighbors`` points, and log it."""
    radius = float(np.sqrt(n_neighbors / (np.pi * sampling.density)))
    monitor.resolved(radius=radius)
    return radius
