"""
Failure: facades behind trees and cars
======================================

What trees and parked cars hide of a facade is no part of it: windows behind them are missing. Windows and doors that
were found are white, and points are colored by how far they are before the fronts.
"""

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline, run_stage
from lidar_buildings.algorithms.stages import STAGES

cloud = run_stage(STAGES["simulate_street"], length=30.0, clutter=True, line_rate=50.0).cloud
cloud.set("classification", np.zeros(len(cloud), np.uint8))
results = run_pipeline(PIPELINES["model_facades"], cloud)

# %%
# One side of the street, seen from the other: points behind the middle of the street, the nearest last.
xyz = results.cloud.get("xyz")
middle = np.median(xyz[:, 1])
side = xyz[xyz[:, 1] > middle]
side = side[np.argsort(-side[:, 1])]
plt.style.use("dark_background")
ax = plt.subplots(figsize=(8, 4.4))[1]
ax.scatter(side[:, 0], side[:, 2], s=0.5, c=side[:, 1], cmap="viridis_r")
for rings in results.layers["openings"].geometries:
    ring = np.asarray(rings[0])
    if ring[:, 1].mean() > middle:
        ax.plot(ring[:, 0], ring[:, 2], color="white", linewidth=2)
ax.set(aspect="equal", xlim=(23, 47), xlabel="easting (m)", ylabel="elevation (m)")
plt.tight_layout()
