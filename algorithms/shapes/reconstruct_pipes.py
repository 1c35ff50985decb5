"""Pipes and spheres as surfaces: polygons around axes and centers, for three-dimensional views."""

from typing import Optional

import numpy as np

from ..geometry.polygons import axes_across
from ..stage import Field, InputLayer, Layer, LayerFeatures, stage, tunable

_FIELDS = (
    Field("id", int, "number of the face, from 1"),
    Field("kind", str, "pipe or sphere"),
    Field("of", int, "number of the cylinder or of the sphere"),
    Field("radius", float, "its radius", "m"),
)

# Number of sides of a drawn circle: a polygon of 16 looks round; its area is 2.5 % below the circle's.
_SIDES = 16


@stage(
    "Shapes",
    tags="pipe,tube,sphere,tank,3D,surface,view,polygon,industry",
    input_layers=(
        InputLayer("axes", "Axes of cylinders", geometry="LineString"),
        InputLayer("centers", "Centers of spheres", geometry="Point", optional=True),
    ),
    layers=(Layer("pipes", "Pipes and spheres", "Polygon", _FIELDS, style="pipes"),),
    packages=(),
)
def reconstruct_pipes(
    axes,
    centers=None,
    *,
    radius: float = tunable(0.05, label="Radius without attribute", within="[0.001, 100] m"),
    monitor=None,
):
    """Draw cylinders around their axes and spheres around their centers, as polygons in space.

    Three-dimensional views draw lines with one width for all of them. Here each pipe is a prism of ``_SIDES`` sides,
    without ends, and each sphere a solid of ``_SIDES`` by 8 faces.

    Parameters
    ----------
    axes : LayerFeatures
        Lines with heights and the attributes 'id' and 'radius'.
    centers : LayerFeatures, optional
        Points with heights and the attributes 'id' and 'radius'.

    Returns
    -------
    pipes : LayerFeatures
        The faces.

    Other Parameters
    ----------------
    radius
        Radius of lines and points that have no attribute 'radius', such as wires.

    Notes
    -----
    Lines and points without heights are drawn at height 0.

    Examples
    --------
    >>> from lidar_buildings.algorithms.stage import LayerFeatures
    >>> axis = LayerFeatures([np.array([[0, 0, 1.0], [5, 0, 1.0]])], {"radius": [0.2]})
    >>> len(reconstruct_pipes(axis))
    16
    """
    faces: list[np.ndarray] = []
    columns: dict[str, list] = {"kind": [], "of": [], "radius": []}
    for kind, layer, drawn in (("pipe", axes, _tube), ("sphere", centers, _sphere)):
        for number, geometry, own in _shapes(layer, radius):
            # A user may cancel here.
            monitor.progress(0.0)
            made = drawn(geometry, own)
            faces += made
            for name, value in (("kind", kind), ("of", number), ("radius", own)):
                columns[name] += [value] * len(made)
    return LayerFeatures([[face] for face in faces], {"id": list(range(1, len(faces) + 1)), **columns})


def _shapes(layer: Optional[LayerFeatures], radius: float) -> list[tuple[int, np.ndarray, float]]:
    """Return number, geometry (n, 3) and radius of each feature; one whose own radius is not positive is left out."""
    if layer is None:
        return []
    order = range(1, len(layer) + 1)
    ids = layer.columns.get("id", order)
    numbers = [own if isinstance(own, (int, np.integer)) else at for own, at in zip(ids, order)]
    radii = layer.columns.get("radius", [radius] * len(layer))
    found = []
    for number, geometry, own in zip(numbers, layer.geometries, radii):
        points = np.atleast_2d(np.asarray(geometry, float))
        if points.shape[1] == 2:
            points = np.column_stack([points, np.zeros(len(points))])
        if own is not None and np.isfinite(own) and own > 0:
            found.append((int(number), points, float(own)))
    return found


def _tube(axis: np.ndarray, radius: float) -> list[np.ndarray]:
    """Return the faces, closed rings (5, 3), of a prism around each part of an axis (n, 3), m."""
    faces = []
    for start, end in zip(axis[:-1], axis[1:]):
        along = end - start
        if not along.any():
            continue
        circle = _circle(along / np.linalg.norm(along), radius)
        faces += _band(start + circle, end + circle)
    return faces


def _circle(along: np.ndarray, radius: float) -> np.ndarray:
    """Return the corners (sides + 1, 3) of a closed circle across a direction, from its middle, m."""
    first, second = axes_across(along)
    angle = np.linspace(0, 2 * np.pi, _SIDES + 1)[:, None]
    return radius * (np.cos(angle) * first + np.sin(angle) * second)


def _band(first: np.ndarray, second: np.ndarray) -> list[np.ndarray]:
    """Return the faces between two closed circles (sides + 1, 3); at a pole they are triangles."""
    corners = np.stack([first[:-1], first[1:], second[1:], second[:-1]], axis=1)
    rings = []
    for face in corners:
        kept = [point for i, point in enumerate(face) if not np.allclose(point, face[i - 1])]
        rings.append(np.array([*kept, kept[0]]))
    return rings


def _sphere(center: np.ndarray, radius: float) -> list[np.ndarray]:
    """Return the faces, closed rings (4 or 5, 3), of a solid around a center (1, 3), m."""
    up = np.array([0.0, 0.0, 1.0])
    angles = np.linspace(-np.pi / 2, np.pi / 2, _SIDES // 2 + 1)
    circles = [center + radius * np.sin(a) * up + _circle(up, radius * np.cos(a)) for a in angles]
    return [face for low, high in zip(circles[:-1], circles[1:]) for face in _band(low, high)]
