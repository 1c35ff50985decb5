"""
Planes by RANSAC
================

Random samples of three points per voxel; the plane with most points is taken :cite:p:`fischler1981,hrutka2022`.
"""

import matplotlib.pyplot as plt

from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stages import STAGES

town = {"size": 80.0, "density": 8.0, "buildings": 34.0, "trees": 25.0, "forest": 0.05, "river": False}
cloud = run_stage(STAGES["simulate_town"], noise_points=0.0, **town).cloud
found = run_stage(STAGES["segment_planes_ransac"], cloud).cloud

xyz, ids = found.get("xyz"), found.get("segment_id")
inside = ids > 0
plt.style.use("dark_background")
ax = plt.subplots(figsize=(7, 7))[1]
ax.scatter(*xyz[~inside, :2].T, s=1, c="dimgray")
ax.scatter(*xyz[inside, :2].T, s=2, c=ids[inside] % 20, cmap="tab20")
ax.set(aspect="equal", xlabel="easting (m)", ylabel="northing (m)")
