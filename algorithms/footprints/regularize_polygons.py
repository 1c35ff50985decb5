"""Polygons of any source drawn anew along the main directions of buildings: no points are needed."""

from typing import Optional

import numpy as np

from ..criteria import MICROMETER
from ..geometry.grid import plan_box
from ..geometry.kept_areas import welded, with_areas
from ..geometry.polygon_overlap import are_within, as_polygons, overlaps
from ..geometry.ring_directions import deviations
from ..geometry.rings import distances_to_rings, perimeter, polygon_area, sampled_rings, sides_of_rings
from ..rules import rule, rules
from ..stage import Field, InputLayer, Layer, LayerFeatures, Monitor, stage, tunable
from .drawn_blocks import BlockDrawing, draw_block
from .outline_pieces import OutlinePiece, blocks_of, sampled, shared_directions
from .soft_shares import LEAST_SPACING, TOLERANCE_SPACINGS, Lattice, Shares


@rules
class _RULES:
    """How the scale of outlines is measured, and how much polygons may change."""

    sample: float = rule(1.5, "scales", "distance of samples: one scale apart, rasters have a fifth more corners")
    measured: int = rule(20_000, "rings", "most that are measured: all of a country would take hours and gigabytes")
    fine: float = rule(0.1, "m", "step of the samples along which they are measured")
    piece: float = rule(4.0, "edges", "length of the pieces measured: of several edges, since one edge is straight")
    straight: float = rule(2.0, "m", "least length of these; twice as long at most, as longer ones go around corners")
    deviations: float = rule(2.5, "standard deviations", "scale across straight pieces: stairs of 1 m have 0.25 m")
    moved: float = rule(0.5, "scales", "greatest shift of all walls to restore the area: more makes another polygon")
    overlapping: float = rule(0.2, "share", "of the smaller polygon: more is a part or a storey, not a neighbor")
    finer: float = rule(0.6, "share", "of the scale at which a polygon is drawn again: half of it gives more corners")
    trials: int = rule(8, "trials", "most for a block: the last one has a thirtieth of the scale, no step of a wall")


_FIELDS = (
    Field("regularized", int, "1 drawn anew; 0 as it was, since it could not be drawn without losing area or a hole"),
    Field("moved", float, "greatest distance of its new outline from the one before", "m"),
)


@stage(
    "Buildings",
    title="Regularize footprints",
    tags="regularize,simplify,orthogonalize,right angles,square,generalize,raster,network,deep learning,segmentation,"
    "Microsoft,Google,Overture,outlines,shared borders,topology,corners",
    input_layers=(InputLayer("polygons", buildings=True),),
    layers=(Layer("regularized", "Regularized footprints", "Polygon", _FIELDS, style="regularized"),),
)
def regularize_polygons(
    polygons,
    *,
    tolerance: Optional[float] = tunable(
        None,
        within="[0.1, 20] m",
        automatic=(
            f"{TOLERANCE_SPACINGS:g} times the length of the edges, or less where walls deviate less from "
            f"straight lines, at least {TOLERANCE_SPACINGS * LEAST_SPACING:.2g} m."
        ),
    ),
    monitor=None,
):
    """Draw polygons anew along few main directions, with right angles, common borders and the same areas.

    Any polygon layer will do; no point cloud is needed. Polygons that touch share their border vertex by vertex. Holes,
    attributes and the order of the features stay, and curves stay curves. It has no twin in tiles: a border that
    neighbors share must be drawn once, for both, and a million polygons take about 10 GB of memory and 7 hours of a
    processor core; both grow with their number.

    Parameters
    ----------
    polygons : LayerFeatures
        Outlines of buildings: traced from rasters, by networks or from clouds, or drawn by hand.

    Returns
    -------
    regularized : LayerFeatures
        The new outlines in their order, with the attributes of the polygons; names that are used become ``map_…``.

    Other Parameters
    ----------------
    tolerance
        Scale of simplification: bays and steps up to about this depth are left out where they are short.

    Raises
    ------
    ValueError
        If the layer has no features.

    Notes
    -----
    Walls are found as in 'Extract footprints', by one dynamic program over all corners and directions of a ring, from
    samples along it. The main directions of a building are weighed with the buildings across a street. The
    walls of a block divide the plane into cells, and a minimum cut gives each to a polygon or to the ground, so that
    polygons do not overlap. Then whole walls are moved along their normals, by little in the sum of squares, until
    every polygon has its area again.

    A polygon that would lose a hole, cross itself, or need walls moved by more than ``_RULES.moved`` of the scale, is
    drawn again with a finer tolerance. Where that does not help either, its block stays as it is. Polygons that overlap
    by ``_RULES.overlapping`` of the smaller one are drawn apart from each other.

    References
    ----------
    Perez and Vidal (1994), Optimum polygonal approximation of digitized curves. [perez1994]
    Boykov, Veksler and Zabih (2001), Fast approximate energy minimization via graph cuts. [boykov2001]

    Examples
    --------
    >>> from lidar_buildings.algorithms.stage import LayerFeatures
    >>> x = np.repeat(np.arange(0.0, 10.5, 0.5), 2)
    >>> stairs = np.column_stack([x[:-1], x[1:] / 2])
    >>> ring = np.concatenate([stairs, [[10, 13], [0, 8]], stairs[:1]])
    >>> made = regularize_polygons(LayerFeatures([[ring]], {"key": ["a"]}))
    >>> len(ring) - 1, len(made.geometries[0][0]) - 1, made.columns["key"]
    (43, 4, ['a'])
    """
    if not len(polygons):
        raise ValueError("The layer of polygons has no features; choose another.")
    monitor.progress(0.0)
    plan = [[np.asarray(ring, float)[:, :2] for ring in rings] for rings in polygons.geometries]
    corner = plan_box(np.concatenate([ring for rings in plan for ring in rings]))[0]
    local = [[ring - corner for ring in rings] for rings in plan]
    if tolerance is None:
        tolerance = TOLERANCE_SPACINGS * _scale([ring for rings in local for ring in rings])
        monitor.resolved(tolerance=tolerance)
    made = _drawn(local, tolerance / TOLERANCE_SPACINGS, monitor)
    off = (distances_to_rings(sampled_rings(new, LEAST_SPACING), old) for new, old in zip(made, local))
    moved = [float(distance.max()) for distance in off]
    n_same = sum(new is old for new, old in zip(made, local))
    n_corners = [sum(len(ring) - 1 for rings in one for ring in rings) for one in (local, made)]
    monitor.inform(f"{len(local)} polygons had {n_corners[0]:,} corners and have {n_corners[1]:,} now.")
    if n_same:
        monitor.warn(f"{n_same} of {len(local)} polygons are as they were: they are too small for the tolerance.")
    columns = {"regularized": [int(new is not old) for new, old in zip(made, local)], "moved": moved}
    kept = polygons.kept(range(len(polygons)), _FIELDS)
    return LayerFeatures([[ring + corner for ring in rings] for rings in made], {**columns, **kept})


def _scale(rings: list) -> float:
    """Return the scale (m) of the detail along rings that is no wall: stairs of cells, noise of points."""
    length = np.sort(np.concatenate([np.hypot(*np.diff(ring, axis=0).T) for ring in rings]))
    step = float(length[np.searchsorted(np.cumsum(length), length.sum() / 2)])
    piece = float(np.clip(_RULES.piece * step, _RULES.straight, 2 * _RULES.straight))
    count = round(piece / _RULES.fine)
    long = [ring for ring in rings if perimeter(ring) >= 2 * count * _RULES.fine]
    long = long[:: 1 + len(long) // _RULES.measured]
    across = np.concatenate([np.zeros(0), *(deviations(sampled(ring, _RULES.fine), count) for ring in long)])
    noise = _RULES.deviations * float(np.median(across)) if len(across) else 0.0
    return max(LEAST_SPACING, min(step, noise))


def _drawn(polygons: list, scale: float, monitor: Monitor) -> list:
    """Redraw polygons at a scale (m); return those that can't be redrawn unchanged, as the same objects."""
    made, done, step = list(polygons), 0, _RULES.sample * scale
    samples = [[sampled(ring, step) for ring in rings] for rings in polygons]
    for layer in _layers(samples):
        directions = dict(zip(layer, shared_directions([samples[row] for row in layer])))
        for block in blocks_of([OutlinePiece(row, samples[row]) for row in layer], step):
            rows = [piece.building for piece in block]
            part = monitor.part(done / len(polygons), (done + len(rows)) / len(polygons))
            for row, rings in zip(rows, _block({row: polygons[row] for row in rows}, directions, scale, part)):
                made[row] = rings
            done += len(rows)
    return made


def _layers(samples: list) -> list[list[int]]:
    """Sort polygons, given by samples along them, into layers without clear overlaps; return their indices."""
    edges = as_polygons([[np.concatenate([ring, ring[:1]]) for ring in rings] for rings in samples])
    one, other, shared = overlaps(edges, edges, Monitor())
    is_over = (one != other) & (shared > _RULES.overlapping * np.minimum(edges.area[one], edges.area[other]))
    over: list[set[int]] = [set() for _ in samples]
    for row, neighbor in zip(one[is_over].tolist(), other[is_over].tolist()):
        over[row].add(neighbor)
    layers: list[set[int]] = []
    for row, neighbors in enumerate(over):
        free = [layer for layer in layers if layer.isdisjoint(neighbors)]
        layers += [] if free else [{row}]
        (free or layers[-1:])[0].add(row)
    return [sorted(layer) for layer in layers]


def _block(polygons: dict[int, list], directions: dict[int, np.ndarray], scale: float, monitor: Monitor) -> list:
    """Return the polygons of a block drawn at a scale (m) or a finer one where they need it, as they are if none helps.

    Polygons and main directions, °, go by their numbers.
    """
    finer = dict.fromkeys(polygons, 1.0)
    for trial in range(_RULES.trials):
        monitor.progress(trial / _RULES.trials)
        drawn, bad = _tried(polygons, directions, scale, finer)
        if not bad:
            return drawn
        finer.update({number: _RULES.finer * finer[number] for number in bad})
    return list(polygons.values())


def _tried(
    polygons: dict[int, list], directions: dict[int, np.ndarray], scale: float, finer: dict[int, float]
) -> tuple[list, list[int]]:
    """Return polygons of a block drawn at shares of a scale (m), and the numbers of those that are not sound."""
    spacing, own = _RULES.sample * scale, list(polygons.items())
    pieces = [OutlinePiece(number, [sampled(ring, spacing * finer[number]) for ring in rings]) for number, rings in own]
    shares = {number: _shares(rings, spacing) for number, rings in own}
    how = BlockDrawing(spacing, scale, scale**2, scale**2, finer=finer)
    outlined = sorted(draw_block(pieces, shares, directions, {}, how), key=lambda one: polygon_area(one.rings))
    # Of parts of one polygon the last one stays, the largest.
    found = {one.building: one.rings for one in outlined}
    drawn = [found.get(number, []) for number, _ in own]
    bad = [number for (number, rings), new in zip(own, drawn) if _is_other(new, rings, scale / finer[number])]
    if bad:
        return drawn, bad
    wanted = np.array([polygon_area(rings) for _, rings in own])
    turned = np.zeros(1)
    # Walls that end side by side leave short edges, which may turn around where walls are moved.
    while (turned < scale).all():
        # A little more than the longest of these edges, so that rounding spares none.
        drawn = welded(drawn, 1.01 * turned.max())
        # A closed ring has four vertices at least.
        lost = [number for (number, _), new in zip(own, drawn) if min(map(len, new)) < 4]
        if lost:
            return drawn, lost
        moved = with_areas(drawn, wanted)
        turned = np.array([max(map(_turned, new, rings)) for new, rings in zip(moved, drawn)])
        if not turned.any():
            break
    edges = as_polygons(moved)
    one, other, shared = overlaps(edges, edges, Monitor())
    # Areas are restored to rounding wherever they can be.
    is_bad = (turned > 0) | (np.abs(edges.area - wanted) > 0.01 * wanted)
    is_bad[one[np.abs(shared - np.where(one == other, edges.area[one], 0.0)) > MICROMETER]] = True
    return moved, [own[row][0] for row in np.flatnonzero(is_bad)]


def _turned(new: np.ndarray, old: np.ndarray) -> float:
    """Return the length (m) of the longest edge of a ring that has turned around, 0 without any."""
    way = np.diff(old, axis=0)
    is_turned = (np.diff(new, axis=0) * way).sum(axis=1) <= 0
    return float((np.hypot(*way.T) * is_turned).max(initial=0.0))


def _is_other(new: list, old: list, scale: float) -> bool:
    """Return whether a polygon or a hole was lost, or its walls would have to move too far to keep its area.

    Where it is drawn finer they may move farther, as neighbors take or leave the strip between.
    """
    far = _RULES.moved * scale * sum(map(perimeter, old))
    return len(new) != len(old) or abs(polygon_area(new) - polygon_area(old)) > far


def _shares(rings: list, spacing: float) -> Shares:
    """Return the shares of a polygon: 1 at the nodes within it."""
    lattice = Lattice.around(rings[0], spacing)
    share = are_within(lattice.positions, sides_of_rings(rings)).reshape(lattice.shape).astype(np.float32)
    return Shares(lattice, share, 1 - share)
