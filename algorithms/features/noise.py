"""How dense and how rough the surfaces of a cloud are: what tolerances are tied to."""

from __future__ import annotations

from typing import Any, Union

import numpy as np

from ..cloud.cells import plan_box
from ..cloud.density import point_spacing
from ..cloud.rounding import least_deviation
from ..packages import spatial
from ..stage import Monitor
from ..threads import in_chunks
from .eigen import Nearest, symmetric_eigenvalues
from .wide import LEAST_WIDTH, MOST_ACROSS_LINES, Wide

# Points whose surroundings are looked at, about.
_SAMPLE = 20_000

# They lie in the middle of square places that are so many point spacings wide that the 60 points nearest
# to each are there, too.
_MIDDLE, _PLACE = 0.4, 18.0

# With less than this share of the points aimed at, chance would tell.
_LEAST_OF_SAMPLE = 0.25

_NEIGHBORS = 12

# A plane's neighborhood reaches eight times the noise, which holds its normal's error to a few degrees.
_REACH_DEVIATIONS, LEAST_NEIGHBORS = 8.0, 8

# Leaves and twigs look smooth over less than this (m); roofs are planes over more.
_LEAST_REACH = 0.5

# Points lie on lines where of the smooth neighborhoods more than this share is narrow.
_NARROW_SHARE = 0.2

# Half of the points lying more than so many times as densely as the cloud at large, it is their density that counts.
_UNEVEN = 2.0

# Half a meter around holds so many at 125 points/m²; with more, every neighborhood would cost and tell nothing new.
_MOST_NEIGHBORS = 100

# A fifth of the surroundings of nearly any cloud with ground in it is open ground or roof. In a closed forest less is:
# surfaces differ in roughness by less than so many times the smoothest twentieth, and crowns by more.
_SMOOTH_SHARE, _SMOOTHEST_SHARE, _MOST_ROUGHER = 0.2, 0.05, 3.0

# Roof tiles, gravel and gutters are rougher than the smoothest surfaces, by which the noise is measured,
# and the more so the farther apart the points are (m; share of the point spacing).
_LEAST_ROUGHNESS, _ROUGHNESS_OF_SPACING = 0.02, 0.05


class SurfaceSample:
    """Places spread over a cloud, with all points there: what lies around some points tells about the whole.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points (m), n >= 1.
    tree : scipy.spatial.cKDTree, optional
        Tree of all points where there is one already: then the surroundings are exact.

    Attributes
    ----------
    columns : ndarray of shape (3, m)
        x, y and z of the points of the places, or of all points (m), and ``tree`` of them.
    rows : ndarray of shape (s,)
        The points in the middle of their places, whose neighbors are all there.

    Notes
    -----
    Places are chosen by where they lie, so that the order of the points doesn't matter.
    """

    def __init__(self, xyz: np.ndarray, tree: Any = None) -> None:
        at_places, is_middle = _places(xyz)
        if tree is None:
            xyz, is_middle = xyz[at_places], is_middle[at_places]
            tree = spatial.cKDTree(xyz, balanced_tree=False)
        self.tree, self.columns, self.rows = tree, np.ascontiguousarray(xyz.T), np.flatnonzero(is_middle)

    def __len__(self) -> int:
        return self.columns.shape[1]

    def noise(self) -> float:
        """Return the standard deviation of points across the smooth surfaces, m, at least 0.01 and that of rounding.

        Notes
        -----
        The deviation from the plane of the 12 nearest points at the smoothest fifth of the cloud: vegetation, edges
        and walls don't reach that far; but no more than three times that of the smoothest twentieth, as in a closed
        forest they do. In a cloud of planes and nothing else that is 0.77 of the true noise.
        """
        count = min(_NEIGHBORS, len(self))
        least = least_deviation(self.columns[2])
        if count <= 3:
            return least
        across = self._variances(count)[:, 2] * count / (count - 3)
        smooth, smoothest = np.maximum(np.sqrt(np.quantile(across, (_SMOOTH_SHARE, _SMOOTHEST_SHARE))), least)
        return float(min(smooth, _MOST_ROUGHER * smoothest))

    def roughness(self, density: float) -> float:
        """Return how far points of one roof surface, ``density`` per m², may lie off its plane (one deviation, m)."""
        return float(np.hypot(max(self.noise(), _LEAST_ROUGHNESS), _ROUGHNESS_OF_SPACING / np.sqrt(density)))

    def density(self) -> float:
        """Return the points per square meter of the surfaces that they lie on, however steep these are.

        It is that around the median point, counted in the circle of its 12 nearest; infinite where all points lie at
        one place.
        """
        count = min(_NEIGHBORS, len(self))
        own = self.columns[:, self.rows].T
        reach = float(np.median(self.tree.query(own, k=[count], workers=-1)[0]))
        return count / (np.pi * reach**2) if reach > 0 else float("inf")

    def neighborhood(self, density: float, noise: float) -> Union[Nearest, Wide]:
        """Return which points tell the plane of a surface.

        Few where points are precise, more where they are noisy or dense: the smooth side of a crown is a plane too
        when it is looked at closely enough. And enough to cross scan lines, where the points lie on such.

        Parameters
        ----------
        density : float
            Points per square meter.
        noise : float
            Standard deviation of points across a smooth surface, m.

        Returns
        -------
        Nearest or Wide
            So many nearest points, from 8 to 100 and at most all, as reach half a meter and eight times the noise; and
            not fewer than are wide where less than four fifths of the smooth neighborhoods of so many are.
        """
        own = self.density()
        reach = max(_LEAST_REACH, _REACH_DEVIATIONS * noise)
        expected = np.pi * reach**2 * (own if own > _UNEVEN * density else density)
        count = min(max(int(np.ceil(min(expected, _MOST_NEIGHBORS))), LEAST_NEIGHBORS), len(self))
        return Wide(count) if count < min(MOST_ACROSS_LINES, len(self)) and self._on_lines(count) else Nearest(count)

    def _on_lines(self, count: int) -> bool:
        """Return whether smooth neighborhoods of ``count`` points are narrow, because points lie on lines."""
        eigenvalues = self._variances(count)
        smooth = eigenvalues[:, 2] <= np.quantile(eigenvalues[:, 2], _SMOOTH_SHARE)
        width = np.sqrt(eigenvalues[smooth, 1] / np.maximum(eigenvalues[smooth, 0], 1e-12))
        return bool(np.quantile(width, _NARROW_SHARE) < LEAST_WIDTH)

    def _variances(self, count: int) -> np.ndarray:
        """Return the variances (s, 3), descending, of the ``count`` points nearest to each point of the sample, m²."""
        variances, nearest = np.empty((len(self.rows), 3)), Nearest(count)

        def work(some: np.ndarray) -> None:
            variances[some] = symmetric_eigenvalues(nearest.moments(self.columns, self.tree, self.rows[some])[2])

        in_chunks(work, np.arange(len(self.rows)), nearest.rows_per_chunk(len(self)), Monitor())
        return variances


def _places(xyz: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return which points lie at the places of a sample, and which in the middle of one (n,); all of a small cloud."""
    everything = np.ones(len(xyz), bool)
    low, high = plan_box(xyz)
    if len(xyz) < 2 * _SAMPLE or not (high > low).any():
        return everything, everything
    side = _PLACE * point_spacing(xyz)
    place, middle = np.zeros(len(xyz), np.uint64), everything.copy()
    # Large odd numbers mix the coordinates; the high bits of the products are the well mixed ones.
    for axis, mixer in enumerate((0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F)):
        position = (xyz[:, axis] - low[axis]) / side
        number = np.floor(position)
        middle &= np.abs(position - number - 0.5) <= _MIDDLE / 2
        place += number.astype(np.uint64) * np.uint64(mixer)
    share = min(1.0, _SAMPLE / (_MIDDLE**2 * len(xyz)))
    chosen = (place >> np.uint64(40)).astype(np.float64) < share * 2**24
    middle &= chosen
    # A cloud on few places, a mast or a wall, is looked at whole.
    return (chosen, middle) if middle.sum() >= _LEAST_OF_SAMPLE * _SAMPLE else (everything, everything)
