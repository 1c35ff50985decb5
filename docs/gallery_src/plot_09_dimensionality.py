"""
Linear, planar, volumetric
==========================

Each point gets the class of its largest feature: linearity (orange), planarity (blue) or scattering (green).
"""

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stages import STAGES

town = {"size": 60.0, "density": 12.0, "buildings": 34.0, "trees": 25.0, "forest": 0.05, "river": False}
cloud = run_stage(STAGES["simulate_town"], noise_points=0.0, **town).cloud
features = run_stage(STAGES["compute_features"], cloud, n_neighbors=20).cloud
found = run_stage(STAGES["classify_dimensionality"], features).cloud

found = found.take(np.argsort(found.get("xyz")[:, 2]))
colors = np.array(["dimgray", "orange", "royalblue", "limegreen"])
plt.style.use("dark_background")
ax = plt.subplots(figsize=(7, 7))[1]
ax.scatter(*found.get("xyz")[:, :2].T, s=2, c=colors[found.get("dimensionality")])
ax.set(aspect="equal", xlabel="easting (m)", ylabel="northing (m)")
