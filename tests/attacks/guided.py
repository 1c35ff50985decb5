#!/usr/bin/env python3
"""Read files whose damage is chosen by the lines of the readers that it reaches: ``guided.py FOLDER MINUTES SEED``.

Needs atheris. The folder keeps what reached new lines, and what was found as ``crash-…``; a later search goes on there.
"""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import atheris

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
with atheris.instrument_imports(include=["lidar_buildings.algorithms.cloud", "laspy"]):
    import conftest  # noqa: F401 - registers the checkout as the package lidar_buildings
    from lidar_buildings.algorithms.cloud import files  # noqa: F401
    from lidar_buildings.tests.attacks import victim
from lidar_buildings.tests.attacks.mutants import KINDS, mutant, sound_files

_EXTENSIONS = (".las", ".laz", ".copc.laz", ".vpc")
_LARGEST = 20_000
_MEMORY, _TIME = 600, 10


def corpus(folder: Path, seed: int) -> None:
    """Write what the search starts from: sound files, and some mutants. The first byte is the kind of file."""
    for at, kind in enumerate(("las", "laz", "copc")):
        for number, raw in enumerate(sound_files(kind)):
            (folder / f"{kind}-{number}").write_bytes(bytes([at]) + raw)
    for number in range(20 * len(KINDS)):
        made = mutant(seed, number)
        at = next(i for i in (2, 1, 0, 3) if made.name.endswith(_EXTENSIONS[i]))
        if len(made.files[made.name]) < _LARGEST:
            (folder / f"mutant-{number}").write_bytes(bytes([at]) + made.files[made.name])


def read(data: bytes) -> None:
    """Read a file of these bytes; any error other than a sentence for users ends the search."""
    if not data:
        return
    with TemporaryDirectory() as folder:
        path = Path(folder) / f"a{_EXTENSIONS[data[0] % len(_EXTENSIONS)]}"
        path.write_bytes(data[1:])
        victim.read(path, data[0])


def main() -> None:
    """Search as the command line says."""
    folder, minutes, seed = Path(sys.argv[1]), float(sys.argv[2]), int(sys.argv[3])
    folder.mkdir(parents=True, exist_ok=True)
    corpus(folder, seed)
    limits = [f"-max_total_time={60 * minutes:.0f}", f"-timeout={_TIME}", f"-rss_limit_mb={_MEMORY}"]
    options = [f"-seed={seed}", f"-max_len={_LARGEST}", f"-artifact_prefix={folder}/", "-print_final_stats=1"]
    atheris.Setup([sys.argv[0], *limits, *options, str(folder)], read)
    atheris.Fuzz()


if __name__ == "__main__":
    main()
