"""Planes in points: fits, growth, patches, and merging."""
