"""Normals of the surface at each point, from neighborhoods that grow with the noise."""

import zlib
from weakref import WeakKeyDictionary

import numpy as np

from ..criteria import PLANE_NEIGHBORS, ROUNDING
from ..neighborhoods.covariance import Nearest, defined_eigenvalues, reduce_neighborhoods, smallest_eigenvectors
from ..neighborhoods.nearest_blocks import Shapes
from ..sampling.cloud_sampling import CloudSampling
from ..sampling.surface_noise import SURFACES
from ..stage import Monitor, tunable

# Standard deviation (radians) that normals may have from the noise: 3°, so that directions distinguish surfaces.
_NORMAL_ERROR = 0.05

# Of each sampling: the points that its normals were measured on, and the normals. They go with the sampling.
_KEPT: WeakKeyDictionary[CloudSampling, tuple[tuple, np.ndarray]] = WeakKeyDictionary()

NORMAL_POINTS = tunable(
    None,
    "Points of the neighborhood that gives a point its normal, itself among them. More are less noisy and round "
    "off edges and thin pipes.",
    label="Points for normals",
    within="[4, 1000]",
    automatic=f"as many as hold the error of normals from the noise to 3°, {PLANE_NEIGHBORS} to "
    f"{SURFACES.most_neighbors}.",
    advanced=True,
)


def normal_points(sampling: CloudSampling) -> int:
    """Return the number of nearest points that makes normals good to 3°.

    The slope of a plane fitted to k points with the deviation s that fill a disk of radius r is off by 2 s / (r
    sqrt(k)), and r is sqrt(k / (pi density)).
    """
    needed = 2 * sampling.scan_noise * float(np.sqrt(np.pi * sampling.surface_density)) / _NORMAL_ERROR
    return int(np.clip(np.ceil(min(needed, SURFACES.most_neighbors)), PLANE_NEIGHBORS, SURFACES.most_neighbors))


def normals_of(xyz: np.ndarray, count: int, sampling: CloudSampling, monitor: Monitor) -> np.ndarray:
    """Return the normals (n, 3) of a cloud (n, 3), m, see :func:`surface_normals`; measured once in a run.

    The stages of a run share its ``sampling``, with which the normals of the last cloud are kept.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Points, m.
    count : int
        Points of a neighborhood.
    sampling : CloudSampling
        How the cloud was sampled.
    monitor : Monitor
        Receives the progress.
    """
    key = count, xyz.shape, zlib.crc32(np.ascontiguousarray(xyz).data)
    kept = _KEPT.get(sampling)
    if kept is None or kept[0] != key:
        kept = key, surface_normals(xyz - xyz.min(axis=0), count, monitor)
        _KEPT[sampling] = kept
    return kept[1]


def surface_normals(xyz: np.ndarray, count: int, monitor: Monitor) -> np.ndarray:
    """Return the normals of the planes through the ``count`` points nearest to each point.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m).
    count : int
        Points of a neighborhood, the point itself among them.
    monitor : Monitor
        Receives progress.

    Returns
    -------
    ndarray of shape (n, 3), float64
        Unit vectors, n_z >= 0; zero where the neighborhood has no plane.

    Raises
    ------
    ValueError
        If all points lie on one line, so that there are no normals.
    """
    refuse_line(xyz)
    normal = np.zeros((len(xyz), 3))
    # In an order of their own, so that rounding does not depend on the cloud's.
    order = np.lexsort(xyz.T)

    def keep(positions: np.ndarray, shapes: Shapes) -> None:
        rows = order[positions]
        eigenvalues = defined_eigenvalues(shapes.covariances, shapes.counts)
        is_plane = eigenvalues[:, 1] > ROUNDING * np.maximum(eigenvalues[:, 0], 1e-300)
        normal[rows[is_plane]] = smallest_eigenvectors(shapes.covariances[is_plane], eigenvalues[is_plane])

    reduce_neighborhoods(xyz[order], Nearest(count), keep, monitor=monitor)
    return normal


def refuse_line(xyz: np.ndarray) -> None:
    """Refuse points that have no plane: fewer than three, or all on one line."""
    if len(xyz) < 3:
        raise ValueError(f"Shapes need at least three points, got {len(xyz)}; choose another cloud.")
    spread = np.linalg.eigvalsh(np.cov((xyz - xyz.mean(axis=0)).T))
    if spread[1] <= ROUNDING * max(spread[2], 1e-300):
        raise ValueError("All points lie on one line, so that no surface has a normal; choose another cloud.")
