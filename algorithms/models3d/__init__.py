"""Buildings in three dimensions: roof faces, closed solids, and the files that hold them."""
