import numpy as np
import pytest

from lidar_buildings.algorithms.quality.assess_models import assess_models
from lidar_buildings.algorithms.stage import LayerFeatures, Monitor
from lidar_buildings.tests.roof_shapes import SHAPES


def gable(rise=0.0):
    """Return the two true faces of the gable, lifted (m)."""
    return [
        [np.array([[0, 0, 4], [12, 0, 4], [12, 4, 7.2], [0, 4, 7.2], [0, 0, 4]]) + [0, 0, rise]],
        [np.array([[0, 4, 7.2], [12, 4, 7.2], [12, 8, 4], [0, 8, 4], [0, 4, 7.2]]) + [0, 0, rise]],
    ]


def assessed(name="gable", faces=None, noise=0.03, **tunables):
    points, _ = SHAPES[name].scanned(noise=noise)
    rng = np.random.default_rng(0)
    ground = np.column_stack([rng.uniform(-2, 14, (800, 2)), np.zeros(800)])
    classes = np.repeat([6, 2], [len(points), 800]).astype(np.uint8)
    faces = gable() if faces is None else faces
    roofs = LayerFeatures(faces, {"building": ["a"] * len(faces)})
    monitor = Monitor()
    xyz = np.concatenate([points, ground])
    made = assess_models.stage.unpack(assess_models(xyz, classes, roofs, monitor=monitor, **tunables))
    return made.layers["faces"].columns, made.layers["building_distances"].columns, made.report, monitor


def test_distances_are_those_of_the_noise():
    faces, buildings, report, _ = assessed()
    assert report.values["rms"] == pytest.approx(0.03, rel=0.06)
    assert report.values["p95"] == pytest.approx(1.96 * 0.03, rel=0.08)
    assert (report.values["missing"], report.values["invented"], report.values["all_faces"]) == (0, 0, 2)
    assert faces["status"] == ["matched", "matched"]
    assert buildings["volume"] == pytest.approx([12 * 8 * 5.6], rel=0.01)
    assert report.values["on_model"] == pytest.approx(100, abs=0.5)


def test_volumes_do_not_depend_on_the_way_that_rings_run():
    hole = np.array([[2, 1, 4.8], [4, 1, 4.8], [4, 2, 5.6], [2, 2, 5.6], [2, 1, 4.8]])
    faces = gable()
    both = [[faces[0][0], hole], faces[1]]
    turned = [[ring[::-1] for ring in faces[0]] + [hole], [faces[1][0][::-1]]]
    expected = 12 * 8 * 5.6 - 2 * 5.2
    for given in (both, turned):
        assert assessed(faces=given)[1]["volume"] == pytest.approx([expected], rel=0.01)


def test_a_model_that_lies_too_high_is_reported_by_how_much():
    faces, _, report, _ = assessed(faces=gable(0.5), noise=0.0)
    assert faces["mean"][:2] == pytest.approx([-0.5, -0.5], abs=1e-6)
    assert report.values["rms"] == pytest.approx(0.5, abs=1e-6)
    assert faces["status"][:2] == ["invented", "invented"]
    # Both planes of the roof are not in the model.
    assert report.values["missing"] == 2


def test_faces_with_undefined_heights_are_left_out():
    """A hole whose heights are NaN made every distance NaN."""
    hole = np.array([[2, 1, np.nan], [2, 2, np.nan], [3, 2, np.nan], [3, 1, np.nan], [2, 1, np.nan]])
    faces = gable()
    _, buildings, report, monitor = assessed(faces=[faces[0], [faces[1][0], hole]])
    assert report.values["all_faces"] == 1
    assert np.isfinite([report.values["rms"], *buildings["volume"]]).all()
    assert any("1 of 2 faces" in warning for warning in monitor.warnings)


def test_a_dormer_that_the_model_has_not_is_missing():
    faces, buildings, report, _ = assessed("dormer")
    assert report.values["missing"] == 1
    assert buildings["missing"] == [1]
    assert faces["status"].count("missing") == 1
    assert faces["points"][faces["status"].index("missing")] == pytest.approx(2 * 2.275 * 12, rel=0.25)
    _, _, larger, _ = assessed("dormer", min_plane_area=20.0)
    assert larger.values["missing"] == 0


def test_a_face_without_points_is_unseen_and_upright_ones_are_left_out():
    beside = [np.array([[20, 0, 4], [24, 0, 4], [24, 4, 4], [20, 4, 4], [20, 0, 4.0]])]
    upright = [np.array([[0, 0, 0], [12, 0, 0], [12, 0, 4], [0, 0, 4], [0, 0, 0.0]])]
    faces, _, _, monitor = assessed(faces=[*gable(), beside, upright])
    assert faces["status"] == ["matched", "matched", "unseen"]
    assert any("1 of 4 faces have no heights or no area" in warning for warning in monitor.warnings)


def test_walls_do_not_count():
    points, _ = SHAPES["flat"].scanned()
    rng = np.random.default_rng(1)
    wall = np.column_stack([rng.uniform(0, 12, 300), np.full(300, 0.05), rng.uniform(0, 5, 300)])
    xyz = np.concatenate([points, wall])
    ring = np.array([[0, 0, 6], [12, 0, 6], [12, 8, 6], [0, 8, 6], [0, 0, 6.0]])
    roofs = LayerFeatures([[ring]], {})
    *_, report = assess_models(xyz, np.full(len(xyz), 6, np.uint8), roofs)
    assert report.values["rms"] == pytest.approx(0.03, rel=0.1)


def test_a_wall_under_the_edge_of_a_roof_is_no_missing_plane():
    """Its points less than a meter below the model are taken for the roof's, and lie on one upright plane."""
    points, _ = SHAPES["flat"].scanned()
    rng = np.random.default_rng(1)
    wall = np.column_stack([rng.uniform(0, 12, 600), rng.normal(0.05, 0.01, 600), rng.uniform(5.05, 5.8, 600)])
    xyz = np.concatenate([points, wall])
    ring = np.array([[0, 0, 6], [12, 0, 6], [12, 8, 6], [0, 8, 6], [0, 0, 6.0]])
    *_, report = assess_models(xyz, np.full(len(xyz), 6, np.uint8), LayerFeatures([[ring]], {}))
    assert report.values["points"] == len(xyz)
    assert report.values["missing"] == 0


def test_what_has_no_heights_or_buildings_is_refused():
    flat = [[ring[:, :2] for ring in rings] for rings in gable()]
    with pytest.raises(ValueError, match="None of the 2 roof faces has heights"):
        assessed(faces=flat)
    with pytest.raises(ValueError, match="run 'Detect buildings' first"):
        assess_models(np.zeros((3, 3)), np.ones(3, np.uint8), LayerFeatures(gable(), {}))
