"""A triangulated surface in plan, with the location of points on it."""

from typing import Callable, Optional

import numpy as np

from ..criteria import ROUNDING
from ..packages import spatial
from ..stage import Monitor
from ..threads import ROWS_AT_ONCE, in_chunks
from .delaunay import Triangulation, circles, triangulate
from .grid import plan_box
from .raster_filling import nearest_known
from .scattered import scattered

# Points that a plane needs.
PLANE_POINTS = 3

# Far more steps than a walk from the nearest node takes.
_MAX_STEPS = 1000

# Far corners around the nodes of a surface, which come before these.
CORNERS = 4


class Tin:
    """Delaunay triangulation of ``nodes`` in plan, defined everywhere.

    Four far corners, each as high as the node nearest to it, surround the nodes, so that every
    point lies in a facet; ``is_extrapolated`` marks the facets with such a corner.

    Parameters
    ----------
    nodes : ndarray of shape (m, 3), float64
        Nodes (m), m >= 1; of nodes at one position in plan, one counts.
    box : ndarray of shape (2, 2), float64, optional
        Least and greatest easting and northing (m) that the far corners surround; the nodes' when absent.
    monitor : Monitor, optional
        Receives progress.

    Attributes
    ----------
    nodes : ndarray of shape (4 + m, 3), float64
        Corners and nodes (m), from the shift.
    shift : ndarray of shape (3,), float64
        The middle of the box, at elevation 0 (m).
    reach : float
        How far (m) the corners lie from there to the east, west, north and south.
    """

    def __init__(self, nodes: np.ndarray, box: Optional[np.ndarray] = None, monitor: Optional[Monitor] = None) -> None:
        box = plan_box(nodes) if box is None else box
        # Squares of coordinates keep their digits where these are small.
        self.shift = np.append(box.mean(axis=0), 0.0)
        # Far enough that their facets hardly cut into the hull of the nodes, also where the box is a single position.
        self.reach = reach = 3 * float((box[1] - box[0]).max()) + 10.0
        corners = np.array([[-reach, -reach], [reach, -reach], [reach, reach], [-reach, reach]])
        nodes = nodes - self.shift
        nearest = [np.argmin(np.linalg.norm(nodes[:, :2] - corner, axis=1)) for corner in corners]
        self.nodes = np.vstack([np.column_stack([corners, nodes[nearest, 2]]), nodes])
        self._take(triangulate(self.nodes[:, :2], monitor))

    def add(self, points: np.ndarray, facet: np.ndarray, joining: np.ndarray) -> np.ndarray:
        """Let some of the points join the nodes.

        Parameters
        ----------
        points : ndarray of shape (n, 3), float64
            Points (m), those that join within the box.
        facet : ndarray of shape (n,), int32
            The facet under each point.
        joining : ndarray of shape (m,), int64
            Indices of the points that join.

        Returns
        -------
        ndarray of shape (n,), int32
            The facet that is under each point then.
        """
        new = points[joining] - self.shift
        mesh, became = self._mesh.with_positions(new[:, :2], facet[joining])
        corner = self.facets[:, 0]
        self.nodes = np.vstack([self.nodes, new])
        self._take(mesh)
        new_facet = became[facet]
        gone = np.flatnonzero(new_facet < 0)
        new_facet[gone] = self.locate_near(points[gone], corner[facet[gone]])
        return new_facet

    def _take(self, mesh: Triangulation) -> None:
        """Take the facets of a triangulation of the nodes, and derive the rest from them."""
        self._mesh = mesh
        self._weights, self._planes = self._barycentric(), self._gradients()
        # One facet per node; -1 for duplicates.
        self._at_node = np.full(len(self.nodes), -1, np.int32)
        self._at_node[self.facets] = np.arange(len(self.facets))[:, None]

    @property
    def facets(self) -> np.ndarray:
        """Node numbers (f, 3) of the facets."""
        return self._mesh.facets

    def is_extrapolated(self) -> np.ndarray:
        """Return for each facet (f,) whether it lies outside the hull of the nodes."""
        return (self.facets < CORNERS).any(axis=1)

    def locate(self, xyz: np.ndarray, monitor: Optional[Monitor] = None) -> np.ndarray:
        """Return the facet (n,), int32, under each point.

        Each point starts at a facet of a node near it and walks from there, all points of a
        chunk together: a step or two for nearly all of them. Beyond the far corners the facet
        is the one at the nearest position between them.
        """
        used = CORNERS + np.flatnonzero(self._at_node[CORNERS:] >= 0)
        near = _NodeRaster(self.nodes[used, :2])
        return self._located(xyz, lambda rows, plan: used[near.at(plan)], monitor or Monitor())

    def locate_near(self, xyz: np.ndarray, node: np.ndarray) -> np.ndarray:
        """Return the facet (n,), int32, under each point, for points that are near a node (n,) known by number."""
        return self._located(xyz, lambda rows, plan: node[rows], Monitor())

    def _located(
        self, xyz: np.ndarray, node: Callable[[np.ndarray, np.ndarray], np.ndarray], monitor: Monitor
    ) -> np.ndarray:
        """Return the facets under points; ``node`` returns the nodes from which points start, by rows and positions."""
        found = np.empty(len(xyz), np.int32)

        def walk(rows: np.ndarray) -> None:
            # Within the far corners, by more than rounding.
            plan = np.clip(xyz[rows, :2] - self.shift[:2], -0.99 * self.reach, 0.99 * self.reach)
            found[rows] = self._walk(plan, self._at_node[node(rows, plan)])

        in_chunks(walk, np.arange(len(xyz)), ROWS_AT_ONCE, monitor)
        return found

    def _walk(self, plan: np.ndarray, facet: np.ndarray) -> np.ndarray:
        """Return the facets (n,) under positions (n, 2), m from the shift; the walks begin at ``facet`` (n,)."""
        walking = np.arange(len(plan))
        for _ in range(_MAX_STEPS):
            across = self._leaving(plan[walking], facet[walking])
            outside = across >= 0
            walking, across = walking[outside], across[outside]
            if not len(walking):
                return facet
            facet[walking] = self._mesh.neighbors[facet[walking], across]
        # Facets of nearly collinear nodes can make a walk go in circles; then take the facet that the point is outside
        # of least.
        for row in walking:
            facet[row] = np.nanargmax(self._weights_of(plan[row], np.arange(len(self.facets))).min(axis=0))
        return facet

    def _leaving(self, plan: np.ndarray, facet: np.ndarray) -> np.ndarray:
        """Return the side (0-2) by which each point lies outside its facet most, -1 where it lies inside."""
        weights = self._weights_of(plan, facet)
        side = np.argmin(weights, axis=0)
        least = np.take_along_axis(weights, side[None], axis=0)[0]
        return np.where(least < -ROUNDING, side, -1)

    def _weights_of(self, plan: np.ndarray, facet: np.ndarray) -> np.ndarray:
        """Return the weights (3, n) of the corners of facets at positions, negative beyond the side across from one."""
        to_weights = self._weights[facet]
        offset = plan - to_weights[:, 4:]
        first = to_weights[:, 0] * offset[:, 0] + to_weights[:, 1] * offset[:, 1]
        second = to_weights[:, 2] * offset[:, 0] + to_weights[:, 3] * offset[:, 1]
        return np.stack([first, second, 1 - first - second])

    def _barycentric(self) -> np.ndarray:
        """Return the maps from plan coordinates to weights of a facet's first two nodes (f, 6): 2 x 2 and origin."""
        a, b, c = np.swapaxes(self.nodes[self.facets, :2], 0, 1)
        u, v = a - c, b - c
        area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
        # Facets of collinear nodes have no inside: NaN never lies outside either, and Qhull's neighbors end the walk.
        scale = np.divide(1.0, area, out=np.full(len(area), np.nan), where=area != 0)
        return np.column_stack([v[:, 1] * scale, -v[:, 0] * scale, -u[:, 1] * scale, u[:, 0] * scale, c])

    def elevation(self, xyz: np.ndarray, facet: np.ndarray) -> np.ndarray:
        """Return the surface's elevation (n,) at points that lie in ``facet`` (n,)."""
        slope, level = self._planes
        east, north = slope.take(facet, axis=0).T
        x, y = (xyz[:, axis] - self.shift[axis] for axis in (0, 1))
        return (east * x + north * y) + level.take(facet)

    def slope_cosine(self) -> np.ndarray:
        """Return the cosine (f,) of each facet's slope, 1 where it is level."""
        slope, _ = self._planes
        return 1.0 / np.sqrt(1.0 + np.einsum("ij,ij->i", slope, slope))

    def longest_edge(self) -> np.ndarray:
        """Return the longest edge (f,) of each facet in plan, m."""
        corners = self.nodes[self.facets, :2]
        return np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)

    def circles(self, facets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return center (f, 2), from the shift, and radius (f,) of the circles through the nodes of some facets, m.

        No node lies inside of them. Where the nodes lie on a line, neither is finite.
        """
        return circles(self.nodes[:, :2], self.facets[facets])

    def _gradients(self) -> tuple[np.ndarray, np.ndarray]:
        """Return gradient (f, 2) and level at the shifted origin (f,) of each facet."""
        a, b, c = np.swapaxes(self.nodes[self.facets], 0, 1)
        (ux, uy, uz), (vx, vy, vz) = (b - a).T, (c - a).T
        area = ux * vy - uy * vx
        # Facets of collinear nodes have no gradient; Qhull keeps them only at rounding's edge.
        safe = np.where(np.abs(area) > 0, area, np.inf)
        slope = np.column_stack([(uz * vy - vz * uy) / safe, (ux * vz - vx * uz) / safe])
        return slope, a[:, 2] - np.einsum("ij,ij->i", slope, a[:, :2])


class _NodeRaster:
    """A raster with a node near each cell, for walks: faster than the nearest node from a tree, and as good a start.

    Parameters
    ----------
    plan : ndarray of shape (m, 2), float64
        Nodes, m >= 1.
    """

    def __init__(self, plan: np.ndarray) -> None:
        self._low, high = plan.min(axis=0), plan.max(axis=0)
        extent = high - self._low
        # Two cells for each node. Nodes on a line have no area; their raster has a cell for each of them along it.
        size = 0.7 * float(np.sqrt(extent.prod() / len(plan)))
        self._size = max(size, float(extent.max()) / len(plan)) or 1.0
        self._shape = (extent / self._size).astype(np.int64) + 1
        node = np.full(self._shape, -1, np.int64)
        node[tuple(self._cells(plan).T)] = np.arange(len(plan))
        self._node = nearest_known(node, node < 0)

    def at(self, plan: np.ndarray) -> np.ndarray:
        """Return a node (n,) near each position (n, 2)."""
        return self._node[tuple(self._cells(plan).T)]

    def _cells(self, plan: np.ndarray) -> np.ndarray:
        return np.clip(((plan - self._low) / self._size).astype(np.int64), 0, self._shape - 1)


def node_fits(nodes: np.ndarray, most: Optional[int] = None) -> tuple[np.ndarray, np.ndarray]:
    """Return the height of each node, or of a sample of them, above the plane of its eight nearest in plan.

    Parameters
    ----------
    nodes : ndarray of shape (m, 3), float64
        Points of a surface (m), m > 3.
    most : int, optional
        Size of the sample, about; all nodes, unless given.

    Returns
    -------
    residuals : ndarray of shape (m,), or fewer
        Heights (m): measurement noise and what the surface bends within its own spacing.
    nearest : ndarray of shape (m,), or fewer
        Distance (m) of each to its nearest neighbor.
    """
    tree = spatial.cKDTree(nodes[:, :2])
    # Sample by square decimeters, so that the choice depends neither on the order of nodes nor on the others.
    number = scattered(np.floor(10.0 * nodes[:, :2]).astype(np.int64))
    taken = np.flatnonzero(number <= max(1.0 / max(1, len(nodes) // (most or len(nodes))), number.min()))
    residuals, nearest = np.empty((2, len(taken)))

    def fit(sample: np.ndarray) -> None:
        rows = taken[sample]
        apart, neighbors = (found[:, 1:] for found in tree.query(nodes[rows, :2], k=min(8, len(nodes) - 1) + 1))
        design = nodes[neighbors] - nodes[rows, None]
        heights = design[..., 2].copy()
        # The plane through offsets is slope . (x, y) + level.
        design[..., 2] = 1.0
        # A small term on the diagonal keeps the equations of collinear neighbors solvable.
        normal = np.swapaxes(design, 1, 2) @ design + 1e-6 * np.eye(3)
        right = np.swapaxes(design, 1, 2) @ heights[..., None]
        residuals[sample], nearest[sample] = -np.linalg.solve(normal, right)[:, 2, 0], apart[:, 0]

    in_chunks(fit, np.arange(len(residuals)), ROWS_AT_ONCE, Monitor())
    return residuals, nearest


def robust_deviation(residuals: np.ndarray, floor: float = 0.01) -> float:
    """Return the standard deviation that follows from the median of absolute residuals, at least ``floor``.

    All are in one unit, m unless the floor is given.
    """
    # The standard deviation of normally distributed residuals is 1.4826 times the median of their absolute values.
    return max(1.4826 * float(np.median(np.abs(residuals))), floor)
