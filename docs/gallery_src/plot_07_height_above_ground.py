"""
Height above ground
===================

Elevation minus the ground below each point.
"""

from scenes import plan, step, town

cloud, truth = town(size=80.0, slope=12.0)
cloud.set("classification", truth)
found = step("compute_height_above_ground", cloud).cloud
plan(found, found.get("height_above_ground"), title="height above ground, m", cmap="viridis", vmin=0, vmax=12)
