"""Dimensions: their names in Python and on disk, dtypes and meanings, in one table.

Stages name dimensions by the Python name, in positional arguments (read) and in
``writes=``. A vector dimension (``normal``) is one array (n, 3) in Python and
several dimensions on disk. Undefined is NaN in a float dimension and 0 in an id.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Dimension:
    """One row of the table.

    ``disk`` holds the names on disk (one per component), as QGIS and PDAL write them. ``aliases`` are read as the same
    dimension; ``description`` has at most 31 bytes, since LAS has 32 for it; ``standard`` ones are LAS fields. ``of``
    is the id dimension whose numbers it refers to or describes: a stage that writes new numbers there clears it.
    """

    name: str
    disk: tuple[str, ...]
    dtype: str
    description: str
    unit: str = ""
    standard: bool = False
    aliases: tuple[str, ...] = ()
    of: str = ""

    @property
    def undefined(self) -> float:
        """The value of a point that has none: NaN in a float dimension, 0 in all others."""
        return float("nan") if self.dtype[0] == "f" else 0


_STANDARD = (
    Dimension("xyz", ("X", "Y", "Z"), "f8", "easting, northing, elevation", "m", standard=True),
    Dimension("classification", ("Classification",), "u1", "ASPRS class", standard=True),
    Dimension("return_number", ("ReturnNumber",), "u1", "number of this return, from 1", standard=True),
    Dimension("number_of_returns", ("NumberOfReturns",), "u1", "returns of the pulse", standard=True),
    Dimension("intensity", ("Intensity",), "u2", "strength of the return", standard=True),
    Dimension("scan_angle", ("ScanAngleRank",), "f4", "angle of the beam to nadir", "°", standard=True),
    Dimension("point_source_id", ("PointSourceId",), "u2", "flight line", standard=True),
    Dimension("gps_time", ("GpsTime",), "f8", "time of the pulse", "s", standard=True),
    Dimension("scan_direction_flag", ("ScanDirectionFlag",), "u1", "1 if the mirror turns forward", standard=True),
    Dimension("edge_of_flight_line", ("EdgeOfFlightLine",), "u1", "1 at the end of a scan line", standard=True),
    Dimension("red", ("Red",), "u2", "red", standard=True),
    Dimension("green", ("Green",), "u2", "green", standard=True),
    Dimension("blue", ("Blue",), "u2", "blue", standard=True),
)

_HEIGHTS = ("height above ground", "height_above_ground", "HAG")
_WRITTEN = (
    Dimension("height_above_ground", ("HeightAboveGround",), "f4", "elevation minus ground", "m", aliases=_HEIGHTS),
    Dimension("segment_id", ("SegmentID",), "i4", "segment; 0 if unassigned", aliases=("segment_id",)),
    Dimension("shape", ("Shape",), "u1", "1 plane, 2 cylinder, 3 sphere", of="segment_id"),
    Dimension("cluster_id", ("ClusterID",), "i4", "cluster; 0 if unassigned", aliases=("cluster_id",)),
    Dimension("wall_of", ("WallOf",), "i4", "cluster of the wall's roof", aliases=("wall_of",), of="cluster_id"),
    Dimension("linearity", ("Linearity",), "f4", "(l1 - l2) / l1"),
    Dimension("planarity", ("Planarity",), "f4", "(l2 - l3) / l1"),
    Dimension("scattering", ("Scattering",), "f4", "l3 / l1"),
    Dimension("entropy", ("Entropy",), "f4", "Shannon entropy of L, P, S"),
    Dimension("omnivariance", ("Omnivariance",), "f4", "(l1 l2 l3)^(1/3)", "m²"),
    Dimension("anisotropy", ("Anisotropy",), "f4", "(l1 - l3) / l1"),
    Dimension("eigenentropy", ("Eigenentropy",), "f4", "-sum e ln e, e = l / sum l"),
    Dimension("eigenvalue_sum", ("EigenvalueSum",), "f4", "l1 + l2 + l3", "m²"),
    Dimension("surface_variation", ("SurfaceVariation",), "f4", "l3 / (l1 + l2 + l3)"),
    Dimension("verticality", ("Verticality",), "f4", "1 - |nz|"),
    Dimension("normal", ("NormalX", "NormalY", "NormalZ"), "f4", "unit normal, upward"),
    Dimension("height_range", ("HeightRange",), "f4", "highest less lowest elevation", "m"),
    Dimension("height_deviation", ("HeightDeviation",), "f4", "deviation of elevations", "m"),
    Dimension("plan_radius", ("PlanRadius",), "f4", "reach of the neighbors in plan", "m"),
    Dimension("plan_density", ("PlanDensity",), "f4", "neighbors per area in plan", "points/m²"),
    Dimension("plan_eigenvalue_ratio", ("PlanEigenvalueRatio",), "f4", "m2 / m1 of the plan"),
    Dimension("optimal_neighbors", ("OptimalKNN",), "i4", "points of the neighborhood"),
    Dimension("dimensionality", ("Dimensionality",), "u1", "1 line, 2 plane, 3 volume"),
    Dimension("cluster_entropy", ("ClusterEntropy",), "f4", "mean entropy of the cluster"),
    Dimension("previous_source_id", ("PreviousSourceId",), "u2", "PointSourceId before the merge"),
    Dimension("voxel_count", ("VoxelCount",), "u4", "points of the voxel"),
    Dimension("confidence", ("Confidence",), "f4", "0 unsure to 1 sure of building", of="cluster_id"),
    Dimension("building_probability", ("BuildingProbability",), "f4", "likeness to the buildings", of="cluster_id"),
    Dimension("earlier_class", ("EarlierClass",), "u1", "class kept; 0 if not"),
    Dimension("reason", ("Reason",), "u1", "why it is a building or not", of="cluster_id"),
    Dimension("weakest_evidence", ("WeakestEvidence",), "u4", "kind, value and limit; 0 if none"),
)

DIMENSIONS = {dimension.name: dimension for dimension in (*_STANDARD, *_WRITTEN)}
