"""
Planes by RANSAC
================

Random samples of three points per voxel; the plane with most points is taken :cite:p:`fischler1981,hrutka2022`.
"""

from scenes import group_colors, plan, step, town

cloud, truth = town(size=60.0)
cloud.set("classification", truth)
found = step("segment_planes_ransac", cloud).cloud
plan(found, group_colors(found.get("segment_id")), title="planes")
