"""STAC items in JSON that name the tiles of one cloud: virtual point clouds, other collections, and single items."""

import json
import os
import re
from dataclasses import replace
from datetime import datetime, timezone
from pathlib import Path
from typing import Any, Callable, NamedTuple, Optional, cast
from urllib.parse import unquote, urlsplit

import numpy as np

from ..stage import Monitor
from .catalog_json import read_json
from .crs import Crs, stated_wkt, storable
from .header import LARGEST_STEP, OF_OLD_FILES, WAVEFORMS, WKT_BIT, Header, Vlr
from .outputs import COPC, EPT, LAS, LAZ, kind_of, replacing, stem_of
from .point_records import fill_merged, merged_layout
from .points import open_header, points_within, read_chunks, thinned
from .printable import shown
from .web_addresses import is_address, is_allowed, split_address
from .web_file import WebFile, fetch_files, is_on_web

# Role by which a STAC item marks the assets that are its point clouds.
_DATA_ROLE = "data"
# How a URI of a file begins, up to the path on this computer; and the slash before a drive of Windows in it.
_FILE = re.compile("^file:(?://(?:localhost)?(?=/))?", re.IGNORECASE)
_BEFORE_DRIVE = re.compile("^/(?=[A-Za-z]:/)")
# Most files that STAC items come in, and most items: ten times as many as the largest survey that is run as one.
_MOST_PAGES, _MOST_ITEMS = 500, 50_000
# Links of a page or a collection that lead to more items.
_LEADS = ("next", "items", "item")
# STAC extensions that define the properties "pc:…" and "proj:…".
_EXTENSIONS = (
    "https://stac-extensions.github.io/pointcloud/v1.0.0/schema.json",
    "https://stac-extensions.github.io/projection/v1.1.0/schema.json",
)

# Dimensions that PDAL calls otherwise than laspy; all others differ in underscores and capitals alone.
_PDAL_NAMES = {"scan_angle": "ScanAngleRank", "nir": "Infrared"}

ToDegrees = Callable[[np.ndarray], np.ndarray]


class Named(NamedTuple):
    """What a STAC item says of its point cloud."""

    crs: str = ""  #: Its CRS (WKT or "EPSG:code"), "" where none is named
    #: (2, 2): least and greatest easting and northing in that system, None where they are not named
    box: Optional[np.ndarray] = None


def tiles_of(path: Path) -> dict[Path, Named]:
    """Return the tiles that a virtual point cloud or other STAC items name, in their order, with CRS and box of each.

    Items may come in pages, each of which leads to the next one, and a collection may lead to its items.

    Raises
    ------
    ValueError
        If a file has no such items or is far too large, if tiles are missing or on hosts that are not allowed, or if
        there are too many pages or items.
    """
    tiles: dict[Path, tuple[Path, Named]] = {}
    waiting, seen, n_items = [path], {path}, 0
    while waiting:
        fetch_files(waiting, Monitor())
        following: dict[Path, None] = {}
        for page in waiting:
            hrefs, leads = _content_of(page)
            n_items += len(hrefs)
            # A tile that is named twice is read once, whichever way it is named.
            named = ((_tile(page, href), said) for href, said in hrefs.items())
            tiles.update({tile.resolve(): (tile, said) for tile, said in named})
            following.update(dict.fromkeys(_page(page, link) for link in leads))
        waiting = [page for page in following if page not in seen]
        seen.update(waiting)
        if len(seen) > _MOST_PAGES or n_items > _MOST_ITEMS:
            raise ValueError(
                f"{path.name} leads to more than {_MOST_PAGES} pages or {_MOST_ITEMS:,} items; ask for the items of an "
                "extent (bbox=…)."
            )
    if not tiles:
        raise ValueError(f"{path.name} names no tiles; build it again.")
    return dict(tiles.values())


def _content_of(page: Path) -> tuple[dict[str, Named], list[dict]]:
    """Return the tiles that a page names, their properties, and its links to other pages."""
    content = read_json(page)
    try:
        leads = [link for link in content.get("links") or () if link.get("rel") in _LEADS]
        # What leads to its items has none of its own.
        items = content.get("features", [] if leads else [content])
        return {href: _named(one.get("properties")) for one in items for href in _hrefs(one["assets"])}, leads
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        raise ValueError(
            f"{page.name} is not a virtual point cloud: it is no STAC item or feature collection with assets."
        ) from None


def _page(page: Path, link: dict) -> Path:
    """Return the page that a link leads to.

    Raises
    ------
    ValueError
        If it must be asked for otherwise than by its address, or lies on a host that is neither the page's nor allowed.
    """
    href = str(link.get("href"))
    if link.get("method", "GET") == "GET":
        if is_on_web(page):
            leads = cast(WebFile, page).beside(href)
            if leads.host == cast(WebFile, page).host or is_allowed(leads.address):
                return cast(Path, leads)
        elif is_address(href) and is_allowed(href):
            return cast(Path, WebFile(href))
    raise ValueError(
        f"{page.name} is one page of several, and the next one, {shown(href)}, is not read; ask for all at once "
        "(limit=…), or allow its host in the options of Processing ('Hosts that files may name point clouds of')."
    )


def _named(properties: Any) -> Named:
    """Return the facts on a point cloud in the properties of its STAC item."""
    found = properties if isinstance(properties, dict) else {}
    wkt, code = found.get("proj:wkt2"), found.get("proj:code") or found.get("proj:epsg")
    coded = f"EPSG:{code}" if isinstance(code, int) else code if isinstance(code, str) else ""
    numbers = found.get("proj:bbox")
    try:
        ends = np.array(numbers, float).reshape(2, -1) if numbers else np.empty((0, 0))
    except (TypeError, ValueError, OverflowError):
        ends = np.empty((0, 0))
    is_box = ends.shape in ((2, 2), (2, 3)) and np.isfinite(ends).all()
    return Named(storable(wkt) or coded, ends[:, :2] if is_box else None)


def _hrefs(assets: dict) -> list[str]:
    """Return the point clouds of one feature; overviews repeat points of the tiles and are left out."""
    all_of_them = list(assets.values())
    # Items of catalogs have pictures and metadata, too.
    clouds = [one for one in all_of_them if _is_cloud(str(one["href"]))] or all_of_them
    data = [one for one in clouds if _DATA_ROLE in (one.get("roles") or ())]
    return [str(one["href"]) for one in (data or clouds[:1])]


def _is_cloud(href: str) -> bool:
    """Whether the name of a tile, a path or an address, ends as one of a file of points."""
    return kind_of(Path(urlsplit(href).path if is_address(href) else href)) in (LAS, LAZ, COPC, EPT)


def _tile(path: Path, href: str) -> Path:
    if is_on_web(path):
        tile = cast(WebFile, path).beside(href)
        if not _is_cloud(tile.address):
            raise ValueError(f"{path.name} names the tile {shown(href)}, which is no LAS, LAZ or COPC file.")
        return cast(Path, tile)
    if is_address(href) and _is_cloud(href):
        if not is_allowed(href):
            raise ValueError(
                f"{path.name} names the tile {shown(href)}, which is on the web; allow it in the options of Processing "
                f"(add {split_address(href).hostname} to 'Hosts that files may name point clouds of')."
            )
        return cast(Path, WebFile(href))
    names = _meanings(href)
    # On Windows, merely looking for a file on another computer sends it the name and a hash of the password.
    if any("://" in name or name.startswith("//") for name in names[1:]):
        why = "is not a local file; download it and"
    elif kind_of(Path(names[-1])) not in (LAS, LAZ, COPC, EPT):
        why = "is no LAS, LAZ or COPC file; leave it out and"
    else:
        for name in names:
            if os.path.isfile(path.parent / name):  # noqa: PTH113 - names too long are missing
                return path.parent / name
        why = "is missing; put it back or"
    raise ValueError(f"{path.name} names the tile {shown(href)}, which {why} build {path.name} again.")


def _meanings(href: str) -> list[str]:
    """Return the possible readings of an href: a name as it is, as in QGIS; a path of Windows; and a URI."""
    path = _FILE.sub("", href.replace("\\", "/"))
    return [href, *(_BEFORE_DRIVE.sub("", one) for one in (path, unquote(path).replace("\\", "/")))]


def write_vpc(tiles: list[Path], path: Path, to_degrees: Optional[ToDegrees] = None, crs: Optional[Crs] = None) -> None:
    """Write a virtual point cloud that names ``tiles``; paths are relative to its folder where they can be.

    Parameters
    ----------
    tiles : list of Path
        LAS, LAZ or COPC files of one coordinate reference system.
    path : Path
        The .vpc file; it appears when it is complete.
    to_degrees : callable, optional
        Turns coordinates (n, 2) of the tiles into longitude and latitude (n, 2), by which catalogs look tiles up;
        without it they stay as they are.
    crs : Crs, optional
        The one of the tiles; by default what each file states.

    Raises
    ------
    ValueError
        If a tile can't be read or the file can't be written.
    """
    features = [_feature(tile, path.parent, to_degrees, crs) for tile in tiles]
    with replacing(path) as stream:
        stream.write(json.dumps({"type": "FeatureCollection", "features": features}, indent=1).encode())


def _feature(tile: Path, folder: Path, to_degrees: Optional[ToDegrees], crs: Optional[Crs]) -> dict:
    """Return the STAC item of a tile."""
    header = open_header(tile)
    low, high = header.low, header.high
    corners = np.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]], [low[0], low[1]]])
    geographic = corners if to_degrees is None else to_degrees(corners)
    return {
        "type": "Feature",
        "stac_version": "1.0.0",
        "stac_extensions": list(_EXTENSIONS),
        "id": stem_of(tile),
        "geometry": {"type": "Polygon", "coordinates": [geographic.tolist()]},
        "bbox": [*geographic.min(axis=0).tolist(), float(low[2]), *geographic.max(axis=0).tolist(), float(high[2])],
        "properties": {
            "datetime": datetime.fromtimestamp(tile.stat().st_mtime, timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
            "pc:count": header.count,
            "pc:encoding": "LASzip" if header.is_compressed else "LAS",
            "pc:type": "lidar",
            "pc:schemas": _schemas(header),
            "proj:bbox": [*low.tolist(), *high.tolist()],
            "proj:wkt2": crs.wkt or crs.stated if crs else stated_wkt(header),
            "proj:geometry": {"type": "Polygon", "coordinates": [corners.tolist()]},
        },
        "links": [],
        "assets": {"data": {"href": _href(tile, folder), "roles": [_DATA_ROLE]}},
    }


def _schemas(header: Header) -> list[dict]:
    """Return the dimensions of the points of a tile, by the names that QGIS and PDAL know them by."""
    kinds, layout = {"f": "floating", "u": "unsigned", "i": "signed"}, header.layout
    fields = layout.standard.fields or {}
    # Bit fields share bytes.
    stored = {name: fields[name][0] if name in fields else np.dtype(np.uint8) for name in layout.names}
    named = {_PDAL_NAMES.get(name, name.title().replace("_", "")): dtype for name, dtype in stored.items()}
    named.update(dict.fromkeys("XYZ", np.dtype(float)))
    named.update({extra.name: extra.dtype for extra in layout.extras if extra.is_scalar and extra.name})
    return [{"name": name, "size": dtype.itemsize, "type": kinds[dtype.kind]} for name, dtype in named.items()]


def _href(tile: Path, folder: Path) -> str:
    tile, folder = tile.resolve(), folder.resolve()
    return f"./{tile.relative_to(folder).as_posix()}" if folder in tile.parents else str(tile)


def read_tiles(
    paths: list[Path], headers: list[Header], monitor: Monitor, box: Optional[np.ndarray] = None
) -> tuple[Header, np.ndarray]:
    """Return all tiles as one cloud, tile after tile: its header and its records.

    The merged cloud has the finest scale of the tiles, all their dimensions and all their VLRs, the first tile's first.

    Parameters
    ----------
    paths : list of Path
        The tiles.
    headers : list of Header
        Of each.
    monitor : Monitor
        Receives progress.
    box : ndarray of shape (2, 2), optional
        Least and greatest easting and northing in the coordinates of the tiles: only points within are kept, thinned
        where the headers ask for a spacing, and only tiles whose headers meet the box are read.

    Raises
    ------
    ValueError
        If tiles span more than their scale can store.
    """
    header = merged_header(headers, "tiles", monitor)
    if box is not None:
        return header, _within(paths, headers, header, box, monitor)
    points = np.zeros(header.count, header.layout.dtype)
    start = 0
    for path, tile in zip(paths, headers):
        part = monitor.part(start / header.count, (start + tile.count) / header.count)
        for at, chunk in read_chunks(path, tile, part):
            fill_merged(points[start + at : start + at + len(chunk)], chunk, tile, header)
        start += tile.count
    return header, points


def _within(paths: list[Path], headers: list[Header], merged: Header, box: np.ndarray, monitor: Monitor) -> np.ndarray:
    """Return the records of all tiles that lie within a box, as records of the merged cloud."""
    found = [np.empty(0, merged.layout.dtype)]
    for path, tile, part in zip(paths, headers, monitor.parts(len(paths))):
        records = points_within(path, tile, box, part)
        found.append(np.zeros(len(records), merged.layout.dtype))
        fill_merged(found[-1], records, tile, merged)
    return thinned(np.concatenate(found), merged)


def merged_header(headers: list[Header], what: str, monitor: Monitor) -> Header:
    """Return one header for all points of several files or clouds: with the finest scale and all fields.

    The headers have true bounds, in one coordinate system; ``what`` is their name in sentences to the user ("tiles").
    The monitor receives warnings about parts that can't be merged.

    Raises
    ------
    ValueError
        If they span more than their scale can store.
    """
    first = headers[0]
    if any(header.find(WAVEFORMS) or header.has_waveforms_outside for header in headers):
        monitor.warn(f"The waveforms of the {what} are not merged; their references are kept.")
    # The first bit says how GPS time is counted.
    if any((header.encoding ^ first.encoding) & 1 for header in headers):
        monitor.warn(f"The {what} count GPS time in different ways; the values are kept as they are.")
    layout = merged_layout([header.layout for header in headers])
    scale, offset = _grid(headers, what)
    reduced = [header.without(*OF_OLD_FILES) for header in headers]
    merged = replace(
        reduced[0],
        minor=max(header.minor for header in headers),
        count=sum(header.count for header in headers),
        encoding=first.encoding if layout.is_old else first.encoding | WKT_BIT,
        scale=scale,
        offset=offset,
        vlrs=_union([header.vlrs for header in reduced]),
        evlrs=_union([header.evlrs for header in reduced]),
        waveforms_at=0,
        user_bytes=b"",
        gap=b"",
    )
    return merged.with_layout(layout)


def _union(lists: list[list[Vlr]]) -> list[Vlr]:
    """Return the first list and, of the others, the records with a user and record id not seen before."""
    records = list(lists[0])
    for added in (record for others in lists[1:] for record in others):
        if all(record.key != added.key for record in records):
            records.append(added)
    return records


def _grid(headers: list[Header], what: str) -> tuple[np.ndarray, np.ndarray]:
    """Return scale and offset that hold all tiles: the first's offset if the finest scale reaches from there."""
    scale = np.min([header.scale for header in headers], axis=0)
    low = np.min([header.low for header in headers], axis=0)
    high = np.max([header.high for header in headers], axis=0)
    offset = headers[0].offset.copy()
    far = np.maximum(np.abs(low - offset), np.abs(high - offset)) > scale * LARGEST_STEP
    offset[far] = np.round((low + high)[far] / 2)
    if (np.maximum(offset - low, high - offset) > scale * LARGEST_STEP).any():
        span, step = (high - low).max(), scale.min()
        raise ValueError(f"The {what} span {span:.0f} units, too far for their scale {step:g}; take fewer.")
    return scale, offset
