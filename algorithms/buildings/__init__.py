"""Which groups are buildings, and their outlines."""
