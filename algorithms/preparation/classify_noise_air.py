"""Noise in the air over the scene: loose points that nothing supports."""

import numpy as np

from ..cloud.asprs import PointClass
from ..sampling.cloud_sampling import MEASURED, CloudSampling
from ..stage import stage
from .points_in_the_air import REACH, in_the_air


@stage(
    "Preparation",
    title="Classify noise in the air",
    tags="noise,outliers,birds,flock,dust,plume,high points,clean",
    writes=("classification",),
    reach=REACH,
)
def classify_noise_air(xyz, classification, *, sampling: CloudSampling = MEASURED, monitor=None):
    """Find loose points in the open air: birds, flocks, plumes of dust.

    They become high noise (class 18). Roofs and crowns that no trunk or wall supports in the cloud stay, as they stop
    most pulses.

    Parameters
    ----------
    xyz : ndarray of shape (n, 3)
        Coordinates (m).
    classification : ndarray of shape (n,)
        Classes; points that are noise already stay so and are not counted.

    Returns
    -------
    ndarray of shape (n,), uint8
        The classes, 18 for the noise that was found, all others as they were.

    Notes
    -----
    Points are noise if no chain of points up to 2.4 m apart (3.5 point spacings on sparse clouds) ties them to the
    scene and nothing is above them. They must also stop less than three tenths of the pulses. Wires, panes, the heads
    of lamps, and objects that the border of the cloud cuts stay. What touches the scene is not found: dust on the
    ground, birds in a tree.

    References
    ----------
    Carrilho et al. (2018), Statistical outlier detection method for airborne LiDAR data. [carrilho2018]
    The stage is this project's.

    Examples
    --------
    >>> x, y = np.mgrid[0:40:0.5, 0:40:0.5].reshape(2, -1)
    >>> z = np.where((abs(x - 20) < 5) & (abs(y - 20) < 4), 5.0, 0.0)
    >>> xyz = np.column_stack([x, y, z])
    >>> bird = np.vstack([xyz, [20, 20, 60]])
    >>> int(classify_noise_air(bird, np.zeros(len(bird)))[-1])
    18
    """
    classes = classification.astype(np.uint8)
    points, used = sampling.without_noise(xyz, classes, monitor)
    if not len(used):
        return classes
    hanging = in_the_air(points, sampling.spacing, monitor)
    classes[used[hanging]] = PointClass.HIGH_NOISE
    monitor.resolved(high_noise=int(hanging.sum()))
    return classes
