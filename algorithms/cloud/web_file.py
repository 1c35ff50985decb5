"""A file on the web, of which only those ranges of bytes are fetched that are read.

It has the methods of a path by which point clouds are read, so that one reader serves both.
"""

from __future__ import annotations

import io
import os
import threading
import time
import zlib
from bisect import bisect_right, insort
from collections.abc import Iterable
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from functools import lru_cache
from pathlib import Path, PurePosixPath
from typing import Any, NamedTuple, Optional, Union, cast
from urllib.parse import unquote, urlsplit

from ..stage import Monitor
from ..threads import BETWEEN_LOOKS
from .printable import shown
from .web_addresses import is_address, redirected, same_server, split_address, without_query
from .web_cache import KeptRanges, remove_oldest
from .web_requests import NoAnswerError, Reply, transport

# Least number of bytes that are asked for at once, since a request takes longer than these; so ranges with no more
# between them are fetched as one. The header of a COPC file and most pages of its index are shorter.
_LEAST = 2**14
# Most bytes of one request, and most that are read in one piece: nothing sound in a point cloud is longer.
MOST_AT_ONCE, MOST_READ = 2**23, 2**29
# Bytes of one file, and of all together, that are kept; those fetched or used first go first.
_KEPT = 2**28
# Seconds for which a file that nobody reads is known.
_KNOWN_FOR = 600.0
# Seconds before a request is sent again: each time more, as servers ask.
_WAITS = (0.5, 1.0, 2.0)
# Redirections that are followed; browsers follow 20, but no survey needs more than two.
_MOST_REDIRECTIONS = 5
_REDIRECTIONS, _AGAIN = (301, 302, 303, 307, 308), (408, 429, 500, 502, 503, 504)
# Requests that are sent at once: as many as browsers open connections to a server.
AT_ONCE = 6


class WebState(NamedTuple):
    """What the system says of a local file: bytes, and a number that changes with the file."""

    st_size: int
    st_mtime_ns: int
    #: Of no disk
    st_dev: int = -1
    st_ino: int = 0


class _Content:
    """The content of an address, as far as it is known: size, version, and the parts that were fetched."""

    def __init__(self, address: str, login: str) -> None:
        self.address, self.login = address, login
        self.size, self.version = -1, ""
        self.used = time.monotonic()
        self.lock = threading.RLock()
        self.held = 0
        self._parts: dict[int, bytes] = {}
        self._starts: list[int] = []

    def take(self, at: int, size: int) -> bytes:
        """Return bytes from a position on, one at least and ``size`` at most; none behind the end."""
        with self.lock:
            self.used = time.monotonic()
            if not 0 <= at < self._known_size():
                return b""
            if self._held_to(at) == at:
                stop = self._starts[bisect_right(self._starts, at) :][:1] or [self.size]
                self.fetch(at, min(stop[0], at + min(max(size, _LEAST), MOST_AT_ONCE)))
            start = self._starts[bisect_right(self._starts, at) - 1]
            return self._parts[start][at - start : at - start + size]

    def _held_to(self, at: int) -> int:
        """Return the end of the part that holds a position, or the position itself if no part does."""
        before = bisect_right(self._starts, at) - 1
        return max(at, self._starts[before] + len(self._parts[self._starts[before]])) if before >= 0 else at

    def _known_size(self) -> int:
        if self.size < 0:
            # Descriptions are read as a whole, for which servers without ranges do.
            is_points = urlsplit(self.address).path.lower().endswith((".las", ".laz"))
            self.fetch(0, _LEAST if is_points else MOST_AT_ONCE)
        return self.size

    def missing(self, ranges: Iterable[tuple[int, int]]) -> list[tuple[int, int]]:
        """Return the parts not held of ranges (start, stop), in ascending order, as the ranges to ask for."""
        found: list[tuple[int, int]] = []
        for start, stop in ranges:
            at, end = start, min(stop, self._known_size())
            while at < end and (held_to := self._held_to(at)) > at:
                at = held_to
            while at < end:
                if found and at - found[-1][1] <= _LEAST and end - found[-1][0] <= MOST_AT_ONCE:
                    at, found[-1] = end, (found[-1][0], end)
                else:
                    found.append((at, min(end, at + MOST_AT_ONCE)))
                    at = found[-1][1]
        return found

    def fetch(self, start: int, stop: int, stopped: Optional[threading.Event] = None) -> int:
        """Fetch the bytes from ``start`` to ``stop``, and keep them; return how many."""
        reply = self._answer(start, stop, stopped or threading.Event())
        name = shown(without_query(self.address), 200)
        first, total = _content_range(name, reply)
        with self.lock:
            if self.size >= 0 and (total, reply.version) != (self.size, self.version):
                _forget(self)
                raise ValueError(f"{name} has changed while it was read; run it again.")
            expected = min(stop, total) - start
            if first != start or len(reply.data) != expected:
                raise ValueError(
                    f"The server of {name} sent {len(reply.data)} bytes from {first} on instead of {expected} from "
                    f"{start} on; download the file."
                )
            kept = KeptRanges(self.address, self.login, reply.version, total)
            if self.size < 0:
                # The first request shows which version the server has.
                for at, data in kept.read():
                    self._keep(at, data)
            else:
                kept.keep(start, reply.data)
                remove_oldest()
            self.size, self.version = total, reply.version
            self._keep(start, reply.data)
        return len(reply.data)

    def _keep(self, start: int, data: bytes) -> None:
        if start not in self._parts:
            insort(self._starts, start)
        self._parts[start] = data
        while (held := sum(map(len, self._parts.values()))) > _KEPT and len(self._parts) > 1:
            oldest = next(iter(self._parts))
            del self._parts[oldest]
            self._starts.remove(oldest)
        self.held = held

    def take_kept(self, version: str) -> bool:
        """Take the whole content from the folder; return whether it was kept there with this version."""
        with self.lock:
            for _, data in KeptRanges(self.address, self.login, version).read():
                self.size, self.version = len(data), version
                self._keep(0, data)
            return self.size >= 0

    def keep_whole(self, version: str) -> None:
        """Keep the whole content in the folder with a version, unless it is held in parts."""
        with self.lock:
            if len(data := self._parts.get(0, b"")) == self.size:
                KeptRanges(self.address, self.login, version).keep(0, data)

    def _answer(self, start: int, stop: int, stopped: threading.Event) -> Reply:
        """Return the reply to a request that is sent until it is answered, and follows redirections."""
        address, login, name = self.address, self.login, shown(without_query(self.address), 200)
        waits, redirections = list(_WAITS), 0
        while not stopped.is_set():
            try:
                reply = transport().get(address, start, stop - 1, login, stopped.is_set)
                why = f"it answers {reply.status}"
                is_whole = reply.status == 200 and start == 0 and max(_promised(reply), len(reply.data)) <= stop
                is_short = len(reply.data) < min(_promised(reply), stop - start) and (is_whole or reply.status == 206)
                why = f"it ended after {len(reply.data)} bytes" if is_short else why
            except NoAnswerError as error:
                reply, why = Reply(_AGAIN[0]), shown(str(error))
                is_whole = is_short = False
            if reply.status in _REDIRECTIONS and redirections < _MOST_REDIRECTIONS:
                leads = redirected(address, reply.location)
                # A login for one server must not be sent to another.
                login = login if same_server(leads, address) else ""
                address, redirections = leads, redirections + 1
            elif is_short or reply.status in _AGAIN:
                if not waits:
                    raise ValueError(f"{name} can't be read ({why}); check the address and the connection.")
                stopped.wait(waits.pop(0))
            elif reply.status == 206 or is_whole:
                return reply
            else:
                raise ValueError(_refusal(name, reply.status))
        raise ValueError(f"Reading {name} was stopped.")


def _promised(reply: Reply) -> int:
    """Return the number of bytes that a reply declares, 0 if it declares none."""
    first, _, last = reply.content_range.partition("/")[0].replace("bytes", "").strip().partition("-")
    return int(last) - int(first) + 1 if first.isdecimal() and last.isdecimal() else 0


def _content_range(name: str, reply: Reply) -> tuple[int, int]:
    """Return the first byte and the size of the whole file that a reply names."""
    given, _, total = reply.content_range.partition("/")
    first = given.replace("bytes", "").strip().partition("-")[0]
    if not (first.isdecimal() and total.isdecimal() and len(total) < 19):
        raise ValueError(f"The server of {name} does not say how large the file is; download the file.")
    return int(first), int(total)


def _refusal(name: str, status: int) -> str:
    """Return the sentence for a status that another try does not mend."""
    if status == 200:
        return f"The server of {name} sends whole files only, no ranges of bytes; download the file and choose that."
    if status in (401, 403):
        return f"{name} may not be read ({status}); choose an authentication configuration (authcfg=… url=https://…)."
    if status in (404, 410):
        return f"There is no file at {name} ({status}); check the address."
    if status == 416:
        return f"{name} is shorter than it says, or empty; get another address."
    return f"{name} can't be read (the server answers {status}); check the address."


_known: dict[tuple[str, str], _Content] = {}
_known_lock = threading.Lock()


def _content(address: str, login: str) -> _Content:
    """Return the content of an address; contents that nobody has read for some minutes are forgotten."""
    with _known_lock:
        now = time.monotonic()
        held = sum(one.held for one in _known.values())
        for key, one in sorted(_known.items(), key=lambda entry: entry[1].used):
            if now - one.used > _KNOWN_FOR or held > _KEPT:
                held -= one.held
                del _known[key]
        return _known.setdefault((address, login), _Content(address, login))


def _forget(content: _Content) -> None:
    with _known_lock:
        _known.pop((content.address, content.login), None)


class WebFile:
    """A file on the web, with those methods of a path by which point clouds are read.

    Parameters
    ----------
    address : str
        Begins with http:// or https://.
    login : str
        How the user is known to the server: in QGIS an authentication configuration, "" for none.

    Raises
    ------
    ValueError
        If it is no such address.
    """

    def __init__(self, address: str, login: str = "") -> None:
        parts = split_address(address)
        self.address, self.login = address.partition("#")[0], login
        path = PurePosixPath(unquote(parts.path) or "/")
        self.name, self.suffix = shown(path.name, 200), path.suffix
        self.host = str(parts.hostname)
        self.parent = without_query(self.address).rpartition("/")[0]

    def __str__(self) -> str:
        return without_query(self.address)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, WebFile) and (self.address, self.login) == (other.address, other.login)

    def __hash__(self) -> int:
        return hash((self.address, self.login))

    def resolve(self) -> WebFile:
        """Return itself."""
        return self

    def is_dir(self) -> bool:
        """Whether it is a folder: never."""
        return False

    def is_file(self) -> bool:
        """Whether there is such a file, as far as is known without asking."""
        return True

    def exists(self) -> bool:
        """Whether it is on this computer: never."""
        return False

    def stat(self) -> WebState:
        """Return its size, and a number for its version, 0 where the server names none."""
        content = _content(self.address, self.login)
        content.take(0, 1)
        return WebState(content.size, zlib.crc32(content.version.encode()))

    def open(self, mode: str = "rb") -> WebStream:  # noqa: ARG002 - as of a path
        """Return a stream of its bytes."""
        return WebStream(_content(self.address, self.login))

    def read_bytes(self) -> bytes:
        """Return its content."""
        return self.open().read()

    def beside(self, name: str) -> WebFile:
        """Return a file that this one names, by an address or a name from its own folder on.

        Raises
        ------
        ValueError
            As :func:`redirected`.
        """
        leads = redirected(self.address, name)
        return WebFile(leads, self.login if same_server(leads, self.address) else "")


class WebStream(io.RawIOBase):
    """The bytes of a file on the web; ``failure`` is why the last reading failed, which LAZ libraries don't say."""

    failure: Optional[Exception] = None

    def __init__(self, content: _Content) -> None:
        super().__init__()
        self._content, self._at = content, 0

    def readable(self) -> bool:
        """Return True."""
        return True

    def seekable(self) -> bool:
        """Return True."""
        return True

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        """Move as in any file."""
        end = len(self) if whence == io.SEEK_END else 0
        self._at = max(0, {io.SEEK_SET: 0, io.SEEK_CUR: self._at, io.SEEK_END: end}[whence] + offset)
        return self._at

    def tell(self) -> int:
        """Return the position."""
        return self._at

    def __len__(self) -> int:
        self._content.take(0, 1)
        return self._content.size

    def read(self, size: Optional[int] = -1) -> bytes:
        """Return the next bytes; fewer than ``size`` at the end only."""
        left = max(0, len(self) - self._at)
        size = left if size is None or size < 0 else min(size, left)
        if size > MOST_READ:
            raise ValueError(
                f"{shown(without_query(self._content.address))} is damaged: {size} bytes should be in one piece."
            )
        pieces = []
        try:
            while size and (piece := self._content.take(self._at, size)):
                pieces.append(piece)
                size -= len(piece)
                self._at += len(piece)
        except ValueError as error:
            self.failure = error
            raise
        return b"".join(pieces)

    def readinto(self, buffer: Any) -> int:
        """Fill a buffer with the next bytes; return how many."""
        data = self.read(len(buffer))
        buffer[: len(data)] = data
        return len(data)

    def prefetch(self, ranges: Iterable[tuple[int, int]], monitor: Monitor) -> None:
        """Fetch ranges (start, stop) in ascending order, several at once; progress is in bytes.

        Raises
        ------
        ValueError
            If one can't be fetched.
        Cancelled
            If the monitor says so, soon after.
        """
        _fetch_at_once([(self._content, *one) for one in self._content.missing(ranges)], monitor)


def fetch_files(files: Iterable[Path], monitor: Monitor, version: str = "") -> None:
    """Fetch the files that are on the web, several at once, and as a whole where they are small.

    Servers without ranges answer this, too. A ``version`` is of the description that names the files: they are kept in
    the folder of the user, and are not asked for while that does not change.
    """
    on_web = cast("list[WebFile]", list(filter(is_on_web, files)))
    contents = [one for one in (_content(one.address, one.login) for one in on_web) if one.size < 0]
    contents = [one for one in contents if not one.take_kept(version)]
    _fetch_at_once([(one, 0, MOST_AT_ONCE) for one in contents], monitor)
    for one in contents:
        one.keep_whole(version)
    if contents and version:
        remove_oldest()


def _fetch_at_once(wanted: list[tuple[_Content, int, int]], monitor: Monitor) -> None:
    """Fetch parts (content, start, stop)."""
    stopped, done, total = threading.Event(), 0, max(1, sum(stop - start for _, start, stop in wanted))
    open_ones: set[Future] = set()
    try:
        while open_ones or wanted:
            monitor.progress(min(1.0, done / total))
            room = AT_ONCE - len(open_ones)
            pool = _threads(os.getpid())
            open_ones |= {pool.submit(one.fetch, start, stop, stopped) for one, start, stop in wanted[:room]}
            wanted = wanted[room:]
            transport().wait()
            ended, open_ones = wait(open_ones, BETWEEN_LOOKS, FIRST_COMPLETED)
            done += sum(one.result() for one in ended)
    finally:
        stopped.set()


@lru_cache(maxsize=1)
def _threads(process: int) -> ThreadPoolExecutor:  # noqa: ARG001
    """Return the threads of all requests of a process: with each thread that ends, Qt deletes objects still in use."""
    return ThreadPoolExecutor(AT_ONCE, "web")


def file_at(path: Union[str, Path, WebFile]) -> Path:
    """Return the file that a path or an address names; one on the web goes where a path is only read."""
    if isinstance(path, WebFile):
        return cast(Path, path)
    return cast(Path, WebFile(str(path))) if is_address(path) else Path(path)


def is_on_web(path: Any) -> bool:
    """Whether a file is on the web."""
    return isinstance(path, WebFile)
