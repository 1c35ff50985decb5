"""Pieces of one pipe become one cylinder; pipes that are not of one axis, radius or line stay two."""

import numpy as np
import pytest

from lidar_buildings.algorithms.shapes.detect_cylinders import detect_cylinders
from lidar_buildings.tests.builders import turned
from lidar_buildings.tests.industry import pipe

# Radius of the pipes, distance between points and their noise, length of a piece, m.
RADIUS, SPACING, NOISE, LENGTH = 0.1, 0.02, 0.002, 1.5


def pieces(rng, gap, radius=RADIUS, aside=0.0, degrees=0.0, count=2):
    """Return points and number of pieces one after the other along x with a gap (m) between; the last one differs."""
    parts = [pipe(rng, RADIUS, LENGTH, SPACING, NOISE, (1, 0, 0)) for _ in range(count - 1)]
    parts.append(turned(pipe(rng, radius, LENGTH, SPACING, NOISE, (1, 0, 0)), degrees) + [0, aside, 0])
    placed = [part + [number * (LENGTH + gap), 0, 3.0] for number, part in enumerate(parts)]
    return np.concatenate(placed), np.repeat(np.arange(1, count + 1), [len(part) for part in placed])


def detect(xyz, segment_id=None, **tunables):
    kept = {"search_in": "each segment"} if segment_id is not None else {}
    return detect_cylinders(xyz, np.ones(len(xyz), np.uint8), segment_id, max_radius=0.5, **kept, **tunables)


@pytest.mark.parametrize("of_segments", [False, True])
@pytest.mark.parametrize("count", [2, 3])
def test_pieces_of_a_pipe_are_one_cylinder_as_long_as_all(of_segments, count, rng):
    xyz, piece = pieces(rng, 0.6, count=count)
    ids, _, axes = detect(xyz, piece.astype(np.int32) if of_segments else None)
    assert len(axes) == 1
    whole = count * LENGTH + (count - 1) * 0.6
    assert axes.columns["length"] == pytest.approx([whole], abs=0.1)
    assert axes.columns["radius"] == pytest.approx([RADIUS], rel=0.01)
    # 60 % of the circumference has points.
    assert axes.columns["seen"] == pytest.approx([0.6], abs=0.1)
    found = ids == axes.columns["id"][0]
    assert axes.columns["points"] == [found.sum()]
    assert found.mean() > 0.95
    (line,) = axes.geometries
    np.testing.assert_allclose(sorted(line[:, 0]), [-LENGTH / 2, whole - LENGTH / 2], atol=0.05)
    np.testing.assert_allclose(line[:, 1:], [[0, 3], [0, 3]], atol=0.005)


@pytest.mark.parametrize(
    "different",
    [
        {"gap": 1.2},  # wider than five diameters
        {"gap": 0.6, "radius": 0.11},
        {"gap": 0.6, "aside": 0.015},  # seven deviations of the noise off the axis
        {"gap": 0.6, "degrees": 3.0},
    ],
)
def test_what_is_not_one_pipe_stays_two(different, rng):
    xyz, _ = pieces(rng, **different)
    assert len(detect(xyz)[2]) == 2


def test_the_gap_can_be_set(rng):
    xyz, _ = pieces(rng, 0.6)
    assert len(detect(xyz, max_gap=0.0)[2]) == 2
    assert len(detect(xyz, max_gap=0.5)[2]) == 2
    assert len(detect(xyz, max_gap=0.7)[2]) == 1


def test_joining_does_not_depend_on_order_or_place(rng):
    xyz, piece = pieces(rng, 0.5, count=3)
    order = rng.permutation(len(xyz))
    one = detect(xyz, piece.astype(np.int32))[0]
    other = detect(xyz[order] + [1000.0, -500.0, 64.0], piece[order].astype(np.int32))[0]
    np.testing.assert_array_equal(one[order] > 3, other > 3)
