"""Features of a layer that are measured block by block have the values of one run on all points."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.run import run_stage
from lidar_buildings.algorithms.stage import LayerFeatures, Monitor
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.algorithms.tiling import features_in_blocks
from lidar_buildings.algorithms.tiling.features_in_blocks import measure_features
from lidar_buildings.algorithms.tiling.survey import open_survey
from lidar_buildings.tests.builders import roof

HEIGHTS = STAGES["compute_building_heights"]
CORNER = np.array([600_000.0, 5_000_000.0, 0.0])
SIDE = 150.0


def house(x, y):
    return np.array([[x, y], [x + 12, y], [x + 12, y + 8], [x, y + 8], [x, y]], float)


@pytest.fixture(scope="module")
def town(tmp_path_factory):
    """Two tiles of a town of rows of two houses; of a map, which has one house without points and one far away."""
    rng = np.random.default_rng(1)
    spots = [(x, y) for x in range(8, 140, 33) for y in range(6, 140, 27)]
    rings = [ring for x, y in spots for ring in (house(x, y), house(x + 12, y))]
    roofs = [roof(rng, x, y, 24, 8, 4.0 + 0.1 * number, density=6.0) for number, (x, y) in enumerate(spots)]
    ground = np.column_stack([rng.uniform(0, SIDE, (40_000, 2)), rng.normal(0, 0.02, 40_000)])
    under = np.zeros(len(ground), bool)
    for x, y in spots:
        under |= ((ground[:, :2] > [x, y]) & (ground[:, :2] < [x + 24, y + 8])).all(axis=1)
    xyz = np.concatenate([ground[~under], *roofs]) + CORNER
    classes = np.repeat([2, 6], [(~under).sum(), len(xyz) - (~under).sum()]).astype(np.uint8)
    folder = tmp_path_factory.mktemp("town")
    west = xyz[:, 0] < CORNER[0] + 70
    arrays = {"xyz": xyz, "classification": classes}
    for name, part in (("west", west), ("east", ~west), ("all", west | True)):
        cloud = create_cloud({key: values[part] for key, values in arrays.items()}, "EPSG:32631")
        write_cloud(cloud, folder / f"{name}.las")
    return folder, [*rings, house(61, 46), house(900, 900)]


def layer_of(rings, origin):
    local = [[ring + (CORNER - origin)[:2]] for ring in rings]
    return LayerFeatures(local, {"key": [5_000_000_000 + number for number in range(len(rings))]})


def test_the_values_are_those_of_one_run(town, monkeypatch):
    folder, rings = town
    cloud = read_cloud(folder / "all.las")
    given = {"footprints": layer_of(rings, cloud.origin)}
    whole = run_stage(HEIGHTS, cloud, None, Monitor(), given).layers["buildings"]
    survey = open_survey([folder / "west.las", folder / "east.las"])
    monkeypatch.setattr(features_in_blocks, "side_of_blocks", lambda *_: 75.0)
    monitor = Monitor()
    found = measure_features(HEIGHTS, survey, layer_of(rings, survey.origin), monitor)
    assert not monitor.warnings
    assert found.columns["key"] == whole.columns["key"] == [5_000_000_000 + number for number in range(len(rings) - 1)]
    assert list(found.columns) == list(whole.columns)
    for name, values in whole.columns.items():
        is_number = isinstance(values[0], float)
        compare = np.testing.assert_allclose if is_number else np.testing.assert_array_equal
        compare(found.columns[name], values, **({"rtol": 1e-6, "atol": 1e-6} if is_number else {}))
    assert set(found.columns["state"]) == {"seen", "no building"}


def test_blocks_without_ground_are_left_out_with_a_warning(town, tmp_path, monkeypatch):
    folder, rings = town
    cloud = read_cloud(folder / "all.las")
    west = cloud.get("xyz")[:, 0] + (cloud.origin - CORNER)[0] < 60
    write_cloud(cloud.take(np.flatnonzero(~west | (cloud.get("classification") == 6))), tmp_path / "hole.las")
    survey, monitor = open_survey([tmp_path / "hole.las"]), Monitor()
    monkeypatch.setattr(features_in_blocks, "side_of_blocks", lambda *_: 40.0)
    at = [0, len(rings) - 3]
    found = measure_features(HEIGHTS, survey, layer_of([rings[one] for one in at], survey.origin), monitor)
    assert found.columns["key"] == [5_000_000_000, 5_000_000_001]
    monkeypatch.setattr(features_in_blocks, "side_of_blocks", lambda *_: 40.0)
    monkeypatch.setitem(HEIGHTS.__dict__, "reach", 10.0)
    found = measure_features(HEIGHTS, survey, layer_of([rings[one] for one in at], survey.origin), monitor)
    assert found.columns["key"] == [5_000_000_001]
    assert monitor.warnings[0].startswith("1 features of a block are left out: No point is called ground")
    with pytest.raises(ValueError, match="No point is called ground"):
        measure_features(HEIGHTS, survey, layer_of(rings[:1], survey.origin), monitor)
    far = create_cloud({"xyz": CORNER + [[0, 0, 0], [4000.0, 0, 0]]}, "EPSG:32631")
    write_cloud(far, tmp_path / "far.las")
    both = open_survey([tmp_path / "hole.las", tmp_path / "far.las"])
    with pytest.raises(ValueError, match="None of the features has points near it"):
        measure_features(HEIGHTS, both, layer_of([house(1000, 10)], both.origin), monitor)
    with pytest.raises(ValueError, match="None of the features has points near it"):
        measure_features(HEIGHTS, survey, layer_of(rings[-1:], survey.origin), monitor)
