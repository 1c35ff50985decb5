"""What is missing on this machine, and the one command that mends it."""

import importlib.util
import shlex
import sys
from collections.abc import Collection
from pathlib import Path

from qgis.core import QgsApplication

from ..algorithms import packages
from ..algorithms.package_versions import requirement, too_old
from ..algorithms.tiling.processes import own_python

# pip must not resolve dependencies (it would put a second numpy before QGIS's own), so those that are
# not part of numpy's family are named here.
_WITH = {"scikit-learn": ("scikit-learn", "joblib", "threadpoolctl")}
# Packages that Debian's system has to install, by the names that it and pip give them.
_DEBIAN = {"scipy": "python3-scipy", "scikit-learn": "python3-sklearn"}
_DEBIAN_PIP = "python3-pip"


def missing_sentence(needed: Collection[str] = packages.ESSENTIAL) -> str:
    """Return the missing ones of the needed packages and the command that installs them; "" when all are there.

    Without a package for LAZ alone everything but LAZ and COPC works, see :func:`laz_sentence`.
    """
    return _sentence(packages.missing(needed), packages.absent(needed))


def laz_sentence() -> str:
    """Return that LAZ and COPC can't be read, and the command that mends it; "" where they can."""
    return "" if packages.has_laz() else f"Only LAS files can be read and written. {_sentence(['lazrs'], ['lazrs'])}"


def lacking_sentence(needed: Collection[str] = packages.ESSENTIAL) -> str:
    """Return a sentence on missing packages and how to install them, "" if none: those needed, else for LAZ."""
    return missing_sentence(needed) or laz_sentence()


def _sentence(missing: list[str], wanted: list[str]) -> str:
    if not missing:
        return ""
    noun = "package is" if len(missing) == 1 else "packages are"
    state = "missing or too old" if any(map(too_old, missing)) else "missing"
    return (
        f"Python {noun} {state}: {', '.join(map(_described, missing))}. Choose Plugins ▸ LiDAR Buildings ▸ Check "
        f"installation, or run this in a terminal and restart QGIS: {command(wanted)}"
    )


def _described(name: str) -> str:
    """Return a package, with its version and the one that is needed where it is too old."""
    return f"{name} ({too_old(name)}, {requirement(name)} is needed)" if too_old(name) else name


def command(missing: list[str]) -> str:
    """Return the command that installs ``missing`` for the Python that QGIS runs, on this platform."""
    commands = [system_command(missing), shown_command(missing)]
    return " && ".join(one for one in commands if one)


def system_command(missing: list[str]) -> str:
    """Return the command for those packages that the system has to install, "" for none."""
    if not _is_debian():
        return ""
    # scipy and scikit-learn have to fit the system's numpy: the system's own do.
    names = [_DEBIAN[name] for name in missing if name in _DEBIAN]
    if _by_pip(missing) and importlib.util.find_spec("pip") is None:
        names.append(_DEBIAN_PIP)
    return f"sudo apt-get install -y {' '.join(names)}" if names else ""


def shown_command(missing: list[str]) -> str:
    """Return the command for the packages that pip installs, as a terminal takes it; "" for none."""
    if not _by_pip(missing):
        return ""
    return " ".join(_quoted(part) for part in (python(), *pip_arguments(missing)))


def pip_arguments(missing: list[str]) -> list[str]:
    """Return the arguments with which QGIS's interpreter installs packages into the profile.

    "-I" takes no module from the current folder, in which a "pip.py" may lie, or from where the environment says.
    """
    names = [requirement(name) for package in _by_pip(missing) for name in _WITH.get(package, (package,))]
    return ["-I", "-m", "pip", "install", "--upgrade", "--no-deps", "--target", str(package_folder()), *names]


def package_folder() -> Path:
    """Return the folder of the profile in which QGIS looks for packages."""
    return Path(QgsApplication.qgisSettingsDirPath()) / "python"


def _by_pip(missing: list[str]) -> list[str]:
    """Return the packages that pip installs on this system."""
    return [name for name in missing if not (_is_debian() and name in _DEBIAN)]


def python() -> str:
    """Return the Python interpreter that this QGIS runs, by its version where none is found.

    ``sys.executable`` may be QGIS itself.
    """
    found = own_python()
    if Path(found).stem.lower().startswith("python"):
        return found
    base, executable = Path(sys.base_prefix), Path(sys.executable or "")
    candidates = (base / "python.exe", executable.parent / "bin" / "python3", base / "bin" / "python3")
    version = f"python{sys.version_info.major}.{sys.version_info.minor}"
    return next((str(path) for path in candidates if path.is_file()), version)


def _is_debian() -> bool:
    return Path("/etc/debian_version").exists()


def _quoted(text: str) -> str:
    if sys.platform == "win32":
        return f'"{text}"' if set(" <>&|^") & set(text) else text
    return shlex.quote(text)
