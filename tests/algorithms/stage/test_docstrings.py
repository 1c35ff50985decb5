"""Sections of a docstring, and the one that a declaration adds."""

from typing import Optional

from lidar_buildings.algorithms.stage import stage, tunable


@stage("Toys", writes=("cluster_id",))
def toy_words(
    xyz,
    *,
    width: float = tunable(2.0, "How wide.", within="[0, inf) m"),
    count: Optional[int] = tunable(None, "How many.", within="[1, inf)", automatic="all."),
    color: Optional[str] = tunable(None, "Which.", empty="it stays as it is."),
    monitor=None,
):
    """Say something in one paragraph.

    A second one.

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
    _, added = toy_words.__doc__.split("Other Parameters\n----------------\n")
    assert added.splitlines() == [
        "width : float, m, at least 0 m, default 2.0",
        "    How wide.",
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


_WIDTH = 1250.5


def test_constants_that_a_docstring_names_become_their_values():
    def toy(xyz, *, monitor=None):
        """Cut strips of ``_WIDTH`` m, not ``width``; ``Optional`` is no number."""

    words = stage("Toys", title="Toy", writes=("cluster_id",))(toy).stage
    assert words.summary == "Cut strips of 1,250.5 m, not ``width``; ``Optional`` is no number."
