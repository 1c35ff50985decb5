"""
Noise by the histogram of heights
=================================

The height histogram of each cell has one main body; sparse bins outside of it are noise :cite:p:`santos2019`.
Noise is yellow here.
"""

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stages import STAGES

cloud = run_stage(STAGES["simulate_town"], size=80.0, density=8.0, noise_points=200.0).cloud
cloud.set("classification", np.zeros(len(cloud), np.uint8))
found = run_stage(STAGES["classify_noise_histogram"], cloud).cloud

xyz = found.get("xyz")
is_noise = np.isin(found.get("classification"), [7, 18])
plt.style.use("dark_background")
ax = plt.subplots(figsize=(8, 4))[1]
ax.scatter(xyz[:, 0], xyz[:, 2], s=1, c=xyz[:, 2], cmap="cool", vmax=20)
ax.scatter(xyz[is_noise, 0], xyz[is_noise, 2], s=8, c="yellow")
ax.set(xlabel="easting (m)", ylabel="elevation (m)")
