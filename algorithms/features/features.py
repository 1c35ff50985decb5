"""Covariance features of each point's neighborhood."""

from __future__ import annotations

from typing import Annotated, Optional, Union

import numpy as np

from ..cloud.density import point_density
from ..stage import Monitor, Param, stage
from .eigen import (
    Nearest,
    Within,
    defined_eigenvalues,
    dimensionality,
    reduce_neighborhoods,
    shannon_entropy,
    shannon_entropy_lps,
    smallest_eigenvectors,
)

_FEATURES = (
    "linearity",
    "planarity",
    "scattering",
    "entropy",
    "omnivariance",
    "anisotropy",
    "eigenentropy",
    "eigenvalue_sum",
    "surface_variation",
    "verticality",
    "normal",
)


@stage(
    "Compute features",
    group="Features",
    tags="covariance,eigenvalues,linearity,planarity,scattering,entropy,normals,verticality,geometric",
    writes=_FEATURES,
)
def compute_features(
    xyz,
    *,
    neighborhood: Annotated[
        str,
        Param(
            "Neighborhood",
            "Which points describe a point: a number of nearest ones, or all within a radius.",
            choices=("nearest", "radius"),
        ),
    ] = "nearest",
    n_neighbors: Annotated[
        int,
        Param(
            "Nearest points",
            "Points per neighborhood, the point itself among them; used by the neighborhood 'nearest'. "
            "More of them smooth noise away and blur small things.",
            low=3,
            high=1000,
        ),
    ] = 50,
    radius: Annotated[
        Optional[float],
        Param(
            "Radius",
            "Radius of the sphere around a point; used by the neighborhood 'radius'.",
            unit="m",
            low=0,
            open_low=True,
            automatic="the radius of a circle that holds 'Nearest points' at the measured density.",
        ),
    ] = None,
    features: Annotated[
        tuple[str, ...],
        Param("Features", "What to compute; each becomes a dimension of the cloud.", choices=_FEATURES),
    ] = ("linearity", "planarity", "scattering", "entropy", "surface_variation", "verticality"),
    monitor=None,
):
    """Describe the shape of each point's neighborhood by the eigenvalues of its covariance.

    Wires are linear, roofs and ground are planar, crowns are scattered; the entropy says how mixed the
    three are. Choose which features to keep: each becomes a dimension that can be drawn and filtered.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m).

    Returns
    -------
    ndarrays of shape (n,), float32, or (n, 3) for normal; None for each feature not asked for
        ``linearity`` (l1 - l2) / l1, ``planarity`` (l2 - l3) / l1 and ``scattering`` l3 / l1, which add up to 1;
        ``entropy`` -L ln L - P ln P - S ln S of these, 0 to ln 3;
        ``omnivariance`` (l1 l2 l3)^(1/3) in m²;
        ``anisotropy`` (l1 - l3) / l1;
        ``eigenentropy`` -sum e ln e with e = l / sum l, 0 to ln 3;
        ``eigenvalue_sum`` l1 + l2 + l3 in m²;
        ``surface_variation`` l3 / (l1 + l2 + l3), 0 to 1/3;
        ``verticality`` 1 - |n_z|, 0 on flat roofs and 1 on walls;
        ``normal`` the unit eigenvector of l3, upward.
        NaN where a neighborhood has fewer than three points or all of them coincide.

    Raises
    ------
    ValueError
        If no feature is chosen, or a radius holds more than 20,000 points on average.

    Notes
    -----
    The covariance is that of the point together with its neighbors, with their number as divisor. Coordinates are
    taken relative to each point, so that large ones lose nothing. Surface variation is what other programs
    call curvature; verticality is that of Demantké et al.

    References
    ----------
    Santos et al. (2019), Building detection from LiDAR data using entropy and the k-means concept, equations 6-11.
    Weinmann et al. (2017), Point cloud analysis for UAV-borne laser scanning, section 4.2.
    Demantké et al. (2011), Dimensionality based scale selection in 3D lidar point clouds.

    Examples
    --------
    >>> square = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]
    >>> made = compute_features(square, n_neighbors=4, features=("planarity", "normal"))
    >>> made[1], made[10][0]
    (array([1., 1., 1., 1.], dtype=float32), array([0., 0., 1.], dtype=float32))
    """
    if not features:
        raise ValueError(f"No feature is chosen; choose at least one of {', '.join(_FEATURES)}.")
    around: Union[Nearest, Within] = Nearest(n_neighbors)
    if neighborhood == "radius":
        around = Within(radius or _automatic_radius(xyz, n_neighbors, monitor))
    made = {name: np.empty((len(xyz), 3) if name == "normal" else len(xyz), np.float32) for name in features}

    def keep(rows: np.ndarray, covariances: np.ndarray, counts: np.ndarray) -> None:
        eigenvalues = defined_eigenvalues(covariances, counts)
        for name, values in features_of(features, eigenvalues, covariances).items():
            made[name][rows] = values

    reduce_neighborhoods(xyz, around, keep, monitor=monitor)
    undefined = int(np.isnan(made[features[0]]).reshape(len(xyz), -1)[:, 0].sum())
    if undefined:
        monitor.warn(f"{undefined} of {len(xyz)} points have too few distinct neighbors: their features are undefined.")
    return tuple(made.get(name) for name in _FEATURES)


def features_of(names: tuple[str, ...], eigenvalues: np.ndarray, covariances: np.ndarray) -> dict[str, np.ndarray]:
    """Return the named features of eigenvalues (m, 3) and the covariances (m, 6) they are of."""
    first, second, third = eigenvalues.T
    total = first + second + third
    linearity, planarity, scattering = dimensionality(eigenvalues)
    computed = {
        "linearity": lambda: linearity,
        "planarity": lambda: planarity,
        "scattering": lambda: scattering,
        "entropy": lambda: shannon_entropy_lps(eigenvalues),
        "omnivariance": lambda: np.cbrt(first * second * third),
        "anisotropy": lambda: linearity + planarity,
        "eigenentropy": lambda: shannon_entropy(first / total, second / total, third / total),
        "eigenvalue_sum": lambda: total,
        "surface_variation": lambda: third / total,
    }
    made = {name: computed[name]() for name in names if name in computed}
    if {"normal", "verticality"} & set(names):
        normal = smallest_eigenvectors(covariances, eigenvalues)
        made.update({name: values for name, values in _of_normal(normal).items() if name in names})
    return made


def _of_normal(normal: np.ndarray) -> dict[str, np.ndarray]:
    return {"verticality": 1 - normal[:, 2], "normal": normal}


def _automatic_radius(xyz: np.ndarray, n_neighbors: int, monitor: Monitor) -> float:
    radius = float(np.sqrt(n_neighbors / (np.pi * point_density(xyz))))
    monitor.resolved(radius=radius)
    return radius
