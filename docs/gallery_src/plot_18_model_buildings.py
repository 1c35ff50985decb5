"""
Models of buildings
===================

Planes of the roof, an arrangement of their lines in the footprint, and a closed solid :cite:p:`peters2022`.
"""

import matplotlib.pyplot as plt
import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from scenes import after, town

cloud, truth = town(size=60.0)
results = after("model_buildings", cloud)
figure = plt.figure(figsize=(7, 6))
ax = figure.add_subplot(projection="3d")
for name, color in (("walls", "#d7ccc8"), ("roofs", "#c62828")):
    for rings in results.layers[name].geometries:
        ring = np.asarray(rings[0])
        if ring.shape[1] == 3:
            ax.add_collection3d(Poly3DCollection([ring], facecolor=color, edgecolor="#5d4037", linewidth=0.4))
xyz = results.cloud.get("xyz")
ax.set(xlim=(xyz[:, 0].min(), xyz[:, 0].max()), ylim=(xyz[:, 1].min(), xyz[:, 1].max()))
ax.set_zlim(xyz[:, 2].min(), xyz[:, 2].min() + 30)
