"""Simulated villages as a drone sees them, what "Map footprints" makes of them, and how far its corners are off."""

from __future__ import annotations

import numpy as np

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline
from lidar_buildings.algorithms.simulation.simulate_village import simulate_village


def village(**tunables):
    """Return the cloud of a village as a drone's software gives it, the true footprints and the old map."""
    *arrays, footprints, old_map = simulate_village(**tunables)
    made = dict(zip(simulate_village.stage.creates, arrays))
    return {**made, "classification": np.zeros_like(made["classification"])}, footprints, old_map


def mapped(arrays, old_map, monitor=None, **tunables):
    """Return what the chain makes of a cloud, with an old map or with None."""
    cloud = create_cloud(arrays)
    return run_pipeline(PIPELINES["map_footprints"], cloud, monitor, input_layers={"old_map": old_map}, **tunables)


def corner_distances(found, true):
    """Return, for each true building that has a footprint, the distances of its corners, and the footprints used."""
    distances, used = [], set()
    middles = np.array([rings[0][:-1].mean(axis=0) for rings in found.geometries])
    for rings in true.geometries:
        own = rings[0][:-1]
        apart = np.hypot(*(middles - own.mean(axis=0)).T)
        nearest = int(np.argmin(apart))
        if apart[nearest] < 2.5:
            used.add(nearest)
            ring = found.geometries[nearest][0][:-1]
            distances.append(np.hypot(*(own[:, None] - ring).transpose(2, 0, 1)).min(axis=1))
    return distances, used
