"""Files that appear complete or not at all, and all files of one run together."""

import errno
import io
import os
import platform
import re
import shutil
import tempfile
import time
import zlib
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any, BinaryIO, Callable, Optional

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]
try:
    import msvcrt
except ImportError:  # all others
    msvcrt = None  # type: ignore[assignment]

LAS, LAZ, COPC, VPC, STAC, EPT = ".las", ".laz", ".copc.laz", ".vpc", ".json", "ept.json"

# Working folders, hidden next to the targets: their names, which say what computer made them. Then the file that a
# running program keeps open and locked in each, and the folder in it for old files while new ones take their places.
_PREFIX, _SUFFIX = ".lb-", ".part"
_NAME = re.compile(r"\.lb-([0-9a-f]{8})-.+\.part")
LOCK = "lock"
_OLD = "old"
# Error numbers of a lock that another program holds; any other error means a disk without locks.
_IS_HELD = (errno.EWOULDBLOCK, errno.EAGAIN, errno.EACCES, errno.EDEADLK)
# Bytes that are copied or unpacked at once: more than most files and records have, and little of a computer's memory.
PIECE = 2**24
# A working folder younger than this (s) may belong to a run that has not locked it yet, which takes far less.
_UNLOCKED = 2.0


def kind_of(path: Path) -> str:
    """Return the extension that says how a file is written: LAS, LAZ, COPC, VPC, STAC, EPT or "" for any other."""
    name = path.name.lower()
    if name == EPT:
        return EPT
    return next((kind for kind in (COPC, LAZ, LAS, VPC, STAC) if name.endswith(kind)), "")


def stem_of(path: Path) -> str:
    """Return the name of a file without the extension that says how it is written."""
    kind = kind_of(path)
    return path.name[: -len(kind)] or "ept" if kind else path.name


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
    check_place(path, sources)


def check_place(path: Path, sources: Iterable[Path] = ()) -> None:
    """Refuse with a ValueError an output whose folder is missing, that is a folder, or one of ``sources``."""
    folder = path.absolute().parent
    if not folder.is_dir():
        raise ValueError(f"The folder {folder} does not exist; make it or choose another one.")
    if path.is_dir():
        raise ValueError(f"{path} is a folder; give the name of a file.")
    if any(same_file(path, source) for source in sources):
        raise ValueError(f"The output {path} is also an input; choose another name.")


def same_file(one: Path, other: Path) -> bool:
    """Whether two paths are the same file, links and case followed where the file system does."""
    return one.samefile(other) if one.exists() and other.exists() else one.resolve() == other.resolve()


def check_not_read(targets: Iterable[Path], sources: Iterable[Path]) -> None:
    """Refuse targets by which a file that is read would be written over, also through links.

    Raises
    ------
    ValueError
        If one of them is, or leads to, one of ``sources``.
    """
    read = {_identity(source): source for source in sources}
    for target in targets:
        identity = _identity(target)
        if identity and identity in read:
            means = "is" if target.resolve() == target.absolute() else f"leads to {read[identity]}, which is"
            raise ValueError(
                f"{target.name} is in the folder {target.parent}, where the tiles go, and {means} an input; "
                "choose another folder."
            )


def _identity(path: Path) -> tuple[int, ...]:
    """Return device and number of the file that a path leads to, nothing where there is no such file."""
    try:
        stat = path.stat()
    except OSError:
        # A link to itself, or to nothing, leads to no file that is read.
        return ()
    return stat.st_dev, stat.st_ino


class DiskFullError(ValueError):
    """The disk is full: nothing else that the run writes will fit."""


class KeptFailure(io.FileIO):
    """A file that stores why reading or writing failed: LAZ libraries report that it failed, not why."""

    failure: Optional[OSError] = None

    def readinto(self, buffer) -> Optional[int]:
        """Read as any file."""
        return self._kept(super().readinto, buffer)

    def write(self, data) -> int:
        """Write as any file."""
        return self._kept(super().write, data)

    def _kept(self, call: Callable, data: Any) -> Any:
        try:
            return call(data)
        except OSError as error:
            self.failure = error
            raise


class ResultFiles:
    """The files of one run: each is written in a working folder next to its target, and all are put in place together.

    Until then older files stay as they are. Nothing is removed but what this run wrote and what it replaces. Working
    folders that a killed run left next to a target are removed.
    """

    def __init__(self) -> None:
        self._entries: list[_Entry] = []

    def beside(self, target: Path, companions: Iterable[Path] = ()) -> Path:
        """Return a path in a new folder, with the same name, for the file that becomes ``target``.

        A link at the target is replaced, never followed: whoever may write into the folder could lead it to any file.
        Whatever else is written into the working folder goes to the folder of the target too.

        Parameters
        ----------
        target : Path
            In an existing folder.
        companions : iterable of Path
            Files that belong to an older target and are replaced, or removed, with it.

        Raises
        ------
        ValueError
            If the folder can't be written, or the target is no ordinary file.
        """
        final = _in_real_folder(target)
        with os_errors_as_messages(target):
            if final.exists() and not final.is_file():
                raise ValueError(f"{target} is no ordinary file; give the name of a file.")
            entry = _Entry(target, final, [_in_real_folder(path) for path in companions])
            self._entries.append(entry)
        return entry.path / final.name

    def final(self, text: str) -> str:
        """Return a text with the paths of working folders replaced by those that the files have in the end."""
        for entry in self._entries:
            text = text.replace(str(entry.path / entry.final.name), str(entry.target))
            text = text.replace(str(entry.path), str(entry.final.parent))
        return text

    def put_in_place(self) -> None:
        """Move all files that were written to their targets; if one can't be moved, all targets are as before.

        Raises
        ------
        ValueError
            If a target can't be replaced, for example because another program uses it.
        """
        with ExitStack() as undo:
            for entry in self._entries:
                with os_errors_as_messages(entry.target):
                    entry.put_in_place(undo)
            undo.pop_all()

    def discard(self) -> None:
        """Remove the working folders, with everything that was not put in place."""
        for entry in self._entries:
            entry.remove()


def _in_real_folder(path: Path) -> Path:
    """Return the absolute path with the links to its folder followed; a link at its end stays one."""
    return Path(os.path.realpath(path.parent), path.name)


class _WorkingFolder:
    """A new hidden folder in another one, from which those are removed that killed runs left."""

    def __init__(self, parent: Path) -> None:
        _sweep(parent)
        self.path = Path(tempfile.mkdtemp(_SUFFIX, f"{_PREFIX}{_computer()}-", parent))
        self._lock = (self.path / LOCK).open("wb")
        if fcntl is not None:
            # A file system without locks has none of its working folders swept either.
            with suppress(OSError):
                fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)

    def remove(self) -> None:
        """Remove the folder, its lock last: a run that is killed here leaves what the next one recognizes."""
        # If somebody has removed the folder meanwhile, nothing is left to do.
        for path in self.path.glob("*"):
            if path.is_dir():
                shutil.rmtree(path, ignore_errors=True)
            elif path.name != LOCK:
                # A later run removes what another program still holds.
                with suppress(OSError):
                    path.unlink()
        self._lock.close()
        shutil.rmtree(self.path, ignore_errors=True)


class _Entry(_WorkingFolder):
    """A target and its working folder."""

    def __init__(self, target: Path, final: Path, companions: list[Path]) -> None:
        super().__init__(final.parent)
        self.target, self.final, self.companions = target, final, companions

    def put_in_place(self, undo: ExitStack) -> None:
        """Move the files to their targets, and note how to undo that."""
        made = {self.final.with_name(new.name): new for new in self.path.iterdir() if new.name != LOCK}
        if not made:
            return
        aside = self.path / _OLD
        aside.mkdir()
        for path in self.companions:
            if path not in made and os.path.lexists(path):
                path.replace(aside / path.name)
                undo.callback((aside / path.name).replace, path)
        for path, new in made.items():
            if path.is_dir():
                raise IsADirectoryError(errno.EISDIR, "a folder is in its place", str(path))
            if _kept(path, aside / path.name, new):
                undo.callback((aside / path.name).replace, path)
            else:
                undo.callback(_remove, path, new.stat().st_ino)
            new.replace(path)


def _kept(path: Path, aside: Path, new: Path) -> bool:
    """Keep a file under a second name until the new one, which gets its permissions, replaces it.

    Its own name stays taken all the time if possible. A link is kept as such: what it leads to is not touched. Return
    whether there was a file; another program may remove it at any time.
    """
    try:
        if path.is_symlink():
            path.replace(aside)
            return True
        shutil.copymode(path, new)
        try:
            os.link(path, aside)
        except OSError:
            path.replace(aside)
    except FileNotFoundError:
        return False
    return True


def _remove(path: Path, inode: int) -> None:
    """Remove a file if it is still the one with this inode."""
    if os.path.lexists(path) and path.lstat().st_ino == inode:
        path.unlink()


def _sweep(folder: Path) -> None:
    """Remove the working folders that runs left in a folder when they were killed."""
    for working in folder.glob(f"{_PREFIX}*{_SUFFIX}"):
        if _is_abandoned(working):
            shutil.rmtree(working, ignore_errors=True)


def _computer() -> str:
    """Return eight digits that identify this computer: locks of some network disks hold on one computer only."""
    return f"{zlib.crc32(platform.node().encode()):08x}"


def _is_abandoned(folder: Path) -> bool:
    """Whether a working folder is empty, or of this computer and no running program of it holds its lock."""
    lock = folder / LOCK
    try:
        if folder.is_symlink() or time.time() - folder.stat().st_mtime < _UNLOCKED:
            return False
        if not list(folder.iterdir()):
            return True
        of_computer = _NAME.fullmatch(folder.name)
        if of_computer and of_computer[1] != _computer():
            return False
        if fcntl is None:
            # Windows removes no file that a program has open.
            lock.unlink()
        else:
            with lock.open("rb") as file:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True


@contextmanager
def working_folder(parent: Path) -> Iterator[Path]:
    """Give a new hidden folder in another one, for files needed until the block ends.

    A killed run's folder is removed when something is written into the same folder again.

    Raises
    ------
    ValueError
        If nothing can be written there.
    """
    with os_errors_as_messages(parent):
        working = _WorkingFolder(parent)
    try:
        yield working.path
    finally:
        working.remove()


@contextmanager
def made_folder(folder: Path) -> Iterator[None]:
    """Make a folder, and those above it, where they are missing; remove those again that are empty if the block fails.

    Raises
    ------
    ValueError
        If the folder can't be made.
    """
    missing = [one for one in (folder, *folder.parents) if not one.exists()]
    try:
        with os_errors_as_messages(folder):
            folder.mkdir(parents=True, exist_ok=True)
        yield
    except BaseException:
        # What has files in it stays.
        with suppress(OSError):
            for one in missing:
                one.rmdir()
        raise


@contextmanager
def locked_folder(folder: Path, warn: Callable[[str], None] = lambda _: None) -> Iterator[bool]:
    """Yield whether no other running program has locked a folder, and lock it for as long as the block lasts.

    The system releases the lock when the program ends, however it ends. Where the file system has no locks, the folder
    counts as free, and ``warn`` is given a sentence about that.
    """
    with (folder / LOCK).open("ab") as lock:
        is_free = True
        try:
            if fcntl is not None:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            elif msvcrt is not None:
                lock.seek(0)
                msvcrt.locking(lock.fileno(), msvcrt.LK_NBLCK, 1)
        except OSError as error:
            is_free = error.errno not in _IS_HELD
            if is_free:
                warn(
                    f"The disk of {folder.parent} has no locks ({error.strerror or error}), so that a second run into "
                    "this folder would not be noticed; start none before this one has ended."
                )
        yield is_free


@contextmanager
def all_or_nothing() -> Iterator[ResultFiles]:
    """Give the files of a run, which are put in place when the block ends well and vanish otherwise.

    Raises
    ------
    ValueError
        If a target can't be replaced.
    """
    files = ResultFiles()
    try:
        yield files
        files.put_in_place()
    finally:
        files.discard()


@contextmanager
def replacing(path: Path) -> Iterator[BinaryIO]:
    """Give a stream whose content becomes ``path`` when the block ends well, and vanishes otherwise.

    Raises
    ------
    ValueError
        If the folder can't be written, the disk is full, or the target is in use.
    """
    file = None
    try:
        with all_or_nothing() as files:
            file = KeptFailure(files.beside(path), "xb+")
            with io.BufferedRandom(file) as stream:
                yield stream
    except Exception as error:
        cause = (file and file.failure) or error
        if isinstance(cause, OSError):
            raise _failure(path, cause) from error
        raise


@contextmanager
def os_errors_as_messages(path: Path) -> Iterator[None]:
    """Say in one sentence why ``path`` can't be written where the block finds that out.

    Raises
    ------
    ValueError
        If the block fails with an error of the system.
    """
    try:
        yield
    except OSError as error:
        raise _failure(path, error) from error


def _failure(path: Path, error: OSError) -> ValueError:
    """Return an error with the reason why a file can't be written, and the remedy."""
    if error.errno in (errno.ENOSPC, errno.EDQUOT):
        return DiskFullError(f"The disk is full: {path} was not written; free some space or choose another folder.")
    if isinstance(error, PermissionError) or error.errno == errno.EROFS:
        return ValueError(
            f"{path} can't be written: its folder is read-only or the file is in use; choose another one."
        )
    return ValueError(f"{path} can't be written ({error.strerror or error}); choose another folder.")
