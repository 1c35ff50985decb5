"""Polygon validity by the rules of OGC Simple Features, literally and slowly, for all tests of outlines."""

import itertools


def cross(o, a, b):
    return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])


def strictly_cross(a, b, c, d):
    return cross(a, b, c) * cross(a, b, d) < 0 and cross(c, d, a) * cross(c, d, b) < 0


def on_segment(point, a, b):
    inside_box = all(min(p, q) <= v <= max(p, q) for v, p, q in zip(point, a, b))
    return inside_box and cross(a, b, point) == 0


def inside(point, ring):
    """Whether a point is inside a ring or on its border."""
    odd = False
    for a, b in zip(ring, ring[1:]):
        if on_segment(point, a, b):
            return True
        if (a[1] > point[1]) != (b[1] > point[1]):
            odd ^= point[0] < a[0] + (point[1] - a[1]) * (b[0] - a[0]) / (b[1] - a[1])
    return odd


def area(ring):
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(ring, ring[1:])) / 2


def assert_valid(rings):
    """Fail unless rings are a valid polygon: exterior counterclockwise, holes clockwise and inside, no crossing."""
    start = rings[0][0]
    rings = [[tuple(point) for point in (ring - start).tolist()] for ring in rings]
    for number, ring in enumerate(rings):
        assert ring[0] == ring[-1], "a ring is open"
        assert len(ring) >= 4
        assert len(set(ring[:-1])) == len(ring) - 1, "a ring touches itself"
        assert area(ring) < 0 if number else area(ring) > 0, "a ring runs the wrong way"
    segments = [pair for ring in rings for pair in zip(ring, ring[1:])]
    for (a, b), (c, d) in itertools.combinations(segments, 2):
        assert not strictly_cross(a, b, c, d), "walls cross"
    for hole in rings[1:]:
        assert all(inside(point, rings[0]) for point in hole), "a hole is outside"
