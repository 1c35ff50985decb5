"""The program of a worker process: it calls the functions that it is sent and returns what they return.

:mod:`.processes` runs this file by its path. It imports nothing of the package before it has received its folder, and
never searches the current folder for modules: a survey's folder may hold files of any origin.
"""

from __future__ import annotations

import importlib.util
import os
import sys
import threading
import traceback
from queue import SimpleQueue
from typing import Any

# Python searches the folder of a program first; the modules here are imported by the name of their package only.
# Before the search path is set, pathlib may not be imported.
_OWN_FOLDER = os.path.dirname(os.path.abspath(__file__))  # noqa: PTH100, PTH120
# Exit code where the other end is gone.
_GONE = 1


def main() -> None:
    """Serve the process at the other end of the connection until it closes it, or ends."""
    sys.path[:] = [folder for folder in sys.path if folder not in ("", _OWN_FOLDER)]
    connection = _connected(int(sys.argv[1]))
    package, folder, search_path, threads = connection.recv()
    sys.path[:] = search_path
    _register(package, folder)
    importlib.import_module(f"{package}.algorithms.threads").use_threads(threads)
    calls: SimpleQueue = SimpleQueue()
    threading.Thread(target=_receive, args=(connection, calls), daemon=True).start()
    connection.send(None)
    while True:
        function, arguments = calls.get()
        _answer(connection, function, arguments)


def _connected(number: int) -> Any:
    """Return the connection with the number of the file or, on Windows, the handle that was inherited."""
    from multiprocessing import connection

    kind = connection.PipeConnection if os.name == "nt" else connection.Connection  # type: ignore[attr-defined]
    return kind(number)


def _register(package: str, folder: str) -> None:
    """Make the package importable by its name, whatever its folder is called."""
    file = os.path.join(folder, "__init__.py")  # noqa: PTH118
    spec = importlib.util.spec_from_file_location(package, file, submodule_search_locations=[folder])
    if spec is None or spec.loader is None:
        raise ImportError(f"There is no package in {folder}.")
    sys.modules[package] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(sys.modules[package])


def _receive(connection: Any, calls: SimpleQueue) -> None:
    """Forward calls; exit at once when the parent closes the pipe or dies."""
    try:
        while True:
            calls.put(connection.recv())
    except (EOFError, OSError):
        os._exit(_GONE)


def _answer(connection: Any, function: Any, arguments: tuple) -> None:
    """Call a function, and send whether it returned, what it returned or raised, and the traceback."""
    try:
        answer = True, function(*arguments), ""
    except Exception as error:
        answer = False, error, traceback.format_exc()
    try:
        connection.send(answer)
    except (TypeError, AttributeError, ValueError) as error:
        # What can't be sent is an error of the program.
        connection.send((False, RuntimeError(f"{answer[1]!r} can't be sent: {error}"), answer[2]))


if __name__ == "__main__":
    main()
