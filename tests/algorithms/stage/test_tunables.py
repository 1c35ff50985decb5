"""A tunable takes what fits its type and bounds, and says in one sentence why it takes nothing else."""

import re

import numpy as np
import pytest

from lidar_buildings.algorithms.stage import Param, Tunable, stage

WIDTH = Param(None, "How wide.", label="Width", within="(0, 4] m")


def tunable(kind, default, param=WIDTH, name="width"):
    return Tunable(name, kind, param.with_default(default))


@pytest.mark.parametrize(
    ("kind", "value", "taken"),
    [
        (float, 4, 4.0),
        (float, np.float32(0.5), 0.5),
        (int, 3.0, 3),
        (int, np.int64(3), 3),
        (bool, np.bool_(True), True),
        (str, "up", "up"),
        (tuple, ["up"], ("up",)),
    ],
)
def test_values_come_in_the_declared_type(kind, value, taken):
    param = Param(None, "Which.", label="Way", choices=("up", "down")) if kind in (str, tuple) else WIDTH
    found = tunable(kind, None, param).check(value)
    assert found == taken
    assert type(found) is type(taken)


@pytest.mark.parametrize(
    ("kind", "value", "wanted"),
    [
        (float, 0.0, "greater than 0 m and at most 4 m"),
        (float, 4.001, "greater than 0 m and at most 4 m"),
        (float, float("nan"), "greater than 0 m and at most 4 m"),
        (float, "3", "a number"),
        (float, True, "a number"),
        (float, [1.0], "a number"),
        (int, 2.5, "a whole number"),
        (int, float("inf"), "a whole number"),
        (bool, 1, "true or false"),
        (str, 1, "a word"),
        (tuple, "up", "a list of words"),
    ],
)
def test_what_does_not_fit_is_refused_in_one_sentence(kind, value, wanted):
    sentence = f"Width (width) must be {wanted}, got {value!r}."
    with pytest.raises(ValueError, match=f"^{re.escape(sentence)}$"):
        tunable(kind, None).check(value)


def test_an_open_bound_is_none_of_the_values():
    below = Param(None, "Which.", label="Share", within="[0, 1)")
    assert tunable(float, 0.5, below).check(0.0) == 0.0
    with pytest.raises(ValueError, match=r"must be at least 0 and less than 1, got 1\.0\."):
        tunable(float, 0.5, below).check(1.0)


def test_words_must_be_among_the_choices():
    way = Param(None, "Which.", label="Way", choices=("up", "down"))
    for kind, value, allowed in ((str, "left", "one of up, down"), (tuple, ("up", "left"), "any of up, down")):
        with pytest.raises(ValueError, match=rf"Way \(width\) must be {allowed}, got"):
            tunable(kind, "up", way).check(value)
    assert tunable(tuple, (), way).check(()) == ()


def test_nothing_is_a_value_of_automatic_tunables_alone():
    assert tunable(float, None).check(None) is None
    with pytest.raises(ValueError, match="must be a number, got None"):
        tunable(float, 1.0).check(None)


@pytest.mark.parametrize(
    ("param", "words"),
    [
        (WIDTH, "greater than 0 m and at most 4 m"),
        (Param(None, "b", label="a", within="[-1.5, inf)°"), "at least -1.5°"),
        (Param(None, "b", label="a", within="(-inf, 7)"), "less than 7"),
        (Param(None, "b", label="a", within="(-inf, 10_000_000]"), "at most 10,000,000"),
        (Param(None, "b", label="a", within="(-inf, 2.5]"), "at most 2.5"),
        (Param(None, "b", label="a"), ""),
    ],
)
def test_bounds_in_words(param, words):
    assert param.bounds == Tunable("a", float, param).range == words


@pytest.mark.parametrize(
    ("name", "label", "shown"),
    [("min_plane_area", "", "Minimum plane area"), ("max_gap", "Widest gap", "Widest gap"), ("seed", "", "Seed")],
)
def test_a_tunable_is_called_by_its_name_in_words_unless_its_declaration_says_otherwise(name, label, shown):
    made = Tunable(name, float, Param(1.0, "What.", label=label, within="[0, 4] m"))
    assert (made.label, made.title) == (shown, f"{shown} (m)")


def test_an_interval_has_bounds_and_a_unit():
    interval = Param(None, "b", label="a", within="(-0.5, 10_000] points/m²")
    assert (interval.low, interval.high, interval.unit) == (-0.5, 10_000, "points/m²")
    assert (interval.open_low, interval.open_high) == (True, False)
    at_least = Param(None, "b", label="a", within="[3, inf)")
    assert (at_least.low, at_least.high, at_least.unit) == (3, None, "")


@pytest.mark.parametrize("wrong", ["0 to 4 m", "[0 4] m", "[0, 4", "4 m"])
def test_what_is_no_interval_is_refused(wrong):
    with pytest.raises(ValueError, match=r"A tunable lies within an interval such as '\(0, 100\] m'"):
        _ = Param(None, "b", label="a", within=wrong).unit


def test_choices_in_words():
    param = Param(None, "b", label="a", choices=("x", "one of"))
    assert Tunable("a", str, param).range == "one of x, one of"
    assert Tunable("a", tuple, param).range == "any of x, one of"


def test_what_an_automatic_tunable_is_when_nobody_sets_it():
    found = Param(None, "b", label="a", automatic="the spacing.")
    without = Param(None, "b", label="a", empty="all stay.")
    assert (found.unset, found.unset_text) == ("automatic", "Automatic: the spacing.")
    assert (without.unset, without.unset_text) == ("none", "Empty: all stay.")
    assert Param(None, "b", label="a").unset_text == ""


@pytest.mark.parametrize(
    ("param", "kind", "why"),
    [
        (Param("final", "Which.", choices=("last", "first")), str, "must be one of last, first, got 'final'"),
        (Param(7.0, "How far.", within="[0, 5] m"), float, "must be at least 0 m and at most 5 m, got 7.0"),
    ],
)
def test_a_default_that_is_not_allowed_is_refused_where_it_is_declared(param, kind, why):
    def toy(xyz, *, which=param, monitor=None):
        """Count."""

    toy.__annotations__["which"] = kind
    with pytest.raises(ValueError, match=rf"the default of which in toy\) {why}"):
        stage("Toys", title="Toy", writes=("cluster_id",))(toy)
