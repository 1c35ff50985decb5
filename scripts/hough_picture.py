#!/usr/bin/env python3
"""Measure and draw the effect of the width of the bins on *Segment planes (Hough)*.

The chart is on its help page::

    scripts/offscreen.sh .venv/bin/python scripts/hough_picture.py

Planes in random directions among scattered points must be found; pairs of planes that lie close must be separated.
"""

from __future__ import annotations

import importlib
import sys
from pathlib import Path
from typing import Callable

import numpy as np
from qgis.PyQt.QtCore import QPointF, QRectF, Qt
from qgis.PyQt.QtGui import QColor, QFont, QGuiApplication, QImage, QPainter, QPen, QPolygonF

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
importlib.import_module("conftest")

from lidar_buildings.algorithms.shapes.segment_planes_hough import segment_planes_hough  # noqa: E402
from lidar_buildings.provider.paths import PICTURES  # noqa: E402

# Standard deviation of points from their plane, spacing of points and side of a plane, m.
NOISE, SPACING, SIDE = 0.03, 0.3, 3.0

# Distance between the planes of a pair, in standard deviations of the noise.
APART = 8.0

# Planes, or pairs of planes, of a scene.
COUNT = 9

# Scattered points to each point of a plane.
CLUTTER = 14.0

# Scenes that each width is measured on.
SCENES = 4

# Other parameters of the stage, the same for all widths. With smaller slope bins the space of the smallest widths does
# not fit into memory.
FIXED = {"slope_bin": 3.0, "tolerance": 2.3 * NOISE, "window_size": 4.0, "max_gap": 1.5, "min_area": 2.0}

# Widths of bins, in standard deviations of the noise.
WIDTHS = (0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0)

# A plane is found, or separated, where this share of its points is one segment, and the same share of the segment's
# points on planes is the plane's.
SAME = 0.7

SIZE = (640, 360)  # pixels
ROOM = (52, 20, 20, 50)  # pixels left of, above, right of and below the axes


def clutter(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Return points (n, 3) of planes in random directions among scattered ones, and the plane of each, or -1."""
    parts = []
    for number in range(COUNT):
        center, axes = _frame(number, rng)
        plane = center + _patch(rng) @ axes
        scattered = center + rng.uniform(-SIDE / 2, SIDE / 2, (round(CLUTTER * len(plane)), 3))
        parts += [(plane, number), (scattered, -1)]
    return _joined(parts)


def pairs(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Return points (n, 3) of pairs of parallel planes, and the plane of each."""
    parts = []
    for number in range(COUNT):
        center, axes = _frame(number, rng)
        for side in (0, 1):
            parts.append((center + (_patch(rng) + [0.0, 0.0, side * APART * NOISE]) @ axes, 2 * number + side))
    return _joined(parts)


def _frame(number: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Return center (3,), m, and random axes (3, 3) of a plane; centers are three sides apart, three in a row."""
    return np.array([number % 3, number // 3, 0.0]) * 3 * SIDE, np.linalg.qr(rng.normal(size=(3, 3)))[0]


def _patch(rng: np.random.Generator) -> np.ndarray:
    """Return points (n, 3), m, of a level plane around the origin."""
    count = round((SIDE / SPACING) ** 2)
    return np.column_stack([rng.uniform(-SIDE / 2, SIDE / 2, (count, 2)), rng.normal(0, NOISE, count)])


def _joined(parts: list[tuple[np.ndarray, int]]) -> tuple[np.ndarray, np.ndarray]:
    """Return the points of all parts, and the number of the part's plane for each."""
    return np.concatenate([xyz for xyz, _ in parts]), np.repeat([at for _, at in parts], [len(xyz) for xyz, _ in parts])


def share_found(scene: Callable[[np.random.Generator], tuple[np.ndarray, np.ndarray]], width: float) -> float:
    """Return the share (%) of the planes of some scenes that are found with bins of a width (in deviations)."""
    right = total = 0
    for seed in range(SCENES):
        xyz, plane = scene(np.random.default_rng(seed))
        segment = segment_planes_hough(xyz, np.zeros(len(xyz), np.uint8), distance_bin=width * NOISE, **FIXED)[0]
        for number in range(plane.max() + 1):
            own = segment[plane == number]
            largest = np.bincount(own[own > 0], minlength=1).argmax() if (own > 0).any() else -1
            of_segment = plane[segment == largest]
            right += (own == largest).mean() >= SAME and (of_segment[of_segment >= 0] == number).mean() >= SAME
            total += 1
    return 100.0 * right / total


def drawn(curves: dict[str, tuple[str, list[float]]]) -> QImage:
    """Return a chart of shares (%) over the widths of bins, by the name and color of each curve."""
    image = QImage(*SIZE, QImage.Format.Format_RGB32)
    image.fill(Qt.GlobalColor.white)
    painter = QPainter(image)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    left, top, right, bottom = ROOM
    area = QRectF(left, top, SIZE[0] - left - right, SIZE[1] - top - bottom)
    step = area.width() / (len(WIDTHS) - 1)
    painter.setFont(QFont("sans-serif", 11))
    for share in range(0, 101, 25):
        y = area.bottom() - share / 100 * area.height()
        painter.setPen(QPen(QColor("#dddddd"), 1))
        painter.drawLine(QPointF(left, y), QPointF(area.right(), y))
        painter.setPen(Qt.GlobalColor.black)
        painter.drawText(QRectF(0, y - 10, left - 6, 20), Qt.AlignmentFlag.AlignRight, f"{share} %")
    for number, width in enumerate(WIDTHS):
        place = QRectF(left + number * step - 40, area.bottom() + 4, 80, 20)
        painter.drawText(place, Qt.AlignmentFlag.AlignHCenter, f"{width:g}")
    below = QRectF(left, area.bottom() + 26, area.width(), 20)
    painter.drawText(below, Qt.AlignmentFlag.AlignHCenter, "width of a bin in standard deviations of the noise")
    for row, (name, (color, shares)) in enumerate(curves.items()):
        painter.setPen(QPen(QColor(color), 3))
        places = [QPointF(left + i * step, area.bottom() - v / 100 * area.height()) for i, v in enumerate(shares)]
        painter.drawPolyline(QPolygonF(places))
        painter.drawText(QPointF(left + 0.03 * area.width(), area.bottom() - 40 + 20 * row), name)
    painter.end()
    return image


def main() -> None:
    """Measure, print the figures and draw them."""
    application = QGuiApplication([])
    curves = {}
    for name, color, scene in (
        ("planes found among scattered points", "#004488", clutter),
        (f"planes {APART:g} deviations apart, separated", "#bb5566", pairs),
    ):
        curves[name] = color, [share_found(scene, width) for width in WIDTHS]
        print(name, dict(zip(WIDTHS, curves[name][1])))
    if not drawn(curves).save(str(PICTURES / "segmentplaneshough.png")):
        raise SystemExit(f"{PICTURES} can't be written")
    del application


if __name__ == "__main__":
    main()
