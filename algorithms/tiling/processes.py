"""Worker processes of this machine, each with its own connection, so that one may end without the others.

The pools of Python's library share one pipe between all processes: one that is killed leaves the others, and the
program itself, waiting for each other. They also start their processes with the current folder on the search path and
run the main program again in each. Both are unsafe where the current folder holds somebody's survey.
"""

from __future__ import annotations

import os
import pickle  # nosec B403 - only to send: what comes back is read by the connection
import subprocess  # nosec B404 - no shell, see below
import sys
import tempfile
import time
from collections.abc import Iterable
from concurrent.futures import BrokenExecutor, Executor, Future
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Lock, Thread
from typing import Any, Callable, Optional

# The package as workers import it, its folder, and the program that they run.
PACKAGE = __name__.split(".", maxsplit=1)[0]
FOLDER = Path(__file__).resolve().parents[2]
_PROGRAM = Path(__file__).with_name("worker_process.py")

# Seconds that an interpreter has to answer.
_ANSWER = 15

# Seconds that a process has to end.
_END = 5

# Most attempts at a call: once more where the system ended the process that worked on it.
_ATTEMPTS = 2


class WorkerEnded(Exception):
    """The system ended the process that worked on a call, and the one that worked on it again."""


class CannotStart(BrokenExecutor):
    """Processes can't be started at all."""


class Processes(Executor):
    """An executor of processes. A call whose process ends is made once more, in a new one.

    Parameters
    ----------
    count : int
        Number of processes, at least 1; each is started when there is work for it.
    threads : int
        Threads that each works with.
    distrusted : iterable of Path
        Folders of data: no module is imported from them.
    """

    def __init__(self, count: int, threads: int, distrusted: Iterable[Path] = ()) -> None:
        self._count, self._threads = count, threads
        self._search_path = _trusted(sys.path, {folder.resolve() for folder in distrusted})
        self._calls: SimpleQueue = SimpleQueue()
        self._servers: list[Thread] = []
        self._running: set[_Process] = set()
        self._lock, self._is_closed = Lock(), False
        self._python = own_python()

    def submit(self, fn: Callable, /, *args: Any, **kwargs: Any) -> Future:
        """Have a process call a function of a module with positional arguments; return its future.

        The future raises what the function raised, :class:`WorkerEnded` or :class:`CannotStart`.
        """
        if self._is_closed:
            raise RuntimeError("The processes are shut down.")
        future: Future = Future()
        self._calls.put((future, fn, args))
        if len(self._servers) < self._count:
            self._servers.append(Thread(target=self._serve, daemon=True))
            self._servers[-1].start()
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End all processes; with ``cancel_futures`` at once, with whatever they work on."""
        with self._lock:
            self._is_closed = True
            running = list(self._running) if cancel_futures else []
        if cancel_futures:
            for call in _drained(self._calls):
                call[0].cancel()
        for process in running:
            process.kill()
        for _ in self._servers:
            self._calls.put(None)
        for server in self._servers if wait else ():
            server.join()

    def at_work(self) -> str:
        """Return the names of the processes at work, and since when, in words."""
        with self._lock:
            running = sorted((process.number, process.seconds) for process in self._running)
        said = [f"process {number} has been at work for {seconds:.0f} s" for number, seconds in running]
        return ", ".join(said) or "processes are being started"

    def _serve(self) -> None:
        """Have one process, and its successors, work on calls until there are no more."""
        process: Optional[_Process] = None
        while True:
            call = self._calls.get()
            if call is None:
                break
            future, function, arguments = call
            if not future.set_running_or_notify_cancel():
                continue
            for _ in range(_ATTEMPTS):
                try:
                    process = process or self._started()
                    future.set_result(process.call(function, arguments))
                except (EOFError, ConnectionError):
                    self._ended(process)
                    process = None
                    continue
                except Exception as error:
                    future.set_exception(error)
                break
            else:
                future.set_exception(WorkerEnded())
        self._ended(process)

    def _started(self) -> _Process:
        """Return a new process; none is started once the executor is shut down."""
        with self._lock:
            if self._is_closed:
                raise WorkerEnded
            process = _Process(self._python, self._search_path)
            self._running.add(process)
        try:
            process.prepare(self._threads)
        except (CannotStart, EOFError, ConnectionError):
            self._ended(process)
            raise
        return process

    def _ended(self, process: Optional[_Process]) -> None:
        if process is not None:
            process.end()
            with self._lock:
                self._running.discard(process)


class _Process:
    """One process: a connection to it, and its messages where it can't start."""

    def __init__(self, python: str, search_path: list[str]) -> None:
        own, other = Pipe()
        self._connection, self._python, self._search_path = own, python, search_path
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115 - open as long as the process runs
        inherited = os.environ.get("PYTHONPATH", "").split(os.pathsep)
        environment = {
            **os.environ,
            "PYTHONSAFEPATH": "1",
            "PYTHONPATH": os.pathsep.join(one for one in inherited if one in search_path),
        }
        try:
            # Signals of a terminal are for the main process: it ends the others.
            self._program = subprocess.Popen(  # nosec B603 - the interpreter that runs this, no shell
                [python, str(_PROGRAM), str(other.fileno())],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=self._errors,
                env=environment,
                **_inherits(other),
            )
        except OSError as error:
            own.close()
            self._errors.close()
            raise CannotStart(_not_started(python, error.strerror or str(error))) from error
        finally:
            other.close()
        self._since = time.monotonic()

    @property
    def number(self) -> int:
        """The number that the system gave it."""
        return self._program.pid

    @property
    def seconds(self) -> float:
        """How long it has been at work on its call, or starting (s)."""
        return time.monotonic() - self._since

    def prepare(self, threads: int) -> None:
        """Send the process the folder of its package; wait until it has imported it.

        Raises
        ------
        CannotStart
            If it ends before that by itself.
        EOFError, ConnectionError
            If the system ends it.
        """
        try:
            self._send((PACKAGE, str(FOLDER), self._search_path, threads))
            self._connection.recv()
        except (EOFError, ConnectionError):
            code = self._program.wait()
            self._errors.seek(0)
            lines = self._errors.read().decode(errors="replace").strip().splitlines()
            # A signal has a negative code; on Windows whoever ends a process chooses its code.
            if code < 0 or (os.name == "nt" and not lines):
                raise
            why = lines[-1] if lines else f"it ended with code {code}"
            raise CannotStart(_not_started(self._python, why)) from None

    def call(self, function: Callable, arguments: tuple) -> Any:
        """Return the result of a function there, or raise its error.

        Raises
        ------
        EOFError, ConnectionError
            If the process ends before it has answered.
        """
        self._since = time.monotonic()
        self._send((function, arguments))
        returned, value, trace = self._connection.recv()
        if returned:
            return value
        if isinstance(value, (EOFError, ConnectionError)):
            # Of a file or a network drive, not of this connection.
            raise OSError(str(value))
        raise value from RuntimeError(trace)

    def _send(self, message: tuple) -> None:
        """Send as :meth:`Connection.send` does, but from bytes: its buffer can't be freed when the process has ended.

        Python reports that whenever it collects garbage (github.com/python/cpython/issues/111331).
        """
        self._connection.send_bytes(pickle.dumps(message))

    def kill(self) -> None:
        """End the process at once, whatever it works on."""
        self._program.kill()

    def end(self) -> None:
        """Close the connection, by which the process ends, and wait for that."""
        self._connection.close()
        try:
            self._program.wait(_END)
        except subprocess.TimeoutExpired:
            self._program.kill()
            self._program.wait()
        self._errors.close()


def own_python() -> str:
    """Return the interpreter that new processes of this machine are started with: the one that runs this program.

    A program that embeds Python, as QGIS, is no interpreter itself. ``sys.executable`` is then the first interpreter on
    the PATH, which may have another version and fail to load the packages of this one.
    """
    prefix = Path(sys.exec_prefix)
    version = f"python{sys.version_info.major}.{sys.version_info.minor}"
    names = ("python.exe",) if os.name == "nt" else (f"bin/{version}", "bin/python3")
    candidates = [sys.executable, *(str(prefix / name) for name in names)]
    found = [one for one in candidates if Path(one).stem.lower().startswith("python") and Path(one).exists()]
    return next(filter(_is_own, found), (found or [sys.executable])[-1])


def _is_own(python: str) -> bool:
    """Return whether an interpreter has the version and the standard library of this one."""
    # "-I" searches neither the current folder nor what the environment names.
    asked = [python, "-I", "-c", "import os, sys; print(sys.version, os.__file__)"]
    try:
        answer = subprocess.run(  # nosec B603 - an interpreter, no shell
            asked, capture_output=True, text=True, timeout=_ANSWER, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return False
    return answer.stdout.strip() == f"{sys.version} {os.__file__}"


def _trusted(search_path: Iterable[str], distrusted: set[Path]) -> list[str]:
    """Return the entries of a search path that don't depend on the current folder and are no folders of data."""
    absolute = (entry for entry in search_path if entry and Path(entry).is_absolute())
    return [entry for entry in absolute if Path(entry).resolve() not in distrusted]


def _inherits(connection: Connection) -> dict[str, Any]:
    """Return the arguments by which a new process inherits a connection, and nothing else."""
    if os.name != "nt":
        return {"pass_fds": (connection.fileno(),), "start_new_session": True}
    handle = connection.fileno()
    os.set_handle_inheritable(handle, True)  # type: ignore[attr-defined]
    startup = subprocess.STARTUPINFO()  # type: ignore[attr-defined]
    startup.lpAttributeList = {"handle_list": [handle]}
    return {"startupinfo": startup, "creationflags": subprocess.CREATE_NO_WINDOW}  # type: ignore[attr-defined]


def _not_started(python: str, why: str) -> str:
    return f"Worker processes can't be started with {python} ({why}); set the number of processes to 1."


def _drained(calls: SimpleQueue) -> list:
    """Return the items of a queue, and empty it."""
    found = []
    while True:
        try:
            found.append(calls.get_nowait())
        except Empty:
            return found
