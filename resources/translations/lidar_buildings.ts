<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" sourcelanguage="en">
<context>
    <name>LidarBuildings</name>
    <message>
        <source>'automatic' follows the density and the noise of the cloud. The others are those of the paper of 2019 for its two surveys (table 2), whatever the cloud is like. They are planimetric distance 0.6 m and height difference 0.2 m with 50 points per minimum building area of 4 m², or 1.4 m, 0.3 m and 16 points. Values that are set replace these.</source>
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
        <source>&lt;/li&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;/ol&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;/ul&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;AREA&lt;/b&gt;: Area compared, a layer of polygons; may be left empty. Where both layers are compared: buildings and footprints with half of their area within. Without it, the next parameter decides.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;AXES&lt;/b&gt;: Axes of cylinders, a layer of lines. Lines with heights and the attributes 'id' and 'radius'.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;AXES&lt;/b&gt;: Axes of cylinders, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;AXES&lt;/b&gt;: True axes of pipes and tanks, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Address of a Dask scheduler&lt;/b&gt; (SCHEDULER): For example tcp://head-node:8786 or tls://head-node:8786; empty: processes of this machine. The workers must see the input and the output folder under the same paths.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Angle (°)&lt;/b&gt;: Angle of the decks to the shortest way across. &lt;i&gt;(at least 0° and at most 50°; default 0°)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Angle (°)&lt;/b&gt;: Direction of both lines from east. &lt;i&gt;(at least 0° and at most 90°; default 15°)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Angular step (°)&lt;/b&gt;: Angle between neighboring beams of a scanner. &lt;i&gt;(at least 0.02° and at most 5°; default 0.25°)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;BRANCHES&lt;/b&gt;: Stems and branches, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;BRANCHES&lt;/b&gt;: True stem and branches, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;BUILDINGS&lt;/b&gt;: Buildings found, merged, split, missed and invented, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;BUILDINGS&lt;/b&gt;: Buildings found, missed and new, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;BUILDINGS&lt;/b&gt;: Buildings new, gone and changed, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;BUILDINGS&lt;/b&gt;: Buildings, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;BUILDINGS_REPORT&lt;/b&gt;: a page with Clusters, Clusters called building, Undecided clusters, Mean entropy of buildings, Mean entropy of everything else; each is an output of its own too.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;BUILDING_DISTANCES&lt;/b&gt;: Distances of buildings, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Beams, gratings and clutter&lt;/b&gt;: What carries the pipes or lies near them and is no pipe. &lt;i&gt;(default yes)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Bin height (m)&lt;/b&gt;: Height of the bins. Automatic: twice the point spacing, at least 1 m. &lt;i&gt;(at least 0.01 m and at most 1,000 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Bin height (m)&lt;/b&gt;: Height of the bins; noise is parted from the scene by at least two empty ones. Automatic: twice the point spacing, at least 1 m. &lt;i&gt;(at least 0.01 m and at most 1,000 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Block&lt;/b&gt; (Reconstruct block): Model the buildings of a block with the walls, windows and doors that were seen from the street.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Boundary&lt;/b&gt;: Straight edges are fitted by least squares, along the main directions of the facade; key points are those of the traced boundary where it turns by more than 40°, as published. &lt;i&gt;(one of straight edges, key points; default straight edges)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Branches&lt;/b&gt;: Branches of the stem. &lt;i&gt;(at least 0 and at most 100; default 14)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Bridges&lt;/b&gt; (Classify bridges): Find bridges and fly-overs in a cloud with classified ground, also where the ground filter took them for ground.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Buildings (per ha)&lt;/b&gt;: Houses on a hectare of streets and plots. &lt;i&gt;(at least 0 per ha and at most 34 per ha; default 16 per ha)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Buildings (per ha)&lt;/b&gt;: Plots with a house on a hectare of streets and plots, two of three with a shed as well. &lt;i&gt;(at least 0 per ha and at most 15 per ha; default 12 per ha)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Buildings (per ha)&lt;/b&gt;: Plots with a house or a short row on a hectare of streets and plots; 0 makes fields. The river's valley and the forest have none. &lt;i&gt;(at least 0 per ha and at most 34 per ha; default 20 per ha)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Buildings&lt;/b&gt; (Classify buildings (as published 2019)): Find the buildings among clusters by their mean entropy, as published in 2019.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Buildings&lt;/b&gt; (Classify buildings): Find the buildings among clusters by their mean entropy and by how far laser beams penetrate them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;CANDIDATE_CORNERS&lt;/b&gt;: Candidate corners, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;CELL_SIZE_USED, BIN_HEIGHT_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;CELL_SIZE_USED, GAP_DISTANCE_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;CELL_SIZE_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;CENTERS&lt;/b&gt;: Centers of spheres, a layer of points; may be left empty. Points with heights and the attributes 'id' and 'radius'.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;CENTERS&lt;/b&gt;: Centers of spheres, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;CENTERS&lt;/b&gt;: True centers of spheres, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;CITYJSON&lt;/b&gt;: CityJSON, a text file: CityJSON (.city.json, .json); CityJSONSeq (.city.jsonl, .jsonl).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;CORNERS&lt;/b&gt;: True corners, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Cars, hedges and bushes&lt;/b&gt;: Objects at walls that are no buildings. &lt;i&gt;(default yes)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Cars, hedges, walls and wires&lt;/b&gt;: Other objects of a town that are no buildings. &lt;i&gt;(default yes)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Cars&lt;/b&gt;: Cars on the decks. &lt;i&gt;(default yes)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Cell size (m)&lt;/b&gt;: Side of a cell of the rasters. Automatic: 2 times the point spacing, rounded to 1, 2 or 5 times a power of ten; at least 0.05 m. &lt;i&gt;(at least 0.01 m and at most 1,000 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Cell size (m)&lt;/b&gt;: Side of the cells that are compared from above. Automatic: 0.5 m where the cloud has more than 6 points per m² of its bounding rectangle, 1 m elsewhere. &lt;i&gt;(at least 0.05 m and at most 100 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Cell size (m)&lt;/b&gt;: Side of the cells whose heights are counted, each together with the eight cells around it. Automatic: cells of 450 points on average. &lt;i&gt;(at least 0.1 m and at most 10,000 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Cell size (m)&lt;/b&gt;: Side of the cells whose heights are counted. Automatic: cells of 4,000 points on average. &lt;i&gt;(at least 0.1 m and at most 10,000 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Certificates for tls&lt;/b&gt; (CERTIFICATES): Three files of PEM, with semicolons between: certificate authority; certificate; key.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Changes since the old map&lt;/b&gt;: Share of the buildings that the map lacks; as many demolished ones are added to it, where plots are free. &lt;i&gt;(at least 0 and at most 0.5; default 0.1)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Class threshold (m)&lt;/b&gt;: Points at most this far above or below the cloth are ground. &lt;i&gt;(greater than 0 m and at most 100 m; default 0.5 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Classes&lt;/b&gt;: Keep points of these classes: numbers and ranges, separated by commas (2, 6-9); empty keeps every class. &lt;i&gt;(default empty)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Clearance above the roof (m)&lt;/b&gt;: Points up to this far above the roof belong to it. &lt;i&gt;(at least 0 m and at most 20 m; default 1 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Clutter&lt;/b&gt;: Put parked cars, trees, poles and people before the fronts, which hide parts of them. &lt;i&gt;(default yes)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Codes to write&lt;/b&gt;: Whose class codes are written: those of ASPRS, which all other steps read, or those of the Dutch, the French or the American survey. &lt;i&gt;(one of ASPRS, AHN (Netherlands), IGN LiDAR HD (France), USGS 3DEP (United States); default ASPRS)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Codes&lt;/b&gt; (Recode classes): Replace class codes by those of an agency, or by one's own.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Comparison&lt;/b&gt; (Compare corners): Compare the corners of footprints with those of an older map: distances, shift, buildings found, missed and new.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Complete hidden parts&lt;/b&gt;: Fill what cars, trees and people hide of the foot and the sides of a facade; without it a facade ends where its points do. &lt;i&gt;(default yes)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Complete&lt;/b&gt; (Complete buildings): Add walls, chimneys, edges and gaps to each building, and number the buildings.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Coordinate reference system&lt;/b&gt; (CRS): That of clouds whose files name none, and of their results. Clouds that name one keep it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Corner distance (m)&lt;/b&gt;: Edges of neighboring facades move onto the intersection line of their planes from this far at most; 0 leaves them where they are. &lt;i&gt;(at least 0 m and at most 10 m; default 0.4 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Cylinders&lt;/b&gt; (Detect cylinders): Find cylinders (pipes, tanks, columns): axes with radius and length, and the points on each.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;DECKS&lt;/b&gt;: True bridge decks, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;DENSITY_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;DISPLACEMENTS&lt;/b&gt;: Displacements of corners, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;DSM&lt;/b&gt;: Surface model (m), a raster.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;DTM&lt;/b&gt;: Terrain model (m), a raster.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Dimension&lt;/b&gt;: Any dimension of the cloud, by name (Intensity, NormalZ, Z), whose range is to be limited. &lt;i&gt;(default empty)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Directions&lt;/b&gt;: Directions of artificial scan lines, evenly spread. &lt;i&gt;(at least 2 and at most 16; default 4)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Distance (m)&lt;/b&gt;: Points of a line that are closer in space may belong together; larger passes over wider obstacles. Automatic: 9 times the point spacing. &lt;i&gt;(greater than 0 m and at most 1,000 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Distance bin (m)&lt;/b&gt;: Width of a bin in the distance of a plane. Smaller bins separate planes that lie closer; in bins smaller than the noise the points of one plane scatter over several, and its maximum is lost. Automatic: the tolerance: two bins side by side then hold a plane with its noise. &lt;i&gt;(greater than 0 m and at most 10 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Duration (s)&lt;/b&gt;: From take-off to landing: a fifth of it each for the climb and the landing, the rest for one turn. Longer flights have more points. &lt;i&gt;(at least 5 s and at most 600 s; default 190 s)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;EARLIER&lt;/b&gt;: Footprints of the earlier survey, a layer of polygons. Buildings of the earlier survey, cut to the area of both.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Earlier&lt;/b&gt; (Recode classes): Replace class codes by those of an agency, or by one's own.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Edge length (m)&lt;/b&gt;: Facets whose edges are all shorter are not refined. Automatic: the point spacing, at least 2 m. &lt;i&gt;(at least 0 m and at most 1,000 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Edge length (m)&lt;/b&gt;: Facets whose edges are all shorter are not refined. Automatic: twice the grid cell size. &lt;i&gt;(at least 0 m and at most 1,000 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Existing&lt;/b&gt; (Keep classes): Remember classes of a cloud that comes classified, for 'Restore classes' to put them back.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Extent (empty = the whole cloud)&lt;/b&gt; (EXTENT): Only points within are read: to try parameters on a part of the cloud first. Empty: all points.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;FACADES&lt;/b&gt;: Facades with openings, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;FACADES&lt;/b&gt;: Facades, a layer of polygons. Upright polygons of the walls seen from the street, in the frame of the cloud, as 'Register street scan' makes them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;FACADES&lt;/b&gt;: Facades, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;FACADES&lt;/b&gt;: True facades, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;FACES&lt;/b&gt;: Distances of faces, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;FOOTPRINTS&lt;/b&gt;: Footprints, a layer of polygons. Buildings of the new survey, cut to the area of both.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;FOOTPRINTS&lt;/b&gt;: Footprints, a layer of polygons. Footprints of buildings, from 'Extract footprints' or any other source; heights, volumes and confidences are read from their attributes 'height', 'volume' and 'confidence'.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;FOOTPRINTS&lt;/b&gt;: Footprints, a layer of polygons. New outlines of buildings.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;FOOTPRINTS&lt;/b&gt;: Footprints, a layer of polygons. Outlines of buildings that are to be assessed.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;FOOTPRINTS&lt;/b&gt;: Footprints, a layer of polygons. Outlines of the buildings that are modelled.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;FOOTPRINTS&lt;/b&gt;: Footprints, a layer of polygons. Outlines of the buildings, from the airborne cloud.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;FOOTPRINTS&lt;/b&gt;: Footprints, a layer of polygons. Outlines of the buildings: those of 'Extract footprints', or any other map of roofs or walls.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;FOOTPRINTS&lt;/b&gt;: Footprints, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;FOOTPRINTS&lt;/b&gt;: True footprints, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;FOOTPRINTS&lt;/b&gt;: True wall footprints, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;FOOTPRINTS_REPORT&lt;/b&gt;: a page with Points before thinning, Points, Points above ground, Points of roofs, Points of walls, Footprints, Footprints that are outlines of walls, Candidate corners, Candidate corners that are corners of footprints; each is an output of its own too.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Facade distance (m)&lt;/b&gt;: Steep segments at most this much nearer to the scanner than the farthest one on their side of the line are of the facade (h0). &lt;i&gt;(at least 0 m and at most 50 m; default 1.5 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Features&lt;/b&gt; (Compute features): Describe the shape of each point's neighborhood by the eigenvalues of its covariance.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Features&lt;/b&gt;: What to compute; each becomes a dimension of the cloud. &lt;i&gt;(any of linearity, planarity, scattering, entropy, omnivariance, anisotropy, eigenentropy, eigenvalue_sum, surface_variation, verticality, normal, height_range, height_deviation, plan_radius, plan_density, plan_eigenvalue_ratio, optimal_neighbors; default linearity, planarity, scattering, entropy, surface_variation, verticality)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Features&lt;/b&gt;: What to compute; each becomes a dimension of the cloud. &lt;i&gt;(any of linearity, planarity, scattering, entropy, omnivariance, anisotropy, eigenentropy, eigenvalue_sum, surface_variation, verticality, normal, height_range, height_deviation, plan_radius, plan_density, plan_eigenvalue_ratio, optimal_neighbors; default linearity, planarity, scattering, verticality, optimal_neighbors)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Filter of counts&lt;/b&gt;: Applied to the number of points of a voxel and its 26 neighbors before voxels with few points are left out. Mean and binomial are convolutions, which smooth; the others are rank orders: the minimum thins and the maximum widens, and the median removes single voxels. &lt;i&gt;(one of none, mean, binomial, minimum, median, maximum; default none)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Flat halls&lt;/b&gt;: Flat roofs with parapets, 10 to 100 m long, where there is room. &lt;i&gt;(at least 0 and at most 20; default 2)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Flight height (m)&lt;/b&gt;: How high over the street the drone climbs. &lt;i&gt;(at least 2 m and at most 25 m; default 8 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Footprints compared&lt;/b&gt;: Around the reference: footprints that overlap a building of the reference or lie amid its buildings; it may cover a part of the survey. Everywhere: all footprints, of which those without a building are invented. &lt;i&gt;(one of around the reference, everywhere; default around the reference)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Footprints&lt;/b&gt; (Extract footprints): Outline each building as a polygon with its area, heights, volume, entropy and confidence.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Footprints&lt;/b&gt; (Extract wall footprints): Outline the walls of each building, without the eaves: corners where walls meet, and a quality for every edge.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;GABLES&lt;/b&gt;: Gable houses, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;GAP_USED, DENSITY_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;GROUND_OUTPUT&lt;/b&gt;: the cloud as the step Ground leaves it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Gap between roofs (m)&lt;/b&gt;: Points of planes at most this far apart belong to one building. Automatic: 3 times the point spacing, from 0.6 to 5 m. &lt;i&gt;(greater than 0 m and at most 20 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Gap distance (m)&lt;/b&gt;: Cells of the surface model without points are interpolated up to this far from cells with points. Automatic: 5 cells. &lt;i&gt;(at least 0 m and at most 10,000 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Gap to close (m)&lt;/b&gt;: Gaps in a roof up to this wide are filled where no ground is seen in them (gutters, skylights, ridges). Automatic: 4 point spacings, from 3 to 20 m. &lt;i&gt;(at least 0 m and at most 20 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Glass (%)&lt;/b&gt;: Share of the pulses on window panes that pass them and are lost. &lt;i&gt;(at least 0 % and at most 100 %; default 70 %)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Granularity&lt;/b&gt;: How finely the surface is started and refined: it sets the grid cell size where that is automatic, at least 2 m (coarse), 1 m (medium, fine) or 0.5 m (extra fine). Automatic: fine where points are farther apart than 1 m, else medium. &lt;i&gt;(one of coarse, medium, fine, extra fine; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Grid cell size (m)&lt;/b&gt;: Cell in which the lowest point is looked for. Automatic: half the point spacing (coarse and medium: the whole), at least that of the granularity. &lt;i&gt;(at least 0.1 m and at most 100 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Grid cell size (m)&lt;/b&gt;: Distance of the cloth's particles (grid resolution). &lt;i&gt;(at least 0.05 m and at most 100 m; default 0.5 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Ground&lt;/b&gt; (Classify ground points (TIN)): Find the ground by letting a triangulated surface grow through the lowest points.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Ground&lt;/b&gt; (Classify ground points (TIN, as published 2000)): Find the ground by letting a triangulated surface grow from the lowest point of each large cell.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Ground&lt;/b&gt; (Classify ground segments): Separate bare earth from objects by how segments end, then bridges from bare earth.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;HEIGHT_OUTPUT&lt;/b&gt;: the cloud as the step Height leaves it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Height (m)&lt;/b&gt;: Height of the tree. &lt;i&gt;(at least 3 m and at most 60 m; default 14 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Height difference (m)&lt;/b&gt;: Points whose heights differ by less than this, and that are close enough in plan, belong together (T_Dh; the paper has 0.2 m at 12.5 and 0.3 m at 4 points/m²). Automatic: 10 times the measured surface noise, 0.2 to 0.3 m. &lt;i&gt;(greater than 0 m and at most 100 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Height of stoops (m)&lt;/b&gt;: Height of the doors over the street. Stairs lead up to them; from 1.4 m on there are cellar windows. &lt;i&gt;(at least 0 m and at most 4 m; default 0 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Height of terraces (m)&lt;/b&gt;: Rise of steps in the slope. &lt;i&gt;(at least 0 m and at most 3 m; default 1.5 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Height step (m)&lt;/b&gt;: Points of a line also belong together if their heights differ by no more than this. Automatic: 4 standard deviations of the surface noise. &lt;i&gt;(at least 0 m and at most 100 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Height tolerance (m)&lt;/b&gt;: A height has changed if it differs by more. Automatic: 3 times the median difference between the heights of both surveys, 0.5 to 3 m. &lt;i&gt;(at least 0 m and at most 100 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Height&lt;/b&gt; (Height above ground): Measure how high each point lies above the ground points around it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Heights of medium and high vegetation&lt;/b&gt;: Height above the ground from which vegetation is medium (4), and that from which it is high (5); below both it is low (3). The last two are those of the French and the Australian surveys. &lt;i&gt;(one of 2 m and 5 m, 0.5 m and 2 m, 0.5 m and 1.5 m (IGN), 0.3 m and 2 m (ICSM); default 2 m and 5 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;High vegetation from (m)&lt;/b&gt;: Height above the ground from which vegetation is high (5). Automatic: the higher one of the heights chosen above. &lt;i&gt;(at least 0 m and at most 100 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Houses&lt;/b&gt;: Put houses with gable roofs behind the fronts; no front is curved then. &lt;i&gt;(default no)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads Linearity, Planarity, Scattering.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z, Classification, ClusterID; if there, Reason.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z, Classification, ClusterID; if there, ReturnNumber, NumberOfReturns, Reason, SegmentID, Red, Green, Blue.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z, Classification, HeightAboveGround, ClusterID.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z, Classification, HeightAboveGround, ClusterID; if there, Confidence, Reason, SegmentID, ReturnNumber, NumberOfReturns, Intensity.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z, Classification, HeightAboveGround, SegmentID.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z, Classification, HeightAboveGround.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z, Classification, HeightAboveGround; if there, Confidence, Reason, SegmentID, ReturnNumber, NumberOfReturns.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z, Classification, HeightAboveGround; if there, NumberOfReturns.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z, Classification, SegmentID.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z, Classification.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z, Classification; if there, ClusterID, EarlierClass.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z, Classification; if there, ClusterID, HeightAboveGround, ClusterEntropy, Confidence, Reason, WeakestEvidence.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z, Classification; if there, EarlierClass.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z, Classification; if there, GpsTime, PointSourceId.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z, Classification; if there, GpsTime, ScanAngleRank, PointSourceId, ScanDirectionFlag, EdgeOfFlightLine, ReturnNumber, NumberOfReturns.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z, Classification; if there, HeightAboveGround, the dimension named.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z, Classification; if there, HeightAboveGround.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z, Classification; if there, ReturnNumber, NumberOfReturns.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z, Classification; if there, ReturnNumber.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z, Classification; if there, SegmentID, Shape.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z, ClusterID; if there, WallOf, HeightAboveGround, Classification, VoxelCount.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z, GpsTime; if there, PointSourceId.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z, SegmentID.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUT&lt;/b&gt;: reads X, Y, Z; if there, Classification, GpsTime, ReturnNumber.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;INPUTS&lt;/b&gt;: reads X, Y, Z, PointSourceId.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;ITERATION_DISTANCE_USED, EDGE_LENGTH_USED, SWEEP_DISTANCE_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Identifier&lt;/b&gt;: Attribute of the footprints that names buildings in all results. With it, the layer of buildings and CityJSON keep all attributes of the footprints. If empty, buildings are named by the attribute 'id' or 'fid', or numbered, and in CityJSON also by their position, so that files can be merged. &lt;i&gt;(default empty)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Ignored classes&lt;/b&gt;: Points that have one of these classes in the reference are not counted: numbers and ranges, separated by commas (7, 64-67); empty counts every point. &lt;i&gt;(default 64-67)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Ignored classes&lt;/b&gt;: Points that have one of these classes in the reference are not counted: numbers and ranges, separated by commas (7, 64-67); empty counts every point. &lt;i&gt;(default 7, 17, 18, 26, 64-67)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Ignored classes&lt;/b&gt;: Points that have one of these classes in the reference are not counted: numbers and ranges, separated by commas (7, 64-67); empty counts every point. &lt;i&gt;(default 7, 9, 17, 18, 26, 64-67)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Invert&lt;/b&gt;: Keep the points that any of the limits leaves out, and leave out the others. &lt;i&gt;(default no)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Isolated points under the ground&lt;/b&gt;: Also find single points and a few together under the ground (multipath), within the heights of the scene. &lt;i&gt;(default yes)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Isolated points&lt;/b&gt;: Also find isolated points in the air (birds, flocks, plumes of dust) and under the ground (multipath), within the heights of the scene. &lt;i&gt;(default yes)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Iteration angle (°)&lt;/b&gt;: Largest angle between a facet and the lines to its nodes under which a point joins the surface; larger follows steeper breaks and lets more low objects in. Automatic: 20°, in nature 30°. &lt;i&gt;(greater than 0° and at most 90°; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Iteration angle (°)&lt;/b&gt;: Upper bound of the angle between a facet and the lines to its nodes under which a point joins the surface, which is estimated in each round. Larger follows steeper breaks and lets more low objects in. &lt;i&gt;(greater than 0° and at most 90°; default 20°)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Iteration distance (m)&lt;/b&gt;: Largest distance from its facet at which a point joins the surface. Automatic: 8 times the roughness of the surface, estimated in each round; or half of that and half the point spacing, if that is more. &lt;i&gt;(greater than 0 m and at most 100 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Iteration distance (m)&lt;/b&gt;: Largest distance from its facet at which a point joins the surface. Automatic: 8 times the roughness of the surface, measured again in each round; or half of that and 0.5 point spacings, if that is more. &lt;i&gt;(greater than 0 m and at most 100 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Iterations&lt;/b&gt;: Most steps of the simulation. &lt;i&gt;(at least 1 and at most 10,000; default 500)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Keep existing classes&lt;/b&gt;: Which classes of a cloud that comes classified stay as they are: none, ground (2), ground and buildings (6), or all but 0 and 1. Where ground or buildings are kept, no others are looked for. &lt;i&gt;(one of none, ground, ground and buildings, all; default none)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Keep existing ground&lt;/b&gt;: Where the cloud has ground (2) already, it stays as it is and no other is looked for. &lt;i&gt;(default no)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Keep outside&lt;/b&gt;: Keep the points outside all polygons instead. &lt;i&gt;(default no)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Kept buildings&lt;/b&gt; (Restore classes): Put back the classes that 'Keep classes' remembered.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Kept ground&lt;/b&gt; (Restore classes): Put back the classes that 'Keep classes' remembered.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Kept&lt;/b&gt; (Restore classes): Put back the classes that 'Keep classes' remembered.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Kind&lt;/b&gt;: A flat or arched bridge over a canal between quays, a footbridge over a stream, one or two decks over a cutting, a bridge over a valley, a fly-over with ramps. Or no bridge: the mouths of a tunnel, a jetty, a ramp that ends over a wall. 'all' lays them side by side. &lt;i&gt;(one of all, canal, arch, footbridge, cutting, two decks, valley, fly-over, tunnel, jetty, ramp; default all)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;LINES&lt;/b&gt;: Line segments, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;LINE_DURATION_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;LINE_WIDTH_USED, DISTANCE_USED, MAX_STEP_USED, NOISE_USED, DENSITY_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Largest gap at the ridge (m)&lt;/b&gt;: Points of both roof planes come this near to each other. &lt;i&gt;(greater than 0 m and at most 10 m; default 1.5 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Learn from the scene&lt;/b&gt;: Learn what buildings of this cloud look like, and correct points near their edges that look otherwise. Without it nothing is changed. &lt;i&gt;(default yes)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Leaves&lt;/b&gt;: Points of leaves around the ends of branches, per point of wood. &lt;i&gt;(at least 0 and at most 5; default 0.2)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Length (m)&lt;/b&gt;: Length of the street. &lt;i&gt;(at least 10 m and at most 2,000 m; default 60 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Level of detail&lt;/b&gt;: 1.2: one level top per building; 1.3: one per part where heights differ clearly; 2.2: the planes of the roof. Files have the simpler levels too. &lt;i&gt;(one of 1.2, 1.3, 2.2; default 2.2)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Line distance (m)&lt;/b&gt;: Distance of neighboring points on adjacent scan lines at most. Automatic: 3 times the mean distance of scan lines. &lt;i&gt;(greater than 0 m and at most 1,000 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Line duration (s)&lt;/b&gt;: Time of one turn of the scanner's mirror. Automatic: the median time between two views of the sky, which give no points. &lt;i&gt;(greater than 0 s and at most 60 s; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Line rate (1/s)&lt;/b&gt;: Scan lines of each scanner. &lt;i&gt;(at least 1 1/s and at most 500 1/s; default 100 1/s)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Line rate (1/s)&lt;/b&gt;: Scan lines of each scanner. &lt;i&gt;(at least 1 1/s and at most 500 1/s; default 40 1/s)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Line width (m)&lt;/b&gt;: Width of an artificial scan line. Automatic: 3 times the point spacing. &lt;i&gt;(greater than 0 m and at most 1,000 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Look for vegetation&lt;/b&gt;: If not, no class changes. For models that contain this step. &lt;i&gt;(default yes)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Look for water&lt;/b&gt;: If not, no class changes. For models that contain this step. &lt;i&gt;(default yes)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Look for wires&lt;/b&gt;: If not, no class changes. For models that contain this step. &lt;i&gt;(default yes)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;MAX_BUILDING_SIZE_USED, CELL_SIZE_USED, ITERATION_ANGLE_USED, ITERATION_DISTANCE_USED, EDGE_LENGTH_USED, SWEEP_DISTANCE_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;MEDIUM_HEIGHT_USED, HIGH_HEIGHT_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;MIN_HEIGHT_USED, MAX_HEIGHT_USED, LOW_USED, HIGH_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;MIN_HEIGHT_USED, NOISE_USED, DENSITY_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;MIN_RADIUS_USED, MAX_RADIUS_USED, TOLERANCE_USED, N_NEIGHBORS_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Margin (m)&lt;/b&gt;: Points up to this distance from the box of a footprint are kept, so that its ground is among them. &lt;i&gt;(at least 0 m and at most 1,000 m; default 10 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Margin around roofs (m)&lt;/b&gt;: How far the convex hull of a roof is grown; walls outside it belong to no roof. &lt;i&gt;(at least 0 m and at most 20 m; default 0.3 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum angle (°)&lt;/b&gt;: Largest angle between the normals of a point and of the surface, with smooth normals only. &lt;i&gt;(greater than 0° and at most 90°; default 15°)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum bridge width (m)&lt;/b&gt;: Width of the widest bridge; 0 looks for no bridges. &lt;i&gt;(at least 0 m and at most 1,000 m; default 40 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum building size (m)&lt;/b&gt;: Cell whose lowest point starts the surface: the shorter side of the largest building. Smaller keeps more of narrow hilltops. In lasground, the tool that the authors of 2019 used, it is 5 m in nature, 10 m in towns, 25 m in cities and 50 m in the largest cities. &lt;i&gt;(at least 1 m and at most 1,000 m; default 60 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum building size (m)&lt;/b&gt;: The shorter side of the largest building; smaller keeps more of narrow hilltops. Automatic: 60 m, and any size for segments that are free-standing on nearly all sides; or that of the kind of terrain. &lt;i&gt;(at least 1 m and at most 1,000 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum clearance (m)&lt;/b&gt;: Height over the scene, or depth under it, beyond which everything is noise, however many points it has: clouds, aircraft, flocks. Cables over a deep valley may need more. &lt;i&gt;(at least 1 m and at most 100,000 m; default 200 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum depth (m)&lt;/b&gt;: How far behind the wall points may belong to its openings; deeper recesses are parts of the building. &lt;i&gt;(at least 0.05 m and at most 10 m; default 0.8 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum distance (m)&lt;/b&gt;: Unclassified points no farther above or below the surface of the ground become ground; 0 adds none. &lt;i&gt;(at least 0 m and at most 1 m; default 0.1 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum edge (m)&lt;/b&gt;: Triangles with a longer edge belong to no surface: they lie across walls and gaps. Automatic: 4 point spacings. &lt;i&gt;(greater than 0 m and at most 10,000 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum gap (m)&lt;/b&gt;: Longest part of an axis without points, behind a flange or in the shadow of another object, across which pieces of one radius in one line are put together; 0 leaves them apart. An end cap always parts them. &lt;i&gt;(at least 0 m and at most 100 m; default 1 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum gap (m)&lt;/b&gt;: Points of a plane at most this far apart are of one surface; gaps wider than this, or than a window, part coplanar surfaces. Automatic: 3 times the point spacing on surfaces. &lt;i&gt;(greater than 0 m and at most 1,000 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum gap (m)&lt;/b&gt;: Widest gap in a stem or branch that is crossed. Automatic: 8 voxels. &lt;i&gt;(at least 0 m and at most 10 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum ground height (m)&lt;/b&gt;: Level segments at most this high over the lowest one of their line are ground (d0). &lt;i&gt;(at least 0 m and at most 10 m; default 0.5 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum height (m)&lt;/b&gt;: Greatest height above the ground of the points kept: 2.5 m leaves everything lower than roofs. Empty: no limit; the log gives the range of the cloud. &lt;i&gt;(at least -10,000 m and at most 10,000 m; default none)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum height (m)&lt;/b&gt;: Walls are looked for up to this height above the ground. &lt;i&gt;(at least 0.5 m and at most 100 m; default 2.5 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum nearest points&lt;/b&gt;: Largest neighborhood that is tried by the neighborhood 'optimal'; time grows with it. &lt;i&gt;(at least 3 and at most 1,000; default 100)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum object area (m²)&lt;/b&gt;: Area of the largest object: larger segments are bare earth, also where they are raised along their border, as islands and quarters between canals are. &lt;i&gt;(at least 1 m² and at most 10,000,000 m²; default 50,000 m²)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum overhang (m)&lt;/b&gt;: How far roofs may jut out over their walls; parts deeper under a roof are inside. &lt;i&gt;(at least 0 m and at most 10 m; default 1.2 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum penetration&lt;/b&gt;: Share of the beam that may pass through a building: cells with points below, and returns that are not the last. &lt;i&gt;(greater than 0 and at most 1; default 0.4)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum radius (m)&lt;/b&gt;: Largest radius that is looked for. Automatic: 20 m, but no more than half of the longest side of the cloud, and at least twice the minimum. &lt;i&gt;(at least 0.001 m and at most 1,000 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum range (m)&lt;/b&gt;: How far the scanners see. &lt;i&gt;(at least 1 m and at most 40 m; default 30 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum range (m)&lt;/b&gt;: How far the scanners see. &lt;i&gt;(at least 5 m and at most 200 m; default 40 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum scan angle (°)&lt;/b&gt;: Angle to the vertical at the edge of a strip. Wide strips show more of the walls and less of the yards behind them. &lt;i&gt;(at least 5° and at most 30°; default 20°)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum shift (m)&lt;/b&gt;: How far the street scan may be off the airborne cloud, along either axis. &lt;i&gt;(at least 0 m and at most 20 m; default 3 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum slope (°)&lt;/b&gt;: Points of a line belong together if the line between them is no steeper; 90 leaves the criterion out. &lt;i&gt;(at least 0° and at most 90°; default 30°)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum slope (°)&lt;/b&gt;: Slope of the steepest plane that is kept; 90° keeps walls. &lt;i&gt;(at least 0° and at most 90°; default 60°)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum slope (°)&lt;/b&gt;: Slope of the steepest roof plane. &lt;i&gt;(at least 1° and at most 85°; default 75°)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum slope (°)&lt;/b&gt;: Slope of the steepest roof surface. Up to 90° walls are surfaces, too, so that towers are not lost in the trees that they touch; outlines then get less even. &lt;i&gt;(at least 0° and at most 90°; default 75°)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum tilt (°)&lt;/b&gt;: Largest angle of a facade to the vertical. &lt;i&gt;(at least 0° and at most 45°; default 10°)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum tilt (°)&lt;/b&gt;: Largest angle of a wall to the vertical. &lt;i&gt;(at least 0° and at most 90°; default 30°)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Maximum value&lt;/b&gt;: Keep points that have at most this in the dimension. Empty: no limit; the log gives the range of the cloud. &lt;i&gt;(at least -10,000,000,000 and at most 10,000,000,000; default none)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Medium vegetation from (m)&lt;/b&gt;: Height above the ground from which vegetation is medium (4). Automatic: the lower one of the heights chosen above. &lt;i&gt;(at least 0 m and at most 100 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Merge touching buildings&lt;/b&gt;: Outline buildings that touch as one block. Otherwise each has its own footprint, and so has each house of a row of three or more, where valleys between the roofs, steps or walls above them show the party walls. &lt;i&gt;(default no)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Merge&lt;/b&gt; (Merge point clouds): Make one cloud of several, each but the first turned and moved if need be; PointSourceId identifies them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Merged classes&lt;/b&gt;: Classes that count as one: numbers and ranges separated by commas, and one such group from the next by a semicolon; empty merges none. &lt;i&gt;(default 0, 1; 3-5; 7, 18; 13-16)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Method&lt;/b&gt;: With center first, points vote for a center, and those of the best center for a radius. With four dimensions, they vote for both together, which takes more memory. &lt;i&gt;(one of center first, four dimensions; default center first)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Method&lt;/b&gt;: With points, each point votes for all planes through it. With normals, the normal of each point votes for a direction, then the point for a distance, which needs surfaces smooth enough for normals. &lt;i&gt;(one of points, normals; default normals)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Method&lt;/b&gt;: With points, each point votes for all planes through it. With normals, the normal of each point votes for a direction, then the point for a distance, which needs surfaces smooth enough for normals. &lt;i&gt;(one of points, normals; default points)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum area (m²)&lt;/b&gt;: Area of the smallest surface, along the surface. &lt;i&gt;(at least 0 m² and at most 1,000,000 m²; default 2 m²)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum bridge area (m²)&lt;/b&gt;: Area of the smallest bridge. &lt;i&gt;(at least 1 m² and at most 100,000 m²; default 20 m²)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum building area (m²)&lt;/b&gt;: Area of the smallest building to be found. &lt;i&gt;(at least 0.1 m² and at most 10,000 m²; default 10 m²)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum building area (m²)&lt;/b&gt;: Area of the smallest building to be found. &lt;i&gt;(at least 0.1 m² and at most 10,000 m²; default 4 m²)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum building area (m²)&lt;/b&gt;: Area of the smallest building to be found. &lt;i&gt;(at least 0.1 m² and at most 10,000 m²; default 6 m²)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum facade area (m²)&lt;/b&gt;: Area of the smallest facade, where it has points. &lt;i&gt;(at least 0.1 m² and at most 10,000 m²; default 2 m²)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum facade height (m)&lt;/b&gt;: Height of the lowest facade; cars and hedges are lower than walls. &lt;i&gt;(at least 0 m and at most 100 m; default 2.5 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum frequency&lt;/b&gt;: Points that a bin of the histogram needs to belong to the scene (T_f). More of them remove denser noise, and thin objects such as wires with it. &lt;i&gt;(at least 1 and at most 10,000; default 5)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum ground area (m²)&lt;/b&gt;: Area of the smallest segment of the bare earth. &lt;i&gt;(at least 1 m² and at most 100,000 m²; default 10 m²)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum height (m)&lt;/b&gt;: Height above the ground of the lowest wires. &lt;i&gt;(at least 1 m and at most 100 m; default 4 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum height (m)&lt;/b&gt;: Height above the ground over which half of a roof lies. &lt;i&gt;(at least 0.5 m and at most 100 m; default 2 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum height (m)&lt;/b&gt;: Keep points at least this high above the ground: 0.3 m removes ground and grass. Empty: no limit; the log gives the range of the cloud. &lt;i&gt;(at least -10,000 m and at most 10,000 m; default none)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum height (m)&lt;/b&gt;: Least height of a bridge above its surroundings; in 'Classify ground segments' that of an object, too. &lt;i&gt;(at least 0.1 m and at most 100 m; default 1 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum height (m)&lt;/b&gt;: Lower points may be ground, kerbs and plants. &lt;i&gt;(at least 0 m and at most 10 m; default 0.3 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum height (m)&lt;/b&gt;: Mean height above ground of the lowest roof and of other clusters. Automatic: 2 m; 1.2 m in clouds of matched images, where edges are rounded. &lt;i&gt;(at least 0 m and at most 100 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum height (m)&lt;/b&gt;: Only points at least this high above the ground are used, where heights are known. &lt;i&gt;(at least 0 m and at most 100 m; default 0 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum height (m)&lt;/b&gt;: Only points at least this high above the ground are used, where heights are known. &lt;i&gt;(at least 0 m and at most 100 m; default 1.5 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum height (m)&lt;/b&gt;: Points at least this high above the ground are vegetation; all others are unclassified. &lt;i&gt;(at least 0 m and at most 10 m; default 0.1 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum hole area (m²)&lt;/b&gt;: Smaller holes are filled, larger ones are courtyards. &lt;i&gt;(at least 0 m² and at most 10,000 m²; default 5 m²)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum length (m)&lt;/b&gt;: Length of the shortest branch; points of shorter ones are leaves. &lt;i&gt;(at least 0 m and at most 100 m; default 0.3 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum nearest points&lt;/b&gt;: Smallest neighborhood that is tried by the neighborhood 'optimal'; fewer than ten describe noise. &lt;i&gt;(at least 3 and at most 1,000; default 10)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum overlap&lt;/b&gt;: Share of a building that the other layer must cover for the building to be in it. &lt;i&gt;(greater than 0 and at most 1; default 0.5)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum overlap&lt;/b&gt;: Share of a building's area that the other map must cover for the building to be the same. &lt;i&gt;(greater than 0 and at most 1; default 0.5)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum overlap&lt;/b&gt;: Share of the points of a segment that must lie in the other one, more than 0.5, so that each segment has one counterpart at most. 0.8 is usual. &lt;i&gt;(greater than 0.5 and at most 1; default 0.8)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum overlap&lt;/b&gt;: Share of the shorter of two pieces of a seed that lies beside the other. &lt;i&gt;(at least 0 and at most 1; default 0.5)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum overlap&lt;/b&gt;: Share of the smaller building that both surveys must have for two buildings to be the same. &lt;i&gt;(greater than 0 and at most 1; default 0.5)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum plane area (m²)&lt;/b&gt;: Area of the smallest plane, measured on it. &lt;i&gt;(at least 0 m² and at most 10,000 m²; default 2 m²)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum plane area (m²)&lt;/b&gt;: Area of the smallest roof plane of a gable. &lt;i&gt;(at least 0.5 m² and at most 10,000 m²; default 4 m²)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum plane area (m²)&lt;/b&gt;: Area of the smallest roof plane, seen from above. &lt;i&gt;(at least 0.1 m² and at most 1,000 m²; default 1.5 m²)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum plane area (m²)&lt;/b&gt;: Area of the smallest roof plane, seen from above; dormers have 2 m² and more. &lt;i&gt;(at least 0.1 m² and at most 1,000 m²; default 1.5 m²)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum plane area (m²)&lt;/b&gt;: Area of the smallest surface, measured on it. Automatic: half the side of a window, squared. &lt;i&gt;(at least 0 m² and at most 10,000 m²; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum plane area (m²)&lt;/b&gt;: Smaller planes of the points, seen from above, are not reported as missing. &lt;i&gt;(at least 0.1 m² and at most 1,000 m²; default 2 m²)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum points of a piece&lt;/b&gt;: Pieces of a line with fewer points join nothing. &lt;i&gt;(at least 2 and at most 10,000; default 5)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum points of a piece&lt;/b&gt;: Straight pieces with fewer points join nothing. &lt;i&gt;(at least 3 and at most 10,000; default 5)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum points of a voxel&lt;/b&gt;: Voxels with fewer points are left out: wood has several points to a voxel, leaves have single ones. &lt;i&gt;(at least 1 and at most 1,000; default 2)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum points of a voxel&lt;/b&gt;: Voxels with fewer points, after the filter, count as empty: more suppress scattered points. &lt;i&gt;(at least 1 and at most 1,000,000; default 1)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum points&lt;/b&gt;: Points of the shortest segment; shorter ones are stray points. &lt;i&gt;(at least 3 and at most 1,000; default 5)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum points&lt;/b&gt;: Points of the smallest cylinder. &lt;i&gt;(at least 16 and at most 1,000,000; default 40)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum points&lt;/b&gt;: Points of the smallest sphere. &lt;i&gt;(at least 20 and at most 1,000,000; default 40)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum points&lt;/b&gt;: Points within the radius, the point itself among them, that make a point the core of a cluster; larger leaves out thin objects. Automatic: a quarter of the points of a level surface within the radius, as at the corner of a roof. &lt;i&gt;(at least 1 and at most 1,000,000; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum points&lt;/b&gt;: Segments with fewer points get no id. &lt;i&gt;(at least 1 and at most 1,000,000; default 1)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum points&lt;/b&gt;: Segments with fewer points get no id. &lt;i&gt;(at least 1 and at most 10,000,000; default 20)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum points&lt;/b&gt;: Segments with fewer points get no id. &lt;i&gt;(at least 1 and at most 10,000,000; default 30)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum points&lt;/b&gt;: Smaller segments, of the input and of the reference, are ignored. &lt;i&gt;(at least 1 and at most 1,000,000,000; default 1)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum points&lt;/b&gt;: Surfaces with fewer points get no id. &lt;i&gt;(at least 1 and at most 10,000,000; default 20)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum radius (m)&lt;/b&gt;: Least radius that is looked for. Automatic: the larger of 1.2 times the point spacing and 6 times the roughness of surfaces. &lt;i&gt;(at least 0.001 m and at most 1,000 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum roof area (m²)&lt;/b&gt;: Area of the smallest roof surface, seen from above. &lt;i&gt;(at least 0.1 m² and at most 10,000 m²; default 2 m²)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum share of buildings around&lt;/b&gt;: Share of the points within a few meters around a building that must belong to buildings, its own included. Around smooth spots of crowns it is less. &lt;i&gt;(at least 0 and at most 1; default 0.5)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum share of roof surfaces&lt;/b&gt;: Share of the points at about the height of a building's roof, within the clearance above and below, that must lie on roof surfaces. In crowns with a smooth side it is less. 0 accepts any; in clouds of matched images it is not examined. &lt;i&gt;(at least 0 and at most 1; default 0.6)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum share of walls seen&lt;/b&gt;: Where less of the perimeter has wall points, the outline of the roof is given instead. &lt;i&gt;(at least 0 and at most 1; default 0.25)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum share seen&lt;/b&gt;: Least share of the circumference that must have points, 0 to 1. A cylinder of which less is seen has an uncertain radius. &lt;i&gt;(at least 0.05 and at most 1; default 0.2)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum share seen&lt;/b&gt;: Least share of the sphere that must have points, 0 to 1. A sphere of which less is seen has an uncertain radius. &lt;i&gt;(at least 0.05 and at most 1; default 0.15)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum size (m)&lt;/b&gt;: Least width and height of a window or door. &lt;i&gt;(at least 0.05 m and at most 10 m; default 0.4 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum slope (°)&lt;/b&gt;: Slope of the flattest plane that is kept; 70° keeps walls. &lt;i&gt;(at least 0° and at most 90°; default 0°)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum step (m)&lt;/b&gt;: At level 1.3, parts of a roof that step by less are one part. &lt;i&gt;(at least 0 m and at most 100 m; default 3 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum value&lt;/b&gt;: Keep points that have at least this in the dimension. Empty: no limit; the log gives the range of the cloud. &lt;i&gt;(at least -10,000,000,000 and at most 10,000,000,000; default none)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum wall length (m)&lt;/b&gt;: Length of the shortest wall that is looked for. &lt;i&gt;(at least 0.2 m and at most 100 m; default 1.2 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Minimum water area (m²)&lt;/b&gt;: Area of the smallest water body to be found. &lt;i&gt;(at least 10 m² and at most 1,000,000 m²; default 50 m²)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Models&lt;/b&gt; (Reconstruct roofs): Model buildings as closed solids of roof planes, walls and a level ground, at levels of detail 1.2, 1.3 and 2.2.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;NDSM&lt;/b&gt;: Heights above the terrain (m), a raster.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;NOISE_OUTPUT&lt;/b&gt;: the cloud as the step Noise leaves it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;NOISE_USED, DENSITY_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;NOISE_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;N_NEIGHBORS_USED, DENSITY_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;N_NEIGHBORS_USED, NOISE_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Near ground&lt;/b&gt; (Complete ground): Add to the ground the points on its surface that have no other class.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Nearest points&lt;/b&gt;: Points of the neighborhood in which the entropy of a point is measured, itself included (N). Automatic: the points of the minimum building area (Ar_min d), at least 3. &lt;i&gt;(at least 3 and at most 10,000; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Nearest points&lt;/b&gt;: Points of the neighborhood in which the entropy of a point is measured, itself included (N). Automatic: the smallest neighborhood in which neither noise nor scan lines blur a plane. &lt;i&gt;(at least 3 and at most 10,000; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Nearest points&lt;/b&gt;: Points per neighborhood, the point itself among them; used by the neighborhood 'nearest'. More of them smooth noise away and blur small objects. &lt;i&gt;(at least 3 and at most 1,000; default 50)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Nearest points&lt;/b&gt;: Points that a normal is made of, the point itself among them; used by the neighborhood 'nearest'. Automatic: as many as reach 6 times the roughness at the density of low points near roofs, 8 to 30. &lt;i&gt;(at least 3 and at most 1,000; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Neighborhood&lt;/b&gt;: Which points describe a point: a number of nearest ones, all within a radius, or as many nearest ones as show the clearest shape (least eigenentropy), chosen for each point. &lt;i&gt;(one of nearest, radius, optimal; default nearest)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Neighborhood&lt;/b&gt;: Which points give a point its normal: a number of nearest ones, or all within a radius. &lt;i&gt;(one of nearest, radius; default nearest)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Neighbors&lt;/b&gt;: Nearest points whose mean distance is taken, the point itself not counted. &lt;i&gt;(at least 1 and at most 200; default 8)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Neighbors&lt;/b&gt;: Nearest points within the radius that are used, the point included. &lt;i&gt;(at least 6 and at most 200; default 12)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Neighbors&lt;/b&gt;: Voxels that belong together: those that share a face (6), a face or an edge (18), or a face, an edge or a corner (26). &lt;i&gt;(one of 6, 18, 26; default 26)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Noise (m)&lt;/b&gt;: Standard deviation of a point across the bark. &lt;i&gt;(at least 0 m and at most 0.05 m; default 0.003 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Noise (m)&lt;/b&gt;: Standard deviation of a point in every direction. &lt;i&gt;(at least 0 m and at most 0.2 m; default 0.03 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Noise (m)&lt;/b&gt;: Standard deviation of each point in every direction. &lt;i&gt;(at least 0 m and at most 0.2 m; default 0.01 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Noise (m)&lt;/b&gt;: Standard deviation of the distance of a point. &lt;i&gt;(at least 0 m and at most 0.1 m; default 0.002 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Noise of the old map (m)&lt;/b&gt;: Standard deviation of its corners to the east and to the north. &lt;i&gt;(at least 0 m and at most 1 m; default 0.15 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Noise points (per ha)&lt;/b&gt;: Points far above (birds) and below the ground (multipath), half of each. &lt;i&gt;(at least 0 per ha and at most 1,000 per ha; default 10 per ha)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Noise points (per ha)&lt;/b&gt;: Wrong matches above and below the ground. &lt;i&gt;(at least 0 per ha and at most 1,000 per ha; default 20 per ha)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Noise&lt;/b&gt; (Classify noise by distance): Find points far from their nearest neighbors, and groups of points apart from all others.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Noise&lt;/b&gt; (Classify noise by height histogram (as published 2019)): Find points far above or below the scene by the cell histogram filter.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Noise&lt;/b&gt; (Classify noise by height histogram): Find points far above or below the scene, such as birds, clouds and multipath returns.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OBJ&lt;/b&gt;: Wavefront OBJ, a text file: Wavefront OBJ (.obj).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OBJECTS&lt;/b&gt;: Found, missed and invented buildings, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OLD_MAP&lt;/b&gt;: Old map, a layer of polygons; may be left empty. Buildings to compare with, cut to the area that was surveyed; without a map, all footprints are new.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OLD_MAP&lt;/b&gt;: Old map, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OPENINGS&lt;/b&gt;: True openings, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OPENINGS&lt;/b&gt;: Windows and doors, a layer of polygons. Polygons in the planes of the facades.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OPENINGS&lt;/b&gt;: Windows and doors, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OPENINGS_FACADES&lt;/b&gt;: Facades with openings, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTLINES&lt;/b&gt;: True outlines of houses, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTLINE_TOLERANCE_USED, HEIGHT_TOLERANCE_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: a cloud of the points selected with X, Y, Z, Classification, VoxelCount; everything else of them stays, withheld points are left out.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: a cloud of the points selected; everything else of them stays, withheld points are left out.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: a folder with a tile for each file, with Classification, ClusterID, Entropy, ClusterEntropy, Confidence, Reason, WeakestEvidence, and a virtual point cloud over all of them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: a folder with a tile for each file, with Classification, HeightAboveGround, SegmentID, ClusterID, Reason, Entropy, ClusterEntropy, Confidence, WeakestEvidence; EarlierClass where classes are kept; BuildingProbability where the buildings of the scene could be learned, and a virtual point cloud over all of them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: a folder with a tile for each file, with Classification, SegmentID, and a virtual point cloud over all of them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: a folder with a tile for each file, with Classification, X, Y, Z, VoxelCount, HeightAboveGround, SegmentID, ClusterID, WallOf; NormalX, NormalY, NormalZ with 'Write normals', and a virtual point cloud over all of them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: a folder with a tile for each file, with SegmentID, Shape, and a virtual point cloud over all of them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: a folder with a tile for each file, with SegmentID, and a virtual point cloud over all of them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: a folder with a tile for each file, with X, Y, Z, Classification, VoxelCount, Linearity, Planarity, Scattering, Verticality, OptimalKNN, Dimensionality, and a virtual point cloud over all of them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: a new cloud with X, Y, Z, Classification, ReturnNumber, NumberOfReturns, Intensity, ScanAngleRank, PointSourceId, GpsTime, SegmentID, ClusterID.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: a new cloud with X, Y, Z, Classification, ReturnNumber, NumberOfReturns, Intensity, ScanAngleRank, PointSourceId, GpsTime, SegmentID.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: a new cloud with X, Y, Z, Classification, ReturnNumber, NumberOfReturns, Red, Green, Blue, SegmentID.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: a new cloud with X, Y, Z, Classification, SegmentID, Shape.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: a new cloud with X, Y, Z, Classification, SegmentID.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the cloud as it was, and what 'Features' names of these dimensions:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the cloud with Classification, ClusterID, Entropy, ClusterEntropy, Confidence, Reason, WeakestEvidence.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the cloud with Classification, ClusterID; Confidence, Reason where the cloud has them; BuildingProbability where the buildings of the scene could be learned; everything else in it stays as it was.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the cloud with Classification, ClusterID; Confidence, Reason where the cloud has them; everything else in it stays as it was.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the cloud with Classification, ClusterID; everything else in it stays as it was.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the cloud with Classification, Entropy, ClusterEntropy, Confidence, Reason, WeakestEvidence; everything else in it stays as it was.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the cloud with Classification, HeightAboveGround, SegmentID, ClusterID, Reason, Entropy, ClusterEntropy, Confidence, WeakestEvidence; EarlierClass where classes are kept; BuildingProbability where the buildings of the scene could be learned.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the cloud with Classification, SegmentID.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the cloud with Classification, WallOf; everything else in it stays as it was.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the cloud with Classification, X, Y, Z, VoxelCount, HeightAboveGround, SegmentID, ClusterID, WallOf; NormalX, NormalY, NormalZ with 'Write normals'.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the cloud with Classification; ClusterID where buildings are kept; everything else in it stays as it was.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the cloud with Classification; everything else in it stays as it was.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the cloud with ClusterID; everything else in it stays as it was.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the cloud with Dimensionality; everything else in it stays as it was.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the cloud with EarlierClass where classes are kept; everything else in it stays as it was.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the cloud with HeightAboveGround; everything else in it stays as it was.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the cloud with SegmentID, ClusterID, Reason; everything else in it stays as it was.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the cloud with SegmentID, Shape.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the cloud with SegmentID, Shape; everything else in it stays as it was.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the cloud with SegmentID.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the cloud with SegmentID; NormalX, NormalY, NormalZ with 'Write normals'; everything else in it stays as it was.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the cloud with SegmentID; everything else in it stays as it was.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the cloud with X, Y, Z, PointSourceId, Classification, VoxelCount, Linearity, Planarity, Scattering, Verticality, OptimalKNN, Dimensionality; PreviousSourceId where PointSourceId was not 0 everywhere.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;OUTPUT&lt;/b&gt;: the points of all clouds in one with X, Y, Z, PointSourceId; PreviousSourceId where PointSourceId was not 0 everywhere; withheld points are left out.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Oblique angle (°)&lt;/b&gt;: Angle of the four oblique views to the vertical: more shows more of the walls. &lt;i&gt;(at least 0° and at most 30°; default 28°)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Openings&lt;/b&gt; (Extract openings): Find windows and doors, cut them out of the facades, and measure their size, position and row.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Operation&lt;/b&gt;: Applied before voxels are connected: erosion shrinks and dilation enlarges objects, opening removes thin parts, closing fills narrow gaps. &lt;i&gt;(one of none, erosion, dilation, opening, closing; default none)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Outline tolerance (m)&lt;/b&gt;: An outline has changed if it is farther than this from the earlier one somewhere. Automatic: 3 times the median distance between the outlines of both surveys, 1 to 4 m. &lt;i&gt;(at least 0 m and at most 100 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Overhang of roofs (m)&lt;/b&gt;: How far the eaves jut out over the walls; sheds have half. &lt;i&gt;(at least 0 m and at most 1 m; default 0.5 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Own codes&lt;/b&gt;: Classes and the code that each gets instead, over those chosen above: 3-5=5; 17=26. Numbers and ranges before the equals sign, entries separated by semicolons; empty for none. &lt;i&gt;(default 3-5, 9, 14-15, 17=1)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Own codes&lt;/b&gt;: Classes and the code that each gets instead, over those chosen above: 3-5=5; 17=26. Numbers and ranges before the equals sign, entries separated by semicolons; empty for none. &lt;i&gt;(default empty)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;PIPES&lt;/b&gt;: Pipes and spheres, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;PLANES&lt;/b&gt;: Planes, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;PLANES_FACADES&lt;/b&gt;: Facades, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;PLANES_OUTPUT&lt;/b&gt;: the cloud as the step Planes leaves it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;PLAN_DISTANCE_USED, HEIGHT_DISTANCE_USED, DENSITY_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;POLYGONS&lt;/b&gt;: Polygons, a layer of polygons; may be left empty. Areas whose points are kept: a district, parcels, a mask. They may overlap and have holes. Without a layer the extent alone cuts.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Percentile of level tops (%)&lt;/b&gt;: At levels 1.2 and 1.3, the share of the roof points below the top: 50 is the median, 100 the ridge. &lt;i&gt;(at least 0 % and at most 100 %; default 70 %)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Pipes&lt;/b&gt; (Reconstruct pipes): Draw cylinders around their axes and spheres around their centers, as polygons in space.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Pipes&lt;/b&gt;: Straight pipes with diameters of 5 to 60 cm, on racks. &lt;i&gt;(at least 1 and at most 2,000; default 200)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Planarity&lt;/b&gt;: Local: points are accepted near the plane of the surface around the nearest of its points, so that smooth curved surfaces are one. Global: near the plane of all points of the surface (plane growing). None: at any distance from a plane. &lt;i&gt;(one of local, global, none; default local)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Planes per voxel&lt;/b&gt;: Planes that are looked for in one voxel. &lt;i&gt;(at least 1 and at most 20; default 4)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Planes&lt;/b&gt; (Extract facades): Find the facades of buildings and draw each as a vertical polygon with its common borders.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Planes&lt;/b&gt; (Segment planes (Hough)): Find planes as maxima of a parameter space, group their points by proximity, and draw them as polygons.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Planes&lt;/b&gt; (Segment planes (RANSAC)): Find planes among the points that are not ground: by RANSAC in voxels, joined where they continue each other.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Planimetric distance (m)&lt;/b&gt;: Points closer than this in plan, and close enough in height, belong together (T_Dxy; the paper has 0.6 m at 12.5 and 1.4 m at 4 points/m²). Automatic: twice the point spacing. &lt;i&gt;(greater than 0 m and at most 100 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Point density (points/m²)&lt;/b&gt;: Average number of points per square meter of occupied area. Automatic: measured on the cloud; 'Segment roofs', 'Classify buildings' and 'Complete buildings' take the effective density, less where points lie on lines, in pairs or in dense strips, so that distances reach over the gaps. &lt;i&gt;(at least 0.001 points/m²; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Point density (points/m²)&lt;/b&gt;: Density on surfaces up to 6 m from the scanner; farther ones have less. The floor has a twentieth. &lt;i&gt;(at least 100 points/m² and at most 100,000 points/m²; default 4,000 points/m²)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Point density (points/m²)&lt;/b&gt;: Points on open ground, seen from above. &lt;i&gt;(at least 5 points/m² and at most 400 points/m²; default 40 points/m²)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Point density (points/m²)&lt;/b&gt;: Points on open ground; roofs have about as many, walls a tenth of it where a view reaches them. &lt;i&gt;(at least 5 points/m² and at most 1,000 points/m²; default 100 points/m²)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Point density (points/m²)&lt;/b&gt;: Points on wood. &lt;i&gt;(at least 100 points/m² and at most 100,000 points/m²; default 5,000 points/m²)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Points for normals&lt;/b&gt;: Points of the neighborhood that gives a point its normal, itself among them. More are less noisy and round off edges and thin pipes. Automatic: as many as hold the error of normals from the noise to 3°, 12 to 80. &lt;i&gt;(at least 4 and at most 1,000; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Processes (empty = one for each core)&lt;/b&gt; (PROCESSES): How many blocks are worked on at once; each takes about 2 GB of memory.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Proximity&lt;/b&gt;: Points are near if they are among the nearest within the radius, or joined by an edge of the triangulation in plan that is no longer (for clouds with one surface above each position). &lt;i&gt;(one of radius, edges; default radius)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Pulse density (pulses/m²)&lt;/b&gt;: Laser pulses of the scan from the air. &lt;i&gt;(at least 0.5 pulses/m² and at most 100 pulses/m²; default 12 pulses/m²)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Pulse density (pulses/m²)&lt;/b&gt;: Laser pulses on average; on open ground each of them gives a point, in trees several, on water few. &lt;i&gt;(at least 0.5 pulses/m² and at most 100 pulses/m²; default 8 pulses/m²)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;RADIUS_USED, MIN_POINTS_USED, DENSITY_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;RADIUS_USED, TOLERANCE_USED, NOISE_USED, DENSITY_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;RADIUS_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;REFERENCE&lt;/b&gt;: The scan of the street, from a vehicle or a tripod.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;REFERENCE&lt;/b&gt;: reads X, Y, Z, Classification. The same points with the true values, to compare with.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;REFERENCE&lt;/b&gt;: reads X, Y, Z, Classification. The same points with the true values; or give polygons of the true buildings.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;REFERENCE&lt;/b&gt;: reads X, Y, Z, Classification. The scan of the street, from a vehicle or a tripod.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;REFERENCE&lt;/b&gt;: reads X, Y, Z, SegmentID. The same points with the true values, to compare with.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;REFERENCE_MAP&lt;/b&gt;: Reference, a layer of polygons. Buildings that are trusted: a cadastre, a base map, an earlier result.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;REFERENCE_MAP&lt;/b&gt;: True buildings, a layer of polygons; may be left empty. Polygons of the buildings in place of a reference cloud: a base map, a cadastre or an earlier result. Of the points within, all are building, also those of crowns over a roof.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;REPORT&lt;/b&gt;: a page with Buildings in the new survey, Buildings in the earlier survey, New buildings, Buildings gone, Buildings changed in height, Buildings changed in outline, Buildings unchanged, Area of the new buildings (m²), Area of the buildings gone (m²); each is an output of its own too.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;REPORT&lt;/b&gt;: a page with Buildings in the old map, Footprints, Buildings found, Buildings missed, New buildings, Corners of the buildings found, Corners matched, Mean distance (m), Minimum distance (m), Maximum distance (m), Median distance (m), Standard deviation of the distances (m), Mean shift eastward (m), Mean shift northward (m); each is an output of its own too.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;REPORT&lt;/b&gt;: a page with Buildings in the reference, Footprints, Buildings found one to one, Buildings merged with others, Buildings split, Buildings missed, Footprints invented, Footprints outside the area compared, Buildings found, merged or split (%), Footprints that are in the reference (%), Median IoU of the buildings found one to one, Median Hausdorff distance of these (m), Median PoLiS distance of these (m), Corners of the buildings that have footprints, Corners of the footprints that belong to buildings, Corners matched, Median distance of matched corners (m), Median shift of the footprints eastward (m), Median shift of the footprints northward (m), Median squareness of the footprints, Median squareness of the reference; each is an output of its own too.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;REPORT&lt;/b&gt;: a page with Buildings, Area of all buildings (m²), Volume of all buildings (m³), Doubtful buildings; each is an output of its own too.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;REPORT&lt;/b&gt;: a page with Buildings, Roof points, RMS of the distances (m), 95th percentile of the distances (m), Median of the buildings&amp;#x27; RMS (m), Points on the model (%), Faces, Missing planes, Invented faces, Volume (m³); each is an output of its own too.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;REPORT&lt;/b&gt;: a page with Clusters, Clusters called building, Undecided clusters, Mean entropy of buildings, Mean entropy of everything else; each is an output of its own too.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;REPORT&lt;/b&gt;: a page with Correct segments, Over-segmented segments of the reference, Under-segmented segments of the reference, Missed segments of the reference, Noise segments, Segments of the reference, Segments, Correct segments of the reference (%), Points in correct segments (%), Points of over-segmented segments (%), Points of under-segmented segments (%), Points of missed segments (%), Points in noise segments (%); each is an output of its own too.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;REPORT&lt;/b&gt;: a page with Overall accuracy (%), Cohen&amp;#x27;s kappa (%), Mean intersection over union (%), F-score of ground (%), F-score of vegetation (%), F-score of building (%), F-score of water (%), F-score of wires (%), F-score of bridges (%), F-score of noise (%), Intersection over union of ground (%), Intersection over union of vegetation (%), Intersection over union of building (%), Intersection over union of water (%), Intersection over union of wires (%), Intersection over union of bridges (%), Intersection over union of noise (%), Points compared; each is an output of its own too.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;REPORT&lt;/b&gt;: a page with Points before thinning, Points, Points above ground, Points of roofs, Points of walls, Footprints, Footprints that are outlines of walls, Candidate corners, Candidate corners that are corners of footprints; each is an output of its own too.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;REPORT&lt;/b&gt;: a page with Points: completeness (%), Points: correctness (%), Points: F-score (%), Points: quality (%), Points: found, Points: missed, Points: falsely called building, Cells: completeness (%), Cells: correctness (%), Cells: F-score (%), Cells: quality (%), Cells: found, Cells: missed, Cells: falsely called building, Objects: completeness (%), Objects: correctness (%), Objects: F-score (%), Objects: missed, Objects: falsely called building, Objects in the reference, Objects in the input, Cell size (m); each is an output of its own too.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;REPORT&lt;/b&gt;: a page with Shift eastward (m), Shift northward (m), Shift upward (m), Residual of common walls and ends (m), Overhang of the eaves (m), Common walls, Common ends of walls, Common cells of ground; each is an output of its own too.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;REPORT&lt;/b&gt;: a page with Type I error (%), Type II error (%), Total error (%), Cohen&amp;#x27;s kappa (%), Points compared, Ground points in the reference; each is an output of its own too.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;ROOFPRINTS&lt;/b&gt;: Roofprints, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;ROOFS&lt;/b&gt;: Roofs, a layer of polygons. Roof faces with heights, of any program; faces with the same attribute 'building' are one building.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;ROOFS&lt;/b&gt;: Roofs, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;ROOFS_OUTPUT&lt;/b&gt;: the cloud as the step Roofs leaves it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Radius (m)&lt;/b&gt;: Points at most this far apart are neighbors (eps); larger joins clusters over wider gaps. Automatic: 3 times the point spacing. &lt;i&gt;(greater than 0 m and at most 100 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Radius (m)&lt;/b&gt;: Radius of the sphere around a point; used by the neighborhood 'radius'. &lt;i&gt;(greater than 0 m and at most 10 m; default 0.5 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Radius (m)&lt;/b&gt;: Radius of the sphere around a point; used by the neighborhood 'radius'. Automatic: the radius of a circle that holds 'Nearest points' at the measured density. &lt;i&gt;(greater than 0 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Radius (m)&lt;/b&gt;: Reach of the neighborhood in which planes are fitted, and of growth. Automatic: 3 times the point spacing on surfaces. &lt;i&gt;(greater than 0 m and at most 1,000 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Radius without attribute (m)&lt;/b&gt;: Radius of lines and points that have no attribute 'radius', such as wires. &lt;i&gt;(at least 0.001 m and at most 100 m; default 0.05 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Range noise (m)&lt;/b&gt;: Standard deviation of the measured distances. &lt;i&gt;(at least 0 m and at most 0.2 m; default 0.01 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Range noise (m)&lt;/b&gt;: Standard deviation of the measured distances. &lt;i&gt;(at least 0 m and at most 0.2 m; default 0.02 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Range noise (m)&lt;/b&gt;: Standard deviation of the measured distances. &lt;i&gt;(at least 0 m and at most 0.2 m; default 0.03 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Refine&lt;/b&gt; (Refine buildings): Correct the edges of buildings by what the other buildings of the scene look like.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Regions&lt;/b&gt; (Segment regions): Gather the points that are not ground into clusters by region growing.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Regularize outlines&lt;/b&gt;: Make walls straight and, where they nearly are, parallel or square to each other. &lt;i&gt;(default yes)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Relief (m)&lt;/b&gt;: Height from hollows to hills, about. &lt;i&gt;(at least 0 m and at most 10 m; default 2 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Report&lt;/b&gt; (Report on buildings): Write a page on the buildings found: number, areas, heights, volumes, a map, and the doubtful ones.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Rigidness&lt;/b&gt;: Stiffness of the cloth: 1 follows steep slopes, 2 terraces, 3 is for flat land. &lt;i&gt;(at least 1 and at most 3; default 3)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;River&lt;/b&gt;: A river in a channel, with a bridge for every street. &lt;i&gt;(default yes)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Roofs&lt;/b&gt; (Classify roofs): Gather the planes above a height into the roofs of buildings.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Roofs&lt;/b&gt; (Segment roofs): Gather the points above the ground into roof surfaces and clusters of everything else.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Rounding of edges (m)&lt;/b&gt;: Distance over which eaves and ridges are rounded. &lt;i&gt;(at least 0 m and at most 2 m; default 0.5 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;SET_OPENINGS&lt;/b&gt;: Windows and doors of the model, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Scan pattern&lt;/b&gt;: Parallel lines of a rotating mirror, the zigzag of an oscillating one, or pulses at random. &lt;i&gt;(one of lines, zigzag, random; default lines)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Scanners&lt;/b&gt;: Whose points are wanted. Run twice with one scanner each, the same flight gives two clouds to be merged. &lt;i&gt;(one of both, horizontal, vertical; default both)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Search in&lt;/b&gt;: All points, or those on facade lines: the steep pieces of a vehicle's scan lines that lie farthest from the scanner, behind cars, trees and people. Facade lines need the GPS time of the points. &lt;i&gt;(one of all points, facade lines; default all points)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Search in&lt;/b&gt;: Points to search: the whole cloud, whose segments and shapes found before are discarded; the points without a shape; or those of each segment (SegmentID) by itself. There, points on which no shape is found keep their segment. &lt;i&gt;(one of whole cloud, points without a shape, each segment; default each segment)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Search in&lt;/b&gt;: Points to search: the whole cloud, whose segments and shapes found before are discarded; the points without a shape; or those of each segment (SegmentID) by itself. There, points on which no shape is found keep their segment. &lt;i&gt;(one of whole cloud, points without a shape, each segment; default whole cloud)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Search&lt;/b&gt;: Where bridges are looked for: everywhere, or only around level surfaces over a gap in the ground with ground at their height at both ends, in a fraction of the time. &lt;i&gt;(one of everywhere, gaps in the ground; default everywhere)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Search&lt;/b&gt;: Where bridges are looked for: everywhere, or only around level surfaces over a gap in the ground with ground at their height at both ends, in a fraction of the time. &lt;i&gt;(one of everywhere, gaps in the ground; default gaps in the ground)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Seed&lt;/b&gt;: Start of the random numbers: the same seed gives the same result. &lt;i&gt;(at least 0 and at most 2,147,483,647; default 0)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Seed&lt;/b&gt;: Start of the random numbers: the same seed gives the same result. &lt;i&gt;(at least 0 and at most 2,147,483,647; default 1)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Seeds&lt;/b&gt;: How the plane of a neighborhood is found. Least squares is quick and finds seeds where all points around are of one surface; robust least squares leaves outliers out. The local Hough transform finds planes among outliers and at edges, in 4 times the time. &lt;i&gt;(one of least squares, robust, hough; default least squares)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Segments&lt;/b&gt; (Segment scan lines): Cut the cloud into artificial scan lines of several directions, group their points, and merge the groups.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Several returns&lt;/b&gt;: Record what a pulse meets on its way; otherwise the first surface only, with unknown return numbers, as image matching does. &lt;i&gt;(default yes)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Share of forest&lt;/b&gt;: Share of the site that is forest, also under the lines. &lt;i&gt;(at least 0 and at most 1; default 0.15)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Share of forest&lt;/b&gt;: Share of the town that is forest. &lt;i&gt;(at least 0 and at most 1; default 0.1)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Share of holes&lt;/b&gt;: Approximate share of all surfaces where matching finds nothing. &lt;i&gt;(at least 0 and at most 0.5; default 0.1)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Share of walls&lt;/b&gt;: Density of points on walls, as a share of that on open ground. &lt;i&gt;(at least 0 and at most 1; default 0.6)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Shift of the old map (m)&lt;/b&gt;: How far the old map lies to the east and to the north. &lt;i&gt;(at least 0 m and at most 2 m; default 0.3 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Show the tiles on the map&lt;/b&gt; (LOAD): Each tile is written as COPC too, into a folder &amp;#x27;shown&amp;#x27; among the tiles, and a virtual point cloud over these is loaded: QGIS shows the points of no other tiles. It takes as much space again. Without effect on the command line.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Side of a block (m, empty = automatic)&lt;/b&gt; (BLOCK_SIDE): Larger blocks take more memory and less time, as less of what surrounds them is worked on twice. Empty: the largest multiple of 50 m, from 100 to 1600 m, at which a block and the margin read around it hold at most 5.3 million points. In dense clouds a multiple of 10 m, at least 1.25 times the margin.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Side of a tile (m)&lt;/b&gt; (SIDE): Tiles are squares of this side.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Size (m)&lt;/b&gt;: Side of the site, a square from (0, 0). &lt;i&gt;(at least 40 m and at most 400 m; default 150 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Size (m)&lt;/b&gt;: Side of the site, a square from (0, 0). &lt;i&gt;(at least 80 m and at most 1,000 m; default 200 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Size (m)&lt;/b&gt;: Side of the town, a square from (0, 0). &lt;i&gt;(at least 50 m and at most 2,000 m; default 200 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Size (m)&lt;/b&gt;: Side of the village, a square from (0, 0). &lt;i&gt;(at least 50 m and at most 1,000 m; default 150 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Skeleton only&lt;/b&gt;: Thin the voxels of the layer to lines in the middle of the objects; the segments of the points stay. &lt;i&gt;(default no)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Slope (°)&lt;/b&gt;: Mean slope of the ground. &lt;i&gt;(at least 0° and at most 20°; default 2°)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Slope (°)&lt;/b&gt;: Mean slope of the ground. &lt;i&gt;(at least 0° and at most 20°; default 4°)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Slope (°)&lt;/b&gt;: Mean slope of the ground. &lt;i&gt;(at least 0° and at most 40°; default 3°)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Slope (°)&lt;/b&gt;: Slope along the street. &lt;i&gt;(at least 0° and at most 10°; default 1°)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Slope (°)&lt;/b&gt;: Slope of the ground, which is a plane. &lt;i&gt;(at least 0° and at most 10°; default 1.5°)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Slope bin (°)&lt;/b&gt;: Width of a bin in the slopes of a plane. Smaller bins separate directions, need more memory and time, and scatter a plane over several. Automatic: a plane off by half a bin is off by one distance bin at the side of the window; at most 11°. &lt;i&gt;(greater than 0° and at most 30°; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Slope post-processing&lt;/b&gt;: Let the cloth down where it hangs over slopes without a step of 0.3 m from one particle to the next. &lt;i&gt;(default yes)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Smooth normals&lt;/b&gt;: Points are accepted only if their normals are like that of the surface beside them. &lt;i&gt;(default no)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Source of the points&lt;/b&gt;: Matched images show one closed surface, crowns included. There, roofs are distinguished from crowns by planarity within half a meter of each point and by color, and low buildings are looked for. 'automatic' takes a cloud for matched images that has no second returns, at least 8 points per m² and no points beneath crowns. &lt;i&gt;(one of automatic, laser scanner, matched images; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Span (m)&lt;/b&gt;: Distance between the towers of the transmission line. &lt;i&gt;(at least 50 m and at most 500 m; default 120 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Speed (m/s)&lt;/b&gt;: Speed of the vehicle. &lt;i&gt;(at least 0.5 m/s and at most 30 m/s; default 5 m/s)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Spheres&lt;/b&gt; (Detect spheres): Find spheres (vessels, domes, targets): centers with radius, and the points on each.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Spheres&lt;/b&gt;: Spherical vessels with diameters of 1 to 3 m. &lt;i&gt;(at least 0 and at most 50; default 4)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Standard deviations&lt;/b&gt;: How far a point's mean distance may lie over that of the whole cloud. Smaller values remove more, and sparse parts of the scene with it. &lt;i&gt;(at least 0 and at most 100; default 6)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Stem diameter (m)&lt;/b&gt;: Diameter of the stem at breast height, 1.3 m. &lt;i&gt;(at least 0.05 m and at most 2 m; default 0.3 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Step of nearest points&lt;/b&gt;: From one neighborhood that 'optimal' tries to the next; larger steps are faster and coarser. &lt;i&gt;(at least 1 and at most 100; default 1)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Steps&lt;/b&gt;: How many times the operation erodes or dilates. &lt;i&gt;(at least 1 and at most 100; default 1)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Street&lt;/b&gt; (Register street scan): Find facades, windows and doors in a street scan and move them onto the airborne cloud.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Strip overlap&lt;/b&gt;: Share of a strip that the next one scans too. Without any, roofs and crowns at the seam are cut. &lt;i&gt;(at least 0 and at most 0.8; default 0.3)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Structure&lt;/b&gt; (Classify dimensionality): Classify points as linear, planar or volumetric by the largest of linearity, planarity and scattering.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Structures on the roof (m)&lt;/b&gt;: Points up to this far above the roof belong to it where they cover a small part of it only (chimneys, dormers, masts). Trees cover more. &lt;i&gt;(at least 0 m and at most 100 m; default 4 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Structuring element&lt;/b&gt;: Neighbors that the operation reaches with each step: 6, 18 or 26. &lt;i&gt;(one of 6, 18, 26; default 26)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Surface noise (m)&lt;/b&gt;: Standard deviation of the points across a smooth surface. Automatic: measured on the cloud, on its smoothest fifth; at least 0.01 m, or a twelfth of the radius where that is less. &lt;i&gt;(greater than 0 m and at most 10 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Surface noise (m)&lt;/b&gt;: Standard deviation of the points across a smooth surface. Roofs and walls may be rougher, by tiles, gravel and the spacing of the points. Automatic: measured on the cloud, on its smoothest fifth; at least 0.01 m. &lt;i&gt;(greater than 0 m and at most 10 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Surfaces&lt;/b&gt; (Segment surfaces): Grow surfaces from smooth seeds to the points beside them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Surfaces&lt;/b&gt;: Pieces join a region near the plane of all its points (planar), as published, or near the plane of the pieces beside them (smooth), so that terrain, domes and ramps are one. &lt;i&gt;(one of planar, smooth; default planar)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Survey&lt;/b&gt; (INPUT): A folder of .las and .laz files, a .vpc file, or any number of files.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Sweep distance (m)&lt;/b&gt;: Points at most this far above or below the finished surface are ground too; 0 leaves its nodes only. Automatic: 4 times the roughness of the finished surface, or the surface noise where that is more; increased by a half, but by 0.1 cells at most. &lt;i&gt;(at least 0 m and at most 100 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Sweep distance (m)&lt;/b&gt;: Points at most this far above or below the finished surface are ground too; 0 leaves its nodes only. Automatic: 6 times the roughness of the finished surface. &lt;i&gt;(at least 0 m and at most 100 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;TILES, BLOCKS, POINTS, FAILURES&lt;/b&gt;: how many tiles were written, how many blocks and points were worked on, and how many blocks and tiles failed.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;TOLERANCE_USED, DISTANCE_BIN_USED, SLOPE_BIN_USED, WINDOW_SIZE_USED, MAX_GAP_USED, MIN_AREA_USED, N_NEIGHBORS_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;TOLERANCE_USED, LINE_DISTANCE_USED, MAX_GAP_USED, NOISE_USED, DENSITY_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;TOLERANCE_USED, MAX_EDGE_USED, NOISE_USED, DENSITY_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;TOLERANCE_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Tanks&lt;/b&gt;: Upright tanks with diameters from 5 to 30 m, of which the sides and the roof are seen. &lt;i&gt;(at least 0 and at most 20; default 3)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Terrace height (m)&lt;/b&gt;: Height of the banks across the slope, one every 45 m. &lt;i&gt;(at least 0 m and at most 5 m; default 1.5 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Terrain angle (°)&lt;/b&gt;: Steepest line from a point to the nodes of its facet under which it joins the surface. &lt;i&gt;(greater than 0° and at most 90°; default 88°)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Terrain&lt;/b&gt; (Rasterize terrain): Make rasters of the terrain, of the surface with all objects on it, and of the difference.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Terrain&lt;/b&gt;: Kind of terrain and of its buildings: it sets the maximum building size (15, 30, 60, 120, 240 m) and the iteration angle (30° in nature, else 20°) where these are automatic. Automatic: the smallest kind from town on that has room for the largest building found. &lt;i&gt;(one of nature, village, town, city, industry; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Thresholds&lt;/b&gt;: 'automatic' follows the density and the noise of the cloud. The others are those of the paper of 2019 for its two surveys (table 2), whatever the cloud is like. They are planimetric distance 0.6 m and height difference 0.2 m with 50 points per minimum building area of 4 m², or 1.4 m, 0.3 m and 16 points. Values that are set replace these. &lt;i&gt;(one of automatic; table 2, 12.5 points/m²; table 2, 4 points/m²; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Time step&lt;/b&gt;: How far the cloth falls in one step; smaller is slower and steadier. &lt;i&gt;(greater than 0 and at most 2; default 0.65)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Tolerance (m)&lt;/b&gt;: Corners farther apart are not the same corner. Automatic: three times the median distance of a corner from the nearest one of the other layer, pairs by chance left out, 1 to 3 m. &lt;i&gt;(greater than 0 m and at most 100 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Tolerance (m)&lt;/b&gt;: Corners farther apart, after the shift between the maps is removed, are not the same corner. Automatic: three times the median distance of a corner from the nearest one of the other map, pairs by chance left out, 1 to 3 m. &lt;i&gt;(greater than 0 m and at most 100 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Tolerance (m)&lt;/b&gt;: Distance at which a point lies on a face or plane. Automatic: 3 times the roughness of the cloud's surfaces, 0.08 to 0.35 m. &lt;i&gt;(at least 0.01 m and at most 5 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Tolerance (m)&lt;/b&gt;: Distance at which a point lies on a plane. A larger one gives fewer planes. Automatic: 3 times the roughness of the cloud's surfaces, 0.08 to 0.35 m. &lt;i&gt;(at least 0.01 m and at most 5 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Tolerance (m)&lt;/b&gt;: Distance from the straight line through a piece, and of its ends from the plane of a region. Automatic: 4.5 times the root of the sum of the squares of the surface noise and 0.05 point spacings. &lt;i&gt;(greater than 0 m and at most 100 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Tolerance (m)&lt;/b&gt;: Distance to the plane of a surface within which points belong to it; larger joins rougher and more curved surfaces. Automatic: 3 times the root of the sum of the squares of the surface noise and 0.05 point spacings. &lt;i&gt;(greater than 0 m and at most 100 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Tolerance (m)&lt;/b&gt;: Distance within which a point lies on a plane. Automatic: 2.3 times the roughness of surfaces, which is the root of the sum of the squares of the noise of the scan and of 0.065 point spacings. &lt;i&gt;(greater than 0 m and at most 10 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Tolerance (m)&lt;/b&gt;: Distance within which a point lies on a plane. Automatic: 2.3 times the roughness: the root of the sum of the squares of the surface noise, at least 0.025 m, and of 0.065 point spacings. &lt;i&gt;(greater than 0 m and at most 10 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Tolerance (m)&lt;/b&gt;: Distance within which a point lies on the plane of a facade. Smaller divides a curved front into more strips and separates shallower recesses. Automatic: 3 times the root of the sum of the squares of the surface noise and of 0.01 m, the relief of walls. &lt;i&gt;(greater than 0 m and at most 1 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Tolerance (m)&lt;/b&gt;: Distance within which a point lies on the surface. Automatic: 3 times the roughness of surfaces, which is the root of the sum of the squares of the noise of the scan and of 0.065 point spacings. &lt;i&gt;(greater than 0 m and at most 10 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Tolerance (m)&lt;/b&gt;: Distance within which points lie on a line segment: a few standard deviations of the noise and of the relief of walls. &lt;i&gt;(greater than 0 m and at most 1 m; default 0.05 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Tolerance (m)&lt;/b&gt;: Distance within which points lie on a wall. Automatic: 3.1 times the roughness: the root of the sum of the squares of the surface noise, at least 0.025 m, and of 0.065 point spacings. &lt;i&gt;(at least 0.01 m and at most 2 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Tolerance (m)&lt;/b&gt;: Scale of simplification: bays and steps up to about this depth are left out where they are short. Automatic: 1.75 times the mean spacing of the building points, at least 0.44 m. &lt;i&gt;(at least 0.01 m and at most 100 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Tolerance (m)&lt;/b&gt;: Two surfaces merge if neither lies farther than this from their common plane (root mean square). Automatic: 2 times the root of the sum of the squares of the surface noise and 0.05 point spacings. &lt;i&gt;(greater than 0 m and at most 100 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Transforms&lt;/b&gt;: Where the clouds after the first go, in their order and separated by semicolons; empty for a cloud that stays. Six numbers: rotations about the axes to the east, to the north and up (°, in this order, counterclockwise), then offsets to the east, to the north and up (m). Or the 16 numbers of a 4x4 matrix, row by row. Or the path of a text file with either. '0 0 90 5 0 0; ; matrix.txt' turns and moves the second cloud, leaves the third and moves the fourth as the file says. &lt;i&gt;(default empty)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Trees (per ha)&lt;/b&gt;: Trees in gardens. &lt;i&gt;(at least 0 per ha and at most 200 per ha; default 15 per ha)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Trees (per ha)&lt;/b&gt;: Trees in gardens. &lt;i&gt;(at least 0 per ha and at most 200 per ha; default 30 per ha)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Trees (per ha)&lt;/b&gt;: Trees outside the forest, single and in clumps, where there is room for them. &lt;i&gt;(at least 0 per ha and at most 200 per ha; default 20 per ha)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Trees (per ha)&lt;/b&gt;: Trees outside the forest. &lt;i&gt;(at least 0 per ha and at most 200 per ha; default 20 per ha)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Trees&lt;/b&gt;: Trees along the street. &lt;i&gt;(at least 0 and at most 22; default 4)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Trees&lt;/b&gt;: Trees on the land. &lt;i&gt;(default yes)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Trials&lt;/b&gt;: Planes through three points that are tried for each plane. &lt;i&gt;(at least 1 and at most 10,000; default 100)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Two classes&lt;/b&gt;: How the mean entropies are separated: 'exact' tries every gap between them; 'k-means' is scikit-learn's, from ten random starts. &lt;i&gt;(one of exact, k-means; default exact)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Unevenness (m)&lt;/b&gt;: How far the ends of a front are before or behind the line of its neighbors at most: fronts nearly in one plane. &lt;i&gt;(at least 0 m and at most 1 m; default 0 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Unevenness of the ground (m)&lt;/b&gt;: Standard deviation of the ground from the slope: gardens, kerbs, ruts. &lt;i&gt;(at least 0 m and at most 0.5 m; default 0.12 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;VOXELS&lt;/b&gt;: Voxels, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;VOXELS_OUTPUT&lt;/b&gt;: the cloud as the step Voxels leaves it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;VOXEL_SIZE_USED, MAX_GAP_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;VOXEL_SIZE_USED, TOLERANCE_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;VOXEL_SIZE_USED&lt;/b&gt;: the value that was used, given or automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Vegetation&lt;/b&gt; (Classify vegetation): Classify low, medium and high vegetation: points above the ground without another class.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;View&lt;/b&gt;: Scan the street from a vehicle or from an airplane. Both see the same street for the same seed. &lt;i&gt;(one of vehicle, airplane; default vehicle)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Voxel size (m)&lt;/b&gt;: Side of a voxel. Points closer than about this belong together; larger voxels bridge wider gaps. Automatic: 2 times the point spacing on surfaces. &lt;i&gt;(at least 0.001 m and at most 1,000 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Voxel size (m)&lt;/b&gt;: Side of a voxel: about the thickness of the thinnest branches. Smaller voxels show thinner branches and need denser points. Automatic: 2 times the point spacing on surfaces, at least 0.02 m. &lt;i&gt;(at least 0.005 m and at most 10 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Voxel size (m)&lt;/b&gt;: Side of the cubes in which planes are looked for; smaller finds smaller planes and needs denser points. Automatic: wide enough for 20 points of a surface and for 10 tolerances, 0.5 to 3 m. &lt;i&gt;(at least 0.1 m and at most 20 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Voxel size (m)&lt;/b&gt;: Side of the cubes that are left with one point each. Take more than the noise of the scanner and less than the smallest object of interest. &lt;i&gt;(at least 0.001 m and at most 1,000 m; default 0.1 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Voxels&lt;/b&gt; (Downsample to voxels): Leave one point in every occupied voxel: the center of gravity of its points.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;WALLS&lt;/b&gt;: Walls, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;WALL_EDGES&lt;/b&gt;: Wall edges, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;WALL_FOOTPRINTS&lt;/b&gt;: Wall footprints, with the attributes:</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Walls&lt;/b&gt; (Classify walls): Find the points of walls below roofs: lower than roofs, upright, and inside the grown hull of a roof.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Water&lt;/b&gt; (Classify water): Classify the points on water: where few pulses came back, from one level, lower than the ground around.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Waves (m)&lt;/b&gt;: Standard deviation of errors that neighboring points share. &lt;i&gt;(at least 0 m and at most 0.3 m; default 0.03 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Widest gap (m)&lt;/b&gt;: Points of one plane at most this far apart belong to one facade; trees and poles leave such gaps. &lt;i&gt;(at least 0.1 m and at most 100 m; default 1 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Widest gap (m)&lt;/b&gt;: Scan lines end where two points in a row are farther apart. Automatic: the larger of 10 median steps between points and 3 distances of scan lines. &lt;i&gt;(greater than 0 m and at most 1,000 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Widest obstacle (m)&lt;/b&gt;: A piece of a line goes on behind an obstacle up to this width, such as a hedge, a car or a gap without points. The ends on both sides must meet the criteria of slope and height step. 0: pieces end at every obstacle. &lt;i&gt;(at least 0 m and at most 1,000 m; default 0 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Width (m)&lt;/b&gt;: Distance between the fronts of both sides. &lt;i&gt;(at least 12 m and at most 60 m; default 16 m)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Window size (m)&lt;/b&gt;: Side of the cubes in which planes are looked for; planes that continue in the next cube are joined. Automatic: wide enough for 40 points of a surface and for 20 tolerances. &lt;i&gt;(greater than 0 m and at most 100 m; default automatic)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Wires&lt;/b&gt; (Classify wires): Classify the wires of power lines (14), of high and low voltage, and the masts and poles at their ends (15).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Write LAZ&lt;/b&gt; (COMPRESSED): Tiles are compressed (.laz); otherwise they are .las files.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;b&gt;Write normals&lt;/b&gt;: Give each point the normal of its plane (NormalX, NormalY, NormalZ); otherwise these are not written. &lt;i&gt;(default no)&lt;/i&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;angle (°)&lt;/i&gt;: angle between the two walls, 0 to 90</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;angle (°)&lt;/i&gt;: angle to the shortest way across</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;angle (°)&lt;/i&gt;: inner angle at the corner where it begins</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;anisotropy&lt;/i&gt;: Anisotropy, (l1 - l3) / l1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;area (m²)&lt;/i&gt;: Area</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;area (m²)&lt;/i&gt;: Area of the face</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;area (m²)&lt;/i&gt;: Area of the polygon, openings left out</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;area (m²)&lt;/i&gt;: area</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;area (m²)&lt;/i&gt;: area inside the walls</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;area (m²)&lt;/i&gt;: area of the polygon, measured on the plane</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;area (m²)&lt;/i&gt;: area seen from above</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;area (m²)&lt;/i&gt;: area without courtyards</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;area (m²)&lt;/i&gt;: area without holes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;area (m²)&lt;/i&gt;: area, in the slope</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;aspect (°)&lt;/i&gt;: direction that the plane faces, clockwise from north; empty where it is level</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;azimuth (°)&lt;/i&gt;: Direction that it faces, clockwise from north</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;azimuth (°)&lt;/i&gt;: direction that it faces, clockwise from north</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;azimuth (°)&lt;/i&gt;: direction that it faces, clockwise from north; empty for level faces</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;base (m)&lt;/i&gt;: Elevation of the lowest corner</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;branch_order&lt;/i&gt;: 0 for a stem, 1 for branches of the stem, 2 for theirs</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;branch_order&lt;/i&gt;: 0 for the stem, 1 for branches of the stem, 2 for theirs</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;building&lt;/i&gt;: attribute id of the building in its own layer, or its number in it</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;building&lt;/i&gt;: building that it is part of, as in the layer of buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;building&lt;/i&gt;: footprint below it: its attribute id, or its number</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;building&lt;/i&gt;: its attribute id in its own layer, or its number there</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;building&lt;/i&gt;: its attribute id in its own map, or its number there</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;building&lt;/i&gt;: its building: the attribute building of the roofs, or empty</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;building&lt;/i&gt;: object id of the building there, 0 where it was demolished</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;building&lt;/i&gt;: the attribute building of the roofs, or empty</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;check&lt;/i&gt;: 2: a simpler level, or over 25% of the roof points off; 1: over 10% off, or points on less than 75% of the area, or less than 50% of the points of a large face on it; 0: sound</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;cluster_id&lt;/i&gt;: building that it belongs to</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;cluster_id&lt;/i&gt;: building that it outlines</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;cluster_id&lt;/i&gt;: cluster that it outlines</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;confidence&lt;/i&gt;: 0 unsure to 1 sure of being a building</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;confidence&lt;/i&gt;: confidence in the model: explained times covered, less if weakest_face is under 0.5, 0 to 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;corner_distance (m)&lt;/i&gt;: mean distance of these</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;corners&lt;/i&gt;: its corners</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;corners&lt;/i&gt;: number of corners</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;count&lt;/i&gt;: points in the voxel; 0 where the operation added it</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;counterpart&lt;/i&gt;: buildings of the other survey that it was compared with, separated by commas</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;counterpart&lt;/i&gt;: names of the footprints that belong to it, the best first, separated by commas</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;counterpart&lt;/i&gt;: what it was compared with in the other map, separated by commas</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;counterpart_corners&lt;/i&gt;: corners of the best counterpart</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;counterpart_squareness&lt;/i&gt;: the same of the best counterpart</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;covered&lt;/i&gt;: share of it that the other layer has too, 0 to 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;covered&lt;/i&gt;: share of it that the other map has too, the shift taken off, 0 to 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;covered&lt;/i&gt;: share of its area that has points, 0 to 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;covered&lt;/i&gt;: share that is building on the other side too, 0 to 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;dbh (m)&lt;/i&gt;: diameter of a stem at breast height, 1.3 m; empty for branches</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;density (points/m²)&lt;/i&gt;: Points per square meter of the polygon</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;depth (m)&lt;/i&gt;: Median distance of its points behind the wall</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;deviation (m)&lt;/i&gt;: standard deviation of its points across it</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;deviation (m)&lt;/i&gt;: standard deviation of wall points across their edges</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;distance (m)&lt;/i&gt;: Distance of its middle from the scanner in plan</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;distance (m)&lt;/i&gt;: distance from the voxel&amp;#x27;s center to the nearest empty voxel&amp;#x27;s</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;dx (m)&lt;/i&gt;: eastward part of it</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;dy (m)&lt;/i&gt;: northward part of it</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;eave (m)&lt;/i&gt;: Elevation of the eaves</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;eave (m)&lt;/i&gt;: elevation of its lowest corner</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;eave_height (m)&lt;/i&gt;: lower quartile of the heights above ground at which the roof ends along the outline</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;eave_height (m)&lt;/i&gt;: lower quartile of the heights above the terrain at which its roof ends outside</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;edge&lt;/i&gt;: number of the edge in its footprint, from 1, counterclockwise</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;edges&lt;/i&gt;: number of edges</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;edges_seen&lt;/i&gt;: edges of which at least half has wall points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;eigenentropy&lt;/i&gt;: Eigenentropy, -sum e ln e, e = l / sum l</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;eigenvalue_sum&lt;/i&gt;: EigenvalueSum, l1 + l2 + l3 (m²)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;enclosed&lt;/i&gt;: Share of its outline with wall beside it</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;entropy&lt;/i&gt;: Entropy, Shannon entropy of L, P, S</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;entropy&lt;/i&gt;: mean entropy of the clusters that its points are of</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;evidence&lt;/i&gt;: measure nearest to its limit for most of these roofs, and the limit</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;explained&lt;/i&gt;: share of its roof points that lie on the model, 0 to 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;facade&lt;/i&gt;: Number of its facade</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;facade&lt;/i&gt;: number of its facade</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;facade&lt;/i&gt;: number of the facade</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;face&lt;/i&gt;: Number of the face of the house, from 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;faces&lt;/i&gt;: faces of its roof</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;filtered&lt;/i&gt;: number of points after the filter; the count without one</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;footprint&lt;/i&gt;: footprint that it belongs to</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;footprint&lt;/i&gt;: footprint: its attribute id, or its number</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;from_left (m)&lt;/i&gt;: Distance of its left side from the left end of the facade</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;gained (m²)&lt;/i&gt;: area that it and those compared with it have gained</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;gap (m)&lt;/i&gt;: distance to the nearest point on each of the walls, the larger of the two</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;gap_area (m²)&lt;/i&gt;: area of its footprint without points; sort by it to find holes too small for check</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;ground (m)&lt;/i&gt;: elevation of its base, near that of the lowest ground beside it</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;ground_elevation (m)&lt;/i&gt;: median elevation of the ground under the roof&amp;#x27;s points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;hausdorff (m)&lt;/i&gt;: greatest distance between its outline and that of the best counterpart</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;height (m)&lt;/i&gt;: Height</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;height (m)&lt;/i&gt;: Height from the lowest to the highest corner</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;height (m)&lt;/i&gt;: That elevation over the lowest of its line</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;height (m)&lt;/i&gt;: height</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;height (m)&lt;/i&gt;: median height of the roof&amp;#x27;s points above ground</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;height (m)&lt;/i&gt;: median of the roof&amp;#x27;s heights above ground</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;height_change (m)&lt;/i&gt;: height in the new survey less that in the earlier one</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;height_deviation&lt;/i&gt;: HeightDeviation, deviation of elevations (m)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;height_range&lt;/i&gt;: HeightRange, highest less lowest elevation (m)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;hull_share&lt;/i&gt;: Area within the boundary, as a share of the convex hull of the points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;id&lt;/i&gt;: Number of the house, from 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;id&lt;/i&gt;: Number of the opening, from 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;id&lt;/i&gt;: SegmentID of its points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;id&lt;/i&gt;: number of the branch, as SegmentID of its points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;id&lt;/i&gt;: number of the building in the map, from 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;id&lt;/i&gt;: number of the building, from 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;id&lt;/i&gt;: number of the candidate, from 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;id&lt;/i&gt;: number of the cylinder, as SegmentID of its points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;id&lt;/i&gt;: number of the deck, as SegmentID of its points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;id&lt;/i&gt;: number of the displacement, from 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;id&lt;/i&gt;: number of the edge, from 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;id&lt;/i&gt;: number of the facade, as SegmentID of its points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;id&lt;/i&gt;: number of the face, from 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;id&lt;/i&gt;: number of the footprint, from 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;id&lt;/i&gt;: number of the house</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;id&lt;/i&gt;: number of the object, from 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;id&lt;/i&gt;: number of the opening, as ClusterID of its points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;id&lt;/i&gt;: number of the opening, from 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;id&lt;/i&gt;: number of the part, as SegmentID of its points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;id&lt;/i&gt;: number of the plane, as SegmentID of its points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;id&lt;/i&gt;: number of the sphere, as SegmentID of its points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;id&lt;/i&gt;: object id of the building, as SegmentID of its points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;identificatie&lt;/i&gt;: name of the building: the attribute id or fid of its footprint, once each</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;invented&lt;/i&gt;: faces that most of their points don&amp;#x27;t lie on</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;iou&lt;/i&gt;: intersection over union with the best counterpart, 0 to 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;kind&lt;/i&gt;: found or missed: a building of the reference; invented: one of the input that is not true; missed part, invented part: what a building that was found lacks or has too much</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;kind&lt;/i&gt;: gable, hip, flat, L, row, shed or hall</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;kind&lt;/i&gt;: ground, facade or other</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;kind&lt;/i&gt;: kind of the crossing</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;kind&lt;/i&gt;: kind of the front that it is part of: plain, recess, bay, curved or balconies</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;kind&lt;/i&gt;: pipe or sphere</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;kind&lt;/i&gt;: pipe or tank</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;kind&lt;/i&gt;: rectangle, hip, L, bend or shed</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;kind&lt;/i&gt;: roof, wall or ground</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;kind&lt;/i&gt;: window or door</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;length (m)&lt;/i&gt;: Distance between its first and last point</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;length (m)&lt;/i&gt;: distance from the old corner to the new one</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;length (m)&lt;/i&gt;: length</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;length (m)&lt;/i&gt;: length along the middle line</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;length (m)&lt;/i&gt;: length of the axis</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;level&lt;/i&gt;: level of detail that it has: 1.2, 1.3 or 2.2</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;line&lt;/i&gt;: Number of the scan line, from 1, by scanner and time</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;linearity&lt;/i&gt;: Linearity, (l1 - l2) / l1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;lost (m²)&lt;/i&gt;: area that these have lost</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;matched&lt;/i&gt;: its corners that the other layer has too</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;matched&lt;/i&gt;: its corners that were found in the other map</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;max_distance (m)&lt;/i&gt;: greatest distance of these</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;max_height (m)&lt;/i&gt;: greatest height above ground</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;mean (m)&lt;/i&gt;: mean height of these above the face</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;mean_distance (m)&lt;/i&gt;: mean distance of these</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;measured&lt;/i&gt;: share of its pieces whose radius is measured, 0 to 1; of the others it is estimated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;missing&lt;/i&gt;: planes of the points that the model lacks</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;neighbors&lt;/i&gt;: Facades with which it has a common border</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;normal&lt;/i&gt;: NormalX, NormalY, NormalZ, unit normal, upward</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;normal_x&lt;/i&gt;: Outward unit normal, eastward component</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;normal_y&lt;/i&gt;: Outward unit normal, northward component</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;normal_z&lt;/i&gt;: Outward unit normal, upward component</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;of&lt;/i&gt;: number of the cylinder or of the sphere</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;off&lt;/i&gt;: share of its roof points more than 0.5 m above or below the model, 0 to 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;old_building&lt;/i&gt;: building of the old map: its attribute id, or its number</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;omnivariance&lt;/i&gt;: Omnivariance, (l1 l2 l3)^(1/3) (m²)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;optimal_neighbors&lt;/i&gt;: OptimalKNN, points of the neighborhood</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;outcome&lt;/i&gt;: &amp;#x27;corner&amp;#x27;: of the footprint. &amp;#x27;on an edge&amp;#x27;: the footprint runs straight on. &amp;#x27;off the outline&amp;#x27;: both walls have edges elsewhere. &amp;#x27;wall not used&amp;#x27;: one of them has no edge. &amp;#x27;outline of the roof&amp;#x27;: too few walls were seen. &amp;#x27;too small&amp;#x27;: the footprint would be too small</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;outline_change (m)&lt;/i&gt;: greatest distance between the outlines of both surveys</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;overhang (m)&lt;/i&gt;: median distance from the walls to the edge of the roof</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;p95 (m)&lt;/i&gt;: 95th percentile of the heights above or below it</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;p95 (m)&lt;/i&gt;: 95th percentile of these heights</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;perimeter (m)&lt;/i&gt;: length of all edges</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;perimeter (m)&lt;/i&gt;: length of the exterior and the holes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;place&lt;/i&gt;: Position in the row, from 1 at the left, seen from outside</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;plan_density&lt;/i&gt;: PlanDensity, neighbors per area in plan (points/m²)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;plan_eigenvalue_ratio&lt;/i&gt;: PlanEigenvalueRatio, m2 / m1 of the plan</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;plan_radius&lt;/i&gt;: PlanRadius, reach of the neighbors in plan (m)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;planarity&lt;/i&gt;: Planarity, (l2 - l3) / l1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;points&lt;/i&gt;: Number of its points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;points&lt;/i&gt;: building points in it, of the side that it belongs to</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;points&lt;/i&gt;: points of class 6 over it</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;points&lt;/i&gt;: points of its roof</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;points&lt;/i&gt;: points of the building, walls among them</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;points&lt;/i&gt;: points on it</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;points&lt;/i&gt;: points on the branch</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;points&lt;/i&gt;: points on the cylinder</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;points&lt;/i&gt;: points on the plane</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;points&lt;/i&gt;: points on the sphere</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;points&lt;/i&gt;: points over its footprint</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;points&lt;/i&gt;: roof points above or below it</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;points&lt;/i&gt;: wall points on it</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;points&lt;/i&gt;: wall points on the edges</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;polis (m)&lt;/i&gt;: mean distance of the corners of both outlines from the other one (PoLiS)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;precision (m)&lt;/i&gt;: standard deviation across its direction, from its points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;quality&lt;/i&gt;: share of the edge that has wall points, corners left out, 0 to 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;quality&lt;/i&gt;: share of the perimeter that has wall points, 0 to 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;radius (m)&lt;/i&gt;: its radius</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;radius (m)&lt;/i&gt;: median radius of its pieces, measured or estimated</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;radius (m)&lt;/i&gt;: radius</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;radius (m)&lt;/i&gt;: radius at the base</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;reason&lt;/i&gt;: why it has a simpler level than was asked for, empty where it has that one</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;reason&lt;/i&gt;: why most of its roofs are called building</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;regularized&lt;/i&gt;: 1 straightened along main directions, 0 outline as traced or in chords of it</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;ridge (m)&lt;/i&gt;: Elevation of the ridge</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;ridge (m)&lt;/i&gt;: elevation of its highest corner</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;ridge_height (m)&lt;/i&gt;: 98th percentile of the heights of its roof points above the terrain</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;ridge_height (m)&lt;/i&gt;: 98th percentile of the roof&amp;#x27;s heights above ground</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;rms (m)&lt;/i&gt;: Root mean square distance of its points from the plane</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;rms (m)&lt;/i&gt;: Root mean square distance of the roof&amp;#x27;s points from its two planes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;rms (m)&lt;/i&gt;: root mean square distance of the points from the cylinder</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;rms (m)&lt;/i&gt;: root mean square distance of the points from the plane</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;rms (m)&lt;/i&gt;: root mean square distance of the points from the sphere</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;rms (m)&lt;/i&gt;: root mean square height above or below it</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;rms (m)&lt;/i&gt;: root mean square height of its points above or below it</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;rms (m)&lt;/i&gt;: root mean square height of its roof points above or below the model</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;rms (m)&lt;/i&gt;: root mean square height of these above or below the model</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;roof_area (m²)&lt;/i&gt;: area of its roof, in its slopes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;roof_type&lt;/i&gt;: flat, stepped flat, shed, gable, hip, mansard, truncated (with a flat top) or other</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;row&lt;/i&gt;: Row on the facade, from 1 at the bottom</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;scattering&lt;/i&gt;: Scattering, l3 / l1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;seen&lt;/i&gt;: Share of its area with points</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;seen&lt;/i&gt;: share of the circumference that has points, 0 to 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;seen&lt;/i&gt;: share of the sphere that has points, 0 to 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;seen_share&lt;/i&gt;: Share of the area within the boundary that has points, openings with points included</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;segment_id&lt;/i&gt;: segment of the voxel; 0 if unassigned</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;sill (m)&lt;/i&gt;: Height of its lower side over the foot of the facade</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;sill (m)&lt;/i&gt;: height of its lower side over the ground of the building</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;slope (°)&lt;/i&gt;: Angle of the line through its points to the horizontal</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;slope (°)&lt;/i&gt;: Slope of the face</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;slope (°)&lt;/i&gt;: slope</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;slope (°)&lt;/i&gt;: slope of the plane: 0 is level, 90 a wall</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;source&lt;/i&gt;: street: on a facade; air: on the outline of a footprint</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;source&lt;/i&gt;: wall: outline of the walls; roof: outline of the roof, as too few walls were seen</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;source&lt;/i&gt;: wall: seen; roof: derived from the edge of the roof</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;squareness&lt;/i&gt;: share of its edges&amp;#x27; length along two directions square to each other, 0 to 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;state&lt;/i&gt;: kept or demolished</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;status&lt;/i&gt;: found or missed: a building of the old map; new: a footprint that isn&amp;#x27;t in it</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;status&lt;/i&gt;: found: a building of the reference with one footprint of its own; merged: it shares its footprint with others; split: it has several; missed: it has none; invented: a footprint that isn&amp;#x27;t in the reference</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;status&lt;/i&gt;: matched: most of its points lie on it; invented: they don&amp;#x27;t; unseen: it has no points; missing: a plane of the points that the model lacks</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;status&lt;/i&gt;: new or gone: in the new or in the earlier survey only; height changed, outline changed, height and outline changed; unchanged</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;surface_variation&lt;/i&gt;: SurfaceVariation, l3 / (l1 + l2 + l3)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;tilt (°)&lt;/i&gt;: Angle to the vertical, positive where it faces the sky</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;tree&lt;/i&gt;: number of the tree, from 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;verticality&lt;/i&gt;: Verticality, 1 - |nz|</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;volume (m³)&lt;/i&gt;: space between roof and ground: mean height of the roof&amp;#x27;s surface times area</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;volume (m³)&lt;/i&gt;: sum of the volumes of pieces of half a meter, each a cylinder</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;volume (m³)&lt;/i&gt;: volume</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;volume (m³)&lt;/i&gt;: volume between its roof and the lowest of its points or of the ground beside it</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;walls_seen&lt;/i&gt;: how many of the two walls that meet in it have wall points, 0 to 2</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;weakest_face&lt;/i&gt;: least share of the points of a roof face of 5 m² or more that lie on it, 0 to 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;width (m)&lt;/i&gt;: Width</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;width (m)&lt;/i&gt;: width</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;worst_quality&lt;/i&gt;: share of the least seen edge that has wall points, 0 to 1</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;x (m)&lt;/i&gt;: Mean of the eastings of its first and last point, from the cloud&amp;#x27;s origin</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;x1&lt;/i&gt;: Parameter: x of vertex 1, in the units of the map</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;x2&lt;/i&gt;: Parameter: x of vertex 2, in the units of the map</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;x3&lt;/i&gt;: Parameter: x of vertex 3, in the units of the map</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;x4&lt;/i&gt;: Parameter: x of vertex 4, in the units of the map</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;x5&lt;/i&gt;: Parameter: x of vertex 5, in the units of the map</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;x6&lt;/i&gt;: Parameter: x of vertex 6, in the units of the map</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;y (m)&lt;/i&gt;: Mean of the northings of its first and last point, from the cloud&amp;#x27;s origin</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;y1&lt;/i&gt;: Parameter: y of vertex 1, in the units of the map</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;y2&lt;/i&gt;: Parameter: y of vertex 2, in the units of the map</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;y3&lt;/i&gt;: Parameter: y of vertex 3, in the units of the map</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;y4&lt;/i&gt;: Parameter: y of vertex 4, in the units of the map</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;y5&lt;/i&gt;: Parameter: y of vertex 5, in the units of the map</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;y6&lt;/i&gt;: Parameter: y of vertex 6, in the units of the map</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;z (m)&lt;/i&gt;: Mean of the elevations of its first and last point</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;z1 (m)&lt;/i&gt;: Parameter: elevation of the ridge</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;z3 (m)&lt;/i&gt;: Parameter: elevation of the eaves</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;i&gt;z7 (m)&lt;/i&gt;: Parameter: elevation of the ground</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;ol&gt;</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>&lt;ul&gt;</source>
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
        <source>A bridge over a valley, in the colors of the true classes.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A building of the old map is found when footprints cover at least the minimum overlap of it; a footprint is new unless at least as much of it lies in buildings that were found. Corners are compared between buildings that share the minimum overlap of the smaller one, so that a row of houses may be one outline in one of the maps.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A corner is a vertex where the outline turns by 20° or more. Two corners can be the same when they face the same way, to 60°. A shift that all corners share (the median of the displacements) is found first and taken off while buildings and corners are matched. Distances, arrows and the mean shift are those between the maps as they are. The standard deviation has the divisor n.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A door is 1.8 m high at least, and ground, a landing or steps up to 1.5 m before the wall rise to within 0.4 m of its sill, with no wall seen further down. Where nothing is seen before the wall, its foot is taken for the ground. Openings that two walls share are drawn in the one that encloses them more. An opening that another wall hides, up to the maximum depth before it, is not drawn.</source>
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
        <source>A footprint belongs to a building where both share the minimum overlap of the smaller one, and where all footprints together cover the minimum overlap of the building. Around the reference, footprints are compared that overlap one of its buildings or lie within the convex hull of those within 50 m. A building is missed if no footprint belongs to it. It is merged if one of its footprints belongs to other buildings too, and split if it has several footprints that don't. A footprint is invented if less of it than the minimum overlap lies in buildings that are not missed.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A ground filter keeps a thin surface: where flight lines differ in height by a few centimeters, or grass is low, it takes one layer of points and leaves the other. Buildings, plants, water and other classes stay as they are.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A height has changed if it differs by more.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A limit that is not set excludes nothing; points must be within all limits that are set. Points at a limit are kept.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A page that shows the numbers.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A piece of a line goes on behind an obstacle up to this width, such as a hedge, a car or a gap without points. The ends on both sides must meet the criteria of slope and height step. 0: pieces end at every obstacle.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A plane is fitted to the neighborhood of each point. Where it fits well, the neighborhood is a seed surface. Surfaces grow from seeds to points near them, as long as these lie on the plane of the surface and, on request, have a similar normal. Roofs, terrain, curved ramps, domes and pipes become one segment each; crowns and other scattered points get none. With &lt;i&gt;global&lt;/i&gt; planarity each segment is a plane.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A point is noise when the mean distance to its k nearest neighbors exceeds mean + m * standard deviation of all these means. Distances have a long tail wherever there are trees and walls: with m = 2 or 3, often seen elsewhere, every hundredth point or more of a good airborne cloud is lost. With the default these are less than two in a thousand on most. Two kinds of noise are missed: points very far away raise the standard deviation and hide less distant ones, and points of a flock or a plume have near neighbors.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A point lies on a wall if another one of its building is more than 0.4 m higher beside it, steeper than 72°. So does a point that a later step added to the building, if another one is more than a meter (or three spacings) higher. Points on walls belong to the building but don't widen its outline. One point counts for each cell with an area of half a spacing squared.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A point on the common edge of two polygons belongs to exactly one of them, so that clouds clipped with adjacent parcels share no point. On the outer edge of an area it may lie on either side. Points flagged as withheld are left out, as by every step that selects.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A point whose height or value is undefined is within no limit. A result without points is refused when it would have to be written: a cloud must have points.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A point with enough others within the radius is the core of a cluster; cores within the radius of each other belong together, and so does every point within the radius of one. All other points are noise and get no id.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A point x goes to R x + t, with the rotation R about the zero of the coordinates: the three angles are three rotations about fixed axes, one after the other, R = Rz Ry Rx. A matrix must be rigid, that is turn and move only. Its upper left part times its own transpose may differ from the identity by 0.0002, as with four decimals; the nearest rotation is taken. A warning is given if that moves points by more than a millimeter. With coordinates of millions of meters, give nine decimals or more.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A river in a channel, with a bridge for every street.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A roof surface is a patch on which neighbors share a plane, that is large and high enough and does not go on into the ground as bridges, ramps and slopes do. The remaining points above the ground (crowns, hedges, wires, roof edges) are clustered by distance, so that both kinds can be distinguished by their entropy afterwards.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A run that was stopped goes on where it was when it is started again with the same input, parameters and version. Until it is complete, the results of blocks are kept in a hidden folder among the tiles. Blocks that fail are named at the end; the tiles that they touch are missing then, all others are written.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A scanner flies strips to and fro, 600 m over the ground. Every beam is followed to what it meets first: walls that face the scanner have points, yards behind houses have none. Points lie exactly on roofs, walls and ground but for the range noise, which is along the beam. Leaves are met at random, the more the longer the way through the crown; each lets 70 % of the pulses on. The beam is 0.2 m wide on the ground, so that the edge of a roof gives two returns. Echoes less than 0.7 m apart are one.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A segment is correct if it and one of the reference share most points of both. One of the reference is over-segmented if several segments, most of each within it, make up most of it. Several of the reference are under-segmented if they make up most of one segment, most of each within it. All other true segments are missed, all other segments are noise.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A simulated town in the colors of its classes after this step; unclassified points gray.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A simulated town in the colors of the classes that it came with.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A simulated town without classes. Choose Plugins ▸ LiDAR Buildings ▸ Find buildings in this view….</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A simulated town: ground brown, plants green, buildings red with footprints, water and the bridges over it blue, wires yellow, the rest gray.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A simulated transmission line and a line along houses: wires yellow, masts brown.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A simulated valley: bare earth brown, the bridge over it blue, objects gray.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A simulated village from a drone's images: roofs red, and the walls below them as footprints.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A single cluster, or clusters of one entropy, leave nothing to separate: none is called a building then, and the log says so. Clusters of one kind only are split in two nevertheless; 'Classify buildings' is not misled by that.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A slightly crooked stem that becomes thinner toward its top, branches around it, and branches of these; leaves around the outer halves of branches, and level ground.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A sphere of a simulated plant in color.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A station sees one point of each cell of directions, the nearest. The cells are as large as the density at 6 m asks for; farther surfaces have fewer points. Surfaces that are met at less than 8° give none. Noise lies along the beam. The default of 200 pipes makes 3.6 million points in about two minutes. Not simulated: points between two surfaces at edges, reflections, errors of the registration.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A text file: {}, as its name ends.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A tile for each file, and a virtual point cloud over all of them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A transmission line on towers of 30 m carries six bundles of two conductors and a guard wire. A line on poles of 9 m carries three wires on a cross-arm, four in a rack below it, a telephone cable, and a wire to a house at every second pole. Trees and a forest grow under both.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A wall belongs to the nearest footprint within 1.6 m. An edge of the footprint up to 0.5 m before a wall is the outline of its eaves and moves onto it; walls with less than 3 m between them are joined. Of two parallel walls the outer one hides the end of the inner one, so the step between them is at the end of the outer one. A facade that ends near a corner of the footprint is the corner. Windows and doors lie in the plane of the wall, 3 cm from its edges at least; those that cross an edge of a wall are left out, and their number is reported.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>A wire is a parabola in an upright plane, as the catenary of a tight wire nearly is. It is 10 m long at least and bent upward, with free space below and no building beside it. Spans are found by RANSAC among points that lie on lines. Beside each, wires of the same masts have its direction and curve. Where spans end, the slender upright object that reaches up to them is a mast. Clouds of matched images are left as they are: wires are thinner than their pixels.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>AHN: plants, noise and masts become 1 (other), bridge decks 26 (civil works). IGN: wires and masts become 64 (lasting objects above the ground), noise 65 (artefacts). USGS: plants, wires and masts become 1. LAS formats 0 to 5 hold codes up to 31 only.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>ASPRS, 2014. Positional accuracy standards for digital geospatial data, edition 1, version 1.0, table 7.5.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>ASPRS, 2019. LAS specification 1.4, R15, table 17.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>ASPRS, 2019. LAS specification 1.4, R15, table 17. IGN, 2023. LiDAR HD: descriptif de contenu des nuages de points classés. USGS, 2024. Lidar base specification, table 5.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Add this text to a report of a problem.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Add to the ground the points on its surface that have no other class.</source>
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
        <source>Airborne point cloud</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>All buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>All points, or those on facade lines: the steep pieces of a vehicle's scan lines that lie farthest from the scanner, behind cars, trees and people. Facade lines need the GPS time of the points.</source>
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
        <source>An opening is where points lie behind the wall (frames, panes, curtains, reveals) and wall encloses them. Holes with nothing behind them are shadows or unknown, and no openings. A plane that fills openings of another facade, such as a shop front, is not drawn as a facade.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>An outline has changed if it is farther than this from the earlier one somewhere.</source>
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
        <source>Any two polygon layers can be compared: footprints with a cadastre or base map, or with an earlier result. Each building is found, merged, split, missed or invented; its IoU, Hausdorff distance, corners and squareness are attributes.</source>
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
        <source>Approximate share of all surfaces where matching finds nothing.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Area (m²)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Area compared</source>
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
        <source>Around the reference: footprints that overlap a building of the reference or lie amid its buildings; it may cover a part of the survey. Everywhere: all footprints, of which those without a building are invented.</source>
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
        <source>At 2 points per m² a wire has a point on 3 m or so, at 50 per m² several on each meter. Wires inside crowns, wires closer than 0.75 m to one another at the same height, and spans seen over less than 10 m are not found.</source>
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
        <source>Automatic: 2 times the point spacing on surfaces, at least 0.02 m.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 2 times the point spacing on surfaces.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 2 times the point spacing, rounded to 1, 2 or 5 times a power of ten; at least 0.05 m.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 2 times the root of the sum of the squares of the surface noise and 0.05 point spacings.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 2.3 times the roughness of surfaces, which is the root of the sum of the squares of the noise of the scan and of 0.065 point spacings.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 2.3 times the roughness: the root of the sum of the squares of the surface noise, at least 0.025 m, and of 0.065 point spacings.</source>
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
        <source>Automatic: 3 times the mean distance of scan lines.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 3 times the median difference between the heights of both surveys, 0.5 to 3 m.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 3 times the median distance between the outlines of both surveys, 1 to 4 m.</source>
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
        <source>Automatic: 3 times the root of the sum of the squares of the surface noise and 0.05 point spacings.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 3 times the root of the sum of the squares of the surface noise and of 0.01 m, the relief of walls.</source>
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
        <source>Automatic: 3.1 times the roughness: the root of the sum of the squares of the surface noise, at least 0.025 m, and of 0.065 point spacings.</source>
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
        <source>Automatic: 4 times the roughness of the finished surface, or the surface noise where that is more; increased by a half, but by 0.1 cells at most.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 4.5 times the root of the sum of the squares of the surface noise and 0.05 point spacings.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 5 cells.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 6 times the roughness of the finished surface.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: 60 m, and any size for segments that are free-standing on nearly all sides; or that of the kind of terrain.</source>
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
        <source>Automatic: three times the median distance of a corner from the nearest one of the other layer, pairs by chance left out, 1 to 3 m.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Automatic: three times the median distance of a corner from the nearest one of the other map, pairs by chance left out, 1 to 3 m.</source>
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
        <source>Avbelj, J., Müller, R., Bamler, R., 2015. A metric for polygon comparison and building extraction evaluation. IEEE Geoscience and Remote Sensing Letters 12(1), 170-174 (PoLiS). Rutzinger, M., Rottensteiner, F., Pfeifer, N., 2009. A comparison of evaluation techniques for building extraction from airborne laser scanning. IEEE Journal of Selected Topics in Applied Earth Observations and Remote Sensing 2(1). Huttenlocher, D. P., Klanderman, G. A., Rucklidge, W. J., 1993. Comparing images using the Hausdorff distance. IEEE Transactions on Pattern Analysis and Machine Intelligence 15(9).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Average number of points per square meter of occupied area.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Axelsson, P., 2000. DEM generation from laser scanner data using adaptive TIN models. International Archives of Photogrammetry and Remote Sensing 33 (B4), 110-117.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Axelsson, P., 2000. DEM generation from laser scanner data using adaptive TIN models. International Archives of Photogrammetry and Remote Sensing 33 (B4), 110-117. The search for multipath is this project's.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Axes of cylinders</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Bare earth brown, the bridge over the valley blue, objects gray.</source>
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
        <source>Bins are examined from both ends of a histogram only, so that sparse points of a facade, between ground and roof, stay. Parts adjoining the scene stay too (chimneys, masts, treetops, slopes), and so do three high points close together (a lamp, a wire). A cell whose surroundings have no full bin gets the range of the nearest one that has.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Block</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Blocks</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Blocks and tiles that failed</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Both lines of the site, in the colors of the true classes.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Both surveys are layers of footprints, as &lt;i&gt;Extract footprints&lt;/i&gt; and &lt;i&gt;Detect buildings&lt;/i&gt; make them from a cloud. Heights are compared where both have the attribute 'ridge_height', or else 'height'.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Boundary</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Boykov, Veksler and Zabih (2001), Fast approximate energy minimization via graph cuts. Lorensen and Cline (1987), Marching cubes: a high resolution 3D surface construction algorithm. Santos et al. (2019), Building detection from LiDAR data using entropy and the k-means concept. Perez and Vidal (1994), Optimum polygonal approximation of digitized curves.</source>
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
        <source>Building</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings are decided in columns: where a roof was found, everything from the foot of the walls to just above the roof is building, and so are chimneys and the walls along its edge. Small gaps between roof surfaces are closed where the ground does not show in them. In clouds of matched images roofs reach to where the rounded edge has half of their height, and the smeared walls below belong to them. Ground of an inner court that lies as high over the streets around as a roof is a deck, and of the building. Where the scanner numbered its returns, crowns at a wall are separated from it by the pulses that pass through them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings are the same where they overlap. Each corner of the old map is then matched with at most one of the footprints, the nearest pairs first, and arrows show from where to where it has moved.</source>
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
        <source>Buildings must be classified before: their steps and low walls are as near to the ground. The default of 0.1 m is the vertical accuracy that airborne surveys promise (root mean square) and the height from which 'Classify vegetation' finds plants.</source>
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
        <source>Buildings that are trusted: a cadastre, a base map, an earlier result.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Buildings that share the minimum overlap of the smaller one are compared. Where several of one survey are one in the other, they are compared as a group: a house that was drawn as two has not changed. The height of a group is the mean by area. Distances of outlines are measured every 0.1 m, walls between buildings of a group left out.</source>
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
        <source>Carrilho et al. (2018), Statistical outlier detection method for airborne LiDAR data. Santos et al. (2019), Building detection from LiDAR data using entropy and the k-means concept, section 2.1.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Carrilho et al. (2018), Statistical outlier detection method for airborne LiDAR data. The stage is this project's.</source>
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
        <source>Cars, garden walls, fences, boats and poles stay unclassified (1): objects whose surfaces are smooth and reflect the whole pulse, and slender upright ones. Ground, buildings, water, noise and all other classes stay as they are.</source>
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
        <source>Cars, trees and people take bites out of the foot and the sides of a facade. Pockets between the boundary and its convex hull are filled where the hull is upright or follows the foot, and hidden corners of the foot are where side and foot meet. A passage that is open to the street is filled, too. Steps and gables at the top stay.</source>
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
        <source>Cells lie at multiples of their size from a corner at whole kilometers of the map. Neighboring clouds have the same cells if these divide 1000 m, as those of 1, 2 and 5 times a power of ten do.</source>
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
        <source>Choose a system…</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>CityJSON</source>
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
        <source>Classes and the code that each gets instead, over those chosen above: 3-5=5; 17=26. Numbers and ranges before the equals sign, entries separated by semicolons; empty for none.</source>
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
        <source>Clouds that lie apart are merged all the same; a warning names a cloud whose bounding box is more than 1 m away from those of all the others. Ids of segments and clusters stay as they are, so that two clouds may have the same ones. The order of points is kept; withheld points are left out.</source>
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
        <source>Clusters of points above the ground, each in a color of its own.</source>
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
        <source>Components of connected voxels, each in a color of its own.</source>
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
        <source>Confidence above 0.5 grows with the size of the cluster, to half at twice the points of the smallest building, as small objects such as cars can look like a roof by chance. This changes no decision. Nor does a cloud that can hardly show buildings, as it is thin, small or without ground: a warning says so, and no confidence is over 0.65.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Confidence that a cluster is a building, from blue, low, to red, high.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Congalton, R. G., 1991. A review of assessing the accuracy of classifications of remotely sensed data. Remote Sensing of Environment 37(1), 35-46.</source>
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
        <source>Corners farther apart, after the shift between the maps is removed, are not the same corner.</source>
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
        <source>Corners of the footprints that belong to buildings</source>
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
        <source>Crowns, hedges and bushes in green, the darker the higher; buildings red, walls gray.</source>
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
        <source>Decks are looked for among all points of the bare earth, as the paper does, in eight directions instead of four. Unlike in the paper, beams must not pass through them and both ends must be joined, since crowns over the terrain are raised, too. Of the bare earth only the points near the lowest of their cell are ground. In towns and forests roofs and crowns are connected with the terrain by pieces of walls and leaves. Run a ground filter first there; its ground points are then the terrain. 'Classify bridges' works on the ground of a filter alone.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Default</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Delete</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Density of points on walls, as a share of that on open ground.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Density on surfaces up to 6 m from the scanner; farther ones have less. The floor has a twentieth.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Describe the shape of each point's neighborhood by the eigenvalues of its covariance.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Detached houses (rectangles, L shapes, some with a bend) whose eaves overhang the walls, sheds, cars, bushes against walls, hedges and trees. They are seen straight down and in four oblique views: many points on roofs, few on walls.</source>
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
        <source>Deviation from the paper: it thins the voxels to a skeleton and finds paths on that. Scanned stems are hollow and have holes, and their skeleton is a net; slices by the length of the path have their middle inside the stem. The ground below a tree is the lowest point within 1 to 2 m. Gaps up to the maximum are crossed at three times their length: shadows part stems and branches in every scan. Points farther from the middle line than 2.5 times the median of their piece of 0.5 m are leaves. The radius of a piece is the median distance of its points from the line. That must be at least half a voxel and at most 3 times the estimated one, and the distances scatter by less than 0.2 of it, as those of a circle do. The estimate is a cone: stem and branches grow thinner toward their tips as the stem does from its diameter at breast height. It counts where points show no circle, unless they lie closer to the line. A stem too slender to carry itself belongs to the thicker one that it grows from. A branch is crooked if its chord is shorter than 0.6 of its length.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Deviation from the paper: radii are searched octave by octave, from small to large, each in windows of four times the least radius and among points thinned accordingly. So time and memory don't grow with the radius. In a window only one sphere is looked for at a time; windows overlap by half.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Deviations from the paper. Radii are searched octave by octave, from small to large, each in windows of four times the least radius and among points thinned accordingly. A window holds few objects, as the segments of the paper do, and time and memory don't grow with the radius. A bin of the Gaussian sphere counts at most a sixteenth of the normals, so that planes don't decide the direction. A cylinder is at least 1.5 diameters long, or one meter if that is less, and 0.3 diameters in any case: shorter pieces can't be distinguished from elbows and spheres. A bend, a cone or a bulge shows in the distances of the points from the cylinder. These must not follow their position on it by more than 0.6 of the noise and 0.3 % of the radius, the tolerance to which tanks are built. The inside is counted in ten slices along the axis, of which the middle one decides, so that a roof within the wall has no effect. The paper does not put pieces together; here they are also where they lie in different segments.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Deviations from the paper. Steep planes have no finite slope: on two further faces of a cube X and Y are written as functions of the other coordinates. The distance is that along the normal in place of the height at the origin, so that bins are as wide for steep planes. The space is that of a window, not of the whole cloud: its maxima are not those of planes that exist by chance through all objects, and its memory does not grow with the cloud. A maximum counts with the bin beside it, where a plane at the border of two bins would be lost. A plane must hold more points than scattered points would have on one in a thousand windows.</source>
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
        <source>Dissimilarity is the distance, as root mean square over the area of the triangles, of the worse of the two surfaces from their common plane. The queue of pairs is worked off in rounds, in each of which all mutually best pairs merge. Of points at one position in plan one counts, and the others get no id.</source>
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
        <source>Distances are differences in height; those above 5 m count as 5 m. A point lies on a face within the tolerance across its plane. Points more than a meter below both the model and others of class 6 beside them are of walls and are not counted. A face without points is unseen, neither matched nor invented. The volume is that of prisms between the faces and the lowest point of class 6 or 2 in the building's box.</source>
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
        <source>Divide</source>
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
        <source>Doubtful</source>
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
        <source>Each kind lies on a lot of 140 m, turned at random. Nothing but decks is bridge deck (17), and only where they do not lie on the land: the land over a tunnel, quays, jetties and ramps are ground.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Each line is split where it bends or leaves a gap. A segment gets its slope, the mean of its ends, its height over the lowest one of its line and its distance from the scanner. Level and low ones are ground; steep ones that are the farthest on their side are of the facade; all others are of cars, trees, people and signs.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Each particle of the cloth falls until it reaches the height of the point nearest to it in plan, and stays there. In each step neighbors draw each other to a common height, the more often the more rigid the cloth is. The simulation ends when no particle moves by 5 mm. All returns are used: in woods where pulses pass through the leaves, 'Classify ground points (TIN)' finds more. The paper leaves open gravity, damping, in which order neighbors draw each other, particles without a point, and from where the cloth falls. These and the defaults are as in the program that its authors published, with three differences. Of two points equally near to a particle the lower is taken, where the program takes the first in the file, so that the order of points has no influence. Particles at the corners of the cloud are let down as all others are, where the program leaves some of them out. Particles more than 20 grid cells from any point, with none in their row and column, take the height of the nearest point, where the program searches on over the links.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Each point is compared with the 8 that follow it on its line. Lines start at the lowest coordinate across them. A piece meets a wider obstacle where its last point and the first one of a piece further on are compared: the gap between them moves along the line with the pieces. For the scanner's own lines there is 'Segment recorded lines' (Jiang &amp;amp; Bunke 1994).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Each point of a roof is compared with the face above or below it. Planes that grow over the points of a building by themselves show what the model lacks.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Each position in plan has a share of every building: that of the points around it. Outlines follow the lines where a building has the largest share, in straight walls along the two main directions of the building where that explains the line; other walls keep their own direction. Buildings that touch share their border exactly, and so do the houses of a row.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Each segment in a color of its own, points without a segment in gray.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Each tile is written as COPC too, into a folder 'shown' among the tiles, and a virtual point cloud over these is loaded: QGIS shows the points of no other tiles. It takes as much space again. Without effect on the command line.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Each triangle of the Delaunay triangulation in plan starts as a surface. The two adjacent surfaces that are most similar merge and get a common plane, until no two are similar enough. For clouds with one surface above each position, such as airborne ones.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Each wall point gets the number of the roof above it (WallOf) and becomes building (class 6); ClusterID stays that of roofs only, so that both can be distinguished.</source>
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
        <source>Edges of the closed models over the points they were made of.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Empty: no limit; the log gives the range of the cloud.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Equations 5 to 11 of the paper, with N = Ar_min d (the paper has N = 50 and 16 at 12.5 and 4 points per m², which 'Thresholds' takes whatever the density of the cloud is). Neighbors are clustered points, and points equally far away at rank N share its weight, so that the order of the points decides nothing. The two means are the optimum that K-means approaches: in one dimension sorting finds it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Ester, M., Kriegel, H.-P., Sander, J., Xu, X., 1996. A density-based algorithm for discovering clusters in large spatial databases with noise. KDD-96, 226-231. Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection, section 2.3.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Evens out the density of scans, where surfaces that are near or scanned twice have many times the points of others, and makes clouds smaller. The class is that of most points of the voxel, VoxelCount their number. Everything else but the position comes from the point nearest to the center.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Every point and its normal define a line on which the center lies. In each window points vote along it, to both sides, for all radii. The best center and radius are fitted by least squares and kept if their points look like a sphere: close to it, spread over enough of it, not following another shape, and with nothing inside.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Everything is installed.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Everything is installed; start QGIS again.</source>
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
        <source>File or layer of the points, or an address on the web (https://…) of COPC, EPT, VPC or STAC items.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>File or layer.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Files, layers or addresses on the web, one or more.</source>
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
        <source>Finds the buildings as 'Detect buildings' does, and models each on its footprint: the planes of its roof, walls and ground as a closed solid, at levels of detail 1.2, 1.3 and 2.2. Where there is a map of the buildings, 'Reconstruct roofs' takes that instead of the footprints found.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Finds the buildings of the airborne cloud as 'Detect buildings' does. Facades, windows and doors of the street scan are moved onto it, by the walls, their ends and the ground that both show; the shift is reported. Outlines follow the facades where they were seen, and are footprints elsewhere. Roofs are reconstructed on them, and windows and doors set into the walls, as CityJSON at level of detail 3.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>First steps</source>
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
        <source>Folder of the tiles</source>
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
        <source>Footprints around the points of buildings.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Footprints compared</source>
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
        <source>Footprints outside the area compared</source>
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
        <source>For surveys of any size: the input is a folder of tiles, a virtual point cloud, any number of files, or one file of any size. Each file becomes a classified tile of the same name in the output folder, with a virtual point cloud over all of them. A file of more than 25 million points becomes tiles of the size of a block. The layers are those of the whole survey, without seams and duplicates.</source>
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
        <source>Gaps of a roof, and bites at its edge up to 4 m wide, are roof where no point is seen in them, as long as surfaces are seen all around. Gaps with points a meter and more below the eaves are courtyards. Sides beside which another roof begins are party walls: they lie under the edge of the roof, and are not counted in the share of walls seen. Parts of a roof inside of others are left out.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Gaps up to 20 m wide belong to the cloud. Shadows of buildings are gaps, too, but the ground in them is as high as beside them; roofs are no ground. A point is on water if its height differs from that of the nearest lowest point of the water body by at most three standard deviations of the noise. It also lies at most three cells from the body.</source>
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
        <source>Give each point the normal of its plane (NormalX, NormalY, NormalZ); otherwise these are not written.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Glass</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Gorte, B. G. H., Pfeifer, N., 2004. Structuring laser-scanned trees using 3D mathematical morphology. IAPRS 35 (B5), 929-933. Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds, section 5.4. McMahon, T. A., 1973. Size and shape in biology. Science 179, 1201-1204.</source>
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
        <source>Greig, D.M., Porteous, B.T., Seheult, A.H., 1989. Exact maximum a posteriori estimation for binary images. Journal of the Royal Statistical Society B 51(2), 271-279 (minimum cut).</source>
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
        <source>Ground of a simulated town in brown, as the cloth finds it; all else gray.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Ground of a simulated town in brown, up to the river's banks; all else gray.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Ground of a simulated town in brown, with what lies on its surface.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Ground points are 0 m high. Points outside the hull of the ground points are measured from the nearest ground point; the log says how many. The paper subtracts a terrain raster; here heights are those over a triangulation, so that nothing is lost to cells on slopes. Its nodes are the means of the ground points in cells of 0.5 m, so that the noise of single points does not affect heights. The filter of heights above 0.3 m is a step of its own, 'Filter points'. Bridge decks are measured from the ground below them, and objects on them, such as cars and parapets, from the decks.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Ground points get class 2. Points of class 7 and 18 (noise) are never used and keep their class, points that were ground before and are not found again become 1 (unclassified), all others keep their class. Classify noise first: a point far below the ground holds the cloth up.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Ground points get class 2. Points of class 7 and 18 (noise) are never used and keep their class, points that were ground before and are not found again become 1 (unclassified), all others keep their class. Classify noise first: points far below the ground pull any ground filter down. 'Classify multipath under the ground' finds pits of noise.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Ground points get class 2. Points of class 7 and 18 (noise) are never used and keep their class, points that were ground before and are not found again become 1 (unclassified), all others keep their class. Classify noise first: points far below the ground pull the surface down.</source>
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
        <source>Height above the ground over which half of a roof lies.</source>
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
        <source>Heights from blue, the ground, to red, the highest roofs and crowns.</source>
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
        <source>Hoover, A., et al., 1996. An experimental comparison of range image segmentation algorithms. IEEE Transactions on Pattern Analysis and Machine Intelligence 18 (7), 673-689.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Hosts that files may name point clouds of (with spaces between)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Houses</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Houses are outlined one by one. What two outlines share stays in the footprint with more roof points there, so that no two overlap.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Houses are side by side along both sides: plain fronts, fronts with a recess, a bay, balconies, and curved ones, all with windows and doors. Parked cars, trees, poles and people hide parts of them. The vehicle drives through the street once, with two scanners whose planes look ahead and back.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Houses cut into slopes and terraces, sheds, rows, blocks of flat roofs, halls with parapets, cars and vans, trees, hedges and bushes. Crowns are closed lumpy surfaces, edges rounded, walls smeared or missing, surfaces wavy; dark, bright and shiny ones have holes and spikes. Every material has its color, in light and in shadow.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Houses of a row are parted along straight lines from one side of a building to the other, in its main directions and in the one in which its roofs slope. Along such a line both roofs slope up from it, parallel roofs step by 0.2 m, any by 1 m, or a wall rises 0.2 m above both. One dynamic program chooses all walls of a row. Each pays by the length on which it is seen, less its cost by its length without low parts. A row costs as much as one wall can pay, as two roofs may be one house. Houses cost more the less alike their widths are, from 3.5 m on. Each house is searched again for walls that end at these. Pieces under 25 m² join a neighbor. At a step the lower house must have six tenths of the height of the higher one. Houses keep the number of their cluster.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Houses on a hectare of streets and plots.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Houses whose roofs nearly touch are one building by the distance between roofs. They are outlined one by one where two walls face each other across the whole building, no farther apart than twice the maximum overhang. At least half of each must be seen, and the smallest building or more lie behind both. The line halfway between the walls parts the roof. Passages under one roof are parted in the same way.</source>
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
        <source>How far the convex hull of a roof is grown; walls outside it belong to no roof.</source>
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
        <source>How large a neighborhood should be depends on the noise, the density and the size of objects. One number of points for the whole cloud gives smooth results; the number that is best for each point ('optimal') keeps small objects apart and follows the noise more.</source>
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
        <source>Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection, section 2.2 (heights of 0.3 and 2.5 m).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection, section 2.2.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection, section 2.3. Fischler, M. A., Bolles, R. C., 1981. Random sample consensus: a paradigm for model fitting. Communications of the ACM 24 (6), 381-395. Moisan, L., Stival, B., 2004. A probabilistic criterion to detect rigid point matches. International Journal of Computer Vision 57 (3), 201-218.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection, section 4, table 2.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection. International Archives of the Photogrammetry, Remote Sensing and Spatial Information Sciences XLVIII-4/W1, section 2.3.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection. International Archives of the Photogrammetry, Remote Sensing and Spatial Information Sciences XLVIII-4/W1, section 2.4. Fischler, M. A., Bolles, R. C., 1981. Random sample consensus: a paradigm for model fitting. Communications of the ACM 24 (6), 381-395.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection. International Archives of the Photogrammetry, Remote Sensing and Spatial Information Sciences XLVIII-4/W1.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Höfle, B., Vetter, M., Pfeifer, N., Mandlburger, G., Stötter, J., 2009. Water surface mapping from airborne laser scanning using signal intensity and elevation data. Earth Surface Processes and Landforms 34(12), 1635-1649.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Identifier</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>If not, no class changes. For models that contain this step.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Ignored classes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>In a cloud that can hardly show buildings, as it is thin, small or without ground, every building that has a confidence is doubtful. The page says why.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>In clouds of matched images walls are smeared to slopes that the surface climbs; ground points on objects narrower than 4.5 m, and on the feet of walls, are taken out again. Halls on slopes, whose uphill eaves are 1 m or more above the terrain, are free-standing there if the steps around them are 2 m high on the mean.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>In clouds of matched images, crowns are as closed as roofs, and penetration says nothing. There, roof surfaces are buildings, planar over half a meter, if the minimum share of the points around them lie on such surfaces. There, and in scans without second returns, colored clusters that are as green as plants are refused, roofs of grass too. The threshold of greenness comes from the scene: it is the middle between the medians of rough clusters and of surfaces of ten times the minimum area, if it separates the two. Otherwise it separates all points best into two kinds, if their means differ by 0.1 or more. Greenness is the normalized excess green, which shadow hardly changes.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>In clouds of matched images, in which roofs are bent, smooth surfaces beside the planes of a building belong to it. There, rows and blocks of three level roofs or more fall into houses where walls rise 0.3 m above both roofs or the roofs step by 0.4 m. Matching rounds both: parapets of half a meter between level roofs are not seen at 59 points per m², and of steps of 0.4 m every other one is.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>In clouds of matched images, walls and other points below the surface seen from above are left out, and planes are laid through all points within half a meter. Crowns are closed surfaces there, and smooth over less than that.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>In each window every point votes for all planes through it, in a space of two slopes and a distance; the bin with most votes is a plane. Its points are fitted, taken out, and the next maximum is looked for. With normals, the space is searched in two steps: first the direction on the Gaussian half sphere, then the distance. Planes that continue each other in neighboring windows are joined. Their points are then grouped by proximity, and groups that are large enough become segments.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>In each window the normals of the points are plotted on the Gaussian sphere. The great circle along which they fill most of it gives the direction of an axis. The points of this circle are projected along the axis, and each votes along its normal, to both sides, for the center of a circle of every radius. The best circle is fitted by least squares, grown along its axis, and kept if its points look like a cylinder. They must be close to it, spread over enough of its circumference, without a bend and with little inside. The surface must end at the visible arc, unlike that of a kerb, which goes on. Of cylinders inside others the one with most points is kept. Pieces of one pipe that are parted by a flange or by the shadow of another object are put together, if one cylinder lies as close to the points of each as its own one.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Inputs</source>
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
        <source>Isolated points under the ground are found without histograms: single points or a few, 0.45 m or more below the surface on all sides. They are not near others of the same height, as ground seen between leaves is. More than three that share a level over meters are a floor, seen through glass or in a shaft. Among crowns and in narrow yards points just below the ground are left alone.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>It counts per point, per cell and per object. Cells are counted by the topmost point, which leaves walls out: some references call them building, some don't. An object is found when at least half of it is. A layer shows which buildings were found, missed and invented.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>It is made where it is missing.</source>
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
        <source>Keep</source>
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
        <source>Keep points at least this high above the ground: 0.3 m removes ground and grass.</source>
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
        <source>Kind of terrain and of its buildings: it sets the maximum building size (15, 30, 60, 120, 240 m) and the iteration angle (30° in nature, else 20°) where these are automatic.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Land cover</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Larger blocks take more memory and less time, as less of what surrounds them is worked on twice. Empty: the largest multiple of 50 m, from 100 to 1600 m, at which a block and the margin read around it hold at most 5.3 million points. In dense clouds a multiple of 10 m, at least 1.25 times the margin.</source>
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
        <source>Largest angle of a wall to the vertical.</source>
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
        <source>Least height of a bridge above its surroundings; in 'Classify ground segments' that of an object, too.</source>
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
        <source>LiDAR Buildings</source>
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
        <source>Lines and points without heights are drawn at height 0.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Lines are fitted to the wall points of each building in plan, one after the other. They, and lines for sides of the roof under which no wall was seen, cut the plane into cells. The footprint is made of the cells whose outline runs along walls that were seen, as far as there are any. Walls that are nearly square or parallel become so where their points allow it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Lines come from GPS times, scan angles and the scanner's marks; without times, from the order of the points. Each is split at its farthest point until its pieces are straight. Three long pieces side by side on adjacent lines that lie on a plane are a seed. It grows by adjacent pieces whose ends lie on its surface until none can be added. For clouds from scanners whose order is lost, run 'Segment scan lines', which lays lines of its own.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Lines with heights and the attributes 'id' and 'radius'.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Local: points are accepted near the plane of the surface around the nearest of its points, so that smooth curved surfaces are one. Global: near the plane of all points of the surface (plane growing). None: at any distance from a plane.</source>
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
        <source>Matched images show one closed surface, crowns included. There, roofs are distinguished from crowns by planarity within half a meter of each point and by color, and low buildings are looked for. 'automatic' takes a cloud for matched images that has no second returns, at least 8 points per m² and no points beneath crowns.</source>
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
        <source>Mean slope of the ground.</source>
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
        <source>Median PoLiS distance of these</source>
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
        <source>Melzer, T., Briese, C., 2004. Extraction and modeling of power lines from ALS point clouds. 28th Workshop of the Austrian Association for Pattern Recognition, 47-54. Fischler, M. A., Bolles, R. C., 1981. Random sample consensus. Communications of the ACM 24(6), 381-395.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Merge</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Merge buildings</source>
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
        <source>Merges the clouds and leaves one point per voxel, so that areas scanned for long don't count more than others. Then it describes the neighborhood of each point, and sorts points by the largest of linearity, planarity and scattering: wires and edges, ground and walls, crowns and bushes. The features stay in the cloud. The neighborhood of 50 points gives smooth results on noisy scans; 'optimal' chooses a number for each point and keeps more detail. In tiles, the files of a survey are one cloud, also where they overlap: they are not moved, and points keep the numbers of their sources.</source>
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
        <source>Models as published</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Models in tiles</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>More results</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Most steps of the simulation.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Most that a run reads of a point cloud on the web (MB)</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Multipath points lie under the ground along their beams, and several from one mirror make a pit. Such a pit is a group of points up to 3 m wide, lower by 0.45 m or more than smooth ground all round. No terrain leads down to it, and its points do not cover it as a floor does. Either other pulses reach the ground between them, or they are closer together than pulses are, or they are fewer than six. Light shafts, cellar stairs and excavations, whose floors stop every pulse, stay ground. The surface grows from the lowest ground point of each cell onto the others, as in 'Classify ground points (TIN)'.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Murakami, H., Nakagawa, K., Hasegawa, H., Shibata, T., Iwanami, E., 1999. Change detection of buildings using an airborne laser scanner. ISPRS Journal of Photogrammetry and Remote Sensing 54(2-3).</source>
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
        <source>Next</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>No building is listed; choose a layer of footprints, or list all.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Noise</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Noise first; then pieces of artificial scan lines in several directions are merged to segments. Segments that are higher than their surroundings are objects, large halls among them; the others are bare earth. Parts of the bare earth that are raised on both sides and joined to the terrain at both ends are bridges and fly-overs, and become bridge deck (17). The terrain model is made of the rest. In towns and forests, where walls and leaves join roofs and crowns to the terrain, use 'Classify ground points (TIN)' and then 'Classify bridges' instead: they make fewer errors.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Noise is removed and one point left per voxel. Progressive TIN densification finds the ground, without flat roofs of any size, and bridge decks are found over its gaps. The ground becomes a terrain model. Planes high above it are roofs, and low upright surfaces below them are their walls. Footprints are the outlines of walls, without the eaves, with a quality for every edge. Where too little of the walls was seen, as in most airborne clouds, they are outlines of roofs, and their attributes say so. Where an old map is given, its corners are compared with the new ones. The terrain and the cloud of every step can be kept. The paper's ground filter, a cloth, settles on large flat roofs; to use it, open the model and put 'Classify ground points (cloth)' in the place of the ground step.</source>
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
        <source>Noise, ground, bridges and heights come first, then roof surfaces and clusters of everything else above the ground. A cluster is a building by its mean entropy, compared with that of planes and volumes, and by how much of the beam passes through it. Then walls are added, edges are corrected by a regression learned from the buildings themselves, water, wires and vegetation get classes, and outlines are drawn. Distances and tolerances follow the density and the noise of the cloud.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Not installed: {}. Python says: {}</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Not simulated: eaves that jut out, windows, curved roofs, objects that move, errors between strips, drift of the position, grass, and walls that mirror.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Not simulated: parts of the drone in view, errors of the position, edges that mix two surfaces in one echo, windows, and surfaces too dark or too slanted to return an echo.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Not simulated: what lies under eaves, crowns and bridges, double surfaces, seams between blocks of images.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Not simulated: windows, surfaces that mirror, blur of edges, errors that neighboring points share, dormers.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Not yet reviewed</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Notes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Nothing is changed in scenes with a single building, and in clouds of matched images, which show crowns and roofs as one closed surface: there the corrections lose as much as they gain.</source>
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
        <source>On lines in eight directions the sections of a bridge are smooth, opaque and raised on both sides. Such parts become bridge deck (17) if they are large enough and go on into the ground at both ends. Bridges whose ends are not in the cloud, and embankments, are not found. A run in tiles reads twice the maximum width around each block, or half the maximum width where bridges are looked for at gaps only. Bridges of which an end lies farther out are not found in that block. For long ones set a larger block or maximum width.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>One side of a simulated street: each facade in a color, windows and doors outlined.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>One side of a simulated street: each facade in a color, with its boundary.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>One side of a simulated street: windows and doors outlined.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>One side of the street, each true facade in a color of its own.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Only points at least this high above the ground are used, where heights are known.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Only points within are read: to try parameters on a part of the cloud first. Empty: all points.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Only voxels that are occupied are held in memory, never the box around the cloud. The space around the cloud counts as empty, so that objects are not cut off at its border. Voxels start at the least coordinates of the points used. Thinning to the skeleton takes off simple points, whose removal changes no component, tunnel or cavity. Where voxels inside an object are empty by chance, apply a closing first.</source>
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
        <source>Outline buildings that touch as one block. Otherwise each has its own footprint, and so has each house of a row of three or more, where valleys between the roofs, steps or walls above them show the party walls.</source>
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
        <source>Outlines of the walls, which lie within the eaves.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Outputs</source>
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
        <source>Overhang of the eaves</source>
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
        <source>Parameters</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Block</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Bridges</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Codes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Comparison</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Complete</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Cylinders</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Earlier</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Existing</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Features</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Footprints</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Ground</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Merge</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Models</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Near ground</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Noise</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Openings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Pipes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Planes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Refine</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Regions</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Roofs</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Segments</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Spheres</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Street</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Surfaces</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Survey</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Terrain</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Vegetation</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Voxels</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Walls</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Water</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parameters: Wires</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Parts deeper under a roof than it juts out over the other walls count as inside: loggias, porches. Sides without wall points lie as far inside the edge of the roof as the other walls in the median; &lt;code&gt;quality&lt;/code&gt; 0 marks them. The result depends on the seed, and not on the order of points. A building whose points are spread so thinly that it would be nearly empty has no footprint; the log names it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Peng, C., Yu, Z., 2018. Research on 3D building information extraction and image post-processing based on vehicle LIDAR. EURASIP Journal on Image and Video Processing 2018:121, section 3.4.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Peng, C., Yu, Z., 2018. Research on 3D building information extraction and image post-processing based on vehicle LIDAR. EURASIP Journal on Image and Video Processing 2018:121, section 4.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Peng, C., Yu, Z., 2018. Research on 3D building information extraction and image post-processing based on vehicle LIDAR. EURASIP Journal on Image and Video Processing 2018:121, sections 3 and 4.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Peng, C., Yu, Z., 2018. Research on 3D building information extraction and image post-processing based on vehicle LIDAR. EURASIP Journal on Image and Video Processing 2018:121, sections 3.1 to 3.3.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Peng, C., Yu, Z., 2018. Research on 3D building information extraction and image post-processing based on vehicle LIDAR. EURASIP Journal on Image and Video Processing 2018:121.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Peng, C., Yu, Z., 2018. Research on 3D building information extraction and image post-processing based on vehicle LIDAR. EURASIP Journal on Image and Video Processing 2018:121. CityJSON Specifications 2.0.1, section 3.3 (semantics of geometric primitives).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Percentile of level tops</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Peters, R., Dukai, B., Vitalis, S., van Liempt, J., Stoter, J., 2022. Automated 3D reconstruction of LoD2 and LoD1 models for all 10 million buildings of the Netherlands, section on quality. Photogrammetric Engineering &amp;amp; Remote Sensing 88(3).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Peters, R., Dukai, B., Vitalis, S., van Liempt, J., Stoter, J., 2022. Automated 3D reconstruction of LoD2 and LoD1 models for all 10 million buildings of the Netherlands. Photogrammetric Engineering &amp;amp; Remote Sensing 88(3).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Peters, R., Dukai, B., Vitalis, S., van Liempt, J., Stoter, J., 2022. Automated 3D reconstruction of LoD2 and LoD1 models for all 10 million buildings of the Netherlands. Photogrammetric Engineering &amp;amp; Remote Sensing 88(3). Nan, L., Wonka, P., 2017. PolyFit: polygonal surface reconstruction from point clouds. ICCV. Huang, J., Stoter, J., Peters, R., Nan, L., 2022. City3D: large-scale building reconstruction from airborne LiDAR point clouds. Remote Sensing 14(9). Biljecki, F., Ledoux, H., Stoter, J., 2016. An improved LOD specification for 3D building models. Computers, Environment and Urban Systems 59.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Photograph a made-up site with a drone, match the images with all their errors, and store the true classes.</source>
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
        <source>Pieces of a vehicle's scan lines, joined to surfaces in a color each.</source>
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
        <source>Pipes of a simulated plant with their axes, each in a color of its own.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Pipes, elbows and posts of a simulated plant, each in a color of its own.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Planarity</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Planarity from blue, low in crowns and at edges, to red, high on roofs and ground.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Planes</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Planes grow over the points of each footprint. The lines in which they intersect, and those where one ends above another, divide the footprint into cells; each cell takes a plane, all together so that points and borders cost least. A building that is too far from its points gets the next simpler level, with the reason.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Planes of the roofs of a simulated village, each in a color of its own.</source>
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
        <source>Planes that lie higher above the ground than cars and hedges are roofs; those whose points lie near each other are one building (class 6).</source>
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
        <source>Points are noise if no chain of points up to 2.4 m apart (3.5 point spacings on sparse clouds) ties them to the scene and nothing is above them. They must also stop less than three tenths of the pulses. Wires, panes, the heads of lamps, and objects that the border of the cloud cuts stay. What touches the scene is not found: dust on the ground, birds in a tree.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points at least this high above the ground are vegetation; all others are unclassified.</source>
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
        <source>Points by what they lie on: lines, surfaces or volumes.</source>
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
        <source>Points in segments of the reference are counted by the outcome of their segment; of a correct one, those that both have. Points in noise segments are counted as a share of the points that have a segment in the input, all others of those that have one in the reference. Where a segment could be counted as correct or as a part of a set, the paper takes what overlaps more on average; here it counts as correct.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points of a building</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points of a class in both are TP, in the reference only FN and in the input only FP. Completeness is TP / (TP + FN), correctness TP / (TP + FP), F their harmonic mean and intersection over union TP / (TP + FN + FP). The mean of the latter is that of the classes, as merged, that the reference has. Figures of ground (2), vegetation (3-5), building (6), water (9), wires and masts (13-16), bridges (17) and noise (7, 18) are outputs, too, however classes are merged. Classes of a reference that mean "everything else" (1) are best ignored.</source>
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
        <source>Points of a plane at most this far apart are of one surface; gaps wider than this, or than a window, part coplanar surfaces.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points of a simulated flight by what they lie on: lines, surfaces or volumes.</source>
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
        <source>Points per neighborhood, the point itself among them; used by the neighborhood 'nearest'. More of them smooth noise away and blur small objects.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points that a bin of the histogram needs to belong to the scene (T_f). More of them remove denser noise, and thin objects such as wires with it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points that a normal is made of, the point itself among them; used by the neighborhood 'nearest'.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points that are building in both are TP, in the reference only FN and in the input only FP. Completeness is TP / (TP + FN), correctness TP / (TP + FP) and quality TP / (TP + FN + FP). F is the harmonic mean of the first two. Ignored by default are the reference's noise (7, 18), bridges (17; 26 in the Netherlands) and what other agencies keep for artefacts, civil works and virtual points (64-67). Objects are groups of building cells that touch by a side or a corner. Parts are distinguished from ragged edges by their size: they have the minimum area and are three cells wide somewhere.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points that have one of these classes in the reference are not counted: numbers and ranges, separated by commas (7, 64-67); empty counts every point.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Points to search: the whole cloud, whose segments and shapes found before are discarded; the points without a shape; or those of each segment (SegmentID) by itself. There, points on which no shape is found keep their segment.</source>
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
        <source>Points within the radius, the point itself among them, that make a point the core of a cluster; larger leaves out thin objects.</source>
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
        <source>Polygons cut in plan, at all heights. The extent is read first: of a COPC file only the chunks that touch it, of a virtual point cloud only the tiles. So a window of a large cloud can be taken out without reading all of it.</source>
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
        <source>Previous</source>
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
        <source>Python packages are missing or too old: {}.</source>
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
        <source>Racks carry pipes at three levels, some with flanges, some with elbows to a pipe that leads up or down; I-beams carry the racks, gratings and heaps lie beside them. Upright tanks are in the west, spherical vessels in the east. The scanner has stations at the corners of the racks and around tanks, and sees what nothing hides.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radius</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radius of lines and points that have no attribute 'radius', such as wires.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radius of the sphere around a point; used by the neighborhood 'radius'.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Radius without attribute</source>
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
        <source>References</source>
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
        <source>Regions of neighboring points above the ground, each in a color of its own.</source>
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
        <source>Remove deleted</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Remove deleted buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Replace class codes by those of an agency, or by one's own.</source>
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
        <source>Review</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Review buildings</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Review buildings…</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Review of a building</source>
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
        <source>Roof surfaces in a color each; all other points are gray.</source>
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
        <source>Roofs are planar everywhere and have low entropy; crowns are not and have high entropy. A cluster is compared with the entropies of planes and volumes that are as dense and as rough as the cloud. Roofs stop the beam, crowns let it through: a building (class 6) needs both, or the support of buildings around it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Roofs are planar everywhere and have low entropy; crowns are not and have high entropy. Two-class K-means on the mean entropies of the clusters separates them; the class with the lower mean is buildings (class 6).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Roofs of a simulated village in red; plants at their height are gray.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Roofs with the walls below their eaves.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Rounding of edges</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Run it after 'Complete buildings': nearly all other points above the ground are vegetation then. An object is a group of points that are connected in plan and height. It is solid if it is no higher than 3.5 m and less than a fifth of its pulses had several returns, and half of its points have neighbors that deviate from a plane no more than points of roofs and walls do. It is a pole if it is four times as high as its extent in plan. In thin clouds few cars are recognized: there are too few points for a plane. Objects that touch a plant are vegetation with it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Run this command? It installs Python packages for QGIS alone, from the Python Package Index.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Rusu et al. (2008), Towards 3D point cloud based object maps for household environments.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Sample data</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Santos et al. (2019), Building detection from LiDAR data using entropy and the k-means concept, equations 6-11. Weinmann et al. (2017), Point cloud analysis for UAV-borne laser scanning, section 4.2. Weinmann et al. (2015), Semantic point cloud interpretation based on optimal neighborhoods, relevant features and efficient classifiers: the choice of the neighborhood, the features of height and plan. Demantké et al. (2011), Dimensionality based scale selection in 3D lidar point clouds.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Santos, R. C. dos, Pessoa, G. G., Carrilho, A. C., Galo, M., 2019. Building detection from LiDAR data using entropy and the k-means concept, section 2.3. Sampath, A., Shan, J., 2007. Building boundary tracing and regularization from airborne LiDAR point clouds. Photogrammetric Engineering and Remote Sensing 73 (7), 805-812.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Santos, R. C. dos, Pessoa, G. G., Carrilho, A. C., Galo, M., 2019. Building detection from LiDAR data using entropy and the k-means concept, section 2.4.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Santos, R. C. dos, Pessoa, G. G., Carrilho, A. C., Galo, M., 2019. Building detection from LiDAR data using entropy and the k-means concept, section 4 (critical regions).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Santos, R. C. dos, Pessoa, G. G., Carrilho, A. C., Galo, M., 2019. Building detection from LiDAR data using entropy and the k-means concept, section 4. Sampath, A., Shan, J., 2007. Building boundary tracing and regularization from airborne LiDAR point clouds. Photogrammetric Engineering and Remote Sensing 73 (7), 805-812.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Santos, R. C. dos, Pessoa, G. G., Carrilho, A. C., Galo, M., 2019. Building detection from LiDAR data using entropy and the k-means concept. International Archives of the Photogrammetry, Remote Sensing and Spatial Information Sciences XLII-2/W13.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Save</source>
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
        <source>Scan made-up power lines from the air, with the true class of every point.</source>
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
        <source>Scanned as in 'Simulate town', with strips, lines and occlusion. Walls of terrain, such as those of tunnel mouths and abutments, rise at 60°, quays at 90°. Ramps rise at 12 %, steeper than roads, to keep lots small.</source>
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
        <source>Second cloud</source>
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
        <source>Seeds make a first TIN: the lowest points of cells that stay when the lowest surface is opened with growing windows. In each round at most one point per facet joins it: the one with the smallest angle to the facet's nodes, if angle and distance to the facet are under the thresholds. The distance threshold is estimated in each round from the residuals of the nodes over the plane of their neighbors, and allows for the point spacing; the largest angle is fixed. The growth ends when hardly any point joins. Distances are measured across the facet, so that slopes don't loosen or tighten them. Free-standing segments, with steps down all round, are excluded from the seeds and from densification.</source>
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
        <source>Segments that are higher than their surroundings are objects, the others bare earth; bridges and fly-overs, which go on into the terrain at their ends, belong to its segments. On lines in eight directions a bridge is raised on both sides. Such parts become bridge deck (17) if they are opaque and smooth, large enough, and joined to the terrain at both ends. Run 'Segment scan lines' first, and in towns and forests 'Classify ground points (TIN)', too.</source>
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
        <source>Share of the buildings that the map lacks; as many demolished ones are added to it, where plots are free.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Share of the points at about the height of a building's roof, within the clearance above and below, that must lie on roof surfaces. In crowns with a smooth side it is less. 0 accepts any; in clouds of matched images it is not examined.</source>
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
        <source>Shares are of a lattice of half a spacing, with weights of a Gaussian of 0.9 spacings. Roof points count against the other points around them, and against what is missing to the density of the roofs around. Gaps with roofs all around are filled. The spacing is that of the building points of the whole cloud or survey, in steps of a fifth.</source>
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
        <source>Shimrat, M., 1962. Algorithm 112: position of point relative to polygon. Communications of the ACM 5(8).</source>
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
        <source>Single points are found by the distances to their neighbors. Isolated points, single or in groups, are found by their distance to the scene: loose objects in the open air, and a few points under the ground. Low noise (class 7) lies under its neighbors, high noise (class 18) over them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Sithole and Vosselman (2004), Experimental comparison of filter algorithms for bare-Earth extraction.</source>
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
        <source>Smaller planes of the points, seen from above, are not reported as missing.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Smaller segments, of the input and of the reference, are ignored.</source>
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
        <source>Solids are valid by the rules of ISO 19107. Corners lie where planes intersect, to 0.1 mm, so that faces are plane; where more than two walls would meet in an edge, the smallest piece of roof there joins a neighbor. A part of a roof with a fault takes the plane of a neighbor or becomes level. Parts of a footprint that touch in a point only are solids of their own. A level that is farther from the points than a simpler one is left out. The ground is level, at the 5th percentile of the ground points nearest to the outline. Curved roofs become strips.</source>
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
        <source>Split recorded scan lines into straight pieces and merge those of adjacent lines to planes or smooth surfaces.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Stairs lead straight up to a landing of 1.2 m before raised doors. A curved front is made of six flat strips; walls of neighboring houses in one plane are one facade. The roofs of houses are flush with their walls. From the air the street is scanned as "Simulate town" does. The position of the vehicle is known exactly; the noise lies along the beam. Frames are 10 cm and panes 16 cm behind the front. Not simulated: rooms behind panes, mirror images in glass, and echoes of the vehicle's scanners that mix two surfaces at an edge.</source>
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
        <source>Steep planes are found and fitted by least squares. Each gets a boundary in its own plane: that of a triangulation without its long edges, drawn in straight edges and pushed out to hold its points. Where two facades meet, their border is the intersection line of the planes. A curved, recessed or protruding front is several planes.</source>
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
        <source>Stem and branches of a simulated tree in a color each; leaves are gray.</source>
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
        <source>Steps to save: {}.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Stiffness of the cloth: 1 follows steep slopes, 2 terraces, 3 is for flat land.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Still water reflects most pulses away from the sensor. Where an area in the cloud has less than half of the pulses that land has, the ground in it is level and most of the ground around it is higher, it is water (9). Streams whose surface reflects as land does and falls by more than 1 % are not found. Clouds of matched images are left as they are.</source>
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
        <source>Street scan</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Street, vehicle or tripod</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Streets with plots run up a slope. There are houses with gable, hip, flat and L-shaped roofs, with dormers and chimneys, rows of different heights that share walls, sheds and a hall. There are trees, hedges and a forest that let part of the light through; cars, walls, wires on poles. There is a river with bridges, and there are birds and multipath points.</source>
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
        <source>That of clouds whose files name none, and of their results. Clouds that name one keep it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The best counterpart is the footprint with the greatest IoU. Hausdorff distances are measured every 0.1 m along both outlines, courtyards included. PoLiS is the mean distance of vertices from the other outline, in the mean of both ways. A corner is a vertex where the outline turns by 20° or more; corners are matched one to one, the nearest first, if they face the same way to 60°. Squareness counts edges within 3° of two directions of the building's own. Positions are compared as they are: no shift between the layers is removed.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The bins decide between accuracy and reliability, measured on planes among scattered points: in bins smaller than the noise planes get lost, in large ones those that lie close become one.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The bins decide between accuracy and reliability. Small bins give parameters more exactly and separate planes that are nearly the same. But in bins smaller than the noise the points of one plane scatter over several, until its maximum is no higher than that of planes that exist by chance. Bins as wide as the noise are the best balance, since the parameters are determined by a least-squares fit to the points afterwards, and the automatic bins are as wide.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The blocks are worked on by one process for each core, or by the workers of a Dask cluster that runs already. These must see the same folders under the same paths; they receive the program from QGIS, and need numpy, scipy, laspy and lazrs.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The bridge over the valley, ground before this step, in blue.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The classes at hand are the labels of a logistic regression. On one half of the scene it learns how points of buildings differ from all others in shape, height, returns and intensity. It then gives a probability to each point of the other half, and the reverse. Points up to 2 m from the edge of a building then get new classes, all together: those that contradict the probabilities, the classes so far and each other least. A minimum cut in the graph of nearest neighbors finds them. Nothing comes from outside the cloud.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The cloud becomes a 3D grid of numbers of points, which may be filtered, then of occupied and empty voxels, to which erosion, dilation, opening or closing may be applied. Voxels that are connected make a segment. The layer has the voxels as points at their centers, with counts and distances to the background (distance transform), or their skeleton.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The cloud is cut into cubes. In each, planes through three random points are tried, the one with most points on it is fitted and taken out, and the next is looked for in the rest. Planes of neighboring cubes that are one plane are joined, and every point goes to the nearest of them. Planes are kept by their slope and area.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The cloud is divided into smooth surfaces: connected pipes with their elbows, a tank, a plate. In each of them, cylinders are found first, since a strip of a tank would pass for a plane, then spheres and planes among the points that have no shape yet. Points of a surface without a shape keep its SegmentID.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The cloud is split into thin parallel slices. Points of a slice that are near each other in space and not steeply above one another make a piece, also across points that lie off it. This is repeated for slices in other directions, and pieces that share points are merged. Bridges and ramps, which join the terrain at some side, become part of its segment; roofs, which join it nowhere, do not.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The clouds may differ in scale, offset, point format and extra dimensions. The result has the finest scale, the smallest point format that holds the colors, times and waveform references of all, and all extra dimensions. What a cloud lacks is NaN, or 0 in whole numbers, colors and times. It has the coordinate reference system that the clouds have; different ones are refused, and a cloud without any is taken to be in that of the others.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The clusters are those of DBSCAN with the gap as radius and a quarter of the points that a level roof has within it. A cluster that one larger cluster surrounds on more than three fifths of its border, seen from above, belongs to it: stair houses and penthouses on flat roofs, skylights in them. The paper takes the points above the height; here a plane is taken whole, down to eaves that are lower, if half of it is above. That height is 2 m and not the 2.5 m up to which "Classify walls" looks for walls, so that lean-tos are roofs and walls have as many points. Numbers follow the westernmost points of clusters, not the order of points.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The clusters are those of scikit-learn's DBSCAN on the same points in the same order: a point within the radius of cores of several clusters goes to the first of them. Memory follows the points, not their neighbors.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The confidence is the geometric mean of what entropy and penetration say, and nothing with more penetration than the maximum is a building, with one exception. Clusters adjacent to a building (dormers, eaves, parapets) are all edge, and points seen past an edge are no evidence: there entropy alone decides, if few of the pulses split. A cluster smaller than the minimum area is a building only beside another.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The covariance is that of the point together with its neighbors, with their number as divisor; its eigenvalues are l1, the largest, to l3, and those of its part in plan m1 and m2. L, P and S are linearity, planarity and scattering. Coordinates are taken relative to each point, so that large ones lose nothing. Surface variation is what other programs call curvature; verticality is that of Demantké et al.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The drone takes off between houses with balconies, parked cars, lamps and trees, turns once around and lands where it stood. One scanner looks along the horizon: it sees facades and crowns at the height of the drone, again and again. The other looks in the plane across the drone: it sees the ground, too, and everything around while the drone turns.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The entropies are those of the paper (equations 5 to 11), in the smallest neighborhood in which neither noise nor scan lines blur a plane. Neighbors are clustered points. 'Classify buildings (as published 2019)' is the method of the paper; everything below is this project's.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The filter of the paper (T_f) has no gap, no groups, no pooled cells and no isolated points; see 'Classify noise by height histogram (as published 2019)'.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The final sweep adds the points within the noise of the finished surface, which the paper leaves unclassified. Where strips overlap that were not adjusted to one another, the surface follows the lower one; 'Complete ground' takes the points of the other in.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The first step of a chain. Steps after it may change all classes.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The ground is the triangulated surface (TIN) of the points of class 2, evened out over half a meter.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The heights of each cell and its neighbors make a histogram. From both ends inward, bins that hold few points and are parted from the scene by a gap are noise: low noise (class 7) below it and high noise (class 18) above it. Then come isolated points under the ground. 'Classify noise in the air' finds birds and dust between these heights.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The heights of each cell make a histogram. From both ends inward, bins with fewer points than the minimum frequency are noise, up to the first bin that has at least as many: low noise (class 7) below, high noise (class 18) above it.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The kinds of terrain are this stage's own. The steps of lasground by the same names are smaller. 'Classify ground points (TIN, as published 2000)' starts from the seeds of the paper, and has none of the additions.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The last step of a chain: every other step reads the codes of ASPRS.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The layer is temporary: export it before QGIS closes.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The layers name no coordinate reference system; they are shown in local meters.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The lowest point of each cell as large as the largest building makes a first TIN. In each round at most one point per facet joins it: the one with the smallest angle to the facet's nodes, if angle and distance to the facet are under the thresholds. Both thresholds are estimated in each round from the nodes: 8 robust standard deviations of their distances from the plane of their neighbors, and of the angles under which these appear from the nearest node. A point that lies too high above its facet is tried again at its mirror image about the facet's highest node, if that is one of the first nodes. Rounds go on until no point qualifies, and every point is tried in each.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The map shows footprints colored by their confidence over a hillshade of the points. The ten buildings of the least confidence below 0.7 are shown one by one, from above and in sections along and across.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The neighbors and the plane of each point are kept; links between seeds are not, only the sets that they join. The memory beyond the cloud is 100 bytes for each point, 120 in &lt;i&gt;global&lt;/i&gt; mode, with 12 neighbors; each further neighbor takes 4 bytes, and a copy without noise 30.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The noise and the density of the cloud set every tolerance: a plane's neighborhood, and the distance at which a point lies on it, 2.3 times the roughness of roofs, more with less than 10 points/m². Noise over that of the ground points is of crowns and does not count. This is the "more robust segmentation" that the paper names as future work.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The normal is that of the plane of the neighbors, which are low points near roofs; neighbors that lie on no plane (bushes, corners) make no wall. A point belongs to the nearest roof, if the hull of that roof holds it. The paper scales hulls up; here they grow by the same distance on all sides, whatever their size.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The outer side is that from which points lie in front of the wall (street, cars), or close behind its openings; facades that meet at a corner face the same side of it. A window that is a plane of its own and large enough is a facade, too; "Extract openings" takes it as an opening.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The outline of each building follows the facades where they were seen: fronts, recesses, bays. Elsewhere it is the footprint. Roofs are reconstructed on it, and windows and doors set into the walls.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The page shows the matrix as a heat map, completeness, correctness, F-score and intersection over union of each class, and a map of the errors.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The paper clusters the normals of the triangles of a TIN around two means of their x and y components, which fits a building with two kinds of slopes. Vertical walls fold a TIN over the plan, and a street has facades in all directions; here the planes come from RANSAC in voxels ("Segment planes (RANSAC)"). Pieces are joined where their normals and offsets agree: the same clustering without a fixed number of clusters. Distances to the planes are perpendicular, not along z, which a vertical plane doesn't have.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The paper finds ground by Z' - min(Z') &amp;lt; d0 and facades by abs(Y' - max(Y')) &amp;lt; h0, with Y' across the way of the vehicle. Here Y' is the distance from the scanner in plan, on each of its two sides. A file doesn't say where the scanner was: it is taken to be over the point in the middle of the time of its line, which begins and ends with the sky. Lines end where no point comes for an eighth of a turn. They are split at gaps, and at their farthest point until all points are within the tolerance (Douglas and Peucker), which the paper leaves open.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The paper grows one surface after the other. Here all grow together in rounds, and neighboring seeds that fit the planes of one another are one surface. A point that several surfaces could take joins that of its nearest neighbor. Where it does not fit the plane there, the next neighbor is tried, even if that belongs to the same surface. A point that joins gets the least squares plane of the surface around it, as the paper asks for. The paper accepts seeds by the sum of squared distances. Here the limit is a root mean square distance of 1.55 standard deviations, corrected for the degrees of freedom. The local Hough transform votes for 128 directions of planes through each point. In &lt;i&gt;global&lt;/i&gt; mode planes start from the smoothest seed of each neighborhood and are joined in mutually best pairs where they meet.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The paper has no confidence. Above 0.5 it grows with the size of the cluster, to half at twice the points of the smallest building, as small objects such as cars can look like a roof by chance. This changes no decision.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The paper names the filter and its threshold T_f, which is 5 in both of its scenes; cells and bins are not given, and follow the density of the cloud. A cell in which no bin has enough points borrows the histogram of itself and its eight neighbors, and where these have none either, the range of the nearest cell that has one.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The paper removes triangles with an edge over 1.5 spacings and keeps the points where the boundary turns, which keeps every bite that chance takes out of it ("key points"). Straight edges are fitted by least squares to the boundary of triangles with edges up to 4 spacings. The spacing is measured where the points are farthest apart, since the mean over a vehicle's scan lines would tear the triangulation between them. Where shadows cut a facade, the longest edge grows until 95 % of the points are in one piece, at most to the widest gap.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The paper scans streets without satellite positions and leaves open how its scans come together. A vehicle's position between high houses is off by decimeters to meters, its direction hardly at all; so the transformation is a shift. A search on a grid of 0.25 m finds the shift at which most of the walls lie on outlines. Least squares in narrowing rounds then solve for shift and overhang of the eaves together, which walls on both sides of a street separate. Where a street shows no end of a wall at a corner, the shift along it stays near 0.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The paper states that size, position and arrangement of the elements of a facade are obtained (section 4), and not how. Points within three times the rms of the plane are wall; points up to the maximum depth behind it are of openings. Both are laid on cells of 1.2 spacings of the wall. Cells behind that lie within 0.3 m of each other with no wall between are one opening. It must have wall within 0.15 m along half of its outline, where the sill of a door does not count, and points in a tenth of its area. Its sides are the edges of the wall where these lie within 0.3 m of the points. It is a rectangle unless the convex hull of its points fills less than three quarters of it, as that of a triangular window. Panes with at most 0.15 m between them are one window.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The paper works on range images. Here adjacent lines are found by their points: the nearest one to the side of a piece, and the nearest one on the opposite side, also of another flight line. The ends of a piece are those of the straight line through its points by least squares, so that noise of single points does not count. Points that are on no piece, such as those at bends and first returns, join the region of one of the 3 nearest points that have one if they lie on its plane. The published method merges planes only.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The paper's steps 1 to 13 grow one region after another with a sphere; their result is the transitive closure of equations 2 and 3, which does not depend on the order of points and is computed directly. The least number of points is the paper's: T_Np = Ar_min d, the minimum building area times the density. Its T_Dxy are twice the spacings that it states (0.3 and 0.7 m); here the spacing is s = 1 / sqrt(d), which is 0.28 and 0.5 m there. For T_Dh it names "internal altimetric accuracy" and takes 0.2 and 0.3 m, about ten times the range noise of the two scanners. Automatic is ten times the measured noise between these two values. 'Thresholds' takes the values of the paper's table 2 themselves.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The papers leave open how many deviations the thresholds are, and the part of the point spacing that the distance allows for. They have no bound of the angle, without which rough first nodes let the surface climb onto anything. They have no terrain angle either, with which programs in use bound the slope between nodes. Unlike there, facets with short edges are closed, and points near a node don't join, as they add nodes but no shape. The final sweep takes in the points within the noise of the finished surface, as the tools in use do; sweep distance 0 leaves it out. The paper of 2019 took 'city' of lasground, whose step is 25 m: that is a maximum building size of 25 m.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The points become voxels, whose gaps are closed. Stems are round and upright at breast height. Every voxel has the shortest path to the root of a stem, and connected voxels about as far from it are a slice. At each fork of the slices the branch goes on where the way to its tip is longest, and the others are branches of the next order. Points of short and of crooked branches, and those far from the wood, are leaves.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The probability of building that was learned from the scene, from blue to red.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The project has no point cloud here.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The published chain without this project's additions: cell histogram filter, progressive TIN densification from the lowest point of each cell of the largest building's size, region growing, mean entropy per cluster and two means. Where the papers give no value (cells of the histograms, thresholds of the TIN, distances of the regions), it follows the density and the noise of the cloud. The Notes of each step say how. 'Thresholds' takes the values of the paper's table 2 instead. The outlines are this project's. 'Detect buildings' finds more buildings with fewer errors.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The rack of the plant: pipes, elbows, flanges and beams, each in a color of its own.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The river of a simulated town in blue, below its bridges.</source>
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
        <source>The scan of the street, from a vehicle or a tripod.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The scanners are those of the publication: 40 lines per second, a beam every 0.25° in all directions but a quarter of the circle, behind the horizontal one and above the vertical one. They reach 30 m, with 3 cm of noise along the beam. The drone sways by up to 0.3 m and 2°. Its position is known exactly: points lie on surfaces but for the range noise. With nothing set there are 6.7 million points in 320,000 voxels of 0.1 m, about as many as in the publication.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The scene is a surface of cells of 0.1 m, and so are the errors: matching turns it into a smoother surface with errors that neighbors share, on which points are drawn. Steps are smeared by normal distributions whose width changes over the site from half to one and a half times the mean. Points that are smeared beyond the edge of an object, 0.3 m above the ground or more, are of the object.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The shift makes facades lie on the outlines of buildings, their ends at corners of these, and the street on the ground. It is reported with its residual. The airborne cloud stays where it is.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The shorter side of the largest building; smaller keeps more of narrow hilltops.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The site from above, in the colors of its images.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The site of the flight, in the colors of the true classes.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The slope of a plane is the angle of its normal from the vertical: roofs are kept up to 60°, walls have 90°. Leaves and other scattered points are no plane: it must have more points than a plane found by chance in one of a thousand voxels of scattered points. A strip narrower than 3.5 tolerances has no plane of its own. The result depends on the seed, not on the order of points or the number of threads.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The terrain model (DTM) is the triangulated surface (TIN) of the ground points (class 2), at the middle of each cell. The surface model (DSM) holds the highest point of each cell. The heights (nDSM) are surface minus terrain.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The tiles are those of a lattice that starts at the origin of the coordinates; each is named by its lower left corner in meters. Every point of every file is in exactly one tile, with all its dimensions; points at a lower edge belong to the tile, those at an upper edge to the next one. Files are read in portions, so that memory does not grow with them; on the disk the points lie once uncompressed beside the tiles while they are made. A virtual point cloud over all tiles is written with them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The town from above, in the colors of the true classes.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The tree, each branch in a color of its own.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The village from above, in the colors of its images.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The walls of a ring are found by one dynamic program over all corners and directions. Its costs are squared distances from the line, a price for each corner by its angle, and a price for walls off the main directions. The walls of neighbors within 30 m count, too. Rings with many walls off these directions, and round ones, are drawn as chords. The walls of all buildings of a block cut the plane into cells, and a minimum cut gives each cell to a building or to the ground. Clusters whose points lie on one line have no area and give no polygon.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>The work is done in blocks of a lattice that starts at the origin of the coordinates, each with the points around it as far as the steps reach. So the result does not depend on how the points are spread over files. Density, spacing and noise of the cloud are measured once for all blocks. So are the roughness of the ground and the mean entropies that clusters are compared with, where steps use them. A block that cuts off a building or a facade is worked on again with more around it; long pipes and large planes are put together from the pieces that blocks found. Rasters have the same cells in all blocks, and no seams. Steps that read layers alone are run once, on those of the whole survey.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>There is no layer to show; run a model first.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>There is no terrain outside the hull of the ground points. Small gaps of the surface (shadows, dark roofs, water) are interpolated linearly between the cells around them; larger ones stay empty.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>These buildings don't touch; only neighbors that do become one.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>They become high noise (class 18). Roofs and crowns that no trunk or wall supports in the cloud stay, as they stop most pulses.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>They become low noise (class 7), and the ground around them that they hid becomes ground (class 2). Small pools and sunken yards that few pulses reached become noise too, so look at the result.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Thin the voxels of the layer to lines in the middle of the objects; the segments of the points stay.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>This is self-training in one round, on all labels: half-wrong ones cancel out, and walls are learned although few points of walls are certain. Points are described in cubes of four point spacings, alone and with the 26 around: shape (eigenvalues), elevation, height, returns, intensity, and the column in plan, three cubes wide. Halves are squares of 10 m in turn, so that no point is judged by labels of its own surroundings alone. What is wrong everywhere in a scene is learned, too.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>This is the second step of 'Classify ground segments', for the ground of any filter and without segments. All points can be of a deck, except those of classes that are no decks.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>This stage is not part of the published method, whose clusters are roofs and lose points that are not planar or not connected with them.</source>
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
        <source>Three-dimensional views draw lines with one width for all of them. Here each pipe is a prism of 16 sides, without ends, and each sphere a solid of 16 by 8 faces.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Thresholds</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Thresholds follow the data of each building. The distance of points to their line is that of the noise. A wall is cut into pieces that should hold three points each, and is covered where they hold any. An edge of the outline is judged by its points between the corners, which are left out. The paper takes every pair of corners for a candidate edge. Here the whole outline is the one that costs least: unseen wall by the meter, corners by the piece and more where they aren't square, parts outside the roof by the area. It is found by a minimum cut, then line by line it is tried whether the outline is better off without.</source>
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
        <source>Tiles written</source>
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
        <source>Tips of trees, chimneys, masts and wires that have few points in a bin are noise by this rule. 'Classify noise by height histogram' asks for a gap and keeps them, and finds single points between the heights of the scene.</source>
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
        <source>Two points belong to one cluster when a chain of points leads from one to the other in which each step is shorter than the planimetric distance and than the height difference. Clusters with fewer points than the minimum building area holds at the cloud's density get no id.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Two roof planes that rise toward each other are a gable. Their intersection line, made level, is the ridge; the outer edges of their points are the eaves, which get one height; walls are upright below the edges of the roof, down to the ground around.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Two surfaces merge if neither lies farther than this from their common plane (root mean square).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Two-class K-means starts from the mean entropies of random points on a disk, as rough as the cloud's surfaces, and in a ball. These two stay in the data, each with many times the weight of all clusters, and so decide. A handful of clusters, or clusters of one kind only as in a forest, are not split in two. Surfaces are as rough as the ground at most, since nearly all points of a forest are of crowns.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Type I error</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Type I errors are ground that was lost, type II errors are objects that were taken for ground.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Type I is the share of the true ground that was called object, type II the share of the true objects that were called ground. Total is the share of all points that are wrong, and kappa the agreement beyond chance. Ignored by default are the reference's noise, water and bridges, and what agencies keep for artefacts and virtual points.</source>
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
        <source>Undo</source>
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
        <source>Unevenness of the ground, waves and the roughness of crowns are those of two real clouds, a suburb and a beach. Open ground deviates from planes by 1 to 1.3 cm over 1 m and by 3 to 5 cm over 4 m.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Unlike in the publications, lines cut only the cells along which planes adjoin, so that the cost grows with the border of planes and not with the square of their number. A border costs its length and the wall that it needs, in the same unit as the roof that no plane explains: square meters.</source>
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
        <source>Vertical planes are found among the points. Each gets a boundary in its plane, and neighbors a common border on the intersection line of their planes. An enclosed area with points behind the wall is a window or a door: a hole of the facade, and a feature with its size and position. Nothing has to be set; ground and noise are left out where they are classified.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Vertices are numbered as in the paper's figure 8: 1 and 2 are the ends of the ridge, 3 to 6 those of the eaves, 7 to 10 lie below these on the ground. The fifteen parameters are x and y of 1 to 6, z1, z3 and z7. The paper offers two ways to a level ridge; here the ridge is the intersection line, turned level at its middle. Both eaves get the mean of their elevations and stay in their planes, so that all faces are planar; walls below them are upright, and gable walls are square to the ridge. A plane is used for the neighbor that it shares the longest ridge with.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>View</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Views are parallel; what a ray meets first is a point. A wall that faces an oblique view of 28° gets a tenth of the density of open ground (a fifth of the views, times the tangent of the angle), and nothing right under the eaves. That is about the share of wall points (5 % of those on roofs) that Hrutka, Siki and Takács (2022) report of real clouds. Noise is the same in all directions.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Virtual point cloud over the tiles</source>
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
        <source>Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds, section 2.1. Sithole, G., Vosselman, G., 2003. Automatic structure detection in a point cloud of an urban landscape. URBAN 2003, Berlin, 67-71.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds, section 2.3. Gorte, B. G. H., Pfeifer, N., 2004. Structuring laser-scanned trees using 3D mathematical morphology. IAPRS 35 (B5), 929-933. Palágyi, K., Kuba, A., 1999. Directional 3D thinning using 8 subiterations. LNCS 1568, 325-336.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds, section 3.2. Gorte, B., 2002. Segmentation of TIN-structured surface models. Joint International Symposium on Geospatial Theory, Processing and Applications, Ottawa.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds, section 4.1. Hough, P. V. C., 1962. Method and means for recognizing complex patterns. U.S. Patent 3,069,654. Vosselman, G., Dijkman, S., 2001. 3D building model reconstruction from point clouds and ground plans.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds, section 4.2. Kimme, C., Ballard, D., Sklansky, J., 1975. Finding circles by an array of accumulators. Communications of the ACM 18 (2), 120-122. Rabbani, T., van den Heuvel, F., 2005. Efficient Hough transform for automatic detection of cylinders in point clouds.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds, section 4.3.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds, section 5.3. Sithole, G., Vosselman, G., 2003. Automatic structure detection in a point cloud of an urban landscape. URBAN 2003, Berlin, 67-71.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds, sections 2.1 and 3.1. Jiang, X. Y., Bunke, H., 1994. Fast segmentation of range images into planar regions by scan line grouping. Machine Vision and Applications 7 (2), 115-122.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds, sections 2.2, 3.1 and 4.1. Hoover, A., et al., 1996. An experimental comparison of range image segmentation algorithms. IEEE Transactions on Pattern Analysis and Machine Intelligence 18 (7), 673-689.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds. International Archives of Photogrammetry, Remote Sensing and Spatial Information Sciences 36 (8/W2), 33-38.</source>
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
        <source>Voxels start at the origin of the coordinates, not at the first point, so that clouds of the same site get the same voxels. A point on the side between two voxels belongs to the eastern, northern or upper one. One that is less than 0.1 µm off counts as on the side, since decimals like 0.3 have no exact binary number. The result depends on neither the order of the points nor, but for this rounding, on where the cloud lies.</source>
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
        <source>Walls are looked for up to this height above the ground.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Water</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Wavefront OBJ</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Waves</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Weinmann et al. (2017), Point cloud analysis for UAV-borne laser scanning with horizontally and vertically oriented line scanners, section 4.1. Hrutka et al. (2022), Voxel-based point cloud segmentation and building detection, section 2.2.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Weinmann et al. (2017), Point cloud analysis for UAV-borne laser scanning with horizontally and vertically oriented line scanners, section 5.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Weinmann et al. (2017), Point cloud analysis for UAV-borne laser scanning with horizontally and vertically oriented line scanners, sections 3.2 and 5.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Weinmann et al. (2017), Point cloud analysis for UAV-borne laser scanning, section 4.3.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Weinmann, M., Müller, M. S., Hillemann, M., Reydel, N., Hinz, S., Jutzi, B., 2017. Point cloud analysis for UAV-borne laser scanning with horizontally and vertically oriented line scanners - concept and first results. International Archives of the Photogrammetry, Remote Sensing and Spatial Information Sciences XLII-2/W6.</source>
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
        <source>Where both layers are compared: buildings and footprints with half of their area within. Without it, the next parameter decides.</source>
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
        <source>Where points are few, larger spots of crowns are smooth by chance. Most of the points around these are leaves, so clusters with too few building points around them are refused. Such spots may lie next to each other, but none of them is sure. So adjacent clusters are also decided on together, by their mean confidence times the mean share around them, unless they are so large that ground would be seen in them among trees.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Where the cloud came with ground or buildings, points that steps in between called ground or building become unclassified (1). Kept buildings are numbered anew, those whose points are close to one another in plan as one. Without remembered classes nothing changes.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Where the cloud has fewer points than a neighborhood asks for, it is made of all of them. Of several points equally far at the end of a neighborhood of 'nearest' or 'optimal', each counts in part, so that their order in the cloud decides nothing. This holds as long as they are among the 1.3 (sqrt(k) + 1)² nearest; the features of extent are those of all of them. 'optimal' tries the minimum of nearest points, then a step more, up to the maximum, and takes the one with the least eigenentropy; of several that differ by rounding only, the smallest.</source>
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
        <source>Whole buildings in red, with walls, dormers and edges.</source>
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
        <source>Why clusters are buildings</source>
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
        <source>Wiedemann et al. (1998), Empirical evaluation of automatically extracted road axes. Santos et al. (2019), Building detection from LiDAR data using entropy and the k-means concept, section 3.2.</source>
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
        <source>Wires are linear, roofs and ground are planar, crowns are scattered; the entropy says how mixed the three are. Choose which features to keep: each becomes a dimension that can be drawn and filtered.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Wires are parabolas with a sag of 3 % of the span, those of low voltage of 0.8 m. A pulse whose axis passes a wire within 0.1 m gives a return from it in 70 of 100 cases, and most go on. Scanned as in 'Simulate town'.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Wires, poles and edges are linear, ground, roofs and walls planar, crowns and bushes volumetric. Nothing has to be trained; the scale of structure and noise is that of the neighborhood of 'Compute features', which comes before.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>With &lt;i&gt;Isolated points&lt;/i&gt;, both are found. A point must then be farther than 4.8 m (7 point spacings on sparse clouds) from its nearest one, too, so that facades and crowns keep their sparse parts. Points that no chain of points half as far apart ties to the scene are noise too, and so are points under the ground. 'Classify noise in the air' and 'Classify noise by height histogram' find these in the same way; their notes name the objects that stay. Only points with nothing around them can be noise by their distance then. So neighbors are looked up for those in voxels with few points, and of the others of large clouds for a sample of 200,000, which gives mean and standard deviation of all.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>With center first, points vote for a center, and those of the best center for a radius. With four dimensions, they vote for both together, which takes more memory.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>With points, each point votes for all planes through it. With normals, the normal of each point votes for a direction, then the point for a distance, which needs surfaces smooth enough for normals.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Wood is seen from all sides. Nothing is hidden, and nothing moves in the wind.</source>
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
        <source>Write the points of buildings and ground around footprints, and the footprints, as the program roofer reads them.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Wrong matches above and below the ground.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Yarowsky, D., 1995. Unsupervised word sense disambiguation rivaling supervised methods. Proceedings of the 33rd Annual Meeting of the Association for Computational Linguistics, 189-196 (self-training). Weinmann, M., Jutzi, B., Hinz, S., Mallet, C., 2015. Semantic point cloud interpretation based on optimal neighborhoods, relevant features and efficient classifiers. ISPRS Journal of Photogrammetry and Remote Sensing 105, 286-304 (features).</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>Zhang, W., Qi, J., Wan, P., Wang, H., Xie, D., Wang, X., Yan, G., 2016. An easy-to-use airborne LiDAR data filtering method based on cloth simulation. Remote Sensing 8 (6), 501. Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection, section 2.2.</source>
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
        <source>roofer 1.0 reads the classes 2 and 6 unless its configuration names others, and models parts of a building as separate buildings. Its attribute for names is called as in the 3DBAG.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>roofer takes a LAS or LAZ file with the classes 2 (ground) and 6 (building), and one polygon for each building with an attribute that names it: &lt;code&gt;roofer --id-attribute identificatie cloud.laz roofprints.gpkg folder&lt;/code&gt;. It writes CityJSONSeq.</source>
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
    <message>
        <source>{} buildings touch this one; select those to merge it with.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>{} buildings, {} of them doubtful.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>{} can't be edited; export it to a GeoPackage and review that.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>{} of {} reviewed.</source>
        <translation type="unfinished"></translation>
    </message>
    <message>
        <source>{}, as used</source>
        <translation type="unfinished"></translation>
    </message>
</context>
</TS>
