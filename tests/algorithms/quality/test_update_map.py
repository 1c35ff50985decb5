"""A map that is updated: towns of which it is known what has changed since the map was drawn."""

import numpy as np
import pytest

from lidar_buildings.algorithms.geometry.polygon_overlap import are_within, as_polygons, overlaps
from lidar_buildings.algorithms.geometry.rings import is_valid, polygon_area, sides_of_rings
from lidar_buildings.algorithms.quality import update_map as updating
from lidar_buildings.algorithms.quality.map_changes import (
    CHANGED,
    DOUBTFUL,
    GONE,
    HEIGHTENED,
    LOWERED,
    MOVED,
    NEW,
    UNCHANGED,
    UNSEEN,
)
from lidar_buildings.algorithms.quality.update_map import update_map
from lidar_buildings.algorithms.stage import LayerFeatures, Monitor
from lidar_buildings.tests.changed_towns import annexed, changed_town, cloud, house


def updated(old, houses, footprints=None, columns=None, **others):
    """Return the updated map by id, the buildings gone, and the report, of an old map and the true houses."""
    keys = {name: others.pop(name) for name in ("holes", "trees", "low", "high") if name in others}
    columns = columns or {"id": np.arange(len(old))}
    layer = None if footprints is None else LayerFeatures(footprints, {})
    made, gone, report = update_map(
        *cloud(houses, **keys), old_map=LayerFeatures(old, columns), footprints=layer, **others
    )
    rows = {}
    for number, (rings, key) in enumerate(zip(made.geometries, made.columns["id"])):
        rows.setdefault(key, []).append({**{name: own[number] for name, own in made.columns.items()}, "rings": rings})
    assert all(is_valid(rings) for rings in made.geometries)
    return rows, gone, report


def iou(one, other):
    first, second = as_polygons([one]), as_polygons([other])
    shared = overlaps(first, second, Monitor())[2].sum()
    return shared / (first.area[0] + second.area[0] - shared)


def test_what_is_right_stays_as_it_is_to_the_byte():
    """As read is what is written: files wind their rings in both ways, and transforming back would round."""
    old = [house(0, 0), house(0.3, 12.2)]
    rows, gone, report = updated(old, [house(0, 0), house(0, 12)], columns={"id": [7, 9], "street": ["A", None]})
    assert [(row["status"], row["street"]) for (row,) in rows.values()] == [(UNCHANGED, "A"), (UNCHANGED, None)]
    assert [row["rings"] is rings for (row,), rings in zip(rows.values(), old)] == [True, True]
    assert not len(gone)
    assert (report.values["unchanged"], report.values["new"]) == (2, 0)


def test_an_annex_is_added_to_the_old_walls():
    ((row,),) = updated([house(0.2, 0.1)], [annexed(0, 0)])[0].values()
    assert row["status"] == CHANGED
    assert row["added"] == pytest.approx(20, abs=4)
    assert row["removed"] == 0
    assert iou(row["rings"], annexed(0, 0)) > 0.93
    for corner in house(0.2, 0.1)[0][[0, 1, 3]]:
        assert (row["rings"][0] == corner).all(axis=1).any()


def test_a_part_that_was_torn_down_is_cut_off():
    ((row,),) = updated([annexed(0, 0)], [house(0, 0)])[0].values()
    assert row["status"] == CHANGED
    assert row["removed"] == pytest.approx(20, abs=4)
    assert iou(row["rings"], house(0, 0)) > 0.95


def test_a_torn_down_part_that_trees_hide_stays():
    ((row,),) = updated([annexed(0, 0)], [house(0, 0)], trees=[house(10, 1, (0, 0), (7, 0), (7, 9), (0, 9))])[
        0
    ].values()
    assert row["status"] == UNCHANGED


def test_what_has_gone_what_was_not_seen_and_what_trees_hide():
    old = [house(0, 0), house(0, 12), house(20, 0), house(20, 12)]
    rows, gone, report = updated(old, [house(0, 0)], holes=[house(20, 0)], trees=[house(20, 12)])
    assert {key: own[0]["status"] for key, own in rows.items()} == {0: UNCHANGED, 2: UNSEEN, 3: DOUBTFUL}
    assert gone.columns["id"] == [1]
    assert gone.geometries[0] is old[1]
    assert [report.values[name] for name in ("gone", "not_seen", "doubtful")] == [1, 1, 1]


@pytest.mark.parametrize(("height", "gone"), [(0.6, 1), (2.0, 0)])
def test_cars_show_that_no_roof_is_there_and_halls_without_a_class_do_not(height, gone):
    """Unclassified points cover the site of a house of the map."""
    old = [house(0, 0), house(20, 0)]
    xyz, classes = cloud([old[0]])
    inside = are_within(xyz[:, :2], sides_of_rings(old[1]))
    xyz[inside, 2], classes[inside] = height, 1
    made = update_map(xyz, classes, old_map=LayerFeatures(old, {"id": [0, 1]}))
    assert len(made[1]) == gone
    assert made[0].columns["status"] == [UNCHANGED] + [DOUBTFUL] * (1 - gone)


def test_a_house_is_gone_whose_neighbor_has_grown_over_its_edge_and_changed_where_more_of_it_is_left():
    old = [house(0, 0), house(20, 0)]
    now = [old[0], house(21, -8.5, (0, 0), (10, 0), (10, 9.5), (0, 9.5))]
    rows, gone, _ = updated(old, now, now)
    assert gone.columns["id"] == [1]
    assert [own[0]["status"] for own in rows.values()] == [UNCHANGED, NEW]
    rows, gone, _ = updated(old, [old[0], house(20, 0, (0, 0), (4, 0), (4, 8), (0, 8))])
    assert [own[0]["status"] for own in rows.values()] == [UNCHANGED, CHANGED]


def test_a_new_house_gets_an_id_and_shares_its_neighbors_wall():
    old = house(0, 0)
    rows, _, _ = updated([old], [old, house(10, 0)], [old, house(10.2, 0.2)], {"id": [4]})
    assert sorted(rows) == [4, 5]
    new = rows[5][0]
    assert (new["status"], rows[4][0]["status"]) == (NEW, UNCHANGED)
    assert {(10.0, 0.0), (10.0, 8.0)} <= {tuple(corner) for corner in new["rings"][0].tolist()}
    assert iou(new["rings"], house(10, 0)) > 0.93


def test_a_strip_along_a_wall_of_the_map_is_of_the_new_house_beyond_it():
    """The border between the roofs lies 1.2 m before the wall that both houses share, and the new one is narrower."""
    old, new = house(20, 0), house(10, 0, (0, 0), (10, 0), (10, 6), (0, 6))
    outlines = [house(10, 0, (0, 0), (8.8, 0), (8.8, 6), (0, 6)), house(18.8, 0, (0, 0), (11.2, 0), (11.2, 8), (0, 8))]
    rows, _, _ = updated([old], [old, new], outlines, {"id": [4]}, least_width=1.0)
    assert (rows[4][0]["status"], rows[5][0]["status"]) == (UNCHANGED, NEW)


@pytest.mark.parametrize(("ids", "new"), [([4.0, np.nan], 5), (["a", "b"], "new-1"), ([3, 9], 10)])
def test_new_ids_follow_those_of_the_map(ids, new):
    old = [house(0, 0), house(0, 12)]
    rows, _, _ = updated(old, [*old, house(20, 0)], columns={"id": ids})
    assert [own[0]["status"] for key, own in rows.items() if key == new] == [NEW]


def test_buildings_of_a_map_without_ids_are_numbered():
    old = [house(0, 0), house(0, 12), house(20, 12)]
    rows, gone, _ = updated(old, [old[0], old[2], house(20, 0)], columns={"street": ["A", "B", "C"]})
    assert {key: own[0]["street"] for key, own in rows.items()} == {1: "A", 3: "C", 4: None}
    assert gone.columns["id"] == [2]


def test_a_house_that_was_misdrawn_as_a_whole_is_shifted():
    true = [house(15.0 * i, 14.0 * j) for i in range(3) for j in range(3)]
    old = [[ring + [1.5, -1.0]] if number == 4 else [ring] for number, (ring,) in enumerate(true)]
    rows, _, _ = updated(old, true, low=(-10, -10), high=(60, 60))
    assert {key: own[0]["status"] for key, own in rows.items()} == {i: MOVED if i == 4 else UNCHANGED for i in range(9)}
    moved = rows[4][0]
    assert [moved["shift_east"], moved["shift_north"]] == pytest.approx([-1.5, 1.0], abs=0.1)
    assert np.abs(moved["rings"][0] - true[4][0]).max() < 0.1


def test_the_maps_own_offset_is_no_change_and_is_that_of_what_is_drawn():
    true = [house(15.0 * i, 14.0 * j) for i in range(3) for j in range(2)]
    roofs = [[_grown(ring, 0.6)] for (ring,) in [*true, house(0, 28)]]
    old = [[ring + [0.9, -0.7]] for (ring,) in true]
    rows, _, report = updated(old, roofs, roofs, low=(-10, -10), high=(60, 60))
    assert {own[0]["status"] for key, own in rows.items() if key < 6} == {UNCHANGED}
    found = [report.values[name] for name in ("map_shift_east", "map_shift_north", "overhang")]
    assert found == pytest.approx([-0.9, 0.7, 0.6], abs=0.05)
    assert np.abs(np.sort(rows[6][0]["rings"][0][:-1], axis=0) - np.sort(house(0.9, 27.3)[0][:-1], axis=0)).max() < 0.05


def _grown(ring, by):
    return np.mean(ring[:-1], axis=0) + (ring - np.mean(ring[:-1], axis=0)) * [1 + by / 5, 1 + by / 4]


def test_a_town_that_has_changed_since_a_map_with_errors_was_drawn():
    old, kinds, true = changed_town()
    columns = {"id": list(old)}
    rows, gone, _ = updated(list(old.values()), true, columns=columns, low=(-10, -10), high=(250, 140))
    status = {key: rows[key][0]["status"] if key in rows else GONE for key in old}
    wanted = {"same": UNCHANGED, "row": UNCHANGED, "annex": CHANGED, "cut": CHANGED, GONE: GONE, MOVED: MOVED}
    assert {key: one for key, one in status.items() if one != wanted[kinds[key]]} == {}
    assert sum(own[0]["status"] == NEW for own in rows.values()) == kinds.count(NEW)
    for row, *_ in rows.values():
        best = max(iou(row["rings"], rings) for rings in true)
        assert best > (0.85 if row["status"] in (UNCHANGED, MOVED) else 0.88)


def test_a_map_is_updated_square_by_square_as_at_once(monkeypatch):
    """Whoever is decided on in one square is seen by others; what is usual of the map is measured on all."""
    old, _, true = changed_town()
    given = {"columns": {"id": list(old)}, "footprints": true, "low": (-10, -10), "high": (250, 140)}
    whole, whole_gone, report = updated(list(old.values()), true, **given)
    boxes, within = [], updating.SeenPoints.of
    monkeypatch.setattr(updating, "_SIDE", 37.0)
    monkeypatch.setattr(updating, "AROUND", 12.0)
    monkeypatch.setattr(
        updating.SeenPoints, "of", lambda xyz, *args: boxes.append(np.ptp(xyz, axis=0)) or within(xyz, *args)
    )
    rows, gone, parts = updated(list(old.values()), true, **given)
    assert len(boxes) > 20
    assert np.max(boxes) < 100
    assert parts.values == report.values
    assert gone.columns["id"] == whole_gone.columns["id"]
    added = [key for key in whole if key not in old]
    assert sorted(rows) == sorted(whole)
    for key in set(whole) - set(added):
        assert [one["status"] for one in rows[key]] == [one["status"] for one in whole[key]]
        assert iou(rows[key][0]["rings"], whole[key][0]["rings"]) > 0.999
    for key in added:
        assert max(iou(rows[key][0]["rings"], whole[one][0]["rings"]) for one in added) > 0.999


def test_buildings_of_the_map_neither_overlap_nor_part_where_one_is_drawn_anew():
    old = [house(0, 0), house(10, 0), house(20, 0)]
    true = [old[0], house(10, 0, (0, 0), (10, 0), (10, 12), (0, 12)), old[2]]
    rows, _, _ = updated(old, true, true, low=(-20, -20), high=(50, 40))
    rings = [own[0]["rings"] for own in rows.values()]
    edges = as_polygons(rings)
    one, other, shared = overlaps(edges, edges, Monitor())
    assert shared[one != other].max() < 1e-6
    assert [own[0]["status"] for own in rows.values()] == [UNCHANGED, CHANGED, UNCHANGED]
    assert sum(map(polygon_area, rings)) == pytest.approx(280, abs=1)
    for corner in [(10, 0), (10, 8), (20, 0), (20, 8)]:
        assert (rings[1][0] == corner).all(axis=1).any()


def test_a_part_between_buildings_is_of_the_one_whose_walls_go_on_along_it():
    row = [house(6 * i, 0, (0, 0), (6, 0), (6, 12), (0, 12)) for i in range(3)]
    behind = house(0, 12, (0, 0), (18, 0), (18, 9), (6, 9), (6, 8), (0, 8))
    whole = house(0, 0, (0, 0), (18, 0), (18, 21), (6, 21), (6, 20), (0, 20))
    old = [row[0], house(6, 0, (0, 0), (6, 0), (6, 9), (0, 9)), row[2], behind]
    rows, _, _ = updated(old, [whole], [whole])
    assert [own[0]["status"] for own in rows.values()] == [UNCHANGED, CHANGED, UNCHANGED, UNCHANGED]
    assert iou(rows[1][0]["rings"], row[1]) > 0.99


@pytest.mark.parametrize("is_classified", [True, False])
def test_roofs_that_have_risen_or_fallen_since_an_earlier_survey(is_classified):
    houses = [house(0, 0), house(20, 0), house(0, 15), annexed(20, 15)]
    xyz, classes = cloud(houses)
    earlier = np.column_stack([xyz[:, :2], xyz[:, 2] * 0.9])
    for (rings,), height in zip((houses[1], houses[2]), (2.0, 8.0)):
        earlier[are_within(xyz[:, :2], sides_of_rings([rings])), 2] = height
    made, _, report = update_map(
        xyz,
        classes,
        reference_xyz=earlier,
        reference_classification=classes if is_classified else np.ones_like(classes),
        old_map=LayerFeatures([*houses[:3], house(20, 15)], {"id": [1, 2, 3, 4]}),
    )
    assert made.columns["status"] == [UNCHANGED, HEIGHTENED, LOWERED, CHANGED]
    assert made.columns["height_change"] == pytest.approx([0.5, 3.0, -3.0, 0.5])
    assert (report.values["heightened"], report.values["lowered"]) == (1, 1)
    assert [made.geometries[row] is houses[row] for row in range(3)] == [True] * 3


def test_points_without_ground_are_refused():
    xyz, classes = cloud([house(0, 0)])
    with pytest.raises(ValueError, match="No point is called ground"):
        update_map(xyz, np.where(classes == 2, 1, classes), old_map=LayerFeatures([house(0, 0)], {}))


def test_a_missing_identifier_is_refused():
    with pytest.raises(ValueError, match="no attribute 'key'"):
        updated([house(0, 0)], [house(0, 0)], id_field="key")


@pytest.mark.parametrize(("old", "status"), [([], [NEW]), ([house(20, 20)], [NEW])])
def test_a_map_without_any_of_the_buildings(old, status):
    rows, gone, _ = updated(old, [house(0, 0)])
    assert [own[0]["status"] for own in rows.values()] == status
    assert len(gone) == len(old)
