"""
How noise of the range acts
===========================

The same town with 2 and 10 cm of noise: tolerances follow the measured noise.
"""

import matplotlib.pyplot as plt
from scenes import after, plan, town

figure, axes = plt.subplots(1, 2, figsize=(11, 5))
for ax, noise in zip(axes, (0.02, 0.10)):
    cloud, truth = town(size=60.0, range_noise=noise)
    results = after("detect_buildings", cloud)
    right = (results.cloud.get("classification") == 6) == (truth == 6)
    plan(results.cloud, title=f"{100 * noise:.0f} cm: {100 * right.mean():.1f} % right", ax=ax)
