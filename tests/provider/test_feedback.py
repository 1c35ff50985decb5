"""The log of a run: a heading and the seconds of each step, each value once, each sentence on a line of its own."""

import pytest
from qgis.core import QgsApplication


def test_values_and_warnings_are_shown_once_and_each_step_with_its_seconds(log):
    from lidar_buildings.provider.feedback import ChainFeedback

    chain = ChainFeedback(log)
    chain.setProgressText("First")
    chain.pushInfo("Sampling: density 4.3 points/m², surface noise 0.02 m")
    chain.pushInfo("Point density: 4.3")
    chain.setProgressText("Second")
    chain.pushInfo("Sampling: density 4.3 points/m², height resolution 0.01 m")
    chain.pushInfo("Point density: 4.3")
    chain.pushInfo("Sampling: density 4.3 points/m²")
    for _ in range(2):
        chain.pushWarning("No coordinate reference system.")
    chain.end_step()
    chain.end_step()
    seconds = [info for info in log.infos if info.endswith(" s") and info[:-2].replace(".", "").isdigit()]
    assert [info for info in log.infos if info not in seconds] == [
        "Sampling: density 4.3 points/m², surface noise 0.02 m",
        "Point density: 4.3",
        "Sampling: height resolution 0.01 m",
    ]
    assert len(seconds) == 2
    assert log.warnings == ["No coordinate reference system."]


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
    from lidar_buildings.provider.feedback import ChainFeedback, FeedbackMonitor

    monitor = FeedbackMonitor(log)
    monitor.inform("First.")
    monitor.progress(0.3)
    monitor.inform("Second.")
    monitor.inform("Third.")
    chain = ChainFeedback(log)
    chain.setProgress(60.0)
    chain.setProgressText("A step")
    chain.setProgress(80.0)
    chain.end_step()
    lines = "".join(screen).split("\n")
    assert lines[:4] == ["First.", ".", "Second.", "Third."]
    assert lines[4] == "."
    assert lines[5] == "."
    assert lines[6].endswith(" s")


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
