"""Files that appear complete or not at all."""

from __future__ import annotations

import errno
import io
import uuid
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO, Optional

LAS, LAZ, COPC, VPC = ".las", ".laz", ".copc.laz", ".vpc"


def kind_of(path: Path) -> str:
    """Return the extension that says how a file is written: LAS, LAZ, COPC, VPC or "" for any other."""
    name = path.name.lower()
    return next((kind for kind in (COPC, LAZ, LAS, VPC) if name.endswith(kind)), "")


def check_output(path: Path, sources: Iterable[Path]) -> None:
    """Refuse an output that can't be written or that is an input.

    Raises
    ------
    ValueError
        If the extension is unknown, the folder missing, or the path one of ``sources``.
    """
    if kind_of(path) not in (LAS, LAZ, COPC):
        raise ValueError(
            f"{path.name} can't be written as a point cloud: give it the extension .las, .laz or .copc.laz."
        )
    if not path.parent.is_dir():
        raise ValueError(f"The folder {path.parent} does not exist; make it or choose another one.")
    if path.is_dir():
        raise ValueError(f"{path} is a folder; give the name of a file.")
    for source in sources:
        if same_file(path, source):
            raise ValueError(f"The output {path} is also an input; choose another name.")


def same_file(one: Path, other: Path) -> bool:
    """Whether two paths are the same file, links and case followed where the file system does."""
    if one.exists() and other.exists():
        return one.samefile(other)
    return one.resolve() == other.resolve()


class _File(io.FileIO):
    """A file that remembers why writing failed: LAZ libraries pass on that it failed, not why."""

    failure: Optional[OSError] = None

    def write(self, data) -> int:
        try:
            return super().write(data)
        except OSError as error:
            self.failure = error
            raise


@contextmanager
def replacing(path: Path) -> Iterator[BinaryIO]:
    """Give a stream whose content becomes ``path`` when the block ends well, and vanishes otherwise.

    Raises
    ------
    ValueError
        If the folder can't be written, the disk is full, or the target is in use.
    """
    temporary = path.with_name(f".{path.name}.{uuid.uuid4().hex[:8]}.part")
    file = None
    try:
        file = _File(temporary, "xb+")
        with io.BufferedRandom(file) as stream:
            yield stream
        temporary.replace(path)
    except Exception as error:
        cause = (file and file.failure) or error
        if isinstance(cause, OSError):
            raise ValueError(_sentence(path, cause)) from error
        raise
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def written_or_told(path: Path) -> Iterator[None]:
    """Say in one sentence why ``path`` can't be written where the block finds that out.

    Raises
    ------
    ValueError
        If the block fails with an error of the system.
    """
    try:
        yield
    except OSError as error:
        raise ValueError(_sentence(path, error)) from error


def _sentence(path: Path, error: OSError) -> str:
    if error.errno in (errno.ENOSPC, errno.EDQUOT):
        return f"The disk is full: {path} was not written; free some space or choose another folder."
    if isinstance(error, PermissionError) or error.errno == errno.EROFS:
        return f"{path} can't be written: its folder is read-only or the file is in use; choose another one."
    return f"{path} can't be written ({error.strerror or error}); choose another folder."
