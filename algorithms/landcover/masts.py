"""Masts: slender upright objects where the spans of wires end."""

from typing import Optional

import numpy as np

from ..criteria import MAJORITY
from ..geometry.groups import components, run_starts, split_groups
from ..packages import spatial
from ..rules import rules
from .wire_spans import Span


@rules
class _RULES:
    """What a mast is."""

    #: Distance from where spans end within which their mast is looked for, as a share of its height: wires hang from
    #: arms, and end some meters before them where points are few
    arms: float = 0.2
    radius: float = 0.6  #: Radius (m) of poles with their fittings
    spread: float = 0.08  #: Radius of towers, as a share of their height
    above: float = 2.0  #: Height (m) over the highest wire up to which a mast reaches: insulators and the tip
    part: float = 1.5  #: Height (m) of the parts in which points are counted
    #: Shares of the height between which a mast has no arms and a tree has its crown: around it there are fewer points
    #: than in it
    trunk: tuple[float, float] = (0.25, 0.65)


def on_masts(xyz: np.ndarray, height: np.ndarray, is_wire: np.ndarray, spans: list[Span]) -> np.ndarray:
    """Return the rows (k,) of the points of masts.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Points of no class and of wires, m.
    height : ndarray of shape (n,)
        Their heights above the ground, m.
    is_wire : ndarray of shape (n,), bool
        Which are on wires.
    spans : list of Span
        The wires.
    """
    if not spans:
        return np.zeros(0, np.int64)
    ends = np.array([span.at(along) for span in spans for along in (span.start, span.end)])
    wires = np.flatnonzero(is_wire)
    over = height[wires[spatial.cKDTree(xyz[wires, :2]).query(ends[:, :2])[1]]]
    reach = _RULES.arms * over
    pairs = spatial.cKDTree(ends[:, :2]).query_pairs(2 * float(reach.max()), output_type="ndarray")
    near = np.hypot(*(ends[pairs[:, 0], :2] - ends[pairs[:, 1], :2]).T) <= reach[pairs[:, 0]] + reach[pairs[:, 1]]
    count, group = components(pairs[near, 0], pairs[near, 1], len(ends))
    rows = np.flatnonzero(~is_wire)
    tree = spatial.cKDTree(xyz[rows, :2])
    found = [np.zeros(0, np.int64)]
    for members in split_groups(group, count):
        top, middle = float(over[members].max()), ends[members, :2].mean(axis=0)
        around = rows[tree.query_ball_point(middle, 2 * float(reach[members].max()))]
        found.append(around[_mast(xyz[around, :2] - middle, height[around], top, float(reach[members].max()))])
    return np.unique(np.concatenate(found))


def _mast(plan: np.ndarray, height: np.ndarray, top: float, reach: float) -> np.ndarray:
    """Return the mask of points (n,) of a mast with wires ``top`` (m) above the ground, if there is one.

    ``plan`` (n, 2) is from the middle of the ends of its spans, within ``reach`` (m) of which its axis is.
    """
    nothing = np.zeros(len(plan), bool)
    inside = height <= top + _RULES.above
    near = inside & (np.hypot(*plan.T) <= reach)
    if not near.any():
        return nothing
    radius = max(_RULES.radius, _RULES.spread * top)
    axis = _axis(plan[near], height[near], radius, top)
    if axis is None:
        return nothing
    out = np.hypot(*(plan - axis).T)
    in_trunk = (height >= _RULES.trunk[0] * top) & (height <= _RULES.trunk[1] * top) & (out <= 2 * radius)
    part = (height[in_trunk] / _RULES.part).astype(np.int64)
    inner_minus_outer = np.bincount(part, np.where(out[in_trunk] <= radius, 1, -1))
    # A crown next to a mast surrounds some parts of its trunk, a tree's crown most of them.
    if (inner_minus_outer < 0).sum() > MAJORITY * (np.bincount(part) > 0).sum():
        return nothing
    return inside & ((out <= radius) | ((height > _RULES.trunk[1] * top) & (out <= _RULES.arms * top)))


def _axis(plan: np.ndarray, height: np.ndarray, radius: float, top: float) -> Optional[np.ndarray]:
    """Return the position (2,) around which most parts of the height have points; None where too few have."""
    parts = max(round(top / _RULES.part), 2)
    part = np.clip(height / top * parts, 0, parts - 1).astype(np.int64)
    # One point of each half radius and part is enough.
    cell = np.floor(plan / (radius / 2)).astype(np.int64)
    order = np.lexsort((plan[:, 1], plan[:, 0], part, *cell.T))
    key = np.column_stack([cell, part])[order]
    first = order[run_starts(np.unique(key, axis=0, return_inverse=True)[1].ravel())]
    plan, part = plan[first], part[first]
    near = np.hypot(*(plan[:, None] - plan[None]).transpose(2, 0, 1)) <= radius
    filled = np.column_stack([(near & (part == number)).any(axis=1) for number in range(parts)])
    # A tower has many such positions: those with the most points around them count, by their middle.
    best = int((filled.sum(axis=1) + near.mean(axis=1)).argmax())
    shares = [float(half.mean()) for half in np.array_split(filled[best], 2)]
    return plan[near[best]].mean(axis=0) if min(shares) >= MAJORITY else None
