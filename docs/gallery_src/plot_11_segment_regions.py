"""
Regions, as published
=====================

Points form a region that are closer than one distance in plan and another one in height
:cite:p:`santos2019,sampath2007`.
"""

from scenes import group_colors, plan, step, town

cloud, truth = town(size=80.0)
cloud.set("classification", truth)
found = step("segment_regions", cloud).cloud
plan(found, group_colors(found.get("cluster_id")), title="regions")
