"""
Surface growing
===============

A surface grows from a seed to neighbors that lie on its local plane :cite:p:`vosselman2004`.
"""

from scenes import group_colors, plan, step, town

cloud, truth = town(size=60.0)
found = step("segment_surfaces", cloud).cloud
plan(found, group_colors(found.get("segment_id")), title="surfaces")
