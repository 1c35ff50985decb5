"""Workers: processes of this machine, or of a running Dask cluster."""

import os
import pickle  # nosec B403 - what goes to the cluster that the user has confirmed; no file is unpickled
import shutil
import tempfile
import time
from collections.abc import Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any, Callable, Optional

from ..cloud.outputs import DiskFullError
from ..memory import installed_memory
from ..stage import Cancelled, Monitor
from ..threads import BETWEEN_LOOKS, n_threads
from .processes import ANSWER, FOLDER, PACKAGE, CannotStart, Processes, WorkerEnded

# Seconds between two messages about tasks that are done or waited for.
BETWEEN_MESSAGES = 10.0

# The message if a cluster has dropped its work.
_DROPPED = (
    "The Dask scheduler has ended or dropped the work; start it and the same run again, which goes on from there."
)


@dataclass(frozen=True)
class Workers:
    """Where blocks are worked on."""

    #: Processes of this machine; None is one for each core that this program may use, as far as memory reaches. With 1
    #: the work is done in this process.
    processes: Optional[int] = None
    #: Address of a Dask scheduler ("tcp://host:8786", "tls://host:8786"); "" for processes of this machine
    scheduler: str = ""
    #: For tls: files of the certificate authority, of this program's certificate and of its key
    certificates: tuple[str, ...] = ()

    @contextmanager
    def open(self, distrusted: Iterable[Path] = (), memory: float = 1.0) -> Iterator[Executor]:
        """Give an executor, as ``concurrent.futures`` has them; it is closed at the end.

        Parameters
        ----------
        distrusted : iterable of Path
            Folders of data: processes of this machine import no module from them.
        memory : float
            Bytes that a process needs.

        Raises
        ------
        ValueError
            If there is no scheduler, or its package is missing.
        """
        if self.scheduler:
            with self._cluster() as executor:
                yield executor
            return
        count = self.count(memory)
        if count == 1:
            with ThreadPoolExecutor(1) as thread:
                yield thread
            return
        processes = Processes(count, max(1, n_threads() // count), distrusted)
        try:
            yield processes
        finally:
            processes.shutdown(cancel_futures=True)

    def count(self, memory: float) -> int:
        """Return the number of processes on this machine, each of which needs ``memory`` bytes."""
        have_room = self.memory(1) / memory
        count = self.processes or int(max(1, min(n_threads(), have_room)))
        # The most processes that concurrent.futures allows on Windows.
        return min(count, 61) if os.name == "nt" else count

    def memory(self, count: int) -> float:
        """Return the bytes of memory for each of ``count`` processes."""
        # The rest is for the system, QGIS and enlarged windows.
        return 0.75 * installed_memory() / count

    @contextmanager
    def _cluster(self) -> Iterator[Executor]:
        """Give an executor of the cluster of the scheduler."""
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
            files = {"tls_ca_file": authority, "tls_client_cert": certificate, "tls_client_key": key}
            security = distributed.Security(**files, require_encryption=True)
        try:
            client = distributed.Client(self.scheduler, timeout=ANSWER, security=security, set_as_default=False)
        except (OSError, ValueError, TypeError) as error:
            raise ValueError(
                f"No Dask scheduler answers at {self.scheduler} ({error}); start it or check the address."
            ) from None
        with client, tempfile.TemporaryDirectory() as folder:
            # Workers that come later get the program too, and always this version of it.
            client.register_plugin(distributed.diagnostics.plugin.UploadFile(str(_archive(Path(folder)))))
            executor = client.get_executor(pure=False, retries=1)
            try:
                yield _Remote(client, executor)
            finally:
                executor.shutdown(wait=False)


class _Call:
    """A call that is made where it is unpickled."""

    def __init__(self, function: Callable, argument: Any) -> None:
        self.function, self.argument = function, argument

    def __reduce__(self) -> tuple:
        return self.function, (self.argument,)


class _Remote(Executor):
    """An executor of a cluster, to which calls go as bytes.

    The scheduler unpickles functions and arguments that it passes on, but only workers have this program.
    """

    def __init__(self, client: Any, executor: Executor) -> None:
        self._client, self._executor = client, executor

    def submit(self, fn: Callable, /, *args: Any, **kwargs: Any) -> Future:
        """Have a worker call a function with one argument."""
        if self._client.status != "running":
            raise ValueError(_DROPPED)
        return self._executor.submit(pickle.loads, pickle.dumps(_Call(fn, *args)))

    def at_work(self) -> str:
        """Return the workers at work, in words."""
        if self._client.status != "running":
            return "the Dask scheduler does not answer"
        count = len(self._client.scheduler_info()["workers"])
        return f"the Dask scheduler has {count or 'no'} worker{'s' * (count != 1)}"


def _archive(folder: Path) -> Path:
    """Write a zip of the core, which imports no QGIS, and return it."""
    package = folder / "content" / PACKAGE
    ignored = shutil.ignore_patterns("__pycache__", "*.pyc")
    shutil.copytree(FOLDER / "algorithms", package / "algorithms", ignore=ignored)
    shutil.copy(FOLDER / "requirements.txt", package)
    (package / "__init__.py").write_text('"""The core of LiDAR Buildings, as workers import it."""\n', encoding="utf-8")
    return Path(shutil.make_archive(str(folder / PACKAGE), "zip", folder / "content"))


def run_all(
    executor: Executor, work: Callable[[Any], Any], tasks: list, stop: Path, monitor: Monitor, on_done: Callable
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
        A file by which running work stops; it is made when the user cancels.
    monitor : Monitor
        Receives the share of tasks that are done, and messages while no task ends.
    on_done : callable
        Is called with the position of every task that is done.

    Raises
    ------
    Cancelled
        If the user cancels; no work is left running then.
    ValueError
        If processes of this machine can't be started, the disk is full, or a scheduler has ended.
    """
    waiting = {executor.submit(work, task): number for number, task in enumerate(tasks)}
    results: dict[int, Any] = {}
    failed: dict[int, str] = {}
    open_: set[Future] = set(waiting)
    last = time.monotonic()
    try:
        while open_:
            done, open_ = wait(open_, timeout=BETWEEN_LOOKS, return_when=FIRST_COMPLETED)
            if done:
                last = time.monotonic()
            elif time.monotonic() - last > BETWEEN_MESSAGES:
                last = time.monotonic()
                monitor.inform(f"Waiting for {len(open_)} of {len(tasks)} tasks: {_at_work(executor)}.")
            for future in done:
                number = waiting[future]
                if future.cancelled():
                    raise ValueError(_DROPPED)
                error = future.exception()
                if error is None:
                    results[number] = future.result()
                else:
                    failed[number] = _why_failed(error)
                on_done(number)
            monitor.progress(1 - len(open_) / max(1, len(tasks)))
    except BaseException as error:
        # On a full disk work ends with its block.
        with suppress(OSError):
            stop.touch()
        for future in open_:
            future.cancel()
        if isinstance(error, Cancelled):
            # Work has that long (s) to end by itself; then its process is ended.
            wait([future for future in open_ if not future.cancelled()], timeout=1.5)
        raise
    return results, failed


def _why_failed(error: BaseException) -> str:
    """Return the cause of a failed task, in a sentence; raise errors that all other work would meet, too."""
    if isinstance(error, DiskFullError):
        raise error
    if isinstance(error, (ValueError, OSError, MemoryError)):
        return str(error) or type(error).__name__
    if isinstance(error, CannotStart):
        raise ValueError(str(error)) from error
    # The latter is Dask's, when the workers that were given a task have died one after the other.
    if isinstance(error, WorkerEnded) or type(error).__name__ == "KilledWorker":
        return (
            "the processes that worked on it were ended, by the system where memory was short; run it again with fewer "
            "processes or smaller blocks."
        )
    raise error


def _at_work(executor: Executor) -> str:
    """Return the workers at work for an executor of :class:`Workers`, in words."""
    return executor.at_work() if isinstance(executor, (Processes, _Remote)) else "this process is at work"
