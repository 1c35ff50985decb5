"""
Facades of a street
===================

Upright planes of a vehicle's scan, their outlines, windows and doors :cite:p:`peng2018`.
"""

import matplotlib.pyplot as plt
import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from scenes import simulated, step

cloud = simulated("simulate_street", length=30.0, clutter=False, line_rate=50.0).cloud
cloud.set("classification", np.zeros(len(cloud), np.uint8))
found = step("extract_facades", cloud)
figure = plt.figure(figsize=(8, 5))
ax = figure.add_subplot(projection="3d")
for rings in found.layers["facades"].geometries:
    ax.add_collection3d(Poly3DCollection([np.asarray(rings[0])], facecolor="#ffcc80", edgecolor="#5d4037"))
xyz = found.cloud.get("xyz")
ax.set(xlim=(xyz[:, 0].min(), xyz[:, 0].max()), ylim=(xyz[:, 1].min(), xyz[:, 1].max()))
ax.set_zlim(xyz[:, 2].min(), xyz[:, 2].max())
