"""Whether the surroundings of each point are a line, a surface or a volume."""

from enum import IntEnum

import numpy as np

from ..stage import stage


class Dimensionality(IntEnum):
    """What the dimension ``dimensionality`` holds."""

    UNDEFINED = 0
    LINEAR = 1
    PLANAR = 2
    VOLUMETRIC = 3


@stage(
    "Features",
    tags="linear,planar,volumetric,linearity,planarity,scattering,structure,dimensionality,wire,power line",
    writes=("dimensionality",),
    cost=0.1,
    packages=(),
)
def classify_dimensionality(linearity, planarity, scattering, *, monitor=None):
    """Classify points as linear, planar or volumetric by the largest of linearity, planarity and scattering.

    Wires, poles and edges are linear, ground, roofs and walls planar, crowns and bushes volumetric. Nothing has to be
    trained; the scale of structure and noise is set by the neighborhood of 'Compute features', which comes before.

    Parameters
    ----------
    linearity, planarity, scattering : ndarray of shape (n,), float32
        Shares of the three, 0 to 1; NaN where undefined.

    Returns
    -------
    ndarray of shape (n,), uint8
        1 linear, 2 planar, 3 volumetric; 0 where a share is undefined. Of equal shares the lower number counts.

    References
    ----------
    Weinmann et al. (2017), Point cloud analysis for UAV-borne laser scanning, section 4.3. [weinmann2017]

    Examples
    --------
    >>> classify_dimensionality([0.7, 0.1, 0.2], [0.2, 0.8, 0.3], [0.1, 0.1, 0.5])
    array([1, 2, 3], dtype=uint8)
    """
    monitor.progress(0.0)
    shares = np.column_stack([linearity, planarity, scattering])
    undefined = np.isnan(shares).any(axis=1)
    if undefined.any():
        monitor.warn(f"{undefined.sum()} of {len(shares)} points have no features, so they are left undefined (0).")
    return np.where(undefined, Dimensionality.UNDEFINED, shares.argmax(axis=1) + Dimensionality.LINEAR).astype(np.uint8)
