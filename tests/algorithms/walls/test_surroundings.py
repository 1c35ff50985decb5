"""Gaps, bites, courtyards and party walls of roofs with visible ground all around."""

import numpy as np
import pytest

from lidar_buildings.algorithms.geometry.polygon_overlap import as_polygons, overlaps
from lidar_buildings.algorithms.geometry.rings import nearest_edge_distances, signed_area
from lidar_buildings.algorithms.sampling.cloud_sampling import CloudSampling
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.algorithms.walls.extract_wall_footprints import extract_wall_footprints
from lidar_buildings.algorithms.walls.surroundings import Surroundings, without_nested
from lidar_buildings.tests.polygon_validity import assert_valid

DENSITY = 60.0


def site(rng, holes=(), courts=(), other=None):
    """Return the cloud of a flat roof 20 m by 14 m in a field: nothing is seen in holes, the ground in courts."""
    xy = rng.uniform(-8, (28, 22), (round(36 * 30 * DENSITY), 2))
    within = lambda box: ((xy >= box[:2]) & (xy < box[2:])).all(axis=1)  # noqa: E731
    is_roof = within((0, 0, 20, 14)) & ~np.any([within(box) for box in courts] or [xy[:, 0] < -99], axis=0)
    is_other = within(other) if other else np.zeros(len(xy), bool)
    xyz = np.column_stack([xy, 5.0 * is_roof + 8.0 * is_other])
    kept = ~np.any([within(box) for box in holes] or [xy[:, 0] < -99], axis=0)
    return xyz[kept], (is_roof + 2 * is_other)[kept].astype(np.int32)


def footprint(xyz, cluster_id):
    found = extract_wall_footprints(xyz, cluster_id)[0]
    assert found.columns["source"] == ["roof"] * len(found)
    return found


def test_gaps_and_bites_where_nothing_is_seen_are_roof(rng):
    holes = [(5, 5, 7.5, 8), (0, 3, 1.5, 5), (12, 12, 14, 14), (9, 4, 9.6, 4.6)]
    found = footprint(*site(rng, holes))
    assert len(found) == 1
    (ring,) = found.geometries[0]
    true = np.array([(0, 0), (20, 0), (20, 14), (0, 14), (0, 0)], float)
    # Bites are 1.5 m and 2 m deep, and gaps 4 m away from the edge.
    assert nearest_edge_distances(ring, true[:-1], true[1:]).max() < 0.4
    assert signed_area(found.geometries[0][0]) == pytest.approx(20 * 14, rel=0.02)


def test_a_courtyard_in_which_the_ground_is_seen_stays_open(rng):
    found = footprint(*site(rng, holes=[(14, 2, 17, 5)], courts=[(5, 5, 11, 10)]))
    (rings,) = found.geometries
    assert len(rings) == 2
    assert signed_area(rings[1]) == pytest.approx(-30, rel=0.1)


def test_where_no_ground_is_seen_beside_the_roof_gaps_show_nothing(rng):
    xyz, cluster_id = site(rng, holes=[(5, 5, 9, 9)])
    xyz, cluster_id = xyz[cluster_id == 1], cluster_id[cluster_id == 1]
    surroundings = Surroundings(xyz, cluster_id, CloudSampling.of(xyz))
    assert len(surroundings.gaps(xyz, 0.13)) == 0


def test_a_side_is_a_party_wall_where_another_roof_begins(rng):
    xyz, cluster_id = site(rng, other=(20, -2, 28, 10))
    surroundings = Surroundings(xyz, cluster_id, CloudSampling.of(xyz))
    corners = np.array([(0, 0), (20, 0), (20, 14), (0, 14), (0, 0)], float)
    sides = np.stack([corners[:-1], corners[1:]], axis=1)
    # Of the eastern side 10 of 14 m have a roof next to them.
    assert surroundings.is_party(sides, 1).tolist() == [False, True, False, False]
    # Seen from the other roof, whose points lie to the left of the same side the other way round.
    assert surroundings.is_party(sides[1:2, ::-1], 2).tolist() == [True]


def test_parts_in_parts_are_left_out_but_not_those_in_courtyards():
    def square(x, y, half):
        ring = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)], float)
        return ring * half + (x, y)

    large, inner, court, house = square(0, 0, 10), square(5, 5, 2), square(-5, -5, 3)[::-1], square(-5, -5, 1)
    kept = without_nested([[house], [inner], [large, court]])
    assert [rings[0][0].tolist() for rings in kept] == [large[0].tolist(), house[0].tolist()]


@pytest.mark.parametrize(("other", "area"), [((20, -2, 28, 10), 376), ((8, 4, 13, 9), 280)])
def test_footprints_of_roofs_beside_and_in_each_other_do_not_overlap(rng, other, area):
    """Each roof was outlined alone: half a spacing beyond its last points, and over gaps in which others begin."""
    found = footprint(*site(rng, holes=[(19, 3, 21, 5)], other=other))
    polygons = as_polygons(found.geometries)
    one, second, shared = overlaps(polygons, polygons, Monitor())
    assert shared[one != second].max() < 1e-4
    assert sum(found.columns["area"]) == pytest.approx(area, rel=0.03)
    for rings in found.geometries:
        assert_valid(rings)
