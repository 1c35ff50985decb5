#!/usr/bin/env python3
"""Keep the names by which saved models and scripts call the plugin, in ``tests/released.json``.

These are ids of algorithms, names and choices of their parameters, names of their outputs, and attributes of layers.
Run for a release, it adds what is new; it never takes anything out::

    scripts/offscreen.sh .venv/bin/python scripts/released.py
"""

from __future__ import annotations

import importlib
import json
import sys
from pathlib import Path
from typing import Any

from qgis.core import QgsApplication, QgsProcessingProvider

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))
importlib.import_module("conftest")

from lidar_buildings.algorithms.stages import STAGES  # noqa: E402

RELEASED = ROOT / "tests" / "released.json"


def names_of(provider: QgsProcessingProvider) -> dict[str, dict[str, list[str]]]:
    """Return the names of each algorithm of a provider, by its id, as lists by kind."""
    found: dict[str, dict[str, list[str]]] = {}
    for algorithm in provider.algorithms():
        found[algorithm.name()] = {
            "parameters": [one.name() for one in algorithm.parameterDefinitions()],
            "outputs": [one.name() for one in algorithm.outputDefinitions()],
        }
    for stage in STAGES.values():
        for tunable in stage.tunables.values():
            if tunable.param.choices:
                found[stage.id][f"choices of {tunable.name.upper()}"] = list(tunable.param.choices)
        for layer in stage.layers:
            found[stage.id][f"attributes of {layer.name.upper()}"] = [field.name for field in layer.fields]
    return found


def missing(released: dict[str, Any], found: dict[str, Any]) -> list[str]:
    """Return what of the released names is no longer found, as "id: kind: name"."""
    return [
        f"{algorithm}: {kind}: {name}"
        for algorithm, kinds in released.items()
        for kind, names in kinds.items()
        for name in names
        if name not in found.get(algorithm, {}).get(kind, [])
    ]


def with_new(released: dict[str, Any], found: dict[str, Any]) -> dict[str, Any]:
    """Return the released names with those that are new after them."""
    return {
        algorithm: {
            kind: list(dict.fromkeys([*released.get(algorithm, {}).get(kind, []), *names]))
            for kind, names in {**released.get(algorithm, {}), **found.get(algorithm, {})}.items()
        }
        for algorithm in sorted({*released, *found})
    }


def main() -> int:
    """Write the file; return the exit code."""
    application = QgsApplication([], False)  # noqa: F841 - QGIS needs it while it runs
    QgsApplication.initQgis()
    from lidar_buildings.provider.provider import Provider

    provider = Provider()
    QgsApplication.processingRegistry().addProvider(provider)
    released, found = json.loads(RELEASED.read_text(encoding="utf-8")), names_of(provider)
    gone = missing(released, found)
    if gone:
        print(f"{len(gone)} released names are gone, {gone[0]!r} first; bring them back.", file=sys.stderr)
    else:
        lines = [f"{json.dumps(name)}: {json.dumps(kinds)}" for name, kinds in with_new(released, found).items()]
        RELEASED.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")
    QgsApplication.exitQgis()
    return 1 if gone else 0


if __name__ == "__main__":
    sys.exit(main())
