"""The page needs no other file, and its map shows each outcome at its position."""

import base64
import re
import struct
import zlib
from html.parser import HTMLParser

import numpy as np

from lidar_buildings.algorithms.report.page import FALSE, HIT, MISS, REST, Row, build_page, draw_map, outcome_of

NAMES = ("rest", "hit", "missed", "false")


def decoded(picture):
    """Return the color numbers of the PNG in a map, read without the code under test."""
    data = base64.b64decode(re.search(r"base64,([^\"]+)", picture).group(1))
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    chunks, at = {}, 8
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + length]
        assert zlib.crc32(kind + body) == struct.unpack(">I", data[at + 8 + length : at + 12 + length])[0]
        chunks[kind] = body
        at += 12 + length
    width, height, depth, color = struct.unpack(">IIBB", chunks[b"IHDR"][:10])
    assert (depth, color) == (8, 3)
    return np.frombuffer(zlib.decompress(chunks[b"IDAT"]), np.uint8).reshape(height, width + 1)[:, 1:]


def test_outcomes():
    predicted, true = np.array([1, 0, 1, 0], bool), np.array([1, 1, 0, 0], bool)
    assert outcome_of(predicted, true).tolist() == [HIT, MISS, FALSE, REST]


def test_map_is_north_up_and_shows_the_topmost_point():
    # Four points to a pixel: a 2 x 2 block of pixels, each with its own outcome on top of false ones.
    plan = np.stack(np.meshgrid(np.linspace(0, 7.99, 4), np.linspace(0, 7.99, 4)), -1).reshape(-1, 2)
    west, south = plan[:, 0] < 4, plan[:, 1] < 4
    top = np.select([west & south, west, south], [HIT, MISS, FALSE], REST)
    xyz = np.concatenate([np.column_stack([plan, np.full(16, 9.0)]), np.column_stack([plan, np.zeros(16)])])
    image = decoded(draw_map(xyz[::2], np.concatenate([top, np.full(16, FALSE)])[::2].astype(np.uint8), NAMES))
    assert image[0, 0] == MISS  # northwest
    assert image[-1, 0] == HIT  # southwest
    assert image[0, -1] == REST
    assert image[-1, -1] == FALSE


def test_large_extent_gives_a_small_map(rng):
    xyz = rng.uniform(0, 1e6, (100, 3))
    image = decoded(draw_map(xyz, np.zeros(100, np.uint8), NAMES))
    assert max(image.shape) <= 801


def test_one_point_gives_a_map():
    assert decoded(draw_map(np.zeros((1, 3)), np.array([HIT], np.uint8), NAMES)).tolist() == [[HIT]]


def test_page_is_whole_and_escapes():
    page = build_page("A < B", "Lead & more", {"Table": [Row("<name>", "1 %", "What it means.")]}, "<p>map</p>")
    opened = []

    class Reader(HTMLParser):
        def handle_starttag(self, tag, attrs):
            if tag not in {"meta", "img"}:
                opened.append(tag)

        def handle_endtag(self, tag):
            assert opened.pop() == tag

    Reader().feed(page)
    assert not opened
    assert "&lt;name&gt;" in page
    assert "A &lt; B" in page
    assert not re.search(r"(src|href)=\"(?!data:)", page)
