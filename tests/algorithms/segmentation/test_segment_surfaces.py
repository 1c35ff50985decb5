"""Surface growing on a tile of two strips with roofs, a dome, a ramp and a crown, and against a literal growth."""

import tracemalloc
from types import SimpleNamespace

import numpy as np
import pytest

from lidar_buildings.algorithms import threads
from lidar_buildings.algorithms.planes import best_pairs, least_squares_planes, surface_growing
from lidar_buildings.algorithms.planes import local_planes as local_planes_module
from lidar_buildings.algorithms.planes.local_planes import Criteria, local_planes
from lidar_buildings.algorithms.planes.surface_growing import connected_seeds
from lidar_buildings.algorithms.segmentation.segment_surfaces import segment_surfaces as stage
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.tests.builders import FAR, crown
from lidar_buildings.tests.monitors import Listening

GROUND, WEST_ROOF, EAST_ROOF, DOME, RAMP, DECK, CROWN = range(7)


def segment_surfaces(xyz, **tunables):
    return stage(xyz, np.ones(len(xyz), np.uint8), **tunables)


def surface_at(x, y):
    """Return height (n,) and part (n,) of the surface above places: 60 m by 40 m."""
    z, part = 0.02 * x, np.full(len(x), GROUND)

    def put(inside, heights, number):
        z[inside], part[inside] = heights[inside], number

    west = (x > 5) & (x <= 10) & (y > 5) & (y < 17)
    east = (x > 10) & (x < 15) & (y > 5) & (y < 17)
    put(west, 4 + 0.6 * (x - 5), WEST_ROOF)
    put(east, 4 + 0.6 * (15 - x), EAST_ROOF)
    away = np.hypot(x - 28, y - 11)
    put(away < 6, 3 + np.sqrt(np.maximum(8**2 - away**2, 0)) - np.sqrt(8**2 - 6**2), DOME)
    # A ramp that turns by a half circle and rises by 4 m; its deck goes on at the top.
    turn = np.arctan2(y - 28, x - 45)
    radius = np.hypot(x - 45, y - 28)
    put((radius > 6) & (radius < 10) & (y > 28), 2 + 4 * turn / np.pi + 0.02 * x, RAMP)
    return z, part


@pytest.fixture(scope="module")
def tile():
    """Two strips, of which the second lies 2 cm higher; crowns over the ground; 8 points per m² in each strip."""
    rng = np.random.default_rng(5)
    strips, parts = [], []
    for lift, (west, east) in ((0.0, (0, 40)), (0.02, (20, 60))):
        x, y = rng.uniform((west, 0), (east, 40), (8 * 40 * (east - west), 2)).T
        z, part = surface_at(x, y)
        strips.append(np.column_stack([x, y, z + lift + rng.normal(0, 0.015, len(x))]))
        parts.append(part)
    crown = rng.normal(0, 1, (900, 3))
    crown *= rng.uniform(0.2, 1, (900, 1)) * 2.5 / np.linalg.norm(crown, axis=1, keepdims=True)
    return np.concatenate([*strips, crown + [10, 30, 6]]), np.concatenate([*parts, np.full(900, CROWN)])


def share(ids, part, number):
    """Return the segment with most points of a part, its share of the part, and how much of it is of the part."""
    segment = np.bincount(ids[(part == number) & (ids > 0)], minlength=1).argmax()
    return segment, (ids[part == number] == segment).mean(), (part[ids == segment] == number).mean()


@pytest.mark.parametrize("seeds", ["least squares", "robust", "hough"])
def test_each_surface_of_the_tile_is_one_segment(tile, seeds):
    xyz, part = tile
    ids = segment_surfaces(xyz, seeds=seeds)
    segments = set()
    for number, least in ((GROUND, 0.97), (WEST_ROOF, 0.93), (EAST_ROOF, 0.93), (DOME, 0.93), (RAMP, 0.9)):
        segment, found, correct = share(ids, part, number)
        assert found > least, number
        assert correct > 0.97, number
        segments.add(segment)
    assert len(segments) == 5
    assert (ids[part == CROWN] > 0).mean() < 0.35


def test_planes_part_the_dome_and_keep_the_roofs(tile):
    xyz, part = tile
    ids = segment_surfaces(xyz, planarity="global")
    for number in (GROUND, WEST_ROOF, EAST_ROOF):
        _, found, correct = share(ids, part, number)
        assert found > 0.95
        assert correct > 0.95
    assert len(np.unique(ids[(part == DOME) & (ids > 0)])) >= 5
    for number in np.unique(ids[ids > 0]):
        points = xyz[ids == number] - xyz[ids == number].mean(axis=0)
        assert np.linalg.svd(points, compute_uv=False)[-1] / np.sqrt(len(points)) < 0.05


def strip(west, east, along, across, turn, lift, rng):
    """Return places (n, 2) and heights' offsets (n,) of a strip of scan lines between two eastings, 0 to 30 m north.

    Lines are ``across`` (m) apart, points on them ``along`` (m), and the lines are turned (degrees) in plan.
    """
    u, v = np.meshgrid(np.arange(-60, 60, along), np.arange(-60, 60, across))
    # Every other line begins half a distance later, and the pulses jitter.
    u = u + along / 2 * (np.arange(len(v)) % 2)[:, None] + rng.normal(0, 0.05 * along, u.shape)
    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    x, y = c * u - s * v + 20, s * u + c * v + 15
    inside = (x > west) & (x < east) & (y > 0) & (y < 30)
    return np.column_stack([x[inside], y[inside], np.full(inside.sum(), lift)])


def house_at(x, y):
    """Return height and part of a gable house, 16 m by 10 m, in the middle of a plane of 40 m by 30 m."""
    inside = (np.abs(x - 20) < 8) & (np.abs(y - 15) < 5)
    part = np.where(inside, np.where(y < 15, WEST_ROOF, EAST_ROOF), GROUND)
    return np.where(inside, 8 - 0.7 * np.abs(y - 15), 0.01 * x), part


@pytest.mark.parametrize("lift", [0.0, 0.03, -0.05])
def test_a_roof_that_two_strips_see_is_one_segment(lift, rng):
    """The strips overlap on the middle third of the roof; their lines cross, one is denser and higher or lower."""
    xyz = np.concatenate([strip(0, 23, 0.3, 0.4, 4, 0.0, rng), strip(17, 40, 0.35, 0.5, -12, lift, rng)])
    z, part = house_at(*xyz[:, :2].T)
    xyz[:, 2] += z + rng.normal(0, 0.015, len(xyz))
    ids = segment_surfaces(xyz)
    segments = set()
    for number in (GROUND, WEST_ROOF, EAST_ROOF):
        segment, found, correct = share(ids, part, number)
        assert found > 0.97
        assert correct > 0.97
        segments.add(segment)
        for own in (xyz[:, 0] < 17, (xyz[:, 0] >= 17) & (xyz[:, 0] <= 23), xyz[:, 0] > 23):
            assert (ids[own & (part == number)] == segment).mean() > 0.95
    assert len(segments) == 3


def ramp(foot, rng):
    """Return points of a ramp around three quarters of a circle, from ``foot`` (m) to 6 m up, over flat ground."""
    x, y = rng.uniform(0, 40, (2, 19_200))
    turn = np.arctan2(y - 20, x - 20) % (2 * np.pi)
    is_ramp = (np.abs(np.hypot(x - 20, y - 20) - 12) < 2.5) & (turn < 1.5 * np.pi)
    height = np.where(is_ramp, foot + (6 - foot) * turn / (1.5 * np.pi), 0)
    return np.column_stack([x, y, height + rng.normal(0, 0.015, len(x))]), np.where(is_ramp, RAMP, GROUND)


@pytest.mark.parametrize("criteria", [{}, {"smooth_normals": True}])
def test_a_curved_ramp_is_one_segment_apart_from_the_ground_beside_it(criteria, rng):
    xyz, part = ramp(0.5, rng)
    ids = segment_surfaces(xyz, **criteria)
    segment, found, correct = share(ids, part, RAMP)
    assert found > 0.93
    assert correct > 0.98
    ground, found, correct = share(ids, part, GROUND)
    assert found > 0.97
    assert correct > 0.98
    assert ground != segment


def test_a_ramp_that_rises_from_the_ground_is_one_surface_with_it(rng):
    """At its foot it goes on into the ground as smoothly as a road does; planes part the two."""
    xyz, part = ramp(0.0, rng)
    ids = segment_surfaces(xyz)
    assert share(ids, part, RAMP)[0] == share(ids, part, GROUND)[0]
    assert share(ids, part, RAMP)[1] > 0.93
    planes = segment_surfaces(xyz, planarity="global")
    assert len(np.unique(planes[(part == RAMP) & (ids > 0)])) > 8


@pytest.mark.parametrize("criteria", [{}, {"smooth_normals": True}])
def test_a_dome_is_one_smooth_surface_and_several_planes(criteria, rng):
    """A hemisphere of 6 m, 30 points per m² of its surface: its tangent planes are upright at the foot."""
    direction = rng.normal(size=(6800, 3))
    direction[:, 2] = np.abs(direction[:, 2])
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    xyz = (6 + rng.normal(0, 0.01, len(direction)))[:, None] * direction
    assert (segment_surfaces(xyz, **criteria) == 1).mean() > 0.98
    planes = segment_surfaces(xyz, planarity="global", **criteria)
    sizes = np.bincount(planes)[1:]
    assert len(sizes) > 20
    assert sizes.max() < len(xyz) / 10
    for number in np.unique(planes[planes > 0]):
        off = xyz[planes == number] - xyz[planes == number].mean(axis=0)
        # Points of a cap lie evenly between its foot and its top: with 2 cm off its plane (root mean square) it is 7 cm
        # high, and of a sphere of 6 m it reaches sqrt(2 * 6 * 0.07) = 0.9 m.
        assert np.linalg.norm(off, axis=1).max() < 1.5


def test_crowns_are_noise(rng):
    """Crowns of random points at six densities over ground: at most a tenth of a crown is in one segment."""
    ground = np.column_stack([rng.uniform(0, [60, 20], (9600, 2)), rng.normal(0, 0.02, 9600)])
    crowns = [crown(rng, 5 + 10 * number, 10, 3, 6, 400 + 200 * number) for number in range(6)]
    ids = segment_surfaces(np.concatenate([ground, *crowns]))
    assert (ids[: len(ground)] == 1).mean() > 0.99
    start = len(ground)
    for one in crowns:
        own = ids[start : start + len(one)]
        assert np.bincount(own)[1:].max(initial=0) < 0.1 * len(one)
        assert (own > 0).mean() < 0.35
        start += len(one)


def test_smooth_normals_part_what_meets_at_an_edge_without_planarity(tile):
    xyz, part = tile
    roofs = np.isin(part, (WEST_ROOF, EAST_ROOF))
    together = segment_surfaces(xyz[roofs], planarity="none", tolerance=0.06)
    assert len(np.unique(together)) == 1
    apart = segment_surfaces(xyz[roofs], planarity="none", smooth_normals=True, tolerance=0.06)
    assert share(apart, part[roofs], WEST_ROOF)[0] != share(apart, part[roofs], EAST_ROOF)[0]
    assert share(apart, part[roofs], WEST_ROOF)[1] > 0.85


def test_edges_of_the_triangulation_end_at_walls_and_gaps(tile):
    xyz, part = tile
    ids = segment_surfaces(xyz[part != CROWN], proximity="edges")
    kept = part[part != CROWN]
    for number in (WEST_ROOF, EAST_ROOF, DOME):
        assert share(ids, kept, number)[1] > 0.85
        assert share(ids, kept, number)[2] > 0.95
    gap = np.concatenate([xyz[(part == GROUND) & (xyz[:, 1] < 20)], xyz[(part == GROUND) & (xyz[:, 1] > 24)]])
    assert (segment_surfaces(gap, proximity="edges", radius=1.0) == 1).mean() < 0.7


def test_robust_seeds_are_found_among_outliers(rng):
    """A floor of which every fourth point is up to half a meter off."""
    xyz = np.column_stack([rng.uniform(0, 20, (4000, 2)), rng.normal(0, 0.01, 4000)])
    is_off = rng.random(4000) < 1 / 4
    xyz[is_off, 2] += rng.uniform(0.1, 0.5, is_off.sum())
    tunables = {"tolerance": 0.04, "radius": 1.0}
    assert (segment_surfaces(xyz, **tunables)[~is_off] == 1).mean() < 0.7
    for seeds in ("robust", "hough"):
        ids = segment_surfaces(xyz, seeds=seeds, **tunables)
        assert (ids[~is_off] == 1).mean() > 0.95
        assert (ids[is_off] == 1).mean() < 0.03


def holds(planes, criteria, a, b):
    """Whether the plane of a holds point and center of b, whose normal is like its own."""
    center, normal = planes.xyz[a] + planes.offset[a], planes.normal[a]
    away = max(abs((place - center) @ normal) for place in (planes.xyz[b], planes.xyz[b] + planes.offset[b]))
    return away <= criteria.tolerance and abs(planes.normal[b] @ normal) >= criteria.cosine


def literal(planes, is_seed, criteria):
    """Grow from one seed after the other over seeds only, pair by pair."""
    surface, number = np.full(len(is_seed), -1), 0
    for seed in np.flatnonzero(is_seed):
        if surface[seed] >= 0:
            continue
        surface[seed], stack = number, [seed]
        while stack:
            a = stack.pop()
            for b in np.flatnonzero(is_seed & (surface < 0)):
                linked = b in planes.neighbors[a] or a in planes.neighbors[b]
                if linked and holds(planes, criteria, a, b) and holds(planes, criteria, b, a):
                    surface[b] = number
                    stack.append(b)
        number += 1
    return surface


def test_surfaces_of_seeds_are_those_of_a_literal_growth(rng):
    x, y = rng.uniform(0, 8, (500, 2)).T
    xyz = np.column_stack([x, y, np.where(x < 4, 0.5 * np.sin(y), 1.0) + rng.normal(0, 0.03, 500)])
    criteria = Criteria(0.06, np.cos(np.radians(20)))
    planes = local_planes(xyz, 9, 1.2, "least squares", 0.06, Monitor())
    is_seed = planes.deviation < 0.05
    expected = literal(planes, is_seed, criteria)
    surface = connected_seeds(planes, is_seed, criteria, Monitor())
    pairs = np.unique(np.column_stack([surface[is_seed], expected[is_seed]]), axis=0)
    assert len(pairs) == len(np.unique(pairs[:, 0])) == len(np.unique(pairs[:, 1])) >= 2


def literal_planes(xyz, count, radius):
    """Return the plane of each point by singular values, of neighbors by all distances, and the deviations from it."""
    planes = SimpleNamespace(xyz=xyz, offset=np.zeros_like(xyz), normal=np.zeros_like(xyz), neighbors=[])
    deviation = np.full(len(xyz), np.inf)
    for i, own in enumerate(xyz):
        distance = np.linalg.norm(xyz - own, axis=1)
        near = np.argsort(distance)[:count]
        near = near[distance[near] <= radius]
        planes.neighbors.append(set(near) - {i})
        if len(near) >= 5:
            center = xyz[near].mean(axis=0)
            _, sizes, axes = np.linalg.svd(xyz[near] - center)
            planes.offset[i], planes.normal[i], deviation[i] = center - own, axes[2], sizes[2] / np.sqrt(len(near) - 3)
    return planes, deviation


@pytest.mark.parametrize(("smooth_normals", "cosine"), [(False, -1), (True, np.cos(np.radians(12)))])
def test_segments_are_those_of_a_literal_segmentation(smooth_normals, cosine, rng):
    """Waves half a meter over a floor, and a slope that rises from it."""
    x, y = rng.uniform(0, [9, 8], (800, 2)).T
    heights = np.select([x < 3, x < 6], [0.4 * np.sin(y) + 0.9, 0], 1.2 * (x - 6))
    xyz = np.column_stack([x, y, heights + rng.normal(0, 0.01, 800)])
    planes, deviation = literal_planes(xyz, 10, 1.0)
    is_seed = deviation <= 1.55 / 3 * 0.08
    expected = literal(planes, is_seed, Criteria(0.08, cosine))
    tunables = {"smooth_normals": smooth_normals, "max_angle": 12.0, "neighbors": 10, "radius": 1.0}
    ids = segment_surfaces(xyz, tolerance=0.08, noise=0.02, density=11.0, min_points=1, **tunables)
    assert is_seed.mean() > 0.6
    pairs = np.unique(np.column_stack([ids[is_seed], expected[is_seed]]), axis=0)
    assert len(pairs) == len(np.unique(pairs[:, 0])) == len(np.unique(pairs[:, 1])) >= 2


def peak_memory(n_points, planarity):
    """Return the most memory (bytes) that is held beyond the cloud while a rough plane of 4 points/m² is segmented."""
    rng = np.random.default_rng(7)
    xyz = np.column_stack([rng.uniform(0, [500, n_points / 2000], (n_points, 2)), rng.normal(0, 0.02, n_points)])
    tracemalloc.start()
    try:
        segment_surfaces(xyz, planarity=planarity, noise=0.02, density=4.0)
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize(("planarity", "most"), [("local", 100), ("global", 120)])
def test_memory_is_bounded_by_the_points(planarity, most, monkeypatch):
    """The nodes of the tree, 14 bytes for each point, are not seen by Python and not counted."""
    segment_surfaces(np.zeros((10, 3)), radius=1.0, tolerance=0.1, noise=0.01, density=1.0)  # imports packages
    for module in (surface_growing, best_pairs):
        monkeypatch.setattr(module, "ROWS_AT_ONCE", 1000)
    for module in (surface_growing, local_planes_module, least_squares_planes):
        monkeypatch.setattr(module, "NEIGHBORS_AT_ONCE", 12_000)
    # With several threads it depends on their timing how many chunks are in memory at once.
    monkeypatch.setattr(threads, "_ASSIGNED", [1])
    few, many = (peak_memory(n_points, planarity) for n_points in (10_000, 30_000))
    assert (many - few) / 20_000 < most


def test_order_position_and_turns_change_nothing(tile):
    xyz, part = tile
    some = np.flatnonzero(xyz[:, 0] < 22)
    xyz = xyz[some].round(3)
    tunables = {"tolerance": 0.08, "radius": 0.9}
    ids = segment_surfaces(xyz, **tunables)
    order = np.random.default_rng(1).permutation(len(xyz))
    turn = np.array([[0.6, -0.8, 0], [0.8, 0.6, 0], [0, 0, 1]])
    for other in (
        segment_surfaces(xyz[order], **tunables)[np.argsort(order)],
        segment_surfaces(xyz @ turn, **tunables),
    ):
        pairs, count = np.unique(np.column_stack([ids, other]), axis=0, return_counts=True)
        assert count[np.argsort(count)[-ids.max() - 1 :]].sum() > 0.995 * len(ids)
    np.testing.assert_array_equal(segment_surfaces(xyz + FAR, **tunables) > 0, ids > 0)


def test_noise_few_points_and_lines_give_no_segment(rng):
    xyz = np.column_stack([rng.uniform(0, 10, (600, 2)), rng.normal(0, 0.01, 600)])
    noise = np.full(600, 7, np.uint8)
    noise[:300] = 1
    assert (stage(xyz, noise)[300:] == 0).all()
    assert not segment_surfaces(xyz[:4]).any()
    line = np.column_stack([np.linspace(0, 50, 400), np.zeros(400), np.zeros(400)])
    for planarity in ("local", "global"):
        for proximity in ("radius", "edges"):
            assert segment_surfaces(line, planarity=planarity, proximity=proximity, tolerance=0.1).shape == (400,)
    assert not segment_surfaces(np.zeros((50, 3)), radius=1.0, tolerance=0.1, noise=0.01, density=1.0).any()


def test_cancel_gets_through(tile):
    with pytest.raises(Cancelled):
        stage(tile[0], np.ones(len(tile[0]), np.uint8), monitor=Listening(stop_at=0.5))


def test_a_step_of_two_centimeters_parts_surfaces_in_a_scan_of_a_millimeter(rng):
    """Noise was held at a centimeter: its tolerance of 3 cm was wider than the radius, and both plates were one."""
    places = rng.uniform(0, 1, (12_000, 2))
    lower, upper = (
        np.column_stack([places, np.zeros(len(places))]),
        np.column_stack([places + [1, 0], np.full(12_000, 0.02)]),
    )
    xyz = np.concatenate([lower, upper]) + rng.normal(0, 0.0013, (24_000, 3))
    ids = segment_surfaces(xyz)
    assert np.bincount(ids, minlength=3)[1:].min() > 11_000
    assert (ids[:12_000] > 0).mean() > 0.95
