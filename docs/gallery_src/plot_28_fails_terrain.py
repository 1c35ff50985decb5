"""
Failure: roofs and crowns joined to the terrain
===============================================

*Model terrain* asks whether segments are joined to the terrain. Pieces of walls and of crowns connect roofs and
trees with it: objects that became bare earth are red, bare earth that was lost is yellow.
"""

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline, run_stage
from lidar_buildings.algorithms.stages import STAGES

town = {"size": 80.0, "density": 8.0, "buildings": 34.0, "trees": 25.0, "forest": 0.2, "river": False, "seed": 4}
cloud = run_stage(STAGES["simulate_town"], noise_points=0.0, **town).cloud
true = cloud.get("classification") == 2
cloud.set("classification", np.zeros(len(cloud), np.uint8))
results = run_pipeline(PIPELINES["model_terrain"], cloud)

called = results.cloud.get("classification") == 2
color = np.select([called & ~true, true & ~called, called], ["crimson", "yellow", "peru"], "dimgray")
order = np.argsort(results.cloud.get("xyz")[:, 2])
plt.style.use("dark_background")
ax = plt.subplots(figsize=(7, 7))[1]
ax.scatter(*results.cloud.get("xyz")[order, :2].T, s=2, c=color[order])
ax.set(aspect="equal", title="bare earth: found (brown), invented (red), lost (yellow)")
