"""Entwine point tiles (EPT 1.0): an octree whose nodes are files, described by ept.json and pages of a hierarchy."""

import re
from functools import lru_cache
from pathlib import Path
from typing import Any, Callable, Optional, cast

import numpy as np

from .. import packages
from ..stage import Monitor
from .catalog_json import read_json
from .crs import crs_records, is_epsg_code, storable
from .extra_bytes import LONGEST_NAME, new_field
from .header import LARGEST_STEP, MOST_EXTRAS, Header, truncated
from .octree import PAGE, Nodes, fetched_to, nodes_of
from .outputs import EPT, PIECE, kind_of
from .point_formats import Layout
from .printable import shown
from .web_file import MOST_READ, WebFile, fetch_files, is_on_web

# Encodings of nodes with the extensions of their files; zstandard compresses binary nodes.
_ENDINGS = {"laszip": "laz", "binary": "bin", "zstandard": "zst"}
# Most nodes and pages of one hierarchy: ten times as many as the largest known data sets have.
_MOST_NODES, _MOST_PAGES = 5_000_000, 20_000
_KEY = re.compile(r"\d{1,2}(?:-\d{1,12}){3}")
# Kinds of numbers by their names in a schema, with the numbers of bytes that they may have.
_KINDS = {"signed": ("i", (1, 2, 4, 8)), "unsigned": ("u", (1, 2, 4, 8)), "floating": ("f", (4, 8))}
# Names of standard fields that differ from laspy's names in capitals.
_NAMES = {"ScanAngleRank": "scan_angle", "ScanAngle": "scan_angle", "Infrared": "nir", "ScanChannel": "scanner_channel"}
# Compact form of a name, without the characters that PDAL and laspy spell differently.
_FLAT = str.maketrans("", "", "_")


def is_ept(path: Path) -> bool:
    """Whether a path or address names a description of Entwine point tiles."""
    return kind_of(path) == EPT


class Ept:
    """The content of ept.json: place of the octree, encoding of nodes, and dimensions of points.

    Raises
    ------
    ValueError
        If the description is damaged, or nodes are stored in a way that can't be read.
    """

    def __init__(self, path: Path) -> None:
        self.path, content = path, read_json(path)
        try:
            self.kind, self.count = str(content["dataType"]), int(content["points"])
            ends = np.array([content["bounds"], content.get("boundsConforming") or content["bounds"]], float)
            ends = ends.reshape(2, 2, 3)
            self.fields = [_field(one) for one in content["schema"][: MOST_EXTRAS + 1]]
            names = {name for name, *_ in self.fields}
            self.srs, span = content.get("srs") or {}, float(content.get("span") or 0)
            is_box = np.isfinite(ends).all() and (ends[:, 1] >= ends[:, 0]).all() and (ends[0, 1] > ends[0, 0]).all()
            is_sound = is_box and len(names) == len(self.fields) <= MOST_EXTRAS and 0 <= self.count < 2**62
        except (KeyError, TypeError, ValueError, OverflowError, AttributeError, IndexError):
            is_sound = False
        if not is_sound:
            raise truncated(path, "it is no description of Entwine point tiles")
        if self.kind not in _ENDINGS:
            raise ValueError(
                f"{path.name} has points of the type {shown(self.kind)}; only the types laszip, binary and "
                "zstandard can be read; convert it to one of these, or to COPC."
            )
        if self.kind == "zstandard" and packages.zstandard() is None:
            raise ValueError(
                f"{path.name} has points that are packed by zstandard, and the Python package zstandard is missing; "
                "install it (pip install zstandard), or convert the points to COPC."
            )
        self.is_laz = self.kind == "laszip"
        #: Version of a description on the web, which shows whether it has changed; "" on this computer
        self.version = str(path.stat().st_mtime_ns or "") if is_on_web(path) else ""
        (self.low, self.high), self.bounds = ends
        #: Distance of the points that the root shows
        self.spacing = float((self.high - self.low)[0] / span) if span > 0 else 0.0

    def file(self, folder: str, key: str, extension: str) -> Path:
        """Return a file of the octree."""
        name = f"{folder}/{key}.{extension}"
        return cast(Path, cast(WebFile, self.path).beside(name)) if is_on_web(self.path) else self.path.parent / name

    def data(self, key: str) -> Path:
        """Return the file of a node."""
        return self.file("ept-data", key, _ENDINGS[self.kind])

    @property
    def record(self) -> np.dtype:
        """How a point of a binary node is stored."""
        return np.dtype([(name, dtype) for name, dtype, _, _ in self.fields])

    def header(self, of_file: Callable[[Path], Header]) -> Header:
        """Return the header that a LAS file with all these points would have; ``of_file`` reads a node's."""
        if self.is_laz:
            root = self.data("0-0-0-0")
            fetch_files([root], Monitor(), self.version)
            of_root = of_file(root)
            layout, scale, offset = of_root.layout, of_root.scale, of_root.offset
        else:
            layout, scale, offset = self._layout(), *self._grid()
        header = Header(count=self.count, scale=scale, offset=offset, low=self.bounds[0], high=self.bounds[1])
        header.vlrs, header.encoding = crs_records(_system(self.srs))
        return header.with_layout(layout)

    def _grid(self) -> tuple[np.ndarray, np.ndarray]:
        """Return scale and offset (3,) of the coordinates of binary nodes."""
        of = {name: (scale, offset) for name, dtype, scale, offset in self.fields if dtype.kind == "i"}
        if all(of.get(axis, (0.0, 0.0))[0] > 0 for axis in "XYZ"):
            return tuple(np.array([of[axis][i] for axis in "XYZ"]) for i in (0, 1))
        return Header().scale, np.floor(self.bounds.mean(axis=0))

    def _layout(self) -> Layout:
        """Return the layout of records that hold the dimensions of binary nodes."""
        names = {name for name, *_ in self.fields}
        if not names >= set("XYZ"):
            raise truncated(self.path, "its schema has no X, Y and Z")
        point_format = 8 if "Infrared" in names else 7 if "Red" in names else 6
        standard = _standard(Layout(point_format))
        extras = [one for one in self.fields if one[0] not in "XYZ" and _flat(one[0]) not in standard]
        fields = [new_field(name, "f8" if scale else dtype.str, "") for name, dtype, scale, _ in extras]
        return Layout(point_format, tuple(fields))

    def decode(self, raw: bytes, header: Header) -> np.ndarray:
        """Return the records of the bytes of a binary node."""
        stored = np.frombuffer(raw, self.record)
        out = np.zeros(len(stored), header.layout.dtype)
        standard, extra = _standard(header.layout), 0
        for name, dtype, scale, offset in self.fields:
            values = stored[name]
            if name in ("X", "Y", "Z"):
                axis = "XYZ".index(name)
                if dtype.kind != "i" or scale != header.scale[axis] or offset != header.offset[axis]:
                    values = values * (scale or 1.0) + offset
                    values = np.rint((values - header.offset[axis]) / header.scale[axis])
                if len(values) and not max(values.max(), -values.min()) <= LARGEST_STEP:
                    raise truncated(self.path, "it has coordinates far outside its bounds")
                out[name] = values
                continue
            values = values * scale + offset if scale else values
            if _flat(name) in standard:
                # Numbers below 0 would be wrong bits.
                is_bits = standard[_flat(name)] not in out.dtype.names
                header.layout.put(out, standard[_flat(name)], np.maximum(values, 0) if is_bits else values)
            else:
                out[f"extra{extra}"] = values
                extra += 1
        return out


def _flat(name: str) -> str:
    return _NAMES.get(name, name).translate(_FLAT).lower()


def _standard(layout: Layout) -> dict[str, str]:
    """Return the standard fields of a layout by their names without underscores, in lower case."""
    return {_flat(name): name for name in layout.names if name not in ("X", "Y", "Z")}


def _field(one: dict) -> tuple[str, np.dtype, float, float]:
    """Return name, type, scale (0 for none) and offset of a dimension of a schema."""
    name, size, scale, offset = str(one["name"]), one["size"], float(one.get("scale", 0)), float(one.get("offset", 0))
    letter, sizes = _KINDS[one["type"]]
    if size not in sizes or not 0 < len(name.encode()) <= LONGEST_NAME or not np.isfinite([scale, offset]).all():
        raise ValueError(name)
    # Plain numbers have a scale of 1 and no offset.
    is_plain = (scale, offset) == (1.0, 0.0) and name not in ("X", "Y", "Z")
    return name, np.dtype(f"<{letter}{size}"), 0.0 if is_plain else scale, offset


def _system(srs: Any) -> str:
    """Return the coordinate reference system of a description: WKT, "EPSG:code" or ""."""
    wkt, code = (srs.get(name) for name in ("wkt", "horizontal")) if isinstance(srs, dict) else ("", "")
    if '"' in storable(wkt):
        return storable(wkt)
    text = f"EPSG:{code}"
    return text if len(text) < 11 and is_epsg_code(text) else ""


class EptOctree:
    """The nodes of Entwine point tiles that may have points in the reach of a header.

    Parameters
    ----------
    path : Path
        Of the description.
    header : Header
        From :meth:`Ept.header`; with its reach.
    read_laz : callable
        Returns the records of a node in a LAZ file, in the header's format; given its number of points, too.
    """

    def __init__(self, path: Path, header: Header, read_laz: Callable[[Path, int, Header], np.ndarray]) -> None:
        self.ept, self.header, self.read_laz = Ept(path), header, read_laz
        reach, spacing = (None if one is None else tuple(one.ravel()) for one in (header.reach, header.spacing))
        state = path.stat()
        self.keys, counts, self.nodes = _hierarchy(path, reach, spacing, state.st_size, state.st_mtime_ns)
        if header.reach is None and header.spacing is None and counts.sum() != self.ept.count:
            raise truncated(path, f"it promises {self.ept.count} points, but its nodes hold {counts.sum()}")
        self.chunks = np.column_stack([counts * 0, counts * self._size(), counts]).astype(np.int64)

    def _size(self) -> float:
        """Return the bytes of a point; if packed, of the root node, as only asking for a file shows its size."""
        if self.ept.kind == "binary":
            return self.ept.record.itemsize
        at = (self.keys == 0).all(axis=1).argmax() if len(self.keys) else 0
        return self.ept.data("0-0-0-0").stat().st_size / self.nodes.points[at] if len(self.keys) else 0.0

    def _file(self, row: int) -> Path:
        return self.ept.data("-".join(map(str, self.keys[row].tolist())))

    def fetch(self, parts: list[np.ndarray], first: int, monitor: Monitor) -> int:
        """Fetch the nodes of portions from the first on, as many as are kept; return the portion behind them."""
        last = fetched_to(self.chunks, parts, first)
        files = map(self._file, np.concatenate(parts[first:last]))
        fetch_files(files, monitor.part(first / len(parts), last / len(parts)), self.ept.version)
        return last

    def read(self, some: np.ndarray) -> np.ndarray:
        """Return the records of nodes."""
        return np.concatenate([self._node(self._file(row), int(self.nodes.points[row])) for row in some])

    def _node(self, file: Path, count: int) -> np.ndarray:
        if self.ept.is_laz:
            return self.read_laz(file, count, self.header)
        expected = count * self.ept.record.itemsize
        with file.open("rb") as stream:
            raw = self._bytes(file, stream, min(expected, MOST_READ))
        if len(raw) != expected:
            found = len(raw) if len(raw) < expected else "more"
            raise truncated(file, f"its {count} points should take {expected} bytes, and it has {found}")
        return self.ept.decode(raw, self.header)

    def _bytes(self, file: Path, stream: Any, size: int) -> bytes:
        """Return the bytes of the points of a node, unpacked; at most a piece more than its size should be."""
        zstandard, found = packages.zstandard() if self.ept.kind == "zstandard" else None, bytearray()
        errors = (zstandard.ZstdError, EOFError) if zstandard else (EOFError,)
        try:
            # A stream allocates as much as one call asks for.
            stream = zstandard.open(stream) if zstandard else stream
            while len(found) <= size and (piece := stream.read(PIECE)):
                found += piece
        except errors:
            raise truncated(file, "its points can't be unpacked") from None
        return bytes(found)


@lru_cache(maxsize=8)
def _hierarchy(
    path: Path, reach: Optional[tuple], spacing: Optional[tuple], size: int, changed: int
) -> tuple[np.ndarray, np.ndarray, Nodes]:
    """Return keys (m, 4), numbers of points (m,) and nodes of those that touch a box; ``size``, ``changed``: its state.

    Pages of the hierarchy are read only where their node touches the box and is needed for the spacing.
    """
    ept = Ept(path)
    box = np.array(reach or (-np.inf, -np.inf, np.inf, np.inf)).reshape(2, 2)
    sides = None if spacing is None else np.array(spacing)
    found: dict[tuple, int] = {}
    waiting, seen = [(0, 0, 0, 0)], {(0, 0, 0, 0)}
    while waiting:
        files = [ept.file("ept-hierarchy", "-".join(map(str, key)), "json") for key in waiting]
        fetch_files(files, Monitor(), ept.version)
        entries = {key: count for file in files for key, count in _page(file).items()}
        if len(found) + len(entries) > _MOST_NODES or len(seen) > _MOST_PAGES:
            raise truncated(path, f"its hierarchy has more than {_MOST_NODES} nodes or {_MOST_PAGES} pages")
        found.update({key: count for key, count in entries.items() if count > 0})
        pages = [key for key, count in entries.items() if count == PAGE and key not in seen]
        waiting = [key for key, touches in zip(pages, _nodes(ept, pages).touch(box, sides)) if touches]
        seen.update(waiting)
    keys = sorted(found)
    nodes = _nodes(ept, keys, [found[key] for key in keys])
    near = nodes.touch(box, sides)
    return np.array(keys, np.int64).reshape(-1, 4)[near], nodes.points[near], nodes.take(near)


def _nodes(ept: Ept, keys: list[tuple], counts: Any = ()) -> Nodes:
    """Return the nodes of an octree by their keys."""
    margin = np.full(2, max([*Header().scale, *(scale for name, _, scale, _ in ept.fields if name in ("X", "Y"))]))
    points = np.array(counts if len(counts) else [0] * len(keys), np.int64)
    found = np.array(keys, np.int64).reshape(-1, 4)
    root = np.array([ept.low, ept.high - ept.low])[:, :2]
    return nodes_of(ept.path, found, points, root, margin, ept.spacing)


def _page(file: Path) -> dict[tuple, int]:
    """Return the numbers of points by the keys of one page of a hierarchy."""
    content = read_json(file)
    # A point takes a byte at least, so that a node has no more of them than bytes are read.
    is_sound = isinstance(content, dict) and all(
        _KEY.fullmatch(key) and type(count) is int and PAGE <= count <= MOST_READ for key, count in content.items()
    )
    if not is_sound:
        raise truncated(file, "it is no page of the hierarchy of Entwine point tiles")
    return {tuple(map(int, key.split("-"))): count for key, count in content.items()}
