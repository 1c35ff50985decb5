"""Ground errors: counted by hand, and against an independent scorer."""

import numpy as np
import pytest

from lidar_buildings.algorithms.quality.assess_ground import assess_ground, ground_errors


def test_errors_by_hand():
    # 6 ground points of which 2 are lost, 4 objects of which 1 is taken for ground.
    ground = np.array([1, 1, 1, 1, 1, 1, 0, 0, 0, 0], bool)
    called = np.array([1, 1, 1, 1, 0, 0, 1, 0, 0, 0], bool)
    found = ground_errors(called, ground)
    assert found["type_1"] == pytest.approx(100 / 3)
    assert found["type_2"] == pytest.approx(25)
    assert found["total"] == pytest.approx(30)
    assert found["kappa"] == pytest.approx(40)  # agreement 0.7, by chance 0.5 * 0.6 + 0.5 * 0.4 = 0.5


def test_nothing_to_lose_is_undefined():
    found = ground_errors(np.zeros(4, bool), np.zeros(4, bool))
    assert found["total"] == 0
    assert np.isnan([found["type_1"], found["kappa"]]).all()


def test_agrees_with_an_independent_scorer(rng, scorer):
    xyz = np.round(rng.uniform(0, 50, (5000, 3)), 3)
    true = rng.choice([1, 2, 2, 2, 6, 7, 9, 18, 26, 66], 5000)
    predicted = np.where(rng.random(5000) < 0.2, rng.choice([1, 2], 5000), true)
    order = rng.permutation(5000)
    values = assess_ground(xyz, predicted, xyz[order], true[order]).values
    for name, expected in scorer.score_ground(xyz, predicted, true).items():
        assert values[name] == pytest.approx(expected, abs=1e-9), name


def test_water_is_not_counted_unless_asked():
    xyz = np.column_stack([np.arange(4.0), np.zeros(4), np.zeros(4)])
    true, predicted = np.array([2, 1, 9, 9]), np.array([2, 1, 2, 2])
    assert assess_ground(xyz, predicted, xyz, true).values["total"] == 0
    assert assess_ground(xyz, predicted, xyz, true, ignored_classes="").values["total"] == 50


def test_page_has_the_figures():
    xyz = np.column_stack([np.arange(8.0), np.zeros(8), np.zeros(8)])
    report = assess_ground(xyz, np.array([2, 2, 2, 1, 1, 1, 1, 2]), xyz, np.array([2, 2, 2, 2, 1, 1, 1, 1]))
    assert "1 of 4 ground points were not called ground" in report.html
    assert "2 of 8 points are wrong" in report.html
    assert set(report.values) == {measure.name for measure in assess_ground.stage.measures}
