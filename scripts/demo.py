#!/usr/bin/env python3
"""Show what LiDAR Buildings does: find the buildings of a simulated town, or of a tile, and draw them.

Started by ``make demo``. It runs the plugin as a user does, through ``qgis_process``, and writes into ``demo/``
the classified cloud, the footprints, a quality page and a picture.
"""

from __future__ import annotations

import json
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
DEMO = ROOT / "demo"

# Rates of the quality page that are printed.
FIGURES = ("completeness", "correctness", "f", "quality")


def main(arguments: list[str]) -> None:
    """Run the chain and print the result."""
    DEMO.mkdir(exist_ok=True)
    tile = Path(arguments[0]).resolve() if arguments else simulated_town()
    cloud, footprints, picture = DEMO / "buildings.copc.laz", DEMO / "footprints.gpkg", DEMO / "buildings.png"
    run(f"Finding the buildings of {tile.name}", "detectbuildings", INPUT=tile, OUTPUT=cloud, FOOTPRINTS=footprints)
    rates = assessed(cloud, tile)
    print("\n" + output_of([sys.executable, ROOT / "scripts/picture.py", cloud, footprints, picture]).strip())
    print(f"  classified cloud  {cloud}\n  footprints        {footprints}\n  picture           {picture}")
    if not rates:
        print("The tile has no buildings of its own (class 6), so there is nothing to compare the result with.")
        return
    print(f"  quality           {DEMO / 'quality.html'}")
    origin = "the classes that the tile came with" if arguments else "the town's true classes"
    figures = ", ".join(f"{'F-score' if name == 'f' else name} {rates[name]:.1f} %" for name in FIGURES)
    print(f"Against {origin}, point by point: {figures}.")


def simulated_town() -> Path:
    """Make the scan of a town whose buildings are known."""
    town = DEMO / "town.copc.laz"
    run("Scanning a simulated town", "simulatetown", OUTPUT=town)
    return town


def assessed(cloud: Path, reference: Path) -> dict[str, float]:
    """Return the rates per point, in percent; empty where the reference has no buildings."""
    page = DEMO / "quality.html"
    found = run(
        "Comparing with the classes it came with", "assessbuildings", INPUT=cloud, REFERENCE=reference, REPORT=page
    )
    if found["POINTS_HITS"] + found["POINTS_MISSES"] == 0:
        page.unlink()
        return {}
    return {name: float(found[f"POINTS_{name.upper()}"]) for name in FIGURES}


def run(doing: str, algorithm: str, **parameters: Any) -> dict[str, Any]:
    """Run one of the plugin's algorithms and return its results; end with its error message when it fails."""
    print(f"{doing} … ", end="", flush=True)
    start = time.monotonic()
    command = ["qgis_process", "--json", "run", f"lidarbuildings:{algorithm}", "--"]
    command += [f"{name}={value}" for name, value in parameters.items()]
    results = json.loads(output_of(command))["results"]
    print(f"{time.monotonic() - start:.0f} s")
    return results


def output_of(command: list) -> str:
    """Run a command and return its output; end with its error message when it fails."""
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"failed.\n{done.stderr.strip()}")
    return done.stdout


if __name__ == "__main__":
    main(sys.argv[1:])
