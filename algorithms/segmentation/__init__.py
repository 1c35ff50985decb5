"""Groups of points that belong together."""
