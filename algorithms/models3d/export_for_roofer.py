"""Points and footprints as the program roofer reads them."""

import numpy as np

from ..cloud.asprs import PointClass
from ..footprints.footprint_points import NO_AREA, require_buildings, require_ground, rows_near, tell_without_area
from ..geometry.rings import signed_area
from ..stage import Field, InputLayer, Layer, LayerFeatures, feature_names, stage, tunable
from .cityjson import unique_names
from .roof_partition import inside_rings

_FIELDS = (
    Field("identificatie", str, "name of the building: the attribute id or fid of its footprint, once each"),
    Field("points", int, "points of class 6 over it"),
)


@stage(
    "3D",
    tags="3D,roofer,3DBAG,LoD2,LoD1.2,LoD1.3,export,CityJSONSeq,roofprint",
    selects=True,
    input_layers=(InputLayer("footprints", buildings=True),),
    layers=(Layer("roofprints", "Roofprints", "Polygon", _FIELDS),),
)
def export_for_roofer(
    xyz, classification, footprints, *, margin: float = tunable(10.0, within="[0, 1000] m"), monitor=None
):
    """Write the points of buildings and ground around footprints, and the footprints, as the program roofer reads them.

    roofer takes a LAS or LAZ file with the classes 2 (ground) and 6 (building), and one polygon for each building with
    an attribute that names it: ``roofer --id-attribute identificatie cloud.laz roofprints.gpkg folder``. It writes
    CityJSONSeq.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m).
    classification : ndarray of shape (n,)
        Classes; points of 2 and 6 are kept.
    footprints : LayerFeatures
        Outlines of the buildings that are modelled.

    Returns
    -------
    selected : ndarray of shape (m,), int64
        The points that are kept, in their order.
    roofprints : LayerFeatures
        The footprints in plan, each with a name of its own; those without an area are left out.

    Other Parameters
    ----------------
    margin
        Points up to this distance from the box of a footprint are kept, so that its ground is among them.

    Raises
    ------
    ValueError
        If no point is called building, or none ground, or no footprint has an area.

    Notes
    -----
    roofer 1.0 reads the classes 2 and 6 unless its configuration names others, and models parts of a building as
    separate buildings. Its attribute for names is called as in the 3DBAG.

    References
    ----------
    Peters, R., Dukai, B., Vitalis, S., van Liempt, J., Stoter, J., 2022. Automated 3D reconstruction of LoD2 and LoD1
    models for all 10 million buildings of the Netherlands. Photogrammetric Engineering & Remote Sensing 88(3).
    [peters2022]

    Examples
    --------
    >>> from lidar_buildings.algorithms.stage import LayerFeatures
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> classes = np.where(z > 0, 6, 2)
    >>> ring = np.array([[15, 16], [25, 16], [25, 24], [15, 24], [15, 16.0]])
    >>> kept, *_ = export_for_roofer(xyz, classes, footprints=LayerFeatures([[ring]], {}))
    >>> len(kept) <= len(xyz)
    True
    """
    require_buildings(classification)
    require_ground(classification)
    plan = [[np.asarray(ring, float)[:, :2] for ring in rings] for rings in footprints.geometries]
    sound = [i for i, rings in enumerate(plan) if len(rings[0]) > 3 and abs(signed_area(rings[0])) >= NO_AREA]
    tell_without_area(len(sound), len(plan), monitor)
    order = np.argsort(xyz[:, 0], kind="stable")
    ordered, is_near = xyz[order], np.zeros(len(xyz), bool)
    wanted = np.isin(classification, (PointClass.GROUND, PointClass.BUILDING))
    points = []
    for number, i in enumerate(sound):
        rows = order[rows_near(ordered, plan[i], margin)]
        is_near[rows] = True
        building = rows[classification[rows] == PointClass.BUILDING]
        points.append(int(inside_rings(xyz[building, :2], plan[i]).sum()))
        monitor.progress((number + 1) / len(sound))
    names = feature_names(footprints)
    columns = {"identificatie": list(unique_names(names[i] for i in sound)), "points": points}
    return np.flatnonzero(is_near & wanted), LayerFeatures([plan[i] for i in sound], columns)
