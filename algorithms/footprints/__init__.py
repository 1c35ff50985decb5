"""Outlines of buildings as polygons: soft shares on a lattice, straight walls, borders shared where buildings touch."""
