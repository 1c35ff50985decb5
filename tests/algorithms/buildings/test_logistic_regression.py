"""Logistic regression whose truth is a formula, and scikit-learn's as a second opinion."""

import numpy as np
import pytest

from lidar_buildings.algorithms.buildings import logistic_regression
from lidar_buildings.algorithms.buildings.logistic_regression import LogisticRegression


def likely(values):
    return 1 / (1 + np.exp(-values))


@pytest.fixture
def features(rng):
    return rng.normal(size=(20_000, 2)) * [2.0, 0.5] + [10.0, -3.0]


def test_shares_that_follow_the_model_are_found_again(features):
    """Labels are the probabilities themselves: a line in one feature, and one that bends at the mean of the other."""
    standard = (features - features.mean(axis=0)) / features.std(axis=0)
    truth = likely(0.5 + 1.5 * standard[:, 0] - np.maximum(standard[:, 1], 0))
    found = LogisticRegression.fit(features, truth)
    np.testing.assert_allclose(found.predict(features), truth, atol=0.01)
    np.testing.assert_allclose(found.weights, [0.5, 1.5, 0, 0, -1], atol=0.06)


def test_scikit_learn_finds_the_same_weights(features, rng):
    linear = pytest.importorskip("sklearn.linear_model")
    labels = (rng.random(len(features)) < likely(features[:, 0] - 10)).astype(float)
    found = LogisticRegression.fit(features, labels)
    standard = (features - found.mean) / found.scale
    terms = np.column_stack([standard, np.maximum(standard, 0)])
    other = linear.LogisticRegression(C=1.0, tol=1e-10, max_iter=1000).fit(terms, labels)
    np.testing.assert_allclose(found.weights, [*other.intercept_, *other.coef_[0]], atol=1e-4)


def test_a_feature_that_is_the_same_everywhere_and_labels_without_errors_are_no_trouble(features):
    constant = np.column_stack([features, np.full(len(features), 4.0)])
    labels = (features[:, 0] > 10).astype(float)
    found = LogisticRegression.fit(constant, labels)
    assert np.isfinite(found.weights).all()
    assert ((found.predict(constant) > 0.5) == (labels > 0.5)).mean() > 0.99


def test_rows_that_fill_no_block_count_as_all_others(features):
    """Products are made of 64 rows at a time."""
    labels = likely(features[:, 0] - 10)
    few = slice(0, 777)
    assert 777 % logistic_regression._RULES.block
    doubled = np.concatenate([features[few]] * 64), np.concatenate([labels[few]] * 64)
    once, often = LogisticRegression.fit(features[few], labels[few]), LogisticRegression.fit(*doubled)
    # Repeated samples outweigh the ridge.
    np.testing.assert_allclose(once.predict(features), often.predict(features), atol=0.02)
