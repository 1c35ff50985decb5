"""The index of a COPC file: the chunks of points that may lie in a box."""

import struct
from pathlib import Path
from typing import BinaryIO

import numpy as np

from .header import COPC_INFO, Header, truncated
from .octree import PAGE, Nodes, nodes_of

# center, halfsize, spacing, root hierarchy offset and size, GPS time range, reserved
INFO = struct.Struct("<3dddQQdd11Q")
# Level, x, y, z of a node; position, bytes and number of points of its chunk.
ENTRY = np.dtype([("key", "<i4", 4), ("offset", "<u8"), ("size", "<i4"), ("count", "<i4")])


def has_index(header: Header) -> bool:
    """Whether a header is of a COPC file: its first record is the one with the position of the octree."""
    first = header.vlrs[0] if header.vlrs else None
    is_info = first and first.key == COPC_INFO and first.data is not None and len(first.data) == INFO.size
    return bool(header.is_compressed and is_info)


def read_index(path: Path, header: Header, stream: BinaryIO, chunks: np.ndarray) -> Nodes:
    """Return the nodes with points of a COPC file, in its order, checked against the chunks that the file has.

    Parameters
    ----------
    path : Path
        For messages.
    header : Header
        Of which :func:`has_index` is true.
    stream : file
        The open file.
    chunks : ndarray of shape (m, 3), int64
        Position, bytes and number of points of each chunk, in the order of the file.

    Raises
    ------
    ValueError
        If a page lies outside of the file or comes twice, or the nodes do not match the chunks.
    """
    x, y, _, half, spacing, at, size, *_ = INFO.unpack(header.vlrs[0].data or b"")
    if not (np.isfinite([x, y, half]).all() and half > 0):
        raise _damaged(path, f"its root is a cube of {2 * half:g} around ({x:g}, {y:g})")
    nodes = _nodes(path, stream, at, size, len(chunks))
    nodes = nodes[np.argsort(nodes["offset"], kind="stable")]
    found = np.column_stack([nodes[name].astype(np.int64) for name in ("offset", "size", "count")])
    held = chunks[chunks[:, 2] > 0]
    if not np.array_equal(found, held):
        raise _damaged(path, f"it names {len(found)} nodes that are not the {len(held)} chunks of the file")
    keys, points = nodes["key"].astype(np.int64), found[:, 2]
    root = np.array([[x - half, y - half], [2 * half, 2 * half]])
    return nodes_of(path, keys, points, root, header.scale[:2], spacing)


def _nodes(path: Path, stream: BinaryIO, at: int, size: int, most: int) -> np.ndarray:
    """Return the entries of all nodes with points, page by page from the root's on; ``most`` is how many may be."""
    total = path.stat().st_size
    waiting, seen, found = [(at, size)], set(), [np.empty(0, ENTRY)]
    count = 0
    while waiting:
        at, size = waiting.pop()
        if at in seen:
            raise _damaged(path, f"it leads to the page at byte {at} more than once")
        seen.add(at)
        if size < 0 or size % ENTRY.itemsize or at + size > total:
            raise _damaged(path, f"a page of {size} bytes should be at byte {at} of {total}")
        stream.seek(at)
        page = np.frombuffer(stream.read(size), ENTRY)
        nodes = page[page["count"] > 0]
        count += len(nodes)
        if (page["count"] < PAGE).any() or count > most:
            raise _damaged(path, f"it names more nodes than the {most} chunks of the file")
        found.append(nodes)
        waiting += [(int(one["offset"]), int(one["size"])) for one in page[page["count"] == PAGE]]
    return np.concatenate(found)


def _damaged(path: Path, what: str) -> ValueError:
    return truncated(path, f"of its index, {what}")
