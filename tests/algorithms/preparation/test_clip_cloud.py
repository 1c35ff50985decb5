"""Points in polygons: truth by construction, and against the parity of every edge."""

import time

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.geometry.rings import are_inside
from lidar_buildings.algorithms.preparation.clip_cloud import clip_cloud
from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stage import LayerFeatures, Monitor

FAR = np.array([6e5, 5e6])


def square(low, high, clockwise=False):
    (x0, y0), (x1, y1) = low, high
    ring = np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]], float)
    return ring[::-1] if clockwise else ring


def layer(*polygons):
    return LayerFeatures(list(polygons), {})


def grid(n=20):
    x, y = np.meshgrid(np.arange(n) + 0.5, np.arange(n) + 0.5)
    return np.column_stack([x.ravel(), y.ravel(), np.zeros(n * n)])


@pytest.mark.parametrize("clockwise", [False, True])
def test_a_square_with_a_hole(clockwise):
    xyz = grid()
    courtyard = [square((2, 2), (12, 12), clockwise), square((5, 5), (8, 8))]
    kept = clip_cloud(xyz, layer(courtyard))
    x, y = xyz[:, :2].T
    is_in = (abs(x - 7) < 5) & (abs(y - 7) < 5) & ~((abs(x - 6.5) < 1.5) & (abs(y - 6.5) < 1.5))
    assert kept.tolist() == np.flatnonzero(is_in).tolist()
    assert clip_cloud(xyz, layer(courtyard), outside=True).tolist() == np.flatnonzero(~is_in).tolist()


def test_polygons_that_overlap_keep_what_any_of_them_holds():
    kept = clip_cloud(grid(), layer([square((0, 0), (6, 4))], [square((4, 0), (10, 4))]))
    assert len(kept) == 10 * 4


def test_adjacent_parcels_share_no_point_and_leave_none_out():
    x, y = np.meshgrid(np.arange(1, 10), np.arange(1, 10))
    xyz = np.column_stack([x.ravel(), y.ravel(), np.zeros(81)]).astype(float)
    corner = np.array([4.0, 5.0])
    outer = square((0, 0), (10, 10))
    parcels = [np.array([corner, a, b, corner]) for a, b in zip(outer[:-1], outer[1:])]
    times = np.zeros(81, int)
    for ring in parcels:
        times[clip_cloud(xyz, layer([ring]))] += 1
    assert times.tolist() == [1] * 81


@pytest.mark.parametrize("shift", [np.zeros(2), FAR])
def test_random_rings_as_the_parity_of_all_edges(shift):
    random = np.random.default_rng(3)
    xyz = np.column_stack([random.random((20_000, 2)) * 100 + shift, np.zeros(20_000)])
    angle = np.linspace(0, 2 * np.pi, 60)[:-1]
    polygons = []
    for center in random.random((25, 2)) * 100:
        ring = center + (random.random(59) * 15 + 2)[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
        polygons.append([np.vstack([ring, ring[:1]]) + shift])
    expected = np.any([are_inside(xyz[:, :2], ring) for (ring,) in polygons], axis=0)
    kept = clip_cloud(xyz, layer(*polygons))
    assert 0.2 < expected.mean() < 0.9
    assert kept.tolist() == np.flatnonzero(expected).tolist()
    order = random.permutation(len(xyz))
    assert sorted(order[clip_cloud(xyz[order], layer(*polygons))]) == kept.tolist()


def test_a_boundary_of_many_vertices_takes_a_moment():
    random = np.random.default_rng(0)
    xyz = np.column_stack([random.random((300_000, 2)) * 2 - 1, np.zeros(300_000)])
    angle = np.linspace(0, 2 * np.pi, 20_001)
    ring = np.column_stack([np.cos(angle), np.sin(angle)]) * 0.8
    ring[-1] = ring[0]
    start = time.process_time()
    kept = clip_cloud(xyz, layer([ring]))
    # Each point against each edge are six billion comparisons.
    assert time.process_time() - start < 10
    assert abs(len(kept) - (np.hypot(*xyz[:, :2].T) < 0.8).sum()) <= 2


def test_nothing_to_be_outside_of():
    with pytest.raises(ValueError, match="needs polygons"):
        clip_cloud(grid(), outside=True)
    assert len(clip_cloud(grid())) == 400


def test_no_point_left_is_a_sentence():
    with pytest.raises(ValueError, match="None of 400 points lies within the polygons"):
        clip_cloud(grid(), layer([square((50, 50), (60, 60))]))


def test_all_dimensions_stay():
    xyz = grid() + [*FAR, 0.0]
    cloud = create_cloud({"xyz": xyz, "intensity": np.arange(400, dtype=np.uint16)})
    ring = square((2, 2), (4, 4)) + FAR - cloud.origin[:2]
    made = run_stage(clip_cloud.stage, cloud, None, Monitor(), {"polygons": layer([ring])}).cloud
    assert sorted(made.get("intensity")) == [42, 43, 62, 63]
