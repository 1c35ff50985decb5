"""A tree scanned from all sides, of which every branch is known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cloud.asprs import PointClass
from ..geometry.polygons import axes_across
from ..params import SEED
from ..shapes.stem_search import BREAST
from ..stage import Field, Layer, LayerFeatures, stage, tunable

# Radius of a branch where it leaves its parent (share of the radius of the parent there).
_THINNER = 0.55

# Radius of the tip of a branch (share of its base's).
_TIP = 0.35

# Length of a branch: share of the way from its base to the tip of its parent, so that the parent stays the longer one.
_LENGTH = (0.35, 0.6)

# Least and greatest angle between a branch and its parent (°).
_ANGLE = (45.0, 70.0)

# Straight pieces of the line of a branch.
_PIECES = 12

# Standard deviation of the turn from one piece to the next (°), about either axis.
_TURN = 3.0

# Branches leave the stem above this share of its length, over this share of it.
_OF_STEM = (0.3, 0.6)

# Shares of the length of a branch at which its branches leave it.
_OF_BRANCH = (0.3, 0.5, 0.7)

# Length of the shortest branch that has branches (m).
_LONG = 2.0

# Standard deviation (m) of the leaves around the line of their branch, along each axis.
_LEAF_SPREAD = 0.15

# Half the side of the square of ground (m).
_GROUND = 3.0

# Points of the ground per square meter.
_GROUND_DENSITY = 200.0

_FIELDS = (
    Field("id", int, "number of the branch, as SegmentID of its points"),
    Field("branch_order", int, "0 for the stem, 1 for branches of the stem, 2 for theirs"),
    Field("length", float, "length", "m"),
    Field("radius", float, "radius at the base", "m"),
)


@dataclass(frozen=True)
class _Limb:
    """A stem or branch: its line (k, 3), the radii (k,) along it, and its order."""

    line: np.ndarray
    radius: np.ndarray
    order: int

    @property
    def length(self) -> float:
        return float(np.linalg.norm(np.diff(self.line, axis=0), axis=1).sum())

    @property
    def facts(self) -> dict[str, float]:
        return {"branch_order": self.order, "length": self.length, "radius": float(self.radius[0])}


@stage(
    "Simulation",
    tags="synthetic,tree,stem,branches,leaves,terrestrial,laser scanner,DBH,demo,example,test,truth,teaching",
    creates=("xyz", "classification", "segment_id"),
    layers=(Layer("branches", "True stem and branches", "LineString", _FIELDS),),
)
def simulate_tree(
    *,
    height: float = tunable(14.0, "Height of the tree.", within="[3, 60] m"),
    dbh: float = tunable(
        0.3, "Diameter of the stem at breast height, 1.3 m.", label="Stem diameter", within="[0.05, 2] m"
    ),
    n_branches: int = tunable(14, "Branches of the stem.", label="Branches", within="[0, 100]"),
    leaves: float = tunable(0.2, "Points of leaves around the ends of branches, per point of wood.", within="[0, 5]"),
    density: float = tunable(5000.0, "Points on wood.", label="Point density", within="[100, 100_000] points/m²"),
    noise: float = tunable(0.003, "Standard deviation of a point across the bark.", within="[0, 0.05] m"),
    seed: int = SEED,
    monitor=None,
):
    """Scan a made-up tree: points with their true branch, and the lines of stem and branches.

    A slightly crooked stem that becomes thinner toward its top, branches around it, and branches of these; leaves
    around the outer halves of branches, and level ground.

    Returns
    -------
    xyz : ndarray of shape (n, 3), float64
        Coordinates (m).
    classification : ndarray of shape (n,), uint8
        2 ground, 5 everything else.
    segment_id : ndarray of shape (n,), int32
        1 for the stem, branches from 2; 0 for leaves and ground.
    branches : LayerFeatures
        Lines of stem and branches, from the base to the tip.

    Notes
    -----
    Wood is seen from all sides. Nothing is hidden, and nothing moves in the wind.

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
    ground = rng.uniform(-_GROUND, _GROUND, (round((2 * _GROUND) ** 2 * _GROUND_DENSITY), 3)) * [1, 1, 0]
    ground[:, 2] += noise * rng.standard_normal(len(ground))
    ids = np.repeat(np.arange(1, len(limbs) + 1), [len(one) for one in points])
    n_other = len(foliage) + len(ground)
    classes = np.repeat([PointClass.HIGH_VEGETATION, PointClass.GROUND], [n_wood + len(foliage), len(ground)])
    return (
        np.concatenate([*points, foliage, ground]),
        classes.astype(np.uint8),
        np.concatenate([ids, np.zeros(n_other)]).astype(np.int32),
        LayerFeatures.numbered([(limb.line, limb.facts) for limb in limbs], _FIELDS),
    )


def _grown(height: float, dbh: float, branches: int, rng: np.random.Generator) -> list[_Limb]:
    """Return the stem, its branches, and theirs."""
    # The radius that is asked for is that at breast height.
    taper = 1 - (1 - _TIP) * BREAST / height
    stem = _limb(np.zeros(3), np.array([0.0, 0.0, 1.0]), height, dbh / 2 / taper, 0, rng)
    limbs = [stem]
    turn = rng.uniform(0, 2 * np.pi)
    for number in range(branches):
        share = _OF_STEM[0] + _OF_STEM[1] * (number + rng.uniform(0.2, 0.8)) / branches
        # By the golden angle no two branches are above each other.
        limbs.append(_branch(stem, share, turn + number * np.pi * (3 - np.sqrt(5)), rng))
        if limbs[-1].length >= _LONG:
            limb = limbs[-1]
            sides = rng.uniform(0, 2 * np.pi) + np.arange(len(_OF_BRANCH)) * np.pi
            limbs += [_branch(limb, at, side, rng) for at, side in zip(_OF_BRANCH, sides)]
    return limbs


def _branch(parent: _Limb, share: float, turn: float, rng: np.random.Generator) -> _Limb:
    """Return a branch that leaves its parent at a share of its length."""
    at = share * (len(parent.line) - 1)
    first = int(at)
    base = parent.line[first] + (at - first) * (parent.line[first + 1] - parent.line[first])
    along = parent.line[first + 1] - parent.line[first]
    along /= np.linalg.norm(along)
    one, other = axes_across(along)
    angle = np.radians(rng.uniform(*_ANGLE))
    direction = np.cos(angle) * along + np.sin(angle) * (np.cos(turn) * one + np.sin(turn) * other)
    length = rng.uniform(*_LENGTH) * (1 - share) * parent.length
    radius = _THINNER * float(np.interp(at, np.arange(len(parent.radius)), parent.radius))
    return _limb(base, direction, length, radius, parent.order + 1, rng)


def _limb(
    base: np.ndarray, direction: np.ndarray, length: float, radius: float, order: int, rng: np.random.Generator
) -> _Limb:
    """Return a limb of pieces that are turned a little, each from the one before."""
    line = [base]
    for _ in range(_PIECES):
        direction = direction + np.radians(_TURN) * rng.standard_normal(3)
        direction /= np.linalg.norm(direction)
        line.append(line[-1] + length / _PIECES * direction)
    return _Limb(np.array(line), np.linspace(radius, _TIP * radius, _PIECES + 1), order)


def _bark(limb: _Limb, density: float, noise: float, rng: np.random.Generator) -> np.ndarray:
    """Return points (n, 3) on a limb."""
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
    """Return the points of a limb that lie in no thicker limb: where it leaves its parent, it is inside of that."""
    kept = np.ones(len(xyz), bool)
    for other in limbs:
        if other.order < limb.order:
            for start, end, radius in zip(other.line[:-1], other.line[1:], other.radius):
                along = end - start
                share = np.clip((xyz - start) @ along / (along @ along), 0, 1)
                kept &= np.linalg.norm(xyz - start - share[:, None] * along, axis=1) > radius
    return xyz[kept]


def _foliage(limbs: list[_Limb], count: int, rng: np.random.Generator) -> np.ndarray:
    """Return points (count, 3) of leaves around the outer halves of branches."""
    bearing = [limb for limb in limbs if limb.order > 0]
    if not bearing:
        return np.zeros((0, 3))
    which = rng.integers(0, len(bearing), count)
    at = rng.integers(_PIECES // 2, _PIECES + 1, count)
    lines = np.array([limb.line for limb in bearing])
    return lines[which, at] + rng.normal(0, _LEAF_SPREAD, (count, 3))
