"""
Eigenentropy
============

The eigenvalues of the covariance of a neighborhood, as shares of their sum, have an entropy: low on planes,
high in crowns :cite:p:`weinmann2017`.
"""

from scenes import plan, step, town

cloud, truth = town(size=60.0)
found = step("compute_features", cloud, n_neighbors=20, features=("eigenentropy",)).cloud
plan(found, found.get("eigenentropy"), title="eigenentropy of 20 neighbors", cmap="magma")
