"""Facades and openings of a street scan, moved onto an airborne cloud by the walls and the ground that both show."""

import numpy as np

from ..cloud.asprs import PointClass
from ..report.page import Row, build_page
from ..stage import InputLayer, LayerFeatures, Measure, Report, stage, tunable
from .extract_facades import extract_facades
from .extract_openings import PIERCED, extract_openings
from .plan_segments import facade_segments, outline_segments
from .registration import Registration, register

_MEASURES = (
    Measure("shift_x", "Shift eastward", "m"),
    Measure("shift_y", "Shift northward", "m"),
    Measure("shift_z", "Shift upward", "m"),
    Measure("residual", "Residual of common walls and ends", "m"),
    Measure("overhang", "Overhang of the eaves", "m"),
    Measure("walls", "Common walls"),
    Measure("ends", "Common ends of walls"),
    Measure("ground", "Common cells of ground"),
)

# Sentences of the report on each measure.
_MEANINGS = {
    "shift_x": "Added to the eastings of the street scan.",
    "shift_y": "Added to its northings.",
    "shift_z": "Added to its elevations, from the ground that both scans show.",
    "residual": "Root mean square distance of common walls and ends from the outlines after the shift.",
    "overhang": "Mean distance of airborne outlines outside the walls: eaves, and the spacing of the points at edges.",
    "walls": "Facades that lie on an edge of a footprint.",
    "ends": "Ends of facades that lie at a corner of a footprint; they give the shift along the street.",
    "ground": "Cells of 0.5 m in which the lowest point of the street is ground from the air, too.",
}


@stage(
    "Facades",
    title="Register street scan",
    tags="registration,alignment,shift,coregistration,mobile mapping,terrestrial,airborne,facade,street,Peng",
    input_layers=(InputLayer("footprints"),),
    layers=PIERCED,
    measures=_MEASURES,
    input_title="Airborne point cloud",
    reference_title="Street scan",
    reference="The scan of the street, from a vehicle or a tripod.",
    cost=20.0,
)
def register_street(
    xyz,
    classification,
    reference_xyz,
    reference_classification,
    footprints,
    *,
    max_shift: float = tunable(3.0, within="[0, 20] m"),
    min_size: float = tunable(0.4, within="[0.05, 10] m"),
    monitor=None,
):
    """Find facades, windows and doors in a street scan and move them onto the airborne cloud.

    The shift makes facades lie on the outlines of buildings, their ends at corners of these, and the street on the
    ground. It is reported with its residual. The airborne cloud stays where it is.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates of the airborne cloud, m.
    classification : ndarray of shape (n,), uint8
        Its classes: ground (2) gives the shift in height.
    reference_xyz : ndarray of shape (m, 3), float64
        Coordinates of the street scan, from a vehicle or a tripod, m.
    reference_classification : ndarray of shape (m,), uint8
        Its classes; ground, water and noise are no facades. All points may be unclassified.
    footprints : LayerFeatures
        Outlines of the buildings, from the airborne cloud.

    Returns
    -------
    facades, openings : LayerFeatures
        As of "Extract openings", in the frame of the airborne cloud.
    report : Report
        The shift, its residual and what it rests on.

    Other Parameters
    ----------------
    max_shift
        How far the street scan may be off the airborne cloud, along either axis.
    min_size
        Least width and height of a window or door.

    Raises
    ------
    ValueError
        If the airborne cloud has no ground points.

    Notes
    -----
    The paper scans streets without satellite positions and leaves open how its scans come together. A vehicle's
    position between high houses is off by decimeters to meters, its direction hardly at all; so the transformation is a
    shift. A search on a grid of 0.25 m finds the shift at which most of the walls lie on outlines. Least squares in
    narrowing rounds then solve for shift and overhang of the eaves together, which walls on both sides of a street
    separate. Where a street shows no end of a wall at a corner, the shift along it stays near 0.

    References
    ----------
    Peng, C., Yu, Z., 2018. Research on 3D building information extraction and image post-processing based on vehicle
    LIDAR. EURASIP Journal on Image and Video Processing 2018:121, sections 3 and 4. [peng2018]

    Examples
    --------
    >>> from lidar_buildings.algorithms.stage import LayerFeatures
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 6, 2)
    >>> ring = np.array([[15, 16], [25, 16], [25, 24], [15, 24], [15, 16.0]])
    >>> facades, openings, report = register_street(xyz, classes, xyz, classes, LayerFeatures([[ring]], {}))
    >>> sorted(report.values)
    ['ends', 'ground', 'overhang', 'residual', 'shift_x', 'shift_y', 'shift_z', 'walls']
    """
    is_ground = classification == PointClass.GROUND
    if not is_ground.any():
        raise ValueError(
            "No point of the airborne cloud is called ground (class 2); run 'Classify ground points (TIN)' first."
        )
    segment_id, _ = extract_facades(reference_xyz, reference_classification, monitor=monitor.part(0, 0.5))
    facades, openings = extract_openings(reference_xyz, segment_id, min_size=min_size, monitor=monitor.part(0.5, 0.9))
    result = register(facade_segments(facades), outline_segments(footprints), reference_xyz, xyz[is_ground], max_shift)
    if result is None:
        monitor.warn(
            "No facade lies on a footprint, so the street scan is not moved; raise the maximum shift, or check that "
            "both clouds show the same buildings."
        )
        result = Registration(np.zeros(3), float("nan"), float("nan"), 0, 0, 0)
    else:
        monitor.inform(_sentence(result))
    return _moved(facades, result.shift), _moved(openings, result.shift), _report(result)


def _sentence(result: Registration) -> str:
    """Return the shift and its residual in a sentence."""
    x, y, z = result.shift
    return (
        f"The street scan is moved by {x:.2f} m eastward, {y:.2f} m northward and {z:.2f} m upward; "
        f"{result.walls} walls and {result.ends} ends are then off the outlines by {result.residual:.2f} m (rms)."
    )


def _moved(features: LayerFeatures, shift: np.ndarray) -> LayerFeatures:
    """Return features moved by a vector (3,), m."""
    columns = dict(features.columns)
    if "base" in columns:
        columns["base"] = [base + float(shift[2]) for base in columns["base"]]
    return LayerFeatures([[ring + shift for ring in rings] for rings in features.geometries], columns)


def _report(result: Registration) -> Report:
    """Return the measures and their page."""
    lengths = (*result.shift.tolist(), result.residual, result.overhang)
    counts = (result.walls, result.ends, result.ground)
    values = dict(zip((measure.name for measure in _MEASURES), (*lengths, *counts)))
    shown = [*("undefined" if np.isnan(value) else f"{value:.3f} m" for value in lengths), *map(str, counts)]
    rows = [Row(measure.title, text, _MEANINGS[measure.name]) for measure, text in zip(_MEASURES, shown)]
    lead = _sentence(result) if result.walls else "No facade lies on a footprint; the street scan is not moved."
    return Report(values, build_page("Registration of a street scan", lead, {"Shift": rows}, ""))
