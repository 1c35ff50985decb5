"""
Detect buildings
================

*Detect buildings* runs with nothing set: noise, ground, heights, roofs, buildings, and footprints. The
outlines are drawn in black.
"""

from scenes import after, outlines, plan, town

cloud, truth = town(size=80.0)
results = after("detect_buildings", cloud)
ax = plan(results.cloud, title="classes and footprints")
outlines(ax, results.layers["footprints"])
