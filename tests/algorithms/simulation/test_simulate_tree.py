"""The simulated tree agrees with its truth."""

import numpy as np

from lidar_buildings.algorithms.simulation.simulate_tree import simulate_tree

SMALL = {"height": 9.0, "dbh": 0.2, "n_branches": 8, "density": 3000.0}


def test_wood_of_the_simulation_lies_on_its_limbs():
    xyz, _, truth, branches = simulate_tree(**SMALL, noise=0.0)
    for number, line, radius in zip(branches.columns["id"], branches.geometries, branches.columns["radius"]):
        own = xyz[truth == number]
        near = np.full(len(own), np.inf)
        for start, end in zip(line[:-1], line[1:]):
            share = np.clip((own - start) @ (end - start) / ((end - start) @ (end - start)), 0, 1)
            near = np.minimum(near, np.linalg.norm(own - start - share[:, None] * (end - start), axis=1))
        assert near.max() <= radius * 1.001
        assert near.min() >= 0.3 * radius


def test_the_same_seed_gives_the_same_tree():
    one, again, other = (simulate_tree(**SMALL, seed=seed) for seed in (3, 3, 4))
    np.testing.assert_array_equal(one[0], again[0])
    assert len(one[0]) != len(other[0])


def test_the_stem_has_its_diameter_at_breast_height():
    xyz, _, truth, branches = simulate_tree(**SMALL, noise=0.0, leaves=0.0)
    slab = xyz[(truth == 1) & (np.abs(xyz[:, 2] - 1.3) < 0.1)]
    line = branches.geometries[0]
    middle = np.array([np.interp(slab[:, 2], line[:, 2], line[:, k]) for k in (0, 1)]).T
    assert abs(np.median(np.linalg.norm(slab[:, :2] - middle, axis=1)) - 0.1) < 0.002
    assert abs(branches.columns["length"][0] - 9.0) < 1e-9
