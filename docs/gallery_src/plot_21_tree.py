"""
Stem and branches
=================

Voxels have a shortest path to the root; slices of equal length of path are followed to stem and branches
:cite:p:`gorte2004`.
"""

import matplotlib.pyplot as plt

from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stages import STAGES

cloud = run_stage(STAGES["simulate_tree"], height=8.0, density=1500.0).cloud
found = run_stage(STAGES["segment_tree"], cloud).cloud

xyz, ids = found.get("xyz"), found.get("segment_id")
plt.style.use("dark_background")
ax = plt.subplots(figsize=(6, 6))[1]
ax.scatter(xyz[:, 0], xyz[:, 2], s=1, c=ids % 20, cmap="tab20")
ax.set(aspect="equal", xlabel="easting (m)", ylabel="elevation (m)")
