import re

import numpy as np
import pytest

from lidar_buildings.algorithms.models3d.export_for_roofer import export_for_roofer
from lidar_buildings.algorithms.stage import LayerFeatures, Monitor

RING = np.array([[0, 0], [10, 0], [10, 10], [0, 10], [0, 0]], float)


def exported(geometries, ids, classes=(6, 2, 1, 6, 2, 7), **tunables):
    # On the roof, next to it, a tree over it, far away twice, noise.
    xyz = np.array([[5, 5, 6], [12, 5, 0], [5, 6, 9], [300, 5, 6], [300, 6, 0], [5, 5, 50]], float)
    monitor = Monitor()
    made = export_for_roofer(
        xyz, np.array(classes, np.uint8), LayerFeatures(geometries, {"id": ids}), monitor=monitor, **tunables
    )
    return made[0].tolist(), made[1], monitor


def test_ground_and_buildings_around_footprints_are_kept():
    selected, roofprints, _ = exported([[RING]], [1])
    assert selected == [0, 1]
    assert roofprints.columns["points"] == [1]
    selected, _, _ = exported([[RING]], [1], margin=0.0)
    assert selected == [0]


def test_each_roofprint_has_a_name_of_its_own_and_no_heights():
    raised = np.column_stack([RING, np.full(5, 3.0)])
    degenerate = np.repeat(RING[:1], 4, axis=0)
    _, roofprints, monitor = exported([[RING], [raised], [degenerate]], ["a", "a", "b"])
    assert roofprints.columns["identificatie"] == ["a", "a-2"]
    assert all(ring.shape[1] == 2 for rings in roofprints.geometries for ring in rings)
    assert monitor.warnings == ["1 of 3 footprints have no area and are left out."]


@pytest.mark.parametrize(
    ("classes", "sentence"),
    [
        ((1, 2, 1, 1, 2, 7), "No point is called building (class 6); run 'Detect buildings' first."),
        ((6, 1, 1, 6, 1, 7), "No point is called ground (class 2); run 'Classify ground points (TIN)' first."),
    ],
)
def test_what_roofer_could_not_use_is_refused(classes, sentence):
    with pytest.raises(ValueError, match=re.escape(sentence)):
        exported([[RING]], [1], classes)
