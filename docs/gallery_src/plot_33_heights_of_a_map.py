"""
Heights for any map
===================

*Heights of buildings* gives the polygons of any map ground, eaves, ridge and roof type, without models. Here a map has
squared outlines alone; each house is drawn in the color of the height of its ridge.
"""

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stage import LayerFeatures
from lidar_buildings.algorithms.stages import STAGES

village = run_stage(STAGES["simulate_village"], size=120.0, density=20.0)
old_map = village.layers["old_map"]
outlines = LayerFeatures(old_map.geometries, {"id": list(range(1, 1 + len(old_map)))})
layers = {"footprints": outlines}
buildings = run_stage(STAGES["compute_building_heights"], village.cloud, input_layers=layers).layers["buildings"]

# %%
# All attributes of the map stay, and new ones come next to them.
plt.style.use("dark_background")
ax = plt.subplots(figsize=(8, 6))[1]
ridge = np.array(buildings.columns["ridge_height"])
color = plt.get_cmap("viridis")((ridge - np.nanmin(ridge)) / np.ptp(ridge[np.isfinite(ridge)]))
names = [kind or state for kind, state in zip(buildings.columns["roof_type"], buildings.columns["state"])]
for rings, one, high, name in zip(buildings.geometries, color, ridge, names):
    ax.fill(*rings[0].T, facecolor=one if np.isfinite(high) else "none", edgecolor="white", linewidth=0.5)
    ax.annotate(
        f"{high:.1f} m\n{name}" if np.isfinite(high) else name,
        rings[0].mean(axis=0),
        ha="center",
        va="center",
        fontsize=7,
    )
ax.set(aspect="equal", xlabel="m", ylabel="m")
plt.tight_layout()
