"""Show texts of files in sentences to the user."""


def shown(text: str, longest: int = 60) -> str:
    """Return a text as a sentence may show it: printable, in one line, at most ``longest`` characters.

    In damaged files texts hold control characters and halves of characters.
    """
    printable = "".join(one if one.isprintable() else " " for one in text[: 2 * longest])
    line = " ".join(printable.split())
    return line if len(line) <= longest else f"{line[: longest - 1]}…"
