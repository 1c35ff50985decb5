#!/usr/bin/env python3
"""Check in half a minute what differs from main: style, types, imports, and the tests of the modules that changed.

These are the tests of their names, tests of their rooms that import them, their examples, and the contract of stages.
Tests marked as slow are left out, and after 20 seconds no further ones begin, as is said then; ``make test`` runs
everything.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PYTEST = (sys.executable, "-m", "pytest", "-x", "-q", "--no-header", "-m", "not slow")
WITHOUT_QGIS = ("-p", "no:pytest_qgis")
# What every module keeps to; of these, the tests are run that name a module that changed.
CONTRACT = ("tests/test_contract.py", "tests/test_docstrings.py", "tests/test_imports.py", "tests/test_references.py")
STYLE = (("ruff", "check", "."), ("ruff", "format", "--check", "--quiet", "."), ("mypy",))
# Folders whose modules these tests name.
ROOMS = ("algorithms", "provider", "tests")
# Seconds after which no further test begins: most take less than those left of half a minute.
TIME = 20.0
# Pytest ends with these where time is over, and where a part has no test, or but slow ones.
STOPPED, NO_TESTS = 2, 5


def git(*words: str) -> list[str]:
    """Return the lines that a command of git prints."""
    return subprocess.run(("git", *words), cwd=ROOT, check=True, capture_output=True, text=True).stdout.splitlines()


def changed() -> list[Path]:
    """Return the modules that differ from main where this branch began, new ones too."""
    (base,) = git("merge-base", "main", "HEAD")
    names = {*git("diff", "--name-only", base), *git("ls-files", "--others", "--exclude-standard")}
    return sorted(path for path in map(Path, names) if path.suffix == ".py" and (ROOT / path).is_file())


def tests_of(module: Path) -> set[str]:
    """Return the files with tests of a module of the core or the provider, or itself where it is one of tests."""
    if module.parts[0] == "tests":
        return {str(module)} if module.name.startswith("test_") else set()
    if module.parts[0] not in ROOMS:
        return set()
    room, names = ROOT / "tests" / module.parent, ".".join(module.with_suffix("").parts)
    named = re.compile(
        rf"^from lidar_buildings\.(?:{re.escape(names)} import|.+ import .*\b{module.stem}\b)", re.MULTILINE
    )
    found = {path for path in room.glob("test_*.py") if named.search(path.read_text(encoding="utf-8"))}
    found |= {path for path in [room / f"test_{module.stem}.py"] if path.is_file()}
    examples = {str(module)} if module.parts[0] == "algorithms" else set()
    return examples | {str(path.relative_to(ROOT)) for path in found}


def run(command: tuple[str, ...], until: float) -> tuple[str, bool]:
    """Return what a command prints, and whether it found nothing wrong; tests begin ``until`` a time."""
    # Pytest keeps tests compiled where Python may.
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "", "TESTS_BEGIN_UNTIL": str(until)}
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    return done.stdout + done.stderr, done.returncode in ((0, STOPPED, NO_TESTS) if "pytest" in command else (0,))


def commands(modules: list[Path]) -> list[tuple[str, ...]]:
    """Return the commands that check modules."""
    named = {f"test_{path.stem}" for path in modules}
    tests = sorted(set().union(*map(tests_of, modules)), key=lambda one: (Path(one).stem not in named, one))
    of_qgis = [path for path in tests if path.startswith(("tests/provider", "tests/qgis"))]
    of_core = [path for path in tests if path not in of_qgis]
    stems = " or ".join(sorted({path.stem.removeprefix("test_") for path in modules if path.parts[0] in ROOMS}))
    found = [
        tuple(str(Path(sys.executable).parent / one[0]) if not at else word for at, word in enumerate(one))
        for one in STYLE
    ]
    if stems:
        found.append((*PYTEST, *WITHOUT_QGIS, "-k", stems, *CONTRACT))
    if of_core:
        found.append((*PYTEST, *WITHOUT_QGIS, *of_core))
    if of_qgis:
        found.append((str(ROOT / "scripts" / "offscreen.sh"), *PYTEST, *of_qgis))
    return found


def main() -> int:
    """Run all commands, two at once; return 1 if one found something wrong."""
    start, modules = time.time(), changed()
    with ThreadPoolExecutor(2) as pool:
        results = list(pool.map(lambda command: run(command, start + TIME), commands(modules)))
    for printed, is_sound in results:
        lines = printed.strip().splitlines()
        print(*(lines[-2:] if is_sound else lines), sep="\n")
    is_sound = all(sound for _, sound in results)
    found = "nothing wrong was found" if is_sound else "something is WRONG, see above"
    print(f"{len(modules)} modules changed; {found} in {time.time() - start:.0f} s.")
    return 0 if is_sound else 1


if __name__ == "__main__":
    sys.exit(main())
