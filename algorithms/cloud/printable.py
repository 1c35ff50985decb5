"""Texts of files in sentences to the user."""

from __future__ import annotations

_LONGEST = 60


def shown(text: str, longest: int = _LONGEST) -> str:
    """Return a text that a file holds as a sentence may show it: printable, in one line, cut where it is long.

    Parameters
    ----------
    text : str
        Anything; in damaged files it holds control characters and halves of characters.
    longest : int
        Characters that are kept.
    """
    printable = "".join(one if one.isprintable() else " " for one in text[: 2 * longest])
    line = " ".join(printable.split())
    return line if len(line) <= longest else f"{line[: longest - 1]}…"
