"""Solids and triangles of faces as SFCGAL makes and judges them, with exact arithmetic: a second opinion for tests."""

import re

import numpy as np
from pysfcgal.geometry import Geometry
from scipy.spatial import cKDTree

from .solid_validity import in_plane, newell, turn

# Triangles of a face turn by no more than this from its plane (°), the default of val3dity.
MOST_TURN = 20.0


def assert_valid_for_sfcgal(vertices, faces):
    """A second opinion, with exact arithmetic: the solid of the constrained Delaunay triangles of all faces is valid.

    The triangles turn from the planes of their faces by no more than val3dity allows.
    """
    triangles = []
    for rings in faces:
        normal = sum(newell(vertices[ring]) for ring in rings)
        of_face = triangulated(vertices, rings)
        for a, b, c in of_face:
            across = np.cross(vertices[b] - vertices[a], vertices[c] - vertices[a])
            cosine = across @ normal / (np.linalg.norm(across) * np.linalg.norm(normal))
            assert cosine > np.cos(np.deg2rad(MOST_TURN)), f"a triangle turns by {np.degrees(np.arccos(cosine)):.0f}°"
        triangles += of_face
    # Vertices are rounded where files round them, relative to a corner nearby.
    local = vertices - np.floor(vertices.min(axis=0))
    texts = [
        "((" + ",".join("{:.4f} {:.4f} {:.4f}".format(*local[v]) for v in (*ring, ring[0])) + "))" for ring in triangles
    ]
    solid = Geometry.from_wkt("SOLID Z((" + ",".join(texts) + "))")
    assert solid.is_valid(), str(solid.is_valid_detail()[0])[:200]


def triangulated(vertices, rings):
    """Return the constrained Delaunay triangles of a face in its plane, by CGAL."""
    if len(rings) == 1 and len(rings[0]) == 3:
        return [list(rings[0])]
    normal = sum(newell(vertices[ring]) for ring in rings)
    used = sorted({v for ring in rings for v in ring})
    plan = dict(zip(used, in_plane(vertices[used] - vertices[used[0]], normal / np.linalg.norm(normal))))
    texts = ["(" + ",".join("{:.9f} {:.9f}".format(*plan[v]) for v in (*ring, ring[0])) + ")" for ring in rings]
    mesh = Geometry.from_wkt("POLYGON(" + ",".join(texts) + ")").tessellate()
    tree = cKDTree(list(plan.values()))
    triangles = []
    for text in re.findall(r"\(\(([^()]*)\)\)", mesh.to_wkt(9)):
        corners = np.array([[float(value) for value in place.split()] for place in text.split(",")[:3]])
        numbers = [used[k] for k in tree.query(corners[:, :2])[1]]
        triangles.append(numbers if turn(*(plan[v] for v in numbers)) > 0 else numbers[::-1])
    return triangles
