"""
Failure: walls that were not seen
=================================

Seen straight down, the walls below the eaves have no points. *Map footprints* then sets them as far inside
the edge of the roof as the walls it saw, or, as here, outlines the roofs (white); the true walls are dashed.
"""

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline, run_stage
from lidar_buildings.algorithms.stages import STAGES

village = run_stage(STAGES["simulate_village"], size=80.0, density=40.0, buildings=15.0, oblique=0.0)
cloud = village.cloud
cloud.set("classification", np.zeros(len(cloud), np.uint8))
results = run_pipeline(PIPELINES["map_footprints"], cloud)

found = results.cloud.take(np.argsort(results.cloud.get("xyz")[:, 2]))
colors = np.full(32, "gray", object)
colors[[2, 6]] = ["peru", "crimson"]
plt.style.use("dark_background")
ax = plt.subplots(figsize=(6, 6.5))[1]
ax.scatter(*found.get("xyz")[:, :2].T, s=3, c=colors[found.get("classification")])
for layer, style in ((results.layers["wall_footprints"], "-"), (village.layers["footprints"], "--")):
    for rings in layer.geometries:
        ax.plot(*np.asarray(rings[0])[:, :2].T, color="white", linewidth=2, linestyle=style)
ax.set(aspect="equal", xlim=(44, 68), ylim=(10, 37), title="outlines, and the true walls dashed")
