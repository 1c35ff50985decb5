"""Validity of solids by the rules of ISO 19107, literally and slowly, for all tests of models."""

import itertools
import json
import sys

import numpy as np

PLANAR = 0.01

# The Python 3.9 that "make test-pythons" takes has an older C library than wheels of PySFCGAL need.
WITH_SFCGAL = sys.version_info >= (3, 10)

# A cube of 1 m, and its sides seen from outside.
CUBE = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
SIDES = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]]


def assert_valid_solid(vertices, faces):
    """Fail unless faces (lists of open rings of vertex numbers) are one closed, oriented, plane two-manifold."""
    vertices = np.asarray(vertices, float)
    assert_edges_are_shared(faces)
    assert_vertices_have_one_umbrella(vertices, faces)
    for rings in faces:
        assert_plane_and_simple(vertices, rings)
    assert signed_volume(vertices, faces) > 0, "the faces look inward"
    assert_no_crossing(vertices, faces)
    if WITH_SFCGAL:
        from .sfcgal_solids import assert_valid_for_sfcgal

        assert_valid_for_sfcgal(vertices, faces)


def edges_of(rings):
    return [edge for ring in rings for edge in zip(ring, [*ring[1:], ring[0]])]


def assert_edges_are_shared(faces):
    edges = [edge for rings in faces for edge in edges_of(rings)]
    assert len(set(edges)) == len(edges), "two faces run the same way along an edge"
    assert {(b, a) for a, b in edges} == set(edges), "the surface is open"


def assert_vertices_have_one_umbrella(vertices, faces):
    """The faces around each vertex follow each other in one ring."""
    following = {}
    for rings in faces:
        for here, sectors in sectors_of(vertices, rings).items():
            following.setdefault(here, {}).update(sectors)
    for here, ways in following.items():
        start = next(iter(ways))
        count, way = 1, ways[start]
        while way != start and count <= len(ways):
            way, count = ways[way], count + 1
        assert count == len(ways), f"faces touch in vertex {here} only"


def sectors_of(vertices, rings):
    """Return for each vertex of a face the ends of the edges that bound it there, counterclockwise from the next one.

    Where two rings touch in a vertex, or a ring comes twice, the face has two sectors there; each goes from the next
    vertex of one passage counterclockwise to the nearest vertex before, which may be of the other passage.
    """
    passages = {}
    for ring in rings:
        for before, here, after in zip([ring[-1], *ring], ring, [*ring[1:], ring[0]]):
            passages.setdefault(here, []).append((after, before))
    normal = sum(newell(vertices[ring]) for ring in rings)
    axis = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    axes = np.column_stack(
        [axis / np.linalg.norm(axis), np.cross(normal, axis) / np.linalg.norm(np.cross(normal, axis))]
    )
    found = {}
    for here, ends in passages.items():
        if len(ends) == 1:
            found[here] = dict(ends)
            continue
        angle = {v: np.arctan2(*((vertices[v] - vertices[here]) @ axes)[::-1]) for pair in ends for v in pair}
        found[here] = {
            after: min((before for _, before in ends), key=lambda before: (angle[before] - angle[after]) % (2 * np.pi))
            for after, _ in ends
        }
    return found


def newell(corners):
    offset = corners - corners[0]
    return 0.5 * np.cross(offset, np.roll(offset, -1, axis=0)).sum(axis=0)


def assert_plane_and_simple(vertices, rings):
    normal = sum(newell(vertices[ring]) for ring in rings)
    area = np.linalg.norm(normal)
    assert area > 0, "a face has no area"
    normal = normal / area
    corners = vertices[[v for ring in rings for v in ring]]
    off = (corners - corners.mean(axis=0)) @ normal
    assert np.abs(off).max() <= PLANAR, f"a face is {np.abs(off).max():.3f} m off its plane"
    assert newell(vertices[rings[0]]) @ normal > 0, "the exterior runs the wrong way"
    assert all(newell(vertices[ring]) @ normal < 0 for ring in rings[1:]), "a hole runs the wrong way"
    plan = in_plane(vertices, normal)
    for (a, b), (c, d) in itertools.combinations(edges_of(rings), 2):
        if not {a, b} & {c, d}:
            assert not strictly_cross(plan[a], plan[b], plan[c], plan[d]), "edges of a face cross"


def in_plane(vertices, normal):
    axis = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    axis = axis / np.linalg.norm(axis)
    return vertices @ np.column_stack([axis, np.cross(normal, axis)])


def turn(o, a, b):
    return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])


def strictly_cross(a, b, c, d):
    return turn(a, b, c) * turn(a, b, d) < -1e-9 and turn(c, d, a) * turn(c, d, b) < -1e-9


def signed_volume(vertices, faces):
    start = vertices.mean(axis=0)
    total = 0.0
    for rings in faces:
        for ring in rings:
            corners = vertices[ring] - start
            total += sum(np.dot(corners[0], np.cross(b, c)) for b, c in zip(corners[1:-1], corners[2:]))
    return total / 6


def assert_no_crossing(vertices, faces):
    """No edge runs through the inside of a face that it does not touch."""
    low = np.array([vertices[[v for ring in rings for v in ring]].min(axis=0) for rings in faces]) - 1e-6
    high = np.array([vertices[[v for ring in rings for v in ring]].max(axis=0) for rings in faces]) + 1e-6
    edges = np.array(sorted({tuple(sorted(edge)) for rings in faces for edge in edges_of(rings)}))
    one, two = vertices[edges[:, 0]], vertices[edges[:, 1]]
    for rings, lowest, highest in zip(faces, low, high):
        normal = sum(newell(vertices[ring]) for ring in rings)
        normal = normal / np.linalg.norm(normal)
        center = vertices[rings[0]].mean(axis=0)
        from_one, from_two = (one - center) @ normal, (two - center) @ normal
        near = (np.minimum(one, two) <= highest).all(axis=1) & (np.maximum(one, two) >= lowest).all(axis=1)
        through = near & (from_one * from_two < 0) & (np.minimum(abs(from_one), abs(from_two)) > 2 * PLANAR)
        plan = in_plane(vertices, normal)
        for a, b in edges[through]:
            share = ((center - vertices[a]) @ normal) / ((vertices[b] - vertices[a]) @ normal)
            place = plan[a] + share * (plan[b] - plan[a])
            assert not deep_inside(place, [plan[ring] for ring in rings]), "an edge runs through a face"


def deep_inside(place, rings):
    """Whether a place is inside of rings by more than the tolerance."""
    odd = False
    for ring in rings:
        for a, b in zip(ring, np.roll(ring, -1, axis=0)):
            step = b - a
            share = np.clip((place - a) @ step / max(step @ step, 1e-12), 0, 1)
            if np.linalg.norm(place - a - share * step) < 2 * PLANAR:
                return False
            if (a[1] > place[1]) != (b[1] > place[1]):
                odd ^= bool(place[0] < a[0] + (place[1] - a[1]) * (b[0] - a[0]) / (b[1] - a[1]))
    return odd


# Surfaces that only these levels of detail may have.
OPENINGS = ("Window", "Door")
OF_LEVELS = {"2.3": ("OuterCeilingSurface",), "3": OPENINGS}


def assert_valid_cityjson(text):
    """Fail unless a text has the structure of CityJSON 2.0 and its solids are valid; return it."""
    whole = json.loads(text)
    assert (whole["type"], whole["version"]) == ("CityJSON", "2.0")
    assert {"type", "version", "transform", "CityObjects", "vertices"} <= set(whole)
    assert len(whole["transform"]["scale"]) == len(whole["transform"]["translate"]) == 3
    assert_valid_objects(whole["CityObjects"], whole["vertices"], whole["transform"])
    return whole


def assert_valid_sequence(text):
    """The same of CityJSONSeq; return its lines."""
    head, *features = [json.loads(line) for line in text.splitlines()]
    assert (head["type"], head["version"], head["CityObjects"], head["vertices"]) == ("CityJSON", "2.0", {}, [])
    for feature in features:
        assert feature["type"] == "CityJSONFeature"
        assert feature["id"] in feature["CityObjects"]
        assert not {"transform", "version"} & set(feature)
        assert_valid_objects(feature["CityObjects"], feature["vertices"], head["transform"])
    return [head, *features]


def assert_valid_objects(objects, vertices, transform):
    assert all(isinstance(number, int) for vertex in vertices for number in vertex)
    assert len({tuple(vertex) for vertex in vertices}) == len(vertices), "a vertex is there twice"
    # Near the origin: volumes of products of large coordinates lose their digits.
    places = np.array(vertices, float).reshape(-1, 3) * transform["scale"]
    used = set()
    for thing in objects.values():
        if thing["type"] == "TINRelief":
            used |= {v for geometry in thing["geometry"] for (ring,) in geometry["boundaries"] for v in ring}
            continue
        assert thing["type"] == "Building"
        for geometry in thing["geometry"]:
            assert geometry["lod"] in ("1.2", "1.3", "2.0", "2.2", "2.3", "3")
            for shell, values in shells_of(geometry):
                used |= {v for rings in shell for ring in rings for v in ring}
                surfaces = geometry["semantics"]["surfaces"]
                assert len(values) == len(shell)
                kinds = {surfaces[value]["type"] for value in values}
                assert {"RoofSurface", "WallSurface", "GroundSurface"} <= kinds
                assert kinds <= {"RoofSurface", "WallSurface", "GroundSurface", *OF_LEVELS.get(geometry["lod"], ())}
                assert_openings_are_of_walls(surfaces)
                assert_valid_solid(places, shell)
    assert used == set(range(len(vertices))), "vertices are unused or absent"


def assert_openings_are_of_walls(surfaces):
    """Fail unless each window and door has a wall as its parent, which has it among its children."""
    for number, surface in enumerate(surfaces):
        if surface["type"] in OPENINGS:
            parent = surfaces[surface["parent"]]
            assert parent["type"] == "WallSurface"
            assert number in parent["children"]
        assert all(surfaces[child]["parent"] == number for child in surface.get("children", []))


def shells_of(geometry):
    """Return the exterior shells of a geometry, each with the numbers of its surfaces' semantics."""
    solids, values = geometry["boundaries"], geometry["semantics"]["values"]
    if geometry["type"] == "Solid":
        solids, values = [solids], [values]
    else:
        assert geometry["type"] == "MultiSolid"
    assert all(len(solid) == 1 for solid in solids), "a solid has an inner shell"
    return [(solid[0], value[0]) for solid, value in zip(solids, values)]
