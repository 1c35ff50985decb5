"""Geometry of plain arrays: grids, rings, segments, triangulations, and groups of items; no point clouds."""
