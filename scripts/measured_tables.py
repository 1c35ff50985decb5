#!/usr/bin/env python3
"""Write the tables of measured figures into the pages of docs/; with ``--check`` only say whether they fit.

Each table is between the lines ``<!-- measured: NAME -->`` and ``<!-- end -->`` of its page. Its figures are those of
JSON files that ``tests/benchmarks`` writes and docs/measured keeps, with the commit, the day and the machine.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

DOCS = Path(__file__).resolve().parent.parent / "docs"
MEASURED = DOCS / "measured"
PAGES = ("accuracy.md", "performance.md")
_BLOCK = re.compile(r"(<!-- measured: (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)


class Column(NamedTuple):
    """A column of a page: heading, figure in the file, decimals, which row of a group, style, factor of the unit."""

    heading: str
    figure: str
    digits: int = 1
    where: tuple[tuple[str, Any], ...] = ()
    bold: bool = False
    factor: float = 1.0


class Row(NamedTuple):
    """A row of a page: its first cells, the file, the values that find its row, and figures without meaning there."""

    labels: tuple[str, ...]
    file: str
    where: tuple[tuple[str, Any], ...] = ()
    blank: tuple[str, ...] = ()


class Shown(NamedTuple):
    """A table of a page: the headings of its labels, its columns and rows, and the command that measures it."""

    labels: tuple[str, ...]
    columns: tuple[Column, ...]
    rows: tuple[Row, ...]
    command: str


_CLOUDS = {
    "ahn3-delft": ("Delft, old town (AHN3)", "15"),
    "ahn3-delft-4": ("the same, thinned", "4"),
    "ahn-amsterdam-1": ("Amsterdam, blocks (AHN)", "16"),
    "amsterdam-centre-10": ("Amsterdam, canals and inner courts (AHN3, thinned)", "4"),
    "ign-chalet": ("house in a forest (IGN LiDAR HD)", "54"),
    "ign-stbarth": ("villas on a hillside (IGN; bushes at the walls are class 6 there)", "25"),
    "ign-stbarth-4": ("the same, thinned", "4"),
}
_ALL_CLASSES = {
    "ahn3-delft-4": ("Delft, thinned", "4"),
    "amsterdam-centre-10": ("Amsterdam, canal belt", "4"),
    "ahn-amsterdam-1": ("Amsterdam", "16"),
    "ign-stbarth-4": ("villas on a hillside, thinned", "4"),
    "ign-chalet": ("house in a forest", "54"),
    "ign-forest-none": ("river in a forest", "87"),
    "ign-bridge-none": ("motorway bridge", "26"),
}
_OURS, _PUBLISHED = (("chain", "default"),), (("chain", "2019"),)
_RATES = (Column("completeness, %", "completeness"), Column("correctness, %", "correctness"))
_F = Column("**F**, %", "F", bold=True)


# Names of scenes and towns in the files, and on the page.
_SCENES = {
    "blocks of a city": "blocks of a city",
    "the same, strips 8 cm apart": "the same, flight strips 8 cm above one another",
    "halls with machines and wings": "halls of 80 to 105 m with machines and wings",
    "churches and towers": "churches with spires, and towers among trees",
    "terraced vineyard with huts": "terraced vineyard with huts",
    "huts on a slope of 38°": "huts on a slope of 38°",
    "houses in a closed forest": "houses in a closed forest",
    "farm with a field of maize": "farm with a field of maize",
    "railway station with trains": "railway station with trains",
    "container port": "container port",
    "solar park, no building": "solar park, no building",
}
_TOWNS = {
    "as it comes": "8 points per m²",
    "density 1.0": "1 point per m²",
    "density 2.0": "2 points per m²",
    "density 30.0": "30 points per m²",
    "range_noise 0.06": "6 cm of noise",
    "range_noise 0.1, density 20.0": "10 cm of noise, 20 points per m²",
    "slope 20.0": "slope of 20°",
    "slope 35.0": "slope of 35°",
    "returns False": "without return numbers",
    "forest 0.6": "60 % forest",
    "pattern zigzag": "zigzag scan lines",
    "buildings 0.0": "no buildings",
    "trees 0.0, forest 0.0": "no trees",
}
_UNEVEN = (("ahn3-delft", "Delft"), ("ahn-amsterdam-1", "Amsterdam"), ("ign-stbarth", "villas on a hillside"))
_AT_4, _AT_12 = (("points per m²", 4),), (("points per m²", 12),)

_DRAWINGS = {
    "in blocks": "touching buildings merged",
    "house by house": "house by house, as by default",
    "Building-Regulariser": "Building-Regulariser on the traced outlines",
}

# Stages and composites in the file of times, and on the page.
_TIMES = {
    "read + neighbors": "reading, and one search for 16 neighbors",
    "classify_noise_histogram": "Classify noise by height histogram",
    "classify_ground_tin": "Classify ground points (TIN)",
    "classify_bridges": "Classify bridges",
    "compute_height_above_ground": "Height above ground",
    "segment_roofs": "Segment roofs",
    "classify_buildings": "Classify buildings",
    "complete_buildings": "Complete buildings",
    "refine_buildings": "Refine buildings",
    "complete_ground": "Complete ground",
    "classify_water": "Classify water",
    "classify_wires": "Classify wires",
    "classify_vegetation": "Classify vegetation",
    "extract_footprints": "Extract footprints",
    "detect_buildings": "*Detect buildings*",
    "from file to file": "*Detect buildings*, from file to file",
    "map_footprints": "*Map footprints*",
    "model_buildings": "*Model buildings*",
}

TABLES = {
    "buildings": Shown(
        ("cloud", "points per m²"),
        (
            Column("completeness, %", "points: compl.", 1, _OURS),
            Column("correctness, %", "points: corr.", 1, _OURS),
            Column("**F**, %", "points: F", 1, _OURS, bold=True),
            Column("F as published, %", "points: F", 1, _PUBLISHED),
        ),
        tuple(Row(labels, "buildings", (("cloud", name),)) for name, labels in _CLOUDS.items()),
        "accuracy.py buildings",
    ),
    "without_buildings": Shown(
        ("cloud without buildings",),
        (
            Column("called building, m²", "called building, m²", 0, _OURS),
            Column("as published, m²", "called building, m²", 0, _PUBLISHED),
        ),
        (
            Row(
                ("forest with a river, 87 points per m²",),
                "without_buildings",
                (("cloud without buildings", "ign-forest-none"),),
            ),
            Row(
                ("bridge and trees, 26 points per m²",),
                "without_buildings",
                (("cloud without buildings", "ign-bridge-none"),),
            ),
        ),
        "accuracy.py buildings",
    ),
    "review": Shown(
        ("cloud", "points per m²"),
        (
            Column("buildings", "buildings", 0),
            Column("false", "false", 0),
            Column("doubtful", "doubtful", 0),
            Column("false ones among them", "false of these", 0),
            Column("decisions until none is left", "decisions", 0),
            Column("in random order", "decisions at random", 0),
            Column("F, %", "F", 2),
            Column("then", "F after", 2),
            Column("objects that are buildings, %", "objects: corr.", 1),
            Column("then", "objects: corr. after", 1),
        ),
        (
            *(Row(labels, "review", (("cloud", name),)) for name, labels in _CLOUDS.items()),
            *(
                Row((f"simulated town in trees, {nth}", "1.5"), "review", (("cloud", f"town in trees {seed}"),))
                for seed, nth in ((1, "one"), (2, "another"))
            ),
        ),
        "accuracy.py review",
    ),
    "photos": Shown(
        ("cloud", "points per m²"),
        (*_RATES, _F, Column("largest false building, m²", "largest false, m²", 0)),
        (
            Row(("suburb (SensatUrban)", "21"), "photos", (("cloud", "uk-photo-100"),)),
            Row(("beach with one small building (ODMSemantic3D)", "87"), "photos", (("cloud", "brighton-beach"),)),
        ),
        "accuracy.py photos",
    ),
    "drone": Shown(
        ("site",),
        (
            *_RATES,
            _F,
            Column("buildings", "buildings", 0),
            Column("found", "found", 0),
            Column("plants called building, m² per hectare", "plants called building, m²/ha"),
        ),
        tuple(
            Row((name,), "drone", (("site", name),))
            for name in (
                "as by default",
                "another",
                "steep, terraces of 2.5 m",
                "wavy, 20 points per m²",
                "halls of up to 66 m",
            )
        ),
        "accuracy.py drone",
    ),
    "ground": Shown(
        ("cloud",),
        (
            Column("total error, %", "total", 1, (("filter", "classify_ground_tin"),)),
            Column("kappa, %", "kappa", 1, (("filter", "classify_ground_tin"),)),
            Column("total error of *TIN, as published 2000*, %", "total", 1, (("filter", "classify_ground_tin_2000"),)),
        ),
        (
            *(
                Row((name,), "ground", (("cloud", name),))
                for name in ("samp11", "samp12", "samp22", "samp31", "samp41", "samp52", "samp53", "samp61")
            ),
            Row(("Delft (AHN3, class 2)",), "ground", (("cloud", "ahn3-delft"),)),
        ),
        "accuracy.py ground",
    ),
    "classes": Shown(
        ("cloud", "points per m²"),
        tuple(
            column
            for heading, figure in (
                ("accuracy, %", "accuracy, %"),
                *((f"F of {one}", f"F of {one}") for one in ("ground", "plants", "buildings", "water")),
            )
            for column in (
                Column(heading, figure, 1, (("program", "Detect buildings"),), bold=True),
                Column("Whitebox's", figure, 1, (("program", "Whitebox classify_lidar"),)),
            )
        ),
        tuple(Row(labels, "classes", (("cloud", name),)) for name, labels in _ALL_CLASSES.items()),
        "accuracy.py classes",
    ),
    "footprints": Shown(
        ("Delft, outlined",),
        (
            Column("intersection over union with class 6", "IoU with class 6", 2),
            Column("corners of single houses, median, m", "corners of houses, m", 2),
            Column("of whole blocks, median, m", "of blocks, m", 2),
        ),
        (
            Row(("the buildings found",), "footprints_of_delft", (("Delft, classes", "chain"),)),
            Row(("the true points of class 6",), "footprints_of_delft", (("Delft, classes", "truth"),)),
        ),
        "accuracy.py footprints",
    ),
    "outlines": Shown(
        ("outlines of four clouds",),
        (
            Column("points moved by 2 mm: IoU", "moved, own classes: IoU", 3),
            Column("distance, m", "moved, own classes: m", 2),
            Column("90 % of the points: IoU", "90 %, own classes: IoU", 3),
            Column("distance, m", "90 %, own classes: m", 2),
            Column("edges along two directions, %", "along", 0, factor=100),
            Column("corners under 70°, %", "sharp, %"),
            Column("corners per 100 m", "corners per 100 m"),
        ),
        tuple(Row((label,), "outlines", (("drawing", name),)) for name, label in _DRAWINGS.items()),
        "accuracy.py outlines",
    ),
    "outlines_of_map": Shown(
        ("outlines of Delft",),
        (
            Column("corners of single houses, median, m", "their corners, m", 2),
            Column("of whole blocks, median, m", "their corners, m (blocks)", 2),
            Column("of 118 houses found one to one", "one to one", 0),
        ),
        tuple(
            Row((label,), "outlines_of_map", (("drawing", name), ("classes", "found")))
            for name, label in _DRAWINGS.items()
        ),
        "accuracy.py outlines",
    ),
    "harder": Shown(
        ("cloud", "made harder"),
        (*_RATES, _F, Column("wrongly building, m²", "wrong, m²", 0)),
        tuple(
            Row((cloud, change), "harder", (("cloud", name), ("made harder", code)))
            for name, cloud, code, change in (
                ("ahn-amsterdam-1", "Amsterdam", "noise 0.1", "10 cm of noise"),
                ("ahn-amsterdam-1", "Amsterdam", "returns False", "without return numbers"),
                ("ahn-amsterdam-1", "Amsterdam", "keep 0.25", "a quarter of its points"),
                ("ahn-amsterdam-1", "Amsterdam", "step 0.3", "heights rounded to 30 cm"),
                ("ign-stbarth", "villas on a hillside", "noise 0.1", "10 cm of noise"),
                ("ign-stbarth", "villas on a hillside", "step 0.3", "heights rounded to 30 cm"),
                ("ahn3-delft", "Delft", "noise 0.1", "10 cm of noise"),
                ("ign-chalet", "house in a forest", "step 0.3", "heights rounded to 30 cm"),
                ("ign-bridge-none", "bridge, no building", "keep 0.25", "a quarter of its points"),
            )
        ),
        "accuracy.py harder",
    ),
    "uneven": Shown(
        ("points",),
        tuple(Column(f"F of {label}, %", "F", 1, (("cloud", name),)) for name, label in _UNEVEN),
        tuple(
            Row((label,), "uneven", (("spread", spread),))
            for spread, label in (
                ("lines 1 m apart", "on scan lines 1 m apart, one every 25 cm"),
                ("lines 1.5 m apart", "on scan lines 1.5 m apart, one every 30 cm"),
                ("lines 2 m apart", "on scan lines 2 m apart, one every 25 cm"),
                ("zigzag lines", "on lines that zigzag 1.5 m apart"),
                ("bands", "in bands of 60 m, by turns up to 20 and 2 per m²"),
                ("pairs", "in pairs"),
            )
        ),
        "accuracy.py uneven",
    ),
    "objects": Shown(
        ("slope of the ground", "points"),
        (
            _F,
            Column("houses missed of 49", "missed", 0),
            Column("called building of trees, %", "trees, %"),
            Column("of cars, %", "cars, %"),
            Column("of fences at walls, %", "fences, %"),
            Column("of poles, %", "poles, %"),
        ),
        tuple(
            Row((f"{slope} %", points), "objects", (("slope, %", float(slope)),))
            for slope, points in ((4, "a tenth"), (20, "a tenth"), (8, "three tenths"))
        ),
        "accuracy.py objects",
    ),
    "scenes": Shown(
        ("scene",),
        (
            Column("F at 4 points per m², %", "F", 1, _AT_4),
            Column("F at 12, %", "F", 1, _AT_12),
            Column("wrongly building at 4, m²", "wrong, m²", 0, _AT_4),
            Column("at 12, m²", "wrong, m²", 0, _AT_12),
            Column("ground missed at 4, %", "ground missed, %", 1, _AT_4),
        ),
        tuple(
            Row((label,), "scenes", (("scene", name),), ("F",) if "no building" in name else ())
            for name, label in _SCENES.items()
        ),
        "accuracy.py scenes",
    ),
    "towns": Shown(
        ("town of 150 m",),
        (*_RATES, _F, Column("wrongly building, m²", "wrong, m²", 0)),
        tuple(
            Row(
                (label,),
                "towns",
                (("town of 150 m, seed 3", name),),
                ("completeness", "correctness", "F") if name == "buildings 0.0" else (),
            )
            for name, label in _TOWNS.items()
        ),
        "accuracy.py towns",
    ),
    "villages": Shown(
        ("points per m²", "noise"),
        (
            Column("buildings", "buildings", 0),
            Column("found", "found", 0),
            Column("invented", "invented", 0),
            Column("corners: mean, cm", "mean, cm"),
            Column("farthest, cm", "farthest, cm"),
        ),
        tuple(
            Row((str(density), f"{noise} cm"), "villages", (("points/m²", density), ("noise, cm", noise)))
            for density in (50, 100)
            for noise in (2, 5)
        ),
        "accuracy.py villages",
    ),
    "models": Shown(
        ("footprints",),
        (
            Column("polygons", "footprints", 0),
            Column("at level 2.2", "at level 2.2", 0),
            Column("solids", "solids", 0),
            Column("valid", "valid", 0),
            Column("rms of a building, median, m", "median rms, m", 2),
            Column("points over 0.5 m off, %", "over 0.5 m off, %"),
            Column("roofs of type *other*", "type other", 0),
        ),
        (
            Row(("base map of Delft",), "models_on_the_map", (("map", "delft-bgt"),)),
            *(
                Row((label,), "real_models", (("cloud", name),))
                for name, label in (
                    ("ahn3-delft", "those found in Delft"),
                    ("ahn-amsterdam-1", "in two blocks of Amsterdam"),
                    ("amsterdam-centre-10", "in Amsterdam's canal belt, thinned"),
                    ("ign-stbarth", "of villas on a hillside"),
                )
            ),
        ),
        "models.py real map",
    ),
    "facade_fronts": Shown(
        ("front", "openings"),
        (
            Column("seen", "true", 0),
            Column("found", "found", 0),
            Column("of the right kind", "kind right", 0),
            Column("invented on the front", "invented", 0),
            Column("edges off, median, cm", "edges off, median, cm"),
            Column("90 % within, cm", "90th percentile, cm"),
        ),
        tuple(
            Row((front, f"{kind}s"), "facade_fronts", (("front", name), ("element", kind)))
            for name, front in (("nuist-facade-1", "first"), ("nuist-facade-3", "second"))
            for kind in ("window", "door")
        ),
        "facades.py fronts",
    ),
    "facade_streets": Shown(
        ("simulated street of 40 m",),
        (
            Column("facades", "facades", 0),
            Column("found", "found", 0),
            Column("invented", "invented", 0),
            Column("corners off, median, cm", "median off, cm"),
            Column("mean, cm", "corners seen: mean off, cm"),
            Column("windows and doors seen", "windows seen", 0),
            Column("found, %", "found, %", 0),
            Column("invented, %", "invented, %", 0),
            Column("edges off, median, cm", "edges off, median, cm"),
        ),
        tuple(
            Row((label,), "facade_streets", (("street", name),))
            for name, label in (
                ("1", "first"),
                ("2", "second"),
                ("1, with clutter", "first, behind cars, trees and people"),
                ("2, with clutter", "second, behind these"),
            )
        ),
        "facades.py streets",
    ),
    "facade_blocks": Shown(
        ("simulated city block, from the air and from the street",),
        (
            Column("shift of the scan off, cm", "shift off, cm"),
            Column("corners off, median, cm", "corners off, median, cm"),
            Column("greatest, cm", "greatest, cm", 0),
            Column("windows and doors seen", "openings seen", 0),
            Column("in the right wall, %", "in the right wall, %"),
        ),
        tuple(Row((number,), "facade_blocks", (("block", number),)) for number in ("1", "2", "3", "4")),
        "facades.py blocks",
    ),
    "facade_doors": Shown(
        ("simulated street of 40 m",),
        (
            Column("windows and doors seen", "openings seen", 0),
            Column("found", "found", 0),
            Column("of the right kind", "of the right kind", 0),
            Column("doors seen", "doors seen", 0),
            Column("called doors", "of these doors", 0),
            Column("drawn twice", "drawn twice", 0),
        ),
        tuple(
            Row((name,), "facade_doors", (("street", name),))
            for name in (
                "level",
                "stoops of 2 m, nothing before them",
                "stoops of 1 m",
                "fronts 8 cm out of line, nothing before them",
                "stoops of 2 m, fronts 15 cm out of line",
            )
        ),
        "facades.py doors",
    ),
    "flight_dimensionality": Shown(
        ("neighborhood",),
        tuple(Column(kind, f"{kind}, %", 1, (("points", "all"),)) for kind in ("linear", "planar", "volumetric")),
        (
            Row(("50 neighbors, %",), "flight_dimensionality", (("neighborhood", "k = 50"),)),
            Row(("the best number for each point, %",), "flight_dimensionality", (("neighborhood", "k_opt"),)),
        ),
        "structure.py flight --part 0.1",
    ),
    "times": Shown(
        ("1.09 million points of a simulated town",),
        (
            Column("processor time, s", "cpu_seconds"),
            Column("peak memory, MB", "peak_bytes", 0, factor=1e-6),
            Column("beyond what the program needs, bytes per point", "bytes_per_point", 0),
        ),
        tuple(Row((label,), "times", (("name", name),)) for name, label in _TIMES.items()),
        "make bench",
    ),
}


def filled(page: str, folder: Path = MEASURED) -> str:
    """Return the text of a page with its tables as the files in a folder have them."""
    return _BLOCK.sub(lambda found: found[1] + written(TABLES[found[2]], folder) + found[3], page)


def written(table: Shown, folder: Path = MEASURED) -> str:
    """Return a table in Markdown, with a line on its origin."""
    files = {row.file: json.loads((folder / f"{row.file}.json").read_text(encoding="utf-8")) for row in table.rows}
    lines = [
        _line([*table.labels, *(column.heading for column in table.columns)]),
        _line(["---"] * len(table.labels) + ["---:"] * len(table.columns)),
    ]
    for row in table.rows:
        lines.append(_line([*row.labels, *(_cell(files[row.file]["rows"], row, column) for column in table.columns)]))
    return "\n".join([*lines, "", _origin(table.command, list(files.values())), ""])


def _cell(rows: Sequence[dict[str, Any]], row: Row, column: Column) -> str:
    """Return a figure, "" where the file has none in this column; rows that are missing or ambiguous are refused."""
    wanted = dict((*row.where, *column.where))
    found = [one for one in rows if all(one[key] == value for key, value in wanted.items())]
    if len(found) > 1 or (not found and not column.where):
        raise ValueError(f"{row.file}.json has {len(found)} rows with {wanted}; exactly one is needed.")
    if not found or column.figure in row.blank or found[0][column.figure] is None:
        return ""
    text = f"{found[0][column.figure] * column.factor:,.{column.digits}f}"
    return f"**{text}**" if column.bold else text


def _origin(command: str, files: list[dict[str, Any]]) -> str:
    """Return a sentence on the command, the commits, the days and the machine of some files."""
    commits = ", ".join(dict.fromkeys(one["commit"][:7] for one in files))
    days = ", ".join(dict.fromkeys(one["date"][:10] for one in files))
    machine = files[0]["machine"]
    system = f"{machine['cores']} cores, Python {machine['python']}, numpy {machine['numpy']}"
    return f"*`{command}`, commit {commits}, {days}; {system}.*"


def _line(cells: Sequence[str]) -> str:
    """Return a line of a table in Markdown."""
    return "| " + " | ".join(cells) + " |"


def main(arguments: list[str]) -> int:
    """Write the pages, or only compare; return the exit code."""
    for path in (DOCS / page for page in PAGES):
        before = path.read_text(encoding="utf-8")
        after = filled(before)
        if before == after:
            continue
        if "--check" in arguments:
            print(f"{path.name} has other figures than docs/measured; run scripts/measured_tables.py.", file=sys.stderr)
            return 1
        path.write_text(after, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
