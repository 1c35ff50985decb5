"""
Rasters of terrain and heights
==============================

The bare earth, and heights above it.
"""

import matplotlib.pyplot as plt
from scenes import step, town

cloud, truth = town(size=80.0)
cloud.set("classification", truth)
rasters = step("rasterize_terrain", cloud, cell_size=1.0).rasters
figure, axes = plt.subplots(1, 2, figsize=(10, 4))
for ax, name in zip(axes, ("dtm", "ndsm")):
    drawn = ax.imshow(rasters[name].values, cmap="terrain")
    plt.colorbar(drawn, ax=ax, shrink=0.7)
    ax.set_title(name)
