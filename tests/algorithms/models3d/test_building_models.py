"""One building: which level of detail it gets."""

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
    model = model_building(xyz, np.zeros(len(xyz), bool), [RING], 0.0, SETTINGS)
    assert (model.level, model.reason) == ("2.2", "")
    (solid,) = model.best
    assert solid.vertices[:, 2].max() > 11.5
