"""
Failure: a container is a building
==================================

A container is as flat, as high and as opaque as a shed, and *Detect buildings* calls it one. The footprints
outlined are those of a house (north) and of a container of 12 by 2.5 m (south).
"""

import numpy as np
from scenes import after, outlines, plan

from lidar_buildings.algorithms.cloud.cloud import create_cloud

rng = np.random.default_rng(1)
x, y = rng.uniform(0, 40, (2, 16_000))
house = (np.abs(x - 20) < 6) & (np.abs(y - 28) < 4)
container = (np.abs(x - 20) < 6) & (np.abs(y - 9) < 1.25)
z = np.select([house, container], [6 - 0.5 * np.abs(y - 28), np.full(len(x), 2.6)], 0.0)
cloud = create_cloud({"xyz": np.column_stack([x, y, z + rng.normal(0, 0.02, len(x))])})
results = after("detect_buildings", cloud)
ax = plan(results.cloud, title="a house, and a container taken for one")
outlines(ax, results.layers["footprints"])
