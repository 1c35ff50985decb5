"""Walls and roofs in drone clouds, and the footprints of walls."""
