"""The composites: which stage feeds which.

The graph that a user opens in the model designer is drawn from this module too, so it and the chain that runs in memory
can't differ.
"""

from .pipeline import Pipeline, Step, composite

# From the raw cloud to footprints.
_DETECTION = (
    Step("existing", "keep_classes"),
    Step("noise", "classify_noise_histogram"),
    # Drops earlier classes of plants, water, wires and bridges; steps that find ground and buildings drop theirs.
    Step("earlier", "recode_classes", {"mapping": "3-5, 9, 14-15, 17=1"}),
    Step("ground", "classify_ground_tin"),
    Step("kept_ground", "restore_classes"),
    Step("bridges", "classify_bridges", {"search": "gaps in the ground"}),
    Step("height", "compute_height_above_ground"),
    Step("roofs", "segment_roofs"),
    Step("buildings", "classify_buildings"),
    Step("complete", "complete_buildings"),
    Step("refine", "refine_buildings"),
    Step("kept_buildings", "restore_classes"),
    # Before the steps that only sort the other points: these are not run for footprints alone.
    Step("footprints", "extract_footprints"),
    Step("near_ground", "complete_ground"),
    Step("water", "classify_water"),
    Step("wires", "classify_wires"),
    Step("vegetation", "classify_vegetation"),
    Step("kept", "restore_classes"),
)
_DETECTION_SHARED: dict[str, tuple[str, ...]] = {
    "min_area": ("buildings", "complete", "footprints"),
    "density": ("roofs", "buildings", "complete", "refine"),
    "source": ("ground", "roofs", "buildings", "complete", "refine"),
}

# Comparison of the corners of walls with the corners of an old map.
_COMPARISON = Step(
    "comparison", "compare_corners", layers={"footprints": "footprints.wall_footprints"}, only_with=("old_map",)
)


@composite(
    "Models",
    tags=(
        "building,house,detection,roof,footprint,classification,vegetation,tree,water,bridge,wire,power line,"
        "entropy,k-means,las2building,lasclassify"
    ),
    shared=_DETECTION_SHARED,
    shown=(
        "min_area",
        "roofs_min_height",
        "ground_max_building_size",
        "bridges_max_width",
        "water_look_for",
        "wires_look_for",
        "vegetation_look_for",
        "codes_codes",
        "existing_keep",
        "footprints_regularize",
    ),
)
def detect_buildings():
    """Find the buildings in a point cloud: classified points and footprints, with nothing to set.

    Noise, ground, bridges and heights come first, then roof surfaces and clusters of everything else above the ground.
    A cluster is a building by its mean entropy, compared with planes and volumes, and by how much of the beam passes
    through it. Then walls are added, edges are corrected by a regression learned from the buildings themselves, water,
    wires and vegetation get classes, and outlines are drawn. Distances and tolerances follow the density and the noise
    of the cloud.

    References
    ----------
    Santos, R. C. dos, Pessoa, G. G., Carrilho, A. C., Galo, M., 2019. Building detection from LiDAR data using entropy
    and the k-means concept. International Archives of the Photogrammetry, Remote Sensing and Spatial Information
    Sciences XLII-2/W13. [santos2019]
    """
    return (
        *_DETECTION,
        Step("report", "report_buildings", layers={"footprints": "footprints.footprints"}),
        Step("codes", "recode_classes"),
    )


@composite(
    "Models",
    tags="3D,LoD2,LoD1,building,city model,roof,CityJSON,CityGML,OBJ,solid",
    shared=_DETECTION_SHARED,
    shown=(
        "min_area",
        "models_level_of_detail",
        "models_min_plane_area",
        "models_terrain_tolerance",
        "ground_max_building_size",
    ),
    switched_off=("output", "footprints", "terrain"),
)
def model_buildings():
    """Model the buildings of a point cloud in three dimensions: roofs and walls as layers and CityJSON.

    Finds the buildings as 'Detect buildings' does, and models each on its footprint: the planes of its roof, walls and
    ground as a closed solid, at levels of detail 1.2 to 2.3. Where there is a map of the buildings, 'Reconstruct roofs'
    takes that instead of the footprints found.

    References
    ----------
    Peters, R., Dukai, B., Vitalis, S., van Liempt, J., Stoter, J., 2022. Automated 3D reconstruction of LoD2 and LoD1
    models for all 10 million buildings of the Netherlands. Photogrammetric Engineering & Remote Sensing 88(3).
    [peters2022]

    Santos, R. C. dos, Pessoa, G. G., Carrilho, A. C., Galo, M., 2019. Building detection from LiDAR data using entropy
    and the k-means concept. International Archives of the Photogrammetry, Remote Sensing and Spatial Information
    Sciences XLII-2/W13. [santos2019]
    """
    return (*_DETECTION, Step("models", "reconstruct_roofs", layers={"footprints": "footprints.footprints"}))


@composite(
    "Models as published",
    title="Detect buildings, published 2019",
    tags="building,detection,entropy,k-means,kmeans,region growing,Santos",
    shared={
        "thresholds": ("regions", "buildings"),
        "min_area": ("regions", "buildings", "footprints"),
        "density": ("regions", "buildings"),
    },
    shown=(
        "thresholds",
        "min_area",
        "ground_max_building_size",
        "regions_plan_distance",
        "regions_height_distance",
    ),
)
def detect_buildings_2019():
    """Find the buildings in a point cloud by the steps of the paper of 2019, to compare with.

    The published chain without this project's additions: cell histogram filter, progressive TIN densification from the
    lowest point of each cell of the largest building's size, region growing, mean entropy per cluster and two means.
    Where the papers give no value (cells of the histograms, thresholds of the TIN, distances of the regions), it
    follows the density and the noise of the cloud. The Notes of each step say how. 'Thresholds' takes the values of the
    paper's table 2 instead. The outlines are this project's. With a reference cloud, or polygons of the true buildings,
    completeness, correctness and F (table 3) are among the results. 'Detect buildings' finds more buildings with fewer
    errors.

    References
    ----------
    Santos, R. C. dos, Pessoa, G. G., Carrilho, A. C., Galo, M., 2019. Building detection from LiDAR data using entropy
    and the k-means concept. International Archives of the Photogrammetry, Remote Sensing and Spatial Information
    Sciences XLII-2/W13. [santos2019]
    """
    return (
        Step("noise", "classify_noise_histogram_2019"),
        Step("ground", "classify_ground_tin_2000"),
        Step("regions", "segment_regions"),
        Step("buildings", "classify_buildings_2019"),
        Step("footprints", "extract_footprints"),
        Step("assessment", "assess_buildings", only_with=("reference", "reference_map")),
    )


@composite(
    "Models",
    tags="linear,planar,volumetric,dimensionality,voxel,drone,UAV,scanner,scene,structure,Weinmann,wire,power line",
    shown=("voxels_voxel_size", "features_neighborhood", "features_n_neighbors", "merge_transforms"),
    timed=True,
)
def interpret_structure():
    """Classify points as linear, planar or volumetric in a cloud, or in several that are merged.

    Merges the clouds and leaves one point per voxel, so that areas scanned for long don't count more than others. Then
    it describes the neighborhood of each point, and sorts points by the largest of linearity, planarity and scattering:
    wires and edges, ground and walls, crowns and bushes. The features stay in the cloud. The neighborhood of 50 points
    gives smooth results on noisy scans; 'optimal' chooses a number for each point and keeps more detail. A report
    counts what thinning left, and compares the shares of the three kinds in both neighborhoods. In tiles, the files of
    a survey are one cloud, also where they overlap: they are not moved, and points keep the numbers of their sources.

    References
    ----------
    Weinmann, M., Müller, M. S., Hillemann, M., Reydel, N., Hinz, S., Jutzi, B., 2017. Point cloud analysis for
    UAV-borne laser scanning with horizontally and vertically oriented line scanners - concept and first results.
    International Archives of the Photogrammetry, Remote Sensing and Spatial Information Sciences XLII-2/W6.
    [weinmann2017]
    """
    return (
        Step("merge", "merge_clouds"),
        Step("voxels", "downsample_voxels"),
        Step(
            "features",
            "compute_features",
            {"features": ("linearity", "planarity", "scattering", "verticality", "optimal_neighbors")},
        ),
        Step("structure", "classify_dimensionality"),
        Step("report", "report_structure"),
    )


@composite(
    "Models",
    tags="cadastre,land registry,wall,footprint,corner,drone,UAV,photogrammetry,map,update,change detection,Hrutka",
    shared={"min_area": ("roofs", "footprints"), "source": ("ground", "roofs")},
    shown=("min_area", "voxels_voxel_size", "ground_max_building_size", "roofs_min_height", "footprints_min_seen"),
    kept=("noise", "voxels", "ground", "height", "planes", "roofs"),
    switched_off=("candidate_corners",),
)
def map_footprints():
    """Map the walls of buildings from a drone's point cloud, and compare them with the old map.

    Noise is removed and one point left per voxel. Progressive TIN densification finds the ground, without flat roofs of
    any size, and bridge decks are found over its gaps. The ground becomes a terrain model. Planes high above it are
    roofs, and low upright surfaces below them are their walls. Footprints are the outlines of walls, without the eaves,
    with a quality for every edge. Where too little of the walls was seen, as in most airborne clouds, they are outlines
    of roofs, and their attributes say so. Where an old map is given, its corners are compared with the new ones. The
    terrain and the cloud of every step can be kept. The paper's ground filter, a cloth, settles on large flat roofs; to
    use it, open the model and put 'Classify ground points (cloth)' in the place of the ground step.

    References
    ----------
    Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection.
    International Archives of the Photogrammetry, Remote Sensing and Spatial Information Sciences XLVIII-4/W1.
    [hrutka2022]
    """
    return (
        Step("noise", "classify_noise_statistical"),
        Step("voxels", "downsample_voxels"),
        Step("ground", "classify_ground_tin"),
        Step("bridges", "classify_bridges", {"search": "gaps in the ground"}),
        Step("terrain", "rasterize_terrain"),
        Step("height", "compute_height_above_ground"),
        Step("planes", "segment_planes_ransac", {"min_height": 1.5}),
        Step("roofs", "classify_roofs"),
        Step("walls", "classify_walls"),
        Step("footprints", "extract_wall_footprints"),
        _COMPARISON,
    )


@composite(
    "Models as published",
    title="Map footprints, published 2022",
    tags="cadastre,land registry,wall,footprint,corner,drone,UAV,photogrammetry,RANSAC,DBSCAN,cloth,CSF,Hrutka",
    shown=(
        "voxels_voxel_size",
        "ground_rigidness",
        "roofs_radius",
        "footprints_min_points",
        "footprints_min_density",
    ),
    switched_off=("candidate_corners",),
)
def map_footprints_2022():
    """Map the walls of buildings in a drone's point cloud by the steps of a paper of 2022, to compare with.

    The published chain without this project's additions: outliers, voxels, the cloth as ground filter, terrain and
    heights. Planes above 2.5 m, found by RANSAC in voxels, are clustered by DBSCAN to roofs, and upright points below
    them are walls. Crossings of their lines at right angles are corners, pairs of these with many points between are
    edges. Values that the paper leaves open follow density and noise. The report counts points by step (table 1), and
    the comparison with an old map has distances of corners (table 2). 'Map footprints' finds more buildings and closes
    their outlines.

    References
    ----------
    Hrutka, B. P., Siki, Z., Takács, B., 2022. Voxel-based point cloud segmentation and building detection.
    International Archives of the Photogrammetry, Remote Sensing and Spatial Information Sciences XLVIII-4/W1.
    [hrutka2022]
    """
    return (
        Step("noise", "classify_noise_statistical"),
        Step("voxels", "downsample_voxels"),
        Step("ground", "classify_ground_cloth"),
        Step("terrain", "rasterize_terrain"),
        Step("height", "compute_height_above_ground"),
        Step("planes", "segment_planes_ransac", {"min_height": 2.5}),
        Step("roofs", "segment_clusters", {"segments_only": True}),
        Step("walls", "classify_walls"),
        Step("footprints", "extract_wall_footprints_2022"),
        _COMPARISON,
    )


@composite(
    "Models",
    tags="facade,wall,window,door,street,mobile mapping,terrestrial,vehicle,3D,Peng",
    shared={
        name: ("planes", "openings") for name in ("max_tilt", "max_gap", "corner_distance", "boundary", "complete")
    },
    shown=("planes_min_area", "planes_min_height", "openings_min_size", "boundary", "complete"),
    switched_off=("output", "planes_facades"),
)
def model_facades():
    """Turn a street or terrestrial scan into facades with windows and doors, as polygons in space.

    Vertical planes are found among the points. Each gets a boundary in its plane, and neighbors a common border on the
    intersection line of their planes. An enclosed area with points behind the wall is a window or a door: a hole of the
    facade, and a feature with its size and position. Nothing has to be set; ground and noise are left out where they
    are classified.

    References
    ----------
    Peng, C., Yu, Z., 2018. Research on 3D building information extraction and image post-processing based on vehicle
    LIDAR. EURASIP Journal on Image and Video Processing 2018:121. [peng2018]
    """
    return (Step("planes", "extract_facades"), Step("openings", "extract_openings"))


@composite(
    "Models",
    tags="3D,LoD3,city block,street,facade,window,door,roof,mobile mapping,airborne,CityJSON,registration,Peng",
    shared=_DETECTION_SHARED,
    shown=("min_area", "street_max_shift", "street_min_size", "block_min_plane_area", "ground_max_building_size"),
    switched_off=("output", "footprints", "facades", "openings"),
)
def model_city_block():
    """Model a block from an airborne cloud and a street scan: roofs, walls, windows and doors in one model.

    Finds the buildings of the airborne cloud as 'Detect buildings' does. Facades, windows and doors of the street scan
    are moved onto it, by the walls, their ends and the ground that both show; the shift is reported. Outlines follow
    the facades where they were seen, and are footprints elsewhere. Roofs are reconstructed on them, and windows and
    doors set into the walls, as CityJSON at level of detail 3.

    References
    ----------
    Peng, C., Yu, Z., 2018. Research on 3D building information extraction and image post-processing based on vehicle
    LIDAR. EURASIP Journal on Image and Video Processing 2018:121. [peng2018]

    Peters, R., Dukai, B., Vitalis, S., van Liempt, J., Stoter, J., 2022. Automated 3D reconstruction of LoD2 and LoD1
    models for all 10 million buildings of the Netherlands. Photogrammetric Engineering & Remote Sensing 88(3).
    [peters2022]
    """
    return (
        *_DETECTION,
        Step("street", "register_street", layers={"footprints": "footprints.footprints"}),
        Step(
            "block",
            "reconstruct_block",
            layers={
                "footprints": "footprints.footprints",
                "facades": "street.facades",
                "openings": "street.openings",
            },
        ),
    )


@composite(
    "Models",
    tags="terrain,bare earth,DTM,DEM,bridge,fly-over,segments,scan line,lasground,filter,Sithole,Vosselman",
    shared={"noise": ("segments", "ground"), "density": ("segments", "ground")},
    shown=("ground_max_width", "ground_min_bridge_area", "ground_max_object_area", "segments_max_obstacle"),
)
def model_terrain():
    """Model the bare earth without objects and bridges: classified points and rasters, by segments.

    Noise first; then pieces of artificial scan lines in several directions are merged to segments. Segments that are
    higher than their surroundings are objects, large halls among them; the others are bare earth. Parts of the bare
    earth that are raised on both sides and joined to the terrain at both ends are bridges and fly-overs, and become
    bridge deck (17). The terrain model is made of the rest. In towns and forests, where walls and leaves join roofs and
    crowns to the terrain, use 'Classify ground points (TIN)' and then 'Classify bridges' instead: they make fewer
    errors.

    References
    ----------
    Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds.
    International Archives of Photogrammetry, Remote Sensing and Spatial Information Sciences 36 (8/W2), 33-38.
    [vosselman2004]
    """
    return (
        Step("noise", "classify_noise_histogram"),
        Step("segments", "segment_scan_lines"),
        Step("ground", "classify_ground_segments"),
        Step("terrain", "rasterize_terrain"),
    )


@composite(
    "Models",
    tags="industry,plant,pipe,tank,vessel,cylinder,sphere,plane,as-built,terrestrial,laser scanner,Vosselman",
    shared={"min_radius": ("cylinders", "spheres"), "max_radius": ("cylinders", "spheres")},
    shown=("min_radius", "max_radius", "cylinders_min_seen", "planes_min_area"),
    switched_off=("output", "axes", "centers"),
)
def model_industry():
    """Model pipes, tanks, spheres and planes of a scanned plant: axes, centers and surfaces with heights.

    The cloud is divided into smooth surfaces: connected pipes with their elbows, a tank, a plate. In each of them,
    cylinders are found first, since a strip of a tank would pass for a plane, then spheres and planes among the points
    that have no shape yet. Points of a surface without a shape keep its SegmentID.

    References
    ----------
    Vosselman, G., Gorte, B. G. H., Sithole, G., Rabbani, T., 2004. Recognising structure in laser scanner point clouds.
    International Archives of Photogrammetry, Remote Sensing and Spatial Information Sciences 36 (8/W2), 33-38.
    [vosselman2004]
    """
    return (
        Step("surfaces", "segment_surfaces"),
        Step("cylinders", "detect_cylinders", {"search_in": "each segment"}),
        Step("spheres", "detect_spheres", {"search_in": "each segment"}),
        Step("planes", "segment_planes_hough", {"method": "normals", "search_in": "each segment"}),
        Step("pipes", "reconstruct_pipes", layers={"axes": "cylinders.axes", "centers": "spheres.centers"}),
    )


# Every composite of this module, in its order.
PIPELINES = {name: made for name, made in globals().items() if isinstance(made, Pipeline)}
