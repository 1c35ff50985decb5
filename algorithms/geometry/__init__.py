"""Geometry of plain arrays: grids, rings, segments, triangulations, and groups of items. Knows no point cloud."""
