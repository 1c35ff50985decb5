"""What clouds need of this computer's memory."""

from ..algorithms.memory import installed_memory
from ..algorithms.stage import Monitor
from ..algorithms.stages import less_memory

# Bytes that stages take per point at most, the points themselves included.
_PER_POINT = 400

# Bytes of the unit of the message.
_GB = 1e9


def warn_if_memory_is_short(n_points: int, monitor: Monitor) -> None:
    """Warn of clouds that hardly fit into memory: where it ends, most systems end QGIS without a word."""
    installed, needed = installed_memory(), _PER_POINT * n_points
    if needed > installed:
        monitor.warn(
            f"{n_points:,} points may need {needed / _GB:.1f} GB of memory, this computer has {installed / _GB:.1f}; "
            f"if that is not enough, {less_memory()}."
        )
