"""Classes that 'Keep classes' remembered, put back."""

import numpy as np

from ..cloud.asprs import PointClass
from ..geometry.boxes import connect
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..sampling.density import link_distance
from ..stage import stage

# Where a cloud came with points of one of these classes, no others are called so.
_WHOLE = (PointClass.GROUND, PointClass.BUILDING)


@stage(
    "Land cover",
    tags="class,restore,keep,existing,classified,ground,building",
    writes=("classification", "cluster_id"),
    written_if={"cluster_id": "where buildings are kept"},
    cost=0.1,
)
def restore_classes(
    xyz, classification, cluster_id=None, earlier_class=None, *, sampling: CloudSampling = MEASURED, monitor=None
):
    """Put back the classes that 'Keep classes' remembered.

    Where the cloud came with ground or buildings, points that steps in between called ground or building become
    unclassified (1). Kept buildings are numbered anew, those whose points are close to one another in plan as one.
    Without remembered classes nothing changes.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3), float64
        Coordinates, m.
    classification : ndarray of shape (n,), uint8
        ASPRS classes.
    cluster_id : ndarray of shape (n,), int32, optional
        Numbers of buildings.
    earlier_class : ndarray of shape (n,), uint8, optional
        Remembered classes, 0 for none.

    Returns
    -------
    classification : ndarray of shape (n,), uint8
        The classes, with those remembered.
    cluster_id : ndarray of shape (n,), int32, or None
        Numbers of the kept buildings, from 1; None where no buildings are kept or none are numbered.

    References
    ----------
    ASPRS, 2019. LAS specification 1.4, R15, table 17. [asprs2019]

    Examples
    --------
    >>> xyz = np.array([[0, 0, 0.0], [1, 0, 5.0]])
    >>> restore_classes(xyz, np.array([1, 6]), earlier_class=np.array([2, 0]))[0]
    array([2, 6], dtype=uint8)
    """
    classes = classification.astype(np.uint8)
    if earlier_class is None or not earlier_class.any():
        return classes, None
    for whole in _WHOLE:
        if (earlier_class == whole).any():
            classes[classes == whole] = PointClass.UNCLASSIFIED
    classes = np.where(earlier_class > 0, earlier_class, classes).astype(np.uint8)
    is_building = earlier_class == PointClass.BUILDING
    if cluster_id is None or not is_building.any():
        return classes, None
    points = xyz[is_building]
    number = np.zeros(len(xyz), np.int32)
    # Points above one another are of one building, whatever the difference in height.
    number[is_building] = 1 + connect(points, link_distance(sampling.spacing), 1 + float(np.ptp(points[:, 2])), monitor)
    return classes, number
