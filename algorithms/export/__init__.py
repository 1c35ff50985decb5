"""Models of buildings in formats for other programs."""
