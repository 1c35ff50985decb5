"""
Failure: edges are linear
=========================

The neighborhood of a point at an edge is cut off, and looks like a line or a volume: rims of roofs are not planar
(orange linear, gray planar, green volumetric).
"""

import numpy as np
from scenes import after, plan, town

cloud, truth = town(size=50.0, trees=0.0, forest=0.0)
results = after("interpret_structure", cloud)
structure = results.cloud.get("dimensionality")
color = np.array(["#ffffff", "#fb8c00", "#bdbdbd", "#2e7d32"])[structure]
ax = plan(results.cloud, title="linear points at the rims of roofs")
ax.collections[-1].set_color(color[np.argsort(results.cloud.get("xyz")[:, 2], kind="stable")])
