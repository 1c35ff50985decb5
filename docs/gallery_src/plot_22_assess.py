"""
How good it is
==============

A classified cloud beside a reference: completeness, correctness and F.
"""

import matplotlib.pyplot as plt
from scenes import after, town

from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stages import STAGES

cloud, truth = town(size=80.0)
results = after("detect_buildings", cloud)
reference = town(size=80.0)[0]
reference.set("classification", truth)
report = run_stage(STAGES["assess_buildings"], results.cloud, reference).report
names = ["points_completeness", "points_correctness", "points_f"]
figure, ax = plt.subplots(figsize=(6, 2.5))
ax.barh(names, [report.values[name] for name in names], color="#46627f")
ax.set(xlim=(0, 100), xlabel="%")
