"""Outlines of buildings as polygons: traced, straightened, with borders shared where buildings touch."""
