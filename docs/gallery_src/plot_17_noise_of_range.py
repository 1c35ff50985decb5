"""
How noise of the range acts
===========================

The same town with 2 and 10 cm of noise: tolerances follow the measured noise. Buildings that were found are red,
points of buildings that were missed yellow, and points of other objects that were taken for buildings blue.
"""

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline, run_stage
from lidar_buildings.algorithms.stages import STAGES

town = {"size": 60.0, "density": 8.0, "buildings": 34.0, "trees": 25.0, "forest": 0.05, "river": False}
plt.style.use("dark_background")
axes = plt.subplots(1, 2, figsize=(11, 5.4))[1]
for ax, noise in zip(axes, (0.02, 0.10)):
    cloud = run_stage(STAGES["simulate_town"], range_noise=noise, **town).cloud
    true = cloud.get("classification") == 6
    cloud.set("classification", np.zeros(len(cloud), np.uint8))
    found = run_pipeline(PIPELINES["detect_buildings"], cloud).cloud
    called = found.get("classification") == 6
    color = np.select([called & true, true, called], ["crimson", "yellow", "deepskyblue"], "dimgray")
    ax.scatter(*found.get("xyz")[:, :2].T, s=2, c=color)
    ax.set(aspect="equal", title=f"{100 * noise:.0f} cm: {100 * (called == true).mean():.1f} % right")
