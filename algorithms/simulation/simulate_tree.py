"""A tree scanned from all sides, with known branches."""

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from ..cloud.asprs import PointClass
from ..geometry.polygons import axes_across
from ..params import SEED
from ..shapes.stem_search import BREAST
from ..stage import Field, Layer, LayerFeatures, stage, tunable

# Radius of a branch at its tip, as a share of the radius at its base.
_TIP = 0.35

# Straight pieces per branch.
_PIECES = 12

_FIELDS = (
    Field("id", int, "number of the branch, as SegmentID of its points"),
    Field("branch_order", int, "0 for the stem, 1 for branches of the stem, 2 for branches of branches"),
    Field("length", float, "length", "m"),
    Field("radius", float, "radius at the base", "m"),
)


@dataclass(frozen=True)
class _Limb:
    """A stem or branch: axis (k, 3), radii (k,) along it, and branch order."""

    line: np.ndarray
    radius: np.ndarray
    order: int

    @property
    def length(self) -> float:
        return float(np.linalg.norm(np.diff(self.line, axis=0), axis=1).sum())


@stage(
    "Simulation",
    tags="synthetic,tree,stem,branches,leaves,terrestrial,laser scanner,DBH,demo,example,test,truth,teaching",
    creates=("xyz", "classification", "segment_id"),
    layers=(Layer("branches", "True stem and branches", "LineString", _FIELDS),),
)
def simulate_tree(
    *,
    height: float = tunable(14.0, within="[3, 60] m"),
    dbh: float = tunable(0.3, label="Stem diameter", within="[0.05, 2] m"),
    n_branches: int = tunable(14, label="Branches", within="[0, 100]"),
    leaves: float = tunable(0.2, within="[0, 5]"),
    density: float = tunable(5000.0, label="Point density", within="[100, 100_000] points/m²"),
    noise: float = tunable(0.003, within="[0, 0.05] m"),
    seed: int = SEED,
    monitor=None,
):
    """Simulate a scan of a tree: points with their true branch, and the axes of stem and branches.

    The tree has a slightly crooked, tapering stem, branches with branches of their own, and leaves around the outer
    halves of branches. The ground is level.

    Returns
    -------
    xyz : ndarray of shape (n, 3), float64
        Coordinates (m).
    classification : ndarray of shape (n,), uint8
        True class: 2 ground, 5 tree.
    segment_id : ndarray of shape (n,), int32
        1 for the stem, from 2 for branches; 0 for leaves and ground.
    branches : LayerFeatures
        Axes of stem and branches, from the base to the tip.

    Other Parameters
    ----------------
    height
        Height of the tree.
    dbh
        Diameter of the stem at breast height, 1.3 m.
    n_branches
        Branches of the stem.
    leaves
        Number of points on leaves, per point on wood.
    density
        Point density on wood.
    noise
        Standard deviation of points across the bark.

    Notes
    -----
    All sides of the wood have points, without occlusion. Wind is not simulated.

    Examples
    --------
    >>> from lidar_buildings.algorithms.simulation.simulate_tree import simulate_tree
    >>> xyz, _, segment_id, lines = simulate_tree(height=5.0, dbh=0.1, n_branches=2, density=500.0)
    >>> len(lines) >= 3, int(segment_id.max()) == len(lines)
    (True, True)
    """
    rng = np.random.default_rng([seed, 6])
    limbs = _grown(height, dbh, n_branches, rng)
    monitor.progress(0.3)
    points = [_outside(_bark(limb, density, noise, rng), limb, limbs) for limb in limbs]
    n_wood = sum(len(one) for one in points)
    foliage = _foliage(limbs, round(leaves * n_wood), rng)
    # A square of 6 m with 200 points per m².
    ground = rng.uniform(-3.0, 3.0, (7200, 3)) * [1, 1, 0]
    ground[:, 2] += noise * rng.standard_normal(len(ground))
    ids = np.repeat(np.arange(1, len(limbs) + 1), [len(one) for one in points])
    n_other = len(foliage) + len(ground)
    classes = np.repeat([PointClass.HIGH_VEGETATION, PointClass.GROUND], [n_wood + len(foliage), len(ground)])
    facts = [{"branch_order": one.order, "length": one.length, "radius": float(one.radius[0])} for one in limbs]
    return (
        np.concatenate([*points, foliage, ground]),
        classes.astype(np.uint8),
        np.concatenate([ids, np.zeros(n_other)]).astype(np.int32),
        LayerFeatures.numbered([(limb.line, row) for limb, row in zip(limbs, facts)], _FIELDS),
    )


def _grown(height: float, dbh: float, branches: int, rng: Generator) -> list[_Limb]:
    """Return the stem, its branches, and the branches of these."""
    # From the radius at breast height to the radius at the base.
    taper = 1 - (1 - _TIP) * BREAST / height
    stem = _limb(np.zeros(3), np.array([0.0, 0.0, 1.0]), height, dbh / 2 / taper, 0, rng)
    limbs = [stem]
    turn = rng.uniform(0, 2 * np.pi)
    for number in range(branches):
        # Branches leave the stem from 30 to 90 % of its height.
        share = 0.3 + 0.6 * (number + rng.uniform(0.2, 0.8)) / branches
        # Steps of the golden angle avoid branches above each other.
        limb = _branch(stem, share, turn + number * np.pi * (3 - np.sqrt(5)), rng)
        limbs.append(limb)
        # From 2 m on a branch has three branches, alternately at both sides.
        if limb.length >= 2.0:
            sides = rng.uniform(0, 2 * np.pi) + np.arange(3) * np.pi
            limbs += [_branch(limb, at, side, rng) for at, side in zip((0.3, 0.5, 0.7), sides)]
    return limbs


def _branch(parent: _Limb, share: float, turn: float, rng: Generator) -> _Limb:
    """Return a branch that starts at a share of the length of its parent."""
    at = share * (len(parent.line) - 1)
    first = int(at)
    along = parent.line[first + 1] - parent.line[first]
    base = parent.line[first] + (at - first) * along
    along /= np.linalg.norm(along)
    one, other = axes_across(along)
    angle = np.radians(rng.uniform(45.0, 70.0))
    direction = np.cos(angle) * along + np.sin(angle) * (np.cos(turn) * one + np.sin(turn) * other)
    # A branch is shorter than the rest of its parent, and has 55 % of its radius.
    length = rng.uniform(0.35, 0.6) * (1 - share) * parent.length
    radius = 0.55 * float(np.interp(at, np.arange(len(parent.radius)), parent.radius))
    return _limb(base, direction, length, radius, parent.order + 1, rng)


def _limb(base: np.ndarray, direction: np.ndarray, length: float, radius: float, order: int, rng: Generator) -> _Limb:
    """Return a limb of straight pieces with directions that differ by a standard deviation of 3° per coordinate."""
    line = [base]
    for _ in range(_PIECES):
        direction = direction + np.radians(3.0) * rng.standard_normal(3)
        direction /= np.linalg.norm(direction)
        line.append(line[-1] + length / _PIECES * direction)
    return _Limb(np.array(line), np.linspace(radius, _TIP * radius, _PIECES + 1), order)


def _bark(limb: _Limb, density: float, noise: float, rng: Generator) -> np.ndarray:
    """Sample points (n, 3) on the surface of a limb."""
    steps = np.diff(limb.line, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    middle = (limb.radius[1:] + limb.radius[:-1]) / 2
    counts = np.round(2 * np.pi * middle * lengths * density).astype(np.int64)
    piece = np.repeat(np.arange(len(steps)), counts)
    share, angle = rng.random(len(piece)), rng.uniform(0, 2 * np.pi, len(piece))
    frames = np.array([axes_across(step / length) for step, length in zip(steps, lengths)])
    away = np.cos(angle)[:, None] * frames[piece, 0] + np.sin(angle)[:, None] * frames[piece, 1]
    radius = limb.radius[piece] + share * (limb.radius[piece + 1] - limb.radius[piece])
    radius = radius + noise * rng.standard_normal(len(piece))
    return limb.line[piece] + share[:, None] * steps[piece] + radius[:, None] * away


def _outside(xyz: np.ndarray, limb: _Limb, limbs: list[_Limb]) -> np.ndarray:
    """Return the points of a limb outside limbs of lower order: its base is inside its parent."""
    kept = np.ones(len(xyz), bool)
    for other in limbs:
        if other.order < limb.order:
            for start, end, radius in zip(other.line[:-1], other.line[1:], other.radius):
                along = end - start
                share = np.clip((xyz - start) @ along / (along @ along), 0, 1)
                kept &= np.linalg.norm(xyz - start - share[:, None] * along, axis=1) > radius
    return xyz[kept]


def _foliage(limbs: list[_Limb], count: int, rng: Generator) -> np.ndarray:
    """Sample points (count, 3) on leaves around the outer halves of branches, with a standard deviation of 0.15 m."""
    bearing = [limb for limb in limbs if limb.order > 0]
    if not bearing:
        return np.zeros((0, 3))
    which = rng.integers(0, len(bearing), count)
    at = rng.integers(_PIECES // 2, _PIECES + 1, count)
    return np.array([limb.line for limb in bearing])[which, at] + rng.normal(0, 0.15, (count, 3))
