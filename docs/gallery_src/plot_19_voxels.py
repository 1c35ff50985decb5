"""
Voxels
======

Each occupied voxel becomes the center of gravity of its points, and counts them.
"""

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stages import STAGES

town = {"size": 50.0, "density": 20.0, "buildings": 34.0, "trees": 25.0, "forest": 0.05, "river": False}
cloud = run_stage(STAGES["simulate_town"], noise_points=0.0, **town).cloud
found = run_stage(STAGES["downsample_voxels"], cloud, voxel_size=1.0).cloud

found = found.take(np.argsort(found.get("xyz")[:, 2]))
plt.style.use("dark_background")
ax = plt.subplots(figsize=(7, 6))[1]
drawn = ax.scatter(*found.get("xyz")[:, :2].T, s=14, c=found.get("voxel_count"), cmap="turbo", vmax=30)
plt.colorbar(drawn, label="points of a voxel", shrink=0.7)
ax.set(aspect="equal", title=f"{len(cloud):,} points became {len(found):,}")
