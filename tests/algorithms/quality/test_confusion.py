"""Figures of a confusion matrix, counted by hand and by scikit-learn."""

import numpy as np
import pytest
from sklearn import metrics

from lidar_buildings.algorithms.quality.confusion import class_rates, cohens_kappa, confusion, overall_accuracy


def test_figures_by_hand():
    # Of six items of the first class four are right; of four of the second three are.
    matrix = np.array([[4, 2], [1, 3]])
    rates = class_rates(matrix)
    assert rates["completeness"] == pytest.approx([100 * 4 / 6, 75])
    assert rates["correctness"] == pytest.approx([80, 60])
    assert rates["f"] == pytest.approx([100 * 8 / 11, 100 * 6 / 9])
    assert rates["iou"] == pytest.approx([100 * 4 / 7, 50])
    assert overall_accuracy(matrix) == pytest.approx(70)
    assert cohens_kappa(matrix) == pytest.approx(40)  # agreement 0.7, by chance 0.6 * 0.5 + 0.4 * 0.5 = 0.5


def test_figures_agree_with_another_program(rng):
    true = rng.integers(0, 5, 3000)
    called = np.where(rng.random(3000) < 0.3, rng.integers(0, 5, 3000), true)
    matrix = confusion(true, called, 5)
    np.testing.assert_array_equal(matrix, metrics.confusion_matrix(true, called))
    assert cohens_kappa(matrix) == pytest.approx(100 * metrics.cohen_kappa_score(true, called))
    assert class_rates(matrix)["f"] == pytest.approx(100 * metrics.f1_score(true, called, average=None))
    assert class_rates(matrix)["iou"] == pytest.approx(100 * metrics.jaccard_score(true, called, average=None))


def test_what_nothing_is_known_of_is_undefined():
    rates = class_rates(np.array([[3, 0], [0, 0]]))
    assert np.isnan([rates[name][1] for name in rates]).all()
    assert np.isnan(cohens_kappa(np.array([[3, 0], [0, 0]])))
    assert np.isnan(cohens_kappa(np.zeros((2, 2))))
    assert np.isnan(overall_accuracy(np.zeros((2, 2))))
