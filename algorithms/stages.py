"""The stages, in pipeline order. To add one: write its module, name it here, test it."""

from collections import UserDict
from importlib import import_module
from typing import Any

from .stage import Stage

# Each module holds the function of its own name.
_MODULES = (
    "preparation.merge_clouds",
    "preparation.classify_noise_histogram",
    "preparation.classify_noise_histogram_2019",
    "preparation.classify_noise_air",
    "preparation.classify_noise_statistical",
    "preparation.clip_cloud",
    "preparation.filter_points",
    "preparation.downsample_voxels",
    "terrain.classify_ground_tin",
    "terrain.classify_ground_tin_2000",
    "terrain.classify_multipath",
    "terrain.classify_ground_cloth",
    "terrain.compute_height_above_ground",
    "terrain.complete_ground",
    "terrain.rasterize_terrain",
    "features.compute_features",
    "features.classify_dimensionality",
    "features.report_structure",
    "segmentation.segment_roofs",
    "segmentation.segment_regions",
    "segmentation.segment_clusters",
    "segmentation.segment_surfaces",
    "segmentation.segment_scan_lines",
    "segmentation.segment_recorded_lines",
    "bridges.classify_ground_segments",
    "bridges.classify_bridges",
    "segmentation.segment_tin_planes",
    "segmentation.segment_planes_ransac",
    "shapes.segment_planes_hough",
    "shapes.detect_cylinders",
    "shapes.detect_spheres",
    "shapes.reconstruct_pipes",
    "shapes.segment_tree",
    "segmentation.segment_voxels",
    "buildings.classify_buildings",
    "buildings.classify_buildings_2019",
    "buildings.complete_buildings",
    "buildings.refine_buildings",
    "landcover.classify_water",
    "landcover.classify_wires",
    "landcover.classify_vegetation",
    "landcover.keep_classes",
    "landcover.restore_classes",
    "landcover.recode_classes",
    "landcover.classify_segments",
    "footprints.extract_footprints",
    "footprints.regularize_polygons",
    "walls.classify_roofs",
    "walls.classify_walls",
    "walls.extract_wall_footprints",
    "walls.extract_wall_footprints_2022",
    "facades.segment_facade_lines",
    "facades.extract_facades",
    "facades.extract_openings",
    "facades.register_street",
    "models3d.compute_building_heights",
    "models3d.reconstruct_gables",
    "models3d.reconstruct_roofs",
    "models3d.reconstruct_block",
    "models3d.export_for_roofer",
    "export.export_models",
    "quality.report_buildings",
    "quality.assess_buildings",
    "quality.assess_classes",
    "quality.assess_footprints",
    "quality.assess_ground",
    "quality.assess_models",
    "quality.assess_segments",
    "quality.compare_corners",
    "quality.compare_surveys",
    "quality.update_map",
    "simulation.simulate_town",
    "simulation.simulate_bridges",
    "simulation.simulate_power_line",
    "simulation.simulate_flight",
    "simulation.simulate_plant",
    "simulation.simulate_tree",
    "simulation.simulate_village",
    "simulation.simulate_street",
    "simulation.simulate_drone_site",
)


class _Stages(UserDict[str, Stage]):
    """Stages by name, in order. A module is imported when its stage is first asked for: no run needs all of them."""

    def __init__(self, modules: tuple[str, ...]) -> None:
        self._modules = {module.split(".")[-1]: module for module in modules}
        # None until the module is imported; Any, as for all others the values are stages.
        not_yet: Any = None
        super().__init__(dict.fromkeys(self._modules, not_yet))

    def __getitem__(self, name: str) -> Stage:
        if self.data[name] is None:
            module = import_module(f".{self._modules[name]}", __package__)
            self.data[name] = getattr(module, name).stage
        return self.data[name]


STAGES = _Stages(_MODULES)


def less_memory() -> str:
    """Return the advice for clouds that do not fit into memory."""
    return f"cut the cloud into tiles or thin it with '{STAGES['downsample_voxels'].title}'"
