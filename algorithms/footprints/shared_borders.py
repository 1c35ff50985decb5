"""Polygons of buildings that touch: each border is drawn once, and both buildings have it.

The tracing is split into blocks of buildings that touch (``blocks``). Each block is drawn by the first strategy
(``draw_blocks``) that gives valid polygons. Then blocks whose outlines cross are drawn by later ones.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Callable, Optional

import numpy as np

from ..geometry.line_segments import is_valid, meet_in_corners, segments_meet
from ..stage import Monitor
from .alpha_shape import Tracing
from .block_drawing import AS_TRACED, REGULARIZED, Drawing, Strategy, draw_points
from .blocks import Block, split_blocks


@dataclass(frozen=True)
class Drawn:
    """What a block was drawn as, and the number of the strategy that did it."""

    drawing: Drawing
    strategy: int


# Draws a block, by number, by a strategy or the first later one that will do.
Draw = Callable[[int, int], Drawn]


def outline_faces(
    tracing: Tracing, tolerance: float, regularize: bool = True, monitor: Optional[Monitor] = None
) -> Drawing:
    """Return the polygons of the faces of a tracing.

    Parameters
    ----------
    tracing : Tracing
        Faces of buildings.
    tolerance : float
        Distance (m) that wiggles of a traced outline may have.
    regularize : bool
        Whether outlines are made straight, rather than drawn through what was traced.
    monitor : Monitor, optional
        Receives progress.

    Returns
    -------
    Drawing
        Valid polygons of all faces, which do not overlap. Those of one block share their borders vertex by vertex.
    """
    monitor = monitor or Monitor()
    blocks = split_blocks(tracing)
    strategies = REGULARIZED if regularize else AS_TRACED
    draw = partial(_draw_block, blocks, strategies, tolerance)
    drawn = []
    for number in range(len(blocks)):
        drawn.append(draw(number, 0))
        monitor.progress((number + 1) / len(blocks))
    drawn = separate_blocks(drawn, draw, last=len(strategies))
    rings = {face: rings for one in drawn for face, rings in one.drawing.rings.items()}
    return Drawing(rings, frozenset().union(*(one.drawing.straight for one in drawn)))


def _draw_block(
    blocks: Sequence[Block], strategies: Sequence[Strategy], tolerance: float, number: int, first: int
) -> Drawn:
    """Draw a block by the first strategy, from a given one on, that gives valid polygons, or through its points."""
    for strategy in range(first, len(strategies)):
        drawing = strategies[strategy](blocks[number], tolerance)
        if drawing is not None and _is_valid(drawing):
            return Drawn(drawing, strategy)
    return Drawn(draw_points(blocks[number]), len(strategies))


def _is_valid(drawing: Drawing) -> bool:
    """Return whether each polygon is valid, and no two meet but along what they share."""
    if not all(is_valid(rings) for rings in drawing.rings.values()):
        return False
    return len(drawing.rings) == 1 or meet_in_corners(*drawing.segments)


def separate_blocks(drawn: Sequence[Drawn], draw: Draw, last: int) -> list[Drawn]:
    """Draw blocks whose outlines cross by later strategies, until none do.

    The smaller one of two goes first. Where none of its strategies helps, the larger one runs over its points, and has
    to take its next one, and the smaller one starts over.

    Parameters
    ----------
    drawn : sequence of Drawn
        One per block.
    draw : callable
        Draws a block, given by number, from a strategy on, given by number.
    last : int
        The strategy that never runs over the points of another block.

    Returns
    -------
    list of Drawn
        In the same order; no two meet unless both are drawn by the last strategy.
    """
    drawn = list(drawn)
    boxes = np.array([one.drawing.box for one in drawn])
    # By area, as first drawn, and number.
    rank = np.argsort(np.argsort([one.drawing.area for one in drawn], kind="stable"))
    changed: Sequence[int] = range(len(drawn))
    while changed:
        following: dict[int, int] = {}
        for pair in sorted(_crossing(drawn, boxes, changed)):
            small, large = sorted(pair, key=rank.__getitem__)
            if drawn[small].strategy < last:
                following[small] = drawn[small].strategy + 1
            elif drawn[large].strategy < last:
                following.update({small: 0, large: drawn[large].strategy + 1})
        changed = sorted(following)
        for number in changed:
            drawn[number] = draw(number, following[number])
            boxes[number] = drawn[number].drawing.box
    return drawn


def _crossing(drawn: Sequence[Drawn], boxes: np.ndarray, changed: Iterable[int]) -> set[tuple[int, int]]:
    """Return the pairs of blocks, at least one of them among those that changed, whose outlines meet."""
    found: set[tuple[int, int]] = set()
    for one in changed:
        overlaps = (boxes[:, :2] <= boxes[one, 2:]).all(axis=1) & (boxes[:, 2:] >= boxes[one, :2]).all(axis=1)
        for other in np.flatnonzero(overlaps).tolist():
            pair = (min(one, other), max(one, other))
            if one == other or pair in found:
                continue
            if segments_meet(*drawn[one].drawing.segments, *drawn[other].drawing.segments):
                found.add(pair)
    return found
