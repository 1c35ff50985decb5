"""
Failure: a hall at the border of a survey
=========================================

In tiles each window reaches beyond its block, but nothing reaches beyond the survey. A hall of which the survey holds
one side only looks like a terrace: its roof is taken for ground (brown) where it has class 1 (blue) when the whole
hall is seen.
"""

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stages import STAGES

rng = np.random.default_rng(1)
x, y = rng.uniform(0, 120, (2, 40_000))
hall = (np.abs(x - 70) < 30) & (np.abs(y - 60) < 40)
xyz = np.column_stack([x, y, np.where(hall, 6.0, 0.0) + rng.normal(0, 0.02, x.size)])
inside = (x < 80) & (np.abs(y - 60) < 30)

plt.style.use("dark_background")
axes = plt.subplots(1, 2, figsize=(9, 5))[1]
for ax, chosen, title in ((axes[0], slice(None), "the whole hall"), (axes[1], inside, "one side of it")):
    found = run_stage(STAGES["classify_ground_tin"], create_cloud({"xyz": xyz[chosen]})).cloud
    ground = found.get("classification") == 2
    ax.scatter(*found.get("xyz")[:, :2].T, s=3, c=np.where(ground, "peru", "royalblue"))
    ax.set(aspect="equal", xlim=(0, 120), ylim=(0, 120), title=title)
