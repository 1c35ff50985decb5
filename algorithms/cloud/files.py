"""Reading point clouds from files, and writing them."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import BinaryIO, Optional, Union

import numpy as np

from ..stage import Monitor
from .cloud import Cloud
from .copc import copc_header, write_copc
from .copc_sidecar import VIEW_SOFTWARE, check_copc_beside, copc_path, seal
from .crs import Crs, CrsReader, crs_of_tiles, header_with_crs, read_crs
from .header import OF_OLD_CHUNKS, OF_OLD_POINTS, Header
from .laspy_library import need_lazrs
from .laz import writing_backend
from .outputs import COPC, LAZ, STAC, VPC, check_output, kind_of, replacing
from .point_formats import Layout
from .point_records import PointRecords, merged_layout
from .points import (
    EVERYWHERE,
    check_count,
    check_points,
    has_octree,
    may_hold,
    open_headers,
    points_within,
    read_points,
    size_within,
    write_points,
)
from .vpc import Named, read_tiles, tiles_of
from .web_file import file_at, is_on_web

# A box that no file touches, to read only the header of the first file on the web.
NOWHERE = np.full((2, 2), np.nan)

# One sentence for every step of a chain.
_WAVEFORMS_APART = (
    "The waveforms of the input are in a file of their own (.wdp), which is not copied; "
    "copy it next to the output and give it the output's name."
)


def read_cloud(
    path: Union[str, Path],
    monitor: Optional[Monitor] = None,
    read: CrsReader = read_crs,
    box: Optional[np.ndarray] = None,
    spacing: Optional[np.ndarray] = None,
) -> Cloud:
    """Read a LAS, LAZ or COPC file, Entwine point tiles, or all tiles of a virtual point cloud (VPC) or of STAC items.

    Parameters
    ----------
    path : str or Path
        Its extension (.las, .laz, .vpc, .json) says what it is; Entwine point tiles are described by their ept.json.
    monitor : Monitor, optional
        Receives progress, and warnings about units.
    read : callable
        Makes the coordinate reference system of a header; in QGIS by its libraries.
    box : ndarray of shape (2, 2), optional
        Least and greatest easting and northing, in coordinates of the file: only points within are kept, edges
        included, and only these need memory.
    spacing : ndarray of shape (3,), optional
        Sides of cubes, in units of the file: of each only the lowest point is kept. Of COPC and Entwine point tiles
        only the levels that are coarse enough are read, which leave out most points of dense clouds beforehand.

    Returns
    -------
    Cloud
        All points, or all in the box at the spacing, with all dimensions.

    Raises
    ------
    ValueError
        In one sentence, whatever is wrong with the file; or if there are no points in the box.
    """
    path, monitor = file_at(path), monitor or Monitor()
    box = EVERYWHERE if box is None and spacing is not None else box
    with readable(path):
        files = list(touching(named_files_of(path), box))
        states = [state_of(file) for file in files]
        with_points, headers = _opened(path, box, spacing, monitor)
        crs = crs_of_tiles(headers, [file.name for file in with_points], read, monitor)
        with_points, headers = _near(with_points, headers, box)
        header = headers[0]
        if len(with_points) == 1:
            file = with_points[0]
            points = read_points(file, header, monitor) if box is None else points_within(file, header, box, monitor)
            header = header.without(*(OF_OLD_CHUNKS if box is None else OF_OLD_POINTS))
        else:
            header, points = read_tiles(with_points, headers, monitor, box)
        if [state_of(file) for file in files] != states:
            raise ValueError(f"{path.name} has changed while it was read; run it again when it is complete.")
    if not len(points):
        raise ValueError(f"{path.name} has no points within the extent; choose another extent.")
    if spacing is not None:
        total = sum(header.count for header in headers)
        side = spacing[0] * crs.horizontal
        monitor.inform(f"{path.name}: {len(points):,} of {total:,} points are used, one of each cube of {side:g} m.")
    header = header if box is None else replace(header, count=len(points))
    crs.report(monitor)
    return Cloud(header, points, crs, files if files == [path] else [*files, path])


def state_of(path: Path) -> tuple[int, int]:
    """Return the state of a file, which changes when it is written: its size, and when it was written (ns).

    Raises
    ------
    ValueError
        If the system does not say.
    """
    with readable(path):
        stat = path.stat()
    return stat.st_size, stat.st_mtime_ns


def dimension_names(path: Union[str, Path]) -> list[str]:
    """Return the names of the dimensions of a file, without reading its points; of the first tile of several.

    Raises
    ------
    ValueError
        In one sentence, what is wrong with the file.
    """
    path = file_at(path)
    with readable(path):
        header = next(iter(open_headers(list(named_files_of(path))[:1])[1]))
    return Cloud(header, np.zeros(1, header.layout.dtype), Crs()).dimension_names


def check_readable(path: Union[str, Path], box: Optional[np.ndarray] = None) -> None:
    """Refuse what :func:`read_cloud` would refuse, as far as headers and chunk tables show.

    Raises
    ------
    ValueError
        In one sentence, what is wrong with the file or with a tile of it.
    """
    path = file_at(path)
    with readable(path):
        for file, header in zip(*_opened(path, box=box)):
            read_crs(header)
            check_points(file, header)


def read_extent(
    path: Union[str, Path], read: CrsReader = read_crs, box: Optional[np.ndarray] = None
) -> tuple[np.ndarray, np.ndarray, Crs]:
    """Return the lowest and the highest coordinates (3,) and the CRS of a file or of all its tiles.

    Coordinates are as in the file's headers. With a ``box`` (2, 2) tiles on the web count only if they may
    have points in it.

    Raises
    ------
    ValueError
        In one sentence, what is wrong with the file or with a tile of it.
    """
    files, headers = _opened(file_at(path), box=box)
    crs = crs_of_tiles(headers, [file.name for file in files], read, Monitor())
    low, high = ([getattr(header, name) for header in headers] for name in ("low", "high"))
    return np.min(low, axis=0), np.max(high, axis=0), crs


def count_points(path: Union[str, Path], box: Optional[np.ndarray] = None, spacing: Optional[np.ndarray] = None) -> int:
    """Return the number of points of a file or of all its tiles, by the headers.

    In a ``box`` (2, 2), coordinates of the file, points count as spread evenly over each tile. With a ``spacing``
    (3,) octrees count as far as they are read.

    Raises
    ------
    ValueError
        In one sentence, what is wrong with the file or with a tile of it.
    """
    found = []
    for file, header in zip(*_opened(file_at(path), box, spacing)):
        is_thinned = spacing is not None and has_octree(file, header)
        found.append(size_within(file, header, box)[0] if is_thinned else header.count * _share_in(header, box))
    return round(sum(found))


def sizes_within(
    path: Union[str, Path], box: Optional[np.ndarray] = None, spacing: Optional[np.ndarray] = None
) -> list[tuple[Path, tuple[int, int]]]:
    """Return the numbers of points and bytes read of a file on the web, or of each such tile.

    They are those for a box (2, 2) and a spacing (3,), as of :func:`read_cloud`.

    Raises
    ------
    ValueError
        In one sentence, what is wrong with the file or with a tile of it.
    """
    found = zip(*_near(*_opened(file_at(path), box, spacing), box))
    with readable(file_at(path)):
        return [(file, size_within(file, header, box)) for file, header in found if is_on_web(file)]


def _share_in(header: Header, box: Optional[np.ndarray]) -> float:
    """Return the share of the extent of a file that a box holds, 1 without a box."""
    if box is None:
        return 1.0
    low, high = np.asarray(header.low)[:2], np.asarray(header.high)[:2]
    inside = np.minimum(high, box[1]) - np.maximum(low, box[0])
    if (inside < 0).any():
        return 0.0
    # A file without width on an axis lies within the box on it.
    return float(np.prod(np.divide(inside, high - low, out=np.ones(2), where=high > low)))


def _opened(
    path: Path, box: Optional[np.ndarray], spacing: Optional[np.ndarray] = None, monitor: Optional[Monitor] = None
) -> tuple[list[Path], list[Header]]:
    """Return a file, or all its tiles that have points and are to be opened for a box, and their headers."""
    with readable(path):
        return open_named(touching(named_files_of(path), box), monitor, box, spacing)


def open_named(
    named: dict[Path, Named], monitor: Optional[Monitor], box: Optional[np.ndarray], spacing: Optional[np.ndarray]
) -> tuple[list[Path], list[Header]]:
    """Return the files that have points, and their headers.

    Parameters
    ----------
    named : dict of Path to Named
        The files, with the CRS that a catalog gives each.
    monitor : Monitor, optional
        Receives progress.
    box, spacing
        As of :func:`read_cloud`.
    """
    files, headers = open_headers(list(named), monitor)
    crs = (named[file].crs for file in files)
    return files, [replace(header, named=own, reach=box, spacing=spacing) for header, own in zip(headers, crs)]


def touching(named: dict[Path, Named], box: Optional[np.ndarray]) -> dict[Path, Named]:
    """Return the files that are opened to read a box (2, 2): on the web those that may have points in it, else all.

    There is one at least, whose header says what the others are.
    """
    if box is None:
        return named
    found = {
        file: one
        for file, one in named.items()
        if one.box is None or not is_on_web(file) or ((one.box[0] <= box[1]) & (one.box[1] >= box[0])).all()
    }
    return found or dict([next(iter(named.items()))])


def _near(files: list[Path], headers: list[Header], box: Optional[np.ndarray]) -> tuple[list[Path], list[Header]]:
    """Return those files that may have points in a box (2, 2), by their headers; one at least."""
    if box is None:
        return files, headers
    rows = [row for row, header in enumerate(headers) if may_hold(header, box)] or [0]
    return [files[row] for row in rows], [headers[row] for row in rows]


@contextmanager
def readable(path: Path) -> Iterator[None]:
    """Say in one sentence why ``path`` can't be read where the block finds that out.

    Raises
    ------
    ValueError
        If the block fails with an error of the system.
    """
    try:
        yield
    except OSError as error:
        raise ValueError(
            f"{path} can't be read ({error.strerror or error}); check the file and its permissions."
        ) from error


def named_files_of(path: Path) -> dict[Path, Named]:
    """Return the files that hold the points of a cloud, itself or the tiles of a VPC, and what this says of them.

    Raises
    ------
    ValueError
        If it is no point cloud, or a tile is missing.
    """
    if path.is_dir():
        raise ValueError(f"{path} is a folder; choose a point cloud file in it.")
    # The addresses of items of a catalog have no extension.
    kind = kind_of(path) or (STAC if is_on_web(path) and not path.suffix else "")
    if not kind:
        raise ValueError(
            f"{path.name} is no point cloud that can be read; choose a .las, .laz, .copc.laz or .vpc file, ept.json, "
            "or STAC items (.json)."
        )
    if not path.is_file():
        raise ValueError(f"{path} does not exist; check the name.")
    return tiles_of(path) if kind in (VPC, STAC) else {path: Named()}


def write_cloud(
    cloud: Cloud, path: Union[str, Path], monitor: Optional[Monitor] = None, copc_beside: bool = False
) -> None:
    """Write a cloud as LAS, LAZ or COPC, as ``path`` ends in .las, .laz or .copc.laz.

    The file keeps point order (but in COPC), scale, offset, CRS, VLRs, EVLRs,
    extra bytes, waveform references and every dimension that was not set. It
    appears when it is complete; after a failure or cancel nothing is left.

    QGIS with PDAL shows a file x.copc.laz in place of the x.las or x.laz next to it. One that
    was written with the very file that is replaced is replaced or removed with it; next to any
    other, nothing is written.

    Parameters
    ----------
    cloud : Cloud
        Not changed.
    path : str or Path
        In an existing folder; none of the cloud's own files.
    monitor : Monitor, optional
        Receives progress, and warnings about changes by the format.
    copc_beside : bool
        Also write x.copc.laz next to x.las or x.laz, for QGIS to show.

    Raises
    ------
    ValueError
        In one sentence, why the file can't be written.
    """
    path, monitor = Path(path), monitor or Monitor()
    check_write(cloud, path, copc_beside)
    if kind_of(path) == COPC:
        _write_copc(cloud, path, monitor)
        return
    with replacing(path) as stream:
        _write_las(cloud, path, stream, monitor.part(0.0, 0.4) if copc_beside else monitor)
        if copc_beside:
            _write_copc(cloud, copc_path(path), monitor.part(0.4, 1.0), shown=stream)
    if not copc_beside:
        copc_path(path).unlink(missing_ok=True)


def check_write(cloud: Cloud, path: Union[str, Path], copc_beside: bool = False) -> None:
    """Refuse what :func:`write_cloud` would refuse, before a long computation rather than after it.

    Raises
    ------
    ValueError
        If the path can't be written or is a source of the cloud, or QGIS would show another file in its place.
    """
    path = Path(path)
    check_output(path, cloud.files)
    _check_packages(kind_of(path), cloud.records().layout)
    if copc_beside:
        need_lazrs()
    if kind_of(path) != COPC:
        check_copc_beside(path, cloud.files)


def check_compression(path: Path, clouds: Iterable[Path]) -> None:
    """Refuse an output that no installed package compresses, before clouds whose points it is to hold are read.

    Raises
    ------
    ValueError
        If a package is missing, or in one sentence, what is wrong with a cloud.
    """
    if kind_of(path) in (LAZ, COPC):
        layouts = [header.layout for cloud in clouds for header in _opened(cloud, None)[1]]
        _check_packages(kind_of(path), merged_layout(layouts or [Layout(6)]))


def _check_packages(kind: str, layout: Layout) -> None:
    """Refuse a kind of file that no installed package writes for points of a layout."""
    if kind == COPC:
        need_lazrs()
    if kind == LAZ:
        writing_backend(layout.point_format)


def _write_las(cloud: Cloud, path: Path, stream: BinaryIO, monitor: Monitor) -> None:
    """Write a LAS or LAZ file to a stream; the extension of ``path`` says which."""
    records = cloud.records()
    header = _output_header(cloud, records)
    if records.is_upgraded:
        monitor.warn(
            f"Classes over 31 don't fit point format {cloud.header.layout.point_format}; "
            f"{path.name} is written in format {records.layout.point_format} (LAS 1.4)."
        )
    if header.has_waveforms_outside:
        monitor.warn(_WAVEFORMS_APART)
    write_points(stream, header, lambda a, b: records.take(slice(a, b)), kind_of(path) == LAZ, monitor)
    check_count(stream, path, len(cloud))


def _write_copc(cloud: Cloud, path: Path, monitor: Monitor, shown: Optional[BinaryIO] = None) -> None:
    """Write a COPC file, as the view of the complete file in the stream ``shown`` if there is one."""
    records = cloud.records(for_copc=True)
    old, new = cloud.header.layout.point_format, records.layout.point_format
    if old != new:
        lost = "; its waveform references are left out" if cloud.header.layout.has_waveforms else ""
        report = monitor.warn if lost else monitor.inform
        report(f"COPC holds point formats 6 to 8 only: {path.name} is written in format {new} instead of {old}{lost}.")
    header = copc_header(_output_header(cloud, records))
    if shown is not None:
        header = replace(header, software=VIEW_SOFTWARE)
    with replacing(path) as stream:
        write_copc(stream, header, cloud.points, records.take, monitor)
        check_count(stream, path, len(cloud))
        if shown is not None:
            seal(stream, shown)


def _output_header(cloud: Cloud, records: PointRecords) -> Header:
    """Return the header of a cloud for the records that are written, with its CRS as their format has it."""
    header = cloud.header.with_layout(records.layout) if records.layout != cloud.header.layout else cloud.header
    header = header if header.layout.is_old else replace(header, minor=4)
    return header_with_crs(header, cloud.crs)
