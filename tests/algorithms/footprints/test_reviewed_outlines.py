"""Outlines that were reviewed take the place of those that are found."""

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.reasons import Reason
from lidar_buildings.algorithms.footprints.extract_footprints import extract_footprints
from lidar_buildings.algorithms.stage import LayerFeatures
from lidar_buildings.tests.builders import roof

# South-western corners of houses of 10 m by 8 m; the last one is new.
HOUSES = ((0.0, 0.0), (30.0, 0.0), (60.0, 0.0), (0.0, 30.0), (30.0, 30.0))


@pytest.fixture
def street(rng):
    """Points of all houses, and footprints of all but the last."""
    parts = [roof(rng, x, y, 10, 8, 5.0, density=10) for x, y in HOUSES]
    number = np.repeat(np.arange(len(parts)) + 1, [len(part) for part in parts])
    xyz = np.concatenate(parts)
    given = {"xyz": xyz, "classification": np.full(len(xyz), 6), "cluster_id": number}
    old = number <= 4
    footprints = extract_footprints(**{name: values[old] for name, values in given.items()})
    assert len(footprints) == 4
    return given, footprints


def reviewed(footprints, decisions, **columns):
    """Footprints as a GeoPackage gives them, with numbers from 11 on."""
    n = len(footprints)
    facts = {"fid": np.arange(1, n + 1), **footprints.columns, "id": np.arange(11, 11 + n), "review": list(decisions)}
    sources = [f"outline {number}" for number in range(n)]
    return LayerFeatures(footprints.geometries, {**facts, **columns}, sources)


def test_decided_outlines_stay_or_go_and_the_others_keep_their_numbers(street):
    given, old = street
    # The third was redrawn, as a triangle that leaves out a third of the house.
    ring = np.array([[58.0, -1], [72, -1], [58, 11], [58, -1]])
    old.geometries[2] = [ring]
    notes = ["a", "b", None, "d"]
    found = extract_footprints(**given, reviewed=reviewed(old, ["kept", "deleted", "changed", None], note=notes))
    assert found.columns["id"] == [11, 13, 14, 15]
    assert found.columns["review"] == ["kept", "changed", None, None]
    assert found.columns["note"] == ["a", None, None, None]
    assert found.columns["cluster_id"] == [1, 3, 4, 5]
    assert found.columns["area"][1] == old.columns["area"][2]
    assert found.sources == ["outline 0", "outline 2", None, None]
    assert not {"fid", "map_fid"} & set(found.columns)
    np.testing.assert_array_equal(found.geometries[0][0], old.geometries[0][0])
    np.testing.assert_array_equal(found.geometries[1][0], ring)
    # Nothing else changes by the decisions.
    np.testing.assert_array_equal(found.geometries[2][0], extract_footprints(**given).geometries[3][0])


def test_a_kept_building_stays_where_nothing_is_found(street):
    given, old = street
    found = extract_footprints(
        given["xyz"][:1], given["classification"][:1], reviewed=reviewed(old, [None, "kept", None, "deleted"])
    )
    assert found.columns["id"] == [12]
    assert found.columns["cluster_id"] == [0]
    np.testing.assert_array_equal(found.geometries[0][0], old.geometries[1][0])


def test_names_of_a_map_are_no_numbers(street):
    given, old = street
    layer = reviewed(old, ["kept", None, None, None], id=["NL.1", "NL.2", "NL.3", "NL.4"])
    found = extract_footprints(**given, reviewed=layer)
    assert found.columns["id"] == [1, 2, 3, 4, 5]
    assert found.columns["map_id"] == ["NL.1", None, None, None, None]
    missing = reviewed(old, ["kept", None, None, None], id=np.array([np.nan, 7, 8, 9]))
    assert extract_footprints(**given, reviewed=missing).columns["id"] == [10, 7, 8, 9, 11]


def test_neighbors_of_a_deleted_house_are_drawn_as_before(rng):
    """A row of three, the middle one higher: without its points the others would be no row."""
    parts = [roof(rng, x, 0, 8, 10, z, density=10) for x, z in ((0, 5.0), (8, 8.0), (16, 5.0))]
    number = np.repeat([1, 2, 3], [len(part) for part in parts])
    xyz, classes, row = np.concatenate(parts), np.full(len(number), 6), np.ones(len(number), int)
    before = extract_footprints(xyz, classes, row, xyz[:, 2])
    assert len(before) == 3
    middle = int(np.argmax(before.columns["height"]))
    decisions = ["deleted" if house == middle else None for house in range(3)]
    deleted = np.where(number == 2, 1, classes), row, xyz[:, 2]
    reason = np.where(number == 2, Reason.DELETED, 0)
    found = extract_footprints(xyz, *deleted, reason=reason, reviewed=reviewed(before, decisions))
    others = [rings for house, rings in enumerate(before.geometries) if house != middle]
    assert len(found) == 2
    for one, other in zip(found.geometries, others):
        np.testing.assert_array_equal(one[0], other[0])
    assert len(extract_footprints(xyz, *deleted, reason=reason)) == 2
