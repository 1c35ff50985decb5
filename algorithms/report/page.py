"""The page that shows an assessment to a person: self-contained HTML with a map drawn in it."""

from __future__ import annotations

import base64
import html
import math
import re
import struct
import zlib
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Callable

import numpy as np

from ..geometry.grid import plan_box
from ..stage import Measure

# Distinguishable with any color vision and in gray (Tol's high-contrast scheme); the last is the paper.
_COLORS = ((221, 221, 221), (0, 68, 136), (221, 170, 51), (187, 85, 102), (255, 255, 255))

# Outcomes of a point, as positions of their colors.
REST, HIT, MISS, FALSE, _EMPTY = range(5)

_STYLE = """
body { font: 16px/1.5 sans-serif; color: #222; background: #fff; max-width: 60em; margin: 2em auto; padding: 0 1em }
table { border-collapse: collapse; margin: 1em 0 }
th, td { padding: .3em .8em; border-bottom: 1px solid #ccc; text-align: left; vertical-align: top }
td.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap }
svg { max-width: 100%; height: auto }
img { max-width: 100%; border: 1px solid #ccc; image-rendering: pixelated }
svg.view { border: 1px solid #ccc; margin-right: 1em }
.building, svg, img, tr { break-inside: avoid }
.swatch { display: inline-block; width: .9em; height: .9em; margin: 0 .4em 0 1em; border: 1px solid #888;
  print-color-adjust: exact; -webkit-print-color-adjust: exact }
.chart { display: inline-block; width: 49%; break-inside: avoid } .chart h3 { margin: .5em 0 0 }
.parameters { font-size: .8em; columns: 2; -webkit-columns: 2 } .parameters h3 { margin: 0 }
.parameters td, .parameters th { padding: .1em .6em } .parameters div { break-inside: avoid }
@page { size: A4; margin: 15mm }
@media print { body { max-width: none; margin: 0; padding: 0; font-size: 10pt } h2, h3 { break-after: avoid } }
"""

# Marks in a page where the caller of a chain puts the input and the parameters of the run, which no stage knows.
_FIRST, _LAST = "<!-- run -->", "<!-- parameters -->"

# A position in meters from the origin of a run, see :func:`position`.
_POSITION = re.compile(r'<span data-east="([-\d.]+)" data-north="([-\d.]+)">[^<]*</span>')


@dataclass(frozen=True)
class Row:
    """One figure: its name, its value as text, and a sentence with its meaning."""

    name: str
    value: str
    meaning: str


def decimal(value: float, digits: int, unit: str = "") -> str:
    """Return a number with a number of digits and its unit, such as " m", as text."""
    return "undefined" if math.isnan(value) else f"{value:.{digits}f}{unit}"


def percent(value: float) -> str:
    """Return a percentage as text."""
    return decimal(value, 1, " %")


def meters(value: float, digits: int = 3) -> str:
    """Return a length as text."""
    return decimal(value, digits, " m")


def rows_of(
    values: dict[str, float], measures: Iterable[Measure], meanings: dict[str, tuple[str, str]], digits: int = 3
) -> list[Row]:
    """Return the rows of some measures.

    Parameters
    ----------
    values : dict
        Values of measures by name: whole numbers are counts.
    measures : iterable of Measure
        Their declarations, which give the units.
    meanings : dict
        Its name on the page, and a sentence with its meaning.
    digits : int
        Digits of lengths.
    """
    units = {measure.name: measure.unit for measure in measures}

    def shown(measure: str) -> str:
        value, unit = values[measure], units[measure]
        if unit in ("%", "m"):
            return percent(value) if unit == "%" else meters(value, digits)
        return f"{value:,}" if isinstance(value, int) else decimal(value, 3)

    return [Row(name, shown(measure), meaning) for measure, (name, meaning) in meanings.items()]


def outcome_of(predicted: np.ndarray, true: np.ndarray) -> np.ndarray:
    """Return HIT, MISS, FALSE or REST for each point."""
    return np.select([predicted & true, true, predicted], [HIT, MISS, FALSE], REST).astype(np.uint8)


def build_page(title: str, lead: str, tables: dict[str, list[Row]], picture: str) -> str:
    """Return a complete page.

    Parameters
    ----------
    title, lead : str
        Heading, and the result in a sentence or two.
    tables : dict
        Rows by the heading of their table.
    picture : str
        HTML of the map, from :func:`draw_map`.
    """
    parts = [f"<h1>{html.escape(title)}</h1>", f"<p>{html.escape(lead)}</p>", _FIRST]
    parts += [draw_rows(heading, rows) for heading, rows in tables.items()]
    parts += [picture, _LAST]
    head = f'<meta charset="utf-8"><title>{html.escape(title)}</title><style>{_STYLE}</style>'
    return f'<!DOCTYPE html>\n<html lang="en"><head>{head}</head>\n<body>\n' + "\n".join(parts) + "\n</body></html>\n"


def draw_rows(heading: str, rows: Iterable[Row], level: int = 2) -> str:
    """Return the HTML of a table of figures under its heading."""
    lines = [f"<h{level}>{html.escape(heading)}</h{level}>\n<table>"]
    for row in rows:
        name, value, meaning = (html.escape(text) for text in (row.name, row.value, row.meaning))
        lines.append(f'<tr><th scope="row">{name}</th><td class="number">{value}</td><td>{meaning}</td></tr>')
    return "\n".join([*lines, "</table>"])


def position(east: float, north: float) -> str:
    """Return the HTML of a position in local meters, which :func:`with_coordinates` turns into map coordinates."""
    return f'<span data-east="{east:.3f}" data-north="{north:.3f}">{east:.1f} m east, {north:.1f} m north</span>'


def with_coordinates(page: str, to_map: Callable[[np.ndarray], np.ndarray]) -> str:
    """Return a page whose positions in meters from the origin of a run are in map coordinates."""

    def written(found: re.Match) -> str:
        east, north = to_map(np.array([[float(found[1]), float(found[2])]]))[0].tolist()
        return f"{east:.1f} E, {north:.1f} N"

    return _POSITION.sub(written, page)


def with_run(page: str, rows: Iterable[Row], steps: Iterable[StepFacts], of_seconds: str = "") -> str:
    """Return a page with the facts about a run after the lead, and its steps at the end.

    A page that has both already stays as it is.

    Parameters
    ----------
    page : str
        The page, as of :func:`build_page`.
    rows : iterable of Row
        Facts about the run: its input, date and version.
    steps : iterable of StepFacts
        Steps, with their seconds and parameters.
    of_seconds : str
        The work that took the seconds.
    """
    return page.replace(_FIRST, draw_rows("Run", rows), 1).replace(_LAST, _draw_steps(list(steps), of_seconds), 1)


def draw_table(title: str, head: list[str], rows: list[list[str]]) -> str:
    """Return the HTML of a table under its heading; the first column names the rows, the others hold numbers."""
    names = "".join(f'<th scope="col">{html.escape(name)}</th>' for name in head)
    lines = []
    for name, *values in rows:
        cells = "".join(f'<td class="number">{html.escape(value)}</td>' for value in values)
        lines.append(f'<tr><th scope="row">{html.escape(name)}</th>{cells}</tr>')
    return f"<h2>{html.escape(title)}</h2>\n<table>\n<tr>{names}</tr>\n" + "\n".join(lines) + "\n</table>\n"


def draw_legend(colors: Iterable[tuple[str, str]]) -> str:
    """Return names, each behind a swatch of its color."""
    swatch = '<span class="swatch" style="background:{}"></span>{}'
    return "".join(swatch.format(color, html.escape(name)) for name, color in colors)


def pixel_size(extent: np.ndarray, count: int, most: int) -> float:
    """Return the side (m) of the pixels of a map of an extent (2,), m: ``most`` along a side, few of them empty."""
    # Four points per pixel on average leave few pixels empty.
    return max(float(extent.max()) / most, 2 * float(np.sqrt(extent.prod() / count)), 1e-3)


def draw_map(xyz: np.ndarray, outcome: np.ndarray, names: tuple[str, str, str, str]) -> str:
    """Return the HTML of a map, north up, of the outcome of the topmost point of each pixel.

    ``xyz`` (n, 3) is in m, ``outcome`` (n,) REST, HIT, MISS or FALSE; ``names`` are the legend's for these four.
    """
    low, high = plan_box(xyz)
    extent = high - low
    size = pixel_size(extent, len(xyz), 800)
    column, row = np.floor((xyz[:, :2] - low) / size).astype(np.int64).T
    image = np.full((int(row.max()) + 1, int(column.max()) + 1), _EMPTY, np.uint8)
    order = np.argsort(xyz[:, 2], kind="stable")
    # Of values that go to one pixel the last one stays, which is the highest.
    image[row[order], column[order]] = outcome[order]
    data = base64.b64encode(png(image[::-1], _COLORS)).decode()
    legend = draw_legend((name, f"rgb{color}") for name, color in zip(names, _COLORS))
    # A map of few pixels is enlarged.
    width = max(360, image.shape[1])
    caption = f"The map is {extent[0]:,.0f} m wide and {extent[1]:,.0f} m high, north is up; one pixel is {size:.2g} m."
    return (
        f'<h2>Map</h2>\n<p>{legend}</p>\n<img alt="Map of the result" width="{width}" '
        f'src="data:image/png;base64,{data}">\n<p>{caption}</p>'
    )


def svg_image(image: np.ndarray, colors: np.ndarray, box: tuple[float, float, float, float]) -> str:
    """Return the SVG of an image of color numbers in a box: left, top, width and height in units of the picture."""
    data = base64.b64encode(png(image, colors)).decode()
    x, y, width, height = box
    return (
        f'<image x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height:.1f}" preserveAspectRatio="none" '
        f'xlink:href="data:image/png;base64,{data}"/>'
    )


def png(image: np.ndarray, colors: Iterable[Iterable[int]] = ()) -> bytes:
    """Return a PNG file of an image, uint8: (rows, columns, 3), or (rows, columns) of numbers of the ``colors``.

    Colors are red, green and blue.
    """

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    height, width = image.shape[:2]
    palette = bytes(value for color in colors for value in color)
    # Each line of a PNG begins with the number of its filter; 0 means no filter.
    lines = np.column_stack([np.zeros(height, np.uint8), image.reshape(height, -1)]).tobytes()
    header = struct.pack(">IIBBBBB", width, height, 8, 3 if palette else 2, 0, 0, 0)
    parts = [(b"IHDR", header), *([(b"PLTE", palette)] if palette else [])]
    # Photographs are large, and worth the time of the best compression.
    parts += [(b"IDAT", zlib.compress(lines, -1 if palette else 9)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunk(kind, data) for kind, data in parts)


@dataclass
class StepFacts:
    """A step of a run: its title, its seconds, its parameters as used, and what it said."""

    title: str
    seconds: float = 0.0
    parameters: list[Row] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


def _draw_steps(steps: list[StepFacts], of_seconds: str) -> str:
    """Return the HTML of the steps with their seconds, then of the parameters of each."""
    times = [Row(step.title, f"{step.seconds:.1f} s", " ".join(map(_sentence, step.notes))) for step in steps]
    times.append(Row("All steps", f"{sum(step.seconds for step in steps):.1f} s", of_seconds))
    set_up = [f"<div>{draw_rows(step.title, step.parameters, 3)}</div>" for step in steps if step.parameters]
    parts = [draw_rows("Steps", times), "<h2>Parameters</h2>", '<div class="parameters">', *set_up, "</div>"]
    return "\n".join(parts)


def _sentence(note: str) -> str:
    return note if note.endswith((".", "!", "?")) else f"{note}."
