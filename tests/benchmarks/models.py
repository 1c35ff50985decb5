#!/usr/bin/env python3
"""Print how good models of buildings are: ``models.py [table …]``, all by default.

``shapes`` are simulated roofs of twelve kinds, whose ridges, eaves and corners are known; ``real`` the models of
*Model buildings* on real clouds, ``map`` those on the base map of Delft, and ``city3d`` those on buildings of the
City3D data set next to its published models. Each table comes as Markdown for people and as a JSON file for programs
(in ``--output``). Solids are held to the rules of ISO 19107 by the tests.
"""

from __future__ import annotations

import json
import sys
import time
from collections import Counter
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
import numpy as np  # noqa: E402

import conftest  # noqa: E402, F401 - registers the checkout as the package lidar_buildings
from lidar_buildings.algorithms.cloud.files import read_cloud  # noqa: E402
from lidar_buildings.algorithms.models3d.reconstruct_roofs import reconstruct_roofs  # noqa: E402
from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling  # noqa: E402
from lidar_buildings.algorithms.stage import LayerFeatures, MapFrame, StageResults  # noqa: E402
from lidar_buildings.tests.benchmarks.results import Table, print_tables  # noqa: E402
from lidar_buildings.tests.real.clouds import DATA, DELFT, detected  # noqa: E402
from lidar_buildings.tests.roof_shapes import SHAPES, RoofShape, moved  # noqa: E402
from lidar_buildings.tests.solid_validity import assert_valid_solid, shells_of  # noqa: E402

DENSITIES, SEEDS, NOISE = (4, 8, 12, 20, 30), range(6), 0.03
CLOUDS = (DELFT, "buildings/ahn-amsterdam-1", "buildings/amsterdam-centre-10", "buildings/ign-stbarth")
MAP = DATA / "footprints" / "delft-bgt.gpkg"


def shapes() -> list[Table]:
    """Print the largest errors of ridges, eaves and corners (m) of six scans each, each turned by 17° more."""
    kinds = ("ridge, m", "eave, m", "corners, m", "mean of corners, m")
    table = Table("shapes", "roof", "points per m²", "at level 2.2 of 6", "type right of 6", *kinds)
    for name, shape in SHAPES.items():
        for density in DENSITIES:
            found = [_errors(shape, density, seed) for seed in SEEDS]
            level, kind, ridge, eave, corners = (list(column) for column in zip(*found))
            figures = max(ridge), max(eave), max(map(max, corners)), float(np.mean(np.concatenate(corners)))
            table.add(name, density, sum(level), sum(kind), *figures, digits=3)
    return [table]


def _errors(shape: RoofShape, density: float, seed: int) -> tuple[bool, bool, float, float, np.ndarray]:
    """Return whether level and type are right, and how far ridge, eave and each corner are off (m)."""
    points, ring = shape.scanned(density, NOISE, seed, turn=17.0 * seed)
    ground = np.random.default_rng(seed).uniform((-15, -15, 0), (25, 25, 0), (1500, 3))
    classes = np.repeat([6, 2], [len(points), len(ground)]).astype(np.uint8)
    features = LayerFeatures([[ring]], {"id": [1]})
    made = reconstruct_roofs.stage.unpack(reconstruct_roofs(np.concatenate([points, ground]), classes, features))
    facts = {key: values[0] for key, values in made.layers["buildings"].columns.items()}
    roofs = np.concatenate([face_ring for rings in made.layers["roofs"].geometries for face_ring in rings])
    ridge, eave = abs(roofs[:, 2].max() - shape.ridge), abs(roofs[:, 2].min() - shape.eave)
    faces = (*made.layers["roofs"].geometries, *made.layers["walls"].geometries)
    vertices = np.concatenate([face_ring for rings in faces for face_ring in rings])
    true = np.column_stack([moved(shape.corners, 17.0 * seed, (0, 0)), shape.corners[:, 2]])
    corners = np.sqrt(((true[:, None] - vertices[None]) ** 2).sum(axis=2)).min(axis=1)
    return facts["level"] == "2.2", facts["roof_type"] == shape.kind, ridge, eave, corners


def real() -> list[Table]:
    """Print the models on the footprints that the chain finds."""
    table = _table("real_models", "cloud")
    for name in CLOUDS:
        found = detected(name)
        _add(table, name.split("/")[1], found.cloud.get("xyz"), found.classification, found.layers["footprints"])
    return [table]


def on_map() -> list[Table]:
    """Print the models on the base map of Delft."""
    found = detected(DELFT)
    table = _table("models_on_the_map", "map")
    _add(table, "delft-bgt", found.cloud.get("xyz"), found.classification, _outlines(MAP, found.cloud.origin))
    return [table]


def city3d() -> list[Table]:
    """Print the models of City3D's buildings next to the published ones (Huang et al. 2022).

    Ours are heights above and below the model of the points on top; how far points lie from the published models comes
    with the data, which do not tell how it was measured.
    """
    figures = ("without a model", "at level 2.2", "lower rms, %", "median rms, m", "published, m", "faces", "published")
    table = Table("city3d", "set", "buildings", *figures)
    for name in ("city3d-ahn3", "city3d-dales3d"):
        cloud = read_cloud(DATA / "models" / f"{name}.laz")
        published = json.loads((DATA / "models" / f"{name}.published.json").read_text())
        footprints = _outlines(DATA / "models" / f"{name}.gpkg", cloud.origin, "name")
        xyz, classes = cloud.get("xyz"), cloud.get("classification")
        made = reconstruct_roofs.stage.unpack(reconstruct_roofs(xyz, classes, footprints, id_field="name"))
        columns = made.layers["buildings"].columns
        faces = Counter(made.layers["roofs"].columns["building"]) + Counter(made.layers["walls"].columns["building"])
        theirs = [published[building] for building in columns["building"]]
        peer, own = np.array([one["rms"] for one in theirs]), np.array(columns["rms"])
        table.add(
            name,
            len(footprints),
            len(footprints) - len(own),
            columns["level"].count("2.2"),
            100 * float(np.mean(own < peer)),
            float(np.median(own)),
            float(np.median(peer)),
            # The ground is a face of a solid, too.
            float(np.median([faces[building] + 1 for building in columns["building"]])),
            float(np.median([one["faces"] for one in theirs])),
            digits=3,
        )
    return [table]


def _outlines(path: Path, origin: np.ndarray, name: str = "") -> LayerFeatures:
    """Return the polygons of a layer, each part by itself, with their names, or numbers without any."""
    from osgeo import ogr

    polygons, names = [], []
    # The layer is gone with its source.
    source = ogr.Open(str(path))
    for feature in source.GetLayer(0):
        geometry = feature.GetGeometryRef()
        parts = [geometry] if geometry.GetGeometryName() == "POLYGON" else list(geometry)
        polygons += [[np.array(ring.GetPoints())[:, :2] - origin[:2] for ring in part] for part in parts]
        names += [feature.GetField(name) if name else ""] * len(parts)
    return LayerFeatures(polygons, {name: names} if name else {"id": list(range(len(polygons)))})


def _table(name: str, first: str) -> Table:
    levels = [f"at level {level}" for level in ("2.2", "1.3", "1.2")]
    figures = ("median rms, m", "worst tenth from, m", "explained, %", "over 0.5 m off, %")
    figures += ("type other", "solids", "valid", "per minute and core")
    return Table(name, first, "footprints", *levels, "worse than 1.3", *figures)


def _add(table: Table, name: str, xyz: np.ndarray, classes: np.ndarray, footprints: LayerFeatures) -> None:
    """Add the row of a cloud: the models are made once for all levels."""
    sampling = CloudSampling.of(xyz, classes)
    _ = sampling.roughness
    start = time.process_time()
    made = reconstruct_roofs.stage.unpack(reconstruct_roofs(xyz, classes, footprints, sampling=sampling))
    seconds = time.process_time() - start
    columns = made.layers["buildings"].columns
    level = Counter(columns["level"])
    solids, valid = _valid(made)
    rms = np.array(columns["rms"])
    table.add(
        name,
        len(footprints),
        *(level[one] for one in ("2.2", "1.3", "1.2")),
        sum("farther from the points" in reason for reason in columns["reason"]),
        float(np.median(rms)),
        float(np.percentile(rms, 90)),
        100 * float(np.mean(columns["explained"])),
        100 * float(np.average(columns["off"], weights=columns["points"])),
        columns["roof_type"].count("other"),
        solids,
        valid,
        60 * len(rms) / seconds,
        digits=3,
    )


def _valid(made: StageResults) -> tuple[int, int]:
    """Return how many solids there are of all levels, and how many are valid, as CityJSON has them."""
    whole: dict[str, Any] = json.loads("".join(made.files["cityjson"].pieces("CityJSON", MapFrame(np.asarray))))
    places = np.array(whole["vertices"]) * whole["transform"]["scale"]
    shells = [
        shell
        for thing in whole["CityObjects"].values()
        for geometry in thing["geometry"]
        for shell, _ in shells_of(geometry)
    ]
    return len(shells), sum(_is_valid(places, shell) for shell in shells)


def _is_valid(places: np.ndarray, shell: list) -> bool:
    try:
        assert_valid_solid(places, shell)
    except AssertionError:
        return False
    return True


TABLES = {"shapes": shapes, "real": real, "map": on_map, "city3d": city3d}


if __name__ == "__main__":
    print_tables(TABLES, __doc__)
