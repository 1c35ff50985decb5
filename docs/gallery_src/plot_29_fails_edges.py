"""
Failure: edges are linear
=========================

The neighborhood of a point at an edge is cut off, and looks like a line or a volume: rims of roofs are not planar
(orange linear, blue planar, green volumetric).
"""

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline, run_stage
from lidar_buildings.algorithms.stages import STAGES

town = {"size": 50.0, "density": 8.0, "buildings": 34.0, "trees": 0.0, "forest": 0.0, "river": False}
cloud = run_stage(STAGES["simulate_town"], noise_points=0.0, **town).cloud
found = run_pipeline(PIPELINES["interpret_structure"], cloud).cloud

found = found.take(np.argsort(found.get("xyz")[:, 2]))
colors = np.array(["dimgray", "orange", "royalblue", "limegreen"])
plt.style.use("dark_background")
ax = plt.subplots(figsize=(7, 7))[1]
ax.scatter(*found.get("xyz")[:, :2].T, s=4, c=colors[found.get("dimensionality")])
ax.set(aspect="equal", title="linear points at the rims of roofs")
