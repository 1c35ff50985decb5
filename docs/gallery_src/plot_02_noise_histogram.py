"""
Noise by the histogram of heights
=================================

The height histogram of each cell has one main body; sparse bins outside of it are noise :cite:p:`santos2019`.
"""

from scenes import profile, step, town

cloud, truth = town(size=80.0, noise_points=200.0)
found = step("classify_noise_histogram", cloud).cloud
profile(found, title="noise in black", aspect="auto")
