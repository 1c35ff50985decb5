"""
How good it is
==============

A classified cloud is compared with the truth: completeness, correctness and F of points and of objects.
"""

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline, run_stage
from lidar_buildings.algorithms.stages import STAGES

truth = run_stage(STAGES["simulate_town"], size=80.0, density=8.0, buildings=34.0).cloud
cloud = truth.copy()
cloud.set("classification", np.zeros(len(cloud), np.uint8))
results = run_pipeline(PIPELINES["detect_buildings"], cloud)
values = run_stage(STAGES["assess_buildings"], results.cloud, truth).report.values

names = ["points_completeness", "points_correctness", "points_f"]
plt.style.use("dark_background")
ax = plt.subplots(figsize=(7, 2.6))[1]
bars = ax.barh([name.replace("_", ": ") for name in names], [values[name] for name in names], color="crimson")
ax.bar_label(bars, fmt="%.1f", padding=4)
ax.set(xlim=(0, 115), xlabel="%")
plt.tight_layout()
