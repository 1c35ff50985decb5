"""A block of houses scanned from a vehicle and from an airplane, with what is true of it."""

from __future__ import annotations

import functools

import numpy as np

from lidar_buildings.algorithms.simulation.simulate_street import simulate_street
from lidar_buildings.algorithms.stage import LayerFeatures

# Coarse enough to be quick: facades have 100 to 300 points per m².
COARSE = {"length": 30.0, "line_rate": 40.0, "angular_step": 0.4, "houses": True, "clutter": False, "seed": 2}


@functools.cache
def seen_from(view: str) -> tuple[dict[str, np.ndarray], dict[str, LayerFeatures]]:
    """Return the points of a scan from a "vehicle" or an "airplane" by dimension, and the true layers by name."""
    made = simulate_street.stage.unpack(simulate_street(**COARSE, view=view))
    return made.dimensions, made.layers


def outlines(overhang: float = 0.0) -> LayerFeatures:
    """Return rectangles around the true houses with eaves that jut out over street and yard (m)."""
    rings = []
    for (ring,) in seen_from("airplane")[1]["outlines"].geometries:
        start, *_, end, back_end, back_start, _ = ring[:, :2]
        out = overhang * (start - back_start) / np.linalg.norm(start - back_start)
        corners = [start + out, end + out, back_end - out, back_start - out]
        rings.append([np.array([*corners, corners[0]])])
    return LayerFeatures(rings, {"id": list(range(1, len(rings) + 1))})
