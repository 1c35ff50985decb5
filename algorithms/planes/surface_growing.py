"""Surface growing: seed surfaces where local planes are smooth, and growth from these."""

import itertools
from functools import partial
from typing import Callable, Optional

import numpy as np

from ..geometry.groups import DisjointSets, components, mask_of
from ..stage import Monitor
from ..threads import NEIGHBORS_AT_ONCE, ROWS_AT_ONCE, in_chunks
from .best_pairs import common_deviation, merge_best_pairs
from .least_squares_planes import Planes, planes_of
from .local_planes import LEAST_POINTS, Criteria, LocalPlanes, fit_planes, store_planes

# Connect seeds by this many neighbors first: most of the others then belong to the same surface already.
_FIRST_NEIGHBORS = 3

# Whether the surfaces at some points (m,) hold other points (m,), by their numbers.
Hold = Callable[[np.ndarray, np.ndarray], np.ndarray]


def grow_surfaces(planes: LocalPlanes, is_seed: np.ndarray, criteria: Criteria, monitor: Monitor) -> np.ndarray:
    """Grow smooth surfaces from the seeds.

    Parameters
    ----------
    planes : LocalPlanes
        The points; those that join a surface get the plane of its points around them.
    is_seed : ndarray of shape (n,), bool
        Points whose neighborhood is a seed surface.
    criteria : Criteria
        Criteria by which a point belongs to the surface next to it.
    monitor : Monitor
        Receives progress.

    Returns
    -------
    ndarray of shape (n,), int32
        Surface of each point from 0; -1 if unassigned.

    Notes
    -----
    Seeds whose planes agree are one surface; a surface that is grown from one of them reaches the others. Then all
    surfaces take the points next to them in rounds; a point that several could take joins the one of the nearest point.
    Surfaces that meet there and agree are one.
    """
    surface = connected_seeds(planes, is_seed, criteria, monitor.part(0, 0.6))
    unassigned = np.flatnonzero(surface < 0).astype(np.int32)
    for step in itertools.count():
        part = monitor.part(1 - 0.4 * 0.8**step, 1 - 0.4 * 0.8 ** (step + 1))
        parent = _holding(planes, unassigned, surface, partial(planes.hold, criteria), part)
        joins = parent >= 0
        rows, parent = unassigned[joins], parent[joins]
        if not len(rows):
            break
        surface[rows] = surface[parent]
        _refit(planes, rows, parent, surface)
        unassigned = _beside(planes, unassigned[~joins], rows)
    return _met(planes, surface, np.flatnonzero((surface >= 0) & ~is_seed), criteria)


def _beside(planes: LocalPlanes, rows: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Return the points among ``rows`` (m,) that have one of the ``others`` among their neighbors."""
    is_other, is_beside = mask_of(len(planes.xyz), others), np.empty(len(rows), bool)

    def work(some: np.ndarray) -> None:
        is_beside[some] = is_other[planes.neighbors[rows[some]]].any(axis=1)

    in_chunks(work, np.arange(len(rows)), ROWS_AT_ONCE, Monitor())
    return rows[is_beside]


def _met(planes: LocalPlanes, surface: np.ndarray, rows: np.ndarray, criteria: Criteria) -> np.ndarray:
    """Return the surfaces with those joined that meet at the points ``rows`` and go on into one another."""
    one, other = _adjacent(planes, surface, rows, partial(planes.agree, criteria))
    joined = components(one, other, int(surface.max(initial=-1)) + 1)[1]
    return np.append(joined, np.int32(-1))[surface].astype(np.int32)


def _adjacent(
    planes: LocalPlanes, surface: np.ndarray, rows: np.ndarray, agree: Optional[Hold] = None
) -> tuple[np.ndarray, np.ndarray]:
    """Return pairs of surfaces (k,), each once, between which points ``rows`` have a neighbor that they ``agree`` with.

    All points agree where it is None.
    """
    keys = [np.empty(0, np.int64)]

    def work(some: np.ndarray) -> None:
        around, own = planes.neighbors[some], surface[some]
        a, column = np.nonzero((own[:, None] >= 0) & (surface[around] >= 0) & (surface[around] != own[:, None]))
        one, other = some[a], around[a, column]
        if agree is not None:
            agreed = agree(one, other)
            one, other = one[agreed], other[agreed]
        low, high = np.sort([surface[one], surface[other]], axis=0).astype(np.int64)
        keys.append(np.unique(low << 32 | high))

    in_chunks(work, rows, ROWS_AT_ONCE, Monitor())
    return np.divmod(np.unique(np.concatenate(keys)), 2**32)


def connected_seeds(planes: LocalPlanes, is_seed: np.ndarray, criteria: Criteria, monitor: Monitor) -> np.ndarray:
    """Return the surface (n,), int32, of each seed from 0, -1 of other points.

    Parameters
    ----------
    planes : LocalPlanes
        Planes around the points.
    is_seed : ndarray of shape (n,), bool
        Points that may start a surface.
    criteria : Criteria
        When points are of one surface.
    monitor : Monitor
        Receives the progress.
    """
    sets = DisjointSets(len(is_seed))

    def work(rows: np.ndarray) -> None:
        for columns in (slice(_FIRST_NEIGHBORS), slice(_FIRST_NEIGHBORS, None)):
            neighbors = planes.neighbors[rows, columns]
            a, column = np.nonzero(is_seed[neighbors])
            one, other = rows[a], neighbors[a, column]
            # Test only pairs of seeds that are not yet in one surface.
            apart = sets.apart(one, other)
            one, other = one[apart], other[apart]
            held = planes.agree(criteria, one, other)
            sets.join(one[held], other[held])

    seeds = np.flatnonzero(is_seed).astype(np.int32)
    in_chunks(work, seeds, ROWS_AT_ONCE, monitor)
    first = sets.first(seeds)
    surface = np.full(len(is_seed), -1, np.int32)
    firsts = seeds[first == seeds]
    surface[firsts] = np.arange(len(firsts), dtype=np.int32)
    surface[seeds] = surface[first]
    return surface


def _holding(planes: LocalPlanes, rows: np.ndarray, surface: np.ndarray, hold: Hold, monitor: Monitor) -> np.ndarray:
    """Return the nearest neighbor (m,), int32, of points ``rows`` whose surface holds them, -1 without any."""
    parent = np.full(len(rows), -1, np.int32)

    def work(left: np.ndarray) -> None:
        for column in range(planes.neighbors.shape[1]):
            neighbor = planes.neighbors[rows[left], column]
            tried = np.flatnonzero(surface[neighbor] >= 0)
            held = tried[hold(neighbor[tried], rows[left[tried]])]
            parent[left[held]] = neighbor[held]
            left = np.delete(left, held)

    in_chunks(work, np.arange(len(rows), dtype=np.int32), ROWS_AT_ONCE, monitor)
    return parent


def _refit(planes: LocalPlanes, rows: np.ndarray, parent: np.ndarray, surface: np.ndarray) -> None:
    """Give points that joined a surface the plane of its points around them, or their parent's if these are few."""

    def work(joined: np.ndarray) -> None:
        some, beside = rows[joined], parent[joined]
        planes.offset[some] = planes.offset[beside] + (planes.xyz[beside] - planes.xyz[some]).astype(np.float32)
        planes.normal[some] = planes.normal[beside]
        planes.deviation[some] = planes.deviation[beside]
        around = np.column_stack([some, planes.neighbors[some]])
        same = surface[around] == surface[some, None]
        same[:, 1:] &= around[:, 1:] != some[:, None]
        enough = same.sum(axis=1) >= LEAST_POINTS
        some, around, same = some[enough], around[enough], same[enough]
        offsets = (planes.xyz[around] - planes.xyz[some, None]).astype(np.float32)
        store_planes(planes, some, *fit_planes(offsets, same))

    in_chunks(work, np.arange(len(rows)), max(NEIGHBORS_AT_ONCE // (planes.neighbors.shape[1] + 1), 1), Monitor())


def grow_planes(
    planes: LocalPlanes, is_seed: np.ndarray, criteria: Criteria, most_deviation: float, monitor: Monitor
) -> np.ndarray:
    """Grow planes from the smoothest seeds: the plane equation is fitted to all points of a surface.

    Parameters
    ----------
    planes : LocalPlanes
        The points.
    is_seed : ndarray of shape (n,), bool
        Points whose neighborhood is a seed surface.
    criteria : Criteria
        When a point belongs to the plane next to it.
    most_deviation : float
        Largest root mean square distance of the points of two planes that are one, m.
    monitor : Monitor
        Receives progress.

    Returns
    -------
    ndarray of shape (n,), int32
        Plane of each point from 0; -1 if unassigned.

    Notes
    -----
    One seed in each neighborhood, the smoothest, grows together with all others. Planes that meet are joined in rounds
    of mutually best pairs while the points of both deviate no more from the common plane than the points of a seed.
    """
    best = _smoothest(planes, is_seed)
    surface = np.where(best, np.cumsum(best, dtype=np.int32) - np.int32(1), np.int32(-1))
    if not best.any():
        return surface
    fitted = _first_planes(planes, surface, criteria)
    fitted = _grown(planes, surface, fitted, criteria, monitor.part(0, 0.4))

    def cost(parts: Planes, one: np.ndarray, other: np.ndarray) -> np.ndarray:
        deviation = common_deviation(parts, one, other)
        return np.where(deviation <= most_deviation, deviation, np.inf)

    members = np.flatnonzero(surface >= 0).astype(np.int32)
    fitted, joined = merge_best_pairs(fitted, *_adjacent(planes, surface, members), cost, monitor.part(0.4, 0.8))
    surface = np.where(surface >= 0, joined[surface], -1).astype(np.int32)
    # The refined planes hold more of the points at their edges.
    _grown(planes, surface, fitted, criteria, monitor.part(0.8, 1))
    return surface


def _smoothest(planes: LocalPlanes, is_seed: np.ndarray) -> np.ndarray:
    """Return the mask of seeds (n,) that are the smoothest among their neighbors."""
    seeds = np.flatnonzero(is_seed).astype(np.int32)
    rank = np.full(len(is_seed), len(seeds), np.int32)
    rank[seeds[np.argsort(planes.deviation[seeds], kind="stable")]] = np.arange(len(seeds), dtype=np.int32)
    best = np.zeros(len(is_seed), bool)

    def work(rows: np.ndarray) -> None:
        best[rows] = rank[rows] <= rank[planes.neighbors[rows]].min(axis=1, initial=len(seeds))

    in_chunks(work, seeds, ROWS_AT_ONCE, Monitor())
    return best


def _first_planes(planes: LocalPlanes, surface: np.ndarray, criteria: Criteria) -> Planes:
    """Let seeds take the points of their own planes, and return the planes of their points."""
    _join(planes, np.flatnonzero(surface < 0).astype(np.int32), surface, partial(planes.hold, criteria), Monitor())
    members = np.flatnonzero(surface >= 0).astype(np.int32)
    return planes_of(planes.xyz, surface[members], int(surface.max()) + 1, members)


def _join(planes: LocalPlanes, rows: np.ndarray, surface: np.ndarray, hold: Hold, monitor: Monitor) -> np.ndarray:
    """Let the points ``rows`` (m,) join the surface of the nearest neighbor that holds them; return those that do."""
    parent = _holding(planes, rows, surface, hold, monitor)
    joins = parent >= 0
    surface[rows[joins]] = surface[parent[joins]]
    return rows[joins]


def _grown(planes: LocalPlanes, surface: np.ndarray, fitted: Planes, criteria: Criteria, monitor: Monitor) -> Planes:
    """Let planes take the points next to them in rounds, and return the planes of all points then."""

    def hold(neighbor: np.ndarray, point: np.ndarray) -> np.ndarray:
        # As fitted in the round before, to all points of the surface of each neighbor (m,).
        plane = surface[neighbor]
        return criteria.hold(planes.xyz[point] - fitted.center[plane], fitted.normal[plane], planes.normal[point])

    unassigned = np.flatnonzero(surface < 0).astype(np.int32)
    for step in itertools.count():
        rows = _join(planes, unassigned, surface, hold, monitor.part(1 - 0.8**step, 1 - 0.8 ** (step + 1)))
        if not len(rows):
            break
        fitted = _with_points(fitted, planes.xyz, surface[rows], rows)
        unassigned = unassigned[surface[unassigned] < 0]
    return fitted


def _with_points(fitted: Planes, xyz: np.ndarray, plane: np.ndarray, rows: np.ndarray) -> Planes:
    """Return planes fitted to further points ``rows`` (m,) of ``xyz``, whose plane is the number ``plane`` (m,)."""
    number, which = np.unique(plane, return_inverse=True)
    more = planes_of(xyz, which, len(number), rows)
    both = Planes(
        count=np.concatenate([fitted.count, more.count]),
        center=np.concatenate([fitted.center, more.center]),
        covariance=np.concatenate([fitted.covariance, more.covariance]),
    )
    return both.merged(np.concatenate([np.arange(len(fitted)), number]), len(fitted))
