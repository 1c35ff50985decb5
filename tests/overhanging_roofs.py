"""Roofs whose eaves overhang walls that are seen below them."""

from __future__ import annotations

import numpy as np

from lidar_buildings.algorithms.geometry.polygon_overlap import are_within
from lidar_buildings.algorithms.geometry.rings import distances_to_rings, sides_of_rings
from lidar_buildings.algorithms.stage import LayerFeatures

# How far roofs overhang, and how thick they are over their eaves (m).
OVERHANG, THICKNESS = 0.5, 0.25


def along(start, end, step=0.1):
    """Return positions on a line, a step apart."""
    return start + np.arange(step / 2, np.hypot(*(end - start)), step)[:, None] * (end - start) / np.hypot(
        *(end - start)
    )


def inset(start, end):
    """Return positions on the line to the left of a side that is as far inside as the roof overhangs."""
    way = (end - start) / np.hypot(*(end - start))
    return along(start, end) + OVERHANG * np.array([-way[1], way[0]])


def overhanging(shape, turn=0.0, seen=(0, 1, 2, 3, 4, 5, 6, 7)):
    """Return points, classes and footprint of a roof, with points of the walls below some of its sides."""
    roof, ring = shape.scanned(15.0, turn=turn)
    rng, sides = np.random.default_rng(0), sides_of_rings([ring])
    positions = np.concatenate([np.zeros((0, 2)), *(inset(*sides[k]) for k in seen if k < len(sides))])
    positions = positions[are_within(positions, sides) & (distances_to_rings(positions, [ring]) > OVERHANG - 0.01)]
    walls = np.column_stack([positions + rng.normal(0, 0.02, positions.shape), rng.uniform(0.2, 3.2, len(positions))])
    ground = np.column_stack([rng.uniform(-25, 35, (9000, 2)), rng.normal(0, 0.02, 9000)])
    ground = ground[~are_within(ground[:, :2], sides)]
    xyz = np.concatenate([roof, walls, ground])
    classes = np.repeat([6, 6, 2], [len(roof), len(walls), len(ground)]).astype(np.uint8)
    return xyz, classes, LayerFeatures([[ring]], {"id": [7]})
