"""Errors of the core as Processing shows them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from qgis.core import QgsProcessingException

from ..algorithms.stage import Cancelled


@contextmanager
def one_sentence() -> Iterator[None]:
    """Turn the core's errors into Processing's, one sentence each.

    A cancelled run is an error too: otherwise ``qgis_process`` ends with exit code 0. What is
    neither of these is a fault of the program and keeps its traceback.
    """
    try:
        yield
    except Cancelled:
        raise QgsProcessingException("Cancelled; nothing was written.") from None
    except MemoryError:
        raise QgsProcessingException(
            "This needs more memory than there is; cut the cloud into tiles, or thin it with 'Downsample to voxels'."
        ) from None
    except ValueError as error:
        raise QgsProcessingException(str(error)) from error
    except OSError as error:
        where = f" ({error.filename})" if error.filename else ""
        raise QgsProcessingException(f"A file can't be read or written{where}: {error.strerror or error}.") from error
