"""A survey cut into square tiles, streamed: no file is ever read whole."""

from dataclasses import replace
from pathlib import Path
from typing import BinaryIO

import numpy as np

from ..cloud.crs import header_with_crs
from ..cloud.laz import writing_backend
from ..cloud.outputs import LAS, LAZ, os_errors_as_messages, replacing, working_folder
from ..cloud.point_records import fill_merged
from ..cloud.points import check_count, chunks_near, write_points
from ..geometry.groups import run_starts
from ..stage import Monitor
from .blocks import Block
from .survey import Survey, tiles_folder


def cut_into_tiles(
    survey: Survey, side: float, folder: Path, stem: str, compressed: bool, monitor: Monitor
) -> list[Path]:
    """Write the points of a survey as tiles of a lattice that starts at the zero of the map.

    Every record of every file that lies within the extent of the survey is in exactly one tile, with all its
    dimensions, in the order of the files. Memory: one portion of a file at a time; on the disk the points lie once
    uncompressed next to the tiles while they are made.

    Parameters
    ----------
    survey : Survey
        The files to cut.
    side : float
        Side of a tile, m.
    folder : Path
        Where the tiles go; it is made where it is missing.
    stem : str
        What the names of tiles begin with; their lower left corner in meters follows.
    compressed : bool
        LAZ instead of LAS.
    monitor : Monitor
        Receives progress.

    Returns
    -------
    list of Path
        The tiles, from south-west to north-east.

    Raises
    ------
    ValueError
        If a file is damaged, no point lies within the extent, one of the files would be overwritten, or a tile can't
        be written.
    """
    kind = LAZ if compressed else LAS
    if compressed:
        writing_backend(survey.header.layout.point_format)
    with tiles_folder(folder, [source.path for source in survey.sources]), working_folder(folder) as heaps:
        blocks = _sort_out(survey, side, heaps, monitor.part(0.0, 0.5))
        if not blocks:
            raise ValueError("The survey has no points within the extent; choose another extent.")
        size = survey.header.layout.dtype.itemsize
        count = sum((heaps / block.name).stat().st_size for block in blocks) // size
        if survey.extent is None and count != len(survey):
            raise ValueError(f"The tiles would have {count:,} of the {len(survey):,} points; nothing was written.")
        tiles = []
        for block, part in zip(blocks, monitor.part(0.5, 1.0).parts(len(blocks))):
            tile = folder / f"{stem}_{block.name}{kind}"
            heap = heaps / block.name
            records = np.memmap(heap, survey.header.layout.dtype, "r")
            with replacing(tile) as stream:
                _write(survey, records, compressed, stream, part)
                check_count(stream, tile, len(records))
            del records
            heap.unlink()
            tiles.append(tile)
    return tiles


def _sort_out(survey: Survey, side: float, folder: Path, monitor: Monitor) -> list[Block]:
    """Append the records of all files to one file for each tile; return the tiles that have points."""
    blocks: set[tuple[int, int]] = set()
    share = 1 / len(survey.sources)
    for number, source in enumerate(survey.sources):
        header = source.header
        box = source.box / survey.crs.horizontal
        for _, found in chunks_near(source.path, header, box, monitor.part(number * share, (number + 1) * share)):
            chunk = found[survey.holds(found, header)]
            records = np.zeros(len(chunk), survey.header.layout.dtype)
            fill_merged(records, chunk, header, survey.header)
            column, row = np.floor(survey.in_plan(chunk, header) / side).astype(np.int64).T
            order = np.lexsort([column, row])
            column, row, records = column[order], row[order], records[order]
            starts = run_starts(row * (1 << 32) + column)
            for start, stop in zip(starts, [*starts[1:], len(records)]):
                position = int(column[start]), int(row[start])
                blocks.add(position)
                # Messages name the folder of the tiles, as users don't see the hidden one in it.
                with os_errors_as_messages(folder.parent), (folder / Block(*position, side).name).open("ab") as heap:
                    # numpy's own way does not say why it could not write.
                    heap.write(records[start:stop].tobytes())
        source.check_state()
    return [Block(column, row, side) for column, row in sorted(blocks, key=lambda position: position[::-1])]


def _write(survey: Survey, records: np.ndarray, compressed: bool, stream: BinaryIO, monitor: Monitor) -> None:
    """Write a tile of these records; layouts that older versions of LAS do not know make it version 1.4."""
    header = replace(survey.header, count=len(records))
    if not header.layout.is_old:
        header = replace(header, minor=4)
    header = header_with_crs(header, survey.crs)
    write_points(stream, header, lambda start, stop: np.array(records[start:stop]), compressed, monitor)
