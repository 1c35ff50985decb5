"""Surfaces of pipes and spheres: corners lie on them, areas are nearly theirs, and they are closed."""

import numpy as np
import pytest

from lidar_buildings.algorithms.shapes.reconstruct_pipes import reconstruct_pipes
from lidar_buildings.algorithms.stage import LayerFeatures


def area(ring):
    spokes = ring[1:-1] - ring[0]
    return np.linalg.norm(np.cross(spokes[:-1], spokes[1:]).sum(axis=0)) / 2


@pytest.mark.parametrize("end", [[3.0, 0, 0], [0, 0, 3.0], [1.0, 2.0, -2.0]])
def test_a_pipe_is_a_prism_around_its_axis(end):
    start = np.array([10.0, 20.0, 5.0])
    axes = LayerFeatures([np.array([start, start + end])], {"id": [7], "radius": np.array([0.25])})
    pipes = reconstruct_pipes(axes)
    assert len(pipes) == 16
    assert set(pipes.columns["of"]) == {7}
    assert set(pipes.columns["kind"]) == {"pipe"}
    along = np.array(end) / 3.0
    for (ring,) in pipes.geometries:
        offset = ring - start
        across = offset - np.outer(offset @ along, along)
        np.testing.assert_allclose(np.linalg.norm(across, axis=1), 0.25)
        np.testing.assert_array_equal(ring[0], ring[-1])
    total = sum(area(ring) for (ring,) in pipes.geometries)
    assert total == pytest.approx(2 * np.pi * 0.25 * 3.0, rel=0.01)


def test_a_sphere_is_closed_and_round():
    axes = LayerFeatures([], {"id": [], "radius": np.zeros(0)})
    centers = LayerFeatures([np.array([1.0, 2.0, 3.0])], {"id": [2], "radius": np.array([2.0])})
    pipes = reconstruct_pipes(axes, centers)
    rings = [ring for (ring,) in pipes.geometries]
    for ring in rings:
        np.testing.assert_allclose(np.linalg.norm(ring - [1, 2, 3], axis=1), 2.0)
    assert sum(area(ring) for ring in rings) == pytest.approx(4 * np.pi * 4.0, rel=0.04)
    # Every edge is shared by two faces that run along it in opposite directions.
    edges = [tuple(np.round(np.concatenate(pair), 6)) for ring in rings for pair in zip(ring[:-1], ring[1:])]
    assert {edge[3:] + edge[:3] for edge in edges} == set(edges)


def test_features_without_a_radius_of_their_own():
    line = np.array([[0, 0, 0], [1, 0, 0.0]])
    axes = LayerFeatures([line, line], {"id": [1, 2], "radius": [None, 0.1]})
    assert set(reconstruct_pipes(axes).columns["of"]) == {2}
    # Wires have no radius at all, and maps no heights.
    wires = reconstruct_pipes(LayerFeatures([line[:, :2]], {"id": [1]}), radius=0.02)
    assert set(wires.columns["radius"]) == {0.02}
    assert np.abs(np.concatenate([ring for (ring,) in wires.geometries])[:, 2]).max() == pytest.approx(0.02)
