"""Assess segments against a reference: correct, over- and under-segmented, missed and noise."""

from dataclasses import dataclass

import numpy as np

from ..geometry.groups import mask_of
from ..report.page import FALSE, HIT, MISS, REST, Row, build_page, draw_map, percent
from ..stage import Measure, Report, stage, tunable
from .confusion import percentage
from .point_matching import match_points


@stage(
    "Quality",
    tags="accuracy,Hoover,over-segmentation,under-segmentation,correct,missed,noise,evaluation,reference,planes",
    measures=(
        Measure("correct", "Correct segments"),
        Measure("over", "Over-segmented segments of the reference"),
        Measure("under", "Under-segmented segments of the reference"),
        Measure("missed", "Missed segments of the reference"),
        Measure("noise", "Noise segments"),
        Measure("reference_segments", "Segments of the reference"),
        Measure("segments", "Segments"),
        Measure("correct_share", "Correct segments of the reference", "%"),
        Measure("points_correct", "Points in correct segments", "%"),
        Measure("points_over", "Points of over-segmented segments", "%"),
        Measure("points_under", "Points of under-segmented segments", "%"),
        Measure("points_missed", "Points of missed segments", "%"),
        Measure("points_noise", "Points in noise segments", "%"),
    ),
)
def assess_segments(
    xyz,
    segment_id,
    reference_xyz,
    reference_segment_id,
    *,
    min_overlap: float = tunable(0.8, within="(0.5, 1]"),
    min_points: int = tunable(1, within=f"[1, {10**9}]"),
    monitor=None,
):
    """Compare segments with a reference: which are correct, cut up, run together, missed or invented.

    A segment is correct if it and one of the reference share most points of both. One of the reference is
    over-segmented if several segments, most of each within it, make up most of it. Several of the reference are
    under-segmented if they make up most of one segment, most of each within it. All other true segments are
    missed, all other segments are noise.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m) of the input.
    segment_id : ndarray of shape (n,)
        Segments of the input; 0 if unassigned.
    reference_xyz : ndarray of shape (m, 3)
        Coordinates (m) of the reference: the same points in any order, perhaps with others.
    reference_segment_id : ndarray of shape (m,)
        True segments; 0 if unassigned.

    Returns
    -------
    Report
        Counts of segments, percentages of points, and a page with a map. A percentage of nothing is NaN.

    Other Parameters
    ----------------
    min_overlap
        Share of the points of a segment that must lie in the other one, more than 0.5, so that each segment has one
        counterpart at most. 0.8 is usual.
    min_points
        Smaller segments, of the input and of the reference, are ignored.

    Raises
    ------
    ValueError
        If a point of the input is not in the reference, or the reference has no segment.

    Notes
    -----
    Points in segments of the reference are counted by the outcome of their segment; of a correct one, those that both
    have. Points in noise segments are counted as a share of the points that have a segment in the input, all others of
    those that have one in the reference. Where a segment could be counted as correct or as a part of a set, the paper
    takes what overlaps more on average; here it counts as correct.

    References
    ----------
    Hoover, A., et al., 1996. An experimental comparison of range image segmentation algorithms. IEEE Transactions on
    Pattern Analysis and Machine Intelligence 18 (7), 673-689. [hoover1996]

    Examples
    --------
    >>> xyz = [[x, 0, 0] for x in range(6)]
    >>> report = assess_segments(xyz, [1, 1, 1, 2, 3, 0], xyz, [1, 1, 1, 2, 2, 0])
    >>> report.values["correct"], report.values["over"], report.values["missed"]
    (1, 1, 0)
    """
    true = reference_segment_id[match_points(np.asarray(xyz, float), np.asarray(reference_xyz, float))]
    monitor.progress(0.3)
    found, true = _numbered(segment_id, min_points), _numbered(true, min_points)
    if not true.any():
        raise ValueError(
            "The reference has no segment (SegmentID is 0 everywhere, or all are too small); choose another reference."
        )
    matches = match_segments(found, true, min_overlap)
    monitor.progress(0.7)
    values = _values(found, true, matches)
    return Report(values, _page(np.asarray(xyz, float), found, true, matches, values))


@dataclass(frozen=True)
class Matches:
    """What became of segments."""

    #: (k + 1,), int64: for each segment of the reference (k) the correct one of the input, 0 for none
    counterpart: np.ndarray
    #: is_over, is_under, is_missed, (k + 1,), bool: its other outcomes
    is_over: np.ndarray
    is_under: np.ndarray
    is_missed: np.ndarray
    is_noise: np.ndarray  #: (l + 1,), bool: which segments of the input (l) have no part in any of these


def match_segments(found: np.ndarray, true: np.ndarray, min_overlap: float) -> Matches:
    """Return the outcomes of segments, by their shared points.

    Parameters
    ----------
    found, true : ndarray of shape (n,), int64
        Segments of points from 1 without gaps, of the input and of the reference; 0 if unassigned.
    min_overlap : float
        Share of points, more than 0.5.
    """
    n_true, n_found = int(true.max(initial=0)) + 1, int(found.max(initial=0)) + 1
    key, shared = np.unique(true * n_found + found, return_counts=True)
    # Pairs that share points: a segment of the ground truth, and one of the machine.
    g, m = np.divmod(key, n_found)
    both = (g > 0) & (m > 0)
    g, m, shared = g[both], m[both], shared[both]
    size_true, size_found = np.bincount(true, minlength=n_true), np.bincount(found, minlength=n_found)
    # With more than a half each segment lies in one other at most.
    lies_in = shared >= min_overlap * size_found[m]
    holds = shared >= min_overlap * size_true[g]
    counterpart, is_used = np.zeros(n_true, np.int64), np.zeros(n_found, bool)
    counterpart[g[lies_in & holds]] = m[lies_in & holds]
    is_used[counterpart] = True
    is_open, is_free = counterpart == 0, ~is_used
    parts = lies_in & is_open[g] & is_free[m]
    is_over = _made_up(g[parts], shared[parts], size_true, min_overlap)
    pieces = holds & is_open[g] & is_free[m]
    is_whole = _made_up(m[pieces], shared[pieces], size_found, min_overlap)
    is_under = mask_of(n_true, g[pieces & is_whole[m]])
    is_used[m[parts & is_over[g]]] = True
    is_used |= is_whole
    is_missed = is_open & ~is_over & ~is_under
    is_missed[0] = False
    is_noise = ~is_used
    is_noise[0] = False
    return Matches(counterpart, is_over, is_under & ~is_over, is_missed, is_noise)


def _made_up(whole: np.ndarray, shared: np.ndarray, size: np.ndarray, min_overlap: float) -> np.ndarray:
    """Return the mask of segments that two or more others make up."""
    n = len(size)
    return (np.bincount(whole, shared, n) >= min_overlap * size) & (np.bincount(whole, minlength=n) > 1)


def _numbered(ids: np.ndarray, min_points: int) -> np.ndarray:
    """Return segments numbered from 1 without gaps, 0 if unassigned or it is too small."""
    values, which, count = np.unique(np.asarray(ids, np.int64), return_inverse=True, return_counts=True)
    is_large = (values > 0) & (count >= min_points)
    return np.where(is_large, np.cumsum(is_large), 0)[which]


def _outcomes(found: np.ndarray, true: np.ndarray, matches: Matches) -> dict[str, np.ndarray]:
    """Return the mask of points (n,) that are in segments of each kind."""
    return {
        "correct": (true > 0) & (found > 0) & (matches.counterpart[true] == found),
        "over": matches.is_over[true],
        "under": matches.is_under[true],
        "missed": matches.is_missed[true],
        "noise": matches.is_noise[found],
    }


def _values(found: np.ndarray, true: np.ndarray, matches: Matches) -> dict[str, float]:
    """Return the measures."""
    n_true, n_found = len(matches.counterpart) - 1, len(matches.is_noise) - 1
    correct = int((matches.counterpart > 0).sum())
    values: dict[str, float] = {
        "correct": correct,
        **{name: int(getattr(matches, f"is_{name}").sum()) for name in ("over", "under", "missed", "noise")},
        "reference_segments": n_true,
        "segments": n_found,
        "correct_share": 100.0 * correct / n_true,
    }
    in_true, in_found = int((true > 0).sum()), int((found > 0).sum())
    for name, inside in _outcomes(found, true, matches).items():
        values[f"points_{name}"] = percentage(int(inside.sum()), in_found if name == "noise" else in_true)
    return values


def _page(xyz: np.ndarray, found: np.ndarray, true: np.ndarray, matches: Matches, values: dict[str, float]) -> str:
    """Return the page of the report."""
    total, n_segments = int(values["reference_segments"]), int(values["segments"])
    meanings = {
        "correct": ("Correct", "have a counterpart with which they share most points of both."),
        "over": ("Over-segmented", "are cut up into several segments."),
        "under": ("Under-segmented", "are run together with others."),
        "missed": ("Missed", "are matched in none of these ways."),
    }
    rows = []
    for name, (title, meaning) in meanings.items():
        share = f"with {percent(values[f'points_{name}'])} of the points"
        rows.append(Row(title, f"{values[name]:,.0f}", f"Of {total:,} in the reference, {share}, {meaning}"))
    noise = f"Of {n_segments:,} segments, these have no part in the reference."
    rows.append(Row("Noise", f"{values['noise']:,.0f}", noise))
    outcomes = _outcomes(found, true, matches)
    outcome = np.full(len(xyz), REST, np.uint8)
    outcome[outcomes["noise"]] = FALSE
    outcome[(true > 0) & ~outcomes["correct"]] = MISS
    outcome[outcomes["correct"]] = HIT
    legend = ("no segment", "in correct segments", "in segments that are not found as they are", "in noise segments")
    lead = (
        f"{n_segments:,} segments were compared with {total:,} of the reference: {values['correct']:,.0f} are correct."
    )
    return build_page("Quality of the segments", lead, {"Segments": rows}, draw_map(xyz, outcome, legend))
