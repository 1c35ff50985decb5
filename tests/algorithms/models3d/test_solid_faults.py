"""Solids that break one rule of val3dity each, as its documentation lists them, and valid ones next to them."""

import numpy as np
import pytest

from lidar_buildings.algorithms.models3d.solid_faults import fault_of, faults_of
from lidar_buildings.algorithms.models3d.solids import Solid
from lidar_buildings.tests.solid_validity import CUBE, SIDES


def solid(vertices, rings):
    """Return a solid of faces without holes."""
    return Solid(np.asarray(vertices, float), [[list(ring)] for ring in rings])


def cube(**changed):
    """Return a cube of 1 m with some faces changed, by number (f4=...)."""
    return solid(CUBE, [changed.get(f"f{number}", ring) for number, ring in enumerate(SIDES)])


def with_hole(hole, depth=0.5):
    """Return a cube with a pit in its top, under a ring of positions (x, y) in the order of a hole."""
    n = len(hole)
    rim, bottom = range(8, 8 + n), range(8 + n, 8 + 2 * n)
    places = [[x, y, z] for z in (1, 1 - depth) for x, y in hole]
    faces = [[list(ring)] for ring in SIDES]
    faces[1].append(list(rim))
    for k in range(n):
        j = (k + 1) % n
        faces.append([[rim[j], rim[k], bottom[k], bottom[j]]])
    faces.append([list(bottom)[::-1]])
    return Solid(np.concatenate([CUBE, places]), faces)


HOLE = [(0.2, 0.2), (0.2, 0.6), (0.6, 0.6), (0.6, 0.2)]


def pillars():
    """Return two cubes as one solid: nothing joins them."""
    return solid(np.concatenate([CUBE, CUBE + [3, 0, 0]]), [*SIDES, *([v + 8 for v in ring] for ring in SIDES)])


def in_each_other():
    """Return a cube with a small one in it, as one surface."""
    return solid(np.concatenate([CUBE, 0.2 * CUBE + 0.4]), [*SIDES, *([v + 8 for v in ring] for ring in SIDES)])


def divided_top():
    """Return a cube with a pit whose rim touches two edges of the top, which it divides."""
    vertices = np.concatenate([CUBE, [[0.5, 0, 1], [0.8, 0.5, 1], [0.5, 1, 1], [0.2, 0.5, 1], [0.5, 0.5, 0.5]]])
    top, sides = [[4, 8, 5, 7, 10, 6], [8, 11, 10, 9]], [[0, 1, 5, 8, 4], SIDES[3], [3, 2, 6, 10, 7], SIDES[5]]
    pit = [[b, a, 12] for a, b in ((8, 11), (11, 10), (10, 9), (9, 8))]
    return Solid(vertices, [[SIDES[0]], top, *([ring] for ring in [*sides, *pit])])


def hourglass():
    """Return a cube with a pyramid cut out of its top and one out of its bottom, whose tips meet in the middle."""
    pits = [[4, 5, 8], [5, 7, 8], [7, 6, 8], [6, 4, 8], [0, 2, 8], [2, 3, 8], [3, 1, 8], [1, 0, 8]]
    return solid(np.concatenate([CUBE, [[0.5, 0.5, 0.5]]]), [*SIDES[2:], *pits])


def spiked(height):
    """Return a cube whose top is a pyramid with its tip at a height; a low one comes through the bottom."""
    sides = [[4, 5, 8], [5, 7, 8], [7, 6, 8], [6, 4, 8]]
    return solid(np.concatenate([CUBE, [[0.5, 0.5, height]]]), [SIDES[0], *SIDES[2:], *sides])


def narrow(width, off):
    """Return a cube with a vertex ``width`` next to corner 7 on the top edge to 6, ``off`` above the top."""
    place = [1 - width, 1, 1 + off]
    faces = [SIDES[0], [4, 5, 7, 8, 6], *SIDES[2:4], [3, 2, 6, 8, 7], SIDES[5]]
    return solid(np.concatenate([CUBE, [place]]), faces)


def strip(up):
    """Return a wall of 10 m by 0.3 m with two vertices, 0.2 m apart, in a long top edge, one of them ``up`` higher."""
    vertices = np.concatenate([CUBE * [10, 0.3, 1], [[5.2, 0.3, 1 + up], [5.0, 0.3, 1]]])
    return solid(vertices, [SIDES[0], [4, 5, 7, 8, 9, 6], *SIDES[2:4], [3, 2, 6, 9, 8, 7], SIDES[5]])


def folded():
    """Return a cube with a flap of no thickness on its side: two faces that lie on each other."""
    vertices = np.concatenate([CUBE, [[2.0, 0.5, 0.5]]])
    faces = [[ring] for ring in SIDES]
    faces[3] = [[1, 3, 7, 5]]
    flap = [[[1, 8, 3]], [[1, 3, 8]]]
    return Solid(vertices, [*faces, *flap])


def test_valid_solids_have_no_fault():
    assert fault_of(cube()) == ""
    assert fault_of(with_hole(HOLE)) == ""
    assert fault_of(spiked(1.5)) == ""
    assert fault_of(spiked(0.5)) == ""
    assert fault_of(strip(0.0002)) == ""


@pytest.mark.parametrize(
    ("made", "fault"),
    [
        (cube(f4=[3, 2, 6, 6, 7]), "degenerate"),  # 102
        (cube(f1=[4, 7, 5, 6]), "open"),  # 104, whose edges no neighbor has
        (solid(CUBE, SIDES[:5]), "open"),  # 302
        (solid(CUBE, [*SIDES, SIDES[0]]), "more than two faces"),  # 303
        (hourglass(), "only touch in a corner"),  # 303
        (pillars(), "pieces"),  # 305
        (in_each_other(), "pieces"),  # 305
        (divided_top(), "divide"),  # 207
        (spiked(-0.5), "cross"),  # 306
        (cube(f4=SIDES[4][::-1]), "more than two faces"),  # 307
        (solid(CUBE, [ring[::-1] for ring in SIDES]), "inward"),  # 405
        (solid(CUBE[[0, 1, 2]], [[0, 1, 2], [2, 1, 0]]), "fewer than four"),  # 301
        (narrow(0.3, 0.03), "not plane"),  # 203
        (narrow(0.005, 0.002), "triangles"),  # 204
        (strip(0.005), "triangles"),  # 204, though no corner is near to another one or to an edge
        (narrow(0.0004, 0.0), "too close"),
        (with_hole([(0.2, 0.2), (0.6, 0.6), (0.2, 0.6), (0.6, 0.2)]), "cross"),  # 104 in a hole
        (with_hole([(x + 2, y) for x, y in HOLE]), "not inside"),  # 206
        (with_hole(HOLE[::-1]), "wrong way"),  # 208
        (folded(), "more than two faces"),
    ],
)
def test_a_broken_rule_is_found(made, fault):
    assert fault in fault_of(made)


def test_faces_that_lie_on_each_other_are_folded():
    """A wedge whose two sides have no angle between them: an edge of 1 m with a face to and fro."""
    flat = solid([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.2, 0.2, 0.0005]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    assert fault_of(flat) == "faces are folded"


def test_faults_are_named_by_face():
    assert set(faults_of(narrow(0.3, 0.03))) == {1}
    # Vertex 8 is off both the top and nothing else: the wall next to it is still plane.
    assert 4 not in faults_of(narrow(0.3, 0.03))


def test_a_repeated_vertex_ends_the_search():
    """Two passages of one face through a corner: going around it never came back to its start."""
    assert fault_of(cube(f0=[0, 2, 0, 3, 1])) == "a ring is degenerate"
