"""
A map that is updated
=====================

*Update map* keeps the outlines, ids and attributes of a map, and draws anew only what the points show otherwise. Here
an old map lacks a house, has one that was torn down, one drawn 1.5 m off, and one with a wing that is there no more.
"""

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.geometry.rings import polygon_area
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.quality.map_changes import COLORS, GONE
from lidar_buildings.algorithms.run import run_pipeline, run_stage
from lidar_buildings.algorithms.stage import LayerFeatures
from lidar_buildings.algorithms.stages import STAGES

cloud = run_stage(STAGES["simulate_town"], size=120.0, density=8.0, buildings=30.0, trees=5.0).cloud
cloud.set("classification", np.zeros(len(cloud), np.uint8))
results = run_pipeline(PIPELINES["detect_buildings"], cloud)

found = results.layers["footprints"].geometries
houses = sorted((rings for rings in found if len(rings[0]) == 5), key=polygon_area, reverse=True)
wing = houses[1][0].copy()
wing[[0, 1, 4]] += 4 * (wing[1] - wing[2]) / np.hypot(*(wing[1] - wing[2]))
torn_down = [np.array([[0, 0], [9, 0], [9, 7], [0, 7], [0, 0]]) + [98.0, 45.0]]
others = [rings for rings in found if not any(rings is house for house in houses[:3])]
old = [[houses[0][0] + [1.2, -0.9]], [wing], torn_down, *others]

# %%
# Each building gets its status; those that are gone are in a layer of their own.
layers = {"old_map": LayerFeatures(old, {"id": list(range(101, 101 + len(old)))})}
made = run_stage(STAGES["update_map"], results.cloud, input_layers=layers).layers
updated, gone = made["updated_map"], made["buildings_gone"]

plt.style.use("dark_background")
ax = plt.subplots(figsize=(8, 6))[1]
kinds = [*updated.columns["status"], *[GONE] * len(gone)]
for rings, kind in zip([*updated.geometries, *gone.geometries], kinds):
    ax.fill(*rings[0].T, facecolor=COLORS[kind], edgecolor="white", linewidth=0.5)
for rings in old:
    ax.plot(*rings[0].T, color="white", linewidth=0.8, linestyle=":")
for kind in dict.fromkeys(kinds):
    ax.fill([], [], facecolor=COLORS[kind], label=kind)
ax.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
ax.set(aspect="equal", xlabel="m", ylabel="m")
plt.tight_layout()
