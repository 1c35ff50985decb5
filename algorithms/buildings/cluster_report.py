"""The page with the decisions on clusters: reasons, entropies and, where it counts, penetration."""

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..cloud.reasons import Reason
from ..report.charts import BLUE, GRAY, YELLOW, Mark, Series, draw_histogram
from ..report.page import Row, build_page
from ..stage import Measure, Report
from .entropy_split import Split

# Values that every stage that classifies buildings reports.
MEASURES = (
    Measure("clusters", "Clusters"),
    Measure("building_clusters", "Clusters called building"),
    Measure("undecided_clusters", "Undecided clusters"),
    Measure("building_entropy", "Mean entropy of buildings"),
    Measure("other_entropy", "Mean entropy of everything else"),
)


@dataclass(frozen=True)
class Clusters:
    """The mean entropy and the reason of each cluster (m,), and the two means.

    ``penetration`` (m,) and its maximum are None where a method doesn't use it.
    """

    entropy: np.ndarray
    reason: np.ndarray
    split: Split
    penetration: Optional[np.ndarray] = None
    max_penetration: Optional[float] = None


def build_report(clusters: Clusters) -> Report:
    """Return counts, means and page of a decision."""
    outcome = [Reason(number) for number in clusters.reason.tolist()]
    is_building = np.array([reason.is_building for reason in outcome], bool)
    is_undecided = np.isin(clusters.reason, (Reason.ALIKE, Reason.WITHOUT_ENTROPY))
    values = {
        "clusters": len(outcome),
        "building_clusters": int(is_building.sum()),
        "undecided_clusters": int(is_undecided.sum()),
        "building_entropy": clusters.split.building,
        "other_entropy": clusters.split.other,
    }
    groups = {"building": (BLUE, is_building), "not a building": (YELLOW, ~is_building & ~is_undecided)}
    if is_undecided.any():
        groups["undecided"] = (GRAY, is_undecided)
    return Report(values, _page(clusters, values, groups))


def _page(clusters: Clusters, values: dict, groups: dict) -> str:
    lead = (
        f"{values['building_clusters']:,} of {values['clusters']:,} clusters of points are called building. "
        "A cluster is often one surface of a roof: where clusters are joined to whole buildings afterwards, footprints "
        "are fewer."
    )
    if clusters.split.is_one_group:
        lead += " Their entropies form one group; the missing one has the mean of simulated planes or volumes."
    elif clusters.penetration is not None:
        lead += (
            " Their entropies were compared with planes and volumes at the density and noise of the cloud, "
            "which the two means of the clusters move by little; the reasons below say what decided."
        )
    elif values["clusters"]:
        lead += " The two means of their entropies decided."
    counts = {reason: (clusters.reason == reason).sum() for reason in Reason}
    rows = [Row(reason.label, f"{count:,}", reason.text) for reason, count in counts.items() if count]
    means = [Mark("buildings", clusters.split.building), Mark("everything else", clusters.split.other)]
    pictures = "<h2>Mean entropy</h2>\n" + _chart(clusters.entropy, groups, "Mean entropy of a cluster", means)
    if clusters.penetration is not None and clusters.max_penetration is not None:
        most = [Mark("at most", clusters.max_penetration)]
        pictures += "<h2>Penetration</h2>\n" + _chart(clusters.penetration, groups, "Share of the beam passing", most)
    return build_page("Why clusters are buildings", lead, {"Reasons": rows}, pictures)


def _chart(values: np.ndarray, groups: dict, axis: str, marks: list[Mark]) -> str:
    series = [Series(name, color, values[chosen]) for name, (color, chosen) in groups.items()]
    return draw_histogram(series, axis, "Clusters", marks)
