"""Houses on a hillside, and whether the walls of their models end on its terrain."""

from __future__ import annotations

import numpy as np

from lidar_buildings.algorithms.stage import LayerFeatures


def hill(x, y):
    """Return the height of terrain that falls by 20 % and bends; sides of patches are at 0, 50 and 100 m."""
    return 0.2 * x + 1.5 * np.sin(y / 9) + 0.8 * np.sin(x / 7)


def town(count=3, density=6.0, seed=0):
    """Return points and classes of pairs of houses with a common wall, each turned otherwise, and their footprints."""
    rng, side = np.random.default_rng(seed), 22.0
    x, y = rng.uniform(0, count * side, (2, round((count * side) ** 2 * density)))
    z, classes, rings = hill(x, y) + rng.normal(0, 0.02, len(x)), np.full(len(x), 2), []
    for east, north in side * (np.mgrid[:count, :count].reshape(2, -1).T + 0.5):
        c, s = np.cos(angle := rng.uniform(0, np.pi)), np.sin(angle)
        along, across = (x - east) * c + (y - north) * s, (y - north) * c - (x - east) * s
        for start, end, depth, height in ((-7, 0, 4.0, 9), (0, 6, 3.0, 8)):
            inside = (along > start) & (along < end) & (abs(across) < depth)
            z[inside] = hill(east, north) + height - 0.6 * abs(across[inside])
            classes[inside] = 6
            ring = [[start, -depth], [end, -depth], [end, depth], [start, depth], [start, -depth]]
            rings.append([np.array(ring) @ [[c, s], [-s, c]] + [east, north]])
    return np.column_stack([x, y, z]), classes, LayerFeatures(rings, {"id": np.arange(len(rings))})


def positions(xyz):
    return [tuple(row) for row in np.rint(np.asarray(xyz) * 1e4).astype(int).tolist()]


def lower_edges(solid):
    """Return the edges of walls between two corners of the ground, as walls run along them."""
    faces = list(zip(solid.faces, solid.kinds))
    base = {v for rings, kind in faces if kind == "ground" for ring in rings for v in ring}
    rings = [ring for rings, kind in faces if kind == "wall" for ring in rings]
    edges = [edge for ring in rings for edge in zip(ring, [*ring[1:], ring[0]]) if base.issuperset(edge)]
    return [tuple(positions(solid.vertices[list(edge)])) for edge in edges]


def edges_of_terrain(layer):
    rings = [positions(ring) for (ring,) in layer.geometries]
    return {edge for ring in rings for edge in zip(ring, ring[1:])}


def open_edges(items, layer):
    """Return the lower edges of all walls, and those along which neither terrain nor a wall of a neighbor runs."""
    lower = [
        e
        for one in items
        if not one.is_terrain
        for s in one.model.solids.values()
        for solid in s
        for e in lower_edges(solid)
    ]
    beyond = {(b, a) for a, b in edges_of_terrain(layer) | set(lower)}
    return lower, [edge for edge in lower if edge not in beyond]
