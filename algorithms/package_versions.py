"""Versions of the packages that the plugin installs: wanted, as ``requirements.txt`` has them, and installed."""

import importlib.metadata
import pkgutil
import re
from functools import cache

# The package of the plugin, in whose folder, or zip where workers of a cluster run it, the requirements are.
_PLUGIN = __name__.split(".", maxsplit=1)[0]
# A line of the requirements: name, and bounds of versions, of which the first is the least.
_LINE = re.compile(r"(?P<name>[\w.-]+)(?P<bounds>>=(?P<least>[\d.]+)\S*)")


def requirement(name: str) -> str:
    """Return a package with the bounds of its version, as pip takes it; the name alone where there are none."""
    found = _requirements().get(name)
    return name + found["bounds"] if found else name


def too_old(name: str) -> str:
    """Return the version of a package that is installed, where it is less than the least one wanted; "" otherwise."""
    wanted, installed = _requirements().get(name), installed_version(name)
    return installed if wanted and installed and _numbers(installed) < _numbers(wanted["least"]) else ""


def forget_versions() -> None:
    """Look versions up again: packages were installed."""
    installed_version.cache_clear()


@cache
def _requirements() -> dict[str, re.Match]:
    """Return the lines of the requirements by the names of their packages."""
    lines = (pkgutil.get_data(_PLUGIN, "requirements.txt") or b"").decode().splitlines()
    return {found["name"]: found for found in map(_LINE.match, lines) if found}


@cache
def installed_version(name: str) -> str:
    """Return the version of a package that Python finds first, "" where none says its version."""
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return ""


def _numbers(version: str) -> list[int]:
    """Return the numbers that a version begins with: 2, 5, 0 of "2.5.0rc1"."""
    return [int(number) for number in re.findall(r"\d+", re.sub(r"[^\d.].*", "", version))]
