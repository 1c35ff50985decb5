"""
Linear, planar, volumetric
==========================

Each point gets the class of its largest feature: linearity, planarity or scattering.
"""

from scenes import group_colors, plan, step, town

cloud, truth = town(size=60.0)
found = step("classify_dimensionality", step("compute_features", cloud, n_neighbors=20).cloud).cloud
plan(found, group_colors(found.get("dimensionality")), title="linear, planar, volumetric")
