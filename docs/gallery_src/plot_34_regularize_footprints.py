"""
Outlines of a raster made regular
=================================

*Regularize footprints* draws polygons of any source anew, along few main directions. Here the footprints of a simulated
village were drawn on a raster of half a meter, as networks leave them, and traced again.
"""

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.geometry.cell_outlines import outline_cells
from lidar_buildings.algorithms.geometry.grid import Grid
from lidar_buildings.algorithms.geometry.polygon_overlap import are_within
from lidar_buildings.algorithms.geometry.rings import sides_of_rings
from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stage import LayerFeatures
from lidar_buildings.algorithms.stages import STAGES

CELL = 0.5
true = run_stage(STAGES["simulate_village"], size=90.0, density=5.0, buildings=15.0).layers["footprints"].geometries


def traced(rings):
    low = rings[0].min(axis=0) - CELL
    shape = np.ceil(np.ptp(rings[0], axis=0)[::-1] / CELL).astype(int) + 3
    row, column = np.indices(shape).reshape(2, -1)
    inside = np.flatnonzero(are_within(low + (np.column_stack([column, row]) - 0.5) * CELL, sides_of_rings(rings)))
    return outline_cells(Grid(low, CELL, *shape), inside, np.zeros(len(inside), int))[0][:1]


stairs = list(map(traced, true))
layers = {"polygons": LayerFeatures(stairs, {})}
drawn = run_stage(STAGES["regularize_polygons"], None, input_layers=layers).layers["regularized"]

# %%
# The stairs are dotted. Corners are few, angles right, and areas as before.
plt.style.use("dark_background")
ax = plt.subplots(figsize=(8, 6))[1]
for before, after in zip(stairs, drawn.geometries):
    ax.plot(*before[0].T, color="white", linewidth=0.8, linestyle=":")
    ax.fill(*after[0].T, facecolor="#4477aa88", edgecolor="#66ccee")
ax.set(aspect="equal", xlabel="m", ylabel="m")
plt.tight_layout()
