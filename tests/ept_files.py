"""Entwine point tiles written by code that shares nothing with the readers under test, but for laspy in LAZ nodes."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import zstandard

from lidar_buildings.algorithms.cloud.laspy_library import need_laspy

SCALE = 0.01
LEVELS = 4
SCHEMA = (
    ("X", "i4"), ("Y", "i4"), ("Z", "i4"), ("Intensity", "u2"), ("ReturnNumber", "u1"), ("NumberOfReturns", "u1"),
    ("Classification", "u1"), ("GpsTime", "f8"), ("Beam", "f4"),
)  # fmt: skip
_KINDS = {"i": "signed", "u": "unsigned", "f": "floating"}


def made_points(n: int, corner: np.ndarray, side: float, seed: int = 1) -> np.ndarray:
    """Return ``n`` points of the schema in a square, in steps of the scale from its corner."""
    rng = np.random.default_rng(seed)
    points = np.zeros(n, [(name, f"<{kind}") for name, kind in SCHEMA])
    for axis, reach in zip("XYZ", (side, side, 30.0)):
        points[axis] = rng.integers(0, reach / SCALE, n)
    points["Intensity"], points["GpsTime"] = rng.integers(0, 60_000, n), np.arange(n) * 1e-3
    points["ReturnNumber"] = points["NumberOfReturns"] = 1
    points["Classification"], points["Beam"] = rng.integers(1, 7, n), rng.random(n)
    return points


def write_ept(folder: Path, stored: np.ndarray, corner: np.ndarray, side: float, kind: str, **others) -> Path:
    """Write points to a folder; every node of the first level has a page of its own in the hierarchy."""
    points = stored
    for name in ("ept-data", "ept-hierarchy"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    offset = [*map(float, corner), 0.0]
    levels = np.minimum(np.random.default_rng(2).geometric(0.3, len(points)) - 1, LEVELS - 1)
    cells = np.array([points[axis] * SCALE / side for axis in "XYZ"]).T
    keys = np.column_stack([levels, (cells * 2.0 ** levels[:, None]).astype(int)])
    pages = {"0-0-0-0": {}}
    for key in np.unique(keys, axis=0).tolist():
        own, name = points[(keys == key).all(axis=1)], "-".join(map(str, key))
        top = "-".join(map(str, [1, *(one >> key[0] - 1 for one in key[1:])])) if key[0] else "0-0-0-0"
        pages.setdefault(top, {})[name] = len(own)
        if key[0]:
            pages["0-0-0-0"][top] = -1
        _write_node(folder / "ept-data" / name, own, offset, kind)
    for name, page in pages.items():
        (folder / "ept-hierarchy" / f"{name}.json").write_text(json.dumps(page))
    schema = [
        {"name": name, "type": _KINDS[code[0]], "size": int(code[1]), **_grid(name, offset)} for name, code in SCHEMA
    ]
    about = {
        "bounds": [*offset, *(one + side for one in offset)], "dataType": kind, "hierarchyType": "json",
        "boundsConforming": [*offset, offset[0] + side, offset[1] + side, 30.0], "points": len(points),
        "schema": schema, "span": 128, "srs": {"authority": "EPSG", "horizontal": "32631"}, "version": "1.0.0",
    }  # fmt: skip
    (folder / "ept.json").write_text(json.dumps({**about, **others}))
    return folder / "ept.json"


def _grid(name: str, offset: list) -> dict:
    return {"scale": SCALE, "offset": offset["XYZ".index(name)]} if name in ("X", "Y", "Z") else {}


def _write_node(path: Path, points: np.ndarray, offset: list, kind: str) -> None:
    if kind == "zstandard":
        path.with_suffix(".zst").write_bytes(zstandard.compress(points.tobytes()))
        return
    if kind != "laszip":
        path.with_suffix(".bin").write_bytes(points.tobytes())
        return
    laspy = need_laspy()
    las = laspy.create(point_format=6, file_version="1.4")
    las.header.scales, las.header.offsets = [SCALE] * 3, offset
    las.add_extra_dim(laspy.ExtraBytesParams("Beam", "f4"))
    las.X, las.Y, las.Z, las.intensity = points["X"], points["Y"], points["Z"], points["Intensity"]
    las.return_number, las.number_of_returns = points["ReturnNumber"], points["NumberOfReturns"]
    las.classification, las.gps_time = points["Classification"], points["GpsTime"]
    las["Beam"] = points["Beam"]
    las.write(path.with_suffix(".laz"))
