#!/usr/bin/env python3
"""Draw the pictures of the help pages: what each step and model makes of a simulated scene, seen from above at a slant.

Runs the steps themselves, so a picture shows what the code does. With ids as arguments it draws these only::

    scripts/offscreen.sh .venv/bin/python scripts/help_pictures.py [segmentroofs …]

The chart of the Hough transform is drawn by ``hough_picture.py``.
"""

from __future__ import annotations

import importlib
import re
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from qgis.PyQt.QtCore import QPointF
from qgis.PyQt.QtGui import QColor, QGuiApplication, QImage, QPainter, QPen, QPolygonF

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))
importlib.import_module("conftest")

from lidar_buildings.algorithms.captions import captions  # noqa: E402
from lidar_buildings.algorithms.cloud.asprs import NOISE as NOISE_CLASSES  # noqa: E402
from lidar_buildings.algorithms.cloud.asprs import PointClass  # noqa: E402
from lidar_buildings.algorithms.cloud.cloud import Cloud  # noqa: E402
from lidar_buildings.algorithms.pipelines import PIPELINES  # noqa: E402
from lidar_buildings.algorithms.run import Outcome, run_pipeline, run_stage  # noqa: E402
from lidar_buildings.algorithms.stage import Stage  # noqa: E402
from lidar_buildings.algorithms.stages import STAGES  # noqa: E402
from lidar_buildings.provider.paths import PICTURES, STYLES  # noqa: E402

# Width of a picture, pixels.
WIDTH = 640

# Share of the width that is left free on each side.
MARGIN = 0.02

# Eye-dome lighting: a pixel is darker by its depth (m) behind pixels at these distances (pixels).
LIGHTING_PIXELS = (1, 2)

# How much darker, per meter of mean depth: chosen by eye.
LIGHTING_STRENGTH = 0.6

# Depth (m) beyond which a pixel is no darker: chosen by eye.
LIGHTING_DEPTH = 1.5

# Few different colors make small files: steps of lightness, hues of segments, colors of the ramp, and the step between
# values of a band (0 to 255).
LIGHTING_STEPS = 6
HUES = 24
RAMP_STEPS = 20
COLOR_STEP = 32

# Colors of values from low to high.
RAMP = np.array([(44, 62, 120), (52, 132, 160), (92, 176, 120), (214, 204, 88), (214, 96, 56)], float)
NOTHING = (205, 205, 205)  # points of no segment
LINE = QColor("#10161d")


@dataclass(frozen=True)
class Scene:
    """How a picture is made: a simulation and the steps that follow, colors and lines, and from where it is seen.

    Steps are names of stages, or pairs of a name and tunables; a pipeline takes their place. ``color`` is a dimension,
    ``colors`` (red, green, blue) or empty, ``lines`` are names of layers with spaces between. Angles are in degrees,
    the ``box`` is west, south, east, north (m). ``pixels`` is the side of the square that a point is drawn as,
    ``height`` about the greatest height of the picture (pixels). Unless a scene ``keeps_classes``, its steps begin
    without any.
    """

    simulation: tuple[str, dict[str, Any]]
    steps: tuple[Any, ...] = ()
    color: str = "segment_id"
    lines: str = ""
    azimuth: float = 30.0
    tilt: float = 50.0
    box: tuple[float, float, float, float] = (-np.inf, -np.inf, np.inf, np.inf)
    keeps_classes: bool = False
    pixels: int = 3
    height: int = 400
    pipeline: str = ""


TOWN = ("simulate_town", {"size": 100.0, "density": 25.0, "forest": 0.05, "seed": 3})
VILLAGE = ("simulate_village", {"size": 90.0, "density": 50.0, "buildings": 15.0})
STREET = ("simulate_street", {"length": 40.0})
PLANT = ("simulate_plant", {"pipes": 24, "tanks": 0, "spheres": 1, "density": 1500.0})
TREE = ("simulate_tree", {"leaves": 0.05, "density": 4000.0})
BRIDGE = ("simulate_bridges", {"kind": "valley", "density": 12.0})
LINES = ("simulate_power_line", {"size": 130.0, "span": 90.0, "density": 25.0, "forest": 0.05})
FLIGHT = ("simulate_flight", {})

# One side of the street, seen from the other.
FRONT = {"box": (20.0, 14.0, 50.0, 40.0), "azimuth": -44.0, "tilt": 70.0}

# The pipes, without the floor around them.
RACK = {"box": (-1.0, 0.0, 12.0, 10.0), "keeps_classes": True}

NOISE = "classify_noise_histogram"
GROUND = (NOISE, "classify_ground_tin")
HEIGHT = (*GROUND, "compute_height_above_ground")
ROOFS = (*HEIGHT, "segment_roofs")
BUILDINGS = (*ROOFS, "classify_buildings", "complete_buildings")
DRONE = ("classify_noise_statistical", "downsample_voxels", *HEIGHT[1:], ("segment_planes_ransac", {"min_height": 1.5}))
WALLS = (*DRONE, "classify_roofs", "classify_walls")


SCENES = {
    "detectbuildings": Scene(TOWN, pipeline="detect_buildings", color="classification", lines="footprints"),
    "mapfootprints": Scene(VILLAGE, pipeline="map_footprints", color="classification", lines="wall_footprints"),
    "modelbuildings": Scene(TOWN, pipeline="model_buildings", color="", lines="roofs walls"),
    "modelfacades": Scene(STREET, pipeline="model_facades", lines="openings", **FRONT),
    "modelterrain": Scene(BRIDGE, pipeline="model_terrain", color="classification"),
    "modelindustry": Scene(PLANT, pipeline="model_industry", **RACK),
    "interpretstructure": Scene(
        FLIGHT, ("downsample_voxels", "compute_features", "classify_dimensionality"), color="dimensionality"
    ),
    "classifygroundtin": Scene(TOWN, GROUND, color="classification"),
    "classifygroundcloth": Scene(TOWN, (NOISE, "classify_ground_cloth"), color="classification"),
    "classifygroundsegments": Scene(BRIDGE, ("segment_scan_lines", "classify_ground_segments"), color="classification"),
    "classifybridges": Scene(BRIDGE, (*GROUND, "classify_bridges"), color="classification"),
    "computeheightaboveground": Scene(TOWN, HEIGHT, color="height_above_ground"),
    "completeground": Scene(TOWN, (*HEIGHT, "complete_ground"), color="classification"),
    "computefeatures": Scene(TOWN, ("compute_features",), color="planarity"),
    "classifydimensionality": Scene(
        TOWN, (NOISE, "compute_features", "classify_dimensionality"), color="dimensionality"
    ),
    "segmentregions": Scene(TOWN, (*HEIGHT, "segment_regions"), color="cluster_id"),
    "segmentroofs": Scene(TOWN, ROOFS),
    "segmentclusters": Scene(TOWN, (*HEIGHT, "segment_clusters"), color="cluster_id"),
    "segmentsurfaces": Scene(TOWN, (NOISE, "segment_surfaces")),
    "segmentscanlines": Scene(TOWN, (NOISE, "segment_scan_lines")),
    "segmentrecordedlines": Scene(TOWN, (NOISE, "segment_recorded_lines")),
    "segmenttinplanes": Scene(TOWN, (NOISE, "segment_tin_planes")),
    "segmentplanesransac": Scene(VILLAGE, DRONE),
    "detectcylinders": Scene(PLANT, ("detect_cylinders",), lines="axes", **RACK),
    "detectspheres": Scene(PLANT, ("detect_spheres",), keeps_classes=True),
    "segmenttree": Scene(TREE, ("segment_tree",), tilt=80.0, height=560),
    "segmentvoxels": Scene(TOWN, (*HEIGHT, "segment_voxels")),
    "classifybuildings": Scene(TOWN, (*ROOFS, "classify_buildings"), color="confidence"),
    "classifyvegetation": Scene(TOWN, (*BUILDINGS, "classify_vegetation"), color="classification"),
    "classifywater": Scene(TOWN, (*BUILDINGS, "classify_water"), color="classification"),
    "classifywires": Scene(
        LINES, (*BUILDINGS, "classify_wires", "classify_vegetation"), color="classification", azimuth=-30.0, tilt=75.0
    ),
    "keepclasses": Scene(TOWN, (("keep_classes", {"keep": "all"}),), color="classification", keeps_classes=True),
    "classifysegments": Scene(
        TOWN, (NOISE, "segment_surfaces", ("classify_segments", {"min_area": 1000.0})), color="classification"
    ),
    "completebuildings": Scene(TOWN, BUILDINGS, color="classification"),
    "refinebuildings": Scene(TOWN, (*BUILDINGS, "refine_buildings"), color="building_probability"),
    "extractfootprints": Scene(TOWN, (*BUILDINGS, "extract_footprints"), color="classification", lines="footprints"),
    "classifyroofs": Scene(VILLAGE, WALLS[:-1], color="classification"),
    "classifywalls": Scene(VILLAGE, WALLS, color="classification", tilt=60.0),
    "extractwallfootprints": Scene(
        VILLAGE, (*WALLS, "extract_wall_footprints"), color="classification", lines="wall_footprints"
    ),
    "extractwallfootprints2022": Scene(
        VILLAGE, (*WALLS, "extract_wall_footprints_2022"), color="classification", lines="wall_edges"
    ),
    "extractfacades": Scene(STREET, ("extract_facades",), lines="facades", **FRONT),
    "extractopenings": Scene(STREET, ("extract_facades", "extract_openings"), lines="openings", **FRONT),
    "segmentfacadelines": Scene(STREET, ("segment_facade_lines",), **FRONT),
    "reconstructroofs": Scene(
        TOWN, (*BUILDINGS, "extract_footprints", "reconstruct_roofs"), color="", lines="roofs walls"
    ),
    "simulatetown": Scene(TOWN, color="classification", keeps_classes=True),
    "simulatevillage": Scene(VILLAGE, color="colors"),
    "simulatedronesite": Scene(("simulate_drone_site", {"size": 100.0}), color="colors"),
    "updatemap": Scene(
        VILLAGE, ("update_map",), color="classification", lines="updated_map buildings_gone", keeps_classes=True
    ),
    "regularizepolygons": Scene(
        VILLAGE, ("regularize_polygons",), color="classification", lines="regularized", keeps_classes=True
    ),
    "computebuildingheights": Scene(
        VILLAGE, ("compute_building_heights",), color="classification", lines="buildings", keeps_classes=True
    ),
    "simulateflight": Scene(FLIGHT, color="classification", keeps_classes=True),
    "simulateplant": Scene(PLANT, **RACK),
    "simulatetree": Scene(TREE, color="segment_id", tilt=80.0, height=560),
    "simulatestreet": Scene(STREET, **FRONT),
    "simulatepowerline": Scene(LINES, color="classification", keeps_classes=True, azimuth=-30.0, tilt=75.0),
    "simulatebridges": Scene(BRIDGE, color="classification", keeps_classes=True),
}


def derived_scene(stage: Stage) -> Scene:
    """Return the scene of a stage that is not named above: a town, after the steps that write what it reads."""
    if {"segment_id", "cluster_id"} & set(stage.reads):
        steps = ROOFS
    elif "height_above_ground" in stage.reads:
        steps = HEIGHT
    elif "classification" in stage.reads:
        steps = () if stage.name.startswith(("classify_noise", "classify_ground")) else GROUND
    else:
        steps = (NOISE,)
    if not stage.writes:
        raise SystemExit(f"{stage.title} writes no dimension, so it has no picture unless SCENES has a scene for it.")
    return Scene(TOWN, (*steps, stage.name), color=stage.writes[0])


def made(scene: Scene) -> Outcome:
    """Return the cloud of a scene after its steps, and the layers that these made."""
    simulated = _simulated(scene.simulation[0], tuple(scene.simulation[1].items()))
    cloud = simulated.cloud.copy()
    if not scene.keeps_classes and cloud.has("classification"):
        cloud.set("classification", np.zeros(len(cloud), np.uint8))
    if scene.pipeline:
        done = run_pipeline(PIPELINES[scene.pipeline], cloud)
        return Outcome(done.cloud, done.layers)
    # The true footprints and the map of a scene are given to steps that work on its true classes.
    layers: dict[str, Any] = dict(simulated.layers) if scene.keeps_classes else {}
    layers["polygons"] = layers.get("old_map")
    for step in scene.steps:
        name, tunables = (step, {}) if isinstance(step, str) else step
        stage = STAGES[name]
        given = {layer.name: layers.get(layer.name) for layer in stage.input_layers}
        outcome = run_stage(stage, cloud, input_layers=given, **tunables)
        cloud, layers = outcome.cloud or cloud, {**layers, **outcome.layers}
    return Outcome(cloud, layers)


@cache
def _simulated(name: str, tunables: tuple[tuple[str, Any], ...]) -> Outcome:
    """Return the results of a simulation, which several scenes share."""
    return run_stage(STAGES[name], **dict(tunables))


def drawn(scene: Scene) -> QImage:
    """Return the picture of a scene."""
    outcome = made(scene)
    cloud = outcome.cloud
    west, south, east, north = scene.box
    x, y, _ = cloud.get("xyz").T
    cloud = cloud.take(np.flatnonzero((x >= west) & (x <= east) & (y >= south) & (y <= north)))
    xyz = cloud.get("xyz")
    view = View(xyz[~np.isin(cloud.get("classification"), NOISE_CLASSES)], scene)
    pixels = view.points(xyz, colors(cloud, scene.color), scene.pixels)
    height, width = pixels.shape[:2]
    image = QImage(pixels.tobytes(), width, height, 3 * width, QImage.Format.Format_RGB888).copy()
    painter = QPainter(image)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(QPen(LINE, 1.6))
    # Crowns over the corner of a roof would lift its outline.
    is_building = cloud.get("classification") == PointClass.BUILDING
    below = xyz[is_building] if is_building.any() else xyz
    for name in scene.lines.split():
        for ring in rings(outcome.layers[name], scene.box):
            painter.drawPolyline(QPolygonF([QPointF(*pixel) for pixel in view.pixels(with_heights(ring, below))]))
    painter.end()
    return image


class View:
    """A parallel projection, and the size of the picture that a cloud needs."""

    def __init__(self, xyz: np.ndarray, scene: Scene) -> None:
        across, tilt = np.radians(scene.azimuth), np.radians(scene.tilt)
        right = np.array([np.cos(across), np.sin(across), 0.0])
        away = np.array([-np.sin(across), np.cos(across), 0.0])
        up = np.cos(tilt) * away + np.sin(tilt) * np.array([0.0, 0.0, 1.0])
        self._axes = np.stack([right, -up, np.sin(tilt) * away - np.cos(tilt) * np.array([0.0, 0.0, 1.0])])
        seen = xyz @ self._axes[:2].T
        # Stray points may lie outside.
        self._low, high = np.percentile(seen, 0.02, axis=0), np.percentile(seen, 99.98, axis=0)
        self._scale = WIDTH * (1 - 2 * MARGIN) / (high[0] - self._low[0])
        self._scale = min(self._scale, scene.height * (1 - 2 * MARGIN) / (high[1] - self._low[1]))
        self._size = np.ceil((high - self._low) * self._scale + 2 * MARGIN * WIDTH).astype(int)

    def pixels(self, xyz: np.ndarray) -> np.ndarray:
        """Return columns and rows (n, 2) of points."""
        return (xyz @ self._axes[:2].T - self._low) * self._scale + MARGIN * WIDTH

    def points(self, xyz: np.ndarray, color: np.ndarray, side: int) -> np.ndarray:
        """Return the picture (rows, columns, 3), uint8, of points as squares of ``side`` pixels, nearest in front."""
        columns, rows = self._size
        depth = np.full((rows, columns), np.inf)
        picture = np.full((rows, columns, 3), 255.0)
        far = xyz @ self._axes[2]
        order = np.argsort(-far)
        place = np.round(self.pixels(xyz[order])).astype(int) - side // 2
        for down in range(side):
            for over in range(side):
                column, row = place[:, 0] + over, place[:, 1] + down
                inside = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
                # Of points that fall on a pixel the last, which is the nearest, stays.
                at, which = row[inside] * columns + column[inside], order[inside]
                last = np.full(rows * columns, -1)
                last[at] = which
                nearer = (last >= 0) & (np.where(last >= 0, far[last], np.inf) < depth.ravel())
                depth.ravel()[nearer] = far[last[nearer]]
                picture.reshape(-1, 3)[nearer] = color[last[nearer]]
        return (picture * lighting(depth)[..., None]).round().astype(np.uint8)


def lighting(depth: np.ndarray) -> np.ndarray:
    """Return how light each pixel is, 0 to 1, by eye-dome lighting of depths (m), infinite where nothing is."""
    behind = np.zeros(depth.shape)
    known = np.where(np.isfinite(depth), depth, np.nanmax(depth[np.isfinite(depth)]))
    for pixels in LIGHTING_PIXELS:
        for axis in (0, 1):
            for step in (-pixels, pixels):
                behind += np.clip(known - np.roll(known, step, axis), 0, LIGHTING_DEPTH) / pixels
    light = np.exp(-LIGHTING_STRENGTH * behind / 4)
    return np.where(np.isfinite(depth), np.ceil(light * LIGHTING_STEPS) / LIGHTING_STEPS, 1.0)


def colors(cloud: Cloud, by: str) -> np.ndarray:
    """Return the color (n, 3) of each point by a dimension; by no dimension all points have one color."""
    if not by:
        return np.tile(np.array(NOTHING, float), (len(cloud), 1))
    if by == "colors":
        bands = np.stack([cloud.get(name) for name in ("red", "green", "blue")], axis=1) / 257.0
        return np.round(bands / COLOR_STEP) * COLOR_STEP
    values = cloud.get(by)
    if by in ("classification", "dimensionality"):
        return _style_colors(by)[np.minimum(values, 31)]
    if by in ("segment_id", "cluster_id"):
        hues = np.array([QColor.fromHsvF(i * 0.618034 % 1, 0.62, 0.92).getRgb()[:3] for i in range(HUES)], float)
        return np.where((values > 0)[:, None], hues[values % HUES], NOTHING)
    known = np.nan_to_num(values.astype(float))
    low, high = np.percentile(known, (1, 99))
    share = np.clip((known - low) / (high - low), 0, 1)
    share = np.round(share * RAMP_STEPS) / RAMP_STEPS * (len(RAMP) - 1)
    return np.stack([np.interp(share, np.arange(len(RAMP)), band) for band in RAMP.T], axis=1)


@cache
def _style_colors(by: str) -> np.ndarray:
    """Return the colors (32, 3) of the classes in the style that layers have in QGIS."""
    text = (STYLES / f"{by}.qml").read_text(encoding="utf-8")
    table = np.full((32, 3), NOTHING, float)
    for value, color in re.findall(r'<category value="(\d+)"[^>]*color="(\d+,\d+,\d+)', text):
        table[int(value)] = [int(part) for part in color.split(",")]
    return table


def rings(features: Any, box: tuple[float, float, float, float]) -> Iterable[np.ndarray]:
    """Yield the lines and rings of a layer that lie within a box."""
    for geometry in features.geometries:
        for line in geometry if isinstance(geometry, list) else [geometry]:
            if (line[:, :2] >= box[:2]).all() and (line[:, :2] <= box[2:]).all():
                yield line


def with_heights(line: np.ndarray, xyz: np.ndarray) -> np.ndarray:
    """Return a line with elevations; without its own it lies on the highest of the given points near its vertices.

    That is the median of the four highest of the 12 that are nearest in plan.
    """
    if line.shape[1] == 3:
        return line
    from scipy.spatial import cKDTree

    near = cKDTree(xyz[:, :2]).query(line, 12)[1]
    return np.column_stack([line, np.median(np.sort(xyz[near, 2], axis=1)[:, -4:], axis=1)])


def main() -> None:
    """Draw all pictures, or the pictures of the ids given."""
    application = QGuiApplication([])
    PICTURES.mkdir(exist_ok=True)
    by_id = {stage.id: stage for stage in STAGES.values()}
    for name in sys.argv[1:] or [name for name in captions() if name != "segmentplaneshough"]:
        image = drawn(SCENES[name] if name in SCENES else derived_scene(by_id[name]))
        if not image.save(str(PICTURES / f"{name}.png")):
            raise SystemExit(f"{PICTURES} can't be written")
        print(name, image.width(), image.height(), (PICTURES / f"{name}.png").stat().st_size, flush=True)
    del application


if __name__ == "__main__":
    main()
