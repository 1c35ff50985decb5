"""Types of roofs made by hand: each face is a ring (x, y, z), m."""

import numpy as np

from lidar_buildings.algorithms.models3d.building_facts import NamedModel, building_attributes, roof_type
from lidar_buildings.algorithms.models3d.building_models import BuildingModel
from lidar_buildings.algorithms.models3d.solids import GROUND, ROOF, WALL, Solid


def roof(*rings):
    """Return a solid with roof faces alone."""
    start = np.cumsum([0, *map(len, rings)])
    faces = [[list(range(a, b))] for a, b in zip(start, start[1:])]
    return [Solid(np.concatenate(rings).astype(float), faces, [ROOF] * len(rings), list(range(len(rings))))]


SLOPE = [(0, 0, 6), (10, 0, 6), (10, 3, 9), (0, 3, 9)]
TOP = [(0, 3, 9), (10, 3, 9), (10, 6, 9), (0, 6, 9)]
ANNEX = [(0, 6, 3), (10, 6, 3), (10, 8, 3), (0, 8, 3)]


def test_slopes_below_a_flat_top_are_a_truncated_roof():
    assert roof_type(roof(SLOPE, TOP, ANNEX)) == "truncated"


def test_a_large_flat_dormer_below_the_ridge_is_no_flat_top():
    lower = [(x, y, 8.0) for x, y, _ in TOP]
    assert roof_type(roof(SLOPE, lower, ANNEX)) == "other"


def test_a_hip_may_be_of_two_faces():
    """The front is two faces, one next to the other 5 cm lower; the hip at one end is large."""
    front = [(0, 0, 6), (5, 0, 6), (5, 4, 10), (0, 4, 10)]
    beside = [(5, 0, 5.95), (10, 0, 5.95), (6, 4, 9.95), (5, 4, 9.95)]
    back = [(10, 8, 6), (0, 8, 6), (0, 4, 10), (6, 4, 10)]
    hip = [(10, 0, 6), (10, 8, 6), (6, 4, 10)]
    assert roof_type(roof(front, beside, back, hip)) == "hip"


def test_one_large_face_off_its_points_makes_a_model_doubtful():
    """A flat choir on a steep roof was a fourteenth of a church: all shares of the whole were sound."""
    box = [[0, 1, 2, 3], [7, 6, 5, 4], [0, 4, 5, 1], [1, 5, 6, 2], [2, 6, 7, 3], [3, 7, 4, 0]]
    low = [(0, 0, 0), (0, 5, 0), (5, 5, 0), (5, 0, 0)]
    corners = np.array([*low, *[(x, y, 6) for x, y, _ in low]], float)
    solid = Solid(corners, [[ring] for ring in box], [GROUND, ROOF, *[WALL] * 4], [0, 0, *range(4)])

    def facts(weakest):
        shares = {"explained": 0.9, "off": 0.03, "covered": 1.0, "weakest": weakest}
        return building_attributes(NamedModel("1", [], BuildingModel(0.0, "2.2", solids={"2.2": [solid]}, **shares)))

    assert [facts(weakest)["check"] for weakest in (0.6, 0.4)] == [0, 1]
    assert [facts(weakest)["confidence"] for weakest in (0.6, 0.5, 0.25)] == [0.9, 0.9, 0.45]
