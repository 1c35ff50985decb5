"""
Linear, planar, volumetric
==========================

Each point belongs to the largest of linearity, planarity and scattering.
"""

from scenes import group_colors, plan, step, town

cloud, truth = town(size=60.0)
found = step("classify_dimensionality", step("compute_features", cloud, n_neighbors=20).cloud).cloud
plan(found, group_colors(found.get("dimensionality")), title="linear, planar, volumetric")
