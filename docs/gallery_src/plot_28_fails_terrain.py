"""
Failure: roofs and crowns joined to the terrain
===============================================

*Model terrain* asks whether segments are joined to the terrain. Pieces of walls and of crowns connect roofs and
trees with it: objects that became bare earth are red, bare earth that was lost is black.
"""

import numpy as np
from scenes import after, plan, town

cloud, truth = town(size=80.0, density=8.0, forest=0.2, seed=4)
results = after("model_terrain", cloud)
called, true = results.cloud.get("classification") == 2, truth == 2
color = np.select([called & ~true, true & ~called, called], ["#e53935", "#000000", "#d7ccc8"], "#eeeeee")
ax = plan(results.cloud, title="bare earth: found, invented (red), lost (black)")
ax.collections[-1].set_color(color[np.argsort(results.cloud.get("xyz")[:, 2], kind="stable")])
