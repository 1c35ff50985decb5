"""Lines along which the planes of a roof may meet or end, in plan."""

from dataclasses import dataclass

import numpy as np

from ..criteria import PARALLEL
from ..geometry.delaunay import triangulate
from ..geometry.groups import members, split_groups
from ..sampling.density import DENSITY, link_distance
from .roof_planes import RoofPlanes

# Points of two planes are adjacent if a side of a triangle of at most this length joins them (spacings, or m if that is
# more).
_BESIDE_SPACINGS, _BESIDE = 6.0, 2.0

# Least number of contacts of a line.
_LEAST_CONTACTS = 3

# A line whose ends lie no farther than this (m) from another one is the same.
_SAME_OFFSET = 0.10

# Walls of at least this share of the length of the longest one give main directions.
_LONG = 0.5

# A step is located by points no farther from it than this (m), or than points of one object are apart.
_NEAR = 0.6

# Factor by which contacts count more along the main directions, and along and across the slopes of the two planes.
_PREFERENCE = 1.15


@dataclass(frozen=True)
class LinePiece:
    """A piece of a line in plan: its ends (m), and its weight, the number of its contacts."""

    start: np.ndarray
    end: np.ndarray
    weight: float


def find_roof_lines(xyz: np.ndarray, planes: RoofPlanes, rings: list, spacing: float) -> list[LinePiece]:
    """Find the lines along which planes intersect or step, sorted by the order in which they cut.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Points (m).
    planes : RoofPlanes
        Their planes.
    rings : list of ndarray of shape (k, 2)
        Closed rings of the footprint (m), whose walls give the main directions.
    spacing : float
        Mean distance between neighboring points (m).

    Returns
    -------
    list of LinePiece
        Intersections first, heaviest first; without those that lie on a heavier one.
    """
    member = np.flatnonzero(planes.label >= 0)
    if len(planes) < 2 or len(member) < 4:
        return []
    one, other, middle = _contacts(xyz[member, :2], planes.label[member], spacing)
    main = main_directions(rings)
    points = split_groups(planes.label, len(planes))
    points = [xyz[rows, :2] for rows in points]
    meeting, stepping = [], []
    for number, rows in members(one * len(planes) + other + 1).items():
        pair = divmod(number - 1, len(planes))
        border = _Border(planes, pair, middle[rows], [points[plane] for plane in pair], spacing)
        meeting += border.intersection()
        stepping += border.steps(main)
    return _without_doubles(sorted(meeting, key=lambda p: -p.weight) + sorted(stepping, key=lambda p: -p.weight))


def main_directions(rings: list) -> np.ndarray:
    """Return unit vectors (k, 2) along and across the longer walls of a footprint."""
    edge = np.concatenate([np.diff(ring, axis=0) for ring in rings])
    length = np.hypot(*edge.T)
    is_long = length >= _LONG * length.max()
    along = edge[is_long] / length[is_long, None]
    return np.concatenate([along, np.column_stack([-along[:, 1], along[:, 0]])])


def _contacts(xy: np.ndarray, label: np.ndarray, spacing: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Find pairs of neighboring points (n, 2) on different planes.

    Returns the numbers (m,), (m,) of the two planes, the smaller one first, and the middles (m, 2) of the pairs.
    """
    if np.linalg.matrix_rank(xy - xy.mean(axis=0)) < 2:
        return np.zeros(0, int), np.zeros(0, int), np.zeros((0, 2))
    mesh = triangulate(xy)
    side = np.concatenate([mesh.facets[:, [0, 1]], mesh.facets[:, [1, 2]], mesh.facets[:, [2, 0]]])
    side = np.unique(np.sort(side, axis=1), axis=0)
    side = side[label[side[:, 0]] != label[side[:, 1]]]
    length = np.hypot(*(xy[side[:, 0]] - xy[side[:, 1]]).T)
    side = side[length <= max(_BESIDE, _BESIDE_SPACINGS * spacing)]
    pair = np.sort(label[side], axis=1)
    return pair[:, 0], pair[:, 1], xy[side].mean(axis=1)


class _Border:
    """Where two planes are next to each other: positions (m, 2) between their points, and the points of both (k, 2)."""

    def __init__(
        self, planes: RoofPlanes, pair: tuple[int, int], positions: np.ndarray, points: list[np.ndarray], spacing: float
    ) -> None:
        one, other = pair
        self.points = points
        self.difference = planes.coefficients[one] - planes.coefficients[other]
        self.slopes = planes.coefficients[[one, other], :2]
        self.positions, self.spacing = positions, spacing
        self.turn = float(np.hypot(*self.difference[:2]))
        step = np.abs(positions @ self.difference[:2] + self.difference[2])
        limit = link_distance(spacing)
        self.at_line = step <= limit * self.turn if self.turn > PARALLEL else np.zeros(len(positions), bool)

    def intersection(self) -> list[LinePiece]:
        """Return the piece of the line in which the planes intersect, if they meet there."""
        if self.at_line.sum() < _LEAST_CONTACTS:
            return []
        normal = self.difference[:2] / self.turn
        position = -normal * self.difference[2] / self.turn
        return [self._piece(position, np.array([-normal[1], normal[0]]), self.positions[self.at_line])]

    def steps(self, main: np.ndarray) -> list[LinePiece]:
        """Return lines along the contacts where one plane is above the other."""
        remaining = self.positions[~self.at_line]
        directions, weight = self._directions(main)
        normals = np.column_stack([-directions[:, 1], directions[:, 0]])
        found: list[LinePiece] = []
        # Width (m) of the strip whose contacts are of one step.
        width = max(0.3, self.spacing)
        while len(remaining) >= _LEAST_CONTACTS:
            offset = normals @ remaining.T
            order = np.sort(offset, axis=1)
            # Shift the rows apart, so that all directions make one ascending array.
            apart = (np.ptp(order) + width + 1.0) * np.arange(len(order))[:, None]
            ends = np.searchsorted((order + apart).ravel(), (order + apart + width).ravel(), side="right")
            count = (ends - np.arange(order.size)).reshape(order.shape)
            best = int(np.argmax(count.max(axis=1) * weight))
            first = order[best, np.argmax(count[best])]
            chosen = (offset[best] >= first) & (offset[best] <= first + width)
            if chosen.sum() < _LEAST_CONTACTS:
                break
            direction, normal = directions[best], normals[best]
            position = normal * self._between(normal, direction, remaining[chosen])
            found.append(self._piece(position, direction, remaining[chosen]))
            remaining = remaining[~chosen]
        return found

    def _between(self, normal: np.ndarray, direction: np.ndarray, contacts: np.ndarray) -> float:
        """Return the offset (m) of the line that separates the points of both planes along contacts best."""
        middle = float(np.median(contacts @ normal))
        low, high = (contacts @ direction).min(), (contacts @ direction).max()
        near = max(_NEAR, DENSITY.link * self.spacing)
        offsets = []
        for xy in self.points:
            along, offset = xy @ direction, xy @ normal
            offsets.append(offset[(along >= low) & (along <= high) & (np.abs(offset - middle) <= near)])
        if not all(map(len, offsets)):
            return middle
        if np.median(offsets[0]) > np.median(offsets[1]):
            offsets.reverse()
        every = np.sort(np.concatenate(offsets))
        cuts = np.concatenate([[every[0]], (every[1:] + every[:-1]) / 2, [every[-1]]])
        beyond = len(offsets[0]) - np.searchsorted(np.sort(offsets[0]), cuts)
        wrong = beyond + np.searchsorted(np.sort(offsets[1]), cuts)
        best = np.flatnonzero(wrong == wrong.min())
        return float(cuts[best[np.argmin(np.abs(cuts[best] - middle))]])

    def _directions(self, main: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return directions (k, 2) that steps may have, and how much they are preferred (k,)."""
        slopes = self.slopes[np.hypot(*self.slopes.T) > PARALLEL]
        slopes = slopes / np.hypot(*slopes.T)[:, None]
        preferred = np.concatenate([main, slopes, np.column_stack([-slopes[:, 1], slopes[:, 0]])])
        fan = np.deg2rad(np.arange(0, 180, 15))
        found = np.concatenate([preferred, np.column_stack([np.cos(fan), np.sin(fan)])])
        return found, np.repeat([_PREFERENCE, 1.0], [len(preferred), len(fan)])

    def _piece(self, position: np.ndarray, direction: np.ndarray, contacts: np.ndarray) -> LinePiece:
        along = (contacts - position) @ direction
        # As far as the next contact might lie: a cell is cut from side to side anyway.
        beyond = link_distance(self.spacing)
        low, high = along.min() - beyond, along.max() + beyond
        return LinePiece(position + low * direction, position + high * direction, float(len(contacts)))


def _without_doubles(pieces: list[LinePiece]) -> list[LinePiece]:
    """Return the pieces but those that an earlier one covers."""
    if not pieces:
        return []
    start, end = np.array([one.start for one in pieces]), np.array([one.end for one in pieces])
    length = np.hypot(*(end - start).T)
    direction = (end - start) / length[:, None]
    kept: list[int] = []
    for i in range(len(pieces)):
        u = direction[kept]
        covers = np.ones(len(kept), bool)
        for position in (start[i], end[i]):
            offset = position - start[kept]
            along = np.einsum("ij,ij->i", offset, u)
            across = np.abs(u[:, 0] * offset[:, 1] - u[:, 1] * offset[:, 0])
            covers &= (
                (across <= _SAME_OFFSET) & (along >= -DENSITY.least_link) & (along <= length[kept] + DENSITY.least_link)
            )
        if not covers.any():
            kept.append(i)
    return [pieces[i] for i in kept]
