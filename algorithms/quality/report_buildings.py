"""A page on the buildings that were found: how many and how large, a map, and the doubtful ones with their points."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from ..cloud.asprs import NOISE, PointClass
from ..geometry.rings import signed_area
from ..report.building_views import Views, boxes_around, draw_views
from ..report.charts import BLUE, GRAY, RED, YELLOW, draw_bars
from ..report.page import Row, build_page
from ..report.polygon_map import draw_polygons
from ..sampling.cloud_sampling import CloudSampling
from ..sampling.sufficiency import why_doubtful
from ..stage import InputLayer, LayerFeatures, Measure, Report, feature_names, stage

# Of 514 buildings of seven real clouds, 45 had less than this confidence, 15 of the 16 false ones among them.
SURE = 0.7

# Confidence below which a building is as likely as not.
_EVEN = 0.5

# Colors of the map by confidence.
_COLORS = {"unknown": GRAY, f"{SURE} and more": BLUE, f"{_EVEN} to {SURE}": YELLOW, f"below {_EVEN}": RED}

# Doubtful buildings that the page shows one by one: as many as fit two printed pages.
_SHOWN = 10


def _shown(footprints: LayerFeatures) -> np.ndarray:
    """Return the boxes (k, 2, 2), m, around the buildings that the page shows one by one."""
    return boxes_around([footprints.geometries[row] for row in _Facts.of(footprints).least_sure()])


@stage(
    "Quality",
    title="Report on buildings",
    tags="report,summary,statistics,map,doubtful,confidence,PDF,print",
    input_layers=(InputLayer("footprints"),),
    measures=(
        Measure("buildings", "Buildings"),
        Measure("area", "Area of all buildings", "m²"),
        Measure("volume", "Volume of all buildings", "m³"),
        Measure("doubtful", "Doubtful buildings"),
    ),
    shows=_shown,
    cost=0.5,
)
def report_buildings(
    xyz=None, classification=None, footprints=None, *, sampling: Optional[CloudSampling] = None, monitor=None
):
    """Write a page on the buildings found: number, areas, heights, volumes, a map, and the doubtful ones.

    The map shows footprints colored by their confidence over a hillshade of the points. The ten buildings of the least
    confidence below ``SURE`` are shown one by one, from above and in sections along and across.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64, optional
        Coordinates (m) for the hillshade and the views of single buildings. In tiles these are the topmost point of
        each cell of the hillshade, and every point around these buildings.
    classification : ndarray of shape (n,), uint8, optional
        ASPRS classes of these points.
    footprints : LayerFeatures
        Footprints of buildings, from 'Extract footprints' or any other source; heights, volumes and confidences are
        read from their attributes 'height', 'volume' and 'confidence', numbers and reasons from 'id', 'reason' and
        'evidence'.

    Returns
    -------
    Report
        Number of buildings and of doubtful ones, total area (m²) and volume (m³, NaN if unknown), and the page.

    Notes
    -----
    In a cloud that can hardly show buildings, as it is thin, small or without ground, every building that has a
    confidence is doubtful. The page says why.

    Examples
    --------
    >>> from lidar_buildings.algorithms.stage import LayerFeatures
    >>> ring = np.array([[15, 16], [25, 16], [25, 24], [15, 24], [15, 16.0]])
    >>> report = report_buildings(footprints=LayerFeatures([[ring]], {"id": [1]}))
    >>> float(report.values["buildings"])
    1.0
    """
    facts = _Facts.of(footprints)
    doubt = "" if xyz is None or sampling is None else why_doubtful(xyz, classification, sampling)
    # In a chain, the step that classified them has said so.
    if doubt and doubt not in monitor.warnings:
        monitor.warn(doubt)
    monitor.progress(0.1)
    shown = facts.least_sure()
    values = {
        "buildings": len(facts.area),
        "area": float(facts.area.sum()),
        "volume": float(facts.volume.sum()),
        "doubtful": int((facts.confidence < (np.inf if doubt else SURE)).sum()),
    }
    # Birds would be the highest points. Without other points there is no hillshade.
    is_shown = np.zeros(0, bool) if xyz is None else ~np.isin(classification, NOISE)
    surface = xyz[is_shown] if is_shown.any() else None
    picture = draw_polygons(footprints.geometries, facts.kinds(), _COLORS, surface, "Confidence:")
    parts = [picture or "<h2>Map</h2>\n<p>There are no footprints to show.</p>", _charts(facts)]
    monitor.progress(0.5)
    if xyz is not None and len(shown):
        views = Views(xyz, classification == PointClass.BUILDING)
        parts.append(draw_views(views, [footprints.geometries[row] for row in shown], facts.captions(shown)))
    summary = summary_of(values)
    monitor.inform(summary)
    said = f"{summary} {doubt}".strip()
    return Report(values, build_page("Buildings", said, {"In all": _totals(facts, values)}, "\n".join(parts)))


def summary_of(values: dict) -> str:
    """Return the result in a sentence."""
    count = values["buildings"]
    noun = "building" if count == 1 else "buildings"
    found = f"{count:,} {noun}, {values['area']:,.0f} m²"
    if 0 < count == values["doubtful"]:
        return f"Perhaps no building: {found}, all doubtful."
    return f"{found}, {values['doubtful']:,} doubtful."


@dataclass(frozen=True)
class _Facts:
    """Attributes of footprints: arrays (n,), NaN where unknown, names, and why each is called building."""

    names: list[str]
    area: np.ndarray
    height: np.ndarray
    volume: np.ndarray
    confidence: np.ndarray
    why: list[str]

    @classmethod
    def of(cls, footprints: LayerFeatures) -> _Facts:
        count = len(footprints)
        columns = {name.lower(): values for name, values in footprints.columns.items()}
        numbers = {name: _numbers(columns.get(name), count) for name in ("height", "volume", "confidence")}
        # Holes are clockwise: their areas are negative.
        plans = [[np.asarray(ring)[:, :2] for ring in rings] for rings in footprints.geometries]
        area = np.array([sum(map(signed_area, plan)) for plan in plans])
        texts = zip(*(columns.get(name, [None] * count) for name in ("reason", "evidence")))
        why = ["; ".join(str(one) for one in of_one if one) for of_one in texts]
        return cls(feature_names(footprints), area.reshape(count), why=why, **numbers)

    def least_sure(self) -> np.ndarray:
        """Return the rows (m,) of the doubtful buildings that are shown one by one, the least sure first."""
        order = np.argsort(np.where(np.isnan(self.confidence), np.inf, self.confidence), kind="stable")
        return order[self.confidence[order] < SURE][:_SHOWN]

    def kinds(self) -> list[str]:
        """Return the kind of each building on the map."""
        bounds = [np.isnan(self.confidence), self.confidence >= SURE, self.confidence >= _EVEN]
        return np.select(bounds, list(_COLORS)[:3], list(_COLORS)[3]).tolist()

    def captions(self, rows: np.ndarray) -> list[str]:
        """Return a line of text on each of some buildings."""
        return [
            f"Building {self.names[row]}: confidence {self.confidence[row]:.2f}, {self.area[row]:,.0f} m²"
            f"{'; ' * bool(self.why[row])}{self.why[row]}."
            for row in rows
        ]


def _numbers(values: Any, count: int) -> np.ndarray:
    """Return an attribute as numbers (n,), NaN where it is missing or no number."""
    if values is None or (isinstance(values, list) and any(isinstance(value, str) for value in values)):
        return np.full(count, np.nan)
    return np.array([np.nan if value is None else value for value in values], float)


def _totals(facts: _Facts, values: dict) -> list[Row]:
    """Return the rows of the table of totals."""
    rows = [
        Row("Buildings", f"{values['buildings']:,}", "Footprints; houses of a row that are parted count one by one."),
        Row("Area", f"{values['area']:,.0f} m²", "Sum of the footprints, without their holes."),
    ]
    if np.isfinite(values["volume"]):
        rows.append(Row("Volume", f"{values['volume']:,.0f} m³", "Space between roofs and ground."))
    heights = facts.height[np.isfinite(facts.height)]
    if len(heights):
        low, middle, high = np.percentile(heights, (0, 50, 100))
        rows.append(Row("Height", f"{middle:.1f} m", f"Median of the buildings; from {low:.1f} to {high:.1f} m."))
    if np.isfinite(facts.confidence).any():
        meaning = f"Buildings of a confidence below {SURE}: look at these first."
        rows.append(Row("Doubtful", f"{values['doubtful']:,}", meaning))
    return rows


def _charts(facts: _Facts) -> str:
    """Return histograms of the attributes of the buildings."""
    charts = [("Areas", facts.area, "area (m²)"), ("Heights", facts.height, "height (m)")]
    charts += [("Volumes", facts.volume, "volume (m³)"), ("Confidence", facts.confidence, "confidence")]
    drawn = [
        f'<div class="chart"><h3>{title}</h3>{draw_bars(values, axis, "buildings")}</div>'
        for title, values, axis in charts
        if np.isfinite(values).any()
    ]
    return "\n".join(["<h2>Sizes and confidence</h2>", *drawn]) if drawn else ""
