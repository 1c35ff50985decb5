"""
Voxels
======

Each occupied voxel becomes the center of gravity of its points.
"""

from scenes import plan, step, town

cloud, truth = town(size=50.0, density=20.0)
found = step("downsample_voxels", cloud, voxel_size=0.5).cloud
plan(found, found.get("voxel_count"), title=f"{len(cloud):,} points became {len(found):,}", cmap="viridis", vmax=8)
