#!/usr/bin/env python3
"""Make the zip for QGIS's plugin repository, of the files in this folder that ``.gitattributes`` leaves in."""

from __future__ import annotations

import configparser
import subprocess
import sys
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PLUGIN = "lidar_buildings"


def shipped_files() -> list[str]:
    """Return the paths to ship: known to git, or new and not ignored, and not marked ``export-ignore``."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", "--deduplicate"]
    try:
        listed = subprocess.run(
            [*command, "--", ".", ":(exclude,attr:export-ignore)"], cwd=ROOT, check=True, capture_output=True, text=True
        )
    except (OSError, subprocess.CalledProcessError) as error:
        why = getattr(error, "stderr", "").strip() or error
        sys.exit(f"git lists the files to ship, but can't here ({why}); install git and clone the repository.")
    # What is deleted and not committed is still known to git.
    return sorted(name for name in listed.stdout.split("\0") if name and (ROOT / name).is_file())


def make_zip(folder: Path) -> Path:
    """Write ``lidar_buildings-<version>.zip`` into ``folder`` and return its path."""
    metadata = configparser.ConfigParser()
    metadata.read(ROOT / "metadata.txt", encoding="utf-8")
    names = shipped_files()
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{PLUGIN}-{metadata['general']['version']}.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in names:
            archive.write(ROOT / name, f"{PLUGIN}/{name}")
    return path


if __name__ == "__main__":
    made = make_zip(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "dist")
    print(f"{made} ({made.stat().st_size / 1e6:.1f} MB)")
