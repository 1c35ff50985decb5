"""The point cloud: files, dimensions, classes, units, neighborhoods."""
