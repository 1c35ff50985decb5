"""Damaged point clouds: sound files of every kind, and what is done to their fields, records and texts.

A mutant depends on nothing but its seed, its number and the kinds that are asked for, so that each can be made again.
"""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass, field
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Callable

import numpy as np

from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.attacks.other_mutants import RESULT, block_files, layer_files
from lidar_buildings.tests.las_files import RECORD_SIZES, descriptor, evlr, made_las, random_records, vlr

KINDS = ("las", "laz", "copc", "vpc", "geokeys", "wkt", "extra", "block")
# Layers are read by QGIS.
KINDS += ("layer",) if find_spec("qgis") else ()

# Formats of points that sound files have: old and new ones, with colors, and with waveforms (not in LAZ and COPC).
_FORMATS = {"las": (0, 1, 3, 4, 5, 6, 7, 8, 9, 10), "laz": (0, 1, 3, 6, 7, 8), "copc": (6, 7, 8)}
_POINTS = 150
# Most damage is small: a file with many wrong fields is refused for the first of them.
_MOST_CHANGES = 4
# Bytes of a splice, a cut or an insertion.
_LONGEST_SPLICE = 200

WKT = (
    'PROJCS["Amersfoort / RD New",GEOGCS["Amersfoort",DATUM["Amersfoort",SPHEROID["Bessel 1841",6377397.155,299.15]],'
    'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],PROJECTION["Oblique_Stereographic"],'
    'PARAMETER["scale_factor",0.9999079],UNIT["metre",1],AXIS["X",EAST],AXIS["Y",NORTH],AUTHORITY["EPSG","28992"]]'
)
WKT2 = (
    'COMPOUNDCRS["RD + NAP",PROJCRS["RD",BASEGEOGCRS["Amersfoort",DATUM["Amersfoort",ELLIPSOID["Bessel",6377397.155,'
    '299.15,LENGTHUNIT["metre",1]]]],CONVERSION["RD",METHOD["Stereographic"]],CS[Cartesian,2],AXIS["(E)",east,ORDER[1],'
    'LENGTHUNIT["metre",1]],AXIS["(N)",north,ORDER[2],LENGTHUNIT["metre",1]],ID["EPSG",28992]],VERTCRS["NAP",VDATUM['
    '"NAP"],CS[vertical,1],AXIS["height",up,LENGTHUNIT["metre",1]],ID["EPSG",5709]]]'
)
GEOKEYS = (1, 1, 0, 4, 1024, 0, 1, 1, 3072, 0, 1, 32767, 3076, 0, 1, 9002, 3077, 34736, 1, 0)


@dataclass(frozen=True)
class Place:
    """A number of a file: its position, and its code in :mod:`struct`."""

    at: int
    code: str


@dataclass(frozen=True)
class Mutant:
    """Files that are written to an empty folder, and the name of the one that is read."""

    name: str
    files: dict[str, bytes] = field(repr=False)
    reported: str = ""


# --- sound files ------------------------------------------------------------------------------------------------------


@cache
def sound_files(kind: str) -> tuple[bytes, ...]:
    """Return the sound files of a kind ("las", "laz" or "copc"), a few kB each."""
    plain = [_sound_las(point_format) for point_format in _FORMATS[kind]]
    if kind == "las":
        return tuple(plain)
    if kind == "copc":
        return tuple(_written(raw, ".copc.laz") for raw in plain)
    chunked = [_written(raw, ".laz") for raw in plain]
    return (*chunked, pointwise(chunked[0]), pointwise(chunked[2]))


def pointwise(raw: bytes) -> bytes:
    """Return a LAZ file of one chunk of an old point format as LAZ of before 2011: without chunks."""
    points_at, record = struct.unpack_from("<I", raw, 96)[0], raw.index(b"laszip encoded") - 2 + 54
    (table_at,) = struct.unpack_from("<q", raw, points_at)
    whole = bytearray(raw[:points_at] + raw[points_at + 8 : table_at])
    struct.pack_into("<H", whole, record, 1)
    return bytes(whole)


def _sound_las(point_format: int) -> bytes:
    """Return a LAS file with extra dimensions, a CRS and, in newer versions, EVLRs."""
    minor = 4 if point_format > 5 else 3 if point_format > 3 else 2
    fields = descriptor("HeightAboveGround", 9) + descriptor("ClusterID", 6) + descriptor("Mine", 3, 8, scale=0.01)
    keys = vlr("LASF_Projection", 34735, struct.pack(f"<{len(GEOKEYS)}H", *GEOKEYS))
    unit = vlr("LASF_Projection", 34736, struct.pack("<d", 0.3048))
    wkt = vlr("LASF_Projection", 2112, (WKT if point_format % 2 else WKT2).encode() + b"\0")
    crs = (wkt,) if point_format > 5 else (keys, unit)
    behind = (evlr("someone", 7, b"anything"), evlr("LASF_Spec", 65535, bytes(64)))
    return made_las(
        point_format, minor, n=_POINTS, extra=10, vlrs=(vlr("LASF_Spec", 4, fields), *crs), encoding=16 * (minor == 4),
        evlrs=behind[: 1 + (point_format > 8)] if minor == 4 else (), waveforms=point_format > 8,
    )  # fmt: skip


def _written(raw: bytes, extension: str) -> bytes:
    with TemporaryDirectory() as folder:
        source, target = Path(folder) / "a.las", Path(folder) / f"b{extension}"
        source.write_bytes(raw)
        write_cloud(read_cloud(source), target, Monitor())
        return target.read_bytes()


# --- places of numbers ------------------------------------------------------------------------------------------------

_HEADER = [
    (4, "H"), (6, "H"), (24, "B"), (25, "B"), (90, "H"), (92, "H"), (94, "H"), (96, "I"), (100, "I"), (104, "B"),
    (105, "H"), (107, "I"), *((111 + 4 * i, "I") for i in range(5)), *((131 + 8 * i, "d") for i in range(12)),
]  # fmt: skip
_HEADER_4 = [(235, "Q"), (243, "I"), (247, "Q"), *((255 + 8 * i, "Q") for i in range(15))]
_LASZIP = [(0, "H"), (2, "H"), (4, "B"), (8, "I"), (12, "I"), (16, "q"), (24, "q"), (32, "H")]
_LASZIP += [(34 + 2 * i, "H") for i in range(9)]
_DESCRIPTOR = [(2, "B"), (3, "B"), *((40 + 8 * i, "d") for i in range(15))]
_COPC = [*((8 * i, "d") for i in range(5)), (40, "Q"), (48, "Q"), (56, "d"), (64, "d")]
_ENTRY = [*((4 * i, "i") for i in range(4)), (16, "Q"), (24, "i"), (28, "i")]
# Bytes of the chunk table, which is compressed, and of the first chunk's sizes of layers, that are changed as numbers.
_TABLE, _LAYERS = 40, 12


@cache
def places_of(raw: bytes) -> tuple[Place, ...]:
    """Return where a sound file has numbers."""
    minor, (size, points_at, n_vlrs) = raw[25], struct.unpack_from("<HII", raw, 94)
    places = [*_HEADER, *([(227, "Q")] if minor >= 3 else []), *(_HEADER_4 if minor >= 4 else [])]
    at = size
    for _ in range(n_vlrs):
        at = _record_places(raw, at, "H", 54, places)
    if minor >= 4:
        at, n_evlrs = struct.unpack_from("<QI", raw, 235)
        for _ in range(n_evlrs):
            at = _record_places(raw, at, "Q", 60, places)
    if raw[104] & 128:
        table = struct.unpack_from("<q", raw, points_at)[0]
        layers = points_at + 8 + struct.unpack_from("<H", raw, 105)[0]
        places += [(points_at, "q"), (table, "I"), (table + 4, "I")]
        places += [(i, "B") for i in range(max(0, table + 8), min(table + _TABLE, len(raw)))]
        places += [(layers + 4 * i, "I") for i in range(_LAYERS)]
    return tuple(Place(at, code) for at, code in places if at >= 0 and at + struct.calcsize(code) <= len(raw))


def _record_places(raw: bytes, at: int, length: str, head: int, places: list) -> int:
    """Add the places of a VLR or EVLR to the list and return where it ends."""
    user, number = raw[at + 2 : at + 18].rstrip(b"\0"), struct.unpack_from("<H", raw, at + 18)[0]
    (size,) = struct.unpack_from(f"<{length}", raw, at + 20)
    places += [(at + 18, "H"), (at + 20, length)]
    inner, every = {
        (b"laszip encoded", 22204): (_LASZIP, size), (b"LASF_Spec", 4): (_DESCRIPTOR, 192), (b"copc", 1): (_COPC, size),
        (b"copc", 1000): (_ENTRY, 32), (b"LASF_Projection", 34735): ([(0, "H")], 2),
        (b"LASF_Projection", 34736): ([(0, "d")], 8),
    }.get((user, number), ([(0, "B")], 16))  # fmt: skip
    places += [(at + head + start + i, code) for start in range(0, size, every or 1) for i, code in inner]
    return at + head + size


# --- damage to bytes --------------------------------------------------------------------------------------------------

_ODD_FLOATS = (
    *(np.nan, np.inf, -np.inf, 0.0, -0.0, 5e-324, 1e-300, -1e-300, 1e-7, 1e300, -1e300, 1.7e308, 2.0**31, 2.0**63),
    *(-1.0, 1e6, 1e9, 1e-3, 0.1),
)


def odd_integer(rng: np.random.Generator, size: int, raw: bytes, old: int) -> int:
    """Return an odd integer of ``size`` bytes, as in damaged or hostile files, as unsigned."""
    bits = 8 * size
    choices = (
        lambda: 0, lambda: 1, lambda: 2**bits - 1, lambda: 2**bits - 2, lambda: 2 ** (bits - 1),
        lambda: 2 ** (bits - 1) - 1, lambda: 1 << int(rng.integers(bits)), lambda: (1 << int(rng.integers(bits))) - 1,
        lambda: len(raw) + int(rng.integers(-2, 3)), lambda: old + int(rng.integers(-3, 4)), lambda: 2 * old,
        lambda: old // 2, lambda: old ^ 1 << int(rng.integers(bits)), lambda: int(rng.integers(2 ** min(bits, 63))),
        lambda: int(rng.integers(256)), lambda: int.from_bytes(_slice(rng, raw, size), "little"),
    )  # fmt: skip
    return choices[rng.integers(len(choices))]() % 2**bits


def odd_float(rng: np.random.Generator, old: float = 1.0) -> float:
    """Return an odd number of 8 bytes, as in damaged or hostile files."""
    with np.errstate(all="ignore"):
        related = (-old, old * 1e6, old * 1e-6, old + 1e9, rng.normal() * 1e4)
    choices = (*_ODD_FLOATS, *related, struct.unpack("<d", rng.bytes(8))[0])
    return float(choices[rng.integers(len(choices))])


def _slice(rng: np.random.Generator, raw: bytes, size: int) -> bytes:
    at = int(rng.integers(max(1, len(raw) - size)))
    return raw[at : at + size].ljust(size, b"\0")


def _fields(rng: np.random.Generator, raw: bytes, sound: bytes) -> bytes:
    """Give odd values to a few numbers."""
    damaged, places = bytearray(raw), places_of(sound)
    for _ in range(rng.integers(1, _MOST_CHANGES + 1)):
        place = places[rng.integers(len(places))]
        size = struct.calcsize(place.code)
        if place.at + size > len(raw):
            continue
        if place.code == "d":
            struct.pack_into("<d", damaged, place.at, odd_float(rng, struct.unpack_from("<d", raw, place.at)[0]))
        else:
            old = int.from_bytes(raw[place.at : place.at + size], "little")
            damaged[place.at : place.at + size] = odd_integer(rng, size, raw, old).to_bytes(size, "little")
    return bytes(damaged)


def _flips(rng: np.random.Generator, raw: bytes, _: bytes) -> bytes:
    """Change bits or bytes, in the header and its records or anywhere."""
    damaged = bytearray(raw)
    end = (
        len(raw)
        if rng.random() < 0.5
        else max(1, min(len(raw), struct.unpack_from("<I", raw.ljust(100, b"\0"), 96)[0]))
    )
    for at in rng.integers(end, size=rng.integers(1, 9)):
        damaged[at] = damaged[at] ^ 1 << int(rng.integers(8)) if rng.random() < 0.5 else int(rng.integers(256))
    return bytes(damaged)


def _cut(rng: np.random.Generator, raw: bytes, sound: bytes) -> bytes:
    """End the file too early, anywhere or at a number, or append bytes."""
    if rng.random() < 0.2:
        return raw + (
            rng.bytes(int(rng.integers(1, 2000))) if rng.random() < 0.5 else bytes(int(rng.integers(1, 2000)))
        )
    places = places_of(sound)
    return raw[: places[rng.integers(len(places))].at if rng.random() < 0.5 else int(rng.integers(len(raw)))]


def _splice(rng: np.random.Generator, raw: bytes, sound: bytes) -> bytes:
    """Put bytes of this or another sound file over others, between others, or take some out."""
    others = sound_files(("las", "laz", "copc")[rng.integers(3)])
    part = _slice(rng, others[rng.integers(len(others))], int(rng.integers(1, _LONGEST_SPLICE)))
    at, way = int(rng.integers(len(raw))), rng.integers(3)
    if way == 0:
        return raw[:at] + part + raw[at + len(part) :]
    return raw[:at] + part + raw[at:] if way == 1 else raw[:at] + raw[at + len(part) :]


_DAMAGES: tuple[Callable, ...] = (_fields, _fields, _fields, _fields, _flips, _flips, _cut, _splice)


def damaged(rng: np.random.Generator, raw: bytes) -> bytes:
    """Return a sound file with one to three kinds of damage."""
    result = raw
    for _ in range(1 + int(rng.geometric(0.7) > 1)):
        result = _DAMAGES[rng.integers(len(_DAMAGES))](rng, result, raw) or b"\0"
    return result


def _of_bytes(kind: str) -> Callable[[np.random.Generator], Mutant]:
    def make(rng: np.random.Generator) -> Mutant:
        files = sound_files(kind)
        name = {"las": "a.las", "laz": "a.laz", "copc": "a.copc.laz"}[kind]
        return Mutant(name, {name: damaged(rng, files[rng.integers(len(files))])})

    return make


# --- records that are written anew ------------------------------------------------------------------------------------


def _las_with(rng: np.random.Generator, records: tuple, extra: int = 0, **more: Any) -> Mutant:
    """Return a sound LAS file with these VLRs, or its EVLRs where a VLR would be too long."""
    point_format = int(rng.choice((1, 6, 7)))
    short = tuple(vlr(*record) for record in records if len(record[2]) < 2**16)
    long = tuple(evlr(*record) for record in records if len(record[2]) >= 2**16)
    rows = random_records(point_format, RECORD_SIZES[point_format] + extra, 20, seed=int(rng.integers(2**31)))
    minor = 4 if point_format > 5 or long else 2
    return Mutant(
        "a.las", {"a.las": made_las(point_format, minor, records=rows, extra=extra, vlrs=short, evlrs=long, **more)}
    )


_KEYS = (1024, 1025, 1026, 2048, 2052, 2054, 2060, 3072, 3073, 3074, 3076, 3077, 4096, 4097, 4098, 4099)
_PLACES_OF_KEYS = (0, 0, 0, 34736, 34736, 34737, 34735, 1, 65535)
_VALUES_OF_KEYS = (0, 1, 2, 3, 4326, 4978, 4979, 9001, 9002, 9003, 9036, 9102, 28992, 32631, 32767, 5709, 65535)


def _geokeys(rng: np.random.Generator) -> Mutant:
    """GeoKeys of any number and order, with doubles that are no lengths, and arrays that end anywhere."""
    entries = [
        (rng.choice(_KEYS), rng.choice(_PLACES_OF_KEYS), rng.choice((0, 1, 2, 65535)), rng.choice(_VALUES_OF_KEYS))
        for _ in range(rng.choice((0, 1, 3, 5, 20, 3000), p=(0.05, 0.15, 0.4, 0.3, 0.09, 0.01)))
    ]
    head = (rng.choice((0, 1, 65535), p=(0.1, 0.8, 0.1)), 1, 0, rng.choice((len(entries), 0, 65535)))
    directory = np.array([*head, *(number for entry in entries for number in entry)], "<u2").tobytes()
    doubles = np.array([odd_float(rng) for _ in range(rng.integers(4))], "<f8").tobytes()
    if rng.random() < 0.2:
        directory = directory[: rng.integers(len(directory) + 1)]
    records = [("LASF_Projection", 34735, directory), ("LASF_Projection", 34736, doubles)]
    if rng.random() < 0.2:
        records.append(("LASF_Projection", 34737, rng.bytes(30)))
    if rng.random() < 0.2:
        records.append(records[0])
    return _las_with(rng, tuple(records), encoding=int(rng.choice((0, 0, 16, 17, 65535))))


def _wkt(rng: np.random.Generator) -> Mutant:
    """WKT with words that are missing, doubled, exchanged, nested or no numbers."""
    text = (WKT, WKT2)[rng.integers(2)]
    for _ in range(rng.integers(1, _MOST_CHANGES + 1)):
        if len(text) < _LONG_WKT:
            text = _WKT_DAMAGES[rng.integers(len(_WKT_DAMAGES))](rng, text)[:_LONGEST_WKT]
    raw = text.encode("utf-8", "replace") + b"\0" * int(rng.integers(3))
    if rng.random() < 0.1:
        raw = _flips(rng, raw or b"\0", raw)
    user = "liblas" if rng.random() < 0.1 else "LASF_Projection"
    return _las_with(rng, ((user, 2112, raw),), encoding=int(rng.choice((0, 16, 17))))


# Texts longer than the first are not damaged further, and none is longer than the second.
_LONG_WKT, _LONGEST_WKT = 20_000, 3_000_000


def _at(rng: np.random.Generator, text: str) -> int:
    return int(rng.integers(len(text) + 1))


def _nested(rng: np.random.Generator, text: str) -> str:
    depth, at = int(rng.choice((3, 60, 2000, 20_000))), _at(rng, text)
    return text[:at] + 'UNIT["a",' * depth + "1" + "]" * depth + text[at:]


def _renumbered(rng: np.random.Generator, text: str) -> str:
    numbers = ("1e999", "-1", "0", "nan", "inf", "-inf", "1_0", "1e-400", "0x10", "9" * 400, "1e308", "\u0663")
    return text.replace(str(rng.choice(("1", "0.0174532925199433", "28992", "2"))), str(rng.choice(numbers)))


def _exchanged(rng: np.random.Generator, text: str) -> str:
    words = ("UNIT", "LENGTHUNIT", "PROJCS", "PROJCRS", "GEOGCS", "GEOCCS", "AXIS", "ID", "AUTHORITY", "VERTCRS", "CS")
    return text.replace(str(rng.choice(words)), str(rng.choice(words)))


_WKT_DAMAGES: tuple[Callable[[np.random.Generator, str], str], ...] = (
    _nested,
    _renumbered,
    _renumbered,
    _exchanged,
    lambda rng, text: text[: _at(rng, text)],
    lambda rng, text: text[: _at(rng, text)] + text[_at(rng, text) :],
    lambda rng, text: text[: (at := _at(rng, text))] + str(rng.choice(list('[](),"\0\n '))) + text[at:],
    lambda rng, text: text.replace(str(rng.choice(list('[],"'))), str(rng.choice(["", "(", "\0", '""'])), 1),
    lambda rng, text: text + "," + text,
    lambda rng, text: text.replace("Amersfoort", str(rng.choice(["\n\n", "\u202e", "", "a" * 50_000, "<b>", "%s"]))),
    lambda rng, text: text * int(rng.choice((2, 100, 3000), p=(0.6, 0.38, 0.02))),
)

_NAMES = (
    *(
        "HeightAboveGround",
        "ClusterID",
        "SegmentID",
        "NormalX",
        "NormalY",
        "NormalZ",
        "Confidence",
        "Reason",
        "Entropy",
    ),
    *("height above ground", "X", "intensity", "classification", "", " ", "extra0", "Mine", "a" * 32, "\n", "gps_time"),
)


def _extra(rng: np.random.Generator) -> Mutant:
    """Descriptors of all types and options, with names of others, twice or none, for any number of bytes."""
    count = int(rng.choice((1, 2, 5, 20, 341), p=(0.3, 0.3, 0.3, 0.09, 0.01)))
    payload = bytearray()
    for _ in range(count):
        kind = int(rng.integers(1, 11)) if rng.random() < 0.7 else int(rng.choice((0, 11, 20, 21, 30, 31, 40, 255)))
        one = bytearray(descriptor(str(rng.choice(_NAMES))[:32], kind, int(rng.integers(256))))
        for start in (40, 64, 88, 112, 136):
            struct.pack_into("<d", one, start, odd_float(rng))
        if rng.random() < 0.1:
            one[4:36] = rng.bytes(32)
        payload += one
    if rng.random() < 0.1:
        payload = payload[: rng.integers(len(payload) + 1)]
    extra = int(rng.choice((0, 1, 4, 8, 24, 60, 300, 3000)))
    return _las_with(rng, (("LASF_Spec", 4, bytes(payload)),), extra)


# --- virtual point clouds ---------------------------------------------------------------------------------------------

_HREFS = (
    *("./one.las", "two.laz", "./ONE.LAS", "../one.las", "one.las/", "/", "", ".", "a.vpc", "gone.las", "a\nb.las"),
    *(
        "https://example.org/a.laz",
        "file:///one.las",
        "s3://a/b.laz",
        "/vsicurl/http://a/b.las",
        "//host/share/one.las",
        "\\\\host\\share\\one.las",
        "file://host/one.las",
        "%2F%2Fhost/one.las",
        "one%2Elas",
        "one.las%00",
        "./%6Fne.las?query#part",
        "\0.las",
        "\ud800.las",
    ),
    *("/dev/zero.las", "/proc/self/mem", "x" * 300 + ".las", "x" * 5000 + ".las", "./" * 3000 + "one.las", "~/one.las"),
)
_ODD_VALUES: tuple[Callable[[], Any], ...] = (
    lambda: None, lambda: True, lambda: 0, lambda: -1, lambda: 10**400, lambda: float("nan"), lambda: float("inf"),
    lambda: "", lambda: "\0", lambda: "\ud800", lambda: "a" * 100_000, list, dict, lambda: [[]], lambda: {"": {}},
    lambda: _deep(20), lambda: _deep(300), lambda: [None] * 1000, lambda: {str(i): i for i in range(1000)},
)  # fmt: skip


def _deep(depth: int) -> Any:
    value: Any = []
    for level in range(depth):
        value = [value] if level % 2 else {"features": value}
    return value


@cache
def _tiles() -> tuple[bytes, bytes]:
    crs = (vlr("LASF_Projection", 2112, WKT.encode() + b"\0"),)
    one, two = (made_las(7, n=40, vlrs=crs, records=random_records(7, RECORD_SIZES[7], 40, seed)) for seed in (1, 2))
    return one, _written(two, ".laz")


def _collection(rng: np.random.Generator) -> dict:
    features = [
        {
            "type": "Feature", "stac_version": "1.0.0", "id": name, "bbox": [0.0, 0.0, 0.0, 100.0, 100.0, 10.0],
            "geometry": {"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 0]]]},
            "properties": {"pc:count": 40, "pc:type": "lidar", "proj:wkt2": WKT2, "proj:bbox": [0, 0, 0, 1, 1, 1]},
            "assets": {
                "data": {"href": name, "roles": ["data"]}, "overview": {"href": "o.copc.laz", "roles": ["overview"]},
            },
        }
        for name in ("./one.las", "./two.laz")
    ]  # fmt: skip
    return {"type": "FeatureCollection", "features": features * int(rng.choice((1, 50), p=(0.98, 0.02)))}


def _vpc(rng: np.random.Generator) -> Mutant:
    """Virtual point clouds with odd values, names and texts, or of damaged tiles."""
    one, two = _tiles()
    content = json.loads(json.dumps(_collection(rng)))
    way = rng.random()
    if way < 0.25:
        one, two = (damaged(rng, raw) if rng.random() < 0.6 else raw for raw in (one, two))
    else:
        for _ in range(rng.integers(1, _MOST_CHANGES + 1)):
            content = _changed(rng, content)
    text = json.dumps(content)
    raw = text.encode(
        str(rng.choice(("utf-8", "utf-8-sig", "utf-16", "latin-1"), p=(0.94, 0.02, 0.02, 0.02))), "replace"
    )
    if way > 0.8:
        raw = _text_damaged(rng, raw)
    return Mutant("a.vpc", {"a.vpc": raw, "one.las": one, "two.laz": two})


def _changed(rng: np.random.Generator, content: Any) -> Any:
    """Return JSON with one value, name or list changed."""
    holders = list(_holders(content))
    if not holders:
        return content
    holder, key = holders[rng.integers(len(holders))]
    if rng.random() < 0.4:
        hrefs = [(one, name) for one, name in holders if name == "href"]
        holder, key = hrefs[rng.integers(len(hrefs))] if hrefs else (holder, key)
    way = rng.random()
    if key == "href" and way < 0.8:
        holder[key] = str(_HREFS[rng.integers(len(_HREFS))])
    elif way < 0.6:
        holder[key] = _ODD_VALUES[rng.integers(len(_ODD_VALUES))]()
    elif way < 0.8 and isinstance(holder, dict):
        del holder[key]
    else:
        holder[key] = [holder[key]] * int(rng.integers(3))
    return content


def _holders(value: Any) -> Any:
    """Yield each object or list of JSON with each of its keys or positions."""
    if isinstance(value, (dict, list)):
        for key in list(value) if isinstance(value, dict) else range(len(value)):
            yield value, key
            yield from _holders(value[key])


def _text_damaged(rng: np.random.Generator, raw: bytes) -> bytes:
    depth, at = int(rng.choice((10, 1000, 100_000))), int(rng.integers(len(raw) + 1))
    choices = (
        lambda: raw[:at],
        lambda: raw[:at] + b"[" * depth + raw[at:],
        lambda: b'{"a":' * depth + raw,
        lambda: raw[:at] + b"1" * depth + raw[at:],
        lambda: _flips(rng, raw, raw),
        lambda: raw + raw,
        lambda: raw[:at] + b"\xff\xfe" + raw[at:],
    )
    return choices[rng.integers(len(choices))]()


def _layer(rng: np.random.Generator) -> Mutant:
    files = layer_files(rng)
    return Mutant(next(iter(files)), files)


_MAKERS: dict[str, Callable[[np.random.Generator], Mutant]] = {
    "las": _of_bytes("las"), "laz": _of_bytes("laz"), "copc": _of_bytes("copc"), "vpc": _vpc, "geokeys": _geokeys,
    "wkt": _wkt, "extra": _extra, "block": lambda rng: Mutant(RESULT, block_files(rng)), "layer": _layer,
}  # fmt: skip


def mutant(seed: int, number: int, kinds: tuple[str, ...] = KINDS) -> Mutant:
    """Return the mutant of that number; the kinds take turns."""
    kind = kinds[number % len(kinds)]
    made = _MAKERS[kind](np.random.default_rng([seed, number, KINDS.index(kind)]))
    return Mutant(made.name, made.files, kind)
