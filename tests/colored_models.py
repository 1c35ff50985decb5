"""A roof and a wall, points that color them, and the images of files."""

from __future__ import annotations

import struct
import zlib

import numpy as np

from lidar_buildings.algorithms.export.export_models import export_models
from lidar_buildings.algorithms.stage import LayerFeatures

# A sloping roof of 10 m by 6 m and an upright wall below its eave.
ROOF = np.array([[0, 0, 4], [10, 0, 4], [10, 6, 7], [0, 6, 7], [0, 0, 4.0]])
WALL = np.array([[0, 0, 0], [10, 0, 0], [10, 0, 4], [0, 0, 4], [0, 0, 0.0]])
RED, BLUE = (200, 30, 20), (20, 40, 180)


def points(count=3000):
    """Return points on the roof, red west of 4 m and blue east of it, and gray ones of a tree over it."""
    rng = np.random.default_rng(0)
    x, y = rng.uniform(0, 10, count), rng.uniform(0, 6, count)
    on = np.column_stack([x, y, 4 + y / 2 + rng.normal(0, 0.03, count)])
    colors = np.where((x < 4)[:, None], RED, BLUE)
    return np.concatenate([on, on + [0, 0, 1.5]]), np.concatenate([colors, np.full_like(colors, 90)])


def exported(xyz, colors, **tunables):
    roofs, walls = (LayerFeatures([[ring]], {"building": ["1"]}) for ring in (ROOF, WALL))
    red, green, blue = colors.T
    return export_models(xyz, red, green, blue, roofs=roofs, walls=walls, texel_size=0.25, **tunables)[0]


def decoded(raw):
    """Return the image of a PNG file without filters."""
    assert raw[:8] == b"\x89PNG\r\n\x1a\n"
    found, at = {}, 8
    while at < len(raw):
        (length,), kind = struct.unpack(">I", raw[at : at + 4]), raw[at + 4 : at + 8]
        data = raw[at + 8 : at + 8 + length]
        assert struct.unpack(">I", raw[at + 8 + length : at + 12 + length]) == (zlib.crc32(kind + data),)
        found[kind], at = data, at + 12 + length
    columns, rows = struct.unpack(">II", found[b"IHDR"][:8])
    lines = np.frombuffer(zlib.decompress(found[b"IDAT"]), np.uint8).reshape(rows, 1 + 3 * columns)
    assert not lines[:, 0].any()
    return lines[:, 1:].reshape(rows, columns, 3)
