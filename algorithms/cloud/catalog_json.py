"""Read descriptions of point clouds in JSON, in bounded memory."""

import json
from pathlib import Path
from typing import Any

# Memory that the content of a virtual point cloud may take (bytes): enough for 4,000 tiles with the statistics of all
# their dimensions, of 20 kB each.
_MOST_MEMORY = 450_000_000
# Memory that one value of JSON takes at most in addition to its characters (bytes): a text beyond ASCII does. The
# values are bounded by the number of the four signs that may precede one, some of which may be characters of texts.
_BYTES_PER_VALUE = 90


def read_json(path: Path) -> Any:
    """Return the content of a JSON file, None where it is damaged.

    Raises
    ------
    ValueError
        If it would take more memory than any description does.
    """
    raw = _bytes_of(path)
    try:
        # Of bytes, the encoding is found out, by a byte order mark too.
        return json.loads(raw)
    except (ValueError, RecursionError):
        return None


def _bytes_of(path: Path) -> bytes:
    """Return the bytes of a file that is parsed in a bounded memory.

    Raises
    ------
    ValueError
        If it would take more.
    """
    size = path.stat().st_size
    # The bytes, and the text with at least a byte for each.
    needed = 2 * size
    if needed <= _MOST_MEMORY:
        raw = path.read_bytes()
        n_values = sum(map(raw.count, (b"[", b"{", b",", b":")))
        # Other text than ASCII has up to four bytes for a character.
        needed = len(raw) * (2 if raw.isascii() else 5) + n_values * _BYTES_PER_VALUE
    if needed > _MOST_MEMORY:
        raise ValueError(
            f"{path.name} ({size / 1e6:.0f} MB) is larger than a virtual point cloud of thousands of tiles; "
            "build it of fewer tiles."
        )
    return raw
