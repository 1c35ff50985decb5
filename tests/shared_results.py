"""Results that take their time, made once by all processes of a run of the tests."""

from __future__ import annotations

import io
import os
import pickle
from pathlib import Path
from typing import Any, Callable
from weakref import ReferenceType, ref

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

# Names the folder of these results, which ends with the run; without it each process makes its own.
SHARED_RESULTS = "LIDAR_BUILDINGS_SHARED_RESULTS"


class _Pickler(pickle.Pickler):
    """A pickler that writes a weak reference as one whose object is gone."""

    def reducer_override(self, value: Any) -> Any:
        return (_dead_reference, ()) if isinstance(value, ReferenceType) else NotImplemented


def _dead_reference() -> ReferenceType:
    return ref(_Pickler(io.BytesIO()))


def made_once(key: str, make: Callable[[], Any]) -> Any:
    """Return what ``make`` returns, made by the first process that asks for it; others wait for that one."""
    folder = os.environ.get(SHARED_RESULTS)
    if not folder or fcntl is None:
        return make()
    path = Path(folder) / key.replace("/", "-")
    with path.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if path.exists():
            return pickle.loads(path.read_bytes())
        made = make()
        with path.open("wb") as file:
            _Pickler(file, pickle.HIGHEST_PROTOCOL).dump(made)
    return made
