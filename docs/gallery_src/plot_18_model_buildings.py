"""
Models of buildings
===================

Planes of the roof, an arrangement of their lines in the footprint, and a closed solid :cite:p:`peters2022`.
"""

import matplotlib.pyplot as plt
import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline, run_stage
from lidar_buildings.algorithms.stages import STAGES

town = {"size": 80.0, "density": 8.0, "buildings": 34.0, "trees": 25.0, "forest": 0.05, "river": False}
cloud = run_stage(STAGES["simulate_town"], noise_points=0.0, **town).cloud
cloud.set("classification", np.zeros(len(cloud), np.uint8))
results = run_pipeline(PIPELINES["model_buildings"], cloud)

# %%
# Walls and roofs are layers of polygons in three dimensions.
plt.style.use("dark_background")
ax = plt.figure(figsize=(8, 4.5)).add_axes((0, 0, 1, 1), projection="3d")
for name, color in (("walls", "wheat"), ("roofs", "tomato")):
    faces = [np.asarray(rings[0]) for rings in results.layers[name].geometries]
    ax.add_collection3d(Poly3DCollection(faces, facecolor=color, edgecolor="black", linewidth=0.5))
corners = np.concatenate([np.asarray(rings[0]) for rings in results.layers["walls"].geometries])
(west, south, bottom), (east, north, top) = corners.min(axis=0), corners.max(axis=0)
ax.set(xlim=(west, east), ylim=(south, north), zlim=(bottom, top))
ax.set_box_aspect((east - west, north - south, top - bottom), zoom=1.3)
ax.view_init(elev=35, azim=-65)
ax.set_axis_off()
