"""An industrial plant scanned from stations on the ground, of which everything is known."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from ..cloud.asprs import PointClass
from ..geometry.groups import run_starts
from ..params import Seed
from ..stage import Field, Layer, LayerFeatures, Monitor, Param, stage
from .plant_layout import Plant, build_plant
from .plant_parts import Part

# So many points (about 150 bytes each while they are made) still fit into the memory of an office computer.
_MAX_POINTS = 2e7

# Candidates for a point: by three on average, few places of a surface are left without one.
_CANDIDATES = 3.0

# The floor is thinned to this share of the density of everything else: there is more of it than of pipes.
_FLOOR = 0.05

# Range of the scanner (m), distance at which its points have the asked density, and least angle (°) of incidence to
# the surface.
_RANGE, _FULL_DENSITY, _LEAST_INCIDENCE = 45.0, 6.0, 8.0

# Surfaces at most this far (spacings) behind the first one in a beam are the same one.
_SAME = 2.0

_AXIS_FIELDS = (
    Field("id", int, "number of the part, as SegmentID of its points"),
    Field("kind", str, "pipe or tank"),
    Field("radius", float, "radius", "m"),
    Field("length", float, "length", "m"),
    Field("points", int, "points on it"),
)

_CENTER_FIELDS = (
    Field("id", int, "number of the part, as SegmentID of its points"),
    Field("radius", float, "radius", "m"),
    Field("points", int, "points on it"),
)


@stage(
    "Simulate plant",
    group="Simulation",
    tags="synthetic,industry,refinery,pipes,tanks,terrestrial,laser scanner,demo,example,test,truth,teaching",
    creates=("xyz", "classification", "segment_id", "shape"),
    layers=(
        Layer("axes", "True axes of pipes and tanks", "LineString", _AXIS_FIELDS),
        Layer("centers", "True centers of spheres", "Point", _CENTER_FIELDS),
    ),
)
def simulate_plant(
    *,
    pipes: Annotated[
        int, Param("Pipes", "Straight pipes with diameters of 5 to 60 cm, on racks.", low=1, high=2000)
    ] = 200,
    tanks: Annotated[
        int,
        Param(
            "Tanks",
            "Upright tanks with diameters from 5 to 30 m, of which the sides and the roof are seen.",
            low=0,
            high=20,
        ),
    ] = 3,
    spheres: Annotated[int, Param("Spheres", "Spherical vessels with diameters of 1 to 3 m.", low=0, high=50)] = 4,
    clutter: Annotated[
        bool, Param("Beams, gratings and clutter", "What carries the pipes, stands beside them and is no pipe.")
    ] = True,
    density: Annotated[
        float,
        Param(
            "Point density",
            "Most points on a surface: it has them up to 6 m from the scanner. The floor has a twentieth.",
            unit="points/m²",
            low=100,
            high=100_000,
        ),
    ] = 8000.0,
    noise: Annotated[
        float, Param("Noise", "Standard deviation of the distance of a point.", unit="m", low=0, high=0.1)
    ] = 0.002,
    seed: Seed = 1,
    monitor=None,
):
    """Scan a made-up industrial plant: points with their true surface, the axes of pipes and tanks, centers of spheres.

    Racks carry pipes at three levels, some with flanges, some with elbows to a pipe that leads up or down; I-beams
    carry the racks, gratings and heaps lie beside them. Upright tanks stand in the west, spherical vessels in the east.
    The scanner stands at the corners of the racks and around tanks, and sees what nothing hides.

    Returns
    -------
    xyz : ndarray of shape (n, 3), float64
        Coordinates (m).
    classification : ndarray of shape (n,), uint8
        2 floor, 1 everything else.
    segment_id : ndarray of shape (n,), int32
        Number of the part: a pipe, an elbow, a plate of a beam; 0 for clutter and gratings.
    shape : ndarray of shape (n,), uint8
        1 plane, 2 cylinder, 3 sphere, 0 everything else.
    axes : LayerFeatures
        Axes of pipes and tanks that have points.
    centers : LayerFeatures
        Centers of spheres.

    Raises
    ------
    ValueError
        If there would be more than 20 million candidates for a point.

    Notes
    -----
    A station sees one point of each cell of directions, the nearest. The cells are as large as asks the density at 6 m;
    farther surfaces have fewer points. Surfaces that are met at less than 8° give none. Noise lies along the beam.
    Not simulated: points between two surfaces at edges, reflections, errors of the registration.

    Examples
    --------
    >>> from lidar_buildings.algorithms.simulation.simulate_plant import simulate_plant
    >>> xyz, _, segment_id, shape, axes, _ = simulate_plant(pipes=2, tanks=0, spheres=0, density=500.0)
    >>> len(axes), bool((shape == 2).any())
    (2, True)
    """
    monitor = monitor or Monitor()
    rng = np.random.default_rng([seed, 5])
    plant = build_plant(pipes, tanks, spheres, clutter, rng)
    xyz, normal, part = _candidates(plant, density, rng)
    monitor.progress(0.1)
    step = 1 / (np.sqrt(density) * _FULL_DENSITY)
    is_seen, origin = np.zeros(len(xyz), bool), np.zeros((len(xyz), 3))
    for number, station in enumerate(plant.stations):
        seen = _seen(xyz, normal, station, step)
        origin[seen] = station
        is_seen[seen] = True
        monitor.progress(0.1 + 0.8 * (number + 1) / len(plant.stations))
    xyz, part, origin = xyz[is_seen], part[is_seen], origin[is_seen]
    kept = _thinned(xyz, part, plant, density)
    xyz, part, origin = xyz[kept], part[kept], origin[kept]
    beam = xyz - origin
    beam /= np.linalg.norm(beam, axis=1)[:, None]
    xyz = xyz + noise * rng.standard_normal(len(xyz))[:, None] * beam
    monitor.progress(1.0)
    return _dimensions(xyz, part, plant)


def _candidates(plant: Plant, density: float, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return places (n, 3), normals (n, 3) and numbers (n,) of the parts of points that may be seen."""
    stations = np.array(plant.stations)
    counts = []
    for part in plant.parts:
        distance = max(1.0, float(np.linalg.norm(stations - part.middle, axis=1).min()) - np.sqrt(part.area) / 2)
        falling = min(1.0, (_FULL_DENSITY / distance) ** 2) * (_FLOOR if part.kind == "floor" else 1.0)
        counts.append(max(20, round(_CANDIDATES * density * falling * part.area)))
    if sum(counts) > _MAX_POINTS:
        raise ValueError(
            f"The plant would need {sum(counts) / 1e6:.0f} million candidates for points, more than "
            f"{_MAX_POINTS / 1e6:.0f} million; lower the density or the number of pipes and tanks."
        )
    drawn = [part.sample(rng, count) for part, count in zip(plant.parts, counts)]
    number = np.repeat(np.arange(len(drawn)), [len(places) for places, _ in drawn])
    return np.concatenate([places for places, _ in drawn]), np.concatenate([normals for _, normals in drawn]), number


def _seen(xyz: np.ndarray, normal: np.ndarray, station: np.ndarray, step: float) -> np.ndarray:
    """Return the points that a scanner sees from a station, one for each cell of directions ``step`` (radians) wide."""
    offset = xyz - station
    distance = np.linalg.norm(offset, axis=1)
    facing = -np.einsum("ij,ij->i", offset, normal) / np.maximum(distance, 1e-9)
    near = np.flatnonzero(distance < _RANGE)
    offset, distance, facing = offset[near], distance[near], facing[near]
    # What faces away hides what lies behind it, too: plates and pipes are closed.
    azimuth = np.arctan2(offset[:, 1], offset[:, 0]) + np.pi
    elevation = np.arcsin(np.clip(offset[:, 2] / distance, -1, 1)) + np.pi / 2
    columns = int(np.ceil(2 * np.pi / step)) + 1
    is_first = np.ones(len(near), bool)
    # Cells wider than the gaps between candidates hide what lies behind a surface.
    for width in (2 * step, step):
        cell = (elevation / width).astype(np.int64) * columns + (
            azimuth * np.maximum(np.sin(elevation), 0.02) / width
        ).astype(np.int64)
        order = np.argsort(cell)
        starts = run_starts(cell[order])
        which = np.empty(len(cell), np.int64)
        which[order] = np.repeat(np.arange(len(starts)), np.diff(starts, append=len(cell)))
        nearest = np.minimum.reduceat(distance[order], starts)
        is_first &= distance <= nearest[which] + _SAME * width * distance / np.maximum(facing, 0.1)
    lit = np.flatnonzero(is_first & (facing > np.sin(np.radians(_LEAST_INCIDENCE))))
    return near[lit[np.unique(which[lit], return_index=True)[1]]]


def _thinned(xyz: np.ndarray, part: np.ndarray, plant: Plant, density: float) -> np.ndarray:
    """Return which points (n,) to keep so that no surface is denser than asked."""
    is_floor = np.array([one.kind == "floor" for one in plant.parts])[part]
    side = np.where(is_floor, 1 / np.sqrt(density * _FLOOR), 1 / np.sqrt(density))
    cell = np.floor((xyz - xyz.min(axis=0)) / side[:, None]).astype(np.int64)
    shape = cell.max(axis=0) + 1
    key = ((part * shape[0] + cell[:, 0]) * shape[1] + cell[:, 1]) * shape[2] + cell[:, 2]
    return np.sort(np.unique(key, return_index=True)[1])


def _dimensions(xyz: np.ndarray, part: np.ndarray, plant: Plant) -> tuple:
    """Return the dimensions of the points, and the layers of axes and centers."""
    parts = plant.parts
    unnumbered = np.array([one.kind in {"clutter", "grating"} for one in parts])
    flange = np.array([one.kind == "flange" for one in parts])
    ids = np.where(unnumbered, 0, np.cumsum(~unnumbered)).astype(np.int32)
    # The three surfaces of a flange are one part.
    for number in np.flatnonzero(flange[1:] & flange[:-1]) + 1:
        ids[number] = ids[number - 1]
    count = np.bincount(part, minlength=len(parts))
    classes = np.where(np.array([one.kind == "floor" for one in parts]), PointClass.GROUND, PointClass.UNCLASSIFIED)
    shape = np.array([one.shape for one in parts], np.uint8)
    axes = [n for n, one in enumerate(parts) if one.kind in {"pipe", "tank"} and count[n]]
    centers = [n for n, one in enumerate(parts) if one.kind == "sphere" and count[n]]
    return (
        xyz,
        classes.astype(np.uint8)[part],
        ids[part],
        shape[part],
        LayerFeatures([parts[n].axis for n in axes], _columns(parts, ids, count, axes, _AXIS_FIELDS)),
        LayerFeatures([parts[n].middle for n in centers], _columns(parts, ids, count, centers, _CENTER_FIELDS)),
    )


def _columns(
    parts: list[Part], ids: np.ndarray, count: np.ndarray, chosen: list[int], fields: tuple[Field, ...]
) -> dict[str, list]:
    """Return the columns of a layer of the parts ``chosen``."""
    columns: dict[str, list] = {
        "id": [int(ids[n]) for n in chosen],
        "kind": [parts[n].kind for n in chosen],
        "radius": [parts[n].radius for n in chosen],
        "length": [float(np.linalg.norm(np.diff(parts[n].axis, axis=0))) for n in chosen],
        "points": [int(count[n]) for n in chosen],
    }
    return {field.name: columns[field.name] for field in fields}
