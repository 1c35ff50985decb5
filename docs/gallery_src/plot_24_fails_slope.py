"""
Failure: the ground of a model is level
=======================================

A house on a slope of 15°, from the side. *Model buildings* ends its walls at the lowest ground around
(black), so that uphill they go on below the terrain.
"""

import numpy as np
from scenes import after, profile

from lidar_buildings.algorithms.cloud.cloud import create_cloud

rng = np.random.default_rng(1)
x, y = rng.uniform(0, 40, (2, 16_000))
slope = np.tan(np.deg2rad(15.0)) * x
house = (np.abs(x - 20) < 6) & (np.abs(y - 20) < 5)
z = np.where(house, 13.0 - 0.6 * np.abs(y - 20), slope)
cloud = create_cloud({"xyz": np.column_stack([x, y, z + rng.normal(0, 0.02, len(x))])})
results = after("model_buildings", cloud)
ax = profile(results.cloud, 12, 28, title="walls of the model, black, on a slope")
for rings in results.layers["walls"].geometries:
    for ring in rings:
        ax.plot(ring[:, 0], ring[:, 2], color="black", linewidth=1.0)
