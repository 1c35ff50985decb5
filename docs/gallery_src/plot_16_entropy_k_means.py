"""
Mean entropy of clusters
========================

As published, K-means with two means separates buildings from vegetation by the clusters' entropies
:cite:p:`santos2019`.
"""

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stages import STAGES

town = {"size": 80.0, "density": 8.0, "buildings": 34.0, "trees": 25.0, "forest": 0.05, "river": False}
cloud = run_stage(STAGES["simulate_town"], noise_points=0.0, **town).cloud
regions = run_stage(STAGES["segment_regions"], cloud).cloud
found = run_stage(STAGES["classify_buildings_2019"], regions).cloud

mean = found.get("cluster_entropy")
called = found.get("classification") == 6
plt.style.use("dark_background")
ax = plt.subplots(figsize=(7, 3.6))[1]
for values, name, color in ((mean[called], "building", "crimson"), (mean[~called], "other", "limegreen")):
    ax.hist(values[np.isfinite(values)], 40, label=name, color=color)
ax.set(xlabel="mean entropy of the cluster", ylabel="points")
ax.legend()
plt.tight_layout()
