"""A scene whose classes are wrong in a few spots, which the rest of the scene corrects."""

from dataclasses import replace

import numpy as np
import pytest

from lidar_buildings.algorithms.buildings import scene_learning
from lidar_buildings.algorithms.buildings.refine_buildings import (
    CHANCE,
    _squares,
    decided_together,
    refine_buildings,
    without_chance,
)
from lidar_buildings.algorithms.cloud.reasons import Reason
from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling
from lidar_buildings.algorithms.stage import Cancelled, LayerFeatures, Monitor
from lidar_buildings.tests.builders import FAR, crown, roof
from lidar_buildings.tests.monitors import Listening

SIDE, DENSITY, EAVE = 96.0, 6.0, 6.0

#: Points of each of two smooth spots of crowns.
SPOT = 20

#: Side and margin of the squares in which points are decided together, m.
SQUARE, MARGIN = 10.0, 2.0


class Village:
    """Sixteen flat houses of 10 m by 8 m with walls, a crown next to each; truth is known, classes have three errors.

    A strip along the eave of one house was left out, a crown that touches another was taken for a part of it, and so
    was a spot of a wall.
    """

    def __init__(self, rng):
        corners = [(x, y) for x in np.arange(6.0, SIDE, 24.0) for y in np.arange(8.0, SIDE, 24.0)]
        plan = rng.uniform(0, SIDE, (int(SIDE**2 * DENSITY), 2))
        free = np.ones(len(plan), bool)
        for corner in corners:
            free &= ~((plan >= corner) & (plan <= np.add(corner, (10.0, 8.0)))).all(axis=1)
        parts = [np.column_stack([plan[free], rng.normal(0, 0.02, free.sum())])]
        kinds, houses, is_last = [2], [0], [np.ones(free.sum(), bool)]
        for number, (x, y) in enumerate(corners, start=1):
            wall = np.column_stack([np.full(60, x), rng.uniform(y, y + 8, 60), rng.uniform(0.6, EAVE, 60)])
            # The crown touches the eave.
            leaves = crown(rng, x + 12.6, y + 4.0, 2.6, 5.0, 220)
            for points, kind in ((roof(rng, x, y, elevation=EAVE, density=DENSITY), 6), (wall, 6), (leaves, 5)):
                parts.append(points)
                kinds.append(kind)
                houses.append(number if kind == 6 else 0)
                is_last.append(rng.random(len(points)) < (0.3 if kind == 5 else 1.0))
        sizes = [len(part) for part in parts]
        self.xyz = np.concatenate(parts)
        self.truth = np.repeat(kinds, sizes).astype(np.uint8)
        self.house = np.repeat(houses, sizes).astype(np.int32)
        self.number_of_returns = np.where(np.concatenate(is_last), 1, 2).astype(np.uint8)
        self.return_number = np.ones(len(self.xyz), np.uint8)
        self.classification = np.where(self.truth == 5, 1, self.truth).astype(np.uint8)
        self.cluster_id = self.house.copy()
        x, y = corners[5]
        self.strip = (self.house == 6) & (self.xyz[:, 1] < y + 1.5)
        self.crown = (self.truth == 5) & (np.abs(self.xyz[:, :2] - np.add(corners[9], (12.6, 4.0))) < 3).all(axis=1)
        self.classification[self.strip], self.cluster_id[self.strip] = 1, 0
        self.classification[self.crown], self.cluster_id[self.crown] = 6, 10

    def refine(self, rows=slice(None), shift=0.0, **more):
        """Return what the stage makes of some of the points, and its monitor."""
        monitor, xyz = Monitor(), self.xyz[rows]
        made = refine_buildings(
            xyz + shift,
            self.classification[rows],
            xyz[:, 2].astype(np.float32),
            self.cluster_id[rows],
            np.where(self.classification[rows] == 6, 0.9, np.nan).astype(np.float32),
            np.zeros(len(xyz), np.uint8),
            None,
            self.return_number[rows],
            self.number_of_returns[rows],
            **more,
            monitor=monitor,
        )
        return made, monitor


@pytest.fixture
def village(rng):
    return Village(rng)


def test_a_strip_of_a_roof_comes_back_and_a_crown_ceases_to_be_a_building(village):
    (found, number, confidence, reason, probability), monitor = village.refine()
    assert (found[village.strip] == 6).mean() > 0.95
    assert (found[village.crown] == 6).mean() < 0.2
    wrong = (found == 6) != (village.truth == 6)
    before = (village.classification == 6) != (village.truth == 6)
    assert wrong.sum() < 0.2 * before.sum()
    added, removed = (found == 6) & (village.classification != 6), (found != 6) & (village.classification == 6)
    assert monitor.values["points_added"] == added.sum()
    assert monitor.values["points_removed"] == removed.sum()
    assert (number[village.strip & added] == 6).all()
    assert (number[removed] == 0).all()
    assert (reason[added] == Reason.LIKE_BUILDINGS).all()
    assert (reason[removed] == Reason.UNLIKE_BUILDINGS).all()
    assert (reason[~added & ~removed] == 0).all()
    np.testing.assert_array_equal(confidence[added], probability[added])
    # But for a few that follow their neighbors.
    assert np.quantile(probability[added], 0.05) > 0.7
    assert np.quantile(probability[removed], 0.95) < 0.15


def test_the_probability_is_that_of_the_truth(village):
    """Roofs and crowns are separated, also where their labels are wrong; the ground gets no probability of building."""
    probability = village.refine()[0][4]
    assert probability.dtype == np.float32
    assert ((probability >= 0) & (probability <= 1)).all()
    assert probability[village.truth == 6].mean() > 0.9
    assert probability[village.truth == 5].mean() < 0.15
    assert not probability[village.truth == 2].any()


def test_points_of_buildings_are_as_sure_as_both_opinions_together(village):
    """A crown that the evidence alone took for a building becomes doubtful; houses don't."""
    tree = (village.truth == 5) & (village.xyz[:, :2] < 24).all(axis=1)
    village.classification[tree], village.cluster_id[tree] = 6, 17
    (found, _, confidence, _, probability), _ = village.refine()
    stays = (found == 6) & (village.classification == 6)
    np.testing.assert_allclose(confidence[stays], np.sqrt(0.9 * probability[stays]), rtol=1e-5)
    assert np.median(confidence[stays & tree]) < 0.7
    assert np.median(confidence[stays & ~tree]) > 0.9


def test_what_a_reviewer_decided_changes_nothing_else(village):
    """The second house was deleted."""
    ring = np.array([[6.0, 32], [16, 32], [16, 40], [6, 40], [6, 32]])
    before, after = (
        village.refine(reviewed=one)[0] for one in (None, LayerFeatures([[ring]], {"review": ["deleted"]}))
    )
    own = village.house == 2
    assert (before[0][own] == 6).mean() > 0.9
    assert not (after[0][own] == 6).any()
    assert (after[3][own & (before[0] == 6)] == Reason.DELETED).all()
    for one, other in zip(before[2:], after[2:]):
        np.testing.assert_array_equal(one[~own], other[~own])
    np.testing.assert_array_equal(before[0][~own], after[0][~own])


def test_only_points_near_the_edge_of_a_building_change(village):
    """An object that looks like a roof, 5 m from any house, keeps its class."""
    far = np.array([8.0, 21.0])
    apart = roof(np.random.default_rng(3), *far, 6.0, 6.0, EAVE, DENSITY)
    for name, value in (("truth", 5), ("classification", 1), ("number_of_returns", 1), ("return_number", 1)):
        values = getattr(village, name)
        setattr(village, name, np.append(values, np.full(len(apart), value, values.dtype)))
    village.cluster_id = np.append(village.cluster_id, np.zeros(len(apart), np.int32))
    village.xyz = np.concatenate([village.xyz, apart])
    (found, _, _, _, probability), _ = village.refine()
    assert (found[-len(apart) :] == 1).all()
    assert probability[-len(apart) :].mean() > 0.7


def test_ground_noise_water_and_decks_keep_their_classes(village, rng):
    kinds = np.array([2, 7, 9, 17, 18], np.uint8)
    rows = rng.choice(np.flatnonzero(village.strip), 60, replace=False)
    village.classification[rows] = np.tile(kinds, 12)
    (found, number, _, _, probability), _ = village.refine()
    np.testing.assert_array_equal(found[rows], village.classification[rows])
    assert not number[rows].any()
    is_noise = np.isin(village.classification, (7, 18))
    assert is_noise.any()
    np.testing.assert_array_equal(np.isnan(probability), is_noise)


def test_a_scene_with_one_building_is_left_as_it_is(village):
    one = (village.xyz[:, :2] < 24).all(axis=1)
    village.strip = village.crown = np.zeros(len(one), bool)
    (found, number, *_, probability), monitor = village.refine(np.flatnonzero(one))
    np.testing.assert_array_equal(found, village.classification[one])
    np.testing.assert_array_equal(number, village.cluster_id[one])
    assert probability is None
    assert monitor.infos == [
        "Buildings are not refined: the scene has too few buildings or other objects to learn from."
    ]


@pytest.mark.parametrize("chosen", [{"learn": False}, {"source": "matched images"}])
def test_nothing_changes_where_it_is_switched_off_and_in_matched_images(village, chosen):
    (found, number, confidence, reason, probability), monitor = village.refine(**chosen)
    np.testing.assert_array_equal(found, village.classification)
    np.testing.assert_array_equal(number, village.cluster_id)
    assert probability is None
    assert "points_added" not in monitor.values


def test_a_building_that_ceases_leaves_no_gap_in_the_numbers(village):
    """A crown was a building of its own, number 3."""
    alone = village.crown
    village.cluster_id = np.where(village.cluster_id >= 3, village.cluster_id + 1, village.cluster_id).astype(np.int32)
    village.cluster_id[alone] = 3
    (found, number, *_), _ = village.refine()
    assert not (found[alone] == 6).all()
    assert set(np.unique(number)) == set(range(number.max() + 1))


def test_the_order_of_points_and_their_position_change_nothing(village, rng):
    (found, number, _, _, probability), _ = village.refine()
    again = village.refine()[0]
    assert again[0].tobytes() == found.tobytes()
    assert again[4].tobytes() == probability.tobytes()
    order = rng.permutation(len(found))
    shuffled = village.refine(order)[0]
    np.testing.assert_array_equal(shuffled[0], found[order])
    np.testing.assert_allclose(shuffled[4], probability[order], atol=1e-5)
    moved = village.refine(shift=FAR)[0]
    assert (moved[0] == found).mean() > 0.9999


def test_the_building_of_added_points_does_not_depend_on_the_order_of_points(village, rng):
    """In every cell of one house are points of two buildings."""
    village.cluster_id[(village.cluster_id == 6) & (rng.random(len(village.xyz)) < 0.5)] = 17
    (found, number, *_), _ = village.refine()
    assert (found[village.strip] == 6).any()
    order = rng.permutation(len(found))
    np.testing.assert_array_equal(village.refine(order)[0][1], number[order])


def test_other_colors_of_the_beam_are_no_obstacle(village):
    """Without returns and with an intensity that is the same everywhere shape alone decides."""
    village.number_of_returns[:] = 1
    found = village.refine(intensity=np.full(len(village.xyz), 7, np.uint16))[0][0]
    assert (found[village.strip] == 6).mean() > 0.9


def test_a_part_judges_as_the_whole_where_the_whole_was_learned(village):
    """The western half, with what was learned on the whole village; its corner is the whole village's."""
    whole = CloudSampling.of(village.xyz, village.classification)
    expected = village.refine(sampling=whole)[0]
    west = np.flatnonzero(village.xyz[:, 0] < 60)
    part = CloudSampling(lambda: village.xyz[west], corner=whole.corner)
    part.of_whole.update({name: learn(table) for name, (table, learn) in whole.samples.items()})
    found = village.refine(west, sampling=part, density=whole.effective_density)[0]
    inside = village.xyz[west, 0] < 50
    np.testing.assert_array_equal(found[0][inside], expected[0][west][inside])
    np.testing.assert_allclose(found[4][inside], expected[4][west][inside], atol=1e-6)


def test_a_house_less_leaves_the_sample_of_the_others_as_it_is(village, monkeypatch):
    """Rows at even distances all moved with a cell or more: 155 points of a town changed their class with one."""
    monkeypatch.setattr(scene_learning, "SURFACES", replace(scene_learning.SURFACES, sample=300))
    tables = []
    for rows in (np.arange(len(village.xyz)), np.flatnonzero((village.xyz[:, :2] > 22.0).any(axis=1))):
        sampling = CloudSampling(lambda rows=rows: village.xyz[rows], corner=np.zeros(2))
        village.refine(rows, sampling=sampling, density=4.0)
        tables.append(sampling.samples["building_likeness"][0])
    one, other = ({tuple(row) for row in np.round(table[:, 4:], 6).tolist()} for table in tables)
    assert len(one) > 250
    assert len(one & other) > 0.8 * len(one)


def test_parts_of_a_survey_are_learned_from_as_the_whole(rng, monkeypatch):
    """Of a part with a tenth of the cells, a tenth of the sample is taken: its cells have other features."""
    monkeypatch.setattr(scene_learning, "SURFACES", replace(scene_learning.SURFACES, sample=400))
    size = 4000
    half, label = rng.integers(0, 2, (2, size))
    is_small = np.arange(size) < size // 10
    features = rng.normal(label[:, None] * np.where(is_small, -1, 1)[:, None], 1.0, (size, 2))
    number = rng.random(size)
    table = np.column_stack([number, half, label * rng.integers(1, 5, size), label, features])
    parts = [part[np.argsort(part[:, 0])[:400]] for part in (table[is_small], table[~is_small])]
    expected = scene_learning.learn_halves(table[number <= np.sort(number)[399]])
    np.testing.assert_allclose(scene_learning.learn_halves(np.concatenate(parts)), expected, rtol=1e-5, atol=1e-5)


def test_without_confidence_and_reason_none_are_made(village):
    made = refine_buildings(village.xyz, village.classification, village.xyz[:, 2], village.cluster_id)
    assert made[2] is None
    assert made[3] is None


def forest(confidence, crowns=2000):
    """Return what is found in a forest on 100 ground points: two buildings of these confidences amid crowns."""
    cluster_id = np.repeat([0, 1, 2, 0], [100, SPOT, SPOT, crowns]).astype(np.int32)
    classification = np.select([np.arange(len(cluster_id)) < 100, cluster_id > 0], [2, 6], 1).astype(np.uint8)
    known = np.select([cluster_id == 1, cluster_id == 2], confidence, np.nan).astype(np.float32)
    reason = np.where(cluster_id > 0, Reason.SOLID_PLANE, Reason.ROUGH).astype(np.uint8)
    return (classification, cluster_id, known, reason, None), np.where(classification == 2, 0.0, 9.0)


def sampling(**of_whole):
    made = CloudSampling.of(np.zeros((1, 3)))
    made.of_whole.update(of_whole)
    return made


def test_no_doubtful_building_of_a_forest_is_left():
    (found, height), monitor = forest((0.6, 0.74)), Monitor()
    classes, number, confidence, reason, _ = without_chance(found, height, 0.05, sampling(), monitor)
    assert not (classes == 6).any()
    assert not number.any()
    assert (reason[100 : 100 + 2 * SPOT] == Reason.BY_CHANCE).all()
    assert (confidence[100 : 100 + 2 * SPOT] == 0.5).all()
    assert "2 doubtful ones" in monitor.infos[-1]
    # Nothing else changes.
    assert (classes[found[0] != 6] == found[0][found[0] != 6]).all()
    assert (reason[found[1] == 0] == Reason.ROUGH).all()


@pytest.mark.parametrize(
    ("confidence", "crowns"),
    [((0.6, 0.76), 2000), ((0.6, 0.6), 700)],
    ids=["a sure one keeps all", "a shed amid a few trees"],
)
def test_where_one_is_sure_or_crowns_are_few_all_stay(confidence, crowns):
    found, height = forest(confidence, crowns)
    assert without_chance(found, height, 0.05, sampling(), Monitor()) is found


def test_ground_and_low_points_do_not_count_as_crowns():
    found, height = forest((0.6, 0.6))
    assert without_chance(found, np.where(found[1] > 0, height, 1.4), 0.05, sampling(), Monitor()) is found


def test_a_share_of_nothing_keeps_all():
    found, height = forest((0.6, 0.6))
    assert without_chance(found, height, 0.0, sampling(), Monitor()) is found


def test_a_part_of_a_survey_does_as_the_whole_does():
    found, height = forest((0.6, 0.9))
    assert without_chance(found, height, 0.05, sampling(**{CHANCE: (0.0,)}), Monitor()) is found
    _, number, *_ = without_chance(found, height, 0.05, sampling(**{CHANCE: (1.0,)}), Monitor())
    assert set(number[found[1] == 1]) == {0}
    assert set(number[found[1] == 2]) == {1}


def test_a_survey_decides_on_all_of_its_parts_together():
    """A sure building in one part keeps the doubtful ones of the other."""
    tables, learn = [], None
    for confidence in ((0.6, 0.6), (0.9, 0.6)):
        part = sampling()
        without_chance(*forest(confidence), 0.05, part, Monitor())
        table, learn = part.samples[CHANCE]
        tables.append(table)
    assert learn(np.concatenate(tables)) == (0.0,)
    assert learn(tables[0]) == (1.0,)


@pytest.fixture
def edge(rng):
    """A strip of 6 by 60 m with four points per m², whose southern half is a roof; a tenth of all points look wrong."""
    xyz = np.column_stack([rng.uniform(0, 60, 1440), rng.uniform(0, 6, 1440), np.full(1440, 5.0)])
    truth = xyz[:, 1] < 3
    gain = np.where(truth ^ (rng.random(1440) < 0.1), 1.5, -1.5)
    return xyz, truth, gain


def decided(xyz, gain):
    """Return the classes of points with a spacing of half a meter."""
    return decided_together(xyz, gain, 0.5, SQUARE, MARGIN, Monitor())


def test_single_points_follow_their_neighbors(edge):
    xyz, truth, gain = edge
    away = np.abs(xyz[:, 1] - 3) > 0.5
    assert ((gain > 0) == truth)[away].mean() < 0.92
    assert (decided(xyz, gain) == truth)[away].mean() > 0.98


def test_points_far_apart_and_those_that_are_sure_keep_what_they_are(edge):
    xyz, _, gain = edge
    np.testing.assert_array_equal(decided(xyz * 100, gain), gain > 0)
    sure = np.where(gain > 0, np.inf, -np.inf)
    np.testing.assert_array_equal(decided(xyz, sure), gain > 0)


def test_nothing_costs_less_than_what_is_decided(rng):
    """All classes of ten points, one by one: two clusters in a square, with weak evidence."""
    xyz = np.column_stack([rng.uniform(3, 5, 10), rng.uniform(3, 5, 10), np.zeros(10)])
    gain = rng.normal(0, 2, 10)
    squares = np.sum((xyz[:, None] - xyz) ** 2, axis=2)
    # Every point is a neighbor of every other one, in both directions.
    pair = 2 / (1 + squares / 0.5**2)

    def cost(classes):
        return np.abs(gain[classes != (gain > 0)]).sum() + pair[classes][:, ~classes].sum()

    every = [np.array([number >> bit & 1 for bit in range(10)], bool) for number in range(1024)]
    found = decided(xyz, gain)
    assert cost(found) == pytest.approx(min(map(cost, every)), abs=0.02)
    assert not np.array_equal(found, gain > 0)


def test_a_part_with_the_margins_of_its_squares_decides_as_the_whole(edge):
    xyz, _, gain = edge
    whole = decided(xyz, gain)
    part = np.flatnonzero((xyz[:, 0] >= 17.9) & (xyz[:, 0] < 42.1))
    kept = (xyz[part, 0] >= 20) & (xyz[part, 0] < 40)
    np.testing.assert_array_equal(decided(xyz[part], gain[part])[kept], whole[part][kept])


def test_squares_decide_nearly_as_all_points_at_once(edge):
    xyz, _, gain = edge
    at_once = decided_together(xyz, gain, 0.5, 1000.0, MARGIN, Monitor())
    assert (decided(xyz, gain) == at_once).mean() > 0.995


def test_every_point_is_kept_in_one_square_and_seen_from_those_around(edge):
    plan = edge[0][:, :2]
    squares = list(_squares(plan, SQUARE, MARGIN))
    kept = np.concatenate([rows[is_own] for rows, is_own in squares])
    np.testing.assert_array_equal(np.sort(kept), np.arange(len(plan)))
    for rows, is_own in squares:
        if is_own.any():
            low = np.floor(plan[rows[is_own][0]] / SQUARE) * SQUARE
            inside = ((plan >= low - MARGIN) & (plan < low + SQUARE + MARGIN)).all(axis=1)
            np.testing.assert_array_equal(np.flatnonzero(inside), rows)


def test_the_order_of_points_decides_nothing(edge, rng):
    xyz, _, gain = edge
    order = rng.permutation(len(xyz))
    np.testing.assert_array_equal(decided(xyz[order], gain[order]), decided(xyz, gain)[order])


def test_there_may_be_no_points_or_one():
    assert not len(decided(np.empty((0, 3)), np.empty(0)))
    np.testing.assert_array_equal(decided(np.zeros((1, 3)), np.array([2.0])), [True])


def test_progress_is_heard_from_square_to_square_where_the_work_can_be_stopped(edge):
    xyz, _, gain = edge
    listening = Listening()
    decided_together(xyz, gain, 0.5, SQUARE, MARGIN, listening)
    # The strip has six squares.
    assert listening.heard == sorted(listening.heard)
    assert len(listening.heard) >= 6
    assert listening.heard[-1] == 1.0
    with pytest.raises(Cancelled):
        decided_together(xyz, gain, 0.5, SQUARE, MARGIN, Listening(stop_at=0.5))
