"""
Failure: a container is a building
==================================

A container is as flat, as high and as opaque as a shed, and *Detect buildings* calls it one. The footprints
outlined are those of a house (north) and of a container of 12 by 2.5 m (south).
"""

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline

rng = np.random.default_rng(1)
x, y = rng.uniform(0, 40, (2, 16_000))
house = (np.abs(x - 20) < 6) & (np.abs(y - 28) < 4)
container = (np.abs(x - 20) < 6) & (np.abs(y - 9) < 1.25)
z = np.select([house, container], [6 - 0.5 * np.abs(y - 28), np.full(len(x), 2.6)], 0.0)
cloud = create_cloud({"xyz": np.column_stack([x, y, z + rng.normal(0, 0.02, len(x))])})
results = run_pipeline(PIPELINES["detect_buildings"], cloud)

found = results.cloud.get("classification") == 6
plt.style.use("dark_background")
ax = plt.subplots(figsize=(6, 6))[1]
ax.scatter(*results.cloud.get("xyz")[:, :2].T, s=3, c=np.where(found, "crimson", "peru"))
for rings in results.layers["footprints"].geometries:
    ax.plot(*np.asarray(rings[0])[:, :2].T, color="white", linewidth=2)
ax.set(aspect="equal", title="a house, and a container taken for one")
