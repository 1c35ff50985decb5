"""Surveys of any size: read in windows, worked on block by block in several processes, written tile by tile."""
