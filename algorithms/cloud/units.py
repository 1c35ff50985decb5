"""GeoKeys of a file, and units of its coordinates from these or its WKT, without a CRS database."""

from __future__ import annotations

import re
import struct
from dataclasses import dataclass
from typing import Any, NamedTuple, Optional, Union

import numpy as np

from .header import Header, Vlr
from .printable import shown

# User id of the VLRs of coordinate reference systems, and record ids of GeoKeys: numbers, doubles and texts.
PROJECTION = b"LASF_Projection"
_DIRECTORY, _DOUBLES, _TEXTS = ((PROJECTION, number) for number in (34735, 34736, 34737))

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
# Names of units in WKT and in sentences.
_NAMES = {9001: "metre", 9002: "foot", 9003: "US survey foot"}
# GeoTIFF's value "user-defined": the key holds no EPSG code.
USER_DEFINED = 32767
# GeoKeys: kind of the coordinates; codes of the geographic, the projected and the vertical system; the projection, by
# code and by method.
_MODEL, _GEOGRAPHIC, _PROJECTED, _VERTICAL = 1024, 2048, 3072, 4096
_CONVERSION, _METHOD = 3074, 3075
# GeoKeys: code and size of the unit in plan, code of the unit of heights.
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

# A unit in WKT: its name is the second group, its size the third. Names of feet, and of US survey feet among these.
_UNIT = re.compile(r'(UNIT\s*[\[(]\s*"([^"]*)"\s*,\s*)(\d+\.?\d*(?:E[-+]?\d+)?)', re.IGNORECASE)
_FOOT = re.compile(r"(?<![a-z])(foot|feet|ft)(?![a-z])|ftus", re.IGNORECASE)
_SURVEY_FOOT = re.compile(r"us|u\.s|survey", re.IGNORECASE)


class Units(NamedTuple):
    """Meters per unit of a file's coordinates."""

    horizontal: float = 1.0
    vertical: float = 1.0


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


def name_of_length(size: float) -> str:
    """Return the name of a unit of length in WKT, by its size (m)."""
    return next((name for code, name in _NAMES.items() if np.isclose(_LENGTHS[code], size, rtol=1e-8)), "unit")


def with_named_units(wkt: str) -> tuple[str, tuple[str, ...]]:
    """Return WKT in which units called foot have the size of a foot where 1 is given, and a warning if there is one."""
    warnings: dict[str, None] = {}

    def size(found: re.Match) -> str:
        if not _FOOT.search(found[2]) or float(found[3]) != 1:
            return found[0]
        warnings[_mismatch(found[2])] = None
        return f"{found[1]}{_LENGTHS[9003 if _SURVEY_FOOT.search(found[2]) else 9002]!r}"

    return _UNIT.sub(size, wkt), tuple(warnings)


def _mismatch(name: str) -> str:
    return f"The file calls its unit {shown(name)!r} and gives it as 1 m; the name counts."


def units_of_wkt(wkt: str) -> Optional[Units]:
    """Return the units that WKT 1 or WKT 2 gives, meters where it gives none; None for other texts.

    Heights have the horizontal unit where nothing is said of theirs.

    Raises
    ------
    ValueError
        If the coordinates are degrees or geocentric, or a unit is no length.
    """
    root = _parse(wkt)
    if root is None:
        return None
    plane = next(iter(root.anywhere(*_PLANE)), None)
    if plane is None:
        _refuse_ellipsoid(root)
        return None
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
    kinds = [str(value).lower() for system in found[0].all("CS") for value in system.values]
    cartesian = found[0].keyword == "GEOCCS" or "cartesian" in kinds
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
    # All but a micrometer to a thousand kilometers is damage.
    if not 1e-6 <= size <= 1e6:
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


class GeoKeys(dict[int, Any]):
    """The GeoKeys of a file with numbers: short ones as they are, others from the doubles."""

    def __init__(self, header: Header) -> None:
        found = ((key[1], header.find(key)) for key in (_DIRECTORY, _DOUBLES, _TEXTS))
        #: Tag and payload of each record
        self.records = tuple((tag, record.data) for tag, record in found if record is not None and record.data)
        records = dict(self.records)
        directory, doubles = records.get(_DIRECTORY[1], b""), records.get(_DOUBLES[1], b"")
        numbers = struct.unpack(f"<{len(directory) // 2}H", directory[: len(directory) // 2 * 2])
        for start in range(4, len(numbers) - 3, 4):
            key, position, _, value = numbers[start : start + 4]
            if position == 0:
                self[key] = value
            elif position == _DOUBLES[1] and len(doubles) >= 8 * (value + 1):
                self[key] = struct.unpack_from("<d", doubles, 8 * value)[0]

    @property
    def code(self) -> int:
        """EPSG code of the horizontal system, 0 without one."""
        codes = (self.get(_PROJECTED, 0), 0 if _PROJECTED in self else self.get(_GEOGRAPHIC, 0))
        return next((code for code in codes if 0 < code < USER_DEFINED), 0)

    @property
    def text(self) -> str:
        """The codes as a text, with the heights' code: "EPSG:26915+5703"."""
        height = self.get(_VERTICAL, 0)
        return f"EPSG:{self.code}" + (f"+{height}" if 0 < height < USER_DEFINED else "")

    @property
    def defines_system(self) -> bool:
        """Whether they define a horizontal system, by a code or by parameters, and not just a unit or nothing."""
        return bool(self.code or _METHOD in self or 0 < self.get(_CONVERSION, 0) < USER_DEFINED)

    def units(self, known: Optional[Units]) -> tuple[Optional[Units], tuple[str, ...]]:
        """Return the units that they give, else those ``known`` of their codes, None without either; and warnings.

        Raises
        ------
        ValueError
            If the coordinates are degrees or geocentric, or a unit is no length.
        """
        model = self.get(_MODEL)
        on_ellipsoid = self.get(_GEOGRAPHIC, 0) not in (0, USER_DEFINED) and not self.get(_PROJECTED)
        if model in (_MODEL_GEOGRAPHIC, _MODEL_GEOCENTRIC) or (on_ellipsoid and _LINEAR_UNITS not in self):
            raise _not_plane(f"EPSG:{self.get(_GEOGRAPHIC, 'unknown')}", model == _MODEL_GEOCENTRIC)
        own = _LENGTHS.get(self.get(_LINEAR_UNITS, 0))
        warnings: tuple[str, ...] = ()
        size = _length(self[_LINEAR_UNIT_SIZE]) if _LINEAR_UNIT_SIZE in self else None
        if size == 1 and own not in (None, 1):
            warnings = (_mismatch(_NAMES.get(self[_LINEAR_UNITS], f"EPSG:{self[_LINEAR_UNITS]}")),)
        else:
            own = size or own
        horizontal = own or (known.horizontal if known else 1.0)
        vertical = _LENGTHS.get(self.get(_VERTICAL_UNITS, 0))
        if vertical is None:
            # Heights without a unit of their own have the plane's.
            vertical = known.vertical if known and (_VERTICAL in self or not own) else horizontal
        return (Units(horizontal, vertical) if own or known else None), warnings


def geokeys_record(code: int) -> Vlr:
    """Return the record of the GeoKeys that give the EPSG code of a projected system."""
    numbers = (1, 1, 0, 2, _MODEL, 0, 1, 1, _PROJECTED, 0, 1, code)
    return Vlr(*_DIRECTORY, struct.pack(f"<{len(numbers)}H", *numbers), description=b"GeoKeys")
