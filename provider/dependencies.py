"""What is missing on this machine, and the one command that mends it."""

from __future__ import annotations

import shlex
import sys
from pathlib import Path

from qgis.core import QgsApplication

from ..algorithms import packages

# pip must not resolve dependencies (it would put a second numpy before QGIS's own), so those that are
# not part of numpy's family are named here.
_WITH = {"scikit-learn": ("scikit-learn", "joblib", "threadpoolctl")}
_DEBIAN = {"scipy": "python3-scipy", "scikit-learn": "python3-sklearn"}


def missing_sentence() -> str:
    """Return which packages are missing and the command that installs them; "" when all are there."""
    missing = packages.missing()
    if not missing:
        return ""
    noun = "package is" if len(missing) == 1 else "packages are"
    return f"Python {noun} missing: {', '.join(missing)}. Run this in a terminal and restart QGIS: {command(missing)}"


def command(missing: list) -> str:
    """Return the command that installs ``missing`` for the Python that QGIS runs, on this platform."""
    commands = []
    if _is_debian():
        # scipy and scikit-learn have to fit the system's numpy: the system's own do.
        system = [_DEBIAN[name] for name in missing if name in _DEBIAN]
        missing = [name for name in missing if name not in _DEBIAN]
        if system:
            commands.append("sudo apt-get install -y " + " ".join(system))
    if missing:
        names = [name for package in missing for name in _WITH.get(package, (package,))]
        target = Path(QgsApplication.qgisSettingsDirPath()) / "python"
        commands.append(
            f"{_quoted(python())} -m pip install --no-deps --target {_quoted(str(target))} {' '.join(names)}"
        )
    return " && ".join(commands)


def python() -> str:
    """Return the Python interpreter of this QGIS; ``sys.executable`` may be QGIS itself."""
    executable = Path(sys.executable or "")
    if executable.name.lower().startswith("python"):
        return str(executable)
    base = Path(sys.base_prefix)
    places = (base / "python.exe", executable.parent / "bin" / "python3", base / "bin" / "python3")
    return next((str(place) for place in places if place.is_file()), "python3")


def _is_debian() -> bool:
    return Path("/etc/debian_version").exists()


def _quoted(text: str) -> str:
    if sys.platform == "win32":
        return f'"{text}"' if " " in text else text
    return shlex.quote(text)
