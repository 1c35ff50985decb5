"""COPC files: LAZ whose chunks are the nodes of an octree (copc.io, specification 1.0)."""

from dataclasses import dataclass, replace
from typing import Any, BinaryIO, Callable

import numpy as np

from ..geometry.groups import run_starts
from ..stage import Monitor
from .copc_index import ENTRY, INFO
from .crs import stated_wkt
from .header import COPC_HIERARCHY, COPC_INFO, EVLR, LASZIP, OF_OLD_FILES, WAVEFORM_BITS, WKT_BIT, Header, Vlr
from .laspy_library import need_lazrs
from .laz import POINTS_PER_CHUNK
from .points import AT_ONCE, bounds_of

# Levels of the grid within a node: 2^7 = 128 cells along its side. One point of each is shown at the node's level.
_GRID_LEVELS = 7
# Bits per axis of a position in the root cube; three of them fill a 64-bit Morton code.
_BITS = np.iinfo(np.uint64).bits // 3
# Level of the smallest nodes, whose grid is the finest one.
_DEEPEST = _BITS - _GRID_LEVELS


@dataclass(frozen=True)
class Octree:
    """Points by node: node i holds ``order[ends[i-1]:ends[i]]``."""

    low: np.ndarray  #: (3,): least corner of the root cube, in coordinates of the file
    side: float  #: Side of the root cube, in units of the file
    order: np.ndarray  #: (n,), int64: rows of the points, node after node
    keys: np.ndarray  #: (m, 4), int32: level, x, y, z of each node
    ends: np.ndarray  #: (m,), int64: where each node's points end in ``order``


def build_octree(points: np.ndarray, header: Header, monitor: Monitor) -> Octree:
    """Sort points (n,), records of the header's scale and offset, into the nodes of an octree, coarse samples above.

    Each node takes one point, chosen at random, of every occupied cell of its grid, and passes the others on to its
    children. With no more points than a usual LAZ chunk it takes all.
    """
    low, side = _cube(points, header)
    codes = np.empty(len(points), np.uint64)
    for start in range(0, len(points), AT_ONCE):
        monitor.progress(0.3 * start / len(points))
        part = slice(start, start + AT_ONCE)
        codes[part] = _morton(points[part], header, low, side)
    order = _sorted(codes, monitor.part(0.3, 0.5))
    codes = codes[order]
    levels = _levels(codes, monitor.part(0.5, 1.0))
    by_level = np.argsort(levels, kind="stable")
    keys, ends = _nodes(codes[by_level], levels[by_level])
    return Octree(low, side, order[by_level], keys, ends)


def _cube(points: np.ndarray, header: Header) -> tuple[np.ndarray, float]:
    """Return the least corner (3,) and the side of the root cube, in coordinates of the file."""
    low, high = bounds_of(points, header)
    # One step wider, so that the largest coordinate lies inside the last cell.
    return low, float((high - low).max() + header.scale.max())


def _morton(points: np.ndarray, header: Header, low: np.ndarray, side: float) -> np.ndarray:
    """Return the cells of the finest grid in Morton order: x in the lowest of each three bits."""
    code = np.zeros(len(points), np.uint64)
    for i, axis in enumerate("XYZ"):
        along = (points[axis] * header.scale[i] + (header.offset[i] - low[i])) * (2**_BITS / side)
        code |= _spread(np.clip(along, 0, 2**_BITS - 1).astype(np.uint64)) << np.uint64(i)
    return code


def _sorted(codes: np.ndarray, monitor: Monitor) -> np.ndarray:
    """Return the order of ``codes``, found cube by cube so that it can be cancelled."""
    # The highest six bits number the 64 cubes of the second level: points are sorted in one cube at a time.
    top = (codes >> np.uint64(3 * _BITS - 6)).astype(np.uint8)
    order = np.argsort(top, kind="stable")
    start = 0
    for count in np.bincount(top):
        monitor.progress(start / len(codes))
        part = order[start : start + count]
        part[:] = part[np.argsort(codes[part], kind="stable")]
        start += count
    return order


def _spread(cells: np.ndarray) -> np.ndarray:
    """Put two zero bits between all bits of 21-bit numbers."""
    # Groups of 16 bits are taken apart, then groups of 8, down to single ones.
    for size in (16, 8, 4, 2, 1):
        kept = sum(((1 << size) - 1) << start for start in range(0, 3 * _BITS, 3 * size)) & (2**64 - 1)
        cells = (cells | cells << np.uint64(2 * size)) & np.uint64(kept)
    return cells


def _gathered(code: int, axis: int) -> int:
    """Return the bits of one axis of a Morton code."""
    return sum((code >> (3 * bit + axis) & 1) << bit for bit in range(_BITS))


def _levels(codes: np.ndarray, monitor: Monitor) -> np.ndarray:
    """Return the octree level of each point, uint8 (n,); ``codes`` is sorted."""
    generator = np.random.default_rng(0)
    levels = np.empty(len(codes), np.uint8)
    waiting = np.arange(len(codes))
    for level in range(_DEEPEST + 1):
        monitor.progress(1 - len(waiting) / len(codes))
        current = codes[waiting]
        taken = _in_leaves(current >> np.uint64(3 * (_BITS - level)), level)
        first = run_starts(current >> np.uint64(3 * (_BITS - level - _GRID_LEVELS)))
        lengths = np.diff(np.append(first, len(current)))
        taken[first + (generator.random(len(first)) * lengths).astype(np.int64)] = True
        levels[waiting[taken]] = level
        waiting = waiting[~taken]
        if not len(waiting):
            break
    return levels


def _in_leaves(nodes: np.ndarray, level: int) -> np.ndarray:
    """Return the mask (n,) of points in nodes that hold all points not taken by a level above."""
    counts = np.diff(run_starts(nodes), append=len(nodes))
    return np.repeat((counts <= POINTS_PER_CHUNK) | (level == _DEEPEST), counts)


def _nodes(codes: np.ndarray, levels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return keys (m, 4) and ends (m,) of the nodes of points sorted by level and code."""
    nodes = codes >> (np.uint64(3) * (np.uint64(_BITS) - levels.astype(np.uint64)))
    first = np.union1d(run_starts(nodes), run_starts(levels))
    keys = [(int(levels[i]), *(_gathered(int(nodes[i]), axis) for axis in range(3))) for i in first]
    return np.array(keys, np.int32), np.append(first[1:], len(codes))


def copc_header(header: Header) -> Header:
    """Return ``header`` in the form of COPC: LAS 1.4, the info record first, no waveforms, no LAStools index."""
    kept = header.without(*OF_OLD_FILES)
    encoding = kept.encoding & ~WAVEFORM_BITS | (WKT_BIT if stated_wkt(kept) else 0)
    info = Vlr(*COPC_INFO, bytes(INFO.size), description=b"COPC info")
    return replace(kept, minor=4, user_bytes=b"", gap=b"", waveforms_at=0, encoding=encoding, vlrs=[info, *kept.vlrs])


def write_copc(
    stream: BinaryIO, header: Header, points: np.ndarray, take: Callable[[np.ndarray], np.ndarray], monitor: Monitor
) -> None:
    """Write a whole COPC file to ``stream``; takes about 50 bytes of memory per point in addition to the cloud.

    Parameters
    ----------
    stream : file
        New and empty.
    header : Header
        From :func:`copc_header`, with the layout of what ``take`` gives.
    points : structured array, (n,)
        The cloud, for X, Y, Z.
    take : callable
        Gives the output's records of the points at positions (m,).
    monitor : Monitor
        Receives progress.

    Raises
    ------
    ValueError
        If lazrs is not installed.
    """
    lazrs = need_lazrs()
    octree = build_octree(points, header, monitor.part(0.0, 0.2))
    layout = header.layout
    vlr = lazrs.LazVlr.new_for_compression(layout.point_format, layout.las.num_extra_bytes, True)
    record = Vlr(*LASZIP, bytes(vlr.record_data()), description=b"LASzip by lazrs")
    header = replace(header, vlrs=[*header.vlrs, record], is_compressed=True)
    las = header.las()
    header.write(stream, las)
    times = _write_nodes(lazrs.ParLasZipCompressor(stream, vlr), header, las, octree, take, monitor.part(0.2, 1.0))
    stream.seek(header.points_at)
    sizes = np.array([size for _, size in lazrs.read_chunk_table(stream, vlr)], np.int64)
    _describe(stream, header, octree, sizes, times)
    las.extra_vlr_bytes = header.las().extra_vlr_bytes
    header.finish(stream, las)
    monitor.progress(1.0)


def _write_nodes(
    zipper: Any, header: Header, las: Any, octree: Octree, take: Callable, monitor: Monitor
) -> tuple[float, float]:
    """Compress node after node, as many at once as make a good portion of work; return the first and last GPS time.

    laspy's header ``las`` counts the points.
    """
    low, high = np.inf, -np.inf
    start = first = 0
    while first < len(octree.ends):
        monitor.progress(start / len(octree.order))
        last = max(first + 1, int(np.searchsorted(octree.ends, start + AT_ONCE, side="right")))
        points = take(octree.order[start : octree.ends[last - 1]])
        header.count_in(las, points)
        low, high = min(low, points["gps_time"].min()), max(high, points["gps_time"].max())
        nodes = np.split(points, octree.ends[first : last - 1] - start)
        zipper.compress_chunks([np.ascontiguousarray(node).view(np.uint8) for node in nodes])
        start, first = int(octree.ends[last - 1]), last
    zipper.done()
    return low, high


def _describe(stream: BinaryIO, header: Header, octree: Octree, sizes: np.ndarray, times: tuple[float, float]) -> None:
    """Fill in the info record and put the hierarchy before the other EVLRs."""
    entries = np.zeros(len(sizes), ENTRY)
    entries["key"], entries["size"], entries["count"] = octree.keys, sizes, np.diff(octree.ends, prepend=0)
    # The chunks begin behind the position of the chunk table.
    entries["offset"] = header.points_at + 8 + np.cumsum(sizes) - sizes
    hierarchy = Vlr(*COPC_HIERARCHY, entries.tobytes(), description=b"EPT hierarchy")
    header.evlrs = [hierarchy, *header.evlrs]
    at = stream.seek(0, 2) + EVLR.size
    center = octree.low + octree.side / 2
    # The root shows one point of each cell of its grid.
    spacing = octree.side / 2**_GRID_LEVELS
    info = INFO.pack(*center, octree.side / 2, spacing, at, len(hierarchy), *times, *(0,) * 11)
    header.vlrs = [replace(header.vlrs[0], data=info), *header.vlrs[1:]]
