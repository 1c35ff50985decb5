"""Sections of a docstring, and the one that a declaration adds."""

from typing import Optional

import pytest

from lidar_buildings.algorithms.stage import InputLayer, stage, tunable

_WIDTH = 1250.5

# Shared with other stages, so that it has its help with it.
COLOR = tunable(None, "Which.", empty="it stays as it is.")


@stage("Toys", writes=("cluster_id",))
def toy_words(
    xyz,
    *,
    width: float = tunable(2.0, within="[0, inf) m"),
    count: Optional[int] = tunable(None, within="[1, inf)", automatic="all."),
    color: Optional[str] = COLOR,
    monitor=None,
):
    """Say something in one paragraph.

    A second one.

    Other Parameters
    ----------------
    width
        How wide, at most ``_WIDTH`` m,
        in words.
    count
        How many.

    Notes
    -----
    First note.

    Second note.

    References
    ----------
    Nobody.
    """


@stage("Toys", writes=("cluster_id",))
def toy_silence(xyz, *, monitor=None):
    """Say it all at once."""


def test_summary_description_and_sections_come_from_the_docstring():
    words = toy_words.stage
    assert words.summary == "Say something in one paragraph."
    assert words.description == "A second one."
    assert words.section("Notes") == "First note.\n\nSecond note."
    assert words.section("References") == "Nobody."
    assert words.section("Raises") == ""
    silence = toy_silence.stage
    assert (silence.summary, silence.description) == ("Say it all at once.", "")


def test_help_shows_tunables_as_the_dialog_does():
    before, added = toy_words.__doc__.split("Other Parameters\n----------------\n")
    assert before == "Say something in one paragraph.\n\nA second one.\n\n"
    added, after = added.split("\n\n", 1)
    assert after.startswith("Notes\n-----\n")
    assert added.splitlines() == [
        "width : float, m, at least 0 m, default 2.0",
        "    How wide, at most 1,250.5 m, in words.",
        "count : int or None, at least 1, default None",
        "    How many. Automatic: all.",
        "color : str or None, default None",
        "    Which. Empty: it stays as it is.",
        "monitor : Monitor, optional",
        "    Receives progress, automatic values and warnings.",
    ]


def test_without_tunables_the_docstring_stays_as_it_is():
    assert toy_silence.__doc__ == "Say it all at once."


def test_words_and_lines_within_a_section_are_its_text():
    def toy(xyz, *, monitor=None):
        pass

    notes = "Returns\nof two kinds follow in a table.\n\nfirst  last\n-----\n1  2"
    toy.__doc__ = (
        f"Count.\n\nReferences\nto others come last.\n\nNotes\n-----\n{notes}\n\nReferences\n----------\nNobody."
    )
    words = stage("Toys", title="Toy", writes=("cluster_id",))(toy).stage
    assert words.description == "References\nto others come last."
    assert words.section("Notes") == notes
    assert words.section("References") == "Nobody."
    assert words.section("Returns") == ""


def test_constants_that_a_docstring_names_become_their_values():
    def toy(xyz, *, monitor=None):
        """Cut strips of ``_WIDTH`` m, not ``width``; ``Optional`` is no number."""

    words = stage("Toys", title="Toy", writes=("cluster_id",))(toy).stage
    assert words.summary == "Cut strips of 1,250.5 m, not ``width``; ``Optional`` is no number."


def test_what_a_tunable_does_is_read_from_the_docstring_or_comes_with_it():
    helps = {name: tunable.param.help for name, tunable in toy_words.stage.tunables.items()}
    assert helps == {"width": "How wide, at most 1,250.5 m, in words.", "count": "How many.", "color": "Which."}


@pytest.mark.parametrize("name", ["color", "breadth"])
def test_a_docstring_describes_no_tunable_that_has_its_help_or_does_not_exist(name):
    def toy(xyz, *, color: Optional[str] = COLOR, monitor=None):
        pass

    toy.__doc__ = f"Count.\n\nOther Parameters\n----------------\n{name}\n    Which one."
    with pytest.raises(TypeError, match=rf"^toy describes '{name}', no tunable"):
        stage("Toys", title="Toy", writes=("cluster_id",))(toy)


def test_a_section_is_added_at_the_end_where_all_tunables_are_shared():
    def toy(xyz, *, color: Optional[str] = COLOR, monitor=None):
        """Count."""

    made = stage("Toys", title="Toy", writes=("cluster_id",))(toy)
    assert made.__doc__.startswith("Count.\n\nOther Parameters\n----------------\ncolor : str or None, default None\n")


def test_a_layer_says_what_the_docstring_says_of_it_unless_it_has_its_own_words():
    def toy(areas, zones, *, monitor=None):
        """Count.

        Parameters
        ----------
        areas : LayerFeatures
            Where points
            are counted.
        zones : LayerFeatures
            Not shown.
        """

    layers = InputLayer("areas"), InputLayer("zones", "Zone map", "Where not.")
    made = stage("Toys", title="Toy", input_layers=layers)(toy).stage
    assert [(one.title, one.help) for one in made.input_layers] == [
        ("Areas", "Where points are counted."),
        ("Zone map", "Where not."),
    ]
