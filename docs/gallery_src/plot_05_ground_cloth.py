"""
Ground by cloth simulation
==========================

A cloth falls on the cloud turned upside down :cite:p:`zhang2016`. The ground is colored by its elevation.
"""

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stages import STAGES

town = {"size": 80.0, "density": 8.0, "buildings": 34.0, "trees": 25.0, "forest": 0.05, "river": False}
cloud = run_stage(STAGES["simulate_town"], noise_points=0.0, **town, slope=4.0).cloud
cloud.set("classification", np.zeros(len(cloud), np.uint8))
found = run_stage(STAGES["classify_ground_cloth"], cloud).cloud

xyz = found.get("xyz")
ground = found.get("classification") == 2
plt.style.use("dark_background")
ax = plt.subplots(figsize=(7, 6))[1]
ax.scatter(*xyz[~ground, :2].T, s=2, c="dimgray")
drawn = ax.scatter(*xyz[ground, :2].T, s=2, c=xyz[ground, 2], cmap="gist_earth")
plt.colorbar(drawn, label="elevation of the ground (m)", shrink=0.7)
ax.set(aspect="equal", xlabel="easting (m)", ylabel="northing (m)")
