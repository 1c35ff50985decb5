"""Workers: processes of this machine, or those of a Dask cluster that is there already."""

from __future__ import annotations

import os
import pickle
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    Executor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
    wait,
)
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module
from multiprocessing import get_context, set_executable
from pathlib import Path
from typing import Any, Callable, Optional

from ..stage import Cancelled, Monitor
from ..threads import n_threads, use_threads

# Seconds between two looks at whether the user wants to stop.
_BETWEEN_LOOKS = 0.5

# Seconds that a scheduler, or an interpreter, has to answer.
_ANSWER = 15

# What Dask raises, by its name, when the workers that were given a task have died one after the other.
_ALL_DIED = "KilledWorker"

# Of a process that the system has ended.
_ENDED = (
    "a process that worked on it was ended, by the system where memory was short; run it again with fewer processes or "
    "smaller blocks"
)

# Windows waits for no more processes than that.
_MOST_PROCESSES = 61

# The package as workers import it, and the folder it is in.
_PACKAGE = __name__.split(".", maxsplit=1)[0]
_FOLDER = Path(__file__).resolve().parents[2]


def own_python() -> str:
    """Return the interpreter that new processes of this machine are started with: the one that runs this program.

    A program that embeds Python, as QGIS, is no interpreter itself. Python then believes that it is the first one on
    the PATH, which may be another one, that can't load the packages of this one.
    """
    prefix = Path(sys.exec_prefix)
    version = f"python{sys.version_info.major}.{sys.version_info.minor}"
    names = ("python.exe",) if os.name == "nt" else (f"bin/{version}", "bin/python3")
    candidates = [sys.executable, *(str(prefix / name) for name in names)]
    found = [one for one in candidates if Path(one).stem.lower().startswith("python") and Path(one).exists()]
    return next(filter(_is_own, found), (found or [sys.executable])[-1])


def _is_own(python: str) -> bool:
    """Return whether an interpreter has the version and the standard library of this one."""
    asked = "import os, sys; print(sys.version, os.__file__)"
    try:
        answer = subprocess.run([python, "-c", asked], capture_output=True, text=True, timeout=_ANSWER, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return False
    return answer.stdout.strip() == f"{sys.version} {os.__file__}"


@dataclass(frozen=True)
class Workers:
    """Where blocks are worked on.

    Attributes
    ----------
    processes : int or None
        Processes of this machine; None is one for each core that this program may use. With 1 the work is done in
        this process.
    scheduler : str
        Address of a Dask scheduler ("tcp://host:8786", "tls://host:8786"); "" for processes of this machine.
    certificates : tuple of str
        For tls: files of the certificate authority, of this program's certificate and of its key.
    """

    processes: Optional[int] = None
    scheduler: str = ""
    certificates: tuple[str, ...] = ()

    @contextmanager
    def open(self) -> Iterator[Executor]:
        """Give an executor, as ``concurrent.futures`` has them; it is closed at the end.

        Raises
        ------
        ValueError
            If there is no scheduler, or its package is missing.
        """
        if self.scheduler:
            with self._cluster() as executor:
                yield executor
            return
        count = self.processes or n_threads()
        if os.name == "nt":
            count = min(count, _MOST_PROCESSES)
        if count == 1:
            with ThreadPoolExecutor(1) as here:
                yield here
            return
        # A program that has threads, as QGIS, can't be forked safely.
        set_executable(own_python())
        context = get_context("spawn")
        threads = max(1, n_threads() // count)
        executor = ProcessPoolExecutor(count, context, initializer=use_threads, initargs=(threads,))
        try:
            yield executor
        finally:
            executor.shutdown(wait=True, cancel_futures=True)

    @contextmanager
    def _cluster(self) -> Iterator[Executor]:
        try:
            distributed = import_module("distributed")
        except ImportError:
            raise ValueError(
                "A Dask scheduler needs the package distributed; install it with 'python -m pip install distributed', "
                "or leave the address of the scheduler empty."
            ) from None
        security = None
        if self.certificates:
            authority, certificate, key = self.certificates
            security = distributed.Security(
                tls_ca_file=authority, tls_client_cert=certificate, tls_client_key=key, require_encryption=True
            )
        try:
            client = distributed.Client(self.scheduler, timeout=_ANSWER, security=security, set_as_default=False)
        except (OSError, ValueError, TypeError) as error:
            raise ValueError(
                f"No Dask scheduler answers at {self.scheduler} ({error}); start it or check the address."
            ) from None
        with client, tempfile.TemporaryDirectory() as folder:
            # Workers that come later get the program too, and always this version of it.
            client.register_plugin(distributed.diagnostics.plugin.UploadFile(str(_archive(Path(folder)))))
            executor = client.get_executor(pure=False, retries=1)
            try:
                yield _Remote(executor)
            finally:
                executor.shutdown(wait=False)


class _Call:
    """A call that is made where it is unpickled."""

    def __init__(self, function: Callable, argument: Any) -> None:
        self.function, self.argument = function, argument

    def __reduce__(self) -> tuple:
        return self.function, (self.argument,)


class _Remote(Executor):
    """An executor of a cluster. Its scheduler reads all that it passes on, and only its workers have this program."""

    def __init__(self, executor: Executor) -> None:
        self._executor = executor

    def submit(self, fn: Callable, /, *args: Any, **kwargs: Any) -> Future:
        """Have a worker call a function with one argument."""
        return self._executor.submit(pickle.loads, pickle.dumps(_Call(fn, *args)))


def _archive(folder: Path) -> Path:
    """Write a zip of the core, which imports no QGIS, and return it."""
    package = folder / "content" / _PACKAGE
    ignored = shutil.ignore_patterns("__pycache__", "*.pyc")
    shutil.copytree(_FOLDER / "algorithms", package / "algorithms", ignore=ignored)
    (package / "__init__.py").write_text('"""The core of LiDAR Buildings, as workers import it."""\n', encoding="utf-8")
    return Path(shutil.make_archive(str(folder / _PACKAGE), "zip", folder / "content"))


def run_all(
    executor: Executor, work: Callable[[Any], Any], tasks: list, stop: Path, monitor: Monitor, tell: Callable
) -> tuple[dict[int, Any], dict[int, str]]:
    """Call ``work`` on every task; return the results, and the sentences of those that failed, by position.

    Parameters
    ----------
    executor : Executor
        From :class:`Workers`.
    work : callable
        A function of a module, so that workers can import it.
    tasks : list
        What it is called with.
    stop : Path
        A file that tells running work to stop; it is made when the monitor is told to cancel.
    monitor : Monitor
        Receives the share of tasks that are done.
    tell : callable
        Is called with the position of every task that is done.

    Raises
    ------
    Cancelled
        If the monitor is told to cancel; no work is left running then.
    ValueError
        If a process of this machine ends before its work does.
    """
    waiting = {executor.submit(work, task): number for number, task in enumerate(tasks)}
    results: dict[int, Any] = {}
    failed: dict[int, str] = {}
    open_: set[Future] = set(waiting)
    try:
        while open_:
            done, open_ = wait(open_, timeout=_BETWEEN_LOOKS, return_when=FIRST_COMPLETED)
            for future in done:
                number = waiting[future]
                error = future.exception()
                if error is None:
                    results[number] = future.result()
                elif isinstance(error, (ValueError, OSError, MemoryError)):
                    failed[number] = str(error) or type(error).__name__
                elif isinstance(error, BrokenExecutor):
                    raise ValueError(f"The survey was not finished: {_ENDED}.") from None
                elif type(error).__name__ == _ALL_DIED:
                    failed[number] = f"{_ENDED}."
                else:
                    raise error
                tell(number)
            monitor.progress(1 - len(open_) / max(1, len(tasks)))
    except BaseException as error:
        stop.touch()
        for future in open_:
            future.cancel()
        if isinstance(error, Cancelled):
            wait([future for future in open_ if not future.cancelled()], timeout=_ANSWER)
        raise
    return results, failed
