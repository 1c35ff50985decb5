#!/usr/bin/env python3
"""Draw the README's picture of classes: what *Detect buildings* makes of a tile, seen from above at a slant.

scripts/offscreen.sh .venv/bin/python scripts/classes_picture.py TILE.laz [SIDE]

SIDE (m) is the side of the square that is shown; README's shows 180 m of ahn3-delft (AHN3, Dutch open data).
"""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

import numpy as np
from qgis.PyQt.QtGui import QGuiApplication, QImage

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "scripts")]
importlib.import_module("conftest")

import help_pictures as pictures  # noqa: E402

from lidar_buildings.algorithms.cloud.asprs import NOISE  # noqa: E402
from lidar_buildings.algorithms.cloud.files import read_cloud  # noqa: E402
from lidar_buildings.algorithms.pipelines import PIPELINES  # noqa: E402
from lidar_buildings.algorithms.run import run_pipeline  # noqa: E402

TARGET = ROOT / "resources" / "readme" / "classes.png"
# Size of the picture (pixels), and from where the tile is seen (°).
WIDTH, HEIGHT = 1100, 620
AZIMUTH, TILT = 30.0, 42.0


def main(arguments: list[str]) -> None:
    """Classify the tile and draw it."""
    application = QGuiApplication([])
    cloud = read_cloud(Path(arguments[0]))
    cloud.set("classification", np.zeros(len(cloud), np.uint8))
    cloud = run_pipeline(PIPELINES["detect_buildings"], cloud).cloud
    xyz = cloud.get("xyz")
    off = np.abs(xyz[:, :2] - (xyz[:, :2].min(axis=0) + xyz[:, :2].max(axis=0)) / 2).max(axis=1)
    is_noise = np.isin(cloud.get("classification"), NOISE)
    cloud = cloud.take(np.flatnonzero((off <= float((arguments[1:] or ["180"])[0]) / 2) & ~is_noise))
    pictures.WIDTH = WIDTH
    # Of the scene only the view counts: its simulation is not run.
    scene = pictures.Scene(pictures.TOWN, azimuth=AZIMUTH, tilt=TILT, height=HEIGHT)
    xyz = cloud.get("xyz")
    pixels = pictures.View(xyz, scene).points(xyz, pictures.colors(cloud, "classification"), 3)
    height, width = pixels.shape[:2]
    QImage(pixels.tobytes(), width, height, 3 * width, QImage.Format.Format_RGB888).save(str(TARGET))
    del application


if __name__ == "__main__":
    main(sys.argv[1:])
