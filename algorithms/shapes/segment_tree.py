"""Trees into stems and branches: shortest paths through their voxels from the roots, and slices across them."""

from typing import Optional

import numpy as np

from ..criteria import CELL_SPACINGS
from ..geometry.groups import split_groups
from ..geometry.polygons import axes_across
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..segmentation.candidate_points import candidates
from ..stage import Field, Layer, LayerFeatures, Monitor, stage, tunable
from .cylinder_fits import LEAST_POINTS, Cylinder, fit_cylinder
from .stem_search import BREAST, FAR, ROUND, find_stems, ground_level
from .surface_normals import refuse_line
from .tree_structure import Branch, Slices, branches_of, lengths_beyond, roots_of, self_supporting, smooth, voxels_of

# Least side of a voxel (m): bark is not resolved any finer.
_LEAST_VOXEL = 0.02

# Default of the gap that paths cross (voxels).
_GAP_VOXELS = 8.0

# Largest measured radius, as a multiple of the estimated one: larger ones are of leaves.
_WIDEST = 3.0

# Largest measured radius, as a multiple of the smallest one nearer to the root: but for noise, wood grows no thicker
# outward.
_SWELLING = 1.1

# Number of pieces farther out whose median radius a measured radius has to reach: wood grows thicker toward the root,
# and a thinner foot is one of which a part was seen.
_AHEAD = 5

# Length (m) of the pieces of a branch that have a radius of their own: branches taper little over it.
_PIECE = 0.5

_FIELDS = (
    Field("id", int, "number of the branch, as SegmentID of its points"),
    Field("tree", int, "number of the tree, from 1"),
    Field("branch_order", int, "0 for a stem, 1 for branches of the stem, 2 for theirs"),
    Field("dbh", float, "diameter of a stem at breast height, 1.3 m; empty for branches", "m"),
    Field("length", float, "length along the middle line", "m"),
    Field("radius", float, "median radius of its pieces, measured or estimated", "m"),
    Field("measured", float, "share of its pieces whose radius is measured, 0 to 1; of the others it is estimated"),
    Field("volume", float, "sum of the volumes of pieces of half a meter, each a cylinder", "m³"),
    Field("points", int, "points on the branch"),
)


@stage(
    "Shapes",
    title="Segment trees",
    tags="tree,forest,stem,trunk,branch,DBH,wood volume,skeleton,Dijkstra,terrestrial,TLS",
    writes=("segment_id",),
    layers=(Layer("branches", "Stems and branches", "LineString", _FIELDS),),
)
def segment_tree(
    xyz,
    classification,
    *,
    voxel_size: Optional[float] = tunable(
        None,
        within="[0.005, 10] m",
        automatic=f"{CELL_SPACINGS:g} times the point spacing on surfaces, at least {_LEAST_VOXEL:g} m.",
    ),
    min_count: int = tunable(2, label="Minimum points of a voxel", within="[1, 1000]"),
    max_gap: Optional[float] = tunable(None, within="[0, 10] m", automatic=f"{_GAP_VOXELS:g} voxels."),
    min_length: float = tunable(0.3, within="[0, 100] m"),
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Divide trees that were scanned from the ground into stems and branches, with diameters, lengths and volumes.

    The points become voxels, whose gaps are closed. Stems are round and upright at breast height. Every voxel
    has the shortest path to the root of a stem, and connected voxels about as far from it are a slice. At each fork
    of the slices the branch goes on where the way to its tip is longest, and the others are branches of the next order.
    Points of short and of crooked branches, and those far from the wood, are leaves.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes; ground (2, 20), noise (7, 18), water (9) and bridge decks (17) are left out.

    Returns
    -------
    segment_id : ndarray of shape (n,), int32
        Numbers from 1, stems before their branches; 0 is leaves and everything else.
    branches : LayerFeatures
        Middles of stems and branches, from the base to the tip.

    Other Parameters
    ----------------
    voxel_size
        Side of a voxel: about the thickness of the thinnest branches. Smaller voxels show thinner branches and need
        denser points.
    min_count
        Voxels with fewer points are left out: wood has several points to a voxel, leaves have single ones.
    max_gap
        Widest gap in a stem or branch that is crossed.
    min_length
        Length of the shortest branch; points of shorter ones are leaves.

    Raises
    ------
    ValueError
        If all points lie on one line, or the points are spread over more voxels than can be numbered.

    Notes
    -----
    Deviation from the paper: it thins the voxels to a skeleton and finds paths on that. Scanned stems are hollow and
    have holes, and their skeleton is a net; slices by the length of the path have their middle inside the stem. The
    ground below a tree is the lowest point within 1 to 2 m. Gaps up to the maximum are crossed at three times their
    length: shadows part stems and branches in every scan. Points farther from the middle line than ``FAR`` times
    the median of their piece of ``_PIECE`` m are leaves. A cylinder is fitted to each piece by least squares, also
    where one side of it is seen. Where none fits, the radius is the median distance of the points from the line. A
    radius must be at least half a voxel and at most ``_WIDEST`` times the estimated one, and the distances scatter by
    less than ``ROUND`` of it, as on a circle. Nor may it exceed radii nearer to the root by more than a tenth, or be
    thinner than the next ones. Elsewhere it is estimated from the nearest one measured toward the root, or from the
    stem's at breast height. Forks keep the area of the wood (pipe model), in proportion to the length of all branches
    beyond. A stem too slender to carry itself belongs to the thicker one that it grows from. A branch is crooked if
    its chord is shorter than 0.6 of its length.

    References
    ----------
    Gorte, B. G. H., Pfeifer, N., 2004. Structuring laser-scanned trees using 3D mathematical morphology. IAPRS 35 (B5),
    929-933. [gorte2004]
    Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds,
    section 5.4. [vosselman2004]
    Shinozaki, K., Yoda, K., Hozumi, K., Kira, T., 1964. A quantitative analysis of plant form: the pipe model theory.
    Japanese Journal of Ecology 14 (3), 97-105. [shinozaki1964]
    McMahon, T. A., 1973. Size and shape in biology. Science 179, 1201-1204. [mcmahon1973]

    Examples
    --------
    >>> from lidar_buildings.algorithms.simulation.simulate_tree import simulate_tree
    >>> xyz, classes, *_ = simulate_tree(leaves=0.0, density=500.0)
    >>> ids, branches = segment_tree(xyz, classes)
    >>> len(branches) > 0
    True
    """
    refuse_line(xyz)
    rows = candidates(classification, None, 0)
    if voxel_size is None:
        voxel_size = max(CELL_SPACINGS / float(np.sqrt(sampling.surface_density)), _LEAST_VOXEL)
    max_gap = _GAP_VOXELS * voxel_size if max_gap is None else max_gap
    monitor.resolved(voxel_size=voxel_size, max_gap=max_gap)
    origin = xyz.min(axis=0)
    everything = xyz - origin
    rows = rows[np.lexsort(everything[rows].T)]
    positions = everything[rows]
    segment_id = np.zeros(len(xyz), np.int32)
    level = ground_level(everything, positions[:, :2])
    stems = find_stems(positions, level, monitor.part(0, 0.1)) if len(rows) else []
    nothing = segment_id, LayerFeatures([], {field.name: [] for field in _FIELDS})
    if not stems:
        monitor.none_found("No stem was found at a height of 1.3 m; no point has a SegmentID.")
        return nothing
    voxels = voxels_of(positions, voxel_size, min_count, max_gap, monitor.part(0.1, 0.4))
    feet = np.array([_at_breast(stem, level) for stem, level in stems])
    radii = np.array([stem.radius for stem, _ in stems])
    if not len(roots_of(voxels, feet, radii)):
        monitor.none_found(
            f"No voxel of a stem holds {min_count} points ('Minimum points of a voxel'); no point has a SegmentID. "
            "Lower it, or take larger voxels."
        )
        return nothing
    slices = self_supporting(voxels, feet, radii, voxel_size)
    monitor.progress(0.7)
    branches, of_slice = branches_of(slices, min_length, monitor.part(0.7, 0.9))
    of_point = np.where(voxels.of_point >= 0, slices.of_voxel[voxels.of_point], -1)
    label, layer = _measured(
        positions, slices, branches, of_slice, of_point, (feet, radii, voxel_size), monitor.part(0.9, 1)
    )
    segment_id[rows] = label
    layer.geometries = [line + origin for line in layer.geometries]
    return segment_id, layer


def _at_breast(stem: Cylinder, level: float) -> np.ndarray:
    """Return the position (3,) on the axis of a stem at breast height above the ground."""
    return stem.center + (level + BREAST - stem.center[2]) / stem.axis[2] * stem.axis


def _measured(
    xyz: np.ndarray,
    slices: Slices,
    branches: list[Branch],
    of_slice: np.ndarray,
    of_point: np.ndarray,
    stems: tuple[np.ndarray, np.ndarray, float],
    monitor: Monitor,
) -> tuple[np.ndarray, LayerFeatures]:
    """Return the branch (n,) of each point from 1, 0 for leaves, and the layer of the branches.

    ``stems`` are the positions (s, 3) of stems at breast height, their radii (s,), m, and the side of a voxel (m).
    """
    feet, radii, voxel_size = stems
    # For each slice the square of a radius per length of branches beyond, m, and the smallest radius measured, m.
    beyond, wood = lengths_beyond(slices, of_slice), np.full((len(slices.positions), 2), np.inf)
    parts = split_groups(np.where(of_point >= 0, of_slice[of_point], -1), len(branches))
    label = np.zeros(len(xyz), np.int32)
    columns: dict[str, list] = {field.name: [] for field in _FIELDS}
    lines = []
    position = np.zeros(len(slices.positions), np.int64)
    for number, (one, own) in enumerate(zip(branches, parts), start=1):
        monitor.progress(number / len(branches))
        line = smooth(slices.positions[one.slices])
        position[one.slices] = np.arange(len(line))
        steps = np.linalg.norm(np.diff(line, axis=0), axis=1)
        along = np.concatenate([[0.0], np.cumsum(steps)])
        at = position[of_point[own]]
        distance = _off_line(line, at, xyz[own])
        piece, n_pieces = (along[at] / _PIECE).astype(np.int64), int(along[-1] / _PIECE) + 1
        reach = _medians(distance, piece, n_pieces)
        label[own[distance <= FAR * reach[piece]]] = number
        length = float(along[-1])
        ends = np.append(np.arange(n_pieces) * _PIECE, length)
        stem = int(np.argmin(np.linalg.norm(feet[:, None] - line, axis=2).min(axis=1)))
        ahead = beyond[one.slices]
        if one.order == 0:
            breast = int(np.argmin(np.linalg.norm(line - feet[stem], axis=1)))
            wood[one.slices[0]] = radii[stem] ** 2 / max(ahead[breast], _PIECE), radii[stem]
        else:
            ahead[0] = ahead[1] + steps[0]
        ahead = np.interp((ends[1:] + ends[:-1]) / 2, along, ahead)
        round_pieces = _are_round(distance, piece, reach)
        for k, bark in enumerate(split_groups(np.where(distance <= FAR * reach[piece], piece, -1), n_pieces)):
            if len(bark) < LEAST_POINTS:
                continue
            chord = line[at[bark].max()] - line[at[bark].min()]
            fitted = _fitted(xyz[own[bark]], chord, float(reach[k]))
            if fitted is not None:
                reach[k], round_pieces[k] = fitted, True
        may_be = _are_no_thinner(reach, round_pieces & (reach >= voxel_size / 2))
        radius, is_round, states = _radii(reach, may_be, ahead, wood[one.slices[0]])
        wood[one.slices[1:]] = states[(along[1:] / _PIECE).astype(np.int64)]
        row = {
            "id": number,
            "tree": one.tree + 1,
            "branch_order": one.order,
            "dbh": 2 * radii[stem] if one.order == 0 else float("nan"),
            "length": length,
            "radius": float(np.median(radius)),
            "measured": float(is_round.mean()),
            "volume": float((np.pi * radius**2 * np.diff(ends)).sum()),
        }
        for name, value in row.items():
            columns[name].append(value)
        lines.append(line)
    columns["points"] = np.bincount(label, minlength=len(branches) + 1)[1:].tolist()
    return label, LayerFeatures(lines, columns)


def _fitted(xyz: np.ndarray, chord: np.ndarray, reach: float) -> Optional[float]:
    """Return the radius (m) of a cylinder through points (k, 3), m, of a piece; None if they lie on none.

    ``reach`` is the median distance (m) of the points from the middle line of the branch, and ``chord`` (3,), m, is
    a vector along it. Where one side of a branch is seen, that line lies on the bark of this side.
    """
    length = float(np.linalg.norm(chord))
    if not length:
        return None
    axis = chord / length
    center = xyz.mean(axis=0)
    across = np.array(axes_across(axis))
    # The circle of least squares of its equation: arcs make it too small, so that it is the start only.
    plan = (xyz - center) @ across.T
    x, y, rest = np.linalg.lstsq(np.column_stack([2 * plan, np.ones(len(plan))]), (plan**2).sum(axis=1), rcond=None)[0]
    cylinder = Cylinder(center + np.array([x, y]) @ across, axis, float(np.sqrt(rest + x * x + y * y)))
    bark = xyz
    for _ in range(3):
        cylinder = fit_cylinder(bark, cylinder)
        off = np.abs(cylinder.local(xyz)[1] - cylinder.radius)
        bark = xyz[off <= FAR * np.median(off)]
    # The line lies in or next to the branch; a thinner cylinder would run through leaves.
    is_round = np.median(off) <= ROUND * cylinder.radius and reach / _SWELLING <= cylinder.radius <= _WIDEST * reach
    return cylinder.radius if is_round else None


def _are_no_thinner(reach: np.ndarray, may_be: np.ndarray) -> np.ndarray:
    """Return the mask of pieces ``may_be`` (p,) with radii (p,), m, that the next ones do not exceed in the median."""
    kept = may_be.copy()
    for i in np.flatnonzero(may_be).tolist():
        ahead = reach[i + 1 : i + 1 + _AHEAD][may_be[i + 1 : i + 1 + _AHEAD]]
        kept[i] = not len(ahead) or np.median(ahead) <= _SWELLING * reach[i]
    return kept


def _radii(
    reach: np.ndarray, may_be: np.ndarray, ahead: np.ndarray, wood: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the radii (p,), m, of the pieces of a branch from its base, which are measured, and the wood (p, 2) there.

    Parameters
    ----------
    reach : ndarray of shape (p,)
        Distances of their points from the line, m.
    may_be : ndarray of shape (p,), bool
        Those that have a circle.
    ahead : ndarray of shape (p,)
        Length of all branches beyond, m.
    wood : ndarray of shape (2,)
        At the base: square of a radius per length beyond, m, and the smallest radius measured, m.
    """
    radius, is_measured, states = np.empty(len(reach)), np.zeros(len(reach), bool), np.empty((len(reach), 2))
    share, thinnest = wood.tolist()
    for i, (distance, length) in enumerate(zip(reach.tolist(), ahead.tolist())):
        estimate = np.sqrt(share * length)
        is_measured[i] = may_be[i] and distance <= min(_WIDEST * estimate, _SWELLING * thinnest)
        radius[i] = distance if is_measured[i] else estimate
        if is_measured[i]:
            share, thinnest = distance**2 / max(length, _PIECE / 2), min(thinnest, distance)
        states[i] = share, thinnest
    return radius, is_measured, states


def _off_line(line: np.ndarray, at: np.ndarray, xyz: np.ndarray) -> np.ndarray:
    """Return the distances (k,), m, of points (k, 3) from the tangents of a line (m, 3) at its vertices ``at`` (k,)."""
    offset = xyz - line[at]
    ahead = np.gradient(line, axis=0)[at] if len(line) > 1 else np.zeros_like(offset)
    ahead /= np.maximum(np.linalg.norm(ahead, axis=1), 1e-12)[:, None]
    return np.linalg.norm(offset - (offset * ahead).sum(axis=1)[:, None] * ahead, axis=1)


def _are_round(distance: np.ndarray, piece: np.ndarray, reach: np.ndarray) -> np.ndarray:
    """Return the mask of pieces (p,) that have points at about one distance (k,), m, ``reach`` (p,), from the line."""
    scatter = _medians(np.abs(distance - reach[piece]), piece, len(reach))
    return (scatter <= ROUND * reach) & (np.bincount(piece, minlength=len(reach)) > 0)


def _medians(values: np.ndarray, group: np.ndarray, n_groups: int) -> np.ndarray:
    """Return the median of the values of each group, for empty groups of all."""
    whole = float(np.median(values)) if len(values) else 0.0
    order = np.lexsort((values, group))
    first = np.searchsorted(group[order], np.arange(n_groups))
    count = np.bincount(group, minlength=n_groups)[:n_groups]
    middle = np.clip(first + count // 2, 0, max(len(order) - 1, 0))
    return np.where(count > 0, values[order][middle] if len(order) else whole, whole)
