"""
Rasters of terrain and heights
==============================

The bare earth (left), and the heights above it (right).
"""

import matplotlib.pyplot as plt

from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stages import STAGES

town = {"size": 80.0, "density": 8.0, "buildings": 34.0, "trees": 25.0, "forest": 0.05, "river": False}
cloud = run_stage(STAGES["simulate_town"], noise_points=0.0, **town, slope=4.0).cloud
rasters = run_stage(STAGES["rasterize_terrain"], cloud, cell_size=0.5).rasters

plt.style.use("dark_background")
axes = plt.subplots(1, 2, figsize=(10, 4.4))[1]
for ax, name, colors in zip(axes, ("dtm", "ndsm"), ("gist_earth", "inferno")):
    drawn = ax.imshow(rasters[name].values, cmap=colors)
    plt.colorbar(drawn, ax=ax, shrink=0.8, label="m")
    ax.set_title(name)
