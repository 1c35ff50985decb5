"""Worker processes of this machine, each with its own pipes, so that one may end without the others.

The pools of Python's library share one pipe between all processes: one that is killed leaves the others, and the
program itself, waiting for each other. They also start their processes with the current folder on the search path and
run the main program again in each. Both are unsafe where the current folder holds somebody's survey.
"""

from __future__ import annotations

import os
import subprocess  # nosec B404 - no shell, see below
import sys
import tempfile
import time
from collections.abc import Iterable
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from threading import Lock, local
from typing import Any, Callable, Optional

from . import worker_process

# The package as workers import it, its folder, and the program that they run.
PACKAGE = __name__.split(".", maxsplit=1)[0]
FOLDER = Path(__file__).resolve().parents[2]
_PROGRAM = str(Path(__file__).with_name("worker_process.py"))

# Seconds that an interpreter has to answer.
ANSWER = 15


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
        self._threads, self._python = threads, own_python()
        self._search_path = _trusted(sys.path, {folder.resolve() for folder in distrusted})
        # Each of these threads waits for a process of its own.
        self._waiting, self._own = ThreadPoolExecutor(count), local()
        self._running: set[_Process] = set()
        self._lock, self._is_closed = Lock(), False

    def submit(self, fn: Callable, /, *args: Any, **kwargs: Any) -> Future:
        """Have a process call a function of a module with positional arguments; return its future.

        The future raises what the function raised, :class:`WorkerEnded` or :class:`CannotStart`.
        """
        return self._waiting.submit(self._call, fn, args)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = True) -> None:
        """End all processes at once, with whatever they work on."""
        with self._lock:
            self._is_closed = True
            for process in self._running:
                process.program.kill()
        self._waiting.shutdown(wait, cancel_futures=cancel_futures)
        for process in list(self._running):
            self._end(process)

    def at_work(self) -> str:
        """Return the names of the processes at work, and since when, in words."""
        with self._lock:
            running = sorted((one.program.pid, time.monotonic() - one.since) for one in self._running)
        said = [f"process {number} has been at work for {seconds:.0f} s" for number, seconds in running]
        return ", ".join(said) or "processes are being started"

    def _call(self, function: Callable, arguments: tuple) -> Any:
        """Return the result of a function in the process of this thread, or in its successor."""
        # Once more where the system ended the process that worked on it.
        for _ in range(2):
            process: Optional[_Process] = getattr(self._own, "process", None)
            try:
                process = self._own.process = process or self._started()
                return process.call(function, arguments)
            except (EOFError, ConnectionError):
                self._own.process = None
                if process is not None:
                    self._end(process)
        raise WorkerEnded

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
            self._end(process)
            raise
        return process

    def _end(self, process: _Process) -> None:
        process.end()
        with self._lock:
            self._running.discard(process)


class _Process:
    """One process: the pipes to and from it, and its messages where it can't start."""

    def __init__(self, python: str, search_path: list[str]) -> None:
        self._python, self._search_path = python, search_path
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115 - open as long as the process runs
        inherited = os.environ.get("PYTHONPATH", "").split(os.pathsep)
        kept = os.pathsep.join(one for one in inherited if one in search_path)
        # Signals of a terminal are for the main process: it ends the others.
        apart: dict[str, Any] = {"start_new_session": True}
        if os.name == "nt":
            apart = {"creationflags": subprocess.CREATE_NO_WINDOW}  # type: ignore[attr-defined]
        try:
            self.program = subprocess.Popen(  # nosec B603 - the interpreter that runs this, no shell
                [python, _PROGRAM],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=self._errors,
                env={**os.environ, "PYTHONSAFEPATH": "1", "PYTHONPATH": kept},
                **apart,
            )
        except OSError as error:
            self._errors.close()
            raise CannotStart(_not_started(python, error.strerror or str(error))) from error
        #: When it began with its call, or was started (s)
        self.since = time.monotonic()

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
            self._answer(PACKAGE, str(FOLDER), self._search_path, threads)
        except (EOFError, ConnectionError):
            code = self.program.wait()
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
        self.since = time.monotonic()
        returned, value, trace = self._answer(function, arguments)
        if returned:
            return value
        if isinstance(value, (EOFError, ConnectionError)):
            # Of a file or a network drive, not of these pipes.
            raise OSError(str(value))
        raise value from RuntimeError(trace)

    def _answer(self, *message: Any) -> Any:
        """Send a message, and return the answer."""
        try:
            worker_process.send(self.program.stdin, message)
        except OSError as error:
            # Windows has another error where the process has ended.
            raise ConnectionError(str(error)) from error
        return worker_process.receive(self.program.stdout)

    def end(self) -> None:
        """Close the pipes, by which the process ends, and wait for that."""
        for pipe in (self.program.stdin, self.program.stdout):
            # What could not be sent to a process that has ended.
            with suppress(OSError):
                pipe.close()  # type: ignore[union-attr]
        try:
            self.program.wait(timeout=5)
        except subprocess.TimeoutExpired:
            self.program.kill()
            self.program.wait()
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
            asked, capture_output=True, text=True, timeout=ANSWER, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return False
    return answer.stdout.strip() == f"{sys.version} {os.__file__}"


def _trusted(search_path: Iterable[str], distrusted: set[Path]) -> list[str]:
    """Return the entries of a search path that don't depend on the current folder and are no folders of data."""
    absolute = (entry for entry in search_path if entry and Path(entry).is_absolute())
    return [entry for entry in absolute if Path(entry).resolve() not in distrusted]


def _not_started(python: str, why: str) -> str:
    return f"Worker processes can't be started with {python} ({why}); set the number of processes to 1."
