"""The methods of LiDAR Buildings as numpy functions, independent of QGIS.

Conventions, written once and kept by every stage:

* Coordinates are ``xyz``, float64 (n, 3): easting, northing, elevation in meters.
  Stages may be given large coordinates; they shift them before any covariance.
* Lengths are meters, areas square meters, angles degrees, densities points per
  square meter of occupied area. ``min_*`` and ``max_*`` are inclusive; a tolerance is a distance.
* Eigenvalues are ordered l1 >= l2 >= l3 >= 0, of the covariance with divisor n.
* Normals are unit vectors that point upward (n_z >= 0).
* A neighborhood holds the point itself.
* Ids (``segment_id``, ``cluster_id``) run from 1; 0 if unassigned. Undefined measures are NaN.
* Classes are members of :class:`~.cloud.asprs.PointClass`; stages that sort points by class leave noise (7, 18) out.
* ``noise`` is the standard deviation of points across smooth surfaces, ``roughness`` of points of one roof or wall
  across its plane, both m; points that are wrong are noise points.
* Withheld points never reach a stage: the runner leaves them out. They stay in the file, unless the stage makes a cloud
  of other points (``selects``, ``merges``).
"""

from .stages import STAGES

__all__ = ["STAGES"]
