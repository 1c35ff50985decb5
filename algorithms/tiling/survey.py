"""A survey of many tiles as one cloud: its files with their boxes, and the points of any part."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Optional, Union

import numpy as np

from ..cloud.cloud import Cloud, origin_before
from ..cloud.crs import Crs, CrsReader, crs_of_tiles, read_crs
from ..cloud.files import NOWHERE, named_files_of, open_named, readable, state_of, touching
from ..cloud.header import OF_OLD_POINTS, Header
from ..cloud.outputs import STAC, check_not_read, kind_of, made_folder, os_errors_as_messages
from ..cloud.point_records import fill_merged
from ..cloud.points import check_points, chunks_near, is_within, lowest_rows, read_chunks
from ..cloud.vpc import Named, merged_header
from ..cloud.web_file import file_at
from ..stage import Monitor

# The folder among the tiles with the COPC files that QGIS shows.
SHOWN = "shown"

# Dimensions by which two records are recognized as the same measurement.
_KEYS = ("gps_time", "return_number", "number_of_returns", "point_source_id", "intensity")


@dataclass(frozen=True)
class Source:
    """A file of the survey, its header, and its box: least and greatest easting and northing (2, 2) by the header, m.

    The box ends at the extent of the survey, if it has one.
    """

    path: Path
    header: Header
    box: np.ndarray
    state: tuple[int, int]  #: Size and time of the last change, see :func:`state_of`, before anything was read

    def check_state(self) -> None:
        """Refuse a file that has changed since: headers, positions of points and results would not fit each other.

        Raises
        ------
        ValueError
            If its size or the time of its last change differs.
        """
        if state_of(self.path) != self.state:
            raise ValueError(f"{self.path.name} has changed since the run began; run it again when it is complete.")


@dataclass(frozen=True)
class Window:
    """The points of a survey that lie in a box."""

    cloud: Cloud  #: Every measurement once, in an order that depends on neither the files nor their order
    #: source, position, (n,), int32 and int64: Of every record, the position of its file in the survey and its own in
    #: that file
    source: np.ndarray
    position: np.ndarray
    #: (n,), int64: which point of ``cloud`` a record is; records of one measurement in overlapping tiles are the same
    #: point
    point: np.ndarray


@dataclass(frozen=True)
class Survey:
    """Files that are tiles of one cloud."""

    sources: tuple[Source, ...]  #: The files
    header: Header  #: The header of all points as one cloud: finest scale, all dimensions; with its spacing
    crs: Crs  #: Coordinate reference system, with meters per unit of the coordinates
    origin: np.ndarray = field(default_factory=lambda: np.zeros(3))  #: What local coordinates are relative to, m
    #: (2, 2): only points within belong to the survey, edges included; least and greatest easting and northing in
    #: coordinates of the files
    extent: Optional[np.ndarray] = None

    def __len__(self) -> int:
        return sum(source.header.count for source in self.sources)

    @property
    def is_whole(self) -> bool:
        """Whether every point of its files belongs to it."""
        return self.extent is None and self.header.spacing is None

    @property
    def expected(self) -> float:
        """Number of points; a file that reaches beyond the extent counts by the share of its area within.

        With a spacing there are no more than two on average in each column of cubes: the ground, and a roof, crown or
        wall above it.
        """
        wholes = [_box(source.header, self.crs) for source in self.sources]
        areas, of_wholes = (np.array([np.prod(np.ptp(one, axis=0)) for one in boxes]) for boxes in (self.boxes, wholes))
        counts = [source.header.count for source in self.sources] * areas / of_wholes
        if self.header.spacing is not None:
            counts = np.minimum(counts, 2.0 * areas / np.prod(self.header.spacing[:2] * self.crs.horizontal))
        return float(counts.sum())

    def _of_cubes(self, box: np.ndarray) -> np.ndarray:
        """Return a box (2, 2), m, with all of the cubes of the spacing on its edges."""
        side = 0.0 if self.header.spacing is None else self.header.spacing[:2] * self.crs.horizontal
        return box + np.outer([-1, 1], [1, 1]) * side

    @property
    def box(self) -> np.ndarray:
        """Least and greatest easting and northing (2, 2) of the boxes of all files, m."""
        return np.array([self.boxes[:, 0].min(axis=0), self.boxes[:, 1].max(axis=0)])

    @property
    def corner(self) -> np.ndarray:
        """Least easting and northing (2,) of the files, m from ``origin``, also where only an extent is read."""
        low = np.min([source.header.low[:2] for source in self.sources], axis=0)
        scale, offset, unit = self.header.scale[:2], self.header.offset[:2], self.crs.horizontal
        # Computed like the coordinates of a cloud, to the last bit, so that no point lies before the first cell.
        return np.rint((low - offset) / scale) * (scale * unit) + (offset * unit - self.origin[:2])

    @cached_property
    def boxes(self) -> np.ndarray:
        """Boxes (m, 2, 2) of the files, m."""
        return np.array([source.box for source in self.sources])

    def holds(self, records: np.ndarray, header: Header) -> np.ndarray:
        """Return the mask of records (n,) of a file with this header that lie within the extent."""
        return np.ones(len(records), bool) if self.extent is None else is_within(records, header, self.extent)

    def near(self, box: np.ndarray) -> list[int]:
        """Return the positions of the files that may have points in a box (2, 2), m, or in cubes on its edges."""
        return np.flatnonzero(boxes_meet(self.boxes, self._of_cubes(box))).tolist()

    def window(self, box: np.ndarray, monitor: Optional[Monitor] = None) -> Optional[Window]:
        """Return the points in a box (2, 2), m: its lower edges belong to it, its upper ones don't; None if none.

        With a spacing, cubes on the edges have one point as well, of those within and beyond. Memory: the records of
        the window, and one portion of a file at a time.
        """
        monitor = monitor or Monitor()
        numbers = self.near(box)
        found = []
        for number, part in zip(numbers, monitor.parts(len(numbers))):
            found += [(number, *one) for one in self._records(self.sources[number], self._of_cubes(box), part)]
        if not found:
            return None
        records = np.concatenate([records for _, _, records in found])
        source = np.repeat(np.array([number for number, _, _ in found], np.int32), [len(one[1]) for one in found])
        position = np.concatenate([position for _, position, _ in found])
        if self.header.spacing is not None:
            kept = lowest_rows(records, self.header)
            kept = kept[inside(self.in_plan(records[kept], self.header), box)]
            records, source, position = records[kept], source[kept], position[kept]
        return self._in_order(records, source, position) if len(records) else None

    def sound_part(self, box: np.ndarray, monitor: Monitor) -> Survey:
        """Return the survey without the files whose points in a box (2, 2), m, can't be read; warn of each."""
        damaged = set()
        for number in self.near(box):
            try:
                replace(self, sources=(self.sources[number],)).window(box, monitor)
            except ValueError as error:
                monitor.warn(str(error))
                damaged.add(number)
        return replace(self, sources=tuple(one for at, one in enumerate(self.sources) if at not in damaged))

    def positions(self, count: int, monitor: Monitor) -> np.ndarray:
        """Return the positions (k, 2), m, of up to ``count`` points that are spread evenly over all records.

        Files that can't be read give none, with a warning. Memory: one portion of a file at a time.
        """
        first = np.cumsum([0, *(source.header.count for source in self.sources)])
        wanted = np.unique(((np.arange(count) + 0.5) / count * first[-1]).astype(np.int64))
        found = [np.zeros((0, 2))]
        for number, (source, part) in enumerate(zip(self.sources, monitor.parts(len(self.sources)))):
            rows = wanted[(wanted >= first[number]) & (wanted < first[number + 1])] - first[number]
            if not len(rows):
                continue
            try:
                found += self._positions_of(source, rows, part)
            except ValueError as error:
                # The blocks of a damaged file fail by name later.
                monitor.warn(str(error))
            part.progress(1.0)
        return np.concatenate(found)

    def _positions_of(self, source: Source, rows: np.ndarray, monitor: Monitor) -> list[np.ndarray]:
        """Return the positions (k, 2), m, of the records of a file at ascending positions, in parts."""
        found = []
        with readable(source.path):
            for start, chunk in read_chunks(source.path, source.header, monitor):
                own = rows[(rows >= start) & (rows < start + len(chunk))] - start
                found.append(self.in_plan(chunk[own], source.header))
                if start + len(chunk) > rows[-1]:
                    break
        return found

    def _records(self, source: Source, box: np.ndarray, monitor: Monitor) -> Iterable[tuple[np.ndarray, np.ndarray]]:
        """Yield positions in a file and records, in the survey's format, of the points in a box."""
        header, near = source.header, box / self.crs.horizontal
        if self.extent is not None:
            near = _common_box(near, self.extent)
        with readable(source.path):
            for start, chunk in chunks_near(source.path, header, near, monitor):
                rows = np.flatnonzero(self.holds(chunk, header) & inside(self.in_plan(chunk, header), box))
                if header.spacing is not None:
                    rows = rows[lowest_rows(chunk[rows], header)]
                if len(rows):
                    records = np.zeros(len(rows), self.header.layout.dtype)
                    fill_merged(records, chunk[rows], header, self.header)
                    yield start + rows, records
        source.check_state()

    def in_plan(self, records: np.ndarray, header: Header) -> np.ndarray:
        """Return easting and northing (n, 2), m, of records with this header, as the edges of blocks count them."""
        scale, offset = (values * self.crs.horizontal for values in (header.scale, header.offset))
        return np.column_stack([records[axis] * scale[i] + offset[i] for i, axis in enumerate("XY")])

    def _in_order(self, records: np.ndarray, source: np.ndarray, position: np.ndarray) -> Window:
        """Sort records by their measurements, and keep each measurement once."""
        layout = self.header.layout
        keys = [records[axis] for axis in "XYZ"]
        keys += [layout.get(records, name) for name in _KEYS if name in layout.names]
        order = np.lexsort([position, source, *keys[::-1]])
        is_next = np.zeros(len(records), bool)
        is_next[0] = True
        for key in keys:
            is_next[1:] |= key[order][1:] != key[order][:-1]
        group = np.cumsum(is_next) - 1
        # Two equal records of one file are two points: only those that another file repeats are left out.
        first = source[order][is_next][group]
        is_kept = source[order] == first
        point = np.cumsum(is_kept) - 1
        start = point[is_next][group]
        point = np.where(is_kept, point, start)
        cloud = self.cloud(records[order[is_kept]])
        return Window(cloud, source[order], position[order], point)

    def cloud(self, records: np.ndarray) -> Cloud:
        """Return records of the survey as a cloud."""
        cloud = Cloud(replace(self.header, count=len(records)), records, self.crs)
        cloud.origin = self.origin
        return cloud


def boxes_meet(boxes: np.ndarray, box: np.ndarray) -> np.ndarray:
    """Return the mask of boxes (m, 2, 2) that meet a box (2, 2)."""
    return ((boxes[:, 0] <= box[1]) & (boxes[:, 1] >= box[0])).all(axis=1)


def _common_box(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return the box (2, 2) in which two boxes overlap."""
    return np.array([np.maximum(one[0], other[0]), np.minimum(one[1], other[1])])


def inside(positions: np.ndarray, box: np.ndarray) -> np.ndarray:
    """Return the mask of positions (n, 2) that lie in a box (2, 2), its upper edges not in it."""
    return ((positions >= box[0]) & (positions < box[1])).all(axis=1)


def open_survey(
    paths: Iterable[Union[str, Path]],
    read: CrsReader = read_crs,
    monitor: Optional[Monitor] = None,
    extent: Optional[np.ndarray] = None,
    spacing: Optional[np.ndarray] = None,
) -> Survey:
    """Return the survey that files, virtual point clouds and folders of files make.

    Parameters
    ----------
    paths : iterable of str or Path
        A folder means all .las, .laz and .copc.laz files in it; a file that comes twice is one.
    read : callable
        As for :func:`.read_cloud`.
    monitor : Monitor, optional
        Receives warnings about parts that can't be merged.
    extent : ndarray of shape (2, 2), optional
        As :attr:`Survey.extent`; files that lie wholly outside are no part of the survey.
    spacing : ndarray of shape (3,), optional
        As for :func:`.read_cloud`.

    Raises
    ------
    ValueError
        If there are no files, one can't be read, they have different coordinate reference systems or units, or all lie
        outside of the extent.
    """
    monitor = monitor or Monitor()
    named = touching(_named_files(paths), extent)
    states = {file: state_of(file) for file in named}
    files, headers = open_named(named, monitor, extent, spacing)
    for file, header in zip(files, headers):
        check_points(file, header)
    header = merged_header(headers, "tiles", monitor) if len(headers) > 1 else headers[0]
    crs = crs_of_tiles(headers, [file.name for file in files], read, monitor)
    crs.report(monitor)
    sources = tuple(Source(file, one, _box(one, crs), states[file]) for file, one in zip(files, headers))
    if extent is not None:
        sources = _within_extent(sources, extent * crs.horizontal)
    survey = Survey(sources, header.without(*OF_OLD_POINTS), crs, extent=extent)
    return replace(survey, origin=origin_before(survey.box[0]))


def _within_extent(sources: tuple[Source, ...], extent: np.ndarray) -> tuple[Source, ...]:
    """Return the files that may have points in an extent (2, 2), m, with boxes that end at it."""
    met = [source for source in sources if boxes_meet(source.box[None], extent).all()]
    if not met:
        raise ValueError("The survey has no points within the extent; choose another extent.")
    return tuple(replace(source, box=_common_box(source.box, extent)) for source in met)


def files_of_survey(paths: Iterable[Union[str, Path]]) -> list[Path]:
    """Return the files of a survey, see :func:`_named_files`."""
    return list(_named_files(paths))


def _named_files(paths: Iterable[Union[str, Path]]) -> dict[Path, Named]:
    """Return the files named by files, virtual point clouds and folders, each once, with the facts stated about each.

    Raises
    ------
    ValueError
        If there are no files, or one is no point cloud.
    """
    found: dict[Path, tuple[Path, Named]] = {}
    for path in map(file_at, paths):
        inside = sorted(filter(_is_of_survey, path.iterdir())) if path.is_dir() else [path]
        for file in inside:
            # A VPC in the folder adds its files: files of the folder count once, and others were meant to be read.
            for one, said in named_files_of(file).items():
                found[one.resolve()] = one, said if said.crs else found.get(one.resolve(), (one, said))[1]
    if not found:
        raise ValueError("There are no point clouds in the folder; choose one with .las, .laz or .copc.laz files.")
    return dict(found.values())


def _is_of_survey(path: Path) -> bool:
    """Whether a name in the folder of a survey is of a point cloud; JSON there is of many kinds."""
    return kind_of(path) not in ("", STAC) and path.is_file()


def crs_of_survey(paths: Iterable[Union[str, Path]], read: CrsReader = read_crs) -> Crs:
    """Return the coordinate reference system of a survey.

    Raises
    ------
    ValueError
        If a file can't be read, none has points, or they have different systems.
    """
    files, headers = open_named(touching(_named_files(paths), NOWHERE), None, NOWHERE, None)
    return crs_of_tiles(headers, [file.name for file in files], read, Monitor())


def _box(header: Header, crs: Crs) -> np.ndarray:
    """Return the least and greatest easting and northing (2, 2), m, of the points of a file by its header."""
    box = np.array([header.low[:2], header.high[:2]]) * crs.horizontal
    # Some files have rounded bounds: a margin of one step of the scale includes all points.
    step = header.scale[:2] * crs.horizontal
    return box + np.array([-step, step])


@contextmanager
def tiles_folder(folder: Path, inputs: Iterable[Path]) -> Iterator[None]:
    """Make the folder of the tiles where it is missing, or refuse it where a name in it leads to an input of the run.

    If the block fails and leaves it empty, it is removed again.

    Parameters
    ----------
    folder : Path
        Where the tiles go.
    inputs : iterable of Path
        All files that the run reads.

    Raises
    ------
    ValueError
        If it is a file, if an input is in it, also by a link, or if it can't be made.
    """
    if folder.exists() and not folder.is_dir():
        raise ValueError(f"{folder} is a file; choose a folder for the tiles.")
    with made_folder(folder):
        shown = folder / SHOWN
        if shown.is_symlink():
            raise ValueError(f"{shown} is a link, which no run makes; remove it or choose another folder.")
        with os_errors_as_messages(folder):
            names = sorted([*folder.iterdir(), *shown.glob("*")])
        check_not_read(names, inputs)
        yield
