"""
Ground by triangulation
=======================

A triangulation of certain ground points grows point by point :cite:p:`axelsson2000`.
"""

from scenes import profile, step, town

cloud, truth = town(size=80.0, slope=12.0)
found = step("classify_ground_tin", step("classify_noise_histogram", cloud).cloud).cloud
profile(found, low=20, high=30, title="a strip of 10 m, ground in brown")
