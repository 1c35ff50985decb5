"""The log of a run: a heading and the seconds of each step, each value once, each sentence on a line of its own."""

import re

import pytest
from qgis.core import QgsApplication

from lidar_buildings.tests.toys import TOYS


def test_each_step_has_a_line_with_what_it_found_below_and_the_summary_is_last(provider, log):
    from lidar_buildings.provider.feedback import ChainMonitor
    from lidar_buildings.provider.run_log import RunLog

    log.pushFormattedMessage = lambda html, text: log.infos.append(text)
    chain, lift, compare = ChainMonitor(log, RunLog()), TOYS["toy_lift"], TOYS["toy_compare"]
    first = chain.step("first", lift, {"base": None, "step": 2.0}, 0.0, 0.5)
    first.resolved(base=10.0, step=2.0, tower=None)
    first.warn("No coordinate reference system.")
    chain.resolved(sampling="density 4.3 points/m², surface noise 0.02 m")
    last = chain.step("last", compare, {}, 0.5, 1.0)
    last.inform("3 buildings.")
    last.warn("No coordinate reference system.")
    chain.resolved(sampling="density 4.3 points/m², height resolution 0.01 m")
    chain.end_steps()
    chain.end()
    assert [re.sub(r"\d+\.\d s", "? s", info) for info in log.infos] == [
        "Reading: ? s (next: Toy lift)",
        "Toy lift: ? s (next: Toy compare)",
        "Base, automatic: 10 m",
        "Sampling: density 4.3 points/m², surface noise 0.02 m",
        "Toy compare: ? s (next: writing)",
        "Sampling: height resolution 0.01 m",
        "Writing: ? s",
        "3 buildings.",
    ]
    assert log.warnings == ["No coordinate reference system."]
    assert chain.values["first_base"] == 10.0


@pytest.fixture
def screen(log, monkeypatch):
    """What the command line shows: the bar as QGIS draws it, and the sentences between."""
    from lidar_buildings.provider import feedback

    shown = []
    log.progressChanged.connect(lambda percent: shown.append("."))
    log.pushInfo = lambda info: shown.append(f"{info}\n")
    monkeypatch.setattr(feedback, "on_command_line", lambda: True)
    return shown


def test_on_the_command_line_no_sentence_begins_behind_the_bar(provider, log, screen):
    from lidar_buildings.provider.feedback import ChainMonitor, FeedbackMonitor
    from lidar_buildings.provider.run_log import RunLog

    monitor = FeedbackMonitor(log)
    monitor.inform("First.")
    monitor.progress(0.3)
    monitor.inform("Second.")
    monitor.inform("Third.")
    chain = ChainMonitor(log, RunLog())
    chain.progress(0.6)
    step = chain.step("first", TOYS["toy_lift"], {}, 0.6, 1.0)
    step.progress(0.5)
    chain.end_steps()
    lines = "".join(screen).split("\n")
    assert lines[:4] == ["First.", ".", "Second.", "Third."]
    assert lines[4] == "."
    assert lines[5].startswith("Reading: 0.0 s (next: Toy lift, about")
    assert lines[6] == "."
    assert lines[7].startswith("Toy lift: 0.0 s (next: writing, about")


def test_an_error_too_is_on_its_own_line(provider, log, screen):
    from qgis.core import QgsProcessingException

    from lidar_buildings.provider.errors import as_processing_errors

    log.setProgress(50.0)
    with pytest.raises(QgsProcessingException), as_processing_errors(log):
        raise ValueError("None is left.")
    assert "".join(screen) == ".\n"


def test_json_has_no_bar_and_no_empty_lines(provider, log, screen, monkeypatch):
    from lidar_buildings.provider.feedback import FeedbackMonitor

    monkeypatch.setattr(QgsApplication, "arguments", lambda: ["qgis_process", "--json"])
    monitor = FeedbackMonitor(log)
    monitor.progress(0.5)
    monitor.inform("Second.")
    assert "".join(screen) == ".Second.\n"
