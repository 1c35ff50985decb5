"""LAS files made byte by byte, by code that shares nothing with the readers and writers under test."""

from __future__ import annotations

import struct

import numpy as np

HEADER_SIZES = {0: 227, 1: 227, 2: 227, 3: 235, 4: 375}
RECORD_SIZES = (20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67)
FORMATS = range(11)


def descriptor(name, kind, options=0, no_data=b"", scale=0.0, offset=0.0, text=""):
    """One Extra Bytes descriptor, 192 bytes."""
    return struct.pack(
        "<2xBB32s4x8s16x24x24x3d3d32s", kind, options, name.encode(), no_data, scale, 0, 0, offset, 0, 0, text.encode()
    )


def vlr(user, number, data, text="", reserved=0):
    return struct.pack("<H16sHH32s", reserved, user.encode(), number, len(data), text.encode()) + data


def evlr(user, number, data, text=""):
    return struct.pack("<H16sHQ32s", 0, user.encode(), number, len(data), text.encode()) + data


def made_las(
    point_format=6, minor=4, n=100, records=None, extra=0, vlrs=(), evlrs=(), encoding=0, gap=b"",
    scale=(0.01, 0.01, 0.001), offset=(600_000.0, 5_000_000.0, 0.0), user_bytes=b"", waveforms=False, count=None,
    bounds=None,
):  # fmt: skip
    """Return a LAS file as bytes; ``waveforms`` says that the EVLRs hold them, ``bounds`` (xmax, xmin, …) may lie."""
    size = RECORD_SIZES[point_format] + extra
    if records is None:
        records = random_records(point_format, size, n)
    if waveforms:
        encoding |= 2
    header_size = HEADER_SIZES[minor] + len(user_bytes)
    points_at = header_size + sum(map(len, vlrs)) + len(gap)
    evlrs_at = points_at + len(records) * size
    count = len(records) if count is None else count
    old = minor < 4 or point_format < 6
    raw = struct.pack(
        "<4sHH16sBB32s32sHHHIIBHI5I", b"LASF", 77, encoding, bytes(range(16)), 1, minor, b"a scanner", b"a program",
        123, 2019, header_size, points_at, len(vlrs), point_format, size, min(count, 2**32 - 1) if old else 0,
        *[0] * 5,
    )  # fmt: skip
    raw += struct.pack("<3d3d6d", *scale, *offset, *(true_bounds(records, scale, offset) if bounds is None else bounds))
    if minor >= 3:
        raw += struct.pack("<Q", evlrs_at if waveforms else 0)
    if minor >= 4:
        raw += struct.pack("<QIQ15Q", evlrs_at if evlrs else 0, len(evlrs), count, *[0] * 15)
    return raw + user_bytes + b"".join(vlrs) + gap + records.tobytes() + b"".join(evlrs)


def true_bounds(records, scale, offset):
    """Return xmax, xmin, ymax, ymin, zmax, zmin of records, zeros without any."""
    if not len(records):
        return [0.0] * 6
    coordinates = np.ascontiguousarray(records[:, :12]).view("<i4") * np.array(scale) + np.array(offset)
    return np.column_stack([coordinates.max(axis=0), coordinates.min(axis=0)]).ravel().tolist()


def random_records(point_format, size, n, seed=1):
    """Records of random bytes, uint8 (n, size); coordinates within 100 m, and all floats finite, to be compared."""
    rng = np.random.default_rng(seed)
    records = rng.integers(0, 256, (n, size), np.uint8)
    records[:, :12] = rng.integers(0, 10_000, (n, 3), "i4").view(np.uint8)
    time_at = {1: 20, 3: 20, 4: 20, 5: 20, **dict.fromkeys(range(6, 11), 22)}.get(point_format)
    if time_at:
        records[:, time_at : time_at + 8] = rng.uniform(0, 1e9, (n, 1)).view(np.uint8)
    floats_at = {4: 41, 5: 47, 9: 43, 10: 51}.get(point_format)
    if floats_at:
        records[:, floats_at : floats_at + 16] = rng.normal(size=(n, 4)).astype("f4").view(np.uint8)
    return records
