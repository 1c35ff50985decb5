"""The stages, in pipeline order. To add one: write its module, name it here, test it."""

from __future__ import annotations

from typing import Any

from .buildings.buildings import classify_buildings
from .buildings.complete import complete_buildings
from .buildings.footprints import extract_footprints
from .buildings.roofs import classify_roofs
from .buildings.wall_footprints import extract_wall_footprints
from .buildings.walls import classify_walls
from .features.dimensionality import classify_dimensionality
from .features.features import compute_features
from .preparation.filter import filter_points
from .preparation.merge import merge_clouds
from .preparation.noise_histogram import classify_noise_histogram
from .preparation.noise_statistical import classify_noise_statistical
from .preparation.voxels import downsample_voxels
from .quality.buildings import assess_buildings
from .quality.corners import compare_corners
from .quality.ground import assess_ground
from .segmentation.clusters import segment_clusters
from .segmentation.planes_ransac import segment_planes_ransac
from .segmentation.regions import segment_regions
from .segmentation.roofs import segment_roofs
from .simulation.flight import simulate_flight
from .simulation.town import simulate_town
from .simulation.village import simulate_village
from .terrain.ground_cloth import classify_ground_cloth
from .terrain.ground_tin import classify_ground_tin
from .terrain.height import compute_height_above_ground
from .terrain.rasterize import rasterize_terrain

_FUNCTIONS: tuple[Any, ...] = (
    merge_clouds,
    classify_noise_histogram,
    classify_noise_statistical,
    filter_points,
    downsample_voxels,
    classify_ground_tin,
    classify_ground_cloth,
    compute_height_above_ground,
    rasterize_terrain,
    compute_features,
    classify_dimensionality,
    segment_regions,
    segment_roofs,
    segment_clusters,
    segment_planes_ransac,
    classify_buildings,
    complete_buildings,
    extract_footprints,
    classify_roofs,
    classify_walls,
    extract_wall_footprints,
    assess_buildings,
    assess_ground,
    compare_corners,
    simulate_town,
    simulate_flight,
    simulate_village,
)

STAGES = {function.stage.name: function.stage for function in _FUNCTIONS}
