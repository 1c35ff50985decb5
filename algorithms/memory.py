"""Freed memory, returned to the system."""

from __future__ import annotations

import ctypes
import sys
from typing import Callable, Optional


def _trim() -> Optional[Callable[[int], int]]:
    """Return the C library's function that returns freed memory; None where it has none."""
    return getattr(ctypes.CDLL(None), "malloc_trim", None) if sys.platform.startswith("linux") else None


def return_freed() -> None:
    """Return the memory of freed arrays to the system where the C library keeps it, which GNU's does.

    Memory that one stage has freed lies in pieces between memory in use. The large arrays of the next one don't fit
    into them, so that without this the process holds both.
    """
    trim = _trim()
    if trim is not None:
        trim(0)
