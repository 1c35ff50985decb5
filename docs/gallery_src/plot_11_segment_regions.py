"""
Regions, as published
=====================

Points closer than a distance in plan and one in height form a region :cite:p:`santos2019,sampath2007`.
"""

from scenes import group_colors, plan, step, town

cloud, truth = town(size=80.0)
cloud.set("classification", truth)
found = step("segment_regions", cloud).cloud
plan(found, group_colors(found.get("cluster_id")), title="regions")
