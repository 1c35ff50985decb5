"""Create and compare coordinate reference systems: by QGIS's libraries in QGIS, else by pyproj."""

import importlib
import re
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from functools import cache, lru_cache
from typing import Any, NamedTuple, Optional, Protocol

import numpy as np

# Confidence (%) of PROJ's search from which two systems have the same plane, perhaps under other names.
SAME_PLANE = 70
# The axis of heights in WKT 2 of a system of three axes, and their numbers.
_HEIGHT_AXIS = re.compile(r',\s*AXIS\["[^"]*",up(?:,\s*\w+\[(?:[^\[\]]|\[[^\[\]]*\])*\])*\]')
_AXES = "CS[Cartesian,3]", "CS[Cartesian,2]"


class Area(NamedTuple):
    """An area, from west and south to east and north in degrees; beyond 180 degrees, west is more than east."""

    west: float
    south: float
    east: float
    north: float

    def holds(self, longitude: float, latitude: float) -> bool:
        """Whether a position (degrees) lies in the area."""
        between = self.west <= longitude, longitude <= self.east
        return (all(between) if self.west <= self.east else any(between)) and self.south <= latitude <= self.north


class Definition(NamedTuple):
    """What an authority knows of a system."""

    wkt: str  #: The whole system as WKT, heights included
    plane: str  #: Its horizontal part: "EPSG:code" where it has a code, else WKT
    code: str  #: Code of the whole system, else of its horizontal part, "" without any
    identity: str  #: The same text for one plane, however it is written


class Authority(Protocol):
    """What makes and compares systems."""

    def define(self, text: str, keys: tuple[tuple[int, bytes], ...] = ()) -> Optional[Definition]:
        """Return the system of WKT, of a code, or of GeoKeys (tags and payloads) where the text is ""; None if unknown.

        Systems in degrees and geocentric ones have no plane.
        """

    def to_radians(self, plane: str, positions: np.ndarray) -> tuple[np.ndarray, Optional[Area]]:
        """Return longitude and latitude (n, 2), radians, of positions (n, 2) in a plane, and the area it is made for.

        Positions that the plane can't map are infinite; an unknown area is None.
        """


def without_code(wkt: str) -> str:
    """Return the WKT of a system without its own code, which its parameters contradict."""
    return re.sub(r',(AUTHORITY|ID)\["[^"]*",[^\[\]]*\]\]\s*$', "]", wkt)


def nameless(wkt: str) -> str:
    """Return the WKT of a system without its name and code: a search for it finds all codes of one plane."""
    return re.sub(r'"(?:[^"]|"")*"', '"plane"', without_code(wkt), count=1)


def identity_of(codes: Iterable[str], proj: str) -> str:
    """Return one text for a plane: of all its codes the least, without any its PROJ string with numbers of ten digits.

    Some planes have several codes: EPSG:3067 and EPSG:25835.
    """
    numbers = [int(code) for code in codes if code.isdecimal()]
    if numbers:
        return f"EPSG:{min(numbers)}"
    return re.sub(r"(?<==)-?\d[\d.]*(?:e-?\d+)?(?= |$)", lambda number: f"{float(number[0]):.10g}", proj)


# The authority of the host program, None without one.
_of_host: list[Authority] = []


def use_authority(authority: Authority) -> None:
    """Have an authority make all systems of this process: in QGIS its libraries, as pyproj has a PROJ of its own."""
    _of_host[:] = [authority]


def authority_here() -> Optional[Authority]:
    """Return the authority of this process: the host program's, else pyproj if it is installed, else None."""
    return _of_host[0] if _of_host else _pyproj()


@cache
def _pyproj() -> Optional[Authority]:
    try:
        with _quietly():
            pyproj = importlib.import_module("pyproj")
            # A virtual environment may have pyproj without the data of PROJ: then it can make no system at all.
            pyproj.CRS.from_epsg(4326)
    except (ImportError, RuntimeError):
        return None
    return _Pyproj(pyproj)


@contextmanager
def _quietly() -> Iterator[None]:
    """Leave out pyproj's warnings: of its own installation, and that PROJ strings hold less than WKT."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


class _Pyproj:
    """Systems by pyproj, which reads no GeoKeys but the codes in them."""

    def __init__(self, pyproj: Any) -> None:
        self.pyproj = pyproj

    # More systems than a survey has.
    @lru_cache(maxsize=256)  # noqa: B019 - there is one for the life of the process
    def define(self, text: str, keys: tuple[tuple[int, bytes], ...] = ()) -> Optional[Definition]:
        if not text:
            return None
        try:
            with _quietly():
                whole = self.pyproj.CRS.from_wkt(text) if '"' in text else self.pyproj.CRS.from_user_input(text)
                return self._defined(whole)
        except self.pyproj.exceptions.CRSError:
            return None

    def _defined(self, whole: Any) -> Definition:
        system = whole.source_crs if whole.is_bound else whole
        system = system.sub_crs_list[0] if system.is_compound else system
        # pyproj has its own way since 3.6 only.
        system = self.pyproj.CRS.from_wkt(_HEIGHT_AXIS.sub("", system.to_wkt("WKT2_2019")).replace(*_AXES))
        if not (system.is_projected or system.is_engineering):
            return Definition(_written(whole), "", _code(whole), "")
        own, wkt = _code(system), system.to_wkt("WKT2_2019")
        found = self.pyproj.CRS.from_wkt(nameless(wkt)).list_authority("EPSG", SAME_PLANE)
        identity = identity_of((one.code for one in found), system.to_proj4() if system.is_projected else wkt)
        own = own or (identity if identity.startswith("EPSG:") else "")
        return Definition(_written(whole), own or without_code(wkt), _code(whole) or own, identity)

    def to_radians(self, plane: str, positions: np.ndarray) -> tuple[np.ndarray, Optional[Area]]:
        nowhere = np.full(np.shape(positions), np.inf)
        with _quietly():
            system = self.pyproj.CRS.from_user_input(plane)
            if not system.is_projected:
                return nowhere, None
            found = system.area_of_use
            area = Area(found.west, found.south, found.east, found.north) if found else None
            try:
                change = self.pyproj.Transformer.from_crs(system, system.geodetic_crs, always_xy=True)
            except self.pyproj.exceptions.ProjError:
                # A method without some of its parameters.
                return nowhere, area
            return np.column_stack(change.transform(*np.transpose(positions), radians=True)), area


def _code(system: Any) -> str:
    found = system.to_authority(min_confidence=SAME_PLANE)
    return ":".join(found) if found else ""


def _written(whole: Any) -> str:
    """Return WKT 1, as LAS 1.4 asks for, WKT 2 of systems that it has no words for."""
    try:
        return whole.to_wkt("WKT1_GDAL") or whole.to_wkt()
    except Exception:  # noqa: BLE001 - pyproj raises its own error, and warns where it has none
        return whole.to_wkt()
