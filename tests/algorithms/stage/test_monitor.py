"""Parts of a monitor: a stretch of the whole's progress, its values under a prefix, its warnings as they are."""

import pytest

from lidar_buildings.algorithms.stage import Cancelled
from lidar_buildings.tests.monitors import Listening


def test_a_part_of_a_part_is_a_stretch_of_the_whole():
    whole = Listening()
    inner = whole.part(0.2, 0.6).part(0.5, 1.0)
    for fraction in (0.0, 0.5, 1.0):
        inner.progress(fraction)
    assert whole.heard == pytest.approx([0.4, 0.5, 0.6])


def test_values_get_the_prefixes_of_all_parts_and_warnings_none():
    whole = Listening()
    inner = whole.part(0, 1, "ground_").part(0, 1, "seeds_")
    inner.resolved(size=3)
    inner.warn("Few points.")
    assert whole.values == inner.values == {"ground_seeds_size": 3}
    assert whole.warnings == inner.warnings == ["Few points."]


def test_a_part_passes_a_cancellation_on():
    with pytest.raises(Cancelled):
        Listening(stop_at=0.5).part(0.4, 0.8).progress(0.5)
