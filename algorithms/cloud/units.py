"""Units of a file's coordinates, from its WKT or GeoKeys, without a CRS database."""

from __future__ import annotations

import re
import struct
from dataclasses import dataclass
from typing import Any, Callable, Optional, Union

import numpy as np

from ..stage import Monitor
from .header import WKT_BIT, Header, Vlr
from .printable import shown

# EPSG code -> (meters per horizontal unit, meters per vertical unit, whether it is geographic), or None if unknown.
Resolver = Callable[[int], Optional[tuple[float, float, bool]]]

# User and record ids of the VLRs with WKT, and of those with GeoKeys and their numbers.
_PROJECTION = b"LASF_Projection"
_WKT = ((_PROJECTION, 2112), (b"liblas", 2112))
_GEOKEYS, _DOUBLES = (_PROJECTION, 34735), (_PROJECTION, 34736)

# EPSG codes of length units, as GeoKeys give them, in meters.
_LENGTHS = {
    9001: 1.0,  # Meter
    9002: 0.3048,  # International foot
    9003: 1200 / 3937,  # US survey foot
    9005: 0.3047972654,  # Clarke's foot
    9036: 1000.0,  # Kilometer
    9037: 3 * 0.3047972654,  # Clarke's yard
    9096: 0.9144,  # International yard
}
# GeoTIFF's value "user-defined": the key holds no EPSG code.
_USER_DEFINED = 32767
# Lengths that a unit may have (m), from a micrometer to a thousand kilometers: all others are damage.
_SHORTEST_UNIT = 1e-6
_LONGEST_UNIT = 1e6
# WKT of real systems has some thousand bytes; a longer one takes seconds to parse and is taken for damage.
_LONGEST_WKT = 1_000_000
# GeoKeys: kind of the coordinates; codes of the geographic, the projected and the vertical system.
_MODEL, _GEOGRAPHIC, _PROJECTED, _VERTICAL = 1024, 2048, 3072, 4096
# GeoKeys: code and size of the unit in plan, code of that of heights.
_LINEAR_UNITS, _LINEAR_UNIT_SIZE, _VERTICAL_UNITS = 3076, 3077, 4099
# Values of the kind of the coordinates.
_MODEL_GEOGRAPHIC, _MODEL_GEOCENTRIC = 2, 3

# Pieces of WKT: texts in quotes, brackets, commas, and anything else without white space.
_TOKEN = re.compile(r'"(?:[^"]|"")*"|[\[\](),]|[^\s\[\](),"]+')
# Nodes of WKT within one another, at most; deeper ones are damage.
_DEEPEST = 50
# Keywords of WKT 1 and 2: units of length; systems in a plane, on an ellipsoid, of heights.
_LENGTH_UNITS = ("UNIT", "LENGTHUNIT")
_PLANE = ("PROJCS", "PROJCRS", "PROJECTEDCRS", "LOCAL_CS", "ENGCRS", "ENGINEERINGCRS", "DERIVEDPROJCRS")
_ON_ELLIPSOID = ("GEOGCS", "GEOGCRS", "GEOGRAPHICCRS", "GEODCRS", "GEODETICCRS", "GEOCCS")
_HEIGHT = ("VERT_CS", "VERTCS", "VERTCRS", "VERTICALCRS")

# One sentence for every input, so that a chain shows it once: later steps inherit the lack from the first.
NO_CRS = "The input has no coordinate reference system; its coordinates are taken as meters."


@dataclass(frozen=True)
class Units:
    """Meters per unit of the file's coordinates, and a warning for users about them."""

    horizontal: float = 1.0
    vertical: float = 1.0
    warning: str = ""

    @property
    def factors(self) -> np.ndarray:
        """Meters per unit of x, y and z, (3,)."""
        return np.array([self.horizontal, self.horizontal, self.vertical])

    def report(self, monitor: Monitor) -> None:
        """Warn where the unit is not known, and say so where it is not the meter."""
        if self.warning:
            monitor.warn(self.warning)
        if self.horizontal != 1.0 or self.vertical != 1.0:
            monitor.inform(
                f"A unit of the coordinates is {self.horizontal:.6g} m, of heights {self.vertical:.6g} m; parameters, "
                "the log and attributes are in meters."
            )


@dataclass
class _Node:
    """``KEYWORD[...]`` of WKT: its texts and numbers, and the nodes in it."""

    keyword: str
    values: list[Union[str, float]]
    children: list[_Node]

    def all(self, *keywords: str) -> list[_Node]:
        return [child for child in self.children if child.keyword in keywords]

    def anywhere(self, *keywords: str) -> list[_Node]:
        own = [self] if self.keyword in keywords else []
        return own + [found for child in self.children for found in child.anywhere(*keywords)]


def wkt_of(header: Header) -> str:
    """Return WKT, or "EPSG:code" from GeoKeys, "" without either; of both, that which the header's WKT bit names."""
    wkt = _stored_wkt(header)
    keys = _geokeys(header)
    # The bit says which of the two counts; files that have only the other one are common.
    if wkt and (header.encoding & WKT_BIT or not keys):
        return wkt
    code = keys.get(_PROJECTED, 0) or keys.get(_GEOGRAPHIC, 0)
    return f"EPSG:{code}" if 0 < code < _USER_DEFINED else wkt


def has_wkt(header: Header) -> bool:
    """Whether the file holds WKT, not just GeoKeys or nothing."""
    return bool(_stored_wkt(header))


def crs_identity(wkt: str) -> str:
    """Return "EPSG:code" for WKT that gives the code of its CRS, else the WKT without white space: to compare by."""
    if '"' not in wkt:
        return wkt
    root = _parse(wkt)
    if root is not None:
        for node in root.children[0].all("AUTHORITY", "ID"):
            if len(node.values) > 1 and str(node.values[0]).upper() == "EPSG":
                # WKT 1 has the code in quotes, WKT 2 has a number.
                return f"EPSG:{str(node.values[1]).split('.')[0]}"
    return re.sub(r"\s", "", wkt)


def crs_records(wkt: str) -> tuple[list[Vlr], int]:
    """Return the VLRs that store ``wkt`` (WKT, "EPSG:code" or ""), and its bits of the global encoding."""
    if wkt and '"' not in wkt:
        code = wkt[5:]
        if not (wkt.upper().startswith("EPSG:") and code.isdecimal() and 0 < int(code) < _USER_DEFINED):
            raise ValueError(f"The CRS {wkt!r} can't be stored; give WKT or EPSG:code.")
        keys = (1, 1, 0, 2, _MODEL, 0, 1, 1, _PROJECTED, 0, 1, int(code))
        return [Vlr(*_GEOKEYS, struct.pack(f"<{len(keys)}H", *keys), description=b"GeoKeys")], 0
    if not wkt:
        return [], WKT_BIT
    return [Vlr(*_WKT[0], wkt.encode() + b"\0", description=b"WKT")], WKT_BIT


def units_of(header: Header, crs_units: Optional[Resolver] = None) -> Units:
    """Return the units of the coordinates of a file.

    Parameters
    ----------
    header : Header
        With the file's VLRs.
    crs_units : callable, optional
        Looks an EPSG code up in a CRS database, for GeoKeys that give a code and no unit.

    Returns
    -------
    Units
        Meters where the file names no unit, with a warning unless WKT gives a projected system. Heights have the
        horizontal unit where nothing is said of theirs.

    Raises
    ------
    ValueError
        If the coordinates are degrees or geocentric.
    """
    wkt = wkt_of(header)
    return units_of_wkt(wkt) if '"' in wkt else _units_of_geokeys(header, crs_units)


def units_of_wkt(wkt: str) -> Units:
    """Return the units that WKT 1 or WKT 2 gives, see :func:`units_of`."""
    root = _parse(wkt)
    if root is None:
        return Units(warning=NO_CRS)
    plane = next(iter(root.anywhere(*_PLANE)), None)
    if plane is None:
        _refuse_ellipsoid(root)
        return Units(warning=NO_CRS)
    sizes = _axis_units(plane) or [1.0]
    if sizes[0] != sizes[min(1, len(sizes) - 1)]:
        apart = f"{sizes[0]:g} and {sizes[1]:g} m"
        raise ValueError(f"The axes of the coordinates have different units ({apart}); reproject the cloud first.")
    height = next(iter(root.anywhere(*_HEIGHT)), None)
    of_height = _axis_units(height) if height is not None else []
    vertical = of_height[0] if of_height else sizes[2] if len(sizes) > 2 else sizes[0]
    return Units(sizes[0], vertical)


def _refuse_ellipsoid(root: _Node) -> None:
    found = root.anywhere(*_ON_ELLIPSOID)
    if not found:
        return
    system = next(iter(found[0].all("CS")), None)
    cartesian = found[0].keyword == "GEOCCS" or (
        system is not None and "cartesian" in map(str.lower, map(str, system.values))
    )
    raise _not_plane(str(found[0].values[0]) if found[0].values else found[0].keyword, cartesian)


def _not_plane(name: str, geocentric: bool) -> ValueError:
    what = "geocentric" if geocentric else "degrees"
    return ValueError(
        f"The coordinates are {what} ({shown(name)}); "
        "reproject the cloud to a projected system in meters or feet first."
    )


def _axis_units(node: _Node) -> list[float]:
    """Return meters per unit: one for all axes (WKT 1, or a common unit), or one per axis (WKT 2)."""
    by_axis = [unit for axis in node.all("AXIS") for unit in axis.all(*_LENGTH_UNITS)]
    units = by_axis or node.all(*_LENGTH_UNITS)
    sizes = [unit.values[1] for unit in units if len(unit.values) > 1]
    return [_length(size) for size in sizes if isinstance(size, float)]


def _length(size: float) -> float:
    """Return meters per unit, or refuse a unit that is no length."""
    if not _SHORTEST_UNIT <= size <= _LONGEST_UNIT:
        raise ValueError(f"The file gives its unit of length as {size:g} m, which is damaged; assign its CRS again.")
    return size


def _parse(wkt: str) -> Optional[_Node]:
    """Return a nameless node that holds the systems in ``wkt`` (ESRI writes two side by side), None if it is no WKT."""
    root = _Node("", [], [])
    stack = [root]
    for piece in _TOKEN.findall(wkt):
        if piece in ("[", "("):
            if not stack[-1].values or len(stack) > _DEEPEST:
                return None
            # What was taken for a value is the keyword of what follows.
            node = _Node(str(stack[-1].values.pop()).upper(), [], [])
            stack[-1].children.append(node)
            stack.append(node)
        elif piece in ("]", ")"):
            if len(stack) == 1:
                return None
            stack.pop()
        elif piece != ",":
            stack[-1].values.append(_value(piece))
    return root if len(stack) == 1 and root.children else None


def _value(piece: str) -> Union[str, float]:
    if piece.startswith('"'):
        return piece[1:-1]
    try:
        return float(piece)
    except ValueError:
        return piece


def _stored_wkt(header: Header) -> str:
    for key in _WKT:
        record = header.find(key)
        if record is not None and record.data and len(record.data) <= _LONGEST_WKT:
            return record.data.split(b"\0")[0].decode("utf-8", "replace").strip()
    return ""


def _geokeys(header: Header) -> dict[int, Any]:
    """Return the GeoKeys with numbers: short ones as they are, the linear unit's size from the doubles."""
    directory, doubles = header.find(_GEOKEYS), header.find(_DOUBLES)
    if directory is None or not directory.data:
        return {}
    numbers = struct.unpack(f"<{len(directory.data) // 2}H", directory.data[: len(directory.data) // 2 * 2])
    keys: dict[int, Any] = {}
    for start in range(4, len(numbers) - 3, 4):
        key, position, _, value = numbers[start : start + 4]
        if position == 0:
            keys[key] = value
        elif position == _DOUBLES[1] and doubles is not None and doubles.data and len(doubles.data) >= 8 * (value + 1):
            keys[key] = struct.unpack_from("<d", doubles.data, 8 * value)[0]
    return keys


def _units_of_geokeys(header: Header, crs_units: Optional[Resolver]) -> Units:
    keys = _geokeys(header)
    if not keys:
        return Units(warning=NO_CRS)
    model = keys.get(_MODEL)
    on_ellipsoid = keys.get(_GEOGRAPHIC, 0) not in (0, _USER_DEFINED) and not keys.get(_PROJECTED)
    if model in (_MODEL_GEOGRAPHIC, _MODEL_GEOCENTRIC) or (on_ellipsoid and _LINEAR_UNITS not in keys):
        raise _not_plane(f"EPSG:{keys.get(_GEOGRAPHIC, 'unknown')}", model == _MODEL_GEOCENTRIC)
    return _linear_units(keys, crs_units)


def _linear_units(keys: dict[int, Any], crs_units: Optional[Resolver]) -> Units:
    """Return what the unit keys say, else what the CRS database says of the codes, else meters."""
    of_code = _looked_up(keys.get(_PROJECTED, 0), crs_units)
    of_height = _looked_up(keys.get(_VERTICAL, 0), crs_units)
    if of_code and of_code[2]:
        raise _not_plane(f"EPSG:{keys[_PROJECTED]}", geocentric=False)
    own = _LENGTHS.get(keys.get(_LINEAR_UNITS, 0))
    if _LINEAR_UNIT_SIZE in keys:
        own = _length(keys[_LINEAR_UNIT_SIZE])
    horizontal = own or (of_code[0] if of_code else 1.0)
    vertical = _LENGTHS.get(keys.get(_VERTICAL_UNITS, 0))
    if vertical is None:
        # Heights without a unit of their own have that of the plane.
        vertical = of_height[1] if of_height else of_code[1] if of_code and not own else horizontal
    if own or of_code:
        return Units(horizontal, vertical)
    code = keys.get(_PROJECTED, 0)
    named = 0 < code < _USER_DEFINED
    without_unit = f"The file gives EPSG:{code} and no unit; its coordinates are taken as meters."
    return Units(horizontal, vertical, without_unit if named else NO_CRS)


def _looked_up(code: int, crs_units: Optional[Resolver]) -> Optional[tuple[float, float, bool]]:
    return crs_units(code) if crs_units and 0 < code < _USER_DEFINED else None
