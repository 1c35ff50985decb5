"""The hidden folder next to the tiles of a survey that keeps the results of blocks until the run is complete."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Callable

from ..cloud.outputs import LOCK, locked_folder

_NAME = ".lidar-buildings"
_STOP = "stop"

# What a run makes in the folder: nothing else is removed. The last are of runs that were killed while they wrote.
_MADE = ("block-*.npz", "numbers-*.npz", "view-*.npz", _STOP, "pieces", ".lb-*.part")


@contextmanager
def work_folder(folder: Path, warn: Callable[[str], None] = lambda _: None) -> Iterator[Path]:
    """Give the folder in which a run keeps the results of blocks; refuse it while another run has it.

    At the end it is removed if it holds no results. ``warn`` is told of a disk that knows no locks.

    Raises
    ------
    ValueError
        If it can't be made, another run works in it, or it is not as a run leaves it: a link, or with links in it, by
        which files elsewhere would be written over.
    """
    work = folder / _NAME
    try:
        if not work.is_symlink():
            work.mkdir(exist_ok=True)
        links = [path for path in (work, *work.rglob("*")) if path.is_symlink()]
        contents = [path.name for path in work.iterdir()]
    except OSError as error:
        raise ValueError(f"The folder {folder} can't be written ({error.strerror}); choose another one.") from error
    if links:
        raise ValueError(f"{links[0]} is a link, which no run makes; remove it or choose another folder.")
    if contents and LOCK not in contents:
        raise ValueError(f"{work} was made by no run; rename it or choose another folder.")
    is_ours = False
    try:
        with locked_folder(work, warn) as is_ours:
            if not is_ours:
                raise ValueError(f"Another run is writing to {folder}; wait for its end or choose another folder.")
            (work / _STOP).unlink(missing_ok=True)
            yield work
    finally:
        # Windows removes no lock that is open.
        if is_ours and work.is_dir() and {path.name for path in work.iterdir()} <= {LOCK, _STOP}:
            remove_work(work)


def remove_work(work: Path) -> None:
    """Remove what a run made in its folder, and the folder if nothing else is in it."""
    for pattern in _MADE:
        for path in work.glob(pattern):
            if path.is_dir():
                shutil.rmtree(path, ignore_errors=True)
            else:
                path.unlink()
    if work.is_dir() and all(path.name == LOCK for path in work.iterdir()):
        # Windows keeps a lock that is open: the folder is removed when it is closed.
        with suppress(OSError):
            (work / LOCK).unlink()
            work.rmdir()
