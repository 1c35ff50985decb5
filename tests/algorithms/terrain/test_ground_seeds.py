"""Seeds lie on the ground of scenes whose ground is known, and on enough of it."""

import numpy as np
import pytest

from lidar_buildings.algorithms import threads
from lidar_buildings.algorithms.geometry.grid import turned_in_plan
from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.algorithms.terrain import ground_seeds as module
from lidar_buildings.algorithms.terrain.ground_seeds import _View, seeds_by_lowest
from lidar_buildings.tests.monitors import Listening


def from_corner(xyz):
    """Return points measured from the corner of the cloud, where stages have the cells begin."""
    return CloudSampling.of(xyz).from_corner(xyz)


def seeds_by_opening(xyz, *arguments, **options):
    return module.seeds_by_opening(from_corner(xyz), *arguments, **options)


def lowest_points(xyz, cell_size):
    return module.lowest_points(from_corner(xyz), cell_size)


def even(width, depth, step=0.7):
    x, y = np.meshgrid(np.arange(0, width, step), np.arange(0, depth, step))
    return np.column_stack([x.ravel(), y.ravel()])


def raise_roofs(plan, ground, *roofs):
    """Return elevations and which points are roof: (west, south, width, depth, elevation) each."""
    z, is_roof = ground.copy(), np.zeros(len(plan), bool)
    for west, south, width, depth, elevation in roofs:
        inside = ((plan >= [west, south]) & (plan <= [west + width, south + depth])).all(axis=1)
        z[inside] = elevation
        is_roof |= inside
    return z, is_roof


def test_lowest_points_one_by_one(rng):
    xyz = rng.uniform([5, -3, 0], [25, 9, 4], (500, 3))
    lowest = lowest_points(xyz, 1.7)
    expected = {}
    for i, (x, y, z) in enumerate(xyz):
        cell = (int((x - xyz[:, 0].min()) / 1.7), int((y - xyz[:, 1].min()) / 1.7))
        if cell not in expected or z < xyz[expected[cell], 2]:
            expected[cell] = i
    found = {tuple(cell): lowest.index[tuple(cell)] for cell in np.argwhere(lowest.index >= 0).tolist()}
    assert found == expected
    assert sorted(lowest.points(lowest.index >= -1)) == sorted(expected.values())


def test_of_equally_low_points_the_first_counts():
    xyz = np.array([[0.5, 0.5, 3.0], [0.1, 0.1, 1.0], [0.2, 0.3, 1.0], [0.9, 0.9, 1.0]])
    assert lowest_points(xyz, 2.0).index.tolist() == [[1]]


def test_seeds_by_lowest_are_one_per_cell(rng):
    xyz = rng.uniform([0, 0, 0], [90, 60, 5], (4000, 3))
    seeds = seeds_by_lowest(xyz, 30.0)
    assert len(seeds) == 6
    for row in range(2):
        for column in range(3):
            low = np.array([column, row]) * 30 + xyz[:, :2].min(axis=0)
            inside = np.flatnonzero(((xyz[:, :2] >= low) & (xyz[:, :2] < low + 30)).all(axis=1))
            assert inside[np.argmin(xyz[inside, 2])] in seeds


TERRAINS = {
    "level": lambda x, y: np.zeros_like(x),
    "slope": lambda x, y: 0.25 * x - 0.1 * y,
    "hill": lambda x, y: 12 * np.exp(-((x - 60) ** 2 + (y - 60) ** 2) / (2 * 25**2)),
    "valley": lambda x, y: 0.004 * (x - 60) ** 2,
}


@pytest.mark.parametrize("name", TERRAINS)
def test_seeds_cover_terrain_and_no_roof(name, rng):
    plan = even(120, 120) + rng.uniform(-0.3, 0.3, (len(even(120, 120)), 2))
    ground = TERRAINS[name](*plan.T)
    roofs = [(20, 20, 12, 9, 0), (70, 30, 30, 20, 0), (40, 80, 8, 30, 0)]
    placed = []
    for west, south, width, depth, _ in roofs:
        under = ((plan >= [west, south]) & (plan <= [west + width, south + depth])).all(axis=1)
        placed.append((west, south, width, depth, ground[under].max() + 4))
    z, is_roof = raise_roofs(plan, ground + rng.normal(0, 0.03, len(plan)), *placed)
    seeds, *_ = seeds_by_opening(np.column_stack([plan, z]), 1.0, 60.0, Monitor())
    assert len(set(seeds.tolist())) == len(seeds)
    assert not is_roof[seeds].any()
    # Every open place of terrain has a seed within a few cells.
    covered = {(int(x / 6), int(y / 6)) for x, y in plan[seeds]}
    open_ground = {(int(x / 6), int(y / 6)) for x, y in plan[~is_roof]}
    assert len(open_ground - covered) <= 0.03 * len(open_ground)


def test_a_dike_is_terrain_though_windows_lift_it_off(rng):
    """It is narrower than any building, but its sides join the terrain smoothly."""
    plan = rng.uniform(0, 100, (30_000, 2))
    z = 4 * np.exp(-((plan[:, 0] - 50) ** 2) / (2 * 5**2))
    seeds, *_ = seeds_by_opening(np.column_stack([plan, z + rng.normal(0, 0.02, len(plan))]), 1.0, 60.0, Monitor())
    upper_half = {tuple(cell) for cell in np.floor(plan[z > 2]).astype(int).tolist()}
    seeded = {tuple(cell) for cell in np.floor(plan[seeds][z[seeds] > 2]).astype(int).tolist()}
    assert len(seeded) > 0.88 * len(upper_half)


def test_a_steep_ridge_is_terrain_as_its_slope_is_measured_anew(rng):
    """Rock at 50°: most of it is removed by windows over flat terrain, and not by those that follow its slope."""
    plan = even(120, 60, 0.9) + rng.uniform(-0.4, 0.4, (len(even(120, 60, 0.9)), 2))
    z = 1.2 * np.clip(30 - np.abs(plan[:, 0] - 60), 0, 27) + rng.normal(0, 0.02, len(plan))
    seeds, *_ = seeds_by_opening(np.column_stack([plan, z]), 1.0, None, Monitor())
    assert (z > 1.0)[seeds].sum() > 0.5 * 60 * 60


@pytest.mark.parametrize("spacing", [1.6, 2.4])
def test_a_heap_of_soil_is_terrain_however_few_points_hold_it(spacing, rng):
    """In cells of half the spacing a slope looks like steps: twice as steep in one cell, level in the next."""
    plan = even(120, 120, spacing) + rng.uniform(-0.2, 0.2, (len(even(120, 120, spacing)), 2))
    inward = 8 - np.hypot(*(plan - 60).T)
    z = np.clip(0.7 * inward, 0, None) + rng.normal(0, 0.03, len(plan))
    house = (np.abs(plan - 20) < 6).all(axis=1)
    z[house] += 4.0
    seeds, *_ = seeds_by_opening(np.column_stack([plan, z]), spacing / 2, None, Monitor(), spacing)
    heap = inward > 0
    assert heap[seeds].sum() > 0.9 * heap.sum()
    assert not house[seeds].any()


@pytest.mark.parametrize(("depth", "is_pit"), [(4.0, False), (6.0, True)])
def test_pits_are_no_seeds(depth, is_pit, rng):
    """Single points of multipath lie deeper than five cells; a shaft doesn't."""
    plan = even(40, 40) + rng.uniform(-0.3, 0.3, (len(even(40, 40)), 2))
    xyz = np.column_stack([plan, rng.normal(0, 0.02, len(plan))])
    deep = np.array([100, 1500, 2222])
    xyz[deep, 2] = -depth
    seeds, *_ = seeds_by_opening(xyz, 1.0, 30.0, Monitor())
    assert (~np.isin(deep, seeds)).all() == is_pit
    assert len(seeds) > 1000


def test_a_narrow_yard_is_no_pit(rng):
    """Four meters wide in a building 15 m high, it is less than a tenth of all around, but no single place."""
    plan = even(80, 80) + rng.uniform(-0.3, 0.3, (len(even(80, 80)), 2))
    inward = 15 - np.abs(plan - 40).max(axis=1)
    is_yard = inward > 13
    z = np.where((inward > 0) & ~is_yard, 15.0, 0.0) + rng.normal(0, 0.02, len(plan))
    seeds, *_ = seeds_by_opening(np.column_stack([plan, z]), 1.0, None, Monitor())
    assert is_yard[seeds].sum() >= 9


def test_stray_points_as_deep_as_ground_farther_off_are_no_terrain(rng):
    """On a terrace some points lie as deep as the plain; at its edge they may be of it, but not 15 m from there."""
    plan = even(100, 60, 1.0) + rng.uniform(0.0, 0.9, (len(even(100, 60, 1.0)), 2))
    is_stray = (rng.random(len(plan)) < 0.03) & (plan[:, 0] < 45)
    z = np.where((plan[:, 0] < 60) & ~is_stray, 12.0, 0.0) + rng.normal(0, 0.02, len(plan))
    seeds, *_ = seeds_by_opening(np.column_stack([plan, z]), 1.0, None, Monitor())
    assert is_stray[seeds].sum() <= 0.05 * is_stray.sum()


@pytest.mark.parametrize(("share", "is_terrain"), [(0.15, True), (0.06, False)])
def test_gaps_of_a_forest_show_the_ground_and_stray_points_do_not(share, is_terrain, rng):
    """Both lie twelve meters below all that is next to them; pulses that go astray are few."""
    plan = even(80, 80, 1.0) + rng.uniform(0.0, 0.9, (len(even(80, 80, 1.0)), 2))
    is_deep = rng.random(len(plan)) < share
    z = 0.2 * plan[:, 0] + np.where(is_deep, 0.0, 12.0 + (rng.uniform(0, 4, len(plan)) if is_terrain else 0.0))
    seeds, *_ = seeds_by_opening(np.column_stack([plan, z]), 1.0, None, Monitor())
    assert (is_deep[seeds].sum() > 0.9 * is_deep.sum()) == is_terrain
    assert is_deep[seeds].mean() == pytest.approx(float(is_terrain), abs=0.03)


def test_gaps_without_points_change_nothing(rng):
    """A lake returns nothing; its shores are still ground."""
    plan = even(80, 80) + rng.uniform(-0.3, 0.3, (len(even(80, 80)), 2))
    plan = plan[np.hypot(*(plan - 40).T) > 18]
    seeds, *_ = seeds_by_opening(np.column_stack([plan, 0.05 * plan[:, 0]]), 1.0, 60.0, Monitor())
    shore = np.hypot(*(plan[seeds] - 40).T) < 20
    assert shore.sum() > 100


def test_a_terrace_keeps_its_upper_level(rng):
    """A step of 3 m across the whole scene is terrain on both sides: the upper side is wider than any window."""
    plan = even(150, 60) + rng.uniform(-0.3, 0.3, (len(even(150, 60)), 2))
    z = np.where(plan[:, 0] > 75, 3.0, 0.0) + rng.normal(0, 0.02, len(plan))
    seeds, *_ = seeds_by_opening(np.column_stack([plan, z]), 1.0, 40.0, Monitor())
    upper = plan[seeds, 0] > 76
    assert upper.sum() > 0.9 * 74 * 60


def scene_with_plateau(rng, bank):
    """Return points of a level scene with a plateau of 100 m by 90 m, 9 m high, and how wide its bank is (m)."""
    plan = even(240, 240, 1.4) + rng.uniform(-0.3, 0.3, (len(even(240, 240, 1.4)), 2))
    inward = np.minimum(50 - np.abs(plan[:, 0] - 120), 45 - np.abs(plan[:, 1] - 120))
    z = 9.0 * np.clip((inward + bank) / bank if bank else inward > 0, 0, 1)
    return np.column_stack([plan, z + rng.normal(0, 0.02, len(plan))]), inward > 0


def test_a_hall_larger_than_usual_is_found_as_it_is_free_standing(rng):
    xyz, is_hall = scene_with_plateau(rng, bank=0.0)
    seeds, stands_free, size = seeds_by_opening(xyz, 1.4, None, Monitor())
    assert not is_hall[seeds].any()
    # At the walls cells hold the ground, too.
    assert stands_free[is_hall].mean() > 0.9
    assert not stands_free[~is_hall].any()
    assert size > 85
    seeds, _, size = seeds_by_opening(xyz, 1.4, 60.0, Monitor())
    assert is_hall[seeds].mean() > 0.1
    assert size == 60.0


def test_a_flat_hill_as_large_as_a_hall_is_terrain(rng):
    xyz, is_top = scene_with_plateau(rng, bank=15.0)
    seeds, stands_free, size = seeds_by_opening(xyz, 1.4, None, Monitor())
    assert not stands_free.any()
    assert size == 60.0
    assert is_top[seeds].sum() > 0.9 * is_top.sum()


def test_a_low_house_with_a_large_roof_on_a_slope_is_no_bank(rng):
    """Growing windows remove its hip roof little by little, and uphill its eaves are hardly 1.3 m over the lawn."""
    plan = even(70, 70, 0.5) + rng.uniform(-0.2, 0.2, (len(even(70, 70, 0.5)), 2))
    terrain = 0.08 * plan[:, 0]
    inward = 7.0 - np.abs(plan - 35).max(axis=1)
    eaves = 0.08 * 28 + 2.4
    xyz = np.column_stack([plan, np.where(inward > 0, eaves + 0.35 * inward, terrain) + rng.normal(0, 0.02, len(plan))])
    seeds, *_ = seeds_by_opening(xyz, 1.0, None, Monitor())
    assert not (inward[seeds] > 0).any()
    assert (inward[seeds] < -1).sum() > 0.9 * (70**2 - 16**2)


def test_a_garage_built_into_the_slope_beside_a_high_building_is_no_terrain(rng):
    """Its roof meets the slope uphill, so that it is not free-standing, and with the slope it is as wide as a hill."""
    plan = even(90, 90) + rng.uniform(-0.3, 0.3, (len(even(90, 90)), 2))
    terrain = 0.08 * plan[:, 1]
    z, is_roof = raise_roofs(plan, terrain, (25, 25, 15, 40, 12.0), (40, 30, 5, 30, 0.08 * 60))
    seeds, *_ = seeds_by_opening(np.column_stack([plan, z + rng.normal(0, 0.02, len(plan))]), 1.0, None, Monitor())
    is_high = is_roof & (z > terrain + 1.0)
    assert is_high[seeds].sum() < 0.05 * is_high.sum()
    assert (~is_roof[seeds]).sum() > 0.45 * (~is_roof).sum()


def test_a_roof_that_meets_a_steep_slope_is_no_terrain_where_it_is_high_over_it(rng):
    """A house of 12 m on a slope of 0.5: 6 m over the terrain downhill, where it would be no steeper than that."""
    plan = even(80, 80) + rng.uniform(-0.3, 0.3, (len(even(80, 80)), 2))
    terrain = 0.5 * plan[:, 0]
    z, is_roof = raise_roofs(plan, terrain, (34, 34, 12, 12, 0.5 * 46))
    seeds, *_ = seeds_by_opening(np.column_stack([plan, z + rng.normal(0, 0.02, len(plan))]), 1.0, None, Monitor())
    assert not (z - terrain > 5.0)[seeds].any()
    assert (~is_roof[seeds]).sum() > 0.45 * (~is_roof).sum()


@pytest.mark.parametrize("slope", [0.8, 1.0, 1.1])
def test_banks_as_steep_as_soil_lies_are_terrain_on_both_sides(slope, rng):
    """However unevenly the lowest points lie in their cells: eaves are no steeper than their flanks look there."""
    plan = even(90, 90) + rng.uniform(-0.35, 0.35, (len(even(90, 90)), 2))
    across, along = np.abs(plan - 45).T
    bank = slope * np.clip(np.minimum(4 - across, 20 - along), 0, None)
    seeds, *_ = seeds_by_opening(np.column_stack([plan, bank + rng.normal(0, 0.02, len(plan))]), 1.0, None, Monitor())
    # One of the two points of a cell is a seed.
    assert (bank[seeds] > 1).sum() > 0.4 * (bank > 1).sum()


def test_a_house_on_a_dike_stays_an_object_where_the_dike_comes_back(rng):
    """Windows lift both off, as one region that joins the terrain smoothly all round."""
    plan = even(100, 100) + rng.uniform(-0.3, 0.3, (len(even(100, 100)), 2))
    dike = 4 * np.exp(-((plan[:, 0] - 50) ** 2) / (2 * 5**2))
    z, is_house = raise_roofs(plan, dike, (46, 40, 8, 10, 7.0))
    seeds, stands_free, _ = seeds_by_opening(
        np.column_stack([plan, z + rng.normal(0, 0.02, len(plan))]), 1.0, None, Monitor()
    )
    assert stands_free[is_house].mean() > 0.7
    assert not is_house[seeds].any()
    # One of the two points of a cell is a seed.
    assert (dike[seeds] > 2).sum() > 0.4 * ((dike > 2) & ~is_house).sum()


def test_progress_only_grows():
    plan, monitor = even(30, 30), Listening()
    seeds_by_opening(np.column_stack([plan, np.zeros(len(plan))]), 1.0, 30.0, monitor)
    assert monitor.heard == sorted(monitor.heard)
    assert monitor.heard[-1] == 1.0


def test_the_search_for_pits_can_be_stopped(rng, monkeypatch):
    """In a dense forest there are as many pits as trees. With one thread, the monitor is called at each step."""
    monkeypatch.setattr(threads, "_ASSIGNED", [1])
    plan, monitor = even(60, 60), Listening(stop_at=0.01)
    z = np.where(rng.random(len(plan)) < 0.1, 0.0, rng.uniform(18, 22, len(plan)))
    with pytest.raises(Cancelled):
        seeds_by_opening(np.column_stack([plan, z]), 1.0, 30.0, monitor)
    assert monitor.heard[-1] < 0.1


def test_a_point_far_off_is_refused_instead_of_filling_memory(rng):
    """A raster from here to a point 300 km away would have 90 thousand million cells."""
    xyz = np.vstack([rng.uniform(0, 50, (500, 3)), [[300_000.0, 300_000.0, 0.0]]])
    with pytest.raises(ValueError, match="501 points are spread over 300,000 m by 300,000 m, which is nearly empty"):
        seeds_by_opening(xyz, 1.0, None, Monitor())
    with pytest.raises(ValueError, match="501 points are spread"):
        seeds_by_lowest(xyz, 1.0)


def seeds_of_views(monkeypatch, reported):
    """Return the seeds of three points by given results of directions; the middle one is the lowest of its cell."""
    usual = {"says_terrain": 1, "stands_free": 0, "size": 0.0}
    views = {angle: {**usual, **one} for angle, one in zip((0.0, 30.0, 60.0), reported)}

    def view(seen, z, slope, monitor):
        now, n = views.pop(seen.cells.angle), len(z)
        says, free = np.full(n, now["says_terrain"], np.int8), np.full(n, bool(now["stands_free"]))
        return _View(np.array([1]), says, free, now["size"], np.zeros(n))

    monkeypatch.setattr(module, "_view", view)
    found = seeds_by_opening(np.array([[0.0, 0, 0], [5, 0, 0], [5, 5, 0]]), 1.0, None, Monitor())
    assert not views
    return found


@pytest.mark.parametrize(
    ("verdicts", "is_seed"),
    [
        ((1, 1, 1), True),
        ((1, 1, -1), True),
        ((-1, 1, 1), True),
        # The lowest point of a steep cell lies over the lowest of others.
        ((1, 0, 0), True),
        ((1, 0, -1), False),
        ((-1, 0, 1), False),
        ((1, -1, -1), False),
        ((-1, 0, 0), False),
    ],
)
def test_a_point_is_terrain_by_the_majority_of_directions(verdicts, is_seed, monkeypatch):
    seeds, *_ = seeds_of_views(monkeypatch, [{"says_terrain": verdict} for verdict in verdicts])
    assert seeds.tolist() == ([1] if is_seed else [])


@pytest.mark.parametrize(
    ("free", "stands"),
    [((0, 0, 0), False), ((0, 1, 0), False), ((0, 0, 1), False), ((0, 1, 1), True), ((1, 0, 0), True), ((1,), True)],
)
def test_free_standing_cells_are_so_in_the_first_direction_or_in_all_others(free, stands, monkeypatch):
    monkeypatch.setattr(module, "_turns", lambda: np.array((0.0, 30.0, 60.0))[: len(free)])
    seeds, stands_free, _ = seeds_of_views(monkeypatch, [{"stands_free": one} for one in free])
    assert stands_free.all() == stands_free.any() == stands
    assert seeds.tolist() == ([] if stands else [1])


@pytest.mark.parametrize(("sizes", "size"), [((0, 100, 100), 60), ((80, 0, 120), 80)])
def test_the_largest_building_is_what_the_first_direction_finds_or_larger(sizes, size, monkeypatch):
    """The others see the box of a hall turned, and larger than it is."""
    assert seeds_of_views(monkeypatch, [{"size": float(one)} for one in sizes])[2] == size


@pytest.mark.parametrize(("width", "directions"), [(40, [0.0, 30.0, 60.0]), (35, [0.0, 30.0, 60.0]), (28, [0.0])])
def test_a_narrow_strip_is_looked_at_in_one_direction(width, directions, rng, monkeypatch):
    """Turned, it would lie in a raster that is empty for the most part."""
    looked, view = [], module._view
    monkeypatch.setattr(module, "_view", lambda seen, *given: looked.append(seen.cells.angle) or view(seen, *given))
    plan = even(100, width)
    seeds, *_ = seeds_by_opening(np.column_stack([plan, np.zeros(len(plan))]), 1.0, None, Monitor())
    # The others are looked at side by side.
    assert looked[0] == 0.0
    assert sorted(looked) == directions
    assert len(seeds) == 100 * width


def test_the_slope_is_measured_once(monkeypatch):
    measured, slope = [], module.ObjectRemoval.slope
    monkeypatch.setattr(
        module.ObjectRemoval, "slope", lambda removal, monitor: measured.append(1) or slope(removal, monitor)
    )
    seeds_by_opening(np.column_stack([even(30, 30), 0.1 * even(30, 30)[:, 0]]), 1.0, None, Monitor())
    assert len(measured) == 1


@pytest.mark.parametrize("angle", [0.0, 30.0, 60.0])
@pytest.mark.parametrize(("hall", "is_free"), [((30, 20, 50, 60, 8.0), True), ((0, 15, 80, 65, 8.0), False)])
def test_where_the_cloud_ends_is_the_same_in_each_direction(hall, is_free, angle):
    """Of a hall a corner is seen, or one wall: that may be terrain from which something is dug out."""
    plan = even(80, 80)
    z, is_hall = raise_roofs(plan, np.zeros(len(plan)), hall)
    view = seen_from(angle, plan, z)
    assert (view.stands_free[is_hall].mean() > 0.95) == is_free
    assert view.stands_free[is_hall].any() == is_free
    assert not view.stands_free[~is_hall].any()


@pytest.mark.parametrize("angle", [0.0, 30.0, 60.0])
def test_every_lowest_point_of_a_steep_slope_is_terrain_in_each_direction(angle):
    """In the turned cells others lie lower, by as much as terrain rises within a cell."""
    plan = even(60, 60, step=1.0)
    view = seen_from(angle, plan, 0.8 * plan[:, 0])
    inside = ((plan > 10) & (plan < 50)).all(axis=1)
    assert (view.says_terrain[inside] == 1).all()


def seen_from(angle, plan, z):
    turned = turned_in_plan(np.column_stack([plan, z]), angle)
    cells = module._Cells(np.array([plan.min(axis=0), plan.max(axis=0)]), angle, 1.0, 0.7)
    return module._view(module._lowest_surface(turned, cells, None, Monitor()), z, None, Monitor())
