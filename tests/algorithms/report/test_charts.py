"""Charts show the numbers, read back from the drawing."""

import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from lidar_buildings.algorithms.report.charts import (
    BLUE,
    RED,
    YELLOW,
    Mark,
    Series,
    bar_edges,
    draw_histogram,
    draw_scatter,
    round_step,
)

SVG = "{http://www.w3.org/2000/svg}"


def drawn(page):
    """Return the chart of a piece of HTML as an element tree."""
    return ET.fromstring(re.search(r"<svg.*</svg>", page, re.DOTALL).group())


def bars(svg, color):
    """Return (left, right, height) of the bars of a color, in pixels."""
    boxes = [bar for bar in svg.iter(f"{SVG}rect") if bar.get("fill") == color]
    numbers = [[float(bar.get(name)) for name in ("x", "width", "height")] for bar in boxes]
    return np.array([(x, x + width, height) for x, width, height in numbers])


def test_heights_of_bars_are_the_counts(rng):
    low, high = rng.normal(0.3, 0.03, 200), rng.normal(0.9, 0.05, 100)
    svg = drawn(draw_histogram([Series("roofs", BLUE, low), Series("trees", YELLOW, high)], "Entropy", "Clusters", []))
    edges = bar_edges(np.concatenate([low, high]))
    for values, color in ((low, BLUE), (high, YELLOW)):
        counts = np.histogram(values, edges)[0]
        heights = bars(svg, color)[:, 2]
        np.testing.assert_allclose(heights / heights.sum(), counts[counts > 0] / counts.sum(), atol=0.01)
    assert bars(svg, BLUE)[:, 1].max() <= bars(svg, YELLOW)[:, 0].min() + 0.2


def test_marks_stand_at_their_values():
    values = np.linspace(0, 1, 101)
    svg = drawn(draw_histogram([Series("all", BLUE, values)], "x", "y", [Mark("half", 0.5), Mark("none", np.nan)]))
    (mark,) = [path for path in svg.iter(f"{SVG}path") if path.get("stroke-dasharray")]
    left, right = bars(svg, BLUE)[:, 0].min(), bars(svg, BLUE)[:, 1].max()
    edges = bar_edges(values)
    expected = left + (right - left) * (0.5 - edges[0]) / (edges[-1] - edges[0])
    assert float(re.match(r"M([\d.]+) ", mark.get("d")).group(1)) == pytest.approx(expected, abs=0.2)
    texts = [text.text for text in svg.iter(f"{SVG}text")]
    assert "half: 0.5" in texts
    assert not any("none" in text for text in texts)


@pytest.mark.parametrize(
    "values", [np.array([3.0]), np.full(5, 0.7), np.zeros(3), np.array([1e-9, 1e9]), np.array([np.nan, 2.0])]
)
def test_few_equal_and_far_values_have_a_chart(values):
    svg = drawn(draw_histogram([Series("all", BLUE, values)], "x", "y", [Mark("mean", float(np.nanmean(values)))]))
    assert len(bars(svg, BLUE))


def test_nothing_is_said_to_be_nothing():
    nothing = np.array([np.nan])
    assert "nothing to show" in draw_histogram([Series("all", BLUE, nothing)], "x", "y", [])
    assert "nothing to show" in draw_scatter(np.zeros((0, 2)), "x", "m", "mean")


def test_edges_are_round_hold_all_values_and_are_not_too_many(rng):
    for values in (rng.normal(5, 2, 1000), rng.exponential(1e-3, 30), np.append(rng.normal(size=1000), 1e3)):
        edges = bar_edges(values)
        assert edges[0] <= values.min() + 1e-9
        assert edges[-1] >= values.max() - 1e-9
        assert 8 <= len(edges) <= 43
        step = edges[1] - edges[0]
        assert round_step(step) == pytest.approx(step)


def test_the_last_bar_ends_at_a_round_greatest_value():
    np.testing.assert_allclose(bar_edges(np.linspace(0, 1, 11))[[0, -1]], [0, 1])


@pytest.mark.parametrize(("width", "expected"), [(1.0, 1), (1.1, 2), (0.03, 0.05), (70, 100), (5, 5)])
def test_steps_are_one_two_or_five(width, expected):
    assert round_step(width) == pytest.approx(expected)


def test_dots_lie_where_the_points_are_north_up():
    svg = drawn(draw_scatter(np.array([[1.0, 0], [0, 1], [-1, 0.5]]), "moves", "m", "mean"))
    (dots,) = [group for group in svg.iter(f"{SVG}g")]
    east, north, west = [(float(dot.get("cx")), float(dot.get("cy"))) for dot in dots]
    assert east[0] > north[0] > west[0]
    assert north[1] < west[1] < east[1]
    assert any(path.get("stroke") == RED for path in svg.iter(f"{SVG}path"))


def test_many_dots_are_thinned_and_it_is_said(rng):
    page = draw_scatter(rng.normal(size=(10_000, 2)), "moves", "m", "mean")
    (dots,) = [group for group in drawn(page).iter(f"{SVG}g")]
    assert len(dots) == 2500
    assert "one in 4 is drawn" in page


def test_words_are_escaped():
    page = draw_histogram([Series("<a>", BLUE, np.arange(3.0))], "<b>", "<c>", [Mark("<d>", 1.0)])
    assert not re.search(r"<[abcd]>", page)


def test_values_next_to_nothing_have_bars_too():
    """Powers of ten below the smallest float ended in "math domain error"."""
    for values in ([0.0, 0.0], [0.0, 5e-324], [1e-310, 3e-310], [-1e-320, 1e-320]):
        edges = bar_edges(np.array(values))
        assert np.isfinite(edges).all()
        assert edges[0] <= min(values) <= max(values) <= edges[-1]
