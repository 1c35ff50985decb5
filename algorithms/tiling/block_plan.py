"""Size and position of the blocks of a survey."""

from typing import Optional

import numpy as np

from .blocks import Block
from .survey import Survey

# Bytes that a worker needs per point of a window: the most that was measured.
_BYTES_PER_POINT = 340

# A window has at most about this many points, so that a worker needs 1.8 GB. Two workers, one of them with a window
# that was enlarged, and the main process need less than 4 GB.
MOST_POINTS = 5_300_000

# Sides of blocks are multiples of this, m: round numbers, little below what fits.
_SIDE_STEP = 10.0

# Least and greatest side unless a cloud is dense, m; smaller blocks would work mostly on what lies around them.
_LEAST_SIDE, _MOST_SIDE = 100.0, 1600.0

# Least side in dense clouds, in reaches around a block: the block is then a seventh of its window.
_LEAST_HALOS = 1.25

# Larger blocks are advised where they save a third of the work or more.
_WORTH_SAYING = 1.5

# Fewest blocks along the longer side of a survey: with fewer, processes would wait for the last one.
_LEAST_BLOCKS = 3

# Largest number of blocks, unless their points are many: a single point far away makes the extent too large.
_MANY_BLOCKS = 10_000

# Least mean number of points of a block where there are more blocks.
_POINTS_PER_BLOCK = 100


def side_of_blocks(density: float, halo: float, most_points: float = MOST_POINTS) -> float:
    """Return the largest side of a block, m, whose window holds no more than ``most_points``, or the least side.

    Parameters
    ----------
    density : float
        Points per m².
    halo : float
        Distance around a block within which points are read, m.
    most_points : float
        Most points of a window, that is of a block with those around it.
    """
    fits = np.floor((np.sqrt(most_points / density) - 2 * halo) / _SIDE_STEP) * _SIDE_STEP
    if fits >= _LEAST_SIDE:
        return float(min(fits, _MOST_SIDE))
    least = max(np.ceil(_LEAST_HALOS * halo / _SIDE_STEP), 1.0) * _SIDE_STEP
    return float(min(max(fits, least), _LEAST_SIDE))


def points_of_window(density: float, side: float, halo: float) -> float:
    """Return the points of a block (``side``, m) and up to ``halo`` (m) around it, ``density`` of them per m²."""
    return density * (side + 2 * halo) ** 2


def memory_of(points: float) -> float:
    """Return the bytes that a worker needs for a window of ``points``."""
    return _BYTES_PER_POINT * points


def larger_blocks(density: float, side: float, halo: float, memory: float, extent: float) -> Optional[str]:
    """Return the advice to take larger blocks for which a worker has the memory; None where they save little.

    Parameters
    ----------
    density : float
        Points per m².
    side, halo : float
        Side of a block, and distance around it within which points are read, m.
    memory : float
        Bytes for a worker.
    extent : float
        Longer side of the survey, m.
    """
    larger = min(side_of_blocks(density, halo, memory / _BYTES_PER_POINT), extent / _LEAST_BLOCKS)
    now, then = ((1 + 2 * halo / one) ** 2 for one in (side, larger))
    if now < _WORTH_SAYING * then:
        return None
    needed = memory_of(points_of_window(density, larger, halo))
    return (
        f"Each point is worked on {now:.1f} times. With {larger:.0f} m as 'Side of a block' it would be {then:.1f} "
        f"times, and each process would need {needed / 1e9:.1f} GB of memory."
    )


def blocks_of(survey: Survey, side: float) -> list[Block]:
    """Return the blocks that files of the survey reach into, from south-west to north-east.

    Raises
    ------
    ValueError
        If there are many more than the points can fill.
    """
    lowest, highest = (np.floor(survey.boxes[:, end] / side) for end in (0, 1))
    count = (highest - lowest + 1).prod(axis=1)
    if count.sum() > max(_MANY_BLOCKS, len(survey) / _POINTS_PER_BLOCK):
        file = survey.sources[int(np.argmax(count))].path.name
        raise ValueError(
            f"The {len(survey):,} points are spread over {count.sum():,.0f} blocks of {side:g} m, most of them in "
            f"{file}; remove points that lie far off in plan."
        )
    found = set()
    for low, high in zip(lowest.astype(int), highest.astype(int)):
        found |= {(column, row) for row in range(low[1], high[1] + 1) for column in range(low[0], high[0] + 1)}
    return [Block(column, row, side) for column, row in sorted(found, key=lambda position: position[::-1])]
