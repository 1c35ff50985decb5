"""
Ground by cloth simulation
==========================

A cloth falls on the cloud turned upside down :cite:p:`zhang2016`.
"""

from scenes import plan, step, town

cloud, truth = town(size=80.0, slope=4.0)
found = step("classify_ground_cloth", step("classify_noise_histogram", cloud).cloud).cloud
plan(found, title="ground in brown")
