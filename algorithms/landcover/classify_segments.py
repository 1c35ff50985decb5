"""Give a class to segments that a person picks by number, in the map or by their measures."""

from typing import Any, Optional

import numpy as np

from ..cloud.asprs import parse_classes
from ..geometry.grid import distinct
from ..geometry.groups import run_starts
from ..planes.least_squares_planes import planes_of
from ..preparation.filter_points import within_limits
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..segmentation.cluster_measures import occupied_cells
from ..shapes.plane_polygons import outline_of_cells
from ..stage import Field, InputLayer, Layer, LayerFeatures, Monitor, stage, tunable

_FIELDS = (
    Field("id", int, "number of the segment, as SegmentID of its points", numbers="segment_id"),
    Field("points", int, "points of the segment"),
    Field("area", float, "area that its points occupy, seen from above", "m²"),
    Field("height", float, "mean height of its points above the ground; empty where heights are not known", "m"),
    Field("slope", float, "slope of the plane through its points: 0 is level, 90 a wall", "°"),
    Field("roughness", float, "root mean square distance of its points from this plane", "m"),
    Field("picked", int, "1 picked, 0 not"),
)


def _limit(text: str, within: str) -> Any:
    """Return the declaration of a limit of a measure."""
    return tunable(None, f"Pick segments {text}.", within=within, empty="no limit.")


@stage(
    "Land cover",
    tags="pick,select,operator,manual,interactive,assign,class,segments,terrain,outlines,reclassify",
    writes=("classification",),
    layers=(Layer("segments", "Segments", "Polygon", _FIELDS, style="picked_segments"),),
    input_layers=(InputLayer("selection", "Segments to pick", optional=True),),
)
def classify_segments(
    xyz,
    classification,
    segment_id,
    height_above_ground=None,
    selection=None,
    *,
    code: int = tunable(2, label="Class", within="[0, 255]"),
    numbers: str = tunable("", label="Numbers of segments"),
    min_area: Optional[float] = _limit("of at least this area, seen from above", "[0, inf) m²"),
    max_area: Optional[float] = _limit("of at most this area, seen from above", "[0, inf) m²"),
    min_height: Optional[float] = _limit("with at least this mean height above the ground", "[-10_000, 10_000] m"),
    max_height: Optional[float] = _limit("with at most this mean height above the ground", "[-10_000, 10_000] m"),
    min_slope: Optional[float] = _limit("whose plane is at least this steep", "[0, 90]°"),
    max_slope: Optional[float] = _limit("whose plane is at most this steep", "[0, 90]°"),
    min_roughness: Optional[float] = _limit(
        "whose points lie at least this far off their plane, root mean square", "[0, inf) m"
    ),
    max_roughness: Optional[float] = _limit(
        "whose points lie at most this far off their plane, root mean square", "[0, inf) m"
    ),
    sampling: CloudSampling = MEASURED,
    monitor=None,
):
    """Give the segments that you pick a class: by number, in the map, or by area, height, slope and roughness.

    Run it first with nothing set: no class changes, and *Segments* has the outline of each segment with its number and
    measures. Select the terrain there, say, and run it again with these outlines as *Segments to pick* and *Selected
    features only*. A segment must have one of the numbers, be in that layer and be within all limits that are set.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes.
    segment_id : ndarray of shape (n,), int32
        Segments; 0 if unassigned.
    height_above_ground : ndarray of shape (n,), float32, optional
        Heights, m; needed to limit them.
    selection : LayerFeatures, optional
        The outlines that an earlier run made, of which those are selected or left that are to be picked. Their
        attribute 'id' is the number of the segment.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        The class in picked segments; other points keep theirs.
    segments : LayerFeatures
        Outline of the largest piece of each segment, seen from above, in the order of their numbers.

    Other Parameters
    ----------------
    code
        Class that the points of picked segments get.
    numbers
        Pick these segments: numbers and ranges, separated by commas (3, 7, 12-15); empty: any number.

    Raises
    ------
    ValueError
        If no point has a segment, or no segment has a picked number. If the layer has no attribute id, heights are
        limited without being known, or a minimum is above its maximum.

    Notes
    -----
    In the paper an operator picks the segments of the terrain where no filter knows them; surfaces are grown before by
    'Segment surfaces'. Area is counted in cells that hold points, which reach over the edges of small segments. A
    segment whose points lie at one position has no slope and is within no limit of it.

    References
    ----------
    Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds,
    section 5.2. [vosselman2004]

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz, segment = np.column_stack([x, y, z]), np.where(z > 0, 7, 3)
    >>> classes, segments = classify_segments(xyz, np.ones(len(z)), segment, min_area=1000.0)
    >>> bool((classes == np.where(z > 0, 1, 2)).all()), segments.columns["id"], segments.columns["picked"]
    (True, [3, 7], [1, 0])
    """
    used = np.flatnonzero(segment_id > 0)
    if not len(used):
        raise ValueError("No point has a segment (SegmentID above 0); run 'Segment surfaces' first.")
    limits = {
        "area": (min_area, max_area),
        "height": (min_height, max_height),
        "slope": (min_slope, max_slope),
        "roughness": (min_roughness, max_roughness),
    }
    if height_above_ground is None and limits["height"] != (None, None):
        raise ValueError("Limits of the height need HeightAboveGround; run 'Height above ground' first or set none.")
    ids, which = distinct(segment_id[used].astype(np.int64))
    heights = np.full(len(used), np.nan) if height_above_ground is None else height_above_ground[used]
    facts, outlines = _measured(sampling.from_corner(xyz[used]), which, heights, sampling.density, monitor)
    listed = parse_classes(numbers, "Numbers of segments", int(ids[-1]))
    given = [np.isin(ids, listed)] if len(listed) else []
    given += [] if selection is None else [np.isin(ids, _numbers(selection))]
    for name, (low, high) in limits.items():
        within = within_limits(facts[name], low, high, (f"min_{name}", f"max_{name}"), monitor)
        given += [] if low is None and high is None else [within]
    picked = np.all(given, axis=0) if given else np.zeros(len(ids), bool)
    classes = classification.astype(np.uint8)
    classes[used[picked[which]]] = code
    n_points = facts["points"][picked].sum()
    monitor.inform(f"{picked.sum():,} of {len(ids):,} segments are picked; {n_points:,} points get class {code}.")
    columns = {"id": ids, **facts, "picked": picked.astype(int)}
    shifted = [[ring + sampling.corner for ring in rings] for rings in outlines]
    return classes, LayerFeatures(shifted, {name: values.tolist() for name, values in columns.items()})


def _numbers(selection: LayerFeatures) -> np.ndarray:
    """Return the attribute ``id`` of features as numbers, NaN for NULL."""
    try:
        return np.array(list(selection.columns["id"]), float)
    except (KeyError, TypeError, ValueError):
        raise ValueError(
            "Segments to pick need an attribute id with the numbers of segments, got "
            f"{', '.join(selection.columns) or 'none'}; choose outlines that 'Classify segments' made."
        ) from None


def _measured(
    points: np.ndarray, which: np.ndarray, heights: np.ndarray, density: float, monitor: Monitor
) -> tuple[dict[str, np.ndarray], list]:
    """Return the measures of segments ``which`` (n,) from 0, by fields of the layer, and their outlines."""
    grid, owner, cell = occupied_cells(points, which, density)
    planes = planes_of(points, which, int(which.max()) + 1)
    known = np.isfinite(heights)
    n_known, total = (np.bincount(which[known], weight, len(planes)) for weight in (None, heights[known]))
    facts = {
        "points": planes.count,
        "area": np.bincount(owner) * grid.size**2,
        "height": total / np.where(n_known, n_known, np.nan),
        "slope": np.degrees(np.arccos(np.clip(planes.normal[:, 2], 0, 1))),
        "roughness": np.sqrt(np.maximum(planes.eigenvalues[:, 2], 0)),
    }
    outlines = []
    for number, cells in enumerate(np.split(cell, run_starts(owner)[1:])):
        outlines.append(outline_of_cells(grid, cells, np.ones(len(cells)), 0.0))
        monitor.progress(number / len(planes))
    return facts, outlines
