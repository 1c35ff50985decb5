"""
Failure: walls that were not seen
=================================

Seen straight down, the walls below the eaves have no points. *Map footprints* then sets them as far inside
the edge of the roof as the walls it saw, or, as here, outlines the roofs; the true walls are dashed.
"""

import numpy as np
from scenes import after, outlines, plan, simulated

made = simulated("simulate_village", size=80.0, density=40.0, buildings=15.0, oblique=0.0)
cloud = made.cloud
cloud.set("classification", np.zeros(len(cloud), np.uint8))
results = after("map_footprints", cloud)
ax = plan(results.cloud, title="outlines, and the true walls dashed", size=1.0)
outlines(ax, results.layers["wall_footprints"])
outlines(ax, made.layers["footprints"], linestyle="--", color="#1565c0")
ax.set(xlim=(44, 68), ylim=(10, 37))
