"""
Mean entropy of clusters
========================

As published, K-means with two means separates buildings from vegetation by the clusters' entropies
:cite:p:`santos2019`.
"""

import matplotlib.pyplot as plt
import numpy as np
from scenes import step, town

cloud, truth = town(size=80.0)
cloud.set("classification", truth)
found = step("classify_buildings_2019", step("segment_regions", cloud).cloud).cloud
mean = found.get("cluster_entropy")
called = found.get("classification") == 6
figure, ax = plt.subplots(figsize=(7, 3))
for values, name, color in ((mean[called], "building", "#e53935"), (mean[~called], "other", "#2e7d32")):
    ax.hist(values[np.isfinite(values)], 40, label=name, color=color, alpha=0.8)
ax.set(xlabel="mean entropy of the cluster", ylabel="points")
ax.legend()
