"""The log of a chain: a heading and the seconds of each step, each value once."""


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
