"""
Stem and branches
=================

Voxels have a shortest path to the root; slices of equal length of path are followed to stem and branches
:cite:p:`gorte2004`.
"""

import matplotlib.pyplot as plt
from scenes import group_colors, simulated, step

cloud = simulated("simulate_tree", height=8.0, density=1500.0).cloud
found = step("segment_tree", cloud).cloud
xyz, ids = found.get("xyz"), found.get("segment_id")
figure, ax = plt.subplots(figsize=(5, 6))
ax.scatter(xyz[:, 0], xyz[:, 2], s=1, c=group_colors(ids), linewidths=0)
ax.set(aspect="equal", xlabel="m", ylabel="elevation (m)")
