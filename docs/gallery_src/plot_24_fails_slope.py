"""
Failure: the ground of a model is level
=======================================

A house on a slope of 15°, from the side. *Model buildings* ends its walls at the lowest ground around
(white), so that uphill they go on below the terrain. With a *Terrain tolerance* they end on it.
"""

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline

rng = np.random.default_rng(1)
x, y = rng.uniform(0, 40, (2, 16_000))
slope = np.tan(np.deg2rad(15.0)) * x
house = (np.abs(x - 20) < 6) & (np.abs(y - 20) < 5)
z = np.where(house, 13.0 - 0.6 * np.abs(y - 20), slope)
cloud = create_cloud({"xyz": np.column_stack([x, y, z + rng.normal(0, 0.02, len(x))])})
results = run_pipeline(PIPELINES["model_buildings"], cloud)

xyz = results.cloud.get("xyz")
strip = np.abs(xyz[:, 1] - 20) < 8
is_building = results.cloud.get("classification")[strip] == 6
plt.style.use("dark_background")
ax = plt.subplots(figsize=(8, 3.6))[1]
ax.scatter(xyz[strip, 0], xyz[strip, 2], s=3, c=np.where(is_building, "crimson", "peru"))
for rings in results.layers["walls"].geometries:
    for ring in rings:
        ax.plot(ring[:, 0], ring[:, 2], color="white", linewidth=1.5)
ax.set(aspect="equal", xlabel="easting (m)", ylabel="elevation (m)", title="walls of the model on a slope")
plt.tight_layout()
