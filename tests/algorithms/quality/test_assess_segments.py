"""Segments whose match is known by construction, and a literal search over all sets."""

import itertools

import numpy as np
import pytest

from lidar_buildings.algorithms.quality.assess_segments import assess_segments, match_segments


def line(n):
    return np.column_stack([np.arange(n, dtype=float), np.zeros(n), np.zeros(n)])


def assess(found, true, **tunables):
    return assess_segments(line(len(found)), np.array(found), line(len(true)), np.array(true), **tunables).values


def test_each_kind_of_match_is_reported():
    true = np.repeat([1, 2, 3, 4, 5, 0], 10)
    found = np.concatenate([np.full(10, 7), np.repeat([3, 4], 5), np.full(20, 9), np.zeros(10), np.full(10, 8)])
    values = assess(found, true)
    wanted = {"correct": 1, "over": 1, "under": 2, "missed": 1, "noise": 1, "reference_segments": 5, "segments": 5}
    assert {name: values[name] for name in wanted} == wanted
    assert values["correct_share"] == 20
    shares = {"correct": 20, "over": 20, "under": 40, "missed": 20, "noise": 20}
    assert {name: values[f"points_{name}"] for name in shares} == pytest.approx(shares)


def test_the_overlap_decides():
    true, found = np.repeat([1, 0], [10, 2]), np.repeat([0, 1], [1, 11])
    assert assess(found, true)["correct"] == 1, "9 of 10 and 9 of 11"
    assert assess(found, true, min_overlap=0.85)["correct"] == 0
    assert assess(found, true, min_overlap=0.85)["missed"] == 1
    assert assess(found, true, min_overlap=0.85)["noise"] == 1


def test_small_segments_are_left_out():
    values = assess([1, 1, 1, 2], [1, 1, 1, 2], min_points=2)
    assert (values["correct"], values["segments"], values["reference_segments"]) == (1, 1, 1)


def test_equal_segments_are_all_correct_in_any_order(rng):
    true = rng.integers(0, 9, 200)
    order = rng.permutation(200)
    renumbered = np.where(true > 0, 50 - true, 0)
    values = assess_segments(line(200)[order], renumbered[order], line(200), true).values
    assert values["correct"] == values["reference_segments"] == 8
    assert values["points_correct"] == 100
    assert values["noise"] == 0


def literal(found, true, share):
    """Return the correct pairs and the over-segmented segments, by trying all sets of segments."""
    sets = {n: set(np.flatnonzero(found == n)) for n in range(1, found.max() + 1)}
    truths = {n: set(np.flatnonzero(true == n)) for n in range(1, true.max() + 1)}
    correct = {
        (g, m)
        for g, m in itertools.product(truths, sets)
        if len(truths[g] & sets[m]) >= share * max(len(truths[g]), len(sets[m]))
    }
    used = {m for _, m in correct}
    over = set()
    for g in set(truths) - {g for g, _ in correct}:
        for size in range(2, len(sets) + 1):
            for parts in itertools.combinations(sorted(set(sets) - used), size):
                inside = [len(sets[m] & truths[g]) for m in parts]
                if all(i and i >= share * len(sets[m]) for i, m in zip(inside, parts)) and sum(inside) >= share * len(
                    truths[g]
                ):
                    over.add(g)
    return correct, over


@pytest.mark.parametrize("seed", range(8))
def test_matches_are_those_of_a_literal_search(seed):
    rng = np.random.default_rng(seed)
    true = np.sort(rng.integers(1, 4, 40))
    found = np.clip(true + rng.integers(0, 2, 40) * (rng.random(40) < 0.3), 1, 5)
    found[true == 1] += np.sort(rng.integers(0, 2, (true == 1).sum())) * 4
    found = np.unique(found, return_inverse=True)[1] + 1
    matches = match_segments(found, true, 0.7)
    correct, over = literal(found, true, 0.7)
    assert {(g, m) for g, m in enumerate(matches.counterpart.tolist()) if m} == correct
    assert set(np.flatnonzero(matches.is_over)) == over


def test_a_reference_without_segments_is_refused():
    with pytest.raises(ValueError, match="The reference has no segment"):
        assess([1, 1], [0, 0])
