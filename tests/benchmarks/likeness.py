"""How alike simulated clouds of matched images are to real ones: roughness over distances, slopes, depths of cells."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lidar_buildings.algorithms.cloud.asprs import PointClass
from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.sampling.closed_surface import seen_through_share
from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling
from lidar_buildings.algorithms.simulation.simulate_drone_site import simulate_drone_site
from lidar_buildings.tests.real.clouds import WITH_IMAGES, Result, detected, run_on, truth

from .results import Table

# Simulated sites, one about as dense as each of the real clouds.
SITES = {
    "simulated suburb": {"size": 110.0, "density": 24.0},
    "simulated edge of town": {"size": 80.0, "density": 90.0, "seed": 2, "rounding": 0.25, "halls": 0, "trees": 10.0},
}
REAL = dict(zip(("real suburb", "real beach"), WITH_IMAGES))

# Sides of the windows in which roughness is measured, m.
WINDOWS = (0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0)

# Side of a cell of which only the highest point is used, m.
_TOP_CELL = 0.25

# Share of the cells of a window that must hold a point for it to count.
_FULL = 0.7

# Least number of such windows by which a surface has a roughness.
_FEWEST_WINDOWS = 8

# Height above ground (m) from which on points off buildings are plants.
_PLANTS = 2.5

# Height above ground (m) up to which points off buildings are open ground.
_GROUND = 0.3

# Edges of the bins of slopes, degrees.
SLOPES = np.arange(0.0, 91.0, 10.0)

# Differences in height within a cell whose frequency is compared, m.
DEPTHS = (0.5, 1.0, 2.0, 3.0)


def likeness() -> list[Table]:
    """Return tables of roughness (m) and slopes (%) by surface, and of depths of cells (%), for each cloud."""
    rough = Table("likeness", "cloud", "surface", *(f"{window:g} m" for window in WINDOWS), texts=2)
    clouds = dict(_clouds())
    for name, (xyz, surfaces) in clouds.items():
        for surface, chosen in surfaces.items():
            rough.add(name, surface, *(_known(median_roughness(xyz[chosen], window)) for window in WINDOWS), digits=3)
    bins = [f"{low:.0f} to {high:.0f}°" for low, high in zip(SLOPES, SLOPES[1:])]
    slopes = Table("likeness_slopes", "cloud", "surface", *bins, texts=2)
    for name, (xyz, surfaces) in clouds.items():
        for surface in ("roofs", "plants"):
            slopes.add(name, surface, *slope_shares(xyz[surfaces[surface]]).tolist())
    deep = [f"deeper than {depth:g} m" for depth in DEPTHS]
    depths = Table("likeness_depths", "cloud", "points per m²", "noise, cm", *deep, "seen through", "empty", texts=1)
    for name, (xyz, _) in clouds.items():
        sampling = CloudSampling(lambda points=xyz: points, single_returns=True)
        through = 100 * seen_through_share(xyz, sampling.spacing)
        depths.add(name, sampling.density, 100 * sampling.noise, *deep_shares(xyz), through, empty_share(xyz))
    return [rough, slopes, depths]


def _clouds() -> Iterator[tuple[str, tuple[np.ndarray, dict[str, np.ndarray]]]]:
    """Yield the name of each cloud with its points and the points of each surface, found by the same rule in all."""
    for name, path in REAL.items():
        yield name, _parted(detected(path), truth(path))
    for name, tunables in SITES.items():
        made = dict(zip(simulate_drone_site.stage.creates, simulate_drone_site(**tunables)))
        true = made.pop("classification")
        del made["segment_id"]
        yield name, _parted(run_on(create_cloud(made)), true)


def _parted(result: Result, true: np.ndarray) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Return the points (n, 3) of a cloud, and which of them (n,) are of each surface."""
    height, is_building = result.cloud.get("height_above_ground"), true == PointClass.BUILDING
    surfaces = {
        "roofs": is_building,
        "plants": ~is_building & (height > _PLANTS),
        "open ground": ~is_building & (height < _GROUND),
    }
    return result.cloud.get("xyz"), surfaces


def median_roughness(xyz: np.ndarray, window: float) -> float:
    """Return the median over windows (m) of the deviation (m) of the highest points from the plane of best fit.

    NaN where fewer than eight windows are full.
    """
    top = _highest(xyz) - xyz.mean(axis=0)
    _, which, count = np.unique(np.floor(top[:, :2] / window), axis=0, return_inverse=True, return_counts=True)
    mean = np.column_stack([np.bincount(which, top[:, i]) / count for i in range(3)])
    off = top - mean[which]
    covariance = np.empty((len(count), 3, 3))
    for i in range(3):
        for j in range(3):
            covariance[:, i, j] = np.bincount(which, off[:, i] * off[:, j]) / count
    deviation = np.sqrt(np.maximum(np.linalg.eigvalsh(covariance)[:, 0], 0.0))
    full = count >= max(4, _FULL * (window / _TOP_CELL) ** 2)
    return float(np.median(deviation[full])) if full.sum() >= _FEWEST_WINDOWS else float("nan")


def slope_shares(xyz: np.ndarray) -> np.ndarray:
    """Return the share (%) of windows of a meter in each bin of the slope of their planes."""
    top = _highest(xyz) - xyz.mean(axis=0)
    _, which, count = np.unique(np.floor(top[:, :2]), axis=0, return_inverse=True, return_counts=True)
    slopes = []
    order = np.argsort(which, kind="stable")
    for rows in np.split(order, np.cumsum(count)[:-1]):
        if len(rows) >= _FULL / _TOP_CELL**2:
            off = top[rows] - top[rows].mean(axis=0)
            normal = np.linalg.svd(off, full_matrices=False)[2][2]
            slopes.append(np.degrees(np.arccos(min(1.0, abs(normal[2])))))
    share = np.histogram(slopes, SLOPES)[0]
    return 100 * share / max(share.sum(), 1)


def deep_shares(xyz: np.ndarray) -> list[float]:
    """Return the share (%) of cells of half a meter whose points lie farther apart in height than some depths."""
    _, cell = np.unique(np.floor(xyz[:, :2] / 0.5), axis=0, return_inverse=True)
    high, low = np.full(cell.max() + 1, -np.inf), np.full(cell.max() + 1, np.inf)
    np.maximum.at(high, cell, xyz[:, 2])
    np.minimum.at(low, cell, xyz[:, 2])
    return [100 * float(np.mean(high - low > depth)) for depth in DEPTHS]


def empty_share(xyz: np.ndarray) -> float:
    """Return the share (%) of cells of a meter without a point among those with three or four filled neighbors."""
    column, row = np.floor(xyz[:, :2] - xyz[:, :2].min(axis=0)).astype(np.int64).T + 1
    filled = np.zeros((row.max() + 2, column.max() + 2), bool)
    filled[row, column] = True
    around = sum(np.roll(filled, step, axis).astype(int) for step in (-1, 1) for axis in (0, 1)) >= 3
    return 100 * float((around & ~filled).sum() / around.sum())


def _highest(xyz: np.ndarray) -> np.ndarray:
    """Return the highest point of each cell."""
    cell = np.floor(xyz[:, :2] / _TOP_CELL).astype(np.int64)
    order = np.lexsort((xyz[:, 2], *cell.T))
    return xyz[order[np.append((np.diff(cell[order], axis=0) != 0).any(axis=1), True)]]


def _known(value: float) -> float | None:
    return None if np.isnan(value) else value
