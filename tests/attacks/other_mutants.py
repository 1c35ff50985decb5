"""Damage to what is no point cloud: kept results of blocks, and layers of polygons, lines and points in text."""

from __future__ import annotations

import io
import json
import struct
import zipfile
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Callable

import numpy as np

from lidar_buildings.algorithms.stage import LayerFeatures
from lidar_buildings.algorithms.tiling.block_result import BlockResult

# Names of the damaged result, and of the sound one that it was made of.
RESULT, SOUND = "block.npz", "sound.npz"
# Points of the file that the sound result has some of.
POINTS = 1000
# Bytes that a compressed array declares, far more than a victim may take.
_BOMB = 4_000_000_000


@cache
def sound_result() -> bytes:
    """Return the file of a result with something in each of its fields."""
    rng, n = np.random.default_rng(7), 200
    square = [np.array([[0.0, 0], [9, 0], [9, 9], [0, 9], [0, 0]])]
    edges = np.column_stack([np.zeros(20), np.arange(20), np.arange(20) % 3 + 1]).astype(np.int64)
    result = BlockResult(
        np.zeros(n, np.int32), rng.permutation(POINTS)[:n].astype(np.int64), rng.random(n) < 0.5,
        dimensions={"classification": rng.integers(1, 7, n).astype(np.uint8), "xyz": rng.random((n, 3))},
        used={"cluster_id": np.arange(1, 4)}, counts={"cluster_id": np.array([50, 50, 100])},
        most={"cluster_id": np.array([3])}, inside={"cluster_id": edges}, beside={"cluster_id": edges},
        rasters={"terrain": rng.random((5, 4)).astype(np.float32)}, lattices={"terrain": np.array([0, 0, 5, 4, 0.5])},
        layers={"footprints": LayerFeatures([square, square], {"id": [1, 2], "cluster_id": [1, 3]})},
        pieces={"footprints": np.array([True, False])}, items={"Solid": [("1", {"height": 3.0})]},
        seconds={"ground": np.array(1.5)}, values={"ground_cell": np.array(0.5)}, messages=["One."], absent=["None."],
        tries=np.array([[131.0, 5000, 0.5, 2.5]]),
    )  # fmt: skip
    with TemporaryDirectory() as folder:
        result.write(Path(folder) / SOUND)
        return (Path(folder) / SOUND).read_bytes()


def block_files(rng: np.random.Generator) -> dict[str, bytes]:
    """Return a damaged result, and the sound one."""
    sound = sound_result()
    way = _RESULT_DAMAGES[rng.integers(len(_RESULT_DAMAGES))]
    return {RESULT: way(rng, sound), SOUND: sound}


def _numbers(rng: np.random.Generator, raw: bytes) -> bytes:
    """Give odd values to fields of the archive's own records, of which its reader takes positions and sizes."""
    damaged = bytearray(raw)
    starts = [at for mark in (b"PK\x01\x02", b"PK\x03\x04", b"PK\x05\x06") for at in _places(raw, mark)]
    for _ in range(rng.integers(1, 4)):
        at = int(rng.choice(starts)) + int(rng.integers(4, 46))
        size = int(rng.choice((1, 2, 4)))
        value = int(rng.choice((0, 1, 0x7FFFFFFF, 0xFFFFFFFF, len(raw), int(rng.integers(2**32)))))
        damaged[at : at + size] = struct.pack("<I", value)[:size]
    return bytes(damaged)


def _heads(rng: np.random.Generator, raw: bytes) -> bytes:
    """Change the text in which an array states its type and shape."""
    at = int(rng.choice(_places(raw, b"{'descr'")))
    end = raw.index(b"\n", at)
    old, new = _HEADS[rng.integers(len(_HEADS))]
    return raw[:at] + raw[at:end].replace(old, new).ljust(end - at)[: end - at] + raw[end:]


_HEADS = (
    (b"'<i8'", b"'|O' "), (b"'<f8'", b"'|O' "), (b"(200,)", b"(9**9,)"), (b"(200,)", b"(-1,) "), (b"}", b"[[[["),
    (b"False", b"True "), (b"'descr'", b"'descR'"), (b"(20, 3)", b"(3, 20)"), (b"(", b"(" * 40), (b"'<i8'", b"'<c16'"),
    (b"200", b"2e2"), (b"{", b"\x00"), (b"'fortran_order': False", b"'fortran_order': f()  "),
)  # fmt: skip


def _arrays(rng: np.random.Generator, raw: bytes) -> bytes:
    """Write all arrays anew, one of them with another shape, type or value, as an archive of numpy's."""
    with np.load(io.BytesIO(raw)) as stored:
        arrays = dict(stored)
    name = str(rng.choice(sorted(arrays)))
    arrays[name] = _ARRAYS[rng.integers(len(_ARRAYS))](arrays[name])
    if rng.random() < 0.2:
        del arrays[name]
    made = io.BytesIO()
    (np.savez_compressed if rng.random() < 0.3 else np.savez)(made, **arrays)
    return made.getvalue()


_ARRAYS: tuple[Callable[[np.ndarray], np.ndarray], ...] = (
    lambda values: values[None],
    lambda values: values.ravel()[:1],
    lambda values: values.astype(object),
    lambda values: values.astype(float) * np.nan,
    lambda values: -values.astype(float) - 1,
    lambda values: np.full(values.shape, 2**62, np.int64),
    lambda values: values.astype(str),
    lambda values: np.repeat(values.ravel(), 3),
    lambda values: np.frombuffer(b"[" * 100_000, np.uint8),
    lambda values: np.frombuffer(b'{"kind": "rings", "values": {"id": [[]]}}', np.uint8),
)


def _bomb(rng: np.random.Generator, raw: bytes) -> bytes:
    """Put an array into the archive that takes no space in it and gigabytes in memory."""
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        with archive.open("source.npy", "w", force_zip64=True) as member:
            head = io.BytesIO()
            np.lib.format.write_array_header_1_0(head, {"descr": "|u1", "fortran_order": False, "shape": (_BOMB,)})
            member.write(head.getvalue())
            for _ in range(3):
                member.write(bytes(2**20))
        if rng.random() < 0.5:
            archive.comment = b"0" * 64
    return made.getvalue()


def _bytes(rng: np.random.Generator, raw: bytes) -> bytes:
    """Change, cut, double or insert bytes anywhere."""
    at, part = int(rng.integers(len(raw))), raw[: int(rng.integers(1, 300))]
    ways = (raw[:at], raw[:at] + bytes([raw[at] ^ 1 << int(rng.integers(8))]) + raw[at + 1 :], raw + raw[at:])
    ways += (raw[:at] + part + raw[at:], raw[:at] + raw[at + len(part) :], part + raw, b"")
    return ways[rng.integers(len(ways))]


_RESULT_DAMAGES = (_numbers, _numbers, _heads, _heads, _arrays, _arrays, _bytes, _bytes, _bomb)


def _places(raw: bytes, mark: bytes) -> list[int]:
    return [at for at in range(len(raw)) if raw.startswith(mark, at)]


# --- layers -----------------------------------------------------------------------------------------------------------

_X, _Y = 85_000.0, 446_000.0
_ODD = (np.nan, np.inf, -np.inf, 0.0, 1e300, -1e300, 1e-300, 1e15, 1e9, 85_000.0, 446_000.0, -1.0)
_KINDS = ("Polygon", "LineString", "Point")


def layer_files(rng: np.random.Generator) -> dict[str, bytes]:
    """Return a layer in text (CSV with WKT, or GeoJSON) whose geometries and values are odd."""
    kind = str(rng.choice(_KINDS, p=(0.7, 0.2, 0.1)))
    features = [_feature(rng, kind, number) for number in range(int(rng.choice((1, 3, 8))))]
    if rng.random() < 0.6:
        return {"layer.csv": _csv(rng, kind, features)}
    return {"layer.geojson": _geojson(rng, kind, features)}


def _feature(rng: np.random.Generator, kind: str, number: int) -> tuple[list, dict[str, Any]]:
    """Return the rings of a feature, each a list of coordinates, and its values."""
    if kind == "Point":
        rings = [[[_X + 5.0, _Y + 5.0, 3.0]]]
    elif kind == "LineString":
        rings = [[[_X + number, _Y + 2.0, 1.0], [_X + 9.0 + number, _Y + 2.5, 1.5], [_X + 15.0, _Y + 9.0, 2.0]]]
    elif rng.random() < 0.4:
        rings = [[[_X + a, _Y + 5.0, z] for a, z in ((5, 0), (12, 0), (12, 6), (5, 6), (5, 0))]]
    else:
        corners = ((5, 5), (12, 5), (12, 10), (5, 10), (5, 5))
        rings = [[[_X + a + 3 * number, _Y + b, 0.0] for a, b in corners]]
        if rng.random() < 0.3:
            rings.append([[_X + a + 3 * number, _Y + b, 0.0] for a, b in ((7, 7), (7, 8), (8, 8), (7, 7))])
    for _ in range(rng.integers(3)):
        rings = _RINGS[rng.integers(len(_RINGS))](rng, rings)
    values = {"id": number + 1, "height": 3.0, "building": str(number + 1), "kind": "window", "radius": 0.3}
    if rng.random() < 0.4:
        values[str(rng.choice(sorted(values)))] = _VALUES[rng.integers(len(_VALUES))]
    return rings, values


def _odd_coordinate(rng: np.random.Generator, rings: list) -> list:
    ring = rings[rng.integers(len(rings))] if rings else []
    if ring:
        vertex = ring[rng.integers(len(ring))]
        if vertex:
            vertex[rng.integers(len(vertex))] = float(rng.choice(_ODD))
    return rings


def _spiral(rng: np.random.Generator, rings: list) -> list:
    angle = np.linspace(0, 60, 4000)
    ring = np.column_stack([_X + 9 + angle / 9 * np.cos(angle), _Y + 9 + angle / 9 * np.sin(angle), angle])
    return [[*ring.tolist(), ring[0].tolist()]]


_RINGS: tuple[Callable[[np.random.Generator, list], list], ...] = (
    _odd_coordinate,
    _odd_coordinate,
    _spiral,
    lambda rng, rings: [*rings, []],
    lambda rng, rings: [[]],
    lambda rng, rings: [],
    lambda rng, rings: [[ring[0]] * len(ring) if ring else [] for ring in rings],
    lambda rng, rings: [ring[: rng.integers(len(ring) + 1)] for ring in rings],
    lambda rng, rings: [ring[::-1] for ring in rings],
    lambda rng, rings: [[*ring[:2], *ring[1::-1]] for ring in rings],
    lambda rng, rings: [[vertex[:2] for vertex in ring] for ring in rings],
    lambda rng, rings: rings * 3,
    lambda rng, rings: [[[1e4 * a for a in vertex] for vertex in ring] for ring in rings],
    lambda rng, rings: [[[_X + 1e-7 * (a - _X) for a in vertex[:1]] + vertex[1:] for vertex in ring] for ring in rings],
)
_VALUES = (None, "", "\n", "x" * 10_000, -1, 0, 1.5, 2**31, 2**62, "nan", "<b>", "1; DROP", "\u202e", "True", [1, 2])


def _csv(rng: np.random.Generator, kind: str, features: list) -> bytes:
    """Return features as lines with WKT, of which some have another kind, words or brackets."""
    lines = ["WKT,id,height,building,kind,radius"]
    for rings, values in features:
        text = _wkt(kind, rings)
        if rng.random() < 0.3:
            old, new = _WORDS[rng.integers(len(_WORDS))]
            text = text.replace(old, new)
        cells = [json.dumps(values[name]) if isinstance(values[name], str) else str(values[name]) for name in values]
        lines.append(",".join([f'"{text}"', *cells]))
    return ("\n".join(lines) + "\n").encode("utf-8", "replace")


_WORDS = tuple(
    pair.split("|")
    for pair in (
        "POLYGON Z|POLYGON", "POLYGON Z|MULTIPOLYGON", "POLYGON Z|CURVEPOLYGON Z", "POLYGON Z|TRIANGLE Z", "((|(",
        "POLYGON Z|POLYGON ZM", "LINESTRING Z|CIRCULARSTRING Z", "POLYGON Z|TIN Z", "POLYGON Z|LINESTRING Z", ", |  ",
        " Z (| Z EMPTY, (", "85000|nan", "))|", "(|" + 500 * "(",
    )
)  # fmt: skip


def _wkt(kind: str, rings: list) -> str:
    parts = [", ".join(" ".join(map(repr, vertex)) for vertex in ring) for ring in rings]
    if kind == "Polygon":
        return (
            f"POLYGON Z ({', '.join(f'({part})' if part else 'EMPTY' for part in parts)})" if parts else "POLYGON EMPTY"
        )
    return f"{kind.upper()} Z ({parts[0]})" if parts and parts[0] else f"{kind.upper()} EMPTY"


def _geojson(rng: np.random.Generator, kind: str, features: list) -> bytes:
    """Return features as GeoJSON, of which some have another kind, or are parts of a collection."""
    found = []
    for rings, values in features:
        coordinates = rings if kind == "Polygon" else (rings[0] if rings else [])
        if kind == "Point":
            coordinates = coordinates[0] if coordinates else []
        said = kind if rng.random() < 0.9 else str(rng.choice((*_KINDS, "MultiPolygon", "GeometryCollection", "")))
        geometry: Any = {"type": said, "coordinates": coordinates}
        if rng.random() < 0.1:
            geometry = {"type": "GeometryCollection", "geometries": [geometry, None]}
        found.append({"type": "Feature", "geometry": None if rng.random() < 0.05 else geometry, "properties": values})
    crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::28992"}}
    text = json.dumps({"type": "FeatureCollection", "crs": crs, "features": found})
    if rng.random() < 0.1:
        text = text[: rng.integers(len(text))]
    return text.encode("utf-8", "replace")
