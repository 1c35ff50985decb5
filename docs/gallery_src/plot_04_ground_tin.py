"""
Ground by triangulation
=======================

A triangulation of certain ground points grows point by point :cite:p:`axelsson2000`. A strip of a town on a slope,
from the side, with the ground in orange.
"""

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stages import STAGES

cloud = run_stage(STAGES["simulate_town"], size=80.0, density=8.0, buildings=34.0, slope=12.0, river=False).cloud
cloud.set("classification", np.zeros(len(cloud), np.uint8))
found = run_stage(STAGES["classify_ground_tin"], cloud).cloud

xyz = found.get("xyz")
strip = np.abs(xyz[:, 1] - 25) < 5
ground = strip & (found.get("classification") == 2)
plt.style.use("dark_background")
ax = plt.subplots(figsize=(8, 3.4))[1]
ax.scatter(xyz[strip, 0], xyz[strip, 2], s=2, c="deepskyblue")
ax.scatter(xyz[ground, 0], xyz[ground, 2], s=2, c="orange")
ax.set(aspect="equal", xlabel="easting (m)", ylabel="elevation (m)")
plt.tight_layout()
