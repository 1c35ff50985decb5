"""Ranges of files on the web that are kept from run to run, in a folder that the user names."""

import os
from collections.abc import Iterable, Iterator
from contextlib import suppress
from functools import lru_cache
from hashlib import sha256
from pathlib import Path
from typing import Optional

from .outputs import os_errors_as_messages, replacing

# Environment variable that names the folder, also for worker processes; without one, nothing is kept.
_VARIABLE = "LIDARBUILDINGS_WEB_CACHE"
# Bytes of all ranges in the folder: those written first are removed first.
_MOST = 2 * 10**9
# Extension of kept ranges; no other file in the folder is removed.
_ENDING = ".lidar-buildings-range"

_folder = [os.environ.get(_VARIABLE, "")]


def keep_in(folder: str) -> None:
    """Keep ranges in a folder from now on; with "" in the folder of the environment variable, if there is one."""
    _folder[0] = folder or os.environ.get(_VARIABLE, "")


class KeptRanges:
    """The ranges that the folder has of one version of a file.

    Parameters
    ----------
    address, login : str
        Where the file is, and how the user is known there. Only a digest of both is in the names of files.
    version : str
        As the server names it; what has no version is not kept.
    size : int, optional
        Bytes of the whole file; None if it is kept as a whole, with the version of what names it.
    """

    def __init__(self, address: str, login: str, version: str, size: Optional[int] = None) -> None:
        self.folder: Optional[Path] = Path(_folder[0]).expanduser() if _folder[0] and version else None
        self.name = sha256(repr((address, login, version, size)).encode()).hexdigest()

    def read(self) -> Iterator[tuple[int, bytes]]:
        """Yield position and bytes of each range, the one written last at the end."""
        for _, _, file in _oldest_first(_listed(self.folder).get(self.name, ())) if self.folder else ():
            _, start, size = file.name.split(".")[0].split("-")
            # Another process may remove it meanwhile.
            with suppress(FileNotFoundError):
                data = file.read_bytes()
                if len(data) == int(size):
                    yield int(start), data

    def keep(self, start: int, data: bytes) -> None:
        """Keep a range.

        Raises
        ------
        ValueError
            If the folder can't be written.
        """
        if self.folder is None:
            return
        target = self.folder / f"{self.name}-{start}-{len(data)}{_ENDING}"
        with os_errors_as_messages(target):
            self.folder.mkdir(0o700, parents=True, exist_ok=True)
        with replacing(target) as stream:
            stream.write(data)


def remove_oldest() -> None:
    """Remove the oldest ranges of all files in the folder, beyond the bound."""
    files = _oldest_first(Path(_folder[0]).expanduser().glob(f"*-*-*{_ENDING}")) if _folder[0] else []
    excess = sum(size for _, size, _ in files) - _MOST
    while excess > 0 and files:
        _, size, file = files.pop(0)
        # Windows removes no file that another process reads: it goes the next time.
        with suppress(PermissionError):
            file.unlink(missing_ok=True)
        excess -= size


def _listed(folder: Path) -> dict[str, list[Path]]:
    """Return the ranges in a folder by the names of :class:`KeptRanges`."""
    return _listed_once(folder, folder.stat().st_mtime_ns) if folder.is_dir() else {}


@lru_cache(maxsize=1)
def _listed_once(folder: Path, changed: int) -> dict[str, list[Path]]:  # noqa: ARG001
    """Return the ranges by names; the folder is listed again when it has ``changed`` (ns), not for each of many."""
    found: dict[str, list[Path]] = {}
    for file in folder.glob(f"*-*-*{_ENDING}"):
        found.setdefault(file.name.partition("-")[0], []).append(file)
    return found


def _oldest_first(files: Iterable[Path]) -> list[tuple[int, int, Path]]:
    """Return when each range was written (ns), its bytes and its file."""
    found = []
    for file in files:
        with suppress(FileNotFoundError):
            state = file.stat()
            found.append((state.st_mtime_ns, state.st_size, file))
    return sorted(found)
