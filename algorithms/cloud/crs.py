"""The coordinate reference system of a cloud: one record, made when the cloud is opened and handed on from there."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Callable, Optional

import numpy as np

from ..criteria import EQUATORIAL_RADIUS, POLAR_RADIUS
from ..stage import Monitor
from .authority import Authority, Definition, authority_here
from .header import LARGEST_VLR, WKT_BIT, Header, Vlr
from .printable import shown
from .units import (
    PROJECTION,
    USER_DEFINED,
    GeoKeys,
    Units,
    geokeys_record,
    name_of_length,
    units_of_wkt,
    with_named_units,
)

# User and record ids of the VLRs with WKT.
_WKT = ((PROJECTION, 2112), (b"liblas", 2112))
# Difference of the map's scale from 1 above which a warning names it: twice the difference at the edges of UTM zones.
_NAMED_SCALE = 0.001
# Scale, as a difference from 1, above which lengths are corrected to meters on the ground. No system for surveys
# reaches it within its area; world Mercator does from 8 degrees of latitude on.
_GROUND_SCALE = 0.01
# Largest ratio of the scales of two directions: 1.06 at the edges of maps of continents, 1.007 in
# the spherical Mercator.
_LARGEST_DISTORTION = 1.1
# Scales are rounded to multiples of this, so that parts of one cloud have the same scale.
_STEP = 1e-4
# Distance (m) of the positions that the scale is measured by from the middle, and the directions to them.
_APART, _CROSS = 50.0, np.array([[1, 0], [-1, 0], [0, 1], [0, -1]])
# Squared eccentricity of the ellipsoids of WGS 84 and GRS 1980: all others are within 0.02 % of it.
_ECCENTRICITY = 1 - (POLAR_RADIUS / EQUATORIAL_RADIUS) ** 2

# A code, and the code of the vertical system.
_CODE = re.compile(r"[A-Za-z]{3,}:\w+(\+\d+)?")
# Units of two readings of a system are one if they differ by no more than this share: US and international feet are.
_SAME_UNIT = 1e-5

# The same sentence for every input, so that a chain shows it once, as later steps inherit the lack.
NO_CRS = "The input has no coordinate reference system; its coordinates are taken as meters."
_ONLY_UNIT = "The input names a unit and no coordinate reference system; results have none either."
_UNNAMED = "The coordinate reference system of the input has no definition that can be written; results name none."


@dataclass(frozen=True)
class Crs:
    """A coordinate reference system; it travels to other processes, which need no authority then."""

    stated: str = ""  #: What the file says: WKT as it is, else "EPSG:code", else ""
    wkt: str = ""  #: The whole system as WKT, heights included; "" if unknown
    plane: str = ""  #: Its horizontal part: "EPSG:code" or WKT, "" if unknown
    code: str = ""  #: Code of the whole system, else of its horizontal part, "" without any
    identity: str = ""  #: The same text for one plane, however it is written; "" without a system
    horizontal: float = 1.0  #: Meters on the ground per unit in plan
    vertical: float = 1.0  #: Meters per unit of heights
    warnings: tuple[str, ...] = ()  #: Sentences for the user

    @property
    def factors(self) -> np.ndarray:
        """Meters per unit of x, y and z, (3,)."""
        return np.array([self.horizontal, self.horizontal, self.vertical])

    @property
    def title(self) -> str:
        """The system in a sentence."""
        name = self.code or (self.plane.split('"')[1] if '"' in self.plane else self.identity)
        return shown(name, 40) if self.identity else "none"

    def report(self, monitor: Monitor) -> None:
        """Warn of unknown and unusual facts, and say so where the unit is not the meter."""
        for warning in self.warnings:
            monitor.warn(warning)
        if self.horizontal != 1.0 or self.vertical != 1.0:
            monitor.inform(
                f"A unit of the coordinates is {self.horizontal:.6g} m, of heights {self.vertical:.6g} m; parameters, "
                "the log and attributes are in meters."
            )


# Makes the record of a file.
CrsReader = Callable[[Header], Crs]


def read_crs(header: Header, authority: Optional[Authority] = None, given: str = "") -> Crs:
    """Return the coordinate reference system of a file.

    WKT counts before GeoKeys, but in formats 0 to 5 whose header names GeoKeys. A file that names no system takes the
    system of the virtual point cloud that lists it, else the given one.

    Parameters
    ----------
    header : Header
        With the file's VLRs and bounds.
    authority : Authority, optional
        Makes the system; by default the one of this process. Without any, only units are known.
    given : str
        WKT or "EPSG:code" of files that name no system.

    Raises
    ------
    ValueError
        If coordinates are degrees or geocentric, or not true to scale in any direction.
    """
    keys, wkt, text = GeoKeys(header), stated_wkt(header), header.named or given
    if authority is None and (wkt or text or keys.defines_system):
        authority = authority_here()
    # Files that have only the one that their bit does not name are common.
    if wkt and keys.defines_system and header.layout.is_old and not header.encoding & WKT_BIT:
        wkt = ""
    crs = crs_of_text(wkt, authority)
    if not crs.identity:
        other = _crs_of_keys(keys, authority) if keys.defines_system or not text else crs_of_text(text, authority)
        crs = replace(other, warnings=(*(crs.warnings if wkt else ()), *other.warnings))
    return _on_the_ground(crs, header, authority) if authority and crs.plane else crs


def crs_of_text(text: str, authority: Optional[Authority] = None) -> Crs:
    """Return the coordinate reference system of WKT, "EPSG:code" or "", see :func:`read_crs`."""
    if not text:
        return Crs(warnings=(NO_CRS,))
    if '"' not in text and not _CODE.fullmatch(text):
        # Refuse such texts, as libraries would open them as addresses or names of files.
        return _unread(text)
    mended, warnings = with_named_units(text)
    known, is_code = authority.define(mended) if authority else None, '"' not in text
    units = units_of_wkt(mended) or (units_of_wkt(known.wkt) if known else None)
    if units is None and not is_code:
        return _unread(text)
    if units is None:
        warnings = (*warnings, _without_unit(text))
    elif authority and not (known and known.plane):
        warnings = (*warnings, _UNNAMED)
    wkt = known.wkt if known and is_code else "" if is_code else mended
    return _crs(text, wkt, known, _identity(known, text), units, warnings)


def _unread(text: str) -> Crs:
    return Crs(text, warnings=(f"The WKT of the file can't be read ({shown(text, 40)}); assign its CRS again.",))


def _crs_of_keys(keys: GeoKeys, authority: Optional[Authority]) -> Crs:
    """Return the system of a file with GeoKeys, or with nothing."""
    if not keys.defines_system:
        units, warnings = keys.units(None) if keys else (None, ())
        return Crs("", "", "", "", "", *(units or Units()), (*warnings, _ONLY_UNIT if units else NO_CRS))
    code = keys.code
    known = authority.define("", keys.records) if authority else None
    if authority and known is None and code:
        # Many files have the code of a vertical datum in place of the code of a vertical system.
        known = authority.define(keys.text) or authority.define(f"EPSG:{code}")
    of_system = units_of_wkt(known.wkt) if known else None
    units, warnings = keys.units(of_system)
    stated = f"EPSG:{code}" if code else ""
    if units is None:
        warnings = (*warnings, _without_unit(stated))
    elif of_system and not np.isclose(units.horizontal, of_system.horizontal, rtol=_SAME_UNIT):
        # The system of that code is not the one of the file.
        known, stated = None, ""
    if known is None and not (code and authority is None):
        warnings = (*warnings, _UNNAMED)
    identity = _identity(known, stated or f"GeoKeys {sorted(keys.items())}")
    wkt = _with_heights(known.wkt, units or Units()) if known else ""
    return _crs(stated, wkt, known, identity, units, warnings)


def _without_unit(text: str) -> str:
    return f"The file gives {shown(text)} and no unit; its coordinates are taken as meters."


def _with_heights(wkt: str, units: Units) -> str:
    """Return the WKT of a system with heights in their unit where it has others; "" where that can't be written."""
    own = units_of_wkt(wkt)
    if own and np.allclose(own, units, rtol=_SAME_UNIT):
        return wkt
    plane = wkt[wkt.find("PROJCS[") :].partition(",VERT_CS[")[0]
    if not plane.startswith("PROJCS["):
        return ""
    height = f'UNIT["{name_of_length(units.vertical)}",{units.vertical!r}],AXIS["Up",UP]'
    name = plane.split('"')[1]
    return f'COMPD_CS["{name} + heights",{plane},VERT_CS["heights",VERT_DATUM["unknown",2005],{height}]]'


def _crs(
    stated: str, wkt: str, known: Optional[Definition], identity: str, units: Optional[Units], warnings: tuple[str, ...]
) -> Crs:
    plane, code = (known.plane, known.code) if known else ("", "")
    return Crs(stated, wkt, plane, code, identity, *(units or Units()), warnings)


def _identity(known: Optional[Definition], text: str) -> str:
    """Return the text that a plane is compared by; of WKT that no authority knows, its own code, else all of it."""
    if known:
        return known.identity
    code = re.search(r'(?:AUTHORITY|ID)\["EPSG","?(\d+)"?\]\]\s*$', text)
    return f"EPSG:{code[1]}" if code else re.sub(r"\s", "", text)


def _on_the_ground(crs: Crs, header: Header, authority: Authority) -> Crs:
    """Return the system with its unit in meters on the ground: corrected by the scale of the map in the middle."""
    if not (header.low.any() or header.high.any()) or not np.isfinite([header.low, header.high]).all():
        return crs
    middle, step = (header.low[:2] + header.high[:2]) / 2, _APART / crs.horizontal
    radians, area = authority.to_radians(crs.plane, middle + step * _CROSS)
    longitude, latitude = radians.T
    if not np.isfinite([longitude, latitude]).all():
        return crs
    across = 1 - _ECCENTRICITY * np.sin(latitude.mean()) ** 2
    radii = EQUATORIAL_RADIUS / np.sqrt(across) * np.array([[np.cos(latitude.mean())], [(1 - _ECCENTRICITY) / across]])
    on_ground = radii * np.array([np.unwrap(longitude), latitude]) @ _CROSS / (2 * _APART)
    high, low = 1 / np.maximum(np.linalg.svd(on_ground, compute_uv=False)[::-1], _STEP)
    is_within = area is None or area.holds(*np.degrees(radians[0]))
    if is_within and high / low > _LARGEST_DISTORTION:
        raise ValueError(
            f"The map of {crs.title} stretches lengths by direction here; reproject the cloud to a local system."
        )
    scale = round(np.sqrt(high * low) / _STEP) * _STEP
    here = f"A meter on the ground is {scale:.4f} m on the map of {crs.title} here"
    if is_within and abs(scale - 1) >= _GROUND_SCALE:
        warning = f"{here}; lengths, areas and volumes are those on the ground."
        return replace(crs, horizontal=crs.horizontal / scale, warnings=(*crs.warnings, warning))
    if max(high - 1, 1 - low) > _NAMED_SCALE:
        between = "" if high - low < _NAMED_SCALE else f" ({low:.4f} to {high:.4f} by direction)"
        outside = "" if is_within else ", which is not made for this place"
        warning = f"{here}{between}{outside}; lengths, areas and volumes are those on the map."
        return replace(crs, warnings=(*crs.warnings, warning))
    return crs


def common_crs(systems: Sequence[Crs], names: Sequence[str], monitor: Monitor, whole: bool = True) -> Crs:
    """Return the system of several clouds: the first that is named; clouds that name none are taken to have it.

    Parameters
    ----------
    systems : sequence of Crs
        Of each cloud.
    names : sequence of str
        What each cloud is called in sentences.
    monitor : Monitor
        Is warned of clouds that name none while others do.
    whole : bool
        Heights must have one unit, too.

    Raises
    ------
    ValueError
        If two have different ones.
    """
    first = next((at for at, crs in enumerate(systems) if crs.identity), None)
    if first is None:
        return systems[0]
    leader = systems[first]
    for crs, name in zip(systems, names):
        if not crs.identity:
            monitor.warn(
                f"{name} names no coordinate reference system; it is taken to be in the system of {names[first]}."
            )
            continue
        differs = crs.identity != leader.identity
        if differs or (whole and not np.isclose(crs.vertical, leader.vertical, rtol=1e-7)):
            heights = "" if differs else " with heights in units of {:.6g} m"
            one, other = (system.title + heights.format(system.vertical) for system in (leader, crs))
            raise ValueError(
                f"{names[first]} and {name} have different coordinate reference systems ({one}, {other}); "
                "reproject them to one first."
            )
    return leader


def crs_of_tiles(headers: Sequence[Header], names: Sequence[str], read: CrsReader, monitor: Monitor) -> Crs:
    """Return the one system of the files of a cloud, with the scale in the middle of all.

    Parameters
    ----------
    headers : sequence of Header
        Of the files.
    names : sequence of str
        Names of the files in sentences.
    read : callable
        Makes the system of a header.
    monitor : Monitor
        As for :func:`common_crs`, which raises the errors.
    """
    nowhere = np.zeros(3)
    systems = [read(replace(header, low=nowhere, high=nowhere)) for header in headers]
    leader = headers[systems.index(common_crs(systems, names, monitor))]
    low, high = ([getattr(header, name) for header in headers] for name in ("low", "high"))
    return read(replace(leader, low=np.min(low, axis=0), high=np.max(high, axis=0)))


def header_with_crs(header: Header, crs: Crs) -> Header:
    """Return the header of a file that is written in a system: with its records where they lack or can't count."""
    own, keys = stated_wkt(header), GeoKeys(header)
    if header.layout.is_old:
        if own or keys.defines_system or not crs.identity:
            return header
        code = crs.plane if is_epsg_code(crs.plane) and crs.vertical == crs.horizontal else ""
        vlrs, bits = crs_records(code or crs.wkt or crs.stated)
        return replace(header, vlrs=[*header.vlrs, *vlrs], encoding=header.encoding | bits)
    if '"' in crs.wkt and own != crs.stated:
        vlrs, _ = crs_records(crs.wkt)
        kept = header.without(*_WKT)
        return replace(kept, vlrs=[*kept.vlrs, *vlrs], encoding=kept.encoding | WKT_BIT)
    # Where there are both, other programs go by the bit.
    return replace(header, encoding=header.encoding | WKT_BIT) if own and keys else header


def crs_records(text: str) -> tuple[list[Vlr], int]:
    """Return the VLRs that store ``text`` (WKT, "EPSG:code" or ""), and its bits of the global encoding."""
    if text and '"' not in text:
        if not is_epsg_code(text):
            raise ValueError(f"The CRS {text!r} can't be stored; give WKT or EPSG:code.")
        return [geokeys_record(int(text[5:]))], 0
    return ([Vlr(*_WKT[0], text.encode() + b"\0", description=b"WKT")] if text else []), WKT_BIT


def storable(named: Any) -> str:
    """Return the system that a catalog names, "" if the VLR of a file can't hold that text and the zero behind it."""
    try:
        return named if isinstance(named, str) and len(named.encode()) < LARGEST_VLR else ""
    except UnicodeEncodeError:  # JSON may have halves of characters, files can't.
        return ""


def is_epsg_code(text: str) -> bool:
    """Whether a text is a code that GeoKeys can hold."""
    return text.upper().startswith("EPSG:") and text[5:].isdecimal() and 0 < int(text[5:]) < USER_DEFINED


def stated_wkt(header: Header) -> str:
    """Return the WKT in a file, "" without any; one that no VLR holds is damage, and would take seconds to parse."""
    for key in _WKT:
        record = header.find(key)
        if record is not None and record.data and len(record.data) <= LARGEST_VLR:
            return record.data.split(b"\0")[0].decode("utf-8", "replace").strip()
    return ""
