#!/usr/bin/env python3
"""Draw how alike simulated clouds of matched images are to real ones, from the tables of the benchmark ``likeness``.

Where the real clouds are (the benchmark says where it looks)::

    .venv/bin/python tests/benchmarks/accuracy.py likeness
    scripts/offscreen.sh /usr/bin/python3 scripts/likeness_picture.py benchmarks resources/readme/likeness.png
"""

from __future__ import annotations

import json
import math
import sys
from dataclasses import dataclass
from pathlib import Path

from qgis.PyQt.QtCore import QPointF, QRectF, Qt
from qgis.PyQt.QtGui import QColor, QFont, QGuiApplication, QImage, QPainter, QPen, QPolygonF

PANEL = (440, 330)  # pixels
ROOM = (64, 34, 24, 46)  # pixels left of, above, right of and below the axes
LEGEND = 40  # pixels
COLORS = {"real": ("#004488", "#4aa3df"), "simulated": ("#bb5566", "#ddaa33")}


@dataclass(frozen=True)
class Panel:
    """A chart: titles of it and its axes, positions across with their texts, and values by the name of the cloud.

    A value is None where it is unknown.
    """

    title: str
    across: str
    up: str
    positions: list[float]
    names: list[str]
    curves: dict[str, list[float | None]]
    is_logarithmic: bool = False


def panels(folder: Path) -> list[Panel]:
    """Return the charts of the tables in a folder."""
    rough, slopes, depths = (
        _rows(folder / f"{name}.json") for name in ("likeness", "likeness_slopes", "likeness_depths")
    )
    made = []
    for surface in ("roofs", "plants", "open ground"):
        rows = [row for row in rough if row["surface"] == surface]
        names = [key for key in rows[0] if key.endswith(" m")]
        curves = {row["cloud"]: [row[name] for name in names] for row in rows}
        widths = [float(name.split()[0]) for name in names]
        axes = "window (m)", "deviation from planes (m)"
        texts = [f"{width:g}" for width in widths]
        made.append(Panel(f"Roughness of {surface}", *axes, widths, texts, curves, is_logarithmic=True))
    for surface in ("roofs", "plants"):
        rows = [row for row in slopes if row["surface"] == surface]
        names = [key for key in rows[0] if key.endswith("°")]
        curves = {row["cloud"]: [row[name] for name in names] for row in rows if any(row[name] for name in names)}
        middles = [(float(name.split()[0]) + float(name.split()[2][:-1])) / 2 for name in names]
        texts = [f"{middle:g}" for middle in middles]
        made.append(Panel(f"Slopes of {surface}, by the meter", "slope (°)", "share (%)", middles, texts, curves))
    names = [key for key in depths[0] if key.startswith("deeper")] + ["seen through", "empty"]
    curves = {row["cloud"]: [row[name] for name in names] for row in depths}
    short = [name.replace("deeper than ", "> ") for name in names]
    positions = [float(number) for number in range(len(names))]
    made.append(Panel("Cells: depth, seen through, empty", "", "share (%)", positions, short, curves))
    return made


def _rows(path: Path) -> list[dict]:
    return json.loads(path.read_text(encoding="utf-8"))["rows"]


def draw(charts: list[Panel]) -> QImage:
    """Return the charts in two rows, with one legend."""
    columns = -(-len(charts) // 2)
    image = QImage(columns * PANEL[0], 2 * PANEL[1] + LEGEND, QImage.Format.Format_RGB32)
    image.fill(Qt.GlobalColor.white)
    painter = QPainter(image)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    pens = _pens([name for chart in charts for name in chart.curves])
    for number, chart in enumerate(charts):
        painter.save()
        painter.translate(number % columns * PANEL[0], number // columns * PANEL[1] + LEGEND)
        _draw_chart(painter, chart, pens)
        painter.restore()
    painter.setFont(QFont("sans-serif", 11))
    for number, (name, pen) in enumerate(pens.items()):
        left = 70 + number * 300
        painter.setPen(pen)
        painter.drawLine(left, 24, left + 40, 24)
        painter.setPen(Qt.GlobalColor.black)
        painter.drawText(left + 50, 29, name)
    painter.end()
    return image


def _pens(names: list[str]) -> dict[str, QPen]:
    """Return a pen for each cloud: real ones solid, simulated ones dashed."""
    pens: dict[str, QPen] = {}
    for name in dict.fromkeys(names):
        kind = name.split()[0]
        color = COLORS[kind][sum(other.startswith(kind) for other in pens) % 2]
        pens[name] = QPen(QColor(color), 3, Qt.PenStyle.SolidLine if kind == "real" else Qt.PenStyle.DashLine)
    return pens


def _draw_chart(painter: QPainter, chart: Panel, pens: dict[str, QPen]) -> None:
    left, top, right, bottom = ROOM
    area = QRectF(left, top, PANEL[0] - left - right, PANEL[1] - top - bottom)
    values = [value for curve in chart.curves.values() for value in curve if value is not None]
    scale = math.log10 if chart.is_logarithmic else float
    low, high = (0.5 * min(values), 1.5 * max(values)) if chart.is_logarithmic else (0.0, 1.08 * max(values))
    first, last = scale(chart.positions[0]), scale(chart.positions[-1])

    def at(position: float, value: float) -> QPointF:
        along = (scale(position) - first) / (last - first)
        height = (scale(value) - scale(low)) / (scale(high) - scale(low))
        return QPointF(area.left() + along * area.width(), area.bottom() - height * area.height())

    painter.setFont(QFont("sans-serif", 11, QFont.Weight.Bold))
    painter.drawText(QPointF(left, top - 12), chart.title)
    painter.setFont(QFont("sans-serif", 9))
    for tick in _ticks(low, high, chart.is_logarithmic):
        y = at(chart.positions[0], tick).y()
        painter.setPen(QPen(QColor("#dddddd"), 1))
        painter.drawLine(QPointF(area.left(), y), QPointF(area.right(), y))
        painter.setPen(Qt.GlobalColor.black)
        painter.drawText(QRectF(0, y - 9, left - 6, 18), Qt.AlignmentFlag.AlignRight, f"{tick:g}")
    for position, name in zip(chart.positions, chart.names):
        painter.drawText(
            QRectF(at(position, high).x() - 40, area.bottom() + 5, 80, 18),
            Qt.AlignmentFlag.AlignHCenter,
            name,
        )
    painter.drawText(
        QRectF(area.left(), area.bottom() + 22, area.width(), 18), Qt.AlignmentFlag.AlignHCenter, chart.across
    )
    painter.drawText(QRectF(area.left() + 6, area.top(), area.width(), 18), Qt.AlignmentFlag.AlignLeft, chart.up)
    painter.setPen(QPen(QColor("#222222"), 1))
    painter.drawLine(area.bottomLeft(), area.bottomRight())
    for name, curve in chart.curves.items():
        painter.setPen(pens[name])
        known = [at(position, value) for position, value in zip(chart.positions, curve) if value is not None]
        if len(known) > 1:
            painter.drawPolyline(QPolygonF(known))
        elif known:
            painter.drawEllipse(known[0], 3, 3)


def _ticks(low: float, high: float, is_logarithmic: bool) -> list[float]:
    if is_logarithmic:
        powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
        return [factor * 10.0**power for power in powers for factor in (1, 2, 5) if low <= factor * 10.0**power <= high]
    step = 10.0 ** math.floor(math.log10(high / 2))
    step *= next(factor for factor in (1, 2, 5, 10) if high / (factor * step) <= 8)
    return [number * step for number in range(int(high / step) + 1)]


def main() -> None:
    """Draw the tables of a folder to a file."""
    folder, target = Path(sys.argv[1]), Path(sys.argv[2])
    application = QGuiApplication([])
    # Few colors make a small file.
    image = draw(panels(folder)).convertToFormat(QImage.Format.Format_Indexed8)
    if not image.save(str(target)):
        raise SystemExit(f"{target} can't be written")
    del application


if __name__ == "__main__":
    main()
