"""Windows and doors of facades: as holes in their polygons, and as features with size, position and row."""

from dataclasses import replace

import numpy as np

from ..criteria import DEVIATIONS, MAJORITY, SAME_WAY
from ..geometry.rings import is_valid
from ..packages import spatial
from ..params import BOUNDARY, COMPLETE_FACADES, CORNER_DISTANCE, FACADE_GAP, FACADE_TILT
from ..sampling.density import DENSITY
from ..stage import Field, Layer, LayerFeatures, Monitor, stage, tunable
from .approaches import BEFORE
from .common_borders import with_common_borders
from .extract_facades import FACADES
from .facade_outline import Drawing, ring_area
from .facade_surfaces import Facade, facade_features, surfaces_of
from .opening_search import Opening, find_openings

# Openings whose middles differ in height by less than this share of their height are in one row.
_SAME_ROW = 0.5

# A hole ends this far (m) inside the boundary: the sill of a door lies on it.
_INSIDE = 0.01

OPENING_FIELDS = (
    Field("id", int, "Number of the opening, from 1"),
    Field("facade", int, "Number of its facade", of="facades"),
    Field("kind", str, "window or door"),
    Field("row", int, "Row on the facade, from 1 at the bottom"),
    Field("place", int, "Position in the row, from 1 at the left, seen from outside"),
    Field("width", float, "Width", "m"),
    Field("height", float, "Height", "m"),
    Field("area", float, "Area", "m²"),
    Field("from_left", float, "Distance of its left side from the left end of the facade", "m"),
    Field("sill", float, "Height of its lower side over the foot of the facade", "m"),
    Field("depth", float, "Median distance of its points behind the wall", "m"),
    Field("enclosed", float, "Share of its outline with wall next to it"),
    Field("seen", float, "Share of its area with points"),
)

PIERCED = (
    replace(FACADES, title="Facades with openings"),
    Layer("openings", "Windows and doors", "Polygon", OPENING_FIELDS, style="openings"),
)

# Positions along and up an opening at which a wall is looked for before it.
_STEPS = 8

Found = list[tuple[Facade, list[Opening]]]


@stage(
    "Facades",
    tags="window,door,opening,facade,wall,shop front,glass,mobile mapping,terrestrial,Peng",
    layers=PIERCED,
    reach=lambda tunables: max(tunables["max_depth"], BEFORE),
    cost=17.0,
)
def extract_openings(
    xyz,
    segment_id,
    *,
    max_depth: float = tunable(0.8, within="[0.05, 10] m"),
    min_size: float = tunable(0.4, within="[0.05, 10] m"),
    max_tilt: float = FACADE_TILT,
    max_gap: float = FACADE_GAP,
    corner_distance: float = CORNER_DISTANCE,
    boundary: str = BOUNDARY,
    complete: bool = COMPLETE_FACADES,
    monitor=None,
):
    """Find windows and doors, cut them out of the facades, and measure their size, position and row.

    An opening is where points lie behind the wall (frames, panes, curtains, reveals) and wall encloses them. Holes
    with nothing behind them are shadows or unknown, and no openings. A plane that fills openings of another
    facade, such as a shop front, is not drawn as a facade.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    segment_id : ndarray of shape (n,), int32
        Facades from 1, as "Extract facades" finds them; 0 if unassigned. Only steep segments are used.

    Returns
    -------
    facades : LayerFeatures
        Polygons with Z; openings are their holes.
    openings : LayerFeatures
        Polygons with Z in the planes of the facades, with the fields ``OPENING_FIELDS``.

    Other Parameters
    ----------------
    max_depth
        How far behind the wall points may belong to its openings; deeper recesses are parts of the building.
    min_size
        Least width and height of a window or door.

    Notes
    -----
    The paper states that size, position and arrangement of the elements of a facade are obtained (section 4), and not
    how. Points within three times the rms of the plane are wall; points up to the maximum depth behind it are of
    openings. Both are laid on cells of 1.2 spacings of the wall. Cells behind that lie within 0.3 m of each other with
    no wall between are one opening. It must have wall within 0.15 m along half of its outline, where the sill of a door
    does not count, and points in a tenth of its area. The share of its outline and the share of its sides along which
    the wall has an edge add up to 0.83 at least. Its sides are the edges of the wall where these lie within 0.3 m of
    the points. It is a rectangle unless the convex hull of its points fills less than three quarters of it, as of a
    triangular window. Panes with at most 0.15 m between them are one window.

    A door is 1.8 m high at least, or 1.5 m where no wall is seen above it. Ground, a landing or steps up to ``BEFORE``
    m before the wall rise to within 0.4 m of its sill, with no wall seen further down. Where nothing is seen before the
    wall, its foot is taken for the ground. Openings that two walls share are drawn in the one that encloses them more.
    An opening that another wall hides, up to the maximum depth before it, is not drawn.

    References
    ----------
    Peng, C., Yu, Z., 2018. Research on 3D building information extraction and image post-processing based on vehicle
    LIDAR. EURASIP Journal on Image and Video Processing 2018:121, section 4. [peng2018]

    Examples
    --------
    >>> x, z = np.mgrid[0:10:0.05, 0:6:0.05].reshape(2, -1)
    >>> wall = (abs(x - 5) > 0.5) | (abs(z - 3) > 0.7)
    >>> xyz = np.column_stack([x, np.where(wall, 0, 0.3), z])
    >>> facades, openings = extract_openings(xyz, np.where(wall, 1, 0))
    >>> len(openings), openings.columns["kind"][0]
    (1, 'window')
    """
    facades = surfaces_of(xyz, segment_id, Drawing(max_tilt, max_gap, boundary, complete), monitor.part(0, 0.5))
    if corner_distance:
        facades = with_common_borders(facades, corner_distance, monitor.part(0.5, 0.55))
    found = _searched(facades, xyz, max_depth, min_size, monitor.part(0.55, 1))
    if not facades:
        monitor.none_found("No segment is a vertical plane, so there are no facades; run 'Extract facades' first.")
    elif not any(openings for _, openings in found):
        monitor.none_found(
            "No opening was found in any facade: nothing lies behind the walls and is enclosed by them; openings need "
            "about 50 points per m² and frames or panes that are set back."
        )
    pierced = [replace(facade, holes=_holes(facade, openings)) for facade, openings in found]
    return facade_features(pierced), _features(found)


def _searched(facades: list[Facade], xyz: np.ndarray, max_depth: float, min_size: float, monitor: Monitor) -> Found:
    """Return facades with their openings, without those that fill openings of others; larger ones come first."""
    is_filling = np.zeros(len(xyz), bool)
    found: Found = []
    for done, facade in enumerate(sorted(facades, key=lambda facade: -facade.area), start=1):
        monitor.progress((done - 1) / len(facades))
        # What fills openings of others is no facade: panes, curtains, shop fronts.
        if is_filling[facade.points].mean() >= MAJORITY:
            continue
        openings = find_openings(facade, xyz, _near(facade, xyz, max(max_depth, BEFORE)), max_depth, min_size)
        for opening in openings:
            is_filling[opening.points] = True
        found.append((facade, openings))
    monitor.progress(1.0)
    return sorted(drawn_once(found, xyz, max_depth), key=lambda item: item[0].number)


def _near(facade: Facade, xyz: np.ndarray, margin: float) -> np.ndarray:
    """Return the points in the box around a facade with a margin (m) on all sides."""
    corners = facade.rings[0]
    low, high = corners.min(axis=0) - margin, corners.max(axis=0) + margin
    return np.flatnonzero(((xyz >= low) & (xyz <= high)).all(axis=1))


def _holes(facade: Facade, openings: list[Opening]) -> list[np.ndarray]:
    """Return the rings of openings, clockwise and strictly inside the facade, without those that cross it."""
    holes: list[np.ndarray] = []
    low = facade.ring[:, 1].min() + _INSIDE
    for opening in openings:
        ring = opening.ring.copy()
        if opening.kind == "door":
            ring[:, 1] = np.maximum(ring[:, 1], low)
        if is_valid([facade.ring, *holes, ring[::-1]]):
            holes.append(ring[::-1])
    return holes


def _features(found: Found) -> LayerFeatures:
    """Return the openings as features."""
    features, names = [], [field.name for field in OPENING_FIELDS[1:]]
    for facade, openings in found:
        for opening, *place in zip(openings, *(numbers.tolist() for numbers in _arrangement(openings))):
            from_left, sill = (opening.box[0] - facade.ring.min(axis=0)).tolist()
            size = (*opening.size.tolist(), ring_area(opening.ring), from_left, sill)
            facts = (facade.number, opening.kind, *place, *size, opening.depth, opening.enclosed, opening.seen)
            features.append(([facade.frame.space(opening.ring)], dict(zip(names, facts))))
    return LayerFeatures.numbered(features, OPENING_FIELDS)


def _arrangement(openings: list[Opening]) -> tuple[np.ndarray, np.ndarray]:
    """Return row from the bottom and place from the left, both from 1, of each opening."""
    count = len(openings)
    rows, positions = np.zeros(count, np.int64), np.zeros(count, np.int64)
    if not count:
        return rows, positions
    middle = np.array([opening.box[:, 1].mean() for opening in openings])
    height = np.array([opening.size[1] for opening in openings])
    order = np.argsort(middle, kind="stable")
    step = np.diff(middle[order]) > _SAME_ROW * np.minimum(height[order][1:], height[order][:-1])
    rows[order] = 1 + np.concatenate([[0], np.cumsum(step)])
    for row in np.unique(rows):
        own = np.flatnonzero(rows == row)
        positions[own[np.argsort([openings[k].box[0, 0] for k in own], kind="stable")]] = np.arange(1, len(own) + 1)
    return rows, positions


def drawn_once(found: Found, xyz: np.ndarray, max_depth: float) -> Found:
    """Return facades with their openings, without those that another wall hides or has as well.

    Of two openings that are the same the one with more wall around it is kept. Openings reach ``max_depth`` (m) behind
    their wall; ``xyz`` (n, 3), m, is the whole cloud.
    """
    walls = [_Wall(facade, xyz) for facade, _ in found]
    normals = np.array([facade.frame.normal for facade, _ in found]).reshape(-1, 3)
    candidates = [(own, opening) for own, (_, openings) in enumerate(found) for opening in openings]
    candidates.sort(key=lambda one: (-one[1].enclosed, -float(np.prod(one[1].size))))
    taken = np.zeros(len(xyz), bool)
    kept: list[list[Opening]] = [[] for _ in found]
    for own, opening in candidates:
        frame = found[own][0].frame
        ring, faces_as = frame.space(opening.ring), normals @ frame.normal >= np.cos(np.radians(SAME_WAY))
        others = [wall for k, wall in enumerate(walls) if k != own and faces_as[k]]
        # It is one of the others, seen through a second wall.
        is_drawn = taken[opening.points].mean() >= MAJORITY
        if not is_drawn and not any(wall.hides(ring, max_depth) for wall in others):
            kept[own].append(opening)
            taken[opening.points] = True
    return [
        (facade, [opening for opening in openings if any(opening is one for one in chosen)])
        for (facade, openings), chosen in zip(found, kept)
    ]


class _Wall:
    """A facade and its points in its plane."""

    def __init__(self, facade: Facade, xyz: np.ndarray) -> None:
        self.facade = facade
        self.tree = spatial.cKDTree(facade.frame.local(xyz[facade.points])[:, :2])

    def hides(self, ring: np.ndarray, max_depth: float) -> bool:
        """Return whether the wall lies before most of an opening (m, 3) of another one."""
        local = self.facade.frame.local(ring)
        if not DEVIATIONS * self.facade.rms <= -local[:, 2].mean() <= max_depth:
            return False
        low, size = local[:, :2].min(axis=0), np.ptp(local[:, :2], axis=0)
        share = (np.arange(_STEPS) + 0.5) / _STEPS
        along, up = np.meshgrid(*(low + share[:, None] * size).T)
        off = self.tree.query(np.column_stack([along.ravel(), up.ravel()]))[0]
        # A position lies on the wall where a point is no farther than points of one object are apart.
        return bool(np.mean(off <= DENSITY.link * self.facade.spacing) > MAJORITY)
