"""Made LAS files: written and taken apart here byte by byte, by code that is independent of the tested code."""

import os
import struct
from pathlib import Path

import numpy as np
import pytest

from lidar_buildings.tests.las_files import HEADER_SIZES, made_las


@pytest.fixture(scope="session")
def real_files():
    """Clouds of real surveys, where they are there."""
    folder = Path(os.environ.get("LIDAR_BUILDINGS_DATA", Path(__file__).parents[4] / "shared" / "data"))
    files = [file for file in sorted(folder.glob("*/*.laz")) if file.stat().st_size < 3_000_000]
    # The odd ones have tests of their own (tests/real/test_cases.py).
    files = [file for file in files if file.parent.name != "cases"]
    if not files:
        pytest.skip(f"no real clouds in {folder}")
    return files


@pytest.fixture
def make_las(tmp_path):
    """Write a LAS file with known bytes and return its path."""

    def make(name="made.las", **contents):
        path = tmp_path / name
        path.write_bytes(made_las(**contents))
        return path

    return make


@pytest.fixture
def take_apart():
    """Return what a LAS (not LAZ) file holds, as plain bytes and numbers."""
    return _take_apart


def _take_apart(path):
    raw = path.read_bytes()
    start = struct.unpack_from("<4sHH16sBB32s32sHHHIIBHI5I", raw)
    names = "signature source_id encoding guid major minor system software day year header_size points_at n_vlrs"
    found = dict(zip([*names.split(), "format", "size"], start))
    found["legacy_count"], found["legacy_returns"] = start[15], start[16:21]
    numbers = struct.unpack_from("<12d", raw, 131)
    found["scale"], found["offset"], found["extent"] = numbers[:3], numbers[3:6], numbers[6:]
    found["user_bytes"] = raw[HEADER_SIZES[found["minor"]] : found["header_size"]]
    found["count"], found["waveforms_at"], evlrs_at, n_evlrs = found["legacy_count"], 0, 0, 0
    if found["minor"] >= 3:
        (found["waveforms_at"],) = struct.unpack_from("<Q", raw, 227)
    if found["minor"] >= 4:
        evlrs_at, n_evlrs, found["count"] = struct.unpack_from("<QIQ", raw, 235)
        found["returns"] = struct.unpack_from("<15Q", raw, 255)
    at, found["vlrs"] = found["header_size"], []
    for _ in range(found["n_vlrs"]):
        length = 54 + struct.unpack_from("<H", raw, at + 20)[0]
        found["vlrs"].append(raw[at : at + length])
        at += length
    found["gap"] = raw[at : found["points_at"]]
    end = found["points_at"] + found["count"] * found["size"]
    found["records"] = np.frombuffer(raw[found["points_at"] : end], np.uint8).reshape(-1, found["size"])
    found["rest"] = raw[end:]
    found["evlrs"], at = [], evlrs_at
    for _ in range(n_evlrs):
        length = 60 + struct.unpack_from("<Q", raw, at + 20)[0]
        found["evlrs"].append(raw[at : at + length])
        at += length
    return found
