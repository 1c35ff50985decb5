"""Pairs of adjacent raster cells."""

from collections.abc import Iterator

# Rows and columns of a step from a cell in each of the four directions in which others touch it.
DIRECTIONS = ((0, 1), (1, 1), (1, 0), (1, -1))


def adjacent_cells(dimensions: int) -> Iterator[tuple[tuple[slice, ...], tuple[slice, ...]]]:
    """Yield the slices of an array without its last or first cells, and of the cells next to those.

    Along each axis in order, first with the cells after, then with those before.
    """
    for axis in range(dimensions):
        for inside, outside in ((slice(None, -1), slice(1, None)), (slice(1, None), slice(None, -1))):
            yield (slice(None),) * axis + (inside,), (slice(None),) * axis + (outside,)
