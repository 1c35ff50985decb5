"""Terrestrial laser scans of an industrial plant with known truth."""

from dataclasses import dataclass

import numpy as np

from ..cloud.asprs import PointClass
from ..geometry.groups import placed
from ..packages import spatial
from ..params import SEED
from ..stage import Field, Layer, LayerFeatures, Monitor, stage, tunable
from ..threads import n_threads
from .plant_layout import Plant, build_plant

# Most candidate points: at 44 bytes each they take 1.8 GB, which fits into the memory of an office computer.
_MAX_POINTS = 4e7

# Candidates drawn per block: about 100 bytes each meanwhile.
_DRAWN = 1_000_000

# Density of the floor, as a share of the density of other surfaces: its area is larger than the area of pipes.
_FLOOR = 0.05

# Distance (m) from the scanner up to which surfaces have the full density.
_FULL_DENSITY = 6.0

# Least angle (°) between beam and surface that returns an echo.
_LEAST_INCIDENCE = 8.0

_AXIS_FIELDS = (
    Field("id", int, "number of the part, as SegmentID of its points"),
    Field("kind", str, "pipe or tank"),
    Field("radius", float, "radius", "m"),
    Field("length", float, "length", "m"),
    Field("points", int, "points on it"),
)

_CENTER_FIELDS = tuple(field for field in _AXIS_FIELDS if field.name not in {"kind", "length"})


@stage(
    "Simulation",
    tags="synthetic,industry,refinery,pipes,tanks,terrestrial,laser scanner,demo,example,test,truth,teaching",
    creates=("xyz", "classification", "segment_id", "shape"),
    layers=(
        Layer("axes", "True axes of pipes and tanks", "LineString", _AXIS_FIELDS),
        Layer("centers", "True centers of spheres", "Point", _CENTER_FIELDS),
    ),
)
def simulate_plant(
    *,
    pipes: int = tunable(200, within="[1, 2000]"),
    tanks: int = tunable(3, within="[0, 20]"),
    spheres: int = tunable(4, within="[0, 50]"),
    clutter: bool = tunable(True, label="Beams, gratings and clutter"),
    density: float = tunable(4000.0, label="Point density", within="[100, 100_000] points/m²"),
    noise: float = tunable(0.002, within="[0, 0.1] m"),
    seed: int = SEED,
    monitor=None,
):
    """Simulate scans of an industrial plant: points with true surfaces, axes of pipes and tanks, centers of spheres.

    Racks of I-beams carry pipes at three levels, some with flanges, some with elbows to a pipe that leads up or down.
    Gratings and heaps are next to the racks, upright tanks in the west, spherical vessels in the east. The scanner has
    stations at the corners of the racks and around the tanks; occluded surfaces have no points.

    Returns
    -------
    xyz : ndarray of shape (n, 3), float64
        Coordinates (m).
    classification : ndarray of shape (n,), uint8
        True class: 2 floor, 1 other objects.
    segment_id : ndarray of shape (n,), int32
        Number of the part: a pipe, an elbow, a plate of a beam; 0 for clutter and gratings.
    shape : ndarray of shape (n,), uint8
        1 plane, 2 cylinder, 3 sphere, 0 other surfaces.
    axes : LayerFeatures
        Axes of pipes and tanks with points.
    centers : LayerFeatures
        Centers of spheres with points.

    Other Parameters
    ----------------
    pipes
        Straight pipes with diameters of 5 to 60 cm, on racks.
    tanks
        Upright tanks with diameters of 5 to 30 m; their sides and roofs are visible.
    spheres
        Spherical vessels with diameters of 1 to 3 m.
    clutter
        Add objects other than pipes: supports, gratings and clutter.
    density
        Density on surfaces up to 6 m from the scanner; it decreases beyond. The floor has a twentieth of it.
    noise
        Standard deviation of measured ranges.

    Raises
    ------
    ValueError
        If there would be more than 40 million candidate points.

    Notes
    -----
    A station records one point per cell of directions, the nearest. The size of the cells follows from the density at
    ``_FULL_DENSITY`` m; farther surfaces have fewer points. Surfaces at less than ``_LEAST_INCIDENCE``° to the beam
    have none. Noise is along the beam. By default, 200 pipes give 3.6 million points in about two minutes. Not
    simulated: points between two surfaces at edges, reflections, registration errors.

    Examples
    --------
    >>> from lidar_buildings.algorithms.simulation.simulate_plant import simulate_plant
    >>> xyz, _, segment_id, shape, axes, _ = simulate_plant(pipes=2, tanks=0, spheres=0, density=500.0)
    >>> len(axes), bool((shape == 2).any())
    (2, True)
    """
    rng = np.random.default_rng([seed, 5])
    plant = build_plant(pipes, tanks, spheres, clutter, rng)
    candidates = _candidates(plant, density, rng, monitor.part(0, 0.2))
    xyz, part = candidates.xyz, candidates.part
    step = 1 / (np.sqrt(density) * _FULL_DENSITY)
    is_seen, origin = np.zeros(len(xyz), bool), np.zeros(len(xyz), np.int32)
    for number, station in enumerate(plant.stations):
        monitor.progress(0.2 + 0.7 * number / len(plant.stations))
        seen = _seen(candidates, station, step)
        origin[seen] = number
        is_seen[seen] = True
    xyz, part, origin = xyz[is_seen], part[is_seen], origin[is_seen]
    kept = _thinned(xyz, part, plant, density)
    xyz, part = xyz[kept], part[kept]
    beam = xyz - np.array(plant.stations)[origin[kept]]
    beam /= np.linalg.norm(beam, axis=1)[:, None]
    xyz = xyz + noise * rng.standard_normal(len(xyz))[:, None] * beam
    return _dimensions(xyz, part, plant)


@dataclass(frozen=True)
class _Candidates:
    """Candidate points on surfaces, of which stations see some."""

    xyz: np.ndarray  #: (n, 3), float64: positions (m)
    normal: np.ndarray  #: (n, 3), float32: outward normals of the surfaces
    part: np.ndarray  #: (n,), int32: indices of the parts
    #: (n,), float32: greatest distance (m) of a station that uses a candidate. It is drawn so that the density of the
    #: candidates of a station decreases with the square of the distance, as the density of its points does.
    reach: np.ndarray


def _candidates(plant: Plant, density: float, rng: np.random.Generator, monitor: Monitor) -> _Candidates:
    """Return candidate points with the density that the nearest station needs."""
    stations = spatial.cKDTree(np.array(plant.stations))
    drawn: list[tuple[np.ndarray, ...]] = []
    total = 0
    for number, part in enumerate(plant.parts):
        monitor.progress(number / len(plant.parts))
        nearest = max(1.0, float(stations.query(part.middle)[0]) - np.sqrt(part.area) / 2)
        falling = min(1.0, (_FULL_DENSITY / nearest) ** 2)
        # With three candidates per point few parts of a surface are left without points; at least 20 candidates, so
        # that no small part is missed by chance.
        count = max(20, round(3.0 * density * falling * part.area * (_FLOOR if part.kind == "floor" else 1.0)))
        for start in range(0, count, _DRAWN):
            positions, normals = part.sample(rng, min(_DRAWN, count - start))
            distance = np.maximum(stations.query(positions, workers=n_threads())[0], _FULL_DENSITY)
            kept = rng.random(len(positions)) * falling < (_FULL_DENSITY / distance) ** 2
            reach = distance[kept] / np.sqrt(1 - rng.random(int(kept.sum())))
            total += len(reach)
            if total > _MAX_POINTS:
                raise ValueError(
                    f"The plant would need more than {_MAX_POINTS / 1e6:g} million candidates for points; lower the "
                    "density or the number of pipes and tanks."
                )
            numbers = np.full(len(reach), number, np.int32)
            drawn.append((positions[kept], normals[kept].astype(np.float32), numbers, reach.astype(np.float32)))
    return _Candidates(*(np.concatenate(column) for column in zip(*drawn)))


def _seen(candidates: _Candidates, station: np.ndarray, step: float) -> np.ndarray:
    """Return the indices of visible candidates: one per cell of directions ``step`` (radians) wide."""
    near, offset = _looked_at(candidates, station)
    distance = np.sqrt(np.einsum("ij,ij->i", offset, offset))
    # Sorted from far to near, so that the nearest one in a cell is stored last.
    order = np.argsort(-distance, kind="stable")
    near, offset, distance = near[order], offset[order], distance[order]
    facing = -np.einsum("ij,ij->i", offset, candidates.normal[near]) / np.maximum(distance, 1e-9)
    # Surfaces that face away also occlude: plates and pipes are closed.
    azimuth = np.arctan2(offset[:, 1], offset[:, 0]) + np.pi
    elevation = np.arcsin(np.clip(offset[:, 2] / distance, -1, 1)) + np.pi / 2
    # Cells closer than about 1° to the zenith or nadir do not become narrower.
    around = azimuth * np.maximum(np.sin(elevation), 0.02)
    is_first = np.ones(len(near), bool)
    # Wide cells leave no gaps between candidates, through which hidden surfaces could be seen.
    for width in (2 * step, step):
        columns = int(2 * np.pi / width) + 2
        cell = (elevation / width).astype(np.int64) * columns + (around / width).astype(np.int64)
        nearest = placed(distance, cell, (int(np.pi / width) + 2) * columns)
        # Points up to two spacings behind the first one in a beam are on the same surface.
        is_first &= distance <= nearest[cell] + 2.0 * width * distance / np.maximum(facing, 0.1)
    lit = np.flatnonzero(is_first & (facing > np.sin(np.radians(_LEAST_INCIDENCE))))
    chosen = placed(near[lit], cell[lit], len(nearest), -1)
    return chosen[chosen >= 0]


def _looked_at(candidates: _Candidates, station: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the indices (k,) of the candidates of a station, and their offsets (k, 3), float32, from it (m)."""
    rows, offsets = [], []
    for start in range(0, len(candidates.xyz), _DRAWN):
        offset = (candidates.xyz[start : start + _DRAWN] - station).astype(np.float32)
        distance = np.sqrt(np.einsum("ij,ij->i", offset, offset))
        reach = candidates.reach[start : start + _DRAWN]
        # The range of the scanner is 45 m.
        near = np.flatnonzero((distance < 45.0) & (np.maximum(distance, _FULL_DENSITY) <= reach))
        rows.append(near + start)
        offsets.append(offset[near])
    return np.concatenate(rows), np.concatenate(offsets)


def _thinned(xyz: np.ndarray, part: np.ndarray, plant: Plant, density: float) -> np.ndarray:
    """Return the indices of points thinned to at most ``density`` on every surface."""
    part = part.astype(np.int64)
    is_floor = np.array([one.kind == "floor" for one in plant.parts])[part]
    side = np.where(is_floor, 1 / np.sqrt(density * _FLOOR), 1 / np.sqrt(density))
    cell = np.floor((xyz - xyz.min(axis=0)) / side[:, None]).astype(np.int64)
    shape = cell.max(axis=0) + 1
    key = ((part * shape[0] + cell[:, 0]) * shape[1] + cell[:, 1]) * shape[2] + cell[:, 2]
    return np.sort(np.unique(key, return_index=True)[1])


def _dimensions(xyz: np.ndarray, part: np.ndarray, plant: Plant) -> tuple:
    """Return the dimensions of the points, and the layers of axes and centers."""
    parts = plant.parts
    kinds = np.array([one.kind for one in parts])
    unnumbered, is_flange = np.isin(kinds, ("clutter", "grating")), kinds == "flange"
    ids = np.where(unnumbered, 0, np.cumsum(~unnumbered)).astype(np.int32)
    # The three surfaces of a flange are one part.
    for number in np.flatnonzero(is_flange[1:] & is_flange[:-1]) + 1:
        ids[number] = ids[number - 1]
    count = np.bincount(part, minlength=len(parts))
    classes = np.where(kinds == "floor", PointClass.GROUND, PointClass.UNCLASSIFIED).astype(np.uint8)
    shape = np.array([one.shape for one in parts], np.uint8)

    def layer(kinds: set[str], position: str, fields: tuple[Field, ...]) -> LayerFeatures:
        seen = [(one, int(ids[n]), int(count[n])) for n, one in enumerate(parts) if one.kind in kinds and count[n]]
        lengths = [float(np.linalg.norm(np.diff(one.axis, axis=0))) for one, *_ in seen]
        rows = [
            {"id": number, "kind": one.kind, "radius": one.radius, "length": length, "points": points}
            for (one, number, points), length in zip(seen, lengths)
        ]
        columns = {field.name: [row[field.name] for row in rows] for field in fields}
        return LayerFeatures([getattr(one, position) for one, *_ in seen], columns)

    layers = layer({"pipe", "tank"}, "axis", _AXIS_FIELDS), layer({"sphere"}, "middle", _CENTER_FIELDS)
    return xyz, classes[part], ids[part], shape[part], *layers
