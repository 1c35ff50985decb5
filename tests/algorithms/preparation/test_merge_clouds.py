"""Clouds come where the transforms say: against scipy's rotations, and in words that users can act on."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from lidar_buildings.algorithms.preparation.merge_clouds import merge_clouds, read_transforms
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.tests.monitors import Listening

angles = st.lists(st.floats(-360, 360), min_size=3, max_size=3)
offsets = st.lists(st.floats(-1e6, 1e6), min_size=3, max_size=3)


def merged(clouds, transforms="", monitor=None):
    sources = [np.zeros(len(cloud), np.uint16) for cloud in clouds]
    return merge_clouds(clouds, sources, transforms=transforms, monitor=monitor)


def written(numbers) -> str:
    return " ".join(repr(float(number)) for number in np.ravel(numbers))


def matrix_of(rotation, offset) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation, offset
    return matrix


@pytest.fixture
def two(rng):
    return [rng.uniform(0, 10, (50, 3)), rng.uniform(0, 10, (30, 3))]


# --- Against scipy


@settings(max_examples=100)
@given(angles, offsets)
def test_angles_are_rotations_about_fixed_axes_one_after_the_other(degrees, offset):
    points = np.random.default_rng(0).uniform(-50, 50, (20, 3))
    xyz, *_ = merged([points, points], written([*degrees, *offset]))
    wanted = Rotation.from_euler("xyz", degrees, degrees=True).apply(points) + offset
    np.testing.assert_allclose(xyz[20:], wanted, rtol=0, atol=1e-9)
    assert (xyz[:20] == points).all()


@settings(max_examples=100)
@given(st.integers(0, 2**32 - 1), offsets)
def test_a_matrix_does_the_same_as_its_angles(seed, offset):
    rotation = Rotation.random(random_state=seed)
    points = np.random.default_rng(seed).uniform(-50, 50, (20, 3))
    by_matrix = merged([points, points], written(matrix_of(rotation.as_matrix(), offset)))[0]
    by_angles = merged([points, points], written([*rotation.as_euler("xyz", degrees=True), *offset]))[0]
    np.testing.assert_allclose(by_matrix[20:], rotation.apply(points) + offset, rtol=0, atol=1e-9)
    np.testing.assert_allclose(by_matrix, by_angles, rtol=0, atol=1e-9)


@settings(max_examples=50)
@given(st.integers(0, 2**32 - 1))
def test_distances_stay_whatever_the_decimals(seed):
    """A matrix of four decimals is no exact rotation; the nearest rotation replaces it."""
    rotation = Rotation.random(random_state=seed)
    points = np.random.default_rng(seed).uniform(-50, 50, (20, 3))
    rounded = " ".join(f"{value:.4f}" for value in matrix_of(rotation.as_matrix(), [1, 2, 3]).ravel())
    xyz = merged([points, points], rounded)[0][20:]
    was, is_now = (np.linalg.norm(one[:, None] - one, axis=2) for one in (points, xyz))
    np.testing.assert_allclose(was, is_now, rtol=0, atol=1e-9)
    np.testing.assert_allclose(xyz, rotation.apply(points) + [1, 2, 3], atol=0.02)


def test_a_transform_and_its_inverse_bring_the_cloud_back(two):
    rotation = Rotation.from_euler("xyz", [10, -20, 130], degrees=True)
    moved = merged(two, written(matrix_of(rotation.as_matrix(), [5, 6, 7])))[0][50:]
    back = matrix_of(rotation.inv().as_matrix(), -rotation.inv().apply([5, 6, 7]))
    np.testing.assert_allclose(merged([two[0], moved], written(back))[0][50:], two[1], atol=1e-9)


# --- Which cloud goes where


def test_transforms_go_to_the_clouds_after_the_first_in_their_order(rng):
    clouds = [rng.uniform(0, 10, (n, 3)) for n in (4, 5, 6, 7)]
    xyz, number, previous = merged(clouds, "0 0 0 1 0 0;; 0, 0, 0, 0, 0, 3")
    assert number.tolist() == [1] * 4 + [2] * 5 + [3] * 6 + [4] * 7
    assert number.dtype == np.uint16
    assert previous is None
    shift = xyz - np.concatenate(clouds)
    np.testing.assert_allclose(shift, np.repeat([[0, 0, 0], [1, 0, 0], [0, 0, 0], [0, 0, 3]], [4, 5, 6, 7], axis=0))


@pytest.mark.parametrize("text", ["", "  ", ";", " ; ;; "])
def test_nothing_said_moves_nothing(two, text):
    assert merged(two, text)[0] is None


def test_source_ids_from_before_are_kept(two):
    sources = [np.arange(50), np.full(30, 60_000)]
    _, number, previous = merge_clouds(two, sources)
    assert np.bincount(number).tolist() == [0, 50, 30]
    assert previous.tolist() == [*range(50), *[60_000] * 30]
    assert previous.dtype == np.uint16


def test_what_was_done_is_reported(two):
    monitor = Monitor()
    merged(two, "0 0 -90 0 0 0", monitor)
    assert monitor.values["rotation_of_cloud_2_in_degrees"] == pytest.approx(90)
    middle = (two[1].min(axis=0) + two[1].max(axis=0)) / 2
    assert monitor.values["shift_of_the_middle_of_cloud_2_in_meters"] == pytest.approx(
        np.hypot(*middle[:2]) * np.sqrt(2)
    )


# --- How transforms are written


ROTATED = [[0, -1, 0, 5], [1, 0, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]]


@pytest.mark.parametrize(
    "content",
    [
        "0 -1 0 5\n1 0 0 6\n0 0 1 7\n0 0 0 1\n",
        "# from the scanner\r\n0,-1,0,5\r\n1,0,0,6\r\n0,0,1,7\r\n0,0,0,1",
        "[[0. -1. 0. 5.]\n [1. 0. 0. 6.]\n [0. 0. 1. 7.]\n [0. 0. 0. 1.]]",
        "[0 -1 0 5; 1 0 0 6; 0 0 1 7; 0 0 0 1]",
        "\ufeff0\t-1\t0\t5\t1\t0\t0\t6\t0\t0\t1\t7\t0\t0\t0\t1",
        "0 0 90 5 6 7",
    ],
)
def test_a_text_file_may_be_written_as_programs_write_matrices(two, tmp_path, content):
    path = tmp_path / "to the first.txt"
    path.write_bytes(content.encode())
    xyz, *_ = merged(two, f" {path} ;")
    x, y, z = two[1].T
    np.testing.assert_allclose(xyz[50:], np.column_stack([5 - y, 6 + x, 7 + z]), atol=1e-12)
    assert (merged(two, f'"{path}"')[0] == xyz).all()


def test_each_cloud_may_have_its_file(rng, tmp_path):
    clouds = [rng.uniform(0, 10, (4, 3)) for _ in range(3)]
    for i in (2, 3):
        (tmp_path / f"{i}.txt").write_text(f"0 0 0 {i} 0 0")
    xyz, *_ = merged(clouds, f"{tmp_path / '2.txt'}; {tmp_path / '3.txt'}")
    np.testing.assert_allclose((xyz - np.concatenate(clouds))[:, 0], np.repeat([0, 2, 3], 4))


# --- What is refused


SCALED = written(np.diag([1.01, 1.01, 1.01, 1]))
MIRRORED = written(np.diag([1, 1, -1, 1]))
SHEARED = written([[1, 0.01, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
TRANSPOSED = written(np.transpose(ROTATED))


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("1 2 3", r"The transform of cloud 2 must be six numbers \(.*\) or the 16 of a 4x4 matrix, got 3 numbers\."),
        (";1 2", "The transform of cloud 3 must be six numbers .*, got 2 numbers"),
        ("0 0 nan 0 0 0", "The transform of cloud 2 has a number that is not finite; correct it"),
        (SCALED, r"The transform of cloud 2 is not rigid: it scales or shears, .* by 0\.02; give a rotation"),
        (SHEARED, r"The transform of cloud 2 is not rigid: it scales or shears, .* by 0\.01; give a rotation"),
        (MIRRORED, "The transform of cloud 2 is not rigid: it mirrors the cloud; give a rotation"),
        (TRANSPOSED, "The transform of cloud 2 must have 0 0 0 1 in its last row, got 5 6 7 1; is it transposed"),
        ("no such file.txt", r"cloud 2 \(no such file.txt\) is neither numbers nor a text file .*\(No such file"),
        (";;0 0 0 0 0 0", "There are 3 transforms for 3 clouds, of which the first stays; give at most 2, separated"),
    ],
)
def test_what_is_no_rigid_transform_is_refused(text, sentence):
    with pytest.raises(ValueError, match=sentence) as refusal:
        read_transforms(text, 3)
    assert str(refusal.value).count(". ") == 0


def test_files_that_are_no_transforms_are_refused(tmp_path):
    picture = tmp_path / "a.png"
    picture.write_bytes(b"\x89PNG\xff\xfe")
    with pytest.raises(ValueError, match=r"\(a.png\) is neither numbers nor a text file .*\(it is not text\)"):
        read_transforms(str(picture), 2)
    with pytest.raises(ValueError, match="neither numbers nor a text file"):
        read_transforms(str(tmp_path), 2)
    letter = tmp_path / "letter.txt"
    letter.write_text("Dear user")
    with pytest.raises(ValueError, match=r"cloud 2 \(letter.txt\) must be six numbers .* got something else\."):
        read_transforms(str(letter), 2)


def test_too_few_decimals_for_the_coordinates_are_reported(rng):
    turn = Rotation.from_euler("z", 30, degrees=True).as_matrix()
    near, far = rng.uniform(0, 10, (20, 3)), rng.uniform(0, 10, (20, 3)) + [6e5, 5e6, 0]
    coarse, fine = (
        " ".join(f"{value:.{digits}f}" for value in matrix_of(turn, [0, 0, 0]).ravel()) for digits in (6, 10)
    )
    reported = []
    for points, text in ((near, coarse), (far, fine), (far, coarse)):
        monitor = Monitor()
        merged([points, points], text, monitor)
        reported.append([warning for warning in monitor.warnings if "decimals" in warning])
    assert reported[:2] == [[], []]
    assert reported[2][0].startswith(
        "The matrix of cloud 2 has too few decimals for its coordinates: the nearest rotation"
    )


# --- Clouds that lie apart


def test_clouds_that_lie_apart_are_merged_and_reported(two):
    monitor = Monitor()
    xyz, *_ = merged([*two, two[0]], "; 0 0 0 1000 0 0", monitor)
    assert len(xyz) == 130
    (warning,) = monitor.warnings
    assert warning.startswith("Some clouds lie apart, 99")
    assert warning.endswith(
        "m or more from the nearest other (cloud 3); if they are of one site, check the transforms."
    )


def test_two_clouds_apart_from_each_other_are_reported_in_one_sentence(two):
    monitor = Monitor()
    merged(two, "0 0 0 1000 0 0", monitor)
    (warning,) = monitor.warnings
    assert "(cloud 1, 2)" in warning


def test_neighboring_tiles_are_not_reported(rng):
    monitor = Monitor()
    tile = np.concatenate([rng.uniform(0, 100, (500, 3)), [[0, 0, 0], [100, 100, 100]]])
    merged([tile, tile + [100, 0, 0], tile + [0, 100.5, 0]], "", monitor)
    assert monitor.warnings == []


def test_it_can_be_cancelled(two):
    with pytest.raises(Cancelled):
        merged(two, "", Listening(stop_at=0.0))
