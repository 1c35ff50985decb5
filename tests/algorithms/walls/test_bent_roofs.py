"""Halves of roofs that matching has bent belong to the house whose planes lie next to them."""

from __future__ import annotations

import numpy as np
import pytest

from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.algorithms.walls.classify_roofs import classify_roofs, with_bent_roofs
from lidar_buildings.tests.surfaces import box, mound, seen_from_above


def bent_gable(x, y):
    """A gable along the x axis whose northern half sags by 0.4 m in the middle."""
    inside = (x >= 5) & (x <= 15) & (y >= 5) & (y <= 13)
    sag = 0.4 * np.clip(1 - ((y - 11) / 2) ** 2, 0, 1)
    return np.where(inside, 7 - 0.7 * np.abs(y - 9) - np.where(y > 9, sag, 0), 0)


def classified(xyz, on_plane, **tunables):
    height = xyz[:, 2].astype(np.float32)
    classes = np.where(xyz[:, 2] < 0.1, 2, 1).astype(np.uint8)
    return classify_roofs(xyz, classes, height, on_plane.astype(np.int32), **tunables)[1]


@pytest.fixture
def site(rng):
    """The gable, a level roof of which no plane was found, and a crown with a flat top."""
    parts = bent_gable, box(20, 20, 26, 26, 5.0), mound((10, 22), 3.5, 6.0, rough=0.6)
    xyz, part = seen_from_above(rng, *parts)
    return xyz, part, (part == 1) & (xyz[:, 1] < 8.7)


def test_the_bent_half_joins_the_plane(site):
    xyz, part, on_plane = site
    building = classified(xyz, on_plane, source="matched images")
    north = (part == 1) & (xyz[:, 1] > 9.3) & (xyz[:, 1] < 12.7)
    assert (building[north] == 1).mean() > 0.9
    assert (building[on_plane] == 1).all()


def test_what_no_plane_lies_beside_is_no_roof(site):
    xyz, part, on_plane = site
    assert not classified(xyz, on_plane, source="matched images")[part != 1].any()


def test_earth_against_a_wall_is_seen_to_go_on_into_the_ground(rng):
    """It falls from 4 m by 9 m; of the part that is raised alone, less than a tenth is low."""

    def bank(x, y):
        return np.where((x >= 5) & (x <= 15) & (y >= 13) & (y <= 22), 4 * (22 - y) / 9, 0)

    xyz, part = seen_from_above(rng, bent_gable, bank)
    building = classified(xyz, (part == 1) & (xyz[:, 1] < 8.7), source="matched images")
    assert (building[part == 2] > 0).mean() < 0.01
    assert (building[(part == 1) & (xyz[:, 1] > 9.3) & (xyz[:, 1] < 12.7)] == 1).mean() > 0.9


def test_a_scanner_sees_planes_only(site):
    xyz, part, on_plane = site
    building = classified(xyz, on_plane, source="laser scanner")
    np.testing.assert_array_equal(building > 0, on_plane)


def test_a_part_between_two_houses_joins_the_one_it_touches_most(rng):
    # Two planes with a strip between, that touches the western one all along and the eastern one for two meters.
    xyz, _ = seen_from_above(rng, box(0, 0, 30, 30, 5.0))
    x, y = xyz[:, 0], xyz[:, 1]
    building = np.where(x < 10, 1, np.where((x > 14) & (y < 2), 2, 0)).astype(np.int32)
    is_bent = (x >= 10) & (x <= 14)
    joined = with_bent_roofs(xyz, building, is_bent, 0.6, 6.0, 40.0, Monitor())
    assert (joined[is_bent] == 1).all()
    np.testing.assert_array_equal(joined[~is_bent], building[~is_bent])
    # Neither too small a part nor one out of reach joins.
    small = is_bent & (y < 1)
    np.testing.assert_array_equal(with_bent_roofs(xyz, building, small, 0.6, 6.0, 40.0, Monitor()), building)
    far = (x > 20) & (y > 10)
    np.testing.assert_array_equal(with_bent_roofs(xyz, building, far, 0.6, 6.0, 40.0, Monitor()), building)


def test_the_order_of_points_does_not_matter(site, rng):
    xyz, _, on_plane = site
    order = rng.permutation(len(xyz))
    expected = classified(xyz, on_plane, source="matched images")[order]
    np.testing.assert_array_equal(classified(xyz[order], on_plane[order], source="matched images"), expected)
