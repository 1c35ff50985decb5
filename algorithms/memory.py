"""Memory of this computer: how much it has; freed memory is shared by threads, and returned to the system."""

import ctypes
import os
import sys
from typing import Callable, Optional


def installed_memory() -> float:
    """Return the bytes of memory of this computer, infinity where the system doesn't report it."""
    try:
        if sys.platform == "win32":
            kilobytes = ctypes.c_ulonglong()
            is_known = ctypes.windll.kernel32.GetPhysicallyInstalledSystemMemory(ctypes.byref(kilobytes))
            return 1024.0 * kilobytes.value if is_known else float("inf")
        return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, ValueError, OSError):
        return float("inf")


def _of_libc(name: str) -> Optional[Callable[..., int]]:
    """Return a function of the C library; None where it has none of that name."""
    return getattr(ctypes.CDLL(None), name, None) if sys.platform.startswith("linux") else None


def share_freed() -> None:
    """Let threads take memory that others have freed, where the C library would give each an arena of its own.

    An arena keeps what its thread has freed, so that each holds as much as its thread ever needed. Arrays are large and
    few: threads hardly wait for each other. Arenas that there are already stay.
    """
    set_option = _of_libc("mallopt")
    if set_option is not None:
        # By its number in malloc.h: the most arenas of a process.
        set_option(-8, 1)


def return_freed() -> None:
    """Return the memory of freed arrays to the system where the C library keeps it, which GNU's does.

    Memory that one stage has freed lies in pieces between memory in use. The large arrays of the next one don't fit
    into them, so that without this the process holds both.
    """
    trim = _of_libc("malloc_trim")
    if trim is not None:
        trim(0)
