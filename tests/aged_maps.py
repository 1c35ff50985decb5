"""Old maps made from footprints, with known differences that a comparison must find."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lidar_buildings.algorithms.geometry.rings import signed_area
from lidar_buildings.algorithms.stage import LayerFeatures

# Distance (m) from the old wall to the wall of an annex that was added since.
ANNEX = 4.5

# A vertex that turns by less (°) may be no corner any more on a map with noise.
PLAIN = 35.0


@dataclass(frozen=True)
class AgedMap:
    """A map as it was before: its layer, the counts that a comparison must give, and the displacement of each corner.

    ``layer`` has polygons with ``id``, the footprint's or one of no footprint where the building is gone; ``counts``
    are values of the comparison's report by name. ``corners`` has for every footprint in the map where its corners are
    (k, 2), and how they have moved since (k, 2), m.
    """

    layer: LayerFeatures
    counts: dict[str, int]
    corners: dict[int, tuple[np.ndarray, np.ndarray]]


def with_plain_corners(footprints: LayerFeatures) -> LayerFeatures:
    """Return the exteriors of footprints without flat bends: whether those are corners hangs on the noise of a map."""
    plain = [i for i, rings in enumerate(footprints.geometries) if _flattest(rings[0]) > PLAIN]
    columns = {"id": [footprints.columns["id"][i] for i in plain]}
    return LayerFeatures([footprints.geometries[i][:1] for i in plain], columns)


def _flattest(ring: np.ndarray) -> float:
    """Return the least angle (°) by which a ring turns at a corner."""
    way = np.diff(ring, axis=0)
    way = way / np.hypot(*way.T)[:, None]
    return float(np.rad2deg(np.arccos(np.clip((way * np.roll(way, 1, axis=0)).sum(axis=1), -1, 1))).min())


def aged(
    footprints: LayerFeatures,
    *,
    shift: tuple[float, float],
    noise: float,
    missing: int,
    gone: int,
    annexes: int,
    seed: int = 1,
) -> AgedMap:
    """Return footprints as an old map has them.

    All corners are displaced by a shift (m) and each by noise (standard deviation, m); some buildings are missing, some
    more have gone since, far from all others, and some had a wing less: one of their walls stood 4.5 m farther inside.
    """
    rng = np.random.default_rng(seed)
    rings = [rings[0] for rings in footprints.geometries]
    order = rng.permutation(len(rings))
    kept, large = np.sort(order[missing:]), [i for i in order[missing:] if _widest(rings[i])[1] > 2.2 * ANNEX]
    shortened = set(large[:annexes])
    made, corners, unmatched = [], {}, 0
    for number in kept:
        before = rings[number][:-1].copy()
        is_there = np.ones(len(before), bool)
        if number in shortened:
            is_there[_withdraw(before, _widest(rings[number])[0])] = False
        moved = shift + noise * rng.standard_normal(before.shape)
        made.append(np.concatenate([before + moved, before[:1] + moved[:1]]))
        corners[int(number)] = before[is_there] + moved[is_there], -moved[is_there]
        unmatched += int((~is_there).sum())
    made += _gone(np.concatenate(rings), gone)
    total = sum(len(ring) - 1 for ring in made[: len(kept)])
    names = [*kept.tolist(), *range(len(rings), len(rings) + gone)]
    counts = {"old_buildings": len(made), "all_footprints": len(rings), "found": len(kept)}
    counts.update({"missed": gone, "new": missing, "corners": total, "matched": total - unmatched})
    return AgedMap(LayerFeatures([[ring] for ring in made], {"id": names}), counts, corners)


def _widest(ring: np.ndarray) -> tuple[int, float]:
    """Return the edge whose shorter neighbor is longest, and the length of that neighbor (m)."""
    length = np.hypot(*np.diff(ring, axis=0).T)
    beside = np.minimum(np.roll(length, 1), np.roll(length, -1))
    edge = int(np.argmax(beside))
    return edge, float(beside[edge]) if signed_area(ring) > 0 else 0.0


def _withdraw(corners: np.ndarray, edge: int) -> list[int]:
    """Move both ends of an edge inward along the edges next to it, in place, and return them."""
    n = len(corners)
    for end, toward in ((edge, (edge - 1) % n), ((edge + 1) % n, (edge + 2) % n)):
        way = corners[toward] - corners[end]
        corners[end] += ANNEX * way / np.hypot(*way)
    return [edge, (edge + 1) % n]


def _gone(corners: np.ndarray, count: int) -> list[np.ndarray]:
    """Return squares of 8 m in a row south of everything."""
    west, south = corners.min(axis=0)
    square = np.array([(0, 0), (8, 0), (8, 8), (0, 8), (0, 0)], float)
    return [square + (west + 20 * i, south - 40) for i in range(count)]
