"""False and true pits in simulated towns: groups of multipath points under the ground, and shafts, stairs, excavations.

A detour of the beam makes the range too long: the point lies on under the surface along its beam, and other pulses
next to it see the surface. A true pit shows its floor to every pulse that enters it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stages import STAGES

# Depths (m), radii in plan (m) and points of the groups.
DEPTHS, RADII, POINTS = (0.5, 6.0), (0.2, 1.0), (3, 20)

# Plan (m) and depth (m) of the true pits, and whether their floor descends from the surface along the first side.
SHAFT, STAIRS, EXCAVATION = (2.0, 1.0, 2.0, False), (5.0, 1.4, 2.5, True), (9.0, 6.0, 2.0, False)

# Pits and groups keep so far apart (m), so that each can be judged by itself.
APART = 8.0


@dataclass(frozen=True)
class Scene:
    """A cloud whose pits are known, by arrays (n,) for its points.

    ``group`` is the group of multipath points of each, from 1, ``pit`` the true pit whose floor it is on, from 1; 0 for
    none. ``is_ground`` says which are ground, the floors of pits among them.
    """

    cloud: object
    group: np.ndarray
    pit: np.ndarray
    is_ground: np.ndarray


def scene(density=8.0, slope=3.0, groups=40, pits=(SHAFT, STAIRS, EXCAVATION) * 3, seed=1, size=150.0, **town):
    """Return a town with groups of multipath points, half of them next to walls, and with true pits."""
    rng = np.random.default_rng([seed, 7])
    cloud = run_stage(
        STAGES["simulate_town"], size=size, density=density, slope=slope, noise_points=0.0, seed=seed, **town
    ).cloud
    xyz, truth = cloud.get("xyz").copy(), cloud.get("classification")
    ground = np.flatnonzero(truth == PointClass.GROUND)
    pit = np.zeros(len(xyz), int)
    places = _places(xyz, truth, len(pits), groups, rng)
    for number, (kind, place) in enumerate(zip(pits, places[: len(pits)]), start=1):
        _dig(xyz, ground, pit, number, kind, place)
    row, moved = [np.arange(len(xyz))], [xyz]
    group = [np.zeros(len(xyz), int)]
    for number, place in enumerate(places[len(pits) :], start=1):
        source, points = _group(xyz, ground, place, rng)
        row.append(source)
        moved.append(points)
        group.append(np.full(len(source), number))
    whole = cloud.take(np.concatenate(row))
    whole.set("xyz", np.concatenate(moved))
    whole.set("classification", np.ones(len(whole), np.uint8))
    row, group = np.concatenate(row), np.concatenate(group)
    # Half of the pulses that went astray have no other echo.
    gone = rng.permutation(np.unique(row[group > 0]))[::2]
    stays = np.flatnonzero((group > 0) | ~np.isin(row, gone))
    is_ground = (truth[row] == PointClass.GROUND) & (group == 0)
    return Scene(whole.take(stays), group[stays], pit[row][stays] * (group[stays] == 0), is_ground[stays])


def _places(xyz, truth, n_pits, n_groups, rng):
    """Return places (m, 2) on the ground: of pits on open ground, then of groups, every other one next to a wall."""
    ground = xyz[truth == PointClass.GROUND]
    to_building = cKDTree(xyz[truth == PointClass.BUILDING, :2]).query(ground[:, :2])[0]
    to_other = cKDTree(xyz[~np.isin(truth, (PointClass.GROUND, PointClass.BUILDING)), :2]).query(ground[:, :2])[0]
    edge = 12.0
    low, high = xyz[:, :2].min(axis=0) + edge, xyz[:, :2].max(axis=0) - edge
    inside = ((ground[:, :2] > low) & (ground[:, :2] < high)).all(axis=1)
    is_open, is_beside = inside & (to_building > 6) & (to_other > 6), inside & (to_building < 1.5)
    chosen = np.empty((0, 2))
    for number in range(n_pits + n_groups):
        candidates = ground[is_beside if number >= n_pits and number % 2 else is_open, :2]
        if len(chosen):
            candidates = candidates[cKDTree(chosen).query(candidates)[0] > APART]
        if not len(candidates):
            break
        chosen = np.vstack([chosen, candidates[rng.integers(len(candidates))]])
    return chosen


def _dig(xyz, ground, pit, number, kind, place):
    """Lower the ground in a rectangle around a place."""
    length, width, depth, descends = kind
    off = xyz[ground, :2] - place
    inside = (np.abs(off) <= [length / 2, width / 2]).all(axis=1)
    share = (off[inside, 0] + length / 2) / length if descends else 1.0
    xyz[ground[inside], 2] -= depth * share
    pit[ground[inside]] = number


def _group(xyz, ground, place, rng):
    """Return the rows of the pulses that a group of multipath points comes from, and the points."""
    count, radius, depth = rng.integers(POINTS[0], POINTS[1] + 1), rng.uniform(*RADII), rng.uniform(*DEPTHS)
    # Some mirrors are smooth and some are rough.
    scatter = rng.choice([0.03, 0.3])
    angle, far = rng.uniform(0, 2 * np.pi, count), radius * np.sqrt(rng.random(count))
    plan = place + (far * [np.cos(angle), np.sin(angle)]).T
    source = ground[cKDTree(xyz[ground, :2]).query(plan)[1]]
    below = np.maximum(depth + rng.normal(0, scatter, count), DEPTHS[0])
    return source, np.column_stack([plan, xyz[source, 2] - below])
