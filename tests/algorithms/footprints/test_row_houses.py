"""Simulated rows: every house gets its polygon where its roof ends, and no house is cut in two."""

import itertools

import numpy as np
import pytest

from lidar_buildings.algorithms.footprints import extract_footprints as outlining
from lidar_buildings.algorithms.footprints import row_houses as rows
from lidar_buildings.algorithms.footprints.extract_footprints import extract_footprints
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.tests.monitors import Listening
from lidar_buildings.tests.polygon_validity import assert_valid

WIDTH, DEPTH = 5.5, 11.0


def gables(a, v, number):
    return 6 + 1.1 * (WIDTH / 2 - np.abs(a - WIDTH / 2))


def steps(a, v, number):
    return 7 + 0.6 * (number % 2) + 0.7 * (DEPTH / 2 - np.abs(v - DEPTH / 2))


def flat_steps(a, v, number):
    return 7 + 0.8 * (number % 2)


def one_roof(a, v, number):
    return 7 + 0.7 * (DEPTH / 2 - np.abs(v - DEPTH / 2))


def firewalls(a, v, number):
    return one_roof(a, v, number) + 0.6 * (np.minimum(a, WIDTH - a) < 0.2)


def dormers(a, v, number):
    return np.where((np.abs(a - WIDTH / 2) < 1.2) & (v > 1) & (v < 4), 9.0, one_roof(a, v, number))


def row(rng, roof, density, houses=5, angle=0.5, depth=DEPTH):
    """Return the points of a row of houses and the ground around it, their classes, and how to turn back to the row."""
    n = round(houses * WIDTH * depth * density)
    u, v = rng.uniform(0, houses * WIDTH, n), rng.uniform(0, depth, n)
    number = (u // WIDTH).astype(int)
    z = roof(u - number * WIDTH, v, number)
    m = round((houses * WIDTH + 16) * (depth + 16) * density)
    ground = rng.uniform([-8, -8], [houses * WIDTH + 8, depth + 8], (m, 2))
    is_under = (ground >= 0).all(axis=1) & (ground <= [houses * WIDTH, depth]).all(axis=1)
    plan = np.concatenate([np.column_stack([u, v]), ground[~is_under]])
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    z = np.concatenate([z, np.zeros((~is_under).sum())]) + rng.normal(0, 0.03, len(plan))
    return np.column_stack([plan @ turn + [1000, 2000], z]), np.repeat([6, 2], [n, (~is_under).sum()]), turn


def outlined(rng, roof, density, **more):
    xyz, classification, turn = row(rng, roof, density, **more)
    found = extract_footprints(xyz, classification, None, xyz[:, 2].astype(np.float32))
    return found, [(np.concatenate(rings) - [1000, 2000]) @ turn.T for rings in found.geometries]


@pytest.mark.parametrize("roof", [gables, steps, flat_steps, firewalls])
@pytest.mark.parametrize("density", [8, 20])
def test_houses_of_a_row_are_polygons_that_share_their_walls(rng, roof, density):
    found, places = outlined(rng, roof, density)
    assert len(found) == 5
    assert found.columns["cluster_id"] == [1] * 5
    assert sorted(found.columns["id"]) == [1, 2, 3, 4, 5]
    assert found.columns["area"] == pytest.approx([WIDTH * DEPTH] * 5, rel=0.06)
    walls = sorted(x for place in places for x in (place[:, 0].min(), place[:, 0].max()))
    # Inner walls are there twice, once for either house.
    assert walls[1:-1] == pytest.approx(np.repeat(np.arange(1, 5) * WIDTH, 2), abs=0.3)
    edges = [{tuple(edge) for edge in np.hstack([r[:-1], r[1:]]).tolist()} for (r,) in found.geometries]
    back = [{(c, d, a, b) for a, b, c, d in one} for one in edges]
    assert sum(bool(one & other) for one in edges for other in back) == 8
    for rings in found.geometries:
        assert_valid(rings)


@pytest.mark.parametrize("density", [6, 8])
def test_triangles_that_a_wall_cuts_off_at_the_outline_cost_no_house(density):
    """A corner of a triangle behind a wall was taken for a piece too small for a house, and the wall was left out."""
    for seed in range(6):
        found, _ = outlined(np.random.default_rng(seed), flat_steps, density, houses=8, angle=0.3 * seed)
        assert found.columns["area"] == pytest.approx([WIDTH * DEPTH] * 8, rel=0.2)


def test_attributes_are_those_of_each_house(rng):
    found, places = outlined(rng, flat_steps, 12)
    heights = [7 + 0.8 * ((place[:, 0].min() + WIDTH / 2) // WIDTH % 2) for place in places]
    for name in ("height", "ridge_height", "eave_height"):
        assert found.columns[name] == pytest.approx(heights, abs=0.1)
    assert found.columns["volume"] == pytest.approx([h * a for h, a in zip(heights, found.columns["area"])], rel=0.03)


@pytest.mark.parametrize("roof", [one_roof, dormers])
@pytest.mark.parametrize("density", [4, 20])
def test_a_roof_that_goes_on_is_not_split(rng, roof, density):
    assert len(outlined(rng, roof, density)[0]) == 1


def hipped(a, v, number):
    """Gables whose valleys are seen on half of the depth only: hipped at both ends."""
    end = np.minimum(v, DEPTH - v)
    return 6 + np.minimum(gables(a, v, number) - 6, 1.1 * np.maximum(end - 2.75, 0.0))


def test_hipped_houses_beside_clear_ones_are_of_their_row(rng):
    def mixed(a, v, number):
        return np.where(number < 3, gables(a, v, number), hipped(a, v, number))

    assert len(outlined(rng, mixed, 20, houses=6)[0]) == 6
    # Those alone were one, as less than half of each valley is seen.
    assert len(outlined(rng, hipped, 20, houses=6)[0]) == 6


def across(a, v, number):
    """Flat houses that step; two in the middle make way for three whose walls end at their neighbors'."""
    return np.where(np.isin(number, [2, 3]), 8.4 + 0.8 * (v // WIDTH % 2 == 0), flat_steps(a, v, number))


@pytest.mark.parametrize("density", [8, 20])
def test_walls_that_end_at_other_party_walls_are_found(rng, density):
    found, places = outlined(rng, across, density, houses=6, depth=3 * WIDTH)
    assert len(found) == 7
    inner = [place[:, 1] for place in places if 2 * WIDTH - 1 < place[:, 0].mean() < 4 * WIDTH + 1]
    middles = sorted((v.min() + v.max()) / 2 for v in inner)
    assert middles == pytest.approx([0.5 * WIDTH, 1.5 * WIDTH, 2.5 * WIDTH], abs=0.4)
    for rings in found.geometries:
        assert_valid(rings)


def test_a_roof_as_steep_as_a_spire_is_no_row(rng):
    """Along a roof of 65° a neighboring sample is half a meter higher, which was taken for a wall above both."""
    assert len(outlined(rng, lambda a, v, number: 6 + 2.1 * (DEPTH / 2 - np.abs(v - DEPTH / 2)), 12)[0]) == 1


def test_two_gables_may_be_one_house(rng):
    assert len(outlined(rng, gables, 12, houses=2)[0]) == 1


def with_wings(a, v, number):
    """A wing of 60 m² that is half as high as the house, on either side of it, and a tower on it."""
    return np.where((number == 2) & (v < 4), 14.0, np.choose(number, [4.0, 8.0, 8.0, 8.0, 4.0]))


def test_low_parts_and_towers_are_no_houses(rng):
    assert len(outlined(rng, with_wings, 12)[0]) == 1


def low_and_high(a, v, number):
    """Garages of 60 m² between houses: half as high, and no houses themselves."""
    return np.where(number % 2, 8.0, 4.0)


def dormers_from_front_to_back(a, v, number):
    """A strip 2 m wide and 0.8 m higher ends before it would be a house."""
    return 7 + 0.8 * (np.abs(a - WIDTH / 2) < 1)


@pytest.mark.parametrize("roof", [low_and_high, dormers_from_front_to_back])
def test_objects_side_by_side_that_are_no_houses_are_no_row(roof):
    """Of 30 draws of dormers, 29 had been houses."""
    for density in (8, 12, 20):
        for seed in range(4):
            assert len(outlined(np.random.default_rng(seed), roof, density)[0]) == 1


def test_no_house_is_narrower_than_the_least_width(rng):
    """Valleys every 3 m: at least 3.5 m lie between two walls, so that every other one is left out."""

    def narrow(a, v, number):
        return 6 + 1.1 * (1.5 - np.abs((a + number * WIDTH) % 3 - 1.5))

    walls = sorted(place[:, 0].min() for place in outlined(rng, narrow, 12)[1])[1:]
    assert len(walls) >= 3
    assert np.diff(walls).min() > 3.3


@pytest.mark.parametrize("elevation", [-300.0, 0.0, 3000.0])
def test_without_heights_the_elevation_of_the_scene_changes_nothing(rng, elevation):
    """Shares of heights were shares of elevations: in the mountains a wing was a house, below sea level none was."""
    for roof, houses in ((with_wings, 1), (gables, 5)):
        xyz, classification, _ = row(rng, roof, 12)
        assert len(extract_footprints(xyz + [0, 0, elevation], classification)) == houses


def test_a_row_is_one_polygon_if_that_is_asked_for(rng):
    xyz, classification, _ = row(rng, gables, 12)
    assert len(extract_footprints(xyz, classification)) == 5
    merged = extract_footprints(xyz, classification, merge_touching=True)
    assert merged.columns["area"] == pytest.approx([5 * WIDTH * DEPTH], rel=0.03)


def test_buildings_that_touch_are_one_block_if_that_is_asked_for(rng):
    """Two clusters of 5 and 2 houses side by side are two footprints, or one that has the number of the larger."""
    xyz, classification, turn = row(rng, one_roof, 12, houses=7)
    along = ((xyz[:, :2] - [1000, 2000]) @ turn.T)[:, 0]
    cluster = np.where(classification == 6, np.where(along < 5 * WIDTH, 2, 1), 0)
    found = extract_footprints(xyz, classification, cluster)
    assert found.columns["cluster_id"] == [1, 2]
    assert found.columns["area"] == pytest.approx([2 * WIDTH * DEPTH, 5 * WIDTH * DEPTH], rel=0.05)
    merged = extract_footprints(xyz, classification, cluster, merge_touching=True)
    assert merged.columns["cluster_id"] == [2]
    assert merged.columns["area"] == pytest.approx([7 * WIDTH * DEPTH], rel=0.03)


def test_houses_are_the_same_in_any_order_and_place(rng):
    xyz, classification, _ = row(rng, gables, 10)
    areas = sorted(extract_footprints(xyz, classification).columns["area"])
    order = rng.permutation(len(xyz))
    moved = extract_footprints(xyz[order] + [6e5, 5e6, 0], classification[order])
    assert sorted(moved.columns["area"]) == pytest.approx(areas, rel=1e-3)


def test_a_wall_beside_a_front_leaves_no_strip_for_the_house_behind_it(rng, monkeypatch):
    """Of two houses set against each other, one reached along the side of the other as wide as the wall was off."""
    plan = np.mgrid[-8:20:0.3, -8:22:0.3].reshape(2, -1).T + 0.1
    plan += rng.normal(0, 0.02, plan.shape)
    x, y = plan.T
    is_roof = ((x > 0) & (x < 6) & (y > 0) & (y < 10)) | ((x > 6) & (x < 12) & (y > 4) & (y < 14))
    xyz = np.column_stack([plan, np.where(is_roof, 6.0, 0.0)])

    def split(lattice, is_inside, roof, *_):
        # The wall is found a fifth of a meter off the sides of both.
        west, south = roof.min(axis=0)
        is_right = lattice.positions[:, 0].reshape(is_inside.shape) > west + 6.1
        ends = np.add([[[6.1, -1.3], [6.1, 15.3]]], [west, south])
        return rows.Houses(ends, np.where(is_inside, 1 + is_right, 0))

    monkeypatch.setattr(outlining, "split_row", split)
    found = extract_footprints(xyz, np.where(is_roof, 6, 2))
    left, right = sorted((rings[0] for rings in found.geometries), key=lambda ring: ring[:, 0].min())
    assert left.max(axis=0) == pytest.approx([6, 10], abs=0.3)
    assert right.min(axis=0) == pytest.approx([6, 4], abs=0.3)
    assert_valid([left])
    assert_valid([right])


@pytest.mark.parametrize("spacing", [3.0, 1.4])
def test_where_points_are_too_far_apart_to_see_roofs_this_is_reported(rng, spacing):
    """From 2.7 m on, not one place of the grid was next to a wall, and the stage broke off."""
    plan = rng.uniform(0, 1, (round(4800 / spacing**2), 2)) * [80, 60]
    monitor = Monitor()
    xyz = np.column_stack([plan, np.full(len(plan), 8.0)])
    assert len(extract_footprints(xyz, np.full(len(plan), 6), monitor=monitor)) == 1
    assert "too far to see where the houses of a row part" in monitor.infos[-1]


def test_a_long_row_reports_its_progress_and_can_be_cancelled(rng):
    xyz, classification, _ = row(rng, steps, 10, houses=12)
    monitor = Listening()
    found = extract_footprints(xyz, classification, monitor=monitor)
    assert len(found) == 12
    assert monitor.heard == sorted(monitor.heard)
    assert monitor.heard[-1] == pytest.approx(1)
    for stop_at in (0.1, 0.45, 0.6):
        with pytest.raises(Cancelled):
            extract_footprints(xyz, classification, monitor=Listening(stop_at))


def step_of(height, left=0.0, right=0.0, low=8.0):
    """Return a roof across a wall at 0: ``step`` m higher there, rising by slopes to the left and right."""
    return lambda x: low + np.where(x < 0, -left * x, height + right * x)


@pytest.mark.parametrize(
    ("seen", "unseen"),
    [
        # A valley from a slope of 0.25 on.
        (step_of(0.0, 0.3, 0.3), step_of(0.0, 0.2, 0.2)),
        # A step of 0.2 m between roofs whose slopes differ by less than 0.35, and one of 1 m between all but
        # the sides of a ridge.
        (step_of(0.25), step_of(0.15)),
        (step_of(0.7, -0.1, 0.4), step_of(0.7, -0.1, 0.5)),
        (step_of(1.1, 0.0, 0.6), step_of(0.9, 0.0, 0.6)),
        (step_of(2.0, -0.2, -0.3), step_of(2.0, -0.3, -0.3)),
        # A wall 0.2 m above both roofs.
        (lambda x: 8 + 0.25 * (np.abs(x) < 0.2), lambda x: 8 + 0.15 * (np.abs(x) < 0.2)),
        # Roofs deviate by less than 0.25 m from a line.
        (
            lambda x: step_of(0.9)(x) + 0.18 * np.cos(4 * np.pi * x),
            lambda x: step_of(0.9)(x) + 0.32 * np.cos(4 * np.pi * x),
        ),
        # Half of the step is still there 2.7 m from every line within 0.8 m of it.
        (lambda x: step_of(0.9)(x) - 0.9 * (x > 3.6), lambda x: step_of(0.9)(x) - 0.9 * (x > 3.1)),
        # The lower house has six tenths of the other's height.
        (step_of(1.6, low=2.6), step_of(1.6, low=2.2)),
    ],
)
def test_what_looks_like_a_wall_between_two_houses(seen, unseen):
    """On a grid of 25 cm, with the wall in the middle of 20 m."""
    across = 0.25 * np.arange(-40, 41)
    for roof, is_wall in ((seen, True), (unseen, False)):
        for turned in (1, -1):
            height = np.tile(roof(across)[::turned], (20, 1))
            strength, *_ = rows._evidence(height, np.ones(height.shape, bool), 0.25, 1.0)
            assert (strength[10, 40] > 0) == is_wall


@pytest.mark.parametrize(
    ("depth", "seen", "low", "share"),
    [
        # A wall is from 3.5 to 22 m long without low parts, and pays by the share of it that is seen.
        (8.0, 8.0, 0.0, 1.0),
        (3.0, 3.0, 0.0, None),
        (21.0, 21.0, 0.0, 1.0),
        (23.0, 23.0, 0.0, None),
        (12.0, 6.0, 0.0, 0.5),
        (12.0, 4.0, 4.0, 0.5),
    ],
)
def test_what_a_wall_pays(depth, seen, low, share):
    """A step of 0.8 m across a row, of which shares are seen, and next to roofs lower than 4 m."""
    along = 0.25 * np.arange(round(depth / 0.25))[:, None]
    roof = 8 + np.where((np.arange(81) >= 40) & (along < seen), 0.8, 0.0)
    roof[along[:, 0] >= depth - low] = 3.0
    view = rows._View(0.3, 0.25, None, None, None, *rows._evidence(roof, np.ones(roof.shape), 0.25, 1.0))
    inside = np.ones(roof.shape, bool)
    runs = rows._Runs.of(inside)
    pays = view._pays(*view._sums(runs, inside))[40] / 10_000
    # A step four times as high as the least one is seen by three quarters; ends blur over a meter.
    expected = 0.75 * share - 0.3 * rows.ROWS.wall if share else 0
    assert pays == pytest.approx(min(expected, rows.ROWS.row), rel=0.15) if share else pays < -1


def cost_of(walls, pays, step):
    """Return what some walls of a row save, as its definition says it; none where a house is too narrow."""
    ends = np.array([0, *walls, len(pays)]) * step
    if np.diff(ends).min() < rows.ROWS.narrowest:
        return -np.inf
    unlike = min(rows.ROWS.unlike * np.abs(np.log(np.diff(ends) / width)).sum() for width in rows._WIDTHS)
    return pays[list(walls)].sum() / 10_000 - unlike - rows.ROWS.row


def test_no_other_walls_of_a_row_save_more():
    """All 2^17 choices of walls in 18 m of a row are tried."""
    for seed in range(3):
        pays = np.rint(10_000 * np.random.default_rng(seed).uniform(-0.2, 0.7, 18)).astype(np.int64)
        saved, walls = rows._chosen_walls(pays, np.full(18, 20), 1.0)
        choices = (
            walls
            for count in range(1, 5)
            for walls in itertools.combinations(range(4, 15), count)
            if np.diff([0, *walls, 18]).min() >= 4
        )
        best = max(choices, key=lambda walls: cost_of(walls, pays, 1.0))
        assert walls.tolist() == list(best)
        assert saved / 10_000 == pytest.approx(cost_of(best, pays, 1.0), abs=1e-3)


@pytest.mark.parametrize("roof", [gables, steps, flat_steps])
def test_rows_are_parted_at_four_points_per_square_meter(roof):
    """Nothing was split from 0.44 m between points on."""
    found = [len(outlined(np.random.default_rng(seed), roof, 4, houses=8)[0]) for seed in range(4)]
    assert np.mean(found) >= 6


def test_walls_run_along_the_roofs_where_the_front_is_not_square_to_them(rng):
    """Along a canal that bends: walls were sought along the front and square to it, and none was found."""
    xyz, classification, turn = row(rng, gables, 12, houses=6, depth=16)
    along, across = ((xyz[:, :2] - [1000, 2000]) @ turn.T).T
    # The front is turned by 27° against the walls, and so is the back.
    moved = np.column_stack([along, across + 0.5 * along]) @ turn + [1000, 2000]
    found = extract_footprints(np.column_stack([moved, xyz[:, 2]]), classification, None, xyz[:, 2].astype(np.float32))
    assert found.columns["area"] == pytest.approx([WIDTH * 16] * 6, rel=0.12)
