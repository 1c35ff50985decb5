"""The stages, in pipeline order. To add one: write its module, name it here, test it."""

from __future__ import annotations

from typing import Any

from .buildings.classify_buildings import classify_buildings
from .buildings.classify_buildings_2019 import classify_buildings_2019
from .buildings.complete_buildings import complete_buildings
from .buildings.refine_buildings import refine_buildings
from .facades.extract_facades import extract_facades
from .facades.extract_openings import extract_openings
from .facades.register_street import register_street
from .facades.segment_facade_lines import segment_facade_lines
from .features.classify_dimensionality import classify_dimensionality
from .features.compute_features import compute_features
from .footprints.extract_footprints import extract_footprints
from .landcover.classify_vegetation import classify_vegetation
from .landcover.classify_water import classify_water
from .landcover.classify_wires import classify_wires
from .landcover.recode_classes import recode_classes
from .models3d.export_for_roofer import export_for_roofer
from .models3d.reconstruct_block import reconstruct_block
from .models3d.reconstruct_gables import reconstruct_gables
from .models3d.reconstruct_roofs import reconstruct_roofs
from .preparation.classify_noise_air import classify_noise_air
from .preparation.classify_noise_histogram import classify_noise_histogram
from .preparation.classify_noise_histogram_2019 import classify_noise_histogram_2019
from .preparation.classify_noise_statistical import classify_noise_statistical
from .preparation.clip_cloud import clip_cloud
from .preparation.downsample_voxels import downsample_voxels
from .preparation.filter_points import filter_points
from .preparation.merge_clouds import merge_clouds
from .quality.assess_buildings import assess_buildings
from .quality.assess_classes import assess_classes
from .quality.assess_footprints import assess_footprints
from .quality.assess_ground import assess_ground
from .quality.assess_models import assess_models
from .quality.assess_segments import assess_segments
from .quality.compare_corners import compare_corners
from .quality.compare_surveys import compare_surveys
from .quality.report_buildings import report_buildings
from .segmentation.classify_bridges import classify_bridges
from .segmentation.classify_ground_segments import classify_ground_segments
from .segmentation.segment_clusters import segment_clusters
from .segmentation.segment_planes_ransac import segment_planes_ransac
from .segmentation.segment_recorded_lines import segment_recorded_lines
from .segmentation.segment_regions import segment_regions
from .segmentation.segment_roofs import segment_roofs
from .segmentation.segment_scan_lines import segment_scan_lines
from .segmentation.segment_surfaces import segment_surfaces
from .segmentation.segment_tin_planes import segment_tin_planes
from .segmentation.segment_voxels import segment_voxels
from .shapes.detect_cylinders import detect_cylinders
from .shapes.detect_spheres import detect_spheres
from .shapes.segment_planes_hough import segment_planes_hough
from .shapes.segment_tree import segment_tree
from .simulation.simulate_bridges import simulate_bridges
from .simulation.simulate_drone_site import simulate_drone_site
from .simulation.simulate_flight import simulate_flight
from .simulation.simulate_plant import simulate_plant
from .simulation.simulate_power_line import simulate_power_line
from .simulation.simulate_street import simulate_street
from .simulation.simulate_town import simulate_town
from .simulation.simulate_tree import simulate_tree
from .simulation.simulate_village import simulate_village
from .terrain.classify_ground_cloth import classify_ground_cloth
from .terrain.classify_ground_tin import classify_ground_tin
from .terrain.classify_ground_tin_2000 import classify_ground_tin_2000
from .terrain.classify_multipath import classify_multipath
from .terrain.complete_ground import complete_ground
from .terrain.compute_height_above_ground import compute_height_above_ground
from .terrain.rasterize_terrain import rasterize_terrain
from .walls.classify_roofs import classify_roofs
from .walls.classify_walls import classify_walls
from .walls.extract_wall_footprints import extract_wall_footprints

_FUNCTIONS: tuple[Any, ...] = (
    merge_clouds,
    classify_noise_histogram,
    classify_noise_histogram_2019,
    classify_noise_air,
    classify_noise_statistical,
    clip_cloud,
    filter_points,
    downsample_voxels,
    classify_ground_tin,
    classify_ground_tin_2000,
    classify_multipath,
    classify_ground_cloth,
    compute_height_above_ground,
    complete_ground,
    rasterize_terrain,
    compute_features,
    classify_dimensionality,
    segment_regions,
    segment_roofs,
    segment_clusters,
    segment_surfaces,
    segment_scan_lines,
    segment_recorded_lines,
    classify_ground_segments,
    classify_bridges,
    segment_tin_planes,
    segment_planes_ransac,
    segment_planes_hough,
    detect_cylinders,
    detect_spheres,
    segment_tree,
    segment_voxels,
    classify_buildings,
    classify_buildings_2019,
    complete_buildings,
    refine_buildings,
    classify_water,
    classify_wires,
    classify_vegetation,
    recode_classes,
    extract_footprints,
    classify_roofs,
    classify_walls,
    extract_wall_footprints,
    segment_facade_lines,
    extract_facades,
    extract_openings,
    register_street,
    reconstruct_gables,
    reconstruct_roofs,
    reconstruct_block,
    export_for_roofer,
    report_buildings,
    assess_buildings,
    assess_classes,
    assess_footprints,
    assess_ground,
    assess_models,
    assess_segments,
    compare_corners,
    compare_surveys,
    simulate_town,
    simulate_bridges,
    simulate_power_line,
    simulate_flight,
    simulate_plant,
    simulate_tree,
    simulate_village,
    simulate_street,
    simulate_drone_site,
)

STAGES = {function.stage.name: function.stage for function in _FUNCTIONS}

# The advice for clouds that do not fit into memory.
LESS_MEMORY = f"cut the cloud into tiles or thin it with '{STAGES['downsample_voxels'].title}'"
