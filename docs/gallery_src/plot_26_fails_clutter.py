"""
Failure: facades behind trees and cars
======================================

What trees and parked cars hide of a facade is no part of it: windows behind them are missing (blue: windows and
doors that were found, gray: points of the scan).
"""

import matplotlib.pyplot as plt
import numpy as np
from scenes import after, simulated

cloud = simulated("simulate_street", length=30.0, clutter=True, line_rate=50.0).cloud
cloud.set("classification", np.zeros(len(cloud), np.uint8))
results = after("model_facades", cloud)
xyz = results.cloud.get("xyz")
north = xyz[:, 1] > np.median(xyz[:, 1])
ax = plt.subplots(figsize=(8, 4))[1]
ax.scatter(xyz[north, 0], xyz[north, 2], s=0.2, c="#bbbbbb", linewidths=0)
for rings in results.layers["openings"].geometries:
    ring = np.asarray(rings[0])
    if ring[:, 1].mean() > np.median(xyz[:, 1]):
        ax.plot(ring[:, 0], ring[:, 2], color="#1565c0")
ax.set(
    aspect="equal", xlim=(14, 47), xlabel="m", ylabel="elevation (m)", title="one side of a street with trees and cars"
)
