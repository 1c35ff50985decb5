"""Facades: their faces, edges and openings, from scans of streets and fronts."""
