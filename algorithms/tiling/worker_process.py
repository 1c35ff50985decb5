"""The program of a worker process: it calls the functions that it is sent and returns what they return.

:mod:`.processes` runs this file by its path. It imports nothing of the package before it has received its folder, and
never searches the current folder for modules: a survey's folder may hold files of any origin.
"""

import importlib.util
import os
import pickle  # nosec B403 - between a program and the process that it has started
import struct
import sys
import threading
import traceback
from queue import SimpleQueue
from typing import Any

# Python searches the folder of a program first; the modules here are imported by the name of their package only.
# Before the search path is set, pathlib may not be imported.
_OWN_FOLDER = os.path.dirname(os.path.abspath(__file__))  # noqa: PTH100, PTH120
# The size of a message (bytes), which comes before it.
_SIZE = struct.Struct("<Q")


def main() -> None:
    """Serve the process at the other end of the pipes until it closes them, or ends."""
    sys.path[:] = [folder for folder in sys.path if folder not in ("", _OWN_FOLDER)]
    # What libraries print goes nowhere.
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    package, folder, search_path, threads = receive(sys.stdin.buffer)
    sys.path[:] = search_path
    _register(package, folder)
    importlib.import_module(f"{package}.algorithms.threads").use_threads(threads)
    calls: SimpleQueue = SimpleQueue()
    threading.Thread(target=_receive, args=(calls,), daemon=True).start()
    send(answers, None)
    while True:
        _answer(answers, *calls.get())


def send(pipe: Any, message: Any) -> None:
    """Send a message to the process at the other end."""
    data = pickle.dumps(message)
    pipe.write(_SIZE.pack(len(data)))
    pipe.write(data)
    pipe.flush()


def receive(pipe: Any) -> Any:
    """Return the next message; raise EOFError where the other end is closed or its process is gone."""
    head = pipe.read(_SIZE.size)
    data = pipe.read(*_SIZE.unpack(head)) if len(head) == _SIZE.size else b""
    if not data or len(data) < _SIZE.unpack(head)[0]:
        raise EOFError
    return pickle.loads(data)  # nosec B301 - see above


def _register(package: str, folder: str) -> None:
    """Make the package importable by its name, whatever its folder is called."""
    file = os.path.join(folder, "__init__.py")  # noqa: PTH118
    spec = importlib.util.spec_from_file_location(package, file, submodule_search_locations=[folder])
    if spec is None or spec.loader is None:
        raise ImportError(f"There is no package in {folder}.")
    sys.modules[package] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(sys.modules[package])


def _receive(calls: SimpleQueue) -> None:
    """Forward calls; exit at once when the parent closes the pipe or dies."""
    try:
        while True:
            calls.put(receive(sys.stdin.buffer))
    except (EOFError, OSError):
        os._exit(1)


def _answer(answers: Any, function: Any, arguments: tuple) -> None:
    """Call a function, and send whether it returned, what it returned or raised, and the traceback."""
    try:
        answer = True, function(*arguments), ""
    except Exception as error:
        answer = False, error, traceback.format_exc()
    try:
        send(answers, answer)
    except (TypeError, AttributeError, ValueError) as error:
        # What can't be sent is an error of the program.
        send(answers, (False, RuntimeError(f"{answer[1]!r} can't be sent: {error}"), answer[2]))


if __name__ == "__main__":
    main()
