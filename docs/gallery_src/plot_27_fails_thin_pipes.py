"""
Failure: pipes thinner than the points are apart
================================================

*Detect cylinders* finds a pipe by the directions of its surface, which need several points across. Of five
pipes scanned with points 3 cm apart those of 2 and 4 cm in diameter are lost (gray).
"""

import numpy as np
from scenes import group_colors, plan, step

from lidar_buildings.algorithms.cloud.cloud import create_cloud

rng = np.random.default_rng(1)
parts = []
for number, diameter in enumerate([0.02, 0.04, 0.08, 0.16, 0.32]):
    count = int(np.pi * diameter * 4 / 0.03**2)
    angle, along = rng.uniform(0, 2 * np.pi, count), rng.uniform(0, 4, count)
    radius = diameter / 2
    parts.append(np.column_stack([number + radius * np.cos(angle), along, 2 + radius * np.sin(angle)]))
xyz = np.concatenate(parts)
cloud = create_cloud({"xyz": xyz + rng.normal(0, 0.001, xyz.shape)})
found = step("detect_cylinders", cloud)
ax = plan(found.cloud, title="pipes of 2, 4, 8, 16 and 32 cm")
order = np.argsort(found.cloud.get("xyz")[:, 2], kind="stable")
ax.collections[-1].set_color(group_colors(found.cloud.get("segment_id"))[order])
