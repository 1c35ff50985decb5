"""Errors of the core as Processing shows them."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Optional

from qgis.core import QgsProcessingException, QgsProcessingFeedback

from ..algorithms.cloud.printable import shown
from ..algorithms.stage import Cancelled
from ..algorithms.stages import less_memory
from .caller import is_step, on_command_line
from .feedback import ProgressBar

_STOPPED = "Cancelled; nothing was written."

# Characters of a sentence about a file, whose path may have some thousand.
_LONGEST = 1000


@contextmanager
def as_processing_errors(feedback: Optional[QgsProcessingFeedback] = None, cancelled: str = _STOPPED) -> Iterator[None]:
    """Turn the core's errors into Processing's, one sentence each.

    A run that was cancelled by its ``feedback`` ends with the message ``cancelled`` and no error. On the command line
    it is an error, as the exit code would be 0 otherwise. Any other error is a fault of the program and keeps its
    traceback.
    """
    try:
        with _on_its_own_line(feedback):
            yield
    except Cancelled:
        if feedback is None or not feedback.isCanceled() or on_command_line():
            raise QgsProcessingException(cancelled) from None
        if not is_step(feedback):
            feedback.pushInfo(cancelled)
    except MemoryError:
        raise QgsProcessingException(f"This needs more memory than there is; {less_memory()}.") from None
    except ValueError as error:
        raise QgsProcessingException(str(error)) from error
    except OSError as error:
        raise QgsProcessingException(sentence_of(error)) from error


def sentence_of(error: OSError) -> str:
    """Return what an error of the system says of a file."""
    where = f" ({error.filename})" if error.filename else ""
    return shown(f"A file can't be read or written{where}: {error.strerror or error}.", _LONGEST)


@contextmanager
def _on_its_own_line(feedback: Optional[QgsProcessingFeedback]) -> Iterator[None]:
    """End the line of progress on the command line where an error leaves it unfinished."""
    try:
        yield
    except Exception:
        if feedback is not None:
            ProgressBar(feedback).end_line()
        raise
