"""
Failure: pipes thinner than the points are apart
================================================

*Detect cylinders* finds a pipe by the directions of its surface, which need several points across. Of five
pipes scanned with points 3 cm apart those of 2 and 4 cm in diameter are lost (gray).
"""

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stages import STAGES

rng = np.random.default_rng(1)
parts = []
for number, diameter in enumerate([0.02, 0.04, 0.08, 0.16, 0.32]):
    count = int(np.pi * diameter * 4 / 0.03**2)
    angle, along = rng.uniform(0, 2 * np.pi, count), rng.uniform(0, 4, count)
    radius = diameter / 2
    parts.append(np.column_stack([number + radius * np.cos(angle), along, 2 + radius * np.sin(angle)]))
xyz = np.concatenate(parts)
cloud = create_cloud({"xyz": xyz + rng.normal(0, 0.001, xyz.shape)})
found = run_stage(STAGES["detect_cylinders"], cloud).cloud

xyz, ids = found.get("xyz"), found.get("segment_id")
colors = np.array(["gray", "tomato", "deepskyblue", "limegreen", "gold", "orchid"])
plt.style.use("dark_background")
ax = plt.subplots(figsize=(7, 6))[1]
ax.scatter(*xyz[:, :2].T, s=4, c=colors[ids])
ax.set(aspect="equal", xlabel="easting (m)", ylabel="northing (m)", title="pipes of 2, 4, 8, 16 and 32 cm")
