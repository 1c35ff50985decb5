"""
Scan lines
==========

Artificial scan lines in several directions; pieces that share points are merged :cite:p:`vosselman2004`.
"""

from scenes import group_colors, plan, step, town

cloud, truth = town(size=60.0)
found = step("segment_scan_lines", cloud).cloud
plan(found, group_colors(found.get("segment_id")), title="segments of scan lines")
