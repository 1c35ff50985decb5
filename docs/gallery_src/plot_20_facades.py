"""
Facades of a street
===================

Upright planes of a vehicle's scan, with their outlines, and the windows and doors in them :cite:p:`peng2018`.
"""

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline, run_stage
from lidar_buildings.algorithms.stages import STAGES

cloud = run_stage(STAGES["simulate_street"], length=30.0, clutter=False, line_rate=50.0).cloud
cloud.set("classification", np.zeros(len(cloud), np.uint8))
results = run_pipeline(PIPELINES["model_facades"], cloud)

# %%
# Both sides of the street: facades that look north, and those that look south, with their windows and doors.
facades, openings = results.layers["openings_facades"], results.layers["openings"]
looks_north = np.cos(np.deg2rad(facades.columns["azimuth"])) > 0
side_of = dict(zip(facades.columns["id"], looks_north))
plt.style.use("dark_background")
axes = plt.subplots(2, 1, figsize=(8, 6))[1]
for number, rings in enumerate(facades.geometries):
    wall, color = np.asarray(rings[0]), plt.get_cmap("Set2")(number % 8)
    axes[int(looks_north[number])].fill(wall[:, 0], wall[:, 2], facecolor=color, edgecolor="white")
for facade, rings in zip(openings.columns["facade"], openings.geometries):
    hole = np.asarray(rings[0])
    axes[int(side_of[facade])].fill(hole[:, 0], hole[:, 2], facecolor="midnightblue", edgecolor="white")
for ax, title in zip(axes, ("facades that look south", "facades that look north")):
    ax.set(aspect="equal", title=title, ylabel="elevation (m)")
plt.tight_layout()
