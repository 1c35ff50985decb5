"""The point cloud: its files, dimensions, classes, reason codes and units."""
