"""Outlines of buildings as polygons: from soft shares on a lattice, straight, with borders shared where buildings touch."""
