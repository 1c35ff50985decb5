<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" sourcelanguage="en">
<context>
    <name>LidarBuildings</name>
    <message>
        <source>'automatic' follows the density and the noise of the cloud. The others are those of the paper of 2019 for its two surveys (table 2), whatever the cloud is like. They are planimetric distance 0.6 m and height difference 0.2 m with 50 points per minimum building area of 4 m², or 1.4 m, 0.3 m and 16 points. Values that are set win.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>1.2: one level top per building; 1.3: one per part where heights differ clearly; 2.2: the planes of the roof. Files have the simpler levels too.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>3D</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>3D: {}</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>95th percentile of the distances</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A .las, .laz or .copc.laz file.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A GeoPackage or any other vector format that QGIS writes.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A GeoTIFF, tiled and compressed.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A flat or arched bridge over a canal between quays, a footbridge over a stream, one or two decks over a cutting, a bridge over a valley, a fly-over with ramps. Or no bridge: the mouths of a tunnel, a jetty, a ramp that ends over a wall. 'all' lays them side by side.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A folder of .las and .laz files, a .vpc file, or any number of files.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A height has changed if it differs by more.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A page that shows the numbers.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A piece of a line goes on behind an obstacle up to this width, such as a hedge, a car or a gap without points. Its ends there must meet the criteria of slope and height. 0: it ends.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A river in a channel, with a bridge for every street.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A simulated town without classes. Choose Plugins ▸ LiDAR Buildings ▸ Find buildings.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Add this text to a report of a problem.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Add to the ground what lies on its surface and has no other class.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Add walls, chimneys, edges and gaps to each building, and number the buildings.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Address of a Dask scheduler</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Airborne laser, 4 points per m² and more</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Airborne laser, fewer points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>All points, or those of the facade lines of a vehicle's scan: steep lines that are the farthest on their side, which cars, trees and people are not. Facade lines need the GPS time of the points.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>All steps</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Also find isolated points in the air (birds, flocks, plumes of dust) and under the ground (multipath), within the heights of the scene.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Also find single points and a few together under the ground (multipath), within the heights of the scene.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>An outline has changed if it is farther off somewhere.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Angle</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Angle between neighboring beams of a scanner.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Angle of a wall's normal to the horizontal.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Angle of the decks to the shortest way across.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Angle of the four oblique views to the vertical: more shows more of the walls.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Angle to the vertical at the edge of a strip. Wide strips show more of the walls and less of the yards behind them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Angular step</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Any dimension of the cloud, by name (Intensity, NormalZ, Z), whose range is to be limited.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Applied before voxels are connected: erosion shrinks and dilation enlarges objects, opening removes thin parts, closing fills narrow gaps.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Applied to the number of points of a voxel and its 26 neighbors before voxels with few points are left out. Mean and binomial are convolutions, which smooth; the others are rank orders: the minimum thins and the maximum widens, and the median removes single voxels.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Area of all buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Area of the buildings gone</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Area of the largest object: larger segments are bare earth, also where they are raised along their border, as islands and quarters between canals are.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Area of the new buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Area of the smallest bridge.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Area of the smallest building to be found.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Area of the smallest facade, where it has points.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Area of the smallest plane, measured on it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Area of the smallest roof plane of a gable.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Area of the smallest roof plane, seen from above.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Area of the smallest roof plane, seen from above; dormers have 2 m² and more.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Area of the smallest roof surface, seen from above.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Area of the smallest segment of the bare earth.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Area of the smallest surface, along the surface.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Area of the smallest surface, measured on it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Area of the smallest water body to be found.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Areas whose points are kept: a district, parcels, a mask. They may overlap and have holes. Without a layer the extent alone cuts.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Assess buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Assess classes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Assess footprints</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Assess ground</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Assess models</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Assess segments</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>At level 1.3, parts of a roof that step by less are one part.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>At levels 1.2 and 1.3, the share of the roof points below the top: 50 is the median, 100 the ridge.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Attribute of the footprints that names buildings in all results. With it, the layer of buildings and CityJSON keep all attributes of the footprints. If empty, buildings are named by the attribute 'id' or 'fid', or numbered, and in CityJSON also by their position, so that files can be merged.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 0.5 m where the cloud has more than 6 points per m² of its bounding rectangle, 1 m elsewhere.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 1.75 times the mean spacing of the building points, at least 0.44 m.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 10 times the measured surface noise, 0.2 to 0.3 m.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 2 m; 1.2 m in clouds of matched images, where edges are rounded.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 2 standard deviations: the surface noise and 0.05 point spacings.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 2 times the point spacing on surfaces, at least 0.02 m.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 2 times the point spacing on surfaces.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 2.3 times the roughness of surfaces, which is the root of the sum of the squares of the noise of the scan and of 0.065 point spacings.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 2.3 times the roughness: the measured surface noise, at least 0.025 m, and 0.065 point spacings on top.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 20 m, but no more than half of the longest side of the cloud, and at least twice the minimum.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 20°, in nature 30°.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 3 standard deviations: the surface noise and 0.05 point spacings.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 3 times the mean distance of scan lines.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 3 times the point spacing on surfaces.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 3 times the point spacing, from 0.6 to 5 m.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 3 times the point spacing.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 3 times the roughness of surfaces, which is the root of the sum of the squares of the noise of the scan and of 0.065 point spacings.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 3 times the roughness of the cloud's surfaces, 0.08 to 0.35 m.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 3.1 times the roughness: the measured surface noise, at least 0.025 m, and 0.065 point spacings on top.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 4 for straight edges; 1.5 for key points, as published.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 4 point spacings, from 3 to 20 m.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 4 point spacings.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 4 standard deviations of the surface noise.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 4.5 standard deviations: the surface noise and 0.05 point spacings.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 5 cells.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 6 times the roughness of the finished surface, or the surface noise where that is more; the last third at most 0.1 cells.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 6 times the roughness of the finished surface.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 60 m, and any size for segments that are free-standing on nearly all sides; or as the terrain says.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 8 times the roughness of the surface, estimated in each round; or half of that and half the point spacing, if that is more.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 8 times the roughness of the surface, measured again in each round; or half of that and 0.5 point spacings, if that is more.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 8 voxels.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 9 times the point spacing.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: a plane off by half a bin is off by one distance bin at the side of the window; at most 11°.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: a quarter of the points of a level surface within the radius, as at the corner of a roof.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: as many as hold the error of normals from the noise to 3°, 12 to 80.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: as many as reach 6 times the roughness at the density of low points near roofs, 8 to 30.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: cells of 4,000 points on average.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: cells of 450 points on average.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: fine where points are farther apart than 1 m, else medium.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: half the point spacing (coarse and medium: the whole), at least that of the granularity.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: half the side of a window, squared.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: measured in the cloud</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: measured on the cloud, on its smoothest fifth; at least 0.01 m, or a twelfth of the radius where that is less.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: measured on the cloud, on its smoothest fifth; at least 0.01 m.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: measured on the cloud; 'Segment roofs', 'Classify buildings' and 'Complete buildings' take the effective density, less where points lie on lines, in pairs or in dense strips, so that distances reach over the gaps.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: the higher one of the heights chosen above.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: the larger of 1.2 times the point spacing and 6 times the roughness of surfaces.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: the larger of 10 median steps between points and 3 distances of scan lines.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: the lower one of the heights chosen above.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: the median time between two views of the sky, which give no points.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: the point spacing, at least 2 m.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: the points of the minimum building area (Ar_min d), at least 3.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: the radius of a circle that holds 'Nearest points' at the measured density.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: the smallest kind from town on that has room for the largest building found.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: the smallest neighborhood in which neither noise nor scan lines blur a plane.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: the tolerance: two bins side by side then hold a plane with its noise.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: three standard deviations of the measured surface noise with 0.01 m of relief.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: three times the median difference between the heights of both surveys, 0.5 to 3 m.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: three times the median distance between the outlines of both surveys, 1 to 4 m.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: three times the median distance of nearest corners that are not so by chance, 1 to 3 m.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: twice the grid cell size.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: twice the point spacing, at least 1 m.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: twice the point spacing, rounded to 1, 2 or 5 times a power of ten; at least 0.05 m.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: twice the point spacing.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: wide enough for 20 points of a surface and for 10 tolerances, 0.5 to 3 m.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: wide enough for 40 points of a surface and for 20 tolerances.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Average number of points per square meter of occupied area.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Axes of cylinders</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Beams, gratings and clutter</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Bin height</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Block</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Boundary</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Branches</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Branches of the stem.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Bridges</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings changed in height</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings changed in outline</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings found</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings found one to one</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings found, merged or split</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings found, merged, split, missed and invented</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings found, missed and new</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings gone</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings in the earlier survey</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings in the new survey</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings in the old map</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings in the reference</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings merged with others</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings missed</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings new, gone and changed</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings of the earlier survey, cut to the area of both.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings of the new survey, cut to the area of both.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings split</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings that are trusted: a cadastre, a base map, an earlier result; cut to the same area.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings to compare with, cut to the area that was surveyed; without a map, all footprints are new.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings unchanged</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Candidate corners</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Candidate corners that are corners of footprints</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cars</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cars on the decks.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cars, hedges and bushes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cars, hedges, walls and wires</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cell in which the lowest point is looked for.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cell size</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cell whose lowest point starts the surface: the shorter side of the largest building. Smaller keeps more of narrow hilltops. In lasground, the tool that the authors of 2019 used, it is 5 m in nature, 10 m in towns, 25 m in cities and 50 m in the largest cities.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cells of the surface model without points are interpolated up to this far from cells with points.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cells: F-score</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cells: completeness</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cells: correctness</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cells: falsely called building</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cells: found</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cells: missed</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cells: quality</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Centers of spheres</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Certificates for tls</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Changes since the old map</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Check installation…</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Choose a point cloud first</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Class</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Class codes that dialogs begin with</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Class threshold</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classes and the code that each gets instead, over those chosen above: 3-5=5; 17=26. Numbers and ranges before the sign, entries separated by semicolons; empty for none.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classes by their names</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classes that count as one: numbers and ranges separated by commas, and one such group from the next by a semicolon; empty merges none.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classify bridges</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classify buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classify buildings (as published 2019)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classify dimensionality</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classify ground points (TIN)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classify ground points (TIN, as published 2000)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classify ground points (cloth)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classify ground segments</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classify low, medium and high vegetation: points above the ground without another class.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classify multipath under the ground</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classify noise by distance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classify noise by height histogram</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classify noise by height histogram (as published 2019)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classify noise in the air</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classify points as linear, planar or volumetric by the largest of linearity, planarity and scattering.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classify points as linear, planar or volumetric in a cloud, or in those of several scanners merged.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classify roofs</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classify the points on water: where few pulses came back, from one level, lower than the ground around.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classify the wires of power lines (14), of high and low voltage, and the masts and poles at their ends (15).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classify vegetation</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classify walls</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classify water</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Classify wires</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Clearance above the roof</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Clip cloud</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Clusters</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Clusters called building</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Clutter</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Codes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Codes to write</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cohen's kappa</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Common cells of ground</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Common ends of walls</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Common walls</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Compare all classes with those of a reference: confusion matrix, accuracy, kappa, and figures of each class.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Compare corners</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Compare footprints with polygons of a reference, building by building, and mark what agrees and what doesn't.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Compare segments with those of a reference: which are correct, cut up, run together, missed or invented.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Compare surveys</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Compare the buildings of a classification with those of a reference: completeness, correctness, F-score, quality.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Compare the corners of footprints with those of an older map: distances, shift, buildings found, missed and new.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Compare the ground of a classification with that of a reference: type I, type II and total error, kappa.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Comparison</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Complete</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Complete buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Complete ground</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Complete hidden parts</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Compute features</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Confidence</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Coordinate reference system</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Coordinate reference system (of a cloud that names none)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Copy</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Corner distance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Corners farther apart are not the same corner.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Corners farther apart, when the shift between the maps is taken off, are not the same corner.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Corners matched</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Corners of the buildings found</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Corners of the buildings that have footprints</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Corners of the footprints</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Correct segments</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Correct segments of the reference</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Correct the edges of buildings by what the other buildings of the scene look like.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cut into tiles</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cut point clouds of any size into square tiles.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cut the cloud into artificial scan lines of several directions, group their points, and merge the groups.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Cylinders</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Dask schedulers that may be used (addresses, with spaces between)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Density of points on walls, as a share of that on open ground.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Describe the shape of each point's neighborhood by the eigenvalues of its covariance.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Detect buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Detect buildings on a survey of any size, tile by tile, in several processes.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Detect buildings, in tiles</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Detect buildings, published 2019</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Detect buildings, published 2019 on a survey of any size, tile by tile, in several processes.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Detect buildings, published 2019, in tiles</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Detect cylinders</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Detect spheres</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Diameter of the stem at breast height, 1.3 m.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Dimension</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Dimensions of the point cloud</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Direction of both lines from east.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Directions</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Directions of artificial scan lines, evenly spread.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Displacements of corners</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance at which a point lies on a face or plane.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance at which a point lies on a plane. A larger one gives fewer planes.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance between the fronts of both sides.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance between the towers of the transmission line.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance bin</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance from the straight line through a piece, and of its ends from the plane of a region.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance of neighboring points on adjacent scan lines at most.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance of the cloth's particles (grid resolution).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance over which eaves and ridges are rounded.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance to the plane of a surface within which points belong to it; larger joins rougher and more curved surfaces.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance within which a point lies on a plane.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance within which a point lies on the plane of a facade. Smaller divides a curved front into more strips and separates shallower recesses.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance within which a point lies on the surface.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance within which points lie on a line segment: a few standard deviations of the noise and of the relief of walls.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distance within which points lie on a wall.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distances of buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Distances of faces</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Divide a vehicle's scan lines into straight segments, and label those of ground, facades and other objects.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Divide trees that were scanned from the ground into stems and branches, with diameters, lengths and volumes.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Doubtful buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Downsample to voxels</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Draw cylinders around their axes and spheres around their centers, as polygons in space.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Drone, laser scanner</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Drone, matched images</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Duration</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Each tile is written as COPC too, into a folder 'shown' among the tiles, and a virtual point cloud over these is loaded: QGIS shows the points of no other tiles. It takes as much space again. Without effect on the command line.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Earlier</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Edge length</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Edges of neighboring facades move onto the intersection line of their planes from this far at most; 0 leaves them where they are.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Empty: no limit; the log gives the range of the cloud.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Everything is installed.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Everything is installed; the algorithms can run.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Existing</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Export for roofer</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Extent (empty = the whole cloud)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Extract facades</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Extract footprints</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Extract openings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Extract wall footprints</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>F-score of bridges</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>F-score of building</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>F-score of ground</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>F-score of noise</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>F-score of vegetation</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>F-score of water</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>F-score of wires</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Facade distance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Facades</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Facades with openings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Faces</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Facets whose edges are all shorter are not refined.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Features</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>File or layer of the points.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>File or layer.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Files or layers of points, one or more.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Files…</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Fill what cars, trees and people hide of the foot and the sides of a facade; without it a facade ends where its points do.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Filter of counts</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Filter points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find bridges and fly-overs in a cloud with classified ground, also where the ground filter took them for ground.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find buildings in this view…</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find cylinders (pipes, tanks, columns): axes with radius and length, and the points on each.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find facades, windows and doors in a street scan and move them onto the airborne cloud.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find groups of multipath points under the ground, which a ground filter takes for pits.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find loose points in the open air: birds, flocks, plumes of dust.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find planes among the points that are not ground: by RANSAC in voxels, joined where they continue each other.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find planes as maxima of a parameter space, group their points by proximity, and draw them as polygons.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find points far above or below the scene by the cell histogram filter.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find points far above or below the scene, such as birds, clouds and multipath returns.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find points far from their nearest neighbors, and groups of points apart from all others.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find spheres (vessels, domes, targets): centers with radius, and the points on each.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find the buildings among clusters by their mean entropy and by how far laser beams penetrate them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find the buildings among clusters by their mean entropy, as published in 2019.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find the buildings in a point cloud by the steps of the paper of 2019, to compare with.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find the buildings in a point cloud: classified points and footprints, with nothing to set.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find the buildings of the active point cloud within the map view</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find the buildings that are new, gone, or changed in height or outline since an earlier survey.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find the facades of buildings and draw each as a vertical polygon with its common borders.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find the ground by letting a cloth fall onto the terrain turned upside down.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find the ground by letting a triangulated surface grow from the lowest point of each large cell.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find the ground by letting a triangulated surface grow through the lowest points.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find the points of walls below roofs: lower than roofs, upright, and inside the grown hull of a roof.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Find windows and doors, cut them out of the facades, and measure their size, position and row.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Flat halls</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Flat roofs with parapets, 10 to 100 m long, where there is room.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Flight height</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Folder of point clouds</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Folder…</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Footprints</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Footprints invented</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Footprints of buildings, from 'Extract footprints' or any other source; heights, volumes and confidences are read from their attributes 'height', 'volume' and 'confidence'.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Footprints of the earlier survey</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Footprints that are in the reference</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Footprints that are outlines of walls</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>For example tcp://head-node:8786 or tls://head-node:8786; empty: processes of this machine. The workers must see the input and the output folder under the same paths.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Found, missed and invented buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>From one neighborhood that 'optimal' tries to the next; larger steps are faster and coarser.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>From take-off to landing: a fifth of it each for the climb and the landing, the rest for one turn. Longer flights have more points.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Gable houses</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Gap between roofs</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Gap distance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Gap to close</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Gaps in a roof up to this wide are filled where no ground is seen in them (gutters, skylights, ridges).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Gather the planes above a height into the roofs of buildings.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Gather the points above the ground into roof surfaces and clusters of everything else.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Gather the points that are not ground into clusters by region growing.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Gather the points that are not ground into clusters where they lie densely (DBSCAN).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Give each point the normal of its plane (NormalX, NormalY, NormalZ).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Glass</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Granularity</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Greatest height above the ground of the points kept: 2.5 m leaves everything lower than roofs.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Grid cell size</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Ground</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Ground points in the reference</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Group points by the connected components of the voxels that they occupy.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Grow surfaces from smooth seeds to the points beside them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height above ground</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height above the ground from which points are vegetation; lower ones are unclassified.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height above the ground from which vegetation is high (5).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height above the ground from which vegetation is medium (4), and that from which it is high (5); below both it is low (3). The last two are those of the French and the Australian surveys.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height above the ground from which vegetation is medium (4).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height above the ground of the lowest wires.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height above the ground that parts roofs, which are looked for above it, from walls, which are below.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height above their surroundings from which parts of the bare earth are bridges, and segments objects.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height difference</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height from hollows to hills, about.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height of stoops</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height of terraces</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height of the banks across the slope, one every 45 m.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height of the bins.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height of the bins; noise is parted from the scene by at least two empty ones.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height of the doors over the street. Stairs lead up to them; from 1.4 m on there are cellar windows.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height of the lowest facade; cars and hedges are lower than walls.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height of the tree.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height over the scene, or depth under it, beyond which everything is noise, however many points it has: clouds, aircraft, flocks. Cables over a deep valley may need more.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height step</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Height tolerance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Heights above the terrain</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Heights of medium and high vegetation</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>High vegetation from</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Houses</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Houses on a hectare of streets and plots.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far a point's mean distance may lie over that of the whole cloud. Smaller values remove more, and sparse parts of the scene with it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far behind the wall points may belong to its openings; deeper recesses are parts of the building.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far roofs may jut out over their walls; parts deeper under a roof are inside.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far the cloth falls in one step; smaller is slower and steadier.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far the convex hull of a roof is grown; walls outside it belong to nobody.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far the eaves jut out over the walls; sheds have half.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far the ends of a front are before or behind the line of its neighbors at most: fronts nearly in one plane.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far the old map lies to the east and to the north.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far the scanners see.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How far the street scan may be off the airborne cloud, along either axis.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How finely the surface is started and refined: it sets the grid cell size where that is automatic, at least 2 m (coarse), 1 m (medium, fine) or 0.5 m (extra fine).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How high over the street the drone climbs.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How many blocks are worked on at once; each takes about 2 GB of memory.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How many times the operation erodes or dilates.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How the mean entropies are separated: 'exact' tries every gap between them; 'k-means' is scikit-learn's, from ten random starts.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>How the plane of a neighborhood is found. Least squares is quick and finds seeds where all points around are of one surface; robust least squares leaves outliers out. The local Hough transform finds planes among outliers and at edges, in 4 times the time.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Identifier</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Ignored classes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Installing Python packages…</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Install…</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Interpret structure</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Interpret structure on a survey of any size, tile by tile, in several processes.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Interpret structure, in tiles</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Intersection over union of bridges</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Intersection over union of building</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Intersection over union of ground</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Intersection over union of noise</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Intersection over union of vegetation</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Intersection over union of water</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Intersection over union of wires</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Invented faces</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Invert</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Isolated points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Isolated points under the ground</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Iteration angle</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Iteration distance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Iterations</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Keep classes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Keep existing classes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Keep existing ground</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Keep outside</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Keep points at least so high above the ground: 0.3 m takes ground and grass away.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Keep points of these classes: numbers and ranges, separated by commas (2, 6-9); empty keeps every class.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Keep points that have at least this in the dimension.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Keep points that have at most this in the dimension.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Keep the points outside all polygons instead.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Keep the points that any of the limits leaves out, and leave out the others.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Keep the points that are of some classes, between two heights above the ground, and in a range of any dimension.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Keep the points that lie in polygons, within an extent, or both; all their dimensions stay.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Kept</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Kept buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Kept ground</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Kind</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Kind of cloud</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Kind of cloud that dialogs begin with</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Kind of terrain and of its buildings: it sets the maximum building size (20, 40, 60, 120, 250 m) and the iteration angle (30° in nature, else 20°) where these are automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Land cover</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Larger blocks take more memory and less time, as less of what surrounds them is worked on twice. Empty: the largest multiple of 50 m, from 100 to 1600 m, that has at most 5.3 million points with those around it; in dense clouds a multiple of 10 m, from 1.25 times the distance around it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Largest angle between a facet and the lines to its nodes under which a point joins the surface; larger follows steeper breaks and lets more low objects in.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Largest angle between the normals of a point and of the surface, with smooth normals only.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Largest angle of a facade to the vertical.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Largest distance from its facet at which a point joins the surface.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Largest gap at the ridge</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Largest neighborhood that is tried by the neighborhood 'optimal'; time grows with it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Largest radius that is looked for.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Laser pulses of the scan from the air.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Laser pulses on average.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Laser pulses on average; on open ground each of them gives a point, in trees several, on water few.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Layers</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Learn from the scene</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Learn what buildings of this cloud look like, and correct points near their edges that look otherwise. Without it nothing is changed.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Least radius that is looked for.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Least share of the circumference that must have points, 0 to 1. A cylinder of which less is seen has an uncertain radius.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Least share of the sphere that must have points, 0 to 1. A sphere of which less is seen has an uncertain radius.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Least width and height of a window or door.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Leave one point in every occupied voxel: the center of gravity of its points.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Leaves</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Length</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Length of the shortest branch; points of shorter ones are leaves.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Length of the shortest wall that is looked for.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Length of the street.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Let the cloth down where it hangs over slopes without a step of 0.3 m from one particle to the next.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Level of detail</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Level segments at most this high over the lowest one of their line are ground (d0).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>LiDAR Buildings: installation</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Line distance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Line duration</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Line rate</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Line segments</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Line width</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Lines with heights and the attributes 'id' and 'radius'.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Local: points are accepted near the plane of the surface around the nearest of its points, so that smooth curved surfaces are one. Global: near the plane of all points of the surface (plane growing). Or anywhere.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Longest edge</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Longest part of an axis without points, behind a flange or in the shadow of another object, across which pieces of one radius in one line are put together; 0 leaves them apart. An end cap always parts them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Look for vegetation</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Look for water</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Look for wires</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Lower points may be ground, kerbs and plants.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Make one cloud of several, each but the first turned and moved if need be; PointSourceId identifies them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Make rasters of the terrain, of the surface with all objects on it, and of the difference.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Make walls straight and, where they nearly are, parallel or square to each other.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Map footprints</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Map footprints on a survey of any size, tile by tile, in several processes.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Map footprints, in tiles</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Map the walls of buildings from a drone's point cloud, and compare them with the old map.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Margin</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Margin around roofs</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Matched images show one closed surface, crowns included. There, roofs are distinguished from crowns by planarity over meters and by color, and low buildings are looked for. 'automatic' takes a cloud for matched images that has no second returns, at least 8 points per m² and no points beneath crowns.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Maximum angle</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Maximum bridge width</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Maximum building size</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Maximum clearance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Maximum depth</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Maximum distance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Maximum edge</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Maximum gap</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Maximum ground height</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Maximum height</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Maximum nearest points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Maximum object area</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Maximum overhang</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Maximum penetration</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Maximum radius</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Maximum range</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Maximum scan angle</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Maximum shift</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Maximum slope</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Maximum tilt</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Maximum value</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Mean distance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Mean entropy of buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Mean entropy of everything else</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Mean height above ground of the lowest roof and of other clusters.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Mean intersection over union</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Mean shift eastward</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Mean shift northward</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Measure how far models of buildings are from the points of their roofs, and which planes are missing or invented.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Measure how high each point lies above the ground points around it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Median Hausdorff distance of these</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Median IoU of the buildings found one to one</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Median distance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Median distance of matched corners</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Median of the buildings' RMS</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Median shift of the footprints eastward</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Median shift of the footprints northward</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Median squareness of the footprints</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Median squareness of the reference</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Medium vegetation from</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Merge</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Merge point clouds</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Merge the triangles of a TIN to planes, the most similar neighbors first.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Merge touching buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Merged classes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Method</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum area</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum bridge area</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum building area</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum distance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum facade area</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum facade height</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum frequency</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum ground area</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum height</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum hole area</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum length</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum nearest points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum overlap</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum plane area</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum points of a piece</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum points of a voxel</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum radius</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum roof area</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum share of buildings around</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum share of roof surfaces</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum share of walls seen</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum share seen</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum size</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum slope</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum step</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum value</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum wall length</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Minimum water area</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Missed segments of the reference</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Missing planes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Model a block from an airborne cloud and a street scan: roofs, walls, windows and doors in one model.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Model buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Model buildings as closed solids of roof planes, walls and a level ground, at levels of detail 1.2, 1.3 and 2.2.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Model buildings on a survey of any size, tile by tile, in several processes.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Model buildings, in tiles</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Model city block</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Model facades</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Model facades on a survey of any size, tile by tile, in several processes.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Model facades, in tiles</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Model industry</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Model industry on a survey of any size, tile by tile, in several processes.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Model industry, in tiles</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Model pipes, tanks, spheres and planes of a scanned plant: axes, centers and surfaces with heights.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Model terrain</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Model terrain on a survey of any size, tile by tile, in several processes.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Model terrain, in tiles</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Model the bare earth without objects and bridges: classified points and rasters, by segments.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Model the buildings of a block with the walls, windows and doors that were seen from the street.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Model the buildings of a point cloud in three dimensions: roofs and walls as layers and CityJSON.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Models</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>More results</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Most points on a surface: it has them up to 6 m from the scanner. The floor has a twentieth.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Most steps of the simulation.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Near ground</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Nearest points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Nearest points whose mean distance is taken, the point itself not counted.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Nearest points within the radius that are used, the point included.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Neighborhood</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Neighbors</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Neighbors that the operation reaches with each step: 6, 18 or 26.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>New buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>New outlines of buildings.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Noise</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Noise of the old map</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Noise points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Noise segments</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Not installed: {}. Python says: {}</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Objects at walls that are no buildings.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Objects in the input</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Objects in the reference</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Objects: F-score</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Objects: completeness</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Objects: correctness</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Objects: falsely called building</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Objects: missed</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Oblique angle</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Of clouds that name none, and of their results. Clouds that name one keep it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Of the simulated cloud.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Old map</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Only points at least this high above the ground are clustered, where heights are known.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Only points within are read: to try parameters on a part of the cloud first. Empty: all points.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Open sample data</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Openings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Operation</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Other objects of a town that are no buildings.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Outline buildings that touch as one block. Otherwise each has its own footprint, and so have three houses of a row or more where valleys between their roofs, steps or walls above them show which is which.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Outline each building as a polygon with its area, heights, volume, entropy and confidence.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Outline the walls of each building, without the eaves: corners where walls meet, and a quality for every edge.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Outline tolerance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Outlines before the walls</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Outlines of buildings that are to be assessed.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Outlines of the buildings that are modelled.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Outlines of the buildings, from the airborne cloud.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Outlines of the buildings: those of 'Extract footprints', or any other map of roofs or walls.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Over-segmented segments of the reference</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Overall accuracy</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Overhang of roofs</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Own codes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Packages of the system have to be installed in a terminal, then QGIS be started again:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parallel lines of a rotating mirror, the zigzag of an oscillating one, or pulses at random.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Percentile of level tops</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Photograph a made-up site with a drone, match the images with all their errors, and keep the truth.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Photograph a made-up village with a drone: the matched points, the true footprints of the walls, and an old map.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Pieces join a region near the plane of all its points (planar), as published, or near the plane of the pieces beside them (smooth), so that terrain, domes and ramps are one.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Pieces of a line with fewer points join nothing.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Pipes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Pipes and spheres</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Planarity</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Planes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Planes of the points that are smaller, seen from above, are not missed.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Planes per voxel</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Planes that are looked for in one voxel.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Planes through three points that are tried for each plane.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Planimetric distance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Plots with a house on a hectare of streets and plots, two of three with a shed as well.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Plots with a house or a short row on a hectare of streets and plots; 0 makes fields. The river's valley and the forest have none.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Point cloud</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Point clouds</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Point density</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points above ground</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points are accepted only if their normals are like that of the surface beside them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points are near if they are among the nearest within the radius, or joined by an edge of the triangulation in plan that is no longer (for clouds with one surface above each position).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points at most this far above or below the cloth are ground.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points at most this far above or below the finished surface are ground too; 0 leaves its nodes only.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points at most this far apart are neighbors (eps); larger joins clusters over wider gaps.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points before thinning</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points closer than this in plan, and close enough in height, belong together (T_Dxy; the paper has 0.6 m at 12.5 and 1.4 m at 4 points/m²).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points compared</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points far above (birds) and below the ground (multipath), half of each.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points for normals</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points in correct segments</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points in noise segments</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points of a line also belong together if their heights differ by no more than this.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points of a line belong together if the line between them is no steeper; 90 leaves the criterion out.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points of a line that are closer in space may belong together; larger passes over wider obstacles.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points of a plane at most this far apart are of one surface; wider gaps, and gaps wider than a window, part coplanar surfaces.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points of both roof planes come this near to each other.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points of leaves around the ends of branches, per point of wood.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points of missed segments</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points of one plane at most this far apart belong to one facade; trees and poles leave such gaps.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points of over-segmented segments</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points of planes at most this far apart belong to one building.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points of roofs</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points of the neighborhood in which the entropy of a point is measured, itself included (N).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points of the neighborhood that gives a point its normal, itself among them. More are less noisy and round off edges and thin pipes.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points of the shortest segment; shorter ones are stray points.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points of the smallest cylinder.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points of the smallest sphere.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points of under-segmented segments</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points of walls</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points on open ground, seen from above.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points on open ground; roofs have about as many, walls a tenth of it where a view reaches them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points on the model</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points on wood.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points per neighborhood, the point itself among them; used by the neighborhood 'nearest'. More of them smooth noise away and blur small things.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points that a bin of the histogram needs to belong to the scene (T_f). More of them remove denser noise, and thin things such as wires with it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points that a normal is made of, the point itself among them; used by the neighborhood 'nearest'.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points that have one of these classes in the reference are not counted: numbers and ranges, separated by commas (7, 64-67); empty counts every point.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points to search: the whole cloud, which forgets segments and shapes found before; the points that have no shape yet; or those of each segment (SegmentID) by itself. There, points on which no shape is found keep their segment.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points up to this distance from the box of a footprint are kept, so that its ground is among them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points up to this far above the roof belong to it where they cover a small part of it only (chimneys, dormers, masts). Trees cover more.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points up to this far above the roof belong to it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points whose heights differ by less than this, and that are close enough in plan, belong together (T_Dh; the paper has 0.2 m at 12.5 and 0.3 m at 4 points/m²).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points with heights and the attributes 'id' and 'radius'.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points within the radius, the point itself among them, that make a point the core of a cluster; larger leaves out thinner things.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points: F-score</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points: completeness</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points: correctness</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points: falsely called building</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points: found</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points: missed</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points: quality</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Polygons</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Polygons in the planes of the facades.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Polygons of the buildings in place of a reference cloud: a base map, a cadastre or an earlier result. Of the points within, all are building, also those of crowns over a roof.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Preparation</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Processes (empty = one for each core)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Proximity</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Pulse density</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Put back the classes that 'Keep classes' remembered.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Put houses with gable roofs behind the fronts; no front is curved then.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Put parked cars, trees, poles and people before the fronts, which hide parts of them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Python packages are missing: {}.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Quality</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>RMS of the distances</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radius</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radius of lines and points without an attribute 'radius', such as wires.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radius of others</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radius of the sphere around a point; used by the neighborhood 'radius'.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Range noise</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Rasterize terrain</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Reach of the neighborhood in which planes are fitted, and of growth.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Reason</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Recode classes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Reconstruct block</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Reconstruct gable houses: ten vertices from two roof planes, the height of the eaves and that of the ground.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Reconstruct gables</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Reconstruct pipes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Reconstruct roofs</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Record what a pulse meets on its way; otherwise the first surface only, with unknown return numbers, as image matching does.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Reference</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Reference point cloud</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Refine</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Refine buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Regions</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Register street scan</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Regularize outlines</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Relief</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Remember classes of a cloud that comes classified, for 'Restore classes' to put them back.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Remove</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Report</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Report on buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Residual of common walls and ends</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Restore classes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Ridge height</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Rigidness</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Rise of steps in the slope.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>River</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Roof faces with heights, of any program; faces with the same attribute 'building' are one building.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Roof points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Roof type</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Roofprints</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Roofs</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Rounding of edges</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Run this command? It installs Python packages for QGIS alone, from the Python Package Index.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Sample data</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Scale of simplification: bays and steps up to about this depth are left out where they are short.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Scan a made-up industrial plant: points with their true surface, the axes of pipes and tanks, centers of spheres.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Scan a made-up street from a drone with two line scanners, with the true class of every point.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Scan a made-up street from a vehicle or an airplane, with the true facades, windows, doors and corners.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Scan a made-up town from the air: houses, trees, a river, and the true class of every point.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Scan a made-up tree: points with their true branch, and the lines of stem and branches.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Scan lines end where two points in a row are farther apart.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Scan lines of each scanner.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Scan made-up bridges from the air: decks with parapets, piers and cars, and the true class of every point.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Scan made-up power lines from the air, and the true class of every point.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Scan pattern</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Scan the street from a vehicle or from an airplane. Both see the same street for the same seed.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Scanners</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Search</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Search in</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Seed</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Seeds</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Segment TIN planes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Segment clusters (DBSCAN)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Segment facade lines</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Segment planes (Hough)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Segment planes (RANSAC)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Segment recorded lines</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Segment regions</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Segment roofs</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Segment scan lines</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Segment surfaces</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Segment trees</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Segment voxels</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Segmentation</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Segments</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Segments of the reference</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Segments with fewer points get no id.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Separate bare earth from objects by how segments end, then bridges from bare earth.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Sets the parameters that are better set than measured for this kind of cloud.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Several returns</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Shapes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Share of a building that the other layer must cover for the building to be in it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Share of a building's area that the other map must cover for the building to be the same.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Share of a strip that the next one scans too. Without any, roofs and crowns at the seam are cut.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Share of all surfaces where matching found nothing, about.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Share of forest</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Share of holes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Share of the beam that may pass through a building: cells with points below, and returns that are not the last.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Share of the buildings that the map lacks; as many again are on it and gone, where plots are free.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Share of the points at about the height of a building's roof, within the clearance above and below, that must lie on roof surfaces. In crowns with a smooth side it is less. 0 takes any; in clouds of matched images it is not examined.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Share of the points of a segment that must lie in the other one, more than 0.5, so that each segment has one counterpart at most. 0.8 is usual.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Share of the points within a few meters around a building that must belong to buildings, its own included. Around smooth spots of crowns it is less.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Share of the pulses on window panes that pass them and are lost.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Share of the shorter of two pieces of a seed that lies beside the other.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Share of the site that is forest, also under the lines.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Share of the smaller building that both surveys must have for two buildings to be the same.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Share of the town that is forest.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Share of walls</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Shift eastward</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Shift northward</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Shift of the old map</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Shift upward</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Show models in 3D</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Show the tiles on the map</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Side of a block (m, empty = automatic)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Side of a cell of the rasters.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Side of a tile (m)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Side of a voxel. Points closer than about this belong together; larger voxels bridge wider gaps.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Side of a voxel: about the thickness of the thinnest branches. Smaller voxels show thinner branches and need denser points.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Side of the cells that are compared from above.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Side of the cells whose heights are counted, each together with the eight cells around it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Side of the cells whose heights are counted.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Side of the cubes in which planes are looked for; planes that continue in the next cube are joined.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Side of the cubes in which planes are looked for; smaller finds smaller planes and needs denser points.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Side of the cubes that are left with one point each. Take more than the noise of the scanner and less than the smallest object of interest.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Side of the site, a square from (0, 0).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Side of the town, a square from (0, 0).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Side of the village, a square from (0, 0).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Simulate bridges</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Simulate drone flight</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Simulate drone site</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Simulate plant</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Simulate power line</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Simulate street</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Simulate town</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Simulate tree</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Simulate village</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Simulation</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Size</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Skeleton only</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Slope</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Slope along the street.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Slope bin</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Slope of the flattest plane that is kept; 70° keeps walls.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Slope of the ground on the whole.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Slope of the ground, which is a plane.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Slope of the steepest plane that is kept; 90° keeps walls.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Slope of the steepest roof plane.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Slope of the steepest roof surface. Up to 90° walls are surfaces, too, so that towers are not lost in the trees that they touch; outlines then get less even.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Slope post-processing</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Smaller holes are filled, larger ones are courtyards.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Smaller segments, of the input and of the reference, count as none.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Smallest neighborhood that is tried by the neighborhood 'optimal'; fewer than ten describe noise.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Smooth normals</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Source of the points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Span</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Speed</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Speed of the vehicle.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Spheres</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Spherical vessels with diameters of 1 to 3 m.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Split height</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Split recorded scan lines into straight pieces and merge those of adjacent lines to planes or smooth surfaces.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Standard deviation of a point across the bark.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Standard deviation of a point in every direction.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Standard deviation of each point in every direction.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Standard deviation of errors that neighboring points share.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Standard deviation of its corners to the east and to the north.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Standard deviation of the distance of a point.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Standard deviation of the distances</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Standard deviation of the ground from the slope: gardens, kerbs, ruts.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Standard deviation of the measured distances.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Standard deviation of the points across a smooth surface.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Standard deviation of the points across a smooth surface. Roofs and walls may be rougher, by tiles, gravel and the spacing of the points.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Standard deviations</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Start of the random numbers: the same seed gives the same result.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Steep segments at most this much nearer to the scanner than the farthest one on their side of the line are of the facade (h0).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Steepest line from a point to the nodes of its facet under which it joins the surface.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Stem diameter</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Stems and branches</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Step of nearest points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Steps</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Stiffness of the cloth: 1 follows steep slopes, 2 terraces, 3 is for flat land.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Straight edges are fitted by least squares, along the main directions of the facade; key points are those of the traced boundary where it turns by more than 40°, as published.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Straight pieces with fewer points join nothing.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Straight pipes with diameters of 5 to 60 cm, on racks.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Street</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Street, vehicle or tripod</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Strip overlap</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Structure</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Structures on the roof</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Structuring element</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Surface model</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Surface noise</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Surfaces</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Surfaces with fewer points get no id.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Survey</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Survey: blocks, processes, files</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Sweep distance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tanks</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Terrace height</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Terrain</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Terrain angle</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Terrain model</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The same points with the true values, to compare with.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The same points with the true values; or give polygons of the true buildings.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The shorter side of the largest building; smaller keeps more of narrow hilltops.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The street scan, from a vehicle or a tripod.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>There is no layer to show; run a model first.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Thin the voxels of the layer to lines in the middle of the objects; the segments of the points stay.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Threads (empty = one for each core)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Three files of PEM, with semicolons between: certificate authority; certificate; key.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Thresholds</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tiles are compressed (.laz); otherwise they are .las files.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tiles are squares of this side.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Time of one turn of the scanner's mirror.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Time step</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Tolerance</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Total error</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Town</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Town, true classes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Transforms</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Trees</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Trees along the street.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Trees in gardens.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Trees on the land.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Trees outside the forest, single and in clumps, where there is room for them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Trees outside the forest.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Trials</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Triangles with a longer edge belong to no surface: they lie across walls and gaps.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Triangles with an edge longer than this many point spacings are removed from the boundary inward.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>True axes of pipes and tanks</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>True bridge decks</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>True buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>True centers of spheres</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>True corners</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>True facades</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>True footprints</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>True openings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>True outlines of houses</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>True stem and branches</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>True wall footprints</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Turn a street or terrestrial scan into facades with windows and doors, as polygons in space.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Two classes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Two surfaces merge if the points of either lie no farther from the common plane (root mean square).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Type I error</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Type II error</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Unclassified points no farther above or below the surface of the ground become ground; 0 adds none.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Undecided clusters</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Under-segmented segments of the reference</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Unevenness</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Unevenness of the ground</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Upper bound of the angle between a facet and the lines to its nodes under which a point joins the surface, which is estimated in each round. Larger follows steeper breaks and lets more low objects in.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Upright polygons of the walls seen from the street, in the frame of the cloud, as 'Register street scan' makes them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Upright tanks with diameters from 5 to 30 m, of which the sides and the roof are seen.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Vegetation</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>View</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Volume</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Volume of all buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Voxel size</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Voxels</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Voxels that belong together: those that share a face (6), a face or an edge (18), or a face, an edge or a corner (26).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Voxels with fewer points are left out: wood has several points to a voxel, leaves have single ones.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Voxels with fewer points, after the filter, count as empty: more suppress scattered points.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Wall edges</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Wall footprints</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Walls</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Water</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Waves</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What carries the pipes or lies near them and is no pipe.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>What to compute; each becomes a dimension of the cloud.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Where bridges are looked for: everywhere, or only around level surfaces over a gap in the ground with ground at their height at both ends, in a fraction of the time.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Where less of the perimeter has wall points, the outline of the roof is given instead.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Where the cloud has ground (2) already, it stays as it is and no other is looked for.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Where the clouds after the first go, in their order and separated by semicolons; empty for a cloud that stays. Six numbers: rotations about the axes to the east, to the north and up (°, in this order, counterclockwise), then offsets to the east, to the north and up (m). Or the 16 numbers of a 4x4 matrix, row by row. Or the path of a text file with either. '0 0 90 5 0 0; ; matrix.txt' turns and moves the second cloud, leaves the third and moves the fourth as the file says.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Which classes of a cloud that comes classified stay as they are: none, ground (2), ground and buildings (6), or all but 0 and 1. Where ground or buildings are kept, no others are looked for.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Which points describe a point: a number of nearest ones, all within a radius, or as many nearest ones as show the clearest shape (least eigenentropy), chosen for each point.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Which points give a point its normal: a number of nearest ones, or all within a radius.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Whose class codes are written: those of ASPRS, which all other steps read, or those of the Dutch, the French or the American survey.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Whose points are wanted. Run twice with one scanner each, the same flight gives two clouds to be merged.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Widest gap</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Widest gap in a stem or branch that is crossed.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Widest obstacle</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Width</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Width of a bin in the distance of a plane. Smaller bins separate planes that lie closer; in bins smaller than the noise the points of one plane scatter over several, and its maximum is lost.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Width of a bin in the slopes of a plane. Smaller bins separate directions, need more memory and time, and scatter a plane over several.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Width of an artificial scan line.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Width of the widest bridge; 0 looks for no bridges.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Window size</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Windows and doors</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Windows and doors of the model</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Wires</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>With center first, points vote for a center, and those of the best center for a radius. With four dimensions, they vote for both together, which takes more memory.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>With points, each point votes for all planes through it. With normals, the normal of a point votes for a direction first, the point for a distance then, which needs surfaces smooth enough for normals.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Without it no class changes: for models that have this step.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Write LAZ</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Write a page on the buildings found: number, areas, heights, volumes, a map, and the doubtful ones.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Write normals</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Write the class codes of an agency, or codes of one's own.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Write the points of buildings and ground around footprints, and the footprints, as the program roofer reads them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Wrong matches above and below the ground.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>automatic</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>empty</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>is not installed</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>none</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>one for each core</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>optional</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>the command gave no reason</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>the whole cloud</source>
        <translation type="unfinished"></translation>
    </message>
</context>
</TS>
