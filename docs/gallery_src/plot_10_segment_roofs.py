"""
Roof surfaces
=============

Points above the ground are grouped into planar surfaces; the rest is clustered.
"""

from scenes import group_colors, plan, step, town

cloud, truth = town(size=80.0)
cloud.set("classification", truth)
height = step("compute_height_above_ground", cloud).cloud
found = step("segment_roofs", height).cloud
plan(found, group_colors(found.get("segment_id")), title="segments")
