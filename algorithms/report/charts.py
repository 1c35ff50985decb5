"""Charts for the quality pages: SVG within the page, readable in gray and in every color vision."""

import html
import math
from dataclasses import dataclass

import numpy as np

from ..criteria import ROUNDING
from .page import draw_legend

# Colors that differ in all color visions: Tol's high-contrast scheme, as in the maps of the pages, a gray, and more of
# his bright scheme.
BLUE, YELLOW, RED, GRAY = "#004488", "#ddaa33", "#bb5566", "#bbbbbb"
CYAN, GREEN, PURPLE = "#66ccee", "#228833", "#aa3377"

# Size of a histogram, and its margins with titles and numbers, pixels.
_WIDTH, _HEIGHT = 720, 320
_LEFT, _RIGHT, _TOP, _BOTTOM = 70, 20, 50, 50

# Side of a scatter plot, and the margin around its circle, pixels.
_SIDE, _MARGIN = 420, 50

# Sides of a cell of a matrix, and room for the names of its rows and columns, pixels.
_CELL_WIDTH, _CELL_HEIGHT, _NAMES = 84, 44, 190


@dataclass(frozen=True)
class Series:
    """Values that share a color and a name in the legend."""

    name: str
    color: str
    values: np.ndarray


@dataclass(frozen=True)
class Mark:
    """A position on the axis that is pointed out."""

    name: str
    value: float


def draw_histogram(series: list[Series], axis: str, count: str, marks: list[Mark]) -> str:
    """Return the HTML of a histogram, the bars of the series stacked on each other.

    Parameters
    ----------
    series : list of Series
        Values to count; those that are not finite are left out.
    axis, count : str
        Titles of the axes: the values, and the things counted.
    marks : list of Mark
        Values that are pointed out; those that are not finite are left out.
    """
    marks = [mark for mark in marks if math.isfinite(mark.value)]
    values = [one.values[np.isfinite(one.values)] for one in series]
    every = np.concatenate([*values, [mark.value for mark in marks]])
    if not sum(map(len, values)):
        return "<p>There is nothing to show in a histogram.</p>"
    edges = bar_edges(every)
    # Round edges may miss the outermost values by their last digit.
    counts = np.array([np.histogram(np.clip(one, edges[0], edges[-1]), edges)[0] for one in values])
    across = _Axis(edges[0], edges[-1], _LEFT, _WIDTH - _RIGHT)
    up = _Axis(0.0, float(counts.sum(axis=0).max()) * 1.05, _HEIGHT - _BOTTOM, _TOP)
    parts = [_bars(edges, counts, [one.color for one in series], across, up), _ticks_across(across, axis)]
    parts += [_ticks_up(up, count), *(_mark(mark, i, across) for i, mark in enumerate(marks))]
    legend = _legend(series) if any(one.name for one in series) else ""
    return legend + _picture(_WIDTH, _HEIGHT, f"Histogram: {axis}", "".join(parts))


def draw_bars(values: np.ndarray, axis: str, count: str) -> str:
    """Return the HTML of a histogram of one series, which needs no legend."""
    return draw_histogram([Series("", BLUE, values)], axis, count, [])


def bar_edges(values: np.ndarray) -> np.ndarray:
    """Return the edges of the bars of a histogram: round numbers, with the width of Freedman and Diaconis."""
    low, high = float(values.min()), float(values.max())
    extent, size = high - low, max(abs(low), abs(high))
    # Of smaller values, powers of ten of their widths are beyond what float64 holds: they are 0 in a chart.
    if size < 1e-200:
        return np.array([0.0, 1.0] if low >= 0 else [-1.0, 0.0, 1.0])
    if extent <= ROUNDING * size:  # equal but for rounding
        step = round_step(size / 10)
    else:
        width = 2 * float(np.subtract(*np.percentile(values, [75, 25]))) / len(values) ** (1 / 3)
        # Narrower bars are not distinguishable, wider ones hide two groups.
        step = round_step(float(np.clip(width, extent / 40, extent / 20)))
    first, last = math.floor(low / step + ROUNDING), math.ceil(high / step - ROUNDING)
    return np.arange(first, max(last, first + 1) + 1) * step


def round_step(width: float) -> float:
    """Return the smallest of 1, 2 and 5 times a power of ten that is at least ``width``."""
    power = 10.0 ** math.floor(math.log10(width))
    return next(factor * power for factor in (1, 2, 5, 10) if factor * power >= width * (1 - ROUNDING))


def draw_scatter(xy: np.ndarray, axis: str, unit: str, mean_name: str) -> str:
    """Return the HTML of points around a center: where displacements (n, 2) go, their mean marked.

    Parameters
    ----------
    xy : ndarray of shape (n, 2)
        Displacements.
    axis : str
        Name of the axes.
    unit : str
        Their unit.
    mean_name : str
        Name of the mean.
    """
    if not len(xy):
        return "<p>There is nothing to show in a chart.</p>"
    reach = round_step(float(np.hypot(*xy.T).max()) or 1.0)
    scale = (_SIDE / 2 - _MARGIN) / reach
    middle = _SIDE / 2
    rings = "".join(
        f'<circle cx="{middle}" cy="{middle}" r="{share * reach * scale:.1f}" fill="none" stroke="#ccc"/>'
        f'<text x="{middle + 4}" y="{middle - share * reach * scale - 3:.1f}" fill="#555">'
        f"{share * reach:g} {unit}</text>"
        for share in (0.5, 1.0)
    )
    cross = f"M{_MARGIN} {middle}H{_SIDE - _MARGIN}M{middle} {_MARGIN}V{_SIDE - _MARGIN}"
    positions = np.column_stack([middle + xy[:, 0] * scale, middle - xy[:, 1] * scale])
    # More than 3000 dots slow browsers down.
    every = -(-len(xy) // 3000)
    dots = "".join(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3"/>' for x, y in positions[::every].tolist())
    shown = axis if every == 1 else f"{axis} (one in {every} is drawn)"
    x, y = positions.mean(axis=0).tolist()
    mean = (
        f'<path d="M{x - 9:.1f} {y:.1f}h18M{x:.1f} {y - 9:.1f}v18" stroke="#fff" stroke-width="6"/>'
        f'<path d="M{x - 8:.1f} {y:.1f}h16M{x:.1f} {y - 8:.1f}v16" stroke="{RED}" stroke-width="3"/>'
    )
    body = f'{rings}<path d="{cross}" stroke="#ccc"/><g fill="{BLUE}" fill-opacity="0.45">{dots}</g>{mean}'
    legend = _legend([Series(shown, BLUE, xy), Series(mean_name, RED, xy)])
    return legend + _picture(_SIDE, _SIDE, axis, body)


def draw_matrix(counts: np.ndarray, names: list[str], columns: str, rows: str) -> str:
    """Return the HTML of a matrix of counts (m, m) as a heat map: the darker, the larger the share of its row.

    Parameters
    ----------
    counts : ndarray of shape (m, m), int
        How many items of the class of each row have the class of each column.
    names : list of str
        The classes.
    columns, rows : str
        What the two sides of the matrix are.
    """
    shares = counts / np.maximum(counts.sum(axis=1, keepdims=True), 1)
    left, top = _NAMES, _NAMES
    parts = [
        f'<text x="{left - 10}" y="{top + (i + 0.6) * _CELL_HEIGHT:.1f}" text-anchor="end">{html.escape(name)}</text>'
        f'<text transform="translate({left + (i + 0.6) * _CELL_WIDTH:.1f} {top - 10}) rotate(-60)">'
        f"{html.escape(name)}</text>"
        for i, name in enumerate(names)
    ]
    parts += [
        _cell(left + j * _CELL_WIDTH, top + i * _CELL_HEIGHT, int(counts[i, j]), float(shares[i, j]), i == j)
        for i in range(len(names))
        for j in range(len(names))
    ]
    parts.append(f'<text x="10" y="{top - 10}">{html.escape(rows)}</text>')
    parts.append(f'<text x="{left}" y="16">{html.escape(columns)}</text>')
    width, height = left + len(names) * _CELL_WIDTH + 90, top + len(names) * _CELL_HEIGHT + 10
    return _picture(width, height, f"{rows} and {columns}", "".join(parts))


def _cell(x: float, y: float, count: int, share: float, is_right: bool) -> str:
    """Return a cell of a matrix with its count and its share of the row; empty ones have no text."""
    fill = BLUE if is_right else RED
    # Text is white where the cell is darker than half.
    ink = "#fff" if share > 0.5 else "#222"  # noqa: PLR2004
    text = (
        f'<text x="{x + _CELL_WIDTH / 2:.1f}" y="{y + 19:.1f}" text-anchor="middle" fill="{ink}">{count:,}</text>'
        f'<text x="{x + _CELL_WIDTH / 2:.1f}" y="{y + 36:.1f}" text-anchor="middle" font-size="12" fill="{ink}">'
        f"{100 * share:.1f} %</text>"
    )
    return (
        f'<rect x="{x:.1f}" y="{y:.1f}" width="{_CELL_WIDTH}" height="{_CELL_HEIGHT}" fill="{fill}" '
        f'fill-opacity="{share:.3f}" stroke="#ccc"/>' + (text if count else "")
    )


@dataclass(frozen=True)
class _Axis:
    """Values from ``low`` to ``high`` on pixels from ``start`` to ``end``."""

    low: float
    high: float
    start: float
    end: float

    def at(self, value: float) -> float:
        """Return the pixel of a value."""
        return self.start + (value - self.low) / (self.high - self.low) * (self.end - self.start)

    def ticks(self, most: int) -> list[float]:
        """Return the round values on the axis, at most one more than ``most``."""
        step = round_step((self.high - self.low) / most)
        first, last = math.ceil(self.low / step - ROUNDING), math.floor(self.high / step + ROUNDING)
        return [float(f"{i * step:.12g}") for i in range(first, last + 1)]


def _bars(edges: np.ndarray, counts: np.ndarray, colors: list[str], across: _Axis, up: _Axis) -> str:
    """Return the bars of counts (series, bars) between edges (bars + 1,), the series stacked on each other."""
    top = np.cumsum(counts, axis=0)
    bars = []
    for color, height, upper in zip(colors, counts, top):
        for i in np.flatnonzero(height):
            left, right = across.at(edges[i]), across.at(edges[i + 1])
            y, foot = up.at(upper[i]), up.at(upper[i] - height[i])
            box = f'x="{left:.1f}" y="{y:.1f}" width="{right - left:.1f}" height="{foot - y:.1f}"'
            bars.append(f'<rect {box} fill="{color}" stroke="#fff"/>')
    return "".join(bars)


def _ticks_across(across: _Axis, title: str) -> str:
    """Return the lower axis with its numbers and its title."""
    foot = _HEIGHT - _BOTTOM
    places = [(across.at(tick), tick) for tick in across.ticks(8)]
    ticks = "".join(f'<text x="{x:.1f}" y="{foot + 18}" text-anchor="middle">{tick:g}</text>' for x, tick in places)
    middle = (across.start + across.end) / 2
    return (
        f'<path d="M{_LEFT} {foot}H{_WIDTH - _RIGHT}" stroke="#222"/>{ticks}'
        f'<text x="{middle}" y="{_HEIGHT - 10}" text-anchor="middle">{html.escape(title)}</text>'
    )


def _ticks_up(up: _Axis, title: str) -> str:
    """Return the whole numbers and the title on the left, where things are counted."""
    whole = [(up.at(tick) + 5, tick) for tick in up.ticks(5) if tick == int(tick)]
    ticks = "".join(f'<text x="{_LEFT - 8}" y="{y:.1f}" text-anchor="end">{tick:,.0f}</text>' for y, tick in whole)
    middle = (_TOP + _HEIGHT - _BOTTOM) / 2
    turned = f'transform="rotate(-90 18 {middle})"'
    return f'{ticks}<text x="18" y="{middle}" text-anchor="middle" {turned}>{html.escape(title)}</text>'


def _mark(mark: Mark, i: int, across: _Axis) -> str:
    """Return a line across the bars with its name above; names of neighbors, even and odd ``i``, have two lines."""
    x, y = across.at(mark.value), 16 + 17 * (i % 2)
    anchor = "end" if x > _WIDTH / 2 else "start"
    line = f"M{x:.1f} {y - 10}V{_HEIGHT - _BOTTOM}"
    return (
        f'<path d="{line}" stroke="#fff" stroke-width="5" stroke-opacity="0.7"/>'
        f'<path d="{line}" stroke="#222" stroke-width="2" stroke-dasharray="6 3"/>'
        f'<text x="{x + (-6 if anchor == "end" else 6):.1f}" y="{y}" text-anchor="{anchor}">'
        f"{html.escape(mark.name)}: {mark.value:.3g}</text>"
    )


def _legend(series: list[Series]) -> str:
    """Return the names of series next to their colors."""
    return f"<p>{draw_legend((one.name, one.color) for one in series)}</p>\n"


def _picture(width: int, height: int, title: str, body: str) -> str:
    """Return a picture of a size in pixels, whose title screen readers say."""
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" role="img" aria-label="{html.escape(title)}" '
        f'viewBox="0 0 {width} {height}" width="{width}" font-family="sans-serif" font-size="14" fill="#222">'
        f"{body}</svg>\n"
    )
