"""Trees whose stems and branches are known."""

import tracemalloc

import numpy as np
import pytest

from lidar_buildings.algorithms.shapes import tree_structure
from lidar_buildings.algorithms.shapes.segment_tree import _are_no_thinner, _radii, segment_tree
from lidar_buildings.algorithms.shapes.stem_search import find_stems, ground_level
from lidar_buildings.algorithms.simulation.simulate_tree import simulate_tree
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.tests.builders import EXACT_FAR

SMALL = {"height": 9.0, "dbh": 0.2, "n_branches": 8, "density": 3000.0}


@pytest.fixture(scope="module")
def tree():
    return simulate_tree(**SMALL)


@pytest.fixture(scope="module")
def found(tree):
    return segment_tree(tree[0], tree[1])


def right_length(found, truth, true_branches):
    """Return the share of the length of branches over 3 cm whose points are in a segment that is mostly theirs."""
    total = right = 0.0
    for number, length, radius in zip(*(true_branches.columns[name] for name in ("id", "length", "radius"))):
        if radius < 0.015:
            continue
        total += length
        own = np.bincount(found[truth == number], minlength=2)
        own[0] = 0
        best = int(own.argmax())
        of_best = np.bincount(truth[found == best])
        of_best[0] = 0
        if own[best] and of_best.argmax() == number:
            right += length * own[best] / (truth == number).sum()
    return right / total


def test_the_stem_is_found_with_its_diameter_and_length(found):
    columns = found[1].columns
    assert columns["branch_order"].count(0) == 1
    assert columns["dbh"][0] == pytest.approx(0.2, abs=0.01)
    assert columns["length"][0] == pytest.approx(9.0, rel=0.04)
    # A cone from the base, a little thicker than at breast height, to 0.35 of that at the top.
    assert columns["volume"][0] == pytest.approx(np.pi / 3 * 9 * 0.11**2 * (1 + 0.35 + 0.35**2), rel=0.15)
    assert np.isnan(columns["dbh"][1:]).all()


@pytest.mark.parametrize(
    ("tunables", "is_one_sided"),
    [({}, False), ({"height": 14.0, "dbh": 0.3, "n_branches": 14}, False), ({"leaves": 1.0}, False), ({}, True)],
)
def test_branches_have_their_wood(tunables, is_one_sided):
    """Branches of first order had half of it, of second order a seventh; two thirds of all where one side is seen."""
    xyz, classification, truth, branches = simulate_tree(**{**SMALL, **tunables})
    kept = np.ones(len(xyz), bool)
    for number, line in enumerate(branches.geometries if is_one_sided else (), start=1):
        own = np.flatnonzero(truth == number)
        offset = xyz[own] - line[np.linalg.norm(xyz[own, None] - line, axis=2).argmin(axis=1)]
        kept[own] = offset[:, 0] < 0.2 * np.abs(offset[:, 1])
    columns = {name: np.array(one) for name, one in segment_tree(xyz[kept], classification[kept])[1].columns.items()}
    order, length, radius = (np.array(branches.columns[name]) for name in ("branch_order", "length", "radius"))
    # Each a cone whose tip has 0.35 of the radius of its base.
    wood = np.pi / 3 * length * radius**2 * (1 + 0.35 + 0.35**2)
    assert columns["volume"].sum() == pytest.approx(wood.sum(), rel=0.1)
    assert columns["volume"][columns["branch_order"] == 1].sum() == pytest.approx(wood[order == 1].sum(), rel=0.35)
    assert 0.5 < columns["volume"][columns["branch_order"] == 2].sum() / wood[order == 2].sum() < 2


def test_leaves_do_not_swell_branches(found):
    """Round clumps of them far out on a branch made all beyond thicker than the stem."""
    radius, order = (np.array(found[1].columns[name]) for name in ("radius", "branch_order"))
    assert radius[order > 0].max() < 0.6 * radius[0]


def test_a_stem_of_a_meter_and_a_half_has_its_root():
    """No voxel of it is within half a meter of its axis, and the stage ended in an IndexError."""
    xyz, classification, *_ = simulate_tree(height=20.0, dbh=1.5, n_branches=4, density=150.0, noise=0.01)
    columns = segment_tree(xyz, classification)[1].columns
    assert columns["branch_order"].count(0) == 1
    assert columns["dbh"][0] == pytest.approx(1.5, rel=0.02)
    assert columns["length"][0] == pytest.approx(20.0, rel=0.05)


def test_a_measured_radius_that_swells_is_estimated():
    """From 0.1 m at 4 m of branches beyond: half of the length has 0.71 of the radius, whatever is measured there."""
    reach, ahead = np.array([0.1, 0.25, 0.07]), np.array([4.0, 2.0, 1.0])
    radius, is_measured, wood = _radii(reach, np.array([True, True, True]), ahead, np.array([0.0025, np.inf]))
    assert is_measured.tolist() == [True, False, True]
    assert radius == pytest.approx([0.1, 0.1 / np.sqrt(2), 0.07])
    assert wood[-1].tolist() == pytest.approx([0.07**2 / 1.0, 0.07])


def test_the_foot_of_a_stem_that_is_thinner_than_the_stem_is_not_measured():
    """Of a real pine's first meter grass left a quarter, and all above got its radius."""
    reach = np.array([0.04, 0.08, 0.05, 0.14, 0.13, 0.13, 0.12, 0.12])
    is_round = np.array([True, True, False, True, True, True, True, True])
    assert _are_no_thinner(reach, is_round).tolist() == [False] * 3 + [True] * 5


def test_radii_that_voxels_cannot_carry_are_estimated(tree, found):
    """With voxels of 13 cm, all branches got radii of 14 cm, and the wood was 12 times as much."""
    xyz, classification, *_ = tree
    fine = found[1].columns
    coarse = segment_tree(xyz, classification, voxel_size=0.13)[1].columns
    assert sum(coarse["volume"]) == pytest.approx(sum(fine["volume"]), rel=0.4)
    is_branch = np.array(coarse["branch_order"]) > 0
    assert np.mean(np.array(coarse["measured"])[is_branch]) < 0.2
    assert fine["measured"][0] > 0.7


def test_a_stem_too_slender_to_stand_is_no_stem(tree, rng):
    """A branch that hangs to the ground next to a stem took half of its tree."""
    xyz, classification, *_ = tree
    count, top = 4000, 8.5
    up, turn = rng.uniform(0, top, count), rng.uniform(0, 2 * np.pi, count)
    foot = xyz[xyz[:, 2] < 1][:, :2].mean(axis=0) + [0.6, 0]
    hanging = np.column_stack([foot + 0.017 * np.column_stack([np.cos(turn), np.sin(turn)]), up])
    both = np.concatenate([xyz, hanging])
    layer = segment_tree(both, np.append(classification, np.ones(count, np.uint8)))[1]
    assert layer.columns["branch_order"].count(0) == 1
    assert layer.columns["dbh"][0] == pytest.approx(0.2, abs=0.01)


def test_branches_are_found_and_leaves_are_no_branches(tree, found):
    xyz, classification, truth, branches = tree
    ids = found[0]
    assert right_length(ids, truth, branches) > 0.75
    leaves = (truth == 0) & (classification != 2)
    assert (ids[leaves] > 0).mean() < 0.1
    assert not ids[classification == 2].any()


def test_points_of_the_layer_lie_in_the_wood(tree, found):
    xyz, _, truth, branches = tree
    stem = found[1].geometries[0]
    line = branches.geometries[0]
    inside = stem[(stem[:, 2] > 0.5) & (stem[:, 2] < 8.0)]
    at = np.array([np.interp(inside[:, 2], line[:, 2], line[:, k]) for k in (0, 1)]).T
    assert np.linalg.norm(inside[:, :2] - at, axis=1).max() < 0.11


def test_stems_of_several_trees_are_found_by_themselves(tree):
    """Trees 4 m apart, whose crowns touch: each branch belongs to the tree whose root is below it."""
    xyz, classification, truth, _ = tree
    both = np.concatenate([xyz, xyz + [4.0, 0.5, 0]])
    ids, layer = segment_tree(both, np.concatenate([classification, classification]))
    stems = [line for line, order in zip(layer.geometries, layer.columns["branch_order"]) if order == 0]
    assert sorted(round(line[0, 0] / 4) for line in stems) == [0, 1]
    assert sorted(set(layer.columns["tree"])) == [1, 2]
    numbers = ids[: len(xyz)][truth == 1], ids[len(xyz) :][truth == 1]
    assert all((np.bincount(own)[1:].max() / len(own)) > 0.85 for own in numbers)


def test_a_cloud_without_stems_says_so(rng):
    monitor = Monitor()
    ids, layer = segment_tree(rng.uniform(0, [10, 10, 0.2], (3000, 3)), np.ones(3000, np.uint8), monitor=monitor)
    assert not ids.any()
    assert len(layer) == 0
    assert monitor.warnings == ["No stem was found at a height of 1.3 m; no point has a SegmentID."]
    with pytest.raises(ValueError, match="All points lie on one line"):
        segment_tree(np.column_stack([np.arange(50.0)] * 3), np.ones(50, np.uint8))


def test_where_no_voxel_of_a_stem_is_full_it_says_so(tree):
    """It was an error of numpy's."""
    monitor = Monitor()
    ids, layer = segment_tree(tree[0], tree[1], min_count=1000, monitor=monitor)
    assert not ids.any()
    assert len(layer) == 0
    assert monitor.warnings == [
        "No voxel of a stem holds 1000 points ('Minimum points of a voxel'); no point has a SegmentID. "
        "Lower it, or take larger voxels."
    ]


def test_position_and_order_do_not_matter(rng):
    xyz, classification, *_ = simulate_tree(height=5.0, dbh=0.12, n_branches=3, density=1500.0)
    xyz = np.round(xyz * 1024) / 1024
    expected = segment_tree(xyz, classification)[0]
    np.testing.assert_array_equal(segment_tree(xyz + EXACT_FAR, classification)[0], expected)
    order = rng.permutation(len(xyz))
    np.testing.assert_array_equal(segment_tree(xyz[order], classification[order])[0], expected[order])


def test_the_ground_is_the_lowest_point_around_and_memory_follows_the_points(rng):
    """A point 1000 km away took a raster of a million by a million cells."""
    near = rng.uniform(0, [9.0, 7.0, 3.0], (400, 3))
    xyz = np.concatenate([near, [[1e6, 1e6, -5.0]]])
    tracemalloc.start()
    level = ground_level(xyz, xyz[:, :2])
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    cell = np.floor(xyz[:, :2] - xyz[:, :2].min(axis=0))
    is_around = (np.abs(cell[:, None] - cell) <= 1).all(axis=2)
    np.testing.assert_array_equal(level, [xyz[row, 2].min() for row in is_around])
    assert peak < 1e6


def test_the_search_for_stems_can_be_canceled(rng):
    """Progress was reported once, after the fits of all stems."""
    stems = np.repeat(np.arange(30.0), 40)
    angle = rng.uniform(0, 2 * np.pi, 1200)
    xyz = np.column_stack([stems + 0.1 * np.cos(angle), 0.1 * np.sin(angle), rng.uniform(1.0, 1.6, 1200)])
    reported: list[float] = []
    monitor = Monitor()
    monitor.progress = reported.append
    assert len(find_stems(xyz, np.zeros(1200), monitor)) == 30
    assert len([fraction for fraction in reported if fraction >= 0.3]) >= 30
    assert reported == sorted(reported)


def test_gaps_are_the_shortest_pairs_of_pieces_however_many_are_listed_at_once(rng, monkeypatch):
    """All voxels near all others were listed at once: 2 kB for each of a thin crown, 30 kB for each of a dense one."""
    positions = np.floor(rng.uniform(0, 12, (250, 3)))
    piece = rng.integers(0, 40, 250)
    monkeypatch.setattr(tree_structure, "_CHUNK", 7)
    pairs = tree_structure._gaps(positions, piece, 3.0, Monitor())
    distance = np.linalg.norm(positions[:, None] - positions, axis=2)
    expected = {}
    for one in range(40):
        for other in range(one):
            shortest = distance[np.ix_(piece == one, piece == other)].min(initial=np.inf)
            if shortest <= 3:
                expected[other, one] = shortest
    found = {tuple(sorted(piece[pair])): distance[tuple(pair)] for pair in pairs}
    assert len(pairs) == len(found)
    assert found == expected
