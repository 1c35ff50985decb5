"""
Height above ground
===================

Elevation minus the ground below each point, on a slope.
"""

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stages import STAGES

town = {"size": 80.0, "density": 8.0, "buildings": 34.0, "trees": 25.0, "forest": 0.05, "river": False}
cloud = run_stage(STAGES["simulate_town"], noise_points=0.0, **town, slope=12.0).cloud
found = run_stage(STAGES["compute_height_above_ground"], cloud).cloud

found = found.take(np.argsort(found.get("height_above_ground")))
plt.style.use("dark_background")
ax = plt.subplots(figsize=(7, 6))[1]
drawn = ax.scatter(*found.get("xyz")[:, :2].T, s=2, c=found.get("height_above_ground"), cmap="turbo", vmin=0, vmax=12)
plt.colorbar(drawn, label="height above ground (m)", shrink=0.7)
ax.set(aspect="equal", xlabel="easting (m)", ylabel="northing (m)")
