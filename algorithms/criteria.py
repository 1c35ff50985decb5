"""Criteria that are no choice of a method: a majority, normal errors, rounding, the millimeters of maps."""

# Share of the parts of something that decides for all of it: the majority.
MAJORITY = 0.5

# Standard deviations within which normal errors lie, all but one of 370.
DEVIATIONS = 3.0

# Standard deviations of one normal error within which the difference of two lies, as of two points, or of a point and
# the line through two others.
DIFFERENCE = DEVIATIONS * 2**0.5

# Side of a cell (point spacings) that holds four points of a surface on average: chance leaves one of fifty empty.
CELL_SPACINGS = 2.0

# Gap (point spacings) that random sampling of a surface does not leave: of 10^12 points one has such a hole around it.
GAP_SPACINGS = 3.0

# Point spacing (m) that the reach of automatic distances in parts of a cloud allows for: of 36 points per m².
WIDE_SPACING = 1 / 6

# Points of a neighborhood whose plane shows a surface: nine degrees of freedom, so that its deviation is known to a
# quarter.
PLANE_NEIGHBORS = 12

# Root mean square distance of as many points from their plane (standard deviations of the points) that one plane in a
# hundred exceeds by chance (chi-square).
SMOOTH = 1.55

# Roughness of a surface beyond noise (point spacings): its curvature between points.
BENDS = 0.05

# Share, distance (m) or area (m²) up to which rounding takes 0: far below the resolution of files.
ROUNDING = 1e-9

# Distance (m) or area (m²) up to which rounding of large coordinates takes 0: no map or cloud is as fine.
MICROMETER = 1e-6

# Positions closer than this (m) are the same, as maps and files have millimeters at best.
MILLIMETER = 1e-3

# Value in place of a missing number in grids and attributes: GDAL and most GIS programs take it for none.
NO_DATA = -9999

# Semi-major axis (m) of the ellipsoids of WGS 84 and GRS 1980.
EQUATORIAL_RADIUS = 6_378_137.0

# Semi-minor axis (m) of the ellipsoid of WGS 84; the one of GRS 1980 differs by less than 0.2 mm.
POLAR_RADIUS = 6_356_752.314245

# Directions that differ by less than this (°), of faces, slopes or edges, are the same way.
SAME_WAY = 20.0

# Lines with a smaller sine between them, and planes with a smaller share of the greatest singular value, are parallel:
# the position of their intersection is undetermined.
PARALLEL = 0.05
