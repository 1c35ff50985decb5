"""
Clusters by density
===================

DBSCAN :cite:p:`ester1996` on what is not ground.
"""

from scenes import group_colors, plan, step, town

cloud, truth = town(size=80.0)
cloud.set("classification", truth)
found = step("segment_clusters", cloud).cloud
plan(found, group_colors(found.get("cluster_id")), title="clusters")
