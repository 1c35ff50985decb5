"""Which Dask schedulers a run may connect to: those that the user has confirmed, wherever an address comes from.

Whoever controls a scheduler runs code as the user. An address may come with a model or a project of somebody else.
"""

import re

from qgis.core import QgsApplication

from .options import GROUP, SCHEDULERS
from .qgis_crs import is_main_thread
from .questions import is_answered_yes

# How addresses of schedulers are written: with nothing in them by which one could look like another.
_ADDRESS = re.compile(r"(?:[a-z]+://)?[A-Za-z0-9._:\[\]%-]+/?")


def confirmed() -> list[str]:
    """Return the addresses that the user has confirmed."""
    return SCHEDULERS.value.split()


def check_scheduler(address: str) -> None:
    """Refuse the address of a Dask scheduler that the user has not confirmed; in a window, ask first.

    Raises
    ------
    ValueError
        If it is no address, or not confirmed; the message says how to confirm it.
    """
    if not address:
        return
    if not _ADDRESS.fullmatch(address):
        raise ValueError(f"The Dask scheduler (SCHEDULER) must be an address like tcp://host:8786, got {address!r}.")
    if address in confirmed():
        return
    if _has_windows() and _is_wanted(address):
        SCHEDULERS.set(" ".join([*confirmed(), address]))
        return
    raise ValueError(
        f"The Dask scheduler {address!r} (SCHEDULER) was not confirmed, and whoever controls it can run code as you; "
        f"if it is yours, add it to '{SCHEDULERS.title}' under Settings ▸ Options ▸ Processing ▸ Providers ▸ {GROUP}."
    )


def _has_windows() -> bool:
    """Whether the user can be asked: in the desktop, from the thread of its windows."""
    return QgsApplication.platform() == "desktop" and is_main_thread()


def _is_wanted(address: str) -> bool:
    """Ask whether a scheduler may be used."""
    return is_answered_yes(
        None,
        GROUP,
        f"Connect to the Dask scheduler at {address}?\n\nWhoever controls it can run code as you, also on this "
        "computer: answer Yes only if it is yours. The address is then kept in the options of Processing.",
    )
