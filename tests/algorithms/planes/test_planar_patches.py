"""Patches on roofs given by formulas, at many densities and noises, and none in leaves."""

import numpy as np
import pytest

from lidar_buildings.algorithms.neighborhoods.covariance import Nearest
from lidar_buildings.algorithms.planes import planar_patches as module
from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.tests.builders import FAR, crown
from lidar_buildings.tests.monitors import Listening


def segment_patches(xyz, density, off_plane, max_slope, monitor):
    """Return the patches of points with the neighborhood that they ask for."""
    around = CloudSampling.of(xyz).neighborhood(density, off_plane) if len(xyz) else Nearest(8)
    return module.segment_patches(xyz, np.arange(len(xyz)), around, off_plane, max_slope, monitor)


def gable(rng, density, noise, slope=40.0):
    """Return points of a gable roof, 12 m by 16 m with its ridge at x = 6, and their distance across to the ridge."""
    plan = rng.uniform(0, [12, 16], (int(12 * 16 * density), 2))
    to_ridge = plan[:, 0] - 6
    z = 9 - np.abs(to_ridge) * np.tan(np.radians(slope))
    return np.column_stack([plan, z + rng.normal(0, noise, len(plan))]), to_ridge


def leaves(rng, density, radius=4.0):
    """Return points spread evenly in a ball, ``density`` of them per square meter seen from above, twice returned."""
    return crown(rng, 0, 0, radius, 0, int(2 * density * np.pi * radius**2))


def largest(patch, count):
    """Return the numbers of the ``count`` largest patches."""
    return np.argsort(np.bincount(patch[patch >= 0]))[::-1][:count]


@pytest.mark.parametrize("density", [2, 5, 12, 30])
@pytest.mark.parametrize("noise", [0.01, 0.03, 0.06])
def test_a_gable_is_two_patches_that_meet_in_the_ridge(density, noise, rng):
    xyz, to_ridge = gable(rng, density, noise)
    patch = segment_patches(xyz, density, max(noise, 0.02), 75.0, Monitor())
    assert (patch >= 0).mean() > 0.9
    sides = largest(patch, 2)
    of_side = [to_ridge[patch == side] for side in sides]
    assert {np.sign(np.median(across)) for across in of_side} == {-1, 1}
    spacing = 1 / np.sqrt(density)
    for across in of_side:
        own = np.sign(np.median(across))
        # A point of the other side is within the noise of this side's plane only next to the ridge.
        assert (across * own).min() > -(spacing + 6 * noise)
        assert len(across) > 0.85 * (np.sign(to_ridge) == own).sum()


def test_points_beside_ridge_and_eaves_belong_to_their_side(rng):
    """Planes fitted across the ridge would lose a strip as wide as a neighborhood."""
    xyz, to_ridge = gable(rng, 10, 0.02)
    patch = segment_patches(xyz, 10.0, 0.02, 75.0, Monitor())
    near = (np.abs(to_ridge) < 0.4) | (np.abs(to_ridge) > 5.6) | (xyz[:, 1] < 0.4) | (xyz[:, 1] > 15.6)
    assert np.isin(patch[near], largest(patch, 2)).mean() > 0.95


@pytest.mark.parametrize("gap", [1.5, 2.0])
def test_a_gable_on_lines_that_zigzag_is_two_patches(gap, rng):
    """A point every 25 cm on lines that part from one another and meet again: no number of points suits all places."""
    x, line = np.meshgrid(np.arange(0.1, 12, 0.25), np.arange(-4, 20 / gap))
    way = np.abs(x % 12 - 6) / 6 * gap
    y = gap * line + np.where(line % 2, way, -way)
    plan = np.column_stack([x.ravel(), y.ravel()]) + rng.normal(0, 0.02, (x.size, 2))
    plan = plan[(plan[:, 1] > 0) & (plan[:, 1] < 16)]
    to_ridge = plan[:, 1] - 8
    z = 9 - np.abs(to_ridge) * np.tan(np.radians(40)) + rng.normal(0, 0.015, len(plan))
    patch = segment_patches(np.column_stack([plan, z]), 4 / gap, 0.04, 75.0, Monitor())
    shares = []
    for side in (to_ridge < -1, to_ridge > 1):
        shares += [np.bincount(patch[side] + 1)[1:].max(initial=0) / side.sum()]
    assert min(shares) > 0.9


@pytest.mark.parametrize(("density", "most"), [(2, 0.25), (8, 0.04), (20, 0.02), (50, 0.02)])
def test_leaves_are_no_patch(density, most, rng):
    shares = []
    for _ in range(3):
        patch = segment_patches(leaves(rng, density), density, 0.03, 75.0, Monitor())
        sizes = np.bincount(patch[patch >= 0], minlength=1)
        shares.append(sizes[sizes >= 2 * density].sum() / len(patch))  # of at least 2 m²
    assert np.mean(shares) < most


def test_a_step_parts_two_flat_roofs_and_a_sharp_edge_is_kept(rng):
    plan = rng.uniform(0, [20, 10], (2000, 2))
    xyz = np.column_stack([plan, np.where(plan[:, 0] < 10, 5.0, 5.4) + rng.normal(0, 0.02, 2000)])
    patch = segment_patches(xyz, 10.0, 0.02, 75.0, Monitor())
    low, high = (np.bincount(patch[side & (patch >= 0)]).argmax() for side in (plan[:, 0] < 10, plan[:, 0] >= 10))
    assert low != high
    assert (patch[plan[:, 0] < 10] == low).mean() > 0.97
    assert (patch[plan[:, 0] >= 10] == high).mean() > 0.97


def test_a_vault_is_one_patch(rng):
    """Curved roofs bend by little between neighbors: a barrel of 8 m radius, 10 m wide."""
    plan = rng.uniform([-5, 0], [5, 20], (2400, 2))
    xyz = np.column_stack([plan, np.sqrt(64 - plan[:, 0] ** 2) + rng.normal(0, 0.02, 2400)])
    patch = segment_patches(xyz, 12.0, 0.02, 75.0, Monitor())
    assert np.bincount(patch[patch >= 0]).max() > 0.95 * len(xyz)


@pytest.mark.parametrize(("slope", "is_patch"), [(30, True), (55, True), (68, False), (90, False)])
def test_steeper_than_the_maximum_slope_is_no_patch(slope, is_patch, rng):
    along, across = rng.uniform(0, 12, (2, 1500))
    angle = np.radians(slope)
    xyz = np.column_stack([along, across * np.cos(angle), across * np.sin(angle)]) + rng.normal(0, 0.01, (1500, 3))
    on_patch = segment_patches(xyz, 10.0, 0.02, 60.0, Monitor()) >= 0
    assert on_patch.mean() > 0.95 if is_patch else on_patch.mean() < 0.05


@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_upright_walls_are_patches_that_end_at_the_corner(noise, rng):
    """Normals of walls point a little up to either side by chance, and no wall may fall apart for that."""
    along, up = rng.uniform([0, 0], [8, 10], (1600, 2)).T
    across = rng.normal(0, noise, 1600)
    is_north = np.arange(1600) < 800
    xyz = np.column_stack([np.where(is_north, along, across), np.where(is_north, across, along), up])
    patch = segment_patches(xyz, 10.0, 0.02, 90.0, Monitor())
    one, other = (np.bincount(patch[side & (patch >= 0)]).argmax() for side in (is_north, ~is_north))
    assert one != other
    assert (patch[is_north] == one).mean() > 0.95
    assert (patch[~is_north] == other).mean() > 0.95


def test_points_above_a_roof_are_not_on_it(rng):
    plan = rng.uniform(0, 12, (1500, 2))
    xyz = np.column_stack([plan, rng.normal(4, 0.02, 1500)])
    xyz[::50, 2] += 0.6
    patch = segment_patches(xyz, 10.0, 0.02, 75.0, Monitor())
    roof = largest(patch, 1)[0]
    assert (patch[::50] != roof).all()
    assert (np.delete(patch, np.arange(0, 1500, 50)) == roof).mean() > 0.97


def test_order_position_and_direction_change_nothing(rng):
    xyz, _ = gable(rng, 8, 0.02)
    patch = segment_patches(xyz, 8.0, 0.02, 75.0, Monitor())
    order = rng.permutation(len(xyz))
    for other, of in (
        (segment_patches(xyz[order], 8.0, 0.02, 75.0, Monitor()), patch[order]),
        (segment_patches(xyz + FAR, 8.0, 0.02, 75.0, Monitor()), patch),
        (segment_patches(xyz[:, [1, 0, 2]] * [-1, 1, 1], 8.0, 0.02, 75.0, Monitor()), patch),
    ):
        same = (other >= 0) == (of >= 0)
        assert same.mean() > 0.999
        pairs = set(zip(of[same & (of >= 0)].tolist(), other[same & (of >= 0)].tolist()))
        assert len(pairs) == len({a for a, _ in pairs}) == len({b for _, b in pairs})


@pytest.mark.parametrize("count", [0, 1, 3, 7])
def test_a_handful_of_points_is_no_patch(count):
    patch = segment_patches(np.arange(3.0 * count).reshape(-1, 3), 1.0, 0.02, 75.0, Monitor())
    assert patch.tolist() == [-1] * count


@pytest.mark.parametrize(
    "xyz",
    [np.zeros((30, 3)), np.outer(np.arange(30.0), [1, 0, 0]), np.outer(np.arange(30.0), [0, 0, 1])],
    ids=["one place", "line", "pole"],
)
def test_points_without_a_plane_do_no_harm(xyz):
    assert segment_patches(xyz, 1.0, 0.02, 75.0, Monitor()).shape == (30,)


def test_cancel_gets_through(rng):
    with pytest.raises(Cancelled):
        segment_patches(gable(rng, 5, 0.02)[0], 5.0, 0.02, 75.0, Listening(stop_at=0.3))
