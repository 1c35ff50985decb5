#!/usr/bin/env python3
"""Start runs of ``qgis_process`` at once, in one profile of QGIS: ``crowd.py --runs 8``.

Each finds the ground of the same cloud and writes a cloud of its own. All must end well, with the outputs
of a run that is alone.
"""

from __future__ import annotations

import argparse
import hashlib
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
import conftest  # noqa: E402, F401 - registers the checkout as the package lidar_buildings
from lidar_buildings.algorithms.cloud.files import write_cloud  # noqa: E402
from lidar_buildings.algorithms.run import run_stage  # noqa: E402
from lidar_buildings.algorithms.stages import STAGES  # noqa: E402
from lidar_buildings.tests.benchmarks.results import FOLDER, Table  # noqa: E402
from lidar_buildings.tests.profiles import Profile  # noqa: E402

_STAGE = "lidarbuildings:classifygroundtin"


def run(profile: Profile, cloud: Path, folder: Path) -> tuple[int, str, str, float]:
    """Run the stage; return its exit code, the digest of what it wrote, what it said of errors, and its time (s)."""
    folder.mkdir()
    start, target = time.monotonic(), folder / "a.laz"
    done = profile("run", _STAGE, "--", f"INPUT={cloud}", f"OUTPUT={target}")
    files = sorted(path.name for path in folder.iterdir())
    digest = hashlib.sha256(target.read_bytes()).hexdigest() if files == [target.name] else f"files {files}"
    return done.returncode, digest, done.stderr[-500:], time.monotonic() - start


def main() -> int:
    """Run as the command line says; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=8, help="at once (8)")
    parser.add_argument("--output", type=Path, default=FOLDER, help="folder for the table")
    asked = parser.parse_args()
    with TemporaryDirectory() as parent, ThreadPoolExecutor(asked.runs) as pool:
        root = Path(parent)
        cloud, profile = root / "town.laz", Profile(root / "profile", ("laspy", "lazrs"))
        write_cloud(run_stage(STAGES["simulate_town"], None, size=100.0, density=4.0).cloud, cloud)
        before = cloud.read_bytes()
        alone = run(profile, cloud, root / "alone")
        together = list(pool.map(lambda number: run(profile, cloud, root / str(number)), range(asked.runs)))
        well = [one for one in together if one[:2] == (0, alone[1])]
        untouched = cloud.read_bytes() == before
    table = Table("crowd", "runs at once", "ended well, output as alone", "s alone", "s together")
    table.add(str(asked.runs), len(well), alone[3], max(seconds for *_, seconds in together))
    table.write(asked.output)
    for code, digest, said, _ in (one for one in together if one not in well):
        print(f"Exit code {code}, {digest}: {said}")
    return 0 if alone[0] == 0 and untouched and len(well) == asked.runs else 1


if __name__ == "__main__":
    sys.exit(main())
