"""The part of a cloud that lies in polygons, or outside of them."""

from typing import Optional

import numpy as np

from ..geometry.polygon_overlap import are_in_polygons, as_polygons
from ..stage import InputLayer, LayerFeatures, stage, tunable


@stage(
    "Preparation",
    tags="las,laz,copc,pdal,clip,crop,cut,polygon,mask,extent,window,area,subset,extract,outside,erase,lasclip",
    selects=True,
    input_layers=(InputLayer("polygons", optional=True),),
)
def clip_cloud(
    xyz, polygons: Optional[LayerFeatures] = None, *, outside: bool = tunable(False, label="Keep outside"), monitor=None
):
    """Keep the points that lie in polygons, within an extent, or both; all their dimensions stay.

    Polygons cut in plan, at all heights. The extent is read first: of a COPC file only the chunks that touch it, of a
    virtual point cloud only the tiles. So a window of a large cloud can be taken out without reading all of it.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates, m.
    polygons : LayerFeatures, optional
        Areas whose points are kept: a district, parcels, a mask. They may overlap and have holes. Without a layer the
        extent alone cuts.

    Returns
    -------
    selected : ndarray of shape (m,), int64
        Positions of the points that are kept, ascending.

    Other Parameters
    ----------------
    outside
        Keep the points outside all polygons instead.

    Raises
    ------
    ValueError
        If points outside of polygons are asked for and there are no polygons, or if no point is left.

    Notes
    -----
    A point on the common edge of two polygons belongs to exactly one of them, so that clouds clipped with adjacent
    parcels share no point. On the outer edge of an area it may lie on either side. Points flagged as withheld are left
    out, as by every step that selects.

    References
    ----------
    Shimrat, M., 1962. Algorithm 112: position of point relative to polygon. Communications of the ACM 5(8).
    [shimrat1962]

    Examples
    --------
    >>> from lidar_buildings.algorithms.stage import LayerFeatures
    >>> ring = np.array([[15, 16], [25, 16], [25, 24], [15, 24], [15, 16.0]])
    >>> xyz = [[20, 20, 5], [5, 5, 0]]
    >>> clip_cloud(xyz, polygons=LayerFeatures([[ring]], {}))
    array([0])
    """
    if polygons is None:
        if outside:
            raise ValueError("'Keep outside' needs polygons to be outside of; choose a layer or leave it off.")
        return np.arange(len(xyz))
    is_kept = are_in_polygons(xyz[:, :2], as_polygons(polygons.geometries), monitor) != outside
    if len(xyz) and not is_kept.any():
        where = "outside" if outside else "within"
        raise ValueError(f"None of {len(xyz)} points lies {where} the polygons; choose another layer or extent.")
    return np.flatnonzero(is_kept)
