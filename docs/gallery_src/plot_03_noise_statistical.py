"""
Noise by distance
=================

A point is noise when the mean distance to its nearest points exceeds the mean of the cloud by several
standard deviations.
"""

from scenes import profile, step, town

cloud, truth = town(size=80.0, noise_points=200.0)
found = step("classify_noise_statistical", cloud).cloud
profile(found, title="noise in black", aspect="auto")
