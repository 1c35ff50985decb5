"""
Eigenentropy
============

The eigenvalues of the covariance of a neighborhood, as shares of their sum, have an entropy: low on planes,
high in crowns :cite:p:`weinmann2017`.
"""

import matplotlib.pyplot as plt
import numpy as np

from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stages import STAGES

town = {"size": 60.0, "density": 12.0, "buildings": 34.0, "trees": 25.0, "forest": 0.05, "river": False}
cloud = run_stage(STAGES["simulate_town"], noise_points=0.0, **town).cloud
found = run_stage(STAGES["compute_features"], cloud, n_neighbors=20, features=("eigenentropy",)).cloud

found = found.take(np.argsort(found.get("xyz")[:, 2]))
plt.style.use("dark_background")
ax = plt.subplots(figsize=(7, 6))[1]
drawn = ax.scatter(*found.get("xyz")[:, :2].T, s=2, c=found.get("eigenentropy"), cmap="plasma")
plt.colorbar(drawn, label="eigenentropy of 20 neighbors", shrink=0.7)
ax.set(aspect="equal", xlabel="easting (m)", ylabel="northing (m)")
