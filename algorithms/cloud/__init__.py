"""The point cloud: files, dimensions, classes, units, cells and density."""
