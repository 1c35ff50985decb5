"""Preparation of clouds: merging, filtering, thinning, and noise."""
