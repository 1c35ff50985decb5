"""How dense and how noisy the surfaces of a cloud are, measured on a sample of it."""

from dataclasses import dataclass
from functools import cached_property
from typing import Callable, Optional, Union

import numpy as np

from ..geometry.grid import plan_box
from ..geometry.scattered import scattered
from ..geometry.tin import PLANE_POINTS
from ..neighborhoods.covariance import Nearest, symmetric_eigenvalues
from ..neighborhoods.wide_in_plan import LEAST_WIDTH, MOST_ACROSS_LINES, Wide
from ..packages import spatial, special
from ..rules import rule, rules
from ..stage import Monitor
from ..threads import in_chunks, n_threads
from .density import point_spacing


@rules
class SURFACES:
    """What shows the noise of surfaces, and how rough roofs and walls are."""

    sample: int = rule(20_000, "points, or cells", "statistics: quantiles of as many are good to a percent")
    square: float = rule(18.0, "point spacings", "side of the squares in plan from which the sample is taken")
    middle: float = rule(0.4, "share", "of that side; the 60 points nearest to a point there are in its square, too")
    least_of_sample: float = rule(0.25, "share", "of the sample; with less, the cloud is taken whole")
    neighbors: int = rule(12, "points", "few reach no farther than one surface, and more measure its noise no better")
    smooth_share: float = rule(
        0.2, "share", "of the neighborhoods, smooth in nearly any cloud; of these, as many may be narrow in plan"
    )
    smoothest_share: float = rule(0.05, "share", "the same in a closed forest")
    most_rougher: float = rule(2.4, "ratio", "of the noise by these two: surfaces differ by less, crowns by more")
    reach: float = rule(6.0, "deviations", "statistics: holds the error of a normal to a few degrees")
    least_reach: float = rule(0.5, "m", "physics: leaves and twigs look smooth over less, roofs are planes over more")
    least_neighbors: int = rule(8, "points", "statistics: five degrees of freedom for a plane")
    most_neighbors: int = rule(100, "points", "half a meter around at 125 points per m²")
    uneven: float = rule(
        2.0, "ratio", "of the density around the median point to the cloud's, above which the former counts"
    )
    least_roughness: float = rule(0.025, "m", "physics: relief of roof tiles, gravel and gutters")
    roughness_of_spacing: float = rule(0.065, "point spacings", "chosen: surfaces bend between points")
    on_plane: float = rule(2.33, "deviations", "statistics: 98 % of normally distributed points lie as near to a plane")


ON_PLANE, LEAST_NEIGHBORS = SURFACES.on_plane, SURFACES.least_neighbors
ROUGHNESS_OF_SPACING = SURFACES.roughness_of_spacing

# The roughness of surfaces, for the help of parameters that follow it.
ROUGHNESS = (
    f"the root of the sum of the squares of the surface noise, at least {SURFACES.least_roughness:g} m, and of "
    f"{SURFACES.roughness_of_spacing:g} point spacings"
)


def plane_roughness(noise: float, density: float) -> float:
    """Return the standard deviation (m) of the points of one roof or wall from its plane.

    Parameters
    ----------
    noise : float
        Standard deviation of points across the smooth surfaces of the cloud, m.
    density : float
        Points per square meter.
    """
    return float(np.hypot(max(noise, SURFACES.least_roughness), ROUGHNESS_OF_SPACING / np.sqrt(density)))


def surface_density(xyz: np.ndarray) -> float:
    """Return the points per square meter of the surfaces that points (n, 3) lie on, however steep these are.

    It is that around the median point, counted in the circle of its 12 nearest; infinite where all points lie at
    one position.
    """
    return SurfaceSample(xyz).density


@dataclass(frozen=True)
class MeasuredSurfaces:
    """The numbers measured on a :class:`SurfaceSample` from which neighborhoods follow."""

    n_points: int  #: Points of the sample
    surface_density: float  #: Points per square meter of surfaces
    narrow_below: int  #: Smooth neighborhoods of fewer points than this are narrow in plan, because points lie on lines

    def neighborhood(self, density: float, deviation: float) -> Union[Nearest, Wide]:
        """Return the neighbors that show the plane of a surface, see :meth:`SurfaceSample.neighborhood`."""
        return _neighborhood(
            self.n_points, self.surface_density, lambda count: count < self.narrow_below, density, deviation
        )


class SurfaceSample:
    """Squares spread over a cloud with all points in them: neighborhoods there represent the whole cloud's.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m), n >= 1.
    spacing : float, optional
        Their spacing in plan (m); measured where it is not known.

    Attributes
    ----------
    columns : ndarray of shape (3, m)
        x, y and z of the points of the squares, or of all points (m), and ``tree`` of them.
    rows : ndarray of shape (s,)
        The sample: points in the middle of their squares, whose neighbors are all there.

    Notes
    -----
    Squares are chosen by their coordinates, so that the order of the points doesn't matter.
    """

    def __init__(self, xyz: np.ndarray, spacing: Optional[float] = None) -> None:
        in_square, is_middle = _squares(xyz, spacing)
        xyz, is_middle = xyz[in_square], is_middle[in_square]
        self.tree = spatial.cKDTree(xyz, balanced_tree=False)
        self.columns, self.rows = np.ascontiguousarray(xyz.T), np.flatnonzero(is_middle)

    def __len__(self) -> int:
        return self.columns.shape[1]

    def noise(self, resolution: float) -> float:
        """Return the standard deviation of points across the smooth surfaces, m, at least the ``resolution`` (m).

        Notes
        -----
        It is that across the plane of the 12 nearest points, at the smoothest fifth of the cloud, which vegetation,
        edges and walls don't reach. But no more than ``SURFACES.most_rougher`` times that at the smoothest twentieth,
        which they don't reach in a closed forest. Of equally rough planes the smoothest seem smoother than they are, by
        chance. Each quantile is divided by its expected share of the true deviation, so that a cloud of planes has its
        true noise.
        """
        count = min(SURFACES.neighbors, len(self))
        # Residuals of k points over their plane have k - 3 degrees of freedom.
        degrees = count - PLANE_POINTS
        if degrees < 1:
            return resolution
        across = np.sqrt(self._of_nearest[:, 2] * count / degrees)
        smooth, smoothest = (
            max(float(np.quantile(across, share)) / _expected_quantile(share, degrees), resolution)
            for share in (SURFACES.smooth_share, SURFACES.smoothest_share)
        )
        return min(smooth, SURFACES.most_rougher * smoothest)

    @cached_property
    def density(self) -> float:
        """Points per square meter of the surfaces, see :func:`surface_density`."""
        count = min(SURFACES.neighbors, len(self))
        reach = float(np.median(self.tree.query(self.columns[:, self.rows].T, k=[count], workers=n_threads())[0]))
        return count / (np.pi * reach**2) if reach > 0 else float("inf")

    def neighborhood(self, density: float, deviation: float) -> Union[Nearest, Wide]:
        """Return the neighbors of a point that show the plane of a surface.

        Few where points are precise, more where they are noisy or dense: the smooth side of a crown is a plane too
        when it is looked at closely enough. And enough to cross scan lines, where the points lie on such.

        Parameters
        ----------
        density : float
            Points per square meter of the cloud. The surfaces' counts where it is over twice as large.
        deviation : float
            Standard deviation of points across the surface, m.

        Returns
        -------
        Nearest or Wide
            As many nearest points as reach half a meter or 6 deviations, whichever is more, from 8 to 100 and at most
            all. Where less than four fifths of the smooth neighborhoods of that number are wide in plan, those that are
            not get more points.
        """
        return _neighborhood(len(self), self.density, self._on_lines, density, deviation)

    def measured(self) -> MeasuredSurfaces:
        """Return the settings of neighborhoods, without the points: for the parts of a cloud that is worked on so."""
        return MeasuredSurfaces(len(self), self.density, self._narrow_below)

    @cached_property
    def _of_nearest(self) -> np.ndarray:
        """Variances (s, 3) of the nearest points that show the noise, m²."""
        return self._variances(min(SURFACES.neighbors, len(self)))

    @cached_property
    def _narrow_below(self) -> int:
        """Least number of points from which on smooth neighborhoods are not narrow: they widen with their number."""
        low, high = LEAST_NEIGHBORS, min(MOST_ACROSS_LINES, len(self))
        # In most clouds the fewest points do, and show it soonest.
        if low < high and not self._on_lines(low):
            return low
        while low < high:
            middle = (low + high) // 2
            low, high = (middle + 1, high) if self._on_lines(middle) else (low, middle)
        return low

    def _on_lines(self, count: int) -> bool:
        """Return whether smooth neighborhoods of ``count`` points are narrow, because points lie on lines."""
        eigenvalues = self._variances(count)
        smooth = eigenvalues[:, 2] <= np.quantile(eigenvalues[:, 2], SURFACES.smooth_share)
        width = np.sqrt(eigenvalues[smooth, 1] / np.maximum(eigenvalues[smooth, 0], 1e-12))
        return bool(np.quantile(width, SURFACES.smooth_share) < LEAST_WIDTH)

    def _variances(self, count: int) -> np.ndarray:
        """Return the variances (s, 3), descending, of the ``count`` points nearest to each point of the sample, m²."""
        variances, nearest = np.empty((len(self.rows), 3)), Nearest(count)

        def work(some: np.ndarray) -> None:
            variances[some] = symmetric_eigenvalues(nearest.moments(self.tree, self.rows[some])[2])

        in_chunks(work, np.arange(len(self.rows)), nearest.rows_per_chunk(len(self)), Monitor())
        return variances


def _neighborhood(
    n_points: int, own_density: float, on_lines: Callable[[int], bool], density: float, deviation: float
) -> Union[Nearest, Wide]:
    """Return the neighbors that show the plane of a surface, see :meth:`SurfaceSample.neighborhood`."""
    reach = max(SURFACES.least_reach, SURFACES.reach * deviation)
    expected = np.pi * reach**2 * (own_density if own_density > SURFACES.uneven * density else density)
    count = min(max(int(np.ceil(min(expected, SURFACES.most_neighbors))), LEAST_NEIGHBORS), n_points)
    return Wide(count) if count < min(MOST_ACROSS_LINES, n_points) and on_lines(count) else Nearest(count)


def _expected_quantile(share: float, degrees: int) -> float:
    """Return the quantile of estimates of a standard deviation that have ``degrees`` of freedom, over the true one.

    Their squares are distributed as chi squared over its degrees: 0.77 for a fifth and 0.61 for a twentieth with 9.
    """
    return float(np.sqrt(2 * special.gammaincinv(degrees / 2, share) / degrees))


def _squares(xyz: np.ndarray, spacing: Optional[float]) -> tuple[np.ndarray, np.ndarray]:
    """Return masks (n,) of points in the squares of a sample, and in the middle of any; all of a small cloud."""
    everything = np.ones(len(xyz), bool)
    low, high = plan_box(xyz)
    if len(xyz) < 2 * SURFACES.sample or not (high > low).any():
        return everything, everything
    side = SURFACES.square * (point_spacing(xyz) if spacing is None else spacing)
    position = (xyz[:, :2] - low) / side
    square = np.floor(position)
    middle = (np.abs(position - square - 0.5) <= SURFACES.middle / 2).all(axis=1)
    chosen = scattered(square.astype(np.int64)) < min(1.0, SURFACES.sample / (SURFACES.middle**2 * len(xyz)))
    middle &= chosen
    # A cloud on few squares, a mast or a wall, is looked at whole.
    return (chosen, middle) if middle.sum() >= SURFACES.least_of_sample * SURFACES.sample else (everything, everything)
