"""Parts of roofs with a fault get another plane, and the rest of the roof stays."""

import numpy as np
import pytest

from lidar_buildings.algorithms.geometry.rings import signed_area
from lidar_buildings.algorithms.models3d import mending
from lidar_buildings.algorithms.models3d.mending import mended
from lidar_buildings.algorithms.models3d.roof_limits import HeightsAround
from lidar_buildings.algorithms.models3d.roof_partition import Partition, empty_partition
from lidar_buildings.algorithms.models3d.roof_planes import RoofPlanes, find_roof_planes, with_level_patches
from lidar_buildings.algorithms.models3d.solid_faults import fault_of, faults_of
from lidar_buildings.algorithms.models3d.solids import ROOF

RING = np.array([[0, 0], [12, 0], [12, 8], [0, 8], [0, 0]], float)


def partition(xyz, cuts, planes, label_of):
    """Return a footprint of 12 m by 8 m, cut at eastings, with planes by the middle of each strip."""
    cells, _ = empty_partition([RING], xyz[:, :2])
    for x in cuts:
        cells.cut(np.array([x, -1.0]), np.array([x, 9.0]))
    centers = cells.centers()
    inside = (centers > 0).all(axis=1) & (centers < [12, 8]).all(axis=1)
    label = np.array([label_of(x) if is_in else -1 for (x, _), is_in in zip(centers, inside)])
    return Partition(cells, label, np.array(planes, float), np.zeros((len(cells), len(planes))))


def level_points(height=6.0):
    xy = np.random.default_rng(0).uniform((0, 0), (12, 8), (1200, 2))
    return np.column_stack([xy, np.full(len(xy), height)])


def heights_of(solids):
    return np.unique(
        np.round([s.vertices[v, 2] for s in solids for f, k in zip(s.faces, s.kinds) if k == ROOF for v in f[0]], 2)
    )


def test_a_cell_far_above_its_points_takes_the_plane_of_a_neighbor():
    xyz = level_points()
    parts = partition(xyz, [8.0], [[0, 0, 6.0], [0.5, 0, 6.0]], lambda x: int(x > 8))
    solids, why = mended(parts, 0.0, xyz, HeightsAround(xyz), 70.0)
    assert why == ""
    assert heights_of(solids).tolist() == [6.0]


def test_what_lies_around_a_corner_far_above_its_points_is_cut_off():
    """The plane is right but for a corner, over which the points lie 5 m lower: the rest of the cell keeps it."""
    xyz = level_points()
    is_low = (xyz[:, 0] > 9.5) & (xyz[:, 1] > 5.5)
    xyz[:, 2] = np.where(is_low, 6.0, 6.0 + 0.5 * xyz[:, 0])
    parts = partition(xyz, [], [[0.5, 0, 6.0]], lambda x: 0)
    solids, why = mended(parts, 0.0, xyz, HeightsAround(xyz), 70.0)
    assert why == ""
    corners = np.concatenate([solid.vertices for solid in solids])
    at_corner = corners[(corners[:, :2] > [11.9, 7.9]).all(axis=1)]
    assert at_corner[:, 2].max() <= 6.5
    assert corners[:, 2].max() == pytest.approx(12.0)
    assert parts.cells.areas()[parts.label == 0].sum() > 90


def test_a_corner_of_narrow_cells_is_lowered():
    """A piece of the cell of 0.3 m at the corner joins its neighbor again: the corner must not stay high by that."""
    xyz = level_points()
    is_low = (xyz[:, 0] > 10.9) & (xyz[:, 1] > 6.4)
    xyz[:, 2] = np.where(is_low, 11.0, 6.0 + 0.5 * xyz[:, 0])
    parts = partition(xyz, [11.7], [[0.5, 0, 6.0]], lambda x: 0)
    solids, why = mended(parts, 0.0, xyz, HeightsAround(xyz), 70.0)
    assert why == ""
    corners = np.concatenate([solid.vertices for solid in solids])
    assert corners[(corners[:, :2] > [11.9, 7.9]).all(axis=1), 2].max() < 11.96
    assert parts.cells.areas()[parts.label == 0].sum() > 90


def test_cuts_go_on_until_no_corner_is_high():
    """The points lie below the plane over 5 m: the corners of the first cut are too high as well."""
    xyz = level_points()
    is_low = xyz[:, 0] > 7.0
    xyz[:, 2] = np.where(is_low, 6.0, 6.0 + 0.5 * xyz[:, 0])
    parts = partition(xyz, [], [[0.5, 0, 6.0]], lambda x: 0)
    limits = HeightsAround(xyz)
    solids, why = mended(parts, 0.0, xyz, limits, 70.0)
    assert why == ""
    roofs = np.concatenate([s.vertices[f[0]] for s in solids for f, k in zip(s.faces, s.kinds) if k == ROOF])
    assert (roofs[:, 2] <= limits.highest(roofs[:, :2]) + 0.01).all()


def test_a_narrow_part_stays_where_its_neighbors_would_be_too_high():
    """A strip of 0.3 m along a lower building: joined with the roof of 12 m, its end would be 6 m too high."""
    xyz = level_points()
    xyz[:, 2] = np.where(xyz[:, 0] > 8, 6.0, 12.0)
    ring = np.array([[0, 0], [12, 0], [12, 0.3], [8, 0.3], [8, 8], [0, 8], [0, 0]], float)
    cells, inside = empty_partition([ring], xyz[:, :2])
    cells.cut(np.array([9.0, -1.0]), np.array([9.0, 9.0]))
    label = np.append(np.where(inside, 0, -1), [-1] * (len(cells) - len(inside)))
    (narrow,) = np.flatnonzero((np.abs(cells.centers() - [10.5, 0.15]) < 0.1).all(axis=1))
    label[narrow] = 1
    parts = Partition(cells, label, np.array([[0, 0, 12.0], [0, 0, 6.0]]), np.zeros((len(cells), 2)))
    solids, why = mended(parts, 0.0, xyz, HeightsAround(xyz), 70.0)
    assert why == ""
    assert heights_of(solids).tolist() == [6.0, 12.0]


def test_vertices_closer_than_cuts_snap_are_one():
    """The step between two level roofs has a jog of 3 cm; the outline keeps its corners, which are 4 cm apart."""
    xyz = level_points()
    ring = np.array([[0, 0], [12, 0], [12, 8], [5, 8], [5, 8.04], [0, 8.04], [0, 0]], float)
    cells, _ = empty_partition([ring], xyz[:, :2])
    for start, end in (([6, -1], [6, 8]), ([-1, 4], [6, 4]), ([6, 4.03], [13, 4.03])):
        cells.cut(np.array(start, float), np.array(end, float), 0.001)
    inside = ((cells.centers() > 0) & (cells.centers() < [12, 8.05])).all(axis=1)
    inside &= (cells.centers()[:, 0] < 5) | (cells.centers()[:, 1] < 8)
    label = np.where(inside, (cells.centers()[:, 1] > 4.01).astype(int), -1)
    parts = Partition(cells, label, np.array([[0, 0, 6.0], [0, 0, 9.0]]), np.zeros((len(cells), 2)))
    (solid,), why = mended(parts, 0.0, xyz, None, 70.0)
    assert (why, fault_of(solid)) == ("", "")
    plan = np.unique(solid.vertices[:, :2].round(3), axis=0)
    close = np.argwhere(np.triu(np.hypot(*(plan[:, None] - plan).transpose(2, 0, 1)) < 0.05, 1))
    assert [plan[pair].tolist() for pair in close] == [[[5.0, 8.0], [5.0, 8.04]]]


def test_without_limits_it_stays():
    xyz = level_points()
    parts = partition(xyz, [8.0], [[0, 0, 6.0], [0.5, 0, 6.0]], lambda x: int(x > 8))
    solids, _ = mended(parts, 0.0, xyz, None, 70.0)
    assert heights_of(solids).max() == pytest.approx(12.0)


def test_a_narrow_strip_joins_the_neighbor_with_its_points():
    xyz = level_points()
    parts = partition(xyz, [5.0, 5.3], [[0, 0, 6.0], [0, 0, 6.1], [0, 0, 9.0]], lambda x: int(x > 5) + int(x > 5.3))
    solids, why = mended(parts, 0.0, xyz, None, 70.0)
    assert why == ""
    assert heights_of(solids).tolist() == [6.0, 9.0]


def test_a_fault_stays_where_it_is():
    """The strip in the middle reaches below the ground: its wall has no height there, and the surface was open."""
    xyz = level_points()
    planes = [[0, 0, 6.0], [-3.0, 0, 20.0], [0, 0, 6.5]]
    parts = partition(xyz, [4.0, 8.0], planes, lambda x: int(x > 4) + int(x > 8))
    solids, why = mended(parts, 0.0, xyz, None, 70.0)
    assert why == ""
    assert all(fault_of(solid) == "" for solid in solids)
    assert heights_of(solids).tolist() == [6.0, 6.5]


def test_a_part_with_a_fault_is_lowered_before_it_takes_another_plane(monkeypatch):
    """Edges touch by chance where roofs cross, and no longer 2 cm lower."""
    xyz = level_points()
    xyz[xyz[:, 0] > 8, 2] = 9.0
    found = []

    def faulty_once(solid):
        found.append(faults_of(solid))
        roofs = [face for face, kind in enumerate(solid.kinds) if kind == ROOF]
        highest = max(roofs, key=lambda face: solid.vertices[solid.faces[face][0], 2].max())
        return found[-1] if len(found) > 1 else {highest: "edges of a face touch"}

    monkeypatch.setattr(mending, "faults_of", faulty_once)
    parts = partition(xyz, [8.0], [[0, 0, 6.0], [0, 0, 9.0]], lambda x: int(x > 8))
    solids, why = mended(parts, 0.0, xyz, HeightsAround(xyz), 70.0)
    assert why == ""
    assert found == [{}, {}]
    assert heights_of(solids).tolist() == [6.0, 8.98]


def test_a_fault_costs_a_large_part_one_cell(monkeypatch):
    """A part of 64 m² and one of 32 m²: a strip of 4 m² at their border changes; all of the smaller part did."""
    xyz = level_points()
    xyz[xyz[:, 0] > 8, 2] = 9.0

    def faulty(solid):
        at_step = solid.vertices[np.isclose(solid.vertices[:, 0], 8.0) & (solid.vertices[:, 2] > 8.0)]
        roofs = [face for face, kind in enumerate(solid.kinds) if kind == ROOF]
        highest = max(roofs, key=lambda face: solid.vertices[solid.faces[face][0], 2].max())
        return {highest: "triangles of a face are not plane"} if len(at_step) else faults_of(solid)

    monkeypatch.setattr(mending, "faults_of", faulty)
    parts = partition(xyz, [8.0, 8.5], [[0, 0, 6.0], [0, 0, 9.0]], lambda x: int(x > 8))
    solids, why = mended(parts, 0.0, xyz, HeightsAround(xyz), 70.0)
    assert why == ""
    assert heights_of(solids)[0] == pytest.approx(6.0)
    assert heights_of(solids)[-1] > 8.8
    high = parts.coefficients[parts.label][:, 2] > 8.0
    assert parts.cells.areas()[high & (parts.label >= 0)].sum() == pytest.approx(28.0)


def test_planes_meet_where_they_intersect():
    """The cut lies 3 cm next to the ridge; the corner on the outline moves along it, and there is no step of 5 cm."""
    xyz = level_points()
    planes = [[0.8, 0, 2.0], [-0.8, 0, 11.6]]
    parts = partition(xyz, [6.03], planes, lambda x: int(x > 6))
    (solid,), _ = mended(parts, 0.0, xyz, None, 70.0)
    ridge = solid.vertices[solid.vertices[:, 2] > 6]
    assert ridge[:, 0] == pytest.approx([6.0, 6.0])
    assert ridge[:, 2] == pytest.approx([6.8, 6.8])


def test_no_plane_is_steeper_than_the_limit():
    """Points choose planes after these have grown: points of a facade made a plane of 89° of a growing one of 70°."""
    rng = np.random.default_rng(2)
    y, z = rng.uniform(0, 8, 3000), rng.uniform(0, 8, 3000)
    roof = np.column_stack([rng.uniform(0, 3, 900), rng.uniform(0, 8, 900)])
    roof = np.column_stack([roof, 8 + 2.6 * roof[:, 0]])
    wall = np.column_stack([rng.normal(0, 0.02, 3000), y, z])
    for limit in (60.0, 75.0):
        planes = find_roof_planes(np.concatenate([roof, wall]), 0.15, limit, 20)
        assert np.degrees(np.arccos(planes.cosine)).max(initial=0) <= limit


def test_points_on_no_plane_form_a_level_patch():
    xyz = level_points()
    xyz[:, 2] += np.where((np.abs(xyz[:, :2] - 4) < 1).all(axis=1), 2.0, 0.0)
    label = np.where(xyz[:, 2] > 7, -1, 0)
    planes = with_level_patches(xyz, np.ones(len(xyz), bool), RoofPlanes(np.array([[0, 0, 6.0]]), label), 0.3, 10)
    assert planes.coefficients[1:].tolist() == [[0, 0, 8.0]]
    assert (planes.label[label < 0] == 1).mean() > 0.9
    none = with_level_patches(xyz, np.zeros(len(xyz), bool), RoofPlanes(np.array([[0, 0, 6.0]]), label), 0.3, 10)
    assert len(none) == 1


def test_a_wedge_at_the_edge_of_the_rectangle_stays_outside():
    """A narrow cell next to the footprint that reached the rectangle took the state of its neighbor inside."""
    ring = np.array([[0, 0], [12, 0], [12, 8], [6, 8.012], [0, 8], [0, 0]], float)
    for turn in np.deg2rad(np.arange(0, 90, 7)):
        turned = ring @ [[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]]
        cells, inside = empty_partition([turned], np.zeros((0, 2)))
        assert not (inside & cells.is_on_rim()).any()
        assert cells.areas()[inside].sum() == pytest.approx(96.07, abs=0.1)


@pytest.mark.parametrize("turn", [0, 25, 70])
@pytest.mark.parametrize(
    "side",
    [
        [[0, 0], [4.326, -0.027], [4.2889, -0.0822], [4.5058, -0.2285], [4.5058, -0.027], [12, 0.0004]],
        [[0, 0], [5.3903, -0.0273], [5.4284, -0.2756], [5.5561, -0.2695], [5.5561, -0.0275], [12, -0.0017]],
    ],
)
def test_halves_of_a_side_nearly_in_line_leave_no_slit(side, turn):
    """Halves of a side a third of a degree apart, parted by a chimney: their lines cut a slit whose sides touch."""
    angle = np.deg2rad(turn)
    turned = [[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]
    ring = np.array([*side, [12, 8], [0, 8], [0, 0]]) @ turned
    cells, inside = empty_partition([ring], np.zeros((0, 2)))
    partition = Partition(cells, np.where(inside, 0, -1), np.array([[0, 0, 5.0]]), np.zeros((len(cells), 1)))
    solids, why = mended(partition, 0.0, np.zeros((0, 3)), None, 70.0)
    assert why == ""
    assert [fault_of(solid) for solid in solids] == [""]
    # Slits and corners nearer than 1 cm are lost.
    assert solids[0].volume == pytest.approx(5 * signed_area(ring), abs=1.0)
