"""One building: which level of detail it gets."""

from dataclasses import replace

import numpy as np

from lidar_buildings.algorithms.models3d.building_models import Settings, model_building

RING = np.array([[0, 0], [12, 0], [12, 8], [0, 8], [0, 0]], float)
SETTINGS = Settings(
    spacing=0.3, tolerance=0.15, min_area=2.0, max_slope=75.0, min_step=0.5, percentile=70.0, level="2.2"
)


def test_a_high_corner_is_better_than_a_simpler_level():
    """Around one corner all points lie in a shaft below the ground: a roof as low as they are has no solid."""
    xy = np.random.default_rng(0).uniform((0, 0), (12, 8), (1200, 2))
    is_shaft = (xy > [9.8, 5.8]).all(axis=1)
    xyz = np.column_stack([xy, np.where(is_shaft, -3.0, 6.0 + 0.5 * xy[:, 0])])
    model = model_building(xyz, np.zeros(len(xyz), bool), xyz, [RING], 0.0, SETTINGS)
    assert (model.level, model.reason) == ("2.2", "")
    (solid,) = model.best
    assert solid.vertices[:, 2].max() > 11.5


def test_where_a_roof_has_no_points_those_of_a_neighbor_limit_it():
    """The slope has no points beyond an easting of 9 m; a shed next to the footprint there is 3 m high."""
    xy = np.random.default_rng(0).uniform((0, 0), (9, 8), (1000, 2))
    roof = np.column_stack([xy, 6.0 + 0.5 * xy[:, 0]])
    shed = np.random.default_rng(1).uniform((12.1, 0, 2.99), (14, 8, 3.01), (300, 3))
    around = np.concatenate([roof, shed])
    model = model_building(roof, np.zeros(len(roof), bool), around, [RING], 0.0, SETTINGS)
    corners = np.concatenate([solid.vertices for solid in model.best])
    assert model.level == "2.2"
    assert corners[corners[:, 0] > 11.9, 2].max() <= 3.51
    assert corners[:, 2].max() > 10.0


def test_the_weakest_face_tells_of_a_part_that_lies_off_its_points():
    """A third of the roof is 2 m lower: with planes of its own it is explained, under one level top it is not."""
    xy = np.random.default_rng(0).uniform((0, 0), (12, 8), (1200, 2))
    xyz = np.column_stack([xy, np.where(xy[:, 0] > 8, 6.0, 8.0)])
    found = {
        level: model_building(xyz, np.zeros(len(xyz), bool), xyz, [RING], 0.0, replace(SETTINGS, level=level)).weakest
        for level in ("1.2", "2.2")
    }
    assert found["2.2"] > 0.95
    assert 0.6 < found["1.2"] < 0.7
